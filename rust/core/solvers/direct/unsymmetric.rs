//! Block L D U of a matrix whose blocks lie symmetrically and differ: rows that push along other directions than those in
//! which they measure, as contacts that slide do.

use super::block::{
    self, Block, Triple, subtract, subtract_product, times, transposed, transposed_times,
};
use super::structure::Structure;
use crate::math::Real;

/// First the blocks of the matrix, then those of its factors.
#[derive(Clone, Debug, Default)]
pub(super) struct Unsymmetric {
    /// Diagonal blocks by column, later their inverses.
    pub(super) diagonal: Vec<Block>,
    /// Blocks below the diagonal.
    pub(super) below: Vec<Block>,
    /// Those at the same places right of the diagonal, transposed.
    pub(super) beside: Vec<Block>,
}

impl Unsymmetric {
    /// Makes room for a matrix of zeros.
    pub(super) fn reset(&mut self, structure: &Structure) {
        self.diagonal.clear();
        self.diagonal.resize(structure.len(), block::ZERO);
        for blocks in [&mut self.below, &mut self.beside] {
            blocks.clear();
            blocks.resize(structure.rows.len(), block::ZERO);
        }
    }

    /// Turns the matrix into its factors.
    pub(super) fn factor(&mut self, structure: &Structure) {
        for column in 0..structure.len() {
            let inverse = inverse(self.diagonal[column]);
            self.diagonal[column] = inverse;
            self.eliminate(structure, column, &inverse);
        }
    }

    /// Takes what a column gives to those after it.
    fn eliminate(&mut self, structure: &Structure, column: usize, pivot: &Block) {
        let range = structure.below(column);
        let rows = &structure.rows[range.clone()];
        let (own, later) = self.below.split_at_mut(range.end);
        let (own_beside, later_beside) = self.beside.split_at_mut(range.end);
        let (own, own_beside) = (&mut own[range.start..], &own_beside[range.start..]);
        let turned = transposed(pivot);
        for block in own.iter_mut() {
            *block = block.map(|row| times(&turned, row));
        }
        for (first, (&row, (block, beside))) in
            rows.iter().zip(own.iter().zip(own_beside)).enumerate()
        {
            subtract_product(&mut self.diagonal[row as usize], block, beside);
            // The rows after this one are all among those of its column, in the same order.
            let mut target = structure.below(row as usize).start;
            let others = rows.iter().zip(own.iter().zip(own_beside)).skip(first + 1);
            for (&other_row, (other, other_beside)) in others {
                while structure.rows[target] != other_row {
                    target += 1;
                }
                subtract_product(&mut later[target - range.end], other, beside);
                subtract_product(&mut later_beside[target - range.end], other_beside, block);
            }
        }
    }

    /// Replaces the right-hand side, by column, by the solution.
    pub(super) fn solve(&self, structure: &Structure, x: &mut [Triple]) {
        for column in 0..structure.len() {
            let value = x[column];
            for k in structure.below(column) {
                subtract(&mut x[structure.rows[k] as usize], times(&self.below[k], value));
            }
        }
        for column in (0..structure.len()).rev() {
            let mut value = x[column];
            for k in structure.below(column) {
                let row = structure.rows[k] as usize;
                subtract(&mut value, transposed_times(&self.beside[k], x[row]));
            }
            x[column] = times(&self.diagonal[column], value);
        }
    }
}

/// Inverse of a block, its largest entries as pivots; directions in which it is singular are left out.
fn inverse(mut a: Block) -> Block {
    let mut inverse = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Column in which each row has its pivot.
    let mut pivots = [None; 3];
    for _ in 0..3 {
        let mut best = (0.0, 0, 0);
        for row in (0..3).filter(|row| pivots[*row].is_none()) {
            for column in (0..3).filter(|column| !pivots.contains(&Some(*column))) {
                let size: Real = a[row][column].abs();
                if size > best.0 {
                    best = (size, row, column);
                }
            }
        }
        let (size, row, column) = best;
        if !(size > 0.0 && size.is_finite()) {
            break;
        }
        pivots[row] = Some(column);
        let pivot = 1.0 / a[row][column];
        (a[row], inverse[row]) = (a[row].map(|x| x * pivot), inverse[row].map(|x| x * pivot));
        for other in (0..3).filter(|other| *other != row) {
            let factor = a[other][column];
            for k in 0..3 {
                a[other][k] -= factor * a[row][k];
                inverse[other][k] -= factor * inverse[row][k];
            }
        }
    }
    let mut sorted = block::ZERO;
    for (row, column) in pivots.iter().enumerate() {
        if let Some(column) = column {
            sorted[*column] = inverse[row];
        }
    }
    sorted
}
