//! The circular wire.

use std::f64::consts::{PI, TAU};

use super::bounds::Interval;
use super::geometry::{Ring, steps};
use crate::math::{Real, Rot, Vec2, cross, sin_cos, vec2};

/// A circular arc, counter-clockwise from one unit vector to another, seen from its centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct WireArc {
    pub center: Vec2,
    pub radius: Real,
    from: Vec2,
    to: Vec2,
    reach: Reach,
    sweep: Real,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Reach {
    UpToHalf,
    BeyondHalf,
    Circle,
}

impl WireArc {
    pub fn new(center: Vec2, radius: Real, start: Real, sweep: Real) -> Self {
        let unit = |angle: Real| {
            let (sin, cos) = sin_cos(angle);
            vec2(cos, sin)
        };
        let (first, last) = (unit(start), unit(start + sweep));
        let (from, to) = if sweep < 0.0 { (last, first) } else { (first, last) };
        let reach = match sweep.abs() {
            x if x <= PI => Reach::UpToHalf,
            x if x < TAU => Reach::BeyondHalf,
            _ => Reach::Circle,
        };
        Self { center, radius, from, to, reach, sweep: sweep.abs() }
    }

    /// A polyline through points of the arc at most `max_angle` apart.
    pub fn outline(&self, max_angle: Real) -> Ring {
        let closed = self.reach == Reach::Circle;
        let steps = steps(self.sweep, max_angle);
        let point = |k: u32| {
            let turn = Rot::new(self.sweep * Real::from(k) / Real::from(steps));
            self.center + turn.apply(self.from) * self.radius
        };
        let last = if closed { steps - 1 } else { steps };
        Ring { points: (0..=last).map(point).collect(), closed }
    }

    /// Whether the ray from the centre along `direction` meets the arc.
    fn includes(&self, direction: Vec2) -> bool {
        let between = |a: Vec2, b: Vec2| cross(a, direction) >= 0.0 && cross(direction, b) >= 0.0;
        // Opposite a short arc both products vanish in rounding as well.
        let ahead = |a: Vec2, b: Vec2| a.dot(&direction) >= 0.0 || b.dot(&direction) >= 0.0;
        match self.reach {
            Reach::UpToHalf => between(self.from, self.to) && ahead(self.from, self.to),
            Reach::BeyondHalf => {
                cross(self.to, direction) <= 0.0 || cross(direction, self.from) <= 0.0
            }
            Reach::Circle => true,
        }
    }

    /// Extent along a unit vector, relative to the centre.
    pub fn span(&self, direction: Vec2) -> Interval {
        let mut span = Interval::of(&[self.from, self.to], direction);
        if self.includes(direction) {
            span = span.with(1.0);
        }
        if self.includes(-direction) {
            span = span.with(-1.0);
        }
        Interval { min: span.min * self.radius, max: span.max * self.radius }
    }

    /// The points that bound the extent along −direction and direction, and how far it goes beyond
    /// them, for an arc about `center`.
    pub fn bounds(&self, center: Vec2, direction: Vec2) -> ((Vec2, Real), (Vec2, Real)) {
        let end = |sign: Real| {
            if self.includes(direction * sign) {
                return (center, sign * self.radius);
            }
            let along = |p: Vec2| sign * p.dot(&direction);
            let farther = if along(self.from) > along(self.to) { self.from } else { self.to };
            (center + farther * self.radius, 0.0)
        };
        (end(-1.0), end(1.0))
    }

    /// Largest distance of a point of the arc from `point`.
    pub fn extent_from(&self, point: Vec2) -> Real {
        let away = self.center - point;
        if self.includes(away) {
            return away.norm() + self.radius;
        }
        let distance = |end: Vec2| (away + end * self.radius).norm();
        distance(self.from).max(distance(self.to))
    }
}
