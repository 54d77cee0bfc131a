//! Anderson's acceleration ("Iterative procedures for nonlinear integral equations", 1965) of what the fluid and the
//! contacts of the bodies tell one another.

use crate::math::{Real, Twist};

/// Earlier turns that are remembered.
const DEPTH: usize = 6;

/// What was told in the turns of a substep, and by how much it was wrong.
#[derive(Clone, Debug, Default)]
pub(super) struct Accelerator {
    told: Vec<Vec<Real>>,
    wrong: Vec<Vec<Real>>,
    weights: Vec<Real>,
    turns: u32,
}

impl Accelerator {
    /// Forgets the turns of the last substep.
    pub fn begin(&mut self) {
        self.turns = 0;
    }

    /// How many turns there were.
    pub fn turns(&self) -> u32 {
        self.turns
    }

    /// Makes room for another turn.
    pub fn clear(&mut self) {
        let place = self.turns as usize % DEPTH;
        for columns in [&mut self.told, &mut self.wrong] {
            columns.resize(DEPTH, Vec::new());
            columns[place].clear();
        }
        self.weights.clear();
        self.turns += 1;
    }

    /// A body of this mass and inertia was told that it would change like this, which was wrong by so much.
    pub fn add(&mut self, told: &Twist, wrong: &Twist, (mass, inertia): (Real, Real)) {
        let place = (self.turns as usize - 1) % DEPTH;
        let flat = |twist: &Twist| [twist.linear.x, twist.linear.y, twist.angular];
        self.told[place].extend(flat(told));
        self.wrong[place].extend(flat(wrong));
        self.weights.extend([mass, mass, inertia]);
    }

    /// What to tell next: the combination of the turns that would be least wrong if all was linear, and what it lacks.
    pub fn next(&self, changes: &mut [Twist]) {
        let last = (self.turns as usize - 1) % DEPTH;
        let known = (self.turns as usize).min(DEPTH);
        let others: Vec<usize> = (0..known).filter(|k| *k != last).collect();
        let weights = self.mix(last, &others);
        let part = |k: usize, n: usize| self.told[k][n] + self.wrong[k][n];
        let mix = |n: usize| {
            let own = part(last, n);
            own + others.iter().zip(&weights).map(|(k, w)| w * (part(*k, n) - own)).sum::<Real>()
        };
        for (k, change) in changes.iter_mut().enumerate() {
            change.linear = crate::math::vec2(mix(3 * k), mix(3 * k + 1));
            change.angular = mix(3 * k + 2);
        }
    }

    /// Weights of the other turns at which the sum of what is wrong is least, in the norm of energy.
    fn mix(&self, last: usize, others: &[usize]) -> Vec<Real> {
        let n = others.len();
        let difference = |k: usize| self.wrong[k].iter().zip(&self.wrong[last]).map(|(a, b)| a - b);
        let dot = |a: &mut dyn Iterator<Item = Real>, b: &mut dyn Iterator<Item = Real>| -> Real {
            a.zip(b).zip(&self.weights).map(|((a, b), weight)| a * b * weight).sum()
        };
        let mut matrix = nalgebra::DMatrix::<Real>::zeros(n, n);
        let mut right = nalgebra::DVector::<Real>::zeros(n);
        for (i, a) in others.iter().enumerate() {
            for (j, b) in others.iter().enumerate() {
                matrix[(i, j)] = dot(&mut difference(*a), &mut difference(*b));
            }
            right[i] = -dot(&mut difference(*a), &mut self.wrong[last].iter().copied());
        }
        // Turns that are nearly the same say nothing of the rest.
        let trace = matrix.trace();
        for i in 0..n {
            matrix[(i, i)] += 1e-12 * trace + Real::MIN_POSITIVE;
        }
        matrix
            .cholesky()
            .map_or_else(|| vec![0.0; n], |factor| factor.solve(&right).as_slice().to_vec())
    }
}
