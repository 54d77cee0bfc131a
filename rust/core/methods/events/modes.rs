//! Accelerations of bodies that touch: each contact sticks, slides or lets go, and joints hold.
//!
//! a = M⁻¹(F + Jᵀλ) with n·a + J̇v = 0 for each point that bears, t·a + J̇v = 0 where the surfaces stick, and
//! λ_t = −σμλ_n where they slide the way σ. For given modes that is linear; it is solved together with the rows of joints,
//! exactly. Which modes hold, [`super::choose`] says.

use super::dense::Dense;
use super::point::{Point, Seen};
use super::rows::{Line, Origin, Push, ROUNDING, Responses, Terms, combined, parts};
use crate::body::Mass;
use crate::collision::Frame;
use crate::constraints::contact::Touch;
use crate::forces::Ledger;
use crate::math::{Pose, Real, Twist, Vec2, vec2};
use crate::methods::joined::Joints;

/// What the surfaces of a contact do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slip {
    /// They stick.
    Sticks,
    /// B's slides over A's along +t or −t.
    Slides(Real),
}

/// Up to two points of a pair with one normal.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Place of the pair in the island.
    pub pair: u32,
    /// Slots of A and B.
    pub slots: [u32; 2],
    /// The points.
    pub points: [Point; 2],
    /// Number of points.
    pub count: usize,
    /// Which of them bear.
    pub on: [bool; 2],
    /// What the surfaces do, if any point bears.
    pub slip: Slip,
    /// Friction and restitution.
    pub touch: Touch,
    /// Forces of the last evaluation: of the points, and along the tangent (N).
    pub force: [Real; 3],
}

/// The contacts and joints of an island, in their modes.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// What touches.
    pub contacts: Vec<Contact>,
    /// The joints.
    pub joints: Joints,
    inverse: Vec<[Real; 3]>,
    frames: Vec<Frame>,
    lines: Vec<Line>,
    dense: Dense,
    values: Vec<Real>,
    /// Σ|terms| of each acceleration: what is below its rounding is none.
    terms: Vec<[Real; 3]>,
}

/// Accelerations and velocities below this part of the terms they are made of are rounding.
const NOTHING: Real = 32.0 * Real::EPSILON;

impl Modes {
    /// Of bodies with these masses, tied by joints that know them already.
    #[must_use]
    pub fn new(masses: &[Mass], joints: Joints) -> Self {
        let inverse =
            masses.iter().map(|m| [m.inverse.x, m.inverse.y, m.inverse_inertia]).collect();
        Self { inverse, joints, ..Self::default() }
    }

    /// Whether some contact bears.
    #[must_use]
    pub fn bears(&self) -> bool {
        self.contacts.iter().any(Contact::bears)
    }

    /// Inverse masses of a slot.
    #[must_use]
    pub fn inverse(&self, slot: u32) -> [Real; 3] {
        self.inverse[slot as usize]
    }

    /// Takes in where the bodies stand.
    pub fn look(&mut self, poses: &[Pose], twists: &[Twist]) {
        self.joints.look(poses, twists);
        self.frames.clear();
        self.frames.extend(poses.iter().map(Frame::of));
    }

    /// Frames of the bodies of a contact, where they were last looked at.
    pub fn frames(&self, slots: [u32; 2]) -> [&Frame; 2] {
        slots.map(|slot| &self.frames[slot as usize])
    }

    /// Adds what joints and contacts do to the accelerations by all other forces; returns powers (W).
    pub fn accelerate(&mut self, poses: &[Pose], twists: &[Twist], out: &mut [Twist]) -> Ledger {
        self.look(poses, twists);
        let mut power = self.joints.start_forces(twists, out);
        self.collect(poses, twists);
        self.solve(|line| -line.bias, out, |line| line.push);
        let values = std::mem::take(&mut self.values);
        self.add(&values, out, |line| line.push);
        power += self.book(&values, twists);
        self.values = values;
        power
    }

    /// Adds forces or impulses along rows to accelerations or velocities. What is below the rounding of its terms is none: what
    /// rests stays where it is to the last bit.
    fn add(&mut self, values: &[Real], out: &mut [Twist], push: impl Fn(&Line) -> [[Real; 3]; 2]) {
        let Self { lines, terms, inverse, .. } = self;
        terms.clear();
        terms.extend(out.iter().map(|a| parts(a).map(Real::abs)));
        for (line, x) in lines.iter().zip(values) {
            let push = push(line);
            terms.add(line, &push, (*x, inverse));
            out.push_along(line, &push, (*x, inverse));
        }
        for (a, terms) in out.iter_mut().zip(terms) {
            let [x, y, turn] = parts(a);
            let kept = |a: Real, terms: Real| if a.abs() <= NOTHING * terms { 0.0 } else { a };
            *a = Twist::new(vec2(kept(x, terms[0]), kept(y, terms[1])), kept(turn, terms[2]));
        }
    }

    /// Keeps the forces of a solution; returns their powers (W): what moves as it is given and conveyors do, and what
    /// friction takes.
    fn book(&mut self, values: &[Real], twists: &[Twist]) -> Ledger {
        let mut power = Ledger::default();
        for contact in &mut self.contacts {
            contact.force = [0.0; 3];
        }
        for (line, &force) in self.lines.iter().zip(values) {
            match line.origin {
                Origin::Joint(tie, row) => {
                    power.work += self.joints.book_held((tie, row), force, twists);
                }
                Origin::Contact(k, row) => {
                    let contact = &mut self.contacts[k];
                    contact.force[row] += force;
                    if let (Slip::Slides(sigma), true) = (contact.slip, row < 2) {
                        contact.force[2] -= sigma * contact.touch.friction.sliding * force;
                    }
                }
            }
        }
        for contact in self.contacts.iter().filter(|contact| contact.bears()) {
            power += contact.power(self.frames(contact.slots), &self.inverse, twists);
        }
        power
    }

    /// Rows of the present modes.
    fn collect(&mut self, poses: &[Pose], twists: &[Twist]) {
        let Self { contacts, joints, lines, frames, .. } = self;
        lines.clear();
        for (tie, k, slots, row, rounding) in joints.held_rows(poses) {
            lines.push(Line {
                slots,
                jacobian: row.jacobian,
                push: row.jacobian,
                bias: row.turning,
                position: row.position,
                rounding,
                speed: 0.0,
                origin: Origin::Joint(tie, k),
                scale: 0.0,
            });
        }
        for (k, contact) in contacts.iter().enumerate().filter(|(_, contact)| contact.bears()) {
            let pair = contact.slots.map(|slot| &frames[slot as usize]);
            let mut rows = contact.lines(k, pair, twists);
            let tangent = rows[2];
            if let Slip::Slides(sigma) = contact.slip {
                let mu = sigma * contact.touch.friction.sliding;
                for row in &mut rows[..2] {
                    row.push = combined(&row.jacobian, &tangent.jacobian, -mu);
                }
            }
            lines.extend((0..contact.count).filter(|p| contact.on[*p]).map(|p| rows[p]));
            if contact.slip == Slip::Sticks && contact.touch.friction.sticking > 0.0 {
                lines.push(tangent);
            }
        }
    }

    /// Forces or impulses along `push` that change J·`by` of every row to what is wanted; they stand in `values`.
    fn solve(
        &mut self,
        wanted: impl Fn(&Line) -> Real,
        by: &[Twist],
        push: impl Fn(&Line) -> [[Real; 3]; 2],
    ) {
        let Self { lines, dense, values, inverse, .. } = self;
        for line in &mut *lines {
            let own = line.coupled(&line.jacobian, line, inverse);
            line.scale = if own > 0.0 { 1.0 / own.sqrt() } else { 0.0 };
        }
        let n = lines.len();
        let matrix = dense.start(n);
        for (j, other) in lines.iter().enumerate() {
            let push = push(other);
            for (i, line) in lines.iter().enumerate() {
                matrix[i * n + j] = line.scale * other.scale * line.coupled(&push, other, inverse);
            }
        }
        values.clear();
        values.extend(lines.iter().map(|line| line.scale * (wanted(line) - line.along(by))));
        if n > 0 {
            dense.factor();
            dense.solve(values);
        }
        values.iter_mut().zip(&*lines).for_each(|(x, line)| *x *= line.scale);
    }

    /// Puts the bodies where contacts that bear touch and joints hold, and stops what moves against them. Returns what that takes.
    pub fn settle(
        &mut self,
        (masses, gravity): (&[Mass], Vec2),
        poses: &mut [Pose],
        twists: &mut [Twist],
    ) -> Ledger {
        // Newton's method, quadratic near the answer.
        const MOST: usize = 8;
        let mut ledger = Ledger::default();
        let mut before = Real::INFINITY;
        for _ in 0..MOST {
            self.look(poses, twists);
            self.collect(poses, twists);
            let gap = self.lines.iter().map(|line| line.position.abs() / line.rounding);
            let gap = gap.fold(0.0, |most: Real, x| if x > most { x } else { most });
            if gap <= 1.0 || gap > 0.5 * before {
                break;
            }
            before = gap;
            let still = vec![Twist::ZERO; poses.len()];
            let moves = |line: &Line| -line.position;
            self.solve(moves, &still, |line| line.jacobian);
            let mut way = still;
            way.push_all(&self.lines, &self.values, &self.inverse);
            for ((pose, way), mass) in poses.iter_mut().zip(&way).zip(masses) {
                pose.position += way.linear;
                pose.angle += way.angular;
                let weight = mass.mass * gravity.component_mul(&mass.gravity_scale);
                ledger.correction_work -= weight.dot(&way.linear);
            }
        }
        ledger += self.halt(masses, twists);
        ledger
    }

    /// Stops what moves along the rows of all points that are on.
    pub fn halt_all(&mut self, poses: &[Pose], twists: &mut [Twist]) {
        self.look(poses, twists);
        self.collect(poses, twists);
        let before = twists.to_vec();
        self.halt_once(&before, twists);
    }

    fn halt_once(&mut self, before: &[Twist], twists: &mut [Twist]) {
        self.solve(|line| line.speed, before, |line| line.jacobian);
        let values = std::mem::take(&mut self.values);
        self.add(&values, twists, |line| line.jacobian);
        self.values = values;
    }

    /// Takes from the velocities what moves against the rows.
    fn halt(&mut self, masses: &[Mass], twists: &mut [Twist]) -> Ledger {
        let mut ledger = Ledger::default();
        for _ in 0..2 {
            let moves =
                |line: &Line| (line.along(twists) - line.speed).abs() > line.speed_rounding(twists);
            if !self.lines.iter().any(moves) {
                break;
            }
            let before = twists.to_vec();
            self.halt_once(&before, twists);
            for ((mass, old), new) in masses.iter().zip(&before).zip(&*twists) {
                ledger.dissipated += mass.kinetic_energy(old) - mass.kinetic_energy(new);
            }
        }
        ledger
    }

    /// What a unit impulse along each row of the contacts does to the bodies, joints holding.
    pub fn responses(&mut self, poses: &[Pose], twists: &[Twist]) -> Responses {
        let rows: Vec<Line> = (self.contacts.iter().enumerate())
            .flat_map(|(k, contact)| contact.lines(k, self.frames(contact.slots), twists))
            .collect();
        let contacts = std::mem::take(&mut self.contacts);
        self.collect(poses, twists);
        self.contacts = contacts;
        let moves = rows.iter().map(|row| {
            let mut change = vec![Twist::ZERO; self.inverse.len()];
            change.push_along(row, &row.jacobian, (1.0, &self.inverse));
            if !self.lines.is_empty() {
                self.solve(|_| 0.0, &change, |line| line.jacobian);
                change.push_all(&self.lines, &self.values, &self.inverse);
            }
            change
        });
        let moves = moves.collect();
        Responses { rows, moves }
    }
}

impl Contact {
    /// Whether a point bears.
    #[must_use]
    pub fn bears(&self) -> bool {
        (0..self.count).any(|k| self.on[k])
    }

    /// Where point k is.
    pub fn seen(&self, k: usize, frames: [&Frame; 2]) -> Seen {
        self.points[k].seen(frames)
    }

    /// The points between which friction acts: those that bear, or all.
    fn rubbing(&self) -> [usize; 2] {
        match (self.count, self.on) {
            (1, _) | (_, [true, false]) => [0, 0],
            (_, [false, true]) => [1, 1],
            _ => [0, 1],
        }
    }

    /// Rows of the points and of the tangent, which acts in the middle of the points.
    fn lines(&self, k: usize, frames: [&Frame; 2], twists: &[Twist]) -> [Line; 3] {
        let pair = self.slots.map(|slot| &twists[slot as usize]);
        let seen = [0, 1].map(|p| self.points[p.min(self.count - 1)].seen(frames));
        let biases = [0, 1].map(|p| self.points[p.min(self.count - 1)].bias(&seen[p], pair));
        let [first, second] = self.rubbing();
        let line = |row: usize, jacobian: [[Real; 3]; 2], bias: Real| Line {
            slots: self.slots.map(Some),
            jacobian,
            push: jacobian,
            bias,
            position: 0.0,
            rounding: 1.0,
            speed: 0.0,
            origin: Origin::Contact(k, row),
            scale: 0.0,
        };
        let reach = frames[0].position.norm() + frames[1].position.norm() + seen[0].arms[0].norm();
        let normal = |p: usize| Line {
            position: seen[p].gap,
            rounding: ROUNDING * reach.max(Real::MIN_POSITIVE),
            ..line(p, seen[p].jacobian(seen[p].normal), biases[p][0])
        };
        let along = |p: usize| seen[p].jacobian(seen[first].tangent());
        let middle = combined(&along(first), &along(second), 1.0).map(|side| side.map(|x| 0.5 * x));
        let tangent = Line {
            speed: self.touch.tangent_speed,
            ..line(2, middle, 0.5 * (biases[first][1] + biases[second][1]))
        };
        [normal(0), normal(1), tangent]
    }

    /// How fast B's surface slides over A's along the tangent, beyond what a conveyor does itself (m/s).
    pub fn slip_speed(&self, frames: [&Frame; 2], twists: &[Twist]) -> Real {
        let pair = self.slots.map(|slot| &twists[slot as usize]);
        let along = |p: usize| {
            let seen = self.points[p].seen(frames);
            seen.tangent().dot(&seen.velocity(pair))
        };
        let [first, second] = self.rubbing();
        0.5 * (along(first) + along(second)) - self.touch.tangent_speed
    }

    fn power(&self, frames: [&Frame; 2], inverse: &[[Real; 3]], twists: &[Twist]) -> Ledger {
        let mut work = self.force[2] * self.touch.tangent_speed;
        for (row, line) in self.lines(0, frames, twists).iter().enumerate() {
            for (slot, jacobian) in self.slots.iter().zip(line.jacobian) {
                let (inverse, v) = (inverse[*slot as usize], parts(&twists[*slot as usize]));
                // Of bodies whose motion is given; what they push comes from outside.
                let fixed = |c: usize| if inverse[c] == 0.0 { jacobian[c] * v[c] } else { 0.0 };
                work -= self.force[row] * (fixed(0) + fixed(1) + fixed(2));
            }
        }
        let dissipated = -self.force[2] * self.slip_speed(frames, twists);
        Ledger { work, dissipated, ..Ledger::default() }
    }
}
