//! Air drag, and the width it acts on.

use super::{Answer, Check, Column, Judged, Motion, Number, Reference, Scene, Toleranced, at};
use crate::body::BodyDef;
use crate::error::Result;
use crate::forces::Air;
use crate::math::{Pose, Real, exp, ln_1p, vec2};
use crate::shapes::{Shape, Silhouette};
use crate::world::World;

/// A ball of 2 kg and 1 m across in air of 1.2 kg/m², C = 0.4: k = ½ρCA = 0.24 kg/m.
const MASS: Real = 2.0;
const K: Real = 0.24;
const G: Real = 9.81;
const SPEED: Real = 20.0;

fn ball_in_air(gravity: Real, speed: Real) -> Result<World> {
    let mut world = World::new(vec2(0.0, -gravity))?;
    world.set_air(Air { density: 1.2, wind: vec2(0.0, 0.0) })?;
    world.add_body(BodyDef {
        mass: Some(MASS),
        velocity: vec2(speed, 0.0),
        drag_coefficient: 0.4,
        ..BodyDef::new(Shape::circle(0.5)?)
    })?;
    Ok(world)
}

/// ln cosh z without overflow.
fn ln_cosh(z: Real) -> Real {
    z + ln_1p(exp(-2.0 * z)) - std::f64::consts::LN_2
}

pub static FALL: Scene = Scene {
    id: "S3",
    name: "fall_with_drag",
    title: "A fall with air drag towards its terminal velocity",
    about: "v = v_t tanh(gt/v_t), y = −(v_t²/g) ln cosh(gt/v_t), v_t = √(mg/k) = 9.0416 m/s.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || ball_in_air(G, 0.0),
        exact: |t| {
            let terminal2 = MASS * G / K;
            vec![at(0.0, -terminal2 / G * ln_cosh(G * t / libm::sqrt(terminal2)))]
        },
        duration: 3.0,
        dt: 1.0 / 60.0,
        length: 21.3608811068,
        fixed: 1e-4,
        toleranced: Some(Toleranced { tolerance: 1e-10, error: 1e-10 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "speeds at t = 1 and 3 against 7.18842565892 and 9.01469242065 m/s",
        column: Column::Fixed,
        asked: 1e-4,
        measure: || {
            let mut world = ball_in_air(G, 0.0)?;
            world.steps(1.0 / 60.0, 60)?;
            let first = world.bodies().twists[0].linear.y / -7.188_425_658_92 - 1.0;
            world.steps(1.0 / 60.0, 120)?;
            let last = world.bodies().twists[0].linear.y / -9.014_692_420_65 - 1.0;
            Ok(first.abs().max(last.abs()))
        },
    }],
};

/// x = (m/k) ln(1 + kv₀t/m).
fn coasted(t: Real) -> Pose {
    at(MASS / K * ln_1p(K * SPEED * t / MASS), 0.0)
}

/// Error of the speed against v₀/(1 + kv₀t/m).
fn speed_error(world: &World) -> Real {
    let exact = SPEED / (1.0 + K * SPEED * world.time() / MASS);
    (world.bodies().twists[0].linear.x / exact - 1.0).abs()
}

pub static COAST: Scene = Scene {
    id: "S4",
    name: "coast_with_drag",
    title: "A ball slowed by air drag alone from 20 m/s",
    about: "v = v₀/(1 + kv₀t/m), x = (m/k) ln(1 + kv₀t/m). At t = 5: 1.53846153846, 21.3745779788.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || ball_in_air(0.0, SPEED),
        exact: |t| vec![coasted(t)],
        duration: 5.0,
        dt: 1.0 / 60.0,
        length: 21.374_577_978_8,
        fixed: 1e-13,
        toleranced: Some(Toleranced { tolerance: 1e-14, error: 1e-13 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "speed at t = 5 against 1.53846153846 m/s",
        column: Column::Fixed,
        asked: 1e-13,
        measure: || {
            let mut world = ball_in_air(0.0, SPEED)?;
            world.steps(1.0 / 60.0, 300)?;
            Ok(speed_error(&world))
        },
    }],
};

/// One step over which drag would take 10⁴ times the momentum there is: kv₀h/m = 10⁴.
const LONG_STEP: Real = 1e4 * MASS / (K * SPEED);

pub static COAST_IN_ONE_STEP: Scene = Scene {
    id: "S4x",
    name: "coast_in_one_step",
    title: "The same in one step with k·v₀·h/m = 10⁴",
    about: "The same formula; explicit drag overshoots from k·v·h/m = 2 on.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || ball_in_air(0.0, SPEED),
        exact: |t| vec![coasted(t)],
        duration: LONG_STEP,
        dt: LONG_STEP,
        length: 76.0,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-13, error: 1e-12 }),
        judged: Judged::AsItComes,
    }),
    checks: &[Check {
        what: "speed against v₀/10001, without overshoot",
        column: Column::Fixed,
        asked: 1e-12,
        measure: || {
            let mut world = ball_in_air(0.0, SPEED)?;
            world.step(LONG_STEP)?;
            Ok(speed_error(&world))
        },
    }],
};

pub static SILHOUETTE: Scene = Scene {
    id: "S5b",
    name: "silhouette",
    title: "The projected width of a turned box, and its mean over all directions",
    about: "a|sin φ| + b|cos φ| for a box a × b that moves along φ in its own frame; the mean of a convex shape is its perimeter/π (Cauchy).",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(silhouette),
    checks: &[],
};

fn silhouette() -> Result<Vec<Number>> {
    let (a, b) = (2.0, 0.7);
    let shape = Shape::rectangle(a, b)?;
    let width = |shape: &Shape, angle: Real| {
        let (sin, cos) = crate::math::sin_cos(angle);
        Silhouette::new(&[shape]).width_across(vec2(cos, sin))
    };
    let mut numbers: Vec<Number> = (0..12)
        .map(|k| {
            let angle = 0.3 + Real::from(k);
            let (sin, cos) = crate::math::sin_cos(angle);
            let exact = a * sin.abs() + b * cos.abs();
            let what = format!("width of a box 2 × 0.7 along {angle:.1} rad");
            Number { what, value: width(&shape, angle), exact, asked: 1e-14 }
        })
        .collect();
    let hexagon = Shape::regular_polygon(6, 1.0)?;
    let capsule = Shape::capsule(vec2(-0.5, 0.0), vec2(0.5, 0.0), 0.25)?;
    for (name, shape) in [("box", &shape), ("hexagon", &hexagon), ("capsule", &capsule)] {
        let mean = mean_over_angles(|angle| width(shape, angle));
        let exact = shape.perimeter() / std::f64::consts::PI;
        let what = format!("mean width of a {name} against perimeter/π");
        numbers.push(Number { what, value: mean, exact, asked: 1e-12 });
    }
    Ok(numbers)
}

/// Mean over [0, 2π) of a function that is smooth but for kinks at multiples of π/6: Gauss's rule of
/// 8 points on 24 pieces.
fn mean_over_angles(f: impl Fn(Real) -> Real) -> Real {
    const NODES: [(Real, Real); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let half = std::f64::consts::TAU / 48.0;
    let piece = |k: u32| -> Real {
        let middle = half * Real::from(2 * k + 1);
        let pair = |(node, weight): &(Real, Real)| {
            0.5 * weight * (f(middle - half * node) + f(middle + half * node))
        };
        NODES.iter().map(pair).sum()
    };
    (0..24).map(piece).sum::<Real>() / 24.0
}
