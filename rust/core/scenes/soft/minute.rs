//! Deformable bodies at play for some seconds, and for a minute: what is kept on the way, and how they end.

use super::number;
use super::played::{PLATE, SPEED, WHEEL, balloon, cart, press, pressed, ropes, stairs};
use crate::error::Result;
use crate::math::{Real, Vec2};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::world::{Touched, World};

const STEP: Real = 1.0 / 60.0;
const G: Real = 9.81;
const ABOUT: &str = "On the way energy is accounted for to 1e-9 of what there is, and no step gives more than 1e-3 of it.";

const fn scene(
    (id, name): (&'static str, &'static str),
    title: &'static str,
    answer: fn() -> Result<Vec<Number>>,
) -> Scene {
    let (reference, answer) = (Reference::Law, Answer::Numbers(answer));
    Scene { id, name, title, about: ABOUT, reference, answer, checks: &[] }
}

pub static PRESS: Scene = scene(
    ("D12", "press"),
    "A smooth block under a plate of 20 times its mass: by how much it is shorter, 30 s",
    || pressing(30),
);
pub static STAIRS: Scene =
    scene(("D13", "stairs"), "A jelly thrown down a flight of stairs comes to rest, 20 s", || {
        stairs_for(20)
    });
pub static BALLOON: Scene =
    scene(("D14", "balloon"), "A box falls on a balloon, which bears it, 20 s", || balloon_for(20));
pub static CART: Scene = scene(
    ("D15", "cart"),
    "A cart on two wheels of rubber that its motors drive over bumps, 8 s",
    || cart_for(8),
);
pub static ROPES: Scene = scene(
    ("D16", "ropes"),
    "Ropes over drums that do not turn: one is held by friction, one runs off, 8 s",
    || ropes_for(8),
);

/// The same for a minute.
pub static MINUTES: [Scene; 5] = [
    scene(("D12m", "press_minute"), "The block under the plate for 60 s", || pressing(60)),
    scene(("D13m", "stairs_minute"), "The jelly on the stairs for 60 s", || stairs_for(60)),
    scene(("D14m", "balloon_minute"), "The balloon under the box for 60 s", || balloon_for(60)),
    scene(("D15m", "cart_minute"), "The cart on soft wheels for 60 s", || cart_for(60)),
    scene(("D16m", "ropes_minute"), "The ropes over drums for 60 s", || ropes_for(60)),
];

/// Runs a world; returns what its laws say, and the mean force (N) on the first body in the last second.
fn run(world: &mut World, seconds: u32) -> Result<(Vec<Number>, Real)> {
    let start = world.energy()?;
    let scale = start.total();
    let (mut taken, mut given, mut off, mut borne) = (0.0, 0.0, 0.0, 0.0);
    let first = world.bodies().handles()[0];
    for step in 0..60 * seconds {
        world.step(STEP)?;
        let now = world.energy()?;
        given = Real::max(given, taken - now.dissipated);
        off = Real::max(off, (now.balance() - start.balance()).abs());
        taken = now.dissipated;
        if step >= 60 * (seconds - 1) {
            let on_first = |touched| matches!(touched, Touched::Body(body, _) if body == first);
            let contacts = world.soft_contacts().iter().filter(|c| on_first(c.other));
            borne += contacts.map(|contact| contact.impulse).sum::<Real>();
        }
    }
    let laws = vec![
        number("change of the balance of energy", off / scale, 0.0, 1e-9),
        number("most energy given in a step", given / scale, 0.0, 1e-3),
    ];
    Ok((laws, borne))
}

fn fastest(world: &World, k: usize) -> Real {
    world.soft_bodies()[k].velocities().iter().map(Vec2::norm).fold(0.0, Real::max)
}

/// Lowest and highest node.
fn span(world: &World, k: usize) -> [Real; 2] {
    let heights = world.soft_bodies()[k].positions().iter().map(|p| p.y);
    heights.fold([Real::INFINITY, -Real::INFINITY], |[low, high], y| [low.min(y), high.max(y)])
}

/// Stretch of a block that gives way sideways under a force on a metre of its top: ∂ψ/∂s₁ = 0 and ∂ψ/∂s₂ = −F, by bisection.
fn pressed_to(force: Real) -> Real {
    let moduli = pressed().moduli();
    let (shear, area) = (moduli.shear, moduli.area);
    let pressure = |s2: Real| {
        let s1 = (shear + area) * s2 / (shear + area * s2 * s2);
        shear * (s1 - s2) - area * s1 * (s1 * s2 - 1.0)
    };
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pressure(middle) > force { low = middle } else { high = middle }
    }
    low
}

fn pressing(seconds: u32) -> Result<Vec<Number>> {
    let mut world = press()?;
    let (mut numbers, borne) = run(&mut world, seconds)?;
    let own = world.soft_bodies()[0].mass();
    let [low, high] = span(&world, 0);
    // In the mean it bears half of its own weight.
    let stretch = pressed_to((PLATE + 0.5 * own) * G);
    numbers.push(number("height of the block (m)", high - low, stretch, 0.01));
    numbers.push(number("force on the floor (N)", borne, (PLATE + own) * G, 0.01));
    Ok(numbers)
}

fn stairs_for(seconds: u32) -> Result<Vec<Number>> {
    let mut world = stairs()?;
    let (mut numbers, borne) = run(&mut world, seconds)?;
    let body = &world.soft_bodies()[0];
    numbers.push(number("force on the floor (N)", borne, body.mass() * G, 1e-3));
    numbers.push(number("speed at the end (m/s)", fastest(&world, 0), 0.0, 1e-3));
    let off = span(&world, 0)[0] - body.radius();
    numbers.push(number("lowest node off the floor, in sides", off / body.side(), 0.0, 0.02));
    Ok(numbers)
}

fn balloon_for(seconds: u32) -> Result<Vec<Number>> {
    let mut world = balloon()?;
    let state = |world: &World| {
        let body = &world.soft_bodies()[0];
        let outside = body.def().gas.map_or(Real::NAN, |gas| gas.outside);
        body.area() * (body.pressure().unwrap_or(Real::NAN) + outside)
    };
    let before = state(&world);
    let (mut numbers, borne) = run(&mut world, seconds)?;
    numbers.push(number("force on the floor (N)", borne, world.mass() * G, 1e-2));
    numbers.push(number("p·A (N·m)", state(&world), before, 1e-10));
    Ok(numbers)
}

fn cart_for(seconds: u32) -> Result<Vec<Number>> {
    let mut world = cart()?;
    let (mut numbers, _) = run(&mut world, seconds)?;
    // The way there and back up of bumps, and sinking in, is a few hundredths; so is starting from rest.
    let way = world.soft_bodies()[0].center().x + 0.7;
    let speed = way / (Real::from(seconds) - 0.5);
    numbers.push(number("mean speed (m/s)", speed, SPEED * WHEEL, 0.1));
    numbers.push(number("gap of joints (m)", world.joint_gap(), 0.0, 1e-5));
    Ok(numbers)
}

fn ropes_for(seconds: u32) -> Result<Vec<Number>> {
    let mut world = ropes()?;
    let before = world.soft_bodies()[0].center();
    let (mut numbers, _) = run(&mut world, seconds)?;
    let [held, gone] = [0, 1].map(|k| world.soft_bodies()[k].center());
    numbers.push(number("way of the rope that is held (m)", (held - before).norm(), 0.0, 0.02));
    numbers.push(number("height of the one that ran off (m)", gone.y, 0.0, 0.2));
    Ok(numbers)
}
