//! Dense triangular factors of real and of complex matrices, in room that is kept: nalgebra's own take new room for each
//! matrix.

use nalgebra::ComplexField;

use crate::math::Real;

/// P A = L U by Gaussian elimination with row exchanges; matrices by columns.
#[derive(Clone, Debug, Default)]
pub struct Lu<T> {
    n: usize,
    factors: Vec<T>,
    /// Row exchanged with row k in step k.
    exchanges: Vec<usize>,
}

impl<T: ComplexField<RealField = Real> + Copy> Lu<T> {
    /// Room for a matrix of n columns, to be filled in.
    pub fn start(&mut self, n: usize) -> &mut [T] {
        self.n = n;
        self.factors.clear();
        self.factors.resize(n * n, T::zero());
        &mut self.factors
    }

    /// Factors what was filled in; false: it is singular, or not of numbers.
    pub fn factor(&mut self) -> bool {
        let Self { n, factors, exchanges } = self;
        let n = *n;
        exchanges.clear();
        for k in 0..n {
            let (done, rest) = factors.split_at_mut((k + 1) * n);
            let column = &mut done[k * n..];
            let larger = |best: usize, i: usize| {
                if column[i].norm1() > column[best].norm1() { i } else { best }
            };
            let best = (k..n).fold(k, larger);
            let size = column[best].norm1();
            if size == 0.0 || !size.is_finite() {
                return false;
            }
            exchanges.push(best);
            column.swap(k, best);
            let inverse = T::one() / column[k];
            column[k + 1..].iter_mut().for_each(|x| *x *= inverse);
            for other in rest.chunks_exact_mut(n) {
                other.swap(k, best);
                let part = other[k];
                if part != T::zero() {
                    subtract(&mut other[k + 1..], part, &column[k + 1..]);
                }
            }
        }
        true
    }

    /// Solves for a right-hand side; writes x there.
    pub fn solve(&self, b: &mut [T]) {
        let column = |k: usize| &self.factors[k * self.n..(k + 1) * self.n];
        for (k, best) in self.exchanges.iter().enumerate() {
            // Columns to the left of an exchange were left as they were.
            b.swap(k, *best);
            let part = b[k];
            subtract(&mut b[k + 1..], part, &column(k)[k + 1..]);
        }
        for k in (0..self.n).rev() {
            b[k] /= column(k)[k];
            let part = b[k];
            subtract(&mut b[..k], part, &column(k)[..k]);
        }
    }
}

/// y −= a x.
fn subtract<T: ComplexField + Copy>(y: &mut [T], a: T, x: &[T]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y -= a * *x);
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;

    use super::Lu;

    /// A matrix whose elimination needs exchanges: its first pivot is zero.
    #[test]
    fn real_and_complex_systems() {
        let matrix = [[0.0, 2.0, 1.0], [1.0, -1.0, 0.5], [3.0, 0.25, -2.0]];
        let x = [1.5, -2.0, 0.75];
        let mut lu = Lu::default();
        let into = lu.start(3);
        for (i, row) in matrix.iter().enumerate() {
            row.iter().enumerate().for_each(|(j, a)| into[3 * j + i] = *a);
        }
        assert!(lu.factor());
        let mut b = matrix.map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum());
        lu.solve(&mut b);
        assert!(b.iter().zip(&x).all(|(b, x): (&f64, _)| (b - x).abs() < 1e-14), "{b:?}");
        // The same with i on the diagonal.
        let mut lu = Lu::default();
        let into = lu.start(3);
        let with_i = |i: usize, j: usize| Complex::new(matrix[i][j], f64::from(u8::from(i == j)));
        (0..9).for_each(|k| into[k] = with_i(k % 3, k / 3));
        assert!(lu.factor());
        let mut b = [0, 1, 2].map(|i| (0..3).map(|j| with_i(i, j) * x[j]).sum::<Complex<f64>>());
        lu.solve(&mut b);
        assert!(b.iter().zip(&x).all(|(b, x)| (b - x).norm() < 1e-14), "{b:?}");
        // Two equal rows.
        let mut lu = Lu::default();
        lu.start(2).copy_from_slice(&[1.0, 1.0, 2.0, 2.0]);
        assert!(!lu.factor());
    }
}
