//! One small adapter per engine, and what they have in common.

mod box2d;
mod culbuto;
mod rapier_double;
mod rapier_single;
mod worker;

use std::ops::Range;
use std::time::Duration;

use ::culbuto::math::{Real, Vec2};
use cpu_time::ProcessTime;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::scene::Scene;

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct State {
    /// Where its frame stands (m).
    pub position: Vec2,
    /// Angle of its frame (rad), whole turns apart.
    pub angle: Real,
    /// Velocity of its centre of mass (m/s).
    pub velocity: Vec2,
    /// rad/s.
    pub angular_velocity: Real,
}

/// An engine that runs in this process.
trait Engine: Sized {
    /// The world of a scene.
    fn build(scene: &Scene) -> Result<Self>;
    /// Sets the velocity of a kinematic body, by its place in the scene.
    fn steer(&mut self, body: usize, velocity: Vec2) -> Result<()>;
    /// One step of the scene.
    fn step(&mut self, scene: &Scene) -> Result<()>;
    /// All bodies, in the scene's order.
    fn state(&mut self) -> Result<Vec<State>>;
}

/// One that takes part in a race: an engine in this process or in another.
pub trait Entrant {
    /// What it is called in tables.
    fn name(&self) -> &str;
    /// What it is built from, and its version.
    fn version(&mut self) -> Result<String>;
    /// Makes the world of a scene and forgets the one before.
    fn start(&mut self, scene: &Scene) -> Result<()>;
    /// Takes these steps; gives the CPU time of its process that they took.
    fn advance(&mut self, scene: &Scene, steps: Range<u32>) -> Result<Duration>;
    /// All bodies, in the scene's order.
    fn state(&mut self) -> Result<Vec<State>>;
}

/// Says which versions of the engines were built.
const LOCK: &str = include_str!("../Cargo.lock");

struct Native<E> {
    name: &'static str,
    package: &'static str,
    world: Option<E>,
}

impl<E> Native<E> {
    fn world(&mut self) -> Result<&mut E> {
        self.world.as_mut().ok_or_else(|| "no scene was started".into())
    }
}

impl<E: Engine> Entrant for Native<E> {
    fn name(&self) -> &str {
        self.name
    }

    fn version(&mut self) -> Result<String> {
        let entry = format!("name = \"{}\"\nversion = \"", self.package);
        let found = LOCK.split_once(&entry).and_then(|(_, rest)| rest.split_once('"'));
        Ok(format!("{} {}", self.package, found.ok_or("not in Cargo.lock")?.0))
    }

    fn start(&mut self, scene: &Scene) -> Result<()> {
        self.world = None; // frees the old world before the new one is made
        self.world = Some(E::build(scene)?);
        Ok(())
    }

    fn advance(&mut self, scene: &Scene, steps: Range<u32>) -> Result<Duration> {
        let world = self.world()?;
        let start = ProcessTime::now();
        for step in steps {
            if let Some(swing) = scene.swing {
                world.steer(swing.body, swing.velocity(step, scene.dt))?;
            }
            world.step(scene)?;
        }
        Ok(start.elapsed())
    }

    fn state(&mut self) -> Result<Vec<State>> {
        self.world()?.state()
    }
}

fn native<E: Engine + 'static>(name: &'static str, package: &'static str) -> Box<dyn Entrant> {
    Box::new(Native::<E> { name, package, world: None })
}

/// Culbuto with all rows of a group solved at once.
pub const AT_ONCE: &str = "culbuto-newton";

/// Box2D 2, which takes part only in studies.
pub const BOX2D_2: &str = "box2d-2";

/// Entrants that divide no step, but iterate.
pub const ITERATE: [&str; 2] = ["pymunk", BOX2D_2];

/// Entrants that are Python packages.
pub const PYTHON: [&str; 2] = ITERATE;

/// Whether it is Culbuto.
pub fn is_own(name: &str) -> bool {
    name.starts_with("culbuto")
}

/// Name of an entrant, and how it is made; `python` is an interpreter that has those of Python.
type Maker = (&'static str, fn(python: Option<&str>) -> Result<Box<dyn Entrant>>);

/// All entrants; times are compared with those of the first.
pub const ALL: [Maker; 7] = [
    ("culbuto", |_| Ok(native::<culbuto::Culbuto<false>>("culbuto", "culbuto"))),
    (AT_ONCE, |_| Ok(native::<culbuto::Culbuto<true>>(AT_ONCE, "culbuto"))),
    ("rapier-f64", |_| Ok(native::<rapier_double::adapter::Rapier>("rapier-f64", "rapier2d-f64"))),
    ("rapier-f32", |_| Ok(native::<rapier_single::adapter::Rapier>("rapier-f32", "rapier2d"))),
    ("box2d", |_| Ok(native::<box2d::Box2d>("box2d", "boxdd"))),
    (BOX2D_2, |python| Ok(Box::new(worker::Worker::new(BOX2D_2, "box2d_race.py", python)?))),
    ("pymunk", |python| Ok(Box::new(worker::Worker::new("pymunk", "pymunk_race.py", python)?))),
];

/// Names and versions.
pub fn versions(entrants: &mut [Box<dyn Entrant>]) -> Result<Vec<(String, String)>> {
    entrants.iter_mut().map(|entrant| Ok((entrant.name().into(), entrant.version()?))).collect()
}
