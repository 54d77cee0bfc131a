//! A dynamic tree of boxes.
//!
//! A leaf holds one box, an inner node the smallest box around its two children. A new leaf goes where it
//! makes the borders of all inner boxes grow least, found by going down from the root (the surface area
//! heuristic of Goldsmith and Salmon 1987, in the plane with perimeters; insertion after Bittner, Hapala and
//! Havran, "Incremental BVH construction for ray tracing", 2015); on the way back up, a child and a
//! grandchild change places where that makes a box smaller (tree rotations: Kensler 2008; Catto, "Dynamic
//! bounding volume hierarchies", GDC 2019). So the tree depends on the order of the calls alone.

mod batch;
mod search;

use serde::{Deserialize, Serialize};

pub(super) use search::BoxCast;

use crate::math::Real;
use crate::shapes::Aabb;

/// No node.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Node {
    aabb: Aabb,
    /// Of a free node, the next free one.
    parent: u32,
    /// NONE twice in a leaf, whose item is then in `item`.
    children: [u32; 2],
    item: u32,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.children[0] == NONE
    }
}

/// The tree. Leaves are named by node numbers that stay until the leaf is removed.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    root: u32,
    free: u32,
    /// Sizes of the inner boxes over those of the leaves when the tree was last good; 0: not known.
    #[serde(default)]
    looseness: Real,
    /// Of each node, whether a leaf below it counts as moved; empty: none does.
    #[serde(skip)]
    marks: Vec<bool>,
    #[serde(skip)]
    order: Vec<u32>,
}

// By hand, so that a copy into an old one keeps its memory.
impl Clone for Tree {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, from: &Self) {
        self.nodes.clone_from(&from.nodes);
        (self.root, self.free, self.looseness) = (from.root, from.free, from.looseness);
    }
}

impl Default for Tree {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            root: NONE,
            free: NONE,
            looseness: 0.0,
            marks: Vec::new(),
            order: Vec::new(),
        }
    }
}

/// Building.
impl Tree {
    /// Adds a leaf and returns its node.
    pub fn insert(&mut self, aabb: Aabb, item: u32) -> u32 {
        let leaf = self.allocate(Node { aabb, parent: NONE, children: [NONE; 2], item });
        self.attach(leaf);
        leaf
    }

    /// Removes a leaf.
    pub fn remove(&mut self, leaf: u32) {
        self.detach(leaf);
        self.release(leaf);
    }

    /// Gives a leaf another box, and its place in the tree anew.
    pub fn replace(&mut self, leaf: u32, aabb: Aabb) {
        self.detach(leaf);
        self.nodes[leaf as usize].aabb = aabb;
        self.attach(leaf);
    }

    fn allocate(&mut self, node: Node) -> u32 {
        if self.free == NONE {
            self.nodes.push(node);
            return self.nodes.len() as u32 - 1;
        }
        let index = self.free;
        self.free = self.nodes[index as usize].parent;
        self.nodes[index as usize] = node;
        index
    }

    fn release(&mut self, index: u32) {
        self.nodes[index as usize].parent = self.free;
        self.free = index;
    }

    /// Takes a leaf out of the tree; its parent goes, and its sibling takes the parent's place.
    fn detach(&mut self, leaf: u32) {
        let parent = self.nodes[leaf as usize].parent;
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let Node { parent: grandparent, children, .. } = self.nodes[parent as usize];
        let sibling = children[usize::from(children[0] == leaf)];
        self.nodes[sibling as usize].parent = grandparent;
        self.put_in_place_of(parent, grandparent, sibling);
        self.release(parent);
        let mut index = grandparent;
        while index != NONE {
            let before = self.nodes[index as usize].aabb;
            self.fit(index);
            if self.nodes[index as usize].aabb == before {
                break;
            }
            index = self.nodes[index as usize].parent;
        }
    }

    /// Puts a leaf that is nowhere in the tree beside its best sibling.
    fn attach(&mut self, leaf: u32) {
        let aabb = self.nodes[leaf as usize].aabb;
        let Some(sibling) = self.best_sibling(&aabb) else {
            self.nodes[leaf as usize].parent = NONE;
            self.root = leaf;
            return;
        };
        let grandparent = self.nodes[sibling as usize].parent;
        let merged = self.nodes[sibling as usize].aabb.merged(&aabb);
        let parent = self.allocate(Node {
            aabb: merged,
            parent: grandparent,
            children: [sibling, leaf],
            item: NONE,
        });
        self.nodes[sibling as usize].parent = parent;
        self.nodes[leaf as usize].parent = parent;
        self.put_in_place_of(sibling, grandparent, parent);
        let mut index = grandparent;
        while index != NONE {
            self.fit(index);
            self.rotate(index);
            index = self.nodes[index as usize].parent;
        }
    }

    /// Where `old` hung below `parent`, `new` hangs now.
    fn put_in_place_of(&mut self, old: u32, parent: u32, new: u32) {
        if parent == NONE {
            self.root = new;
            return;
        }
        let children = &mut self.nodes[parent as usize].children;
        children[usize::from(children[0] != old)] = new;
    }

    /// Makes an inner box the smallest around its children.
    fn fit(&mut self, index: u32) {
        let [a, b] = self.nodes[index as usize].children;
        self.nodes[index as usize].aabb = self.boxes(a, b);
    }

    fn boxes(&self, a: u32, b: u32) -> Aabb {
        self.nodes[a as usize].aabb.merged(&self.nodes[b as usize].aabb)
    }
}

/// Keeping the tree good.
impl Tree {
    /// The node beside which a box costs least: what the pair's own box costs, and by how much the boxes above
    /// grow. From the root down, to the child where it may cost less, while one may.
    fn best_sibling(&self, aabb: &Aabb) -> Option<u32> {
        if self.root == NONE {
            return None;
        }
        let size = aabb.half_perimeter();
        let (mut index, mut inherited) = (self.root, 0.0);
        let node = &self.nodes[index as usize];
        let mut direct = node.aabb.merged(aabb).half_perimeter();
        let (mut best, mut best_cost) = (index, direct);
        loop {
            let Node { aabb: around, children, .. } = self.nodes[index as usize];
            if children[0] == NONE {
                return Some(best);
            }
            inherited += direct - around.half_perimeter();
            let measure = |child: u32| {
                let node = &self.nodes[child as usize];
                let merged = node.aabb.merged(aabb).half_perimeter();
                let cost = inherited + merged;
                // Least that anything below the child can cost.
                let bound = if node.is_leaf() {
                    Real::INFINITY
                } else {
                    cost - node.aabb.half_perimeter() + size
                };
                (cost, bound, merged)
            };
            let options = children.map(measure);
            for (child, (cost, ..)) in children.into_iter().zip(options) {
                if cost < best_cost {
                    (best, best_cost) = (child, cost);
                }
            }
            let next = self.closer_child(children, [options[0].1, options[1].1], aabb);
            if options[next].1 >= best_cost {
                return Some(best);
            }
            (index, direct) = (children[next], options[next].2);
        }
    }

    /// The child with the lower bound; of equal ones (both hold the box, say) the one with the nearer centre.
    fn closer_child(&self, children: [u32; 2], bounds: [Real; 2], aabb: &Aabb) -> usize {
        if bounds[0] != bounds[1] {
            return usize::from(bounds[1] < bounds[0]);
        }
        let distance = |child: u32| {
            let other = &self.nodes[child as usize].aabb;
            ((other.min - aabb.min) + (other.max - aabb.max)).norm_squared()
        };
        usize::from(distance(children[1]) < distance(children[0]))
    }

    /// Exchanges a child with a grandchild on the other side, or two grandchildren of different sides, where
    /// that makes the boxes of the children smaller, by the most.
    fn rotate(&mut self, index: u32) {
        let [b, c] = self.nodes[index as usize].children;
        let size = |index: u32| self.nodes[index as usize].aabb.half_perimeter();
        let below = |index: u32| self.nodes[index as usize].children;
        let (mut gain, mut swap) = (0.0, None);
        for (child, other) in [(b, c), (c, b)] {
            if self.nodes[other as usize].is_leaf() {
                continue;
            }
            let [f, g] = below(other);
            for (lifted, stays) in [(f, g), (g, f)] {
                let saved = size(other) - self.boxes(child, stays).half_perimeter();
                if saved > gain {
                    (gain, swap) = (saved, Some((child, lifted)));
                }
            }
        }
        if !self.nodes[b as usize].is_leaf() && !self.nodes[c as usize].is_leaf() {
            let ([d, e], [f, g]) = (below(b), below(c));
            for (moved, other) in [(f, g), (g, f)] {
                let [b_new, c_new] = [self.boxes(d, moved), self.boxes(e, other)];
                let saved = size(b) + size(c) - b_new.half_perimeter() - c_new.half_perimeter();
                if saved > gain {
                    (gain, swap) = (saved, Some((e, moved)));
                }
            }
        }
        if let Some((one, other)) = swap {
            self.exchange(index, one, other);
        }
    }

    /// Exchanges two subtrees below `index` (children or grandchildren of it) and fits what they hang below.
    fn exchange(&mut self, index: u32, one: u32, other: u32) {
        let [above_one, above_other] = [one, other].map(|node| self.nodes[node as usize].parent);
        self.put_in_place_of(one, above_one, other);
        self.put_in_place_of(other, above_other, one);
        self.nodes[one as usize].parent = above_other;
        self.nodes[other as usize].parent = above_one;
        for parent in [above_one, above_other] {
            if parent != index {
                self.fit(parent);
            }
        }
    }
}

/// Asking.
impl Tree {
    /// Calls `found` with the item of every leaf whose box meets `aabb`, until it says no. `stack` is working
    /// memory, returned empty. Whether it went to the end.
    pub fn query(
        &self,
        aabb: &Aabb,
        stack: &mut Vec<u32>,
        found: &mut dyn FnMut(u32) -> bool,
    ) -> bool {
        stack.clear();
        if self.root != NONE {
            stack.push(self.root);
        }
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.aabb.overlaps(aabb) {
                continue;
            }
            if !node.is_leaf() {
                stack.extend(node.children);
            } else if !found(node.item) {
                stack.clear();
                return false;
            }
        }
        true
    }

    /// Sum of the half perimeters of all inner boxes (m): what the heuristic keeps low.
    pub fn cost(&self) -> Real {
        let mut cost = 0.0;
        self.visit(&mut |node| {
            if !node.is_leaf() {
                cost += node.aabb.half_perimeter();
            }
        });
        cost
    }

    /// Number of levels.
    pub fn height(&self) -> usize {
        let mut level = Vec::new();
        level.extend((self.root != NONE).then_some(self.root));
        let mut height = 0;
        while !level.is_empty() {
            height += 1;
            let nodes = level.iter().map(|&index| &self.nodes[index as usize]);
            level = nodes.filter(|node| !node.is_leaf()).flat_map(|node| node.children).collect();
        }
        height
    }

    fn visit(&self, see: &mut dyn FnMut(&Node)) {
        let mut stack = Vec::new();
        stack.extend((self.root != NONE).then_some(self.root));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            see(node);
            if !node.is_leaf() {
                stack.extend(node.children);
            }
        }
    }

    /// Number of leaves, if every inner box is the smallest around its children and every node knows its parent.
    pub fn check(&self) -> Option<usize> {
        let (mut leaves, mut good) = (0, self.root == NONE || self.parent(self.root) == NONE);
        self.visit(&mut |node| {
            if node.is_leaf() {
                leaves += 1;
                return;
            }
            let [a, b] = node.children;
            good &= self.parent(a) == self.parent(b) && node.aabb == self.boxes(a, b);
            good &= std::ptr::eq(&raw const self.nodes[self.parent(a) as usize], node);
        });
        good.then_some(leaves)
    }

    fn parent(&self, index: u32) -> u32 {
        self.nodes[index as usize].parent
    }
}
