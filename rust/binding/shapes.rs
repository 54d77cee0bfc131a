//! The shapes, one class each.
#![allow(clippy::needless_pass_by_value, reason = "PyO3 hands PyRef by value")]

use culbuto::Part;
use culbuto::math::{self, Real};
use culbuto::shapes::ShapeDef;
use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{self, Vec2Arg};
use crate::shape::{Shape, checked, rows};
use crate::vec2::Vec2;

const ORIGIN: Vec2Arg = Vec2Arg(math::vec2(0.0, 0.0));

/// A shape of Python for a part of the core.
pub fn to_python(py: Python<'_>, part: Part) -> PyResult<Bound<'_, PyAny>> {
    let def = part.shape.def().clone();
    let base = PyClassInitializer::from(Shape { part });
    Ok(match def {
        ShapeDef::Circle { .. } => Bound::new(py, base.add_subclass(Circle))?.into_any(),
        ShapeDef::Box { .. } => Bound::new(py, base.add_subclass(Rectangle))?.into_any(),
        ShapeDef::RegularPolygon { .. } => {
            Bound::new(py, base.add_subclass(RegularPolygon))?.into_any()
        }
        ShapeDef::Polygon { radius, .. } if radius > 0.0 => {
            Bound::new(py, base.add_subclass(RoundedPolygon))?.into_any()
        }
        ShapeDef::Polygon { .. } => Bound::new(py, base.add_subclass(Polygon))?.into_any(),
        ShapeDef::Capsule { .. } => Bound::new(py, base.add_subclass(Capsule))?.into_any(),
        ShapeDef::Segment { .. } => Bound::new(py, base.add_subclass(Segment))?.into_any(),
        ShapeDef::Arc { .. } => Bound::new(py, base.add_subclass(Arc))?.into_any(),
        ShapeDef::Chain { .. } => Bound::new(py, base.add_subclass(Chain))?.into_any(),
    })
}

/// Read-only properties of a class from the fields of its definition.
macro_rules! fields {
    ($class:ident: $variant:ident { $($(#[$doc:meta])* $field:ident: $type:ty = $convert:expr),* $(,)? }) => {
        #[pymethods]
        impl $class {
            $(
                $(#[$doc])*
                #[getter]
                fn $field(slf: PyRef<'_, Self>) -> PyResult<$type> {
                    let convert = $convert;
                    match slf.as_super().part.shape.def() {
                        ShapeDef::$variant { $field, .. } => Ok(convert($field)),
                        other => Err(PyValueError::new_err(format!("not a {other:?}"))),
                    }
                }
            )*
        }
    };
}

fn number(x: &Real) -> Real {
    *x
}

fn vector(v: &math::Vec2) -> Vec2 {
    Vec2(*v)
}

/// A disk.
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Circle;

#[pymethods]
impl Circle {
    #[new]
    #[pyo3(signature = (radius, *, center=ORIGIN, **own))]
    fn new(
        radius: Real,
        center: Vec2Arg,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let def = ShapeDef::Circle { radius, center: center.0 };
        Ok(checked(def, own)?.add_subclass(Self))
    }
}

fields! { Circle: Circle {
    /// Radius (m).
    radius: Real = number,
    /// Centre (m).
    center: Vec2 = vector,
} }

/// A rectangle.
#[pyclass(frozen, extends = Shape, name = "Box", module = "culbuto")]
pub struct Rectangle;

#[pymethods]
impl Rectangle {
    #[new]
    #[pyo3(signature = (width, height, *, center=ORIGIN, angle=0.0, **own))]
    fn new(
        width: Real,
        height: Real,
        center: Vec2Arg,
        angle: Real,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let def = ShapeDef::Box { width, height, center: center.0, angle };
        Ok(checked(def, own)?.add_subclass(Self))
    }

    /// Corners (4, 2), counter-clockwise (m).
    #[getter]
    fn vertices(slf: PyRef<'_, Self>) -> PyResult<Bound<'_, PyArray2<Real>>> {
        corners(slf.py(), slf.as_super())
    }
}

fields! { Rectangle: Box {
    /// Width along x before turning (m).
    width: Real = number,
    /// Height along y before turning (m).
    height: Real = number,
    /// Centre (m).
    center: Vec2 = vector,
    /// By which it is turned (rad).
    angle: Real = number,
} }

/// A polygon of equal sides and angles; its first vertex lies in the direction `angle`.
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct RegularPolygon;

#[pymethods]
impl RegularPolygon {
    #[new]
    #[pyo3(signature = (sides, radius, *, center=ORIGIN, angle=0.0, **own))]
    fn new(
        sides: i64,
        radius: Real,
        center: Vec2Arg,
        angle: Real,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let sides = convert::count("sides", sides)?;
        let def = ShapeDef::RegularPolygon { sides, radius, center: center.0, angle };
        Ok(checked(def, own)?.add_subclass(Self))
    }

    /// Vertices (n, 2), counter-clockwise (m).
    #[getter]
    fn vertices(slf: PyRef<'_, Self>) -> PyResult<Bound<'_, PyArray2<Real>>> {
        corners(slf.py(), slf.as_super())
    }
}

fields! { RegularPolygon: RegularPolygon {
    /// Number of sides.
    sides: u32 = |n: &u32| *n,
    /// Distance of the vertices from the centre (m).
    radius: Real = number,
    /// Centre (m).
    center: Vec2 = vector,
    /// Direction of the first vertex (rad).
    angle: Real = number,
} }

/// A simple polygon, convex or not, with or without holes. Vertices may be given in either direction.
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Polygon;

#[pymethods]
impl Polygon {
    #[new]
    #[pyo3(signature = (vertices, *, holes=None, **own))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        holes: Option<&Bound<'_, PyAny>>,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut rings = Vec::new();
        if let Some(holes) = holes {
            for hole in holes.try_iter()? {
                rings.push(convert::vectors("a hole of the polygon", &hole?, None)?);
            }
        }
        let vertices = convert::vectors("vertices", vertices, None)?;
        let def = ShapeDef::Polygon { vertices, holes: rings, radius: 0.0 };
        Ok(checked(def, own)?.add_subclass(Self))
    }

    /// Vertices (n, 2), cleaned, counter-clockwise (m).
    #[getter]
    fn vertices(slf: PyRef<'_, Self>) -> PyResult<Bound<'_, PyArray2<Real>>> {
        outline_of(slf.py(), slf.as_super())
    }

    /// Holes, each (n, 2), clockwise (m).
    #[getter]
    fn holes(slf: PyRef<'_, Self>) -> PyResult<Vec<Bound<'_, PyArray2<Real>>>> {
        let py = slf.py();
        match slf.as_super().part.shape.def() {
            ShapeDef::Polygon { holes, .. } => holes.iter().map(|hole| rows(py, hole)).collect(),
            _ => Ok(Vec::new()),
        }
    }
}

/// A convex polygon grown by a disk of this radius.
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct RoundedPolygon;

#[pymethods]
impl RoundedPolygon {
    #[new]
    #[pyo3(signature = (vertices, radius, **own))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        radius: Real,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        if radius == 0.0 {
            let message =
                "radius of the rounded polygon is 0; allowed: above 0 (a Polygon has none)";
            return Err(PyValueError::new_err(message));
        }
        let vertices = convert::vectors("vertices", vertices, None)?;
        let def = ShapeDef::Polygon { vertices, holes: Vec::new(), radius };
        Ok(checked(def, own)?.add_subclass(Self))
    }

    /// Vertices of the core (n, 2), cleaned, counter-clockwise (m).
    #[getter]
    fn vertices(slf: PyRef<'_, Self>) -> PyResult<Bound<'_, PyArray2<Real>>> {
        outline_of(slf.py(), slf.as_super())
    }
}

fields! { RoundedPolygon: Polygon {
    /// Radius of the disk (m).
    radius: Real = number,
} }

/// All points within `radius` of the segment from `a` to `b`.
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Capsule;

#[pymethods]
impl Capsule {
    #[new]
    #[pyo3(signature = (a, b, radius, **own))]
    fn new(
        a: Vec2Arg,
        b: Vec2Arg,
        radius: Real,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let def = ShapeDef::Capsule { a: a.0, b: b.0, radius };
        Ok(checked(def, own)?.add_subclass(Self))
    }
}

fields! { Capsule: Capsule {
    /// One end of the segment (m).
    a: Vec2 = vector,
    /// The other end (m).
    b: Vec2 = vector,
    /// Radius (m).
    radius: Real = number,
} }

/// A thin straight wire; its density is per length (kg/m).
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Segment;

#[pymethods]
impl Segment {
    #[new]
    #[pyo3(signature = (a, b, **own))]
    fn new(
        a: Vec2Arg,
        b: Vec2Arg,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        Ok(checked(ShapeDef::Segment { a: a.0, b: b.0 }, own)?.add_subclass(Self))
    }
}

fields! { Segment: Segment {
    /// One end (m).
    a: Vec2 = vector,
    /// The other end (m).
    b: Vec2 = vector,
} }

/// A thin circular wire from the direction `start` over the signed angle `sweep` (rad); its density is
/// per length (kg/m).
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Arc;

#[pymethods]
impl Arc {
    #[new]
    #[pyo3(signature = (center, radius, start, sweep, **own))]
    fn new(
        center: Vec2Arg,
        radius: Real,
        start: Real,
        sweep: Real,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let def = ShapeDef::Arc { center: center.0, radius, start, sweep };
        Ok(checked(def, own)?.add_subclass(Self))
    }
}

fields! { Arc: Arc {
    /// Centre of its circle (m).
    center: Vec2 = vector,
    /// Radius (m).
    radius: Real = number,
    /// Direction of its first point from the centre (rad).
    start: Real = number,
    /// Angle from its first point to its last (rad), counter-clockwise above 0.
    sweep: Real = number,
} }

/// Thin straight wires through points, one after another; their density is per length (kg/m).
#[pyclass(frozen, extends = Shape, module = "culbuto")]
pub struct Chain;

#[pymethods]
impl Chain {
    #[new]
    #[pyo3(signature = (points, *, closed=false, one_sided=false, **own))]
    fn new(
        points: &Bound<'_, PyAny>,
        closed: bool,
        one_sided: bool,
        own: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let points = convert::vectors("points", points, None)?;
        Ok(checked(ShapeDef::Chain { points, closed, one_sided }, own)?.add_subclass(Self))
    }

    /// The points (n, 2) (m).
    #[getter]
    fn points(slf: PyRef<'_, Self>) -> PyResult<Bound<'_, PyArray2<Real>>> {
        outline_of(slf.py(), slf.as_super())
    }
}

fields! { Chain: Chain {
    /// Whether the last point is joined to the first.
    closed: bool = bool::clone,
    /// Whether only the left side is solid.
    one_sided: bool = bool::clone,
} }

/// Corners of a shape that is its own only convex piece.
fn corners<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Bound<'py, PyArray2<Real>>> {
    rows(py, shape.part.shape.convex_pieces().first().map_or(&[][..], |piece| piece))
}

fn outline_of<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Bound<'py, PyArray2<Real>>> {
    match shape.part.shape.def() {
        ShapeDef::Polygon { vertices, .. } => rows(py, vertices),
        ShapeDef::Chain { points, .. } => rows(py, points),
        _ => rows(py, &[]),
    }
}
