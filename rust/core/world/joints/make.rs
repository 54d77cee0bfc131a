//! From a definition to a joint: what was left open is taken from where the bodies stand.

use std::mem::discriminant;

use super::{index_of, law_of, pair_of};
use crate::body::Bodies;
use crate::constraints::joint::{Action, Law, Pair, Row};
use crate::error::{Error, Result};
use crate::joint::{Custom, Given, Joint, JointDef, JointKind, MatterEnd, ROWS};
use crate::math::{Pose, Real, Wrench, floor};

/// Checks a definition and makes the joint.
pub(super) fn joint(bodies: &Bodies, def: JointDef, custom: Option<Custom>) -> Result<Joint> {
    def.validated()?;
    places(bodies, &def)?;
    made(bodies, def, custom, [None; 2])
}

/// The same of a joint with sides that are points of matter, whose anchors say where those are.
pub(in crate::world) fn with_matter(
    bodies: &Bodies,
    def: JointDef,
    matter: [Option<MatterEnd>; 2],
) -> Result<Joint> {
    for body in def.bodies.into_iter().flatten() {
        bodies.index(body)?;
    }
    made(bodies, def, None, matter)
}

fn made(
    bodies: &Bodies,
    mut def: JointDef,
    custom: Option<Custom>,
    matter: [Option<MatterEnd>; 2],
) -> Result<Joint> {
    let places = def.bodies.map(|body| body.and_then(|body| bodies.index(body).ok()));
    let frames = places.map(|i| i.map_or(Pose::IDENTITY, |i| bodies.origin(i)));
    for (anchor, frame) in def.anchors.iter_mut().zip(&frames) {
        if let Given::World(point) = *anchor {
            *anchor = Given::Local(frame.apply_inverse(point));
        }
    }
    if let Some(axis) = def.axis_mut() {
        let local = match *axis {
            Given::Local(direction) => direction,
            Given::World(direction) => frames[0].rot().apply_inverse(direction),
        };
        // What was normalised once stays as it is, to the bit.
        let length = local.norm();
        let is_unit = (length - 1.0).abs() <= 2.0 * Real::EPSILON;
        *axis = Given::Local(if is_unit { local } else { local / length });
    }
    let rigid = def.kind != JointKind::Filter && matter == [None; 2];
    let mut joint = Joint {
        rigid,
        matter,
        def,
        springs: [None; ROWS],
        impulses: [0.0; ROWS],
        substep: 0.0,
        reaction: Wrench::ZERO,
        notch: 0.0,
        custom,
    };
    let pair = pair_of(bodies, &joint);
    close(&mut joint, bodies, &pair);
    tune(&mut joint, bodies, &pair);
    Ok(joint)
}

/// What a joint between the same bodies keeps when it is changed: springs that stay as they are and, where its rows are
/// still of the same kinds, what these remember.
pub(in crate::world) fn carry_over(bodies: &Bodies, before: &Joint, changed: &mut Joint) {
    let (old, new) = (before.def.kind, changed.def.kind);
    for (k, (own, known)) in changed.springs.iter_mut().zip(&before.springs).enumerate() {
        if old.spring(k) == new.spring(k) && own.is_some() && known.is_some() {
            *own = *known;
        }
    }
    let actions = |joint: &Joint| {
        let rows = law_of(bodies, joint).rows(&pair_of(bodies, joint)).rows;
        rows.map(|row| discriminant(&row.action))
    };
    if actions(before) == actions(changed) {
        (changed.impulses, changed.substep) = (before.impulses, before.substep);
    }
    if old == new {
        changed.notch = before.notch;
    }
    changed.reaction = before.reaction;
}

/// Places of the bodies: two different ones, of which at least one can move.
fn places(bodies: &Bodies, def: &JointDef) -> Result<()> {
    let mut places = [None; 2];
    for (place, body) in places.iter_mut().zip(def.bodies) {
        *place = body.map(|body| bodies.index(body)).transpose()?;
    }
    if places[0] == places[1] {
        let got = if places[0].is_some() { "the same body twice" } else { "the world twice" };
        return Err(Error::invalid("the pair of bodies", got, "two different bodies"));
    }
    if !places.iter().flatten().any(|i| bodies.masses[*i].is_free()) {
        let allowed = "at least one dynamic body with an axis that is not locked";
        return Err(Error::invalid("the pair of bodies", "one that nothing can move", allowed));
    }
    Ok(())
}

/// Takes what was left open from where the bodies stand.
fn close(joint: &mut Joint, bodies: &Bodies, pair: &Pair) {
    let angle = pair.angles[1] - pair.angles[0];
    let anchors = [0, 1].map(|side| {
        let law = law_of(bodies, joint);
        pair.centers[side] + pair.rots[side].apply(law.arms[side])
    });
    let apart = anchors[1] - anchors[0];
    match &mut joint.def.kind {
        JointKind::Distance { length, .. } => {
            length.get_or_insert(apart.norm());
        }
        JointKind::Revolute { angle: own, .. }
        | JointKind::Prismatic { angle: own, .. }
        | JointKind::Weld { angle: own, .. }
        | JointKind::Motor { angle: own, .. }
        | JointKind::AngleSpring { angle: own, .. } => {
            own.get_or_insert(angle);
        }
        JointKind::Gear { ratio, phase } => {
            phase.get_or_insert(*ratio * pair.angles[0] + pair.angles[1]);
        }
        JointKind::Pulley { over, ratio, length, .. } => {
            let ropes = [0, 1].map(|k| (anchors[k] - (over[k] - pair.origin)).norm());
            length.get_or_insert(ropes[0] + *ratio * ropes[1]);
        }
        JointKind::Rack { axis, radius, offset } => {
            let way = pair.rots[0].apply(axis.vector()).dot(&apart);
            offset.get_or_insert(way - *radius * angle);
        }
        JointKind::Ratchet { step, phase } => joint.notch = notch(angle, *step, *phase),
        JointKind::Wheel { .. }
        | JointKind::Grab { .. }
        | JointKind::Friction { .. }
        | JointKind::Filter
        | JointKind::Custom => {}
    }
}

/// The last notch that an angle has passed.
pub(in crate::world) fn notch(angle: Real, step: Real, phase: Real) -> Real {
    phase + floor((angle - phase) / step) * step
}

/// Springs by frequency get their coefficients from the effective mass 1/(J M⁻¹ Jᵀ) of their rows. Those of a point pull alike in
/// all directions, with the mean of J M⁻¹ Jᵀ, or the motion would depend on how the axes of the world lie.
fn tune(joint: &mut Joint, bodies: &Bodies, pair: &Pair) {
    let law: Law = law_of(bodies, joint);
    let rows = law.rows(pair);
    let point = matches!(
        joint.def.kind,
        JointKind::Weld { .. } | JointKind::Grab { .. } | JointKind::Motor { .. }
    );
    for (k, row) in rows.as_slice().iter().enumerate() {
        let (Action::Spring(_), Some(spring)) = (row.action, joint.def.kind.spring(k)) else {
            continue;
        };
        let mass = if point && k < 2 {
            let [x, y] = [0, 1].map(|k| response(&rows.rows[k], bodies, joint));
            inverse(0.5 * (x + y))
        } else {
            effective_mass(row, bodies, joint)
        };
        joint.springs[k] = Some(spring.coefficients(mass));
    }
}

/// 1/(J M⁻¹ Jᵀ) of a row (kg, kg·m²); 0 where nothing gives way.
pub(super) fn effective_mass(row: &Row, bodies: &Bodies, joint: &Joint) -> Real {
    inverse(response(row, bodies, joint))
}

fn inverse(response: Real) -> Real {
    if response > 0.0 { 1.0 / response } else { 0.0 }
}

/// J M⁻¹ Jᵀ of a row (1/kg, 1/(kg·m²)).
fn response(row: &Row, bodies: &Bodies, joint: &Joint) -> Real {
    (0..2)
        .filter_map(|side| {
            let Some(i) = index_of(bodies, joint, side) else {
                let inverse = joint.matter[side]?.inverse_mass;
                return Some(row.response(side, [inverse, inverse, 0.0]));
            };
            let mass = &bodies.masses[i];
            let inverse = [mass.inverse.x, mass.inverse.y, mass.inverse_inertia];
            Some(row.response(side, inverse))
        })
        .sum()
}
