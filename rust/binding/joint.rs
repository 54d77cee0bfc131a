//! The joint of Python: a draft until a world takes it, then one object for the joint as long as that lives.
//!
//! The classes of the kinds stand in `culbuto.joints`; they reach their parameters here by name.

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use culbuto::joint::{Joint as Kind, JointDef, JointHandle, JointKind};
use culbuto::math::Real;
use culbuto::world::JointRef;
use pyo3::exceptions::PyValueError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};

use crate::body::Body;
use crate::custom_joint::Rule;
use crate::error::{StaleHandleError, to_py};
use crate::joint_parameters::{Value, blank, joint_error, parameter, put, seen};
use crate::joint_springs::{SpringMotion, Springs};
use crate::parts::{Made, Place};
use crate::soft::SoftBody;
use crate::world::World;

/// What the joints of all kinds are to the engine. Use `culbuto.Joint` and the classes of the kinds.
#[pyclass(name = "_Joint", frozen, subclass, dict, weakref, module = "culbuto._native")]
pub struct Joint {
    made: Made,
    /// Never held while Python may run.
    draft: Mutex<Draft>,
    pub place: OnceLock<Place<Kind>>,
    /// The user's own code, of a custom joint.
    rule: OnceLock<Py<Rule>>,
}

/// What is to be made. Once it is made, nothing is left of it.
pub struct Draft {
    pub def: JointDef,
    pub bodies: [Option<Held>; 2],
}

/// What a joint holds: a body, or a point of a deformable one.
#[derive(FromPyObject, IntoPyObject)]
pub enum Held {
    Body(Py<Body>),
    Soft(Py<SoftBody>),
}

impl Held {
    fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Body(body) => Self::Body(body.clone_ref(py)),
            Self::Soft(body) => Self::Soft(body.clone_ref(py)),
        }
    }

    /// An error, which calls it by this name, unless it is in this world.
    fn check(&self, world: &Bound<'_, World>, name: &str) -> PyResult<()> {
        let (same, alive) = match self {
            Self::Body(body) => {
                let place = &body.get().place;
                (place.world.is(world), place.is_alive())
            }
            Self::Soft(body) => {
                let place = &body.get().place;
                (place.world.is(world), place.is_alive())
            }
        };
        let message = match (same, alive) {
            (true, true) => return Ok(()),
            (false, _) => format!("{name} belongs to another world"),
            _ => format!("{name} is no longer in its world: it was removed"),
        };
        Err(StaleHandleError::new_err(message))
    }

    fn repr(&self, py: Python<'_>) -> PyResult<String> {
        let text = match self {
            Self::Body(body) => body.bind(py).repr()?,
            Self::Soft(body) => body.bind(py).repr()?,
        };
        Ok(text.to_string())
    }
}

impl Draft {
    fn empty() -> Self {
        Self { def: JointDef::new(None, None, JointKind::Filter), bodies: [None, None] }
    }

    pub fn bodies(&self, py: Python<'_>) -> [Option<Held>; 2] {
        self.bodies.each_ref().map(|body| body.as_ref().map(|body| body.clone_ref(py)))
    }
}

/// Reaching the joint in the core.
impl Joint {
    pub fn draft(&self) -> MutexGuard<'_, Draft> {
        self.draft.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn place(&self) -> PyResult<&Place<Kind>> {
        self.place.get().ok_or_else(|| {
            StaleHandleError::new_err("this joint is in no world yet: World.add_joint adds it")
        })
    }

    /// The user's own code, of a custom joint.
    pub fn rule(&self) -> Option<&Py<Rule>> {
        self.rule.get()
    }

    /// Gives a rule to a joint that has none yet.
    pub fn adopt(&self, rule: Option<Py<Rule>>) {
        if let Some(rule) = rule {
            // A joint that has a rule keeps it: they are the same.
            let _ = self.rule.set(rule);
        }
    }

    /// The handle it has or had.
    pub fn known(&self) -> Option<JointHandle> {
        self.place.get().and_then(Place::known)
    }

    /// The slot it has or had.
    pub fn slot(&self) -> Option<usize> {
        self.place.get().and_then(Place::slot)
    }

    /// Puts the joint into its world. Called with the core locked.
    pub fn enter(&self, handle: JointHandle) {
        if let Some(place) = self.place.get() {
            place.enter(handle);
        }
    }

    /// Takes the joint out of its world. Called with the core locked.
    pub fn leave(&self) {
        if let Some(place) = self.place.get() {
            place.leave();
        }
    }

    /// Whether it is of this world.
    pub fn is_of(&self, world: &Bound<'_, World>) -> bool {
        self.place.get().is_some_and(|place| place.world.is(world))
    }

    /// Whether it is in this world.
    pub fn lives_in(&self, world: &Bound<'_, World>) -> bool {
        self.place.get().is_some_and(|place| place.lives_in(world))
    }

    /// A joint of a class that is yet to be given its place in a world.
    pub fn placed<'py>(
        world: &Bound<'py, World>,
        class: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, Self>> {
        let joint = class.call_method1("__new__", (class,))?.cast_into::<Self>()?;
        // OK because the joint was made a moment ago.
        let _ = joint.get().place.set(Place::new(world));
        Ok(joint)
    }

    fn live<T>(&self, py: Python<'_>, read: impl FnOnce(JointRef<'_>) -> T) -> PyResult<T> {
        let place = self.place()?;
        let world = place.world.get();
        let core = world.core(py)?;
        let _at_work = world.at_work();
        core.joint(place.handle()?).map(read).map_err(to_py)
    }

    fn def<T>(&self, py: Python<'_>, read: impl FnOnce(&JointDef) -> T) -> PyResult<T> {
        if self.place.get().is_some() {
            self.live(py, |joint| read(joint.def()))
        } else {
            Ok(read(&self.draft().def))
        }
    }

    fn body(&self, py: Python<'_>, side: usize) -> PyResult<Option<Held>> {
        let Some(place) = self.place.get() else {
            return Ok(self.draft().bodies(py)[side].take());
        };
        let own = place.world.get();
        let (rigid, soft) = {
            let core = own.core(py)?;
            let handle = place.handle()?;
            let rigid = core.joint(handle).map_err(to_py)?.def().bodies[side];
            (rigid, core.soft_ends(handle).map_err(to_py)?[side])
        };
        let rigid = rigid.and_then(|body| own.body(py, body)).map(Held::Body);
        Ok(rigid.or_else(|| own.soft_body(py, soft?).map(Held::Soft)))
    }

    /// Removes the joint; its object stays, and says that it was removed.
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        let place = self.place()?;
        place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        let handle = place.handle()?;
        let index = core.joint_handles().iter().position(|other| *other == handle);
        core.remove_joint(handle).map_err(to_py)?;
        place.leave();
        let gone = index.map(|index| own.objects().joints.swap_remove(index));
        drop(core);
        drop(gone);
        Ok(())
    }

    /// Adds the joint that was drafted.
    pub fn add_to(slf: &Bound<'_, Self>, world: &Bound<'_, World>) -> PyResult<()> {
        let (py, own) = (slf.py(), slf.get());
        let again = || {
            let message = "this joint is, or was, in a world already; make another";
            PyValueError::new_err(message)
        };
        let (mut def, bodies) = {
            let draft = own.draft();
            (draft.def.clone(), draft.bodies(py))
        };
        for (name, body) in ["body_a", "body_b"].into_iter().zip(&bodies) {
            if let Some(body) = body {
                body.check(world, name)?;
            }
        }
        let place = Place::new(world);
        let rule = own.rule().map(|rule| Rule::shared(rule.bind(py))).transpose()?;
        let mut core = world.get().core(py)?;
        if own.place.get().is_some() {
            return Err(again());
        }
        let mut softs = [None; 2];
        for ((handle, soft), body) in def.bodies.iter_mut().zip(&mut softs).zip(&bodies) {
            match body {
                Some(Held::Body(body)) => *handle = Some(body.get().place.handle()?),
                Some(Held::Soft(body)) => *soft = Some(body.get().place.handle()?),
                None => {}
            }
        }
        let kind = def.kind;
        let handle = {
            let _at_work = world.get().at_work();
            match rule {
                Some(_) if softs != [None; 2] => {
                    let message =
                        "a custom joint ties rigid bodies: a point of a deformable one has no pose";
                    return Err(PyValueError::new_err(message));
                }
                Some(rule) => core.add_custom_joint(def, rule),
                None => core.add_soft_joint(def, softs),
            }
        }
        .map_err(|error| joint_error(&kind, error))?;
        place.enter(handle);
        own.place.set(place).map_err(|_| again())?;
        world.get().objects().joints.push(slf.clone().unbind());
        drop(core);
        let old = std::mem::replace(&mut *own.draft(), Draft::empty());
        drop(old);
        Ok(())
    }
}

#[pymethods]
impl Joint {
    #[new]
    #[pyo3(signature = (*_arguments, **_keywords))]
    fn new(_arguments: &Bound<'_, PyTuple>, _keywords: Option<&Bound<'_, PyDict>>) -> Self {
        Self {
            made: Made::default(),
            draft: Mutex::new(Draft::empty()),
            place: OnceLock::new(),
            rule: OnceLock::new(),
        }
    }

    /// Drafts a joint of a kind between two bodies; None is the world.
    #[pyo3(signature = (kind, body_a, body_b, **parameters))]
    fn _make(
        &self,
        kind: &str,
        body_a: Option<Held>,
        body_b: Option<Held>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let blank = blank(kind)
            .ok_or_else(|| PyValueError::new_err(format!("no kind of joint is called {kind:?}")))?;
        let mut def = JointDef::new(None, None, blank);
        let mut springs = Springs::default();
        let mut anchors: Option<String> = None;
        for (key, value) in parameters.into_iter().flatten() {
            let key = key.cast::<PyString>()?.to_cow()?;
            if matches!(&*key, "point" | "points" | "anchor_a" | "anchor_b") {
                if value.is_none() {
                    continue;
                }
                let is_anchor = |name: &str| name.starts_with("anchor");
                if anchors.as_deref().is_some_and(|other| !is_anchor(other) || !is_anchor(&key)) {
                    let message = "anchors are given by anchor_a and anchor_b, or point, or points";
                    return Err(PyValueError::new_err(message));
                }
                anchors = Some(key.to_string());
            }
            let value = crate::surface::argument::<Value>(&key, &value)?;
            if !springs.take(&key, &value)? {
                put(&mut def, &key, value, None)?;
            }
        }
        springs.put(&mut def)?;
        def.validated().map_err(|error| joint_error(&def.kind, error))?;
        if self.place.get().is_some() {
            return Err(PyValueError::new_err("this joint is in a world: it was made before"));
        }
        let new = Draft { def, bodies: [body_a, body_b] };
        let old = std::mem::replace(&mut *self.draft(), new);
        drop(old);
        Ok(())
    }

    /// Gives a custom joint its function of the poses of A and B, and its number of rows.
    fn _rule(&self, py: Python<'_>, function: Py<PyAny>, rows: usize) -> PyResult<()> {
        self.adopt(Some(Rule::new(py, (function, rows))?));
        Ok(())
    }

    /// The function of a custom joint.
    #[getter]
    fn _function(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.rule().map(|rule| rule.get().function.clone_ref(py))
    }

    /// A parameter, or something to be seen of it.
    fn _read(&self, py: Python<'_>, name: &str) -> PyResult<Value> {
        if let Some(found) = self.def(py, |def| parameter(def, name))? {
            return Ok(found);
        }
        self.live(py, |joint| seen(&joint, name))
    }

    /// Changes a parameter.
    fn _write(&self, py: Python<'_>, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let value = crate::surface::argument::<Value>(name, value)?;
        let Some(place) = self.place.get() else {
            let mut draft = self.draft();
            let mut def = draft.def.clone();
            put(&mut def, name, value, None)?;
            def.validated().map_err(|error| joint_error(&def.kind, error))?;
            draft.def = def;
            return Ok(());
        };
        let world = place.world.get();
        let mut core = world.core(py)?;
        let _at_work = world.at_work();
        let handle = place.handle()?;
        let joint = core.joint(handle).map_err(to_py)?;
        let mut def = joint.def().clone();
        put(&mut def, name, value, Some(&joint))?;
        let kind = def.kind;
        core.edit_joint(handle, |own| *own = def).map_err(|error| joint_error(&kind, error))
    }

    /// "distance", "revolute", …
    #[getter]
    fn kind(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.def(py, |def| def.kind.name())
    }

    /// A; None: the world.
    #[getter]
    fn body_a(&self, py: Python<'_>) -> PyResult<Option<Held>> {
        self.body(py, 0)
    }

    /// B; None: the world.
    #[getter]
    fn body_b(&self, py: Python<'_>) -> PyResult<Option<Held>> {
        self.body(py, 1)
    }

    /// The world it is, or was, in; None until it is added to one.
    #[getter]
    fn world(&self, py: Python<'_>) -> Option<Py<World>> {
        self.place.get().map(|place| place.world.clone_ref(py))
    }

    /// Whether it was removed from its world.
    #[getter]
    fn removed(&self) -> bool {
        self.place.get().is_some_and(|place| !place.is_alive())
    }

    /// How what hangs on its springs moves, by the law and as steps of dt (s) make it.
    fn spring_motions(&self, py: Python<'_>, dt: Real) -> PyResult<Vec<SpringMotion>> {
        let place = self.place()?;
        let world = place.world.get();
        let core = world.core(py)?;
        let _at_work = world.at_work();
        let motions = core.spring_motions(place.handle()?, dt).map_err(to_py)?;
        Ok(motions.iter().map(SpringMotion::from).collect())
    }

    /// Removes the joint from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place()?.world.bind(py))
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (py, own) = (slf.py(), slf.get());
        let class = slf.get_type().name()?;
        if own.removed() {
            return Ok(format!("<removed {class}>"));
        }
        let Ok(name) = own.def(py, |def| def.name.clone()) else {
            return Ok(format!("<{class} of a world at work>"));
        };
        let name = name.map_or_else(String::new, |name| format!(" {name:?}"));
        let side = |side| match own.body(py, side)? {
            Some(body) => body.repr(py),
            None => Ok("the world".to_owned()),
        };
        Ok(format!("<{class}{name} of {} and {}>", side(0)?, side(1)?))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        if !self.made.yes() {
            return Ok(());
        }
        if let Some(place) = self.place.get() {
            place.traverse(&visit)?;
        }
        visit.call(self.rule.get())?;
        let Ok(draft) = self.draft.try_lock() else { return Ok(()) };
        draft.bodies.iter().flatten().try_for_each(|body| match body {
            Held::Body(body) => visit.call(body),
            Held::Soft(body) => visit.call(body),
        })
    }
}
