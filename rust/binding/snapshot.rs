//! Worlds that are kept, copied and sent: what each Python object becomes on the way.

use std::collections::HashMap;

use culbuto::World as Core;
use culbuto::world::Snapshot as Kept;
use pyo3::exceptions::PyValueError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple, PyType};

use pyo3::PyClass;

use crate::body::Body;
use crate::code::{Code, CodeParts};
use crate::custom_joint::RuleParts;
use crate::error::to_py;
use crate::field::Field;
use crate::fluid::Fluid;
use crate::joint::Joint;
use crate::joint_pickle::{Classes, joint_class};
use crate::law::LawParts;
use crate::parts::Place;
use crate::schedule::Schedule;
use crate::soft::SoftBody;
use crate::world::{Objects, World};

/// A world as it was at one moment: to go back to, to keep, to send. It continues bit for bit.
#[pyclass(frozen, weakref, module = "culbuto")]
pub struct Snapshot {
    kept: Kept,
    /// The user's own code in it.
    code: Code,
    /// The world it is of, and the objects of then; none once it was pickled.
    origin: Option<(Py<World>, Objects)>,
}

#[pymethods]
impl Snapshot {
    /// A snapshot from the bytes of another, and the user's fields and joints that are not in them. For pickles.
    #[new]
    #[pyo3(signature = (data, laws=Vec::new(), rules=Vec::new()))]
    fn new(
        py: Python<'_>,
        data: &[u8],
        laws: Vec<LawParts>,
        rules: Vec<RuleParts>,
    ) -> PyResult<Self> {
        let code = Code::from_parts(py, (laws, rules))?;
        Ok(Self { kept: code.snapshot(py, data)?, code, origin: None })
    }

    /// World time (s).
    #[getter]
    fn time(&self) -> culbuto::math::Real {
        self.kept.time()
    }

    /// Number of bodies.
    fn __len__(&self) -> usize {
        self.kept.bodies().len()
    }

    fn __bool__(&self) -> bool {
        true
    }

    /// A new world that continues from here.
    fn to_world<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, World>> {
        World::assembled(py, self.kept.to_world(), &self.code)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Stored<'py>)> {
        let (py, own) = (slf.py(), slf.get());
        let data = own.kept.to_bytes().map_err(to_py)?;
        let (laws, rules) = own.code.parts(py);
        Ok((slf.get_type().into_any(), (PyBytes::new(py, &data), laws, rules)))
    }

    fn __repr__(&self) -> String {
        format!("<Snapshot of {} bodies at t = {:?} s>", self.__len__(), self.kept.time())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.code.traverse(&visit)?;
        if let Some((world, objects)) = &self.origin {
            visit.call(world)?;
            objects.traverse(&visit)?;
        }
        Ok(())
    }
}

/// What a pickle holds of a snapshot.
type Stored<'py> = (Bound<'py, PyBytes>, Vec<LawParts>, Vec<RuleParts>);

impl Objects {
    /// Shows the garbage collector all objects.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.bodies.iter().try_for_each(|body| visit.call(body))?;
        self.joints.iter().try_for_each(|joint| visit.call(joint))?;
        self.broken.iter().try_for_each(|broken| visit.call(broken))?;
        self.fields.iter().try_for_each(|field| visit.call(field))?;
        self.schedules.iter().try_for_each(|schedule| visit.call(schedule))?;
        self.fluids.iter().try_for_each(|fluid| visit.call(fluid))?;
        self.softs.iter().try_for_each(|body| visit.call(body))
    }

    fn copied(&self, py: Python<'_>) -> Self {
        Self {
            bodies: self.bodies.iter().map(|body| body.clone_ref(py)).collect(),
            joints: self.joints.iter().map(|joint| joint.clone_ref(py)).collect(),
            broken: Vec::new(),
            fields: self.fields.iter().map(|field| field.clone_ref(py)).collect(),
            schedules: self.schedules.iter().map(|schedule| schedule.clone_ref(py)).collect(),
            fluids: self.fluids.iter().map(|fluid| fluid.clone_ref(py)).collect(),
            softs: self.softs.iter().map(|body| body.clone_ref(py)).collect(),
        }
    }

    /// The user's own code.
    fn code(&self, py: Python<'_>) -> Code {
        let law = |field: &Py<Field>| field.get().law().map(|law| law.clone_ref(py));
        let rule = |joint: &Py<Joint>| joint.get().rule().map(|rule| rule.clone_ref(py));
        Code {
            laws: self.fields.iter().filter_map(law).collect(),
            rules: self.joints.iter().filter_map(rule).collect(),
        }
    }

    /// New objects for all that a core has.
    fn new(world: &Bound<'_, World>, kept: &Kept, code: &Code) -> PyResult<Self> {
        let py = world.py();
        let mut objects = Self::default();
        for _ in kept.bodies() {
            objects.bodies.push(Py::new(py, Body { place: Place::new(world) })?);
        }
        let classes = Classes::known(py)?;
        let (mut laws, mut rules) = (code.laws.iter(), code.rules.iter());
        for joint in kept.joints() {
            let made = Joint::placed(world, &classes.of(joint)?)?;
            if joint.custom.is_some() {
                made.get().adopt(rules.next().map(|rule| rule.clone_ref(py)));
            }
            objects.joints.push(made.unbind());
        }
        for field in kept.fields() {
            let own = if field.built_in().is_none() { laws.next() } else { None };
            let law = own.map(|law| law.clone_ref(py));
            objects.fields.push(Py::new(py, Field::new(world, law))?);
        }
        for _ in kept.schedules() {
            objects.schedules.push(Py::new(py, Schedule { place: Place::new(world) })?);
        }
        for _ in kept.fluid_handles() {
            objects.fluids.push(Py::new(py, Fluid { place: Place::new(world) })?);
        }
        for _ in kept.soft_handles() {
            objects.softs.push(Py::new(py, SoftBody { place: Place::new(world) })?);
        }
        Ok(objects)
    }

    /// Puts every object in its place. Called with the core locked.
    fn enter(&self, kept: &Kept) {
        for (body, handle) in self.bodies.iter().zip(kept.bodies()) {
            body.get().place.enter(*handle);
        }
        for (joint, handle) in self.joints.iter().zip(kept.joint_handles()) {
            joint.get().enter(*handle);
        }
        for (field, handle) in self.fields.iter().zip(kept.field_handles()) {
            field.get().place.enter(*handle);
        }
        for (schedule, handle) in self.schedules.iter().zip(kept.schedule_handles()) {
            schedule.get().place.enter(*handle);
        }
        for (fluid, handle) in self.fluids.iter().zip(kept.fluid_handles()) {
            fluid.get().place.enter(*handle);
        }
        for (body, handle) in self.softs.iter().zip(kept.soft_handles()) {
            body.get().place.enter(*handle);
        }
    }

    /// Takes every object out of its place. Called with the core locked.
    fn leave(&self) {
        self.bodies.iter().for_each(|body| body.get().place.leave());
        self.joints.iter().for_each(|joint| joint.get().leave());
        self.fields.iter().for_each(|field| field.get().place.leave());
        self.schedules.iter().for_each(|schedule| schedule.get().place.leave());
        self.fluids.iter().for_each(|fluid| fluid.get().place.leave());
        self.softs.iter().for_each(|body| body.get().place.leave());
    }

    /// Keeps the present objects of bodies whose handles are the same.
    fn keep_bodies(&mut self, py: Python<'_>, present: &[Py<Body>], kept: &Kept) {
        let known = present.iter().filter_map(|body| Some((body.get().place.known()?, body)));
        let known: HashMap<_, _> = known.collect();
        for (body, handle) in self.bodies.iter_mut().zip(kept.bodies()) {
            if let Some(present) = known.get(handle) {
                *body = present.clone_ref(py);
            }
        }
    }
}

impl World {
    /// A world around a core.
    pub fn assembled<'py>(py: Python<'py>, core: Core, code: &Code) -> PyResult<Bound<'py, Self>> {
        let kept = core.snapshot();
        let world = Bound::new(py, Self::from_core(core))?;
        let objects = Objects::new(&world, &kept, code)?;
        objects.enter(&kept);
        *world.get().objects() = objects;
        Ok(world)
    }

    /// Takes a state and the objects that belong to it, instead of its own.
    fn become_kept(&self, py: Python<'_>, kept: &Kept, objects: Objects) -> PyResult<()> {
        let mut core = self.core(py)?;
        let mut own = self.objects();
        core.restore(kept);
        own.leave();
        objects.enter(kept);
        let old = std::mem::replace(&mut *own, objects);
        drop(own);
        drop(core);
        drop(old);
        Ok(())
    }
}

/// What a pickle holds of a world.
type Pickled<'py> = (
    Bound<'py, PyBytes>,
    CodeParts,
    Vec<Py<Body>>,
    Vec<Py<Joint>>,
    Vec<Py<Field>>,
    (Vec<Py<Schedule>>, Vec<Py<Fluid>>, Vec<Py<SoftBody>>),
    Bound<'py, PyAny>,
);

#[pymethods]
impl World {
    /// Keeps the world as it is: `restore` goes back to it.
    fn snapshot(slf: &Bound<'_, Self>) -> PyResult<Snapshot> {
        let py = slf.py();
        let core = slf.get().core(py)?;
        let (kept, objects) = (core.snapshot(), slf.get().objects().copied(py));
        drop(core);
        let code = objects.code(py);
        Ok(Snapshot { kept, code, origin: Some((slf.clone().unbind(), objects)) })
    }

    /// Goes back to a snapshot, of this world or of another. The objects of then are those of now again, the
    /// removed ones too; what was added since is gone. From another world's snapshot, or one that was pickled, bodies
    /// whose handles are the same keep their objects, and the rest is made anew.
    fn restore(slf: &Bound<'_, Self>, snapshot: &Bound<'_, Snapshot>) -> PyResult<()> {
        let (py, own) = (slf.py(), slf.get());
        let Snapshot { kept, code, origin } = snapshot.get();
        let objects = match origin {
            Some((world, objects)) if world.is(slf) => objects.copied(py),
            _ => {
                let mut objects = Objects::new(slf, kept, code)?;
                let present = own.objects().copied(py);
                objects.keep_bodies(py, &present.bodies, kept);
                objects
            }
        };
        own.become_kept(py, kept, objects)
    }

    /// A world of its own in the same state; bodies take their attributes along, without copying those.
    fn __copy__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, Self>> {
        let (py, own) = (slf.py(), slf.get());
        let core = own.core(py)?;
        let (copy, objects) = (core.clone(), own.objects().copied(py));
        drop(core);
        let world = Self::assembled(py, copy, &objects.code(py))?;
        Self::copy_rules(slf, &world)?;
        let made = world.get().objects().copied(py);
        copy_attributes(slf, &world)?;
        for (old, new) in objects.bodies.iter().zip(&made.bodies) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        for (old, new) in objects.joints.iter().zip(&made.joints) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        for (old, new) in objects.fields.iter().zip(&made.fields) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        for (old, new) in objects.schedules.iter().zip(&made.schedules) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        for (old, new) in objects.fluids.iter().zip(&made.fluids) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        for (old, new) in objects.softs.iter().zip(&made.softs) {
            copy_attributes(old.bind(py), new.bind(py))?;
        }
        Ok(world)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>, Pickled<'py>)> {
        let (py, own) = (slf.py(), slf.get());
        let core = own.core(py)?;
        let (kept, objects) = (core.snapshot(), own.objects().copied(py));
        drop(core);
        let data = PyBytes::new(py, &kept.to_bytes().map_err(to_py)?);
        let code = objects.code(py).parts(py);
        let Objects { bodies, joints, fields, schedules, fluids, softs, .. } = objects;
        let attributes = slf.getattr("__dict__")?;
        let others = (schedules, fluids, softs);
        let state = (data, code, bodies, joints, fields, others, attributes);
        Ok((slf.get_type().into_any(), PyTuple::empty(py), state))
    }

    /// The part of this kind in a slot; a new one, to be put there, while the world is being unpickled.
    #[pyo3(name = "_part", signature = (kind, slot, class_=None))]
    fn part<'py>(
        slf: &Bound<'py, Self>,
        kind: &str,
        slot: Option<usize>,
        class_: Option<Bound<'py, PyType>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let objects = slf.get().objects().copied(py);
        let found = match kind {
            "body" => in_slot(py, objects.bodies, slot, |body| body.get().place.slot()),
            "joint" => in_slot(py, objects.joints, slot, |joint| joint.get().slot()),
            "field" => in_slot(py, objects.fields, slot, |field| field.get().place.slot()),
            "fluid" => in_slot(py, objects.fluids, slot, |fluid| fluid.get().place.slot()),
            "soft body" => in_slot(py, objects.softs, slot, |body| body.get().place.slot()),
            _ => in_slot(py, objects.schedules, slot, |schedule| schedule.get().place.slot()),
        };
        Ok(match (found, kind) {
            (Some(found), _) => found,
            (None, "body") => Bound::new(py, Body { place: Place::new(slf) })?.into_any(),
            (None, "joint") => Joint::placed(slf, joint_class(class_)?.as_any())?.into_any(),
            (None, "field") => Bound::new(py, Field::new(slf, None))?.into_any(),
            (None, "fluid") => Bound::new(py, Fluid { place: Place::new(slf) })?.into_any(),
            (None, "soft body") => Bound::new(py, SoftBody { place: Place::new(slf) })?.into_any(),
            (None, _) => Bound::new(py, Schedule { place: Place::new(slf) })?.into_any(),
        })
    }

    fn __setstate__(slf: &Bound<'_, Self>, state: Pickled<'_>) -> PyResult<()> {
        let py = slf.py();
        let (data, code, bodies, joints, fields, others, attributes) = state;
        let (schedules, fluids, softs) = others;
        let code = Code::from_parts(py, code)?;
        let kept = code.snapshot(py, data.as_bytes())?;
        // Fields and joints are made here, around the code; their pickles find them by their place.
        let mut objects = Objects::new(slf, &kept, &code)?;
        let wanted =
            [kept.bodies().len(), kept.joints().len(), kept.fields().len(), kept.schedules().len()];
        let given = [bodies.len(), joints.len(), fields.len(), schedules.len()];
        let wanted_too = (kept.fluid_handles().len(), kept.soft_handles().len());
        if given != wanted || (fluids.len(), softs.len()) != wanted_too {
            return Err(PyValueError::new_err("this is no pickled world"));
        }
        let own = |world: &Py<Self>| world.is(slf);
        let right = bodies.iter().all(|body| own(&body.get().place.world))
            && joints.iter().all(|joint| joint.get().is_of(slf))
            && fields.iter().all(|field| own(&field.get().place.world))
            && schedules.iter().all(|schedule| own(&schedule.get().place.world))
            && fluids.iter().all(|fluid| own(&fluid.get().place.world))
            && softs.iter().all(|body| own(&body.get().place.world));
        if !right {
            return Err(PyValueError::new_err("this is no pickled world"));
        }
        (objects.bodies, objects.schedules) = (bodies, schedules);
        (objects.fluids, objects.softs) = (fluids, softs);
        for (joint, made) in joints.iter().zip(&objects.joints) {
            joint.get().adopt(made.get().rule().map(|rule| rule.clone_ref(py)));
        }
        objects.joints = joints;
        for (field, law) in fields.iter().zip(&objects.fields) {
            field.get().adopt(law.get().law().map(|law| law.clone_ref(py)));
        }
        objects.fields = fields;
        slf.getattr("__dict__")?.cast_into::<PyDict>()?.update(attributes.cast()?)?;
        slf.get().become_kept(py, &kept, objects)
    }
}

/// The object in a slot.
fn in_slot<P: PyClass>(
    py: Python<'_>,
    objects: Vec<Py<P>>,
    slot: Option<usize>,
    slot_of: impl Fn(&Py<P>) -> Option<usize>,
) -> Option<Bound<'_, PyAny>> {
    let found = objects.into_iter().find(|object| slot.is_some() && slot_of(object) == slot);
    found.map(|object| object.into_bound(py).into_any())
}

/// Gives the attributes of the user's own on one object to another.
fn copy_attributes(from: &Bound<'_, PyAny>, to: &Bound<'_, PyAny>) -> PyResult<()> {
    let (from, to) = (from.getattr("__dict__")?, to.getattr("__dict__")?);
    to.cast::<PyDict>()?.update(from.cast()?)
}
