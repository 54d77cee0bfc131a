//! Joints and springs at the ends of their ranges.

use super::{pin, rod, watch};
use crate::body::{BodyDef, BodyHandle};
use crate::error::Result;
use crate::joint::{Coefficients, Hold, JointDef, JointKind, Spring};
use crate::math::{PI, Real, Vec2, cos, vec2};
use crate::scenes::gauge::{at_most, worse};
use crate::scenes::stage::{DT, G, heavy};
use crate::scenes::{Answer, Reference, Scene, weightless};
use crate::world::World;

/// Ten rods from the side, the last with a mass of its own.
fn chain(last: Real) -> Result<(World, Real)> {
    const LINKS: usize = 10;
    let mut world = heavy()?;
    let mut before: Option<BodyHandle> = None;
    for i in 0..LINKS {
        let (mass, left) = (if i + 1 == LINKS { last } else { 1.0 }, i as Real);
        let body = world.add_body(rod(1.0, mass, vec2(left + 0.5, 0.0))?)?;
        pin(&mut world, before, body, vec2(left, 0.0))?;
        before = Some(body);
    }
    // What all would have fallen by when hanging straight.
    let fall = (0..LINKS).map(|i| i as Real + 0.5).sum::<Real>() + (last - 1.0) * 9.5;
    Ok((world, G * fall))
}

/// Two rods on one hinge, free, thrown apart.
fn joint(ratio: Real) -> Result<(World, Real)> {
    let mut world = weightless()?;
    let a = world.add_body(rod(1.0, 1.0, vec2(-0.5, 0.0))?)?;
    let spin = 3.0;
    let thrown = BodyDef {
        velocity: vec2(0.0, 0.5 * spin),
        angular_velocity: spin,
        ..rod(1.0, ratio, vec2(0.5, 0.0))?
    };
    let b = world.add_body(thrown)?;
    pin(&mut world, Some(a), b, Vec2::zeros())?;
    let kinetic = world.energy()?.kinetic;
    Ok((world, kinetic))
}

/// Stiffness (N/m) for two masses on a spring to swing at 2 Hz, and how far off they are after 5 s, of the amplitude.
fn spring_off(ratio: Real) -> Result<Real> {
    let mut world = weightless()?;
    let [inner, outer] = [1.0, ratio].map(|mass| {
        let position = vec2(if mass == 1.0 { 0.0 } else { 1.25 }, 0.0);
        world.add_body(BodyDef { position, ..BodyDef::point(mass) })
    });
    let omega = 4.0 * PI;
    let stiffness = omega * omega / (1.0 + 1.0 / ratio);
    let spring = Spring::Constants(Coefficients { stiffness, damping: 0.0 });
    let hold = Hold::Spring(spring);
    let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
    let joint = world.add_joint(JointDef::new(inner?, outer?, kind))?;
    let mut off: Real = 0.0;
    for _ in 0..300 {
        world.step(DT)?;
        let long = world.joint(joint)?.travel()[0] - 1.0;
        off = worse(off, (long / 0.25 - cos(omega * world.time())).abs());
    }
    Ok(off)
}

pub static RATIOS: Scene = Scene {
    id: "X1j",
    name: "mass_ratios_in_joints",
    title: "Mass ratios of 10⁻³ … 10⁶ in a falling chain, across a hinge and across a spring",
    about: "A chain of ten rods let go from the side for 4 s, two free rods on a hinge, two masses on a spring of 2 Hz (exact: cos ωt, \
        ω² = k(1/m₁ + 1/m₂)). Joints do not open, no energy is made, the books balance.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| {
        let mut numbers = Vec::new();
        for ratio in [1e-3, 1e-2, 0.1, 10.0, 1e3, 1e6] {
            for (what, (mut world, scale)) in [("chain", chain(ratio)?), ("hinge", joint(ratio)?)] {
                let seen = watch(&mut world, 4.0)?;
                let of = format!("{what} {ratio:e}:1");
                // Energy as pendulums are asked to keep it for a minute, to 0.1 %; gaps as S9.
                numbers.extend([
                    at_most(format!("energy gained, {of}"), seen.gained / scale, 1e-3),
                    at_most(format!("books out of balance, {of}"), seen.unbalanced / scale, 1e-9),
                    at_most(format!("gap (m), {of}"), seen.gap, 1e-6),
                ]);
            }
            let off = spring_off(ratio)?;
            numbers.push(at_most(format!("spring {ratio:e}:1, of the amplitude"), off, 1e-3));
        }
        Ok(numbers)
    }),
    checks: &[],
};

/// A point on a grab joint, and its rest g/ω² below.
fn hanging(hold: Hold, place: Vec2) -> Result<World> {
    let mut world = heavy()?;
    let body = world.add_body(BodyDef { position: place, ..BodyDef::point(2.0) })?;
    let kind = JointKind::Grab { hold, max_force: None };
    let joint = JointDef::new(None, body, kind);
    world.add_joint(joint.anchored_locally(Vec2::zeros(), Vec2::zeros()))?;
    Ok(world)
}

/// What a spring shows: how far one at rest under its load moves, relative to the sag g/ω²; and the largest |x|/x₀ of one
/// that is let go without a load.
fn stiffness_seen(hertz: Real, zeta: Real) -> Result<(Real, Real)> {
    let omega = 2.0 * PI * hertz;
    let sag = G / (omega * omega);
    let hold = Hold::soft(hertz, zeta);
    let mut world = hanging(hold, vec2(0.0, -sag))?;
    // 1e-9 of the sag, or 64 roundings of what gravity gives in a substep where that is more.
    let scale = sag + 64.0 * Real::EPSILON / 1e-9 * G * (DT / 4.0) * (DT / 4.0);
    let mut moved: Real = 0.0;
    for _ in 0..300 {
        world.step(DT)?;
        moved = worse(moved, (world.bodies().poses[0].position + vec2(0.0, sag)).norm() / scale);
    }
    let mut world = hanging(hold, vec2(0.1, 0.0))?;
    world.set_gravity(Vec2::zeros())?;
    let mut most: Real = 0.0;
    for _ in 0..300 {
        world.step(DT)?;
        most = worse(most, world.bodies().poses[0].position.norm() / 0.1);
    }
    Ok((moved, most))
}

pub static STIFFNESS: Scene = Scene {
    id: "X6",
    name: "joint_stiffness",
    title: "Joints of 0.1 Hz … 10⁶ Hz, ζ = 0 … 10",
    about: "Under a load they sag by g/ω², exactly; without one they do not grow.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let mut numbers = Vec::new();
        for power in -1..=6 {
            let hertz = libm::pow(10.0, Real::from(power));
            for zeta in [0.0, 0.1, 1.0, 10.0] {
                let (moved, most) = stiffness_seen(hertz, zeta)?;
                let of = format!("{hertz} Hz, ζ = {zeta}");
                numbers.extend([
                    at_most(format!("sag off g/ω², relative, {of}"), moved, 1e-9),
                    at_most(format!("growth, {of}"), (most - 1.0).max(0.0), 1e-9),
                ]);
            }
        }
        Ok(numbers)
    }),
    checks: &[],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_equal_rods_falls_by_its_own_height() {
        let (world, fall) = chain(1.0).unwrap();
        assert!((fall - world.mass() * G * 5.0).abs() < 1e-9);
    }
}
