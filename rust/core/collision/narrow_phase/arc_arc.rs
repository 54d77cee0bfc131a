//! Two circular wires.

use super::super::{Anchor, Frame, Manifold, Normal, WireArc};
use super::arc_convex::{self, End, ends, normal_and_gap};
use super::axes::Core;
use super::{Two, direction, first_of, on_arc};
use crate::math::{Real, Vec2, perp};

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
        .then(|| candidate(Normal::Between, [a.radius, b.radius]));
    let within_a = (a.radius > b.radius && a.includes(unit) && b.includes(unit))
        .then(|| candidate(Normal::Inside, [-a.radius, b.radius]));
    let within_b = (b.radius > a.radius && a.includes(-unit) && b.includes(-unit))
        .then(|| candidate(Normal::Inside, [a.radius, -b.radius]));
    let candidates = [outside, within_a, within_b].into_iter().flatten();
    let (gap, manifold) = candidates.max_by(|x, y| x.0.total_cmp(&y.0))?;
    (gap >= 0.0 || cross(a, b, (unit, distance))).then_some((gap, manifold))
}

/// Whether two wires whose circles overlap cross: at one of the two points where the circles do, t along the
/// line of centres and h off it, t = (d² + a² − b²)/2d, h² = a² − t². Otherwise they went past each other.
fn cross(a: &WireArc, b: &WireArc, (unit, distance): (Vec2, Real)) -> bool {
    let t = (distance + (a.radius - b.radius) * ((a.radius + b.radius) / distance)) / 2.0;
    let h = ((a.radius - t) * (a.radius + t)).max(0.0).sqrt();
    [h, -h].into_iter().any(|h| {
        let arm = unit * t + perp(unit) * h;
        a.includes(arm) && b.includes(arm - unit * distance)
    })
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
            anchor.feature = on_arc(end.number + 4 * side, first_of(anchor.feature));
        }
        found.add(gap, if mirror { manifold.mirrored() } else { manifold });
    }
}
