//! How accelerations change with positions and velocities, by differences, and the matrices of implicit methods that are
//! made of it.

use nalgebra::ComplexField;

use crate::error::Result;
use crate::math::Real;
use crate::methods::System;
use crate::methods::first_order::{self, Columns};
use crate::methods::lu::Lu;
use crate::methods::scale::{SHIFT, Scales};

/// The slopes that evaluations at the state and beside it use.
const HERE: usize = 3;
const BESIDE: usize = 4;

/// ∂a/∂q and ∂a/∂v, by columns.
#[derive(Clone, Debug, Default)]
pub struct Jacobian {
    /// Positions of all bodies, angles among them.
    n: usize,
    by_places: Vec<Real>,
    by_velocities: Vec<Real>,
}

impl Jacobian {
    /// Takes it at the state, whose slope is `slopes[0]`.
    pub fn take(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        scales: &Scales,
        (time, h): (Real, Real),
    ) -> Result<()> {
        let n = 3 * first_order::bodies(&y.state);
        self.n = n;
        for matrix in [&mut self.by_places, &mut self.by_velocities] {
            matrix.clear();
            matrix.resize(n * n, 0.0);
        }
        y.stage.copy_from_slice(&y.state);
        let springless = |system: &mut System<'_>, is: bool| {
            system.joints.iter_mut().for_each(|joints| joints.springless = is);
        };
        springless(system, true);
        let result = self.take_differences(y, system, scales, (time, h));
        springless(system, false);
        if let Some(joints) = &mut system.joints {
            let matrices = [&mut *self.by_places, &mut *self.by_velocities];
            joints.add_spring_jacobian(first_order::split(&y.state), matrices);
        }
        result
    }

    /// By differences, of all but springs of joints.
    fn take_differences(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        scales: &Scales,
        (time, h): (Real, Real),
    ) -> Result<()> {
        let n = self.n;
        y.slope_of_stage(HERE, system, time)?;
        for k in 0..2 * n {
            let component = k % n;
            // What moves as it is given does so whatever forces there are; an axis that is locked stays to the last bit, with nothing in its
            // row and column that an exchange of rows could bring in.
            let mass = &system.forces.masses[component / 3];
            if [mass.inverse.x, mass.inverse.y, mass.inverse_inertia][component % 3] == 0.0 {
                continue;
            }
            let shift = if k < n {
                scales.shift(component)
            } else {
                scales.shift_of_velocity(component, h)
            };
            // What has neither size nor way yet is shifted as far as forces would move it.
            let pushed = if k < n { h * h } else { h } * y.slopes[0][n + component].abs();
            let shift = if shift > 0.0 { shift } else { SHIFT * pushed };
            let from = y.state[k];
            y.stage[k] = from + shift;
            // The shift that its numbers allow.
            let shift = y.stage[k] - from;
            if shift == 0.0 {
                continue;
            }
            y.slope_of_stage(BESIDE, system, time)?;
            y.stage[k] = from;
            let matrix = if k < n { &mut self.by_places } else { &mut self.by_velocities };
            let column = &mut matrix[component * n..(component + 1) * n];
            let slopes = y.slopes[BESIDE][n..2 * n].iter().zip(&y.slopes[HERE][n..2 * n]);
            column
                .iter_mut()
                .zip(slopes)
                .for_each(|(a, (beside, here))| *a = (beside - here) / shift);
        }
        Ok(())
    }

    /// What factors cost, real and complex, in evaluations of the accelerations: (1 + 4)·⅔n³ operations, of which an
    /// evaluation takes some hundreds a coordinate.
    pub fn cost_of_factors(&self) -> Real {
        cost_of_factors(self.n)
    }

    /// g² − g·∂a/∂v − ∂a/∂q.
    pub fn fill<'a, T: ComplexField<RealField = Real> + Copy>(
        &self,
        lu: &'a mut Lu<T>,
        g: T,
    ) -> &'a mut Lu<T> {
        let matrix = lu.start(self.n);
        let parts = self.by_places.iter().zip(&self.by_velocities);
        for (x, (q, v)) in matrix.iter_mut().zip(parts) {
            *x = -(g * T::from_real(*v)) - T::from_real(*q);
        }
        matrix.iter_mut().step_by(self.n + 1).for_each(|x| *x += g * g);
        lu
    }

    /// Solves (g − J)(q, v) = (r, s) in place with the factors for g.
    pub fn solve<T: ComplexField<RealField = Real> + Copy>(
        &self,
        lu: &Lu<T>,
        g: T,
        right: &mut [T],
        folded: &mut Vec<T>,
    ) {
        let (r, s) = right.split_at_mut(self.n);
        folded.clear();
        folded.extend(s.iter().zip(&*r).map(|(s, r)| *s + g * *r));
        for (column, r) in self.by_velocities.chunks_exact(self.n).zip(&*r) {
            folded.iter_mut().zip(column).for_each(|(x, a)| *x -= *r * T::from_real(*a));
        }
        lu.solve(folded);
        for ((r, s), q) in r.iter_mut().zip(s).zip(&*folded) {
            *s = g * *q - *r;
            *r = *q;
        }
    }

    /// The fastest rate (1/s) at which anything of this motion moves: by powers of J, from a start that has all in it.
    pub fn fastest(&self) -> Real {
        const POWERS: u32 = 24;
        const LAST: u32 = 8;
        let n = self.n;
        let mut q: Vec<Real> = (0..n).map(|k| 1.0 + 0.1 * (k % 7) as Real).collect();
        let mut v = vec![0.0; n];
        let mut sum = 0.0;
        for power in 0..POWERS {
            let mut a = vec![0.0; n];
            for (matrix, x) in [(&self.by_places, &q), (&self.by_velocities, &v)] {
                for (column, x) in matrix.chunks_exact(n).zip(x) {
                    a.iter_mut().zip(column).for_each(|(a, m)| *a += m * x);
                }
            }
            q = std::mem::replace(&mut v, a);
            let norm = |x: &[Real]| libm::sqrt(x.iter().map(|x| x * x).sum());
            let size: Real = norm(&v);
            if size == 0.0 || !size.is_finite() {
                return 0.0;
            }
            let before = norm(&q);
            if power >= POWERS - LAST && before > 0.0 {
                sum += libm::log(size / before);
            }
            q.iter_mut().chain(&mut v).for_each(|x| *x /= size);
        }
        libm::exp(sum / Real::from(LAST))
    }
}

/// As the Jacobian says, for n coordinates.
pub fn cost_of_factors(n: usize) -> Real {
    const OF_A_COORDINATE: Real = 300.0;
    let n = n as Real;
    5.0 * 2.0 / 3.0 * n * n / OF_A_COORDINATE
}
