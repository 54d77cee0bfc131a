//! The broad phase does what looking at every pair would do.

use std::collections::{BTreeMap, BTreeSet};

use culbuto::collision::{BroadPhase, PairMap, ProxyId};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::{Aabb, Interval};
use proptest::prelude::*;

#[derive(Clone, Debug)]
enum Call {
    Insert(Aabb, Real, bool),
    Remove(usize),
    Update(usize, Aabb, Real),
    Shift(usize, Vec2, Real),
    SetMoving(usize, bool),
    Touch(usize),
    FindPairs,
    Query(Aabb),
    Cast(Vec2, Vec2, Vec2),
    Restore,
}

fn boxes() -> impl Strategy<Value = Aabb> {
    // On a coarse grid, so that boxes touch and coincide.
    (-20..20_i32, -20..20_i32, 0..8_i32, 0..8_i32).prop_map(|(x, y, w, h)| {
        let span = |at, length| Interval { min: Real::from(at), max: Real::from(at + length) };
        Aabb::new(span(x, w), span(y, h))
    })
}

fn points(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

fn calls() -> impl Strategy<Value = Vec<Call>> {
    let margin = || prop_oneof![Just(0.0), 0.01..2.0];
    let extent = (0.0..2.0, 0.0..2.0).prop_map(|(x, y)| vec2(x, y));
    let one = prop_oneof![
        6 => (boxes(), margin(), any::<bool>()).prop_map(|(b, m, moving)| Call::Insert(b, m, moving)),
        2 => any::<usize>().prop_map(Call::Remove),
        3 => (any::<usize>(), boxes(), margin()).prop_map(|(i, b, m)| Call::Update(i, b, m)),
        6 => (any::<usize>(), points(1.0), margin()).prop_map(|(i, v, m)| Call::Shift(i, v, m)),
        1 => (any::<usize>(), any::<bool>()).prop_map(|(i, moving)| Call::SetMoving(i, moving)),
        1 => any::<usize>().prop_map(Call::Touch),
        3 => Just(Call::FindPairs),
        1 => boxes().prop_map(Call::Query),
        1 => (points(30.0), points(60.0), extent).prop_map(|(o, t, e)| Call::Cast(o, t, e)),
        1 => Just(Call::Restore),
    ];
    prop::collection::vec(one, 1..150)
}

/// The broad phase beside a plain list of what it holds.
#[derive(Default)]
struct Beside {
    broad: BroadPhase,
    tight: BTreeMap<ProxyId, Aabb>,
    moved: BTreeSet<ProxyId>,
    /// Pairs whose boxes met in the last search.
    met: BTreeSet<(ProxyId, ProxyId)>,
}

impl Beside {
    fn pick(&self, number: usize) -> Option<ProxyId> {
        let at = number.checked_rem(self.tight.len())?;
        self.tight.keys().nth(at).copied()
    }

    /// All pairs of a box are to be found.
    fn renew(&mut self, id: ProxyId) {
        self.moved.insert(id);
        self.met.retain(|(a, b)| *a != id && *b != id);
    }

    fn update(&mut self, id: ProxyId, tight: Aabb, margin: Real) {
        let changed = self.broad.update(id, &tight, margin);
        let fat = *self.broad.fat_box(id);
        assert!(fat.contains_box(&tight), "the fat box holds the tight one");
        assert!(tight.grown(4.0 * margin).contains_box(&fat), "the fat box is not far too large");
        if changed {
            self.moved.insert(id);
        }
        self.tight.insert(id, tight);
    }

    fn call(&mut self, call: &Call) {
        match *call {
            Call::Insert(tight, margin, moving) => {
                let id = self.broad.insert(&tight, margin, moving);
                assert!(
                    self.tight.insert(id, tight).is_none(),
                    "numbers in use are not given again"
                );
                self.renew(id);
            }
            Call::Remove(i) => {
                if let Some(id) = self.pick(i) {
                    self.broad.remove(id);
                    self.tight.remove(&id);
                    self.moved.remove(&id);
                }
            }
            Call::Update(i, tight, margin) => {
                if let Some(id) = self.pick(i) {
                    self.update(id, tight, margin);
                }
            }
            Call::Shift(i, offset, margin) => {
                if let Some(id) = self.pick(i) {
                    self.update(id, self.tight[&id].moved(offset), margin);
                }
            }
            Call::SetMoving(i, moving) => {
                if let Some(id) = self.pick(i) {
                    if self.broad.is_moving(id) != moving {
                        self.renew(id);
                    }
                    self.broad.set_moving(id, moving);
                }
            }
            Call::Touch(i) => {
                if let Some(id) = self.pick(i) {
                    self.broad.touch(id);
                    self.renew(id);
                }
            }
            Call::FindPairs => self.find_pairs(),
            Call::Query(aabb) => self.query(&aabb),
            Call::Cast(origin, translation, extent) => self.cast(origin, translation, extent),
            Call::Restore => {
                let text = serde_json::to_string(&self.broad).unwrap();
                self.broad = serde_json::from_str(&text).unwrap();
            }
        }
    }

    fn fat(&self) -> Vec<(ProxyId, Aabb)> {
        self.tight.keys().map(|&id| (id, *self.broad.fat_box(id))).collect()
    }

    fn find_pairs(&mut self) {
        let allow = |a: ProxyId, b: ProxyId| !(a.0 + b.0).is_multiple_of(7);
        let fat = self.fat();
        let (mut wanted, mut meet) = (BTreeSet::new(), BTreeSet::new());
        for (i, (a, box_a)) in fat.iter().enumerate() {
            for (b, box_b) in &fat[i + 1..] {
                let moved = self.moved.contains(a) || self.moved.contains(b);
                let moving = self.broad.is_moving(*a) || self.broad.is_moving(*b);
                assert_eq!(self.broad.overlaps(*a, *b), box_a.overlaps(box_b));
                if box_a.overlaps(box_b) {
                    let new = !self.met.contains(&(*a, *b));
                    if new && moved && moving && allow(*a, *b) {
                        wanted.insert((*a, *b));
                    }
                    meet.insert((*a, *b));
                }
            }
        }
        let mut copy = self.broad.clone();
        let (mut found, mut again) = (Vec::new(), Vec::new());
        self.broad.find_pairs(allow, |a, b| found.push((a, b)));
        copy.find_pairs(allow, |a, b| again.push((a, b)));
        assert_eq!(found, again, "the order is the same each time");
        assert_eq!(found.len(), wanted.len(), "each pair comes once");
        assert_eq!(found.into_iter().collect::<BTreeSet<_>>(), wanted);
        self.moved.clear();
        self.met = meet;
        self.broad.find_pairs(|_, _| true, |a, b| panic!("{a:?}, {b:?} did not move"));
    }

    fn query(&self, aabb: &Aabb) {
        let mut found = Vec::new();
        self.broad.query(aabb, &mut |id| {
            found.push(id);
            true
        });
        let mut first = None;
        self.broad.query(aabb, &mut |id| first.replace(id).is_some());
        assert_eq!(first, found.first().copied(), "a no ends the search");
        let fat = self.fat();
        let wanted: Vec<_> =
            fat.iter().filter(|(_, b)| b.overlaps(aabb)).map(|(id, _)| *id).collect();
        found.sort();
        assert_eq!(found, wanted);
    }

    fn cast(&self, origin: Vec2, translation: Vec2, extent: Vec2) {
        let mut found = BTreeSet::new();
        self.broad.cast((origin, extent), translation, &mut |id, limit| {
            assert!(found.insert(id));
            limit
        });
        let first = |b: &Aabb| first_meeting(b, origin, translation, extent);
        let fat = self.fat();
        let wanted = fat.iter().filter_map(|(id, b)| Some((first(b)?, *id)));
        let wanted: Vec<_> = wanted.collect();
        for (_, id) in &wanted {
            assert!(found.contains(id), "{id:?} is in the way");
        }
        let mut best = (Real::INFINITY, None);
        self.broad.cast((origin, extent), translation, &mut |id, limit| {
            let fraction = first(self.broad.fat_box(id)).unwrap_or(limit);
            if fraction < best.0 {
                best = (fraction, Some(id));
            }
            fraction.min(limit)
        });
        let least = wanted.iter().map(|w| w.0).fold(Real::INFINITY, Real::min);
        assert!(best.0 == least || wanted.is_empty(), "{} is not the first, {least}", best.0);
    }
}

/// First of many points of the way at which two boxes meet.
fn first_meeting(aabb: &Aabb, origin: Vec2, translation: Vec2, extent: Vec2) -> Option<Real> {
    const STEPS: u32 = 400;
    let fractions = (0..=STEPS).map(|k| Real::from(k) / Real::from(STEPS));
    fractions.into_iter().find(|t| {
        let at = origin + translation * *t;
        aabb.overlaps(&Aabb { min: at - extent, max: at + extent })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_tree_does_what_a_list_does(calls in calls()) {
        let mut beside = Beside::default();
        for call in &calls {
            beside.call(call);
            let quality = beside.broad.quality();
            let leaves = quality.leaves.map(|n| n.expect("every box is the smallest around its children"));
            prop_assert_eq!(leaves[0] + leaves[1], beside.tight.len());
        }
        beside.find_pairs();
    }
}

/// However boxes come, the tree is a few times deeper than the best tree at most.
#[test]
fn a_tree_of_rows_is_low() {
    for columns in [1, 10, 100] {
        let mut broad = BroadPhase::default();
        for k in 0..1000 {
            broad.insert(
                &unit_box(vec2(f64::from(k % columns), f64::from(k / columns)) * 2.0),
                0.1,
                true,
            );
        }
        let height = broad.quality().height[1];
        assert!(height <= 20, "{height} levels for 1000 boxes in {columns} columns");
    }
}

fn unit_box(center: Vec2) -> Aabb {
    Aabb { min: center - vec2(0.5, 0.5), max: center + vec2(0.5, 0.5) }
}

#[test]
fn pairs_have_no_order() {
    let [a, b, c] = [3, 1, 2].map(ProxyId);
    let mut map: PairMap = [(a, b), (b, c)].into_iter().collect();
    assert_eq!((map.get(a, b), map.get(b, a), map.get(c, b)), (Some(0), Some(0), Some(1)));
    assert_eq!(map.insert(c, a, 7), None);
    assert_eq!(map.insert(a, c, 8), Some(7));
    assert_eq!(map.remove(b, a), Some(0));
    assert!(!map.contains(a, b) && map.len() == 2 && !map.is_empty());
    map.clear();
    assert!(map.is_empty());
}

proptest! {
    /// What is posted and settled in one go meets what it would if it came one by one, and the trees stay trees.
    #[test]
    fn many_boxes_in_one_go_meet_what_one_by_one_do(
        places in prop::collection::vec((points(12.0), any::<bool>()), 2..60),
        ways in prop::collection::vec(points(9.0), 1..6),
        part in 1..4_usize,
    ) {
        let [mut one, mut many] = [BroadPhase::default(), BroadPhase::default()];
        for (place, moving) in &places {
            one.insert(&unit_box(*place), 0.1, *moving);
            many.insert(&unit_box(*place), 0.1, *moving);
        }
        for (round, way) in ways.iter().enumerate() {
            for (k, (place, moving)) in places.iter().enumerate().filter(|(k, _)| k % part == 0) {
                let turn = if *moving { k as Real } else { 0.0 };
                let tight = unit_box(place + *way * (1.0 + 0.1 * turn * round as Real));
                one.update(ProxyId(k as u32), &tight, 0.1);
                many.post(ProxyId(k as u32), &tight, 0.1, vec2(0.0, 0.0));
            }
            many.settle();
            let [mut first, mut second] = [BTreeSet::new(), BTreeSet::new()];
            one.find_pairs(|_, _| true, |a, b| assert!(first.insert((a, b))));
            many.find_pairs(|_, _| true, |a, b| assert!(second.insert((a, b))));
            prop_assert_eq!(first, second);
            prop_assert_eq!(one.quality().leaves, many.quality().leaves);
        }
    }
}
