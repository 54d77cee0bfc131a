//! Joints as the methods see them: rows that hold are solved exactly, for accelerations, for places and for
//! velocities, by one factor; springs are forces like any other.
//!
//! Bodies are named by their slot among those that move together; what moves as it is given (static and kinematic bodies) has
//! a slot as well, with no inverse mass.

mod accelerate;
mod jacobian;
mod lead;
mod settle;
mod together;

use crate::body::Mass;
use crate::constraints::Velocity;
use crate::constraints::joint::{Action, Law, Pair, Row, Rows};
use crate::math::{Pose, Real, Rot, Twist, Vec2, Wrench, cross, vec2};
use crate::solvers::direct::{self, Factor, Triple};

/// A joint between two slots.
#[derive(Clone, Debug)]
pub struct Tie {
    /// Slots of A and B; none: the world.
    pub bodies: [Option<u32>; 2],
    /// What it does.
    pub law: Law,
    /// Anchors of the world, where it is one of the two (m).
    pub ground: [Vec2; 2],
}

/// The joints of bodies that move together, with all the room that solving their rows needs.
#[derive(Clone, Debug, Default)]
pub struct Joints {
    /// The joints.
    ties: Vec<Tie>,
    /// Inverse masses by slot.
    inverse: Vec<Velocity>,
    /// Rotations by slot where rows were last looked at.
    rots: Vec<Rot>,
    /// Rows by tie, there.
    rows: Vec<Rows>,
    /// Ties with rows that hold.
    held: Vec<u32>,
    /// Their slots.
    links: Vec<direct::Link>,
    factor: Factor,
    /// What the factor is made of.
    blocks: Vec<direct::Rows>,
    /// Right-hand sides by held tie.
    wanted: Vec<Triple>,
    /// λ by held tie of the last solution.
    impulses: Vec<Triple>,
    /// M⁻¹Jᵀλ by slot.
    response: Vec<Twist>,
    /// Places before a correction, and before all of them.
    before: Vec<Pose>,
    start: Vec<Pose>,
    /// Rows and rotations that are set aside while others are looked at.
    aside: (Vec<Rows>, Vec<Rot>),
    /// λ by held tie that leads bodies through a drift.
    led: Vec<Triple>,
    /// What each tie does to its second body (N, N·m about its anchor) at the last evaluation of accelerations, or on
    /// average over a span that is stepped by impulses.
    pub reactions: Vec<Wrench>,
    /// What an impulse adds to them (1/s).
    share: Real,
    /// Whether springs are left out of accelerations.
    pub springless: bool,
    /// Systems of rows solved since the joints were loaded.
    pub solves: u64,
}

/// Values of rows up to so many times their rounding are rounding.
const ROUNDING: Real = 4.0 * Real::EPSILON;

impl Joints {
    /// Forgets all joints and bodies.
    pub fn clear(&mut self) {
        self.ties.clear();
        self.inverse.clear();
        self.solves = 0;
    }

    /// Takes in the body of the next slot.
    pub fn add_body(&mut self, mass: &Mass) {
        self.inverse.push(Velocity::new(Twist::ZERO, mass));
    }

    /// Takes in a joint.
    pub fn add(&mut self, tie: Tie) {
        self.ties.push(tie);
    }

    /// Number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.inverse.len()
    }

    /// Whether a damper makes forces change with the velocity.
    #[must_use]
    pub fn velocity_dependent(&self) -> bool {
        let damps =
            |row: &Row| matches!(row.action, Action::Spring(spring) if spring.damping != 0.0);
        self.rows.iter().any(|rows| rows.as_slice().iter().any(damps))
    }

    /// Prepares for the joints that were taken in.
    pub fn begin(&mut self, poses: &[Pose], twists: &[Twist]) {
        self.look(poses, twists);
        self.held.clear();
        self.links.clear();
        for (k, (tie, rows)) in self.ties.iter().zip(&self.rows).enumerate() {
            if held(rows).next().is_some() {
                self.held.push(k as u32);
                self.links.push(direct::on_ground(&tie.bodies, &self.inverse));
            }
        }
        if !self.held.is_empty() {
            self.factor.analyse(self.inverse.len(), &self.links);
        }
        self.response.clear();
        self.response.resize(self.inverse.len(), Twist::ZERO);
        self.share = 1.0;
        self.reactions.clear();
        self.reactions.resize(self.ties.len(), Wrench::ZERO);
    }

    /// Rows where the bodies stand.
    pub(super) fn look(&mut self, poses: &[Pose], twists: &[Twist]) {
        let Self { ties, rots, rows, .. } = self;
        rots.clear();
        rots.extend(poses.iter().map(Pose::rot));
        rows.clear();
        rows.extend(ties.iter().map(|tie| tie.law.rows(&tie.pair(poses, rots, twists))));
    }

    /// Factors of the rows that were last looked at.
    pub(super) fn factor(&mut self) {
        let Self { rows, held, blocks, .. } = self;
        if held.is_empty() {
            return;
        }
        blocks.clear();
        blocks.extend(held.iter().map(|&k| block(&rows[k as usize])));
        self.factor.factor(&self.inverse, blocks);
    }

    /// Impulses that change Jv of every row that holds by what is wanted of it where bodies move so, and what bodies
    /// get of them. Loads of redundant rows are shared as evenly as can be, whatever they were before.
    pub(super) fn solve(&mut self, twists: &[Twist], wanted: impl Fn(&Row, [&Twist; 2]) -> Real) {
        let Self { ties, rows, held: held_ties, wanted: right, .. } = self;
        right.clear();
        for &k in &*held_ties {
            let at = ties[k as usize].of(twists);
            let mut own = [0.0; 3];
            own.iter_mut().zip(held(&rows[k as usize])).for_each(|(b, row)| *b = wanted(row, at));
            right.push(own);
        }
        self.impulses.clear();
        self.impulses.resize(right.len(), [0.0; 3]);
        self.response.fill(Twist::ZERO);
        self.factor.solve(right, &mut self.impulses, &mut self.response);
        self.solves += 1;
    }

    /// Whether any row holds.
    pub(super) fn holds(&self) -> bool {
        !self.held.is_empty()
    }

    /// What bodies got of the last solution.
    pub(super) fn response(&self) -> &[Twist] {
        &self.response
    }

    /// The largest |C| of the rows that hold, in parts of its rounding.
    pub(super) fn gap(&self, poses: &[Pose]) -> Real {
        self.worst(|tie, row| (row.position, tie.place_rounding(row, poses)))
    }

    /// The largest |Jv| of the rows that hold, in parts of its rounding.
    pub(super) fn rate(&self, twists: &[Twist]) -> Real {
        self.worst(|tie, row| (row.velocity(tie.of(twists)), speed_rounding(row, tie.of(twists))))
    }

    fn worst(&self, value: impl Fn(&Tie, &Row) -> (Real, Real)) -> Real {
        let ratio = |(x, rounding): (Real, Real)| if x == 0.0 { 0.0 } else { x.abs() / rounding };
        let mut worst = 0.0;
        for &k in &self.held {
            let tie = &self.ties[k as usize];
            let of_rows = held(&self.rows[k as usize]).map(|row| ratio(value(tie, row)));
            worst = of_rows.fold(worst, Real::max);
        }
        worst
    }

    /// Power (W) that bodies of given motion put in where a row pushes with a force, or work (J) where with an impulse: it pushes
    /// back at them along what no force changes.
    fn driving(&self, (tie, row): (&Tie, &Row), force: Real, twists: &[Twist]) -> Real {
        let mut given = 0.0;
        for (slot, [x, y, turn]) in tie.bodies.iter().zip(row.jacobian) {
            let Some(slot) = *slot else { continue };
            let (body, twist) = (&self.inverse[slot as usize], &twists[slot as usize]);
            let fixed = |inverse: Real, part: Real| if inverse == 0.0 { part } else { 0.0 };
            given += fixed(body.inverse_mass.x, x * twist.linear.x)
                + fixed(body.inverse_mass.y, y * twist.linear.y)
                + fixed(body.inverse_inertia, turn * twist.angular);
        }
        -force * given
    }

    /// The same of the impulses of the last solution.
    pub(super) fn driving_of_solution(&self, twists: &[Twist]) -> Real {
        let mut work = 0.0;
        for (&k, impulses) in self.held.iter().zip(&self.impulses) {
            let tie = &self.ties[k as usize];
            for (row, impulse) in held(&self.rows[k as usize]).zip(impulses) {
                work += self.driving((tie, row), *impulse, twists);
            }
        }
        work
    }

    /// Adds what a row does to the second body of tie k: a force, or an impulse over its share of the time.
    fn book_reaction(&mut self, k: usize, row: &Row, force: Real) {
        let tie = &self.ties[k];
        let arm = tie.bodies[1]
            .map_or(vec2(0.0, 0.0), |slot| self.rots[slot as usize].apply(tie.law.arms[1]));
        let [x, y, turn] = row.jacobian[1];
        let force = force * self.share;
        let push = vec2(x, y) * force;
        self.reactions[k] += Wrench::new(push, turn * force - cross(arm, push));
    }

    /// Adds the last solution to the reactions.
    pub(super) fn book_impulses(&mut self) {
        for j in 0..self.held.len() {
            let k = self.held[j] as usize;
            let rows = self.rows[k];
            for (row, impulse) in held(&rows).zip(self.impulses[j]) {
                self.book_reaction(k, row, impulse);
            }
        }
    }
}

impl Tie {
    fn pair(&self, poses: &[Pose], rots: &[Rot], twists: &[Twist]) -> Pair {
        let slots = self.bodies.map(|slot| slot.map(|slot| slot as usize));
        let [a, b] =
            [0, 1].map(|side| slots[side].map_or(self.ground[side], |i| poses[i].position));
        Pair {
            origin: a,
            centers: [vec2(0.0, 0.0), b - a],
            rots: slots.map(|i| i.map_or(Rot::IDENTITY, |i| rots[i])),
            angles: slots.map(|i| i.map_or(0.0, |i| poses[i].angle)),
            twists: slots.map(|i| i.map_or(Twist::ZERO, |i| twists[i])),
        }
    }

    /// The two of its bodies.
    fn of<'a>(&self, twists: &'a [Twist]) -> [&'a Twist; 2] {
        self.bodies.map(|slot| slot.map_or(&Twist::ZERO, |slot| &twists[slot as usize]))
    }

    /// What is lost of C in the last digits of places and lever arms.
    fn place_rounding(&self, row: &Row, poses: &[Pose]) -> Real {
        let reach = self.law.arms[0].norm() + self.law.arms[1].norm();
        let of_side = |side: usize| {
            let [x, y, turn] = row.jacobian[side].map(Real::abs);
            let (position, angle) = self.bodies[side].map_or((self.ground[side], 0.0), |slot| {
                (poses[slot as usize].position, poses[slot as usize].angle)
            });
            x * (position.x.abs() + reach)
                + y * (position.y.abs() + reach)
                + turn * (1.0 + angle.abs())
        };
        ROUNDING * (of_side(0) + of_side(1))
    }
}

/// What is lost of Jv in the last digits of J and v.
fn speed_rounding(row: &Row, twists: [&Twist; 2]) -> Real {
    let of_side = |(jacobian, twist): (&[Real; 3], &Twist)| {
        let [x, y, turn] = jacobian.map(Real::abs);
        (x + y) * (twist.linear.x.abs() + twist.linear.y.abs()) + turn * twist.angular.abs()
    };
    ROUNDING * row.jacobian.iter().zip(twists).map(of_side).sum::<Real>()
}

/// The rows that hold: three at most, a plane has no more directions.
fn held(rows: &Rows) -> impl Iterator<Item = &Row> {
    rows.as_slice().iter().filter(|row| row.action == Action::Hold).take(3)
}

fn block(rows: &Rows) -> direct::Rows {
    let mut block =
        direct::Rows { jacobian: [[[0.0; 3]; 3]; 2], compliance: [0.0; 3], on: [false; 3] };
    for (r, row) in held(rows).enumerate() {
        (block.jacobian[0][r], block.jacobian[1][r]) = (row.jacobian[0], row.jacobian[1]);
        block.on[r] = true;
    }
    block
}
