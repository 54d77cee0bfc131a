//! The rows of an island's links: by factors of all at once, or by sweeps where those would cost too much.

use super::direct::{Factor, Link, Rows, Triple};
use super::relaxed::Relaxed;
use crate::constraints::Velocity;
use crate::math::{Real, Twist};

/// Solves J M⁻¹ Jᵀ λ + Σ λ = b on the links of an island.
#[derive(Clone, Debug, Default)]
pub struct LinkSolver {
    factor: Factor,
    relaxed: Relaxed,
    by_sweeps: bool,
}

/// How hard to try.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Sweeps to and fro, where it sweeps.
    pub sweeps: u32,
    /// Largest error of a row, in parts of the largest right-hand side, where it does not.
    pub accuracy: Real,
}

/// Block products a link from which on sweeps are cheaper: a chain or tree takes 3, a square lattice of pinned disks of 10 × 10
/// takes 32, of 30 × 30 215, of 60 × 60 470. At 30 × 30 a substep takes 1.9 µs a link by factors, with gaps of rounding, and
/// 2.4 µs by sweeps, which leave 25 mm; at 60 × 60 8 µs and 3 µs.
const DEAR: usize = 250;

impl LinkSolver {
    /// Prepares for the links of so many bodies. Cheap if they are those of last time.
    pub fn analyse(&mut self, bodies: usize, links: &[Link]) {
        if self.factor.analyse(bodies, links) {
            self.by_sweeps = self.factor.work() > DEAR * links.len();
        }
    }

    /// Whether sweeps solve the rows, hence only approximately.
    #[must_use]
    pub fn by_sweeps(&self) -> bool {
        self.by_sweeps
    }

    /// Takes rows, one item a link as analysed, on bodies of these inverse masses.
    pub fn prepare(&mut self, bodies: &[Velocity], links: &[Link], rows: &[Rows]) {
        if self.by_sweeps {
            self.relaxed.prepare(bodies, links, rows);
        } else {
            self.factor.factor(bodies, rows);
        }
    }

    /// Solves for λ near 0 and writes v = M⁻¹ Jᵀ λ.
    pub fn solve(
        &mut self,
        b: &[Triple],
        effort: Effort,
        impulses: &mut [Triple],
        twists: &mut [Twist],
    ) {
        if self.by_sweeps {
            self.relaxed.solve(b, effort.sweeps, impulses, twists);
        } else {
            impulses.fill([0.0; 3]);
            self.factor.solve_to(effort.accuracy, b, impulses, twists);
        }
    }
}
