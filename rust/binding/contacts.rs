//! What touches, and what began and ended to: arrays of all, and an object for each.

use culbuto::body::BodyHandle;
use culbuto::math::{Real, Vec2 as Vector, vec2};
use culbuto::world;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::body::Body;
use crate::joints::BrokenJoint;
use crate::vec2::Vec2;
use crate::world::World;

/// Where two bodies touch: one or two points with one normal.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct Contact {
    /// The body of the two that was added first.
    body_a: Py<Body>,
    /// The other body.
    body_b: Py<Body>,
    /// Which shape of A, counted from 0.
    part_a: usize,
    /// Which shape of B, counted from 0.
    part_b: usize,
    /// Unit vector from A to B.
    normal: Vec2,
    /// One or two points (m).
    points: Vec<Vec2>,
    /// Gap at each point (m), below 0 where the surfaces overlap.
    gaps: Vec<Real>,
    /// Impulse on B along the normal at each point, in the last substep (N·s).
    normal_impulses: Vec<Real>,
    /// Impulse on B along the normal turned by a quarter turn counter-clockwise, in the last substep (N·s).
    tangential_impulse: Real,
    /// Mean force on B over the last substep (N); that on A is its opposite.
    force: Vec2,
    /// Whether the surfaces slid.
    sliding: bool,
}

#[pymethods]
impl Contact {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (a, b) = (self.body_a.bind(py).repr()?, self.body_b.bind(py).repr()?);
        Ok(format!("<Contact of {a} and {b}>"))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body_a)?;
        visit.call(&self.body_b)
    }
}

/// Contacts at one moment, as arrays and one by one.
#[pyclass(frozen, get_all, sequence, module = "culbuto")]
pub struct Contacts {
    /// Places of A and B in body order (n, 2).
    bodies: Py<PyArray2<i64>>,
    /// Which shape of each (n, 2), counted from 0.
    parts: Py<PyArray2<i64>>,
    /// Number of points of each (n,), 1 or 2.
    count: Py<PyArray1<i64>>,
    /// Points (n, 2, 2) (m); NaN where there is no second.
    points: Py<PyArray3<Real>>,
    /// Unit vectors from A to B (n, 2).
    normals: Py<PyArray2<Real>>,
    /// Gaps (n, 2) (m), below 0 where the surfaces overlap; NaN where there is no second point.
    gaps: Py<PyArray2<Real>>,
    /// Impulses on B along the normal (n, 2), in the last substep (N·s); 0 where there is no second point.
    normal_impulses: Py<PyArray2<Real>>,
    /// Impulses on B along the normal turned counter-clockwise (n,), in the last substep (N·s).
    tangential_impulses: Py<PyArray1<Real>>,
    /// Mean forces on B over the last substep (n, 2) (N).
    forces: Py<PyArray2<Real>>,
    /// Whether the surfaces slid (n,).
    sliding: Py<PyArray1<bool>>,
    items: Vec<Py<Contact>>,
}

fn pairs<T: numpy::Element + Copy>(
    py: Python<'_>,
    pairs: impl Iterator<Item = [T; 2]>,
) -> PyResult<Py<PyArray2<T>>> {
    let flat: Vec<T> = pairs.flatten().collect();
    let n = flat.len() / 2;
    Ok(PyArray1::from_vec(py, flat).reshape([n, 2])?.unbind())
}

/// An item of a sequence, counted from the end if below 0.
fn item<T>(items: &[Py<T>], py: Python<'_>, index: isize) -> PyResult<Py<T>> {
    let place = if index < 0 { index + items.len() as isize } else { index };
    let found = usize::try_from(place).ok().and_then(|place| items.get(place));
    found.map(|item| item.clone_ref(py)).ok_or_else(|| PyIndexError::new_err("index out of range"))
}

const NOWHERE: Vector = vec2(Real::NAN, Real::NAN);

impl Contacts {
    fn new(py: Python<'_>, world: &World, all: &[world::Contact]) -> PyResult<Self> {
        let second = |c: &world::Contact| c.count == 2;
        let places = |v: [usize; 2]| v.map(|i| i as i64);
        let points = all.iter().flat_map(|c| {
            let [p, q] = c.points;
            let q = if second(c) { q } else { NOWHERE };
            [p.x, p.y, q.x, q.y]
        });
        let flat = PyArray1::from_iter(py, points);
        let gap = |c: &world::Contact| [c.gaps[0], if second(c) { c.gaps[1] } else { Real::NAN }];
        let pair = |v: Vector| [v.x, v.y];
        let mut items = Vec::new();
        for contact in all {
            if let Some(contact) = Contact::new(py, world, contact) {
                items.push(Py::new(py, contact)?);
            }
        }
        Ok(Self {
            bodies: pairs(py, all.iter().map(|c| places(c.indices)))?,
            parts: pairs(py, all.iter().map(|c| places(c.parts)))?,
            count: PyArray1::from_iter(py, all.iter().map(|c| c.count as i64)).unbind(),
            points: flat.reshape([all.len(), 2, 2])?.unbind(),
            normals: pairs(py, all.iter().map(|c| pair(c.normal)))?,
            gaps: pairs(py, all.iter().map(gap))?,
            normal_impulses: pairs(py, all.iter().map(|c| c.normal_impulses))?,
            tangential_impulses: PyArray1::from_iter(py, all.iter().map(|c| c.tangential_impulse))
                .unbind(),
            forces: pairs(py, all.iter().map(|c| pair(c.force())))?,
            sliding: PyArray1::from_iter(py, all.iter().map(|c| c.sliding)).unbind(),
            items,
        })
    }
}

impl Contact {
    fn new(py: Python<'_>, world: &World, contact: &world::Contact) -> Option<Self> {
        let count = contact.count;
        let [body_a, body_b] = contact.bodies.map(|handle| world.body(py, handle));
        Some(Self {
            body_a: body_a?,
            body_b: body_b?,
            part_a: contact.parts[0],
            part_b: contact.parts[1],
            normal: Vec2(contact.normal),
            points: contact.points[..count].iter().map(|p| Vec2(*p)).collect(),
            gaps: contact.gaps[..count].to_vec(),
            normal_impulses: contact.normal_impulses[..count].to_vec(),
            tangential_impulse: contact.tangential_impulse,
            force: Vec2(contact.force()),
            sliding: contact.sliding,
        })
    }
}

#[pymethods]
impl Contacts {
    /// Number of contacts.
    fn __len__(&self) -> usize {
        self.items.len()
    }

    fn __getitem__(&self, py: Python<'_>, index: isize) -> PyResult<Py<Contact>> {
        item(&self.items, py, index)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyIterator>> {
        PyList::new(py, &self.items)?.try_iter()
    }

    fn __repr__(&self) -> String {
        format!("<{} contacts>", self.items.len())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.items.iter().try_for_each(|item| visit.call(item))
    }
}

/// Something that happened between two shapes.
///
/// The body that was added first is A; of a sensor and what it notices, the sensor. A body that was removed since
/// says so (`removed`).
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct ContactEvent {
    /// "begin", "end", "hit", "sensor_begin" or "sensor_end".
    pub kind: &'static str,
    /// World time (s): of a hit its moment in the step, of all else the end of the step.
    time: Real,
    /// A; None if it was removed before and no object is left of it.
    pub body_a: Option<Py<Body>>,
    /// B; None if it was removed before and no object is left of it.
    pub body_b: Option<Py<Body>>,
    /// Which shape of A, counted from 0.
    part_a: usize,
    /// Which shape of B, counted from 0.
    part_b: usize,
    /// Where they touch (m); None at ends and for sensors.
    point: Option<Vec2>,
    /// Unit vector from A to B; None at ends and for sensors.
    normal: Option<Vec2>,
    /// How fast they came together (m/s), of hits.
    approach_speed: Real,
    /// Along the normal (N·s): of a hit all it took, of a beginning that of the last substep.
    impulse: Real,
}

#[pymethods]
impl ContactEvent {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let name = |body: &Option<Py<Body>>| match body {
            Some(body) => Ok(body.bind(py).repr()?.to_string()),
            None => PyResult::Ok("a removed body".to_owned()),
        };
        let (a, b) = (name(&self.body_a)?, name(&self.body_b)?);
        Ok(format!("<{} of {a} and {b} at t = {:?} s>", self.kind, self.time))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body_a)?;
        visit.call(&self.body_b)
    }
}

/// Events of one kind, as arrays and one by one.
#[pyclass(frozen, get_all, sequence, module = "culbuto")]
pub struct ContactEvents {
    /// World times (n,) (s).
    times: Py<PyArray1<Real>>,
    /// Places of A and B in body order (n, 2); −1 for a body that was removed.
    bodies: Py<PyArray2<i64>>,
    /// Which shape of each (n, 2), counted from 0.
    parts: Py<PyArray2<i64>>,
    /// Points (n, 2) (m); NaN where there is none.
    points: Py<PyArray2<Real>>,
    /// Unit vectors from A to B (n, 2); NaN where there is none.
    normals: Py<PyArray2<Real>>,
    /// How fast they came together (n,) (m/s), of hits.
    approach_speeds: Py<PyArray1<Real>>,
    /// Impulses along the normal (n,) (N·s).
    impulses: Py<PyArray1<Real>>,
    pub items: Vec<Py<ContactEvent>>,
}

impl ContactEvents {
    fn new(
        py: Python<'_>,
        world: &World,
        (kind, all): (&'static str, &[world::ContactEvent]),
    ) -> PyResult<Self> {
        let find = |handle: BodyHandle| {
            world.body(py, handle).or_else(|| world.rules().removed_body(py, handle))
        };
        let mut items = Vec::new();
        for event in all {
            let [body_a, body_b] = event.bodies.map(find);
            let made = ContactEvent {
                kind,
                time: event.time,
                body_a,
                body_b,
                part_a: event.parts[0],
                part_b: event.parts[1],
                point: event.point.map(Vec2),
                normal: event.normal.map(Vec2),
                approach_speed: event.approach_speed,
                impulse: event.impulse,
            };
            items.push(Py::new(py, made)?);
        }
        let core = world.core(py)?;
        let index = |handle| core.bodies().index(handle).map_or(-1, |i| i as i64);
        let indices: Vec<[i64; 2]> = all.iter().map(|event| event.bodies.map(index)).collect();
        drop(core);
        let vector = |v: Option<Vector>| v.map_or([Real::NAN; 2], |v| [v.x, v.y]);
        let numbers = |read: fn(&world::ContactEvent) -> Real| {
            PyArray1::from_iter(py, all.iter().map(read)).unbind()
        };
        Ok(Self {
            times: numbers(|event| event.time),
            bodies: pairs(py, indices.into_iter())?,
            parts: pairs(py, all.iter().map(|event| event.parts.map(|part| part as i64)))?,
            points: pairs(py, all.iter().map(|event| vector(event.point)))?,
            normals: pairs(py, all.iter().map(|event| vector(event.normal)))?,
            approach_speeds: numbers(|event| event.approach_speed),
            impulses: numbers(|event| event.impulse),
            items,
        })
    }
}

#[pymethods]
impl ContactEvents {
    /// Number of events.
    fn __len__(&self) -> usize {
        self.items.len()
    }

    fn __getitem__(&self, py: Python<'_>, index: isize) -> PyResult<Py<ContactEvent>> {
        item(&self.items, py, index)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyIterator>> {
        PyList::new(py, &self.items)?.try_iter()
    }

    fn __repr__(&self) -> String {
        format!("<{} events>", self.items.len())
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.items.iter().try_for_each(|item| visit.call(item))
    }
}

/// What happened during a call that moved the world on.
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct Events {
    /// Shapes that began to touch.
    begin: Py<ContactEvents>,
    /// Shapes that no longer touch.
    end: Py<ContactEvents>,
    /// Impacts, and new contacts that came faster than the forces of a substep make them.
    hit: Py<ContactEvents>,
    /// Shapes that a sensor began to overlap.
    sensor_begin: Py<ContactEvents>,
    /// Shapes that a sensor no longer overlaps.
    sensor_end: Py<ContactEvents>,
    /// Joints that broke.
    broken: Vec<Py<BrokenJoint>>,
}

impl Events {
    pub fn new(py: Python<'_>, world: &World, core: &world::Events) -> PyResult<Self> {
        let list = |kind, all: &[_]| Py::new(py, ContactEvents::new(py, world, (kind, all))?);
        Ok(Self {
            begin: list("begin", &core.begin)?,
            end: list("end", &core.end)?,
            hit: list("hit", &core.hit)?,
            sensor_begin: list("sensor_begin", &core.sensor_begin)?,
            sensor_end: list("sensor_end", &core.sensor_end)?,
            broken: world.objects().broken.iter().map(|joint| joint.clone_ref(py)).collect(),
        })
    }

    /// All events, kind by kind: hits, beginnings, ends, sensors.
    pub fn all(&self, py: Python<'_>) -> Vec<Py<ContactEvent>> {
        let lists = [&self.hit, &self.begin, &self.end, &self.sensor_begin, &self.sensor_end];
        let items = lists.into_iter().flat_map(|list| &list.get().items);
        items.map(|item| item.clone_ref(py)).collect()
    }
}

#[pymethods]
impl Events {
    fn __repr__(&self) -> String {
        let n = |list: &Py<ContactEvents>| list.get().items.len();
        let (begin, end, hit) = (n(&self.begin), n(&self.end), n(&self.hit));
        let sensors = (n(&self.sensor_begin), n(&self.sensor_end));
        format!(
            "<Events: {begin} begin, {end} end, {hit} hit, {} sensor_begin, {} sensor_end, {} broken>",
            sensors.0,
            sensors.1,
            self.broken.len()
        )
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        let lists = [&self.hit, &self.begin, &self.end, &self.sensor_begin, &self.sensor_end];
        lists.into_iter().try_for_each(|list| visit.call(list))?;
        self.broken.iter().try_for_each(|broken| visit.call(broken))
    }
}

#[pymethods]
impl World {
    /// Where solid shapes touched after the last step.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> PyResult<Contacts> {
        let all = self.core(py)?.contacts();
        Contacts::new(py, self, &all)
    }

    /// What happened between shapes, and to joints, during the last call that moved the world on; nothing if it failed.
    #[getter]
    fn events(&self, py: Python<'_>) -> PyResult<Events> {
        let core = self.core(py)?.events().clone();
        Events::new(py, self, &core)
    }
}

#[pymethods]
impl Body {
    /// Where the body touched others after the last step.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> PyResult<Contacts> {
        let world = self.place.world.get();
        let handle = self.place.handle()?;
        let all = world.core(py)?.contacts_of(handle).map_err(crate::error::to_py)?;
        Contacts::new(py, world, &all)
    }

    /// Bodies that a sensor of this body overlapped after the last step, and whose sensors overlapped it.
    #[getter]
    fn overlaps(&self, py: Python<'_>) -> PyResult<Vec<Py<Self>>> {
        let world = self.place.world.get();
        let handle = self.place.handle()?;
        let all = world.core(py)?.overlaps_of(handle).map_err(crate::error::to_py)?;
        let mut handles: Vec<BodyHandle> = all.into_iter().map(|(body, _)| body).collect();
        handles.dedup();
        Ok(handles.into_iter().filter_map(|handle| world.body(py, handle)).collect())
    }
}
