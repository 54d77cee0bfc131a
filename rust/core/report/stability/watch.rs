//! A hard scene under way: what is seen of it, and how that is judged.

use std::ops::Range;

use super::{Cell, LOOKS, State, USUAL, Verdict, states};
use crate::error::Result;
use crate::math::{Real, Vec2};
use crate::scenes::hard::{Hard, Should};
use crate::world::World;

/// Ways and gaps over the size, and speeds over √(size·g), from which on a scene creeps, falls, explodes.
const CREEP: Real = 0.02;
const FALL: Real = 0.5;
const SLOW: Real = 1e-2;
const FAR: Real = 1e3;
const FAST: Real = 1e2;
/// Gains of energy, as a part of what there was and of a fall by the size, that count; and that double it.
const GAIN: Real = 1e-3;
const DOUBLE: Real = 1.0;
/// Disks of a crowd that are so many sizes away were thrown: 50 of them fill a circle of four sizes.
const THROWN: Real = 50.0;

/// What comes of a hard scene, from states alone: the same for every engine.
pub struct Watch<'a> {
    hard: &'a Hard,
    world: World,
    start: Vec<State>,
    energy: Real,
    gained: Real,
    looks: usize,
    seen: Vec<Vec<State>>,
    different: usize,
    lost: Option<Verdict>,
}

impl<'a> Watch<'a> {
    /// Before the first run.
    ///
    /// # Errors
    /// Those of making the world.
    pub fn start(hard: &'a Hard) -> Result<Self> {
        let world = (hard.build)()?;
        let start = states(&world);
        let (seen, looks, different) = (Vec::new(), 0, 0);
        let mut watch = Self {
            hard,
            world,
            start,
            energy: 0.0,
            gained: 0.0,
            looks,
            seen,
            different,
            lost: None,
        };
        watch.energy = watch.energy_of(&watch.start);
        Ok(watch)
    }

    /// The world as it starts.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// How many runs are asked for.
    #[must_use]
    pub fn runs(&self) -> u32 {
        if matches!(self.hard.should, Should::Repeat) { 2 } else { 1 }
    }

    /// One run at steps of `dt` (s): `advance` takes the steps of these numbers and gives the states after them, none
    /// where the engine gives up. Gives the last states.
    pub fn run(
        &mut self,
        dt: Real,
        mut advance: impl FnMut(Range<u32>) -> Option<Vec<State>>,
    ) -> Vec<State> {
        let steps = self.hard.steps(dt);
        let every = (steps / LOOKS).max(1);
        let (mut done, mut last) = (0, self.start.clone());
        self.looks = 0;
        while done < steps && self.lost.is_none() {
            let then = (done + every).min(steps);
            match advance(done..then) {
                Some(states) => {
                    last = states;
                    self.look(&last);
                }
                None => self.lost = Some(Verdict::Refuses),
            }
            done = then;
        }
        last
    }

    fn look(&mut self, states: &[State]) {
        let numbers = |s: &State| {
            let ([x, y], turn) =
                ([s.pose.position, s.twist.linear], [s.pose.angle, s.twist.angular]);
            [x.x, x.y, turn[0], y.x, y.y, turn[1]]
        };
        if states.len() < self.start.len() || !states.iter().flat_map(numbers).all(Real::is_finite)
        {
            self.lost = Some(Verdict::Nan);
            return;
        }
        match self.hard.should {
            Should::Calm => {
                let size = self.hard.size * self.world.settings().gravity.norm();
                let fall = self.world.mass() * size;
                let kinetic: Real = self.free().map(|i| self.kinetic(i, &self.start[i])).sum();
                let gained = (self.energy_of(states) - self.energy) / (kinetic + fall);
                self.gained = self.gained.max(gained);
            }
            Should::Repeat if self.seen.len() == self.looks => self.seen.push(states.to_vec()),
            Should::Repeat => {
                let before = &self.seen[self.looks];
                let pairs = states.iter().flat_map(numbers).zip(before.iter().flat_map(numbers));
                self.different += pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            }
            _ => {}
        }
        self.looks += 1;
    }

    /// The bodies that forces move.
    fn free(&self) -> impl Iterator<Item = usize> + '_ {
        let masses = self.world.bodies().masses.iter().enumerate();
        masses.filter(|(_, mass)| mass.is_free()).map(|(i, _)| i)
    }

    fn kinetic(&self, i: usize, state: &State) -> Real {
        let mass = &self.world.bodies().masses[i];
        let spin = mass.inertia * state.twist.angular * state.twist.angular;
        0.5 * (mass.mass * state.twist.linear.norm_squared() + spin)
    }

    /// Kinetic energy and that of heights (J).
    fn energy_of(&self, states: &[State]) -> Real {
        let (bodies, gravity) = (self.world.bodies(), self.world.settings().gravity);
        let of = |i: usize| {
            let center = states[i].pose.apply(bodies.local_centers[i]);
            self.kinetic(i, &states[i]) - bodies.masses[i].mass * gravity.dot(&center)
        };
        self.free().map(of).sum()
    }

    /// What came of it, by the states at the end.
    #[must_use]
    pub fn cell(&self, engine: &str, rate: Real, last: &[State]) -> Cell {
        let (verdict, figure) = self.judge(last);
        let picture = rate == USUAL && !last.is_empty() && verdict != Verdict::Nan;
        Cell {
            engine: engine.to_owned(),
            step: self.hard.tempo / rate,
            verdict,
            figure,
            picture: picture.then(|| self.outlines(last)),
        }
    }

    fn judge(&self, last: &[State]) -> (Verdict, Option<Real>) {
        if let Some(lost) = self.lost {
            return (lost, None);
        }
        let size = self.hard.size;
        let way = |i: usize| (last[i].pose.position - self.start[i].pose.position).norm() / size;
        let ways = || self.free().map(way).fold(0.0, Real::max);
        let (verdict, figure) = match self.hard.should {
            Should::Stand => self.stand(last, ways()),
            Should::Hold => {
                let gap = self.gap(last) / size;
                (if gap > FAR { Verdict::Explodes } else { graded(gap) }, gap)
            }
            Should::Stop(end) => {
                let lost = self.free().filter(|i| last[*i].pose.position.x > end).count();
                (if lost == 0 { Verdict::Right } else { Verdict::Falls }, lost as Real)
            }
            Should::Turn => {
                let spin = |i: usize| last[i].twist.angular / self.start[i].twist.angular;
                let lost = self.free().map(|i| (1.0 - spin(i)).abs()).fold(0.0, Real::max);
                (graded(lost), lost)
            }
            Should::End(exact) => {
                let pairs = self.free().zip(exact());
                let apart = pairs.map(|(i, exact)| (last[i].pose.position - exact).norm() / size);
                let apart = apart.fold(0.0, Real::max);
                (if apart > FAR { Verdict::Explodes } else { graded(apart) }, apart)
            }
            Should::Calm => (self.calm(last), self.gained),
            Should::Part => {
                let overlap = self.overlap(last);
                (if ways() > THROWN { Verdict::Explodes } else { graded(overlap) }, overlap)
            }
            Should::Repeat => {
                let same = if self.different == 0 { Verdict::Right } else { Verdict::Falls };
                (same, self.different as Real)
            }
        };
        (verdict, Some(figure))
    }

    fn stand(&self, last: &[State], way: Real) -> (Verdict, Real) {
        let fall = (self.hard.size * self.world.settings().gravity.norm()).sqrt();
        let speed = self.speed(last) / fall;
        let verdict = match graded(way) {
            _ if way > FAR || speed > FAST => Verdict::Explodes,
            Verdict::Right if speed > SLOW => Verdict::Creeps,
            verdict => verdict,
        };
        (verdict, way)
    }

    fn calm(&self, last: &[State]) -> Verdict {
        let bodies = self.world.bodies();
        let height = |i: usize| last[i].pose.apply(bodies.local_centers[i]).y / self.hard.size;
        if self.free().any(|i| height(i) < -CREEP) {
            return Verdict::Falls;
        }
        match self.gained {
            gained if gained > DOUBLE => Verdict::Explodes,
            gained if gained > GAIN => Verdict::Creeps,
            _ => Verdict::Right,
        }
    }

    /// Root of the mean square of the speeds (m/s).
    fn speed(&self, last: &[State]) -> Real {
        let (sum, count) = self.free().fold((0.0, 0.0), |(sum, count), i| {
            (sum + last[i].twist.linear.norm_squared(), count + 1.0)
        });
        (sum / Real::max(count, 1.0)).sqrt()
    }

    /// How far the anchors of a joint are apart, at most (m).
    fn gap(&self, last: &[State]) -> Real {
        let bodies = self.world.bodies();
        let gap = |joint: &crate::joint::Joint| {
            let locals = joint.anchors();
            let ends = [0, 1].map(|side| {
                let body = joint.def.bodies[side].and_then(|handle| bodies.index(handle).ok());
                body.map_or(locals[side], |i| last[i].pose.apply(locals[side]))
            });
            (ends[1] - ends[0]).norm()
        };
        self.world.joints().iter().map(gap).fold(0.0, Real::max)
    }

    /// Deepest overlap of two disks as large as the scene's size, over it.
    fn overlap(&self, last: &[State]) -> Real {
        let free: Vec<Vec2> = self.free().map(|i| last[i].pose.position).collect();
        let mut deepest: Real = 0.0;
        for (k, one) in free.iter().enumerate() {
            let near = free[..k].iter().map(|other| (one - other).norm());
            deepest = near.fold(deepest, |deepest, far| deepest.max(1.0 - far / self.hard.size));
        }
        deepest
    }

    /// Outlines of all shapes where they are now.
    fn outlines(&self, last: &[State]) -> Vec<Vec<Vec2>> {
        const ARC: Real = crate::math::PI / 8.0;
        let mut outlines = Vec::new();
        for (info, state) in self.world.bodies().infos.iter().zip(last) {
            for ring in info.def.shapes.iter().flat_map(|part| part.shape.outline(ARC)) {
                outlines.push(ring.points.iter().map(|p| state.pose.apply(*p)).collect());
            }
        }
        outlines
    }
}

fn graded(figure: Real) -> Verdict {
    match figure {
        x if x > FALL => Verdict::Falls,
        x if x > CREEP => Verdict::Creeps,
        _ => Verdict::Right,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::hard::HARD;

    /// What is said of a scene whose every look shows these states.
    fn verdict(hard: &Hard, change: impl Fn(&mut State)) -> Verdict {
        let mut watch = Watch::start(hard).unwrap();
        let mut seen = watch.start.clone();
        let last = watch.free().last().unwrap();
        change(&mut seen[last]);
        for _ in 0..watch.runs() {
            seen = watch.run(hard.tempo / USUAL, |_| Some(seen.clone()));
        }
        watch.cell("none", USUAL, &seen).verdict
    }

    #[test]
    fn what_stays_is_right_and_what_moves_is_not() {
        for hard in HARD {
            let still = verdict(hard, |_| {});
            let moves = matches!(hard.should, Should::End(_) | Should::Part);
            assert_eq!(still == Verdict::Right, !moves, "{}", hard.name);
            let moved = verdict(hard, |state| {
                state.pose.position += crate::math::vec2(2.0, 3.0) * hard.size;
                state.twist.angular *= 2.0;
                state.twist.linear *= 2.0;
            });
            let fine = matches!(hard.should, Should::Stop(_) | Should::Repeat);
            assert_eq!(moved == Verdict::Right, fine, "{}: {moved:?}", hard.name);
            let lost = verdict(hard, |state| state.pose.angle = Real::NAN);
            assert_eq!(lost, Verdict::Nan, "{}", hard.name);
        }
    }

    #[test]
    fn what_passes_differs_sinks_or_gives_up_is_seen() {
        let find = |name| HARD.iter().find(|hard| hard.name == name).unwrap();
        let passed = verdict(find("fast disks"), |state| state.pose.position.x = 1.0);
        assert_eq!(passed, Verdict::Falls);
        let sunk = verdict(find("needle 1000 : 1"), |state| state.pose.position.y = -1.0);
        assert_eq!(sunk, Verdict::Falls);
        let hard = find("the same again");
        let mut watch = Watch::start(hard).unwrap();
        for first in [0.0, 1e-300] {
            let mut seen = watch.start.clone();
            seen[1].twist.linear.x = first;
            watch.run(1.0 / USUAL, |_| Some(seen.clone()));
        }
        assert_eq!(watch.judge(&watch.start), (Verdict::Falls, Some(Real::from(LOOKS))));
        let mut watch = Watch::start(hard).unwrap();
        watch.run(1.0 / USUAL, |_| None);
        assert_eq!(watch.judge(&watch.start), (Verdict::Refuses, None));
    }

    #[test]
    fn steps_that_vary_are_spread_evenly_by_their_logarithms() {
        let hard = HARD.iter().find(|hard| hard.varies).unwrap();
        let steps: Vec<Real> = (0..1000).map(|k| hard.step(k, 1.0)).collect();
        let (least, most) =
            steps.iter().fold((1.0, 1.0), |(a, b): (Real, Real), s| (a.min(*s), b.max(*s)));
        assert!(least > 0.249 && least < 0.26 && most > 3.9 && most < 4.01, "{least}, {most}");
        // The mean of 4^u for u in -1..1.
        let mean = steps.iter().sum::<Real>() / 1000.0;
        assert!((mean - (4.0 - 0.25) / (2.0 * 4.0_f64.ln())).abs() < 0.01, "{mean}");
    }
}
