//! DOP853: Dormand and Prince's Runge–Kutta method of order 8 with error control and dense output.
//!
//! E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I" (1993),
//! sections II.5 (method, error estimate eq. 10.17) and II.6 (dense output).

use crate::error::Result;
use crate::math::Real;
use crate::methods::dop853_table::{A, C};
use crate::methods::first_order::{self, Columns};
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

/// Slopes of a step, its end included.
pub const STAGES: usize = 13;
/// Slopes with those that only dense output needs.
pub const DENSE_STAGES: usize = 16;

pub struct Dop853;

static FACTS: Facts = Facts {
    name: "dop853",
    order: 8,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: true,
    adaptive: true,
    joints: true,
    contacts: false,
    about: "Dormand and Prince's method of order 8; with a tolerance it chooses its own step",
};

impl Method for Dop853 {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let y = &mut scratch.flat;
        y.load(motion, DENSE_STAGES);
        y.settle_state(system, motion);
        for k in 0..span.substeps {
            y.slope_of_state(0, system, span.time(k))?;
            stages(y, system, span.time(k), span.h())?;
            y.settle_stage(system, motion);
            std::mem::swap(&mut y.state, &mut y.stage);
        }
        y.store(motion);
        Ok(())
    }
}

/// Slopes 1 to 11 and, in `y.stage`, the state at the end of a step whose slope 0 is there.
pub fn stages(y: &mut Columns, system: &mut System<'_>, time: Real, h: Real) -> Result<()> {
    for j in 1..12 {
        y.combine(h, A[j]);
        y.slope_of_stage(j, system, time + C[j] * h)?;
    }
    y.combine(h, A[12]);
    Ok(())
}

/// How fast (1/s) velocities change where a step ends, and how fast accelerations follow velocities: |f(y₁) − f(y₁₂)|/|y₁ − y₁₂|, y₁₂ the last stage, which is at
/// the same time. Stiff parts of the motion show there, however little of them there is.
///
/// Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.2, (2.35).
pub fn rates_seen(y: &Columns, h: Real, sizes: impl Fn(usize) -> Real) -> [Real; 2] {
    let n = first_order::bodies(&y.state);
    let apart = |k: usize| -> Real {
        let weights = A[12].iter().enumerate().map(|(j, a)| a - A[11].get(j).unwrap_or(&0.0));
        h * weights.zip(&y.slopes).map(|(w, slope)| w * slope[k]).sum::<Real>()
    };
    let mut sums = [0.0; 4];
    for k in 3 * n..6 * n {
        let size = if k % 3 == 2 { sizes(k / 3 - n) } else { 1.0 };
        let (end, change) = (y.slopes[12][k], y.slopes[12][k] - y.slopes[11][k]);
        let parts = [end, y.stage[k], change, apart(k)];
        sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += size * part * size * part);
    }
    let [a, v, change, apart] = sums;
    [(a, v), (change, apart)].map(|(x, y)| if y > 0.0 { libm::sqrt(x / y) } else { 0.0 })
}
