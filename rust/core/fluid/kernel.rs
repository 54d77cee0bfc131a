//! The smoothing kernel: the cubic spline of Monaghan and Lattanzio (1985) in the plane, and what follows from it
//! on the lattice that particles start on.
//!
//! W(r) = s f(r/H) with s = 40/(7πH²), f(q) = 2(1 − q)₊³ − 8(½ − q)₊³, and ∫W dA = 1.

use std::sync::OnceLock;

use super::shore::half_plane;
use crate::math::{PI, Real};

/// Support over spacing.
pub const SUPPORT: Real = 2.0;

/// 40/(7π): s·H².
const SCALE: Real = 40.0 / (7.0 * PI);

/// The cubic spline of one support.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// H (m): beyond it nothing is felt.
    pub support: Real,
    inverse: Real,
    scale: Real,
}

impl Kernel {
    /// For particles this far apart (m).
    #[must_use]
    pub fn new(spacing: Real) -> Self {
        let support = SUPPORT * spacing;
        let inverse = 1.0 / support;
        Self { support, inverse, scale: SCALE * inverse * inverse }
    }

    /// W(r) (1/m²).
    #[inline]
    #[must_use]
    pub fn value(&self, r: Real) -> Real {
        let q = r * self.inverse;
        let (far, near) = ((1.0 - q).max(0.0), (0.5 - q).max(0.0));
        self.scale * (2.0 * far * far * far - 8.0 * near * near * near)
    }

    /// W′(r) (1/m³), at most 0.
    #[inline]
    #[must_use]
    pub fn slope(&self, r: Real) -> Real {
        let q = r * self.inverse;
        let (far, near) = ((1.0 - q).max(0.0), (0.5 - q).max(0.0));
        self.scale * self.inverse * (24.0 * near * near - 6.0 * far * far)
    }

    /// ∫₀ʳ W(s) s ds: what lies within r of the centre, over 2π.
    #[must_use]
    pub fn moment(&self, r: Real) -> Real {
        let q = (r * self.inverse).min(1.0);
        if q > 0.5 {
            let w = 1.0 - q;
            return 1.0 / (2.0 * PI) - SCALE * w.powi(4) * (0.5 - 0.4 * w);
        }
        SCALE * q * q * (0.5 + q * q * (1.2 * q - 1.5))
    }
}

/// Numbers of the square lattice of spacing 1 at rest.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Area that each particle stands for, over d²: 1/Σ W, so that the lattice is neither thin nor dense.
    pub area: Real,
    /// The part of its kernel that a wall half a spacing before a particle fills, as it counts.
    pub first: Real,
    /// What the square of the part of a kernel that a wall fills counts, so that the first row, half a spacing before it,
    /// is neither thin nor dense. The square, because pressure must resist the first row as it does a mirror image of it:
    /// the part itself grows half as fast, and then every second row of a lattice can sink without pressing on the others.
    pub wall: Real,
    /// What friction at a wall counts, so that the first row of a shear flow feels none in sum.
    pub friction: Real,
    /// What friction between particles counts, so that the lattice has the viscosity that is asked.
    pub shear: Real,
    /// What the part that a wall fills counts as neighbours that pull, so that they are as many in the first row as inside.
    pub pull: Real,
}

/// The lattice's numbers, computed at the first call.
#[must_use]
pub fn lattice() -> &'static Lattice {
    static LATTICE: OnceLock<Lattice> = OnceLock::new();
    LATTICE.get_or_init(measure)
}

fn measure() -> Lattice {
    let kernel = Kernel::new(1.0);
    let reach = SUPPORT as i32;
    let points = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| (x, y)));
    let (mut all, mut above, mut shear, mut half, mut below) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in points {
        let (x, y) = (Real::from(x), Real::from(y));
        let r = (x * x + y * y).sqrt();
        all += kernel.value(r);
        above += if y >= 0.0 { kernel.value(r) } else { 0.0 };
        if r > 0.0 {
            let pull = -2.0 * kernel.slope(r) / r;
            // In the flow v = (½y², 0), whose Laplacian is 1, and of the upper half in the flow v = (y, 0).
            shear += pull * y * y / 2.0;
            half += if y > 0.0 { pull * y } else { 0.0 };
            below += if y < 0.0 { pull * r * r / 4.0 } else { 0.0 };
        }
    }
    let area = 1.0 / all;
    let shore = half_plane(&kernel, 0.5);
    let missing = 1.0 - area * above;
    Lattice {
        area,
        first: missing,
        wall: missing / (shore.part * shore.part),
        friction: area * half / (0.5 * shore.friction),
        shear: 1.0 / (area * shear),
        pull: below / (shear * missing),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ f(r) 2πr dr over the support by the midpoint rule.
    fn integral(kernel: &Kernel, f: impl Fn(Real) -> Real) -> Real {
        let n = 20_000;
        let step = kernel.support / Real::from(n);
        (0..n).map(|k| (Real::from(k) + 0.5) * step).map(|r| f(r) * 2.0 * PI * r * step).sum()
    }

    #[test]
    fn the_kernel_is_a_part_of_one_and_its_slope_its_derivative() {
        let kernel = Kernel::new(0.3);
        assert!((integral(&kernel, |r| kernel.value(r)) - 1.0).abs() < 1e-7);
        for k in 1..60 {
            let r = kernel.support * Real::from(k) / 57.0;
            let difference = (kernel.value(r + 1e-6) - kernel.value(r - 1e-6)) / 2e-6;
            assert!((difference - kernel.slope(r)).abs() < 1e-6 * kernel.value(0.0) / 0.3, "{r}");
            let rate = (kernel.moment(r + 1e-6) - kernel.moment(r - 1e-6)) / 2e-6;
            assert!((rate - kernel.value(r) * r).abs() < 1e-6, "{r}");
        }
        assert!((kernel.moment(kernel.support) * 2.0 * PI - 1.0).abs() < 1e-14);
    }

    #[test]
    fn viscous_pull_gives_the_laplacian() {
        // ∫ 2(−W′/r) ½y² dA = 1.
        let kernel = Kernel::new(1.0);
        let sum = integral(&kernel, |r| -kernel.slope(r) * r / 2.0);
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn corrections_of_the_lattice_are_small() {
        let Lattice { area, first, wall, friction, shear, pull } = *lattice();
        assert!((0.1..0.3).contains(&first), "{first}");
        assert!((area - 1.0).abs() < 2e-3, "{area}");
        assert!((shear - 1.0).abs() < 2e-2, "{shear}");
        assert!((4.0..4.5).contains(&wall), "{wall}");
        assert!((1.0..3.0).contains(&friction), "{friction}");
        assert!((1.5..2.5).contains(&pull), "{pull}");
    }
}
