//! Time to a tolerance where bodies can meet: free motion while nothing is near, else steps that are each taken twice.

use crate::collision::ProxyId;
use crate::error::{Error, Result};
use crate::math::{Pose, Real, Vec2};
use crate::methods::Watch;
use crate::methods::events::Bearing;
use crate::world::contacts::ByEvents;
use crate::world::{State, Trajectory, World};

/// Steps that were tried in a row before the tolerance is said to be out of reach.
const MOST_TRIES: u32 = 60;

/// Steps of a call before the same is said.
const MOST_STEPS: usize = 4000;

/// Bodies of a group from which on a shorter stretch is tried, in which it may fall into smaller ones.
const FEW: usize = 6;

/// How often a stretch is taken because a body was thrown farther than was looked.
const MOST_THROWN: u32 = 12;

/// How far a run has come.
struct Run<'t> {
    /// World time at its start (s).
    start: Real,
    duration: Real,
    tolerance: Real,
    trajectory: &'t mut Trajectory,
    /// Time since the start (s).
    passed: Real,
    /// The next sample.
    next: usize,
    /// Length of the next stretch in which events are located (s).
    stretch: Real,
    /// Length of the next step that is taken twice (s).
    step: Real,
    /// Steps to be taken before events are tried again, and how many the next time.
    wait: [u32; 2],
    /// What bears, where the last stretch went from event to event.
    bearing: Option<Vec<([ProxyId; 2], Bearing)>>,
}

impl World {
    /// [`World::advance_watched`] where bodies can meet. Small groups go from event to event (`methods/events`). Where that cannot be done
    /// each step is taken with n and with 2n substeps; their
    /// difference over 2² − 1 estimates the error of the finer one, which is kept (Richardson; the contact step is of second order
    /// on smooth motion). A step whose estimate is above the tolerance is taken again, shorter.
    pub(super) fn advance_colliding(
        &mut self,
        duration: Real,
        tolerance: Real,
        times: &[Real],
        watch: &mut Watch<'_>,
    ) -> Result<Trajectory> {
        self.attempt(|world| {
            let start = world.time();
            let mut trajectory = Trajectory::new(times.to_vec(), &world.state.bodies);
            world.report.estimate = Some(0.0);
            let mut run = Run {
                start,
                duration,
                tolerance,
                trajectory: &mut trajectory,
                passed: 0.0,
                next: 0,
                stretch: duration,
                step: duration / 16.0,
                wait: [0, 1],
                bearing: None,
            };
            let mut steps = 0_usize;
            while run.passed < duration {
                watch().map_err(|source| Error::Interrupted { source })?;
                if run.wait[0] == 0 && world.stretch(&mut run, watch)? {
                    continue;
                }
                steps += 1;
                if steps > MOST_STEPS + times.len() {
                    let why = format!(
                        "{MOST_STEPS} steps were not enough where bodies meet; ask for less"
                    );
                    return Err(Error::Tolerance { tolerance, time: world.time(), why });
                }
                world.step_between(&mut run)?;
            }
            run.hand_out(world);
            world.see_what_bears(duration, run.bearing.take())?;
            if world.notices() {
                world.notice();
            }
            world.finish(duration)?;
            trajectory.in_frames(&world.state.bodies);
            trajectory.shift(start);
            Ok(trajectory)
        })
    }

    /// Manifolds as they are at the end of a run from event to event, with what they bear.
    fn see_what_bears(
        &mut self,
        duration: Real,
        bearing: Option<Vec<([ProxyId; 2], Bearing)>>,
    ) -> Result<()> {
        let Some(bearing) = bearing.filter(|_| self.meets()) else { return Ok(()) };
        self.state.contacts.spread.clear();
        self.detect(0.0)?;
        // Impulses are those of a substep; of which does not matter.
        let substep = duration / Real::from(self.state.settings.substeps);
        self.state.contacts.remember(&bearing, substep);
        Ok(())
    }

    /// One step that is taken twice, up to the next sample.
    fn step_between(&mut self, run: &mut Run<'_>) -> Result<()> {
        run.hand_out(self);
        run.wait[0] = run.wait[0].saturating_sub(1);
        let times = &run.trajectory.times;
        let stop = times.get(run.next).copied().unwrap_or(run.duration).min(run.duration);
        let dt = run.step.min(stop - run.passed);
        run.bearing = None;
        let (taken, proposed) = self.step_doubled(dt, run.tolerance)?;
        self.settle_joints()?;
        self.planned();
        if self.notices() {
            self.notice();
        }
        run.step = proposed;
        run.pass(taken, stop);
        Ok(())
    }

    /// A stretch in which every group that may meet or touch goes from event to event, and all others by their methods;
    /// false, and nothing done, if that cannot be.
    fn stretch(&mut self, run: &mut Run<'_>, watch: &mut Watch<'_>) -> Result<bool> {
        let before = self.state.clone();
        let (report, hits) = (self.report.clone(), self.events.hit.len());
        let rest = run.duration - run.passed;
        let mut dt = run.stretch.min(rest);
        let short = self.state.contacts.short_stretch(&self.state.bodies, |i| self.pull(i));
        // What is as fast as numbers go makes no stretch so short that it leads nowhere.
        let short = short.max(rest / MOST_STEPS as Real);
        let mut thrown: Vec<(u32, Real)> = Vec::new();
        for _ in 0..MOST_THROWN {
            if !self.find_groups(&mut dt, short, &thrown)? {
                let why = "groups that are too large, or have what events do not know";
                self.report.fallback.get_or_insert((self.time(), why));
                break;
            }
            self.scratch.contacts.by_events = Some(ByEvents::default());
            let result = self.each_span(dt, |world, span| {
                let sampled = (run.start, &mut *run.trajectory);
                world.advance_to_tolerance(span, run.tolerance, sampled, watch)
            });
            let booked = self.scratch.contacts.by_events.take().unwrap_or_default();
            result?;
            let foresaw = self.state.contacts.foresaw(&before.bodies, &self.state.bodies);
            if booked.thrown.is_empty() && booked.gave_up.is_none() && (foresaw || !self.meets()) {
                self.report.events += booked.events;
                self.settle_joints()?;
                self.planned();
                run.pass(dt, run.duration);
                run.stretch = 2.0 * dt;
                run.next = run.trajectory.times.partition_point(|t| *t <= run.passed);
                run.wait = [0, 1];
                run.bearing = Some(booked.bearing);
                if self.notices() {
                    self.notice_located(booked.touched);
                }
                return Ok(true);
            }
            self.go_back(&before);
            self.report = report.clone();
            self.events.hit.truncate(hits);
            if let Some(gave_up) = booked.gave_up {
                self.report.fallback.get_or_insert(gave_up);
                break;
            }
            thrown.extend(booked.thrown);
            if !foresaw {
                dt *= 0.5;
            }
        }
        self.go_back(&before);
        self.state.contacts.spread.clear();
        run.stretch = dt;
        run.wait = [run.wait[1], (2 * run.wait[1]).min(64)];
        Ok(false)
    }

    /// Groups of what may meet within dt, which is shortened where that makes them smaller; false if some group is not one for events.
    fn find_groups(&mut self, dt: &mut Real, short: Real, thrown: &[(u32, Real)]) -> Result<bool> {
        loop {
            if self.meets() {
                let mut contacts = std::mem::take(&mut self.state.contacts);
                contacts.spread_by(*dt, &self.state.bodies, |i| self.pull(i));
                contacts.spread_out(thrown);
                self.state.contacts = contacts;
                self.detect(*dt)?;
            }
            self.scratch.contacts.methods = true;
            self.find_islands();
            if self.largest_group() <= FEW || *dt <= short {
                return Ok(self.suits_events());
            }
            *dt = (0.5 * *dt).max(short);
        }
    }

    /// Acceleration (m/s²) by gravity and steady forces.
    fn pull(&self, i: usize) -> Vec2 {
        let bodies = &self.state.bodies;
        let mass = &bodies.masses[i];
        let gravity = self.state.settings.gravity.component_mul(&mass.gravity_scale);
        gravity + bodies.forces[i].force.component_mul(&mass.inverse)
    }

    /// One step of at most `dt` to a tolerance; returns its length and a length for the next (s).
    fn step_doubled(&mut self, mut dt: Real, tolerance: Real) -> Result<(Real, Real)> {
        let substeps = self.state.settings.substeps;
        let hits = self.events.hit.len();
        let before = self.state.clone();
        self.scratch.contacts.methods = false;
        for _ in 0..MOST_TRIES {
            self.meet_and_advance(dt)?;
            let coarse = self.go_back(&before);
            self.events.hit.truncate(hits);
            self.state.settings.substeps = 2 * substeps;
            let fine = self.meet_and_advance(dt);
            self.state.settings.substeps = substeps;
            fine?;
            let error = self.error_against(&before, &coarse) / 3.0;
            // Third order of a single step; never more than threefold at once.
            let change = 0.9 * libm::cbrt(tolerance / error.max(1e-300));
            if error <= tolerance {
                self.report.estimate = self.report.estimate.map(|sum| sum + error);
                self.report.smallest_step = self.report.smallest_step.min(dt);
                return Ok((dt, dt * change.clamp(1.0, 3.0)));
            }
            self.report.rejected += 1;
            self.go_back(&before);
            self.events.hit.truncate(hits);
            dt *= change.clamp(0.1, 0.5);
        }
        let mut why = String::from(
            "two steps of different length do not agree where bodies meet; ask for less",
        );
        if let Some((time, reason)) = self.report.fallback {
            why += &format!(" (events were not followed from t = {time} s on: {reason})");
        }
        Err(Error::Tolerance { tolerance, time: self.time(), why })
    }

    /// Puts a state back, and hands over the one that was there.
    fn go_back(&mut self, before: &State) -> State {
        let gone = std::mem::replace(&mut self.state, before.clone());
        if self.state.settings.sleeping {
            // Other bodies may have been awake.
            self.plan = None;
            self.planned();
        }
        gone
    }

    /// Largest difference of two states that began as one, relative to size or way.
    fn error_against(&self, before: &State, other: &State) -> Real {
        let bodies = &self.state.bodies;
        let error = |i: usize| -> Real {
            let (a, b): (&Pose, &Pose) = (&bodies.poses[i], &other.bodies.poses[i]);
            let size = bodies.infos[i].size;
            let apart = (a.position - b.position).norm() + size * (a.angle - b.angle).abs();
            let way = (a.position - before.bodies.poses[i].position).norm().max(size);
            if apart == 0.0 { 0.0 } else { apart / way }
        };
        (0..bodies.len()).map(error).fold(0.0, Real::max)
    }
}

impl Run<'_> {
    /// Writes the samples that are due, where a step ended on them.
    fn hand_out(&mut self, world: &World) {
        while self.trajectory.times.get(self.next).is_some_and(|time| *time <= self.passed) {
            let bodies = &world.state.bodies;
            self.trajectory.write(self.next, 0, &bodies.poses, &bodies.twists);
            self.next += 1;
        }
    }

    /// Time goes on; what is left before a stop by rounding is none.
    fn pass(&mut self, dt: Real, stop: Real) {
        let now = self.passed + dt;
        self.passed = if stop - now <= 1e-12 * self.duration { stop } else { now };
    }
}
