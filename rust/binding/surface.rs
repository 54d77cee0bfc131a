//! How shapes touch: friction, restitution, filters and roles, of bodies and of shapes.

use culbuto::body::{Filter, FilterOverride, Friction, Role, Surface, SurfaceOverride};
use culbuto::math::Real;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::body::Body;
use crate::convert::{Vec2Arg, count};
use crate::error::to_py;
use crate::shape::{Shape, checked_density};
use crate::vec2::Vec2;

/// Static and kinetic friction as Python sees them.
pub type Coefficients = (Real, Real);

/// Friction as an argument: a number for both coefficients, or two, static and kinetic.
#[derive(Clone, Copy)]
pub struct FrictionArg(pub Friction);

impl<'py> FromPyObject<'_, 'py> for FrictionArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(both) = object.extract::<Real>() {
            return Ok(Self(Friction::of(both)));
        }
        let wrong =
            || PyTypeError::new_err("expected a number, or two: static and kinetic friction");
        if object.len().map_err(|_| wrong())? != 2 {
            return Err(wrong());
        }
        let number = |i: usize| object.get_item(i)?.extract::<Real>().map_err(|_| wrong());
        Ok(Self(Friction { sticking: number(0)?, sliding: number(1)? }))
    }
}

/// Static and kinetic friction as a tuple.
pub fn coefficients(friction: Friction) -> Coefficients {
    (friction.sticking, friction.sliding)
}

/// A group as an argument.
pub fn group(n: i64) -> PyResult<i32> {
    i32::try_from(n).map_err(|_| {
        let (low, high) = (i32::MIN, i32::MAX);
        PyValueError::new_err(format!("group is {n}; allowed: a whole number from {low} to {high}"))
    })
}

/// The role that two keywords speak of, if they do.
pub fn role(sensor: Option<bool>, one_way: Option<Vec2Arg>) -> PyResult<Option<Role>> {
    Ok(match (sensor, one_way) {
        (Some(true), Some(_)) => {
            let message = "a sensor stops nothing from any side: give sensor or one_way, not both";
            return Err(PyValueError::new_err(message));
        }
        (_, Some(side)) => Some(Role::OneWay(side.0)),
        (Some(true), None) => Some(Role::Sensor),
        (Some(false), None) => Some(Role::Solid),
        (None, None) => None,
    })
}

fn side(role: Role) -> Option<Vec2> {
    if let Role::OneWay(side) = role { Some(Vec2(side)) } else { None }
}

/// What a shape has of its own, none of which it must have.
#[derive(Default)]
pub struct Own {
    pub density: Option<Real>,
    pub surface: SurfaceOverride,
    pub filter: FilterOverride,
    pub role: Option<Role>,
}

impl Own {
    /// Reads the keywords that all shapes take.
    pub fn read(keywords: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut own = Self::default();
        let (mut sensor, mut one_way) = (None, None);
        for (key, value) in keywords.into_iter().flatten().filter(|(_, value)| !value.is_none()) {
            let (surface, filter) = (&mut own.surface, &mut own.filter);
            let key = key.cast::<PyString>()?.to_cow()?;
            match &*key {
                "density" => own.density = Some(checked_density(argument(&key, &value)?)?),
                "friction" => surface.friction = Some(argument::<FrictionArg>(&key, &value)?.0),
                "restitution" => surface.restitution = Some(argument(&key, &value)?),
                "rolling_resistance" => surface.rolling_resistance = Some(argument(&key, &value)?),
                "tangent_speed" => surface.tangent_speed = Some(argument(&key, &value)?),
                "material" => surface.material = Some(argument(&key, &value)?),
                "category" => filter.category = Some(count(&key, argument(&key, &value)?)?),
                "mask" => filter.mask = Some(count(&key, argument(&key, &value)?)?),
                "group" => filter.group = Some(group(argument(&key, &value)?)?),
                "sensor" => sensor = Some(argument(&key, &value)?),
                "one_way" => one_way = Some(argument(&key, &value)?),
                _ => return Err(unexpected(&key)),
            }
        }
        own.role = role(sensor, one_way)?;
        own.surface.validated().map_err(to_py)?;
        own.role.map_or(Ok(()), |role| role.validated()).map_err(to_py)?;
        Ok(own)
    }
}

fn unexpected(key: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "a shape got an unexpected keyword argument '{key}'; all shapes take density, friction, \
         restitution, rolling_resistance, tangent_speed, material, category, mask, group, sensor, one_way"
    ))
}

/// A keyword's value; an error of type names the keyword, as PyO3's do.
pub fn argument<'py, T>(key: &str, value: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    value.extract::<T>().map_err(|error| {
        let error: PyErr = error.into();
        let py = value.py();
        if error.is_instance_of::<PyTypeError>(py) {
            PyTypeError::new_err(format!("argument '{key}': {}", error.value(py)))
        } else {
            error
        }
    })
}

/// The keywords that make again what a shape has of its own.
pub fn keywords(shape: &Shape, named: &Bound<'_, PyDict>) -> PyResult<()> {
    let culbuto::Part { density, surface, filter, role, .. } = &shape.part;
    density.map_or(Ok(()), |density| named.set_item("density", density))?;
    match surface.friction {
        Some(friction) if friction.is_one_number() => {
            named.set_item("friction", friction.sticking)?;
        }
        Some(friction) => named.set_item("friction", coefficients(friction))?,
        None => {}
    }
    for (key, value) in [
        ("restitution", surface.restitution),
        ("rolling_resistance", surface.rolling_resistance),
        ("tangent_speed", surface.tangent_speed),
    ] {
        value.map_or(Ok(()), |value| named.set_item(key, value))?;
    }
    surface.material.as_ref().map_or(Ok(()), |name| named.set_item("material", name))?;
    filter.category.map_or(Ok(()), |bits| named.set_item("category", bits))?;
    filter.mask.map_or(Ok(()), |bits| named.set_item("mask", bits))?;
    filter.group.map_or(Ok(()), |group| named.set_item("group", group))?;
    match role {
        Some(Role::OneWay(side)) => named.set_item("one_way", (side.x, side.y)),
        Some(role) => named.set_item("sensor", *role == Role::Sensor),
        None => Ok(()),
    }
}

/// How it touches.
#[pymethods]
impl Shape {
    /// Static and kinetic friction; None: the body's.
    #[getter]
    fn friction(&self) -> Option<Coefficients> {
        self.part.surface.friction.map(coefficients)
    }

    /// Speed after over speed before a collision, 0 to 1; None: the body's.
    #[getter]
    fn restitution(&self) -> Option<Real> {
        self.part.surface.restitution
    }

    /// Arm by which the normal force opposes rolling (m); None: the body's.
    #[getter]
    fn rolling_resistance(&self) -> Option<Real> {
        self.part.surface.rolling_resistance
    }

    /// Speed of the surface along its border, counter-clockwise (m/s); None: the body's.
    #[getter]
    fn tangent_speed(&self) -> Option<Real> {
        self.part.surface.tangent_speed
    }

    /// Name of the material; None: the body's.
    #[getter]
    fn material(&self) -> Option<&str> {
        self.part.surface.material.as_deref()
    }

    /// Bits of the categories it belongs to; None: the body's.
    #[getter]
    fn category(&self) -> Option<u32> {
        self.part.filter.category
    }

    /// Bits of the categories it touches; None: the body's.
    #[getter]
    fn mask(&self) -> Option<u32> {
        self.part.filter.mask
    }

    /// Group, 0 for none; None: the body's.
    #[getter]
    fn group(&self) -> Option<i32> {
        self.part.filter.group
    }

    /// Whether it only notices what overlaps it; None: as the body, if `one_way` is None, too.
    #[getter]
    fn sensor(&self) -> Option<bool> {
        self.part.role.map(|role| role == Role::Sensor)
    }

    /// The side from which it stops what comes, in the body's frame; None: all sides, or as the body.
    #[getter]
    fn one_way(&self) -> Option<Vec2> {
        self.part.role.and_then(side)
    }
}

impl Body {
    fn set_surface(&self, py: Python<'_>, change: impl FnOnce(&mut Surface)) -> PyResult<()> {
        self.edit(py, |body| {
            let mut surface = body.get().info().def.surface.clone();
            change(&mut surface);
            body.set_surface(surface)
        })
    }

    fn set_filter(&self, py: Python<'_>, change: impl FnOnce(&mut Filter)) -> PyResult<()> {
        self.edit(py, |body| {
            let mut filter = body.get().info().def.filter;
            change(&mut filter);
            body.set_filter(filter)
        })
    }

    /// Changes the role, from that which it has.
    fn set_role(&self, py: Python<'_>, role: impl FnOnce(Role) -> Role) -> PyResult<()> {
        self.edit(py, |body| {
            let now = body.get().info().def.role;
            body.set_role(role(now))
        })
    }
}

/// How its shapes touch that have no values of their own.
#[pymethods]
impl Body {
    /// Static and kinetic friction of shapes that have none of their own. May be set to one number for both.
    #[getter]
    fn friction(&self, py: Python<'_>) -> PyResult<Coefficients> {
        self.def(py, |def| coefficients(def.surface.friction))
    }

    #[setter]
    fn set_friction(&self, py: Python<'_>, friction: FrictionArg) -> PyResult<()> {
        self.set_surface(py, |surface| surface.friction = friction.0)
    }

    /// Speed after over speed before a collision, 0 to 1, of shapes that have none of their own.
    #[getter]
    fn restitution(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.surface.restitution)
    }

    #[setter]
    fn set_restitution(&self, py: Python<'_>, restitution: Real) -> PyResult<()> {
        self.set_surface(py, |surface| surface.restitution = restitution)
    }

    /// Arm (m) by which the normal force opposes rolling, of shapes that have none of their own.
    #[getter]
    fn rolling_resistance(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.surface.rolling_resistance)
    }

    #[setter]
    fn set_rolling_resistance(&self, py: Python<'_>, arm: Real) -> PyResult<()> {
        self.set_surface(py, |surface| surface.rolling_resistance = arm)
    }

    /// Speed (m/s) at which the surface runs along its border, counter-clockwise, as a conveyor's belt.
    #[getter]
    fn tangent_speed(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.surface.tangent_speed)
    }

    #[setter]
    fn set_tangent_speed(&self, py: Python<'_>, speed: Real) -> PyResult<()> {
        self.set_surface(py, |surface| surface.tangent_speed = speed)
    }

    /// Name of the material of shapes that have none of their own, or None. `World.set_pair` speaks of it.
    #[getter]
    fn material(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.def(py, |def| def.surface.material.clone())
    }

    #[setter]
    fn set_material(&self, py: Python<'_>, material: Option<String>) -> PyResult<()> {
        self.set_surface(py, |surface| surface.material = material)
    }

    /// Bits of the categories to which shapes belong that have none of their own.
    #[getter]
    fn category(&self, py: Python<'_>) -> PyResult<u32> {
        self.def(py, |def| def.filter.category)
    }

    #[setter]
    fn set_category(&self, py: Python<'_>, bits: i64) -> PyResult<()> {
        let bits = count("category", bits)?;
        self.set_filter(py, |filter| filter.category = bits)
    }

    /// Bits of the categories that shapes touch that have no mask of their own.
    #[getter]
    fn mask(&self, py: Python<'_>) -> PyResult<u32> {
        self.def(py, |def| def.filter.mask)
    }

    #[setter]
    fn set_mask(&self, py: Python<'_>, bits: i64) -> PyResult<()> {
        let bits = count("mask", bits)?;
        self.set_filter(py, |filter| filter.mask = bits)
    }

    /// Group of shapes that have none of their own, 0 for none: two shapes of one group always touch if it is above 0,
    /// and never if it is below.
    #[getter]
    fn group(&self, py: Python<'_>) -> PyResult<i32> {
        self.def(py, |def| def.filter.group)
    }

    #[setter]
    fn set_group(&self, py: Python<'_>, group: i64) -> PyResult<()> {
        let group = self::group(group)?;
        self.set_filter(py, |filter| filter.group = group)
    }

    /// Whether shapes that have no role of their own only notice what overlaps them.
    #[getter]
    fn sensor(&self, py: Python<'_>) -> PyResult<bool> {
        self.def(py, |def| def.role == Role::Sensor)
    }

    #[setter]
    fn set_sensor(&self, py: Python<'_>, sensor: bool) -> PyResult<()> {
        self.set_role(py, |now| match now {
            _ if sensor => Role::Sensor,
            Role::Sensor => Role::Solid,
            other => other,
        })
    }

    /// The side from which shapes stop what comes that have no role of their own, in the body's frame; None: all
    /// sides. What is set to stop is no sensor any more.
    #[getter]
    fn one_way(&self, py: Python<'_>) -> PyResult<Option<Vec2>> {
        self.def(py, |def| side(def.role))
    }

    #[setter]
    fn set_one_way(&self, py: Python<'_>, side: Option<Vec2Arg>) -> PyResult<()> {
        self.set_role(py, |now| match (side, now) {
            (Some(side), _) => Role::OneWay(side.0),
            (None, Role::OneWay(_)) => Role::Solid,
            (None, other) => other,
        })
    }
}
