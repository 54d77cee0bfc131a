//! Adding a body, with everything it may be given.

use culbuto::BodyDef;
use culbuto::body::{BodyHandle, BodyKind, DragWidth, Filter, Friction, Locks, Surface};
use culbuto::math::{Real, vec2};
use pyo3::prelude::*;

use crate::body::Body;
use crate::convert::{Vec2Arg, count};
use crate::error::to_py;
use crate::parts::Place;
use crate::shape::parts;
use crate::surface::{self, FrictionArg};
use crate::words::{KindArg, WidthArg};
use crate::world::World;

const ZERO: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));
const DYNAMIC: KindArg = KindArg(BodyKind::Dynamic);
const FRICTION: FrictionArg = FrictionArg(Friction::of(0.5));
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
    ///
    /// What shapes do not have of their own: `friction` is a number or two, static and kinetic; `rolling_resistance`
    /// an arm (m); `tangent_speed` that of a conveyor's belt (m/s). Two shapes touch if each one's `category` is in
    /// the other's `mask`; those of one `group` always if it is above 0, never if it is below. A `sensor` only
    /// notices; what is `one_way` stops only what comes from the side that vector points to, in the body's frame.
    #[pyo3(signature = (
        shape=None, *, kind=DYNAMIC, position=ZERO, angle=0.0, velocity=ZERO, angular_velocity=0.0,
        density=1.0, mass=None, inertia=None, center_of_mass=None, lock_x=false, lock_y=false,
        lock_rotation=false, gravity_scale=1.0, linear_damping=0.0, angular_damping=0.0,
        drag_coefficient=0.4, drag_width=SILHOUETTE, force=ZERO, torque=0.0, friction=FRICTION, restitution=0.0,
        rolling_resistance=0.0, tangent_speed=0.0, material=None, category=1, mask=4_294_967_295, group=0,
        sensor=false, one_way=None, name=None,
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
        friction: FrictionArg,
        restitution: Real,
        rolling_resistance: Real,
        tangent_speed: Real,
        material: Option<String>,
        category: i64,
        mask: i64,
        group: i64,
        sensor: bool,
        one_way: Option<Vec2Arg>,
        name: Option<String>,
    ) -> PyResult<Bound<'py, Body>> {
        let friction = friction.0;
        let surface =
            Surface { friction, restitution, rolling_resistance, tangent_speed, material };
        let filter = Filter {
            category: count("category", category)?,
            mask: count("mask", mask)?,
            group: surface::group(group)?,
        };
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
            surface,
            filter,
            role: surface::role(Some(sensor), one_way)?.unwrap_or_default(),
            force: force.0,
            torque,
        };
        Self::insert(slf, def)
    }
}
