//! How fast the loads of joints turn what they hang on.

use super::{Bodies, Tie, Ties};
use crate::constraints::Velocity;
use crate::constraints::joint::Rates;
use crate::joint::JointKind;
use crate::math::{Real, Vec2};
use crate::methods::contact_step::Group;

/// Bound of the rate (rad/s) at which the bodies of a group swing under what its joints bear, as a string under tension
/// does.
///
/// A force F that turns with a body, its arm r, is a spring F·r of the angle, and one along a line of length L a
/// spring F/L across it: the geometric stiffness of a structure. Its modes are bounded as those of springs are, see
/// [`Rates`]. The step takes these forces at the directions in its middle, as leapfrog does, and leapfrog is stable while ωh < 2.
/// Forces of springs, which swing by themselves and are no larger than their strain allows, are left out.
pub fn turning_rate(group: &mut Group) -> Real {
    let Group { ties, velocities, places, angles, .. } = group;
    let Ties { list, rates, .. } = ties;
    let bodies = Bodies { velocities, places, angles };
    rates.clear();
    rates.resize(velocities.len(), Rates::default());
    for tie in &*list {
        let load = tie.load.norm();
        if load == 0.0 || tie.law.springs[0].is_some() {
            continue;
        }
        let line = across(tie, &bodies);
        for (slot, arm) in tie.slots.iter().zip(tie.law.arms) {
            let Some(slot) = slot.map(|slot| slot as usize) else { continue };
            let Velocity { inverse_mass, inverse_inertia, .. } = &velocities[slot];
            rates[slot].stiffness +=
                load * (arm.norm() * inverse_inertia + line * inverse_mass.x.max(inverse_mass.y));
        }
    }
    let of_tie = |tie: &Tie| -> Real {
        tie.slots.iter().flatten().map(|slot| rates[*slot as usize].stiffness).sum()
    };
    list.iter().map(of_tie).fold(0.0, Real::max).sqrt()
}

/// 1/L of what joins two points along a line (1/m); 0 of what does not.
fn across(tie: &Tie, bodies: &Bodies<'_>) -> Real {
    if !matches!(tie.law.kind, JointKind::Distance { .. }) {
        return 0.0;
    }
    let pair = bodies.pair(tie);
    let anchor =
        |side: usize| -> Vec2 { pair.centers[side] + pair.rots[side].apply(tie.law.arms[side]) };
    let length = (anchor(1) - anchor(0)).norm();
    if length > 0.0 { 1.0 / length } else { 0.0 }
}

/// Takes what the joints bore over a span of this duration for their load.
pub fn take_loads(group: &mut Group, duration: Real) {
    for tie in &mut group.ties.list {
        tie.load = tie.given.force / duration;
    }
}
