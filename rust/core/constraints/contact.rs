//! Contact: at most two points with one normal, and one tangent for both.
//!
//! Rows of a manifold: the normal velocity of each point, u_k = n·(v_b − v_a) + ω_b r_b×n − ω_a r_a×n ≥ target
//! with an impulse λ_k ≥ 0 (Signorini), and the tangential velocity in the middle with |λ_t| ≤ μ(λ_0 + λ_1)
//! (Coulomb). Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988.

use serde::{Deserialize, Serialize};

use super::motion::{Place, Velocity, lever};
use crate::body::Friction;
use crate::collision::{Manifold, Normal};
use crate::math::{Real, Twist, Vec2, cross, perp, vec2};

/// What stays of a manifold from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Impulses of the last substep: of the normals and of the tangent (N·s).
    pub impulse: [Real; 3],
    /// Impulse against rolling (N·m·s).
    pub rolling: Real,
    /// Whether it slid.
    pub sliding: bool,
    /// Work that may be spent on solving all rows at once, in products of blocks.
    pub credit: Real,
}

impl Memory {
    /// Of a contact that is new.
    pub const NEW: Self = Self { impulse: [0.0; 3], rolling: 0.0, sliding: false, credit: 3000.0 };

    /// For a substep this many times as long: the same forces. Times too small for that leave nothing to remember.
    #[must_use]
    pub fn scaled(self, by: Real) -> Self {
        if !by.is_finite() {
            return Self { sliding: self.sliding, credit: self.credit, ..Self::NEW };
        }
        Self { impulse: self.impulse.map(|p| p * by), rolling: self.rolling * by, ..self }
    }
}

/// What two surfaces make of their values together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Touch {
    /// Coulomb's coefficients.
    pub friction: Friction,
    /// Restitution.
    pub restitution: Real,
    /// Arm (m) by which the normal force opposes rolling.
    pub rolling_resistance: Real,
    /// Tangential velocity (m/s) of B against A at which nothing slides: not 0 on a conveyor.
    pub tangent_speed: Real,
}

/// The rows of one manifold: two normals and a tangent.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Slots of the two bodies.
    pub bodies: [u32; 2],
    /// From A to B.
    pub normal: Vec2,
    /// r × d of each row, d its direction, for A and for B.
    pub arms: [[Real; 2]; 3],
    /// Gaps (m), below 0 where the surfaces overlap.
    pub gap: [Real; 2],
    /// Velocities that the rows ask for (m/s).
    pub target: [Real; 3],
    /// J M⁻¹ Jᵀ: 00, 11, 01, 0t, 1t, tt.
    pub response: [Real; 6],
    /// Its inverse over the rows that are on: 00, 11, 01, 0t, 1t, tt. Zero where it has none.
    pub inverse: [Real; 6],
    /// Impulses (N·s).
    pub impulse: [Real; 3],
    /// Impulse against rolling (N·m·s).
    pub rolling: Real,
    /// Coulomb's coefficients.
    pub friction: Friction,
    /// Arm (m) by which the normal force opposes rolling.
    pub rolling_resistance: Real,
    /// Points that take part.
    pub on: [bool; 2],
    /// Number of points.
    pub count: u8,
    /// Whether it slides.
    pub sliding: bool,
}

/// A manifold as it moves with its bodies.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// From A to B.
    pub normal: Vec2,
    /// From the centres of A and B to the points, up to a multiple of the normal (m).
    pub arms: [[Vec2; 2]; 2],
    /// Gaps (m).
    pub gap: [Real; 2],
}

impl Moved {
    /// Point k half-way between the surfaces, from A's centre of mass (m).
    #[must_use]
    pub fn surface_point(&self, manifold: &Manifold, k: usize) -> Vec2 {
        let half = 0.5 * self.gap[k];
        match manifold.normal {
            Normal::OnA(_) => self.arms[k][0] - self.normal * (manifold.radius_b + half),
            _ => self.arms[k][0] + self.normal * (manifold.radius_a + half),
        }
    }
}

/// Where a manifold is when its bodies have moved; `apart` leads from A's centre of mass to B's at the start.
#[must_use]
pub fn moved(manifold: &Manifold, apart: Vec2, [a, b]: [&Place; 2]) -> Moved {
    let mut moved = Moved { normal: vec2(0.0, 1.0), arms: [[vec2(0.0, 0.0); 2]; 2], gap: [0.0; 2] };
    match manifold.normal {
        Normal::OnA(local) => moved.normal = a.rot.apply(local),
        Normal::OnB(local) => moved.normal = b.rot.apply(local),
        Normal::Between | Normal::Inside => {}
    }
    let radii = manifold.radius_a + manifold.radius_b;
    let apart = apart + (b.way - a.way);
    for k in 0..manifold.count {
        let anchor = &manifold.anchors[k];
        let (on_a, on_b) = (a.rot.apply(anchor.on_a), b.rot.apply(anchor.on_b));
        let between = apart + on_b - on_a;
        match manifold.normal {
            // The point of the body that has no face carries the contact along the face.
            Normal::OnA(_) => moved.arms[k] = [apart + on_b, on_b],
            Normal::OnB(_) => moved.arms[k] = [on_a, on_a - apart],
            Normal::Between | Normal::Inside => {
                moved.arms[k] = [on_a, on_b];
                let sign = if manifold.normal == Normal::Inside { -1.0 } else { 1.0 };
                let length = between.norm();
                if length > 0.0 {
                    moved.normal = between * (sign / length);
                }
            }
        }
        moved.gap[k] = moved.normal.dot(&between) - radii;
    }
    moved
}

/// Rates at which the normal and the tangential velocity of point k change while both bodies keep their twists:
/// J̇v (m/s²). Where contacts run along a curve, or pivot, the midpoint rule J(v⁻ + v⁺) = 0 needs them.
#[must_use]
pub fn curvature(
    manifold: &Manifold,
    moved: &Moved,
    (apart, k): (Vec2, usize),
    [a, b]: [&Place; 2],
    [va, vb]: [&Twist; 2],
) -> [Real; 2] {
    if va.angular == 0.0
        && vb.angular == 0.0
        && matches!(manifold.normal, Normal::OnA(_) | Normal::OnB(_))
    {
        return [0.0; 2];
    }
    let (n, t) = (moved.normal, perp(moved.normal));
    let apart = apart + (b.way - a.way);
    let anchor = &manifold.anchors[k];
    let (on_a, on_b) = (a.rot.apply(anchor.on_a), b.rot.apply(anchor.on_b));
    let between = apart + on_b - on_a;
    let rate = vb.at(on_b) - va.at(on_a);
    let (wa, wb) = (va.angular, vb.angular);
    let spin = on_a * (wa * wa) - on_b * (wb * wb);
    match manifold.normal {
        // Seen from the turning frame of the face: ẍ − 2ω × ẋ − ω²x of the point against the face's body.
        Normal::OnA(_) => {
            let arm = apart + on_b;
            let rate = vb.at(on_b) - va.linear;
            let along = -on_b * (wb * wb) - perp(rate) * (2.0 * wa) - arm * (wa * wa);
            [n.dot(&along), t.dot(&along)]
        }
        Normal::OnB(_) => {
            let arm = on_a - apart;
            let rate = va.at(on_a) - vb.linear;
            let along = -on_a * (wa * wa) - perp(rate) * (2.0 * wb) - arm * (wb * wb);
            [-n.dot(&along), -t.dot(&along)]
        }
        Normal::Between | Normal::Inside => {
            let along = rate.dot(&t);
            let length = between.dot(&n);
            let turning = if length == 0.0 { 0.0 } else { along / length };
            [n.dot(&spin) + along * turning, t.dot(&spin) - rate.dot(&n) * turning]
        }
    }
}

impl Block {
    /// Of a manifold between two slots.
    #[must_use]
    pub fn new(bodies: [u32; 2], manifold: &Manifold, touch: &Touch, memory: &Memory) -> Self {
        Self {
            bodies,
            normal: vec2(0.0, 1.0),
            arms: [[0.0; 2]; 3],
            gap: [0.0; 2],
            target: [0.0, 0.0, touch.tangent_speed],
            response: [0.0; 6],
            inverse: [0.0; 6],
            impulse: memory.impulse,
            rolling: memory.rolling,
            friction: touch.friction,
            rolling_resistance: touch.rolling_resistance,
            on: [true, manifold.count == 2],
            count: manifold.count as u8,
            sliding: memory.sliding,
        }
    }

    /// What is kept for the next step, with the credit of the contact.
    #[must_use]
    pub fn memory(&self, credit: Real) -> Memory {
        Memory { impulse: self.impulse, rolling: self.rolling, sliding: self.sliding, credit }
    }

    /// Unit vector along the surface: the normal turned by a quarter turn counter-clockwise.
    #[must_use]
    pub fn tangent(&self) -> Vec2 {
        perp(self.normal)
    }

    /// Takes the normal, the lever arms and the gaps of the moved manifold.
    ///
    /// The points of the two surfaces differ by the gap. Between two bodies that both give way the rows act
    /// in the middle, so that angular momentum is kept whatever the gap; against one that does not, at the other's own
    /// surface, so that a ball rolls with its own radius.
    pub fn place(&mut self, manifold: &Manifold, moved: &Moved, [a, b]: [&Velocity; 2]) {
        let n = moved.normal;
        (self.normal, self.gap) = (n, moved.gap);
        let mut height = [0.0; 2];
        for k in 0..manifold.count {
            let [on_a, on_b] = moved.arms[k];
            self.arms[k] = [lever(on_a, n), lever(on_b, n)];
            // r × t = r·n: heights of the surface points over the centres along the normal.
            let (a_height, b_height) = match manifold.normal {
                Normal::OnA(_) => {
                    let at = n.dot(&on_b) - manifold.radius_b;
                    (n.dot(&on_a) - manifold.radius_b - moved.gap[k], at)
                }
                Normal::OnB(_) => {
                    let at = n.dot(&on_a) + manifold.radius_a;
                    (at, n.dot(&on_b) + manifold.radius_a + moved.gap[k])
                }
                _ => (n.dot(&on_a) + manifold.radius_a, n.dot(&on_b) - manifold.radius_b),
            };
            let (share_a, share_b) = match (a.is_fixed(), b.is_fixed()) {
                (true, false) => (1.0, 0.0),
                (false, true) => (0.0, 1.0),
                _ => (0.5, 0.5),
            };
            height[0] += a_height + share_a * moved.gap[k];
            height[1] += b_height - share_b * moved.gap[k];
        }
        let mean = 1.0 / manifold.count as Real;
        self.arms[2] = [height[0] * mean, height[1] * mean];
    }

    /// Computes the response J M⁻¹ Jᵀ and its inverse over the rows that are on.
    pub fn prepare(&mut self, [a, b]: [&Velocity; 2]) {
        let (n, t) = (self.normal, self.tangent());
        let directions = [n, n, t];
        let entry = |i: usize, j: usize| {
            let row = |k: usize, side: usize| (directions[k], self.arms[k][side]);
            a.coupling(row(i, 0), row(j, 0)) + b.coupling(row(i, 1), row(j, 1))
        };
        self.respond([
            entry(0, 0),
            entry(1, 1),
            entry(0, 1),
            entry(0, 2),
            entry(1, 2),
            entry(2, 2),
        ]);
    }

    /// Takes a response J M⁻¹ Jᵀ (00, 11, 01, 0t, 1t, tt) and its inverse over the rows that are on.
    pub fn respond(&mut self, response: [Real; 6]) {
        self.response = response;
        let r = &self.response;
        self.inverse = match self.on {
            [true, true] => inverse_of_three(r),
            [true, false] => inverse_of_two(r[0], r[3], r[5])
                .map_or([0.0; 6], |[i, c, t]| [i, 0.0, 0.0, c, 0.0, t]),
            [false, true] => inverse_of_two(r[1], r[4], r[5])
                .map_or([0.0; 6], |[i, c, t]| [0.0, i, 0.0, 0.0, c, t]),
            [false, false] => [0.0; 6],
        };
    }

    /// Jv of the three rows.
    #[must_use]
    pub fn velocity(&self, [a, b]: [&Velocity; 2]) -> [Real; 3] {
        let apart = b.twist.linear - a.twist.linear;
        let along_n = self.normal.dot(&apart);
        let along_t = self.tangent().dot(&apart);
        let spin = |k: usize| self.arms[k][1] * b.twist.angular - self.arms[k][0] * a.twist.angular;
        [along_n + spin(0), along_n + spin(1), along_t + spin(2)]
    }

    /// Angular momentum that the impulses give the two bodies together, B's centre of mass `apart` from A's: 0 to rounding
    /// where the lever arms are those of bodies that are so far apart.
    #[must_use]
    pub fn couple(&self, apart: Vec2) -> Real {
        let sum =
            self.normal * (self.impulse[0] + self.impulse[1]) + self.tangent() * self.impulse[2];
        let torque = |k: usize| (self.arms[k][1] - self.arms[k][0]) * self.impulse[k];
        cross(apart, sum) + torque(0) + torque(1) + torque(2)
    }

    /// Gives the bodies these impulses.
    pub fn push(&self, [a, b]: [&mut Velocity; 2], impulse: [Real; 3]) {
        let (n, t) = (self.normal, self.tangent());
        let sum = n * (impulse[0] + impulse[1]) + t * impulse[2];
        let torque = |side: usize| {
            self.arms[0][side] * impulse[0]
                + self.arms[1][side] * impulse[1]
                + self.arms[2][side] * impulse[2]
        };
        a.twist.linear -= a.inverse_mass.component_mul(&sum);
        a.twist.angular -= a.inverse_inertia * torque(0);
        b.twist.linear += b.inverse_mass.component_mul(&sum);
        b.twist.angular += b.inverse_inertia * torque(1);
    }
}

/// Inverse of a symmetric matrix [[p, c], [c, q]] as [pp, c, qq]; none if it is singular to rounding.
fn inverse_of_two(p: Real, c: Real, q: Real) -> Option<[Real; 3]> {
    let det = p * q - c * c;
    (det > SINGULAR * p * q).then(|| [q / det, -c / det, p / det])
}

/// A determinant below this part of the diagonal's product says that rows depend on one another.
pub const SINGULAR: Real = 1e-10;

fn inverse_of_three(r: &[Real; 6]) -> [Real; 6] {
    let [a, b, c, d, e, f] = *r; // 00, 11, 01, 0t, 1t, tt
    let minors =
        [b * f - e * e, a * f - d * d, d * e - c * f, c * e - b * d, c * d - a * e, a * b - c * c];
    let det = a * minors[0] + c * minors[2] + d * minors[3];
    if det > SINGULAR * a * b * f { minors.map(|m| m / det) } else { [0.0; 6] }
}
