//! The pendulum in closed form, by the arithmetic–geometric mean (M. Abramowitz, I. A. Stegun, "Handbook of mathematical
//! functions", 16.4 and 17.6).

use crate::math::{Real, atan2, cos, sin_cos};

/// Most halvings: each doubles the digits.
const LEVELS: usize = 8;

/// a of all levels and c/a of all but the first, of the mean of 1 and cos(θ₀/2).
fn means(start: Real) -> ([Real; LEVELS], [Real; LEVELS]) {
    let (mut a, mut b) = (1.0, cos(start / 2.0));
    let (mut all, mut ratios) = ([a; LEVELS], [0.0; LEVELS]);
    for level in 1..LEVELS {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), libm::sqrt(a * b));
        (all[level], ratios[level]) = (a, c / a);
    }
    (all, ratios)
}

/// Period (s): T = 2π/(ω₀ agm(1, cos(θ₀/2))).
#[cfg(test)]
fn period(start: Real, rate: Real) -> Real {
    std::f64::consts::TAU / (rate * means(start).0[LEVELS - 1])
}

/// Angle (rad, from the lowest point) of a pendulum that was let go at rest, after a time; `rate` is that of small swings
/// (rad/s): sin(θ/2) = k cd(ω₀t, k), k = sin(θ₀/2).
pub fn swing(start: Real, rate: Real, time: Real) -> Real {
    let (all, ratios) = means(start);
    let mut phase = Real::from(1_u32 << (LEVELS - 1)) * all[LEVELS - 1] * rate * time;
    let mut above = phase;
    for level in (1..LEVELS).rev() {
        let sin = ratios[level] * sin_cos(phase).0;
        above = phase;
        phase = 0.5 * (phase + atan2(sin, libm::sqrt(1.0 - sin * sin)));
    }
    let half = sin_cos(start / 2.0).0 * cos(above - phase);
    2.0 * atan2(half, libm::sqrt(1.0 - half * half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::PI;

    /// Figures of the catalogue: g = 9.81, L = 1, from 90°.
    #[test]
    fn the_known_figures() {
        let rate = libm::sqrt(9.81);
        assert!((period(PI / 2.0, rate) - 2.367_841_947_58).abs() < 1e-11);
        assert!((swing(PI / 2.0, rate, 10.0) - 0.278_680_673_570).abs() < 1e-11);
        assert!((period(179.0 * PI / 180.0, 2.0 * PI) - 3.901_065_160_389).abs() < 1e-10);
        let after = period(2.0, rate);
        assert!((swing(2.0, rate, after) - 2.0).abs() < 1e-12);
        assert!((swing(2.0, rate, after / 2.0) + 2.0).abs() < 1e-12);
    }
}
