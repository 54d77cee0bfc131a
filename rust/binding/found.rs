//! What queries take and give.

use std::sync::Arc;

use culbuto::body::BodyHandle;
use culbuto::math::Real;
use culbuto::world::QueryFilter;
use pyo3::exceptions::PyTypeError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::body::Body;
use crate::convert::count;
use crate::record::record;
use crate::surface::{argument, group};
use crate::vec2::Vec2;
use crate::world::World;

/// A body inside a record.
#[derive(Clone)]
pub struct Known(Arc<Py<Body>>);

impl Known {
    pub fn new(body: Py<Body>) -> Self {
        Self(Arc::new(body))
    }
}

impl PartialEq for Known {
    fn eq(&self, other: &Self) -> bool {
        self.0.is(&*other.0)
    }
}

impl<'py> FromPyObject<'_, 'py> for Known {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self::new(object.cast::<Body>()?.to_owned().unbind()))
    }
}

impl<'py> IntoPyObject<'py> for Known {
    type Target = Body;
    type Output = Bound<'py, Body>;
    type Error = std::convert::Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.bind(py).clone())
    }
}

record! {
    /// Where a ray or a moving shape hits a shape.
    RayHit {
        /// The body that is hit.
        body: Known,
        /// Which of its shapes, counted from 0.
        part: usize,
        /// Point of that shape (m).
        point: Vec2,
        /// Its outward unit normal there; of wires, on the side that is hit.
        normal: Vec2,
        /// Part of the way up to the hit, 0 to 1.
        fraction: Real,
    }
}

record! {
    /// The shape that is nearest to a point.
    Nearest {
        /// The body.
        body: Known,
        /// Which of its shapes, counted from 0.
        part: usize,
        /// Its nearest point (m): the one that was asked for, if the shape holds it.
        point: Vec2,
        /// How far that is (m), 0 if the shape holds the point.
        distance: Real,
    }
}

record! {
    /// How far two things are apart.
    Distance {
        /// Distance (m), below 0 where they overlap.
        distance: Real,
        /// Nearest point of the one that was asked (m).
        on_self: Vec2,
        /// Nearest point of the other (m).
        on_other: Vec2,
        /// Unit vector from the one to the other.
        normal: Vec2,
    }
}

#[pymethods]
impl RayHit {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&*self.body.0)
    }
}

#[pymethods]
impl Nearest {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&*self.body.0)
    }
}

/// Which shapes a query sees: the keywords that all queries take.
#[derive(Default)]
pub struct Seen {
    mask: Option<u32>,
    category: Option<u32>,
    group: i32,
    sensors: bool,
    exclude: Vec<BodyHandle>,
}

impl Seen {
    pub fn read(world: &Bound<'_, World>, keywords: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut seen = Self::default();
        for (key, value) in keywords.into_iter().flatten().filter(|(_, value)| !value.is_none()) {
            let key = key.cast::<PyString>()?.to_cow()?;
            match &*key {
                "mask" => seen.mask = Some(count(&key, argument(&key, &value)?)?),
                "category" => seen.category = Some(count(&key, argument(&key, &value)?)?),
                "group" => seen.group = group(argument(&key, &value)?)?,
                "sensors" => seen.sensors = argument(&key, &value)?,
                "exclude" => seen.exclude = excluded(world, &value)?,
                _ => return Err(unexpected(&key)),
            }
        }
        Ok(seen)
    }

    pub fn filter(&self) -> QueryFilter<'_> {
        let Self { mask, category, group, sensors, ref exclude } = *self;
        QueryFilter { mask, category, group, sensors, exclude, predicate: None }
    }
}

fn unexpected(key: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "a query got an unexpected keyword argument '{key}'; all queries take mask, category, group, \
         sensors, exclude"
    ))
}

/// A body, or several.
fn excluded(world: &Bound<'_, World>, value: &Bound<'_, PyAny>) -> PyResult<Vec<BodyHandle>> {
    let handle = |body: &Bound<'_, PyAny>| {
        let body = body.cast::<Body>().map_err(|_| {
            let kind = body.get_type().name().map_or_else(|_| "it".to_owned(), |n| n.to_string());
            PyTypeError::new_err(format!("exclude is a Body or several of them, not {kind}"))
        })?;
        body.get().place.check_world(world)?;
        body.get().place.handle()
    };
    match value.try_iter() {
        Ok(several) => several.map(|body| handle(&body?)).collect(),
        Err(_) => Ok(vec![handle(value)?]),
    }
}
