//! Pairs of particles within reach of one another, each once, and the sums over them that all of the fluid is made of.
//!
//! Particles stand in the order of their cells, so that a pair is of one row of cells or of two that follow one another.
//! Chunks of whole rows can be worked on at once if they are not neighbours: first the even ones, then the odd ones. What
//! a particle gets is added in the same order whatever the number of threads.

use multiversion::multiversion;

use super::cells::Cells;
use super::kernel::Kernel;
use super::team::Team;
use crate::math::{Real, Vec2};

/// Two numbers of a particle.
pub type Pair = [Real; 2];

/// Whole rows, and the pairs whose first particle is in them.
#[derive(Clone, Debug, Default)]
pub struct Chunk {
    /// First particle.
    start: usize,
    /// One beyond its last.
    end: usize,
    /// One beyond the last that its particles have pairs with.
    reach: usize,
    /// Where the pairs of each of its particles end.
    ends: Vec<u32>,
    /// The second particle of each pair, counted from `start`.
    others: Vec<u32>,
    /// Of each pair, V ∇W at the first particle (1/m).
    slopes: Vec<Pair>,
    /// Of each pair, V W.
    values: Vec<Real>,
}

/// All pairs.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    chunks: Vec<Chunk>,
    used: usize,
    size: usize,
}

/// What a particle has of its neighbours.
#[derive(Clone, Copy, Debug, Default)]
pub struct Around {
    /// Σ V W.
    pub part: Real,
    /// Σ V ∇W (1/m).
    pub slope: Pair,
    /// Σ |V ∇W|²/ρ of the neighbours (m⁻²·m²/kg).
    pub square: Real,
}

/// Particles from which on a chunk has enough.
const CHUNK: usize = 384;

impl Pairs {
    /// Finds all pairs of particles, which stand in the order of the cells.
    pub fn find(
        &mut self,
        cells: &Cells,
        positions: &[Vec2],
        (kernel, area): (&Kernel, Real),
        team: &Team,
    ) {
        self.cut(cells, positions.len());
        let (used, rest) = self.chunks.split_at_mut(self.used);
        rest.iter_mut().for_each(|chunk| chunk.ends.clear());
        each(team, used, &|chunk: &mut Chunk| {
            chunk.gather(cells, positions, kernel.support);
            chunk.weigh(kernel, area);
        });
    }

    /// Cuts the rows into chunks.
    fn cut(&mut self, cells: &Cells, particles: usize) {
        self.used = 0;
        self.size = particles;
        let mut start = 0;
        for (k, row) in cells.rows.iter().enumerate() {
            let end = row.end as usize;
            if end - start < CHUNK && end < particles {
                continue;
            }
            if self.used == self.chunks.len() {
                self.chunks.push(Chunk::default());
            }
            let chunk = &mut self.chunks[self.used];
            let reach = cells.next(k).map_or(end, |next| next.end as usize);
            (chunk.start, chunk.end, chunk.reach) = (start, end, reach);
            self.used += 1;
            start = end;
        }
    }

    /// Sums over the neighbours of each particle; `volume` is 1/ρ of each.
    pub fn sum_around(&self, inverse_density: &[Real], out: &mut [Around], team: &Team) {
        out.fill(Around::default());
        self.each(out, team, &|chunk, out| chunk.around(chunk.of(inverse_density), out));
    }

    /// Σ (p_i + p_j) V ∇W of each particle: against the force that pressures give it, over its area (N/m³).
    pub fn push(&self, pressures: &[Real], out: &mut [Pair], team: &Team) {
        out.fill([0.0; 2]);
        self.each(out, team, &|chunk, out| push(chunk, chunk.of(pressures), out));
    }

    /// Σ (u_i − u_j)·V ∇W of each particle: the rate at which its part of the kernel is filled (1/s).
    pub fn converge(&self, velocities: &[Pair], out: &mut [Real], team: &Team) {
        out.fill(0.0);
        self.each(out, team, &|chunk, out| converge(chunk, chunk.of(velocities), out));
    }

    /// Σ over neighbours of what `give` says of a pair: (first, second, V W, V ∇W) gives what the first gets, the second
    /// gets the opposite.
    pub fn exchange(
        &self,
        give: &(impl Fn(usize, usize, Real, Pair) -> Pair + Sync),
        out: &mut [Pair],
        team: &Team,
    ) {
        out.fill([0.0; 2]);
        self.each(out, team, &|chunk, out| {
            chunk.pairs(|i, j, k| {
                let (first, second) = (chunk.start + i, chunk.start + j);
                let given = give(first, second, chunk.values[k], chunk.slopes[k]);
                for axis in 0..2 {
                    out[i][axis] += given[axis];
                    out[j][axis] -= given[axis];
                }
            });
        });
    }

    /// Takes V W (φ_i − φ_j) from the slopes.
    pub fn lean(&mut self, potential: &[Pair], team: &Team) {
        each(team, &mut self.chunks[..self.used], &|chunk: &mut Chunk| chunk.lean(potential));
    }

    /// Calls with both particles of each pair.
    pub fn visit(&self, mut call: impl FnMut(usize, usize)) {
        for chunk in &self.chunks[..self.used] {
            chunk.pairs(|i, j, _| call(chunk.start + i, chunk.start + j));
        }
    }

    /// Runs `work` for each chunk with its part of a column: the even ones, then the odd ones.
    fn each<T: Send>(
        &self,
        column: &mut [T],
        team: &Team,
        work: &(impl Fn(&Chunk, &mut [T]) + Sync),
    ) {
        let chunks = &self.chunks[..self.used];
        for parity in 0..2 {
            share((chunks, parity), (column, 0), team, work);
        }
    }
}

/// Runs `work` for every second chunk from `first` on; the column begins at particle `base`.
fn share<T: Send>(
    (chunks, first): (&[Chunk], usize),
    (column, base): (&mut [T], usize),
    team: &Team,
    work: &(impl Fn(&Chunk, &mut [T]) + Sync),
) {
    let count = (chunks.len() + 1).saturating_sub(first) / 2;
    if count == 0 {
        return;
    }
    if count == 1 {
        let chunk = &chunks[first];
        work(chunk, &mut column[chunk.start - base..chunk.reach - base]);
        return;
    }
    // An even number of chunks on the left, so that the parity stays.
    let middle = 2 * (count / 2);
    let split = chunks[middle + first].start;
    let (left, right) = column.split_at_mut(split - base);
    let (before, after) = chunks.split_at(middle);
    team.both(
        || share((before, first), (left, base), team, work),
        || share((after, first), (right, split), team, work),
    );
}

/// Runs `work` for each item.
fn each<T: Send>(team: &Team, items: &mut [T], work: &(impl Fn(&mut T) + Sync)) {
    if let [item] = items {
        work(item);
    } else if !items.is_empty() {
        let (left, right) = items.split_at_mut(items.len() / 2);
        team.both(|| each(team, left, work), || each(team, right, work));
    }
}

impl Chunk {
    /// Its part of a column.
    fn of<'a, T>(&self, column: &'a [T]) -> &'a [T] {
        &column[self.start..self.reach]
    }

    /// Collects pairs and the ways between them, from the second to the first.
    fn gather(&mut self, cells: &Cells, positions: &[Vec2], support: Real) {
        self.ends.clear();
        let mut found = 0;
        let first = cells.rows.partition_point(|row| (row.end as usize) <= self.start);
        for k in first..cells.rows.len() {
            let row = cells.rows[k];
            if row.start as usize >= self.end {
                break;
            }
            let next = cells.next(k).map_or(0..0, |next| next.start as usize..next.end as usize);
            let (mut low, mut high, mut own) = (next.start, next.start, row.start as usize);
            for i in row.start as usize..row.end as usize {
                let fast = cells.fast(i);
                while own < row.end as usize && cells.fast(own) <= fast + 1 {
                    own += 1;
                }
                while low < next.end && cells.fast(low) + 1 < fast {
                    low += 1;
                }
                high = high.max(low);
                while high < next.end && cells.fast(high) <= fast + 1 {
                    high += 1;
                }
                self.make_room(found + (own - i) + (high - low));
                for run in [i + 1..own, low..high] {
                    found = self.keep((positions, i), run, (support * support, found));
                }
                self.ends.push(found as u32);
            }
        }
        self.others.truncate(found);
        self.slopes.truncate(found);
    }

    fn make_room(&mut self, pairs: usize) {
        if pairs > self.others.len() {
            let size = pairs + pairs / 8;
            self.others.resize(size, 0);
            self.slopes.resize(size, [0.0; 2]);
        }
    }

    /// Keeps those of a run that are within reach of particle i, without a branch that could be foretold wrongly.
    #[inline]
    fn keep(
        &mut self,
        (positions, i): (&[Vec2], usize),
        run: std::ops::Range<usize>,
        (square, mut found): (Real, usize),
    ) -> usize {
        if run.is_empty() {
            return found;
        }
        let at = positions[i];
        let base = (run.start - self.start) as u32;
        let room = found..found + run.len();
        let (others, ways) = (&mut self.others[room.clone()], &mut self.slopes[room]);
        let mut kept = 0;
        for (k, other) in positions[run].iter().enumerate() {
            let (x, y) = (at.x - other.x, at.y - other.y);
            others[kept] = base + k as u32;
            ways[kept] = [x, y];
            kept += usize::from(x * x + y * y < square);
        }
        found += kept;
        found
    }

    /// From the ways of the pairs, V ∇W and V W.
    fn weigh(&mut self, kernel: &Kernel, area: Real) {
        self.values.resize(self.slopes.len(), 0.0);
        weigh(kernel, area, &mut self.slopes, &mut self.values);
    }

    fn lean(&mut self, potential: &[Pair]) {
        let (own, mut k) = (&potential[self.start..self.reach], 0);
        for (i, end) in self.ends.iter().enumerate() {
            while k < *end as usize {
                let (first, second, weight) =
                    (own[i], own[self.others[k] as usize], self.values[k]);
                for axis in 0..2 {
                    self.slopes[k][axis] -= weight * (first[axis] - second[axis]);
                }
                k += 1;
            }
        }
    }

    /// Calls with both particles of each pair and its number.
    #[inline(always)]
    fn pairs(&self, mut call: impl FnMut(usize, usize, usize)) {
        let mut k = 0;
        for (i, end) in self.ends.iter().enumerate() {
            while k < *end as usize {
                call(i, self.others[k] as usize, k);
                k += 1;
            }
        }
    }

    fn around(&self, inverse_density: &[Real], out: &mut [Around]) {
        self.pairs(|i, j, k| {
            let (value, [x, y]) = (self.values[k], self.slopes[k]);
            let square = x * x + y * y;
            let first = &mut out[i];
            first.part += value;
            first.slope = [first.slope[0] + x, first.slope[1] + y];
            first.square += square * inverse_density[j];
            let second = &mut out[j];
            second.part += value;
            second.slope = [second.slope[0] - x, second.slope[1] - y];
            second.square += square * inverse_density[i];
        });
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn weigh(kernel: &Kernel, area: Real, slopes: &mut [Pair], values: &mut [Real]) {
    for (way, value) in slopes.iter_mut().zip(values) {
        let r = (way[0] * way[0] + way[1] * way[1]).sqrt();
        *value = area * kernel.value(r);
        let slope = area * kernel.slope(r) / r.max(Real::MIN_POSITIVE);
        *way = [way[0] * slope, way[1] * slope];
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn push(chunk: &Chunk, pressures: &[Real], out: &mut [Pair]) {
    let mut start = 0;
    for (i, end) in chunk.ends.iter().enumerate() {
        let own = pressures[i];
        let mut sum = [0.0; 2];
        let run = start..*end as usize;
        for (j, slope) in chunk.others[run.clone()].iter().zip(&chunk.slopes[run]) {
            let both = own + pressures[*j as usize];
            let given = [both * slope[0], both * slope[1]];
            sum = [sum[0] + given[0], sum[1] + given[1]];
            let other = &mut out[*j as usize];
            *other = [other[0] - given[0], other[1] - given[1]];
        }
        out[i] = [out[i][0] + sum[0], out[i][1] + sum[1]];
        start = *end as usize;
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn converge(chunk: &Chunk, velocities: &[Pair], out: &mut [Real]) {
    let mut start = 0;
    for (i, end) in chunk.ends.iter().enumerate() {
        let own = velocities[i];
        let mut sum = 0.0;
        let run = start..*end as usize;
        for (j, slope) in chunk.others[run.clone()].iter().zip(&chunk.slopes[run]) {
            let other = velocities[*j as usize];
            let rate = (own[0] - other[0]) * slope[0] + (own[1] - other[1]) * slope[1];
            sum += rate;
            out[*j as usize] += rate;
        }
        out[i] += sum;
        start = *end as usize;
    }
}
