//! DOP853: Dormand and Prince's Runge–Kutta method of order 8 with error control and dense output.
//!
//! E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I" (1993),
//! sections II.5 (method, error estimate eq. 10.17) and II.6 (dense output).

use crate::error::{Error, Result};
use crate::forces::{BoxError, Facets};
use crate::math::{Pose, Real, Twist, powf};
use crate::methods::dop853_dense::{Dense, first_kink};
use crate::methods::dop853_table::{A, C, E3, E5};
use crate::methods::first_order::{self, Columns};
use crate::methods::guard::{Guard, Stop};
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

/// Slopes of a step, its end included.
pub const STAGES: usize = 13;
/// Slopes with those that only dense output needs.
pub const DENSE_STAGES: usize = 16;

pub struct Dop853;

static FACTS: Facts = Facts {
    name: "dop853",
    order: 8,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: true,
    adaptive: true,
    joints: true,
    contacts: false,
    about: "Dormand and Prince's method of order 8; with a tolerance it chooses its own step",
};

impl Method for Dop853 {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let y = &mut scratch.flat;
        y.load(motion, DENSE_STAGES);
        y.settle_state(system, motion);
        for k in 0..span.substeps {
            y.slope_of_state(0, system, span.time(k))?;
            stages(y, system, span.time(k), span.h())?;
            y.settle_stage(system, motion);
            std::mem::swap(&mut y.state, &mut y.stage);
        }
        y.store(motion);
        Ok(())
    }
}

/// Slopes 1 to 11 and, in `y.stage`, the state at the end of a step whose slope 0 is there.
fn stages(y: &mut Columns, system: &mut System<'_>, time: Real, h: Real) -> Result<()> {
    for j in 1..12 {
        y.combine(h, A[j]);
        y.slope_of_stage(j, system, time + C[j] * h)?;
    }
    y.combine(h, A[12]);
    Ok(())
}

/// Takes samples of a run: the number of the sample, and the state of the run's bodies there.
pub type Sink<'a> = dyn FnMut(usize, &[Pose], &[Twist]) + 'a;

/// Is asked at every step whether to go on; an error stops the run.
pub type Watch<'a> = dyn FnMut() -> std::result::Result<(), BoxError> + 'a;

/// What a run to a tolerance is asked for.
pub struct Control<'a> {
    /// Largest local error of a step, relative to the body's size or the way it went (positions), a
    /// radian (angles), and the largest speeds so far.
    pub tolerance: Real,
    /// Sizes ℓ of the bodies (m).
    pub sizes: &'a dyn Fn(usize) -> Real,
    /// Moments at which the state is wanted, in seconds from the start of the span, increasing.
    pub samples: &'a [Real],
}

/// What a run to a tolerance took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Steps accepted.
    pub steps: u64,
    /// Steps tried again because their error was too large.
    pub rejected: u64,
    /// Smallest step accepted (s); infinite where there was none.
    pub smallest: Real,
    /// Sum of the local errors, in the units of the tolerance.
    pub estimate: Real,
}

/// A kink at which a step ends: what the air sees from there on, and the step that would have been.
struct Turn {
    facets: Facets,
    whole_step: Real,
}

/// The step that is next.
#[derive(Default)]
struct Ahead {
    h: Real,
    /// The kink at which it ends.
    turn: Option<Turn>,
    /// It ends at an event; how often its length was corrected.
    stopping: Option<u32>,
}

/// A kink this part of a step away from its start is there already.
const IN_PLACE: Real = 1e-9;
/// Turns in place before a step is made all the same: a body at rest in the air turns with every rounding.
const TURNS_IN_PLACE: u32 = 4;

/// How often a step that is to end at an event is made anew with a better length.
const CORRECTIONS: u32 = 3;

/// Steps that are tried in one run before the tolerance is said to be out of reach: no call goes on for days unasked.
const MOST_STEPS: u64 = 1_000_000;

/// A run of DOP853 to a tolerance. Steps end where a body's silhouette has a kink: between kinks
/// forces are smooth, and the error of a step is what its estimate says.
pub struct Adaptive<'a> {
    control: &'a Control<'a>,
    scales: Vec<Scale>,
    span: Span,
    next_sample: usize,
    may_grow: bool,
    turns_in_place: u32,
    /// Error of the last step over the tolerance.
    error_before: Option<Real>,
    guard: Option<&'a mut dyn Guard>,
    progress: Progress,
}

/// Local error of a step over the tolerance: what is likely, and what the step is kept by.
#[derive(Clone, Copy, Debug, Default)]
struct StepError {
    likely: Real,
    most: Real,
}

/// What the error of a body is measured against.
#[derive(Clone, Copy, Debug)]
struct Scale {
    start: Pose,
    size: Real,
    length: Real,
    angle: Real,
    speed: Real,
    spin: Real,
}

impl<'a> Adaptive<'a> {
    /// Prepares a run over `span` (its number of substeps does not matter).
    #[must_use]
    pub fn new(control: &'a Control<'a>, motion: &Motion<'_>, span: Span) -> Self {
        let scale = |(i, start): (usize, &Pose)| {
            let size = (control.sizes)(i);
            Scale { start: *start, size, length: size, angle: 1.0, speed: 0.0, spin: 0.0 }
        };
        Self {
            control,
            scales: motion.poses.iter().enumerate().map(scale).collect(),
            span,
            next_sample: 0,
            may_grow: true,
            turns_in_place: 0,
            error_before: None,
            guard: None,
            progress: Progress { smallest: Real::INFINITY, ..Progress::default() },
        }
    }

    /// Ends the run at the first event that a guard sees.
    #[must_use]
    pub fn guarded(self, guard: &'a mut dyn Guard) -> Self {
        Self { guard: Some(guard), ..self }
    }

    /// Runs to the end of the span; `sink` is called with the number of each sample and the state there.
    ///
    /// # Errors
    /// Those of the user's fields; [`Error::Tolerance`] where no step is small enough;
    /// [`Error::Interrupted`] with what `watch` said.
    pub fn run(
        self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        scratch: &mut Scratch,
        handlers: (&mut Sink<'_>, &mut Watch<'_>),
    ) -> Result<Progress> {
        self.run_on(system, motion, scratch, handlers).map(|(progress, _)| progress)
    }

    /// The same, and where it ended.
    ///
    /// # Errors
    /// Those of [`Adaptive::run`], and of the guard.
    pub fn run_on(
        mut self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        scratch: &mut Scratch,
        (sink, watch): (&mut Sink<'_>, &mut Watch<'_>),
    ) -> Result<(Progress, Stop)> {
        let y = &mut scratch.flat;
        y.load(motion, DENSE_STAGES);
        y.settle_state(system, motion);
        let start =
            Turn { facets: system.forces.facets_of(motion.poses, motion.twists), whole_step: 0.0 };
        self.turn(y, system, self.span.start, start)?;
        let (mut passed, mut tries, mut early) = (0.0, 0, false);
        let mut ahead = Ahead { h: self.first_step(y), ..Ahead::default() };
        while passed < self.span.duration && !early {
            tries += 1;
            self.refuse_many(tries, passed)?;
            watch().map_err(|source| Error::Interrupted { source })?;
            let rest = self.span.duration - passed;
            // A last step that would leave a sliver takes it along.
            let last = ahead.h >= rest * (1.0 - 1e-10);
            let h = if last { rest } else { ahead.h.min(rest) };
            let time = self.span.start + passed;
            self.refuse_tiny(h, passed)?;
            system.forces.shown.kinked = false;
            stages(y, system, time, h)?;
            let StepError { likely, most: error } = self.error(y, h);
            if !error.is_finite() || error > 1.0 {
                self.progress.rejected += 1;
                self.may_grow = false;
                let change = if error.is_finite() { shrink(error) } else { 1.0 / 3.0 };
                ahead = Ahead { h: h * change, ..Ahead::default() };
                continue;
            }
            let end = if last { self.span.end } else { time + h };
            let booked = motion.ledger.correction_work;
            // Before its slope is taken, so that the next step and dense output go on from there.
            y.settle_stage(system, motion);
            y.slope_of_stage(12, system, end)?;
            ahead.h = h;
            if self.shorten(y, system, time, &mut ahead)? {
                motion.ledger.correction_work = booked;
                early = self.refuse_tiny(ahead.h, passed).is_err() && ahead.stopping.is_some();
                continue;
            }
            self.sample(y, system, (passed, h, last), sink)?;
            self.accept(y, h, likely);
            passed = if last { self.span.duration } else { passed + h };
            early = ahead.stopping.is_some();
            ahead.h = self.next_step(h, error);
            if let Some(kink) = ahead.turn.take() {
                ahead.h = kink.whole_step;
                self.turn(y, system, end, kink)?;
            }
        }
        y.store(motion);
        Ok((self.progress, Stop { passed, samples: self.next_sample, early }))
    }

    /// Makes a step end at the first kink in it, or at the first event; whether it has to be made anew.
    fn shorten(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        time: Real,
        ahead: &mut Ahead,
    ) -> Result<bool> {
        let h = ahead.h;
        if system.forces.shown.kinked
            && ahead.stopping.is_none()
            && ahead.turn.is_none()
            && self.turns_in_place < TURNS_IN_PLACE
            && let Some((part, facets)) = first_kink(y, system, (time, h))?
        {
            let kink = Turn { facets, whole_step: h };
            if part > IN_PLACE {
                ahead.turn = Some(kink);
                ahead.h *= part;
            } else {
                self.turns_in_place += 1;
                self.turn(y, system, time, kink)?;
            }
            return Ok(true);
        }
        let Some(guard) = &mut self.guard else { return Ok(false) };
        let (corrected, until) = if let Some(corrected) = ahead.stopping {
            let change = guard.correct(y, system, (time, h))?;
            if change.abs() <= Real::EPSILON * h || corrected >= CORRECTIONS {
                return Ok(false);
            }
            (corrected + 1, h + change)
        } else {
            let Some(part) = guard.first(y, system, (time, h))? else { return Ok(false) };
            (0, part * h)
        };
        *ahead = Ahead { h: until, turn: None, stopping: Some(corrected) };
        Ok(true)
    }

    /// The step after one of length h.
    fn next_step(&mut self, h: Real, error: Real) -> Real {
        // Not right after a rejection: the error that was too large is still near.
        let most = if self.may_grow { Real::INFINITY } else { 1.0 };
        self.may_grow = true;
        let error = error.max(CALM);
        let before = self.error_before.replace(error).unwrap_or(error);
        h * follow(error, before).min(most)
    }

    /// Lets the air see the bodies' new facets, from the state on.
    fn turn(&self, y: &mut Columns, system: &mut System<'_>, time: Real, turn: Turn) -> Result<()> {
        system.forces.shown.show(turn.facets);
        y.slope_of_state(0, system, time)
    }

    /// A step over which velocities change little: tol^(1/8)·min |v|/|a|.
    fn first_step(&self, y: &Columns) -> Real {
        let (poses, twists) = first_order::split(&y.state);
        let (_, accelerations) = first_order::split(&y.slopes[0]);
        let mut time = self.span.duration;
        for i in 0..poses.len() {
            let (v, a) = (&twists[i], &accelerations[i]);
            let pairs = [
                (v.linear.norm(), a.linear.norm(), self.scales[i].size),
                (v.angular.abs(), a.angular.abs(), 1.0),
            ];
            for (speed, change, length) in pairs.into_iter().filter(|pair| pair.1 > 0.0) {
                let own = (speed / change).max(libm::sqrt(length / change));
                time = if own > 0.0 { time.min(own) } else { time.min(self.span.duration / 100.0) };
            }
        }
        time * powf(self.control.tolerance, 1.0 / 8.0)
    }

    /// No step that the world's time or the numbers of the state no longer resolve.
    fn refuse_tiny(&self, h: Real, passed: Real) -> Result<()> {
        let time = self.span.start + passed;
        if h > 8.0 * Real::EPSILON * time.abs().max(self.span.duration) {
            return Ok(());
        }
        Err(self.gave_up(
            time,
            format!(
                "the step fell to {h:.1e} s after {} steps; a larger tolerance, or a force without jumps, would do",
                self.progress.steps
            ),
        ))
    }

    /// No more steps in a run than anyone waits for.
    fn refuse_many(&self, tries: u64, passed: Real) -> Result<()> {
        if tries <= MOST_STEPS {
            return Ok(());
        }
        let why = format!(
            "{MOST_STEPS} steps led {passed:.1e} s of {:.1e} s far; ask for less at once",
            self.span.duration
        );
        Err(self.gave_up(self.span.start + passed, why))
    }

    fn gave_up(&self, time: Real, why: String) -> Error {
        Error::Tolerance { tolerance: self.control.tolerance, time, why }
    }

    /// Local error of a step: |h|·e₅²/√(e₅² + w²e₃²), e₅ and e₃ the largest over all bodies, so that the worst body keeps the
    /// tolerance, not the average one. w = 1 carries the trend from e₃ to e₅ on; the method's authors keep the step by
    /// w = 0.1.
    fn error(&mut self, y: &Columns, h: Real) -> StepError {
        let n = first_order::bodies(&y.state);
        let (poses, twists) = first_order::split(&y.state);
        let (new_poses, new_twists) = first_order::split(&y.stage);
        let mut worst = [0.0; 2];
        for i in 0..n {
            let scale = &mut self.scales[i];
            scale.grow(&poses[i], &twists[i], h);
            scale.grow(&new_poses[i], &new_twists[i], h);
            for (worst, weights) in worst.iter_mut().zip([&E5, &E3]) {
                let error = |component: usize| -> Real {
                    weights.iter().zip(&y.slopes).map(|(w, slope)| w * slope[component]).sum()
                };
                *worst = Real::max(*worst, scale.relative(i, n, self.span.duration, error));
            }
        }
        let [e5, e3] = worst;
        if e5 == 0.0 && e3 == 0.0 {
            return StepError::default();
        }
        let blend =
            |weight: Real| h / self.control.tolerance * e5 * e5 / libm::hypot(e5, weight * e3);
        StepError { likely: blend(1.0), most: blend(0.1) }
    }

    /// Hands out the samples that fall into the step.
    fn sample(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (passed, h, last): (Real, Real, bool),
        sink: &mut Sink<'_>,
    ) -> Result<()> {
        let until = if last { Real::INFINITY } else { passed + h };
        let mut dense: Option<Dense> = None;
        while let Some(&at) = self.control.samples.get(self.next_sample).filter(|at| **at <= until)
        {
            if dense.is_none() {
                dense = Some(Dense::new(y, system, self.span.start + passed, h)?);
            }
            let state = dense.as_ref().map_or_else(Vec::new, |d| d.at((at - passed) / h));
            let (poses, twists) = first_order::split(&state);
            sink(self.next_sample, poses, twists);
            self.next_sample += 1;
        }
        Ok(())
    }

    /// The end of the step becomes the state; its slope is the next step's first.
    fn accept(&mut self, y: &mut Columns, h: Real, likely: Real) {
        std::mem::swap(&mut y.state, &mut y.stage);
        y.slopes.swap(0, 12);
        self.turns_in_place = 0;
        self.progress.steps += 1;
        self.progress.smallest = self.progress.smallest.min(h);
        self.progress.estimate += likely * self.control.tolerance;
    }
}

/// An error below this part of the tolerance says no more than that the step may grow.
const CALM: Real = 1e-4;

/// Factor from a step to the next by its error and by that of the step before: 0.9·error^(−0.7/8)·before^(0.4/8)
/// within [1/3, 6]. It takes the trend along, so that few steps are rejected where errors change fast.
///
/// Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.2, (2.43c): a PI controller.
fn follow(error: Real, before: Real) -> Real {
    (0.9 * powf(error, -0.7 / 8.0) * powf(before, 0.4 / 8.0)).clamp(1.0 / 3.0, 6.0)
}

/// Factor from a step that is rejected to the one that is tried instead: 0.9·error^(−1/8), not below 1/3.
fn shrink(error: Real) -> Real {
    (0.9 * powf(error, -1.0 / 8.0)).max(1.0 / 3.0)
}

impl Scale {
    /// The way and the speeds grow with the run; nothing here depends on where the origin is.
    fn grow(&mut self, pose: &Pose, twist: &Twist, h: Real) {
        let way = (pose.position - self.start.position).norm();
        self.length = self.length.max(way).max(twist.linear.norm() * h);
        self.angle = self.angle.max((pose.angle - self.start.angle).abs());
        self.speed = self.speed.max(twist.linear.norm()).max(self.size * twist.angular.abs());
        self.spin = self.spin.max(twist.angular.abs());
    }

    /// Largest relative error of body i of n. Speeds also count against a length over the whole
    /// duration, so that a body that rests but for rounding does not ask for tiny steps.
    fn relative(&self, i: usize, n: usize, duration: Real, error: impl Fn(usize) -> Real) -> Real {
        let (q, v) = (3 * i, 3 * (n + i));
        let speed = self.speed.max(self.length / duration);
        let spin = self.spin.max(self.angle / duration);
        let parts = [
            (libm::hypot(error(q), error(q + 1)), self.length),
            (error(q + 2).abs(), self.angle),
            (libm::hypot(error(v), error(v + 1)), speed),
            (error(v + 2).abs(), spin),
        ];
        let relative = |(e, scale): (Real, Real)| if e == 0.0 { 0.0 } else { e / scale };
        parts.into_iter().map(relative).fold(0.0, Real::max)
    }
}
