//! The World of Python: the core's world behind a lock, and one Python object for each thing in it.

use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use culbuto::World as Core;
use culbuto::body::{ImpactLaw, Mixing, Rule};
use culbuto::math::{Real, vec2};
use pyo3::exceptions::{PyRuntimeError, PyTypeError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;

use crate::body::Body;
use crate::convert::{Vec2Arg, count};
use crate::error::to_py;
use crate::field::Field;
use crate::fluid::Fluid;
use crate::hooks::Rules;
use crate::joint::Joint;
use crate::joints::BrokenJoint;
use crate::mixing::{ImpactLawArg, RuleArg, SolverArg};
use crate::parts::Made;
use crate::schedule::Schedule;
use crate::soft::SoftBody;
use crate::vec2::Vec2;

/// Bodies, and the laws they move by.
///
/// Quantities are in SI units. Every call that fails leaves the world as it was. A world may be used
/// from several threads: steps release the interpreter, and others wait for the world meanwhile.
///
/// Two locks, always in the order of the fields. Neither is held while Python may run, but for the
/// first while a world works; then it knows the thread that works, and a field that touches its own
/// world is told so instead of waiting for itself.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct World {
    made: Made,
    core: Mutex<Core>,
    /// Never held while the thread is detached from the interpreter or makes a Python object, so that the
    /// garbage collector always finds it open.
    objects: Mutex<Objects>,
    /// As the objects, and never together with them.
    pub rules: Mutex<Rules>,
    /// Mark of the thread that steps, 0 for none.
    worker: AtomicUsize,
}

/// One Python object for each thing in the world. They live as long as the thing, or longer.
#[derive(Default)]
pub struct Objects {
    /// In body order.
    pub bodies: Vec<Py<Body>>,
    /// In the order of the core's joints.
    pub joints: Vec<Py<Joint>>,
    /// Those that broke in the last call that moved the world on.
    pub broken: Vec<Py<BrokenJoint>>,
    /// In the order of the core's fields.
    pub fields: Vec<Py<Field>>,
    /// In the order of the core's schedules.
    pub schedules: Vec<Py<Schedule>>,
    /// In the order of the core's fluids.
    pub fluids: Vec<Py<Fluid>>,
    /// In the order of the core's deformable bodies.
    pub softs: Vec<Py<SoftBody>>,
}

/// A number that no other living thread has.
fn this_thread() -> usize {
    thread_local!(static MARK: Cell<u8> = const { Cell::new(0) });
    MARK.with(|mark| std::ptr::from_ref(mark).addr())
}

/// Reaching what is inside.
impl World {
    pub fn from_core(core: Core) -> Self {
        Self {
            made: Made::default(),
            core: Mutex::new(core),
            objects: Mutex::default(),
            rules: Mutex::default(),
            worker: AtomicUsize::new(0),
        }
    }

    /// The core's world, for a moment. No Python object may be made or dropped while it is held.
    #[inline]
    pub fn core(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Core>> {
        match self.core.try_lock() {
            Ok(core) => Ok(core),
            Err(TryLockError::Poisoned(core)) => Ok(core.into_inner()),
            Err(TryLockError::WouldBlock) => {
                self.not_within()?;
                Ok(self.core.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner))
            }
        }
    }

    /// Marks this thread as at work in the core, which is locked, where the user's own code may run.
    pub fn at_work(&self) -> Working<'_> {
        Working::new(&self.worker)
    }

    /// The Python objects, for a moment. The core is locked before, where both are wanted.
    pub fn objects(&self) -> MutexGuard<'_, Objects> {
        self.objects.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets the core work with the interpreter released. Fields of the user's attach again.
    #[inline]
    pub fn work<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Core) -> culbuto::error::Result<T> + Send,
    ) -> PyResult<T> {
        self.not_within()?;
        py.detach(|| {
            let mut core = self.core.lock().unwrap_or_else(PoisonError::into_inner);
            let _working = Working::new(&self.worker);
            work(&mut core)
        })
        .map_err(to_py)
    }

    /// An error if this thread is in the middle of a step of this world.
    #[inline]
    pub fn not_within(&self) -> PyResult<()> {
        if self.worker.load(Ordering::Relaxed) == this_thread() {
            return Err(PyRuntimeError::new_err(
                "this world is at work: a field, a joint or a contact hook cannot touch the world that calls it; \
                 it is given all it may see as its argument",
            ));
        }
        Ok(())
    }

    /// Changes a setting.
    pub fn set(
        &self,
        py: Python<'_>,
        set: impl FnOnce(&mut Core) -> culbuto::error::Result<()>,
    ) -> PyResult<()> {
        set(&mut *self.core(py)?).map_err(to_py)
    }
}

/// Says which thread works, until it is dropped.
pub struct Working<'a>(&'a AtomicUsize);

impl<'a> Working<'a> {
    fn new(worker: &'a AtomicUsize) -> Self {
        worker.store(this_thread(), Ordering::Relaxed);
        Self(worker)
    }
}

impl Drop for Working<'_> {
    fn drop(&mut self) {
        self.0.store(0, Ordering::Relaxed);
    }
}

const GRAVITY: Vec2Arg = Vec2Arg(vec2(0.0, -9.81));
const STILL: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));
const GEOMETRIC_MEAN: RuleArg = RuleArg(Rule::GeometricMean);
const MAXIMUM: RuleArg = RuleArg(Rule::Maximum);
const NEWTON: ImpactLawArg = ImpactLawArg(ImpactLaw::Newton);
const SOLVER: SolverArg = SolverArg(culbuto::solvers::Solver::Sweep);

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (
        gravity=GRAVITY, *, air_density=0.0, wind=STILL, method="leapfrog", substeps=4,
        closed_form=true, friction_rule=GEOMETRIC_MEAN, restitution_rule=MAXIMUM, impact_law=NEWTON,
        solver=SOLVER, sleeping=false, timing=false,
    ))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn new(
        gravity: Vec2Arg,
        air_density: Real,
        wind: Vec2Arg,
        method: &str,
        substeps: i64,
        closed_form: bool,
        friction_rule: RuleArg,
        restitution_rule: RuleArg,
        impact_law: ImpactLawArg,
        solver: SolverArg,
        sleeping: bool,
        timing: bool,
    ) -> PyResult<Self> {
        let make = || {
            let mut core = Core::new(gravity.0)?;
            core.set_air(culbuto::forces::Air { density: air_density, wind: wind.0 })?;
            core.set_method(method)?;
            core.set_closed_form(closed_form);
            let (friction, restitution) = (friction_rule.0, restitution_rule.0);
            core.set_mixing(Mixing { friction, restitution, ..Mixing::default() })?;
            core.set_impact_law(impact_law.0);
            core.set_solver(solver.0);
            core.set_sleeping(sleeping);
            core.set_timing(timing);
            Ok(core)
        };
        let mut core = make().map_err(to_py)?;
        core.set_substeps(count("substeps", substeps)?).map_err(to_py)?;
        Ok(Self::from_core(core))
    }

    /// Gravity (m/s²).
    #[getter]
    fn gravity(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.core(py)?.settings().gravity))
    }

    #[setter]
    fn set_gravity(&self, py: Python<'_>, gravity: Vec2Arg) -> PyResult<()> {
        self.set(py, |core| core.set_gravity(gravity.0))
    }

    /// Density of the air (kg/m²).
    #[getter]
    fn air_density(&self, py: Python<'_>) -> PyResult<Real> {
        Ok(self.core(py)?.settings().air.density)
    }

    #[setter]
    fn set_air_density(&self, py: Python<'_>, density: Real) -> PyResult<()> {
        self.set(py, |core| {
            let air = culbuto::forces::Air { density, ..core.settings().air };
            core.set_air(air)
        })
    }

    /// Velocity of the air (m/s).
    #[getter]
    fn wind(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.core(py)?.settings().air.wind))
    }

    #[setter]
    fn set_wind(&self, py: Python<'_>, wind: Vec2Arg) -> PyResult<()> {
        self.set(py, |core| {
            let air = culbuto::forces::Air { wind: wind.0, ..core.settings().air };
            core.set_air(air)
        })
    }

    /// Name of the method that moves bodies at a fixed step; `culbuto.methods()` lists them.
    #[getter]
    fn method(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.core(py)?.settings().method.clone())
    }

    #[setter]
    fn set_method(&self, py: Python<'_>, method: &str) -> PyResult<()> {
        self.set(py, |core| core.set_method(method))
    }

    /// Into how many equal substeps a step is divided, 1 to 65536.
    #[getter]
    fn substeps(&self, py: Python<'_>) -> PyResult<u32> {
        Ok(self.core(py)?.settings().substeps)
    }

    #[setter]
    fn set_substeps(&self, py: Python<'_>, substeps: i64) -> PyResult<()> {
        let substeps = count("substeps", substeps)?;
        self.set(py, |core| core.set_substeps(substeps))
    }

    /// Most sweeps over the rows of contacts a substep, 1 to 10000; fewer where they settle.
    #[getter]
    fn sweeps(&self, py: Python<'_>) -> PyResult<u32> {
        Ok(self.core(py)?.settings().sweeps)
    }

    #[setter]
    fn set_sweeps(&self, py: Python<'_>, sweeps: i64) -> PyResult<()> {
        let sweeps = count("sweeps", sweeps)?;
        self.set(py, |core| core.set_sweeps(sweeps))
    }

    /// Whether bodies under constant forces take the exact solution, whatever the method.
    #[getter]
    fn closed_form(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.core(py)?.settings().closed_form)
    }

    #[setter]
    fn set_closed_form(&self, py: Python<'_>, on: bool) -> PyResult<()> {
        self.core(py)?.set_closed_form(on);
        Ok(())
    }

    /// Whether each stage of a step is timed, for `report()` and `explain()`.
    #[getter]
    fn timing(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.core(py)?.settings().timing)
    }

    #[setter]
    fn set_timing(&self, py: Python<'_>, on: bool) -> PyResult<()> {
        self.core(py)?.set_timing(on);
        Ok(())
    }

    /// World time (s). Schedules and fields that depend on time go by it.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<Real> {
        Ok(self.core(py)?.time())
    }

    #[setter]
    fn set_time(&self, py: Python<'_>, time: Real) -> PyResult<()> {
        self.set(py, |core| core.set_time(time))
    }

    /// All bodies, in body order: the order in which they were added, but that the last one takes the
    /// place of one that is removed.
    #[getter]
    fn bodies(&self, py: Python<'_>) -> Vec<Py<Body>> {
        self.objects().bodies.iter().map(|body| body.clone_ref(py)).collect()
    }

    /// All fields.
    #[getter]
    fn fields(&self, py: Python<'_>) -> Vec<Py<Field>> {
        self.objects().fields.iter().map(|field| field.clone_ref(py)).collect()
    }

    /// All schedules.
    #[getter]
    fn schedules(&self, py: Python<'_>) -> Vec<Py<Schedule>> {
        self.objects().schedules.iter().map(|schedule| schedule.clone_ref(py)).collect()
    }

    fn __len__(&self) -> usize {
        self.objects().bodies.len()
    }

    /// A world without bodies is still a world.
    fn __bool__(&self) -> bool {
        true
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyIterator>> {
        pyo3::types::PyTuple::new(py, self.bodies(py))?.try_iter()
    }

    fn __contains__(slf: &Bound<'_, Self>, item: &Bound<'_, PyAny>) -> bool {
        item.cast::<Body>().is_ok_and(|body| body.get().lives_in(slf))
    }

    /// The first body of this name, in body order; None if there is none.
    fn find(&self, py: Python<'_>, name: &str) -> PyResult<Option<Py<Body>>> {
        let core = self.core(py)?;
        let named = |info: &culbuto::body::Info| info.def.name.as_deref() == Some(name);
        let Some(index) = core.bodies().infos.iter().position(named) else { return Ok(None) };
        Ok(self.objects().bodies.get(index).map(|body| body.clone_ref(py)))
    }

    /// Removes a body (and the joints and schedules on it), a joint, a field, a schedule, a fluid or a deformable body.
    fn remove(slf: &Bound<'_, Self>, part: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(body) = part.cast::<Body>() {
            body.get().remove_from(slf)
        } else if let Ok(joint) = part.cast::<Joint>() {
            joint.get().remove_from(slf)
        } else if let Ok(field) = part.cast::<Field>() {
            field.get().remove_from(slf)
        } else if let Ok(schedule) = part.cast::<Schedule>() {
            schedule.get().remove_from(slf)
        } else if let Ok(fluid) = part.cast::<Fluid>() {
            fluid.get().remove_from(slf)
        } else if let Ok(body) = part.cast::<SoftBody>() {
            body.get().remove_from(slf)
        } else {
            let kind = part.get_type().name()?;
            let message = format!(
                "a world holds bodies, joints, fields, schedules, fluids and deformable bodies, no {kind}"
            );
            Err(PyTypeError::new_err(message))
        }
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let n = self.objects().bodies.len();
        let bodies = if n == 1 { "body" } else { "bodies" };
        match self.core(py) {
            Ok(core) => format!("<World of {n} {bodies} at t = {:?} s>", core.time()),
            Err(_) => format!("<World of {n} {bodies}, at work>"),
        }
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        if !self.made.yes() {
            return Ok(());
        }
        let Ok(objects) = self.objects.try_lock() else { return Ok(()) };
        objects.traverse(&visit)?;
        let Ok(rules) = self.rules.try_lock() else { return Ok(()) };
        rules.traverse(&visit)
    }

    fn __clear__(&self) {
        let rules = std::mem::take(&mut *self.rules());
        let objects = std::mem::take(&mut *self.objects());
        drop((objects, rules)); // with the lock open again: finalisers may ask for it
    }
}
