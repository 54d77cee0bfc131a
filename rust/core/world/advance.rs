//! Time to a tolerance instead of at a step.

use std::ops::Range;

use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Twist};
use crate::methods::{Adaptive, Control, Progress, Sink, Span, Watch};
use crate::world::{StepReport, Trajectory, World};

impl World {
    /// Moves the world on by a duration (s), to a tolerance (relative, 1e-15 to 0.1).
    ///
    /// Bodies under constant forces take the exact solution; every other island takes DOP853 at the
    /// steps its own error asks for. What touches or may goes from event to event (see [`crate::methods::events`]) in small groups; where
    /// some group is not one for that, all advance by steps that are taken once more at half the
    /// substep and shortened until both agree to the tolerance, impacts located in either. The local error of each step is kept below the tolerance times
    /// the body's size or the way it went (positions), a radian (angles), its largest speeds so far
    /// (velocities); the report's estimate is the sum of those errors.
    ///
    /// Where a turning body's silhouette has a kink (another corner bounds it) a step ends, so that forces are
    /// smooth within each. The estimate trusts that the user's own fields are, too, and
    /// [`DragWidth::BoundingBox`](crate::body::DragWidth), whose kinks are not looked for.
    ///
    /// # Errors
    /// A number that is not allowed, a field that fails, deformable bodies in the world, a tolerance that cannot be reached. The world
    /// is then as it was before the call.
    pub fn advance(&mut self, duration: Real, tolerance: Real) -> Result<&StepReport> {
        self.advance_sampled(duration, tolerance, &[])?;
        Ok(&self.report)
    }

    /// The same, handing out the motion at given times (s from now, increasing, within the duration).
    pub fn advance_sampled(
        &mut self,
        duration: Real,
        tolerance: Real,
        times: &[Real],
    ) -> Result<Trajectory> {
        self.advance_watched(duration, tolerance, times, &mut || Ok(()))
    }

    /// The same, asking `watch` at each step of the method whether to go on.
    ///
    /// # Errors
    /// Those of [`World::advance`], and [`Error::Interrupted`] with what `watch` said.
    pub fn advance_watched(
        &mut self,
        duration: Real,
        tolerance: Real,
        times: &[Real],
        watch: &mut Watch<'_>,
    ) -> Result<Trajectory> {
        check::positive("duration", duration)?;
        if !self.state.softs.is_empty() {
            let allowed = "step(dt): deformable bodies move at a fixed step only";
            return Err(Error::invalid("advance", "a world with deformable bodies", allowed));
        }
        if !(1e-15..=0.1).contains(&tolerance) {
            return Err(Error::invalid("tolerance", tolerance, "1e-15 to 0.1"));
        }
        for (i, time) in times.iter().enumerate() {
            let before = i.checked_sub(1).map_or(0.0, |j| times[j]);
            if !(before..=duration).contains(time) {
                return Err(Error::invalid(
                    format!("times[{i}]"),
                    time,
                    format!("increasing times from 0 to {duration}"),
                ));
            }
        }
        self.planned();
        if self.is_wet() {
            let allowed = "a world without fluids: they move at fixed steps (World::steps)";
            return Err(Error::invalid("tolerance", tolerance, allowed));
        }
        if !self.is_smooth() {
            return self.advance_colliding(duration, tolerance, times, watch);
        }
        self.attempt(|world| {
            world.planned();
            let mut trajectory = Trajectory::new(times.to_vec(), &world.state.bodies);
            let start = world.time();
            world.report.estimate = Some(0.0);
            world.each_span(duration, |world, span| {
                world.advance_to_tolerance(span, tolerance, (start, &mut trajectory), watch)
            })?;
            world.settle_joints()?;
            world.finish(duration)?;
            trajectory.in_frames(&world.state.bodies);
            trajectory.shift(start);
            Ok(trajectory)
        })
    }

    /// Whether nothing can meet and no joint has a bound. Finds the groups that joints tie.
    fn is_smooth(&mut self) -> bool {
        let plan = self.planned();
        let (apart, joints) = (plan.colliding.is_empty(), plan.joints);
        if apart && joints > 0 {
            self.scratch.contacts.methods = true;
            self.find_islands();
        }
        apart && (joints == 0 || self.scratch.contacts.is_idle())
    }

    pub(super) fn advance_to_tolerance(
        &mut self,
        span: Span,
        tolerance: Real,
        (start, trajectory): (Real, &mut Trajectory),
        watch: &mut Watch<'_>,
    ) -> Result<()> {
        let passed = span.start - start;
        let samples = trajectory.within(passed, passed + span.duration);
        if !samples.is_empty() {
            self.sample_closed(passed, samples.clone(), trajectory);
        }
        let times: Vec<Real> =
            trajectory.times[samples.clone()].iter().map(|t| t - passed).collect();
        // First what joints tie, while bodies whose motion is given still stand where the step begins.
        let asked = (tolerance, &*times);
        let sampled = (samples.start, &mut *trajectory);
        let mut worst = self.advance_joined_to_tolerance(span, asked, sampled, watch)?;
        let sampled = (samples.start, &mut *trajectory);
        worst = worst.max(self.advance_by_events(span, asked, sampled, watch)?);
        self.advance_closed(span.duration);
        let plan = self.plan.take().unwrap_or_default();
        for run in plan.runs() {
            let first = run.start;
            if self.scratch.contacts.moves(first) {
                continue;
            }
            let mut sink = |k: usize, poses: &[Pose], twists: &[Twist]| {
                trajectory.write(samples.start + k, first, poses, twists);
            };
            let progress = self.run_to_tolerance(
                (run, plan.resistance),
                span,
                (tolerance, &times),
                (&mut sink, &mut *watch),
            )?;
            worst = worst.max(progress.estimate);
        }
        self.plan = Some(plan);
        self.report.estimate = self.report.estimate.map(|sum| sum + worst);
        Ok(())
    }

    /// Runs DOP853 on a run of bodies and books what it took.
    fn run_to_tolerance(
        &mut self,
        (run, resistance): (Range<usize>, bool),
        span: Span,
        (tolerance, samples): (Real, &[Real]),
        (sink, watch): (&mut Sink<'_>, &mut Watch<'_>),
    ) -> Result<Progress> {
        let (mut system, mut motion, scratch) = self.split(run, resistance);
        let infos = system.forces.infos;
        let control = Control { tolerance, sizes: &|i| infos[i].size, samples };
        let adaptive = Adaptive::new(&control, &motion, span);
        let progress = adaptive.run(&mut system, &mut motion, scratch, (sink, watch))?;
        let evaluations = system.forces.evaluations;
        self.report.evaluations += evaluations;
        self.report.book_progress(&progress);
        Ok(progress)
    }

    /// Samples of the bodies whose solution is known, and of those that rest: the state goes there and back.
    fn sample_closed(&mut self, passed: Real, samples: Range<usize>, trajectory: &mut Trajectory) {
        let start = (self.state.bodies.poses.clone(), self.state.bodies.twists.clone());
        let (ledger, steps) = (self.state.ledger, self.report.steps);
        for k in samples {
            self.advance_closed(trajectory.times[k] - passed);
            let bodies = &mut self.state.bodies;
            trajectory.write(k, 0, &bodies.poses, &bodies.twists);
            bodies.poses.clone_from(&start.0);
            bodies.twists.clone_from(&start.1);
        }
        (self.state.ledger, self.report.steps) = (ledger, steps);
    }

    /// `count` steps of dt, keeping the motion after every `every` of them, the start included.
    ///
    /// # Errors
    /// Those of [`World::steps`]; the world is then as it was before the call.
    pub fn record(&mut self, dt: Real, count: u32, every: u32) -> Result<Trajectory> {
        self.record_watched(dt, count, every, &mut || Ok(()))
    }

    /// The same, asking `watch` after each step whether to go on.
    ///
    /// # Errors
    /// Those of [`World::record`], and [`Error::Interrupted`] with what `watch` said.
    pub fn record_watched(
        &mut self,
        dt: Real,
        count: u32,
        every: u32,
        watch: &mut Watch<'_>,
    ) -> Result<Trajectory> {
        check::positive("dt", dt)?;
        if every == 0 {
            return Err(Error::invalid("every", every, "1 or more"));
        }
        self.attempt(|world| {
            let samples = count / every + 1;
            let mut trajectory = Trajectory::new(vec![0.0; samples as usize], &world.state.bodies);
            for k in 0..samples {
                if k > 0 {
                    world.ticks(dt, every, watch)?;
                }
                let bodies = &world.state.bodies;
                trajectory.times[k as usize] = world.state.clock.now;
                trajectory.write(k as usize, 0, &bodies.poses, &bodies.twists);
            }
            world.ticks(dt, count % every, watch)?;
            trajectory.in_frames(&world.state.bodies);
            Ok(trajectory)
        })
    }

    /// `count` steps of dt with an estimate of the error they leave, by running them again at half
    /// the substep (Richardson): |x(h) − x(h/2)|/(2^p − 1)·2^p relative to size or way, the largest over
    /// the bodies at the end. Costs three times as much.
    pub fn steps_with_estimate(&mut self, dt: Real, count: u32) -> Result<&StepReport> {
        let before = self.snapshot();
        let substeps = self.state.settings.substeps;
        self.set_substeps(2 * substeps)?;
        let fine = self.steps(dt, count);
        let end = self.state.bodies.poses.clone();
        self.restore(&before);
        fine?;
        let start = self.state.bodies.poses.clone();
        self.steps(dt, count)?;
        let gain = libm::exp2(Real::from(self.method.facts().order));
        let bodies = &self.state.bodies;
        let error = |i: usize| -> Real {
            let (a, b, size) = (&bodies.poses[i], &end[i], bodies.infos[i].size);
            let apart = (a.position - b.position).norm() + size * (a.angle - b.angle).abs();
            let way = (b.position - start[i].position).norm().max(size);
            if apart == 0.0 { 0.0 } else { apart / way }
        };
        let worst = (0..bodies.len()).map(error).fold(0.0, Real::max);
        self.report.estimate = Some(worst * gain / (gain - 1.0));
        Ok(&self.report)
    }
}
