//! Springs that swing, decay and carry.

use super::{TOLERANCED, disk, watch};
use crate::body::{BodyDef, BodyHandle};
use crate::error::Result;
use crate::joint::{Coefficients, Given, Hold, JointDef, JointKind, Spring};
use crate::math::{PI, Pose, Real, Vec2, cos, exp, sin_cos, vec2};
use crate::scenes::gauge::{at_most, worse};
use crate::scenes::stage::{DT, G, at_fixed_step, heavy, with_tolerance};
use crate::scenes::{Answer, Judged, Motion, Number, Reference, Scene, at, weightless};
use crate::shapes::Shape;
use crate::world::World;

/// One undamped spring on a mass is solved exactly while ωh < 2; of longer steps there is no order.
const EXACT: Judged = Judged::Contact { order: false };

/// Damping ratios of the four springs, and the catalogue's displacements at t = 1.3 s (m).
const DAMPED: [(Real, Real); 4] = [
    (0.0, -0.202_254_248_594),
    (0.1, -0.044_247_103_839_6),
    (1.0, 3.484_487_624_79e-7),
    (2.0, 3.382_692_447_91e-3),
];
/// Frequency (Hz) and first displacement (m).
const HERTZ: Real = 2.0;
const PULLED: Real = 0.25;

/// Displacement of a damped oscillator that is let go at x₀.
fn damped(time: Real, zeta: Real) -> Real {
    let omega = 2.0 * PI * HERTZ;
    let (decay, reach) = (zeta * omega, libm::sqrt((1.0 - zeta * zeta).abs()) * omega);
    let [even, odd] = if zeta < 1.0 {
        let (sin, cos) = sin_cos(reach * time);
        [cos, sin / reach].map(|part| part * exp(-decay * time))
    } else if zeta == 1.0 {
        [1.0, time].map(|part| part * exp(-decay * time))
    } else {
        let (slow, fast) = (exp((reach - decay) * time), exp((-reach - decay) * time));
        [0.5 * (slow + fast), 0.5 * (slow - fast) / reach]
    };
    PULLED * (even + decay * odd)
}

/// A point on a spring of 1 m along x at a height, drawn out.
fn add_sprung(world: &mut World, height: Real, hold: Hold) -> Result<BodyHandle> {
    let place = vec2(1.0 + PULLED, height);
    let body = world.add_body(BodyDef { position: place, ..BodyDef::point(2.0) })?;
    let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
    world.add_joint(JointDef::new(None, body, kind).anchored(vec2(0.0, height), place))?;
    Ok(body)
}

fn soft() -> Result<World> {
    let mut world = weightless()?;
    for (k, (zeta, _)) in DAMPED.into_iter().enumerate() {
        add_sprung(&mut world, k as Real, Hold::soft(HERTZ, zeta))?;
    }
    Ok(world)
}

pub static SOFT: Scene = Scene {
    id: "S7",
    name: "soft_joint",
    title: "Four masses on soft distance joints of 2 Hz, ζ = 0, 0.1, 1 and 2",
    about: "Damped oscillators let go at x₀ = 0.25 m; at t = 1.3: −0.202254248594, −0.0442471038396, 3.48448762479e-7, \
        3.38269244791e-3. Under gravity the sag is g/ω² = 0.0621225507207.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: soft,
        exact: |t| {
            let place =
                |(k, (zeta, _)): (usize, (Real, Real))| at(1.0 + damped(t, zeta), k as Real);
            DAMPED.into_iter().enumerate().map(place).collect()
        },
        duration: 1.3,
        dt: DT,
        length: PULLED,
        fixed: 1e-3,
        toleranced: TOLERANCED,
        judged: Judged::Joined { orders: true },
    }),
    checks: &[
        at_fixed_step("displacements at t = 1.3 against the catalogue's, of x₀", 1e-3, || {
            let mut world = soft()?;
            world.steps(DT, 78)?;
            let off = |(k, (_, exact)): (usize, (Real, Real))| {
                (world.bodies().poses[k].position.x - 1.0 - exact).abs() / PULLED
            };
            Ok(DAMPED.into_iter().enumerate().map(off).fold(0.0, worse))
        }),
        at_fixed_step("sag of a critically damped one against g/ω², relative", 1e-9, || {
            let mut world = heavy()?;
            let place = vec2(0.0, -1.0);
            let body = world.add_body(BodyDef { position: place, ..BodyDef::point(2.0) })?;
            let spring = JointDef::spring(None, body, Hold::soft(HERTZ, 1.0));
            world.add_joint(spring.anchored(Vec2::zeros(), place))?;
            world.steps(DT, 600)?;
            Ok(((-1.0 - world.body(body)?.position().y) / 0.062_122_550_720_7 - 1.0).abs())
        }),
    ],
};

/// Runs an undamped spring of ωh = `phase`; returns its damping ratio as seen, and the largest |x|/x₀.
///
/// Places a substep apart obey x₂ = t x₁ − b x₀, hence x₁² − x₀x₂ is multiplied by b = e^(−2ζωh) in each.
fn seen_damping(phase: Real) -> Result<(Real, Real)> {
    let h = DT / 4.0;
    let mut world = weightless()?;
    world.set_substeps(1)?;
    let hold = Hold::soft(phase / h / (2.0 * PI), 0.0);
    let body = add_sprung(&mut world, 0.0, hold)?;
    let mut places = vec![PULLED];
    for _ in 0..2400 {
        world.step(h)?;
        places.push(world.body(body)?.position().x - 1.0);
    }
    let square = |x: &[Real]| x[1] * x[1] - x[0] * x[2];
    let n = places.len() - 3;
    let ratio = square(&places[n..]) / square(&places[..3]);
    let zeta = -libm::log(ratio) / (2.0 * n as Real * phase);
    let most = places.iter().map(|x| x.abs() / PULLED).fold(0.0, worse);
    Ok((zeta, most))
}

pub static STIFF: Scene = Scene {
    id: "S7b",
    name: "stiff_springs",
    title: "Undamped springs of ωh = 0.1 … 100",
    about: "The amplitude stays, however long the step: the damping that is seen is below a thousandth up to ωh = 0.7, and nothing grows beyond.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| {
        let mut numbers = Vec::new();
        for phase in [0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 2.0, 3.0, 3.2, 5.0, 10.0, 30.0, 100.0] {
            let (zeta, most) = seen_damping(phase)?;
            if phase <= 0.7 {
                numbers.push(at_most(format!("|ζ| seen at ωh = {phase}"), zeta.abs(), 1e-3));
            }
            numbers.push(at_most(format!("growth at ωh = {phase}"), (most - 1.0).max(0.0), 1e-9));
        }
        Ok(numbers)
    }),
    checks: &[],
};

/// Stiffness (N/m) of a spring of 1 m between masses of 1 and 3 kg: ω = √(k/0.75) = 4.
const STIFFNESS: Real = 12.0;

fn two_masses() -> Result<World> {
    let mut world = weightless()?;
    let long = 1.0 + PULLED;
    let places = [vec2(-0.75 * long, 0.0), vec2(0.25 * long, 0.0)];
    let [a, b] = [(1.0, places[0]), (3.0, places[1])]
        .map(|(mass, position)| world.add_body(BodyDef { position, ..BodyDef::point(mass) }));
    let spring = Coefficients { stiffness: STIFFNESS, damping: 0.0 };
    let hold = Hold::Spring(Spring::Constants(spring));
    let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
    world.add_joint(JointDef::new(a?, b?, kind))?;
    Ok(world)
}

pub static TWO_MASSES: Scene = Scene {
    id: "S8",
    name: "two_masses_on_a_spring",
    title: "Masses of 1 and 3 kg on a spring",
    about: "ω = √(k/μ) with the reduced mass μ = 0.75 kg; the centre of mass is still.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: two_masses,
        exact: |t| {
            let long = 1.0 + PULLED * cos(libm::sqrt(STIFFNESS / 0.75) * t);
            vec![at(-0.75 * long, 0.0), at(0.25 * long, 0.0)]
        },
        duration: 10.0,
        dt: DT,
        length: PULLED,
        fixed: 1e-9,
        toleranced: TOLERANCED,
        judged: EXACT,
    }),
    checks: &[at_fixed_step("momentum over 10 s, of the largest Σm|v|", 1e-14, || {
        let mut world = two_masses()?;
        let (mut momentum, mut scale): (Real, Real) = (0.0, 0.0);
        for _ in 0..600 {
            world.step(DT)?;
            let twists = &world.bodies().twists;
            momentum = worse(momentum, world.momentum().norm());
            scale = scale.max(twists[0].linear.norm() + 3.0 * twists[1].linear.norm());
        }
        Ok(momentum / scale)
    })],
};

/// How far a mass hangs below the point that it is grabbed at, after it is moved on by `run`.
fn grabbed(hold: Hold, run: fn(&mut World) -> Result<()>) -> Result<Real> {
    let mut world = heavy()?;
    let body = world.add_body(BodyDef::point(3.0))?;
    let kind = JointKind::Grab { hold, max_force: None };
    world.add_joint(JointDef::new(None, body, kind))?;
    run(&mut world)?;
    Ok(-world.body(body)?.position().y)
}

/// Steps for 10 s.
fn steps(world: &mut World) -> Result<()> {
    world.steps(DT, 600)
}

pub static GRAB: Scene = Scene {
    id: "Q4",
    name: "grabbed_mass",
    title: "A mass hangs from a grab joint",
    about: "It hangs g/ω² below the point it is drawn to, and at it where the joint is hard.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let mut numbers =
            vec![at_most("offset of a hard one (m)", grabbed(Hold::Rigid, steps)?.abs(), 1e-6)];
        for hertz in [2.0, 5.0, 30.0] {
            let omega = 2.0 * PI * hertz;
            numbers.push(Number {
                what: format!("offset at {hertz} Hz against g/ω²"),
                value: grabbed(Hold::soft(hertz, 1.0), steps)?,
                exact: G / (omega * omega),
                asked: 1e-6,
            });
        }
        Ok(numbers)
    }),
    checks: &[with_tolerance("offsets after 10 s, the worst (m)", 1e-12, || {
        let run = |world: &mut World| world.advance(10.0, 1e-13).map(|_| ());
        let mut worst = grabbed(Hold::Rigid, run)?.abs();
        for hertz in [2.0, 5.0, 30.0] {
            let omega = 2.0 * PI * hertz;
            worst =
                worse(worst, (grabbed(Hold::soft(hertz, 1.0), run)? - G / (omega * omega)).abs());
        }
        Ok(worst)
    })],
};

/// A box of 1 × 0.5 m on an undamped spring of 1 Hz that holds it at a point of its own.
fn boxed(anchor: Vec2) -> Result<World> {
    let mut world = weightless()?;
    let def = BodyDef { filter: super::APART, ..BodyDef::new(Shape::rectangle(1.0, 0.5)?) };
    let body = world.add_body(def)?;
    let kind =
        JointKind::Distance { length: Some(1.0), hold: Hold::soft(1.0, 0.0), min: 0.0, max: None };
    let post = anchor + vec2(0.8, -1.1);
    world.add_joint(JointDef::new(None, body, kind).anchored(post, anchor))?;
    Ok(world)
}

pub static LONG: Scene = Scene {
    id: "J2",
    name: "spring_for_a_minute",
    title: "Undamped springs of 1 Hz for a minute",
    about: "A box held by its centre, and one held by a corner, which tumbles, keep their energy.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| {
        [("centre", Vec2::zeros()), ("corner", vec2(0.5, 0.25))]
            .into_iter()
            .map(|(what, anchor)| {
                let mut world = boxed(anchor)?;
                let start = world.energy()?.total();
                let drift = watch(&mut world, 60.0)?.energy / start;
                Ok(at_most(format!("energy in 60 s, held by the {what}, relative"), drift, 1e-3))
            })
            .collect()
    }),
    checks: &[],
};

/// First angle (rad) and frequency (Hz) of a disk on an angle spring.
const TURNED: Real = 1.0;
const TWIST_HERTZ: Real = 3.0;

pub static ANGLE: Scene = Scene {
    id: "J3",
    name: "angle_spring",
    title: "A disk on a hinge and an undamped angle spring of 3 Hz",
    about: "θ = θ₀ cos ωt.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let def = BodyDef { angle: TURNED, ..disk(0.5, 2.0, Vec2::zeros())? };
            let body = world.add_body(def)?;
            super::pin(&mut world, None, body, Vec2::zeros())?;
            let spring = Spring::new(TWIST_HERTZ, 0.0);
            let kind = JointKind::AngleSpring { angle: Some(0.0), spring };
            world.add_joint(JointDef::new(None, body, kind))?;
            Ok(world)
        },
        exact: |t| vec![Pose::new(Vec2::zeros(), TURNED * cos(2.0 * PI * TWIST_HERTZ * t))],
        duration: 5.0,
        dt: DT,
        length: 0.5,
        fixed: 1e-9,
        toleranced: TOLERANCED,
        judged: EXACT,
    }),
    checks: &[],
};

/// Frequency of the suspension (Hz).
const RIDE: Real = 1.5;

pub static SUSPENSION: Scene = Scene {
    id: "J4",
    name: "suspension",
    title: "A wheel let go on an undamped suspension of 1.5 Hz, its hub turned by a motor of bounded torque",
    about: "y = −(g/ω²)(1 − cos ωt), and the angle is ½τt²/I until the motor's speed.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = heavy()?;
            let wheel = world.add_body(disk(0.3, 10.0, Vec2::zeros())?)?;
            let kind = JointKind::Wheel {
                axis: Given::World(vec2(0.0, 1.0)),
                suspension: Hold::soft(RIDE, 0.0),
                limits: None,
                motor: Some(crate::joint::Motor { speed: 100.0, max: Some(0.45) }),
            };
            world.add_joint(JointDef::new(None, wheel, kind))?;
            Ok(world)
        },
        exact: |t| {
            let omega = 2.0 * PI * RIDE;
            let down = G / (omega * omega) * (1.0 - cos(omega * t));
            // I = mr²/2 = 0.45 kg·m².
            vec![Pose::new(vec2(0.0, -down), 0.5 * t * t)]
        },
        duration: 4.0,
        dt: DT,
        length: 0.1,
        fixed: 1e-9,
        toleranced: None,
        judged: EXACT,
    }),
    checks: &[],
};
