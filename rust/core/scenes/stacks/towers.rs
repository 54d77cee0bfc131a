//! Stacks and pyramids of boxes.

use crate::body::{BodyDef, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;
use crate::world::World;

const ABOUT: &str = "Boxes of 1 m, put down exactly and, as a second run, let fall by gaps of 1 cm with their centres off by up to \
    1 cm (2 mm in the pyramid, whose columns are 1 cm apart). Nothing may move but the fall itself: overlap below 1 mm per metre of box, drift below a tenth of a box, speed below \
    10⁻² m/s over the second half. By sweeps, with the settings as they come.";

pub static TEN: Scene = Scene {
    id: "K1a",
    name: "stack_of_10",
    title: "Stack of 10 boxes",
    about: ABOUT,
    reference: Reference::Law,
    answer: Answer::Numbers(|| stand(tower::<10>, 4.0, 60)),
    checks: &[],
};

pub static TWENTY: Scene = Scene {
    id: "K1b",
    name: "stack_of_20",
    title: "Stack of 20 boxes",
    answer: Answer::Numbers(|| stand(tower::<20>, 4.0, 60)),
    ..TEN
};

pub static PYRAMID: Scene = Scene {
    id: "K9",
    name: "pyramid",
    title: "Pyramid of boxes, 40 at the base",
    answer: Answer::Numbers(|| stand(pyramid::<40>, 5.0, 20)),
    ..TEN
};

/// The same for a minute.
pub static LONG: [Scene; 3] = [
    Scene {
        answer: Answer::Numbers(|| stand(tower::<10>, 60.0, 600)),
        title: "Stack of 10 boxes for 60 s",
        ..TEN
    },
    Scene {
        answer: Answer::Numbers(|| stand(tower::<20>, 60.0, 600)),
        title: "Stack of 20 boxes for 60 s",
        ..TWENTY
    },
    Scene {
        answer: Answer::Numbers(|| stand(pyramid::<40>, 60.0, 100)),
        title: "Pyramid of boxes, 40 at the base, for 60 s",
        ..PYRAMID
    },
];

/// A world with ground to stand on, its surface at height 0.
pub(in crate::scenes) fn ground() -> Result<World> {
    ground_of(0.6)
}

/// The same with another friction.
pub(super) fn ground_of(mu: Real) -> Result<World> {
    let mut world = World::default();
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.0, -1.0),
        surface: Surface { friction: Friction::of(mu), ..Surface::default() },
        ..BodyDef::new(Shape::rectangle(400.0, 2.0)?)
    })?;
    Ok(world)
}

fn add_box(world: &mut World, (x, y): (Real, Real), density: Real) -> Result<()> {
    world.add_body(BodyDef {
        density,
        position: vec2(x, y),
        surface: Surface { friction: Friction::of(0.6), ..Surface::default() },
        ..BodyDef::new(Shape::rectangle(1.0, 1.0)?)
    })?;
    Ok(())
}

/// A structure: its boxes off the middle by a fixed pattern or not, and the gap (m) that each falls by.
pub(super) type Build = fn(bool, Real) -> Result<World>;

/// Boxes on one another.
pub(in crate::scenes) fn tower<const LEVELS: u32>(loose: bool, gap: Real) -> Result<World> {
    boxes(LEVELS, |_| 1.0, (loose, gap))
}

/// Boxes on one another, of any densities (kg/m²) by level.
pub(in crate::scenes) fn boxes(
    levels: u32,
    density: impl Fn(u32) -> Real,
    (loose, gap): (bool, Real),
) -> Result<World> {
    let mut world = ground()?;
    for level in 0..levels {
        let off = if loose { 0.01 * pattern(level) } else { 0.0 };
        let above = Real::from(level);
        let at = (off, 0.5 + above + gap * (above + 1.0));
        add_box(&mut world, at, density(level))?;
    }
    Ok(world)
}

/// Numbers in −1..1 that do not repeat: the fractional parts of multiples of the golden ratio.
fn pattern(k: u32) -> Real {
    let golden = 0.618_033_988_749_894_9;
    2.0 * (Real::from(k + 1) * golden).fract() - 1.0
}

/// Rows of boxes 1 cm apart, each on the joints of the row below.
pub(in crate::scenes) fn pyramid<const BASE: u32>(loose: bool, gap: Real) -> Result<World> {
    let mut world = ground()?;
    for level in 0..BASE {
        for place in 0..BASE - level {
            let x = Real::from(place) - 0.5 * Real::from(BASE - level - 1);
            let off = if loose { 0.002 * pattern(37 * level + place) } else { 0.0 };
            let above = Real::from(level);
            let at = (1.01 * x + off, 0.5 + above + gap * (above + 1.0));
            add_box(&mut world, at, 1.0)?;
        }
    }
    Ok(world)
}

/// Lets a structure stand for some seconds, and looks at it a number of times.
fn stand(build: Build, seconds: Real, looks: u32) -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for (loose, gap, how) in
        [(false, 0.0, "put down exactly"), (true, 0.01, "let fall by gaps of 1 cm")]
    {
        let mut world = build(loose, gap)?;
        let mut gauge = Gauge::new(&world, 1.0)?;
        let half = (seconds * 30.0) as u32;
        gauge.run(&mut world, 1.0 / 60.0, half, looks / 2)?;
        gauge.settle(&build(loose, 0.0)?);
        gauge.run(&mut world, 1.0 / 60.0, half, looks / 2)?;
        let seen = gauge.seen;
        numbers.extend([
            at_most(format!("overlap per metre, {how}"), seen.overlap, 1e-3),
            at_most(format!("drift (m), {how}"), seen.drift, 0.1),
            at_most(format!("speed in the last half (m/s), {how}"), seen.speed, 1e-2),
        ]);
        numbers.extend(gauge.laws(how));
    }
    Ok(numbers)
}
