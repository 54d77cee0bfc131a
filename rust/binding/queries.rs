//! What is where in a world: rays, points, regions, shapes that move, distances.

use culbuto::World as Core;
use culbuto::body::BodyHandle;
use culbuto::collision::Closest;
use culbuto::error::Result as CoreResult;
use culbuto::math::{Pose, Real, vec2};
use culbuto::shapes::Aabb;
use culbuto::world::{QueryFilter, ShapeId, distance_between};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::body::Body;
use crate::convert::{self, Vec2Arg};
use crate::error::to_py;
use crate::found::{Distance, Known, Nearest, RayHit, Seen};
use crate::shape::{Shape, rows};
use crate::vec2::Vec2;
use crate::world::World;

const ORIGIN: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));

type Keywords<'a, 'py> = &'a Bound<'py, PyDict>;

impl World {
    /// Asks the core, and finds the bodies that it names.
    fn ask<T>(
        slf: &Bound<'_, Self>,
        seen: Option<Keywords<'_, '_>>,
        ask: impl FnOnce(&Core, &QueryFilter<'_>) -> CoreResult<Vec<T>>,
        body: impl Fn(&T) -> BodyHandle,
    ) -> PyResult<Vec<(Known, T)>> {
        let (py, seen) = (slf.py(), Seen::read(slf, seen)?);
        let own = slf.get();
        let core = own.core(py)?;
        let found = ask(&core, &seen.filter()).map_err(to_py)?;
        let objects = own.objects();
        let known = |found: T| {
            let index = core.bodies().index(body(&found)).ok()?;
            Some((Known::new(objects.bodies.get(index)?.clone_ref(py)), found))
        };
        Ok(found.into_iter().filter_map(known).collect())
    }

    /// Asks for hits.
    fn hits(
        slf: &Bound<'_, Self>,
        seen: Option<Keywords<'_, '_>>,
        ask: impl FnOnce(&Core, &QueryFilter<'_>) -> CoreResult<Vec<culbuto::world::RayHit>>,
    ) -> PyResult<Vec<RayHit>> {
        let found = Self::ask(slf, seen, ask, |hit| hit.body)?;
        let hit = |(body, hit): (Known, culbuto::world::RayHit)| RayHit {
            body,
            part: hit.part,
            point: Vec2(hit.point),
            normal: Vec2(hit.normal),
            fraction: hit.fraction,
        };
        Ok(found.into_iter().map(hit).collect())
    }

    /// Asks for bodies, each of which is named once.
    fn found(
        slf: &Bound<'_, Self>,
        seen: Option<Keywords<'_, '_>>,
        ask: impl FnOnce(&Core, &QueryFilter<'_>) -> CoreResult<Vec<ShapeId>>,
    ) -> PyResult<Vec<Known>> {
        let once = |core: &Core, filter: &QueryFilter<'_>| {
            let mut shapes = ask(core, filter)?;
            shapes.dedup_by_key(|shape| shape.body);
            Ok(shapes)
        };
        let found = Self::ask(slf, seen, once, |shape| shape.body)?;
        Ok(found.into_iter().map(|(body, _)| body).collect())
    }
}

/// Queries. All take the keywords `mask`, `category`, `group`, `sensors` and `exclude`.
#[pymethods]
impl World {
    /// The first shape on the straight way from `start` to `end`; None if it is free.
    ///
    /// Shapes are solid: a ray that starts in one hits it at fraction 0. Wires are hit from both sides.
    #[pyo3(signature = (start, end, **seen))]
    fn cast_ray(
        slf: &Bound<'_, Self>,
        start: Vec2Arg,
        end: Vec2Arg,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Option<RayHit>> {
        let hits = Self::hits(slf, seen, |core, filter| {
            let hit = core.cast_ray(start.0, end.0 - start.0, filter)?;
            Ok(hit.into_iter().collect())
        })?;
        Ok(hits.into_iter().next())
    }

    /// All shapes on the straight way from `start` to `end`, each where the ray first enters it, in the order of
    /// the way.
    #[pyo3(signature = (start, end, **seen))]
    fn cast_ray_all(
        slf: &Bound<'_, Self>,
        start: Vec2Arg,
        end: Vec2Arg,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Vec<RayHit>> {
        let way = end.0 - start.0;
        Self::hits(slf, seen, |core, filter| core.cast_ray_all(start.0, way, filter))
    }

    /// The first hits of many rays at once, from `starts` (n, 2), or one point, to `ends` (n, 2).
    ///
    /// What comes back are arrays; a ray that hits nothing has the body −1, the fraction 1, its own end as the
    /// point and the normal (0, 0). The interpreter is released meanwhile.
    #[pyo3(signature = (starts, ends, **seen))]
    fn cast_rays<'py>(
        slf: &Bound<'py, Self>,
        starts: &Bound<'py, PyAny>,
        ends: &Bound<'py, PyAny>,
        seen: Option<Keywords<'_, 'py>>,
    ) -> PyResult<RayHits> {
        let py = slf.py();
        let ends = convert::vectors("ends", ends, None)?;
        let starts = match starts.extract::<Vec2Arg>() {
            Ok(one) => vec![one.0; ends.len()],
            Err(_) => convert::vectors("starts", starts, Some(ends.len()))?,
        };
        let seen = Seen::read(slf, seen)?;
        let hits = slf.get().work(py, |core| {
            let rays = starts.iter().zip(&ends);
            let cast = rays.map(|(start, end)| {
                let hit = core.cast_ray(*start, end - start, &seen.filter())?;
                let Some(hit) = hit else { return Ok((-1, 1.0, *end, vec2(0.0, 0.0))) };
                let body = core.bodies().index(hit.body)?;
                Ok((body as i64, hit.fraction, hit.point, hit.normal))
            });
            cast.collect::<CoreResult<Vec<_>>>()
        })?;
        let column = |i: fn(&(i64, Real, _, _)) -> culbuto::math::Vec2| {
            PyResult::Ok(rows(py, &hits.iter().map(i).collect::<Vec<_>>())?.unbind())
        };
        Ok(RayHits {
            bodies: PyArray1::from_iter(py, hits.iter().map(|hit| hit.0)).unbind(),
            fractions: PyArray1::from_iter(py, hits.iter().map(|hit| hit.1)).unbind(),
            points: column(|hit| hit.2)?,
            normals: column(|hit| hit.3)?,
        })
    }

    /// The first shape that `shape` hits, moved from `position` and `angle` along `translation` (m) without
    /// turning; None if the way is free. What it overlaps at the start it hits at fraction 0.
    #[pyo3(signature = (shape, translation, *, position=ORIGIN, angle=0.0, **seen))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn cast_shape(
        slf: &Bound<'_, Self>,
        shape: &Bound<'_, Shape>,
        translation: Vec2Arg,
        position: Vec2Arg,
        angle: Real,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Option<RayHit>> {
        let (shape, pose) = (&shape.get().part.shape, Pose::new(position.0, angle));
        let hits = Self::hits(slf, seen, |core, filter| {
            let hit = core.cast_shape(shape, &pose, translation.0, filter)?;
            Ok(hit.into_iter().collect())
        })?;
        Ok(hits.into_iter().next())
    }

    /// All shapes that `shape` would hit on that way if nothing stopped it, in the order of the way.
    #[pyo3(signature = (shape, translation, *, position=ORIGIN, angle=0.0, **seen))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn cast_shape_all(
        slf: &Bound<'_, Self>,
        shape: &Bound<'_, Shape>,
        translation: Vec2Arg,
        position: Vec2Arg,
        angle: Real,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Vec<RayHit>> {
        let (shape, pose) = (&shape.get().part.shape, Pose::new(position.0, angle));
        Self::hits(slf, seen, |core, filter| {
            core.cast_shape_all(shape, &pose, translation.0, filter)
        })
    }

    /// The bodies that hold a point, in body order. Wires hold none.
    #[pyo3(signature = (point, **seen))]
    fn bodies_at(
        slf: &Bound<'_, Self>,
        point: Vec2Arg,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Vec<Known>> {
        Self::found(slf, seen, |core, filter| core.shapes_at(point.0, filter))
    }

    /// The bodies that share a point with the box between two corners, in body order; with `exact=False` those
    /// with a shape whose own box along the axes does.
    #[pyo3(signature = (lower, upper, *, exact=true, **seen))]
    fn bodies_in(
        slf: &Bound<'_, Self>,
        lower: Vec2Arg,
        upper: Vec2Arg,
        exact: bool,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Vec<Known>> {
        let region = Aabb { min: lower.0, max: upper.0 };
        Self::found(slf, seen, |core, filter| {
            if exact { core.shapes_in(&region, filter) } else { core.boxes_in(&region, filter) }
        })
    }

    /// The bodies that share a point with a shape at a place, in body order.
    #[pyo3(signature = (shape, *, position=ORIGIN, angle=0.0, **seen))]
    fn overlapping(
        slf: &Bound<'_, Self>,
        shape: &Bound<'_, Shape>,
        position: Vec2Arg,
        angle: Real,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Vec<Known>> {
        let (shape, pose) = (&shape.get().part.shape, Pose::new(position.0, angle));
        Self::found(slf, seen, |core, filter| core.overlapping(shape, &pose, filter))
    }

    /// The shape that is nearest to a point; None if none is within `max_distance` (m).
    #[pyo3(signature = (point, max_distance=Real::INFINITY, **seen))]
    #[pyo3(text_signature = "($self, point, max_distance=float('inf'), **seen)")]
    fn nearest(
        slf: &Bound<'_, Self>,
        point: Vec2Arg,
        max_distance: Real,
        seen: Option<Keywords<'_, '_>>,
    ) -> PyResult<Option<Nearest>> {
        let ask = |core: &Core, filter: &QueryFilter<'_>| {
            Ok(core.nearest(point.0, max_distance, filter)?.into_iter().collect())
        };
        let found = Self::ask(slf, seen, ask, |near: &culbuto::world::Nearest| near.body)?;
        let nearest = |(body, near): (Known, culbuto::world::Nearest)| Nearest {
            body,
            part: near.part,
            point: Vec2(near.point),
            distance: near.distance,
        };
        Ok(found.into_iter().next().map(nearest))
    }
}

#[pymethods]
impl Body {
    /// How far another body is, and where the two are nearest. Below 0 where they overlap: minus the most that
    /// a convex piece of one has to move to be clear of a piece of the other. A body without shapes is a point.
    fn distance_to(&self, py: Python<'_>, other: &Bound<'_, Self>) -> PyResult<Distance> {
        other.get().place.check_world(self.place.world.bind(py))?;
        let core = self.place.world.get().core(py)?;
        let (own, other) = (self.place.handle()?, other.get().place.handle()?);
        Ok(apart(&core.distance(own, other).map_err(to_py)?))
    }
}

#[pymethods]
impl Shape {
    /// How far another shape is that is placed at `position` (m) and `angle` (rad) in the frame of this one, and
    /// where the two are nearest, in that frame. Below 0 where they overlap, as `Body.distance_to` has it.
    #[pyo3(signature = (other, *, position=ORIGIN, angle=0.0))]
    fn distance_to(
        &self,
        other: &Bound<'_, Self>,
        position: Vec2Arg,
        angle: Real,
    ) -> PyResult<Distance> {
        let pose = Pose::new(position.0, angle);
        let (own, other) = ((&self.part.shape, &Pose::IDENTITY), &other.get().part.shape);
        Ok(apart(&distance_between(own, (other, &pose)).map_err(to_py)?))
    }
}

fn apart(closest: &Closest) -> Distance {
    let &Closest { distance, on_a, on_b, normal } = closest;
    Distance { distance, on_self: Vec2(on_a), on_other: Vec2(on_b), normal: Vec2(normal) }
}

/// What many rays hit, as arrays with a row for each ray.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct RayHits {
    /// Places in body order (n,) of the bodies that are hit, −1 where nothing is.
    bodies: Py<PyArray1<i64>>,
    /// Parts of the ways up to the hits (n,), 1 where nothing is hit.
    fractions: Py<PyArray1<Real>>,
    /// Points that are hit (n, 2) (m), or the ends of the rays.
    points: Py<PyArray2<Real>>,
    /// Outward unit normals (n, 2), or zeros.
    normals: Py<PyArray2<Real>>,
}

#[pymethods]
impl RayHits {
    #[new]
    fn new(
        bodies: Py<PyArray1<i64>>,
        fractions: Py<PyArray1<Real>>,
        points: Py<PyArray2<Real>>,
        normals: Py<PyArray2<Real>>,
    ) -> Self {
        Self { bodies, fractions, points, normals }
    }

    /// Number of rays.
    fn __len__(&self, py: Python<'_>) -> usize {
        self.bodies.bind(py).as_any().len().unwrap_or(0)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let bodies = self.bodies.bind(py).readonly();
        let hits = bodies.as_array().iter().filter(|body| **body >= 0).count();
        Ok(format!("<RayHits: {hits} of {} rays>", self.__len__(py)))
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, own) = (slf.py(), slf.get());
        let arrays = (&own.bodies, &own.fractions, &own.points, &own.normals);
        Ok((slf.get_type().into_any(), arrays.into_pyobject(py)?))
    }
}
