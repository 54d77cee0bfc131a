//! Adding a deformable body, with everything it may be given.

use culbuto::body::{Filter, Friction, Surface};
use culbuto::math::{Real, vec2};
use culbuto::soft::{Gas, Material, Mesh, Plane, Rope, SoftDef};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::convert::{self, Vec2Arg, count};
use crate::error::to_py;
use crate::parts::Place;
use crate::shape::Shape;
use crate::soft::{SoftBody, numbers};
use crate::surface::{self, FrictionArg};
use crate::world::World;

const ZERO: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));
const FRICTION: FrictionArg = FrictionArg(Friction::of(0.5));
const STRESS: PlaneArg = PlaneArg(Plane::Stress);

/// What is zero across the plane, as an argument.
#[derive(Clone, Copy)]
struct PlaneArg(Plane);

impl<'py> FromPyObject<'_, 'py> for PlaneArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<&str>() {
            Ok("stress") => Ok(Self(Plane::Stress)),
            Ok("strain") => Ok(Self(Plane::Strain)),
            _ => Err(PyValueError::new_err(format!(
                "plane is {}; allowed: 'stress', 'strain'",
                object.repr()?
            ))),
        }
    }
}

/// The word for what is zero across the plane.
pub fn plane_name(plane: Plane) -> &'static str {
    match plane {
        Plane::Stress => "stress",
        Plane::Strain => "strain",
    }
}

/// An error unless a keyword that says nothing here was left out.
fn unwanted(given: bool, name: &str, allowed: &str) -> PyResult<()> {
    if given {
        return Err(PyValueError::new_err(format!("{name} is given; allowed: {allowed}")));
    }
    Ok(())
}

/// How finely a shape or an outline is cut, or the triangles between points.
struct Cut<'a, 'py> {
    size: Option<Real>,
    triangles: Option<&'a Bound<'py, PyAny>>,
}

impl Cut<'_, '_> {
    fn mesh(&self, shape: &Bound<'_, PyAny>) -> PyResult<Mesh> {
        let size = || {
            self.size.ok_or_else(|| {
                let message =
                    "size is missing; allowed: about how long the sides of triangles are (m)";
                PyValueError::new_err(message)
            })
        };
        if let Ok(shape) = shape.cast::<Shape>() {
            unwanted(
                self.triangles.is_some(),
                "triangles",
                "nothing beside a shape, which is cut by size",
            )?;
            return Mesh::of_shape(&shape.get().part.shape, size()?).map_err(to_py);
        }
        let points = convert::vectors("shape", shape, None)?;
        match self.triangles {
            Some(triangles) => {
                unwanted(
                    self.size.is_some(),
                    "size",
                    "nothing beside triangles, which are not cut",
                )?;
                let triangles: Vec<[u32; 3]> =
                    numbers("triangles", triangles, "(m, 3) numbers of points, 0 or above")?;
                Mesh::new(&points, &triangles)
            }
            None => Mesh::polygon(&points, &[], size()?),
        }
        .map_err(to_py)
    }

    /// A rope has neither.
    fn rope(&self, points: &Bound<'_, PyAny>, closed: bool) -> PyResult<Mesh> {
        unwanted(
            self.size.is_some(),
            "size",
            "nothing for a rope, which has a rod from point to point",
        )?;
        unwanted(self.triangles.is_some(), "triangles", "nothing for a rope, which has none")?;
        if points.cast::<Shape>().is_ok() {
            let message =
                "shape is a shape; allowed with stretch_stiffness: the points (n, 2) of a rope";
            return Err(PyValueError::new_err(message));
        }
        Mesh::rope(&convert::vectors("shape", points, None)?, closed).map_err(to_py)
    }
}

impl World {
    fn insert_soft<'py>(slf: &Bound<'py, Self>, def: SoftDef) -> PyResult<Bound<'py, SoftBody>> {
        let body = Bound::new(slf.py(), SoftBody { place: Place::new(slf) })?;
        let world = slf.get();
        let mut core = world.core(slf.py())?;
        let handle = core.add_soft_body(def).map_err(to_py)?;
        body.get().place.enter(handle);
        world.objects().softs.push(body.clone().unbind());
        drop(core);
        Ok(body)
    }
}

#[pymethods]
impl World {
    /// Adds a deformable body: a shape or an outline (n, 2) in triangles with sides of about `size` (m); points (n, 2) with
    /// `triangles` (m, 3) between them; or, with a `stretch_stiffness` EA (N), a rope through points, `closed` or not.
    ///
    /// The shape is in the body's frame, which `position` (m) and `angle` (rad) place; `velocity` (m/s) is that of the centre of
    /// mass. `density` is in kg/m², of ropes in kg/m; `youngs_modulus` in Pa; `plane` is "stress" (a thin sheet) or "strain" (a
    /// slice of something long); `damping_ratio` is the part of critical damping at `damping_frequency` (Hz); beyond a difference
    /// of principal strains `yield_strain` it stays bent. `bending_stiffness` EI is in N·m². A closed rope may hold a gas:
    /// `gas_pressure` (Pa) in its area at rest, `outside_pressure` (Pa) against it, γ of pAᵞ the `gas_exponent`.
    ///
    /// `pins` are numbers of nodes that stay where they are; `radius` (m) is by how much the border is thicker than its nodes say.
    /// Bodies touch as `category`, `mask` and `group` say, and itself if it `touches_itself`.
    #[pyo3(signature = (
        shape, *, size=None, triangles=None, position=ZERO, angle=0.0, velocity=ZERO, angular_velocity=0.0,
        density=1000.0, youngs_modulus=1e6, poissons_ratio=0.3, plane=STRESS, damping_ratio=0.0,
        damping_frequency=1.0, yield_strain=None, stretch_stiffness=None, bending_stiffness=0.0, closed=false,
        gas_pressure=None, outside_pressure=0.0, gas_exponent=1.0, gravity_scale=1.0, pins=None, radius=None,
        touches_itself=false, friction=FRICTION, restitution=0.0, tangent_speed=0.0,
        material=None, category=1, mask=4_294_967_295, group=0, name=None,
    ))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn add_soft_body<'py>(
        slf: &Bound<'py, Self>,
        shape: &Bound<'py, PyAny>,
        size: Option<Real>,
        triangles: Option<&Bound<'py, PyAny>>,
        position: Vec2Arg,
        angle: Real,
        velocity: Vec2Arg,
        angular_velocity: Real,
        density: Real,
        youngs_modulus: Real,
        poissons_ratio: Real,
        plane: PlaneArg,
        damping_ratio: Real,
        damping_frequency: Real,
        yield_strain: Option<Real>,
        stretch_stiffness: Option<Real>,
        bending_stiffness: Real,
        closed: bool,
        gas_pressure: Option<Real>,
        outside_pressure: Real,
        gas_exponent: Real,
        gravity_scale: Real,
        pins: Option<&Bound<'py, PyAny>>,
        radius: Option<Real>,
        touches_itself: bool,
        friction: FrictionArg,
        restitution: Real,
        tangent_speed: Real,
        material: Option<String>,
        category: i64,
        mask: i64,
        group: i64,
        name: Option<String>,
    ) -> PyResult<Bound<'py, SoftBody>> {
        let cut = Cut { size, triangles };
        let mesh = if stretch_stiffness.is_some() {
            cut.rope(shape, closed)?
        } else {
            let only = "only with stretch_stiffness, for ropes";
            unwanted(closed, "closed", only)?;
            unwanted(bending_stiffness != 0.0, "bending_stiffness", only)?;
            cut.mesh(shape)?
        };
        let empty = gas_pressure.is_none();
        unwanted(empty && outside_pressure != 0.0, "outside_pressure", "only with gas_pressure")?;
        unwanted(empty && gas_exponent != 1.0, "gas_exponent", "only with gas_pressure")?;
        let friction = friction.0;
        let def = SoftDef {
            material: Material {
                density,
                youngs_modulus,
                poissons_ratio,
                damping_ratio,
                damping_frequency,
                plane: plane.0,
                yield_strain,
            },
            rope: stretch_stiffness
                .map(|stretch_stiffness| Rope { stretch_stiffness, bending_stiffness }),
            gas: gas_pressure.map(|pressure| Gas {
                pressure,
                outside: outside_pressure,
                exponent: gas_exponent,
            }),
            position: position.0,
            angle,
            velocity: velocity.0,
            angular_velocity,
            gravity_scale,
            pins: pins
                .map_or_else(|| Ok(Vec::new()), |pins| numbers("pins", pins, "numbers of nodes"))?,
            radius,
            surface: Surface {
                friction,
                restitution,
                tangent_speed,
                material,
                ..Surface::default()
            },
            filter: Filter {
                category: count("category", category)?,
                mask: count("mask", mask)?,
                group: surface::group(group)?,
            },
            touches_itself,
            name,
            mesh,
        };
        Self::insert_soft(slf, def)
    }

    /// All deformable bodies.
    #[getter]
    fn soft_bodies(&self, py: Python<'_>) -> Vec<Py<SoftBody>> {
        self.objects().softs.iter().map(|body| body.clone_ref(py)).collect()
    }
}
