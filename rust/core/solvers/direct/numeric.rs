//! The numeric part: block L D Lᵀ of a symmetric quasi-definite matrix, right-looking.
//!
//! Such a matrix has these factors in any order (Vanderbei, "Symmetric quasidefinite matrices", 1995).

use super::block::{
    self, Block, Pivot, Triple, subtract, subtract_product, subtract_symmetric, times,
    transposed_times,
};
use super::structure::Structure;
use crate::math::Real;

/// First the blocks of the matrix, then those of its factors.
#[derive(Clone, Debug, Default)]
pub(super) struct Numeric {
    /// Diagonal blocks by column; only their lower halves count.
    pub(super) diagonal: Vec<Block>,
    /// Blocks below the diagonal.
    pub(super) below: Vec<Block>,
    pivots: Vec<Pivot>,
    /// The smallest pivot of a link.
    pub(super) least_pivot: Real,
}

impl Numeric {
    /// Makes room for a matrix of zeros.
    pub(super) fn reset(&mut self, structure: &Structure) {
        self.diagonal.clear();
        self.diagonal.resize(structure.len(), block::ZERO);
        self.below.clear();
        self.below.resize(structure.rows.len(), block::ZERO);
    }

    /// Turns the matrix into its factors.
    pub(super) fn factor(&mut self, structure: &Structure) {
        self.pivots.clear();
        self.least_pivot = Real::INFINITY;
        for (column, &node) in structure.nodes().iter().enumerate() {
            let link = node as usize >= structure.bodies;
            let pivot = Pivot::new(&self.diagonal[column], if link { -1.0 } else { 1.0 });
            if link {
                self.least_pivot = self.least_pivot.min(pivot.least());
            }
            self.pivots.push(pivot);
            self.eliminate(structure, column, &pivot);
        }
    }

    /// Takes what a column gives to those after it.
    fn eliminate(&mut self, structure: &Structure, column: usize, pivot: &Pivot) {
        let range = structure.below(column);
        let rows = &structure.rows[range.clone()];
        let (own, later) = self.below.split_at_mut(range.end);
        let own = &mut own[range.start..];
        for block in own.iter_mut() {
            *block = pivot.divide(block);
        }
        for (first, (block, &row)) in own.iter().zip(rows).enumerate() {
            let weighted = pivot.weighted(block);
            subtract_symmetric(&mut self.diagonal[row as usize], &weighted, block);
            // The rows after this one are all among those of its column, in the same order.
            let mut target = structure.below(row as usize).start;
            for (other, &other_row) in own.iter().zip(rows).skip(first + 1) {
                while structure.rows[target] != other_row {
                    target += 1;
                }
                subtract_product(&mut later[target - range.end], other, &weighted);
            }
        }
    }

    /// Replaces the right-hand side, by column, by the solution.
    pub(super) fn solve(&self, structure: &Structure, x: &mut [Triple]) {
        for (column, pivot) in self.pivots.iter().enumerate() {
            let value = pivot.forward(x[column]);
            x[column] = value;
            for k in structure.below(column) {
                subtract(&mut x[structure.rows[k] as usize], times(&self.below[k], value));
            }
        }
        for (column, pivot) in self.pivots.iter().enumerate().rev() {
            let mut value = pivot.scaled(x[column]);
            for k in structure.below(column) {
                let row = structure.rows[k] as usize;
                subtract(&mut value, transposed_times(&self.below[k], x[row]));
            }
            x[column] = pivot.backward(value);
        }
    }
}
