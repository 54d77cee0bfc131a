//! The rows of all joints solved at once, bounds included: an active set over the solver of links.
//!
//! Rows that are solved meet their targets; those that are pinned have the impulse of a bound. Rows whose impulse leaves
//! its bounds are pinned, pinned ones whose velocity says that they would come back are solved again, until nothing
//! changes. After a few rounds only the first row that is wrong changes, which ends for any bounds that are apart for
//! themselves (Murty, "Linear Complementarity", 1988, ch. 4: least index).

use super::motors;
use super::prepare::{mobility, push};
use super::{Tie, Ties};
use crate::constraints::Velocity;
use crate::constraints::joint::{self, Action};
use crate::math::{Real, Twist};
use crate::solvers::direct;
use crate::solvers::links::Effort;

/// What the solve does with a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum State {
    /// It meets its target.
    #[default]
    Solved,
    /// Its impulse is that of a bound.
    Pinned,
    /// It is not there.
    Off,
}

/// A row in a substep.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// λ (N·s).
    pub impulse: Real,
    /// What Jv⁺ + compliance·λ should be (m/s).
    pub wanted: Real,
    /// Σ (m/s per N·s).
    pub compliance: Real,
    /// Least and greatest λ.
    pub bounds: [Real; 2],
    /// What the solve does with it.
    pub state: State,
    /// C at the start of the substep.
    pub from: Real,
    /// Work that its impulse did (J).
    pub work: Real,
}

impl Row {
    /// Begins with the impulse of the last substep as far as it is allowed.
    pub fn start(&mut self) {
        let [low, high] = self.bounds;
        if self.state == State::Off {
            self.impulse = 0.0;
            return;
        }
        if low == high {
            (self.impulse, self.state) = (low, State::Pinned);
            return;
        }
        // Within rounding of a bound it was pinned there.
        let near = |bound: &Real| (self.impulse - bound).abs() <= 1e-9 * bound.abs();
        let bound = [low, high].into_iter().filter(|bound| bound_is_set(*bound)).find(near);
        if let Some(bound) = bound {
            (self.impulse, self.state) = (bound, State::Pinned);
            return;
        }
        self.impulse = self.impulse.clamp(low, high);
        if self.state == State::Pinned && low == 0.0 {
            self.impulse = 0.0;
        }
    }
}

/// Begins two rows with one bound on both together: pinned both or none.
pub fn start_disc(rows: &mut [Row]) {
    let [.., bound] = rows[0].bounds;
    let length = rows[0].impulse.hypot(rows[1].impulse);
    let pinned = bound_is_set(bound) && length >= bound * (1.0 - 1e-9);
    for row in rows.iter_mut().take(2).filter(|row| row.state != State::Off) {
        row.state = if pinned { State::Pinned } else { State::Solved };
        row.impulse *= if pinned { bound / length } else { 1.0 };
    }
}

/// A bound that pins: other than the 0 of a limit, whose state says whether it is pinned.
fn bound_is_set(bound: Real) -> bool {
    bound != 0.0 && bound.is_finite()
}

/// Rounds in which all rows may change, before only the first does.
pub const TOGETHER: usize = 8;

/// Rounds that settle the bounds of any joint.
pub const ROUNDS: usize = 64;

/// Rounds of a turn between contacts, which change what bounds meet anyway.
pub const TURN: usize = 4;

/// Sweeps to and fro instead of rounds, at most.
const SWEEPS: usize = 4;

/// Rows are solved anew in each substep, so that what is lacking of velocities does not add up.
const EFFORT: Effort = Effort { sweeps: 1, accuracy: 1e-10 };

/// Rounding of a velocity, in parts of what it is a sum of.
const ROUNDING: Real = 1e-12;

/// Solves all rows against the present velocities and gives the bodies the change. Returns what they lacked at first: the
/// largest, along a row.
///
/// At most so many rounds. Where the rows are too many for factors, a few sweeps to and fro do what they can.
pub fn solve(ties: &mut Ties, velocities: &mut [Velocity], rounds: usize) -> Real {
    let by_sweeps = ties.solver.by_sweeps();
    let most = if by_sweeps { rounds.min(SWEEPS) } else { rounds };
    let mut first: Real = 0.0;
    for round in 0..most {
        prepare(ties, velocities);
        let lacked = correct(ties, velocities);
        first = if round == 0 { lacked } else { first };
        if !review(ties, velocities, round >= TOGETHER) && !by_sweeps {
            return first;
        }
    }
    // Whatever is not settled, nothing is left beyond its bounds.
    review(ties, velocities, false);
    first
}

/// Hands the solver the rows that are solved.
fn prepare(ties: &mut Ties, velocities: &[Velocity]) {
    let Ties { list, rows, nodes, solver, prepared, links, .. } = ties;
    let mut on = prepared.take().unwrap_or_default();
    let same = note_solved((list, rows), &mut on, links.len());
    if !same {
        fill(list, nodes, links.len(), |tie, k| {
            let row = &rows[tie.first_row + k];
            (row.state == State::Solved).then_some(row.compliance)
        });
        solver.prepare(velocities, links, nodes);
    }
    *prepared = Some(on);
}

/// Notes which rows are solved; whether they are those that were noted.
pub fn note_solved((list, rows): (&[Tie], &[Row]), on: &mut Vec<[bool; 3]>, links: usize) -> bool {
    let mut same = on.len() == links;
    on.resize(links, [false; 3]);
    for tie in list {
        for k in 0..tie.middle.count {
            let solved = rows[tie.first_row + k].state == State::Solved;
            let flag = &mut on[tie.first_node + k / 3][k % 3];
            same &= *flag == solved;
            *flag = solved;
        }
    }
    same
}

/// Rows of the links; those for which there is no compliance are off.
pub fn fill(
    list: &[Tie],
    nodes: &mut Vec<direct::Rows>,
    count: usize,
    compliance: impl Fn(&Tie, usize) -> Option<Real>,
) {
    let off = direct::Rows { jacobian: [[[0.0; 3]; 3]; 2], compliance: [0.0; 3], on: [false; 3] };
    nodes.clear();
    nodes.resize(count, off);
    for tie in list {
        for (k, row) in tie.middle.as_slice().iter().enumerate() {
            let Some(compliance) = compliance(tie, k) else { continue };
            let node = &mut nodes[tie.first_node + k / 3];
            for side in 0..2 {
                node.jacobian[side][k % 3] = row.jacobian[side];
            }
            (node.compliance[k % 3], node.on[k % 3]) = (compliance, true);
        }
    }
}

/// What is missing: wanted − Jv − Σλ.
pub fn missing(row: &Row, now: &joint::Row, twists: [&Twist; 2]) -> Real {
    row.wanted - now.velocity(twists) - row.compliance * row.impulse
}

pub fn twists(velocities: &[Velocity], tie: &Tie) -> [Twist; 2] {
    tie.slots.map(|slot| slot.map_or(Twist::ZERO, |slot| velocities[slot as usize].twist))
}

/// Solves the rows that are on; the bodies get the change.
fn correct(ties: &mut Ties, velocities: &mut [Velocity]) -> Real {
    let Ties { list, rows, solver, wanted, solved, change, links, .. } = ties;
    wanted.clear();
    wanted.resize(links.len(), [0.0; 3]);
    solved.clear();
    solved.resize(links.len(), [0.0; 3]);
    change.clear();
    change.resize(velocities.len(), Twist::ZERO);
    let mut largest: Real = 0.0;
    for tie in &*list {
        let [a, b] = twists(velocities, tie);
        for (k, now) in tie.middle.as_slice().iter().enumerate() {
            let row = &rows[tie.first_row + k];
            if row.state == State::Solved {
                let lacks = missing(row, now, [&a, &b]);
                wanted[tie.first_node + k / 3][k % 3] = lacks;
                largest = largest.max(lacks.abs());
            }
        }
    }
    if largest == 0.0 {
        return 0.0;
    }
    solver.solve(wanted, EFFORT, solved, change);
    for (velocity, change) in velocities.iter_mut().zip(&*change) {
        velocity.twist += *change;
    }
    for tie in &*list {
        for k in 0..tie.middle.count {
            rows[tie.first_row + k].impulse += solved[tie.first_node + k / 3][k % 3];
        }
    }
    largest
}

/// Pins rows that left their bounds and lets go those that come back. Whether there was any.
pub fn review(ties: &mut Ties, velocities: &mut [Velocity], one_by_one: bool) -> bool {
    let Ties { list, rows, .. } = ties;
    let mut changed = false;
    for tie in &*list {
        let first = if tie.middle.disc {
            changed |= review_disc(tie, &mut rows[tie.first_row..], velocities);
            2
        } else {
            0
        };
        for k in first..tie.middle.count {
            if changed && one_by_one {
                return true;
            }
            let rows = &mut rows[tie.first_row..];
            if rows[k].state == State::Pinned && motors::is_stopped(tie, k, rows) {
                continue;
            }
            if review_row(tie, k, &mut rows[k], velocities) {
                changed = true;
                if tie.middle.rows[k].action == Action::Limit && rows[k].state == State::Solved {
                    motors::yield_to(tie, k, rows, velocities);
                }
            }
        }
    }
    changed
}

fn review_row(tie: &Tie, k: usize, row: &mut Row, velocities: &mut [Velocity]) -> bool {
    let (now, [low, high]) = (&tie.middle.rows[k], row.bounds);
    match row.state {
        State::Solved if row.impulse < low || row.impulse > high => {
            let bound = row.impulse.clamp(low, high);
            push(velocities, tie.slots, now, bound - row.impulse);
            (row.impulse, row.state) = (bound, State::Pinned);
            true
        }
        State::Pinned => {
            let [a, b] = twists(velocities, tie);
            let lacks = missing(row, now, [&a, &b]);
            let noise = ROUNDING * (row.wanted.abs() + speed(now, [&a, &b]));
            let inward = low < high
                && ((row.impulse <= low && lacks > noise)
                    || (row.impulse >= high && lacks < -noise));
            if inward {
                row.state = State::Solved;
            }
            inward
        }
        _ => false,
    }
}

/// Σ |J||v|.
fn speed(row: &joint::Row, twists: [&Twist; 2]) -> Real {
    let part = |side: usize| {
        let ([x, y, turn], v) = (row.jacobian[side], twists[side]);
        (x * v.linear.x).abs() + (y * v.linear.y).abs() + (turn * v.angular).abs()
    };
    part(0) + part(1)
}

/// Two rows with one bound on the length of their impulse. Beyond it the impulse turns towards what both lack until it
/// stays, so that friction works against the motion.
fn review_disc(tie: &Tie, rows: &mut [Row], velocities: &mut [Velocity]) -> bool {
    let bound = rows[0].bounds[1];
    let length = |rows: &[Row]| rows[0].impulse.hypot(rows[1].impulse);
    match rows[0].state {
        State::Solved if length(rows) > bound * (1.0 + ROUNDING) => {
            let scale = bound / length(rows);
            for (row, now) in rows[..2].iter_mut().zip(&tie.middle.rows) {
                let to = row.impulse * scale;
                push(velocities, tie.slots, now, to - row.impulse);
                (row.impulse, row.state) = (to, State::Pinned);
            }
            true
        }
        State::Pinned => turn_disc(tie, rows, velocities, bound),
        _ => false,
    }
}

fn turn_disc(tie: &Tie, rows: &mut [Row], velocities: &mut [Velocity], bound: Real) -> bool {
    let [a, b] = twists(velocities, tie);
    // The larger eigenvalue: no direction overshoots, and none is preferred.
    let [xx, yy, xy] = mobility(tie, velocities);
    let response = 0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy);
    let mut to = [0.0; 2];
    for (k, to) in to.iter_mut().enumerate() {
        let (row, now) = (&rows[k], &tie.middle.rows[k]);
        *to = row.impulse + missing(row, now, [&a, &b]) / (response + row.compliance);
    }
    let length = to[0].hypot(to[1]);
    if !length.is_finite() {
        return false;
    }
    if length < bound * (1.0 - 1e-9) {
        rows[..2].iter_mut().for_each(|row| row.state = State::Solved);
        return true;
    }
    let mut moved: Real = 0.0;
    for (k, to) in to.iter().enumerate() {
        let to = if length > 0.0 { to * bound / length } else { 0.0 };
        moved = moved.max((to - rows[k].impulse).abs());
        push(velocities, tie.slots, &tie.middle.rows[k], to - rows[k].impulse);
        rows[k].impulse = to;
    }
    moved > 1e-9 * bound
}
