//! A force law that is the user's own code, and how the engine calls it.
//!
//! The Python objects are held by a [`Law`], which worlds and snapshots hold where the garbage collector
//! sees it. The engine's side holds a weak reference, so a law that refers to its own world is no leak.

use std::sync::Arc;

use culbuto::body::Mass;
use culbuto::forces::{BodyColumns, BoxError, FieldFacts, ForceField};
use culbuto::math::{Pose, Real, Vec2, Wrench, vec2};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyWeakrefMethods, PyWeakrefReference};

use crate::convert;

/// The user's functions and what they say of themselves.
#[pyclass(frozen, weakref)]
pub struct Law {
    pub function: Py<PyAny>,
    pub potential: Option<Py<PyAny>>,
    pub name: String,
    pub velocity_dependent: bool,
    pub internal: bool,
}

#[pymethods]
impl Law {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.function)?;
        visit.call(&self.potential)
    }
}

/// What makes a law again, for pickles.
pub type LawParts = (Py<PyAny>, Option<Py<PyAny>>, String, bool, bool);

impl Law {
    pub fn new(
        function: &Bound<'_, PyAny>,
        potential: Option<&Bound<'_, PyAny>>,
        (velocity_dependent, internal): (bool, bool),
        name: Option<String>,
    ) -> PyResult<Self> {
        for (what, part) in [("field", Some(function)), ("potential", potential)] {
            if let Some(part) = part.filter(|part| !part.is_callable()) {
                let kind = part.get_type().name()?;
                let message = format!("{what} is a {kind}; wanted a function of a State");
                return Err(PyTypeError::new_err(message));
            }
        }
        let name = match name {
            Some(name) => name,
            None => match function.getattr_opt("__name__")? {
                Some(name) => name.to_string(),
                None => function.get_type().name()?.to_string(),
            },
        };
        Ok(Self {
            function: function.clone().unbind(),
            potential: potential.map(|potential| potential.clone().unbind()),
            name,
            velocity_dependent,
            internal,
        })
    }

    /// The engine's side of a law.
    pub fn shared(law: &Bound<'_, Self>) -> PyResult<Arc<dyn ForceField>> {
        let own = law.get();
        Ok(Arc::new(Caller {
            law: PyWeakrefReference::new(law)?.unbind(),
            name: own.name.clone(),
            forces: format!("force of field {:?}", own.name),
            torques: format!("torque of field {:?}", own.name),
            facts: FieldFacts {
                velocity_dependent: own.velocity_dependent,
                conservative: own.potential.is_some(),
                internal: own.internal,
            },
        }))
    }

    pub fn parts(&self, py: Python<'_>) -> LawParts {
        let potential = self.potential.as_ref().map(|potential| potential.clone_ref(py));
        let function = self.function.clone_ref(py);
        (function, potential, self.name.clone(), self.velocity_dependent, self.internal)
    }

    pub fn from_parts(py: Python<'_>, parts: LawParts) -> PyResult<Bound<'_, Self>> {
        let (function, potential, name, velocity_dependent, internal) = parts;
        let potential = potential.as_ref().map(|potential| potential.bind(py));
        let facts = (velocity_dependent, internal);
        Bound::new(py, Self::new(function.bind(py), potential, facts, Some(name))?)
    }
}

/// All bodies at one moment, in body order, as a field sees them. The arrays are copies.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct State {
    /// World time (s).
    time: Real,
    /// Centres of mass (n, 2) (m).
    positions: Py<PyArray2<Real>>,
    /// Angles (n,) (rad).
    angles: Py<PyArray1<Real>>,
    /// Velocities of the centres of mass (n, 2) (m/s).
    velocities: Py<PyArray2<Real>>,
    /// Angular velocities (n,) (rad/s).
    angular_velocities: Py<PyArray1<Real>>,
    /// Masses (n,) (kg).
    masses: Py<PyArray1<Real>>,
    /// Moments of inertia about the centres of mass (n,) (kg·m²).
    inertias: Py<PyArray1<Real>>,
}

impl State {
    fn new(py: Python<'_>, time: Real, bodies: &BodyColumns<'_>) -> PyResult<Self> {
        let BodyColumns { poses, twists, masses, .. } = *bodies;
        let vectors = |vectors: Vec<[Real; 2]>| {
            let n = vectors.len();
            let flat = PyArray1::from_vec(py, vectors.into_flattened());
            PyResult::Ok(flat.reshape([n, 2])?.unbind())
        };
        let pair = |v: Vec2| [v.x, v.y];
        let numbers = |numbers: Vec<Real>| PyArray1::from_vec(py, numbers).unbind();
        Ok(Self {
            time,
            positions: vectors(poses.iter().map(|p| pair(p.position)).collect())?,
            angles: numbers(poses.iter().map(|p: &Pose| p.angle).collect()),
            velocities: vectors(twists.iter().map(|v| pair(v.linear)).collect())?,
            angular_velocities: numbers(twists.iter().map(|v| v.angular).collect()),
            masses: numbers(masses.iter().map(|m: &Mass| m.mass).collect()),
            inertias: numbers(masses.iter().map(|m| m.inertia).collect()),
        })
    }
}

#[pymethods]
impl State {
    /// Number of bodies.
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.angles.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<State of {} bodies at t = {:?} s>", self.__len__(py)?, self.time))
    }
}

/// The engine's side of a [`Law`].
struct Caller {
    law: Py<PyWeakrefReference>,
    name: String,
    forces: String,
    torques: String,
    facts: FieldFacts,
}

impl Caller {
    fn law<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, Law>> {
        let law = self.law.bind(py).upgrade_as::<Law>()?;
        law.ok_or_else(|| PyRuntimeError::new_err(format!("field {:?} is gone", self.name)))
    }

    fn call(
        &self,
        py: Python<'_>,
        time: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> PyResult<()> {
        let law = self.law(py)?;
        let state = State::new(py, time, bodies)?;
        let result = law.get().function.bind(py).call1((state,))?;
        let both = result.cast::<PyTuple>().ok().filter(|tuple| tuple.len() == 2);
        let (forces, torques) = match both {
            Some(tuple) => (tuple.get_item(0)?, Some(tuple.get_item(1)?)),
            None => (result, None),
        };
        let forces = convert::points(&self.forces, &forces, Some(out.len()))?;
        let forces = forces.as_array();
        if let Some(i) = forces.outer_iter().position(|f| !(f[0].is_finite() && f[1].is_finite())) {
            let got = format!("({}, {})", forces[[i, 0]], forces[[i, 1]]);
            return Err(self.not_finite(&self.forces, i, &got));
        }
        let torques = match torques {
            None => None,
            Some(torques) => Some(convert::column(&self.torques, &torques, Some(out.len()))?),
        };
        if let Some(torques) = &torques {
            let torques = torques.as_array();
            if let Some(i) = torques.iter().position(|torque| !torque.is_finite()) {
                return Err(self.not_finite(&self.torques, i, &torques[i].to_string()));
            }
            out.iter_mut().zip(torques).for_each(|(wrench, torque)| wrench.torque += torque);
        }
        for (wrench, force) in out.iter_mut().zip(forces.outer_iter()) {
            wrench.force += vec2(force[0], force[1]);
        }
        Ok(())
    }

    #[allow(clippy::unused_self, reason = "reads as the field's own complaint")]
    fn not_finite(&self, what: &str, body: usize, got: &str) -> PyErr {
        PyValueError::new_err(format!("{what} on body {body} is {got}; allowed: finite numbers"))
    }

    fn energy(
        &self,
        py: Python<'_>,
        time: Real,
        bodies: &BodyColumns<'_>,
    ) -> PyResult<Option<Real>> {
        let law = self.law(py)?;
        let Some(potential) = &law.get().potential else { return Ok(None) };
        let result = potential.bind(py).call1((State::new(py, time, bodies)?,))?;
        let energy: Real = result.extract()?;
        if energy.is_finite() {
            return Ok(Some(energy));
        }
        let name = &self.name;
        let message = format!("potential of field {name:?} is {energy}; allowed: a finite number");
        Err(PyValueError::new_err(message))
    }
}

impl ForceField for Caller {
    fn name(&self) -> &str {
        &self.name
    }

    fn add_forces(
        &self,
        time: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        Ok(Python::attach(|py| self.call(py, time, bodies, out))?)
    }

    fn potential(&self, time: Real, bodies: &BodyColumns<'_>) -> Result<Option<Real>, BoxError> {
        Ok(Python::attach(|py| self.energy(py, time, bodies))?)
    }

    fn facts(&self) -> FieldFacts {
        self.facts
    }
}
