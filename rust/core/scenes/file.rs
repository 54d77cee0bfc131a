//! Scene files: a world as readable JSON. `docs/scene-files.md` is the guide, `docs/scene.schema.json`
//! the schema.
//!
//! Lists beside `bodies` came later (deformable bodies, fluids), each empty by
//! default. A file that does without them stays as it is, so the version stays 1; it changes only when
//! something that stands in files today gets another meaning.

mod body;
mod fluid;
mod from_world;
mod joint;
mod soft;
mod text;
mod to_world;

use std::collections::BTreeMap;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use body::{SceneBody, ScenePart};
pub use fluid::{SceneFill, SceneFluid};
pub use joint::{SceneJoint, SceneJointState};
pub use soft::{SceneSoft, SceneSoftState};

use crate::body::{Friction, ImpactLaw, Mixing};
use crate::error::{Error, Result};
use crate::fluid::Kept;
use crate::forces::{Air, Attraction, Central};
use crate::math::{Real, Vec2, vec2};
use crate::shapes::Shape;
use crate::solvers::Solver;
use crate::world::Settings;

/// The version of scene files that this engine writes, and the only one it reads.
pub const SCENE_VERSION: u32 = 1;

/// A world as a file holds it. Lengths in m, angles in rad, masses in kg, times in s.
///
/// ```
/// use culbuto::scenes::SceneFile;
/// let scene = SceneFile::from_json(
///     r#"{"culbuto": 1, "bodies": [{"name": "ball", "shapes": [{"shape": {"circle": {"radius": 0.1}}}]}]}"#,
/// )?;
/// let mut world = scene.world()?;
/// world.step(scene.run.dt)?;
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "Culbuto scene", transform = text::known_version)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Where the schema of this file is, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Version of the format: 1.
    pub culbuto: u32,
    /// Name of the scene.
    #[serde(default)]
    pub name: String,
    /// What is to be seen.
    #[serde(default)]
    pub about: String,
    /// Gravity (m/s²).
    #[serde(default = "usual_gravity")]
    #[schemars(with = "[Real; 2]")]
    pub gravity: Vec2,
    /// The air.
    #[serde(default)]
    pub air: Air,
    /// How the world is stepped.
    #[serde(default)]
    pub settings: SceneSettings,
    /// How the scene is meant to be run.
    #[serde(default)]
    pub run: SceneRun,
    /// World time at which the scene begins (s).
    #[serde(default)]
    pub time: Real,
    /// What the world's clock knows beyond the last digit of `time` (s). Programs write it, so that a
    /// world goes on to the bit.
    #[serde(default)]
    pub time_remainder: Real,
    /// What shapes can be made of, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// The bodies, in body order.
    #[serde(default)]
    pub bodies: Vec<SceneBody>,
    /// Deformable bodies, in their order.
    #[serde(default)]
    pub soft_bodies: Vec<SceneSoft>,
    /// What ties bodies together, in the order of the world's joints.
    #[serde(default)]
    pub joints: Vec<SceneJoint>,
    /// The fluids, in the order of the world's.
    #[serde(default)]
    pub fluids: Vec<SceneFluid>,
    /// Regions, in the frame of the world, that remove the particles which enter them.
    #[serde(default)]
    pub drains: Vec<Shape>,
    /// What the fluids know beyond the places and velocities of their particles. Programs write it, so that a world goes on
    /// to the bit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<Kept>,
    /// Forces that are constant between given times.
    #[serde(default)]
    pub schedules: Vec<SceneSchedule>,
    /// Fields of force.
    #[serde(default)]
    pub fields: Vec<SceneField>,
}

/// What shapes can be made of. A shape whose material, or whose body's, is this has its values, but for
/// those it has of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Density (kg/m², or kg/m of a wire); none: that of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<Real>,
    /// Static and kinetic friction; none: that of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Speed after over speed before a collision, 0 to 1; none: that of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<Real>,
    /// Arm (m) by which the normal force opposes rolling; none: that of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rolling_resistance: Option<Real>,
}

/// How a world is stepped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneSettings {
    /// Name of the method that moves bodies at a fixed step.
    pub method: String,
    /// Into how many equal substeps a step is divided (1 to 65536).
    pub substeps: u32,
    /// Bodies under constant forces take the exact solution, whatever the method.
    pub closed_form: bool,
    /// What two surfaces make of their coefficients together.
    pub mixing: Mixing,
    /// What restitution is a ratio of.
    pub impact_law: ImpactLaw,
    /// How the rows of contacts and joints are solved.
    pub solver: Solver,
    /// Bodies that have come to rest are left out of the work until something wakes them.
    pub sleeping: bool,
}

impl Default for SceneSettings {
    fn default() -> Self {
        Self::from(&Settings::default())
    }
}

impl From<&Settings> for SceneSettings {
    fn from(settings: &Settings) -> Self {
        Self {
            method: settings.method.clone(),
            substeps: settings.substeps,
            closed_form: settings.closed_form,
            mixing: settings.mixing.clone(),
            impact_law: settings.impact_law,
            solver: settings.solver,
            sleeping: settings.sleeping,
        }
    }
}

/// How a scene is meant to be run. The world itself does not go by it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneRun {
    /// Length of a step (s).
    pub dt: Real,
    /// How long (s).
    pub duration: Real,
}

impl Default for SceneRun {
    fn default() -> Self {
        Self { dt: 1.0 / 60.0, duration: 10.0 }
    }
}

/// Which body is meant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "the name of a body, or its place in `bodies` counted from 0")]
pub enum BodyLabel {
    /// Its place in `bodies`, counted from 0.
    Index(usize),
    /// Its name, which no other body may have.
    Name(String),
}

/// Forces and torques on a body that are constant between given times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneSchedule {
    /// The body, by name or by place.
    pub body: BodyLabel,
    /// When the forces change (s, world time), increasing: the first force acts from the first time to
    /// the second, and so on; nothing acts outside. The last may be null: for ever.
    pub times: Vec<Option<Real>>,
    /// Forces through the centre of mass (N), one fewer than there are times; none: 0.
    #[serde(default)]
    #[schemars(with = "Vec<[Real; 2]>")]
    pub forces: Vec<Vec2>,
    /// Torques (N·m), one fewer than there are times; none: 0.
    #[serde(default)]
    pub torques: Vec<Real>,
}

/// A field of force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SceneField {
    /// Pull towards a point.
    Central(Central),
    /// Pull of all bodies on one another.
    Attraction(Attraction),
    /// Sinusoidal force on one body.
    Oscillating(SceneOscillating),
}

/// A force and a torque on one body that vary as sin(2π·hertz·t + phase).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneOscillating {
    /// The body, by name or by place.
    pub body: BodyLabel,
    /// Amplitude of the force through the centre of mass (N).
    #[serde(default)]
    #[schemars(with = "[Real; 2]")]
    pub force: Vec2,
    /// Amplitude of the torque (N·m).
    #[serde(default)]
    pub torque: Real,
    /// Frequency (Hz).
    pub hertz: Real,
    /// Phase at t = 0 (rad).
    #[serde(default)]
    pub phase: Real,
}

fn usual_gravity() -> Vec2 {
    Settings::default().gravity
}

impl Default for SceneFile {
    fn default() -> Self {
        Self {
            schema: None,
            culbuto: SCENE_VERSION,
            name: String::new(),
            about: String::new(),
            gravity: usual_gravity(),
            air: Air::default(),
            settings: SceneSettings::default(),
            run: SceneRun::default(),
            time: 0.0,
            time_remainder: 0.0,
            materials: BTreeMap::new(),
            bodies: Vec::new(),
            soft_bodies: Vec::new(),
            joints: Vec::new(),
            fluids: Vec::new(),
            drains: Vec::new(),
            flow: None,
            schedules: Vec::new(),
            fields: Vec::new(),
        }
    }
}

impl SceneFile {
    /// Reads a scene from JSON text. Shapes are checked here, the rest by [`SceneFile::world`].
    ///
    /// # Errors
    /// [`Error::SceneFile`] with the path of the offending value.
    pub fn from_json(json: &str) -> Result<Self> {
        text::from_json(json)
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, else those of [`SceneFile::from_json`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|source| failed(path, source))?;
        Self::from_json(std::str::from_utf8(&bytes).map_err(|error| wrong(".", error))?)
    }

    /// The scene as JSON text: always the same for the same scene, every number to its last bit, what
    /// is as by default left out.
    #[must_use]
    pub fn to_json(&self) -> String {
        text::to_json(self)
    }

    /// Writes a scene file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        std::fs::write(path, self.to_json()).map_err(|source| failed(path, source))
    }

    /// The JSON schema of scene files.
    #[must_use]
    pub fn json_schema() -> serde_json::Value {
        schemars::schema_for!(SceneFile).to_value()
    }
}

impl Default for SceneOscillating {
    fn default() -> Self {
        let still = vec2(0.0, 0.0);
        Self { body: BodyLabel::Index(0), force: still, torque: 0.0, hertz: 0.0, phase: 0.0 }
    }
}

fn failed(path: &Path, source: std::io::Error) -> Error {
    Error::Io { path: path.display().to_string(), source }
}

/// An error about the value at a path.
fn wrong(path: impl Into<String>, message: impl std::fmt::Display) -> Error {
    Error::SceneFile { path: path.into(), message: message.to_string() }
}
