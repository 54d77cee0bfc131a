//! One step, and many.

use std::ops::Range;
use std::time::Instant;

use crate::body::Bodies;
use crate::error::{Error, Result, check};
use crate::forces::{Forces, Shown};
use crate::math::{Real, Wrench};
use crate::methods::closed_form::{Constant, Damping};
use crate::methods::{Motion, Span, System, Watch};
use crate::world::plan::Meeting;
use crate::world::{Clock, Plan, State, StepReport, World};

/// How often a step is taken because a body was thrown too far or struck a sleeping one; the last time with what it got.
pub(super) const MOST_TRIES: u32 = 6;

impl World {
    /// Moves the world on by dt (s), at a fixed step.
    ///
    /// # Errors
    /// A dt that is not allowed, a field that fails, a motion that leaves the range of numbers. The
    /// world is then as it was before the call.
    pub fn step(&mut self, dt: Real) -> Result<()> {
        self.steps(dt, 1)
    }

    /// `count` steps of dt (s). Forces applied for the next step act in the first of them.
    ///
    /// # Errors
    /// Those of [`World::step`]; the world is then as it was before the first of the steps.
    pub fn steps(&mut self, dt: Real, count: u32) -> Result<()> {
        check::positive("dt", dt)?;
        self.attempt(|world| (0..count).try_for_each(|_| world.tick(dt)))
    }

    /// The same, asking `watch` after each step whether to go on.
    ///
    /// # Errors
    /// Those of [`World::step`], and [`Error::Interrupted`] with what `watch` said; the world is then as it
    /// was before the first of the steps.
    pub fn steps_watched(&mut self, dt: Real, count: u32, watch: &mut Watch<'_>) -> Result<()> {
        check::positive("dt", dt)?;
        self.attempt(|world| world.ticks(dt, count, watch))
    }

    pub(super) fn ticks(&mut self, dt: Real, count: u32, watch: &mut Watch<'_>) -> Result<()> {
        (0..count).try_for_each(|_| {
            self.tick(dt)?;
            watch().map_err(|source| Error::Interrupted { source })
        })
    }

    /// One step: a table of contents.
    pub(super) fn tick(&mut self, dt: Real) -> Result<()> {
        self.stage("plan", |world| {
            world.planned();
            Ok(())
        })?;
        self.scratch.contacts.start = self.state.clock.now;
        self.scratch.contacts.methods = self.method.facts().joints;
        self.meet_and_advance(dt)?;
        if self.notices() {
            self.stage("events", |world| {
                world.notice();
                world.state.contacts.line_up(world.scratch.contacts.patches());
                Ok(())
            })?;
        }
        if self.joins() {
            self.stage("joints", |world| {
                world.settle_joints()?;
                world.planned();
                Ok(())
            })?;
        }
        self.stage("report", |world| world.finish(dt))?;
        if self.may_sleep() {
            self.stage("sleep", |world| {
                world.fall_asleep(dt);
                Ok(())
            })?;
        }
        Ok(())
    }

    /// The stages that move the world: those of contact only where bodies can meet.
    pub(super) fn meet_and_advance(&mut self, dt: Real) -> Result<()> {
        match self.plan.as_ref().map(|plan| plan.meeting) {
            Some(Meeting::Bodies) => return self.collide_and_advance(dt),
            Some(Meeting::Fluid) => return self.wade(dt),
            _ => self.join()?,
        }
        self.stage("advance", |world| world.each_span(dt, World::advance_span))
    }

    /// The stages of a world in which bodies can meet. Where one is thrown farther than what it can meet was looked for,
    /// or strikes what sleeps, the step is taken again with that in view, or awake.
    fn collide_and_advance(&mut self, dt: Real) -> Result<()> {
        let (hits, impacts) = (self.events.hit.len(), self.report.impacts);
        self.state.contacts.spread.clear();
        for tries in 1.. {
            self.stage("detect", |world| world.detect_all(dt))?;
            self.stage("islands", |world| {
                world.find_islands();
                Ok(())
            })?;
            let watched = self.scratch.contacts.watched;
            if let Some(plan) = self.plan.as_ref().filter(|_| watched) {
                self.scratch.start.save(&self.state, plan);
            }
            self.stage("advance", |world| world.each_span(dt, World::advance_span))?;
            let struck = self.state.contacts.struck(&self.state.bodies);
            if !watched
                || (self.scratch.contacts.thrown.is_empty() && struck.is_empty())
                || tries == MOST_TRIES
            {
                self.wake_islands(&struck);
                break;
            }
            self.scratch.start.restore(&mut self.state);
            self.state.contacts.spread_out(&self.scratch.contacts.thrown);
            self.wake_islands(&struck);
            self.planned();
            self.events.hit.truncate(hits);
            self.report.impacts = impacts;
        }
        Ok(())
    }

    /// Detection, that of deformable bodies included, until nothing wakes any more.
    pub(super) fn detect_all(&mut self, dt: Real) -> Result<()> {
        loop {
            self.detect(dt)?;
            if !self.has_softs() || !self.look_around_softs(dt) {
                return Ok(());
            }
            self.planned();
        }
    }

    /// Whether bodies can meet, or give way.
    pub(super) fn meets(&self) -> bool {
        self.plan.as_ref().is_some_and(Plan::meets)
    }

    /// Whether there are deformable bodies.
    pub(super) fn has_softs(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.softs > 0)
    }

    /// Whether any joint does anything.
    fn joins(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.joints > 0)
    }

    /// Groups of what joints tie, where nothing can collide.
    fn join(&mut self) -> Result<()> {
        if !self.joins() {
            return Ok(());
        }
        self.stage("islands", |world| {
            world.find_islands();
            Ok(())
        })
    }

    /// Whether bodies can fall asleep. Fields act on all bodies at once, and always.
    fn may_sleep(&self) -> bool {
        self.state.settings.sleeping && self.plan.as_ref().is_some_and(Plan::may_rest)
    }

    /// Whether something can begin or end to touch in a step.
    pub(super) fn notices(&self) -> bool {
        self.meets() || self.state.contacts.touching.changed()
    }

    /// Runs a stage, timed if timing is on.
    pub(super) fn stage(
        &mut self,
        name: &'static str,
        run: impl FnOnce(&mut Self) -> Result<()>,
    ) -> Result<()> {
        if !self.state.settings.timing {
            return run(self);
        }
        let start = Instant::now();
        let result = run(self);
        self.report.book_time(name, start.elapsed());
        result
    }

    /// Runs `work`; if it fails, the world is put back as it was.
    pub(super) fn attempt<T>(&mut self, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        self.planned();
        self.strays.take();
        if let Some(plan) = &self.plan {
            self.scratch.backup.save(&mut self.state, plan, self.applied);
        }
        let report = std::mem::take(&mut self.report);
        self.events.clear();
        self.broken.clear();
        let result = work(self);
        if result.is_err() {
            self.applied = self.scratch.backup.restore(&mut self.state);
            self.report = report;
            self.events.clear();
            self.broken.clear();
            self.plan = None;
        }
        self.state.contacts.sleep.record(false);
        result
    }

    /// Calls `advance` for each stretch of time over which the steady forces stay the same.
    pub(super) fn each_span(
        &mut self,
        duration: Real,
        mut advance: impl FnMut(&mut Self, Span) -> Result<()>,
    ) -> Result<()> {
        let end = self.state.clock.after(duration);
        let substeps = self.state.settings.substeps;
        let mut start = self.state.clock;
        let mut rest = duration;
        while let Some(change) = self.next_change(start.now, rest) {
            let h = change - start.now;
            self.sum_steady_forces(start.now);
            advance(self, Span { start: start.now, end: change, duration: h, substeps })?;
            start = Clock { now: change, behind: 0.0 };
            rest -= h;
        }
        self.sum_steady_forces(start.now);
        advance(self, Span { start: start.now, end: end.now, duration: rest, substeps })?;
        self.state.clock = end;
        Ok(())
    }

    /// First change of a scheduled force within `rest` of a moment. A change that is nearer to either
    /// end than rounding counts as being there.
    fn next_change(&self, now: Real, rest: Real) -> Option<Real> {
        let sliver = 1e-12 * rest;
        let schedules = self.state.schedules.values().iter();
        let changes = schedules.filter_map(|schedule| schedule.forces.next_change(now + sliver));
        changes.reduce(Real::min).filter(|change| *change < now + rest - sliver)
    }

    /// Sums constant, applied and scheduled forces for the span that begins at a moment.
    fn sum_steady_forces(&mut self, now: Real) {
        let Self { state, scratch, applied, plan, .. } = self;
        let steady = &mut scratch.steady;
        steady.clear();
        let constant = plan.as_ref().is_some_and(|plan| plan.forces);
        if !constant && !*applied && state.schedules.values().is_empty() {
            return;
        }
        steady.extend_from_slice(&state.bodies.forces);
        if *applied {
            steady.iter_mut().zip(&state.bodies.applied).for_each(|(sum, own)| *sum += *own);
        }
        for schedule in state.schedules.values() {
            // What begins within rounding of now acts now.
            let moment = now + 4.0 * Real::EPSILON * now.abs();
            if let Ok(i) = state.bodies.index(schedule.body) {
                steady[i] += schedule.forces.at(moment);
            }
        }
    }

    /// Moves every body through a span at the fixed step.
    pub(super) fn advance_span(&mut self, span: Span) -> Result<()> {
        // First what touches, while bodies whose motion is given still stand where the step begins.
        self.advance_contacts(span)?;
        self.advance_joined(span)?;
        self.advance_closed(span.duration);
        let plan = self.plan.take().unwrap_or_default();
        let result = plan.runs().try_for_each(|run| {
            // What touches something is moved with it, below.
            if self.scratch.contacts.moves(run.start) {
                return Ok(());
            }
            self.advance_run(run, span, plan.resistance)
        });
        self.plan = Some(plan);
        result
    }

    /// Moves the bodies whose solution is known.
    pub(super) fn advance_closed(&mut self, h: Real) {
        let Self { state, scratch, plan, report, .. } = self;
        let State { bodies, settings, ledger, .. } = state;
        let Some(plan) = plan else { return };
        let steady = |i: usize| scratch.steady.get(i).copied().unwrap_or(Wrench::ZERO);
        let Bodies { poses, twists, masses, infos, .. } = bodies;
        let alone = |i: &&usize| !scratch.contacts.moves(**i);
        for &i in plan.closed.iter().filter(alone) {
            let force = Constant { mass: &masses[i], steady: steady(i), gravity: settings.gravity };
            force.advance(h, &mut poses[i], &mut twists[i], ledger);
        }
        for &i in plan.damped.iter().filter(alone) {
            let force = Constant { mass: &masses[i], steady: steady(i), gravity: settings.gravity };
            let damping = Damping::of(&masses[i], &infos[i], settings.air);
            force.advance_damped(h, &damping, (&mut poses[i], &mut twists[i]), ledger);
        }
        report.steps += u64::from(!plan.closed.is_empty() || !plan.damped.is_empty());
    }

    /// Moves a run of bodies by the world's method.
    fn advance_run(&mut self, run: Range<usize>, span: Span, resistance: bool) -> Result<()> {
        let method = self.method;
        let (mut system, mut motion, scratch) = self.split(run, resistance);
        method.run(&mut system, &mut motion, span, scratch)?;
        let evaluations = system.forces.evaluations;
        self.report.evaluations += evaluations;
        self.report.steps += u64::from(span.substeps);
        self.report.smallest_step = self.report.smallest_step.min(span.h());
        Ok(())
    }

    /// What a method needs for a run of bodies.
    pub(super) fn split(
        &mut self,
        run: Range<usize>,
        resistance: bool,
    ) -> (System<'_>, Motion<'_>, &mut crate::methods::Scratch) {
        let Self { state, scratch, fields, .. } = self;
        let State { bodies, settings, ledger, .. } = state;
        let Bodies { map, poses, twists, masses, infos, .. } = bodies;
        let steady = if scratch.steady.is_empty() { 0..0 } else { run.clone() };
        let forces = Forces {
            handles: map,
            masses: &masses[run.clone()],
            infos: &infos[run.clone()],
            members: &[],
            steady: &scratch.steady[steady],
            gravity: settings.gravity,
            air: settings.air,
            fields,
            resistance,
            buffers: &mut scratch.forces,
            shown: Shown::default(),
            evaluations: 0,
        };
        let motion = Motion { poses: &mut poses[run.clone()], twists: &mut twists[run], ledger };
        (System { forces, joints: None, modes: None }, motion, &mut scratch.methods)
    }

    /// Checks that the motion is finite, and forgets the forces that were applied for this step.
    pub(super) fn finish(&mut self, dt: Real) -> Result<()> {
        self.report.duration += dt;
        let Some(plan) = &self.plan else { return Ok(()) };
        let bodies = &self.state.bodies;
        if let Some(body) = plan.moving().find(|&i| !is_finite(bodies, i)) {
            let hint = "check forces, velocities and dt; the world is as before the call";
            let time = self.time();
            return Err(Error::NotFinite { time, what: "position or velocity", body, hint });
        }
        if plan.softs > 0 {
            self.finish_softs()?;
        }
        if std::mem::take(&mut self.applied) {
            self.state.bodies.applied.fill(Wrench::ZERO);
        }
        Ok(())
    }

    /// The same for deformable bodies; apart, so that worlds without them do not pay for it.
    #[cold]
    #[inline(never)]
    fn finish_softs(&mut self) -> Result<()> {
        if let Some(body) = self.soft_bodies().iter().position(|body| !body.is_finite()) {
            let (time, what) = (self.time(), "a node of the soft body");
            let hint = "check forces, velocities and dt; the world is as before the call";
            return Err(Error::NotFinite { time, what, body, hint });
        }
        self.notice_softs();
        Ok(())
    }
}

fn is_finite(bodies: &Bodies, i: usize) -> bool {
    let (pose, twist) = (&bodies.poses[i], &bodies.twists[i]);
    // One number stands for six: infinities and NaN survive a sum of absolute values.
    let sum = pose.position.x.abs() + pose.position.y.abs() + pose.angle.abs();
    (sum + twist.linear.x.abs() + twist.linear.y.abs() + twist.angular.abs()).is_finite()
}

impl StepReport {
    fn book_time(&mut self, name: &'static str, time: std::time::Duration) {
        let seconds = time.as_secs_f64();
        match self.stages.iter_mut().find(|stage| stage.name == name) {
            Some(stage) => stage.seconds += seconds,
            None => self.stages.push(crate::world::StageTime { name, seconds }),
        }
    }
}
