//! Groups that hold matter which gives way: its points of contact, rigid contacts and joints in one solve.
//!
//! The rows of all points on one piece of matter are coupled by A⁻¹ among the nodes that are touched. They are swept together with the
//! blocks of rigid contacts and the joints; then the matter settles, nonlinear as it is, under the impulses it got, and what that leaves
//! is swept again.

use super::matter_direct::{Direct, Saved};
use super::matter_energy::book;
use super::matter_ties::{End, MatterTie, remember};
use super::{
    Group, Outcome, Settings, Surroundings, impacts, joints, kick, place_blocks, prepare_rows,
    project,
};
use crate::constraints::matter::{Effort, Matter, Point, Side};
use crate::error::Result;
use crate::math::{Real, Vec2, cross};
use crate::methods::Span;
use crate::solvers::sweep::{self, Budget};

/// What a group holds beside rigid bodies.
pub trait Matters {
    /// Number of pieces.
    fn count(&self) -> usize;

    /// One of them.
    fn piece(&mut self, k: usize) -> &mut dyn Matter;

    /// Finds the points of contact in the middle of a substep of length h (s), with what they remember.
    fn find(&mut self, group: &Group, h: Real, points: &mut Vec<Point>);

    /// Keeps what points did, for the next substep.
    fn keep(&mut self, group: &Group, h: Real, points: &[Point]);
}

/// Rounds of a substep in which the rows are solved and the matter goes a step of Newton's method, and rounds after those in which it settles.
const NEARING: usize = 12;
const SETTLING: usize = 6;
/// Times that points are swept in a round; after all but the last they are solved at once.
const ATTEMPTS: u32 = 8;
/// Sweeps of the last time, as a multiple of the world's.
const SWEEPS: u32 = 4;
/// Part of the velocities that the substep deals with to which the rows must settle.
const CALM: Real = 1e-7;
/// Overlap that is left alone, as a part of the width of a point.
const SLOP: Real = 1e-2;
/// Part of the rest that a substep removes.
const PART: Real = 0.1;
/// Speed with which overlap is removed at most, as a part of the width in a substep.
const MOST: Real = 0.02;

/// Columns of the solve, kept between substeps.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pub(super) points: Vec<Point>,
    /// Joints that hold points of matter.
    pub ties: Vec<MatterTie>,
    pub(super) rows: Vec<Row>,
    /// Nodes that are touched, piece after piece, and where each piece begins; one more ends the last.
    pub(super) nodes: Vec<u32>,
    pub(super) first: Vec<usize>,
    /// Velocities of those.
    pub(super) velocities: Vec<Vec2>,
    /// A⁻¹ among those of each piece.
    pub(super) responses: Vec<Vec<[Real; 4]>>,
    /// Impulses on the touched nodes.
    pub(super) pushed: Vec<Vec2>,
    pub(super) direct: Direct,
    pub(super) saved: Saved,
}

/// The rows of a point as sweeps see them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// Places of the touched nodes of both sides, and their weights, below 0 on A; weight 0: none.
    pub(super) places: [u32; 4],
    pub(super) weights: [Real; 4],
    /// J A⁻¹ Jᵀ: nn, nt, tt.
    response: [Real; 3],
    pub(super) target: [Real; 2],
}

/// Moves a group with matter through a span.
///
/// # Errors
/// Those of the surroundings.
pub fn run(
    group: &mut Group,
    span: Span,
    settings: Settings,
    (around, matters, scratch): (&mut dyn Surroundings, &mut dyn Matters, &mut Scratch),
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let h = span.h();
    joints::start(group);
    for k in 0..span.substeps {
        joints::remember(group);
        remember(group, matters, &mut scratch.ties);
        outcome.ledger.dissipated += around.drift(h / 2.0, group)?;
        (0..matters.count()).for_each(|k| matters.piece(k).begin(h));
        around.accelerate((span.time(k) + h / 2.0, h), group)?;
        place_blocks(group);
        joints::place(group);
        kick(group, h / 2.0);
        group.middle = span.time(k) + h / 2.0;
        impacts::resolve(group, h, settings.law, (around, &mut outcome));
        kick(group, h / 2.0);
        matters.find(group, h, &mut scratch.points);
        solve(group, (h, settings), (matters, scratch), &mut outcome);
        matters.keep(group, h, &scratch.points);
        outcome.ledger.work += around.work(group);
        if group.watch.has_swift(group) {
            impacts::resolve_turned(group, h, settings.law, (around, &mut outcome));
        }
        outcome.ledger.dissipated += around.drift(h / 2.0, group)?;
        for k in 0..matters.count() {
            outcome.ledger += matters.piece(k).finish();
        }
        project::apart(group, h, &mut outcome);
        if !group.ties.is_empty() {
            outcome.ledger.correction_work += joints::close(group, h);
            joints::book_dampers(group, &mut outcome.ledger);
        }
        scratch.book_dampers(group, matters, &mut outcome.ledger);
        if !group.watch.blocks.is_empty() {
            group.note_thrown();
        }
    }
    Ok(outcome)
}

fn solve(
    group: &mut Group,
    (h, settings): (Real, Settings),
    (matters, scratch): (&mut dyn Matters, &mut Scratch),
    outcome: &mut Outcome,
) {
    group.free.clear();
    group.free.extend(group.velocities.iter().map(|velocity| velocity.twist));
    let fastest = prepare_rows(group, h);
    joints::prepare(group, h);
    for point in &mut scratch.points {
        point.handed = point.impulse();
        push(group, matters, point);
    }
    scratch.start_ties(group, h, matters);
    let mut effort = all(matters, |piece| piece.approach());
    scratch.gather(matters);
    let scale = scratch.aim(group, matters, h).max(fastest);
    let mut scale = scale.max(scratch.aim_ties(group, h, matters));
    let mut budget = Budget { tolerance: CALM * scale, most: settings.sweeps };
    let (mut stale, mut near) = (false, scratch.is_empty());
    for round in 0..NEARING + SETTLING {
        if stale {
            scratch.gather(matters);
            scratch.aim(group, matters, h);
        }
        scratch.take(matters);
        if round > 0 && !scratch.ties.is_empty() {
            scale = scratch.aim_ties(group, h, matters).max(scale);
            budget.tolerance = CALM * scale;
        }
        let (sweeps, residual) = scratch.solve_rows(group, budget);
        outcome.sweeps += u64::from(sweeps);
        let given = scratch.given(matters);
        let settles = near || round >= NEARING;
        let more = all(matters, |piece| if settles { piece.settle() } else { piece.approach() });
        effort.iterations += more.iterations;
        effort.factorisations += more.factorisations;
        stale = more.factorisations > 0;
        let off = scratch.off(matters).max(residual);
        near = settles || off <= budget.tolerance;
        let still = given == 0.0 && sweeps <= 1;
        if settles && (still || off <= budget.tolerance) || round + 1 == NEARING + SETTLING {
            outcome.residual = outcome.residual.max(off);
            break;
        }
    }
    outcome.factorisations += effort.factorisations;
    scratch.follow_lead(group, matters, 1.0);
    scratch.weaken(group, h, matters, outcome);
    book(group, h, (matters, scratch), outcome);
    for (block, link) in group.blocks.iter().zip(&mut group.links) {
        link.passed += block.impulse[0] + block.impulse[1];
    }
    if !group.watch.blocks.is_empty() {
        project::turn_back_late(group, h, outcome);
    }
}

/// Lets all pieces do something.
pub(super) fn all(
    matters: &mut dyn Matters,
    mut act: impl FnMut(&mut dyn Matter) -> Effort,
) -> Effort {
    let mut effort = Effort::default();
    for k in 0..matters.count() {
        let own = act(matters.piece(k));
        effort.iterations += own.iterations;
        effort.factorisations += own.factorisations;
    }
    effort
}

/// Gives both sides of a point its impulse.
fn push(group: &mut Group, matters: &mut dyn Matters, point: &Point) {
    let impulse = point.handed;
    if impulse == Vec2::zeros() {
        return;
    }
    for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
        match *side {
            Side::Body(slot, arm) => {
                group.velocities[slot as usize].push_at(arm, impulse * sign);
            }
            Side::Nodes(k, nodes, weights) => {
                for (node, weight) in nodes.iter().zip(weights) {
                    matters.piece(k as usize).push(*node, impulse * (sign * weight));
                }
            }
        }
    }
}

impl Scratch {
    /// Numbers the nodes that are touched, and finds A⁻¹ among them.
    fn gather(&mut self, matters: &mut dyn Matters) {
        let Self { nodes, first, .. } = self;
        nodes.clear();
        first.clear();
        let count = matters.count();
        for k in 0..count {
            self.first.push(self.nodes.len());
            self.touched_of(k as u32);
        }
        let Self { nodes, first, velocities, responses, .. } = self;
        first.push(nodes.len());
        velocities.clear();
        velocities.resize(nodes.len(), Vec2::zeros());
        responses.resize(responses.len().max(count), Vec::new());
        for k in 0..count {
            matters.piece(k).respond(&nodes[first[k]..first[k + 1]], &mut responses[k]);
        }
        self.place_rows();
    }

    /// Adds the nodes of a piece that are touched, each once.
    fn touched_of(&mut self, k: u32) {
        let Self { points, ties, nodes, .. } = self;
        let start = nodes.len();
        for side in points.iter().flat_map(|point| &point.sides) {
            if let Side::Nodes(piece, pair, weights) = side
                && *piece == k
            {
                nodes.extend(pair.iter().zip(weights).filter(|(_, w)| **w != 0.0).map(|(n, _)| *n));
            }
        }
        for end in ties.iter().flat_map(|tie| &tie.ends) {
            if let End::Point(piece, node) = *end
                && piece == k
            {
                nodes.push(node);
            }
        }
        nodes[start..].sort_unstable();
        let mut kept = start;
        for at in start..nodes.len() {
            if at == start || nodes[at] != nodes[kept - 1] {
                nodes[kept] = nodes[at];
                kept += 1;
            }
        }
        nodes.truncate(kept);
    }

    /// Finds the places of what rows touch among the touched nodes.
    fn place_rows(&mut self) {
        let Self { points, ties, rows, nodes, first, .. } = self;
        let place = |piece: u32, node: u32| {
            let own = first[piece as usize]..first[piece as usize + 1];
            (own.start + nodes[own].binary_search(&node).unwrap_or(0)) as u32
        };
        rows.clear();
        for point in points {
            let mut row = Row::default();
            for (s, (side, sign)) in point.sides.iter().zip([-1.0, 1.0]).enumerate() {
                let Side::Nodes(piece, pair, weights) = side else { continue };
                for (n, (node, weight)) in pair.iter().zip(weights).enumerate() {
                    row.places[2 * s + n] = place(*piece, *node);
                    row.weights[2 * s + n] = sign * weight;
                }
            }
            rows.push(row);
        }
        for tie in ties {
            for (end, touched) in tie.ends.iter().zip(&mut tie.touched) {
                if let End::Point(piece, node) = *end {
                    *touched = place(piece, node);
                }
            }
        }
    }

    /// Targets and responses of the rows; returns the size of the velocities that they deal with (m/s).
    fn aim(&mut self, group: &Group, matters: &mut dyn Matters, h: Real) -> Real {
        let mut scale: Real = 0.0;
        self.take(matters);
        for k in 0..self.rows.len() {
            self.rows[k].response = self.response(group, k);
            let point = &self.points[k];
            let mut before = Vec2::zeros();
            for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
                before += sign
                    * match *side {
                        Side::Body(slot, arm) => {
                            let kick = group.places[slot as usize].kick(h);
                            group.free[slot as usize].at(arm) - kick.at(arm)
                        }
                        Side::Nodes(piece, nodes, weights) => {
                            let piece = matters.piece(piece as usize);
                            let of = |n: usize| piece.velocities(nodes[n])[0] * weights[n];
                            of(0) + of(1)
                        }
                    };
            }
            let now = self.velocity(group, k);
            let came = point.normal.dot(&before);
            scale = scale.max(now.amax()).max(before.amax());
            self.rows[k].target = targets(point, h, came);
        }
        scale
    }

    fn is_empty(&self) -> bool {
        self.rows.is_empty() && self.ties.is_empty()
    }

    /// Takes the velocities of the nodes that are touched.
    fn take(&mut self, matters: &mut dyn Matters) {
        for k in 0..matters.count() {
            for at in self.first[k]..self.first[k + 1] {
                self.velocities[at] = matters.piece(k).velocities(self.nodes[at])[1];
            }
        }
    }

    /// Velocity of B against A at point k.
    pub(super) fn velocity(&self, group: &Group, k: usize) -> Vec2 {
        let (point, row) = (&self.points[k], &self.rows[k]);
        let mut velocity = Vec2::zeros();
        for (s, (side, sign)) in point.sides.iter().zip([-1.0, 1.0]).enumerate() {
            match *side {
                Side::Body(slot, arm) => {
                    velocity += group.velocities[slot as usize].at(arm) * sign;
                }
                Side::Nodes(..) => {
                    for n in [2 * s, 2 * s + 1].into_iter().filter(|n| row.weights[*n] != 0.0) {
                        velocity += self.velocities[row.places[n] as usize] * row.weights[n];
                    }
                }
            }
        }
        velocity
    }

    /// nn, nt, tt of the response at point k.
    fn response(&self, group: &Group, k: usize) -> [Real; 3] {
        let [n, t] = self.points[k].directions().map(|along| self.lever_of_point(k, along));
        [(&n, &n), (&n, &t), (&t, &t)].map(|(a, b)| self.coupling(group, a, b))
    }

    /// The block of A⁻¹ between two touched nodes; none between those of different pieces.
    pub(super) fn block(&self, a: u32, b: u32) -> Option<[Real; 4]> {
        let piece = self.piece_of(a);
        let range = self.first[piece]..self.first[piece + 1];
        if !range.contains(&(b as usize)) {
            return None;
        }
        let [row, column] = [a, b].map(|x| x as usize - range.start);
        Some(self.responses[piece][row * range.len() + column])
    }

    /// Sweeps; where they do not settle soon, all points that bear are solved at once, and swept again.
    fn solve_rows(&mut self, group: &mut Group, budget: Budget) -> (u32, Real) {
        let mut sweeps = 0;
        let mut residual = 0.0;
        if !self.ties.is_empty() {
            self.solve_together(group);
        }
        for attempt in 0..ATTEMPTS {
            let last = attempt + 1 == ATTEMPTS;
            let most = if last { SWEEPS * budget.most } else { budget.most };
            let (own, left) = self.sweep(group, budget, most);
            (sweeps, residual) = (sweeps + own, left);
            if residual <= budget.tolerance || self.is_empty() || last {
                break;
            }
            if !self.solve_together(group) {
                let (own, left) = self.sweep(group, budget, SWEEPS * budget.most);
                return (sweeps + own, left);
            }
        }
        (sweeps, residual)
    }

    /// Sweeps over rigid blocks, joints and points in turn.
    fn sweep(&mut self, group: &mut Group, budget: Budget, most: u32) -> (u32, Real) {
        let single = Budget { most: 1, ..budget };
        let mut change = 0.0;
        for sweep in 1..=most {
            change = 0.0;
            if !group.ties.is_empty() {
                change =
                    joints::solve(&mut group.ties, &mut group.velocities, joints::TURN).max(change);
            }
            if !group.blocks.is_empty() {
                let (_, residual) = sweep::solve(&mut group.velocities, &mut group.blocks, single);
                change = residual.max(change);
            }
            change = self.sweep_ties(group).max(change);
            // To and fro, so that what is pushed at one end is felt at the other.
            for at in 0..self.rows.len() {
                let k = if sweep % 2 == 1 { at } else { self.rows.len() - 1 - at };
                change = self.solve_point(group, k).max(change);
            }
            if change <= budget.tolerance {
                return (sweep, change);
            }
        }
        (most, change)
    }

    /// Solves point k exactly; returns the change of its velocity (m/s).
    fn solve_point(&mut self, group: &mut Group, k: usize) -> Real {
        let now = self.velocity(group, k);
        let (point, row) = (&mut self.points[k], &self.rows[k]);
        let [n, t] = point.directions();
        let error = [n.dot(&now) - row.target[0], t.dot(&now) - row.target[1]];
        if point.grip.impulse == [0.0; 2] && error[0] >= 0.0 {
            return 0.0;
        }
        let old = point.grip.impulse;
        let new = impulses(point, row, error);
        point.grip.impulse = new;
        let change = [new[0] - old[0], new[1] - old[1]];
        let [nn, _, tt] = row.response;
        let given = n * change[0] + t * change[1];
        self.give(group, k, given);
        (change[0] * nn).abs().max((change[1] * tt).abs())
    }

    /// Lets both sides of point k feel an impulse.
    pub(super) fn give(&mut self, group: &mut Group, k: usize, impulse: Vec2) {
        let (sides, row) = (self.points[k].sides, self.rows[k]);
        for (s, (side, sign)) in sides.iter().zip([-1.0, 1.0]).enumerate() {
            match *side {
                Side::Body(slot, arm) => {
                    group.velocities[slot as usize].push_at(arm, impulse * sign);
                }
                Side::Nodes(..) => {
                    for n in [2 * s, 2 * s + 1].into_iter().filter(|n| row.weights[*n] != 0.0) {
                        let (place, weight) = (row.places[n], row.weights[n]);
                        self.push_node(place, impulse * weight);
                    }
                }
            }
        }
    }

    /// Hands the pieces what sweeps have given since they settled; returns the largest of it (N·s).
    pub(super) fn given(&mut self, matters: &mut dyn Matters) -> Real {
        let mut largest = self.given_by_ties(matters);
        for point in &mut self.points {
            let impulse = point.impulse();
            let change = impulse - point.handed;
            point.handed = impulse;
            if change == Vec2::zeros() {
                continue;
            }
            largest = largest.max(change.norm());
            for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
                if let Side::Nodes(k, nodes, weights) = *side {
                    for (node, weight) in nodes.iter().zip(weights) {
                        matters.piece(k as usize).push(*node, change * (sign * weight));
                    }
                }
            }
        }
        largest
    }

    /// Lets impulses act on rigid bodies where they act on the matter, so that angular momentum is kept.
    pub(super) fn follow_lead(&self, group: &mut Group, matters: &mut dyn Matters, part: Real) {
        self.ties_follow_lead(group, matters, part);
        for point in &self.points {
            let impulse = point.impulse();
            for s in 0..2 {
                let (Side::Body(slot, _), Side::Nodes(piece, nodes, weights)) =
                    (point.sides[s], point.sides[1 - s])
                else {
                    continue;
                };
                let piece = matters.piece(piece as usize);
                let lead = piece.lead(nodes[0]) * weights[0] + piece.lead(nodes[1]) * weights[1];
                let given = if s == 0 { -impulse } else { impulse };
                let velocity = &mut group.velocities[slot as usize];
                velocity.twist.angular += velocity.inverse_inertia * cross(lead, given) * part;
            }
        }
    }

    /// By how much the nodes as settled are off what sweeps foresaw (m/s).
    fn off(&self, matters: &mut dyn Matters) -> Real {
        let mut off: Real = 0.0;
        for k in 0..matters.count() {
            for at in self.first[k]..self.first[k + 1] {
                let now = matters.piece(k).velocities(self.nodes[at])[1];
                off = off.max((now - self.velocities[at]).amax());
            }
        }
        off
    }
}

pub(super) fn apply(block: &[Real; 4], v: Vec2) -> Vec2 {
    Vec2::new(block[0] * v.x + block[1] * v.y, block[2] * v.x + block[3] * v.y)
}

/// Velocities that the rows of a point ask for: v ≥ −gap/h where there is a gap; what bounces, −e times as it came; what overlaps by more than
/// the slop is parted slowly.
fn targets(point: &Point, h: Real, came: Real) -> [Real; 2] {
    let tangent = point.tangent_speed;
    if point.gap > 0.0 {
        let arrives = came * h < -point.gap;
        let bounce =
            if arrives && point.grip.impulse[0] == 0.0 { -point.restitution * came } else { 0.0 };
        return [if bounce > 0.0 { bounce } else { -point.gap / h }, tangent];
    }
    let slop = SLOP * point.width;
    let parting = (PART * (-point.gap - slop)).clamp(0.0, MOST * point.width) / h;
    let bounce =
        if point.grip.impulse[0] == 0.0 { (-point.restitution * came).max(0.0) } else { 0.0 };
    [parting.max(bounce), tangent]
}

/// Impulses that solve one point: it sticks, parts or slides.
fn impulses(point: &mut Point, row: &Row, error: [Real; 2]) -> [Real; 2] {
    let [nn, nt, tt] = row.response;
    let [n, t] = point.grip.impulse;
    let determinant = nn * tt - nt * nt;
    let stick = if determinant > 1e-12 * nn * tt {
        [
            n - (tt * error[0] - nt * error[1]) / determinant,
            t - (nn * error[1] - nt * error[0]) / determinant,
        ]
    } else {
        [n - error[0] / nn.max(Real::MIN_POSITIVE), t]
    };
    let held = if point.grip.sliding { point.friction.sliding } else { point.friction.sticking };
    if stick[0] >= 0.0 && stick[1].abs() <= held * stick[0] {
        point.grip.sliding = false;
        return stick;
    }
    // Velocities without any impulse of the point.
    let free = [error[0] - nn * n - nt * t, error[1] - nt * n - tt * t];
    if free[0] >= 0.0 {
        return [0.0; 2];
    }
    let slides = |sign: Real| {
        let by = nn + sign * point.friction.sliding * nt;
        let normal = if by > 0.0 { -free[0] / by } else { 0.0 };
        let tangent = sign * point.friction.sliding * normal;
        // It opposes the sliding that remains.
        let speed = free[1] + nt * normal + tt * tangent;
        (sign * speed <= 0.0 && normal > 0.0).then_some([normal, tangent])
    };
    let sign = if free[1] > 0.0 { -1.0 } else { 1.0 };
    let normal = -free[0] / nn.max(Real::MIN_POSITIVE);
    point.grip.sliding = true;
    slides(sign).or_else(|| slides(-sign)).unwrap_or([normal, 0.0])
}
