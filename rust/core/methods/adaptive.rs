//! Runs to a tolerance: steps as long as their error allows, by DOP853, or by Radau's method where the motion is stiff.

use crate::error::{Error, Result};
use crate::forces::Facets;
use crate::math::{Real, powf};
use crate::methods::control::{Control, Progress, Sink, Watch};
use crate::methods::dop853::{DENSE_STAGES, rates_seen, stages};
use crate::methods::dop853_dense::{Dense, first_kink};
use crate::methods::dop853_table::{E3, E5};
use crate::methods::first_order::{self, Columns};
use crate::methods::guard::{Guard, Stop};
use crate::methods::radau5::{Radau, Step};
use crate::methods::scale::Scales;
use crate::methods::step_size::{CALM, SAME, SOLVED, follow, predict, shrink, strict};
use crate::methods::stiffness::Choice;
use crate::methods::{Motion, Scratch, Span, System};

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

/// A run to a tolerance. Steps end where a body's silhouette has a kink: between kinks
/// forces are smooth, and the error of a step is what its estimate says.
pub struct Adaptive<'a> {
    control: &'a Control<'a>,
    scales: Scales,
    /// The same as they are if the step that is tried is accepted.
    trial: Scales,
    radau: Radau,
    choice: Choice,
    /// Whether the last attempt failed, or there was none: its errors may be those of a start.
    rough: bool,
    /// What the last attempt of Radau's cost, in evaluations.
    spent: Real,
    span: Span,
    next_sample: usize,
    may_grow: bool,
    turns_in_place: u32,
    /// Error of the last step over the tolerance, and its length (s).
    before: Option<(Real, Real)>,
    guard: Option<&'a mut dyn Guard>,
    progress: Progress,
}

/// Local error of a step over the tolerance: what is likely, and what the step is kept by.
#[derive(Clone, Copy, Debug, Default)]
struct StepError {
    likely: Real,
    most: Real,
}

impl<'a> Adaptive<'a> {
    /// Prepares a run over `span` (its number of substeps does not matter).
    #[must_use]
    pub fn new(control: &'a Control<'a>, motion: &Motion<'_>, span: Span) -> Self {
        let mut scales = Scales::default();
        scales.begin(motion.poses, control.sizes, span.duration);
        Self {
            control,
            trial: scales.clone(),
            scales,
            radau: Radau::default(),
            choice: Choice::new(3 * motion.poses.len(), true),
            rough: true,
            spent: 0.0,
            span,
            next_sample: 0,
            may_grow: true,
            turns_in_place: 0,
            before: None,
            guard: None,
            progress: Progress { smallest: Real::INFINITY, ..Progress::default() },
        }
    }

    /// Ends the run at the first event that a guard sees.
    #[must_use]
    pub fn guarded(self, guard: &'a mut dyn Guard) -> Self {
        // Guards look at the interpolant of DOP853.
        Self { guard: Some(guard), choice: Choice::new(0, false), ..self }
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
        let mut ahead = Ahead { h: self.first_step(y, system)?, ..Ahead::default() };
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
            let StepError { likely, most: error } = self.attempt(y, system, (time, h))?;
            if !error.is_finite() || error > 1.0 {
                ahead = Ahead { h: self.reject(h, error), ..Ahead::default() };
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
            let by_radau = self.choice.stiff;
            self.accept(y, h, likely);
            passed = if last { self.span.duration } else { passed + h };
            early = ahead.stopping.is_some();
            ahead.h = if by_radau == self.choice.stiff { self.next_step(h, error) } else { h };
            if by_radau && self.choose(h) {
                ahead.h = ahead.h.min(self.choice.longest());
            }
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
            && let Some((part, facets)) = self.first_kink(y, system, (time, h))?
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
        if !self.choice.stiff {
            let (before, _) = self.before.replace((error, h)).unwrap_or((error, h));
            return h * follow(error, before).min(most);
        }
        let before = self.before.replace((error, h));
        let change = predict(h, error, before, self.radau.iterations).min(most);
        // The factors are good for a step of the same length.
        if (1.0..SAME).contains(&change) { h } else { h * change }
    }

    /// Lets the air see the bodies' new facets, from the state on.
    fn turn(&self, y: &mut Columns, system: &mut System<'_>, time: Real, turn: Turn) -> Result<()> {
        system.forces.shown.show(turn.facets);
        y.slope_of_state(0, system, time)
    }

    /// A step over which velocities change little: tol^(1/8)·min |v|/|a|. What rests and has no size says nothing of that; then forces
    /// are asked where it would be after a step.
    fn first_step(&self, y: &mut Columns, system: &mut System<'_>) -> Result<Real> {
        let (poses, twists) = first_order::split(&y.state);
        let (_, accelerations) = first_order::split(&y.slopes[0]);
        let (mut time, mut unknown) = (self.span.duration, false);
        for i in 0..poses.len() {
            let (v, a) = (&twists[i], &accelerations[i]);
            let pairs = [
                (v.linear.norm(), a.linear.norm(), self.scales.size(i)),
                (v.angular.abs(), a.angular.abs(), 1.0),
            ];
            for (speed, change, length) in pairs.into_iter().filter(|pair| pair.1 > 0.0) {
                let own = (speed / change).max(libm::sqrt(length / change));
                unknown |= own == 0.0;
                time = if own > 0.0 { time.min(own) } else { time.min(self.span.duration / 100.0) };
            }
        }
        time *= powf(self.control.tolerance, 1.0 / 8.0);
        if unknown {
            y.combine(time, &[1.0]);
            y.slope_of_stage(1, system, self.span.start)?;
            let n = 3 * first_order::bodies(&y.state);
            let norm =
                |of: &dyn Fn(usize) -> Real| libm::sqrt((n..2 * n).map(|k| of(k) * of(k)).sum());
            let here = norm(&|k| y.slopes[0][k]);
            let change: Real = norm(&|k| y.slopes[1][k] - y.slopes[0][k]);
            if change > here {
                time *= here / change;
            }
        }
        Ok(time)
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

    /// Tries a step by the method that is chosen: its end goes to `y.stage`.
    fn attempt(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (time, h): (Real, Real),
    ) -> Result<StepError> {
        if !self.choice.stiff {
            stages(y, system, time, h)?;
            return Ok(self.error(y, h));
        }
        let step = Step { time, h, wanted: SOLVED * self.control.tolerance };
        let anew = self.rough.then(|| strict(self.control.tolerance));
        let before = (system.forces.evaluations, self.radau.cost);
        let mut error = StepError { likely: Real::INFINITY, most: Real::INFINITY };
        if self.radau.solve(y, system, (&self.scales, &mut self.trial), step)? {
            let found = self.radau.error(y, system, &self.trial, (step, anew))?;
            error.most = found / strict(self.control.tolerance);
            error.likely = error.most;
        }
        self.spent = (system.forces.evaluations - before.0) as Real + self.radau.cost - before.1;
        Ok(error)
    }

    /// The step that is tried after one that is not accepted.
    fn reject(&mut self, h: Real, error: Real) -> Real {
        self.progress.rejected += 1;
        self.may_grow = false;
        self.rough = true;
        let order = if self.choice.stiff { 4.0 } else { 8.0 };
        let change = if error.is_finite() { shrink(error, order) } else { 1.0 / 3.0 };
        let left = self.choose(0.0);
        if left { (h * change).min(self.choice.longest()) } else { h * change }
    }

    /// Takes in what an attempt of Radau's led to; returns whether it is left.
    fn choose(&mut self, passed: Real) -> bool {
        if !self.choice.stiff {
            return false;
        }
        let rate = self.radau.fastest_if_new();
        self.choice.attempted(self.spent, passed, rate);
        !self.choice.stiff
    }

    /// Local error of a step of DOP853: |h|·e₅²/√(e₅² + w²e₃²), e₅ and e₃ the largest over all bodies, so that the worst body keeps the
    /// tolerance, not the average one. w = 1 carries the trend from e₃ to e₅ on; the method's authors keep the step by
    /// w = 0.1.
    fn error(&mut self, y: &Columns, h: Real) -> StepError {
        self.trial.extend(&self.scales, [&y.state, &y.stage], h);
        let [e5, e3] = [&E5, &E3].map(|weights| {
            self.trial.worst(|component| -> Real {
                weights.iter().zip(&y.slopes).map(|(w, slope)| w * slope[component]).sum()
            })
        });
        if e5 == 0.0 && e3 == 0.0 {
            return StepError::default();
        }
        let blend =
            |weight: Real| h / self.control.tolerance * e5 * e5 / libm::hypot(e5, weight * e3);
        StepError { likely: blend(1.0), most: blend(0.1) }
    }

    /// As [`first_kink`], on the interpolant of the method that is chosen.
    fn first_kink(
        &self,
        y: &mut Columns,
        system: &mut System<'_>,
        (time, h): (Real, Real),
    ) -> Result<Option<(Real, Facets)>> {
        if self.choice.stiff {
            return Ok(first_kink(&|x| self.radau.at(&y.state, x), &system.forces));
        }
        let dense = Dense::new(y, system, time, h)?;
        Ok(first_kink(&|x| dense.at(x), &system.forces))
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
        let time = self.span.start + passed;
        while let Some(&at) = self.control.samples.get(self.next_sample).filter(|at| **at <= until)
        {
            let part = (at - passed) / h;
            let state = if self.choice.stiff {
                self.step_to_sample(y, system, (time, h), part)?
            } else {
                if dense.is_none() {
                    dense = Some(Dense::new(y, system, time, h)?);
                }
                dense.as_ref().map_or_else(Vec::new, |d| d.at(part))
            };
            let (poses, twists) = first_order::split(&state);
            sink(self.next_sample, poses, twists);
            self.next_sample += 1;
        }
        Ok(())
    }

    /// The state at a fraction of a step of Radau's, by a step of its own beside the run: the method's polynomial is of order 3 only.
    fn step_to_sample(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (time, h): (Real, Real),
        part: Real,
    ) -> Result<Vec<Real>> {
        if part >= 1.0 {
            return Ok(y.stage.clone());
        }
        if part <= 0.0 {
            return Ok(y.state.clone());
        }
        let end = y.stage.clone();
        let mut beside = self.radau.clone();
        beside.within();
        let step = Step { time, h: part * h, wanted: SOLVED * self.control.tolerance };
        let mut scales = self.trial.clone();
        if !beside.solve(y, system, (&self.trial, &mut scales), step)? {
            let why = "a step to a sample did not converge".into();
            return Err(self.gave_up(time, why));
        }
        let (poses, twists) = first_order::split_mut(&mut y.stage);
        system.settle(poses, twists);
        let state = std::mem::replace(&mut y.stage, end);
        Ok(state)
    }

    /// The end of the step becomes the state; its slope is the next step's first.
    fn accept(&mut self, y: &mut Columns, h: Real, likely: Real) {
        if self.choice.stiff {
            self.progress.stiff += 1;
            self.radau.accept();
            self.rough = false;
        } else if self.choice.looks() {
            self.choice.saw(h, rates_seen(y, h, |i| self.scales.size(i)));
            if self.choice.stiff {
                self.radau.forget();
                (self.rough, self.before) = (true, None);
            }
        }
        std::mem::swap(&mut self.scales, &mut self.trial);
        std::mem::swap(&mut y.state, &mut y.stage);
        y.slopes.swap(0, 12);
        self.turns_in_place = 0;
        self.progress.steps += 1;
        self.progress.smallest = self.progress.smallest.min(h);
        self.progress.estimate += likely * self.control.tolerance;
    }
}
