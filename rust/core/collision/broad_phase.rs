//! Which boxes meet: the pairs of colliders that the narrow phase looks at.

use serde::{Deserialize, Serialize};

use super::tree::{BoxCast, Tree};
use crate::math::{Real, Vec2, vec2};
use crate::shapes::Aabb;

/// No free proxy.
const NONE: u32 = u32::MAX;

/// Names a box in a [`BroadPhase`]: small numbers, used again once the box is removed. For tables beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ProxyId(pub u32);

/// One box. A free place holds the number of the next free one in `leaf`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Proxy {
    fat: Aabb,
    /// The fat box of the last search for pairs: what met it then is known. Nothing, if all that it meets is to be found.
    before: Aabb,
    leaf: u32,
    /// Whether it is of those that move, which is also the number of its tree.
    moving: bool,
    /// Whether it is in the list of those that moved.
    moved: bool,
}

/// Meets nothing. (Infinities could not be serialised as text.)
const NOTHING: Aabb = Aabb { min: vec2(Real::MAX, Real::MAX), max: vec2(Real::MIN, Real::MIN) };

/// Boxes along the axes, and which of them meet.
///
/// Every box is kept a margin larger than told ("fat"), so that most small motions change nothing. What moves
/// and what stands still are in two trees, since what stands still is never looked at for its own sake. All
/// answers come in an order that depends on the order of the calls alone.
#[derive(Debug, Serialize, Deserialize)]
pub struct BroadPhase {
    /// What stands still; what moves.
    trees: [Tree; 2],
    proxies: Vec<Proxy>,
    free: u32,
    moved: Vec<ProxyId>,
    /// New boxes that the trees do not know yet.
    #[serde(skip)]
    posted: Vec<(ProxyId, Aabb)>,
    #[serde(skip)]
    stack: Vec<u32>,
    /// What has changed since a copy was made that [`BroadPhase::save_into`] keeps up; none: that knows nothing yet.
    #[serde(skip)]
    log: Option<Vec<Edit>>,
}

/// A change of the boxes.
#[derive(Clone, Copy, Debug)]
enum Edit {
    Replace(ProxyId, Aabb),
    Touch(ProxyId),
    /// The list of those that moved was emptied.
    Drain,
}

// By hand, so that a copy into an old one keeps its memory.
impl Clone for BroadPhase {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, from: &Self) {
        self.trees.clone_from(&from.trees);
        self.proxies.clone_from(&from.proxies);
        self.moved.clone_from(&from.moved);
        self.free = from.free;
        self.log = None;
    }
}

impl Default for BroadPhase {
    fn default() -> Self {
        Self {
            trees: Default::default(),
            proxies: Vec::new(),
            free: NONE,
            moved: Vec::new(),
            posted: Vec::new(),
            stack: Vec::new(),
            log: None,
        }
    }
}

/// Keeping boxes.
impl BroadPhase {
    /// Adds a box, kept `margin` (m) larger on every side. It counts as moved.
    pub fn insert(&mut self, tight: &Aabb, margin: Real, moving: bool) -> ProxyId {
        self.log = None;
        let fat = tight.grown(margin);
        let id = if self.free == NONE { self.proxies.len() as u32 } else { self.free };
        let leaf = self.trees[usize::from(moving)].insert(fat, id);
        if self.free == NONE {
            self.proxies.push(Proxy { fat, before: NOTHING, leaf, moving, moved: false });
        } else {
            let proxy = &mut self.proxies[id as usize];
            self.free = proxy.leaf;
            *proxy = Proxy { fat, before: NOTHING, leaf, moving, moved: proxy.moved };
        }
        self.touch(ProxyId(id));
        ProxyId(id)
    }

    /// Removes a box. The caller drops its pairs.
    pub fn remove(&mut self, id: ProxyId) {
        self.log = None;
        let Proxy { leaf, moving, moved, .. } = *self.proxy(id);
        self.trees[usize::from(moving)].remove(leaf);
        // If it moved it stays in the list, and meets nothing.
        self.proxies[id.0 as usize] =
            Proxy { fat: NOTHING, before: NOTHING, leaf: self.free, moving, moved };
        self.free = id.0;
    }

    /// Tells where a box is now: the smallest box around a body, or around all of its way through a step.
    /// Nothing happens while that lies in the fat box, unless the fat box is more than three margins too large
    /// somewhere. Returns whether the fat box changed; then it counts as moved.
    pub fn update(&mut self, id: ProxyId, tight: &Aabb, margin: Real) -> bool {
        let fits = self.fits(id, (tight, tight), margin);
        if !fits {
            self.replace(id, tight.grown(margin));
        }
        !fits
    }

    /// The same for one of many, which is expected to go on by `ahead` (m); the fat box then spans that way as well, so that the next
    /// few steps change nothing. What is asked before [`BroadPhase::settle`] may miss it.
    pub fn post(&mut self, id: ProxyId, tight: &Aabb, margin: Real, ahead: Vec2) {
        let shifted = |by: Vec2| Aabb { min: tight.min + by, max: tight.max + by };
        let onward = tight.merged(&shifted(ahead));
        if !self.fits(id, (tight, &onward.merged(&shifted(-ahead))), margin) {
            self.posted.push((id, onward.grown(margin)));
        }
    }

    /// Whether a fat box holds a tight one and is not more than three margins larger than it has to be for a loose one.
    fn fits(&self, id: ProxyId, (tight, loose): (&Aabb, &Aabb), margin: Real) -> bool {
        const LOOSEST: Real = 4.0;
        let fat = &self.proxy(id).fat;
        fat.contains_box(tight) && loose.grown(LOOSEST * margin).contains_box(fat)
    }

    /// Takes in what was posted. A few boxes get new places in the trees; where many move, the trees keep their form and all
    /// boxes above are made to fit in one go.
    pub fn settle(&mut self) {
        let mut posted = std::mem::take(&mut self.posted);
        if self.are_many(posted.len()) {
            self.log = None;
            for (id, fat) in posted.drain(..) {
                let Proxy { leaf, moving, .. } = *self.proxy(id);
                self.trees[usize::from(moving)].set(leaf, fat);
                self.proxies[id.0 as usize].fat = fat;
                self.count_as_moved(id);
            }
            self.trees.iter_mut().for_each(Tree::refit);
        }
        posted.drain(..).for_each(|(id, fat)| self.replace(id, fat));
        self.posted = posted;
    }

    /// Whether so many boxes are better seen together than one by one.
    fn are_many(&self, boxes: usize) -> bool {
        const PART: usize = 16;
        PART * boxes > self.proxies.len()
    }

    fn replace(&mut self, id: ProxyId, fat: Aabb) {
        let Proxy { leaf, moving, .. } = *self.proxy(id);
        self.trees[usize::from(moving)].replace(leaf, fat);
        self.proxies[id.0 as usize].fat = fat;
        self.note(Edit::Replace(id, fat));
        self.count_as_moved(id);
    }

    /// Counts a box among those that move, or among those that stand still. If it changes sides it counts as
    /// moved.
    pub fn set_moving(&mut self, id: ProxyId, moving: bool) {
        let Proxy { fat, leaf, moving: before, .. } = *self.proxy(id);
        if moving == before {
            return;
        }
        self.log = None;
        self.trees[usize::from(before)].remove(leaf);
        let leaf = self.trees[usize::from(moving)].insert(fat, id.0);
        let proxy = &mut self.proxies[id.0 as usize];
        (proxy.leaf, proxy.moving) = (leaf, moving);
        self.touch(id);
    }

    /// Makes all pairs of a box be found again: after its filter changed, say.
    pub fn touch(&mut self, id: ProxyId) {
        self.proxies[id.0 as usize].before = NOTHING;
        self.count_as_moved(id);
        self.note(Edit::Touch(id));
    }

    fn count_as_moved(&mut self, id: ProxyId) {
        let proxy = &mut self.proxies[id.0 as usize];
        if !proxy.moved {
            proxy.moved = true;
            self.moved.push(id);
        }
    }

    fn note(&mut self, edit: Edit) {
        // Beyond that a copy of all is cheaper than what changed.
        let most = self.proxies.len() / 16;
        if let Some(log) = &mut self.log {
            log.push(edit);
            if log.len() > most {
                self.log = None;
            }
        }
    }

    /// Makes `copy` a copy of this, to the last bit. If it is the one that was made last, of a broad phase in which
    /// little has changed since, the cost goes with what has changed.
    pub fn save_into(&mut self, copy: &mut Self) {
        match self.log.take() {
            Some(mut log) => {
                log.drain(..).for_each(|edit| copy.repeat(edit));
                self.log = Some(log);
            }
            None => {
                copy.clone_from(self);
                self.log = Some(Vec::new());
            }
        }
    }

    fn repeat(&mut self, edit: Edit) {
        match edit {
            Edit::Replace(id, fat) => self.replace(id, fat),
            Edit::Touch(id) => self.touch(id),
            Edit::Drain => self.forget_moved(),
        }
    }

    fn forget_moved(&mut self) {
        for id in self.moved.drain(..) {
            let proxy = &mut self.proxies[id.0 as usize];
            proxy.moved = false;
            proxy.before = proxy.fat;
        }
    }

    fn proxy(&self, id: ProxyId) -> &Proxy {
        &self.proxies[id.0 as usize]
    }
}

/// Asking.
impl BroadPhase {
    /// Calls `found` with every pair of fat boxes that meet and did not in the last call, of which at least one is of those that move,
    /// and that `allow` allows. Each pair comes once, the smaller number first. Pairs that met before come again only after
    /// [`BroadPhase::touch`] of one of them. The cost goes with what moved.
    pub fn find_pairs(
        &mut self,
        mut allow: impl FnMut(ProxyId, ProxyId) -> bool,
        mut found: impl FnMut(ProxyId, ProxyId),
    ) {
        if self.are_many(self.moved.len()) {
            self.find_many(&mut allow, &mut found);
        } else {
            self.find_each(&mut allow, &mut found);
        }
        if !self.moved.is_empty() {
            self.forget_moved();
            self.note(Edit::Drain);
        }
    }

    /// Goes down both trees with all that moved at once.
    fn find_many(
        &mut self,
        allow: &mut impl FnMut(ProxyId, ProxyId) -> bool,
        found: &mut impl FnMut(ProxyId, ProxyId),
    ) {
        let Self { trees, proxies, moved, .. } = self;
        // What was removed since is in no tree.
        let there = |proxy: &Proxy| proxy.fat.min.x <= proxy.fat.max.x;
        for proxy in moved.iter().map(|id| proxies[id.0 as usize]).filter(there) {
            trees[usize::from(proxy.moving)].mark(proxy.leaf);
        }
        let mut see = |a: u32, b: u32| {
            let (a, b) = (ProxyId(a.min(b)), ProxyId(a.max(b)));
            if !met_before(proxies, [a, b]) && allow(a, b) {
                found(a, b);
            }
        };
        let [still, moving] = &*trees;
        moving.pairs(&mut see);
        moving.pairs_with(still, &mut see);
        trees.iter_mut().for_each(Tree::unmark);
    }

    /// Asks the trees for each that moved.
    fn find_each(
        &mut self,
        allow: &mut impl FnMut(ProxyId, ProxyId) -> bool,
        found: &mut impl FnMut(ProxyId, ProxyId),
    ) {
        let Self { trees, proxies, moved, stack, .. } = self;
        for &id in &*moved {
            let Proxy { fat, moving, .. } = proxies[id.0 as usize];
            let mut see = |other: u32| {
                // If both moved, the one with the smaller number finds the pair.
                let twice = proxies[other as usize].moved && other <= id.0;
                let pair = (id.min(ProxyId(other)), id.max(ProxyId(other)));
                if !twice && !met_before(proxies, pair.into()) && allow(pair.0, pair.1) {
                    found(pair.0, pair.1);
                }
                true
            };
            for tree in &trees[usize::from(!moving)..] {
                tree.query(&fat, stack, &mut see);
            }
        }
    }

    /// Whether two fat boxes meet: while they do, a pair is kept.
    #[must_use]
    pub fn overlaps(&self, a: ProxyId, b: ProxyId) -> bool {
        self.proxy(a).fat.overlaps(&self.proxy(b).fat)
    }

    /// Whether a box counts as moved since the last search for pairs.
    #[must_use]
    pub fn has_moved(&self, id: ProxyId) -> bool {
        self.proxy(id).moved
    }

    /// Whether any does.
    #[must_use]
    pub fn has_any_moved(&self) -> bool {
        !self.moved.is_empty()
    }

    /// The fat box.
    #[must_use]
    pub fn fat_box(&self, id: ProxyId) -> &Aabb {
        &self.proxy(id).fat
    }

    /// Whether the box is of those that move.
    #[must_use]
    pub fn is_moving(&self, id: ProxyId) -> bool {
        self.proxy(id).moving
    }

    /// Calls `found` with every box that meets `aabb` (fat), until it says no.
    pub fn query(&self, aabb: &Aabb, found: &mut dyn FnMut(ProxyId) -> bool) {
        let mut stack = Vec::new();
        let mut see = |item| found(ProxyId(item));
        // Through the second only if nobody said no in the first.
        let _ = self.trees.iter().all(|tree| tree.query(aabb, &mut stack, &mut see));
    }

    /// Moves a box (of half extents 0: a point) along a translation and calls `found` with those fat boxes that
    /// it meets, and with the fraction of the translation up to which is looked. It returns the fraction up to
    /// which to look from now on: that of a hit, or the one it was given; −1 ends the search. Nearer boxes tend
    /// to come first. Returns the fraction up to which was looked in the end.
    pub fn cast(
        &self,
        (origin, half_extents): (Vec2, Vec2),
        translation: Vec2,
        found: &mut dyn FnMut(ProxyId, Real) -> Real,
    ) -> Real {
        let cast = BoxCast { origin, translation, half_extents };
        let mut see = |item, limit| found(ProxyId(item), limit);
        self.trees.iter().fold(1.0, |limit, tree| tree.cast(&cast, limit, &mut see))
    }

    /// Calls `found` with those fat boxes that are within `limit` (m) of a box, and with the distance up to which
    /// is looked; it returns that from now on, as that of [`BroadPhase::cast`] does.
    pub fn nearest(
        &self,
        aabb: &Aabb,
        limit: Real,
        found: &mut dyn FnMut(ProxyId, Real) -> Real,
    ) -> Real {
        let mut see = |item, limit| found(ProxyId(item), limit);
        self.trees.iter().fold(limit, |limit, tree| tree.nearest(aabb, limit, &mut see))
    }

    /// How good the trees are.
    #[must_use]
    pub fn quality(&self) -> TreeQuality {
        let [still, moving] = &self.trees;
        TreeQuality {
            cost: [still.cost(), moving.cost()],
            height: [still.height(), moving.height()],
            leaves: [still.check(), moving.check()],
        }
    }
}

/// Whether two fat boxes met in the last search for pairs.
fn met_before(proxies: &[Proxy], pair: [ProxyId; 2]) -> bool {
    let [a, b] = pair.map(|id| &proxies[id.0 as usize].before);
    a.overlaps(b)
}

/// How good the trees are, of what stands still and of what moves. For tests and tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeQuality {
    /// Sum of width + height of all inner boxes (m).
    pub cost: [Real; 2],
    /// Number of levels.
    pub height: [usize; 2],
    /// Number of boxes; None if a box in the tree is not the smallest around those below it.
    pub leaves: [Option<usize>; 2],
}
