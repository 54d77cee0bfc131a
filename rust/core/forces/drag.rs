//! Resistance of the air and damping, and their exact flow.
//!
//! With u the velocity against the air, a body obeys m u' = −½ρCA|u|u − c m u. While the direction
//! of u stays, that is the scalar equation u' = −c u − κu², κ = ½ρCA/m, of Bernoulli, whose flow is
//! known: with s(t) = (1 − e^(−ct))/c (s = t for c = 0),
//!   u(t) = u₀ e^(−ct) / (1 + κu₀s),   distance = ln(1 + κu₀s)/κ.
//! It neither overshoots nor travels too far at any step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::{DragWidth, Info, Mass};
use crate::error::{Error, Result};
use crate::math::{Pose, Real, Twist, Vec2, Wrench, exp, exp_m1, ln_1p, vec2};
use crate::shapes::Facet;

/// The air that fills a world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Air {
    /// Density ρ (kg/m²: the engine's world is one metre deep). 0: no air, and nothing is paid for it.
    pub density: Real,
    /// Velocity of the air (m/s). Linear damping, too, is against the moving air.
    #[schemars(with = "[Real; 2]")]
    pub wind: Vec2,
}

impl Default for Air {
    fn default() -> Self {
        Self { density: 0.0, wind: vec2(0.0, 0.0) }
    }
}

/// s(t) = (1 − e^(−ct))/c: how far a unit velocity carries in a time t when it decays at rate c.
#[must_use]
pub fn decay_time(rate: Real, t: Real) -> Real {
    if rate == 0.0 { t } else { -exp_m1(-rate * t) / rate }
}

/// Flow of u' = −cu − κu² for u₀ ≥ 0 over a time t: (speed, distance). None where there is no such
/// state, which can be only for t < 0.
#[must_use]
pub fn decay(speed: Real, rate: Real, kappa: Real, t: Real) -> Option<(Real, Real)> {
    let s = decay_time(rate, t);
    let z = kappa * speed * s;
    let left = if rate == 0.0 { 1.0 } else { exp(-rate * t) };
    // ln(1 + z)/κ = u₀s·ln(1 + z)/z, which stays exact as z → 0.
    let distance = if z == 0.0 { speed * s } else { ln_1p(z) / kappa };
    (z > -1.0).then(|| (speed * left / (1.0 + z), distance))
}

/// Whether quadratic drag acts on the body.
pub fn has_drag(info: &Info, air: Air) -> bool {
    air.density > 0.0 && info.def.is_dynamic() && info.def.drag_coefficient > 0.0
}

/// Whether drag or damping acts on the body.
pub fn resists(info: &Info, air: Air) -> bool {
    has_drag(info, air) || info.def.linear_damping > 0.0 || info.def.angular_damping > 0.0
}

/// The facet of its silhouette that a body shows to the air; none where its width has no kinks of
/// that kind.
pub fn facet(info: &Info, air: Air, (pose, twist): (&Pose, &Twist)) -> Option<Facet> {
    let kinks = has_drag(info, air) && info.def.drag_width == DragWidth::Silhouette;
    kinks.then(|| info.silhouette.facet(heading(air, (pose, twist))))
}

/// The way a body goes through the air, in its own frame (m/s).
pub fn heading(air: Air, (pose, twist): (&Pose, &Twist)) -> Vec2 {
    pose.rot().apply_inverse(twist.linear - air.wind)
}

/// Whether a facet still gives the width that the body shows to the air.
pub fn shows(info: &Info, air: Air, (pose, twist): (&Pose, &Twist), facet: &Facet) -> bool {
    // Next to a kink both facets give the same width; rounding must not send steps back and forth.
    const SAME: Real = 1e-10;
    let direction = heading(air, (pose, twist));
    let width = info.silhouette.width_across(direction);
    (width - facet.width_across(direction)).abs() <= SAME * width
}

/// k = ½ρCA in F = −k|u|u for a body that moves through the air with `relative`; A that of the given
/// facet of the silhouette, if there is one.
fn drag_factor(
    info: &Info,
    air: Air,
    (angle, relative): (Real, Vec2),
    facet: Option<&Facet>,
) -> Real {
    if !has_drag(info, air) || relative == Vec2::zeros() {
        return 0.0;
    }
    let rot = Pose::new(Vec2::zeros(), angle).rot();
    let direction = rot.apply_inverse(relative);
    let width = match info.def.drag_width {
        DragWidth::Silhouette => facet
            .map_or_else(|| info.silhouette.width_across(direction), |f| f.width_across(direction)),
        DragWidth::BoundingBox => info.silhouette.bounding_box_width_across(relative, rot),
        DragWidth::Fixed(width) => width,
    };
    0.5 * air.density * info.def.drag_coefficient * width
}

/// Force and torque of air and damping, for methods that treat them as any other force.
pub fn resistance(
    mass: &Mass,
    info: &Info,
    air: Air,
    (pose, twist): (&Pose, &Twist),
    facet: Option<&Facet>,
) -> Option<Wrench> {
    if !resists(info, air) {
        return None;
    }
    let relative = twist.linear - air.wind;
    let k = drag_factor(info, air, (pose.angle, relative), facet);
    let factor = k * relative.norm() + info.def.linear_damping * mass.mass;
    Some(Wrench::new(-factor * relative, -info.def.angular_damping * mass.inertia * twist.angular))
}

/// Exact motion for a time h under air and damping alone.
pub fn drift(
    mass: &Mass,
    info: &Info,
    air: Air,
    (h, pose, twist): (Real, &mut Pose, &mut Twist),
) -> Result<()> {
    let spin_rate = if mass.inverse_inertia > 0.0 { info.def.angular_damping } else { 0.0 };
    let middle = pose.angle + twist.angular * decay_time(spin_rate, h / 2.0);
    pose.angle += twist.angular * decay_time(spin_rate, h);
    twist.angular *= if spin_rate == 0.0 { 1.0 } else { exp(-spin_rate * h) };

    let relative = twist.linear - air.wind;
    let k = drag_factor(info, air, (middle, relative), None);
    let free = vec2(
        if mass.inverse.x > 0.0 { relative.x } else { 0.0 },
        if mass.inverse.y > 0.0 { relative.y } else { 0.0 },
    );
    let speed = free.norm();
    if speed == 0.0 {
        pose.position += twist.linear * h;
        return Ok(());
    }
    // Along a locked axis only the wind moves against the body; it adds to |u| and stays.
    let across = (relative - free).norm();
    let moved = if across == 0.0 {
        decay(speed, info.def.linear_damping, k / mass.mass, h)
    } else {
        decay_on_rail(speed, across, (info.def.linear_damping, k / mass.mass), h)
    };
    let (left, distance) = moved.ok_or_else(|| {
        Error::invalid(
            "dt",
            h.abs(),
            "a smaller step: this method steps back in time, and back then this drag has no state",
        )
    })?;
    let direction = free / speed;
    pose.position += air.wind.component_mul(&mass.inverse.map(|w| if w > 0.0 { h } else { 0.0 }))
        + direction * distance;
    twist.linear += direction * (left - speed);
    Ok(())
}

/// Flow of u' = −κ√(u² + b²)u with damping halves around it: a body on a rail in a cross wind b.
/// u(t) = b/sinh(z), z = κbt + asinh(b/u₀); distance = ln(tanh(z/2)/tanh(z₀/2))/κ.
fn decay_on_rail(
    speed: Real,
    across: Real,
    (rate, kappa): (Real, Real),
    t: Real,
) -> Option<(Real, Real)> {
    let left = exp(-rate * t / 2.0);
    let start = speed * left;
    if kappa == 0.0 || start == 0.0 {
        return Some((start * left, start * t));
    }
    let z0 = libm::asinh(across / start);
    let z = z0 + kappa * across * t;
    let distance = libm::log(libm::tanh(z / 2.0) / libm::tanh(z0 / 2.0)) / kappa;
    (z > 0.0).then(|| (across / libm::sinh(z) * left, distance))
}
