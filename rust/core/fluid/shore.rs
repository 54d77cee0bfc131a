//! What the solid near a particle adds to its sums: integrals of the kernel over the part of a body within its reach,
//! exact for polygons, without samples.
//!
//! For a radial q(r) with M(r) = ∫₀ʳ q s ds the divergence theorem gives, over the border of the body with outward
//! normal n and a = (x − y)·n the distance of the particle x before an edge,
//!
//! ∫ q dA = 2πM(∞)·[x inside] + Σ a ∫ (M(∞) − M(r))/r² dt, and ∇ₓ∫ W dA = −Σ n ∫ W dt.
//!
//! Only the part of an edge within the support counts. a∫dt/r² is an angle; what is left is smooth, for Gauss's rule.

use super::kernel::Kernel;
use crate::math::{PI, Real, Vec2, atan2, perp};

/// An edge of the border of a body, counter-clockwise around it.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its ends (m).
    pub ends: [Vec2; 2],
    /// Outward normals at its ends, of no particular length: the sum of those of the edges that meet there.
    pub corners: [Vec2; 2],
}

/// What a solid adds at a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shore {
    /// ∫ W dA over the solid: the part of the kernel that it fills.
    pub part: Real,
    /// The gradient of that (1/m).
    pub slope: Vec2,
    /// ∫ −2W′/r dA (1/m²): how it brakes what flows along it, for a viscosity of 1.
    pub friction: Real,
}

/// A point before an edge: the distance a, and the ends of the edge within reach along it.
struct Before {
    a: Real,
    along: [Real; 2],
    normal: Vec2,
}

/// Places and weights of Gauss's rule with six points on (−1, 1).
const GAUSS: [(Real, Real); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_1),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];

impl Before {
    fn new(kernel: &Kernel, edge: &Edge, x: Vec2) -> Option<Self> {
        let [from, to] = edge.ends;
        let length = (to - from).norm();
        let tangent = (to - from) / length;
        let normal = -perp(tangent);
        let a = (x - from).dot(&normal);
        let chord = kernel.support * kernel.support - a * a;
        if chord <= 0.0 {
            return None;
        }
        let chord = chord.sqrt();
        let start = (from - x).dot(&tangent);
        let along = [start.max(-chord), (start + length).min(chord)];
        (along[0] < along[1]).then_some(Self { a, along, normal })
    }

    /// What the edge adds, but for what a point inside adds.
    fn shore(&self, kernel: &Kernel) -> Shore {
        let Self { a, along: [from, to], normal } = *self;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (mut value, mut moment, mut rest) = (0.0, 0.0, 0.0);
        let center = kernel.value(0.0);
        for (place, weight) in GAUSS {
            for t in [middle - half * place, middle + half * place] {
                let square = (a * a + t * t).max(Real::MIN_POSITIVE);
                let r = square.sqrt();
                let own = kernel.value(r);
                value += weight * own;
                moment += weight * kernel.moment(r) / square;
                rest += weight * (center - own) / square;
            }
        }
        let seen = atan2(to, a.abs()) - atan2(from, a.abs());
        let angle = if a < 0.0 { -seen } else { seen };
        Shore {
            part: angle / (2.0 * PI) - a * half * moment,
            slope: normal * (-half * value),
            friction: 2.0 * (center * angle - a * half * rest),
        }
    }
}

impl Edge {
    /// Adds what the edge adds at x. Gives the square of the distance of x to the edge, below 0 from inside; none out of
    /// reach.
    pub fn add(&self, kernel: &Kernel, x: Vec2, shore: &mut Shore) -> Option<Real> {
        let before = Before::new(kernel, self, x)?;
        let own = before.shore(kernel);
        shore.part += own.part;
        shore.slope += own.slope;
        shore.friction += own.friction;
        let [from, to] = self.ends;
        let t = (x - from).dot(&(to - from)) / (to - from).norm_squared();
        let (nearest, outward) = if t <= 0.0 {
            (from, self.corners[0])
        } else if t >= 1.0 {
            (to, self.corners[1])
        } else {
            (from + (to - from) * t, before.normal)
        };
        let apart = x - nearest;
        Some(if apart.dot(&outward) < 0.0 { -apart.norm_squared() } else { apart.norm_squared() })
    }
}

impl Shore {
    /// Adds what a point inside the solid adds.
    pub fn enclose(&mut self, kernel: &Kernel) {
        self.part += 1.0;
        self.friction += 4.0 * PI * kernel.value(0.0);
    }
}

/// What a half plane adds at this distance (m) before it.
#[must_use]
pub fn half_plane(kernel: &Kernel, distance: Real) -> Shore {
    let far = 2.0 * kernel.support;
    let ends = [Vec2::new(far, -distance), Vec2::new(-far, -distance)];
    let up = Vec2::new(0.0, 1.0);
    let mut shore = Shore::default();
    Edge { ends, corners: [up, up] }.add(kernel, Vec2::zeros(), &mut shore);
    shore
}
