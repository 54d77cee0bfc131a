//! Blocks of three by three, and the factors of a pivot block.

use crate::math::Real;

/// Three numbers: the velocity of a body as (x, y, θ), or the rows of a constraint.
pub type Triple = [Real; 3];

/// Three rows of three.
pub type Block = [Triple; 3];

pub(super) const ZERO: Block = [[0.0; 3]; 3];

/// A·x.
pub(super) fn times(a: &Block, x: Triple) -> Triple {
    a.map(|[p, q, r]| p * x[0] + q * x[1] + r * x[2])
}

/// Aᵀ·x.
pub(super) fn transposed_times(a: &Block, x: Triple) -> Triple {
    [0, 1, 2].map(|k| a[0][k] * x[0] + a[1][k] * x[1] + a[2][k] * x[2])
}

pub(super) fn transposed(a: &Block) -> Block {
    [0, 1, 2].map(|k| [a[0][k], a[1][k], a[2][k]])
}

pub(super) fn add(target: &mut Triple, x: Triple) {
    for (to, x) in target.iter_mut().zip(x) {
        *to += x;
    }
}

pub(super) fn subtract(target: &mut Triple, x: Triple) {
    for (to, x) in target.iter_mut().zip(x) {
        *to -= x;
    }
}

/// target − A·Bᵀ.
pub(super) fn subtract_product(target: &mut Block, a: &Block, b: &Block) {
    for (row, a) in target.iter_mut().zip(a) {
        subtract(row, times(b, *a));
    }
}

/// target − A·Bᵀ where that is symmetric: the lower half of it.
pub(super) fn subtract_symmetric(target: &mut Block, a: &Block, b: &Block) {
    for (r, row) in target.iter_mut().enumerate() {
        for (c, to) in row.iter_mut().enumerate().take(r + 1) {
            *to -= a[r][0] * b[c][0] + a[r][1] * b[c][1] + a[r][2] * b[c][2];
        }
    }
}

/// A pivot block as G D Gᵀ: G lower triangular with a unit diagonal, D diagonal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pivot {
    /// G₁₀, G₂₀, G₂₁.
    lower: Triple,
    /// D.
    pivots: Triple,
    /// 1/D; 0 for a row that is dropped.
    inverse: Triple,
}

impl Pivot {
    /// Factors of the lower half of a block whose pivots should have this sign. One that has not, or is not a
    /// number, has been eaten by rounding; its row is dropped, that is, its unknown is zero.
    pub(super) fn new(block: &Block, sign: Real) -> Self {
        let [[a00, ..], [a10, a11, _], [a20, a21, a22]] = *block;
        let invert = |pivot: Real| if pivot * sign > 0.0 { 1.0 / pivot } else { 0.0 };
        let keep = |pivot: Real| if pivot * sign > 0.0 { pivot } else { 0.0 };
        let i0 = invert(a00);
        let (g10, g20) = (a10 * i0, a20 * i0);
        let d1 = a11 - g10 * a10;
        let i1 = invert(d1);
        let e21 = a21 - g20 * a10;
        let g21 = e21 * i1;
        let d2 = a22 - g20 * a20 - g21 * e21;
        Self {
            lower: [g10, g20, g21],
            pivots: [keep(a00), keep(d1), keep(d2)],
            inverse: [i0, i1, invert(d2)],
        }
    }

    /// The size of the smallest pivot.
    pub(super) fn least(&self) -> Real {
        self.pivots.iter().fold(Real::INFINITY, |least, pivot| least.min(pivot.abs()))
    }

    /// A·G⁻ᵀ·D⁻¹.
    pub(super) fn divide(&self, a: &Block) -> Block {
        a.map(|row| self.scaled(self.forward(row)))
    }

    /// A·D.
    pub(super) fn weighted(&self, a: &Block) -> Block {
        let [d0, d1, d2] = self.pivots;
        a.map(|[x, y, z]| [x * d0, y * d1, z * d2])
    }

    /// G⁻¹·x.
    pub(super) fn forward(&self, [x, y, z]: Triple) -> Triple {
        let [g10, g20, g21] = self.lower;
        let y = y - g10 * x;
        [x, y, z - g20 * x - g21 * y]
    }

    /// D⁻¹·x.
    pub(super) fn scaled(&self, [x, y, z]: Triple) -> Triple {
        let [i0, i1, i2] = self.inverse;
        [x * i0, y * i1, z * i2]
    }

    /// G⁻ᵀ·x.
    pub(super) fn backward(&self, [x, y, z]: Triple) -> Triple {
        let [g10, g20, g21] = self.lower;
        let y = y - g21 * z;
        [x - g10 * y - g20 * z, y, z]
    }
}
