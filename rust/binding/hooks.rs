//! The user's own functions about contacts: those called after a step, and those called in the middle of one.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use culbuto::body::BodyHandle;
use culbuto::forces::BoxError;
use culbuto::math::Real;
use culbuto::world::{self, ContactHooks, ShapeView};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyWeakrefMethods, PyWeakrefReference};

use crate::body::Body;
use crate::contacts::Events;
use crate::surface::{Coefficients, FrictionArg, coefficients};
use crate::vec2::Vec2;
use crate::world::World;

/// A function that is called with events of a kind.
struct Listener {
    kind: &'static str,
    function: Py<PyAny>,
    body: Option<Py<Body>>,
}

/// The user's own functions, and bodies that events may still name.
#[derive(Default)]
pub struct Rules {
    filter: Option<Py<PyAny>>,
    pre_solve: Option<Py<PyAny>>,
    listeners: Vec<Listener>,
    /// Removed since the last step, and before it.
    removed: [Vec<Py<Body>>; 2],
}

impl Rules {
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.filter)?;
        visit.call(&self.pre_solve)?;
        for listener in &self.listeners {
            visit.call(&listener.function)?;
            visit.call(&listener.body)?;
        }
        self.removed.iter().flatten().try_for_each(|body| visit.call(body))
    }

    /// The object of a body that was removed of late.
    pub fn removed_body(&self, py: Python<'_>, handle: BodyHandle) -> Option<Py<Body>> {
        let mut removed = self.removed.iter().flatten();
        let found = removed.find(|body| body.get().place.known() == Some(handle))?;
        Some(found.clone_ref(py))
    }

    /// Keeps a body that was removed for the events that will name it.
    pub fn keep_removed(&mut self, body: Py<Body>) {
        self.removed[0].push(body);
    }
}

impl World {
    /// The user's functions, for a moment: as [`World::objects`].
    pub fn rules(&self) -> MutexGuard<'_, Rules> {
        self.rules.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether somebody listens.
    pub fn is_heard(&self) -> bool {
        !self.rules().listeners.is_empty()
    }

    /// After a call that moved the world on: lets go of joints that broke in it, forgets bodies that were removed before the call before, and calls
    /// those who listen.
    pub fn deliver(&self, py: Python<'_>) -> PyResult<()> {
        let old = {
            let mut rules = self.rules();
            let newer = std::mem::take(&mut rules.removed[0]);
            std::mem::replace(&mut rules.removed[1], newer)
        };
        drop(old);
        self.let_go_of_broken(py)?;
        if !self.is_heard() {
            return Ok(());
        }
        let core = self.core(py)?.events().clone();
        // All objects are made before anyone is called, who may remove bodies.
        for event in Events::new(py, self, &core)?.all(py) {
            let own = event.get();
            let hears = |listener: &&Listener| {
                let is = |body: &Option<Py<Body>>| {
                    body.as_ref().is_some_and(|b| listener.body.as_ref().is_some_and(|l| l.is(b)))
                };
                listener.kind == own.kind
                    && (listener.body.is_none() || is(&own.body_a) || is(&own.body_b))
            };
            let functions: Vec<Py<PyAny>> = {
                let rules = self.rules();
                let heard = rules.listeners.iter().filter(hears);
                heard.map(|listener| listener.function.clone_ref(py)).collect()
            };
            for function in functions {
                function.bind(py).call1((event.clone_ref(py),))?;
            }
        }
        Ok(())
    }

    fn listen<'py>(
        &self,
        kind: &'static str,
        function: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_callable("callback", &function)?;
        let own = function.clone().unbind();
        self.rules().listeners.push(Listener { kind, function: own, body });
        Ok(function)
    }

    /// Gives the core the hooks that the rules ask for.
    fn hook_up(slf: &Bound<'_, Self>) -> PyResult<()> {
        let py = slf.py();
        let (filter, pre_solve) = {
            let rules = slf.get().rules();
            (rules.filter.is_some(), rules.pre_solve.is_some())
        };
        let hooks = if filter || pre_solve {
            let world = PyWeakrefReference::new(slf)?.unbind();
            Some(Arc::new(Caller { world, filter, pre_solve }) as Arc<dyn ContactHooks>)
        } else {
            None
        };
        slf.get().work(py, |core| core.set_hooks(hooks))
    }

    /// Gives a copy of a world the rules of the world, but nobody who listens.
    pub fn copy_rules(slf: &Bound<'_, Self>, copy: &Bound<'_, Self>) -> PyResult<()> {
        let py = slf.py();
        let (filter, pre_solve) = {
            let rules = slf.get().rules();
            let cloned = |own: &Option<Py<PyAny>>| own.as_ref().map(|f| f.clone_ref(py));
            (cloned(&rules.filter), cloned(&rules.pre_solve))
        };
        if filter.is_none() && pre_solve.is_none() {
            return Ok(());
        }
        {
            let mut rules = copy.get().rules();
            (rules.filter, rules.pre_solve) = (filter, pre_solve);
        }
        Self::hook_up(copy)
    }

    /// Sets one of the rules; if the pairs that are near one another make it fail, all stays as it was.
    fn set_rule(
        slf: &Bound<'_, Self>,
        name: &str,
        rule: Option<Bound<'_, PyAny>>,
        place: fn(&mut Rules) -> &mut Option<Py<PyAny>>,
    ) -> PyResult<()> {
        if let Some(rule) = &rule {
            check_callable(name, rule)?;
        }
        slf.get().not_within()?;
        let before = std::mem::replace(place(&mut slf.get().rules()), rule.map(Bound::unbind));
        let result = Self::hook_up(slf);
        let gone = if result.is_err() {
            std::mem::replace(place(&mut slf.get().rules()), before)
        } else {
            before
        };
        drop(gone);
        result
    }
}

fn check_callable(what: &str, function: &Bound<'_, PyAny>) -> PyResult<()> {
    if function.is_callable() {
        return Ok(());
    }
    let kind = function.get_type().name()?;
    Err(PyTypeError::new_err(format!("{what} is a {kind}; wanted a function")))
}

#[pymethods]
impl World {
    /// Calls a function with a `ContactEvent` whenever two shapes begin to touch; of one body, if one is given. It is
    /// called after the step, and may change the world. Returns the function.
    #[pyo3(signature = (callback, body=None))]
    fn on_begin<'py>(
        &self,
        callback: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.listen("begin", callback, body)
    }

    /// The same, whenever two shapes no longer touch.
    #[pyo3(signature = (callback, body=None))]
    fn on_end<'py>(
        &self,
        callback: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.listen("end", callback, body)
    }

    /// The same, for each hit.
    #[pyo3(signature = (callback, body=None))]
    fn on_hit<'py>(
        &self,
        callback: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.listen("hit", callback, body)
    }

    /// The same, whenever a sensor begins to overlap a shape.
    #[pyo3(signature = (callback, body=None))]
    fn on_sensor_begin<'py>(
        &self,
        callback: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.listen("sensor_begin", callback, body)
    }

    /// The same, whenever a sensor no longer overlaps a shape.
    #[pyo3(signature = (callback, body=None))]
    fn on_sensor_end<'py>(
        &self,
        callback: Bound<'py, PyAny>,
        body: Option<Py<Body>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.listen("sensor_end", callback, body)
    }

    /// No longer calls a function with events.
    fn off(&self, callback: &Bound<'_, PyAny>) -> PyResult<()> {
        let listeners = std::mem::take(&mut self.rules().listeners);
        let mut kept = Vec::new();
        let mut gone = Vec::new();
        for listener in listeners {
            // As lists do: bound methods are equal, not the same.
            let same = listener.function.bind(callback.py()).eq(callback).unwrap_or(false);
            if same { gone.push(listener) } else { kept.push(listener) }
        }
        self.rules().listeners.splice(0..0, kept);
        if gone.is_empty() {
            return Err(PyValueError::new_err("this function is not called with events"));
        }
        Ok(())
    }

    /// A function of (body_a, part_a, body_b, part_b) that says whether two shapes can touch at all; None: all may that
    /// their categories, masks and groups let. It is asked when shapes come near one another, and may be asked again.
    /// It is called in the middle of a step, and cannot touch the world; attributes of your own on bodies it can read.
    #[getter]
    fn collision_filter(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.rules().filter.as_ref().map(|own| own.clone_ref(py))
    }

    #[setter]
    fn set_collision_filter(
        slf: &Bound<'_, Self>,
        filter: Option<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        Self::set_rule(slf, "collision_filter", filter, |rules| &mut rules.filter)
    }

    /// A function of a `PreSolve` that is called in each step for each contact before it is solved, and may change or
    /// disable it for that step; to return False disables it, too. None: nobody is asked. It is called in the middle of a
    /// step, and cannot touch the world.
    #[getter]
    fn pre_solve(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.rules().pre_solve.as_ref().map(|own| own.clone_ref(py))
    }

    #[setter]
    fn set_pre_solve(slf: &Bound<'_, Self>, hook: Option<Bound<'_, PyAny>>) -> PyResult<()> {
        Self::set_rule(slf, "pre_solve", hook, |rules| &mut rules.pre_solve)
    }
}

/// What of a contact can be set before it is solved.
struct Settable {
    friction: Coefficients,
    restitution: Real,
    rolling_resistance: Real,
    tangent_speed: Real,
    enabled: bool,
}

/// A contact that is about to be solved. What is set holds for this step.
#[pyclass(frozen, module = "culbuto")]
pub struct PreSolve {
    /// One body.
    #[pyo3(get)]
    body_a: Py<Body>,
    /// The other body.
    #[pyo3(get)]
    body_b: Py<Body>,
    /// Which shape of A, counted from 0.
    #[pyo3(get)]
    part_a: usize,
    /// Which shape of B, counted from 0.
    #[pyo3(get)]
    part_b: usize,
    /// Unit vector from A to B.
    #[pyo3(get)]
    normal: Vec2,
    /// One or two points (m).
    #[pyo3(get)]
    points: Vec<Vec2>,
    /// Gap at each point (m), below 0 where the surfaces overlap.
    #[pyo3(get)]
    gaps: Vec<Real>,
    settable: Mutex<Settable>,
}

impl PreSolve {
    fn own(&self) -> MutexGuard<'_, Settable> {
        self.settable.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PreSolve {
    /// Static and kinetic friction. May be set, to one number for both as well.
    #[getter]
    fn friction(&self) -> Coefficients {
        self.own().friction
    }

    #[setter]
    fn set_friction(&self, friction: FrictionArg) {
        self.own().friction = coefficients(friction.0);
    }

    /// Speed after over speed before, 0 to 1. May be set.
    #[getter]
    fn restitution(&self) -> Real {
        self.own().restitution
    }

    #[setter]
    fn set_restitution(&self, restitution: Real) {
        self.own().restitution = restitution;
    }

    /// Arm (m) by which the normal force opposes rolling. May be set.
    #[getter]
    fn rolling_resistance(&self) -> Real {
        self.own().rolling_resistance
    }

    #[setter]
    fn set_rolling_resistance(&self, arm: Real) {
        self.own().rolling_resistance = arm;
    }

    /// Velocity (m/s) of B against A, along the normal turned counter-clockwise, at which nothing slides. May be set.
    #[getter]
    fn tangent_speed(&self) -> Real {
        self.own().tangent_speed
    }

    #[setter]
    fn set_tangent_speed(&self, speed: Real) {
        self.own().tangent_speed = speed;
    }

    /// Whether the shapes resist one another. May be set.
    #[getter]
    fn enabled(&self) -> bool {
        self.own().enabled
    }

    #[setter]
    fn set_enabled(&self, on: bool) {
        self.own().enabled = on;
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body_a)?;
        visit.call(&self.body_b)
    }
}

/// The engine's side of the rules: a weak reference to the world that holds them.
struct Caller {
    world: Py<PyWeakrefReference>,
    filter: bool,
    pre_solve: bool,
}

impl Caller {
    fn world<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, World>> {
        let world = self.world.bind(py).upgrade_as::<World>()?;
        world.ok_or_else(|| PyRuntimeError::new_err("the world of these hooks is gone"))
    }

    fn ask(&self, py: Python<'_>, shapes: [&ShapeView<'_>; 2]) -> PyResult<bool> {
        let world = self.world(py)?;
        let Some(filter) = world.get().collision_filter(py) else { return Ok(true) };
        let [a, b] = [body(py, &world, shapes[0])?, body(py, &world, shapes[1])?];
        filter.bind(py).call1((a, shapes[0].part(), b, shapes[1].part()))?.is_truthy()
    }

    fn prepare(&self, py: Python<'_>, contact: &mut world::PreSolve<'_>) -> PyResult<()> {
        let world = self.world(py)?;
        let Some(hook) = world.get().pre_solve(py) else { return Ok(()) };
        let count = contact.count;
        let seen = PreSolve {
            body_a: body(py, &world, &contact.a)?,
            body_b: body(py, &world, &contact.b)?,
            part_a: contact.a.part(),
            part_b: contact.b.part(),
            normal: Vec2(contact.normal),
            points: contact.points[..count].iter().map(|p| Vec2(*p)).collect(),
            gaps: contact.gaps[..count].to_vec(),
            settable: Mutex::new(Settable {
                friction: coefficients(contact.friction),
                restitution: contact.restitution,
                rolling_resistance: contact.rolling_resistance,
                tangent_speed: contact.tangent_speed,
                enabled: contact.enabled,
            }),
        };
        let seen = Bound::new(py, seen)?;
        let answer = hook.bind(py).call1((&seen,))?;
        let own = seen.get().own();
        let off = !answer.is_none() && !answer.is_truthy()?;
        (contact.friction.sticking, contact.friction.sliding) = own.friction;
        contact.restitution = own.restitution;
        contact.rolling_resistance = own.rolling_resistance;
        contact.tangent_speed = own.tangent_speed;
        contact.enabled = own.enabled && !off;
        Ok(())
    }
}

/// The Python object of a shape's body.
fn body(py: Python<'_>, world: &Bound<'_, World>, shape: &ShapeView<'_>) -> PyResult<Py<Body>> {
    let objects = world.get().objects();
    let found = objects.bodies.get(shape.index()).map(|body| body.clone_ref(py));
    found.ok_or_else(|| PyRuntimeError::new_err("a body of the contact has no object"))
}

impl ContactHooks for Caller {
    fn allows(&self, a: &ShapeView<'_>, b: &ShapeView<'_>) -> Result<bool, BoxError> {
        if !self.filter {
            return Ok(true);
        }
        Ok(Python::attach(|py| self.ask(py, [a, b]))?)
    }

    fn pre_solve(&self, contact: &mut world::PreSolve<'_>) -> Result<(), BoxError> {
        if !self.pre_solve {
            return Ok(());
        }
        Ok(Python::attach(|py| self.prepare(py, contact))?)
    }
}
