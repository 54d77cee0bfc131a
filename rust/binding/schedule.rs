//! Forces that are constant between given times.

use culbuto::World as Core;
use culbuto::forces::{ForceSchedule, Schedule as Kind, ScheduleHandle};
use culbuto::math::{Real, Wrench, vec2};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::body::Body;
use crate::convert;
use crate::error::to_py;
use crate::parts::{Place, Reduced, reduced};
use crate::shape::rows;
use crate::world::{Objects, World};

/// Forces on a body that are constant between given times. Worlds make them: `World.add_schedule`.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct Schedule {
    pub place: Place<Kind>,
}

impl Schedule {
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        self.place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        core.remove_schedule(self.place.handle()?).map_err(to_py)?;
        let gone = own.objects().keep_schedules(core.schedule_handles());
        drop(core);
        drop(gone);
        Ok(())
    }

    fn read<T>(&self, py: Python<'_>, read: impl FnOnce(&Kind, &Core) -> T) -> PyResult<T> {
        let core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        let index = core.schedule_handles().iter().position(|other| *other == handle);
        match index.and_then(|index| core.schedules().get(index)) {
            Some(schedule) => Ok(read(schedule, &core)),
            None => Err(to_py(culbuto::Error::StaleHandle("force schedule"))),
        }
    }
}

impl Objects {
    /// Puts the schedules in the order of the core's, and returns those that are no longer in the core, to be
    /// dropped when no lock is held. Called with the core locked.
    pub fn keep_schedules(&mut self, handles: &[ScheduleHandle]) -> Vec<Py<Schedule>> {
        let mut gone = std::mem::take(&mut self.schedules);
        for handle in handles {
            let is_it = |schedule: &Py<Schedule>| schedule.get().place.known() == Some(*handle);
            if let Some(index) = gone.iter().position(is_it) {
                self.schedules.push(gone.swap_remove(index));
            }
        }
        gone.iter().for_each(|schedule| schedule.get().place.leave());
        gone
    }
}

#[pymethods]
impl Schedule {
    /// The body it acts on.
    #[getter]
    fn body(&self, py: Python<'_>) -> PyResult<Option<Py<Body>>> {
        let body = self.read(py, |schedule, _| schedule.body)?;
        Ok(self.place.world.get().body(py, body))
    }

    /// Times (n + 1,) at which the force changes (s, world time).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        let times = self.read(py, |schedule, _| schedule.forces.times().to_vec())?;
        Ok(PyArray1::from_vec(py, times))
    }

    /// Forces (n, 2) between those times (N).
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        let wrenches = self.read(py, |schedule, _| schedule.forces.wrenches().to_vec())?;
        let forces: Vec<_> = wrenches.iter().map(|wrench| wrench.force).collect();
        rows(py, &forces)
    }

    /// Torques (n,) between those times (N·m).
    #[getter]
    fn torques<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        let wrenches = self.read(py, |schedule, _| schedule.forces.wrenches().to_vec())?;
        Ok(PyArray1::from_vec(py, wrenches.iter().map(|wrench| wrench.torque).collect()))
    }

    /// The world it is, or was, in.
    #[getter]
    fn world(&self, py: Python<'_>) -> Py<World> {
        self.place.world.clone_ref(py)
    }

    /// Whether it was removed from its world.
    #[getter]
    fn removed(&self) -> bool {
        !self.place.is_alive()
    }

    /// Removes the schedule from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place.world.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        if self.removed() {
            return "<removed Schedule>".to_owned();
        }
        let seen = self.read(py, |schedule, _| {
            let times = schedule.forces.times();
            let (first, last) = (times[0], times[times.len() - 1]);
            format!("<Schedule from {first:?} s to {last:?} s>")
        });
        seen.unwrap_or_else(|_| "<Schedule of a world at work>".to_owned())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, "schedule", &slf.get().place)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.place.traverse(&visit)
    }
}

#[pymethods]
impl World {
    /// Adds forces (n, 2) (N) through a body's centre of mass and torques (n,) (N·m) that are constant
    /// between times (n + 1,) (s, world time); nothing acts before and after. The last time may be infinite.
    /// Steps end at each of those times, so the motion is as exact as under a constant force.
    #[pyo3(signature = (body, times, forces=None, torques=None))]
    fn add_schedule<'py>(
        slf: &Bound<'py, Self>,
        body: &Bound<'py, Body>,
        times: &Bound<'py, PyAny>,
        forces: Option<&Bound<'py, PyAny>>,
        torques: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, Schedule>> {
        let py = slf.py();
        if forces.is_none() && torques.is_none() {
            return Err(PyValueError::new_err("a schedule needs forces, torques, or both"));
        }
        let times = convert::column("times", times, None)?.as_array().to_vec();
        let n = times.len().saturating_sub(1);
        let mut wrenches = vec![Wrench::ZERO; n];
        if let Some(forces) = forces {
            let forces = convert::points("forces", forces, Some(n))?;
            for (wrench, force) in wrenches.iter_mut().zip(forces.as_array().outer_iter()) {
                wrench.force = vec2(force[0], force[1]);
            }
        }
        if let Some(torques) = torques {
            let torques = convert::column("torques", torques, Some(n))?;
            wrenches.iter_mut().zip(torques.as_array()).for_each(|(w, torque)| w.torque = *torque);
        }
        let forces = ForceSchedule::new(times, wrenches).map_err(to_py)?;
        let schedule = Bound::new(py, Schedule { place: Place::new(slf) })?;
        let place = &body.get().place;
        place.check_world(slf)?;
        let world = slf.get();
        let mut core = world.core(py)?;
        let handle = core.add_schedule(place.handle()?, forces).map_err(to_py)?;
        schedule.get().place.enter(handle);
        world.objects().schedules.push(schedule.clone().unbind());
        drop(core);
        Ok(schedule)
    }
}
