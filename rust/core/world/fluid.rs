//! Fluids in a world: adding and reading them, and their part in a step.

use super::backup::Start;
use super::plan::Meeting;
use super::step::MOST_TRIES;
use crate::body::{Bodies, BodyHandle};
use crate::error::{Error, Result, check};
use crate::fluid::{Flow, FluidHandle, Fluids, Material, Moving, Team};
use crate::math::{Real, Twist, Vec2, Wrench};
use crate::methods::Span;
use crate::world::{State, World};

mod accelerate;

use accelerate::Accelerator;

/// What the fluid's part of a step works with; no part of the state.
#[derive(Clone, Default)]
pub(super) struct WetScratch {
    flow: Flow,
    /// Before the substep at work.
    start: Start,
    /// Before the step at work.
    moving: Moving,
    /// Steady forces on bodies without those of the fluid.
    dry: Vec<Wrench>,
    /// The same that is expected in this substep, of each wet body.
    changes: Vec<Twist>,
    /// What the fluid did to each body in the last step (N·s).
    impulses: Vec<Twist>,
    /// How long that was (s).
    duration: Real,
    accelerator: Accelerator,
    /// The borders of bodies are known.
    looked: bool,
}

impl WetScratch {
    /// Forgets the borders of bodies that may have changed.
    pub fn forget(&mut self) {
        self.looked = false;
    }

    /// The threads that work on fluids.
    pub fn take_threads(&mut self) -> Team {
        std::mem::take(&mut self.flow.team)
    }

    /// Lets these work on fluids.
    pub fn give_threads(&mut self, team: Team) {
        self.flow.team = team;
    }
}

/// Most substeps that a step may ask for.
const MOST_PARTS: Real = 1e6;

/// How often the fluid and the contacts of the bodies are solved in turn in a substep.
const MOST_TURNS: u32 = 30;

/// Part of a body's change of velocity in the substep to which the two must agree.
const AGREED: Real = 1e-4;

/// Fluids.
impl World {
    /// Adds a fluid with particles at these points (m), at this distance from one another at rest (m). Fluids of a world
    /// have one spacing.
    ///
    /// # Errors
    /// Numbers that are not allowed, or another spacing than that of the fluids there are.
    pub fn add_fluid(
        &mut self,
        points: &[Vec2],
        spacing: Real,
        material: Material,
    ) -> Result<FluidHandle> {
        for (i, point) in points.iter().enumerate() {
            check::finite_vec(&format!("points[{i}]"), *point)?;
        }
        let fluids = self.fluids_mut();
        let fluid = fluids.add(None, material, spacing)?;
        fluids.pour(fluid, points, Vec2::zeros())?;
        Ok(fluid)
    }

    /// Energy (J) of the surfaces of fluids: at the start of the last substep, or now if the fluids were changed since.
    #[must_use]
    pub fn surface_energy(&self) -> Real {
        let State { fluids, bodies, .. } = &self.state;
        fluids.surface.unwrap_or_else(|| Flow::default().surface_energy(fluids, bodies))
    }

    /// Removes a fluid with all its particles.
    ///
    /// # Errors
    /// A handle to a fluid that is gone.
    pub fn remove_fluid(&mut self, fluid: FluidHandle) -> Result<()> {
        self.fluids_mut().remove(fluid)?;
        self.plan = None;
        Ok(())
    }

    /// The fluids, to read.
    #[must_use]
    pub fn fluids(&self) -> &Fluids {
        &self.state.fluids
    }

    /// The fluids, to change.
    pub fn fluids_mut(&mut self) -> &mut Fluids {
        self.plan = None;
        self.state.fluids.surface = None;
        &mut self.state.fluids
    }

    /// How many threads work on fluids: 1 unless set. The bits of a run are the same on any number.
    ///
    /// # Errors
    /// 0, more than 64, or more than the system gives.
    pub fn set_threads(&mut self, threads: u32) -> Result<()> {
        self.scratch.wet.flow.team = Team::new(threads)?;
        Ok(())
    }

    /// How many threads work on fluids.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.scratch.wet.flow.team.threads()
    }

    /// Mean force (N) and torque (N·m, about the centre of mass) of the fluids on a body in the last step.
    ///
    /// # Errors
    /// A handle to a body that is gone.
    pub fn fluid_load(&self, body: BodyHandle) -> Result<Wrench> {
        let index = self.state.bodies.index(body)?;
        let WetScratch { impulses, duration, .. } = &self.scratch.wet;
        let own = impulses.get(index).copied().unwrap_or(Twist::ZERO);
        let over = if *duration > 0.0 { 1.0 / duration } else { 0.0 };
        Ok(Wrench::new(own.linear * over, own.angular * over))
    }
}

/// The fluid's part of a step.
impl World {
    /// One step of a world with fluids: what bodies can meet is looked for once, as without fluids.
    #[cold]
    #[inline(never)]
    pub(super) fn wade(&mut self, dt: Real) -> Result<()> {
        self.stage("fluid", |world| world.wade_through(dt))
    }

    fn wade_through(&mut self, dt: Real) -> Result<()> {
        let wet = &mut self.scratch.wet;
        if !wet.looked {
            wet.flow.look(&self.state.bodies, self.state.fluids.spacing);
            wet.looked = true;
        }
        let bodies = self.state.bodies.len();
        let (hits, impacts) = (self.events.hit.len(), self.report.impacts);
        self.state.contacts.spread.clear();
        for tries in 1.. {
            self.detect_and_split(dt)?;
            if let Some(plan) = &self.plan {
                self.scratch.start.save(&self.state, plan);
                self.scratch.wet.moving.save(&self.state.fluids);
            }
            let wet = &mut self.scratch.wet;
            wet.impulses.clear();
            wet.impulses.resize(bodies, Twist::ZERO);
            wet.duration = dt;
            self.each_span(dt, Self::wade_span)?;
            let watched = self.scratch.contacts.watched;
            if !watched || self.scratch.contacts.thrown.is_empty() || tries == MOST_TRIES {
                break;
            }
            self.scratch.start.restore(&mut self.state);
            self.scratch.wet.moving.restore(&mut self.state.fluids);
            self.state.contacts.spread_out(&self.scratch.contacts.thrown);
            self.events.hit.truncate(hits);
            self.report.impacts = impacts;
        }
        Ok(())
    }

    fn detect_and_split(&mut self, dt: Real) -> Result<()> {
        if self.meets() {
            self.detect_all(dt)?;
        }
        if self.meets() || self.plan.as_ref().is_some_and(|plan| plan.joints > 0) {
            self.find_islands();
        }
        Ok(())
    }

    /// Moves all through a span, in substeps that no particle goes too far in.
    fn wade_span(&mut self, span: Span) -> Result<()> {
        let mut dry = std::mem::take(&mut self.scratch.wet.dry);
        dry.clone_from(&self.scratch.steady);
        let (mut start, mut rest) = (span.start, span.duration);
        let result = loop {
            let State { fluids, bodies, .. } = &self.state;
            let longest = self.scratch.wet.flow.longest(fluids, bodies, rest).min(span.h());
            // What rounding leaves is no substep of its own.
            let parts = (rest / longest - 1e-9).ceil().max(1.0);
            if parts.is_nan() || parts > MOST_PARTS {
                let hint = "the fluid or a body near it is too fast for its spacing; the world is as before the call";
                let time = self.time();
                break Err(Error::NotFinite { time, what: "substep", body: 0, hint });
            }
            let h = rest / parts;
            let last = parts == 1.0;
            let end = if last { span.end } else { start + h };
            let part = Span { start, end, duration: h, substeps: 1 };
            if let Err(error) = self.wade_part(part, &dry) {
                break Err(error);
            }
            (start, rest) = (end, rest - h);
            if last {
                break Ok(());
            }
        };
        self.scratch.steady.clone_from(&dry);
        self.scratch.wet.dry = dry;
        result
    }

    /// One substep: the fluid, and in turn with its pressures what else acts on the bodies, until they agree.
    fn wade_part(&mut self, span: Span, dry: &[Wrench]) -> Result<()> {
        let h = span.duration;
        let gravity = self.state.settings.gravity;
        let before = self.state.fluids.mechanical_energy(gravity);
        self.state.contacts.scale_impulses(h);
        let mut start = std::mem::take(&mut self.scratch.wet.start);
        if let Some(plan) = &self.plan {
            start.save(&self.state, plan);
        }
        let State { fluids, bodies, .. } = &mut self.state;
        let WetScratch { flow, accelerator, .. } = &mut self.scratch.wet;
        let surface = fluids.surface;
        flow.begin(fluids, bodies, (gravity, h));
        accelerator.begin();
        self.expect(dry, h);
        let hits = self.events.hit.len();
        let result = loop {
            let wet = &mut self.scratch.wet;
            wet.flow.press(&mut self.state.fluids, &wet.changes, h);
            self.load(dry, h);
            if let Err(error) = self.advance_span(span) {
                break Err(error);
            }
            if self.agrees(&start, h) {
                break Ok(());
            }
            start.restore(&mut self.state);
            self.events.hit.truncate(hits);
        };
        self.book(&start, h);
        self.scratch.wet.start = start;
        result?;
        let State { fluids, ledger, .. } = &mut self.state;
        let WetScratch { flow, .. } = &mut self.scratch.wet;
        flow.finish(fluids, h);
        let after = fluids.mechanical_energy(gravity);
        if let (Some(before), Some(now)) = (surface, fluids.surface) {
            ledger.dissipated += before - now;
        }
        ledger.work += flow.work;
        ledger.dissipated += before - after + flow.work;
        if fluids.streams() {
            fluids.exchange(h, span.end);
            ledger.work += fluids.mechanical_energy(gravity) - after;
        }
        let effort = std::mem::take(&mut flow.effort);
        self.report.solves += u64::from(effort.iterations);
        self.report.steps += 1;
        self.report.smallest_step = self.report.smallest_step.min(h);
        Ok(())
    }

    /// What all but the fluid is expected to do to the wet bodies: as in the last substep, or gravity and steady forces.
    fn expect(&mut self, dry: &[Wrench], h: Real) {
        let Self { state, scratch, .. } = self;
        let Bodies { masses, .. } = &state.bodies;
        let WetScratch { flow, changes, .. } = &mut scratch.wet;
        let others = &mut state.fluids.others;
        if others.len() != masses.len() {
            others.clear();
            others.extend(masses.iter().enumerate().map(|(i, mass)| {
                let mut own = mass.acceleration(&dry.get(i).copied().unwrap_or(Wrench::ZERO));
                if mass.is_free() {
                    own.linear += state.settings.gravity.component_mul(&mass.gravity_scale);
                }
                own
            }));
        }
        changes.clear();
        changes.extend(flow.touches.wet.iter().map(|wet| {
            let own = &others[wet.body as usize];
            Twist::new(own.linear * h, own.angular * h)
        }));
    }

    /// Adds the fluid's impulses to the steady forces.
    fn load(&mut self, dry: &[Wrench], h: Real) {
        let steady = &mut self.scratch.steady;
        steady.clear();
        steady.extend_from_slice(dry);
        steady.resize(self.state.bodies.len(), Wrench::ZERO);
        let flow = &self.scratch.wet.flow;
        for (wet, impulse) in flow.touches.wet.iter().zip(&flow.impulses) {
            steady[wet.body as usize] += Wrench::new(impulse.linear / h, impulse.angular / h);
        }
    }

    /// Whether the bodies moved as the fluid was told. If not, says better what it should be told.
    fn agrees(&mut self, start: &Start, h: Real) -> bool {
        let Self { state, scratch, report, .. } = self;
        let Bodies { twists, masses, infos, .. } = &state.bodies;
        let WetScratch { flow, changes, accelerator, .. } = &mut scratch.wet;
        let others = &mut state.fluids.others;
        let gravity = state.settings.gravity.norm() * h;
        let (mut worst, mut all): (Real, bool) = (0.0, true);
        accelerator.clear();
        for (k, wet) in flow.touches.wet.iter().enumerate() {
            let i = wet.body as usize;
            let before = start.twist(i).unwrap_or(twists[i]);
            let given = wet.response(&flow.impulses[k]);
            let linear = twists[i].linear - before.linear - given.linear;
            let angular = twists[i].angular - before.angular - given.angular;
            let wrong = Twist::new(linear - changes[k].linear, angular - changes[k].angular);
            let size = infos[i].size;
            let off = wrong.linear.norm() + size * wrong.angular.abs();
            let scale = gravity
                + given.linear.norm()
                + linear.norm()
                + size * (given.angular.abs() + angular.abs());
            all &= off <= AGREED * scale;
            worst = worst.max(off);
            others[i] = Twist::new(linear / h, angular / h);
            accelerator.add(&changes[k], &wrong, (masses[i].mass, masses[i].inertia));
        }
        report.residual = report.residual.max(worst);
        if all || accelerator.turns() >= MOST_TURNS {
            return true;
        }
        accelerator.next(changes);
        false
    }

    /// Books what the fluid did to each body: it is the fluid's own energy, not work from outside.
    fn book(&mut self, start: &Start, h: Real) {
        let State { bodies, ledger, .. } = &mut self.state;
        let WetScratch { flow, impulses, .. } = &mut self.scratch.wet;
        for (wet, impulse) in flow.touches.wet.iter().zip(&flow.impulses) {
            let i = wet.body as usize;
            impulses[i] += *impulse;
            let Some(pose) = start.pose(i) else { continue };
            let way = bodies.poses[i].position - pose.position;
            let turn = bodies.poses[i].angle - pose.angle;
            let work = (impulse.linear.dot(&way) + impulse.angular * turn) / h;
            ledger.work -= work;
            ledger.dissipated -= work;
        }
    }

    /// Whether there is a fluid.
    pub(super) fn is_wet(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.meeting == Meeting::Fluid)
    }
}
