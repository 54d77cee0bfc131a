//! The joints of a world: added, listed, and as arrays.

use std::collections::HashMap;

use culbuto::joint::JointHandle;
use culbuto::math::{Real, Vec2 as Vector};
use culbuto::world::{self as core, JointRef};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyKeyError, PyTypeError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyString, PyTuple};

use crate::error::to_py;
use crate::joint::Joint;
use crate::parts::Made;
use crate::shape::rows;
use crate::vec2::Vec2;
use crate::world::{Objects, World};

impl Objects {
    /// Puts the joints in the order of the core's, and returns those that are no longer in the core, to be dropped
    /// when no lock is held. Called with the core locked.
    pub fn keep_joints(&mut self, handles: &[JointHandle]) -> Vec<Py<Joint>> {
        if self.joints.len() == handles.len() {
            return Vec::new();
        }
        let known = std::mem::take(&mut self.joints).into_iter();
        let mut known: HashMap<_, _> =
            known.filter_map(|joint| Some((joint.get().known()?, joint))).collect();
        self.joints = handles.iter().filter_map(|handle| known.remove(handle)).collect();
        let gone: Vec<_> = known.into_values().collect();
        gone.iter().for_each(|joint| joint.get().leave());
        gone
    }
}

/// A joint that broke: it bore more than it may, and is no longer in the world.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct BrokenJoint {
    /// The joint, which was removed.
    joint: Py<Joint>,
    /// World time at the end of the step in which it broke (s).
    time: Real,
    /// Mean force on B in that step (N).
    reaction_force: Vec2,
    /// Mean torque on B about its anchor in that step (N·m).
    reaction_torque: Real,
}

#[pymethods]
impl BrokenJoint {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let class = self.joint.bind(py).get_type().name()?;
        Ok(format!("<broken {class} at t = {:?} s>", self.time))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.joint)
    }
}

impl World {
    /// After a call that moved the world on: takes out the joints that broke in it.
    pub fn let_go_of_broken(&self, py: Python<'_>) -> PyResult<()> {
        let (seen, gone) = {
            let core = self.core(py)?;
            let gone = self.objects().keep_joints(core.joint_handles());
            (core.broken_joints().to_vec(), gone)
        };
        let mut broken = Vec::with_capacity(seen.len());
        for core::BrokenJoint { time, joint, reaction, .. } in seen {
            let own = gone.iter().find(|object| object.get().known() == Some(joint));
            if let Some(object) = own {
                let record = BrokenJoint {
                    joint: object.clone_ref(py),
                    time,
                    reaction_force: Vec2(reaction.force),
                    reaction_torque: reaction.torque,
                };
                broken.push(Py::new(py, record)?);
            }
        }
        let old = std::mem::replace(&mut self.objects().broken, broken);
        drop(old);
        Ok(())
    }
}

#[pymethods]
impl World {
    /// Adds a joint that was drafted, and returns it: `world.add_joint(cb.DistanceJoint(ground, crate, hertz=2))`.
    fn add_joint<'py>(
        slf: &Bound<'py, Self>,
        joint: &Bound<'py, Joint>,
    ) -> PyResult<Bound<'py, Joint>> {
        Joint::add_to(joint, slf)?;
        Ok(joint.clone())
    }

    /// The joints of now and of later: a view.
    #[getter]
    fn joints(slf: &Bound<'_, Self>) -> Joints {
        Joints { made: Made::default(), world: slf.clone().unbind() }
    }
}

/// The joints of a world: in the order in which they were added, but that the last one takes the place of one that is
/// removed. Arrays follow that order.
#[pyclass(frozen, sequence, module = "culbuto")]
pub struct Joints {
    made: Made,
    world: Py<World>,
}

impl Joints {
    fn list(&self, py: Python<'_>) -> Vec<Py<Joint>> {
        self.world.get().objects().joints.iter().map(|joint| joint.clone_ref(py)).collect()
    }

    fn each<T>(&self, py: Python<'_>, read: impl Fn(JointRef<'_>) -> T) -> PyResult<Vec<T>> {
        let world = self.world.get();
        let core = world.core(py)?;
        let _at_work = world.at_work();
        let read = |handle: &JointHandle| core.joint(*handle).map(&read);
        core.joint_handles().iter().map(read).collect::<Result<_, _>>().map_err(to_py)
    }

    fn named(&self, py: Python<'_>, name: &str) -> PyResult<Option<Py<Joint>>> {
        let own = self.world.get();
        let core = own.core(py)?;
        let named = |joint: &culbuto::joint::Joint| joint.def.name.as_deref() == Some(name);
        let Some(index) = core.joints().iter().position(named) else { return Ok(None) };
        Ok(own.objects().joints.get(index).map(|joint| joint.clone_ref(py)))
    }
}

#[pymethods]
impl Joints {
    fn __len__(&self) -> usize {
        self.world.get().objects().joints.len()
    }

    /// By place, or the first of a name.
    fn __getitem__(&self, py: Python<'_>, key: &Bound<'_, PyAny>) -> PyResult<Py<Joint>> {
        if let Ok(name) = key.cast::<PyString>() {
            let name = name.to_cow()?;
            let missing = || PyKeyError::new_err(format!("no joint is called {name:?}"));
            return self.named(py, &name)?.ok_or_else(missing);
        }
        let index: isize = key
            .extract()
            .map_err(|_| PyTypeError::new_err("joints are found by place (int) or name (str)"))?;
        let objects = self.world.get().objects();
        let n = objects.joints.len();
        let place = if index < 0 { index.checked_add_unsigned(n) } else { Some(index) };
        let found = place.and_then(|place| objects.joints.get(usize::try_from(place).ok()?));
        found
            .map(|joint| joint.clone_ref(py))
            .ok_or_else(|| PyIndexError::new_err(format!("index {index} for {n} joints")))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyTuple::new(py, self.list(py))?.try_iter()
    }

    fn __contains__(&self, py: Python<'_>, item: &Bound<'_, PyAny>) -> bool {
        let world = self.world.bind(py);
        item.cast::<Joint>().is_ok_and(|joint| joint.get().lives_in(world))
    }

    /// The first joint of this name; None if there is none.
    fn find(&self, py: Python<'_>, name: &str) -> PyResult<Option<Py<Joint>>> {
        self.named(py, name)
    }

    /// Places of A and B in body order (n, 2); −1 for the world.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let core = self.world.get().core(py)?;
        let place = |body| core.bodies().index(body).map_or(-1, |i| i as i64);
        let place = |body: &Option<_>| body.map_or(-1, place);
        let places: Vec<i64> =
            core.joints().iter().flat_map(|joint| joint.def.bodies.each_ref().map(place)).collect();
        drop(core);
        let n = places.len() / 2;
        PyArray1::from_vec(py, places).reshape([n, 2])
    }

    /// Anchors of A and of B in the world (n, 2, 2) (m).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<Real>>> {
        let points = self.each(py, |joint| joint.anchors())?;
        let flat = points.iter().flatten().flat_map(|point| [point.x, point.y]);
        PyArray1::from_iter(py, flat).reshape([points.len(), 2, 2])
    }

    /// Mean forces on B in the last step (n, 2) (N).
    #[getter]
    fn reaction_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        let forces: Vec<Vector> = self.each(py, |joint| joint.reaction().force)?;
        rows(py, &forces)
    }

    /// Mean torques on B about its anchor in the last step (n,) (N·m).
    #[getter]
    fn reaction_torques<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.each(py, |joint| joint.reaction().torque)?))
    }

    /// How far each is from what it holds (n,) (m; rad where it holds an angle).
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.each(py, |joint| joint.gap())?))
    }

    /// Energies in the springs (n,) (J).
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.each(py, |joint| joint.energy())?))
    }

    fn __repr__(&self) -> String {
        format!("<{} joints>", self.__len__())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        if self.made.yes() { visit.call(&self.world) } else { Ok(()) }
    }
}
