//! The linear complementarity problem w = Mz + q, w ≥ 0, z ≥ 0, w·z = 0, by Lemke's pivots.
//!
//! C. E. Lemke, "Bimatrix equilibrium points and mathematical programming", 1965; Cottle, Pang and Stone, "The Linear
//! Complementarity Problem", 1992, section 4.4. Contact in the plane with Coulomb's friction is one (the cone has
//! two edges), and where it has a solution that does not jump, this finds one.

use super::dense::Dense;
use crate::math::Real;

/// What is added to the diagonal, in parts of its largest entry: with it rows that depend on one another share evenly, and pivots on
/// them do not end on a ray for rounding. A larger one is tried where that does not solve the problem.
const ADDED: [Real; 3] = [1e-11, 1e-9, 1e-7];

/// Pivots below this part of the largest entry of their row are rounding.
const SMALL: Real = 1e-11;

/// z for a matrix by rows; none where the pivots end on a ray: there is no solution that can be found, or none at all.
#[must_use]
pub fn solve(matrix: &[Real], q: &[Real]) -> Option<Vec<Real>> {
    let n = q.len();
    let scale = q.iter().fold(0.0, |most: Real, x| most.max(x.abs()));
    if q.iter().all(|q| *q >= 0.0) || scale == 0.0 {
        return Some(vec![0.0; n]);
    }
    let mut best: Option<(Real, Vec<Real>)> = None;
    for added in ADDED {
        let Some(rough) = Tableau::new(matrix, q, (scale, added)).run(n) else { continue };
        let rough: Vec<Real> = rough.into_iter().map(|z| z * scale).collect();
        let z = polished(matrix, q, &rough).unwrap_or(rough);
        let error = violation(matrix, q, &z);
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, z));
        }
        if error <= 1e-10 * scale {
            break;
        }
    }
    best.map(|(_, z)| z)
}

/// By how much the worst row misses w ≥ 0 or w·z = 0.
fn violation(matrix: &[Real], q: &[Real], z: &[Real]) -> Real {
    let n = q.len();
    let of_row = |i: usize| {
        let w = q[i] + (0..n).map(|j| matrix[i * n + j] * z[j]).sum::<Real>();
        if z[i] > 0.0 { w.abs() } else { (-w).max(0.0) }
    };
    (0..n).map(of_row).fold(0.0, Real::max)
}

/// The same to the last digits: w = 0 where z is not, without what was added; none if that is no solution.
fn polished(matrix: &[Real], q: &[Real], rough: &[Real]) -> Option<Vec<Real>> {
    let n = q.len();
    let largest = rough.iter().copied().fold(0.0, Real::max);
    let on: Vec<usize> = (0..n).filter(|i| rough[*i] > 1e-9 * largest).collect();
    let mut dense = Dense::default();
    let own = dense.start(on.len());
    for (a, i) in on.iter().enumerate() {
        for (b, j) in on.iter().enumerate() {
            own[a * on.len() + b] = matrix[i * n + j];
        }
    }
    dense.factor();
    let mut x: Vec<Real> = on.iter().map(|i| -q[*i]).collect();
    dense.solve(&mut x);
    let mut z = vec![0.0; n];
    for (i, x) in on.iter().zip(&x) {
        z[*i] = *x;
    }
    let near = |(z, rough): (&Real, &Real)| (z - rough).abs() <= 1e-4 * largest && *z >= 0.0;
    z.iter().zip(rough).all(near).then_some(z)
}

/// Rows w − Mz − d z₀ = q of the present basis; columns: w, z, z₀, q.
struct Tableau {
    n: usize,
    width: usize,
    rows: Vec<Real>,
    /// Which column is basic in each row.
    basis: Vec<usize>,
}

impl Tableau {
    fn new(matrix: &[Real], q: &[Real], (scale, added): (Real, Real)) -> Self {
        let n = q.len();
        let width = 2 * n + 2;
        let largest = (0..n).fold(0.0, |most: Real, i| most.max(matrix[i * n + i].abs()));
        let mut rows = vec![0.0; n * width];
        for i in 0..n {
            let row = &mut rows[i * width..(i + 1) * width];
            row[i] = 1.0;
            for j in 0..n {
                row[n + j] = -matrix[i * n + j];
            }
            row[n + i] -= added * largest;
            row[2 * n] = -1.0;
            row[2 * n + 1] = q[i] / scale;
        }
        Self { n, width, rows, basis: (0..n).collect() }
    }

    fn at(&self, i: usize, j: usize) -> Real {
        self.rows[i * self.width + j]
    }

    fn run(mut self, n: usize) -> Option<Vec<Real>> {
        let artificial = 2 * n;
        let lowest = |best: usize, i: usize| {
            if self.at(i, 2 * n + 1) < self.at(best, 2 * n + 1) { i } else { best }
        };
        let mut row = (0..n).fold(0, lowest);
        let mut entering = artificial;
        for _ in 0..50 * (n + 1) {
            let leaving = self.basis[row];
            self.pivot(row, entering);
            self.basis[row] = entering;
            if leaving == artificial {
                return Some(self.solution());
            }
            entering = if leaving < n { leaving + n } else { leaving - n };
            row = self.leaving_row(entering)?;
        }
        None
    }

    /// The row that limits a column as it grows; z₀ leaves as soon as it may.
    fn leaving_row(&self, column: usize) -> Option<usize> {
        let mut best: Option<(usize, Real)> = None;
        for i in 0..self.n {
            let entry = self.at(i, column);
            let largest = (0..2 * self.n).fold(0.0, |most: Real, j| most.max(self.at(i, j).abs()));
            if entry <= SMALL * largest {
                continue;
            }
            let ratio = self.at(i, 2 * self.n + 1).max(0.0) / entry;
            let better = match best {
                None => true,
                Some((k, least)) if (ratio - least).abs() <= 1e-12 * (1.0 + least) => {
                    self.basis[i] == 2 * self.n
                        || (self.basis[k] != 2 * self.n && entry > self.at(k, column))
                }
                Some((_, least)) => ratio < least,
            };
            if better {
                best = Some((i, ratio));
            }
        }
        best.map(|(i, _)| i)
    }

    fn pivot(&mut self, row: usize, column: usize) {
        let width = self.width;
        let pivot = self.at(row, column);
        for j in 0..width {
            self.rows[row * width + j] /= pivot;
        }
        for i in (0..self.n).filter(|i| *i != row) {
            let part = self.at(i, column);
            if part != 0.0 {
                for j in 0..width {
                    let change = part * self.rows[row * width + j];
                    self.rows[i * width + j] -= change;
                }
            }
        }
    }

    fn solution(&self) -> Vec<Real> {
        let mut z = vec![0.0; self.n];
        for (i, column) in self.basis.iter().enumerate() {
            if (self.n..2 * self.n).contains(column) {
                z[column - self.n] = self.at(i, 2 * self.n + 1).max(0.0);
            }
        }
        z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn no_solution_is_said() {
        // w = −z − 1 is never ≥ 0.
        assert_eq!(solve(&[-1.0], &[-1.0]), None);
        assert_eq!(solve(&[2.0], &[-1.0]), Some(vec![0.5]));
        assert_eq!(solve(&[2.0], &[1.0]), Some(vec![0.0]));
    }

    proptest! {
        /// M = BBᵀ, singular where B has fewer columns than rows; q in its range is solvable.
        #[test]
        fn solutions_are_complementary(
            b in prop::collection::vec(-1.0..1.0_f64, 15), x in prop::collection::vec(-1.0..1.0_f64, 3),
        ) {
            let n = 5;
            let matrix: Vec<Real> = (0..n * n)
                .map(|k| (0..3).map(|c| b[(k / n) * 3 + c] * b[(k % n) * 3 + c]).sum())
                .collect();
            let q: Vec<Real> = (0..n).map(|i| (0..3).map(|c| b[i * 3 + c] * x[c]).sum()).collect();
            let z = solve(&matrix, &q).expect("a solution exists: q is in the range of M");
            // Rounding of the terms.
            let slack = 1e-9 * z.iter().copied().fold(1.0, Real::max);
            for i in 0..n {
                let w: Real = q[i] + (0..n).map(|j| matrix[i * n + j] * z[j]).sum::<Real>();
                prop_assert!(w >= -slack && z[i] >= 0.0 && w.min(z[i]) <= slack, "{w} {}", z[i]);
            }
        }
    }
}
