//! What each row asks for in a substep.

use super::active::{Row, State, start_disc};
use super::{Tie, Ties};
use crate::constraints::Velocity;
use crate::constraints::joint::{self, Action, Gains, Rates};
use crate::math::{Real, Twist, hypot};
use crate::methods::contact_step::Group;

/// Takes targets, compliances and bounds of all rows, and gives the bodies the impulses of the last substep.
pub fn prepare(group: &mut Group, h: Real) {
    let Group { ties, velocities, .. } = group;
    if ties.is_empty() {
        return;
    }
    sum_rates(ties, velocities);
    let Ties { list, rows, before, rates, .. } = ties;
    for tie in list {
        let twists = tie.slots.map(|slot| slot.map_or(Twist::ZERO, |slot| before[slot as usize]));
        let twists = [&twists[0], &twists[1]];
        for k in 0..tie.middle.count {
            let (now, start) = (&tie.middle.rows[k], &tie.end.rows[k]);
            let row = &mut rows[tie.first_row + k];
            *row = Row { impulse: tie.impulses[k], from: start.position, ..Row::default() };
            // Also in a step so short that its length is no number above 0.
            let most = if now.bound.is_finite() { now.bound * h } else { Real::INFINITY };
            row.bounds = [-most, most];
            let along = now.velocity(twists);
            let curve = start.velocity(twists) - along;
            match now.action {
                Action::Off => row.state = State::Off,
                Action::Hold if now.bound < Real::INFINITY => {
                    row.wanted = curve - way_back(tie, k, velocities, h);
                }
                Action::Hold => row.wanted = curve,
                Action::Drive(speed) => row.wanted = speed,
                Action::Limit => limit(row, now, (curve, start), h),
                Action::Spring(spring) => {
                    let around = rates_around(tie, rates);
                    let gains = Gains::new(&spring, &around, h);
                    if gains.after > 0.0 {
                        row.compliance = 1.0 / gains.after;
                        row.wanted =
                            (gains.pull * now.position + gains.before * along) * row.compliance;
                    } else {
                        row.state = State::Off;
                    }
                }
            }
            row.start();
        }
        if tie.middle.disc {
            start_disc(&mut rows[tie.first_row..]);
        }
        super::motors::start(tie, &mut rows[tie.first_row..]);
    }
    warm_start(ties, velocities);
}

/// A limit that is reached, or that carried a load and stays within what the curve opens, keeps to the curve; one that is
/// not reached may be just reached in the next middle.
fn limit(row: &mut Row, now: &joint::Row, (curve, start): (Real, &joint::Row), h: Real) {
    // Where the nearer of two limits is another one than at the start, nothing is known of it.
    let other = against(now, start);
    let curve = if other { 0.0 } else { curve };
    if other {
        row.impulse = 0.0;
    }
    let loaded = row.impulse > 0.0;
    row.bounds = [0.0, Real::INFINITY];
    let (wanted, reached) = reach(loaded, now.position, curve, h);
    row.wanted = wanted;
    row.state = if loaded || reached { State::Solved } else { State::Pinned };
}

/// Speed that a limit asks for at a position, and whether it is reached.
pub fn reach(loaded: bool, position: Real, curve: Real, h: Real) -> (Real, bool) {
    let bends = (curve * h).abs();
    let reached = position <= 0.0 || (loaded && position <= bends);
    (if reached { curve } else { -position / h }, reached)
}

/// Speed (m/s) along row k of a hold with a bounded force that is open: what closes it in a substep, and no more than half
/// of the bound can brake on the way, so that it arrives and does not swing past.
fn way_back(tie: &Tie, k: usize, velocities: &[Velocity], h: Real) -> Real {
    let rows = tie.middle.as_slice();
    let now = &rows[k];
    let (open, response) = if tie.middle.disc && k < 2 {
        let [xx, yy, xy] = mobility(tie, velocities);
        let (x, y) = (rows[0].position, rows[1].position);
        let open = hypot(x, y);
        (open, (xx * x * x + yy * y * y + 2.0 * xy * x * y) / (open * open))
    } else {
        (now.position.abs(), coupling(tie, [now, now], velocities))
    };
    if open == 0.0 {
        return 0.0;
    }
    now.position * (1.0 / h).min((now.bound * response / open).sqrt())
}

/// JM⁻¹Jᵀ of the first two rows of a joint: of the first, of the second, between them.
pub fn mobility(tie: &Tie, velocities: &[Velocity]) -> [Real; 3] {
    let [x, y, ..] = &tie.middle.rows;
    [[x, x], [y, y], [x, y]].map(|rows| coupling(tie, rows, velocities))
}

/// J M⁻¹ J'ᵀ of two rows of a joint (1/kg, or 1/(kg·m²)).
fn coupling(tie: &Tie, [a, b]: [&joint::Row; 2], velocities: &[Velocity]) -> Real {
    let of = |side: usize| -> Real {
        let Some(slot) = tie.slots[side] else { return 0.0 };
        let inverse = velocities[slot as usize].inverse();
        (0..3).map(|i| a.jacobian[side][i] * inverse[i] * b.jacobian[side][i]).sum()
    };
    of(0) + of(1)
}

/// Whether two rows run against each other.
pub fn against(a: &joint::Row, b: &joint::Row) -> bool {
    let dot = |side: usize| -> Real {
        a.jacobian[side].iter().zip(b.jacobian[side]).map(|(x, y)| x * y).sum()
    };
    dot(0) + dot(1) < 0.0
}

fn rates_around(tie: &Tie, rates: &[Rates]) -> Rates {
    tie.slots.iter().flatten().fold(Rates::default(), |sum, slot| Rates {
        stiffness: sum.stiffness + rates[*slot as usize].stiffness,
        damping: sum.damping + rates[*slot as usize].damping,
    })
}

/// Σ k JM⁻¹Jᵀ and Σ c JM⁻¹Jᵀ over the springs of each slot.
fn sum_rates(ties: &mut Ties, velocities: &[Velocity]) {
    ties.rates.clear();
    ties.rates.resize(velocities.len(), Rates::default());
    for tie in &ties.list {
        for row in tie.middle.as_slice() {
            let Action::Spring(spring) = row.action else { continue };
            for (side, slot) in tie.slots.iter().enumerate() {
                let Some(slot) = slot.map(|slot| slot as usize) else { continue };
                let response = row.response(side, velocities[slot].inverse());
                ties.rates[slot].stiffness += spring.stiffness * response;
                ties.rates[slot].damping += spring.damping * response;
            }
        }
    }
}

/// Gives the bodies the impulses that the rows remember.
fn warm_start(ties: &Ties, velocities: &mut [Velocity]) {
    for tie in &ties.list {
        for (k, row) in tie.middle.as_slice().iter().enumerate() {
            push(velocities, tie.slots, row, ties.rows[tie.first_row + k].impulse);
        }
    }
}

/// Gives the bodies of a row an impulse.
pub fn push(velocities: &mut [Velocity], slots: [Option<u32>; 2], row: &joint::Row, impulse: Real) {
    if impulse == 0.0 {
        return;
    }
    for (slot, [x, y, turn]) in slots.iter().zip(row.jacobian) {
        let Some(slot) = slot else { continue };
        let body = &mut velocities[*slot as usize];
        body.twist.linear.x += body.inverse_mass.x * x * impulse;
        body.twist.linear.y += body.inverse_mass.y * y * impulse;
        body.twist.angular += body.inverse_inertia * turn * impulse;
    }
}
