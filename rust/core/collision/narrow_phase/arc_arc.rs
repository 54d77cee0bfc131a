//! Two circular wires.

use super::super::{Anchor, Frame, Manifold, Normal, WireArc};
use super::arc_convex::{self, End, ends, normal_and_gap};
use super::axes::Core;
use super::{Two, direction, on_arc};
use crate::math::{Real, Vec2};

/// Manifolds of two wires: where their circles touch from outside or inside, and of their ends.
pub(super) fn collide(a: &WireArc, b: &WireArc, b_in_a: &Frame, margin: Real) -> Two {
    let mut found = Two::default();
    let b_seen = seen(b, b_in_a);
    if let Some((gap, manifold)) = along_centers(a, (b, &b_seen))
        && gap <= margin
    {
        found.add(gap, manifold);
    }
    for end in ends(b) {
        of_end(&mut found, (a, b_in_a), &end, margin, false);
    }
    for end in ends(a) {
        of_end(&mut found, (b, &b_in_a.inverse()), &end, margin, true);
    }
    found
}

/// A wire as it is seen from the outer frame.
fn seen(arc: &WireArc, frame: &Frame) -> WireArc {
    let turned = |v: Vec2| frame.rot.apply(v);
    let (from, to) = (turned(arc.from), turned(arc.to));
    WireArc { center: frame.apply(arc.center), from, to, ..*arc }
}

/// Contact on the line through both centres, of those that are on both wires the one that is least deep.
fn along_centers(a: &WireArc, (own, b): (&WireArc, &WireArc)) -> Option<(Real, Manifold)> {
    let (unit, distance) = direction(b.center - a.center, a.radius + b.radius)?;
    let anchor = Anchor { on_a: a.center, on_b: own.center, feature: on_arc(0, 0) };
    let candidate = |normal: Normal, [ra, rb]: [Real; 2]| {
        let along = if normal == Normal::Between { distance } else { -distance };
        (along - ra - rb, Manifold::point(normal, anchor, [ra, rb]))
    };
    let outside = (a.includes(unit) && b.includes(-unit))
        .then(|| candidate(Normal::Between, [a.radius, b.radius]))
        .filter(|_| !holds(a, chord(b)) || !holds(b, chord(a)));
    let within_a = (a.radius > b.radius && a.includes(unit) && b.includes(unit))
        .then(|| candidate(Normal::Inside, [-a.radius, b.radius]))
        .filter(|_| holds(a, chord(b)));
    let within_b = (b.radius > a.radius && a.includes(-unit) && b.includes(-unit))
        .then(|| candidate(Normal::Inside, [a.radius, -b.radius]))
        .filter(|_| holds(b, chord(a)));
    let candidates = [outside, within_a, within_b].into_iter().flatten();
    candidates.max_by(|x, y| x.0.total_cmp(&y.0))
}

/// The middle of the chord of a wire; of more than half a circle the centre.
fn chord(arc: &WireArc) -> Vec2 {
    if arc.sweep >= std::f64::consts::PI {
        return arc.center;
    }
    arc.center + (arc.from + arc.to) * (arc.radius / 2.0)
}

/// Whether a point lies in the circle of a wire.
fn holds(arc: &WireArc, point: Vec2) -> bool {
    (point - arc.center).norm_squared() < arc.radius * arc.radius
}

/// An end of one wire against the other: a point without radius, if it is met in front of the end.
fn of_end(
    found: &mut Two,
    (arc, frame): (&WireArc, &Frame),
    end: &End,
    margin: Real,
    mirror: bool,
) {
    let point = Core::disk(&end.place, 0.0);
    let mut touching = Two::default();
    arc_convex::on_wire(&mut touching, (arc, point, frame), margin);
    if !mirror {
        // End to end: once is enough.
        for other in ends(arc) {
            arc_convex::at_end(&mut touching, (&other, point, frame), margin);
        }
    }
    for (gap, mut manifold) in touching.found.into_iter().flatten() {
        let Some((normal, _)) = normal_and_gap(&manifold, frame) else { continue };
        if frame.rot.apply(end.onward).dot(&normal) > super::SAME {
            continue; // the normal leads to the end from behind: the wire itself is met, not its end
        }
        let side = if mirror { 2 } else { 1 };
        for anchor in &mut manifold.anchors {
            let feature = anchor.feature as usize % 64;
            anchor.feature = on_arc(end.number + 4 * side, feature);
        }
        found.add(gap, if mirror { manifold.mirrored() } else { manifold });
    }
}
