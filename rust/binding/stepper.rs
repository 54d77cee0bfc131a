//! Real time to fixed steps.

use std::sync::{Mutex, MutexGuard, PoisonError};

use culbuto::math::Real;
use culbuto::world;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;

use crate::convert::count;
use crate::error::to_py;
use crate::record::record;
use crate::world::World;

record! {
    /// What a frame of a `Stepper` amounted to.
    Frame {
        /// Steps taken.
        ticks: u32,
        /// Part of the next step that has passed, 0 to 1: draw at old + fraction·(new − old).
        fraction: Real,
        /// Time (s, scaled) given up because `most_ticks` was reached.
        dropped: Real,
    }
}

/// Turns the time between frames into whole steps: a fixed number of ticks a second, a time scale (0 pauses),
/// and a cap on how many ticks one frame catches up.
#[pyclass(frozen, module = "culbuto")]
pub struct Stepper(Mutex<world::Stepper>);

impl Stepper {
    fn inner(&self, py: Python<'_>) -> MutexGuard<'_, world::Stepper> {
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Stepper {
    #[new]
    #[pyo3(signature = (ticks_per_second, *, time_scale=1.0, most_ticks=8))]
    fn new(ticks_per_second: Real, time_scale: Real, most_ticks: i64) -> PyResult<Self> {
        let mut stepper = world::Stepper::new(ticks_per_second).map_err(to_py)?;
        stepper.set_time_scale(time_scale).map_err(to_py)?;
        stepper.set_most_ticks(count("most_ticks", most_ticks)?).map_err(to_py)?;
        Ok(Self(Mutex::new(stepper)))
    }

    /// Length of a tick (s).
    #[getter]
    fn tick(&self, py: Python<'_>) -> Real {
        self.inner(py).tick()
    }

    /// How much faster than real time the world runs; 0 pauses it.
    #[getter]
    fn time_scale(&self, py: Python<'_>) -> Real {
        self.inner(py).time_scale()
    }

    #[setter]
    fn set_time_scale(&self, py: Python<'_>, scale: Real) -> PyResult<()> {
        self.inner(py).set_time_scale(scale).map_err(to_py)
    }

    /// Most ticks that a frame catches up; what is beyond is given up.
    #[getter]
    fn most_ticks(&self, py: Python<'_>) -> u32 {
        self.inner(py).most_ticks()
    }

    #[setter]
    fn set_most_ticks(&self, py: Python<'_>, ticks: i64) -> PyResult<()> {
        self.inner(py).set_most_ticks(count("most_ticks", ticks)?).map_err(to_py)
    }

    /// Takes the real time since the last frame (s) and steps the world as often as a tick's worth has
    /// come together.
    fn frame(&self, py: Python<'_>, world: &Bound<'_, World>, elapsed: Real) -> PyResult<Frame> {
        // A copy works, so that no lock is held on the way into a user's field.
        let mut stepper = self.inner(py).clone();
        let world::Frame { ticks, fraction, dropped } =
            world.get().work(py, |core| stepper.frame(core, elapsed))?;
        *self.inner(py) = stepper;
        if ticks > 0 {
            world.get().deliver(py)?;
        }
        Ok(Frame { ticks, fraction, dropped })
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let own = self.inner(py);
        let (hertz, scale, most) = (1.0 / own.tick(), own.time_scale(), own.most_ticks());
        format!("Stepper({hertz:?}, time_scale={scale:?}, most_ticks={most})")
    }
}
