//! The published schema and the files of the documentation.

use std::fs;
use std::path::{Path, PathBuf};

use culbuto::math::Real;
use culbuto::scenes::SceneFile;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

#[test]
fn the_published_schema_is_current() {
    let path = docs().join("scene.schema.json");
    let schema = serde_json::to_string_pretty(&SceneFile::json_schema()).unwrap() + "\n";
    if std::env::var_os("CULBUTO_UPDATE").is_some() {
        fs::write(&path, &schema).unwrap();
    }
    let published = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        published.replace("\r\n", "\n") == schema,
        "{} is not current; CULBUTO_UPDATE=1 cargo test --test scene_file writes it",
        path.display()
    );
}

/// The examples, by name.
fn examples() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(docs().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        found.push((name, fs::read_to_string(&path).unwrap().replace("\r\n", "\n")));
    }
    found.sort();
    found
}

#[test]
fn the_examples_run_and_are_written_as_the_engine_writes() {
    for (name, text) in examples() {
        let scene = SceneFile::from_json(&text).unwrap();
        assert_eq!(scene.to_json(), text, "{name}");
        let mut world = scene.world().unwrap();
        let steps = (scene.run.duration / scene.run.dt).round();
        world.steps(scene.run.dt, steps as u32).unwrap();
        assert!((world.time() - scene.run.duration).abs() < 1e-12, "{name}");
    }
}

fn after(name: &str, duration: Real) -> culbuto::World {
    let scene = SceneFile::read(docs().join("scenes").join(name)).unwrap();
    let mut world = scene.world().unwrap();
    world.steps(scene.run.dt, (duration / scene.run.dt).round() as u32).unwrap();
    world
}

#[test]
fn the_examples_do_what_they_say() {
    // Disk ½mr² with m = 7800·π·0.05², plate m(a² + b²)/12 with m = 2700·0.4·0.02.
    let disk = 0.5 * 7800.0 * std::f64::consts::PI * 0.05_f64.powi(4);
    let inertia = disk + 2700.0 * 0.4 * 0.02 * (0.4 * 0.4 + 0.02 * 0.02) / 12.0;
    let spin = |t: Real| after("motor.json", t).bodies().twists[0].angular * inertia;
    // Torques of 0.5, 0 and −0.25 N·m over 1, 1 and 2 s. The bound is rounding of 240 steps.
    for (time, expected) in [(1.0, 0.5), (2.0, 0.5), (3.0, 0.25), (4.0, 0.0)] {
        assert!((spin(time) - expected).abs() < 1e-13, "at {time}: {}", spin(time));
    }

    // Circles of radius 1/4 and 3/4 with ω = 1: |a| = 0.25·3/1² = ω²·3/4 for the light one.
    let planets = after("two_planets.json", 20.0);
    let (sin, cos) = Real::sin_cos(20.0);
    let light = planets.bodies().poses[1].position;
    assert!((light.x - 0.75 * cos).abs() < 1e-6 && (light.y - 0.75 * sin).abs() < 1e-6);
    // 2000 steps of three kicks, each rounded.
    assert!(planets.center_of_mass().norm() < 6000.0 * Real::EPSILON);

    // Without air the ball lands (y = 0) at t = (9 + √(81 + 3g))/g.
    let scene = SceneFile::read(docs().join("scenes/thrown_ball.json")).unwrap();
    let mut ball = scene.world().unwrap();
    while ball.bodies().poses[0].position.y > 0.0 {
        ball.step(1e-3).unwrap();
    }
    let free = 12.0 * (9.0 + Real::sqrt(81.0 + 3.0 * 9.81)) / 9.81;
    let range = ball.bodies().poses[0].position.x;
    assert!((range / free - 0.9).abs() < 0.01);
}

#[test]
fn the_guide_shows_a_file_that_is_one() {
    let guide = fs::read_to_string(docs().join("scene-files.md")).unwrap().replace("\r\n", "\n");
    let json = guide.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let scene = SceneFile::from_json(json).unwrap();
    assert_eq!(scene.to_json(), json);
    scene.world().unwrap().step(scene.run.dt).unwrap();
}
