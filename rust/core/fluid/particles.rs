//! The particles of all fluids of a world: one column a quantity, in the order of cells.

use serde::{Deserialize, Serialize};

use crate::math::{Real, Vec2};

/// Columns of the particles. Their order changes from step to step; the identity of each does not.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles {
    /// Positions (m).
    pub positions: Vec<Vec2>,
    /// Velocities (m/s).
    pub velocities: Vec<Vec2>,
    /// Pressures (Pa) that keep the density.
    pub pressures: Vec<Real>,
    /// Pressures (Pa) that keep the divergence.
    pub relaxing: Vec<Real>,
    /// Densities over those at rest.
    pub compressions: Vec<Real>,
    /// Number of the fluid that each is of.
    pub kinds: Vec<u32>,
    /// Which particle it is; younger ones have higher numbers.
    pub ids: Vec<u64>,
}

impl Clone for Particles {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// Without allocation where there is room.
    fn clone_from(&mut self, other: &Self) {
        self.positions.clone_from(&other.positions);
        self.velocities.clone_from(&other.velocities);
        self.pressures.clone_from(&other.pressures);
        self.relaxing.clone_from(&other.relaxing);
        self.compressions.clone_from(&other.compressions);
        self.kinds.clone_from(&other.kinds);
        self.ids.clone_from(&other.ids);
    }
}

impl Particles {
    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Adds a particle that nothing presses on.
    pub fn push(&mut self, (position, velocity): (Vec2, Vec2), kind: u32, id: u64) {
        self.positions.push(position);
        self.velocities.push(velocity);
        self.pressures.push(0.0);
        self.relaxing.push(0.0);
        self.compressions.push(1.0);
        self.kinds.push(kind);
        self.ids.push(id);
    }

    /// Keeps those that `keep` says yes to, in their order.
    pub fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        fn filter<T>(column: &mut Vec<T>, keep: &impl Fn(usize) -> bool) {
            let mut place = 0;
            column.retain(|_| {
                place += 1;
                keep(place - 1)
            });
        }
        filter(&mut self.positions, &keep);
        filter(&mut self.velocities, &keep);
        filter(&mut self.pressures, &keep);
        filter(&mut self.relaxing, &keep);
        filter(&mut self.compressions, &keep);
        filter(&mut self.kinds, &keep);
        filter(&mut self.ids, &keep);
    }

    /// Places of the particles of a fluid, oldest first.
    #[must_use]
    pub fn of(&self, kind: u32) -> Vec<usize> {
        let mut places: Vec<_> = (0..self.len()).filter(|&i| self.kinds[i] == kind).collect();
        places.sort_unstable_by_key(|&i| self.ids[i]);
        places
    }

    /// Brings them into a new order: the particle at place `order[k]` goes to place k.
    pub(super) fn reorder(&mut self, order: &[u32], spare: &mut Spare) {
        spare.vectors.reorder(&mut self.positions, order);
        spare.vectors.reorder(&mut self.velocities, order);
        spare.numbers.reorder(&mut self.pressures, order);
        spare.numbers.reorder(&mut self.relaxing, order);
        spare.kinds.reorder(&mut self.kinds, order);
        spare.ids.reorder(&mut self.ids, order);
    }
}

/// Columns that others are reordered into.
#[derive(Clone, Debug, Default)]
pub(super) struct Spare {
    vectors: Column<Vec2>,
    numbers: Column<Real>,
    kinds: Column<u32>,
    ids: Column<u64>,
}

#[derive(Clone, Debug, Default)]
struct Column<T>(Vec<T>);

impl<T: Copy> Column<T> {
    fn reorder(&mut self, column: &mut Vec<T>, order: &[u32]) {
        self.0.clear();
        self.0.extend(order.iter().map(|&i| column[i as usize]));
        std::mem::swap(&mut self.0, column);
    }
}
