//! The guard of a run in modes: it sees when a contact lets go, breaks away, comes to rest or reaches the end of its face, and
//! when shapes meet.

use super::arrival::{Pair, falling};
use super::modes::{Contact, Modes, Slip};
use super::path::{Path, Step};
use super::point::Point;
use crate::collision::Frame;
use crate::error::Result;
use crate::math::{Real, Twist};
use crate::methods::System;
use crate::methods::dop853_dense::Dense;
use crate::methods::first_order::{self, Columns};
use crate::methods::guard::Guard;

/// What ends the present modes.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// Shapes of a pair meet, here if it is known.
    Meets(usize, Option<Point>),
    /// Point of a contact bears no more.
    LetsGo(usize, usize),
    /// Surfaces of a contact break away.
    Breaks(usize),
    /// Surfaces of a contact come to rest against one another.
    Stops(usize),
    /// A point of a contact reaches the end of its face.
    Leaves(usize, usize),
}

/// Looks out for events in each step.
pub struct Lookout<'a> {
    /// What may meet.
    pub pairs: &'a [Pair<'a>],
    /// Features of each pair that bear, or have only just met, or are known to touch.
    pub watch: &'a [Watch],
    /// Time that has passed since the run began (s): what has just left is let get clear.
    pub passed: Real,
    /// The event that was found.
    pub event: Option<Event>,
    /// Its function and the rate of that where it was found.
    slope: Real,
    accelerations: Vec<Twist>,
}

/// How a pair is watched.
#[derive(Clone, Debug)]
pub enum Watch {
    /// It is apart from this time on (s), and leaves at these features until then.
    Apart(Real, Vec<u32>),
    /// It touches; these features bear.
    Touches(Vec<u32>),
}

/// How often a step is looked at for changes of modes.
const LOOKS: u32 = 8;

/// A bound that is missed by less than this part is kept.
const BOUND: Real = 1e-11;

impl<'a> Lookout<'a> {
    /// Over pairs.
    #[must_use]
    pub fn new(pairs: &'a [Pair<'a>], watch: &'a [Watch]) -> Self {
        Self { pairs, watch, passed: 0.0, event: None, slope: 0.0, accelerations: Vec::new() }
    }

    /// The value of an event's function in a state: above 0 before it, below after.
    fn value(
        &mut self,
        event: Event,
        state: &[Real],
        (system, time): (&mut System<'_>, Real),
    ) -> Result<Real> {
        let (poses, twists) = first_order::split(state);
        if let Event::Meets(pair, point) = event {
            let pair = &self.pairs[pair];
            let frames = pair.slots.map(|slot| Frame::of(&poses[slot as usize]));
            return Ok(match point {
                Some(point) => point.seen([&frames[0], &frames[1]]).gap,
                None => pair.distance(&frames),
            });
        }
        self.accelerations.resize(poses.len(), Twist::ZERO);
        system.accelerate(time, poses, twists, &mut self.accelerations)?;
        let Some(modes) = &system.modes else { return Ok(1.0) };
        Ok(of_mode(modes, event, twists))
    }

    /// First change of the modes in a step, as a fraction of it.
    fn first_change(
        &mut self,
        dense: &Dense,
        system: &mut System<'_>,
        (time, h): (Real, Real),
    ) -> Result<Option<(Real, Event)>> {
        let Some(modes) = &system.modes else { return Ok(None) };
        let events = changes(modes);
        if events.is_empty() {
            return Ok(None);
        }
        let mut before = 0.0;
        for k in 1..=LOOKS {
            let x = Real::from(k) / Real::from(LOOKS);
            let values = self.values(&events, (dense, x), (system, time + x * h))?;
            let mut first: Option<(Real, Event)> = None;
            for (event, value) in events.iter().zip(values) {
                if value >= 0.0 {
                    continue;
                }
                let mut failed = None;
                let f = |x: Real, own: &mut Self, system: &mut System<'_>| {
                    own.value(*event, &dense.at(x), (system, time + x * h))
                };
                let cell = std::cell::RefCell::new((&mut *self, &mut *system, &mut failed));
                let root = falling(
                    |x| {
                        let (own, system, failed) = &mut *cell.borrow_mut();
                        f(x, own, system).unwrap_or_else(|error| {
                            **failed = Some(error);
                            -1.0
                        })
                    },
                    [before, x],
                );
                if let Some(error) = failed {
                    return Err(error);
                }
                if first.is_none_or(|(least, _)| root < least) {
                    first = Some((root, *event));
                }
            }
            if first.is_some() {
                return Ok(first);
            }
            before = x;
        }
        Ok(None)
    }

    /// Values of all events at a fraction of the step.
    fn values(
        &mut self,
        events: &[Event],
        (dense, x): (&Dense, Real),
        (system, time): (&mut System<'_>, Real),
    ) -> Result<Vec<Real>> {
        let state = dense.at(x);
        let (poses, twists) = first_order::split(&state);
        self.accelerations.resize(poses.len(), Twist::ZERO);
        system.accelerate(time, poses, twists, &mut self.accelerations)?;
        let Some(modes) = &system.modes else { return Ok(Vec::new()) };
        Ok(events.iter().map(|event| of_mode(modes, *event, twists)).collect())
    }

    /// First meeting of a pair in a step.
    fn first_meeting(&self, path: &dyn Path, until: Real) -> Option<(Real, Event)> {
        let mut first: Option<(Real, Event)> = None;
        for (k, (pair, watch)) in self.pairs.iter().zip(self.watch).enumerate() {
            let to = first.as_ref().map_or(until, |(time, _)| *time);
            let met = match watch {
                Watch::Apart(clear, leaving) => {
                    pair.first_from(path, ((clear - self.passed).max(0.0), leaving), to)
                }
                Watch::Touches(bearing) => pair.first_feature(path, [0.0, to], bearing),
            };
            if let Some(met) = met.filter(|met| met.time < to) {
                first = Some((met.time, Event::Meets(k, met.point)));
            }
        }
        first
    }
}

impl Guard for Lookout<'_> {
    fn first(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        (time, h): (Real, Real),
    ) -> Result<Option<Real>> {
        let dense = Dense::new(y, system, time, h)?;
        let bodies = first_order::bodies(&y.state);
        let bends: Vec<[Real; 2]> = (0..bodies)
            .map(|i| {
                y.slopes.iter().fold([0.0; 2], |[linear, angular]: [Real; 2], slope| {
                    let a = &first_order::split(slope).1[i];
                    [linear.max(a.linear.norm()), angular.max(a.angular.abs())]
                })
            })
            .collect();
        let change = self.first_change(&dense, system, (time, h))?;
        let until = change.map_or(1.0, |(x, _)| x);
        let path = Step { dense: &dense, h, bends: &bends };
        let meeting = self.first_meeting(&path, until * h).map(|(at, event)| (at / h, event));
        let Some((x, event)) = meeting.or(change) else {
            self.passed += h;
            return Ok(None);
        };
        self.event = Some(event);
        // The rate of its function, for corrections.
        let near = (x - 1e-3).max(0.0);
        if x > near {
            let values =
                [near, x].map(|x| self.value(event, &dense.at(x), (&mut *system, time + x * h)));
            let [before, at] = values;
            self.slope = (at? - before?) / ((x - near) * h);
        } else {
            self.slope = 0.0;
        }
        Ok(Some(x))
    }

    fn correct(
        &mut self,
        y: &Columns,
        system: &mut System<'_>,
        (time, h): (Real, Real),
    ) -> Result<Real> {
        let Some(event) = self.event.filter(|_| self.slope < 0.0) else { return Ok(0.0) };
        let value = self.value(event, &y.stage, (system, time + h))?;
        let change = -value / self.slope;
        // Far off the dense output said nothing.
        Ok(if change.abs() <= 0.1 * h { change } else { 0.0 })
    }
}

/// What may end the modes.
fn changes(modes: &Modes) -> Vec<Event> {
    let mut events = Vec::new();
    for (k, contact) in modes.contacts.iter().enumerate().filter(|(_, contact)| contact.bears()) {
        for p in (0..contact.count).filter(|p| contact.on[*p]) {
            events.extend([Event::LetsGo(k, p), Event::Leaves(k, p)]);
        }
        let rubs = contact.touch.friction.sticking > 0.0;
        match contact.slip {
            Slip::Sticks if rubs => events.push(Event::Breaks(k)),
            Slip::Slides(_) if rubs => events.push(Event::Stops(k)),
            _ => {}
        }
    }
    events
}

/// The function of a change of modes where forces were last evaluated.
fn of_mode(modes: &Modes, event: Event, twists: &[Twist]) -> Real {
    let contact = |k: usize| &modes.contacts[k];
    let normal = |contact: &Contact| contact.force[0] + contact.force[1];
    match event {
        Event::Meets(..) => 1.0,
        Event::LetsGo(k, p) => contact(k).force[p] + BOUND * normal(contact(k)).abs(),
        Event::Breaks(k) => {
            let contact = contact(k);
            let bound = contact.touch.friction.sticking * normal(contact);
            bound * (1.0 + BOUND) - contact.force[2].abs()
        }
        Event::Stops(k) => {
            let contact = contact(k);
            let Slip::Slides(sigma) = contact.slip else { return 1.0 };
            sigma * contact.slip_speed(modes.frames(contact.slots), twists)
        }
        Event::Leaves(k, p) => {
            let contact = contact(k);
            let seen = contact.seen(p, modes.frames(contact.slots));
            contact.points[p].within_face(&seen).min(1.0 / Real::EPSILON)
                + 1e-9 * seen.arms[0].norm()
        }
    }
}
