//! What errors of a run to a tolerance are measured against.

use crate::math::{Pose, Real, Twist};
use crate::methods::first_order;

/// The scales of all bodies of a run.
#[derive(Debug, Default)]
pub struct Scales {
    list: Vec<Scale>,
    /// How long the run is (s).
    duration: Real,
}

/// What the error of a body is measured against.
#[derive(Clone, Copy, Debug)]
struct Scale {
    start: Pose,
    size: Real,
    length: Real,
    angle: Real,
    speed: Real,
    spin: Real,
}

impl Scales {
    /// Those of bodies of these sizes (m) that start here.
    pub fn begin(&mut self, poses: &[Pose], size: impl Fn(usize) -> Real, duration: Real) {
        let scale = |(i, start): (usize, &Pose)| {
            let size = size(i);
            Scale { start: *start, size, length: size, angle: 1.0, speed: 0.0, spin: 0.0 }
        };
        self.list.clear();
        self.list.extend(poses.iter().enumerate().map(scale));
        self.duration = duration;
    }

    /// Becomes what another is after a step of length h from a state to its end. That other stays as it is until the step is
    /// accepted: what a step that went astray reached is no measure.
    pub fn extend(&mut self, other: &Self, [state, end]: [&[Real]; 2], h: Real) {
        self.clone_from(other);
        self.grow(state, h);
        self.grow(end, h);
    }

    /// Size of a body (m).
    pub fn size(&self, i: usize) -> Real {
        self.list[i].size
    }

    /// The way and the speeds grow with the run; nothing here depends on where the origin is.
    fn grow(&mut self, y: &[Real], h: Real) {
        let (poses, twists) = first_order::split(y);
        for ((scale, pose), twist) in self.list.iter_mut().zip(poses).zip(twists) {
            scale.grow(pose, twist, h);
        }
    }

    /// The largest relative error of all bodies, of errors by component of a flat column.
    pub fn worst(&self, error: impl Fn(usize) -> Real) -> Real {
        let n = self.list.len();
        let of_body = |(i, scale): (usize, &Scale)| scale.relative((i, n), self.duration, &error);
        self.list.iter().enumerate().map(of_body).fold(0.0, Real::max)
    }

    /// What no iteration between two states gets below, as a relative error: places are as exact as their numbers, velocities as
    /// those at a rate g (1/s).
    pub fn rounding(&self, [from, to]: [&[Real]; 2], g: Real) -> Real {
        let places = 3 * self.list.len();
        let size = |k: usize| from[k].abs().max(to[k].abs());
        self.worst(|k| {
            let (place, rate) = if k < places { (size(k), 1.0) } else { (size(k - places), g) };
            let own = if k < places { 0.0 } else { size(k) };
            ROUNDINGS * Real::EPSILON * (place * rate + own)
        })
    }

    /// Ways by which components of places are shifted to see how accelerations change, an angle's in radians.
    pub fn shift(&self, component: usize) -> Real {
        let scale = &self.list[component / 3];
        SHIFT * if component % 3 == 2 { scale.angle } else { scale.length }
    }

    /// The same of velocities, in steps of h.
    pub fn shift_of_velocity(&self, component: usize, h: Real) -> Real {
        let scale = &self.list[component / 3];
        let most = if component % 3 == 2 { scale.spin } else { scale.speed };
        (SHIFT * most).max(self.shift(component) / h)
    }
}

/// Roundings that add up in an evaluation.
const ROUNDINGS: Real = 16.0;

/// √ε: a difference over this part is as exact as differences to one side get.
pub const SHIFT: Real = 1.5e-8;

impl Clone for Scales {
    fn clone(&self) -> Self {
        Self { list: self.list.clone(), duration: self.duration }
    }

    fn clone_from(&mut self, other: &Self) {
        self.list.clone_from(&other.list);
        self.duration = other.duration;
    }
}

impl Scale {
    fn grow(&mut self, pose: &Pose, twist: &Twist, h: Real) {
        let way = (pose.position - self.start.position).norm();
        self.length = self.length.max(way).max(twist.linear.norm() * h);
        self.angle = self.angle.max((pose.angle - self.start.angle).abs());
        self.speed = self.speed.max(twist.linear.norm()).max(self.size * twist.angular.abs());
        self.spin = self.spin.max(twist.angular.abs());
    }

    /// Largest relative error of body i of n. Speeds also count against a length over the whole
    /// duration, so that a body that rests but for rounding does not ask for tiny steps.
    fn relative(
        &self,
        (i, n): (usize, usize),
        duration: Real,
        error: impl Fn(usize) -> Real,
    ) -> Real {
        let (q, v) = (3 * i, 3 * (n + i));
        let speed = self.speed.max(self.length / duration);
        let spin = self.spin.max(self.angle / duration);
        let parts = [
            (libm::hypot(error(q), error(q + 1)), self.length),
            (error(q + 2).abs(), self.angle),
            (libm::hypot(error(v), error(v + 1)), speed),
            (error(v + 2).abs(), spin),
        ];
        let relative = |(e, scale): (Real, Real)| if e == 0.0 { 0.0 } else { e / scale };
        // A number that is none is an error of any size.
        let worse = |a: Real, b: Real| if b.is_nan() { Real::INFINITY } else { a.max(b) };
        parts.into_iter().map(relative).fold(0.0, worse)
    }
}
