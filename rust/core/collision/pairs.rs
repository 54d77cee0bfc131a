//! Which place a pair of proxies has in a table of the caller's.

use std::collections::HashMap;

use rustc_hash::FxBuildHasher;

use super::ProxyId;

/// A map from unordered pairs of proxies to places. It is only ever asked, never listed, so that no order
/// depends on hashes; it is not serialised, but made again from the caller's table.
#[derive(Clone, Debug, Default)]
pub struct PairMap(HashMap<(u32, u32), u32, FxBuildHasher>);

impl PairMap {
    /// Place of a pair, whichever comes first.
    #[must_use]
    pub fn get(&self, a: ProxyId, b: ProxyId) -> Option<u32> {
        self.0.get(&key(a, b)).copied()
    }

    /// Whether the pair is known.
    #[must_use]
    pub fn contains(&self, a: ProxyId, b: ProxyId) -> bool {
        self.0.contains_key(&key(a, b))
    }

    /// Sets the place of a pair; returns the one it had.
    pub fn insert(&mut self, a: ProxyId, b: ProxyId, place: u32) -> Option<u32> {
        self.0.insert(key(a, b), place)
    }

    /// Forgets a pair; returns the place it had.
    pub fn remove(&mut self, a: ProxyId, b: ProxyId) -> Option<u32> {
        self.0.remove(&key(a, b))
    }

    /// Number of pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is no pair.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Forgets all pairs and keeps the memory.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

impl FromIterator<(ProxyId, ProxyId)> for PairMap {
    /// Each pair at the place it comes in.
    fn from_iter<I: IntoIterator<Item = (ProxyId, ProxyId)>>(pairs: I) -> Self {
        Self(pairs.into_iter().zip(0..).map(|((a, b), place)| (key(a, b), place)).collect())
    }
}

fn key(a: ProxyId, b: ProxyId) -> (u32, u32) {
    (a.0.min(b.0), a.0.max(b.0))
}
