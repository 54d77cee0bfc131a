//! The stage that moves what joints tie where nothing touches: each island by the method.

use rustc_hash::FxHashMap;

use super::{centers_of, index_of, law_of, pair_of};
use crate::body::{Bodies, Mass};
use crate::constraints::joint::{Action, Row};
use crate::error::Result;
use crate::forces::{Forces, Ledger, Shown};
use crate::joint::Joint;
use crate::math::{Pose, Real, Twist, Wrench, vec2};
use crate::methods::events::Modes;
use crate::methods::joined::{Joints, Tie};
use crate::methods::{Adaptive, Control, Motion, Progress, Scratch, Sink, Span, System, Watch};
use crate::world::contacts::Contacts;
use crate::world::{State, Trajectory, World};

/// Columns of the stage; kept between steps so that a warm step allocates nothing.
#[derive(Clone, Default)]
pub(in crate::world) struct JoinedScratch {
    /// Islands by their first joint: they know its graph.
    groups: FxHashMap<u32, Group>,
    /// The one at work.
    pub group: Group,
    /// Slot of each body in it; valid where the mark is its.
    slots: Vec<(u32, u32)>,
    mark: u32,
}

impl JoinedScratch {
    /// Forgets the islands.
    pub fn forget(&mut self) {
        self.groups.clear();
    }
}

/// Bodies of an island, gathered from the columns.
#[derive(Clone, Debug, Default)]
pub(in crate::world) struct Group {
    pub members: Vec<u32>,
    pub poses: Vec<Pose>,
    pub twists: Vec<Twist>,
    pub masses: Vec<Mass>,
    steady: Vec<Wrench>,
    /// What errors of bodies are measured against: their sizes, or how far their joints reach (m).
    pub sizes: Vec<Real>,
    /// Pairs that may touch, and the slots of their bodies.
    pub pairs: Vec<(u32, [u32; 2])>,
    /// Places of the joints among those of the world.
    places: Vec<u32>,
    joints: Joints,
}

impl Group {
    fn clear(&mut self) {
        self.members.clear();
        self.poses.clear();
        self.twists.clear();
        self.masses.clear();
        self.steady.clear();
        self.sizes.clear();
        self.pairs.clear();
        self.places.clear();
        self.joints.clear();
    }

    /// Takes in body i. One that sleeps stays where it is.
    fn add(&mut self, (bodies, i): (&Bodies, usize), asleep: bool, steady: Option<Wrench>) {
        let mass = if asleep { FIXED } else { bodies.masses[i] };
        self.members.push(i as u32);
        self.poses.push(bodies.poses[i]);
        self.twists.push(bodies.twists[i]);
        self.masses.push(mass);
        self.steady.extend(steady);
        self.sizes.push(bodies.infos[i].size);
        self.joints.add_body(&mass);
    }
}

/// Of what nothing moves.
const FIXED: Mass = Mass {
    inverse: vec2(0.0, 0.0),
    inverse_inertia: 0.0,
    mass: 0.0,
    inertia: 0.0,
    gravity_scale: vec2(0.0, 0.0),
};

impl World {
    /// Moves every island that is left to the method through a span, at the fixed step.
    pub(in crate::world) fn advance_joined(&mut self, span: Span) -> Result<()> {
        let method = self.method;
        self.each_joined(|world| {
            let ledger = world.run_joined(false, |system, motion, (scratch, _)| {
                method.run(system, motion, span, scratch)
            })?;
            world.scatter_joined(ledger);
            world.report.steps += u64::from(span.substeps);
            world.report.smallest_step = world.report.smallest_step.min(span.h());
            Ok(())
        })
    }

    /// The same to a tolerance; samples go to the trajectory. Returns the largest estimate of an island's error.
    pub(in crate::world) fn advance_joined_to_tolerance(
        &mut self,
        span: Span,
        (tolerance, samples): (Real, &[Real]),
        (first, trajectory): (usize, &mut Trajectory),
        watch: &mut Watch<'_>,
    ) -> Result<Real> {
        let mut worst: Real = 0.0;
        self.each_joined(|world| {
            let Group { members, sizes, .. } = &world.scratch.joined.group;
            let (members, sizes) = (members.clone(), sizes.clone());
            let mut sink = |sample: usize, poses: &[Pose], twists: &[Twist]| {
                for (slot, body) in members.iter().enumerate() {
                    let (pose, twist) = (&poses[slot..=slot], &twists[slot..=slot]);
                    trajectory.write(first + sample, *body as usize, pose, twist);
                }
            };
            let mut progress = Progress::default();
            let ledger = world.run_joined(false, |system, motion, (scratch, _)| {
                let control = Control { tolerance, sizes: &|slot| sizes[slot], samples };
                let handlers: (&mut Sink<'_>, _) = (&mut sink, &mut *watch);
                let adaptive = Adaptive::new(&control, motion, span);
                progress = adaptive.run(system, motion, scratch, handlers)?;
                Ok(())
            })?;
            world.scatter_joined(ledger);
            world.report.book_progress(&progress);
            worst = worst.max(progress.estimate);
            Ok(())
        })?;
        Ok(worst)
    }

    /// Gathers every island that is left to a method, and lets `advance` move it.
    fn each_joined(&mut self, mut advance: impl FnMut(&mut Self) -> Result<()>) -> Result<()> {
        if !self.scratch.contacts.leaves_any() {
            return Ok(());
        }
        for k in 0..self.scratch.contacts.groups() {
            if !self.scratch.contacts.leaves(k) {
                continue;
            }
            self.with_island(k, &mut advance)?;
        }
        Ok(())
    }

    /// Gathers an island with its contacts, and lets `advance` move it.
    pub(in crate::world) fn with_island(
        &mut self,
        k: usize,
        advance: impl FnOnce(&mut Self) -> Result<()>,
    ) -> Result<()> {
        let first = self.scratch.contacts.joints_of(k).next();
        let joined = &mut self.scratch.joined;
        joined.group = first.and_then(|first| joined.groups.remove(&first)).unwrap_or_default();
        self.gather_joined(k);
        let result = advance(self);
        let joined = &mut self.scratch.joined;
        let group = std::mem::take(&mut joined.group);
        if let Some(first) = first {
            joined.groups.insert(first, group);
        }
        result
    }

    /// Fills the group at work with the bodies and joints of an island.
    fn gather_joined(&mut self, k: usize) {
        let Self { state, scratch, plan, .. } = self;
        let State { bodies, joints, contacts, .. } = state;
        let steady = &scratch.steady;
        let JoinedScratch { group, slots, mark, .. } = &mut scratch.joined;
        group.clear();
        *mark = mark.wrapping_add(1);
        slots.resize(bodies.len(), (0, 0));
        let mut slot_of = |group: &mut Group, i: usize| {
            if slots[i].0 != *mark {
                slots[i] = (*mark, group.members.len() as u32);
                let steady = steady.get(i).copied();
                group.add((bodies, i), contacts.is_asleep(i), steady);
            }
            slots[i].1
        };
        if plan.as_ref().is_some_and(|plan| plan.together > 0) {
            for i in 0..bodies.len() {
                slot_of(group, i);
            }
        }
        for (near, pair) in contacts.pairs_of_group(&scratch.contacts, k) {
            let slots = pair.map(|i| slot_of(group, i as usize));
            group.pairs.push((near, slots));
        }
        for place in scratch.contacts.joints_of(k) {
            let joint = &joints.values()[place as usize];
            let ends = [0, 1].map(|side| {
                let i = index_of(bodies, joint, side)?;
                Some(slot_of(group, i))
            });
            let (law, ground) = (law_of(bodies, joint), centers_of(bodies, joint));
            let apart = (ground[1] - ground[0]).norm();
            for (slot, arm) in ends.iter().zip(&law.arms) {
                let Some(slot) = *slot else { continue };
                let reach = apart.max(arm.norm());
                let size = &mut group.sizes[slot as usize];
                *size = size.max(reach);
            }
            group.places.push(place);
            group.joints.add(Tie { bodies: ends, law, ground });
        }
        group.joints.begin(&group.poses, &group.twists);
    }

    /// Lets a method work on a group, its joints by themselves or together with what touches; returns what it books.
    pub(in crate::world) fn run_joined(
        &mut self,
        touching: bool,
        run: impl FnOnce(&mut System<'_>, &mut Motion<'_>, (&mut Scratch, &Contacts)) -> Result<()>,
    ) -> Result<Ledger> {
        let Self { state, scratch, fields, plan, report, .. } = self;
        let State { bodies, settings, ledger, contacts, .. } = state;
        let Group { members, poses, twists, masses, steady, joints, .. } =
            &mut scratch.joined.group;
        let forces = Forces {
            handles: &bodies.map,
            masses,
            infos: &bodies.infos,
            members,
            steady,
            gravity: settings.gravity,
            air: settings.air,
            fields,
            resistance: plan.as_ref().is_some_and(|plan| plan.resistance),
            buffers: &mut scratch.forces,
            shown: Shown::default(),
            evaluations: 0,
        };
        let mut booked = *ledger;
        let mut motion = Motion { poses, twists, ledger: &mut booked };
        if touching {
            let modes = Box::new(Modes::new(masses, std::mem::take(joints)));
            let mut system = System { forces, joints: None, modes: Some(modes) };
            let result = run(&mut system, &mut motion, (&mut scratch.methods, contacts));
            report.evaluations += system.forces.evaluations;
            *joints = system.modes.map(|modes| modes.joints).unwrap_or_default();
            return result.map(|()| booked);
        }
        let mut system = System { forces, joints: Some(joints), modes: None };
        run(&mut system, &mut motion, (&mut scratch.methods, contacts))?;
        report.evaluations += system.forces.evaluations;
        Ok(booked)
    }

    /// Brings the motion of the group at work, and what its joints do, back to the columns.
    pub(in crate::world) fn scatter_joined(&mut self, ledger: Ledger) {
        let Self { state, scratch, plan, report, .. } = self;
        let State { bodies, joints, .. } = state;
        let together = plan.as_ref().is_some_and(|plan| plan.together > 0);
        let group = &scratch.joined.group;
        for (slot, body) in group.members.iter().enumerate() {
            // What moves as it is given is moved by itself.
            if together || group.masses[slot].is_free() {
                bodies.poses[*body as usize] = group.poses[slot];
                bodies.twists[*body as usize] = group.twists[slot];
            }
        }
        for (place, reaction) in group.places.iter().zip(&group.joints.reactions) {
            joints.values_mut()[*place as usize].reaction = *reaction;
        }
        report.solves += group.joints.solves;
        state.ledger = ledger;
    }
}

/// Whether no row of a joint has a bound on what it may use, nor a side to which it does nothing.
pub(in crate::world) fn is_smooth(bodies: &Bodies, joint: &Joint) -> bool {
    let smooth = |row: &Row| {
        matches!(row.action, Action::Hold | Action::Spring(_) | Action::Off)
            && row.bound == Real::INFINITY
    };
    let breaks = joint.def.breaking_force.is_some() || joint.def.breaking_torque.is_some();
    let rows = law_of(bodies, joint).rows(&pair_of(bodies, joint));
    !breaks && !rows.disc && rows.as_slice().iter().all(smooth)
}
