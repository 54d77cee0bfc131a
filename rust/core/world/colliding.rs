//! Time to a tolerance where bodies can meet: free motion while nothing is near, else steps that are each taken twice.

use crate::error::{Error, Result};
use crate::math::{Pose, Real};
use crate::methods::Watch;
use crate::world::{State, Trajectory, World};

/// Steps that were tried in a row before the tolerance is said to be out of reach.
const MOST_TRIES: u32 = 60;

/// Steps of a call before the same is said.
const MOST_STEPS: usize = 4000;

impl World {
    /// [`World::advance_watched`] where bodies can meet. Each step is taken with n and with 2n substeps; their
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
            let (mut passed, mut step) = (0.0, duration / 16.0);
            let (mut next, mut steps) = (0, 0_usize);
            loop {
                while next < times.len() && times[next] <= passed {
                    let bodies = &world.state.bodies;
                    trajectory.write(next, 0, &bodies.poses, &bodies.twists);
                    next += 1;
                }
                if passed >= duration {
                    break;
                }
                let stop = times.get(next).copied().unwrap_or(duration).min(duration);
                steps += 1;
                if steps > MOST_STEPS + times.len() {
                    let why = format!(
                        "{MOST_STEPS} steps were not enough where bodies meet; ask for less"
                    );
                    return Err(Error::Tolerance { tolerance, time: world.time(), why });
                }
                let dt = step.min(stop - passed);
                let (taken, proposed) = if world.step_apart(dt, tolerance, watch)? {
                    (dt, 2.0 * dt)
                } else {
                    world.step_doubled(dt, tolerance)?
                };
                world.settle_joints()?;
                world.planned();
                // What is left before a stop by rounding is none.
                passed =
                    if stop - (passed + taken) <= 1e-12 * duration { stop } else { passed + taken };
                step = proposed;
                watch().map_err(|source| Error::Interrupted { source })?;
            }
            if world.notices() {
                world.notice();
            }
            world.finish(duration)?;
            trajectory.in_frames(&world.state.bodies);
            trajectory.shift(start);
            Ok(trajectory)
        })
    }

    /// One step in which nothing comes near anything else, by the methods of free motion and of joints; false, and nothing done, if
    /// something may.
    fn step_apart(&mut self, dt: Real, tolerance: Real, watch: &mut Watch<'_>) -> Result<bool> {
        let before = self.state.clone();
        if self.meets() {
            self.state.contacts.spread.clear();
            self.detect(dt)?;
        }
        self.scratch.contacts.methods = true;
        self.find_islands();
        if self.scratch.contacts.is_idle() {
            let (start, mut none) = (self.time(), Trajectory::new(Vec::new(), &self.state.bodies));
            self.each_span(dt, |world, span| {
                world.advance_to_tolerance(span, tolerance, (start, &mut none), watch)
            })?;
            // Detection foresaw the ways by velocity and gravity; other forces may have led farther.
            if !self.meets() || self.state.contacts.foresaw(&before.bodies, &self.state.bodies) {
                return Ok(true);
            }
        }
        self.go_back(&before);
        Ok(false)
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
        let why = "two steps of different length do not agree where bodies meet; ask for less";
        Err(Error::Tolerance { tolerance, time: self.time(), why: why.into() })
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
