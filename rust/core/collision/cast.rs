//! What a ray or a shape that moves in a straight line hits.

use super::core::edges;
use super::{Convex, Geometry, Sweep, WireArc, contains, distance_to_point, first_impact};
use crate::math::{Pose, Real, Vec2, cross};

/// Where something hits a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Of the way, 0 … 1.
    pub fraction: Real,
    /// Point of the shape that is hit (m).
    pub point: Vec2,
    /// Its outward unit normal there; of wires, on the side that is hit.
    pub normal: Vec2,
}

/// First point of a shape on the straight way from `origin` to `origin + translation`, in the frame of the shape.
///
/// Shapes are solid: a ray that starts inside one hits it at fraction 0, where it starts, with a normal against
/// the ray (without a way to go, that of the nearest point of the border). Wires are hit from both sides.
#[must_use]
pub fn cast_ray(geometry: &Geometry, origin: Vec2, translation: Vec2) -> Option<Hit> {
    let length = translation.norm();
    if length == 0.0 || contains(geometry, origin) {
        let closest = distance_to_point(geometry, origin);
        let normal = if length > 0.0 { -translation / length } else { closest.normal };
        let hit = Hit { fraction: 0.0, point: origin, normal };
        return (closest.distance <= 0.0).then_some(hit);
    }
    let ray = Ray { origin, along: translation / length, length };
    match geometry {
        Geometry::Convex(core) => match *core.vertices {
            [a, b] if core.radius == 0.0 => ray.segment(a, b, core.normals.first().copied()?),
            _ if core.radius == 0.0 => ray.polygon(core),
            _ => ray.rounded(core),
        },
        Geometry::Arc(arc) => ray.arc(arc),
    }
}

/// A ray of unit direction; distances along it are in metres.
struct Ray {
    origin: Vec2,
    along: Vec2,
    length: Real,
}

impl Ray {
    fn at(&self, distance: Real) -> Vec2 {
        self.origin + self.along * distance
    }

    fn hit(&self, distance: Real, normal: Vec2) -> Option<Hit> {
        let on_way = (0.0..=self.length).contains(&distance);
        let fraction = distance / self.length;
        on_way.then_some(Hit { fraction, point: self.at(distance), normal })
    }

    /// Of a polygon, by clipping the ray with the line of each edge (Cyrus and Beck 1978).
    fn polygon(&self, core: &Convex) -> Option<Hit> {
        let (mut enter, mut leave) = ((Real::NEG_INFINITY, self.along), Real::INFINITY);
        for edge in edges(core) {
            let height = edge.normal.dot(&(self.origin - edge.ends[0]));
            let speed = edge.normal.dot(&self.along);
            if speed == 0.0 && height > 0.0 {
                return None;
            }
            let at = -height / speed;
            if speed < 0.0 && at > enter.0 {
                enter = (at, edge.normal);
            } else if speed > 0.0 {
                leave = leave.min(at);
            }
        }
        if enter.0 <= leave { self.hit(enter.0, enter.1) } else { None }
    }

    /// Of a rounded core: the nearest of its straight sides and the circles around its vertices.
    fn rounded(&self, core: &Convex) -> Option<Hit> {
        let sides = edges(core).filter_map(|edge| {
            let height = edge.normal.dot(&(self.origin - edge.ends[0])) - core.radius;
            let speed = edge.normal.dot(&self.along);
            let hit = if speed < 0.0 { self.hit(-height / speed, edge.normal) } else { None };
            hit.filter(|hit| edge.spans(hit.point))
        });
        let corners = core.vertices.iter().filter_map(|&center| {
            let [enter, _] = self.circle(center, core.radius)?;
            self.hit(enter, (self.at(enter) - center) / core.radius)
        });
        sides.chain(corners).min_by(|a, b| a.fraction.total_cmp(&b.fraction))
    }

    /// Of a wire. By signs that neighbours with a common end agree on, so that no ray slips through between.
    fn segment(&self, a: Vec2, b: Vec2, normal: Vec2) -> Option<Hit> {
        let (a, b) = (a - self.origin, b - self.origin);
        let sides = [cross(self.along, a), cross(self.along, b)];
        if sides == [0.0; 2] {
            let nearest = a.dot(&self.along).min(b.dot(&self.along));
            return self.hit(nearest, -self.along);
        }
        if sides[0] * sides[1] > 0.0 {
            return None;
        }
        let crossed = a + (b - a) * (sides[0] / (sides[0] - sides[1]));
        let facing = if normal.dot(&self.along) <= 0.0 { normal } else { -normal };
        self.hit(crossed.dot(&self.along), facing)
    }

    fn arc(&self, arc: &WireArc) -> Option<Hit> {
        let distances = self.circle(arc.center, arc.radius)?;
        distances.into_iter().find_map(|distance| {
            let arm = self.at(distance) - arc.center;
            let outward = arm / arc.radius;
            let facing = if outward.dot(&self.along) <= 0.0 { outward } else { -outward };
            if arc.includes(arm) { self.hit(distance, facing) } else { None }
        })
    }

    /// Distances at which the line enters and leaves a circle.
    fn circle(&self, center: Vec2, radius: Real) -> Option<[Real; 2]> {
        let arm = center - self.origin;
        let (ahead, aside) = (arm.dot(&self.along), cross(self.along, arm));
        let square = (radius - aside) * (radius + aside);
        if square < 0.0 {
            return None;
        }
        // The product of both is |arm|² − radius²; that of the larger has no cancellation.
        let larger = ahead + square.sqrt().copysign(ahead);
        let away = arm.norm();
        let product = (away - radius) * (away + radius);
        let smaller = if larger == 0.0 { 0.0 } else { product / larger };
        Some([larger.min(smaller), larger.max(smaller)])
    }
}

/// Where A, moved along `translation` from `pose_a` without turning, first touches B at `pose_b`: the fraction,
/// the point of B in world coordinates, and the outward normal of B. If they overlap at once, fraction 0 with the
/// normal along which they are soonest apart.
#[must_use]
pub fn cast_shape(
    (a, pose_a): (&Geometry, &Pose),
    translation: Vec2,
    (b, pose_b): (&Geometry, &Pose),
) -> Option<Hit> {
    let to = Pose::new(pose_a.position + translation, pose_a.angle);
    let [moving, resting] = [Sweep { from: *pose_a, to }, Sweep { from: *pose_b, to: *pose_b }];
    let impact = first_impact((b, &resting), (a, &moving), 0.0)?;
    let point = pose_b.position + impact.on_a;
    Some(Hit { fraction: impact.fraction, point, normal: impact.normal })
}
