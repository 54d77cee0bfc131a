//! What a call or a step changes, kept to go back to.

use crate::arena::Arena;
use crate::fluid::Moving;
use crate::forces::Ledger;
use crate::joint::Joint;
use crate::math::{Pose, Real, Twist, Wrench};
use crate::world::contacts::{Change, ContactBackup, Patch};
use crate::world::joints::Memory;
use crate::world::plan::Meeting;
use crate::world::soft::SoftBackup;
use crate::world::{Clock, Plan, State};

/// The moving part of a world before a call, to go back to if the call fails.
#[derive(Clone, Debug, Default)]
pub(super) struct Backup {
    moving: Vec<(usize, Pose, Twist)>,
    /// For how long they have been slow.
    slow: Vec<Real>,
    /// Forces for the next step; empty where there are none.
    applied: Vec<Wrench>,
    /// Contacts, where a step can change them.
    contacts: ContactBackup,
    /// Whether it can.
    collides: bool,
    clock: Clock,
    ledger: Ledger,
    /// What began or ended to touch and is not told yet.
    changes: Vec<Change>,
    /// What joints remember.
    joints: Vec<Memory>,
    /// Deformable bodies.
    softs: SoftBackup,
    /// The joints, where one may break.
    breakable: Option<Arena<Joint>>,
    /// The fluids, where there are any.
    fluids: Moving,
}

/// The moving part of a world at the start of a step, to take the step again.
#[derive(Clone, Debug, Default)]
pub(super) struct Start {
    moving: Vec<(usize, Pose, Twist)>,
    patches: Vec<Patch>,
    joints: Vec<Memory>,
    softs: SoftBackup,
    clock: Clock,
    ledger: Ledger,
}

fn remember(memories: &mut Vec<Memory>, state: &State) {
    memories.clear();
    memories.extend(state.joints.values().iter().map(Memory::of));
}

fn recall(memories: &[Memory], state: &mut State) {
    for (memory, joint) in memories.iter().zip(state.joints.values_mut()) {
        memory.put_back(joint);
    }
}

impl Start {
    pub fn save(&mut self, state: &State, plan: &Plan) {
        let bodies = &state.bodies;
        self.moving.clear();
        self.moving.extend(plan.moving().map(|i| (i, bodies.poses[i], bodies.twists[i])));
        self.patches.clone_from(&state.contacts.patches);
        remember(&mut self.joints, state);
        if plan.softs > 0 {
            self.softs.save(&state.softs);
        }
        (self.clock, self.ledger) = (state.clock, state.ledger);
    }

    /// Where a body that moves was.
    pub fn pose(&self, body: usize) -> Option<Pose> {
        self.of(body).map(|(_, pose, _)| *pose)
    }

    /// The velocities of a body that moves.
    pub fn twist(&self, body: usize) -> Option<Twist> {
        self.of(body).map(|(_, _, twist)| *twist)
    }

    fn of(&self, body: usize) -> Option<&(usize, Pose, Twist)> {
        self.moving.iter().find(|(i, ..)| *i == body)
    }

    pub fn restore(&self, state: &mut State) {
        for &(i, pose, twist) in &self.moving {
            (state.bodies.poses[i], state.bodies.twists[i]) = (pose, twist);
        }
        state.contacts.patches.clone_from(&self.patches);
        recall(&self.joints, state);
        self.softs.restore(&mut state.softs, &mut state.joints);
        (state.clock, state.ledger) = (self.clock, self.ledger);
    }
}

impl Backup {
    pub fn save(&mut self, state: &mut State, plan: &Plan, applied: bool) {
        let bodies = &state.bodies;
        self.moving.clear();
        self.moving.extend(plan.moving().map(|i| (i, bodies.poses[i], bodies.twists[i])));
        self.slow.clear();
        self.slow.extend(plan.moving().map(|i| state.contacts.sleep.slow[i]));
        self.applied.clear();
        if applied {
            self.applied.extend_from_slice(&bodies.applied);
        }
        state.contacts.sleep.record(true);
        (self.clock, self.ledger) = (state.clock, state.ledger);
        self.changes.clear();
        self.changes.extend_from_slice(state.contacts.touching.changes());
        remember(&mut self.joints, state);
        if plan.softs > 0 {
            self.softs.save(&state.softs);
            state.softs.events.clear();
        }
        let breaks = |joint: &Joint| {
            joint.def.breaking_force.is_some() || joint.def.breaking_torque.is_some()
        };
        self.breakable = state.joints.values().iter().any(breaks).then(|| state.joints.clone());
        if plan.meeting == Meeting::Fluid {
            self.save_fluids(state);
        }
        // What a joint that breaks tied is looked at anew.
        self.collides = !plan.colliding.is_empty() || self.breakable.is_some();
        if self.collides {
            self.contacts.save(&mut state.contacts);
        }
    }

    #[cold]
    #[inline(never)]
    fn save_fluids(&mut self, state: &State) {
        self.fluids.save(&state.fluids);
    }

    /// Puts the state back, and says whether forces wait for the next step.
    pub fn restore(&self, state: &mut State) -> bool {
        state.contacts.sleep.undo(&mut state.bodies);
        for &(i, pose, twist) in &self.moving {
            (state.bodies.poses[i], state.bodies.twists[i]) = (pose, twist);
        }
        for (&(i, ..), slow) in self.moving.iter().zip(&self.slow) {
            state.contacts.sleep.slow[i] = *slow;
        }
        let applied = !self.applied.is_empty();
        if applied {
            state.bodies.applied.clone_from(&self.applied);
        }
        if self.collides {
            self.contacts.restore(&mut state.contacts);
        }
        (state.clock, state.ledger) = (self.clock, self.ledger);
        match &self.breakable {
            Some(joints) => state.joints.clone_from(joints),
            None => recall(&self.joints, state),
        }
        self.softs.restore(&mut state.softs, &mut state.joints);
        state.softs.events.clear();
        // A call that moves the world adds and removes no fluid.
        if !state.fluids.list.values().is_empty() {
            self.fluids.restore(&mut state.fluids);
        }
        state.contacts.touching.set_changes(&self.changes);
        state.contacts.retell(state.bodies.handles());
        applied
    }
}
