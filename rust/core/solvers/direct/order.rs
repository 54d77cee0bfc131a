//! The order of elimination: minimum degree on the graph of blocks.
//!
//! Rose, "A graph-theoretic study of the numerical solution of sparse positive definite systems of linear
//! equations" (1972): eliminate a node with fewest neighbours, tie its neighbours to one another, and so on. Trees are
//! taken from their leaves and nothing is filled in.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::mem;

use super::Link;

/// The graph that is left while nodes are eliminated. Bodies are the first nodes, links follow.
#[derive(Clone, Debug, Default)]
pub(super) struct Elimination {
    /// Nodes in the order in which they were eliminated.
    pub(super) order: Vec<u32>,
    /// Neighbours of each node, in ascending order; of an eliminated one, those it had then.
    pub(super) neighbours: Vec<Vec<u32>>,
    /// Nodes that may be eliminated, by degree, then number; entries whose degree has changed are stale.
    queue: BinaryHeap<Reverse<(usize, u32)>>,
    done: Vec<bool>,
    /// Nodes whose neighbours are known to be all tied to one another: when such a one goes, no tie is new.
    simplicial: Vec<bool>,
    merged: Vec<u32>,
}

impl Elimination {
    /// Eliminates all nodes of the graph. A link waits until a body of its own is gone: before, its pivot would
    /// be its compliance alone, which may be zero.
    pub(super) fn run(&mut self, bodies: usize, links: &[Link]) {
        self.tie(bodies, links);
        self.eliminate();
    }

    /// Eliminates all nodes of a graph that is given by its edges.
    pub(super) fn run_edges(&mut self, count: usize, edges: impl Iterator<Item = [u32; 2]>) {
        self.clear(count);
        for [a, b] in edges.filter(|[a, b]| a != b) {
            self.neighbours[a as usize].push(b);
            self.neighbours[b as usize].push(a);
        }
        for node in 0..count {
            let own = &mut self.neighbours[node];
            own.sort_unstable();
            own.dedup();
            self.simplicial[node] = own.len() < 2;
            self.queue.push(Reverse((own.len(), node as u32)));
        }
        self.eliminate();
    }

    fn eliminate(&mut self) {
        while let Some(Reverse((degree, node))) = self.queue.pop() {
            let k = node as usize;
            if self.done[k] || self.neighbours[k].len() != degree {
                continue;
            }
            self.done[k] = true;
            self.order.push(node);
            let clique = mem::take(&mut self.neighbours[k]);
            for &other in &clique {
                if self.simplicial[k] {
                    self.untie(other, node);
                } else {
                    self.join(other, node, &clique);
                }
                self.simplicial[other as usize] |=
                    self.neighbours[other as usize].len() + 1 == clique.len();
                // A link that is tied to something has lost a body by now, be it this one.
                self.queue.push(Reverse((self.neighbours[other as usize].len(), other)));
            }
            self.neighbours[k] = clique;
        }
    }

    fn clear(&mut self, count: usize) {
        self.order.clear();
        self.done.clear();
        self.done.resize(count, false);
        self.simplicial.clear();
        self.simplicial.resize(count, false);
        self.neighbours.resize_with(count, Vec::new);
        self.neighbours.iter_mut().for_each(Vec::clear);
    }

    fn tie(&mut self, bodies: usize, links: &[Link]) {
        let count = bodies + links.len();
        self.clear(count);
        for (link, ends) in (bodies as u32..).zip(links) {
            for body in ends.iter().flatten() {
                let own = &mut self.neighbours[link as usize];
                if !own.contains(body) {
                    own.push(*body);
                    self.neighbours[*body as usize].push(link);
                }
            }
            self.neighbours[link as usize].sort_unstable();
        }
        for node in 0..count {
            let degree = self.neighbours[node].len();
            self.simplicial[node] = degree < 2;
            if node < bodies || degree == 0 {
                self.queue.push(Reverse((degree, node as u32)));
            }
        }
    }

    fn untie(&mut self, node: u32, gone: u32) {
        let own = &mut self.neighbours[node as usize];
        if let Ok(place) = own.binary_search(&gone) {
            own.remove(place);
        }
    }

    /// Ties a node to the others of a clique and unties it from the one that is gone.
    fn join(&mut self, node: u32, gone: u32, clique: &[u32]) {
        let own = &mut self.neighbours[node as usize];
        self.merged.clear();
        let (mut i, mut j) = (0, 0);
        while i < own.len() || j < clique.len() {
            let mine = own.get(i).copied().unwrap_or(u32::MAX);
            let theirs = clique.get(j).copied().unwrap_or(u32::MAX);
            let next = mine.min(theirs);
            i += usize::from(mine == next);
            j += usize::from(theirs == next);
            if next != gone && next != node {
                self.merged.push(next);
            }
        }
        mem::swap(own, &mut self.merged);
    }
}
