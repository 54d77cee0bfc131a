//! When two surfaces on their paths meet.

use super::{Link, Surroundings};
use crate::collision::{Manifold, Normal, Sweep};
use crate::constraints::contact::{Moved, curvature, moved};
use crate::constraints::{Place, Velocity};
use crate::math::{Pose, Real, Twist, Vec2, perp};

/// A contact that is about to be.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Time from the middle of the substep (s).
    pub time: Real,
    /// Approach then (m/s), above 0.
    pub approach: Real,
}

/// Two bodies of a contact around the middle of a substep, with the velocities of the middle.
pub struct Pair<'a> {
    /// The contact.
    pub link: &'a Link,
    /// Places in the middle.
    pub places: [&'a Place; 2],
    /// Velocities in the middle.
    pub velocities: [&'a Velocity; 2],
    /// Angles at the start of the step (rad).
    pub angles: [Real; 2],
    /// The kick of the substep is over: the velocities stay.
    pub kicked: bool,
    /// Length of the substep (s).
    pub h: Real,
}

impl Pair<'_> {
    /// Places at a time from the middle: x + vτ + ½aτ² + ⅛ah². A body in flight has fallen by ⅛ah² more in half a
    /// substep than the half drift with the velocity of its start moved it, and its path has to begin where it was.
    #[must_use]
    pub fn places_at(&self, time: Real) -> [Place; 2] {
        let at = |side: usize| {
            let mut place = *self.places[side];
            place.drift(&self.velocities[side].twist, time);
            if !self.kicked {
                place.drift(&place.kick(0.5), time * time + 0.25 * self.h * self.h);
            }
            place
        };
        [at(0), at(1)]
    }

    /// Velocities at a time from the middle: v + aτ. After the kick they are known for its end; the path goes on as if they
    /// stayed, but what an impact changes is counted from what the velocity then is, or energy would come of its place.
    #[must_use]
    pub fn velocities_at(&self, time: Real) -> [Velocity; 2] {
        let at = |side: usize| {
            let mut velocity = *self.velocities[side];
            let since = if self.kicked { time - 0.5 * self.h } else { time };
            velocity.twist += self.places[side].kick(since);
            velocity
        };
        [at(0), at(1)]
    }

    /// First moment between `from` and `to` at which a point arrives faster than it may rest.
    #[must_use]
    pub fn first_arrival(&self, from: Real, to: Real) -> Option<Arrival> {
        let points = 0..self.link.manifold.count;
        let arrivals = points.filter_map(|k| self.arrival(k, from, to));
        arrivals.min_by(|a, b| a.time.total_cmp(&b.time))
    }

    /// First moment at which the shapes meet, whatever their features, faster than they may rest; and the manifold
    /// then. For bodies that move or turn far in a substep.
    #[must_use]
    pub fn first_meeting(
        &self,
        [from, to]: [Real; 2],
        around: &dyn Surroundings,
    ) -> Option<(Arrival, Manifold)> {
        // Enough to halve distances down to rounding, and for a few turns between.
        const TRIES: u32 = 24;
        let mut target = NEAR * self.link.width;
        let mut time = from;
        for _ in 0..TRIES {
            if time >= to {
                return None;
            }
            let ways = [0, 1].map(|side| self.way(side, [time, to]));
            let (fraction, manifold) = around.meet(self.link, &ways, target)?;
            time += fraction * (to - time);
            let (gap, approach) = self.nearest(&manifold, time);
            let none = NEAREST * self.link.width + 16.0 * self.rounding(&self.places_at(time));
            let resting = self.link.resting[0].max(self.link.resting[1]);
            if approach > resting {
                // Near one another the features are those that meet: their arrival is known to the last digits.
                let soon = time + (4.0 * gap / approach).max(0.0);
                let met = self.by_features(manifold, [time, to.min(soon)]);
                if met.is_some() || gap <= none {
                    return met.or(Some((Arrival { time, approach }, manifold)));
                }
            }
            if gap > none {
                // They pass by, or leave while another point may still swing in: look when they are nearer.
                target = gap / 16.0;
                continue;
            }
            // They touch and do not approach. Another point may swing in: of those that are near now, or of others
            // when they have turned a little.
            let turn = ways.iter().map(|way| (way.to.angle - way.from.angle).abs()).sum::<Real>();
            let mut next = time + (to - time) / (turn / LITTLE).ceil().max(1.0);
            if approach < 0.0 {
                // They leave: a little later their distance tells when others meet, whatever their features.
                next = next.min(time + LEFT * self.link.width / -approach);
            }
            if let Some(found) = self.by_features(manifold, [time, next]) {
                return Some(found);
            }
            (time, target) = (next, NEAR * self.link.width);
        }
        None
    }

    /// What rounding may do to a gap (m).
    fn rounding(&self, places: &[Place; 2]) -> Real {
        let ways = places[0].way.norm() + places[1].way.norm();
        4.0 * Real::EPSILON * (self.link.apart.norm() + ways)
    }

    /// Smallest gap of a manifold at a time, and the fastest approach of the points that are as near: below 0 where
    /// they leave.
    fn nearest(&self, manifold: &Manifold, time: Real) -> (Real, Real) {
        let (places, velocities) = (self.places_at(time), self.velocities_at(time));
        let at = moved(manifold, self.link.apart, [&places[0], &places[1]]);
        let gap = at.gap[..manifold.count].iter().copied().fold(Real::INFINITY, Real::min);
        let near = |k: &usize| at.gap[*k] <= (4.0 * gap).max(NEAREST * self.link.width);
        let approach = |k: usize| -self.rates(manifold, &at, k, (&places, &velocities)).0;
        let approaches = (0..manifold.count).filter(near).map(approach);
        let fastest = approaches.fold(Real::NEG_INFINITY, Real::max);
        (gap, fastest)
    }

    /// First arrival of a point of a manifold.
    fn by_features(&self, manifold: Manifold, times: [Real; 2]) -> Option<(Arrival, Manifold)> {
        let link = Link { manifold, ..*self.link };
        let arrival = Pair { link: &link, ..*self }.first_arrival(times[0], times[1])?;
        Some((arrival, manifold))
    }

    /// The way of a body between two times, from A's centre of mass at the start of the step.
    pub fn way(&self, side: usize, times: [Real; 2]) -> Sweep {
        let start = if side == 0 { Vec2::zeros() } else { self.link.apart };
        let [from, to] = times.map(|time| {
            let place = &self.places_at(time)[side];
            Pose::new(start + place.way, self.angles[side] + place.turn)
        });
        Sweep { from, to }
    }

    fn arrival(&self, k: usize, from: Real, to: Real) -> Option<Arrival> {
        // The path is nearly a parabola along the normal: quadratic steps settle in a few.
        const STEPS: usize = 24;
        let manifold = &self.link.manifold;
        let mut time = from;
        for step in 0..STEPS {
            let (places, velocities) = (self.places_at(time), self.velocities_at(time));
            let at = moved(manifold, self.link.apart, [&places[0], &places[1]]);
            let (rate, bend) = self.rates(manifold, &at, k, (&places, &velocities));
            let gap = at.gap[k];
            let same = SAME * self.link.width + self.rounding(&places);
            if gap <= same && (step > 0 || gap <= 0.0) {
                let arrives =
                    -rate > self.link.resting[k] && on_face(manifold, &at, k, self.link.width);
                return arrives.then_some(Arrival { time, approach: -rate });
            }
            time += first_root(gap, rate, bend)?;
            if time > to {
                return None;
            }
        }
        None
    }

    /// Rate of the gap of point k and the rate of that rate.
    fn rates(
        &self,
        manifold: &Manifold,
        at: &Moved,
        k: usize,
        (places, velocities): (&[Place; 2], &[Velocity; 2]),
    ) -> (Real, Real) {
        let [on_a, on_b] = at.arms[k];
        let along = |a: &Twist, b: &Twist| at.normal.dot(&(b.at(on_b) - a.at(on_a)));
        let [va, vb] = [&velocities[0].twist, &velocities[1].twist];
        let rate = along(va, vb);
        let pushed = along(&places[0].acceleration, &places[1].acceleration);
        let link = self.link;
        let bodies = [&places[0], &places[1]];
        (rate, pushed + curvature(manifold, at, (link.apart, k), bodies, [va, vb])[0])
    }
}

/// Swift shapes meet when they are this part of the smaller width apart.
pub const NEAR: Real = 1e-2;

/// Turn (rad) over which the features that are near do not change: both ends of an edge count as near up to 45°.
const LITTLE: Real = 0.25;

/// Shapes that leave have left when they are this part of the width apart.
const LEFT: Real = 1e-6;

/// Down to which part of it further points are told from those that touch.
const NEAREST: Real = 1e-10;

/// A gap below this part of the width is none.
const SAME: Real = 1e-14;

/// Smallest δ > 0 with g + uδ + ½aδ² = 0 for a gap g > 0.
pub(in crate::methods) fn first_root(gap: Real, rate: Real, bend: Real) -> Option<Real> {
    let square = rate * rate - 2.0 * bend * gap;
    if square < 0.0 || (rate >= 0.0 && bend >= 0.0) {
        return None;
    }
    let root = square.sqrt();
    Some(if rate < 0.0 { 2.0 * gap / (root - rate) } else { -(rate + root) / bend })
}

/// Whether a point that arrives at the plane of a face meets the face.
pub(super) fn on_face(manifold: &Manifold, at: &Moved, k: usize, width: Real) -> bool {
    let along = perp(at.normal);
    let (place, [low, high]) = match manifold.normal {
        Normal::OnA(_) => (along.dot(&at.arms[k][0]), manifold.face),
        Normal::OnB(_) => (along.dot(&at.arms[k][1]), manifold.face),
        Normal::Between | Normal::Inside => return true,
    };
    let margin = 1e-9 * width;
    place >= low - margin && place <= high + margin
}

/// Whether two corners, sharp or round, come nearer to one another and yet go past, on straight ways.
pub fn passes(manifold: &Manifold, at: &Moved, k: usize, [va, vb]: [&Twist; 2]) -> bool {
    let [on_a, on_b] = at.arms[k];
    let rate = vb.at(on_b) - va.at(on_a);
    let radii = manifold.radius_a + manifold.radius_b;
    let aside = perp(at.normal).dot(&rate).abs();
    manifold.normal == Normal::Between && (at.gap[k] + radii) * aside > radii * rate.norm()
}
