//! Radau IIA of order 5: three stages, all of them implicit, L-stable. Stiffness does not bound its step.
//!
//! E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.8: the transformed system, Newton's
//! iteration with one Jacobian, the error estimate (8.20), starting values by the last collocation polynomial. The
//! system is of second order, so that matrices of all positions and velocities fold to those of the positions:
//! (g − J)(q, v) = (r, s) is (g² − g·∂a/∂v − ∂a/∂q) q = s + g·r − ∂a/∂v·r, v = g·q − r.

use nalgebra::Complex;

use crate::error::{Error, Result};
use crate::math::Real;
use crate::methods::first_order::{self, Columns};
use crate::methods::jacobian::Jacobian;
use crate::methods::lu::Lu;
use crate::methods::scale::Scales;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

/// Slopes: that of the state, of the three stages, and one to work with.
const SLOPES: usize = 5;

/// √6.
const S6: Real = 2.449_489_742_783_178;

/// Times of the stages in a step.
const C: [Real; 3] = [(4.0 - S6) / 10.0, (4.0 + S6) / 10.0, 1.0];

/// Weights of the last stage.
const B: [Real; 3] = [(16.0 - S6) / 36.0, (16.0 + S6) / 36.0, 1.0 / 9.0];

/// The eigenvalues of A⁻¹: γ and α ± iβ.
const GAMMA: Real = 3.637_834_252_744_496;
const ALPHA: Real = 2.681_082_873_627_752;
const BETA: Real = 3.050_430_199_247_411;

/// A⁻¹ = T Λ T⁻¹ with γ, and α and −β, β and α, in Λ.
const T: [[Real; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107, 0.204_129_352_293_799_94, 0.382_942_112_757_261_9],
    [0.966_048_182_615_093, 1.0, 0.0],
];
const T_INVERSE: [[Real; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605, -0.596_039_204_828_224_9],
];

/// The stages' part in the error estimate.
const E: [Real; 3] = [-(13.0 + 7.0 * S6) / 3.0, (-13.0 + 7.0 * S6) / 3.0, -1.0 / 3.0];

/// Iterations of Newton's method in a step.
const MOST: u32 = 12;

/// A Jacobian with which errors fall by this factor an iteration is kept for the next step.
const GOOD: Real = 1e-3;

pub struct Radau5;

static FACTS: Facts = Facts {
    name: "radau5",
    order: 5,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "Radau's implicit method of order 5, stable however stiff the forces are",
};

/// A step of the method.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// World time at its start (s).
    pub time: Real,
    /// Its length (s).
    pub h: Real,
    /// Relative error to which its equations are solved, rounding permitting.
    pub wanted: Real,
}

/// The method at work: Jacobian, factors, stages.
#[derive(Clone, Debug, Default)]
pub struct Radau {
    jacobian: Jacobian,
    /// Whether the Jacobian is to be kept, and whether it is that of this very state.
    kept: bool,
    fresh: bool,
    /// Whether it was taken since its rates were asked for.
    new: bool,
    real: Lu<Real>,
    complex: Lu<Complex<Real>>,
    /// Step of the factors (s); none: there are none.
    factored: Option<Real>,
    /// Stages less the state: positions, then velocities.
    z: [Vec<Real>; 3],
    /// T⁻¹ z.
    w: [Vec<Real>; 3],
    /// Those of a step before, its length (s), and where in it this one begins; none: there is no such step.
    before: [Vec<Real>; 3],
    known: Option<(Real, Real)>,
    /// Right-hand sides.
    right: Vec<Real>,
    complex_right: Vec<Complex<Real>>,
    folded: Vec<Real>,
    complex_folded: Vec<Complex<Real>>,
    /// Iterations of the last step, and the factor by which its errors fell.
    pub iterations: u32,
    rate: Real,
    /// What factors cost so far, in evaluations of the accelerations.
    pub cost: Real,
}

impl Method for Radau5 {
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
        let Scratch { flat: y, radau, scales: [scales, trial], .. } = scratch;
        y.load(motion, SLOPES);
        y.settle_state(system, motion);
        radau.forget();
        let forces = &system.forces;
        scales.begin(motion.poses, |i| forces.info(i).size, span.duration);
        for k in 0..span.substeps {
            let step = Step { time: span.time(k), h: span.h(), wanted: 0.0 };
            y.slope_of_state(0, system, step.time)?;
            if !radau.solve(y, system, (scales, trial), step)? {
                return Err(refused(step.h));
            }
            y.settle_stage(system, motion);
            radau.accept();
            std::mem::swap(scales, trial);
            std::mem::swap(&mut y.state, &mut y.stage);
        }
        y.store(motion);
        Ok(())
    }
}

fn refused(h: Real) -> Error {
    let allowed = "shorter, or more substeps: the method's equations did not converge";
    Error::invalid("dt", h, allowed)
}

impl Radau {
    /// Forgets the steps before.
    pub fn forget(&mut self) {
        (self.kept, self.fresh, self.factored, self.known) = (false, false, None, None);
    }

    /// Solves the stages of a step from the state, whose slope is `slopes[0]`, and writes its end to `y.stage`; false: the
    /// iteration does not converge.
    pub fn solve(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (scales, trial): (&Scales, &mut Scales),
        step: Step,
    ) -> Result<bool> {
        self.size(y);
        self.guess(step.h);
        loop {
            if !self.kept {
                self.jacobian.take(y, system, scales, (step.time, step.h))?;
                (self.kept, self.fresh, self.new) = (true, true, true);
                self.factored = None;
            }
            if self.factor(step.h) && self.iterate(y, system, (scales, &mut *trial), step)? {
                return Ok(true);
            }
            if self.fresh {
                return Ok(false);
            }
            self.kept = false;
            self.z.iter_mut().for_each(|z| z.fill(0.0));
        }
    }

    /// The end of a step that was solved becomes the state.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.z, &mut self.before);
        self.known = self.factored.map(|h| (h, 1.0));
        self.kept = self.rate < GOOD;
        self.fresh = false;
    }

    /// Error of a step that was solved: (g − J)⁻¹ (f₀ + Σ eᵢzᵢ/h). `anew`: where it is too large, taken once more from there, which
    /// stiff parts of it do not survive.
    pub fn error(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        scales: &Scales,
        (step, anew): (Step, Option<Real>),
    ) -> Result<Real> {
        self.right_of_error(&y.slopes[0], step.h);
        let error = scales.worst(|k| self.right[k]);
        if anew.is_none_or(|most| error <= most) || !error.is_finite() {
            return Ok(error);
        }
        let end = y.stage.clone();
        y.stage.copy_from_slice(&y.state);
        y.stage.iter_mut().zip(&self.right).for_each(|(y, e)| *y += e);
        y.slope_of_stage(SLOPES - 1, system, step.time)?;
        y.stage.copy_from_slice(&end);
        self.right_of_error(&y.slopes[SLOPES - 1], step.h);
        Ok(scales.worst(|k| self.right[k]))
    }

    fn right_of_error(&mut self, slope: &[Real], h: Real) {
        let Self { right, z, folded, .. } = self;
        let of_stages = |k: usize| -> Real { E.iter().zip(&*z).map(|(e, z)| e * z[k]).sum() };
        right.clear();
        right.extend((0..z[0].len()).map(|k| slope[k] + of_stages(k) / h));
        self.jacobian.solve(&self.real, GAMMA / h, right, folded);
    }

    /// The collocation polynomial of a step that was solved, at a fraction of it.
    pub fn at(&self, state: &[Real], x: Real) -> Vec<Real> {
        let mut at = state.to_vec();
        for (y, way) in at.iter_mut().zip(way(&self.z, x)) {
            *y += way;
        }
        at
    }

    /// Prepares for a shorter step from the same state.
    pub fn within(&mut self) {
        self.accept();
        self.known = self.known.map(|(h, _)| (h, 0.0));
    }

    /// The fastest rate (1/s) of the Jacobian, if that is a new one.
    pub fn fastest_if_new(&mut self) -> Option<Real> {
        std::mem::take(&mut self.new).then(|| self.jacobian.fastest())
    }

    fn size(&mut self, y: &Columns) {
        let n = 6 * first_order::bodies(&y.state);
        if self.z[0].len() != n {
            self.forget();
        }
        for columns in [&mut self.z, &mut self.w, &mut self.before] {
            columns.iter_mut().for_each(|column| column.resize(n, 0.0));
        }
    }

    /// Stages by the polynomial of the step before, continued.
    fn guess(&mut self, h: Real) {
        let Self { z, before, known, .. } = self;
        let Some((h_before, from)) = *known else {
            z.iter_mut().for_each(|z| z.fill(0.0));
            return;
        };
        let start: Vec<Real> = way(before, from).collect();
        for (z, c) in z.iter_mut().zip(C) {
            let ahead = way(before, from + c * h / h_before);
            z.iter_mut().zip(ahead.zip(&start)).for_each(|(z, (way, start))| *z = way - start);
        }
    }

    /// Factors for a step; false: there are none.
    fn factor(&mut self, h: Real) -> bool {
        if self.factored == Some(h) {
            return true;
        }
        let Self { jacobian, real, complex, .. } = self;
        self.cost += jacobian.cost_of_factors();
        let found = jacobian.fill(real, GAMMA / h).factor()
            && jacobian.fill(complex, Complex::new(ALPHA / h, BETA / h)).factor();
        self.factored = found.then_some(h);
        found
    }

    /// Newton's iteration on the stages; whether it converges.
    fn iterate(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (scales, trial): (&Scales, &mut Scales),
        step: Step,
    ) -> Result<bool> {
        combine(&T_INVERSE, &self.z, &mut self.w);
        let (mut before, mut rate, mut stalled) = (Real::INFINITY, GOOD, 0);
        for iteration in 1..=MOST {
            self.iterations = iteration;
            self.improve(y, system, step)?;
            self.end(y, step.h);
            trial.extend(scales, [&y.state, &y.stage], step.h);
            let change = self.change(trial);
            if !change.is_finite() {
                return Ok(false);
            }
            if iteration > 1 {
                rate = change / before;
            }
            let left = if rate < 1.0 { rate / (1.0 - rate) * change } else { Real::INFINITY };
            // Of the first iteration nothing is known but its change.
            let solved = iteration > 1 && left <= step.wanted;
            if solved || change <= Real::EPSILON {
                self.rate = rate;
                return Ok(true);
            }
            stalled = if rate >= STALLED { stalled + 1 } else { 0 };
            if stalled == 2 || iteration == MOST {
                self.rate = 1.0;
                return Ok(change <= trial.rounding([&y.state, &y.stage], GAMMA / step.h));
            }
            before = change;
        }
        Ok(false)
    }

    /// One step of Newton's, which leaves what it changes of w in the right-hand sides.
    fn improve(&mut self, y: &mut Columns, system: &mut System<'_>, step: Step) -> Result<()> {
        let Self { jacobian, z, w, right, complex_right, .. } = self;
        for i in 0..3 {
            y.stage.copy_from_slice(&y.state);
            y.stage.iter_mut().zip(&z[i]).for_each(|(y, z)| *y += z);
            y.slope_of_stage(i + 1, system, step.time + C[i] * step.h)?;
        }
        let [g, a, b] = [GAMMA, ALPHA, BETA].map(|part| part / step.h);
        let slope = |row: usize, k: usize| -> Real {
            T_INVERSE[row].iter().zip(&y.slopes[1..]).map(|(t, slope)| t * slope[k]).sum()
        };
        right.clear();
        right.extend((0..w[0].len()).map(|k| slope(0, k) - g * w[0][k]));
        complex_right.clear();
        complex_right.extend((0..w[0].len()).map(|k| {
            let (re, im) = (a * w[1][k] - b * w[2][k], b * w[1][k] + a * w[2][k]);
            Complex::new(slope(1, k) - re, slope(2, k) - im)
        }));
        jacobian.solve(&self.real, g, right, &mut self.folded);
        jacobian.solve(&self.complex, Complex::new(a, b), complex_right, &mut self.complex_folded);
        for (k, (real, complex)) in right.iter().zip(&*complex_right).enumerate() {
            let change = [*real, complex.re, complex.im];
            w.iter_mut().zip(change).for_each(|(w, change)| w[k] += change);
        }
        combine(&T, w, z);
        Ok(())
    }

    /// The largest relative change of a stage by the last step of Newton's.
    fn change(&self, scales: &Scales) -> Real {
        let change = |row: &[Real; 3], k: usize| {
            let complex = self.complex_right[k];
            row[0] * self.right[k] + row[1] * complex.re + row[2] * complex.im
        };
        T.iter().map(|row| scales.worst(|k| change(row, k))).fold(0.0, Real::max)
    }

    /// The end of the step, in `y.stage`.
    fn end(&self, y: &mut Columns, h: Real) {
        y.combine(h, &[0.0, B[0], B[1], B[2]]);
        let n = self.z[2].len();
        y.stage[..n].copy_from_slice(&y.state[..n]);
        y.stage.iter_mut().zip(&self.z[2]).for_each(|(y, z)| *y += z);
    }
}

/// Two iterations in a row whose changes fall more slowly have come as far as they will. One does not say so: where what is stiff turns, the
/// second takes back what the first, along the tangent, leaves of its square.
const STALLED: Real = 0.8;

/// Ways from the start by the polynomial through the stages, at a fraction of their step.
fn way(z: &[Vec<Real>; 3], x: Real) -> impl Iterator<Item = Real> + '_ {
    let weight = |i: usize| {
        let others = (0..3).filter(|j| *j != i).map(|j| (x - C[j]) / (C[i] - C[j]));
        x / C[i] * others.product::<Real>()
    };
    let weights = [weight(0), weight(1), weight(2)];
    (0..z[0].len()).map(move |k| weights.iter().zip(z).map(|(w, z)| w * z[k]).sum())
}

/// out = matrix · columns.
fn combine(matrix: &[[Real; 3]; 3], columns: &[Vec<Real>; 3], out: &mut [Vec<Real>; 3]) {
    for (row, out) in matrix.iter().zip(out) {
        let sum = |k: usize| row.iter().zip(columns).map(|(t, column)| t * column[k]).sum();
        out.iter_mut().enumerate().for_each(|(k, x)| *x = sum(k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Butcher's matrix, from its own formula.
    fn matrix() -> [[Real; 3]; 3] {
        [
            [(88.0 - 7.0 * S6) / 360.0, (296.0 - 169.0 * S6) / 1800.0, (-2.0 + 3.0 * S6) / 225.0],
            [(296.0 + 169.0 * S6) / 1800.0, (88.0 + 7.0 * S6) / 360.0, (-2.0 - 3.0 * S6) / 225.0],
            B,
        ]
    }

    #[test]
    fn the_tables_are_those_of_the_method() {
        // A T Λ = T, and T⁻¹ T = 1.
        let lambda = [[GAMMA, 0.0, 0.0], [0.0, ALPHA, -BETA], [0.0, BETA, ALPHA]];
        let times = |a: &[[Real; 3]; 3], b: &[[Real; 3]; 3]| {
            let at = |i: usize, j: usize| -> Real { (0..3).map(|k| a[i][k] * b[k][j]).sum() };
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| at(i, j)))
        };
        let same = times(&matrix(), &times(&T, &lambda));
        let one = times(&T_INVERSE, &T);
        for i in 0..3 {
            for j in 0..3 {
                assert!((same[i][j] - T[i][j]).abs() < 1e-14, "{i}, {j}: {same:?}");
                assert!((one[i][j] - Real::from(i == j)).abs() < 1e-14, "{i}, {j}: {one:?}");
            }
            // Collocation: Σ aᵢⱼ cⱼ^(k−1) = cᵢ^k/k for k = 1, 2, 3.
            for k in 1..=3 {
                let sum: Real = (0..3).map(|j| matrix()[i][j] * C[j].powi(k - 1)).sum();
                assert!((sum - C[i].powi(k) / Real::from(k)).abs() < 1e-15, "{i}, {k}");
            }
        }
    }
}
