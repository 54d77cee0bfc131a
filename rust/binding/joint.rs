//! The joint of Python: a draft until a world takes it, then one object for the joint as long as that lives.
//!
//! The classes of the kinds stand in `culbuto.joints`; they reach their parameters here by name.

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use culbuto::joint::{Joint as Kind, JointDef, JointHandle, JointKind};
use culbuto::world::JointRef;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple, PyType};

use crate::body::Body;
use crate::error::StaleHandleError;
use crate::joint_parameters::{Value, blank, joint_error, parameter, put, seen};
use crate::joint_springs::Springs;
use crate::parts::{Made, Place};
use crate::world::World;

/// What the joints of all kinds are to the engine. Use `culbuto.Joint` and the classes of the kinds.
#[pyclass(name = "_Joint", frozen, subclass, dict, weakref, module = "culbuto._native")]
pub struct Joint {
    made: Made,
    /// Never held while Python may run.
    draft: Mutex<Draft>,
    place: OnceLock<Place<Kind>>,
}

/// What is to be made. Once it is made, nothing is left of it.
struct Draft {
    def: JointDef,
    bodies: [Option<Py<Body>>; 2],
}

impl Draft {
    fn empty() -> Self {
        Self { def: JointDef::new(None, None, JointKind::Filter), bodies: [None, None] }
    }

    fn bodies(&self, py: Python<'_>) -> [Option<Py<Body>>; 2] {
        self.bodies.each_ref().map(|body| body.as_ref().map(|body| body.clone_ref(py)))
    }
}

/// Reaching the joint in the core.
impl Joint {
    fn draft(&self) -> MutexGuard<'_, Draft> {
        self.draft.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn place(&self) -> PyResult<&Place<Kind>> {
        self.place.get().ok_or_else(|| {
            StaleHandleError::new_err("this joint is in no world yet: World.add_joint adds it")
        })
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
        let core = place.world.get().core(py)?;
        let handle = place.handle()?;
        core.joint(handle).map(read).map_err(crate::error::to_py)
    }

    fn def<T>(&self, py: Python<'_>, read: impl FnOnce(&JointDef) -> T) -> PyResult<T> {
        if self.place.get().is_some() {
            self.live(py, |joint| read(joint.def()))
        } else {
            Ok(read(&self.draft().def))
        }
    }

    fn body(&self, py: Python<'_>, side: usize) -> PyResult<Option<Py<Body>>> {
        let Some(place) = self.place.get() else {
            return Ok(self.draft().bodies(py)[side].take());
        };
        let body = self.live(py, |joint| joint.def().bodies[side])?;
        Ok(body.and_then(|body| place.world.get().body(py, body)))
    }

    /// Removes the joint; its object stays, and says that it was removed.
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        let place = self.place()?;
        place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        core.remove_joint(place.handle()?).map_err(crate::error::to_py)?;
        let gone = own.objects().keep_joints(core.joint_handles());
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
            let Some(place) = body.as_ref().map(|body| &body.get().place) else { continue };
            if !place.world.is(world) {
                let message = format!("{name} belongs to another world");
                return Err(StaleHandleError::new_err(message));
            }
            if !place.is_alive() {
                let message = format!("{name} is no longer in its world: it was removed");
                return Err(StaleHandleError::new_err(message));
            }
        }
        let place = Place::new(world);
        let mut core = world.get().core(py)?;
        if own.place.get().is_some() {
            return Err(again());
        }
        for (handle, body) in def.bodies.iter_mut().zip(&bodies) {
            *handle = body.as_ref().map(|body| body.get().place.handle()).transpose()?;
        }
        let kind = def.kind;
        let handle = core.add_joint(def).map_err(|error| joint_error(&kind, error))?;
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
        Self { made: Made::default(), draft: Mutex::new(Draft::empty()), place: OnceLock::new() }
    }

    /// Drafts a joint of a kind between two bodies; None is the world.
    #[pyo3(signature = (kind, body_a, body_b, **parameters))]
    fn _make(
        &self,
        kind: &str,
        body_a: Option<Py<Body>>,
        body_b: Option<Py<Body>>,
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
        let mut core = place.world.get().core(py)?;
        let handle = place.handle()?;
        let joint = core.joint(handle).map_err(crate::error::to_py)?;
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
    fn body_a(&self, py: Python<'_>) -> PyResult<Option<Py<Body>>> {
        self.body(py, 0)
    }

    /// B; None: the world.
    #[getter]
    fn body_b(&self, py: Python<'_>) -> PyResult<Option<Py<Body>>> {
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
            Some(body) => Ok::<_, PyErr>(body.bind(py).repr()?.to_string()),
            None => Ok("the world".to_owned()),
        };
        Ok(format!("<{class}{name} of {} and {}>", side(0)?, side(1)?))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let (py, own, class) = (slf.py(), slf.get(), slf.get_type());
        let attributes = slf.getattr("__dict__")?;
        if let Some(place) = own.place.get() {
            let slot = place.slot().filter(|_| place.is_alive());
            let finder = py
                .import("operator")?
                .getattr("methodcaller")?
                .call1(("_part", "joint", slot, class))?;
            return (finder, (place.world.clone_ref(py),), attributes)
                .into_pyobject(py)
                .map(Bound::into_any);
        }
        let (def, bodies) = {
            let draft = own.draft();
            (serde_json::to_string(&draft.def), draft.bodies(py))
        };
        let def = def.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let [a, b] = bodies;
        let new = py.import("copyreg")?.getattr("__newobj__")?;
        (new, (class,), (def, a, b, attributes)).into_pyobject(py).map(Bound::into_any)
    }

    fn __setstate__(slf: &Bound<'_, Self>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let own = slf.getattr("__dict__")?.cast_into::<PyDict>()?;
        if let Ok(attributes) = state.cast::<PyDict>() {
            return own.update(attributes.as_mapping());
        }
        type Drafted<'py> = (String, Option<Py<Body>>, Option<Py<Body>>, Bound<'py, PyDict>);
        let (def, a, b, attributes) = state.extract::<Drafted<'_>>()?;
        own.update(attributes.as_mapping())?;
        let def = serde_json::from_str(&def)
            .map_err(|_| PyValueError::new_err("this is no pickled joint"))?;
        let old = std::mem::replace(&mut *slf.get().draft(), Draft { def, bodies: [a, b] });
        drop(old);
        Ok(())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        if !self.made.yes() {
            return Ok(());
        }
        if let Some(place) = self.place.get() {
            place.traverse(&visit)?;
        }
        let Ok(draft) = self.draft.try_lock() else { return Ok(()) };
        draft.bodies.iter().flatten().try_for_each(|body| visit.call(body))
    }
}

/// The classes of joints, by kind.
pub struct Classes<'py>(Bound<'py, PyAny>);

impl<'py> Classes<'py> {
    /// Those of `culbuto.joints`.
    pub fn known(py: Python<'py>) -> PyResult<Self> {
        Ok(Self(py.import("culbuto.joints")?.getattr("class_of")?))
    }

    /// That of a joint.
    pub fn of(&self, joint: &Kind) -> PyResult<Bound<'py, PyAny>> {
        let is_rope = matches!(joint.def.kind, JointKind::Distance { hold, max: Some(_), min: 0.0, .. }
            if hold == culbuto::joint::Hold::Free);
        self.0.call1((if is_rope { "rope" } else { joint.def.kind.name() },))
    }
}

/// A class of joints, as an argument.
pub fn joint_class<'py>(class: Option<Bound<'py, PyType>>) -> PyResult<Bound<'py, PyType>> {
    let of_joints = |class: &Bound<'py, PyType>| class.is_subclass_of::<Joint>().unwrap_or(false);
    class.filter(of_joints).ok_or_else(|| PyTypeError::new_err("this is no class of joints"))
}
