//! Time: steps, runs to a tolerance, recordings, and what they took.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use culbuto::forces::BoxError;
use culbuto::math::{Real, Vec2};
use culbuto::world;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::convert::{self, count};
use crate::record::record;
use crate::world::World;

record! {
    /// What the last step or run took.
    StepReport {
        /// World time that passed (s).
        duration: Real,
        /// Steps of the methods, summed over what moves by itself; a closed form counts one a call.
        steps: u64,
        /// Of the steps, those of Radau's method in runs to a tolerance, where the motion was stiff.
        stiff_steps: u64,
        /// Steps that were tried again because their error was too large.
        rejected: u64,
        /// Evaluations of the forces.
        evaluations: u64,
        /// Sweeps over the rows of contacts, summed over islands and substeps.
        sweeps: u64,
        /// Systems of the rows of joints solved by the methods, summed over islands.
        solves: u64,
        /// Most parts that a substep was divided into because of what joints bear; 256 may not have been enough.
        parts: u32,
        /// Factorisations of the rows of contacts and joints together, summed over islands and substeps.
        factorisations: u64,
        /// Impacts resolved.
        impacts: u64,
        /// Events located in time by runs to a tolerance.
        events: u64,
        /// Largest change of velocity in the last sweep of a substep (m/s): what the rows still lack.
        residual: Real,
        /// Deepest overlap of two shapes that touch, at the end (m).
        overlap: Real,
        /// How far some joint is from what it holds, at the end (m, or rad where it holds an angle).
        gap: Real,
        /// Smallest step (s); infinite where only closed forms were needed.
        smallest_step: Real,
        /// Estimated relative error; None where it was not asked for.
        estimate: Option<Real>,
        /// When (s) and why a run to a tolerance could not go from event to event for the first time; None where it did.
        fallback: Option<(Real, String)>,
        /// Seconds each stage took, where `World.timing` is on.
        stages: BTreeMap<String, f64>,
        /// The motion at the times that were asked for.
        trajectory: Option<Kept> = None,
    }
}

impl From<&culbuto::World> for StepReport {
    fn from(world: &culbuto::World) -> Self {
        let report = world.report();
        let stages = report.stages.iter().map(|stage| (stage.name.to_owned(), stage.seconds));
        Self {
            duration: report.duration,
            steps: report.steps,
            stiff_steps: report.stiff_steps,
            rejected: report.rejected,
            evaluations: report.evaluations,
            sweeps: report.sweeps,
            solves: report.solves,
            parts: report.parts,
            factorisations: report.factorisations,
            impacts: report.impacts,
            events: report.events,
            residual: report.residual,
            overlap: world.overlap(),
            gap: world.joint_gap(),
            smallest_step: report.smallest_step,
            estimate: report.estimate,
            fallback: report.fallback.map(|(time, why)| (time, why.to_owned())),
            stages: stages.collect(),
            trajectory: None,
        }
    }
}

/// The motion of all bodies at a row of times. Bodies stand in body order.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct Trajectory {
    /// World times (k,) (s).
    times: Py<PyArray1<Real>>,
    /// Positions of the bodies' frames (k, n, 2) (m).
    positions: Py<PyArray3<Real>>,
    /// Angles (k, n) (rad).
    angles: Py<PyArray2<Real>>,
    /// Velocities of the centres of mass (k, n, 2) (m/s).
    velocities: Py<PyArray3<Real>>,
    /// Angular velocities (k, n) (rad/s).
    angular_velocities: Py<PyArray2<Real>>,
}

#[pymethods]
impl Trajectory {
    #[new]
    fn new(
        times: Py<PyArray1<Real>>,
        positions: Py<PyArray3<Real>>,
        angles: Py<PyArray2<Real>>,
        velocities: Py<PyArray3<Real>>,
        angular_velocities: Py<PyArray2<Real>>,
    ) -> Self {
        Self { times, positions, angles, velocities, angular_velocities }
    }

    /// Number of times.
    fn __len__(&self, py: Python<'_>) -> usize {
        self.times.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let shape = self.angles.bind(py).shape();
        format!("<Trajectory of {} bodies at {} times>", shape[1], shape[0])
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, own) = (slf.py(), slf.get());
        let arrays =
            (&own.times, &own.positions, &own.angles, &own.velocities, &own.angular_velocities);
        Ok((slf.get_type().into_any(), arrays.into_pyobject(py)?))
    }
}

impl Trajectory {
    fn from_core(py: Python<'_>, motion: world::Trajectory) -> PyResult<Self> {
        let (k, n) = (motion.times.len(), motion.bodies);
        let vectors = |vectors: Vec<Vec2>| {
            let flat: Vec<Real> = vectors.into_iter().flat_map(|v| [v.x, v.y]).collect();
            PyResult::Ok(PyArray1::from_vec(py, flat).reshape([k, n, 2])?.unbind())
        };
        let numbers = |numbers: Vec<Real>| {
            PyResult::Ok(PyArray1::from_vec(py, numbers).reshape([k, n])?.unbind())
        };
        Ok(Self {
            times: PyArray1::from_vec(py, motion.times).unbind(),
            positions: vectors(motion.poses.iter().map(|pose| pose.position).collect())?,
            angles: numbers(motion.poses.iter().map(|pose| pose.angle).collect())?,
            velocities: vectors(motion.twists.iter().map(|twist| twist.linear).collect())?,
            angular_velocities: numbers(motion.twists.iter().map(|twist| twist.angular).collect())?,
        })
    }
}

/// A trajectory inside a record.
#[derive(Clone)]
pub struct Kept(Arc<Py<Trajectory>>);

impl PartialEq for Kept {
    fn eq(&self, other: &Self) -> bool {
        self.0.is(&*other.0)
    }
}

impl<'py> FromPyObject<'_, 'py> for Kept {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(Arc::new(object.cast::<Trajectory>()?.to_owned().unbind())))
    }
}

impl<'py> IntoPyObject<'py> for Kept {
    type Target = Trajectory;
    type Output = Bound<'py, Trajectory>;
    type Error = std::convert::Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.bind(py).clone())
    }
}

/// Lets Python's signal handlers run now and then during a long run, and reports what they raise
/// (`KeyboardInterrupt`).
fn signals() -> impl FnMut() -> Result<(), BoxError> {
    let (mut calls, mut last) = (0_u32, Instant::now());
    move || {
        calls = calls.wrapping_add(1);
        if !calls.is_multiple_of(64) || last.elapsed() < Duration::from_millis(50) {
            return Ok(());
        }
        last = Instant::now();
        #[allow(
            clippy::redundant_closure_for_method_calls,
            reason = "the method is of one lifetime only"
        )]
        let checked = Python::attach(|py| py.check_signals());
        Ok(checked?)
    }
}

impl World {
    /// Steps one by one, so that who listens may change the world in between. The events are those of all steps.
    fn step_heard(&self, py: Python<'_>, dt: Real, steps: u32) -> PyResult<()> {
        let (mut earlier, mut broken) = (world::Events::default(), Vec::new());
        for _ in 0..steps {
            self.work(py, |core| core.step(dt))?;
            let events = self.core(py)?.events().clone();
            self.deliver(py)?;
            earlier.append(events);
            broken.append(&mut self.objects().broken);
            py.check_signals()?;
        }
        self.core(py)?.set_events(earlier);
        self.objects().broken = broken;
        Ok(())
    }
}

#[pymethods]
impl World {
    /// Moves the world on by `steps` steps of `dt` (s), at a fixed step. Forces applied for the next step act in
    /// the first. Who listens to events is called after each step; what they raise ends the call, and the world stays
    /// as after that step. With `estimate` the error is estimated from a run at half the substep (three times the
    /// cost); `report()` tells it. A call that fails leaves the world as it was before the first step.
    #[pyo3(signature = (dt, steps=1, *, estimate=false))]
    fn step(&self, py: Python<'_>, dt: Real, steps: i64, estimate: bool) -> PyResult<()> {
        let steps = count("steps", steps)?;
        if estimate {
            self.work(py, |core| core.steps_with_estimate(dt, steps).map(drop))?;
        } else if steps == 1 {
            self.work(py, |core| core.step(dt))?;
        } else if self.is_heard() {
            return self.step_heard(py, dt, steps);
        } else {
            self.work(py, |core| core.steps_watched(dt, steps, &mut signals()))?;
        }
        self.deliver(py)
    }

    /// Moves the world on by a duration (s), to a relative tolerance (1e-15 to 0.1), at the steps that asks for.
    /// The report holds an estimate of the error and, where `times` (k,) are given (s from now, increasing,
    /// within the duration), the motion at those.
    #[pyo3(signature = (duration, tolerance=1e-9, *, times=None))]
    fn advance(
        &self,
        py: Python<'_>,
        duration: Real,
        tolerance: Real,
        times: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<StepReport> {
        let wanted = match times {
            Some(times) => convert::column("times", times, None)?.as_array().to_vec(),
            None => Vec::new(),
        };
        let (mut report, trajectory) = self.work(py, |core| {
            let trajectory = core.advance_watched(duration, tolerance, &wanted, &mut signals())?;
            Ok((StepReport::from(&*core), trajectory))
        })?;
        self.deliver(py)?;
        if times.is_some() {
            let trajectory = Py::new(py, Trajectory::from_core(py, trajectory)?)?;
            report.trajectory = Some(Kept(Arc::new(trajectory)));
        }
        Ok(report)
    }

    /// `steps` steps of `dt` (s), keeping the motion at the start and after every `every` steps.
    #[pyo3(signature = (dt, steps, every=1))]
    fn record(&self, py: Python<'_>, dt: Real, steps: i64, every: i64) -> PyResult<Trajectory> {
        let (steps, every) = (count("steps", steps)?, count("every", every)?);
        let trajectory =
            self.work(py, |core| core.record_watched(dt, steps, every, &mut signals()))?;
        self.deliver(py)?;
        Trajectory::from_core(py, trajectory)
    }

    /// What the last step or run took.
    fn report(&self, py: Python<'_>) -> PyResult<StepReport> {
        Ok(StepReport::from(&*self.core(py)?))
    }

    /// Names of the stages that a step of this world runs now, in their order.
    #[getter]
    fn stages(&self, py: Python<'_>) -> PyResult<Vec<&'static str>> {
        Ok(self.core(py)?.stages())
    }

    /// The stages a step of this world runs, which bodies each moves, and how.
    fn explain(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.core(py)?.explain())
    }
}
