//! L D Lᵀ of a symmetric matrix of 2 × 2 blocks, one block row a node, inside the envelope that Cuthill and McKee's order, reversed,
//! leaves it ("Reducing the bandwidth of sparse symmetric matrices", 1969).

use std::collections::VecDeque;

use crate::math::{Real, Vec2};

/// Where the entries of a matrix stand: fixed by the graph of its nodes.
#[derive(Clone, Debug, Default)]
pub struct Envelope {
    /// Place of each node in the order of elimination.
    place: Vec<u32>,
    /// Node at each place.
    node: Vec<u32>,
    /// First column of each scalar row.
    first: Vec<u32>,
    /// Where each scalar row begins in the values; one more ends the last.
    start: Vec<usize>,
}

/// A matrix in an envelope, and its factors.
#[derive(Clone, Debug, Default)]
pub struct Matrix {
    /// Entries of the lower half, row after row, diagonal last; L once it is factored.
    values: Vec<Real>,
    /// 1/D.
    inverse: Vec<Real>,
    /// Work of a solution.
    work: Vec<Real>,
}

/// A pivot below this part of its diagonal entry says that the matrix is not positive definite.
const SINGULAR: Real = 1e-14;

impl Envelope {
    /// Of a graph of `nodes` nodes, in which the nodes of each clique are tied to one another.
    #[must_use]
    pub fn new<'a>(nodes: usize, cliques: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut beside: Vec<Vec<u32>> = vec![Vec::new(); nodes];
        for clique in cliques {
            for &i in clique {
                beside[i as usize].extend(clique.iter().copied().filter(|&j| j != i));
            }
        }
        for list in &mut beside {
            list.sort_unstable();
            list.dedup();
        }
        let node = reversed_cuthill_mckee(&beside);
        let mut place = vec![0; nodes];
        for (at, &i) in node.iter().enumerate() {
            place[i as usize] = at as u32;
        }
        let (mut first, mut start) = (Vec::with_capacity(2 * nodes), vec![0]);
        for (at, &i) in node.iter().enumerate() {
            let lowest = beside[i as usize].iter().map(|&j| place[j as usize]).min();
            let column = 2 * lowest.unwrap_or(at as u32).min(at as u32);
            for row in [2 * at, 2 * at + 1] {
                first.push(column);
                start.push(start[row] + row + 1 - column as usize);
            }
        }
        Self { place, node, first, start }
    }

    /// Number of entries that factors have.
    #[must_use]
    pub fn size(&self) -> usize {
        self.start.last().copied().unwrap_or(0)
    }

    fn row(&self, row: usize) -> std::ops::Range<usize> {
        self.start[row]..self.start[row + 1]
    }
}

/// Order in which neighbours are near one another: breadth first from a node at the rim, reversed.
fn reversed_cuthill_mckee(beside: &[Vec<u32>]) -> Vec<u32> {
    let mut order = Vec::with_capacity(beside.len());
    let mut seen = vec![false; beside.len()];
    let mut by_degree: Vec<u32> = (0..beside.len() as u32).collect();
    by_degree.sort_by_key(|&i| beside[i as usize].len());
    for &start in &by_degree {
        if seen[start as usize] {
            continue;
        }
        // The last that a walk reaches lies at the rim.
        let rim = walk(beside, start, &mut seen.clone()).last().copied().unwrap_or(start);
        order.extend(walk(beside, rim, &mut seen));
    }
    order.reverse();
    order
}

fn walk(beside: &[Vec<u32>], start: u32, seen: &mut [bool]) -> Vec<u32> {
    let mut found = Vec::new();
    let mut open = VecDeque::from([start]);
    seen[start as usize] = true;
    while let Some(i) = open.pop_front() {
        found.push(i);
        let mut next: Vec<u32> =
            beside[i as usize].iter().copied().filter(|&j| !seen[j as usize]).collect();
        next.sort_by_key(|&j| (beside[j as usize].len(), j));
        next.iter().for_each(|&j| seen[j as usize] = true);
        open.extend(next);
    }
    found
}

impl Matrix {
    /// All entries 0.
    pub fn clear(&mut self, envelope: &Envelope) {
        self.values.clear();
        self.values.resize(envelope.size(), 0.0);
        self.inverse.resize(envelope.first.len(), 0.0);
        self.work.resize(envelope.first.len(), 0.0);
    }

    /// Adds a block (xx, xy, yx, yy) at the row of node i and the column of node j. Of the two blocks of a pair only the one below
    /// the diagonal is looked at, so both may be handed.
    pub fn add(&mut self, envelope: &Envelope, (i, j): (u32, u32), block: [Real; 4]) {
        let (row, column) = (envelope.place[i as usize], envelope.place[j as usize]);
        if column > row {
            return;
        }
        let (row, column) = (2 * row as usize, 2 * column as usize);
        for (a, pair) in block.chunks_exact(2).enumerate() {
            let at = envelope.start[row + a] - envelope.first[row + a] as usize;
            for (b, x) in pair.iter().enumerate().filter(|(b, _)| column + b <= row + a) {
                self.values[at + column + b] += x;
            }
        }
    }

    /// Takes a node out: its rows and columns become those of the identity.
    pub fn pin(&mut self, envelope: &Envelope, node: u32) {
        let at = 2 * envelope.place[node as usize] as usize;
        for row in at..envelope.first.len() {
            let first = envelope.first[row] as usize;
            for column in [at, at + 1].into_iter().filter(|c| (first..=row).contains(c)) {
                let entry = &mut self.values[envelope.start[row] + column - first];
                *entry = if row == column { 1.0 } else { 0.0 };
            }
            if row < at + 2 {
                let range = envelope.row(row);
                let last = range.end - 1;
                self.values[range].fill(0.0);
                self.values[last] = 1.0;
            }
        }
    }

    /// Factors the matrix; false if it is not positive definite.
    pub fn factor(&mut self, envelope: &Envelope) -> bool {
        let Self { values, inverse, .. } = self;
        for i in 0..envelope.first.len() {
            let first = envelope.first[i] as usize;
            let (done, rest) = values.split_at_mut(envelope.start[i]);
            let row = &mut rest[..=i - first];
            let diagonal = row[i - first];
            // U = L D of this row, then L.
            for j in first..i {
                let above = envelope.first[j] as usize;
                let from = above.max(first);
                let other = &done[envelope.start[j]..][from - above..j - above];
                row[j - first] -= dot(&row[from - first..j - first], other);
            }
            let mut pivot = diagonal;
            for j in first..i {
                let u = row[j - first];
                row[j - first] = u * inverse[j];
                pivot -= u * row[j - first];
            }
            if pivot.is_nan() || pivot <= SINGULAR * diagonal {
                return false;
            }
            inverse[i] = 1.0 / pivot;
        }
        true
    }

    /// Solves for one right-hand side, in place.
    pub fn solve(&mut self, envelope: &Envelope, vector: &mut [Vec2]) {
        let Self { values, inverse, work } = self;
        for (at, &i) in envelope.node.iter().enumerate() {
            (work[2 * at], work[2 * at + 1]) = (vector[i as usize].x, vector[i as usize].y);
        }
        for i in 0..work.len() {
            let first = envelope.first[i] as usize;
            let row = &values[envelope.row(i)];
            work[i] -= dot(&row[..i - first], &work[first..i]);
        }
        for (x, inverse) in work.iter_mut().zip(&*inverse) {
            *x *= inverse;
        }
        for i in (0..work.len()).rev() {
            let first = envelope.first[i] as usize;
            let row = &values[envelope.row(i)];
            let (before, x) = work.split_at_mut(i);
            for (y, l) in before[first..].iter_mut().zip(row) {
                *y -= l * x[0];
            }
        }
        for (at, &i) in envelope.node.iter().enumerate() {
            vector[i as usize] = Vec2::new(work[2 * at], work[2 * at + 1]);
        }
    }
}

/// Σ a b, eight sums side by side.
fn dot(a: &[Real], b: &[Real]) -> Real {
    let (left, right) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: Real = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; 8];
    for (x, y) in left.zip(right) {
        for k in 0..8 {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum::<Real>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_solution_solves_its_system_with_and_without_pins() {
        // A ladder of squares, each a clique.
        let cliques: Vec<[u32; 4]> =
            (0..9).map(|k| [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3]).collect();
        let envelope = Envelope::new(20, cliques.iter().map(|c| &c[..]));
        for pinned in [None, Some(7)] {
            let mut dense = vec![vec![0.0; 40]; 40];
            let mut matrix = Matrix::default();
            matrix.clear(&envelope);
            for (k, clique) in cliques.iter().enumerate() {
                for (&i, &j) in clique.iter().flat_map(|i| clique.iter().map(move |j| (i, j))) {
                    let strong = if i == j { 9.0 + k as Real } else { -1.0 };
                    let cross = if i == j { 0.5 } else { Real::from(i) - Real::from(j) };
                    let block = [strong, cross, if i == j { 0.5 } else { -cross }, strong];
                    matrix.add(&envelope, (i, j), block);
                    for (n, x) in block.iter().enumerate() {
                        dense[2 * i as usize + n / 2][2 * j as usize + n % 2] += x;
                    }
                }
            }
            if let Some(node) = pinned {
                matrix.pin(&envelope, node);
            }
            assert!(matrix.factor(&envelope));
            let mut x: Vec<Vec2> = (0..20).map(|i| vec2(Real::from(i), 3.0)).collect();
            if let Some(node) = pinned {
                x[node as usize] = vec2(0.0, 0.0);
            }
            let right = x.clone();
            matrix.solve(&envelope, &mut x);
            for i in (0..20).filter(|i| Some(*i as u32) != pinned) {
                for a in 0..2 {
                    let sum: Real = (0..40).map(|c| dense[2 * i + a][c] * x[c / 2][c % 2]).sum();
                    assert!((sum - right[i][a]).abs() < 1e-12);
                }
            }
        }
    }
}
