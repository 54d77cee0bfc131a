//! The Body of Python: one object per body, as long as the body lives.

use culbuto::body::{Body as Kind, BodyDef, Locks};
use culbuto::math::{Real, Wrench};
use culbuto::world::{BodyMut, BodyRef};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::convert::Vec2Arg;
use crate::error::to_py;
use crate::parts::{Place, Reduced, reduced};
use crate::vec2::Vec2;
use crate::words::kind_name;
use crate::world::World;

/// A body of a world. Worlds make bodies: `World.add_body`.
///
/// There is one object per body, so bodies are compared by identity and keep attributes of the user's own.
/// A body that was removed raises `StaleHandleError`.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct Body {
    pub place: Place<Kind>,
}

/// Reaching the body in the core.
impl Body {
    #[inline]
    pub fn read<T>(&self, py: Python<'_>, read: impl FnOnce(BodyRef<'_>) -> T) -> PyResult<T> {
        let core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        core.body(handle).map(read).map_err(to_py)
    }

    #[inline]
    pub fn edit(
        &self,
        py: Python<'_>,
        edit: impl FnOnce(&mut BodyMut<'_>) -> culbuto::error::Result<()>,
    ) -> PyResult<()> {
        let mut core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        core.body_mut(handle).and_then(|mut body| edit(&mut body)).map_err(to_py)
    }

    pub fn def<T>(&self, py: Python<'_>, read: impl FnOnce(&BodyDef) -> T) -> PyResult<T> {
        self.read(py, |body| read(&body.info().def))
    }

    pub fn set_locks(&self, py: Python<'_>, change: impl FnOnce(&mut Locks)) -> PyResult<()> {
        self.edit(py, |body| {
            let mut locks = body.get().info().def.locks;
            change(&mut locks);
            body.set_locks(locks)
        })
    }

    pub fn lives_in(&self, world: &Bound<'_, World>) -> bool {
        self.place.lives_in(world)
    }

    /// Removes the body, its joints and its schedules; their objects stay, and say that they were removed.
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        self.place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        let handle = self.place.handle()?;
        let index = core.bodies().index(handle).map_err(to_py)?;
        core.remove_body(handle).map_err(to_py)?;
        let mut objects = own.objects();
        let body = (index < objects.bodies.len()).then(|| objects.bodies.swap_remove(index));
        self.place.leave();
        let joints = objects.keep_joints(core.joint_handles());
        let schedules = objects.keep_schedules(core.schedule_handles());
        drop(objects);
        drop(core);
        if let Some(body) = body {
            own.rules().keep_removed(body);
        }
        drop((joints, schedules));
        Ok(())
    }
}

/// The motion.
#[pymethods]
impl Body {
    /// Position of the body's frame (m).
    #[getter]
    fn position(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.position()))
    }

    #[setter]
    fn set_position(&self, py: Python<'_>, position: Vec2Arg) -> PyResult<()> {
        self.edit(py, |body| body.set_position(position.0))
    }

    /// Angle of the body's frame (rad), not wrapped.
    #[getter]
    fn angle(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.angle())
    }

    #[setter]
    fn set_angle(&self, py: Python<'_>, angle: Real) -> PyResult<()> {
        self.edit(py, |body| body.set_angle(angle))
    }

    /// Largest distance of the outline from the centre of mass (m).
    #[getter]
    fn size(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.size())
    }

    /// Velocity of the centre of mass (m/s).
    #[getter]
    fn velocity(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.velocity()))
    }

    #[setter]
    fn set_velocity(&self, py: Python<'_>, velocity: Vec2Arg) -> PyResult<()> {
        self.edit(py, |body| body.set_velocity(velocity.0))
    }

    /// Angular velocity (rad/s).
    #[getter]
    fn angular_velocity(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.angular_velocity())
    }

    #[setter]
    fn set_angular_velocity(&self, py: Python<'_>, angular: Real) -> PyResult<()> {
        self.edit(py, |body| body.set_angular_velocity(angular))
    }

    /// Centre of mass in the world (m).
    #[getter]
    fn center_of_mass(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.center_of_mass()))
    }

    /// Constant force through the centre of mass (N), until changed.
    #[getter]
    fn force(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.force().force))
    }

    #[setter]
    fn set_force(&self, py: Python<'_>, force: Vec2Arg) -> PyResult<()> {
        self.edit(py, |body| {
            let torque = body.get().force().torque;
            body.set_force(Wrench::new(force.0, torque))
        })
    }

    /// Constant torque (N·m), until changed.
    #[getter]
    fn torque(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.force().torque)
    }

    #[setter]
    fn set_torque(&self, py: Python<'_>, torque: Real) -> PyResult<()> {
        self.edit(py, |body| {
            let force = body.get().force().force;
            body.set_force(Wrench::new(force, torque))
        })
    }

    /// Whether the body sleeps: it rests, and is left out of the work until something wakes it.
    #[getter]
    fn asleep(&self, py: Python<'_>) -> PyResult<bool> {
        self.read(py, |body| body.is_asleep())
    }

    /// ½mv² + ½Iω² (J); 0 of a body that does not answer to forces.
    #[getter]
    fn kinetic_energy(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.kinetic_energy())
    }

    /// mv (kg·m/s).
    #[getter]
    fn momentum(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.mass().mass * body.velocity()))
    }

    /// Velocity (m/s) of the point of the body that is at a world point.
    fn velocity_at(&self, py: Python<'_>, point: Vec2Arg) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.velocity_at(point.0)))
    }

    /// World coordinates of a point in the body's frame.
    fn world_point(&self, py: Python<'_>, local: Vec2Arg) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.world_point(local.0)))
    }

    /// Coordinates in the body's frame of a world point.
    fn local_point(&self, py: Python<'_>, world: Vec2Arg) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.local_point(world.0)))
    }

    /// Adds a force (N) for the next step, through the centre of mass or at a world point.
    #[pyo3(signature = (force, at=None))]
    fn apply_force(&self, py: Python<'_>, force: Vec2Arg, at: Option<Vec2Arg>) -> PyResult<()> {
        self.edit(py, |body| body.apply_force(force.0, at.map(|at| at.0)))
    }

    /// Adds a torque (N·m) for the next step.
    fn apply_torque(&self, py: Python<'_>, torque: Real) -> PyResult<()> {
        self.edit(py, |body| body.apply_torque(torque))
    }

    /// Changes the velocities at once by an impulse (N·s), through the centre of mass or at a world point.
    #[pyo3(signature = (impulse, at=None))]
    fn apply_impulse(&self, py: Python<'_>, impulse: Vec2Arg, at: Option<Vec2Arg>) -> PyResult<()> {
        self.edit(py, |body| body.apply_impulse(impulse.0, at.map(|at| at.0)))
    }

    /// Changes the angular velocity at once by an angular impulse (N·m·s).
    fn apply_angular_impulse(&self, py: Python<'_>, impulse: Real) -> PyResult<()> {
        self.edit(py, |body| body.apply_angular_impulse(impulse))
    }

    /// Wakes the body and the island that sleeps with it.
    fn wake(&self, py: Python<'_>) -> PyResult<()> {
        self.edit(py, |body| {
            body.wake();
            Ok(())
        })
    }

    /// Lets the body sleep with all that it touched after the last step and that can move, if sleeping is on.
    fn sleep(&self, py: Python<'_>) -> PyResult<()> {
        self.edit(py, |body| {
            body.sleep();
            Ok(())
        })
    }
}

/// Its place in the world.
#[pymethods]
impl Body {
    /// The world it is, or was, in.
    #[getter]
    fn world(&self, py: Python<'_>) -> Py<World> {
        self.place.world.clone_ref(py)
    }

    /// Its place in body order, which arrays and lists follow.
    #[getter]
    fn index(&self, py: Python<'_>) -> PyResult<usize> {
        self.read(py, |body| body.index())
    }

    /// Whether it was removed from its world.
    #[getter]
    fn removed(&self) -> bool {
        !self.place.is_alive()
    }

    /// Removes the body, and the joints and schedules on it, from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place.world.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        if self.removed() {
            return "<removed Body>".to_owned();
        }
        let seen = self.read(py, |body| {
            let def = &body.info().def;
            let name = def.name.as_ref().map_or_else(String::new, |name| format!(" {name:?}"));
            let (kind, at) = (kind_name(def.kind), body.position());
            format!("<{kind} Body{name} at ({:?}, {:?})>", at.x, at.y)
        });
        seen.unwrap_or_else(|_| "<Body of a world at work>".to_owned())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, "body", &slf.get().place)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.place.traverse(&visit)
    }
}
