//! Steps a named world a number of times and does nothing else, for `make count` to count instructions:
//! `instructions NAME STEPS`. The difference of two counts is the cost of the steps between.

use culbuto::forces::{Air, Central};
use culbuto::math::vec2;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, Result, World};

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

#[allow(clippy::print_stdout, reason = "the list is what is asked for")]
fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (Some(name), Some(steps)) = (arguments.next(), arguments.next()) else {
        WORLDS.iter().for_each(|(name, _)| println!("{name}"));
        return Ok(());
    };
    let steps = steps.parse().unwrap_or(0);
    for (_, build) in WORLDS.iter().filter(|(own, _)| *own == name) {
        let mut world = build()?;
        for _ in 0..steps {
            world.step(1.0 / 60.0)?;
        }
    }
    Ok(())
}
