//! Equal links one after another between two ends: what ropes, chains and bridges have in common.

use super::plan::{Plan, Side};
use crate::body::{BodyDef, BodyHandle};
use crate::error::{Error, Result, check};
use crate::joint::{Given, JointDef, JointKind, Spring, Travel};
use crate::math::{PI, Real, Vec2, atan2, perp, sin_cos, vec2};
use crate::world::World;

/// Where a rope, a chain or a bridge ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// There (m), tied to nothing.
    Free(Vec2),
    /// Pinned to a point of the world (m).
    World(Vec2),
    /// Pinned to a point of a body, in its frame (m).
    Body(BodyHandle, Vec2),
}

impl End {
    /// The point in the world (m).
    fn point(&self, world: &World) -> Result<Vec2> {
        match *self {
            Self::Free(point) | Self::World(point) => check::finite_vec("an end", point),
            Self::Body(body, local) => {
                Ok(world.body(body)?.world_point(check::finite_vec("an end", local)?))
            }
        }
    }

    /// Whether nothing the rope does can move it.
    fn is_fixed(&self, world: &World) -> bool {
        match *self {
            Self::Free(_) => false,
            Self::World(_) => true,
            Self::Body(body, _) => world.body(body).is_ok_and(|body| !body.mass().is_free()),
        }
    }

    /// What a joint at the end holds on to, and where; none: there is no joint.
    pub(super) fn hold(&self) -> Option<(Side, Given)> {
        match *self {
            Self::Free(_) => None,
            Self::World(point) => Some((Side::World, Given::World(point))),
            Self::Body(body, local) => Some((Side::Known(body), Given::Local(local))),
        }
    }
}

/// Most links of one object: more is a slip of the pen.
const MOST: usize = 1_000_000;

/// How an object along a line is asked for.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    /// Where it begins and ends.
    pub ends: [End; 2],
    /// Length along it (m); none: as far as the ends are apart, and a thousandth more where both are fixed.
    pub length: Option<Real>,
    /// Number of links.
    pub count: usize,
}

/// Where the hinges stand.
pub(super) struct Line {
    /// Ends of the links, one more than links (m).
    pub points: Vec<Vec2>,
    /// Directions of the links, unwrapped (rad).
    pub angles: Vec<Real>,
    /// Length of a link (m).
    pub pitch: Real,
}

impl Layout {
    /// Hinges on a straight line, or where there is slack, on an arc of a circle that hangs down.
    ///
    /// # Errors
    /// No links or too many, no length, a length below the distance of the ends, one link that would have to bend.
    pub fn line(&self, world: &World) -> Result<Line> {
        let count = self.count;
        if !(1..=MOST).contains(&count) {
            return Err(Error::invalid("the number of links", count, format!("1 to {MOST}")));
        }
        let [a, b] = [self.ends[0].point(world)?, self.ends[1].point(world)?];
        let apart = (b - a).norm();
        let fixed = self.ends.iter().all(|end| end.is_fixed(world));
        let usual = if fixed { apart * (1.0 + SLACK) } else { apart };
        let length = check::positive("length", self.length.unwrap_or(usual))?;
        let slack = length > apart * (1.0 + ROUNDING);
        if length < apart * (1.0 - ROUNDING) {
            let allowed = format!("{apart} m or more, which the ends are apart");
            return Err(Error::invalid("length", length, allowed));
        }
        if fixed && length < apart * (1.0 + LEAST_SLACK) {
            let allowed = format!(
                "above {apart} m, which the fixed ends are apart: taut, it could bear nothing"
            );
            return Err(Error::invalid("length", length, allowed));
        }
        if slack && count == 1 {
            return Err(Error::invalid("the number of links", 1, "2 or more where there is slack"));
        }
        let pitch = length / count as Real;
        let gravity = world.settings().gravity;
        let down = if gravity == Vec2::zeros() { vec2(0.0, -1.0) } else { gravity.normalize() };
        let along = if apart > 0.0 { (b - a) / apart } else { -perp(down) };
        let turn = if slack { turn_of(count, apart / pitch) } else { 0.0 };
        // The arc bulges to the side that is down.
        let side = if perp(along).dot(&down) > 0.0 { 1.0 } else { -1.0 };
        let first = atan2(along.y, along.x) + side * turn * 0.5 * (count - 1) as Real;
        let angles = (0..count).map(|k| first - side * turn * k as Real).collect();
        let mut line = Line { points: vec![a], angles, pitch };
        line.lay(a, b, slack);
        Ok(line)
    }
}

/// Slack of what hangs between two fixed ends if no length is given: it sags by 2 % of the span.
const SLACK: Real = 1e-3;

/// The least there. Exactly taut, links that do not stretch pull with an infinite force against any load.
const LEAST_SLACK: Real = 1e-6;

/// Lengths that differ by less are the same.
const ROUNDING: Real = 1e-12;

/// Turn θ from one of n equal chords of a circle to the next if they lead `span` chords far:
/// sin(nθ/2)/sin(θ/2) = span, 0 < θ ≤ 2π/n.
fn turn_of(n: usize, span: Real) -> Real {
    let n = n as Real;
    let reach = |turn: Real| sin_cos(0.5 * n * turn).0 / sin_cos(0.5 * turn).0;
    let (mut low, mut high) = (0.0, 2.0 * PI / n);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if reach(middle) > span {
            low = middle;
        } else {
            high = middle;
        }
    }
}

impl Line {
    fn lay(&mut self, a: Vec2, b: Vec2, slack: bool) {
        let count = self.angles.len();
        let mut point = a;
        for (k, angle) in self.angles.iter().enumerate() {
            let (sin, cos) = sin_cos(*angle);
            point += vec2(cos, sin) * self.pitch;
            let straight = a + (b - a) * ((k + 1) as Real / count as Real);
            self.points.push(if slack { point } else { straight });
        }
        self.points[count] = b;
    }

    /// Plans the links, each made by `link` and hinged to the next and to what the ends are tied to. Bodies and joints
    /// are named after the object.
    pub fn hinge(&self, plan: &mut Plan, hinges: &Hinges, link: impl Fn(usize) -> BodyDef) {
        let half = vec2(0.5 * self.pitch, 0.0);
        let links: Vec<Side> = (self.angles.iter().enumerate())
            .map(|(k, angle)| {
                let name = Some(format!("{} {k}", hinges.name));
                let position = (self.points[k] + self.points[k + 1]) * 0.5;
                plan.body(BodyDef { name, position, angle: *angle, ..link(k) })
            })
            .collect();
        let [first, last] = [links[0], links[links.len() - 1]];
        let joint = |k: usize, anchors: [Given; 2], kind: JointKind| JointDef {
            name: Some(format!("{} joint {k}", hinges.name)),
            anchors,
            breaking_force: hinges.breaking_force,
            ..JointDef::new(None, None, kind)
        };
        let loose = JointKind::Revolute { angle: None, travel: Travel::default() };
        if let Some((side, at)) = hinges.ends[0].hold() {
            plan.joint([side, first], joint(0, [at, Given::Local(-half)], loose));
        }
        // A hinge is at rest where its links are in line.
        let travel = Travel { spring: hinges.spring, ..Travel::default() };
        let bending = JointKind::Revolute { angle: Some(0.0), travel };
        for (k, pair) in links.windows(2).enumerate() {
            let anchors = [Given::Local(half), Given::Local(-half)];
            plan.joint([pair[0], pair[1]], joint(k + 1, anchors, bending));
        }
        if let Some((side, at)) = hinges.ends[1].hold() {
            plan.joint([side, last], joint(links.len(), [at, Given::Local(half)], loose));
        }
    }
}

/// What all hinges of an object share.
pub(super) struct Hinges<'a> {
    /// Name of the object.
    pub name: &'a str,
    /// What its ends are tied to.
    pub ends: [End; 2],
    /// Draws two links in line.
    pub spring: Option<Spring>,
    /// Force (N) above which a hinge breaks.
    pub breaking_force: Option<Real>,
}
