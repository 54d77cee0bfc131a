//! Adding a body, with everything it may be given.

use culbuto::BodyDef;
use culbuto::body::{BodyHandle, BodyKind, DragWidth, Locks};
use culbuto::math::{Real, vec2};
use pyo3::prelude::*;

use crate::body::Body;
use crate::convert::Vec2Arg;
use crate::error::to_py;
use crate::parts::Place;
use crate::shape::parts;
use crate::words::{KindArg, WidthArg};
use crate::world::World;

const ZERO: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));
const DYNAMIC: KindArg = KindArg(BodyKind::Dynamic);
const SILHOUETTE: WidthArg = WidthArg(DragWidth::Silhouette);

impl World {
    /// The object of a body, if it is there.
    pub fn body(&self, py: Python<'_>, handle: BodyHandle) -> Option<Py<Body>> {
        let index = self.core(py).ok()?.bodies().index(handle).ok()?;
        self.objects().bodies.get(index).map(|body| body.clone_ref(py))
    }

    fn insert<'py>(slf: &Bound<'py, Self>, def: BodyDef) -> PyResult<Bound<'py, Body>> {
        let py = slf.py();
        let body = Bound::new(py, Body { place: Place::new(slf) })?;
        let world = slf.get();
        let mut core = world.core(py)?;
        let handle = core.add_body(def).map_err(to_py)?;
        body.get().place.enter(handle);
        world.objects().bodies.push(body.clone().unbind());
        drop(core);
        Ok(body)
    }
}

#[pymethods]
impl World {
    /// Adds a body of a shape, of several (a compound), or of none (a point, which needs a mass).
    ///
    /// `position` (m) and `angle` (rad) place the body's frame, in which its shapes are given; `velocity` (m/s)
    /// is that of its centre of mass. `mass` (kg), `inertia` (kg·m², about the centre of mass) and
    /// `center_of_mass` (m, in the body's frame) stand instead of what follows from shapes and densities.
    /// `drag_width` is "silhouette", "bounding_box" or a width (m). `force` (N) and `torque` (N·m) are constant.
    #[pyo3(signature = (
        shape=None, *, kind=DYNAMIC, position=ZERO, angle=0.0, velocity=ZERO, angular_velocity=0.0,
        density=1.0, mass=None, inertia=None, center_of_mass=None, lock_x=false, lock_y=false,
        lock_rotation=false, gravity_scale=1.0, linear_damping=0.0, angular_damping=0.0,
        drag_coefficient=0.4, drag_width=SILHOUETTE, force=ZERO, torque=0.0, name=None,
    ))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn add_body<'py>(
        slf: &Bound<'py, Self>,
        shape: Option<&Bound<'py, PyAny>>,
        kind: KindArg,
        position: Vec2Arg,
        angle: Real,
        velocity: Vec2Arg,
        angular_velocity: Real,
        density: Real,
        mass: Option<Real>,
        inertia: Option<Real>,
        center_of_mass: Option<Vec2Arg>,
        lock_x: bool,
        lock_y: bool,
        lock_rotation: bool,
        gravity_scale: Real,
        linear_damping: Real,
        angular_damping: Real,
        drag_coefficient: Real,
        drag_width: WidthArg,
        force: Vec2Arg,
        torque: Real,
        name: Option<String>,
    ) -> PyResult<Bound<'py, Body>> {
        let def = BodyDef {
            name,
            kind: kind.0,
            position: position.0,
            angle,
            velocity: velocity.0,
            angular_velocity,
            shapes: parts(shape)?,
            density,
            mass,
            inertia,
            center_of_mass: center_of_mass.map(|center| center.0),
            locks: Locks { x: lock_x, y: lock_y, rotation: lock_rotation },
            gravity_scale,
            linear_damping,
            angular_damping,
            drag_coefficient,
            drag_width: drag_width.0,
            force: force.0,
            torque,
        };
        Self::insert(slf, def)
    }
}
