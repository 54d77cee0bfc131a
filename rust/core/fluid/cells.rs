//! The grid: particles in the order of its cells, rows of cells in one piece each.

use crate::math::{Real, Vec2, floor};

/// A row of cells that are not all empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Which row of the grid it is.
    pub slow: u32,
    /// First particle.
    pub start: u32,
    /// One beyond the last.
    pub end: u32,
}

/// Square cells as wide as the support. Rows lie across the longer side of what is filled, so that there are many.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Lower corner of the grid (m).
    origin: Vec2,
    /// 1/H.
    inverse: Real,
    /// The axis along which rows follow one another: 0 or 1.
    slow: usize,
    /// Cell of each particle: row and place in it, sorted.
    keys: Vec<u64>,
    /// Where each stood before.
    pub order: Vec<u32>,
    /// The rows, in order.
    pub rows: Vec<Row>,
    counts: Vec<u32>,
    unsorted: Vec<u64>,
}

/// Cells a particle up to which particles are sorted by counting.
const ROOMY: Real = 8.0;

/// Cells that may be counted whatever the number of particles.
const FEW: Real = 4096.0;

impl Cells {
    /// Sorts positions into cells of this width (m): `order` then tells where each came from.
    pub fn sort(&mut self, positions: &[Vec2], width: Real) {
        let (low, high) = bounds(positions);
        let size = high - low;
        self.origin = low;
        self.inverse = 1.0 / width;
        self.slow = usize::from(size.y > size.x);
        let mut unsorted = std::mem::take(&mut self.unsorted);
        unsorted.clear();
        unsorted.extend(positions.iter().map(|p| {
            let [slow, fast] = self.cell(p);
            (u64::from(slow) << 32) | u64::from(fast)
        }));
        self.unsorted = unsorted;
        let span = size * self.inverse;
        let cells = (floor(span.x) + 1.0) * (floor(span.y) + 1.0);
        if cells <= ROOMY * positions.len() as Real + FEW {
            self.sort_by_counting(floor(span[1 - self.slow]) as usize + 1, cells as usize);
        } else {
            self.order.clear();
            self.order.extend(0..positions.len() as u32);
            let keys = &self.unsorted;
            self.order.sort_unstable_by_key(|&i| (keys[i as usize], i));
        }
        self.keys.clear();
        self.keys.extend(self.order.iter().map(|&i| self.unsorted[i as usize]));
        self.find_rows();
    }

    fn cell(&self, p: &Vec2) -> [u32; 2] {
        // A cast beyond the range takes its border.
        let at = |axis: usize| ((p[axis] - self.origin[axis]) * self.inverse) as u32;
        [at(self.slow), at(1 - self.slow)]
    }

    fn sort_by_counting(&mut self, width: usize, cells: usize) {
        let number = |key: u64| (key >> 32) as usize * width + (key as u32) as usize;
        self.counts.clear();
        self.counts.resize(cells + 1, 0);
        self.unsorted.iter().for_each(|key| self.counts[number(*key) + 1] += 1);
        let mut sum = 0;
        for count in &mut self.counts {
            sum += *count;
            *count = sum;
        }
        self.order.resize(self.unsorted.len(), 0);
        for (i, key) in self.unsorted.iter().enumerate() {
            let next = &mut self.counts[number(*key)];
            self.order[*next as usize] = i as u32;
            *next += 1;
        }
    }

    fn find_rows(&mut self) {
        self.rows.clear();
        for (i, key) in self.keys.iter().enumerate() {
            let slow = (key >> 32) as u32;
            match self.rows.last_mut() {
                Some(row) if row.slow == slow => row.end = i as u32 + 1,
                _ => self.rows.push(Row { slow, start: i as u32, end: i as u32 + 1 }),
            }
        }
    }

    /// The place of a particle in its row.
    #[inline]
    pub fn fast(&self, i: usize) -> u32 {
        self.keys[i] as u32
    }

    /// The row after row k, if no empty one is between.
    pub fn next(&self, k: usize) -> Option<Row> {
        self.rows.get(k + 1).filter(|row| row.slow == self.rows[k].slow + 1).copied()
    }

    /// Runs of particles whose cells a box may touch.
    pub fn within(&self, low: Vec2, high: Vec2, mut run: impl FnMut(std::ops::Range<usize>)) {
        let ([slow, fast], [last, end]) = (self.cell(&low), self.cell(&high));
        // A box that ends before the grid does not reach it.
        if (0..2).any(|axis| high[axis] < self.origin[axis]) {
            return;
        }
        let first = self.rows.partition_point(|row| row.slow < slow);
        for row in self.rows[first..].iter().take_while(|row| row.slow <= last) {
            let keys = &self.keys[row.start as usize..row.end as usize];
            let from = keys.partition_point(|key| (*key as u32) < fast);
            let to = keys.partition_point(|key| (*key as u32) <= end);
            if from < to {
                run(row.start as usize + from..row.start as usize + to);
            }
        }
    }
}

/// Lowest and highest coordinates.
pub fn bounds(positions: &[Vec2]) -> (Vec2, Vec2) {
    let first = positions.first().copied().unwrap_or_default();
    positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}
