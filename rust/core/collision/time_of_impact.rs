//! When two moving and turning shapes first come within a distance of one another.
//!
//! Conservative advancement (Mirtich 1996): from a fraction of the way at which the shapes are apart, go on as far
//! as they provably stay apart, measure the distance again, and so on. How far that is follows from a *gap*:
//! a function of time, below the distance at all times, whose second derivative has a bound C. Over a stretch Δ
//! on which it goes from g₀ to g₁ it is nowhere below
//!
//! g₀ + (g₁ − g₀) s/Δ − ½ C s (Δ − s),
//!
//! so that the last stretch ends on the root of the gap itself, and shapes that pass near one another without
//! touching cost few steps. Gaps are of two kinds:
//!
//! - along an axis that stands still or turns with A or with B: between the extents of the two shapes along it.
//!   Extents are maxima of sinusoids p·u(φ): with ends on tangents of a shape within ρ of the centre of turning,
//!   at most a quarter turn apart, they stay below the sinusoid through both ends, which bends by at
//!   most ρ (1 + √½);
//! - of a shape within the circle of an arc: the radius less the largest distance from the centre, which is a
//!   maximum of convex functions but for what turning bends.
//!
//! Where no gap comes near the distance (something half way through the opening of an arc), the arc is halved.

use std::f64::consts::FRAC_PI_2;

use super::core::{Core, halves};
use super::distance::between;
use super::{Collider, Frame, Geometry};
use crate::math::{Pose, Real, Rot, Vec2, perp, vec2};

/// How a body goes through a step: position and angle on straight lines in time. The angle is not wrapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Pose of the centre of mass at fraction 0.
    pub from: Pose,
    /// At fraction 1.
    pub to: Pose,
}

impl Sweep {
    /// The pose on the way.
    #[must_use]
    pub fn at(&self, fraction: Real) -> Pose {
        let position = self.from.position + (self.to.position - self.from.position) * fraction;
        Pose::new(position, self.from.angle + (self.to.angle - self.from.angle) * fraction)
    }

    fn turn(&self) -> Real {
        self.to.angle - self.from.angle
    }
}

/// Where two shapes first come near one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Of the way, 0 … 1.
    pub fraction: Real,
    /// Point on the surface of A, relative to the centre of mass of A, along the axes of the world (m).
    pub on_a: Vec2,
    /// Unit vector from A to B, along the axes of the world.
    pub normal: Vec2,
}

/// First fraction of the way at which the distance of two shapes is `target` (m, at least 0), or 0 if they are
/// nearer at once; None if they stay farther apart.
///
/// It is met to a thousandth of `target`, but no better than positions are known, and never passed by more. If
/// that takes more than some thousand steps, the fraction up to which the shapes surely stay apart is returned.
#[must_use]
pub fn time_of_impact(
    a: &Collider,
    sweep_a: &Sweep,
    b: &Collider,
    sweep_b: &Sweep,
    target: Real,
) -> Option<Real> {
    first_impact((&a.geometry, sweep_a), (&b.geometry, sweep_b), target).map(|hit| hit.fraction)
}

/// As [`time_of_impact`], and where it is.
#[must_use]
pub fn first_impact(
    (a, sweep_a): (&Geometry, &Sweep),
    (b, sweep_b): (&Geometry, &Sweep),
    target: Real,
) -> Option<Impact> {
    let (core_a, core_b) = (Core::from(a), Core::from(b));
    let reach = [core_a, core_b].map(|core| core.extent_from(Vec2::zeros()));
    let motion = Motion::new(sweep_a, sweep_b);
    let radii = core_a.radius() + core_b.radius();
    let size = reach[0] + reach[1] + radii + motion.offset.norm() + motion.velocity.norm();
    let tolerance = (ROUNDING * size).max(PRECISION * target);
    let (from, until) = motion.within(reach[0] + reach[1] + radii + target + tolerance)?;
    let mut search = Search { motion, reach, radii, target, tolerance, until, steps: MOST_STEPS };
    search.first(core_a, core_b, from)
}

/// Of a target, the part that is not resolved.
const PRECISION: Real = 1e-3;
/// Of all lengths together, what rounding may lose.
const ROUNDING: Real = 64.0 * Real::EPSILON;
/// Number of distances measured, at most.
const MOST_STEPS: u32 = 4000;

/// How B moves as seen from A, along the axes of the world.
struct Motion {
    offset: Vec2,
    velocity: Vec2,
    angles: [Real; 2],
    turns: [Real; 2],
}

impl Motion {
    fn new(a: &Sweep, b: &Sweep) -> Self {
        // Positions first, so that places far from the origin keep their digits.
        let offset = b.from.position - a.from.position;
        let end = b.to.position - a.to.position;
        Self {
            offset,
            velocity: end - offset,
            angles: [a.from.angle, b.from.angle],
            turns: [a.turn(), b.turn()],
        }
    }

    fn offset_at(&self, time: Real) -> Vec2 {
        self.offset + self.velocity * time
    }

    fn rotations_at(&self, time: Real) -> [Rot; 2] {
        [0, 1].map(|i| Rot::new(self.angles[i] + self.turns[i] * time))
    }

    /// The stretch on which the centres are within a distance of one another, if any.
    fn within(&self, distance: Real) -> Option<(Real, Real)> {
        let speed = self.velocity.norm();
        if speed == 0.0 {
            return (self.offset.norm() <= distance).then_some((0.0, 1.0));
        }
        let along = self.velocity / speed;
        let (ahead, aside) = (-self.offset.dot(&along), self.offset.dot(&perp(along)));
        let square = (distance - aside) * (distance + aside);
        if square < 0.0 {
            return None;
        }
        let (enter, leave) = ((ahead - square.sqrt()) / speed, (ahead + square.sqrt()) / speed);
        (enter <= 1.0 && leave >= 0.0).then_some((enter.max(0.0), leave.min(1.0)))
    }
}

/// A function of time that is nowhere above the distance.
#[derive(Clone, Copy)]
enum Gap {
    /// Along an axis that is `normal` at the time `since` and turns at the rate `spin`.
    Axis { normal: Vec2, since: Real, spin: Real },
    /// Between the circle of the arc A and the farthest point of B inside it.
    InsideA,
    /// The same with A and B exchanged.
    InsideB,
}

struct Search {
    motion: Motion,
    reach: [Real; 2],
    radii: Real,
    target: Real,
    tolerance: Real,
    until: Real,
    steps: u32,
}

/// Advancing.
impl Search {
    fn first(&mut self, a: Core<'_>, b: Core<'_>, from: Real) -> Option<Impact> {
        let mut time = from;
        let mut axis = vec2(1.0, 0.0);
        let mut axis_is_known = false;
        loop {
            let frames = self.frames(time);
            let closest = between(a, b, &frames.1);
            // Of two points that touch, the last axis is better known than the line between them.
            if !axis_is_known || closest.distance > 100.0 * self.tolerance {
                axis = frames.0.apply(closest.normal);
                axis_is_known = true;
            }
            let here = Impact { fraction: time, on_a: frames.0.apply(closest.on_a), normal: axis };
            if closest.distance <= self.target + self.tolerance || self.steps == 0 {
                return Some(here);
            }
            self.steps -= 1;
            let normal = frames.0.apply(closest.normal);
            let (widest, stretch) = self.longest_stretch(a, b, time, normal);
            if time + stretch >= self.until {
                return None;
            }
            let poor = widest - self.target < 0.5 * (closest.distance - self.target);
            if poor && let Some(pieces) = self.split(a, b) {
                return self.first_of(pieces, time);
            }
            if time + stretch <= time {
                return Some(here);
            }
            time += stretch;
        }
    }

    /// The nearer pair first, since what it finds bounds the search of the other.
    fn first_of(&mut self, mut pairs: [(Core<'_>, Core<'_>); 2], time: Real) -> Option<Impact> {
        let (_, b_in_a) = self.frames(time);
        let [near, far] = pairs.map(|(a, b)| between(a, b, &b_in_a).distance);
        if far < near {
            pairs.reverse();
        }
        let until = self.until;
        let mut hit: Option<Impact> = None;
        for (a, b) in pairs {
            hit = self.first(a, b, time).or(hit);
            self.until = hit.as_ref().map_or(until, |hit| hit.fraction);
        }
        hit
    }

    /// The rotation of A, and B as seen from A.
    fn frames(&self, time: Real) -> (Rot, Frame) {
        let [rot_a, rot_b] = self.motion.rotations_at(time);
        let a = Frame { position: Vec2::zeros(), rot: rot_a };
        let b = Frame { position: self.motion.offset_at(time), rot: rot_b };
        (rot_a, b.seen_from(&a))
    }

    /// The widest gap now, and the longest time for which one surely stays above the target.
    fn longest_stretch(&self, a: Core<'_>, b: Core<'_>, time: Real, normal: Vec2) -> (Real, Real) {
        let [turn_a, turn_b] = self.motion.turns;
        let axis = |spin| Some(Gap::Axis { normal, since: time, spin });
        let gaps = [
            axis(0.0),
            if turn_a == 0.0 { None } else { axis(turn_a) },
            if turn_b == 0.0 || turn_b == turn_a { None } else { axis(turn_b) },
            if let Core::Arc(_) = a { Some(Gap::InsideA) } else { None },
            if let Core::Arc(_) = b { Some(Gap::InsideB) } else { None },
        ];
        let mut best = (Real::NEG_INFINITY, 0.0);
        for gap in gaps.into_iter().flatten() {
            let bounded = Bounded { search: self, a, b, gap, time, now: self.gap(a, b, gap, time) };
            if bounded.now > self.target && time + best.1 < self.until {
                best.1 = bounded.longest().max(best.1);
            }
            best.0 = bounded.now.max(best.0);
        }
        best
    }

    /// The two halves of the longer arc, each with the other shape; None where the halves of an arc would differ
    /// from it by less than the tolerance.
    fn split<'c>(&self, a: Core<'c>, b: Core<'c>) -> Option<[(Core<'c>, Core<'c>); 2]> {
        let bulge = |core: Core<'_>| match core {
            Core::Arc(arc) => arc.radius * arc.sweep * arc.sweep,
            Core::Convex(_) => 0.0,
        };
        if bulge(a).max(bulge(b)) <= self.tolerance {
            return None;
        }
        match (a, b) {
            (Core::Arc(arc), _) if bulge(a) >= bulge(b) => {
                Some(halves(&arc).map(|half| (Core::Arc(half), b)))
            }
            (_, Core::Arc(arc)) => Some(halves(&arc).map(|half| (a, Core::Arc(half)))),
            _ => None,
        }
    }
}

/// Gaps.
impl Search {
    fn gap(&self, a: Core<'_>, b: Core<'_>, gap: Gap, time: Real) -> Real {
        let offset = self.motion.offset_at(time);
        let [rot_a, rot_b] = self.motion.rotations_at(time);
        let apart = match gap {
            Gap::Axis { normal, since, spin } => {
                let normal = Rot::new(spin * (time - since)).apply(normal);
                normal.dot(&offset)
                    - b.support(rot_b.apply_inverse(-normal))
                    - a.support(rot_a.apply_inverse(normal))
            }
            Gap::InsideA => inside(a, b, (rot_a, rot_b), offset),
            Gap::InsideB => inside(b, a, (rot_b, rot_a), -offset),
        };
        apart - self.radii
    }

    /// Bound of the second derivative of a gap over a stretch, and the longest stretch for which it holds.
    fn bend(&self, gap: Gap, time: Real) -> Bend {
        // What the sinusoid through two tangents a quarter turn apart bends by, see above.
        const TANGENTS: Real = 1.0 + std::f64::consts::FRAC_1_SQRT_2;
        let [turn_a, turn_b] = self.motion.turns;
        let [reach_a, reach_b] = self.reach;
        let relative = turn_b - turn_a;
        let (spin, turning, longest) = match gap {
            Gap::Axis { spin, .. } => {
                let (a, b) = (turn_a - spin, turn_b - spin);
                let fastest = a.abs().max(b.abs());
                (spin, TANGENTS * (a * a * reach_a + b * b * reach_b), FRAC_PI_2 / fastest)
            }
            Gap::InsideA => (turn_a, relative * relative * reach_b, Real::INFINITY),
            Gap::InsideB => (turn_b, relative * relative * reach_a, Real::INFINITY),
        };
        let speed = self.motion.velocity.norm();
        let fixed = 2.0 * speed * spin.abs() + turning;
        let longest = longest.min(self.until - time);
        Bend { fixed, per_offset: spin * spin, longest }
    }
}

/// Radius of an arc less the largest distance of the other core from its centre; `offset` leads from the body
/// of the arc to that of the other.
fn inside(arc: Core<'_>, other: Core<'_>, (rot_arc, rot_other): (Rot, Rot), offset: Vec2) -> Real {
    let Core::Arc(arc) = arc else { return Real::NEG_INFINITY };
    let center = rot_other.apply_inverse(rot_arc.apply(arc.center) - offset);
    arc.radius - other.extent_from(center)
}

/// Second derivative: `fixed` + `per_offset` · |offset of the bodies|.
struct Bend {
    fixed: Real,
    per_offset: Real,
    longest: Real,
}

/// A gap from some time on.
struct Bounded<'s, 'c> {
    search: &'s Search,
    a: Core<'c>,
    b: Core<'c>,
    gap: Gap,
    time: Real,
    now: Real,
}

impl Bounded<'_, '_> {
    /// Lowest that the gap may be within a stretch.
    fn lowest(&self, bend: &Bend, stretch: Real) -> Real {
        let end = self.time + stretch;
        let after = self.search.gap(self.a, self.b, self.gap, end);
        let offset = |time| self.search.motion.offset_at(time).norm();
        let bend = bend.fixed + bend.per_offset * offset(self.time).max(offset(end));
        let least = self.now.min(after);
        if bend == 0.0 {
            return least;
        }
        let deepest = stretch / 2.0 - (after - self.now) / stretch / bend;
        if deepest <= 0.0 || deepest >= stretch {
            return least;
        }
        least.min(self.now - bend * deepest * deepest / 2.0)
    }

    /// A long stretch for which the gap stays above the target, found between one that is too long and one that
    /// is not by the secant and the geometric mean in turn: the secant ends on the root, the mean gets there
    /// from afar.
    fn longest(&self) -> Real {
        const TRIALS: u32 = 12;
        const ENOUGH: Real = 0.05;
        let (target, aim) = (self.search.target, self.search.target + self.search.tolerance / 2.0);
        let bend = self.search.bend(self.gap, self.time);
        let margin = |stretch: Real| self.lowest(&bend, stretch) - aim;
        let (mut low, mut high) = ((0.0, self.now - aim), (bend.longest, margin(bend.longest)));
        if high.1 + aim >= target {
            return high.0;
        }
        for trial in 0..TRIALS {
            let secant = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1)).clamp(0.0, 1.0);
            let mean = if low.0 > 0.0 { (low.0 * high.0).sqrt() } else { high.0 / 16.0 };
            let middle = if trial % 2 == 0 { secant } else { mean };
            if !(low.0 < middle && middle < high.0) {
                continue;
            }
            let value = margin(middle);
            if value + aim < target {
                high = (middle, value);
                continue;
            }
            low = (middle, value);
            if value <= ENOUGH * (self.now - aim) || high.0 < 1.1 * low.0 {
                break;
            }
        }
        low.0
    }
}
