//! Steps a world a number of times and does nothing else, for valgrind to count instructions and memory (`make count`,
//! `make needs`): the difference of two counts is the cost of the steps between. The world is one of those named here, a
//! scene file, or one with a feature that it never had, had or has: `BASE/FEATURE/never`.
//!
//! `instructions WORLD STEPS [--dt DT] [--timed | --keep]`; `--timed` reads the clock around each stage and asks for the
//! process's number between steps, `--keep` leaves the world in memory at the end. Without arguments the names of the worlds
//! are printed, with `features` those of bases and features.

mod features;

use culbuto::forces::{Air, Central};
use culbuto::math::vec2;
use culbuto::scenes::SceneFile;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, Error, Result, World};

/// Name of a world, and how it is made.
type Named = (&'static str, fn() -> Result<World>);

/// The worlds that are counted; without arguments their names are printed.
const WORLDS: &[Named] = &[
    ("nothing", || World::new(vec2(0.0, -9.81))),
    ("one point", || bodies(1, |_| Ok(BodyDef::point(1.0)))),
    ("one disk", || bodies(1, |_| Ok(BodyDef::new(Shape::circle(0.1)?)))),
    ("one L-shaped polygon", || bodies(1, |_| Ok(BodyDef::new(l_shape()?)))),
    ("1000 points", || bodies(1000, |_| Ok(BodyDef::point(1.0)))),
    ("1000 L-shaped polygons", || bodies(1000, |_| Ok(BodyDef::new(l_shape()?)))),
    ("one point, 1000 static boxes", || {
        let mut world = bodies(1000, |_| {
            let kind = culbuto::BodyKind::Static;
            Ok(BodyDef { kind, ..BodyDef::new(Shape::rectangle(1.0, 1.0)?) })
        })?;
        world.add_body(BodyDef::point(1.0))?;
        Ok(world)
    }),
    ("one disk, air of density 0", || {
        let mut world = bodies(1, |_| Ok(BodyDef::new(Shape::circle(0.1)?)))?;
        world.set_air(Air { density: 0.0, ..Air::default() })?;
        Ok(world)
    }),
    ("one disk in air", || {
        let mut world = bodies(1, |_| Ok(BodyDef::new(Shape::circle(0.1)?)))?;
        world.set_air(Air { density: 1.2, ..Air::default() })?;
        Ok(world)
    }),
    ("one L-shaped polygon in air", || {
        let mut world = bodies(1, |_| Ok(BodyDef::new(l_shape()?)))?;
        world.set_air(Air { density: 1.2, ..Air::default() })?;
        Ok(world)
    }),
    ("one point, central field", || {
        let mut world = bodies(1, |_| Ok(BodyDef::point(1.0)))?;
        let center = vec2(0.0, 9.0);
        world.add_field(Central { center, strength: 30.0, exponent: -2.0, per_mass: true });
        Ok(world)
    }),
];

fn l_shape() -> Result<Shape> {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    Shape::polygon(&corners.map(|(x, y)| vec2(x, y)))
}

fn bodies(n: usize, def: impl Fn(usize) -> Result<BodyDef>) -> Result<World> {
    let mut world = World::new(vec2(0.0, -9.81))?;
    for i in 0..n {
        world.add_body(def(i)?)?;
    }
    Ok(world)
}

/// The world of this name.
fn world(name: &str) -> Result<Option<World>> {
    if name.ends_with(".json") {
        return SceneFile::read(name)?.world().map(Some);
    }
    let parts: Vec<&str> = name.split('/').collect();
    if let [base, feature, how] = parts[..] {
        return features::world(base, feature, how);
    }
    WORLDS.iter().find(|(own, _)| *own == name).map(|(_, build)| build()).transpose()
}

#[allow(clippy::print_stdout, reason = "the list is what is asked for")]
fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, steps, options @ ..] = &arguments[..] else {
        if arguments.is_empty() {
            WORLDS.iter().for_each(|(name, _)| println!("{name}"));
        } else {
            for (base, _) in features::BASES {
                features::FEATURES.iter().for_each(|(feature, _)| println!("{base}/{feature}"));
            }
        }
        return Ok(());
    };
    let has = |option: &str| options.iter().any(|own| own == option);
    let dt = options.iter().skip_while(|own| *own != "--dt").nth(1);
    let dt = dt.and_then(|dt| dt.parse().ok()).unwrap_or(1.0 / 60.0);
    let Some(mut world) = world(name)? else {
        return Err(Error::invalid("world", name, "those that are printed without arguments"));
    };
    if has("--timed") {
        world.set_timing(true);
    }
    for _ in 0..steps.parse().unwrap_or(0) {
        if has("--timed") {
            std::hint::black_box(std::process::id());
        }
        world.step(dt)?;
    }
    if has("--keep") {
        std::mem::forget(world);
    }
    Ok(())
}
