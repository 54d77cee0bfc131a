//! When two shapes on their paths first meet.
//!
//! While they are apart: straight pieces of the path, so short that it bends off them by less than a quarter of the distance, are
//! searched as [`first_impact`] does, for what is nearer than that (conservative advancement); near one another the gap of the
//! features that face each other is followed to its root, and the distance there says whether those were the right ones.
//! While they touch: the gaps of further features are watched.

use super::path::Path;
use super::point::{Point, Seen};
use crate::collision::{
    Collider, Frame, Geometry, Manifold, Sweep, collide, distance, first_impact,
};
use crate::constraints::contact::Touch;
use crate::math::Real;
use crate::methods::contact_step::first_root;

/// Two colliders that may meet.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// Slots of A and B.
    pub slots: [u32; 2],
    /// Their shapes.
    pub colliders: [&'a Collider; 2],
    /// Friction and restitution.
    pub touch: Touch,
    /// Smaller width (m).
    pub width: Real,
    /// What overlap the errors of the run may bring about, as a part of the width.
    pub slack: Real,
}

/// What meets, and when.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Time since the start of the path (s).
    pub time: Real,
    /// The features, where they are known.
    pub point: Option<Point>,
}

/// A gap below this part of the width, and rounding of places, is none.
const NONE: Real = 1e-14;

/// Turn (rad) over which features that face one another stay the same.
const LITTLE: Real = 0.2;

/// Pieces of a path that are looked at.
const MOST: usize = 4000;

impl Pair<'_> {
    /// Whether one of the shapes is a link of a chain or a piece of a concave polygon: distances do not know what joins
    /// leave of it.
    pub fn joined(&self) -> bool {
        let has_joins = |collider: &&Collider| matches!(&collider.geometry, Geometry::Convex(convex) if convex.joins.is_some());
        self.colliders.iter().any(has_joins)
    }

    /// What is no gap, where the bodies stand (m).
    pub fn none(&self, frames: &[Frame; 2]) -> Real {
        let places = frames[0].position.norm() + frames[1].position.norm();
        let sizes = self.colliders[0].reach + self.colliders[1].reach;
        NONE * self.width + 2.0 * Real::EPSILON * (places + sizes)
    }

    /// A gap (m) up to which shapes that are not in flight towards one another touch.
    pub fn touching(&self, frames: &[Frame; 2]) -> Real {
        1e-12 * self.width + 64.0 * self.none(frames)
    }

    /// Distance of the shapes (m), below 0 where they overlap.
    pub fn distance(&self, frames: &[Frame; 2]) -> Real {
        let [a, b] = self.colliders.map(|collider| &collider.geometry);
        distance(a, b, &frames[1].seen_from(&frames[0])).distance
    }

    /// Manifolds of what is within a margin (m).
    pub fn manifolds(&self, frames: &[Frame; 2], margin: Real) -> Vec<Manifold> {
        let [a, b] = self.colliders.map(|collider| &collider.geometry);
        let mut found = Vec::new();
        collide(a, b, &frames[1].seen_from(&frames[0]), margin, &mut found);
        found
    }

    /// Points within a margin (m).
    pub fn points(&self, frames: &[Frame; 2], margin: Real) -> Vec<Point> {
        let bodies = [0, 1].map(|side| (self.colliders[side], &frames[side]));
        let found = self.manifolds(frames, margin);
        let points = |manifold: &Manifold| {
            (0..manifold.count).map(|k| Point::of(manifold, k, bodies)).collect::<Vec<_>>()
        };
        found.iter().flat_map(points).collect()
    }

    /// First meeting of shapes that leave one another at these features and are clear after a time: until then others may meet.
    pub fn first_from(
        &self,
        path: &dyn Path,
        (clear, leaving): (Real, &[u32]),
        to: Real,
    ) -> Option<Arrival> {
        let soon = clear.min(to);
        let other = (soon > 0.0).then(|| self.first_feature(path, [0.0, soon], leaving)).flatten();
        other.or_else(|| self.first_meeting(path, [clear, to]))
    }

    /// First meeting after `from` and before `to` of shapes that are apart then.
    pub fn first_meeting(&self, path: &dyn Path, [from, to]: [Real; 2]) -> Option<Arrival> {
        if self.joined() {
            return self.first_feature(path, [from, to], &[]);
        }
        let [bend_a, bend_b] = self.slots.map(|slot| path.bend(slot));
        let [a, b] = self.colliders;
        let bend = bend_a[0] + bend_b[0] + bend_a[1] * a.reach + bend_b[1] * b.reach;
        let mut time = from;
        for _ in 0..MOST {
            if time >= to {
                return None;
            }
            let frames = path.frames(self.slots, time);
            let gap = self.distance(&frames);
            if gap <= self.none(&frames) {
                return Some(Arrival { time, point: None });
            }
            // ⅛ bend·Δ² ≤ ¼ gap.
            let piece = if bend > 0.0 { (2.0 * gap / bend).sqrt() } else { Real::INFINITY };
            if gap <= NEAR * self.width
                && let Some(met) = self.by_features(path, [time, to], &frames)
            {
                return Some(met);
            }
            let end = if piece < to - time { time + piece } else { to };
            if gap < self.resolution(path, [time, end]) {
                let points = self.points(&frames, 2.0 * NEAR * self.width);
                let next = time + self.clear(path, time, &points, end);
                if next <= time {
                    return Some(Arrival { time, point: None });
                }
                time = next;
                continue;
            }
            let ways = self
                .slots
                .map(|slot| Sweep { from: path.body(slot, time).0, to: path.body(slot, end).0 });
            let geometry = [&a.geometry, &b.geometry];
            let near = first_impact((geometry[0], &ways[0]), (geometry[1], &ways[1]), 0.25 * gap);
            let next = near.map_or(end, |hit| time + hit.fraction * (end - time));
            if next <= time {
                return Some(Arrival { time, point: None });
            }
            time = next;
        }
        Some(Arrival { time, point: None })
    }

    /// The nearest features on their way to one another, if they are what meets first.
    fn by_features(
        &self,
        path: &dyn Path,
        [from, to]: [Real; 2],
        frames: &[Frame; 2],
    ) -> Option<Arrival> {
        let points = self.points(frames, 2.0 * NEAR * self.width);
        let times = points.iter().filter_map(|point| {
            let time = self.root_from(path, point, [from, to])?;
            Some(Arrival { time, point: Some(*point) })
        });
        let first = times.min_by(|x, y| x.time.total_cmp(&y.time))?;
        let there = path.frames(self.slots, first.time);
        let off = self.distance(&there);
        (off.abs() <= 8.0 * self.none(&there)).then_some(first)
    }

    /// Root of the gap of a point by quadratic steps, from above.
    fn root_from(&self, path: &dyn Path, point: &Point, [from, to]: [Real; 2]) -> Option<Real> {
        const STEPS: usize = 40;
        let mut time = from;
        for _ in 0..STEPS {
            let frames = path.frames(self.slots, time);
            let (seen, rate, bend) = self.rates(path, point, time);
            if seen.gap.abs() <= self.none(&frames) {
                let on_face = point.within_face(&seen) >= -1e-9 * self.width;
                return (rate < 0.0 && on_face).then_some(time);
            }
            let step = if seen.gap > 0.0 {
                first_root(seen.gap, rate, bend)?
            } else if rate < 0.0 {
                -seen.gap / rate
            } else {
                return None;
            };
            if time + step == time {
                return (rate < 0.0).then_some(time);
            }
            time += step;
            if time > to || time < from {
                return None;
            }
        }
        None
    }

    /// A point at a time, the rate of its gap, and the rate of that.
    fn rates(&self, path: &dyn Path, point: &Point, time: Real) -> (Seen, Real, Real) {
        let frames = path.frames(self.slots, time);
        let seen = point.seen([&frames[0], &frames[1]]);
        let twists = self.slots.map(|slot| path.body(slot, time).1);
        let bends = self.slots.map(|slot| path.acceleration(slot, time));
        let pair = [&twists[0], &twists[1]];
        let rate = seen.normal.dot(&seen.velocity(pair));
        let bend =
            seen.normal.dot(&seen.velocity([&bends[0], &bends[1]])) + point.bias(&seen, pair)[0];
        (seen, rate, bend)
    }

    /// After what time (s) shapes that leave one another are as far apart as searches can tell from rounding, or on the top of
    /// their flight where that is lower.
    pub fn clear(&self, path: &dyn Path, time: Real, points: &[Point], until: Real) -> Real {
        let enough = 2.0 * self.resolution(path, [time, until]);
        let mut latest: Real = 0.0;
        for point in points {
            let (seen, rate, bend) = self.rates(path, point, time);
            let (rate, lack) = (rate.max(0.0), (enough - seen.gap).max(0.0));
            // gap + rate·τ + ½ bend·τ² = enough.
            let square = rate * rate + 2.0 * bend * lack;
            let after = if square >= 0.0 && rate + square.sqrt() > 0.0 {
                2.0 * lack / (rate + square.sqrt())
            } else if bend < 0.0 {
                rate / -bend
            } else {
                0.0
            };
            latest = latest.max(after);
        }
        latest
    }

    /// Distances (m) that searches over a stretch tell from one another.
    fn resolution(&self, path: &dyn Path, [from, to]: [Real; 2]) -> Real {
        let ends = [from, to].map(|time| path.frames(self.slots, time));
        let way = |side: usize| (ends[1][side].position - ends[0][side].position).norm();
        let apart = (ends[0][1].position - ends[0][0].position).norm();
        let sizes = self.colliders[0].reach + self.colliders[1].reach + apart;
        128.0 * Real::EPSILON * (sizes + way(0) + way(1)) + self.none(&ends[0])
    }

    /// First meeting of features other than those that bear, of shapes that touch.
    pub fn first_feature(
        &self,
        path: &dyn Path,
        [from, to]: [Real; 2],
        bearing: &[u32],
    ) -> Option<Arrival> {
        let mut time = from;
        for _ in 0..MOST {
            if time >= to {
                return None;
            }
            let end = self.while_little(path, time, to);
            let frames = path.frames(self.slots, time);
            let margin = self.colliders[0].reach + self.colliders[1].reach;
            let points = self.points(&frames, margin);
            let others = points.iter().filter(|point| !bearing.contains(&point.feature));
            let first = others
                .filter_map(|point| self.crossing(path, point, [time, end]))
                .min_by(|x, y| x.time.total_cmp(&y.time));
            if first.is_some() {
                return first;
            }
            if let Some(overlap) = self.unforeseen(path, [time, end], bearing) {
                return Some(overlap);
            }
            time = end;
        }
        None
    }

    /// Where features that none of the first ones led to begin to overlap within a stretch: what comes over the end of a face, say.
    fn unforeseen(
        &self,
        path: &dyn Path,
        [from, to]: [Real; 2],
        bearing: &[u32],
    ) -> Option<Arrival> {
        let deepest = |time: Real| {
            let frames = path.frames(self.slots, time);
            let gaps = self.points(&frames, 0.0).into_iter().filter_map(|point| {
                let new = !bearing.contains(&point.feature);
                new.then(|| (point.seen([&frames[0], &frames[1]]).gap, point))
            });
            gaps.min_by(|x, y| x.0.total_cmp(&y.0))
        };
        let slack = self.slack * self.width + self.touching(&path.frames(self.slots, to));
        let (gap, _) = deepest(to)?;
        if gap >= -slack || deepest(from).is_some_and(|(gap, _)| gap < -slack) {
            return None;
        }
        let above = |time: Real| deepest(time).map_or(slack, |(gap, _)| gap + slack);
        let time = falling(above, [from, to]);
        let point = deepest(time).filter(|(gap, _)| *gap < 0.0).map(|(_, point)| point);
        Some(Arrival { time, point })
    }

    /// The end of the stretch on which shapes turn against one another, and joined ones move, only a little.
    fn while_little(&self, path: &dyn Path, time: Real, to: Real) -> Real {
        let [(_, a), (_, b)] = self.slots.map(|slot| path.body(slot, time));
        let bends = self.slots.map(|slot| path.bend(slot));
        let turning = (b.angular - a.angular).abs();
        let mut stretch = within(turning, bends[0][1] + bends[1][1], LITTLE);
        if self.joined() {
            let speed = (b.linear - a.linear).norm();
            let most = LITTLE * self.width;
            stretch = stretch.min(within(speed, bends[0][0] + bends[1][0], most));
        }
        if stretch < to - time { time + stretch } else { to }
    }

    /// Where the gap of a point goes through 0 from above within a stretch, on its face.
    fn crossing(&self, path: &dyn Path, point: &Point, [from, to]: [Real; 2]) -> Option<Arrival> {
        const LOOKS: u32 = 4;
        let frames = path.frames(self.slots, from);
        let none = self.touching(&frames);
        let gap = |time: Real| {
            let frames = path.frames(self.slots, time);
            point.seen([&frames[0], &frames[1]]).gap
        };
        let mut looks: Vec<Real> =
            (1..=LOOKS).map(|k| from + (to - from) * Real::from(k) / Real::from(LOOKS)).collect();
        let (mut before, start) = (from, gap(from));
        if start.abs() <= none {
            // What leaves comes back after its top.
            let twists = self.slots.map(|slot| path.body(slot, from).1);
            let seen = point.seen([&frames[0], &frames[1]]);
            let rate = seen.normal.dot(&seen.velocity([&twists[0], &twists[1]]));
            let bends = self.slots.map(|slot| path.bend(slot));
            let bend = bends[0][0] + bends[1][0];
            if rate > 0.0 && bend > 0.0 {
                looks.push((from + rate / bend).min(to));
                looks.sort_unstable_by(Real::total_cmp);
            }
        }
        let mut above = start > none;
        for look in looks {
            let now = gap(look);
            // From clearly above the root itself; from a touch what is clearly below.
            let level = if above { 0.0 } else { -none };
            if now < level {
                let time = falling(|time| gap(time) - level, [before, look]);
                let frames = path.frames(self.slots, time);
                let seen = point.seen([&frames[0], &frames[1]]);
                let met = point.within_face(&seen) >= -1e-9 * self.width && start >= -none;
                return met.then_some(Arrival { time, point: Some(*point) });
            }
            (before, above) = (look, now > none);
        }
        None
    }
}

/// Shapes nearer than this part of the width are followed by their features.
const NEAR: Real = 1e-2;

/// Longest time in which what moves at a rate, and faster by an acceleration, gets no farther than a way.
fn within(rate: Real, bend: Real, way: Real) -> Real {
    let root = (rate * rate + 2.0 * bend * way).sqrt();
    if rate + root > 0.0 { 2.0 * way / (rate + root) } else { Real::INFINITY }
}

/// Where a function that is not below 0 at the first of two times and below at the second gets there: regula falsi with halved
/// weights (Illinois), to the last digits, from above.
pub fn falling(f: impl Fn(Real) -> Real, [from, to]: [Real; 2]) -> Real {
    const MOST: usize = 100;
    let (mut low, mut high) = ((from, f(from).max(0.0)), (to, f(to)));
    let (mut weights, mut last) = ((low.1, high.1), 0);
    for k in 0..MOST {
        let middle = 0.5 * (low.0 + high.0);
        if middle <= low.0 || middle >= high.0 {
            break;
        }
        let secant = low.0 + (high.0 - low.0) * weights.0 / (weights.0 - weights.1);
        let at = if k % 4 == 3 || !(secant > low.0 && secant < high.0) { middle } else { secant };
        let value = f(at);
        if value == 0.0 {
            return at;
        }
        if value > 0.0 {
            weights = (value, if last == 1 { 0.5 * weights.1 } else { weights.1 });
            (low, last) = ((at, value), 1);
        } else {
            weights = (if last == -1 { 0.5 * weights.0 } else { weights.0 }, value);
            (high, last) = ((at, value), -1);
        }
    }
    low.0
}
