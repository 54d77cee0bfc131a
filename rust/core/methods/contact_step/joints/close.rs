//! Gaps of rigid rows closed by moving positions.
//!
//! The shift τ·M⁻¹Jᵀμ, with J of the middle of the substep and τ half of it, is what an impulse μ in the middle and −μ at
//! the end would do together; what the two do to the velocities, M⁻¹(J − J₁)ᵀμ with J₁ at the end, is done as well. Each of them
//! keeps momentum and angular momentum, so the whole does, to rounding.

use super::active::fill;
use super::{Bodies, Ties};
use crate::constraints::Velocity;
use crate::constraints::joint::{self, Action};
use crate::math::{Real, Twist, Vec2, cross, perp};
use crate::methods::contact_step::{Group, Mass};
use crate::solvers::direct::Triple;
use crate::solvers::links::Effort;

/// Newton steps a substep: each leaves of a gap about its part of the turn in half a substep.
const STEPS: usize = 4;

/// Of a Newton step, which the next one corrects.
const EFFORT: Effort = Effort { sweeps: 2, accuracy: 1e-4 };

/// A gap of this part of the lengths around the joint counts as closed: a hundred thousandth of what a substep opens.
const CLOSED: Real = 1e-11;

/// Farthest that a step may move a body, in parts of all gaps together: beyond it rows contradict one another.
const FARTHEST: Real = 8.0;

/// Part of their energy that the velocities' share may change. More comes of rows that contradict one another, such as those of a
/// rope that is exactly taut, and would grow from substep to substep; then it is left out.
const MOST_GAIN: Real = 0.1;

/// Turn (rad) that a step may give at most.
const MOST_TURN: Real = 0.3;

/// Closes the gaps; returns the work that takes against the forces (J), and takes the rows at the end of the substep.
pub fn close(group: &mut Group, h: Real) -> Real {
    look(group);
    let mut total: Vec<Triple> = Vec::new();
    let mut sum = Shift::default();
    for _ in 0..STEPS {
        if !open(group) {
            break;
        }
        total.resize(group.ties.links.len(), [0.0; 3]);
        prepare(group);
        sum += shift(group, &mut total);
        look(group);
    }
    let mut kept = None;
    if sum.size > 0.0 && sum.size <= moved(group, h) {
        kept = turn_velocities(group, &total, 0.5 * h);
    }
    sum.work + kept.unwrap_or_else(|| turn_back(group, sum.carried))
}

/// What moving bodies takes.
#[derive(Clone, Copy, Debug, Default)]
struct Shift {
    /// Work against the forces (J).
    work: Real,
    /// How far it moves the bodies, as [`moved`] has it.
    size: Real,
    /// Angular momentum that their momenta got by being carried to other lines (kg·m²/s).
    carried: Real,
}

impl std::ops::AddAssign for Shift {
    fn add_assign(&mut self, other: Self) {
        self.work += other.work;
        self.size += other.size;
        self.carried += other.carried;
    }
}

/// How far the bodies moved in the substep, or would have without joints, in the measure of their masses: h(Σ mv² + Iω²)^½.
///
/// What a joint opens by itself is closed by a part of that. Whoever puts a body or a target elsewhere opens more: then the
/// bodies are only put where they belong, since no velocities follow from it.
fn moved(group: &Group, h: Real) -> Real {
    let Group { ties, velocities, masses, .. } = group;
    let squares = ties.before.iter().zip(velocities).zip(masses).map(|((before, body), mass)| {
        mass.work(before, before).max(mass.work(&body.twist, &body.twist))
    });
    h * squares.sum::<Real>().sqrt()
}

/// Rows where the bodies are now.
fn look(group: &mut Group) {
    let Group { ties, velocities, places, angles, .. } = group;
    let bodies = Bodies { velocities, places, angles };
    for tie in &mut ties.list {
        tie.law.write_rows(&bodies.pair(tie), &mut tie.end);
    }
}

/// How far a row is from what it holds (m or rad): limits that carried a load count both ways.
fn gap(middle: &joint::Row, end: &joint::Row, impulse: Real) -> Real {
    match (middle.action, end.action) {
        (Action::Hold, Action::Hold) => end.position,
        (Action::Limit, Action::Limit) if impulse > 0.0 => end.position,
        (Action::Limit, Action::Limit) => end.position.min(0.0),
        _ => 0.0,
    }
}

/// Whether any row is open by more than rounding.
fn open(group: &Group) -> bool {
    let ties = &group.ties;
    ties.list.iter().any(|tie| {
        let size = tie.apart.norm() + tie.law.arms[0].norm() + tie.law.arms[1].norm();
        (0..tie.middle.count).any(|k| {
            let (middle, end) = (&tie.middle.rows[k], &tie.end.rows[k]);
            let [x, y, _] = middle.jacobian[1];
            let length = if x == 0.0 && y == 0.0 { 1.0 } else { size };
            gap(middle, end, ties.rows[tie.first_row + k].impulse).abs() > CLOSED * length
        })
    })
}

/// Hands the solver the rows that hold positions.
fn prepare(group: &mut Group) {
    let Group { ties, velocities, .. } = group;
    let Ties { list, rows, nodes, links, solver, prepared, closing, .. } = ties;
    let holds = |tie: &super::Tie, k: usize| {
        let (middle, end) = (&tie.middle.rows[k], &tie.end.rows[k]);
        let impulse = rows[tie.first_row + k].impulse;
        match middle.action {
            Action::Hold => middle.bound == Real::INFINITY,
            Action::Limit => end.action == Action::Limit && (impulse > 0.0 || end.position < 0.0),
            _ => false,
        }
    };
    // Rows that turn out to be passed while others are closed join them.
    closing.clear();
    closing.resize(links.len(), [false; 3]);
    for tie in &*list {
        for k in 0..tie.middle.count {
            closing[tie.first_node + k / 3][k % 3] = holds(tie, k);
        }
    }
    if prepared.as_ref() == Some(&*closing) {
        return;
    }
    fill(list, nodes, links.len(), |tie, k| holds(tie, k).then_some(0.0));
    solver.prepare(velocities, links, nodes);
    prepared.get_or_insert_default().clone_from(closing);
}

/// One Newton step.
fn shift(group: &mut Group, total: &mut [Triple]) -> Shift {
    let Group { ties, places, masses, velocities, .. } = group;
    let Ties { list, rows, solver, wanted, solved, change, links, .. } = ties;
    wanted.clear();
    wanted.resize(links.len(), [0.0; 3]);
    solved.clear();
    solved.resize(links.len(), [0.0; 3]);
    change.clear();
    change.resize(places.len(), Twist::ZERO);
    for tie in &*list {
        for k in 0..tie.middle.count {
            let impulse = rows[tie.first_row + k].impulse;
            wanted[tie.first_node + k / 3][k % 3] =
                -gap(&tie.middle.rows[k], &tie.end.rows[k], impulse);
        }
    }
    solver.solve(wanted, EFFORT, solved, change);
    let turn = change.iter().map(|change| change.angular.abs()).fold(0.0, Real::max);
    let way = change.iter().map(|change| change.linear.norm()).fold(0.0, Real::max);
    let far = FARTHEST * wanted.iter().flatten().map(|gap| gap.abs()).sum::<Real>();
    let within = |most: Real, size: Real| if size > most { most / size } else { 1.0 };
    let part = within(MOST_TURN, turn).min(within(far, way));
    for (sum, own) in total.iter_mut().zip(&*solved) {
        sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += part * own);
    }
    let (mut sum, mut square) = (Shift::default(), 0.0);
    let bodies = places.iter_mut().zip(&*velocities).zip(&*masses);
    for (((place, velocity), mass), change) in bodies.zip(&*change) {
        if *change == Twist::ZERO {
            continue;
        }
        let way = Twist::new(change.linear * part, change.angular * part);
        place.way += way.linear;
        place.rotate(way.angular);
        sum.work -= mass.work(&way, &place.acceleration);
        sum.carried += mass.mass * cross(way.linear, velocity.twist.linear);
        square += mass.work(&way, &way);
    }
    Shift { size: square.sqrt(), ..sum }
}

/// Takes angular momentum from the bodies that joints tie, which turn as one rigid body about their common centre of mass;
/// returns the energy that gives (J). Nothing where one of them is held.
fn turn_back(group: &mut Group, carried: Real) -> Real {
    let Group { ties, velocities, places, masses, .. } = group;
    let Ties { list, positions, .. } = ties;
    if carried == 0.0 {
        return 0.0;
    }
    positions.clear();
    positions.resize(velocities.len(), None);
    for tie in &*list {
        for (slot, start) in tie.slots.iter().zip([tie.origin, tie.origin + tie.apart]) {
            let Some(slot) = slot.map(|slot| slot as usize) else { return 0.0 };
            let Velocity { inverse_mass, inverse_inertia, .. } = &velocities[slot];
            if inverse_mass.x == 0.0 || inverse_mass.y == 0.0 || *inverse_inertia == 0.0 {
                return 0.0;
            }
            positions[slot] = Some(start + places[slot].way);
        }
    }
    let tied = || {
        let slots = positions.iter().zip(&*masses).enumerate();
        slots.filter_map(|(slot, (position, mass))| Some((slot, (*position)?, mass)))
    };
    let mass: Real = tied().map(|(.., mass)| mass.mass).sum();
    let center = tied().map(|(_, at, own)| at * own.mass).sum::<Vec2>() / mass;
    let of =
        |(_, at, own): (usize, Vec2, &Mass)| own.inertia + own.mass * (at - center).norm_squared();
    let turn = -carried / tied().map(of).sum::<Real>();
    let mut gained = 0.0;
    for (slot, at, own) in tied() {
        let change = Twist::new(perp(at - center) * turn, turn);
        let twist = &mut velocities[slot].twist;
        let mean = Twist::new(twist.linear + change.linear * 0.5, twist.angular + 0.5 * turn);
        gained += own.work(&change, &mean);
        *twist += change;
    }
    gained
}

/// The velocities' share of the shift; returns the energy it gives (J), or nothing where it is left out.
fn turn_velocities(group: &mut Group, total: &[Triple], half: Real) -> Option<Real> {
    let Group { ties, velocities, masses, .. } = group;
    let before: Vec<Twist> = velocities.iter().map(|velocity| velocity.twist).collect();
    for tie in &ties.list {
        for k in 0..tie.middle.count {
            let impulse = total[tie.first_node + k / 3][k % 3] / half;
            if impulse == 0.0 {
                continue;
            }
            super::prepare::push(velocities, tie.slots, &tie.middle.rows[k], impulse);
            super::prepare::push(velocities, tie.slots, &tie.end.rows[k], -impulse);
        }
    }
    let gains =
        before.iter().zip(velocities.iter()).zip(&*masses).map(|((before, velocity), mass)| {
            let now = &velocity.twist;
            let change = Twist::new(now.linear - before.linear, now.angular - before.angular);
            let sum = Twist::new(now.linear + before.linear, now.angular + before.angular);
            0.5 * mass.work(&change, &sum)
        });
    let gained: Real = gains.sum();
    let energy = |(twist, mass): (&Twist, &Mass)| 0.5 * mass.work(twist, twist);
    let energies: Real = before.iter().zip(&*masses).map(energy).sum();
    if gained.abs() <= MOST_GAIN * energies {
        return Some(gained);
    }
    velocities.iter_mut().zip(before).for_each(|(velocity, before)| velocity.twist = before);
    None
}
