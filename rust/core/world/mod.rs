//! The [`World`]: one object that owns everything.

mod advance;
mod backup;
mod bodies;
mod colliding;
mod columns;
mod contacts;
mod fluid;
mod joints;
mod plan;
mod queries;
mod report;
mod sleep;
mod snapshot;
mod soft;
mod step;
mod stepper;

pub use bodies::{BodyMut, BodyRef};
pub use columns::Column;
pub use contacts::{Contact, ContactEvent, ContactHooks, Events, PreSolve, ShapeView};
pub use joints::{BrokenJoint, JointRef, SpringMotion};
pub use plan::Plan;
pub use queries::{Nearest, QueryFilter, RayHit, ShapeId, distance_between};
pub use report::{StageTime, StepReport, Trajectory};
pub use snapshot::Snapshot;
pub use soft::{NearestSoft, SoftContact, SoftEvents, SoftFilter, SoftRayHit, Touched};
pub use stepper::{Frame, Stepper};

use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use crate::arena::{Arena, HandleMap};
use crate::body::{Bodies, ImpactLaw, Mixing};
use crate::error::{Error, Result, check};
use crate::fluid::Fluids;
use crate::forces::{Air, Field, FieldHandle, ForceBuffers, ForceField, ForceSchedule, Ledger};
use crate::forces::{Schedule, ScheduleHandle};
use crate::joint::Joint;
use crate::math::{Real, Vec2, vec2};
use crate::methods::{self, Method, Scratch};
use crate::solvers::Solver;

/// What holds for the whole world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Gravity (m/s²).
    pub gravity: Vec2,
    /// The air.
    pub air: Air,
    /// Name of the method that moves bodies at a fixed step.
    pub method: String,
    /// Into how many equal substeps a step is divided.
    pub substeps: u32,
    /// Bodies under constant forces take the exact solution, whatever the method.
    pub closed_form: bool,
    /// What two surfaces make of their coefficients together.
    pub mixing: Mixing,
    /// What restitution is a ratio of.
    pub impact_law: ImpactLaw,
    /// Most sweeps over the rows of contacts a substep; fewer where they settle sooner.
    pub sweeps: u32,
    /// How the rows of contacts and joints are solved.
    pub solver: Solver,
    /// Bodies that have come to rest are left out of the work until something wakes them.
    pub sleeping: bool,
    /// Each stage of a step is timed. Costs about as much as the step of one free body.
    pub timing: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: vec2(0.0, -9.81),
            air: Air::default(),
            method: "leapfrog".into(),
            substeps: 4,
            closed_form: true,
            mixing: Mixing::default(),
            impact_law: ImpactLaw::Newton,
            sweeps: 8,
            solver: Solver::default(),
            sleeping: false,
            timing: false,
        }
    }
}

/// World time with the part that a sum in floating point leaves behind (Kahan), so that a million
/// steps of 1/60 s end where they should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Clock {
    now: Real,
    behind: Real,
}

impl Clock {
    fn after(self, h: Real) -> Self {
        let step = h - self.behind;
        let now = self.now + step;
        Self { now, behind: (now - self.now) - step }
    }
}

/// All of a world that a snapshot holds, the user's own fields apart.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct State {
    settings: Settings,
    bodies: Bodies,
    contacts: contacts::Contacts,
    joints: Arena<Joint>,
    fluids: Fluids,
    softs: soft::Softs,
    schedules: Arena<Schedule>,
    field_map: HandleMap<Field>,
    clock: Clock,
    ledger: Ledger,
}

/// Bodies, and the laws they move by.
///
/// ```
/// use culbuto::{BodyDef, World, math::vec2, shapes::Shape};
///
/// let mut world = World::new(vec2(0.0, -9.81))?;
/// let ball = BodyDef { velocity: vec2(12.0, 9.0), ..BodyDef::new(Shape::circle(0.1)?) };
/// let ball = world.add_body(ball)?;
/// world.steps(1.0 / 60.0, 120)?;
/// let position = world.body(ball)?.position();
/// assert!((position - vec2(24.0, -1.62)).norm() < 1e-12);
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone)]
pub struct World {
    state: State,
    fields: Vec<Arc<dyn ForceField>>,
    hooks: Option<Arc<dyn ContactHooks>>,
    method: &'static dyn Method,
    plan: Option<Plan>,
    /// Some body has a force for the next step.
    applied: bool,
    report: StepReport,
    events: Events,
    broken: Vec<BrokenJoint>,
    scratch: WorldScratch,
    /// What has left the boxes of detection; found when a query asks for it. No part of the state, so that
    /// queries change nothing of what steps do.
    strays: OnceLock<contacts::Strays>,
}

/// Columns a step works in; no part of the state.
#[derive(Clone, Default)]
struct WorldScratch {
    backup: backup::Backup,
    start: backup::Start,
    steady: Vec<crate::math::Wrench>,
    forces: ForceBuffers,
    methods: Scratch,
    contacts: contacts::ContactScratch,
    joined: joints::JoinedScratch,
    wet: fluid::WetScratch,
    soft: soft::SoftScratch,
}

impl Default for World {
    fn default() -> Self {
        let state = State::default();
        // OK because the default names a method of the registry.
        let method = methods::method(&state.settings.method).unwrap_or(methods::REGISTRY[0]);
        Self::from_state(state, Vec::new(), method)
    }
}

impl std::fmt::Debug for World {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("World")
            .field("time", &self.time())
            .field("bodies", &self.bodies().len())
            .field("settings", self.settings())
            .finish_non_exhaustive()
    }
}

/// Making a world, and what holds for all of it.
impl World {
    /// An empty world with this gravity (m/s²).
    pub fn new(gravity: Vec2) -> Result<Self> {
        let mut world = Self::default();
        world.set_gravity(gravity)?;
        Ok(world)
    }

    fn from_state(
        state: State,
        fields: Vec<Arc<dyn ForceField>>,
        method: &'static dyn Method,
    ) -> Self {
        let applied =
            state.bodies.applied.iter().any(|wrench| *wrench != crate::math::Wrench::ZERO);
        Self {
            state,
            fields,
            hooks: None,
            method,
            plan: None,
            applied,
            report: StepReport::default(),
            events: Events::default(),
            broken: Vec::new(),
            scratch: WorldScratch::default(),
            strays: OnceLock::new(),
        }
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.state.settings
    }

    /// World time (s).
    #[must_use]
    pub fn time(&self) -> Real {
        self.state.clock.now
    }

    /// Sets the world time (s). Schedules and fields that depend on time go by it.
    pub fn set_time(&mut self, time: Real) -> Result<()> {
        self.state.clock = Clock { now: check::finite("time", time)?, behind: 0.0 };
        Ok(())
    }

    /// World time, and what the clock knows beyond its last digit (s).
    pub(crate) fn clock(&self) -> (Real, Real) {
        (self.state.clock.now, self.state.clock.behind)
    }

    /// Sets what [`World::clock`] gives.
    pub(crate) fn set_clock(&mut self, time: Real, remainder: Real) -> Result<()> {
        self.set_time(time)?;
        self.state.clock.behind = check::finite("time_remainder", remainder)?;
        Ok(())
    }

    /// Sets gravity (m/s²).
    pub fn set_gravity(&mut self, gravity: Vec2) -> Result<()> {
        self.state.settings.gravity = check::finite_vec("gravity", gravity)?;
        self.wake_all();
        Ok(())
    }

    /// Sets the air: its density (kg/m²) and its velocity (m/s).
    pub fn set_air(&mut self, air: Air) -> Result<()> {
        check::not_negative("air density", air.density)?;
        check::finite_vec("wind", air.wind)?;
        self.state.settings.air = air;
        self.wake_all();
        self.plan = None;
        Ok(())
    }

    /// Most sweeps over the rows of contacts a substep (1 to 10 000).
    pub fn set_sweeps(&mut self, sweeps: u32) -> Result<()> {
        if !(1..=10_000).contains(&sweeps) {
            return Err(Error::invalid("sweeps", sweeps, "1 to 10000"));
        }
        self.state.settings.sweeps = sweeps;
        Ok(())
    }

    /// Chooses how the rows of contacts and joints are solved.
    pub fn set_solver(&mut self, solver: Solver) {
        self.state.settings.solver = solver;
        self.wake_all();
    }

    /// Chooses the method of fixed steps by name; [`methods::REGISTRY`] lists them.
    pub fn set_method(&mut self, name: &str) -> Result<()> {
        self.use_method(methods::method(name)?);
        Ok(())
    }

    /// The same by the method itself, which may be one of your own. Snapshots in memory keep it; bytes and scene files name it, and
    /// can only be read where the registry has the name.
    pub fn use_method(&mut self, method: &'static dyn Method) {
        self.method = method;
        method.facts().name.clone_into(&mut self.state.settings.method);
        self.plan = None;
    }

    /// Into how many equal substeps a step is divided (1 to 65536).
    pub fn set_substeps(&mut self, substeps: u32) -> Result<()> {
        if !(1..=65_536).contains(&substeps) {
            return Err(Error::invalid("substeps", substeps, "1 to 65536"));
        }
        self.state.settings.substeps = substeps;
        Ok(())
    }

    /// Whether bodies under constant forces take the exact solution (default), whatever the method.
    /// Off, the method moves them too, with the errors it has: for teaching.
    pub fn set_closed_form(&mut self, on: bool) {
        self.state.settings.closed_form = on;
        self.plan = None;
    }

    /// Sets what two surfaces make of their coefficients together.
    ///
    /// # Errors
    /// [`Error::Invalid`] names the pair of materials that is not allowed.
    pub fn set_mixing(&mut self, mixing: Mixing) -> Result<()> {
        mixing.validated()?;
        self.state.settings.mixing = mixing;
        self.wake_all();
        self.plan = None;
        Ok(())
    }

    /// Chooses what restitution is a ratio of.
    pub fn set_impact_law(&mut self, law: ImpactLaw) {
        self.state.settings.impact_law = law;
        self.plan = None;
    }

    /// Whether bodies that have come to rest are left out of the work until something wakes them. Their last energy
    /// counts as dissipated. Steps put bodies to sleep, [`World::advance`] only wakes them. Setting it wakes all bodies.
    pub fn set_sleeping(&mut self, on: bool) {
        self.state.settings.sleeping = on;
        self.wake_all();
        self.plan = None;
    }

    /// Whether each stage of a step is timed.
    pub fn set_timing(&mut self, on: bool) {
        self.state.settings.timing = on;
    }

    /// The bodies' columns, to read.
    #[must_use]
    pub fn bodies(&self) -> &Bodies {
        &self.state.bodies
    }

    /// Work and dissipation since the world was made.
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        self.state.ledger
    }

    /// What the last step or run took.
    #[must_use]
    pub fn report(&self) -> &StepReport {
        &self.report
    }
}

/// Forces beyond gravity.
impl World {
    /// Adds a field of force. It acts on all bodies, which then move as one island.
    pub fn add_field(&mut self, field: impl ForceField + 'static) -> FieldHandle {
        self.add_shared_field(Arc::new(field))
    }

    /// Adds a field that is shared with others.
    pub fn add_shared_field(&mut self, field: Arc<dyn ForceField>) -> FieldHandle {
        self.fields.push(field);
        self.wake_all();
        self.plan = None;
        self.state.field_map.insert()
    }

    /// Removes a field.
    pub fn remove_field(&mut self, field: FieldHandle) -> Result<()> {
        let index = self.state.field_map.remove(field)?;
        self.fields.swap_remove(index);
        self.plan = None;
        Ok(())
    }

    /// The fields.
    #[must_use]
    pub fn fields(&self) -> &[Arc<dyn ForceField>] {
        &self.fields
    }

    /// Handles of the fields, in the same order.
    #[must_use]
    pub fn field_handles(&self) -> &[FieldHandle] {
        self.state.field_map.handles()
    }

    /// Adds forces on a body that are constant between given times. They go with the body.
    pub fn add_schedule(
        &mut self,
        body: crate::body::BodyHandle,
        forces: ForceSchedule,
    ) -> Result<ScheduleHandle> {
        let index = self.state.bodies.index(body)?;
        self.pushed(index);
        Ok(self.state.schedules.insert(Schedule { body, forces }))
    }

    /// Removes a schedule.
    pub fn remove_schedule(&mut self, schedule: ScheduleHandle) -> Result<()> {
        self.state.schedules.remove(schedule).map(drop)
    }

    /// Handles of the schedules, in the order of [`World::schedules`].
    #[must_use]
    pub fn schedule_handles(&self) -> &[ScheduleHandle] {
        self.state.schedules.handles()
    }

    /// The schedules.
    #[must_use]
    pub fn schedules(&self) -> &[Schedule] {
        self.state.schedules.values()
    }
}
