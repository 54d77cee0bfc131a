//! The motion from one event to the next.

use super::arrival::Pair;
use super::choose::Hint;
use super::modes::{Contact, Slip};
use super::path::{Free, Path};
use super::point::Point;
use super::switch::{Event, Lookout, Watch};
use super::{Bearing, Run, still};
use crate::error::{Error, Result};
use crate::math::{Pose, Real, Twist};
use crate::methods::{Adaptive, Control, Progress, Scratch, Sink, Span, Watch as Asks};

impl Run<'_, '_, '_, '_> {
    /// Motion to the next event.
    pub(super) fn leg(
        &mut self,
        handlers: (&mut Scratch, &mut Sink<'_>, &mut Asks<'_>),
    ) -> Result<()> {
        let (bears, joined) = self.system.modes.as_ref().map_or((false, false), |modes| {
            (modes.bears(), modes.joints.bodies() > 0 && modes.joints.any())
        });
        if bears {
            // What sticks stands still to the last bit, so that rest is seen however loads are shared.
            self.system.settle_motion(self.motion);
        }
        let accelerations = self.accelerations()?;
        let watch = self.watch(&accelerations);
        if self.island.constant && !bears && !joined {
            self.fly(&accelerations, &watch, handlers.1);
        } else if self.island.constant && self.rests(&accelerations) {
            self.passed = self.span.duration;
        } else {
            self.integrate(&watch, handlers)?;
        }
        self.note_thrown();
        Ok(())
    }

    /// Whether nothing moves, nor will.
    fn rests(&self, accelerations: &[Twist]) -> bool {
        self.motion.twists.iter().chain(accelerations).all(|twist| *twist == Twist::ZERO)
    }

    /// How each pair is watched.
    fn watch(&self, accelerations: &[Twist]) -> Vec<Watch> {
        let path = Free { poses: self.motion.poses, twists: self.motion.twists, accelerations };
        let Some(modes) = &self.system.modes else { return Vec::new() };
        let of_pair = |(k, pair): (usize, &Pair<'_>)| {
            let own = modes.contacts.iter().filter(|contact| contact.pair as usize == k);
            let mut bearing = Vec::new();
            let mut points = Vec::new();
            let mut stays = false;
            for contact in own {
                let frames = modes.frames(contact.slots);
                for p in 0..contact.count {
                    points.push(contact.points[p]);
                    if contact.on[p] {
                        bearing.push(contact.points[p].feature);
                    }
                    let seen = contact.seen(p, frames);
                    let twists = contact.slots.map(|slot| &self.motion.twists[slot as usize]);
                    let rate = seen.normal.dot(&seen.velocity(twists));
                    let bends = contact.slots.map(|slot| &accelerations[slot as usize]);
                    let bend = seen.normal.dot(&seen.velocity(bends))
                        + contact.points[p].bias(&seen, twists)[0];
                    let quiet = still(self.island, contact, self.motion.twists, accelerations);
                    stays |= rate <= quiet && bend <= 1e-9 * accelerations_of(bends);
                }
            }
            if points.is_empty() {
                Watch::Apart(0.0, Vec::new())
            } else if bearing.is_empty() && !stays {
                let rest = self.span.duration - self.passed;
                let leaving = points.iter().map(|point| point.feature).collect();
                Watch::Apart(pair.clear(&path, 0.0, &points, rest), leaving)
            } else {
                Watch::Touches(bearing)
            }
        };
        self.island.pairs.iter().enumerate().map(of_pair).collect()
    }

    /// Free flight under constant forces.
    fn fly(&mut self, accelerations: &[Twist], watch: &[Watch], sink: &mut Sink<'_>) {
        let (poses, twists) = (self.motion.poses.to_vec(), self.motion.twists.to_vec());
        let path = Free { poses: &poses, twists: &twists, accelerations };
        let rest = self.span.duration - self.passed;
        let mut first: Option<(Real, usize, Option<Point>)> = None;
        for (k, (pair, watch)) in self.island.pairs.iter().zip(watch).enumerate() {
            let to = first.as_ref().map_or(rest, |(time, ..)| *time);
            let met = match watch {
                Watch::Apart(clear, leaving) => pair.first_from(&path, (*clear, leaving), to),
                Watch::Touches(bearing) => pair.first_feature(&path, [0.0, to], bearing),
            };
            if let Some(met) = met.filter(|met| met.time < to) {
                first = Some((met.time, k, met.point));
            }
        }
        let h = first.as_ref().map_or(rest, |(time, ..)| *time);
        self.sample(&path, h, sink);
        for (slot, start) in poses.iter().enumerate() {
            let (pose, twist) = path.body(slot as u32, h);
            self.book_flight(slot, &pose, start);
            (self.motion.poses[slot], self.motion.twists[slot]) = (pose, twist);
        }
        self.outcome.progress.steps += 1;
        match first {
            None => self.passed = self.span.duration,
            Some((_, pair, point)) => {
                self.passed += h;
                self.outcome.events += 1;
                self.met.push((pair as u32, point));
            }
        }
    }

    /// Work of steady forces on a body that flew.
    fn book_flight(&mut self, slot: usize, to: &Pose, from: &Pose) {
        if let Some(steady) = self.system.forces.steady.get(slot) {
            let way = Twist::new(to.position - from.position, to.angle - from.angle);
            let mass = &self.system.forces.masses[slot];
            self.motion.ledger.work += crate::forces::power(steady, &way, mass);
        }
    }

    /// Hands out the samples within h from now.
    fn sample(&mut self, path: &dyn Path, h: Real, sink: &mut Sink<'_>) {
        let bodies = self.motion.poses.len() as u32;
        while let Some(&at) = self.samples.get(self.next).filter(|at| **at <= self.passed + h) {
            let states = (0..bodies).map(|slot| path.body(slot, at - self.passed));
            let (poses, twists): (Vec<Pose>, Vec<Twist>) = states.unzip();
            sink(self.next, &poses, &twists);
            self.next += 1;
        }
    }

    /// Samples up to the end, where nothing moves any more, or by rounding.
    pub(super) fn hand_out_rest(&mut self, sink: &mut Sink<'_>) {
        while self.next < self.samples.len() {
            sink(self.next, self.motion.poses, self.motion.twists);
            self.next += 1;
        }
    }

    /// DOP853 in the present modes.
    fn integrate(
        &mut self,
        watch: &[Watch],
        (scratch, sink, asks): (&mut Scratch, &mut Sink<'_>, &mut Asks<'_>),
    ) -> Result<()> {
        let left = self.samples[self.next..].iter().map(|at| at - self.passed);
        let samples: Vec<Real> = left.collect();
        let first = self.next;
        let mut shifted =
            |k: usize, poses: &[Pose], twists: &[Twist]| sink(first + k, poses, twists);
        let sizes = &self.island.sizes;
        let control =
            Control { tolerance: self.island.tolerance, sizes: &|i| sizes[i], samples: &samples };
        let duration = self.span.duration - self.passed;
        let span = Span { start: self.time(), end: self.span.end, duration, substeps: 1 };
        let mut lookout = Lookout::new(&self.island.pairs, watch);
        let adaptive = Adaptive::new(&control, self.motion, span).guarded(&mut lookout);
        let result = adaptive.run_on(self.system, self.motion, scratch, (&mut shifted, asks));
        let (progress, stop) = match result {
            Ok(ended) => ended,
            Err(Error::Tolerance { .. }) => {
                self.outcome.gave_up =
                    Some((self.time(), "forces of the contacts grow without end"));
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        let event = lookout.event.filter(|_| stop.early);
        self.add(&progress);
        self.next += stop.samples;
        self.passed = if stop.early { self.passed + stop.passed } else { self.span.duration };
        if let Some(event) = event {
            self.take(event);
        }
        Ok(())
    }

    fn add(&mut self, progress: &Progress) {
        let sum = &mut self.outcome.progress;
        sum.steps += progress.steps;
        sum.rejected += progress.rejected;
        sum.smallest = sum.smallest.min(progress.smallest);
        sum.estimate += progress.estimate;
    }

    /// Keeps what an event says.
    fn take(&mut self, event: Event) {
        self.outcome.events += 1;
        let Some(modes) = &mut self.system.modes else { return };
        modes.look(self.motion.poses, self.motion.twists);
        let Some(modes) = &self.system.modes else { return };
        let name = |k: usize, p: usize| {
            let contact = &modes.contacts[k];
            (contact.pair, contact.points[p].feature)
        };
        match event {
            Event::Meets(pair, point) => self.met.push((pair as u32, point)),
            Event::LetsGo(k, p) => {
                let (pair, feature) = name(k, p);
                self.hints.push(Hint::LetsGo(pair, feature));
            }
            Event::Breaks(k) => {
                let (pair, feature) = name(k, 0);
                // Friction holds against the way it goes.
                let sigma = -modes.contacts[k].force[2].signum();
                self.hints.push(Hint::Breaks(pair, feature, sigma));
            }
            Event::Stops(k) => {
                // With it stop those whose slip is below the error: what moves together stops together.
                let with = |(j, contact): &(usize, &Contact)| {
                    let slip = contact.slip_speed(modes.frames(contact.slots), self.motion.twists);
                    *j == k || slip.abs() <= self.tolerated(contact)
                };
                let stopped = modes.contacts.iter().enumerate().filter(with);
                let hints = stopped.map(|(j, _)| {
                    let (pair, feature) = name(j, 0);
                    Hint::Stopped(pair, feature)
                });
                let hints: Vec<Hint> = hints.collect();
                self.hints.extend(hints);
            }
            Event::Leaves(..) => {}
        }
    }

    /// Speed (m/s) at a contact that is below the tolerated error: of what its bodies do, and of what gravity does over their size.
    fn tolerated(&self, contact: &Contact) -> Real {
        let none = vec![Twist::ZERO; self.motion.twists.len()];
        let width = self.island.pairs[contact.pair as usize].width;
        let pull = (self.system.forces.gravity.norm() * width).sqrt();
        1e3 * still(self.island, contact, self.motion.twists, &none) + self.island.tolerance * pull
    }

    /// Notes the forces of the contacts at the end.
    pub(super) fn note_bearing(&mut self) -> Result<()> {
        if !self.system.modes.as_ref().is_some_and(|modes| modes.bears()) {
            return Ok(());
        }
        self.accelerations()?;
        let contacts = self.system.modes.iter().flat_map(|modes| &modes.contacts);
        let bearing = contacts.filter(|contact| contact.bears()).map(|contact| Bearing {
            pair: contact.pair,
            features: [0, 1].map(|p| contact.points[p.min(contact.count - 1)].feature),
            force: contact.force,
            slides: matches!(contact.slip, Slip::Slides(_)),
        });
        self.outcome.bearing = bearing.collect();
        Ok(())
    }

    /// Notes which bodies got farther than was looked.
    fn note_thrown(&mut self) {
        let bodies = self.motion.poses.iter().zip(&self.start).zip(&self.island.reach).enumerate();
        for (slot, ((now, start), reach)) in bodies {
            let way = (now.position - start.position).norm();
            if way > *reach {
                self.outcome.thrown.push((slot as u32, way));
            }
        }
    }
}

fn accelerations_of([a, b]: [&Twist; 2]) -> Real {
    a.linear.norm() + b.linear.norm() + a.angular.abs() + b.angular.abs()
}
