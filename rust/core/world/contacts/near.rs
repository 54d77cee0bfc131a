//! Pairs of colliders whose boxes meet, and their manifolds.

use serde::{Deserialize, Serialize};

use super::Contacts;
use crate::body::BodyHandle;
use crate::collision::{Frame, Manifold, ProxyId};
use crate::constraints::contact::{Memory, Touch};
use crate::math::{Real, vec2};

/// What a pair does when it touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::world) enum Kind {
    /// It resists.
    Solid,
    /// It resists from one side; whether it does now.
    OneWay { solid: bool },
    /// It only notices.
    Sensor,
}

/// Two colliders whose boxes meet.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::world) struct Near {
    pub proxies: [ProxyId; 2],
    pub touch: Touch,
    pub kind: Kind,
    /// Whether it touched after the last step.
    pub touching: bool,
    /// Where its patches begin, and how many there are.
    pub first: u32,
    pub count: u32,
    /// How they stood to one another when they were found apart.
    #[serde(skip)]
    pub apart: Apart,
}

/// Where B stood in the frame of A when the two had at least a gap (m). What is known of a gap holds, less what they have moved
/// against one another since, so that most pairs need no narrow phase. Nothing but time depends on it.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Apart {
    place: Frame,
    gap: Real,
}

impl Default for Apart {
    fn default() -> Self {
        Self::new(Frame::IDENTITY, Real::NEG_INFINITY)
    }
}

impl Apart {
    /// Of a place and a gap; −∞ if none is known.
    pub fn new(place: Frame, gap: Real) -> Self {
        Self { place, gap }
    }

    /// Whether the gap is still above `margin` where B stands now; no point of B is farther than `reach` from its origin.
    pub fn holds(&self, place: &Frame, reach: Real, margin: Real) -> bool {
        let way = place.position - self.place.position;
        let (now, then) = (place.rot, self.place.rot);
        // Length of the chord through which a point at a distance of 1 turns.
        let turn = vec2(now.cos - then.cos, now.sin - then.sin);
        let left = self.gap - margin - way.norm();
        // Rounding of places decides nothing.
        left > 0.0 && turn.norm() * reach < left * (1.0 - 1e-9)
    }
}

impl Near {
    /// Whether it does more than notice.
    pub fn resists(&self) -> bool {
        matches!(self.kind, Kind::Solid | Kind::OneWay { solid: true })
    }

    /// Places of its patches.
    pub fn patches(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// A manifold and what it remembers.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::world) struct Patch {
    pub near: u32,
    pub manifold: Manifold,
    pub memory: Memory,
}

impl Patch {
    /// Whether it bore a load in the last substep.
    pub fn bears(&self) -> bool {
        self.memory.impulse[0] + self.memory.impulse[1] > 0.0
    }

    /// A manifold as found, with the impulses of those points of the last step that have the same features.
    pub fn remembering(near: u32, manifold: Manifold, before: &[Self]) -> Self {
        let mut memory = Memory::NEW;
        let credits = before.iter().map(|old| old.memory.credit);
        memory.credit = credits.reduce(Real::min).unwrap_or(memory.credit);
        for old in before {
            let same =
                |k: usize, j: usize| manifold.anchors[k].feature == old.manifold.anchors[j].feature;
            let mut kept = 0.0;
            for k in 0..manifold.count {
                for j in (0..old.manifold.count).filter(|j| same(k, *j)) {
                    memory.impulse[k] = old.memory.impulse[j];
                    kept += old.memory.impulse[j];
                }
            }
            if kept > 0.0 {
                let sum = old.memory.impulse[0] + old.memory.impulse[1];
                memory.impulse[2] = old.memory.impulse[2] * (kept / sum);
                memory.rolling = old.memory.rolling * (kept / sum);
                memory.sliding = old.memory.sliding;
            }
        }
        Self { near, manifold, memory }
    }
}

impl Contacts {
    /// Forgets pairs.
    pub(super) fn drop_near(
        &mut self,
        handles: &[BodyHandle],
        mut gone: impl FnMut(&Near, &Self) -> bool,
    ) {
        let mut near = std::mem::take(&mut self.near);
        near.retain(|pair| {
            let gone = gone(pair, self);
            if gone {
                self.forget_touch(pair, handles);
                self.map.remove(pair.proxies[0], pair.proxies[1]);
            }
            !gone
        });
        self.near = near;
    }

    /// Makes the remembered impulses those of a substep of length h (s).
    pub fn scale_impulses(&mut self, h: f64) {
        if self.substep > 0.0 && self.substep != h {
            let scale = h / self.substep;
            for Patch { memory, .. } in &mut self.patches {
                *memory = memory.scaled(scale);
            }
        }
        self.substep = h;
    }

    /// The patches of a pair.
    pub fn patches_of(&self, near: &Near) -> &[Patch] {
        &self.patches[near.patches()]
    }
}
