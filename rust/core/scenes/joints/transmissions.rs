//! What passes motion on: pulleys, gears, racks. Along straight lines and about fixed axes constant forces give
//! parabolas, which the step has to rounding.

use super::{TOLERANCED, disk, pin, rod};
use crate::body::BodyDef;
use crate::error::Result;
use crate::joint::{Given, JointDef, JointKind, Travel};
use crate::math::{Pose, Real, Vec2, vec2};
use crate::scenes::stage::{DT, G, heavy};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, at, weightless};
use crate::world::World;

/// Masses on either side (kg).
const SIDES: [Real; 2] = [1.0, 2.0];
/// The rope of the second machine counts so many times on its second side.
const TACKLE: Real = 3.0;

fn add_machine(world: &mut World, x: Real, ratio: Real) -> Result<()> {
    let over = [vec2(x, 0.0), vec2(x + 1.0, 0.0)];
    let [a, b] = [0, 1].map(|k| {
        let position = over[k] - vec2(0.0, 10.0);
        world.add_body(BodyDef { position, ..BodyDef::point(SIDES[k]) })
    });
    let kind = JointKind::Pulley { over, ratio, length: None, slack: false };
    world.add_joint(JointDef::new(a?, b?, kind))?;
    Ok(())
}

pub static ATWOOD: Scene = Scene {
    id: "J5",
    name: "atwood",
    title: "Atwood's machine: 1 kg and 2 kg on a rope over a pulley, and on one with a tackle of 3",
    about: "The first rises with g·r(m₂ − r·m₁)/(m₂ + r²m₁), the second falls with 1/r of that; r = 1: g(m₂ − m₁)/(m₁ + m₂).",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = heavy()?;
            add_machine(&mut world, 0.0, 1.0)?;
            add_machine(&mut world, 5.0, TACKLE)?;
            Ok(world)
        },
        exact: |t| {
            let machine = |(x, ratio): (Real, Real)| {
                let [a, b] = SIDES;
                let up = 0.5 * G * ratio * (b - ratio * a) / (b + ratio * ratio * a) * t * t;
                [at(x, up - 10.0), at(x + 1.0, -10.0 - up / ratio)]
            };
            [(0.0, 1.0), (5.0, TACKLE)].into_iter().flat_map(machine).collect()
        },
        duration: 1.5,
        dt: DT,
        length: 1.0,
        fixed: 1e-10,
        toleranced: TOLERANCED,
        judged: Judged::Joined { orders: true },
    }),
    checks: &[],
};

/// Teeth of the first over teeth of the second, torque on the first (N·m), and inertias mr²/2 (kg·m²).
const TEETH: Real = 2.5;
const TORQUE: Real = 0.7;
const WHEELS: [(Real, Real); 2] = [(0.5, 4.0), (0.2, 5.0)];

fn inertia((radius, mass): (Real, Real)) -> Real {
    0.5 * mass * radius * radius
}

pub static GEARS: Scene = Scene {
    id: "J6",
    name: "gear_train",
    title: "Two gears on fixed axes, a torque on the first",
    about: "α = τ/(I₁ + r²I₂) with r teeth over teeth; the second turns against the first, r times as far.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let places = [vec2(0.0, 0.0), vec2(0.7, 0.0)];
            let mut gears = Vec::new();
            for (k, (radius, mass)) in WHEELS.into_iter().enumerate() {
                let torque = if k == 0 { TORQUE } else { 0.0 };
                let def = BodyDef { torque, ..disk(radius, mass, places[k])? };
                gears.push(world.add_body(def)?);
                pin(&mut world, None, gears[k], places[k])?;
            }
            let kind = JointKind::Gear { ratio: TEETH, phase: None };
            world.add_joint(JointDef::new(gears[0], gears[1], kind))?;
            Ok(world)
        },
        exact: |t| {
            let all = inertia(WHEELS[0]) + TEETH * TEETH * inertia(WHEELS[1]);
            let angle = 0.5 * TORQUE / all * t * t;
            vec![Pose::new(Vec2::zeros(), angle), Pose::new(vec2(0.7, 0.0), -TEETH * angle)]
        },
        duration: 2.0,
        dt: DT,
        length: 1.0,
        fixed: 1e-10,
        toleranced: TOLERANCED,
        judged: Judged::Joined { orders: true },
    }),
    checks: &[],
};

/// Pinion (radius and mass) and mass of the rack.
const PINION: (Real, Real) = (0.3, 2.0);
const BAR: Real = 1.5;

pub static RACK: Scene = Scene {
    id: "J7",
    name: "rack_and_pinion",
    title: "A torque on a pinion drives a rack on a slider",
    about: "α = τ/(I + mr²), and the rack goes r times the angle.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let bar = world.add_body(rod(2.0, BAR, vec2(0.0, -PINION.0))?)?;
            let def = BodyDef { torque: TORQUE, ..disk(PINION.0, PINION.1, Vec2::zeros())? };
            let pinion = world.add_body(def)?;
            pin(&mut world, None, pinion, Vec2::zeros())?;
            let axis = Given::World(vec2(1.0, 0.0));
            let slider = JointKind::Prismatic { axis, angle: None, travel: Travel::default() };
            let at = vec2(0.0, -PINION.0);
            world.add_joint(JointDef::new(None, bar, slider).at(at))?;
            // The way is that of the pinion against the rack.
            let kind = JointKind::Rack { axis, radius: -PINION.0, offset: None };
            world.add_joint(JointDef::new(bar, pinion, kind))?;
            Ok(world)
        },
        exact: |t| {
            let (radius, _) = PINION;
            let angle = 0.5 * TORQUE / (inertia(PINION) + BAR * radius * radius) * t * t;
            vec![Pose::new(vec2(radius * angle, -radius), 0.0), Pose::new(Vec2::zeros(), angle)]
        },
        duration: 1.0,
        dt: DT,
        length: 1.0,
        fixed: 1e-10,
        toleranced: TOLERANCED,
        judged: Judged::Joined { orders: true },
    }),
    checks: &[],
};
