//! What bears loads, closed loops, and a rope that catches.

use super::elliptic::swing;
use super::{TOLERANCED, rod, watch, widest};
use crate::body::{BodyDef, BodyHandle};
use crate::error::Result;
use crate::joint::{JointDef, JointHandle};
use crate::math::{PI, Real, Vec2, cross, sin_cos, vec2};
use crate::scenes::gauge::at_most;
use crate::scenes::stage::{DT, G, at_fixed_step, heavy};
use crate::scenes::{Answer, Judged, Motion, Number, Reference, Scene, at, weightless};
use crate::world::World;

pub static BEAM: Scene = Scene {
    id: "J13",
    name: "welded_beam",
    title: "A beam of four rods welded end to end sticks out of a wall",
    about: "The wall bears the weight W and the moment W·L/2; the weld at x what is beyond it.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        const RODS: usize = 4;
        let mut world = heavy()?;
        let (mut welds, mut before) = (Vec::new(), None);
        for i in 0..RODS {
            let left = i as Real;
            let body = world.add_body(rod(1.0, 2.0, vec2(left + 0.5, 0.0))?)?;
            welds.push(world.add_joint(JointDef::weld(before, body).at(vec2(left, 0.0)))?);
            before = Some(body);
        }
        world.steps(DT, 300)?;
        let mut numbers = Vec::new();
        for (i, weld) in welds.into_iter().enumerate() {
            let beyond = (RODS - i) as Real;
            let weight = 2.0 * G * beyond;
            let reaction = world.joint(weld)?.reaction();
            let number = |what: &str, value: Real, exact: Real| Number {
                what: format!("{what} at weld {i}"),
                value,
                exact,
                asked: 1e-9,
            };
            numbers.extend([
                number("force (N)", reaction.force.y, weight),
                number("moment (N·m)", reaction.torque, weight * beyond / 2.0),
            ]);
        }
        let tip = world.bodies().poses[RODS - 1];
        numbers.push(at_most(
            "bend, |y| + |θ| of the tip",
            tip.position.y.abs() + tip.angle.abs(),
            1e-9,
        ));
        Ok(numbers)
    }),
    checks: &[],
};

/// Where the three links of the platform are fixed, and their length (m).
const LINKS: [Real; 3] = [-1.0, 0.0, 1.0];
const LONG: Real = 1.5;

/// A platform on three parallel massless links, one more than it needs, at an angle from the lowest place.
fn platform(angle: Real) -> Result<(World, Vec<JointHandle>)> {
    let mut world = heavy()?;
    let (sin, cos) = sin_cos(angle);
    let place = vec2(sin, -cos) * LONG;
    let body = world.add_body(rod(2.0, 6.0, place)?)?;
    let link = |world: &mut World, x: Real| {
        let post = vec2(x, 0.0);
        world.add_joint(JointDef::distance(None, body).anchored(post, post + place))
    };
    let joints = LINKS.into_iter().map(|x| link(&mut world, x)).collect::<Result<_>>()?;
    Ok((world, joints))
}

pub static PLATFORM: Scene = Scene {
    id: "J15",
    name: "platform_on_three_links",
    title: "A platform swings on three parallel links, of which two would do",
    about: "It does not turn, and each point of it goes as a pendulum of the links' length from 45°. At rest the links bear the weight \
        together, the outer two alike.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || Ok(platform(PI / 4.0)?.0),
        exact: |t| {
            let (sin, cos) = sin_cos(swing(PI / 4.0, libm::sqrt(G / LONG), t));
            vec![at(sin * LONG, -cos * LONG)]
        },
        duration: 10.0,
        dt: DT,
        length: LONG,
        fixed: 2e-3,
        toleranced: TOLERANCED,
        judged: Judged::Joined { orders: true },
    }),
    checks: &[
        at_fixed_step("gap in 10 s (m)", 1e-6, || Ok(watch(&mut platform(PI / 4.0)?.0, 10.0)?.gap)),
        at_fixed_step("outer links at rest apart, of the weight", 1e-9, || {
            let [left, _, right] = at_rest()?;
            Ok((left - right).abs() / (6.0 * G))
        }),
        at_fixed_step("sum of the links at rest against the weight, relative", 1e-9, || {
            Ok((at_rest()?.iter().sum::<Real>() / (6.0 * G) - 1.0).abs())
        }),
    ],
};

/// What the three links bear at rest (N).
fn at_rest() -> Result<[Real; 3]> {
    let (mut world, joints) = platform(0.0)?;
    world.steps(DT, 300)?;
    let mut forces = [0.0; 3];
    for (force, joint) in forces.iter_mut().zip(joints) {
        *force = world.joint(joint)?.reaction().force.y;
    }
    Ok(forces)
}

/// Where the thing on the rope begins and how it moves (m, m/s).
const BEGIN: Vec2 = vec2(0.5, 0.0);
const MOVING: Vec2 = vec2(2.0, 1.5);

fn roped() -> Result<(World, BodyHandle, JointHandle)> {
    let mut world = weightless()?;
    let def = BodyDef { position: BEGIN, velocity: MOVING, ..BodyDef::point(2.0) };
    let body = world.add_body(def)?;
    let rope = JointDef::rope(None, body, 1.0);
    let rope = world.add_joint(rope.anchored_locally(Vec2::zeros(), Vec2::zeros()))?;
    Ok((world, body, rope))
}

pub static ROPE: Scene = Scene {
    id: "J12",
    name: "rope_caught_taut",
    title: "A mass on a slack rope of 1 m flies off and is caught",
    about: "The rope takes the speed along it, once, and keeps the moment of momentum: |v| = |r × v₀|/L from then on, on the circle.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let (mut world, body, _) = roped()?;
        let start = world.energy()?;
        world.steps(DT, 120)?;
        let now = world.body(body)?;
        let kept = cross(BEGIN, MOVING).abs();
        let energy = world.energy()?;
        Ok(vec![
            // It is caught in one substep; what the circle is cut by there is (ωh)² of the speed.
            Number {
                what: "speed (m/s)".into(),
                value: now.velocity().norm(),
                exact: kept,
                asked: 1e-4,
            },
            Number {
                what: "moment of momentum (m²/s)".into(),
                value: cross(now.position(), now.velocity()),
                exact: cross(BEGIN, MOVING),
                asked: 1e-12,
            },
            Number {
                what: "energy taken (J)".into(),
                value: energy.dissipated,
                exact: MOVING.norm_squared() - kept * kept,
                asked: 1e-4,
            },
            at_most("longer than it is (m)", widest(&world)?, 1e-9),
            at_most("books", (energy.balance() - start.balance()).abs() / start.kinetic, 1e-12),
        ])
    }),
    checks: &[],
};
