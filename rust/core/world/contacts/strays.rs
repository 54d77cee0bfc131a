//! Where shapes are now, for queries: in the boxes of detection, or beside them.
//!
//! The boxes of detection are those of the last step: bodies leave them by being set, pushed or accelerated,
//! and in a world where nothing can collide they are never moved at all. Moving them for a query would change
//! the order in which the next step finds its pairs, hence its last digits. So the boxes stay as they are, and
//! what has left its own has a present one here.

use super::{Contacts, Entry, margin};
use crate::body::Bodies;
use crate::collision::{BroadPhase, Frame, ProxyId};
use crate::math::{Real, Vec2};
use crate::shapes::Aabb;

/// Colliders that are not in their boxes of detection.
#[derive(Clone, Debug, Default)]
pub(in crate::world) struct Strays {
    broad: BroadPhase,
    /// By the numbers in `broad`: the collider's number in detection.
    proxies: Vec<ProxyId>,
    /// By the numbers in detection: the number in `broad`.
    own: Vec<Option<ProxyId>>,
}

impl Strays {
    /// Of these bodies and those whose place was set since detection.
    pub fn among(
        contacts: &Contacts,
        bodies: &Bodies,
        moving: impl Iterator<Item = usize>,
    ) -> Self {
        let mut strays = Self::default();
        let placed = contacts.moved.iter().map(|body| *body as usize);
        moving.chain(placed).for_each(|body| strays.follow(contacts, bodies, body));
        strays
    }

    /// Looks where a body is now.
    pub fn follow(&mut self, contacts: &Contacts, bodies: &Bodies, body: usize) {
        let proxies = &contacts.of_body[body];
        if proxies.is_empty() {
            return;
        }
        let frame = Frame::of(&bodies.poses[body]);
        for &proxy in proxies {
            let collider = &contacts.entries[proxy.0 as usize].collider;
            // So that rounding, of the box or of a query's, loses no touch.
            let size = frame.position.amax() + collider.reach;
            let tight = collider.geometry.bounds_at(&frame).grown(16.0 * Real::EPSILON * size);
            match (self.number(proxy), contacts.broad.fat_box(proxy).contains_box(&tight)) {
                (None, true) => {}
                (Some(_), true) => self.drop_one(proxy),
                (Some(own), false) => drop(self.broad.update(own, &tight, margin(collider))),
                (None, false) => self.insert(proxy, &tight, margin(collider)),
            }
        }
    }

    /// Forgets a body that is about to leave detection.
    pub fn forget(&mut self, contacts: &Contacts, body: usize) {
        contacts.of_body[body].iter().for_each(|proxy| self.drop_one(*proxy));
    }

    fn number(&self, proxy: ProxyId) -> Option<ProxyId> {
        self.own.get(proxy.0 as usize).copied().flatten()
    }

    fn insert(&mut self, proxy: ProxyId, tight: &Aabb, margin: Real) {
        let own = self.broad.insert(tight, margin, true);
        let (place, owns) = (proxy.0 as usize, own.0 as usize);
        self.own.resize(self.own.len().max(place + 1), None);
        self.own[place] = Some(own);
        self.proxies.resize(self.proxies.len().max(owns + 1), proxy);
        self.proxies[owns] = proxy;
    }

    fn drop_one(&mut self, proxy: ProxyId) {
        if let Some(own) = self.number(proxy) {
            self.broad.remove(own);
            self.own[proxy.0 as usize] = None;
        }
    }
}

/// Asking. The boxes that are seen are those around what the bodies are now, or larger.
impl Contacts {
    /// Calls `found` with every collider whose box meets `aabb`, until it says no.
    pub fn query(&self, strays: &Strays, aabb: &Aabb, found: &mut dyn FnMut(&Entry) -> bool) {
        let mut go_on = true;
        self.broad.query(aabb, &mut |proxy| {
            go_on = strays.number(proxy).is_some() || found(self.entry(proxy));
            go_on
        });
        if go_on {
            strays.broad.query(aabb, &mut |own| found(self.stray(strays, own)));
        }
    }

    /// As [`BroadPhase::cast`], with colliders.
    pub fn cast(
        &self,
        strays: &Strays,
        moving_box: (Vec2, Vec2),
        translation: Vec2,
        found: &mut dyn FnMut(&Entry, Real) -> Real,
    ) {
        let limit = self.broad.cast(moving_box, translation, &mut |proxy, limit| {
            if strays.number(proxy).is_some() { limit } else { found(self.entry(proxy), limit) }
        });
        if limit >= 0.0 {
            strays.broad.cast(moving_box, translation, &mut |own, other| {
                found(self.stray(strays, own), other.min(limit)).min(limit)
            });
        }
    }

    /// As [`BroadPhase::nearest`], with colliders.
    pub fn nearest(
        &self,
        strays: &Strays,
        aabb: &Aabb,
        limit: Real,
        found: &mut dyn FnMut(&Entry, Real) -> Real,
    ) {
        let limit = self.broad.nearest(aabb, limit, &mut |proxy, limit| {
            if strays.number(proxy).is_some() { limit } else { found(self.entry(proxy), limit) }
        });
        strays.broad.nearest(aabb, limit, &mut |own, limit| found(self.stray(strays, own), limit));
    }

    /// The colliders of a body.
    pub fn of_body(&self, body: usize) -> impl Iterator<Item = &Entry> {
        self.of_body[body].iter().map(|proxy| self.entry(*proxy))
    }

    pub(in crate::world) fn entry(&self, proxy: ProxyId) -> &Entry {
        &self.entries[proxy.0 as usize]
    }

    fn stray(&self, strays: &Strays, own: ProxyId) -> &Entry {
        self.entry(strays.proxies[own.0 as usize])
    }
}
