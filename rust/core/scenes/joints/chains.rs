//! Chains: swinging, hanging, loaded.

use super::{pin, rod, watch, widest};
use crate::body::BodyDef;
use crate::error::Result;
use crate::joint::{JointDef, JointHandle};
use crate::math::{PI, Real, Vec2, atan2, cos, vec2};
use crate::scenes::gauge::{at_most, worse};
use crate::scenes::stage::{DT, G, heavy, with_tolerance};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::world::World;

/// Links of the swinging chains, and the first zero of the Laguerre polynomial of that degree.
const SWINGS: [(usize, Real); 3] =
    [(3, 0.415_774_556_783), (5, 0.263_560_319_718), (10, 0.137_793_470_540)];

/// L₀(x) … L_n(x): (j + 1)L_{j+1} = (2j + 1 − x)L_j − jL_{j−1}.
fn laguerre(n: usize, x: Real) -> Vec<Real> {
    let mut values = vec![1.0, 1.0 - x];
    for j in 1..n {
        let k = j as Real;
        values.push(((2.0 * k + 1.0 - x) * values[j] - k * values[j - 1]) / (k + 1.0));
    }
    values
}

/// Points of 1 kg on massless rods of 1 m in the slowest small swing, the lowest by `reach` (m) aside: point j from below
/// is aside by L_j(x).
fn swinging(n: usize, x: Real, reach: Real) -> Result<World> {
    let aside = laguerre(n, x);
    let mut world = heavy()?;
    let (mut above, mut place) = (None, Vec2::zeros());
    for j in (0..n).rev() {
        let upper = if j + 1 == n { 0.0 } else { aside[j + 1] };
        let dx = reach * (aside[j] - upper);
        let next = place + vec2(dx, -libm::sqrt(1.0 - dx * dx));
        let body = world.add_body(BodyDef { position: next, ..BodyDef::point(1.0) })?;
        world.add_joint(JointDef::distance(above, body).anchored(place, next))?;
        (above, place) = (Some(body), next);
    }
    Ok(world)
}

/// Period of the lowest point: twice the time from one passage to the next.
fn swing_period(n: usize, x: Real) -> Result<Real> {
    let mut world = swinging(n, x, 0.01)?;
    world.set_substeps(1)?;
    let (mut passages, mut count, mut before) = ([0.0; 2], 0, 1.0);
    while count < 2 {
        world.step(DT / 4.0)?;
        let (x, v) =
            (world.bodies().poses[n - 1].position.x, world.bodies().twists[n - 1].linear.x);
        if x * before < 0.0 {
            passages[count] = world.time() - x / v;
            count += 1;
        }
        before = x;
        if world.time() > 60.0 {
            return Ok(Real::INFINITY);
        }
    }
    Ok(2.0 * (passages[1] - passages[0]))
}

/// How far the lowest point is from the middle a quarter of a period after it was let go (s), of the quarter. Of a reach so
/// small that the square of the angles does not count.
fn quarter_off(n: usize, x: Real) -> Result<Real> {
    let mut world = swinging(n, x, 1e-5)?;
    let quarter = 0.5 * PI / libm::sqrt(G * x);
    world.advance(quarter, 1e-13)?;
    let bodies = world.bodies();
    Ok((bodies.poses[n - 1].position.x / bodies.twists[n - 1].linear.x / quarter).abs())
}

pub static CHAIN_SWING: Scene = Scene {
    id: "S14",
    name: "hanging_chain_swing",
    title: "Hanging chains of 3, 5 and 10 points in their slowest small swing",
    about: "ω² = (g/l)·x with x the first zero of the Laguerre polynomial L_N: 0.415774556783, 0.263560319718, 0.137793470540.",
    reference: Reference::Figures(4e-12),
    answer: Answer::Numbers(|| {
        let number = |(n, x): (usize, Real)| {
            let exact = 2.0 * PI / libm::sqrt(G * x);
            let what = format!("period of {n} links (s)");
            Ok(Number { what, value: swing_period(n, x)?, exact, asked: 1e-3 })
        };
        SWINGS.into_iter().map(number).collect()
    }),
    checks: &[with_tolerance("a quarter of the period, the worst, relative", 1e-8, || {
        SWINGS.into_iter().try_fold(0.0, |sum, (n, x)| Ok(worse(sum, quarter_off(n, x)?)))
    })],
};

/// Length (m), span (m) and mass (kg) of the catenary.
const LONG: Real = 2.0;
const SPAN: Real = 1.6;
const MASS: Real = 4.0;

/// Numbers of rods, H/W, sags (m) and pulls at the ends, of W.
const CATENARIES: [(usize, Real, Real, Real); 2] = [
    (10, 0.337_301_091_711, 0.533_728_851_647, 0.603_135_164_345),
    (20, 0.337_976_109_594, 0.531_583_133_233, 0.603_512_925_012),
];

/// Angles of n equal rods at rest between two points: tan φ_i = (i + ½ − n/2)(W/n)/H, for a part H/W.
fn catenary_angles(n: usize, pull: Real) -> Vec<Real> {
    let angle = |i: usize| {
        let below = (i as Real + 0.5) / n as Real - 0.5;
        atan2(below, pull)
    };
    (0..n).map(angle).collect()
}

/// H/W for which the rods span what they should, by halving.
fn catenary_pull(n: usize) -> Real {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let across: Real = catenary_angles(n, middle).iter().map(|angle| cos(*angle)).sum();
        if across * LONG / (n as Real) < SPAN {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// A chain of n rods at rest in equilibrium, and its joints from left to right.
fn catenary(n: usize) -> Result<(World, Vec<JointHandle>)> {
    let mut world = heavy()?;
    let length = LONG / n as Real;
    let (mut joints, mut before, mut end) = (Vec::new(), None, Vec2::zeros());
    for angle in catenary_angles(n, catenary_pull(n)) {
        let along = crate::math::Rot::new(angle).apply(vec2(length, 0.0));
        let def = BodyDef { angle, ..rod(length, MASS / n as Real, end + along * 0.5)? };
        let body = world.add_body(def)?;
        joints.push(pin(&mut world, before, body, end)?);
        (before, end) = (Some(body), end + along);
    }
    if let Some(last) = before {
        joints.push(world.add_joint(JointDef::revolute(last, None).at(end))?);
    }
    Ok((world, joints))
}

/// How deep the joints hang (m).
fn sag(world: &World, joints: &[JointHandle]) -> Result<Real> {
    joints.iter().try_fold(0.0, |deep, joint| Ok(worse(deep, -world.joint(*joint)?.anchors()[1].y)))
}

pub static CATENARY: Scene = Scene {
    id: "Q1",
    name: "catenary",
    title: "A chain of 10 and of 20 rods, 2 m long, hangs between points 1.6 m apart for 10 s",
    about: "tan φ_i = (i + ½ − N/2)(W/N)/H. N = 10: H/W = 0.337301091711, sag 0.533728851647, pull at the ends 0.603135164345 W; \
        N = 20: 0.337976109594, 0.531583133233, 0.603512925012.",
    reference: Reference::Figures(2e-12),
    answer: Answer::Numbers(|| {
        let mut numbers = Vec::new();
        for (n, pull, deep, end) in CATENARIES {
            let (mut world, joints) = catenary(n)?;
            world.steps(DT, 600)?;
            let [left, right] = [joints[0], joints[n]].map(|joint| world.joint(joint));
            let [left, right] = [left?.reaction().force, right?.reaction().force];
            let weight = MASS * G;
            let number = |what: &str, value: Real, exact: Real, asked: Real| Number {
                what: format!("{what}, {n} rods"),
                value,
                exact,
                asked,
            };
            numbers.extend([
                number("sag (m)", sag(&world, &joints)?, deep, 1e-4),
                number("H/W on the left", -left.x / weight, pull, 1e-2),
                number("H/W on the right", -right.x / weight, pull, 1e-2),
                number("pull at the left end, of W", left.norm() / weight, end, 1e-2),
                number("pull at the right end, of W", right.norm() / weight, end, 1e-2),
                number("largest gap (m)", widest(&world)?, 0.0, 1e-6),
            ]);
        }
        Ok(numbers)
    }),
    checks: &[with_tolerance("sag (m) and H/W after 10 s, the worst", 1e-9, || {
        CATENARIES.into_iter().try_fold(0.0, |sum, (n, pull, deep, _)| {
            let (mut world, joints) = catenary(n)?;
            world.advance(10.0, 1e-12)?;
            let left = world.joint(joints[0])?.reaction().force;
            let off = (sag(&world, &joints)? - deep).abs();
            Ok(worse(sum, worse(off, (left.x / (MASS * G) + pull).abs())))
        })
    })],
};

/// Links of the loaded chain.
const LINKS: usize = 20;

/// A chain of 20 rods of 1 m that hangs, the last with a mass of its own, and its joints from above.
fn loaded(mass: Real) -> Result<(World, Vec<JointHandle>)> {
    let mut world = heavy()?;
    let (mut joints, mut above) = (Vec::new(), None);
    for i in 0..LINKS {
        let mass = if i + 1 == LINKS { mass } else { 1.0 };
        let top = -(i as Real);
        let def = rod(1.0, mass, vec2(0.0, top - 0.5))?;
        let body = world.add_body(BodyDef { angle: -PI / 2.0, ..def })?;
        joints.push(pin(&mut world, above, body, vec2(0.0, top))?);
        above = Some(body);
    }
    Ok((world, joints))
}

/// How far the end has moved (m), and how far off the pulls are that the joints bear, relative.
fn stretch_and_pull(world: &World, joints: &[JointHandle], mass: Real) -> Result<[Real; 2]> {
    let mut off: Real = 0.0;
    for (i, joint) in joints.iter().enumerate() {
        let below = G * ((LINKS - 1 - i) as Real + mass);
        let force = world.joint(*joint)?.reaction().force;
        off = worse(off, (force - vec2(0.0, below)).norm() / below);
    }
    let last = world.bodies().poses[LINKS - 1].position;
    Ok([(last - vec2(0.0, 0.5 - LINKS as Real)).norm(), off])
}

pub static LOADED_CHAIN: Scene = Scene {
    id: "Q2",
    name: "loaded_chain",
    title: "A hanging chain of 20 rods, the last of 1 … 10⁶ times the mass of a link",
    about: "It does not stretch; each joint bears the weight below it.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let mut numbers = Vec::new();
        for mass in [1.0, 1e3, 1e6] {
            let (mut world, joints) = loaded(mass)?;
            let seen = watch(&mut world, 4.0)?;
            let [stretch, off] = stretch_and_pull(&world, &joints, mass)?;
            numbers.extend([
                at_most(format!("largest gap in 4 s, {mass:e}:1 (m)"), seen.gap, 1e-4),
                at_most(format!("way of the end, {mass:e}:1 (m)"), stretch, 1e-4),
                at_most(format!("pull against the weight below, {mass:e}:1"), off, 1e-6),
            ]);
        }
        Ok(numbers)
    }),
    checks: &[with_tolerance(
        "way of the end (m) and pull against the weight below after 4 s, 1 … 10⁶:1, the worst",
        1e-10,
        || {
            [1.0, 1e3, 1e6].into_iter().try_fold(0.0, |sum, mass| {
                let (mut world, joints) = loaded(mass)?;
                world.advance(4.0, 1e-12)?;
                let [stretch, off] = stretch_and_pull(&world, &joints, mass)?;
                Ok(worse(sum, worse(stretch, off)))
            })
        },
    )],
};
