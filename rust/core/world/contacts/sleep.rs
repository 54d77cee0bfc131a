//! Islands that rest: put aside, with their pairs and impulses, until something wakes them.

use serde::{Deserialize, Serialize};

use super::near::Kind;
use super::view::seen;
use super::{Contacts, Near, Patch, margin};
use crate::body::Bodies;
use crate::collision::{Frame, ProxyId};
use crate::math::{Pose, Real, Twist};

/// A sleeping island: its bodies, and the pairs in which only they could move.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Resting {
    bodies: Vec<u32>,
    near: Vec<Near>,
    patches: Vec<Patch>,
    /// Length (s) of the substep that the impulses are of.
    substep: Real,
}

/// What a call has changed, to go back to if it fails.
#[derive(Clone, Debug)]
enum Change {
    Slept(u32),
    Woke(u32, Resting, Vec<Pose>),
}

/// Which bodies sleep. Columns are in body order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(in crate::world) struct Sleep {
    /// For how long each body has been slow and tied to something, as a part of the time after which it rests.
    pub slow: Vec<Real>,
    /// Number of each body's sleeping island, from 1; 0: awake.
    island: Vec<u32>,
    /// The islands by their numbers less 1; those without bodies are free.
    islands: Vec<Resting>,
    free: Vec<u32>,
    /// How many bodies sleep.
    pub count: usize,
    /// What the call at work has changed; nothing is kept outside one.
    #[serde(skip)]
    journal: Vec<Change>,
    #[serde(skip)]
    recording: bool,
}

/// Where a pair belongs.
enum Home {
    /// Among those that each step looks at.
    Active,
    /// With a sleeping island.
    With(u32),
    /// Between two that sleep: found again when one wakes.
    Nowhere,
}

impl Sleep {
    pub fn push(&mut self) {
        self.slow.push(0.0);
        self.island.push(0);
    }

    /// Forgets a body that is awake; the last one takes its place.
    pub fn swap_remove(&mut self, body: usize) {
        self.slow.swap_remove(body);
        self.island.swap_remove(body);
        let last = self.island.len() as u32;
        if let Some(number) = self.island.get(body).copied().filter(|number| *number > 0) {
            let bodies = &mut self.islands[number as usize - 1].bodies;
            bodies.iter_mut().filter(|other| **other == last).for_each(|i| *i = body as u32);
        }
    }

    /// Starts to keep what changes, or stops.
    pub fn record(&mut self, on: bool) {
        self.journal.clear();
        self.recording = on;
    }

    /// Pairs that are put aside.
    pub fn near(&self) -> impl Iterator<Item = &Near> {
        self.islands.iter().flat_map(|resting| &resting.near)
    }

    /// The same with their patches.
    pub fn pairs(&self) -> impl Iterator<Item = (&Near, &[Patch])> {
        self.islands.iter().flat_map(move |resting| {
            resting.near.iter().map(move |near| (near, &resting.patches[near.patches()]))
        })
    }

    /// Numbers of all sleeping islands.
    pub fn numbers(&self) -> Vec<u32> {
        let used = |number: &u32| !self.islands[*number as usize - 1].bodies.is_empty();
        (1..=self.islands.len() as u32).filter(used).collect()
    }

    fn note(&mut self, change: impl FnOnce() -> Change) {
        if self.recording {
            self.journal.push(change());
        }
    }

    /// Undoes what was kept. Returns whether there was anything.
    pub fn undo(&mut self, bodies: &mut Bodies) -> bool {
        let changed = !self.journal.is_empty();
        while let Some(change) = self.journal.pop() {
            match change {
                Change::Slept(number) => drop(self.empty(number)),
                Change::Woke(number, resting, poses) => {
                    for (i, pose) in resting.bodies.iter().zip(poses) {
                        (bodies.poses[*i as usize], bodies.twists[*i as usize]) =
                            (pose, Twist::ZERO);
                    }
                    self.fill(number, resting);
                }
            }
        }
        self.recording = false;
        changed
    }

    fn empty(&mut self, number: u32) -> Resting {
        let resting = std::mem::take(&mut self.islands[number as usize - 1]);
        self.free.push(number);
        self.count -= resting.bodies.len();
        for i in &resting.bodies {
            (self.island[*i as usize], self.slow[*i as usize]) = (0, 0.0);
        }
        resting
    }

    /// Undoes the last `empty`, or uses a number that is free or new.
    fn fill(&mut self, number: u32, resting: Resting) {
        if self.free.last() == Some(&number) {
            self.free.pop();
        } else {
            self.islands.push(Resting::default());
        }
        self.count += resting.bodies.len();
        for i in &resting.bodies {
            (self.island[*i as usize], self.slow[*i as usize]) = (number, 0.0);
        }
        self.islands[number as usize - 1] = resting;
    }
}

/// Falling asleep and waking.
impl Contacts {
    /// Whether a body sleeps.
    pub fn is_asleep(&self, body: usize) -> bool {
        self.sleep.island[body] != 0
    }

    /// Lets bodies sleep as one island, and returns the energy (J) that stopping them takes. Their pairs stay until
    /// [`Contacts::put_aside`].
    pub fn lay_down(&mut self, bodies: &mut Bodies, members: Vec<u32>) -> Real {
        let mut energy = 0.0;
        for i in &members {
            let i = *i as usize;
            energy += bodies.masses[i].kinetic_energy(&bodies.twists[i]);
            bodies.twists[i] = Twist::ZERO;
            self.touch(i);
        }
        let new = self.sleep.islands.len() as u32 + 1;
        let number = self.sleep.free.last().copied().unwrap_or(new);
        self.sleep
            .fill(number, Resting { bodies: members, substep: self.substep, ..Resting::default() });
        self.sleep.note(|| Change::Slept(number));
        energy
    }

    /// Puts the pairs aside in which nothing can move any more.
    pub fn put_aside(&mut self, bodies: &Bodies) {
        for pair in std::mem::take(&mut self.near) {
            match self.home(pair.proxies, bodies) {
                Home::With(number) => {
                    let resting = &mut self.sleep.islands[number as usize - 1];
                    let first = resting.patches.len() as u32;
                    resting.patches.extend_from_slice(&self.patches[pair.patches()]);
                    resting.near.push(Near { first, ..pair });
                }
                // A sensor goes on noticing.
                Home::Nowhere if !pair.touching => {
                    self.map.remove(pair.proxies[0], pair.proxies[1]);
                }
                Home::Nowhere | Home::Active => self.near.push(pair),
            }
        }
    }

    /// Takes in a pair that was just found.
    pub(super) fn take_in(&mut self, pair: Near, bodies: &Bodies) {
        match self.home(pair.proxies, bodies) {
            Home::With(number) => self.sleep.islands[number as usize - 1].near.push(pair),
            Home::Nowhere | Home::Active => self.near.push(pair),
        }
    }

    /// Whether both bodies of a pair sleep, each for itself: no pair is kept of them.
    pub(super) fn sleep_apart(&self, [i, j]: [usize; 2]) -> bool {
        let [p, q] = [i, j].map(|i| self.sleep.island[i]);
        p != 0 && q != 0 && p != q
    }

    fn home(&self, proxies: [ProxyId; 2], bodies: &Bodies) -> Home {
        let pair = proxies.map(|proxy| self.body_of(proxy) as usize);
        let still = |i: usize| !bodies.masses[i].is_free() && bodies.twists[i] == Twist::ZERO;
        match pair.map(|i| self.sleep.island[i]) {
            [0, 0] => Home::Active,
            [0, number] if still(pair[0]) => Home::With(number),
            [number, 0] if still(pair[1]) => Home::With(number),
            [0, _] | [_, 0] => Home::Active,
            [p, q] if p == q => Home::With(p),
            _ => Home::Nowhere,
        }
    }

    /// Wakes a sleeping island. Its impulses are as they were.
    pub fn wake(&mut self, bodies: &Bodies, number: u32) {
        let resting = self.sleep.empty(number);
        for i in &resting.bodies {
            // Pairs with what slept nearby are found again.
            self.of_body[*i as usize].iter().for_each(|proxy| self.broad.touch(*proxy));
        }
        let first = self.patches.len() as u32;
        self.near.extend(resting.near.iter().map(|n| Near { first: n.first + first, ..n.clone() }));
        let scale = if resting.substep > 0.0 { self.substep / resting.substep } else { 1.0 };
        self.patches.extend(resting.patches.iter().map(|patch| {
            let mut patch = *patch;
            patch.memory.impulse.iter_mut().for_each(|impulse| *impulse *= scale);
            patch.memory.rolling *= scale;
            patch
        }));
        self.sleep.note(|| {
            let poses = resting.bodies.iter().map(|i| bodies.poses[*i as usize]).collect();
            Change::Woke(number, resting, poses)
        });
    }

    /// The sleeping island of a body.
    pub fn island_of(&self, body: usize) -> Option<u32> {
        Some(self.sleep.island[body]).filter(|number| *number > 0)
    }

    /// Sleeping islands around the boxes in which a body is and was.
    pub fn islands_around(&self, bodies: &Bodies, body: usize) -> Vec<u32> {
        let mut numbers: Vec<u32> = self.island_of(body).into_iter().collect();
        let frame = Frame::of(&bodies.poses[body]);
        for proxy in &self.of_body[body] {
            let collider = &self.entries[proxy.0 as usize].collider;
            let now = collider.geometry.bounds_at(&frame).grown(margin(collider));
            for aabb in [self.broad.fat_box(*proxy), &now] {
                self.broad.query(aabb, &mut |other| {
                    numbers.extend(self.island_of(self.body_of(other) as usize));
                    true
                });
            }
        }
        sorted(numbers)
    }

    /// Sleeping islands that something awake touches, or comes to touch in the step. `motion` is the way and turn of a
    /// body in it.
    pub fn called(&self, bodies: &Bodies, motion: impl Fn(usize) -> Twist) -> Vec<u32> {
        let mut numbers = Vec::new();
        for (near, number) in self.half_asleep(bodies) {
            let pair = near.proxies.map(|proxy| self.body_of(proxy) as usize);
            let ways = pair.map(|i| if self.is_asleep(i) { Twist::ZERO } else { motion(i) });
            let [a, b] = pair.map(|i| &bodies.poses[i]);
            let apart = b.position - a.position;
            let meets = self.patches_of(near).iter().any(|patch| {
                let seen = seen(&patch.manifold, [a, b]);
                (0..patch.manifold.count).any(|k| {
                    let on_a = seen.points[k];
                    let way = ways[0].at(on_a) - ways[1].at(on_a - apart);
                    seen.gaps[k] <= seen.normal.dot(&way).max(0.0)
                })
            });
            if near.touching || meets {
                numbers.push(number);
            }
        }
        sorted(numbers)
    }

    /// Sleeping islands on which something awake has pressed in the step.
    pub fn struck(&self, bodies: &Bodies) -> Vec<u32> {
        let presses = |near: &Near| {
            let pressed = |patch: &Patch| patch.memory.impulse[0] + patch.memory.impulse[1] > 0.0;
            self.patches_of(near).iter().any(pressed)
        };
        let pressed = self.half_asleep(bodies).filter(|(near, _)| presses(near));
        sorted(pressed.map(|(_, number)| number).collect())
    }

    /// Pairs that resist, of a sleeping body and of one that moves, and the number of the island that sleeps.
    fn half_asleep(&self, bodies: &Bodies) -> impl Iterator<Item = (&Near, u32)> {
        let near = if self.sleep.count == 0 { &[] } else { &self.near[..] };
        near.iter().filter_map(|near| {
            let resists = matches!(near.kind, Kind::Solid | Kind::OneWay { solid: true });
            let pair = near.proxies.map(|proxy| self.body_of(proxy) as usize);
            let moves = |i: usize| bodies.masses[i].is_free() || bodies.twists[i] != Twist::ZERO;
            match pair.map(|i| self.sleep.island[i]) {
                [0, number] if number > 0 && resists && moves(pair[0]) => Some((near, number)),
                [number, 0] if number > 0 && resists && moves(pair[1]) => Some((near, number)),
                _ => None,
            }
        })
    }

    /// A body and all that are tied to it by joints or by what touched after the last step and moves.
    pub fn tied_to(
        &self,
        bodies: &Bodies,
        body: usize,
        joined: impl Iterator<Item = [u32; 2]>,
    ) -> Vec<u32> {
        let mut members = vec![body as u32];
        let mut tied: Vec<[u32; 2]> = (self.near.iter())
            .filter(|near| near.touching && near.kind != Kind::Sensor)
            .map(|near| near.proxies.map(|proxy| self.body_of(proxy)))
            .chain(joined)
            .filter(|pair| {
                pair.iter()
                    .all(|i| bodies.masses[*i as usize].is_free() && !self.is_asleep(*i as usize))
            })
            .collect();
        loop {
            let (known, open): (Vec<_>, Vec<_>) =
                tied.into_iter().partition(|pair| pair.iter().any(|i| members.contains(i)));
            if known.is_empty() {
                return sorted(members);
            }
            members = sorted(members.into_iter().chain(known.into_iter().flatten()).collect());
            tied = open;
        }
    }
}

/// In order, each once.
pub(super) fn sorted(mut numbers: Vec<u32>) -> Vec<u32> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}
