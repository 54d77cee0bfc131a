//! Springs at a fixed step: one row of an implicit solve, whose coefficients are fitted so that what hangs on one
//! spring swings and decays exactly, and whatever hangs on many is stable at any stiffness.
//!
//! With x the coordinate in the middle of a step of length h and v its rate before and after the kick, a row gives the
//! impulse λ = −hk x + E v⁻ − D v⁺. Alone on a mass m, with ω² = k/m and Γ = c/m, v⁺ = s(v⁻ + …) with
//! s = 1/(1 + D/m), and drift–kick–drift has the eigenvalues of the exact flow e^(−Γh/2 ± iφ), φ² = (ω² − Γ²/4)h², if
//!
//! 1 + D/m = 1/s, 1 + E/m = b/s, b = e^(−Γh), s = (1 + b − 2√b cos φ)/(ωh)².
//!
//! Any other impulse on the row counts s times as much as well, so that statics are exact. Of several springs on a body the fit
//! is made for the fastest mode that they may have together; undamped, D = E = βkh² then is Newmark's family
//! (N. M. Newmark, "A method of computation for structural dynamics", 1959) between β = 1/12, of fourth order in ωh, and
//! β ≥ 1/4, stable for all ωh.

use crate::joint::Coefficients;
use crate::math::{PI, Real, atan2, cos, exp, exp_m1, ln};

/// Bounds of the modes that the springs around a row may have together: ω² (1/s²) and Γ (1/s).
///
/// λ_max(M⁻¹K) ≤ max over rows of S_a + S_b with S of a body the sum of k·JM⁻¹Jᵀ over its rows: each row is given the
/// part of its bodies' masses in which it shares their stiffness (B. M. Irons, "Applications of a theorem on eigenvalues", 1970).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates {
    /// ω² (1/s²).
    pub stiffness: Real,
    /// Γ (1/s).
    pub damping: Real,
}

/// What a spring does in a step: λ = pull·x + before·v⁻ − after·v⁺.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// −hk.
    pub pull: Real,
    /// E.
    pub before: Real,
    /// D, above 0 unless the spring is nothing at all.
    pub after: Real,
}

/// The largest phase of a step: what swings faster is slowed down to it. Beyond π there is no such motion, and before it the
/// middle of a step is already 1/cos(φ/2) times as far out as the swing, here twice: it must not pass the anchor.
const MOST_PHASE: Real = 2.0 / 3.0 * PI;

impl Gains {
    /// Of a spring among others, for a step of length h.
    #[must_use]
    pub fn new(spring: &Coefficients, rates: &Rates, h: Real) -> Self {
        let (k, c) = (spring.stiffness, spring.damping);
        let (decay, square) = (rates.damping * h, rates.stiffness * h * h);
        let scale = scale(square, decay);
        let lost = -exp_m1(-decay);
        // Shares of D that belong to the damping and to the stiffness.
        let damping = share_of_damping(decay);
        let stiffness = if square > SMALL * SMALL {
            ((1.0 / scale - 1.0 - damping * decay) / square).max(0.0)
        } else {
            1.0 / 12.0
        };
        let taken = if decay > 0.0 { lost / (scale * decay) } else { 1.0 / scale };
        let after = stiffness * k * h * h + damping * c * h;
        Self { pull: -h * k, before: after - taken * c * h, after }
    }

    /// Of a spring on matter, which is moved by the implicit midpoint: so is the spring, D = E = kh²/4, since the fit above is for masses without
    /// stiffness of their own and would give energy here. Its damping takes αv⁺ + (1 − α)v⁻ with that α ≥ ½ which is exact for a lone mass that
    /// is damped at the rate Γ (1/s): no step is too long for the two together.
    #[must_use]
    pub fn midpoint(spring: &Coefficients, rate: Real, h: Real) -> Self {
        let (k, c) = (spring.stiffness, spring.damping);
        let after = 0.25 * k * h * h + share_of_damping(rate * h) * c * h;
        Self { pull: -h * k, before: after - c * h, after }
    }
}

/// α = 1/(1 − e^(−Γh)) − 1/(Γh): between ½ and 1.
fn share_of_damping(decay: Real) -> Real {
    if decay > SMALL { -1.0 / exp_m1(-decay) - 1.0 / decay } else { 0.5 + decay / 12.0 }
}

/// How what hangs on a spring moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Frequency ω/2π of the undamped swing (Hz).
    pub hertz: Real,
    /// ζ = Γ/2ω.
    pub damping_ratio: Real,
}

impl Swing {
    /// By the law: ω² = k/m, Γ = c/m of a spring on an effective mass (kg, kg·m²).
    #[must_use]
    pub fn exact(spring: &Coefficients, mass: Real) -> Self {
        let omega = (spring.stiffness / mass).sqrt();
        let ratio = if omega > 0.0 { spring.damping / (2.0 * mass * omega) } else { 0.0 };
        Self { hertz: omega / (2.0 * PI), damping_ratio: ratio }
    }

    /// As steps of length h with these gains make it: from the eigenvalues of drift–kick–drift.
    #[must_use]
    pub fn stepped(gains: &Gains, mass: Real, h: Real) -> Self {
        let scale = 1.0 / (1.0 + gains.after / mass);
        let product = (1.0 + gains.before / mass) * scale;
        let half = 0.5 * (1.0 + h * gains.pull * scale / mass + product);
        let square = half * half - product;
        let (decay, omega_square) = if square < 0.0 {
            let (decay, turn) = (-0.5 * ln(product) / h, atan2((-square).sqrt(), half) / h);
            (decay, turn * turn + decay * decay)
        } else {
            let rate = |value: Real| -ln(value.abs()) / h;
            let far = half + square.sqrt().copysign(half);
            let [slow, fast] = [rate(far), rate(product / far)];
            (0.5 * (slow + fast), slow * fast)
        };
        let omega = omega_square.max(0.0).sqrt();
        let ratio = if omega > 0.0 { decay / omega } else { 0.0 };
        Self { hertz: omega / (2.0 * PI), damping_ratio: ratio }
    }
}

/// Below this the series do.
const SMALL: Real = 1e-3;

/// s = (1 + b − 2√b cos φ)/(ωh)² without cancellation.
fn scale(square: Real, decay: Real) -> Real {
    let root = exp(-0.5 * decay);
    let phase_square = square - 0.25 * decay * decay;
    if square == 0.0 {
        return if decay > 0.0 { -exp_m1(-decay) / decay } else { 1.0 };
    }
    let numerator = if phase_square >= 0.0 {
        let phase = phase_square.sqrt().min(MOST_PHASE);
        let short = -exp_m1(-0.5 * decay);
        short * short + 2.0 * root * (1.0 - cos(phase))
    } else {
        // (1 − e₁)(1 − e₂) with the two decays of an overdamped spring.
        let spread = (-phase_square).sqrt();
        let slow = square / (0.5 * decay + spread);
        exp_m1(-slow) * exp_m1(-(0.5 * decay + spread))
    };
    numerator / square
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eigenvalues of drift–kick–drift by trace and determinant: those of the exact flow.
    #[test]
    fn one_mass_on_one_spring_swings_and_decays_exactly() {
        for h in [0.01, 0.1] {
            for omega in [1.0, 7.0, 20.0] {
                for zeta in [0.0, 0.1, 0.9, 1.0, 1.5, 4.0] {
                    let (k, c) = (omega * omega, 2.0 * zeta * omega);
                    let rates = Rates { stiffness: k, damping: c };
                    let gains = Gains::new(&Coefficients { stiffness: k, damping: c }, &rates, h);
                    let s = 1.0 / (1.0 + gains.after);
                    let (a, b) = (gains.pull * s, (1.0 + gains.before) * s);
                    let trace = 1.0 + h * a + b;
                    let square = k - 0.25 * c * c;
                    let exact = if square > 0.0 {
                        2.0 * exp(-0.5 * c * h) * cos(square.sqrt() * h)
                    } else {
                        let spread = (-square).sqrt() * h;
                        exp(-0.5 * c * h + spread) + exp(-0.5 * c * h - spread)
                    };
                    assert!((b - exp(-c * h)).abs() < 1e-12, "{omega} {zeta} {h}");
                    assert!((trace - exact).abs() < 1e-10, "{omega} {zeta} {h}: {trace} {exact}");
                }
            }
        }
    }

    /// What is read back of a lone spring is what was asked for, as long as a step resolves it.
    #[test]
    fn the_swing_of_a_lone_spring_is_the_one_asked_for() {
        let (mass, h) = (3.0, 1.0 / 240.0);
        for (hertz, ratio) in [(1.0, 0.0), (5.0, 0.1), (20.0, 0.7), (2.0, 1.5)] {
            let spring = crate::joint::Spring::new(hertz, ratio).coefficients(mass);
            let rates =
                Rates { stiffness: spring.stiffness / mass, damping: spring.damping / mass };
            let gains = Gains::new(&spring, &rates, h);
            for swing in [Swing::exact(&spring, mass), Swing::stepped(&gains, mass, h)] {
                assert!((swing.hertz / hertz - 1.0).abs() < 1e-9, "{swing:?}");
                assert!((swing.damping_ratio - ratio).abs() < 1e-9, "{swing:?}");
            }
        }
    }

    /// However stiff: eigenvalues of size √b at most, and a statically right answer.
    #[test]
    fn nothing_grows_at_any_stiffness() {
        for step in [1e-3, 0.1, 1.0, 3.0, 10.0, 1e3, 1e6] {
            for zeta in [0.0, 0.01, 1.0, 10.0] {
                let (k, c) = (step * step, 2.0 * zeta * step);
                let spring = Coefficients { stiffness: k, damping: c };
                let gains = Gains::new(&spring, &Rates { stiffness: k, damping: c }, 1.0);
                let s = 1.0 / (1.0 + gains.after);
                let (trace, b) =
                    (1.0 + gains.pull * s + (1.0 + gains.before) * s, (1.0 + gains.before) * s);
                assert!((-1e-9..=1.0 + 1e-12).contains(&b), "{step} {zeta}: {b}");
                assert!(trace.abs() <= 1.0 + b + 1e-9, "{step} {zeta}: {trace} {b}");
            }
        }
    }
}
