//! The catalogue of scenes, and the report's measurements. They reach Python as JSON, which
//! `culbuto.catalogue` and `culbuto.study` read into classes.

#![allow(clippy::needless_pass_by_value, reason = "as PyO3 hands them")]

use culbuto::methods;
use culbuto::report::{self, Order, Study, stability};
use culbuto::scenes::hard::HARD;
use culbuto::scenes::{Answer, CATALOGUE, Motion, Scene, scene};
use culbuto::world::Trajectory;
use culbuto::{error::Result, math};
use numpy::{
    PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::code::Code;
use crate::error::to_py;
use crate::world::World;

/// Works with the interpreter released, and writes what came of it as JSON.
fn json_of(py: Python<'_>, work: impl FnOnce() -> Result<Value> + Send) -> PyResult<String> {
    py.detach(work).map(|value| value.to_string()).map_err(to_py)
}

/// The known motion of a scene.
fn motion_of(name: &str) -> PyResult<Motion> {
    let scene = scene(name).map_err(to_py)?;
    match scene.answer {
        Answer::Motion(motion) => Ok(motion),
        Answer::Numbers(_) => {
            let what = "a scene whose answer is a motion";
            Err(to_py(culbuto::Error::invalid("scene", scene.name, what)))
        }
    }
}

fn describe(scene: &&Scene) -> Value {
    let motion = match scene.answer {
        Answer::Motion(motion) => json!({
            "duration": motion.duration,
            "dt": motion.dt,
            "tolerance": motion.toleranced.map(|asked| asked.tolerance),
            "length": motion.length,
        }),
        Answer::Numbers(_) => Value::Null,
    };
    json!({
        "id": scene.id,
        "name": scene.name,
        "title": scene.title,
        "about": scene.about,
        "reference": scene.reference.about(),
        // A world that cannot be made says so to whoever runs it.
        "uncertainty": scene.uncertainty().ok(),
        "motion": motion,
    })
}

/// Every scene of the catalogue.
#[pyfunction]
pub fn catalogue() -> String {
    CATALOGUE.iter().map(describe).collect::<Value>().to_string()
}

/// A scene against its answer.
#[pyfunction]
pub fn verify(py: Python<'_>, name: &str) -> PyResult<String> {
    json_of(py, || Ok(json!(report::verify(scene(name)?)?)))
}

/// Rows of error against run time, at numbers of steps a run and to tolerances; no methods: all.
#[pyfunction]
pub fn study(
    py: Python<'_>,
    name: &str,
    ladders: (Vec<u32>, Vec<f64>),
    methods: Vec<String>,
    repeats: u32,
) -> PyResult<String> {
    let (steps, tolerances) = ladders;
    let what = Study { steps, tolerances, methods, repeats };
    json_of(py, || Ok(json!(report::study(scene(name)?, &what)?)))
}

/// Numbers and names of the hard scenes.
#[pyfunction]
pub fn hard_scenes() -> Vec<(&'static str, &'static str)> {
    HARD.iter().map(|hard| (hard.id, hard.name)).collect()
}

/// How a hard scene ends by each of Culbuto's solvers at these numbers of steps a second; none: the usual ones.
#[pyfunction]
pub fn stability_of(py: Python<'_>, name: &str, rates: Vec<f64>) -> PyResult<String> {
    let rates = if rates.is_empty() { stability::RATES.to_vec() } else { rates };
    let hard = HARD.iter().find(|hard| hard.name == name).ok_or_else(|| {
        let names: Vec<_> = HARD.iter().map(|hard| hard.name).collect();
        to_py(culbuto::Error::invalid("hard scene", format!("{name:?}"), names.join(", ")))
    })?;
    json_of(py, || Ok(json!(stability::line(hard, &rates)?)))
}

/// The order of a method on a scene: {"slope": number or null, "exact": true or false}.
#[pyfunction]
pub fn measured_order(py: Python<'_>, name: &str, method: &str) -> PyResult<String> {
    let motion = motion_of(name)?;
    json_of(py, || {
        let order = report::measured_order(&motion, methods::method(method)?)?;
        let slope = if let Order::Slope(slope) = order { Some(slope) } else { None };
        Ok(json!({ "slope": slope, "exact": order == Order::Exact }))
    })
}

/// Paths of a thrown ball by each method, at each tick rate.
#[pyfunction]
pub fn thrown_ball(py: Python<'_>, methods: Vec<String>, ticks: Vec<u32>) -> PyResult<String> {
    let names: Vec<&str> = methods.iter().map(String::as_str).collect();
    json_of(py, || Ok(json!(report::thrown_ball(&names, &ticks)?)))
}

/// Positions and angles (k, n, 3) of a scene's bodies at times (s), as its answer has them.
#[pyfunction]
pub fn exact_motion<'py>(
    py: Python<'py>,
    name: &str,
    times: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let motion = motion_of(name)?;
    let poses: Vec<Vec<math::Pose>> =
        times.as_array().iter().map(|time| (motion.exact)(*time)).collect();
    let bodies = poses.first().map_or(0, Vec::len);
    let flat: Vec<f64> = poses
        .iter()
        .flatten()
        .flat_map(|pose| [pose.position.x, pose.position.y, pose.angle])
        .collect();
    PyArray1::from_vec(py, flat).reshape([poses.len(), bodies, 3])
}

/// Largest error of a recorded motion of a scene, as the report states it.
#[pyfunction]
pub fn scene_error(
    name: &str,
    times: PyReadonlyArray1<'_, f64>,
    positions: PyReadonlyArray3<'_, f64>,
    angles: PyReadonlyArray2<'_, f64>,
) -> PyResult<f64> {
    let motion = motion_of(name)?;
    let world = (motion.build)().map_err(to_py)?;
    let (positions, angles) = (positions.as_array(), angles.as_array());
    let bodies = world.bodies().len();
    let k = times.as_array().len();
    if positions.shape() != [k, bodies, 2] || angles.shape() != [k, bodies] {
        let allowed = format!("positions ({k}, {bodies}, 2) and angles ({k}, {bodies})");
        let got = format!("{:?} and {:?}", positions.shape(), angles.shape());
        return Err(to_py(culbuto::Error::invalid("motion", got, allowed)));
    }
    let pose = |(place, angle): (usize, &f64)| {
        let (k, i) = (place / bodies, place % bodies);
        math::Pose::new(math::vec2(positions[[k, i, 0]], positions[[k, i, 1]]), *angle)
    };
    let recorded = Trajectory {
        times: times.as_array().to_vec(),
        bodies,
        poses: angles.iter().enumerate().map(pose).collect(),
        twists: Vec::new(),
    };
    Ok(motion.error(&world, &recorded))
}

/// The world of a scene of the catalogue.
#[pyfunction]
pub fn open_scene<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, World>> {
    let motion = motion_of(name)?;
    World::assembled(py, (motion.build)().map_err(to_py)?, &Code::default())
}
