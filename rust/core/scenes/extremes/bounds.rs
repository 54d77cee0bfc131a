//! Huge gravity and huge spin.

use crate::body::{BodyDef, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::stacks::{ground, tower};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;

pub static GRAVITY: Scene = Scene {
    id: "X2",
    name: "huge_gravity",
    title: "Gravity of 10⁴ m/s² on a stack of 20 boxes",
    about: "Boxes of 1 m, for 5 s: no energy from nothing, and each stays above the one below it.",
    reference: Reference::Law,
    answer: Answer::Numbers(huge_gravity),
    checks: &[],
};

fn huge_gravity() -> Result<Vec<Number>> {
    let mut world = tower::<20>(false, 0.0)?;
    world.set_gravity(vec2(0.0, -1e4))?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 300, 30)?;
    let heights =
        world.bodies().poses.windows(2).map(|pair| pair[1].position.y - pair[0].position.y);
    let disorder = heights.filter(|height| *height < 0.5).count();
    let mut numbers = vec![at_most("boxes that left their order", disorder as Real, 0.0)];
    numbers.extend(gauge.laws("20 boxes"));
    Ok(numbers)
}

pub static SPIN: Scene = Scene {
    id: "X5",
    name: "spin_in_contact",
    title: "Bodies that spin at 10⁴ rad/s on the ground",
    about: "A disk, r = 0.1, set down with ω = 10⁴ rad/s on ground with μ = 0.5 slips for a long time: x = ½μgt², \
        ω = ω₀ − 2μgt/r. A box and a rod that spin so and fall to the ground: no energy from nothing, no overlap that lasts.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(spin),
    checks: &[],
};

const SPEED: Real = 1e4;

fn spin() -> Result<Vec<Number>> {
    let mut numbers = disk()?;
    for (name, width, height) in [("a box", 0.5, 0.5), ("a rod", 1.0, 0.05)] {
        for restitution in [0.0, 0.5] {
            let mut world = ground()?;
            world.add_body(BodyDef {
                position: vec2(0.0, 1.0),
                angular_velocity: SPEED,
                surface: Surface { restitution, ..Surface::default() },
                ..BodyDef::new(Shape::rectangle(width, height)?)
            })?;
            let mut gauge = Gauge::new(&world, 1.0)?;
            gauge.run(&mut world, 1.0 / 60.0, 300, 1)?;
            let lowest = world.bodies().poses[1].position.y;
            let how = format!("{name}, e = {restitution}");
            numbers.push(at_most(
                format!("centre below the ground (m), {how}"),
                (-lowest).max(0.0),
                0.0,
            ));
            numbers.extend(gauge.laws(&how));
        }
    }
    Ok(numbers)
}

fn disk() -> Result<Vec<Number>> {
    let (r, mu, g, t) = (0.1, 0.5, 9.81, 2.0);
    let mut world = ground()?;
    let surface = Surface { friction: Friction::of(mu), ..Surface::default() };
    world.body_mut(world.bodies().handles()[0])?.set_surface(surface.clone())?;
    world.add_body(BodyDef {
        position: vec2(0.0, r),
        angular_velocity: -SPEED,
        surface,
        ..BodyDef::new(Shape::circle(r)?)
    })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 120, 12)?;
    let number = |what: &str, value: Real, exact: Real| {
        let what = format!("{what} of the disk");
        Number { what, value, exact, asked: 1e-9 }
    };
    let (pose, twist) = (world.bodies().poses[1], world.bodies().twists[1]);
    let mut numbers = vec![
        number("way (m)", pose.position.x, 0.5 * mu * g * t * t),
        number("speed (m/s)", twist.linear.x, mu * g * t),
        number("spin (rad/s)", twist.angular, -SPEED + 2.0 * mu * g * t / r),
        number("height (m)", pose.position.y, r),
    ];
    numbers.extend(gauge.laws("the disk"));
    Ok(numbers)
}
