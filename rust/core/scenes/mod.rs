//! Scenes: the files that hold them.

mod file;

pub use file::{
    BodyLabel, Material, SCENE_VERSION, SceneBody, SceneField, SceneFile, SceneOscillating,
    ScenePart, SceneRun, SceneSchedule, SceneSettings,
};
