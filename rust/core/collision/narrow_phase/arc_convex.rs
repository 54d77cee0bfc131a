//! A circular wire and a convex shape. The wire is A here.

use super::super::{Anchor, Frame, Manifold, Normal, WireArc};
use super::axes::Core;
use super::{SAME, Two, convex_convex, direction, on_arc};
use crate::math::{Real, Vec2, perp, vec2};

/// Manifolds of a wire and a convex shape: of up to two corners that stand inside the wire's circle, or of
/// the point nearest to its centre outside, and of the wire's ends.
pub(super) fn collide(arc: &WireArc, convex: Core<'_>, frame: &Frame, margin: Real) -> Two {
    let mut found = Two::default();
    on_wire(&mut found, (arc, convex, frame), margin);
    for end in ends(arc) {
        at_end(&mut found, (&end, convex, frame), margin);
    }
    found
}

/// The same of the wire without its ends.
pub(super) fn on_wire(found: &mut Two, (arc, convex, frame): Seen<'_>, margin: Real) {
    match inner_point(arc, convex, frame) {
        Some(inner) => inside(found, (arc, convex, frame), inner, margin),
        None => outside(found, (arc, convex, frame), margin),
    }
}

/// A wire, a core, and the frame of the core seen from the wire's.
type Seen<'a> = (&'a WireArc, Core<'a>, &'a Frame);

/// A point of the core inside the wire's circle, if the shape stands there or came in through the opening;
/// none if it stands outside, even where it reaches in through the wire.
fn inner_point(arc: &WireArc, convex: Core<'_>, frame: &Frame) -> Option<Vec2> {
    let middle = frame.apply(convex.middle());
    if (middle - arc.center).norm_squared() <= arc.radius * arc.radius {
        return Some(middle);
    }
    let nearest = nearest_point(convex, frame, arc.center);
    let reaches_in = (nearest - arc.center).norm_squared() <= arc.radius * arc.radius;
    (reaches_in && !crosses(arc, nearest, middle)).then_some(nearest)
}

/// Whether the way from a point inside the circle to one outside leads through the wire.
fn crosses(arc: &WireArc, inner: Vec2, outer: Vec2) -> bool {
    let (start, way) = (inner - arc.center, outer - inner);
    // |start + t way| = R: t²·w² + 2t·s·w + s² − R² = 0, the larger root, without cancellation.
    let (squared, half) = (way.norm_squared(), start.dot(&way));
    let rest = (arc.radius * arc.radius - start.norm_squared()).max(0.0);
    let root = (half * half + squared * rest).sqrt();
    let t = if half > 0.0 { rest / (half + root) } else { (root - half) / squared };
    arc.includes(start + way * t)
}

/// The point of the core nearest to a point (in the outer frame of `frame`); that point itself if it lies in
/// the core.
fn nearest_point(convex: Core<'_>, frame: &Frame, point: Vec2) -> Vec2 {
    let local = frame.apply_inverse(point);
    let n = convex.vertices.len();
    let mut nearest = (convex.vertices[0], (convex.vertices[0] - local).norm_squared());
    let mut within = n > 2;
    for (i, &normal) in convex.normals.iter().enumerate() {
        let (a, b) = (convex.vertices[i], convex.vertices[convex.after(i)]);
        within &= normal.dot(&(local - a)) <= 0.0;
        let edge = b - a;
        let foot = a + edge * ((local - a).dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0);
        let squared = (foot - local).norm_squared();
        if squared < nearest.1 {
            nearest = (foot, squared);
        }
    }
    if within { point } else { frame.apply(nearest.0) }
}

/// Corners of the core against the inner side of the wire, the two that stand farthest out.
fn inside(found: &mut Two, (arc, convex, frame): Seen<'_>, inner: Vec2, margin: Real) {
    for (i, &on_b) in convex.vertices.iter().enumerate() {
        let place = frame.apply(on_b);
        let arm = place - arc.center;
        let distance = arm.norm();
        let gap = arc.radius - distance - convex.radius;
        let met =
            if distance <= arc.radius { arc.includes(arm) } else { crosses(arc, inner, place) };
        if gap > margin || !met {
            continue;
        }
        let radii = [-arc.radius, convex.radius];
        let anchor = Anchor { on_a: arc.center, on_b, feature: on_arc(0, i) };
        let normal = if distance > SAME * arc.radius {
            Normal::Inside
        } else {
            Normal::OnA(-middle_of(arc))
        };
        found.add(gap, Manifold::point(normal, anchor, radii));
    }
}

/// Direction of the middle of the wire.
fn middle_of(arc: &WireArc) -> Vec2 {
    let middle = arc.from + arc.to;
    let half = if arc.sweep > std::f64::consts::PI { -middle } else { middle };
    direction(half, 1.0).map_or(perp(arc.from), |(unit, _)| unit)
}

/// The core against the outer side of the wire: as against its circle, if that is met on the wire.
fn outside(found: &mut Two, (arc, convex, frame): Seen<'_>, margin: Real) {
    let disk = Core::disk(&arc.center, arc.radius);
    let Ok(manifold) = convex_convex::collide(disk, convex, frame, margin) else { return };
    if let Some((normal, gap)) = normal_and_gap(&manifold, frame)
        && arc.includes(normal)
    {
        found.add(gap, manifold);
    }
}

/// An end of a wire: a point, and the direction in which the wire would go on.
pub(super) struct End {
    pub number: usize,
    pub place: Vec2,
    pub onward: Vec2,
}

/// The two ends of a wire; none if it goes all the way round.
pub(super) fn ends(arc: &WireArc) -> impl Iterator<Item = End> {
    let end = |number: usize, unit: Vec2, onward: Vec2| End {
        number,
        place: arc.center + unit * arc.radius,
        onward,
    };
    let both = [end(1, arc.from, -perp(arc.from)), end(2, arc.to, perp(arc.to))];
    both.into_iter().filter(|_| !arc.is_closed())
}

/// An end of the wire against the core, if it is met in front of the end.
pub(super) fn at_end(
    found: &mut Two,
    (end, convex, frame): (&End, Core<'_>, &Frame),
    margin: Real,
) {
    let point = Core::disk(&end.place, 0.0);
    let Ok(mut manifold) = convex_convex::collide(point, convex, frame, margin) else { return };
    for anchor in &mut manifold.anchors {
        anchor.feature = on_arc(end.number, anchor.feature as usize);
    }
    if let Some((normal, gap)) = normal_and_gap(&manifold, frame)
        && end.onward.dot(&normal) >= -SAME
    {
        found.add(gap, manifold);
    }
}

/// Normal in the frame of A, and gap of the first point; none where the anchors coincide.
pub(super) fn normal_and_gap(manifold: &Manifold, frame: &Frame) -> Option<(Vec2, Real)> {
    let anchor = manifold.anchors[0];
    let arm = frame.apply(anchor.on_b) - anchor.on_a;
    let normal = match manifold.normal {
        Normal::OnA(n) => n,
        Normal::OnB(n) => frame.rot.apply(n),
        Normal::Between => arm.try_normalize(0.0)?,
        Normal::Inside => -arm.try_normalize(0.0).unwrap_or(vec2(0.0, 1.0)),
    };
    Some((normal, normal.dot(&arm) - manifold.radius_a - manifold.radius_b))
}
