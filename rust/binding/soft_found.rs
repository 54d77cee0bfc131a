//! What deformable bodies touch, and where they are.

use culbuto::World as Core;
use culbuto::math::Real;
use culbuto::shapes::Aabb;
use culbuto::soft::SoftHandle;
use culbuto::world::{self as core, SoftFilter, Touched};
use pyo3::exceptions::PyTypeError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::convert::{Vec2Arg, count};
use crate::error::{StaleHandleError, to_py};
use crate::soft::SoftBody;
use crate::surface::{argument, group};
use crate::vec2::Vec2;
use crate::world::World;

/// A deformable body and what it touches, began or ended to touch, or hit.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct SoftContact {
    /// World time at the end of the step (s).
    time: Real,
    /// The deformable body.
    body: Py<SoftBody>,
    /// What it touches: a body or a deformable one.
    other: Py<PyAny>,
    /// Which shape of a body, counted from 0; None of a deformable one.
    part: Option<usize>,
    /// Where most of the load is, or where they are nearest (m).
    point: Vec2,
    /// Unit vector from the deformable body to the other there.
    normal: Vec2,
    /// How fast they came together (m/s). Of hits; 0 else.
    approach_speed: Real,
    /// Along the normals over the step (N·s).
    impulse: Real,
}

#[pymethods]
impl SoftContact {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (body, other) = (self.body.bind(py).repr()?, self.other.bind(py).repr()?);
        Ok(format!("<SoftContact of {body} and {other} at t = {:?} s>", self.time))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body)?;
        visit.call(&self.other)
    }
}

/// What happened to deformable bodies during the last call that moved the world on.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct SoftEvents {
    /// Pairs that began to touch.
    begin: Vec<Py<SoftContact>>,
    /// Pairs that no longer touch.
    end: Vec<Py<SoftContact>>,
    /// Pairs that began to touch faster than the forces of a substep make them.
    hit: Vec<Py<SoftContact>>,
}

#[pymethods]
impl SoftEvents {
    fn __repr__(&self) -> String {
        let Self { begin, end, hit } = self;
        format!("<SoftEvents: {} begin, {} end, {} hit>", begin.len(), end.len(), hit.len())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        let mut all = self.begin.iter().chain(&self.end).chain(&self.hit);
        all.try_for_each(|contact| visit.call(contact))
    }
}

/// Where a ray hits a deformable body.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct SoftRayHit {
    /// The body that is hit.
    body: Py<SoftBody>,
    /// Point of its border (m); the start of the ray where that is inside.
    point: Vec2,
    /// Its outward unit normal there.
    normal: Vec2,
    /// Part of the way up to the hit, 0 to 1.
    fraction: Real,
}

#[pymethods]
impl SoftRayHit {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<SoftRayHit of {} at {:?}>", self.body.bind(py).repr()?, self.fraction))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body)
    }
}

/// The deformable body that is nearest to a point.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct NearestSoft {
    /// The body.
    body: Py<SoftBody>,
    /// Its nearest point (m): the one that was asked for, if the body holds it.
    point: Vec2,
    /// How far that is (m), 0 if the body holds the point.
    distance: Real,
}

#[pymethods]
impl NearestSoft {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<NearestSoft {}, {:?} m off>", self.body.bind(py).repr()?, self.distance))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body)
    }
}

/// The keywords that queries take.
#[derive(Default)]
struct Seen {
    mask: Option<u32>,
    category: Option<u32>,
    group: i32,
    exclude: Vec<SoftHandle>,
}

impl Seen {
    fn read(world: &Bound<'_, World>, given: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut seen = Self::default();
        for (key, value) in given.into_iter().flatten() {
            let key = key.cast::<PyString>()?.to_cow()?;
            match &*key {
                "mask" => seen.mask = Some(count(&key, argument(&key, &value)?)?),
                "category" => seen.category = Some(count(&key, argument(&key, &value)?)?),
                "group" => seen.group = group(argument(&key, &value)?)?,
                "exclude" => {
                    let bodies: Vec<Py<SoftBody>> = argument(&key, &value)?;
                    for body in bodies {
                        let place = &body.get().place;
                        place.check_world(world)?;
                        seen.exclude.push(place.handle()?);
                    }
                }
                _ => {
                    let message =
                        format!("no query takes {key}; allowed: mask, category, group, exclude");
                    return Err(PyTypeError::new_err(message));
                }
            }
        }
        Ok(seen)
    }

    fn filter(&self) -> SoftFilter<'_> {
        let Self { mask, category, group, exclude } = self;
        SoftFilter { mask: *mask, category: *category, group: *group, exclude }
    }
}

impl World {
    /// Asks the core under a filter.
    fn ask_softs<T>(
        slf: &Bound<'_, Self>,
        seen: Option<&Bound<'_, PyDict>>,
        ask: impl FnOnce(&Core, &SoftFilter<'_>) -> culbuto::Result<T>,
    ) -> PyResult<T> {
        let seen = Seen::read(slf, seen)?;
        let core = slf.get().core(slf.py())?;
        ask(&core, &seen.filter()).map_err(to_py)
    }

    fn soft_object(&self, py: Python<'_>, handle: SoftHandle) -> PyResult<Py<SoftBody>> {
        let gone = || StaleHandleError::new_err("a deformable body that was removed");
        self.soft_body(py, handle).ok_or_else(gone)
    }

    /// Contacts as objects, but for those of bodies that were removed.
    fn soft_contacts_of(
        &self,
        py: Python<'_>,
        list: Vec<core::SoftContact>,
    ) -> PyResult<Vec<Py<SoftContact>>> {
        let mut all = Vec::with_capacity(list.len());
        for own in list {
            let Some(body) = self.soft_body(py, own.soft) else { continue };
            let (other, part) = match own.other {
                Touched::Body(body, part) => (self.body(py, body).map(Py::into_any), Some(part)),
                Touched::Soft(soft) => (self.soft_body(py, soft).map(Py::into_any), None),
            };
            let Some(other) = other else { continue };
            let (point, normal) = (Vec2(own.point), Vec2(own.normal));
            let core::SoftContact { time, approach_speed, impulse, .. } = own;
            let contact =
                SoftContact { time, body, other, part, point, normal, approach_speed, impulse };
            all.push(Py::new(py, contact)?);
        }
        Ok(all)
    }
}

/// Queries for deformable bodies. All take the keywords `mask`, `category`, `group` and `exclude`.
#[pymethods]
impl World {
    /// What touches deformable bodies after the last step.
    #[getter]
    fn soft_contacts(&self, py: Python<'_>) -> PyResult<Vec<Py<SoftContact>>> {
        let list = self.core(py)?.soft_contacts().to_vec();
        self.soft_contacts_of(py, list)
    }

    /// What began and ended to touch deformable bodies, and what hit them, during the last call that moved the world on.
    #[getter]
    fn soft_events(&self, py: Python<'_>) -> PyResult<SoftEvents> {
        let core::SoftEvents { begin, end, hit } = self.core(py)?.soft_events().clone();
        let list = |list| self.soft_contacts_of(py, list);
        Ok(SoftEvents { begin: list(begin)?, end: list(end)?, hit: list(hit)? })
    }

    /// The deformable bodies that hold a point.
    #[pyo3(signature = (point, **seen))]
    fn soft_bodies_at(
        slf: &Bound<'_, Self>,
        point: Vec2Arg,
        seen: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Vec<Py<SoftBody>>> {
        let found = Self::ask_softs(slf, seen, |core, seen| core.soft_bodies_at(point.0, seen))?;
        found.into_iter().map(|body| slf.get().soft_object(slf.py(), body)).collect()
    }

    /// The deformable bodies that share a point with the box between two corners.
    #[pyo3(signature = (lower, upper, **seen))]
    fn soft_bodies_in(
        slf: &Bound<'_, Self>,
        lower: Vec2Arg,
        upper: Vec2Arg,
        seen: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Vec<Py<SoftBody>>> {
        let region = Aabb { min: lower.0, max: upper.0 };
        let found = Self::ask_softs(slf, seen, |core, seen| core.soft_bodies_in(&region, seen))?;
        found.into_iter().map(|body| slf.get().soft_object(slf.py(), body)).collect()
    }

    /// The first deformable body on the straight way from `start` to `end`; None if it is free.
    #[pyo3(signature = (start, end, **seen))]
    fn cast_ray_soft(
        slf: &Bound<'_, Self>,
        start: Vec2Arg,
        end: Vec2Arg,
        seen: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Option<SoftRayHit>> {
        let way = end.0 - start.0;
        let hit = Self::ask_softs(slf, seen, |core, seen| core.cast_ray_soft(start.0, way, seen))?;
        let hit = hit.map(|hit| {
            Ok(SoftRayHit {
                body: slf.get().soft_object(slf.py(), hit.body)?,
                point: Vec2(hit.point),
                normal: Vec2(hit.normal),
                fraction: hit.fraction,
            })
        });
        hit.transpose()
    }

    /// The deformable body that is nearest to a point; None if none is within `max_distance` (m).
    #[pyo3(signature = (point, max_distance=Real::INFINITY, **seen))]
    fn nearest_soft(
        slf: &Bound<'_, Self>,
        point: Vec2Arg,
        max_distance: Real,
        seen: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Option<NearestSoft>> {
        let found = Self::ask_softs(slf, seen, |core, seen| {
            core.nearest_soft(point.0, max_distance, seen)
        })?;
        let found = found.map(|found| {
            Ok(NearestSoft {
                body: slf.get().soft_object(slf.py(), found.body)?,
                point: Vec2(found.point),
                distance: found.distance,
            })
        });
        found.transpose()
    }
}
