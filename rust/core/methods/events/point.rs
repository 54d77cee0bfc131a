//! A point where two bodies touch, as a smooth function of their places: its gap, its rows, and how those change.
//!
//! With w = v_b + ω_b × r_b − v_a − ω_a × r_a the velocity of B's surface over A's at the point, n the normal and
//! t = n turned by a quarter turn, the rows are n·w and t·w. Normals turn at the rate Ω: with the body that holds the
//! face, or with the line between two round centres. The rows' rates while both bodies keep their twists are
//! n·ẇ + Ω t·w and t·ẇ − Ω n·w, with ẇ = ω_b × ṙ_b − ω_a × ṙ_a (J̇v).

use crate::collision::{Collider, Frame, Geometry, Manifold, Normal};
use crate::math::{Real, Twist, Vec2, cross, perp};

/// Two features that touch or may: a vertex or a round centre, over a face or another centre.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    normal: Normal,
    /// In the frames of the two centres of mass (m).
    on: [Vec2; 2],
    radii: [Real; 2],
    /// Stretch of the face along the tangent in the frame of its body (m).
    face: [Real; 2],
    /// The same features give the same number.
    pub feature: u32,
}

/// A point where the bodies stand.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// From A to B.
    pub normal: Vec2,
    /// From the two centres of mass to the surfaces (m).
    pub arms: [Vec2; 2],
    /// Gap (m), below 0 where surfaces overlap.
    pub gap: Real,
    /// The anchors, turned (m).
    on: [Vec2; 2],
    /// From A's centre of mass to B's (m).
    apart: Vec2,
    /// Length of the line between two centres along the normal (m).
    length: Real,
}

impl Point {
    /// Point k of a manifold. One that stands where the end of a face meets the other's edge belongs to that edge: there it
    /// stays when the bodies slide.
    pub fn of(manifold: &Manifold, k: usize, bodies: [(&Collider, &Frame); 2]) -> Self {
        let anchor = &manifold.anchors[k];
        let own = Self {
            normal: manifold.normal,
            on: [anchor.on_a, anchor.on_b],
            radii: [manifold.radius_a, manifold.radius_b],
            face: manifold.face,
            feature: anchor.feature,
        };
        let edge = |side: usize, outward: Vec2| edge_of(bodies[side].0, outward);
        match (manifold.normal, anchor.feature >> 30) {
            // Features name who brings the vertex: 0 is A, 1 is B.
            (Normal::OnA(n), 0) => {
                let outward = -bodies[1].1.rot.apply_inverse(bodies[0].1.rot.apply(n));
                edge(1, outward).map_or(own, |(normal, begin, end)| {
                    let along = -perp(normal);
                    let face = [along.dot(&end), along.dot(&begin)];
                    Self { normal: Normal::OnB(-normal), on: [own.on[0], begin], face, ..own }
                })
            }
            (Normal::OnB(n), 1) => {
                let outward = bodies[0].1.rot.apply_inverse(bodies[1].1.rot.apply(n));
                edge(0, outward).map_or(own, |(normal, begin, end)| {
                    let along = perp(normal);
                    let face = [along.dot(&begin), along.dot(&end)];
                    Self { normal: Normal::OnA(normal), on: [begin, own.on[1]], face, ..own }
                })
            }
            _ => own,
        }
    }

    /// Where it is.
    pub fn seen(&self, [a, b]: [&Frame; 2]) -> Seen {
        let on = [a.rot.apply(self.on[0]), b.rot.apply(self.on[1])];
        let apart = b.position - a.position;
        let between = apart + on[1] - on[0];
        let [radius_a, radius_b] = self.radii;
        let length = between.norm();
        let along_line = |sign: Real| {
            if length > 0.0 { between * (sign / length) } else { Vec2::new(0.0, 1.0) }
        };
        let (normal, length) = match self.normal {
            Normal::OnA(n) => (a.rot.apply(n), 0.0),
            Normal::OnB(n) => (b.rot.apply(n), 0.0),
            Normal::Between => (along_line(1.0), length),
            Normal::Inside => (along_line(-1.0), -length),
        };
        let arms = match self.normal {
            Normal::OnA(_) => {
                let arm = on[1] - normal * radius_b;
                [apart + arm, arm]
            }
            Normal::OnB(_) => {
                let arm = on[0] + normal * radius_a;
                [arm, arm - apart]
            }
            Normal::Between | Normal::Inside => {
                [on[0] + normal * radius_a, on[1] - normal * radius_b]
            }
        };
        let gap = normal.dot(&between) - radius_a - radius_b;
        Seen { normal, arms, gap, on, apart, length }
    }

    /// How far the point stands inside the ends of its face (m); below 0 beside it.
    pub fn within_face(&self, seen: &Seen) -> Real {
        let along = perp(seen.normal);
        let place = match self.normal {
            Normal::OnA(_) => along.dot(&(seen.apart + seen.on[1])),
            Normal::OnB(_) => along.dot(&(seen.on[0] - seen.apart)),
            Normal::Between | Normal::Inside => return Real::INFINITY,
        };
        (place - self.face[0]).min(self.face[1] - place)
    }

    /// J̇v of the normal and the tangential row (m/s²).
    pub fn bias(&self, seen: &Seen, [a, b]: [&Twist; 2]) -> [Real; 2] {
        let (n, t) = (seen.normal, perp(seen.normal));
        let [on_a, on_b] = seen.on;
        let [radius_a, radius_b] = self.radii;
        let (wa, wb) = (a.angular, b.angular);
        let apart_rate = b.linear - a.linear;
        let (turning, rates) = match self.normal {
            Normal::OnA(_) => {
                let rate = perp(on_b) * wb - t * (radius_b * wa);
                (wa, [apart_rate + rate, rate])
            }
            Normal::OnB(_) => {
                let rate = perp(on_a) * wa + t * (radius_a * wb);
                (wb, [rate, rate - apart_rate])
            }
            Normal::Between | Normal::Inside => {
                let along = t.dot(&(b.at(on_b) - a.at(on_a)));
                let turning = if seen.length == 0.0 { 0.0 } else { along / seen.length };
                let rate_a = perp(on_a) * wa + t * (radius_a * turning);
                (turning, [rate_a, perp(on_b) * wb - t * (radius_b * turning)])
            }
        };
        let change = perp(rates[1]) * wb - perp(rates[0]) * wa;
        let w = seen.velocity([a, b]);
        [n.dot(&change) + turning * t.dot(&w), t.dot(&change) - turning * n.dot(&w)]
    }
}

impl Seen {
    /// w (m/s).
    pub fn velocity(&self, [a, b]: [&Twist; 2]) -> Vec2 {
        b.at(self.arms[1]) - a.at(self.arms[0])
    }

    /// Along the surface: the normal turned by a quarter turn counter-clockwise.
    pub fn tangent(&self) -> Vec2 {
        perp(self.normal)
    }

    /// J of the velocity along a direction.
    pub fn jacobian(&self, d: Vec2) -> [[Real; 3]; 2] {
        [[-d.x, -d.y, -cross(self.arms[0], d)], [d.x, d.y, cross(self.arms[1], d)]]
    }
}

/// The edge of a collider whose outward normal is nearest to a direction: its normal, begin and end.
fn edge_of(collider: &Collider, outward: Vec2) -> Option<(Vec2, Vec2, Vec2)> {
    let Geometry::Convex(convex) = &collider.geometry else { return None };
    let best = (0..convex.normals.len()).max_by(|i, j| {
        let along = |k: &usize| convex.normals[*k].dot(&outward);
        along(i).total_cmp(&along(j))
    })?;
    let next = (best + 1) % convex.vertices.len();
    Some((convex.normals[best], convex.vertices[best], convex.vertices[next]))
}
