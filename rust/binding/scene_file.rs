//! Scene files: worlds as JSON.

use std::path::PathBuf;

use culbuto::error::Result;
use culbuto::math::Real;
use culbuto::scenes::SceneFile as Core;
use pyo3::prelude::*;

use crate::code::Code;
use crate::error::to_py;
use crate::world::World;

/// A world as a file holds it, and how it is meant to be run. There is none that makes no world.
#[pyclass(frozen, eq, module = "culbuto")]
#[derive(PartialEq)]
pub struct SceneFile(Core);

/// Makes one with the interpreter released, and sees that it makes a world.
fn checked(py: Python<'_>, make: impl FnOnce() -> Result<Core> + Send) -> PyResult<SceneFile> {
    let make = || {
        let file = make()?;
        file.world()?;
        Ok(SceneFile(file))
    };
    py.detach(make).map_err(to_py)
}

#[pymethods]
impl SceneFile {
    /// Reads a scene file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        checked(py, || Core::read(path))
    }

    /// Reads a scene from JSON text.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        checked(py, || Core::from_json(text))
    }

    /// The scene that begins where a world is; the world made from it goes on to the same bits. Step `dt` and
    /// `duration` (s) are for whoever runs it. The world's energy books (work, dissipation) are not in it.
    #[staticmethod]
    #[pyo3(signature = (world, *, name="", about="", dt=1.0/60.0, duration=10.0))]
    fn from_world(
        world: &Bound<'_, World>,
        name: &str,
        about: &str,
        dt: Real,
        duration: Real,
    ) -> PyResult<Self> {
        let mut file = world.get().work(world.py(), |core| Core::from_world(core))?;
        (file.name, file.about) = (name.into(), about.into());
        (file.run.dt, file.run.duration) = (dt, duration);
        checked(world.py(), || Ok(file))
    }

    /// Name of the scene; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// What is to be seen; may be empty.
    #[getter]
    fn about(&self) -> &str {
        &self.0.about
    }

    /// Length of a step (s) for whoever runs it.
    #[getter]
    fn dt(&self) -> Real {
        self.0.run.dt
    }

    /// How long it is meant to be run (s).
    #[getter]
    fn duration(&self) -> Real {
        self.0.run.duration
    }

    /// A new world of the scene, at its beginning.
    fn world<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, World>> {
        World::assembled(py, py.detach(|| self.0.world()).map_err(to_py)?, &Code::default())
    }

    /// The scene as JSON text: always the same for the same scene, every number to its last bit.
    fn to_json(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.to_json())
    }

    /// Writes a scene file, over one that is there.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.0.write(path)).map_err(to_py)
    }

    fn __repr__(&self) -> String {
        let n = self.0.bodies.len();
        format!("<SceneFile {:?} of {n} {}>", self.0.name, if n == 1 { "body" } else { "bodies" })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_json")?, (slf.get().0.to_json(),)))
    }
}

#[pymethods]
impl World {
    /// The world of a scene file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, Self>> {
        let read = || Core::read(path)?.world();
        Self::assembled(py, py.detach(read).map_err(to_py)?, &Code::default())
    }

    /// Writes the world as it is to a scene file, over one that is there.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let file = self.work(py, |core| Core::from_world(core))?;
        py.detach(|| file.write(path)).map_err(to_py)
    }
}

/// The JSON schema of scene files.
#[pyfunction]
pub fn scene_schema(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    py.import("json")?.call_method1("loads", (Core::json_schema().to_string(),))
}
