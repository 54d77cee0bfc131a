//! Many boxes at once: new boxes for many leaves, the tree built anew, all pairs that meet.

use super::{NONE, Tree};
use crate::math::Real;
use crate::shapes::Aabb;

impl Tree {
    /// Gives a leaf another box and leaves the boxes above as they are, until [`Tree::refit`].
    pub fn set(&mut self, leaf: u32, aabb: Aabb) {
        self.nodes[leaf as usize].aabb = aabb;
        self.mark(leaf);
    }

    /// Marks a leaf and all above it.
    pub fn mark(&mut self, leaf: u32) {
        self.marks.resize(self.nodes.len(), false);
        let mut index = leaf;
        while index != NONE && !self.marks[index as usize] {
            self.marks[index as usize] = true;
            index = self.nodes[index as usize].parent;
        }
    }

    /// Forgets all marks.
    pub fn unmark(&mut self) {
        self.marks.clear();
    }

    fn is_marked(&self, index: u32) -> bool {
        self.marks.get(index as usize).is_some_and(|mark| *mark)
    }

    /// Makes the marked inner boxes the smallest around their children, and builds the tree anew where it has become bad:
    /// where its inner boxes have grown, against those of the leaves, since it was last built.
    pub fn refit(&mut self) {
        const WORSE: Real = 1.3;
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        order.extend((self.root != NONE).then_some(self.root));
        let mut next = 0;
        while let Some(index) = order.get(next).copied() {
            next += 1;
            let node = &self.nodes[index as usize];
            if !node.is_leaf() {
                let children = node.children;
                order.extend(children.into_iter().filter(|child| self.is_marked(*child)));
            }
        }
        // From below up.
        for index in order.iter().rev() {
            if !self.nodes[*index as usize].is_leaf() {
                self.fit(*index);
            }
        }
        self.order = order;
        self.unmark();
        let looseness = self.measure();
        if self.looseness == 0.0 {
            self.looseness = looseness;
        } else if looseness > WORSE * self.looseness {
            self.rebuild();
            self.looseness = self.measure();
        }
    }

    /// Sum of the sizes of the inner boxes over that of the leaves.
    fn measure(&self) -> Real {
        let mut sums = [0.0; 2];
        self.visit(&mut |node| sums[usize::from(node.is_leaf())] += node.aabb.half_perimeter());
        sums[0] / sums[1]
    }

    /// Builds the tree anew over its leaves, which keep their names: from above down, each time split in the middle of the
    /// longer side of the centres' box.
    fn rebuild(&mut self) {
        let (mut leaves, mut inner) = (Vec::new(), Vec::new());
        let mut stack = vec![self.root];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if node.is_leaf() {
                leaves.push(index);
            } else {
                inner.push(index);
                stack.extend(node.children);
            }
        }
        inner.sort_unstable();
        leaves.sort_unstable();
        self.root = self.build(&mut leaves, &mut inner, NONE);
    }

    fn build(&mut self, leaves: &mut [u32], free: &mut Vec<u32>, parent: u32) -> u32 {
        let index = match (&*leaves, free.pop()) {
            ([only], spare) => {
                free.extend(spare);
                self.nodes[*only as usize].parent = parent;
                return *only;
            }
            // OK because n leaves have n − 1 inner nodes above them, as before.
            (_, spare) => spare.unwrap_or(NONE),
        };
        let cut = self.split(leaves);
        let (first, second) = leaves.split_at_mut(cut);
        let children = [self.build(first, free, index), self.build(second, free, index)];
        let node = &mut self.nodes[index as usize];
        (node.parent, node.children) = (parent, children);
        self.fit(index);
        index
    }

    /// Sorts leaves into two parts; returns where the second begins. Of the ways to cut between bins along the longer side,
    /// the one whose boxes are smallest, weighted by what is in them (Wald, "On fast construction of SAH-based
    /// bounding volume hierarchies", 2007).
    fn split(&self, leaves: &mut [u32]) -> usize {
        const BINS: usize = 8;
        let twice = |leaf: u32| {
            let aabb = &self.nodes[leaf as usize].aabb;
            aabb.min + aabb.max
        };
        let first = twice(leaves[0]);
        let (low, high) = leaves.iter().fold((first, first), |(low, high), leaf| {
            let center = twice(*leaf);
            (low.inf(&center), high.sup(&center))
        });
        let size = high - low;
        let axis = usize::from(size.y > size.x);
        let half = leaves.len() / 2;
        if size[axis] <= 0.0 {
            return half;
        }
        let scale = BINS as Real / size[axis];
        let bin = |leaf: u32| (((twice(leaf)[axis] - low[axis]) * scale) as usize).min(BINS - 1);
        let mut bins: [(usize, Option<Aabb>); BINS] = [(0, None); BINS];
        for leaf in &*leaves {
            let (count, around) = &mut bins[bin(*leaf)];
            let own = self.nodes[*leaf as usize].aabb;
            *count += 1;
            *around = Some(around.map_or(own, |around| around.merged(&own)));
        }
        let (cut, cost) = best_cut(&bins);
        if !cost.is_finite() {
            return half;
        }
        let mut place = 0;
        for k in 0..leaves.len() {
            if bin(leaves[k]) < cut {
                leaves.swap(place, k);
                place += 1;
            }
        }
        place
    }

    /// Calls `found` with the items of every two leaves of this tree whose boxes meet and of which one is marked.
    pub fn pairs(&self, found: &mut dyn FnMut(u32, u32)) {
        let mut stack = Vec::new();
        stack.extend((self.root != NONE).then_some([self.root; 2]));
        while let Some([a, b]) = stack.pop() {
            if a != b {
                self.meet(self, [a, b], &mut stack, found);
            } else if self.is_marked(a) && !self.nodes[a as usize].is_leaf() {
                let [left, right] = self.nodes[a as usize].children;
                stack.extend([[left, left], [right, right], [left, right]]);
            }
        }
    }

    /// The same with a leaf of this tree and one of another.
    pub fn pairs_with(&self, other: &Self, found: &mut dyn FnMut(u32, u32)) {
        let mut stack = Vec::new();
        stack.extend((self.root != NONE && other.root != NONE).then_some([self.root, other.root]));
        while let Some(pair) = stack.pop() {
            self.meet(other, pair, &mut stack, found);
        }
    }

    /// Goes down from two nodes that differ.
    #[inline]
    fn meet(
        &self,
        other: &Self,
        [a, b]: [u32; 2],
        stack: &mut Vec<[u32; 2]>,
        found: &mut dyn FnMut(u32, u32),
    ) {
        let [p, q] = [&self.nodes[a as usize], &other.nodes[b as usize]];
        if !p.aabb.overlaps(&q.aabb) || !(self.is_marked(a) || other.is_marked(b)) {
            return;
        }
        match [p.is_leaf(), q.is_leaf()] {
            [true, true] => found(p.item, q.item),
            [true, false] => stack.extend(q.children.map(|child| [a, child])),
            [false, true] => stack.extend(p.children.map(|child| [child, b])),
            _ if p.aabb.half_perimeter() > q.aabb.half_perimeter() => {
                stack.extend(p.children.map(|child| [child, b]));
            }
            _ => stack.extend(q.children.map(|child| [a, child])),
        }
    }
}

/// The bin before which a cut costs least, and the cost.
fn best_cut(bins: &[(usize, Option<Aabb>)]) -> (usize, Real) {
    let join = |(count, around): (usize, Option<Aabb>), bin: &(usize, Option<Aabb>)| {
        let around = match (around, bin.1) {
            (Some(a), Some(b)) => Some(a.merged(&b)),
            (a, b) => a.or(b),
        };
        (count + bin.0, around)
    };
    let cost = |(count, around): (usize, Option<Aabb>)| {
        around.map_or(Real::INFINITY, |around| count as Real * around.half_perimeter())
    };
    let at = |cut: usize| {
        let side = |bins: &[(usize, Option<Aabb>)]| cost(bins.iter().fold((0, None), join));
        (cut, side(&bins[..cut]) + side(&bins[cut..]))
    };
    let best = |best: (usize, Real), next: (usize, Real)| if next.1 < best.1 { next } else { best };
    (1..bins.len()).map(at).fold((1, Real::INFINITY), best)
}
