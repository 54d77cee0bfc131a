//! The symbolic part: which blocks of the factor are filled, kept as long as the graph is the same.

use std::ops::Range;

use super::Link;
use super::order::Elimination;

/// A block below the diagonal that a link has with one of its bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Node of the body.
    pub(super) body: usize,
    /// Index among the blocks below the diagonal.
    pub(super) block: usize,
    /// Whether the link goes before the body, so that the block holds the transposed Jacobian.
    pub(super) transposed: bool,
}

/// The filled blocks of the factor, column by column in the order of elimination.
#[derive(Clone, Debug, Default)]
pub(super) struct Structure {
    pub(super) bodies: usize,
    /// Whether the graph has a loop, be it through the ground, so that rows may depend on one another.
    pub(super) redundant: bool,
    links: Vec<Link>,
    elimination: Elimination,
    /// Column of each node.
    pub(super) columns: Vec<u32>,
    /// Where the blocks of each column begin; one more entry than columns.
    starts: Vec<u32>,
    /// Row of each block below the diagonal, ascending within a column.
    pub(super) rows: Vec<u32>,
    /// The blocks of each link.
    pub(super) places: Vec<[Option<Place>; 2]>,
}

impl Structure {
    /// Prepares for a graph; whether it was another one.
    pub(super) fn analyse(&mut self, bodies: usize, links: &[Link]) -> bool {
        if bodies == self.bodies && links == self.links && !self.starts.is_empty() {
            return false;
        }
        self.bodies = bodies;
        self.links.clear();
        self.links.extend_from_slice(links);
        self.elimination.run(bodies, links);
        self.number();
        let places =
            (bodies..).zip(&self.links).map(|(link, ends)| ends.map(|end| self.place(link, end)));
        self.places = places.collect();
        self.redundant = self.has_loop();
        true
    }

    /// Prepares for a graph whose nodes are bodies only.
    pub(super) fn analyse_edges(&mut self, bodies: usize, edges: impl Iterator<Item = [u32; 2]>) {
        self.bodies = bodies;
        self.links.clear();
        self.places.clear();
        self.elimination.run_edges(bodies, edges);
        self.number();
    }

    /// The block below the diagonal that two different columns share, if it is filled.
    pub(super) fn shared(&self, [a, b]: [u32; 2]) -> Option<usize> {
        let below = self.below(a.min(b) as usize);
        let nth = self.rows[below.clone()].binary_search(&a.max(b)).ok()?;
        Some(below.start + nth)
    }

    /// Number of nodes, hence of columns.
    pub(super) fn len(&self) -> usize {
        self.columns.len()
    }

    /// Node of each column.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.elimination.order
    }

    /// The blocks below the diagonal of a column.
    pub(super) fn below(&self, column: usize) -> Range<usize> {
        self.starts[column] as usize..self.starts[column + 1] as usize
    }

    fn number(&mut self) {
        let Elimination { order, neighbours, .. } = &self.elimination;
        self.columns.resize(order.len(), 0);
        for (column, &node) in (0..).zip(order) {
            self.columns[node as usize] = column;
        }
        self.rows.clear();
        self.starts.clear();
        self.starts.push(0);
        for &node in order {
            let start = self.rows.len();
            self.rows.extend(neighbours[node as usize].iter().map(|&k| self.columns[k as usize]));
            self.rows[start..].sort_unstable();
            self.starts.push(self.rows.len() as u32);
        }
    }

    /// Trees are eliminated from their leaves, one neighbour at a time; each may hang on the ground once.
    fn has_loop(&self) -> bool {
        let on_ground = |&node: &u32| {
            (node as usize)
                .checked_sub(self.bodies)
                .is_some_and(|link| self.links[link].contains(&None))
        };
        let mut hangs: Vec<u32> = self.nodes().iter().map(on_ground).map(u32::from).collect();
        (0..self.len()).any(|column| {
            let below = &self.rows[self.below(column)];
            if let [parent] = *below {
                hangs[parent as usize] += hangs[column];
            }
            below.len() > 1 || hangs[column] > 1
        })
    }

    fn place(&self, link: usize, end: Option<u32>) -> Option<Place> {
        let body = end? as usize;
        let (row, column) = (self.columns[link], self.columns[body]);
        let transposed = row < column;
        let below = self.below(row.min(column) as usize);
        let nth = self.rows[below.clone()].binary_search(&row.max(column)).ok()?;
        Some(Place { body, block: below.start + nth, transposed })
    }
}
