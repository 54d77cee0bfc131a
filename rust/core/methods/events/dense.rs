//! A small system of rows, solved at once although its matrix need not be symmetric (sliding friction) nor regular
//! (rows that depend on one another).

use crate::math::Real;

/// What is added to the diagonal, rows scaled to one: of all solutions, about the least comes out, and corrections make up
/// for it.
const EPSILON: Real = 1e-10;

/// Corrections by what is left over, at most.
const CORRECTIONS: usize = 12;

/// A x = b by Gaussian elimination with row exchanges on A + ε, and corrections.
#[derive(Clone, Debug, Default)]
pub struct Dense {
    n: usize,
    /// By rows.
    matrix: Vec<Real>,
    factors: Vec<Real>,
    order: Vec<usize>,
    left: Vec<Real>,
    change: Vec<Real>,
}

impl Dense {
    /// Begins a matrix of n rows of zeros; returns it, by rows, to be filled in.
    pub fn start(&mut self, n: usize) -> &mut [Real] {
        self.n = n;
        self.matrix.clear();
        self.matrix.resize(n * n, 0.0);
        &mut self.matrix
    }

    /// Factors what was filled in.
    pub fn factor(&mut self) {
        let n = self.n;
        self.factors.clone_from(&self.matrix);
        self.order.clear();
        self.order.extend(0..n);
        for k in 0..n {
            self.factors[k * n + k] += EPSILON;
        }
        for k in 0..n {
            let size = |i: usize| self.factors[i * n + k].abs();
            let best = (k..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            if best != k {
                self.order.swap(k, best);
                for j in 0..n {
                    self.factors.swap(k * n + j, best * n + j);
                }
            }
            let pivot = self.factors[k * n + k];
            if pivot == 0.0 {
                continue;
            }
            for i in k + 1..n {
                let part = self.factors[i * n + k] / pivot;
                self.factors[i * n + k] = part;
                if part != 0.0 {
                    for j in k + 1..n {
                        self.factors[i * n + j] -= part * self.factors[k * n + j];
                    }
                }
            }
        }
    }

    /// Solves for a right-hand side; writes x there.
    pub fn solve(&mut self, b: &mut [Real]) {
        let n = self.n;
        let Self { matrix, factors, order, left, change, .. } = self;
        let largest = b.iter().fold(0.0, |most: Real, x| most.max(x.abs()));
        left.clear();
        left.extend_from_slice(b);
        let wanted = left.clone();
        b.fill(0.0);
        let mut error = Real::INFINITY;
        for _ in 0..CORRECTIONS {
            change.clear();
            change.extend(order.iter().map(|k| left[*k]));
            substitute(factors, n, change);
            let row = |i: usize, x: &[Real]| -> Real {
                wanted[i] - (0..n).map(|j| matrix[i * n + j] * x[j]).sum::<Real>()
            };
            let next: Vec<Real> = b.iter().zip(&*change).map(|(x, dx)| x + dx).collect();
            let rest: Vec<Real> = (0..n).map(|i| row(i, &next)).collect();
            let worst = rest.iter().fold(0.0, |most: Real, x| most.max(x.abs()));
            if !worst.is_finite() || worst >= error {
                break;
            }
            b.copy_from_slice(&next);
            left.copy_from_slice(&rest);
            let slow = worst > 0.5 * error;
            error = worst;
            if slow || error <= Real::EPSILON * largest {
                break;
            }
        }
    }
}

fn substitute(factors: &[Real], n: usize, x: &mut [Real]) {
    for i in 0..n {
        let sum: Real = (0..i).map(|j| factors[i * n + j] * x[j]).sum();
        x[i] -= sum;
    }
    for i in (0..n).rev() {
        let sum: Real = (i + 1..n).map(|j| factors[i * n + j] * x[j]).sum();
        let pivot = factors[i * n + i];
        x[i] = if pivot == 0.0 { 0.0 } else { (x[i] - sum) / pivot };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_system_and_a_redundant_one() {
        let mut dense = Dense::default();
        dense.start(2).copy_from_slice(&[1.0, 0.3, -0.2, 1.0]);
        dense.factor();
        let mut x = [1.3, 0.8];
        dense.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 1.0).abs() < 1e-14, "{x:?}");
        // Two equal rows share evenly.
        dense.start(2).copy_from_slice(&[1.0; 4]);
        dense.factor();
        let mut x = [1.0, 1.0];
        dense.solve(&mut x);
        assert!((x[0] - 0.5).abs() < 1e-6 && (x[0] + x[1] - 1.0).abs() < 1e-14, "{x:?}");
    }
}
