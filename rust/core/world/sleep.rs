//! When bodies fall asleep, and what wakes them.

use crate::body::BodyHandle;
use crate::error::Result;
use crate::math::{Real, Twist};
use crate::world::joints::tied;
use crate::world::{State, World};

/// A body is slow below this part of √(aℓ), the speed that its acceleration a gives it over its size ℓ: 3 cm/s for a
/// box of 1 m on Earth.
const SLOW: Real = 0.01;
/// It rests when it has been slow for this many times √(ℓ/a): half a second for that box. Thrown up, it would be slow
/// for 2·SLOW of these only.
const LONG: Real = 2.0;

impl World {
    /// The stage that lets islands sleep: bodies that contacts tie and that have all been slow for long.
    pub(super) fn fall_asleep(&mut self, dt: Real) {
        self.time_the_slow(dt);
        let Self { state, scratch, plan, .. } = self;
        let State { bodies, contacts, ledger, .. } = state;
        let mut slept = false;
        for k in 0..scratch.contacts.groups() {
            let links = || scratch.contacts.links_of(k).flatten();
            // What touches matter that gives way stays awake with it.
            if links().any(|i| i as usize >= bodies.len()) {
                continue;
            }
            let rests = |i: u32| {
                let i = i as usize;
                match bodies.masses[i].is_free() {
                    true => contacts.is_asleep(i) || contacts.sleep.slow[i] >= 1.0,
                    false => bodies.twists[i] == Twist::ZERO,
                }
            };
            if !links().all(rests) {
                continue;
            }
            let stays_awake = |i: &u32| {
                let i = *i as usize;
                !bodies.masses[i].is_free() || contacts.is_asleep(i)
            };
            let mut members: Vec<u32> = links().filter(|i| !stays_awake(i)).collect();
            members.sort_unstable();
            members.dedup();
            if !members.is_empty() {
                ledger.dissipated += contacts.lay_down(bodies, members);
                slept = true;
            }
        }
        if slept {
            contacts.put_aside(bodies);
            *plan = None;
        }
    }

    /// Counts for how long bodies have been slow.
    fn time_the_slow(&mut self, dt: Real) {
        let Self { state, scratch, plan, .. } = self;
        let State { bodies, contacts, settings, schedules, .. } = state;
        let Some(plan) = plan else { return };
        for i in plan.moving().filter(|i| bodies.masses[*i].is_free()) {
            let (mass, twist, size) = (&bodies.masses[i], &bodies.twists[i], bodies.infos[i].size);
            let steady = scratch.steady.get(i).map(|steady| mass.acceleration(steady));
            let own = steady.map_or(0.0, |a| a.linear.norm() + a.angular.abs() * size);
            let pull = settings.gravity.component_mul(&mass.gravity_scale).norm() + own;
            let speed = twist.linear.norm() + twist.angular.abs() * size;
            let slow = &mut contacts.sleep.slow[i];
            let is_slow = speed < SLOW * (pull * size).sqrt() || speed == 0.0;
            // Where nothing pulls there is no time to wait for: what stands still rests.
            let part = if pull > 0.0 { dt * (pull / size).sqrt() / LONG } else { 1.0 };
            let rests = is_slow && scratch.contacts.moves(i);
            *slow = if rests { (*slow + part).min(1.0) } else { 0.0 };
        }
        // What will be pushed at its time is kept awake until then.
        for schedule in schedules.values() {
            if let Ok(i) = bodies.index(schedule.body) {
                contacts.sleep.slow[i] = 0.0;
            }
        }
    }

    /// Wakes sleeping islands by their numbers.
    pub(super) fn wake_islands(&mut self, numbers: &[u32]) {
        for number in numbers {
            self.state.contacts.wake(&self.state.bodies, *number);
        }
        if !numbers.is_empty() {
            self.plan = None;
        }
    }

    /// Wakes every body.
    pub(super) fn wake_all(&mut self) {
        self.state.contacts.sleep.slow.fill(0.0);
        let numbers = self.state.contacts.sleep.numbers();
        self.wake_islands(&numbers);
    }

    /// Wakes a body whose motion or forces are set; if that is not free, what it may touch or is joined to.
    pub(super) fn pushed(&mut self, body: usize) {
        let State { bodies, contacts, .. } = &mut self.state;
        contacts.sleep.slow[body] = 0.0;
        if contacts.sleep.count == 0 {
            return;
        }
        if !bodies.masses[body].is_free() {
            return self.disturbed(body);
        }
        let number = contacts.island_of(body);
        self.wake_islands(number.as_slice());
    }

    /// Wakes a body that is put elsewhere or changed, what it touched or touches, and what is joined to it.
    pub(super) fn disturbed(&mut self, body: usize) {
        let State { bodies, contacts, joints, .. } = &mut self.state;
        contacts.sleep.slow[body] = 0.0;
        if contacts.sleep.count == 0 {
            return;
        }
        let mut numbers = contacts.islands_around(bodies, body);
        for [i, j] in joints.values().iter().filter_map(|joint| tied(bodies, joint)) {
            if i as usize == body || j as usize == body {
                numbers.extend([i, j].iter().filter_map(|i| contacts.island_of(*i as usize)));
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        self.wake_islands(&numbers);
    }

    /// Lets a body sleep with all that it touched after the last step or is joined to and that can move, if sleeping is on and no
    /// field acts. What cannot move stays as it is.
    pub(super) fn lay_down(&mut self, body: usize) {
        let allowed = self.state.settings.sleeping && self.fields.is_empty();
        let State { bodies, contacts, joints, ledger, .. } = &mut self.state;
        if !allowed || contacts.is_asleep(body) || !bodies.masses[body].is_free() {
            return;
        }
        let joined = joints.values().iter().filter_map(|joint| tied(bodies, joint));
        let members = contacts.tied_to(bodies, body, joined);
        ledger.dissipated += contacts.lay_down(bodies, members);
        contacts.put_aside(bodies);
        self.plan = None;
    }

    /// How many bodies sleep.
    #[must_use]
    pub fn asleep(&self) -> usize {
        self.state.contacts.sleep.count
    }

    /// Whether a body sleeps.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for a body that is gone.
    pub fn is_asleep(&self, body: BodyHandle) -> Result<bool> {
        Ok(self.state.contacts.is_asleep(self.state.bodies.index(body)?))
    }
}
