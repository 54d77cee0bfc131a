//! What all shapes have in common.

use std::hash::{DefaultHasher, Hash, Hasher};

use culbuto::math::{self, Real};
use culbuto::shapes::{self, ShapeDef};
use culbuto::{Part, shapes::Shape as CoreShape};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::Vec2Arg;
use crate::error::to_py;
use crate::record::record;
use crate::surface::{Own, keywords};
use crate::vec2::Vec2;

record! {
    /// Mass, centre of mass and moment of inertia.
    MassProperties {
        /// Mass (kg).
        mass: Real,
        /// Centre of mass (m).
        center: Vec2,
        /// Moment of inertia about the centre of mass (kg·m²).
        inertia: Real,
    }
}

/// Any shape: immutable, in the frame of the body it belongs to (lengths in m, angles in rad).
///
/// Shapes are values: equal if they have the same kind, numbers, density and surface. All take the keywords `density`,
/// `friction`, `restitution`, `rolling_resistance`, `tangent_speed`, `material`, `category`, `mask`, `group`, `sensor`
/// and `one_way`; what is not given is the body's.
#[pyclass(frozen, subclass, module = "culbuto")]
pub struct Shape {
    pub part: Part,
}

#[pymethods]
impl Shape {
    /// Mass per area (kg/m²), per length of a wire (kg/m); None: the body's.
    #[getter]
    fn density(&self) -> Option<Real> {
        self.part.density
    }

    /// Area (m²), 0 for wires.
    #[getter]
    fn area(&self) -> Real {
        self.part.shape.area()
    }

    /// Length of the boundary, holes included; the length of a wire (m).
    #[getter]
    fn perimeter(&self) -> Real {
        self.part.shape.perimeter()
    }

    /// What density multiplies: the area (m²), or the length of a wire (m).
    #[getter]
    fn measure(&self) -> Real {
        self.part.shape.measure()
    }

    /// Centroid (m).
    #[getter]
    fn centroid(&self) -> Vec2 {
        Vec2(self.part.shape.centroid())
    }

    /// ∫ r² about the centroid for unit density (m⁴; m³ for wires).
    #[getter]
    fn second_moment(&self) -> Real {
        self.part.shape.second_moment()
    }

    /// Lower left and upper right corner of the smallest box along the axes (m).
    #[getter]
    fn bounds(&self) -> (Vec2, Vec2) {
        let bounds = self.part.shape.bounds();
        (Vec2(bounds.min), Vec2(bounds.max))
    }

    /// Convex polygons that cover the shape without overlap, counter-clockwise, each (n, 2) (m). Of a
    /// rounded polygon its core; none for circles, capsules and wires.
    #[getter]
    fn convex_pieces<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<Real>>>> {
        self.part.shape.convex_pieces().iter().map(|piece| rows(py, piece)).collect()
    }

    /// Whether a point (m) belongs to the shape, its border included. Wires hold no point.
    fn contains(&self, point: Vec2Arg) -> bool {
        self.part.shape.contains(point.0)
    }

    /// Least and greatest coordinate of the shape along a direction (m). Only the direction of the
    /// vector counts, not its length.
    fn projection(&self, direction: Vec2Arg) -> PyResult<(Real, Real)> {
        let interval = self.part.shape.projection(unit(direction)?);
        Ok((interval.min, interval.max))
    }

    /// Width of the shadow along a direction (m): the extent of the shape along that vector.
    fn projected_width(&self, direction: Vec2Arg) -> PyResult<Real> {
        Ok(self.part.shape.projection(unit(direction)?).length())
    }

    /// Mass, centre and inertia for a density in kg/m², or in kg/m for wires.
    fn mass_properties(&self, density: Real) -> PyResult<MassProperties> {
        checked_density(density)?;
        let shapes::MassProperties { mass, center, inertia } =
            self.part.shape.mass_properties(density);
        Ok(MassProperties { mass, center: Vec2(center), inertia })
    }

    /// Polylines to draw, each (n, 2) (m): outline and holes, which end where they begin, or the wire.
    /// Arcs are drawn through points at most `max_angle` (rad) apart.
    #[pyo3(signature = (max_angle=0.1))]
    fn outline<'py>(
        &self,
        py: Python<'py>,
        max_angle: Real,
    ) -> PyResult<Vec<Bound<'py, PyArray2<Real>>>> {
        if max_angle.is_nan() || max_angle <= 0.0 {
            let message = format!("max_angle is {max_angle}; allowed: a number above 0");
            return Err(PyValueError::new_err(message));
        }
        let rings = self.part.shape.outline(max_angle).into_iter().map(|mut ring| {
            if ring.closed {
                ring.points.extend(ring.points.first().copied());
            }
            rows(py, &ring.points)
        });
        rings.collect()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().part == self.part)
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        std::mem::discriminant(self.part.shape.def()).hash(&mut hasher);
        for number in numbers(self.part.shape.def()).into_iter().chain(self.part.density) {
            (number + 0.0).to_bits().hash(&mut hasher); // −0 equals 0
        }
        hasher.finish()
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (arguments, named) = arguments(slf)?;
        let mut shown: Vec<String> = Vec::new();
        for argument in &arguments {
            shown.push(argument.repr()?.to_string());
        }
        for (name, value) in &named {
            shown.push(format!("{name}={}", value.repr()?));
        }
        Ok(format!("{}({})", slf.get_type().name()?, shown.join(", ")))
    }

    fn __getnewargs_ex__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        arguments(slf)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

/// A density, 0 or above.
pub fn checked_density(density: Real) -> PyResult<Real> {
    if density.is_finite() && density >= 0.0 {
        return Ok(density);
    }
    let message = format!("density is {density}; allowed: a finite number, 0 or above");
    Err(PyValueError::new_err(message))
}

/// A direction as a unit vector.
fn unit(direction: Vec2Arg) -> PyResult<math::Vec2> {
    let unit = direction.0.try_normalize(0.0).filter(|v| v.x.is_finite() && v.y.is_finite());
    unit.ok_or_else(|| {
        let (x, y) = (direction.0.x, direction.0.y);
        PyValueError::new_err(format!(
            "direction is ({x}, {y}); allowed: two finite numbers, not both 0"
        ))
    })
}

/// Points as an (n, 2) array.
pub fn rows<'py>(py: Python<'py>, points: &[math::Vec2]) -> PyResult<Bound<'py, PyArray2<Real>>> {
    let flat: Vec<Real> = points.iter().flat_map(|p| [p.x, p.y]).collect();
    numpy::PyArray1::from_vec(py, flat).reshape([points.len(), 2])
}

/// The arguments that make a shape again: in order, and by name those that are not the default.
fn arguments<'py>(
    shape: &Bound<'py, Shape>,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
    let py = shape.py();
    let part = &shape.get().part;
    let pair = |v: &math::Vec2| (v.x, v.y);
    let pairs = |points: &[math::Vec2]| points.iter().map(pair).collect::<Vec<_>>();
    let named = PyDict::new(py);
    let place = |center: &math::Vec2| match *center == math::vec2(0.0, 0.0) {
        true => Ok(()),
        false => named.set_item("center", pair(center)),
    };
    let turn = |angle: Real| if angle == 0.0 { Ok(()) } else { named.set_item("angle", angle) };
    let arguments = match part.shape.def() {
        ShapeDef::Circle { radius, center } => {
            place(center)?;
            (*radius,).into_pyobject(py)?
        }
        ShapeDef::Box { width, height, center, angle } => {
            place(center)?;
            turn(*angle)?;
            (*width, *height).into_pyobject(py)?
        }
        ShapeDef::RegularPolygon { sides, radius, center, angle } => {
            place(center)?;
            turn(*angle)?;
            (*sides, *radius).into_pyobject(py)?
        }
        ShapeDef::Polygon { vertices, holes, radius } => {
            if !holes.is_empty() {
                let holes: Vec<_> = holes.iter().map(|hole| pairs(hole)).collect();
                named.set_item("holes", holes)?;
            }
            match *radius > 0.0 {
                true => (pairs(vertices), *radius).into_pyobject(py)?,
                false => (pairs(vertices),).into_pyobject(py)?,
            }
        }
        ShapeDef::Capsule { a, b, radius } => (pair(a), pair(b), *radius).into_pyobject(py)?,
        ShapeDef::Segment { a, b } => (pair(a), pair(b)).into_pyobject(py)?,
        ShapeDef::Arc { center, radius, start, sweep } => {
            (pair(center), *radius, *start, *sweep).into_pyobject(py)?
        }
        ShapeDef::Chain { points, closed, one_sided } => {
            for (name, flag) in [("closed", closed), ("one_sided", one_sided)] {
                if *flag {
                    named.set_item(name, true)?;
                }
            }
            (pairs(points),).into_pyobject(py)?
        }
    };
    keywords(shape.get(), &named)?;
    Ok((arguments, named))
}

/// All numbers of a definition.
fn numbers(def: &ShapeDef) -> Vec<Real> {
    match def {
        ShapeDef::Circle { radius, center } => vec![*radius, center.x, center.y],
        ShapeDef::Box { width, height, center, angle } => {
            vec![*width, *height, center.x, center.y, *angle]
        }
        ShapeDef::RegularPolygon { sides, radius, center, angle } => {
            vec![Real::from(*sides), *radius, center.x, center.y, *angle]
        }
        ShapeDef::Polygon { vertices, holes, radius } => {
            let points = vertices.iter().chain(holes.iter().flatten());
            points.flat_map(|p| [p.x, p.y]).chain([*radius]).collect()
        }
        ShapeDef::Capsule { a, b, radius } => vec![a.x, a.y, b.x, b.y, *radius],
        ShapeDef::Segment { a, b } => vec![a.x, a.y, b.x, b.y],
        ShapeDef::Arc { center, radius, start, sweep } => {
            vec![center.x, center.y, *radius, *start, *sweep]
        }
        ShapeDef::Chain { points, closed, one_sided } => {
            let flags = [closed, one_sided].map(|&flag| Real::from(u8::from(flag)));
            points.iter().flat_map(|p| [p.x, p.y]).chain(flags).collect()
        }
    }
}

/// Checks a definition and the keywords that go with it.
pub fn checked(
    def: ShapeDef,
    own: Option<&Bound<'_, PyDict>>,
) -> PyResult<PyClassInitializer<Shape>> {
    let Own { density, surface, filter, role } = Own::read(own)?;
    let shape = CoreShape::new(def).map_err(to_py)?;
    Ok(PyClassInitializer::from(Shape { part: Part { shape, density, surface, filter, role } }))
}

/// The shapes of a body as an argument: none, one, or a sequence of them.
pub fn parts(shape: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Part>> {
    let Some(shape) = shape else { return Ok(Vec::new()) };
    if let Ok(one) = shape.cast::<Shape>() {
        return Ok(vec![one.get().part.clone()]);
    }
    let wrong = |what: &Bound<'_, PyAny>| {
        let kind = what.get_type().name().map_or_else(|_| "it".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("a body is made of a Shape or a sequence of them, not {kind}"))
    };
    let items = shape.try_iter().map_err(|_| wrong(shape))?;
    let part = |item: PyResult<Bound<'_, PyAny>>| {
        let item = item?;
        Ok(item.cast::<Shape>().map_err(|_| wrong(&item))?.get().part.clone())
    };
    items.map(part).collect()
}
