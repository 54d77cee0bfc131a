//! Joints that hold a point of matter: their rows among those of the points of contact, through A⁻¹.
//!
//! A point that is held moves by half the sum of its velocities before and after the substep, so its middle is that of the implicit step
//! (`Matter::lead`). Rows are taken there: what one end gets at that point the other gets there as well, so that angular momentum is kept, and a row
//! that obeys J(v⁻ + v⁺) = 0 keeps what it holds. As the middle follows from the solution, rows are taken anew whenever the matter has settled.

use super::Group;
use super::joints::{self, Row, State};
use super::matter::{Matters, Scratch};
use super::matter_lever::Lever;
use crate::constraints::joint::{self, Action, Gains, Law, Pair, Rows};
use crate::forces::Ledger;
use crate::joint::ROWS;
use crate::math::{Real, Rot, Twist, Vec2, cross, hypot, sin_cos, vec2};

/// What a joint holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The world.
    Ground,
    /// The body in a slot.
    Body(u32),
    /// A point: the number of the matter, and that of the point.
    Point(u32, u32),
}

/// A joint of which one end at least is a point of matter.
#[derive(Clone, Debug)]
pub struct MatterTie {
    /// What it does.
    pub law: Law,
    /// What it holds.
    pub ends: [End; 2],
    /// Where places are counted from (m).
    pub origin: Vec2,
    /// From there to B at the start of the step (m).
    pub apart: Vec2,
    /// Where the joint is kept.
    pub place: u32,
    /// Impulses of the last substep.
    pub impulses: [Real; ROWS],
    /// Impulse that B got in the step so far (N·s).
    pub given: Vec2,
    /// Its rows at the start of the substep and in its middle.
    start: Rows,
    middle: Rows,
    /// C in the middle where the bodies drift to, without what the substep gives.
    drifted: [Real; ROWS],
    /// Motion of the ends before the substep.
    before: [Twist; 2],
    rows: [Row; ROWS],
    /// JA⁻¹Jᵀ of each row.
    response: [Real; ROWS],
    /// Of ends that are points, their places among what is touched, how far their middle is taken from where they drifted to, and what
    /// their matter has got in the substep.
    pub(super) touched: [u32; 2],
    lead: [Vec2; 2],
    handed: [Vec2; 2],
}

/// Part of what a row that holds is open at the start of a substep that it closes in it.
const CLOSED: Real = 0.2;

impl MatterTie {
    /// A joint with what it remembers.
    #[must_use]
    pub fn new(law: Law, ends: [End; 2], place: u32, impulses: [Real; ROWS]) -> Self {
        let zero = Vec2::zeros();
        Self {
            law,
            ends,
            origin: zero,
            apart: zero,
            place,
            impulses,
            given: zero,
            start: Rows::NONE,
            middle: Rows::NONE,
            drifted: [0.0; ROWS],
            before: [Twist::ZERO; 2],
            rows: [Row::default(); ROWS],
            response: [0.0; ROWS],
            touched: [0; 2],
            lead: [zero; 2],
            handed: [zero; 2],
        }
    }

    /// Its ends as they are, points a lead from where they stand.
    fn pair(&self, group: &Group, matters: &mut dyn Matters, lead: [Vec2; 2]) -> Pair {
        let starts = [Vec2::zeros(), self.apart];
        let (mut centers, mut rots) = (starts, [Rot::IDENTITY; 2]);
        let mut twists = [Twist::ZERO; 2];
        for side in 0..2 {
            match self.ends[side] {
                End::Ground => {}
                End::Body(slot) => {
                    let place = &group.places[slot as usize];
                    centers[side] += place.way;
                    rots[side] = place.rot;
                    twists[side] = group.velocities[slot as usize].twist;
                }
                End::Point(piece, node) => {
                    let piece = matters.piece(piece as usize);
                    centers[side] = piece.place(node) - self.origin + lead[side];
                    twists[side] = Twist::new(piece.velocities(node)[1], 0.0);
                }
            }
        }
        Pair { origin: self.origin, centers, rots, angles: [0.0; 2], twists }
    }

    /// Its rows where its ends are. A point gets no torque: that of a row acts on the other end.
    fn rows_at(&self, pair: &Pair) -> Rows {
        let mut rows = self.law.rows(pair);
        for row in &mut rows.rows[..rows.count] {
            for side in 0..2 {
                if matches!(self.ends[side], End::Body(_)) {
                    continue;
                }
                let turn = std::mem::take(&mut row.jacobian[side][2]);
                row.jacobian[1 - side][2] += turn;
            }
            for side in 0..2 {
                if !matches!(self.ends[side], End::Body(_)) {
                    row.jacobian[side][2] = 0.0;
                }
            }
        }
        rows
    }

    fn leads(&self, matters: &mut dyn Matters) -> [Vec2; 2] {
        self.ends.map(|end| match end {
            End::Point(piece, node) => matters.piece(piece as usize).lead(node),
            _ => Vec2::zeros(),
        })
    }

    fn holds_what(&self, other: &Self) -> bool {
        self.ends.iter().any(|end| match end {
            End::Ground => false,
            End::Body(_) => other.ends.contains(end),
            End::Point(piece, _) => {
                other.ends.iter().any(|end| matches!(end, End::Point(own, _) if own == piece))
            }
        })
    }

    /// Whether row k takes part in a solve of all rows at once: within its bounds.
    fn is_free(&self, k: usize) -> bool {
        let row = &self.rows[k];
        let [low, high] = row.bounds;
        if row.state == State::Off || self.response[k] + row.compliance <= 0.0 {
            return false;
        }
        if self.middle.disc && k < 2 {
            return hypot(self.rows[0].impulse, self.rows[1].impulse) < high * (1.0 - 1e-9);
        }
        row.impulse > low && row.impulse < high
    }

    /// Σ of row k (m/s per N·s).
    pub(super) fn compliance(&self, k: usize) -> Real {
        self.rows[k].compliance
    }

    /// Adds to the impulse of row k.
    pub(super) fn add(&mut self, k: usize, impulse: Real) {
        self.rows[k].impulse += impulse;
    }

    pub(super) fn row_impulses(&self) -> [Real; ROWS] {
        self.rows.map(|row| row.impulse)
    }

    pub(super) fn set_row_impulses(&mut self, impulses: &[Real; ROWS]) {
        self.rows.iter_mut().zip(impulses).for_each(|(row, impulse)| row.impulse = *impulse);
    }

    /// The impulse on the node of one side.
    fn on_node(&self, side: usize) -> Vec2 {
        let rows = self.middle.as_slice().iter().zip(&self.rows);
        rows.map(|(now, row)| vec2(now.jacobian[side][0], now.jacobian[side][1]) * row.impulse)
            .sum()
    }
}

/// Before a substep: where everything is.
pub(super) fn remember(group: &Group, matters: &mut dyn Matters, ties: &mut [MatterTie]) {
    for tie in ties {
        let pair = tie.pair(group, matters, [Vec2::zeros(); 2]);
        (tie.before, tie.start) = (pair.twists, tie.rows_at(&pair));
    }
}

impl Scratch {
    /// Gives what joints hold the impulses of the last substep.
    pub(super) fn start_ties(&mut self, group: &mut Group, h: Real, matters: &mut dyn Matters) {
        for tie in &mut self.ties {
            let drifted = tie.rows_at(&tie.pair(group, matters, [Vec2::zeros(); 2]));
            tie.drifted = drifted.rows.map(|row| row.position);
            tie.lead = tie.leads(matters);
            tie.middle = tie.rows_at(&tie.pair(group, matters, tie.lead));
            tie.handed = [Vec2::zeros(); 2];
            for k in 0..tie.middle.count {
                let (now, start) = (&tie.middle.rows[k], &tie.start.rows[k]);
                let most = if now.bound.is_finite() { now.bound * h } else { Real::INFINITY };
                let mut row =
                    Row { impulse: tie.impulses[k], from: start.position, ..Row::default() };
                row.bounds =
                    if now.action == Action::Limit { [0.0, Real::INFINITY] } else { [-most, most] };
                row.state = if now.action == Action::Off { State::Off } else { State::Solved };
                let other = now.action == Action::Limit && joints::against(now, start);
                row.impulse = if row.state == State::Off || other {
                    0.0
                } else {
                    row.impulse.clamp(row.bounds[0], row.bounds[1])
                };
                tie.rows[k] = row;
            }
            tie.within_disc();
            for side in 0..2 {
                let given = tie.on_node(side);
                match tie.ends[side] {
                    End::Point(piece, node) => {
                        matters.piece(piece as usize).push(node, given);
                        tie.handed[side] = given;
                    }
                    End::Body(slot) => {
                        for (now, row) in tie.middle.as_slice().iter().zip(&tie.rows) {
                            push_body(group, slot, &now.jacobian[side], row.impulse);
                        }
                    }
                    End::Ground => {}
                }
            }
        }
    }

    /// Takes the rows where the middle of the substep is as last settled, what they already gave included, and what they ask for. Returns the
    /// size of the velocities that they deal with (m/s).
    pub(super) fn aim_ties(
        &mut self,
        group: &mut Group,
        h: Real,
        matters: &mut dyn Matters,
    ) -> Real {
        for t in 0..self.ties.len() {
            let tie = &mut self.ties[t];
            tie.lead = tie.leads(matters);
            let rows = tie.rows_at(&tie.pair(group, matters, tie.lead));
            let before = std::mem::replace(&mut tie.middle, rows);
            for (side, end) in tie.ends.iter().enumerate() {
                let End::Body(slot) = *end else { continue };
                for (k, old) in before.as_slice().iter().enumerate() {
                    let (new, impulse) = (tie.middle.rows[k].jacobian[side], tie.rows[k].impulse);
                    push_body(
                        group,
                        slot,
                        &std::array::from_fn(|i| new[i] - old.jacobian[side][i]),
                        impulse,
                    );
                }
            }
            for k in 0..self.ties[t].middle.count {
                let lever = self.lever_of_row(t, k);
                self.ties[t].response[k] = self.coupling(group, &lever, &lever);
            }
        }
        let mut scale: Real = 0.0;
        for t in 0..self.ties.len() {
            let rate = self.damping_around(t);
            for k in 0..self.ties[t].middle.count {
                let lever = self.lever_of_row(t, k);
                scale = scale.max(self.velocity_along(group, &lever).abs());
                self.ties[t].aim(k, (group, rate), h);
            }
        }
        scale
    }

    /// Γ (1/s): the sum over the springs of all joints that share an end with joint t.
    fn damping_around(&self, t: usize) -> Real {
        let mut sum = 0.0;
        for other in self.ties.iter().filter(|other| other.holds_what(&self.ties[t])) {
            for (row, response) in other.middle.as_slice().iter().zip(other.response) {
                let Action::Spring(spring) = row.action else { continue };
                sum += spring.damping * response;
            }
        }
        sum
    }

    /// Row k of joint t as an impulse along it acts.
    pub(super) fn lever_of_row(&self, t: usize, k: usize) -> Lever {
        let tie = &self.ties[t];
        let mut lever = Lever::default();
        for (side, end) in tie.ends.iter().enumerate() {
            let jacobian = tie.middle.rows[k].jacobian[side];
            match *end {
                End::Ground => {}
                End::Body(slot) => lever.add_body(slot, jacobian),
                End::Point(..) => lever.add_node(tie.touched[side], vec2(jacobian[0], jacobian[1])),
            }
        }
        lever
    }

    /// Solves the rows of the joints one by one; returns the largest change of a velocity along one (m/s).
    pub(super) fn sweep_ties(&mut self, group: &mut Group) -> Real {
        let mut largest: Real = 0.0;
        for t in 0..self.ties.len() {
            let old = self.ties[t].rows.map(|row| row.impulse);
            for k in 0..self.ties[t].middle.count {
                let lever = self.lever_of_row(t, k);
                let (lacks, response) = self.lacks(group, (t, k), &lever);
                let row = &mut self.ties[t].rows[k];
                if row.state == State::Off || response <= 0.0 {
                    continue;
                }
                let from = row.impulse;
                row.impulse = (from + lacks / response).clamp(row.bounds[0], row.bounds[1]);
                let change = row.impulse - from;
                self.apply_lever(group, &lever, change);
            }
            self.ties[t].within_disc().into_iter().enumerate().for_each(|(k, change)| {
                let lever = self.lever_of_row(t, k);
                self.apply_lever(group, &lever, change);
            });
            let tie = &self.ties[t];
            for ((row, old), response) in tie.rows.iter().zip(old).zip(tie.response) {
                largest = largest.max(((row.impulse - old) * response).abs());
            }
        }
        largest
    }

    /// wanted − Jv − Σλ of a row, and JA⁻¹Jᵀ + Σ.
    pub(super) fn lacks(
        &self,
        group: &Group,
        (t, k): (usize, usize),
        lever: &Lever,
    ) -> (Real, Real) {
        let (row, response) = (&self.ties[t].rows[k], self.ties[t].response[k]);
        let lacks = row.wanted - self.velocity_along(group, lever) - row.compliance * row.impulse;
        (lacks, response + row.compliance)
    }

    /// The rows of joints that are solved all at once.
    pub(super) fn free_rows(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.ties.iter().enumerate().flat_map(|(t, tie)| {
            (0..tie.middle.count).filter(|k| tie.is_free(*k)).map(move |k| (t, k))
        })
    }

    /// Largest velocity (m/s) by which a row of a joint misses what it asks for.
    pub(super) fn lack_of_ties(&self, group: &Group) -> Real {
        let lack =
            |(t, k): (usize, usize)| self.lacks(group, (t, k), &self.lever_of_row(t, k)).0.abs();
        self.free_rows().map(lack).fold(0.0, Real::max)
    }

    /// Brings impulses of rows back within their bounds.
    pub(super) fn admit_ties(&mut self, group: &mut Group) {
        for t in 0..self.ties.len() {
            let from = self.ties[t].rows.map(|row| row.impulse);
            let tie = &mut self.ties[t];
            for row in &mut tie.rows[..tie.middle.count] {
                row.impulse = row.impulse.clamp(row.bounds[0], row.bounds[1]);
            }
            tie.within_disc();
            for (k, from) in from.into_iter().enumerate().take(self.ties[t].middle.count) {
                let change = self.ties[t].rows[k].impulse - from;
                if change != 0.0 {
                    let lever = self.lever_of_row(t, k);
                    self.apply_lever(group, &lever, change);
                }
            }
        }
    }

    /// Hands the matter what its points have got since it settled; returns the largest of it (N·s).
    pub(super) fn given_by_ties(&mut self, matters: &mut dyn Matters) -> Real {
        let mut largest: Real = 0.0;
        for tie in &mut self.ties {
            for side in 0..2 {
                let End::Point(piece, node) = tie.ends[side] else { continue };
                let given = tie.on_node(side);
                let change = given - tie.handed[side];
                if change != Vec2::zeros() {
                    tie.handed[side] = given;
                    largest = largest.max(change.norm());
                    matters.piece(piece as usize).push(node, change);
                }
            }
        }
        largest
    }

    /// Lets impulses act on rigid bodies where the matter, as it has settled, has its middle.
    pub(super) fn ties_follow_lead(
        &self,
        group: &mut Group,
        matters: &mut dyn Matters,
        part: Real,
    ) {
        for tie in &self.ties {
            let leads = tie.leads(matters);
            for side in 0..2 {
                let (End::Body(slot), End::Point(..)) = (tie.ends[side], tie.ends[1 - side]) else {
                    continue;
                };
                let farther = leads[1 - side] - tie.lead[1 - side];
                let velocity = &mut group.velocities[slot as usize];
                let turn = cross(farther, -tie.on_node(1 - side));
                velocity.twist.angular += velocity.inverse_inertia * turn * part;
            }
        }
    }

    /// Books what joints did in the substep, and returns what they gave the rigid bodies that give way (J): an impulse p does the work
    /// p·½J(v⁻ + v⁺).
    pub(super) fn book_ties(
        &mut self,
        group: &Group,
        h: Real,
        matters: &mut dyn Matters,
        ledger: &mut Ledger,
    ) -> Real {
        let mut gained = 0.0;
        for tie in &mut self.ties {
            let (mut means, mut driver) = ([Twist::ZERO; 2], [Twist::ZERO; 2]);
            let mut rigid = [false; 2];
            for side in 0..2 {
                match tie.ends[side] {
                    End::Ground => {}
                    End::Body(slot) => {
                        let slot = slot as usize;
                        let (now, free) = (&group.velocities[slot].twist, &group.free[slot]);
                        let kick = group.places[slot].kick(h);
                        means[side] = Twist::new(
                            (now.linear + free.linear - kick.linear) * 0.5,
                            (now.angular + free.angular - kick.angular) * 0.5,
                        );
                        rigid[side] = !group.velocities[slot].is_fixed();
                        if !rigid[side] {
                            driver[side] = means[side];
                        }
                    }
                    End::Point(piece, node) => {
                        let [before, after] = matters.piece(piece as usize).velocities(node);
                        means[side] = Twist::new((before + after) * 0.5, 0.0);
                    }
                }
            }
            let own = [0, 1].map(|side| if rigid[side] { means[side] } else { Twist::ZERO });
            for (k, now) in tie.middle.as_slice().iter().enumerate() {
                let row = &mut tie.rows[k];
                tie.impulses[k] = row.impulse;
                row.work = row.impulse * now.velocity([&means[0], &means[1]]);
                gained += row.impulse * now.velocity([&own[0], &own[1]]);
                joints::book_row(now, row, ledger);
                ledger.work -= row.impulse * now.velocity([&driver[0], &driver[1]]);
                tie.given += vec2(now.jacobian[1][0], now.jacobian[1][1]) * row.impulse;
            }
        }
        gained
    }

    /// Books what dampers took, at the end of a substep.
    pub(super) fn book_dampers(
        &mut self,
        group: &Group,
        matters: &mut dyn Matters,
        ledger: &mut Ledger,
    ) {
        for tie in &mut self.ties {
            let end = tie.rows_at(&tie.pair(group, matters, [Vec2::zeros(); 2]));
            for (now, row) in end.as_slice().iter().zip(&tie.rows) {
                joints::book_damper(now, row, ledger);
            }
        }
    }
}

impl MatterTie {
    /// What row k asks for; springs around it damp at this rate (1/s).
    fn aim(&mut self, k: usize, (group, rate): (&Group, Real), h: Real) {
        let (now, start) = (&self.middle.rows[k], &self.start.rows[k]);
        let before = [&self.before[0], &self.before[1]];
        let along = now.velocity(before);
        let curve = start.velocity(before) - along;
        let row = &mut self.rows[k];
        row.compliance = 0.0;
        match now.action {
            Action::Off => {}
            Action::Hold if now.bound < Real::INFINITY => {
                let disc = self.middle.disc && k < 2;
                let open = if disc {
                    hypot(self.drifted[0], self.drifted[1])
                } else {
                    self.drifted[k].abs()
                };
                let response = if disc {
                    0.5 * (self.response[0] + self.response[1])
                } else {
                    self.response[k]
                };
                let back = if open > 0.0 {
                    (1.0 / h).min((now.bound * response / open).sqrt())
                } else {
                    0.0
                };
                row.wanted = curve - self.drifted[k] * back;
            }
            Action::Hold => {
                let bend = bend(&self.ends, (now, before), group, h);
                row.wanted = curve - bend - CLOSED * start.position / h;
            }
            Action::Drive(speed) => row.wanted = speed,
            Action::Limit => {
                let curve = if joints::against(now, start) { 0.0 } else { curve };
                row.wanted = joints::reach(row.impulse > 0.0, self.drifted[k], curve, h).0;
            }
            Action::Spring(spring) => {
                let gains = Gains::midpoint(&spring, rate, h);
                if gains.after > 0.0 {
                    row.compliance = 1.0 / gains.after;
                    row.wanted =
                        (gains.pull * self.drifted[k] + gains.before * along) * row.compliance;
                } else {
                    (row.state, row.impulse) = (State::Off, 0.0);
                }
            }
        }
    }

    /// Brings two rows with one bound on both together back within it; returns the changes.
    fn within_disc(&mut self) -> [Real; 2] {
        let length = hypot(self.rows[0].impulse, self.rows[1].impulse);
        let bound = self.rows[0].bounds[1];
        if !self.middle.disc || length <= bound || length == 0.0 {
            return [0.0; 2];
        }
        [0, 1].map(|k| {
            let row = &mut self.rows[k];
            let from = row.impulse;
            row.impulse *= bound / length;
            row.impulse - from
        })
    }
}

/// By how much J(v⁻ + v⁺) is off what a rigid body's point moves by, over h/2: the turn by Δθ takes it by 2 tan(Δθ/2) across the arm to the middle of
/// both its places, from the middle of those of the centre.
fn bend(
    ends: &[End; 2],
    (now, before): (&joint::Row, [&Twist; 2]),
    group: &Group,
    h: Real,
) -> Real {
    let of_side = |side: usize| {
        let End::Body(slot) = ends[side] else { return 0.0 };
        let (v, [x, y, turn]) = (&group.velocities[slot as usize].twist, now.jacobian[side]);
        let spin = before[side].angular + v.angular;
        let half = (0.25 * h * spin).clamp(-1.0, 1.0);
        let (sin, cos) = sin_cos(half);
        let ratio = if half == 0.0 { 1.0 } else { sin / (cos * half) };
        let change = v.linear - before[side].linear;
        let arm = turn - 0.25 * h * cross(change, vec2(x, y));
        (arm * ratio - turn) * spin
    };
    of_side(0) + of_side(1)
}

fn push_body(group: &mut Group, slot: u32, [x, y, turn]: &[Real; 3], impulse: Real) {
    group.velocities[slot as usize].push(vec2(*x, *y), *turn, impulse);
}
