//! When two surfaces on their paths meet.

use super::Link;
use crate::collision::{Manifold, Normal};
use crate::constraints::contact::{Moved, curvature, moved};
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Twist, perp};

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
    /// h²/8 of the substep (s²).
    pub sag: Real,
}

impl Pair<'_> {
    /// Places at a time from the middle: x + ah²/8 + vτ + ½aτ². The drift of h/2 with the velocity of the start
    /// has left x short of the middle of the parabola by ah²/8.
    #[must_use]
    pub fn places_at(&self, time: Real) -> [Place; 2] {
        let at = |side: usize| {
            let mut place = *self.places[side];
            place.drift(&self.velocities[side].twist, time);
            place.drift(&place.kick(0.5 * time), time);
            place.drift(&place.kick(self.sag), 1.0);
            place
        };
        [at(0), at(1)]
    }

    /// Velocities at a time from the middle: v + aτ.
    #[must_use]
    pub fn velocities_at(&self, time: Real) -> [Velocity; 2] {
        let at = |side: usize| {
            let mut velocity = *self.velocities[side];
            velocity.twist += self.places[side].kick(time);
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

    fn arrival(&self, k: usize, from: Real, to: Real) -> Option<Arrival> {
        // The path is nearly a parabola along the normal: quadratic steps settle in a few.
        const STEPS: usize = 24;
        let manifold = &self.link.manifold;
        let mut time = from;
        for step in 0..STEPS {
            let (places, velocities) = (self.places_at(time), self.velocities_at(time));
            let at = moved(manifold, self.link.apart, [&places[0], &places[1]]);
            let (rate, bend) = self.rates(&at, k, (&places, &velocities));
            let gap = at.gap[k];
            if gap <= SAME * self.link.width && (step > 0 || gap <= 0.0) {
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
        (rate, pushed + curvature(&link.manifold, at, (link.apart, k), bodies, [va, vb]))
    }
}

/// A gap below this part of the width is none.
const SAME: Real = 1e-14;

/// Smallest δ > 0 with g + uδ + ½aδ² = 0 for a gap g > 0.
fn first_root(gap: Real, rate: Real, bend: Real) -> Option<Real> {
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
