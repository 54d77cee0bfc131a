//! 2 × 2 tensors, as [xx, xy, yx, yy].

use crate::math::{Real, Vec2, vec2};

pub type Tensor = [Real; 4];

pub const IDENTITY: Tensor = [1.0, 0.0, 0.0, 1.0];

pub fn determinant(f: &Tensor) -> Real {
    f[0] * f[3] - f[1] * f[2]
}

/// The cofactors: the derivative of the determinant.
pub fn cofactor(f: &Tensor) -> Tensor {
    [f[3], -f[2], -f[1], f[0]]
}

pub fn apply(f: &Tensor, v: Vec2) -> Vec2 {
    vec2(f[0] * v.x + f[1] * v.y, f[2] * v.x + f[3] * v.y)
}

pub fn times(a: &Tensor, b: &Tensor) -> Tensor {
    [
        a[0] * b[0] + a[1] * b[2],
        a[0] * b[1] + a[1] * b[3],
        a[2] * b[0] + a[3] * b[2],
        a[2] * b[1] + a[3] * b[3],
    ]
}

pub fn transposed(a: &Tensor) -> Tensor {
    [a[0], a[2], a[1], a[3]]
}

pub fn sum(a: &Tensor, b: &Tensor) -> Tensor {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

pub fn difference(a: &Tensor, b: &Tensor) -> Tensor {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

pub fn scaled(a: &Tensor, by: Real) -> Tensor {
    a.map(|x| x * by)
}

pub fn symmetric(a: &Tensor) -> Tensor {
    let shear = 0.5 * (a[1] + a[2]);
    [a[0], shear, shear, a[3]]
}

/// a bᵀ.
pub fn outer(a: Vec2, b: Vec2) -> Tensor {
    [a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y]
}
