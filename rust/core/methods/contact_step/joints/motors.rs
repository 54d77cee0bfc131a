//! Motors whose coordinate is limited: of the two rows only one is solved, or they would fight over one coordinate.
//!
//! A motor that may use any force drives to the limit, which then bears nothing. One with a bound pushes against a limit that
//! bears with all it has.

use super::Tie;
use super::active::{Row, State};
use super::prepare::push;
use crate::constraints::Velocity;
use crate::constraints::joint::{self, Action};
use crate::math::Real;

/// Begins: the rows of a joint as they are asked for, before anything is solved. No velocity has them yet.
pub fn start(tie: &Tie, rows: &mut [Row]) {
    for (m, l, side) in pairs(tie) {
        if rows[m].bounds[1] == Real::INFINITY {
            rows[m].wanted = side * (side * rows[m].wanted).max(rows[l].wanted);
            (rows[l].impulse, rows[l].state) = (0.0, State::Pinned);
        } else if rows[l].state == State::Solved && rows[m].state != State::Off {
            rows[m].impulse = against(&rows[m], &rows[l], side);
            rows[m].state = State::Pinned;
        }
    }
}

/// Limit l bears from now on: motors on its coordinate push with all they have.
pub fn yield_to(tie: &Tie, l: usize, rows: &mut [Row], velocities: &mut [Velocity]) {
    for (m, _, side) in pairs(tie).filter(|pair| pair.1 == l) {
        if rows[m].state == State::Solved {
            let to = against(&rows[m], &rows[l], side);
            push(velocities, tie.slots, &tie.middle.rows[m], to - rows[m].impulse);
            (rows[m].impulse, rows[m].state) = (to, State::Pinned);
        }
    }
}

/// Whether row m is that of a motor at a limit that bears.
pub fn is_stopped(tie: &Tie, m: usize, rows: &[Row]) -> bool {
    matches!(tie.middle.rows[m].action, Action::Drive(_))
        && pairs(tie).any(|(motor, l, _)| motor == m && rows[l].state == State::Solved)
}

/// The bound towards the speed that a motor is to have, seen from the speed that a limit leaves.
fn against(motor: &Row, limit: &Row, side: Real) -> Real {
    let [low, high] = motor.bounds;
    let lacks = motor.wanted - side * limit.wanted;
    if lacks > 0.0 {
        high
    } else if lacks < 0.0 {
        low
    } else {
        motor.impulse.clamp(low, high)
    }
}

/// Motors and limits on one coordinate: their rows, and 1, or −1 where they run against each other.
fn pairs(tie: &Tie) -> impl Iterator<Item = (usize, usize, Real)> + '_ {
    let rows = tie.middle.as_slice();
    let motors = rows.iter().enumerate().filter(|(_, row)| matches!(row.action, Action::Drive(_)));
    motors.flat_map(move |(m, motor)| {
        let limits = rows.iter().enumerate().filter(|(_, row)| row.action == Action::Limit);
        limits.filter_map(move |(l, limit)| Some((m, l, same_line(motor, limit)?)))
    })
}

fn same_line(a: &joint::Row, b: &joint::Row) -> Option<Real> {
    let reversed = b.jacobian.map(|side| side.map(|x| -x));
    if a.jacobian == b.jacobian { Some(1.0) } else { (a.jacobian == reversed).then_some(-1.0) }
}
