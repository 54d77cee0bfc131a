//! Objects from joints: the core's builders, and the Python objects of what they add.
//!
//! `culbuto.builders` makes its classes of the bodies and joints that come from here.

use culbuto::World as Core;
use culbuto::builders::{
    Assembly, BridgeDef, ChainDef, Elasticity, End, LatticeDef, Moduli, Pattern, RagdollDef,
    RopeDef, RopeForm, VehicleDef,
};
use culbuto::error::Result;
use culbuto::joint::{Coefficients, Spring};
use culbuto::math::{Real, vec2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::body::Body;
use crate::convert::{Vec2Arg, count, vectors};
use crate::error::to_py;
use crate::joint::Joint;
use crate::joint_pickle::Classes;
use crate::parts::Place;
use crate::world::World;

const ORIGIN: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));

/// Bodies and joints of Python, as they go to the classes of `culbuto.builders`.
type Parts<'py> = (Bound<'py, PyTuple>, Bound<'py, PyTuple>);

/// What was built, by a class of `culbuto.builders`.
fn made<'py>(
    py: Python<'py>,
    class: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("culbuto.builders")?.getattr(class)?.call1(arguments)
}

/// Builds on a copy of the world, makes the Python objects that this takes while no lock is held, and builds again in the
/// world itself. So what is refused is refused before the world is touched, and objects and core stay in step.
fn build<'py, T>(
    world: &Bound<'py, World>,
    build: impl Fn(&mut Core) -> Result<T>,
    parts: impl Fn(&T) -> Assembly,
) -> PyResult<(Parts<'py>, T)> {
    let (py, own) = (world.py(), world.get());
    let mut trial = own.core(py)?.clone();
    let tried = parts(&build(&mut trial).map_err(to_py)?);
    let bodies = (tried.bodies.iter())
        .map(|_| Bound::new(py, Body { place: Place::new(world) }))
        .collect::<PyResult<Vec<_>>>()?;
    let classes = Classes::known(py)?;
    let joints = (trial.joints().iter().skip(trial.joints().len() - tried.joints.len()))
        .map(|joint| Joint::placed(world, &classes.of(joint)?))
        .collect::<PyResult<Vec<_>>>()?;
    let mut core = own.core(py)?;
    let built = {
        let _at_work = own.at_work();
        build(&mut core).map_err(to_py)?
    };
    let added = parts(&built);
    let mut objects = own.objects();
    for (body, handle) in bodies.iter().zip(added.bodies) {
        body.get().place.enter(handle);
        objects.bodies.push(body.clone().unbind());
    }
    for (joint, handle) in joints.iter().zip(added.joints) {
        joint.get().enter(handle);
        objects.joints.push(joint.clone().unbind());
    }
    drop(objects);
    drop(core);
    Ok(((PyTuple::new(py, bodies)?, PyTuple::new(py, joints)?), built))
}

/// A rope, a chain or a bridge.
fn assembled<'py>(
    world: &Bound<'py, World>,
    put: impl Fn(&mut Core) -> Result<Assembly>,
) -> PyResult<Bound<'py, PyAny>> {
    let (parts, _) = build(world, put, Assembly::clone)?;
    made(world.py(), "Assembly", parts)
}

/// The ends of something long. Those that are not pinned are points of the world that nothing holds.
fn ends(
    world: &Bound<'_, World>,
    given: [&Bound<'_, PyAny>; 2],
    pinned: (bool, bool),
) -> PyResult<[End; 2]> {
    let end = |name: &str, given: &Bound<'_, PyAny>, pinned: bool| {
        let body = given.get_item(0).ok().filter(PyAnyMethods::is_instance_of::<Body>);
        if body.is_none() {
            let Vec2Arg(point) = crate::surface::argument(name, given)?;
            return Ok(if pinned { End::World(point) } else { End::Free(point) });
        }
        let (body, Vec2Arg(local)) =
            crate::surface::argument::<(Bound<'_, Body>, Vec2Arg)>(name, given)?;
        if !pinned {
            let message = format!(
                "{name} is a point of a body; allowed where it is not pinned: one of the world"
            );
            return Err(PyValueError::new_err(message));
        }
        let place = &body.get().place;
        place.check_world(world)?;
        Ok(End::Body(place.handle()?, local))
    };
    Ok([end("start", given[0], pinned.0)?, end("end", given[1], pinned.1)?])
}

/// Adds a rope of links, or of points with rods between them.
#[pyfunction]
#[pyo3(signature = (
    world, start, end, *, pinned=(true, true), length=None, links=20, mass_per_length=1.0, points=false, radius=None,
    bending_stiffness=0.0, bending_damping=0.0, breaking_force=None, name="rope".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn rope<'py>(
    world: &Bound<'py, World>,
    start: &Bound<'py, PyAny>,
    end: &Bound<'py, PyAny>,
    pinned: (bool, bool),
    length: Option<Real>,
    links: i64,
    mass_per_length: Real,
    points: bool,
    radius: Option<Real>,
    bending_stiffness: Real,
    bending_damping: Real,
    breaking_force: Option<Real>,
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    if points && radius.is_some() {
        return Err(PyValueError::new_err("radius is given; allowed: None for a rope of points"));
    }
    let bends = bending_stiffness != 0.0 || bending_damping != 0.0;
    let def = RopeDef {
        name,
        length,
        links: count("links", links)? as usize,
        mass_per_length,
        form: if points { RopeForm::Points } else { RopeForm::Links { radius } },
        bending: bends
            .then_some(Coefficients { stiffness: bending_stiffness, damping: bending_damping }),
        breaking_force,
        ..RopeDef::new(ends(world, [start, end], pinned)?)
    };
    assembled(world, |core| def.build(core))
}

/// Adds a chain of links that hang together.
#[pyfunction]
#[pyo3(signature = (
    world, start, end, *, pinned=(true, true), length=None, links=20, mass_per_length=1.0, wire=None,
    breaking_force=None, name="chain".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn chain<'py>(
    world: &Bound<'py, World>,
    start: &Bound<'py, PyAny>,
    end: &Bound<'py, PyAny>,
    pinned: (bool, bool),
    length: Option<Real>,
    links: i64,
    mass_per_length: Real,
    wire: Option<Real>,
    breaking_force: Option<Real>,
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    let def = ChainDef {
        name,
        length,
        links: count("links", links)? as usize,
        mass_per_length,
        wire,
        breaking_force,
        ..ChainDef::new(ends(world, [start, end], pinned)?)
    };
    assembled(world, |core| def.build(core))
}

/// Adds a bridge of planks hinged end to end.
#[pyfunction]
#[pyo3(signature = (
    world, start, end, *, pinned=(true, true), length=None, planks=12, mass_per_length=1.0, thickness=None,
    breaking_force=None, name="bridge".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn bridge<'py>(
    world: &Bound<'py, World>,
    start: &Bound<'py, PyAny>,
    end: &Bound<'py, PyAny>,
    pinned: (bool, bool),
    length: Option<Real>,
    planks: i64,
    mass_per_length: Real,
    thickness: Option<Real>,
    breaking_force: Option<Real>,
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    let def = BridgeDef {
        name,
        length,
        planks: count("planks", planks)? as usize,
        mass_per_length,
        thickness,
        breaking_force,
        ..BridgeDef::new(ends(world, [start, end], pinned)?)
    };
    assembled(world, |core| def.build(core))
}

/// Adds a human figure of eleven capsules and ten hinges.
#[pyfunction]
#[pyo3(signature = (
    world, height, mass, *, position=ORIGIN, angle=0.0, velocity=ORIGIN, faces_left=false, limits=true, hertz=None,
    damping_ratio=0.0, friction_torque=0.0, group=None, breaking_force=None, name="ragdoll".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn ragdoll<'py>(
    world: &Bound<'py, World>,
    height: Real,
    mass: Real,
    position: Vec2Arg,
    angle: Real,
    velocity: Vec2Arg,
    faces_left: bool,
    limits: bool,
    hertz: Option<Real>,
    damping_ratio: Real,
    friction_torque: Real,
    group: Option<i64>,
    breaking_force: Option<Real>,
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    let def = RagdollDef {
        name,
        position: position.0,
        angle,
        velocity: velocity.0,
        faces_left,
        limits,
        spring: hertz.map(|hertz| Spring::Frequency { hertz, damping_ratio }),
        friction_torque,
        group: group.map(crate::surface::group).transpose()?,
        breaking_force,
        ..RagdollDef::new(height, mass)
    };
    let (parts, _) = build(world, |core| def.build(core), |built| built.parts.clone())?;
    made(world.py(), "Ragdoll", parts)
}

/// Adds a chassis on two wheels with suspension.
#[pyfunction]
#[pyo3(signature = (
    world, length, mass, *, position=ORIGIN, angle=0.0, velocity=ORIGIN, height=None, wheel_base=None,
    wheel_radius=None, wheel_mass=None, suspension_hertz=2.0, suspension_damping_ratio=0.7, suspension_travel=None,
    speed=0.0, max_torque=None, driven=(true, false), name="vehicle".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn vehicle<'py>(
    world: &Bound<'py, World>,
    length: Real,
    mass: Real,
    position: Vec2Arg,
    angle: Real,
    velocity: Vec2Arg,
    height: Option<Real>,
    wheel_base: Option<Real>,
    wheel_radius: Option<Real>,
    wheel_mass: Option<Real>,
    suspension_hertz: Real,
    suspension_damping_ratio: Real,
    suspension_travel: Option<Real>,
    speed: Real,
    max_torque: Option<Real>,
    driven: (bool, bool),
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    let def = VehicleDef {
        name,
        position: position.0,
        angle,
        velocity: velocity.0,
        height,
        wheel_base,
        wheel_radius,
        wheel_mass,
        suspension_hertz,
        suspension_damping: suspension_damping_ratio,
        suspension_travel,
        speed,
        max_torque,
        driven: driven.into(),
        ..VehicleDef::new(length, mass)
    };
    let parts = |built: &culbuto::builders::Vehicle| Assembly {
        bodies: vec![built.chassis, built.wheels[0], built.wheels[1]],
        joints: built.axles.to_vec(),
    };
    let ((bodies, axles), built) = build(world, |core| def.build(core), parts)?;
    made(world.py(), "Vehicle", (bodies, axles, built.wheel_radius))
}

/// How the points of a lattice stand, as an argument.
#[derive(Clone, Copy)]
pub struct PatternArg(Pattern);

impl<'py> FromPyObject<'_, 'py> for PatternArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<&str>() {
            Ok("triangular") => Ok(Self(Pattern::Triangular)),
            Ok("square") => Ok(Self(Pattern::Square)),
            Ok("braced_square") => Ok(Self(Pattern::BracedSquare)),
            _ => Err(PyValueError::new_err(format!(
                "pattern is {}; allowed: 'triangular', 'square', 'braced_square'",
                object.repr()?
            ))),
        }
    }
}

/// Adds points that fill a polygon, with springs between neighbours.
#[pyfunction]
#[pyo3(signature = (
    world, outline, spacing, *, stiffness=None, young=None, holes=None, pattern=PatternArg(Pattern::Triangular),
    damping_ratio=0.02, mass_per_area=1.0, radius=None, velocity=ORIGIN, breaking_force=None,
    name="lattice".to_owned(),
))]
#[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
pub fn lattice<'py>(
    world: &Bound<'py, World>,
    outline: &Bound<'py, PyAny>,
    spacing: Real,
    stiffness: Option<Real>,
    young: Option<Real>,
    holes: Option<&Bound<'py, PyAny>>,
    pattern: PatternArg,
    damping_ratio: Real,
    mass_per_area: Real,
    radius: Option<Real>,
    velocity: Vec2Arg,
    breaking_force: Option<Real>,
    name: String,
) -> PyResult<Bound<'py, PyAny>> {
    let elasticity = match (stiffness, young) {
        (Some(stiffness), None) => Elasticity::Stiffness(stiffness),
        (None, Some(young)) => Elasticity::Young(young),
        _ => return Err(PyTypeError::new_err("a lattice takes either stiffness or young")),
    };
    let mut rings = Vec::new();
    if let Some(holes) = holes {
        for hole in holes.try_iter()? {
            rings.push(vectors("a hole of the lattice", &hole?, None)?);
        }
    }
    let def = LatticeDef {
        name,
        holes: rings,
        pattern: pattern.0,
        damping_ratio,
        mass_per_area,
        radius,
        velocity: velocity.0,
        breaking_force,
        ..LatticeDef::new(vectors("outline", outline, None)?, spacing, elasticity)
    };
    let (parts, built) = build(world, |core| def.build(core), |built| built.parts.clone())?;
    let Moduli { stiffness, young, poisson, shear } = built.moduli;
    let (bodies, joints) = parts;
    made(world.py(), "Lattice", (bodies, joints, stiffness, young, poisson, shear, built.area))
}
