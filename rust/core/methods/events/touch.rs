//! When what touches began to, and when it ceased.

use super::modes::Contact;
use super::point::Seen;
use super::{Run, still};
use crate::math::{Real, Twist, Vec2};

/// A pair that began or ceased to touch.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Place of the pair in the island.
    pub pair: u32,
    /// World time (s).
    pub time: Real,
    /// Whether it touches from then on.
    pub touches: bool,
    /// Where it does (m), and the normal there, from A to B.
    pub spot: Option<(Vec2, Vec2)>,
}

/// What leaves by less than this part of the accelerations it is a difference of does not leave.
const STAYS: Real = 1e-9;

impl Run<'_, '_, '_, '_> {
    /// Notes which pairs touch from now on where that is news, by the accelerations in the present modes: what bears, and what
    /// rests against one another without a load. What meets and leaves at once does not begin to touch.
    pub(super) fn note_touches(&mut self, accelerations: &[Twist]) {
        let time = self.time();
        let spots: Vec<_> = (0..self.island.pairs.len() as u32)
            .map(|pair| self.spot(pair, accelerations))
            .collect();
        self.touching.resize(spots.len(), None);
        for (pair, (spot, known)) in spots.into_iter().zip(&mut self.touching).enumerate() {
            let touches = spot.is_some();
            if *known != Some(touches) {
                *known = Some(touches);
                self.outcome.touched.push(Touch { pair: pair as u32, time, touches, spot });
            }
        }
    }

    /// Where a pair touches and stays: in the middle of its points.
    fn spot(&self, pair: u32, accelerations: &[Twist]) -> Option<(Vec2, Vec2)> {
        let modes = self.system.modes.as_ref()?;
        let own = modes.contacts.iter().filter(|contact| contact.pair == pair);
        let (mut sum, mut normal, mut count) = (Vec2::zeros(), None, 0.0);
        for contact in own {
            let frames = modes.frames(contact.slots);
            for p in 0..contact.count {
                let seen = contact.seen(p, frames);
                if contact.on[p] || self.stays(contact, p, &seen, accelerations) {
                    sum += frames[0].position + seen.arms[0];
                    normal.get_or_insert(seen.normal);
                    count += 1.0;
                }
            }
        }
        normal.map(|normal| (sum / count, normal))
    }

    /// Whether a point without a load stays where it touches: n·v = 0 and n·a + ṅ·v = 0.
    fn stays(&self, contact: &Contact, p: usize, seen: &Seen, accelerations: &[Twist]) -> bool {
        let twists = contact.slots.map(|slot| &self.motion.twists[slot as usize]);
        let rates = contact.slots.map(|slot| &accelerations[slot as usize]);
        let speed = seen.normal.dot(&seen.velocity(twists)).abs();
        let bias = contact.points[p].bias(seen, twists)[0];
        let away = seen.normal.dot(&seen.velocity(rates)) + bias;
        let reach = seen.arms.map(|arm| arm.norm());
        let size = |k: usize| rates[k].linear.norm() + reach[k] * rates[k].angular.abs();
        let still = still(self.island, contact, self.motion.twists, accelerations);
        speed <= still && away <= STAYS * (size(0) + size(1) + bias.abs())
    }
}
