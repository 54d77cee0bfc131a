//! C, J and J̇v of each kind of joint.

use super::{Action, Law, Pair};
use crate::joint::{Hold, JointKind, Motor, ROWS, Travel};
use crate::math::{Real, Twist, Vec2, cross, perp, vec2};

/// One row of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// J for A and for B: along x, along y, about the centre of mass.
    pub jacobian: [[Real; 3]; 2],
    /// C (m or rad).
    pub position: Real,
    /// J̇v: the rate of Ċ while both bodies keep their twists (m/s² or rad/s²).
    pub turning: Real,
    /// What it does.
    pub action: Action,
    /// Largest force (N) or torque (N·m), either way.
    pub bound: Real,
}

impl Row {
    /// Does nothing.
    pub const OFF: Self = Self {
        jacobian: [[0.0; 3]; 2],
        position: 0.0,
        turning: 0.0,
        action: Action::Off,
        bound: Real::INFINITY,
    };

    /// Jv.
    #[must_use]
    pub fn velocity(&self, [a, b]: [&Twist; 2]) -> Real {
        let [ja, jb] = &self.jacobian;
        (ja[0] * a.linear.x + ja[1] * a.linear.y + ja[2] * a.angular)
            + (jb[0] * b.linear.x + jb[1] * b.linear.y + jb[2] * b.angular)
    }

    /// J M⁻¹ Jᵀ of one side, for inverse masses along x, y and about the centre.
    #[must_use]
    pub fn response(&self, side: usize, [x, y, turn]: [Real; 3]) -> Real {
        let [jx, jy, jt] = self.jacobian[side];
        jx * jx * x + jy * jy * y + jt * jt * turn
    }

    /// The same row seen the other way round.
    fn reversed(self) -> Self {
        Self {
            jacobian: self.jacobian.map(|side| side.map(|x| -x)),
            position: -self.position,
            turning: -self.turning,
            ..self
        }
    }

    pub(super) fn acting(self, action: Action) -> Self {
        Self { action, ..self }
    }

    fn within(self, bound: Option<Real>) -> Self {
        Self { bound: bound.unwrap_or(Real::INFINITY), ..self }
    }
}

/// The rows of a joint, in an order that its kind fixes: a row that does nothing stays in its place.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    /// The rows.
    pub rows: [Row; ROWS],
    /// How many there are.
    pub count: usize,
    /// The bounds of the first two are one bound on both together, whatever the direction.
    pub disc: bool,
}

impl Rows {
    /// No row.
    pub const NONE: Self = Self { rows: [Row::OFF; ROWS], count: 0, disc: false };

    pub(super) fn push(&mut self, row: Row) {
        self.rows[self.count] = row;
        self.count += 1;
    }

    /// The rows as a slice.
    #[must_use]
    pub fn as_slice(&self) -> &[Row] {
        &self.rows[..self.count]
    }
}

/// Anchors as they stand.
struct Anchors {
    /// From the centres of mass to the anchors.
    arms: [Vec2; 2],
    /// From A's to B's.
    apart: Vec2,
    /// Its rate.
    rate: Vec2,
    /// Its second rate while the twists stay: ω_a² r_a − ω_b² r_b.
    swing: Vec2,
    spins: [Real; 2],
}

impl Anchors {
    fn of(law: &Law, pair: &Pair) -> Self {
        Self::at([0, 1].map(|side| pair.rots[side].apply(law.arms[side])), pair)
    }

    fn at(arms: [Vec2; 2], pair: &Pair) -> Self {
        let [a, b] = &pair.twists;
        let spins = [a.angular, b.angular];
        Self {
            arms,
            apart: (pair.centers[1] - pair.centers[0]) + arms[1] - arms[0],
            rate: b.at(arms[1]) - a.at(arms[0]),
            swing: arms[0] * (spins[0] * spins[0]) - arms[1] * (spins[1] * spins[1]),
            spins,
        }
    }

    /// C = d·apart with a direction that turns by these shares of the bodies' turns:
    /// Ċ = d·rate + ρ d⊥·apart with ρ = share_a ω_a + share_b ω_b, so that each arm ends on the common line;
    /// C̈ = d·swing + 2ρ d⊥·rate − ρ² d·apart.
    fn along(&self, d: Vec2, share: [Real; 2]) -> Row {
        let turned = cross(d, self.apart);
        let rho = share[0] * self.spins[0] + share[1] * self.spins[1];
        let position = d.dot(&self.apart);
        let [arm_a, arm_b] = self.arms;
        Row {
            jacobian: [
                [-d.x, -d.y, share[0] * turned - cross(arm_a, d)],
                [d.x, d.y, share[1] * turned + cross(arm_b, d)],
            ],
            position,
            turning: d.dot(&self.swing) + 2.0 * rho * perp(d).dot(&self.rate)
                - rho * rho * position,
            ..Row::OFF
        }
    }

    /// C = |apart| − length: J along the line, J̇v = d·swing + (d⊥·rate)²/|apart|.
    fn distance(&self, length: Real) -> Row {
        let now = self.apart.norm();
        let d = if now > 0.0 { self.apart / now } else { vec2(0.0, 1.0) };
        let across = perp(d).dot(&self.rate);
        Row {
            position: now - length,
            turning: d.dot(&self.swing) + if now > 0.0 { across * across / now } else { 0.0 },
            ..self.along(d, [0.0, 0.0])
        }
    }

    /// Both directions of a point that is held.
    fn point(&self) -> [Row; 2] {
        const MEAN: [Real; 2] = [0.5, 0.5];
        [self.along(vec2(1.0, 0.0), MEAN), self.along(vec2(0.0, 1.0), MEAN)]
    }

    /// Both directions of a point that may be far from where it is drawn to: the forces act at B's anchor, so that B gets no
    /// torque from the distance.
    fn carried(&self) -> [Row; 2] {
        [self.axial(vec2(1.0, 0.0)), self.axial(vec2(0.0, 1.0))]
    }

    /// Along a direction that is fixed to A.
    fn axial(&self, d: Vec2) -> Row {
        self.along(d, [1.0, 0.0])
    }
}

/// C = share_a·θ_a + θ_b − value.
fn turn(pair: &Pair, share_a: Real, value: Real) -> Row {
    Row {
        jacobian: [[0.0, 0.0, share_a], [0.0, 0.0, 1.0]],
        position: share_a * pair.angles[0] + pair.angles[1] - value,
        ..Row::OFF
    }
}

/// What a hold makes of row k.
fn held(hold: &Hold, row: Row, law: &Law, k: usize) -> Row {
    let action = match hold {
        Hold::Rigid => Action::Hold,
        Hold::Spring(_) => Action::Spring(law.springs[k].unwrap_or_default()),
        Hold::Free => Action::Off,
    };
    row.acting(action)
}

/// The nearer of two limits of a row's coordinate, whose C is its value.
fn limit(row: Row, low: Real, high: Real) -> Row {
    if low == high {
        return Row { position: row.position - low, ..row }.acting(Action::Hold);
    }
    let lower = Row { position: row.position - low, ..row };
    let upper = Row { position: row.position - high, ..row }.reversed();
    let nearer = if lower.position <= upper.position { lower } else { upper };
    nearer.acting(Action::Limit)
}

fn driven(row: Row, motor: Motor) -> Row {
    row.acting(Action::Drive(motor.speed)).within(motor.max)
}

impl Law {
    /// The rows where the bodies are.
    #[must_use]
    pub fn rows(&self, pair: &Pair) -> Rows {
        let mut rows = Rows::NONE;
        self.write_rows(pair, &mut rows);
        rows
    }

    /// The same, into rows that stood there before: they are large.
    #[expect(clippy::too_many_lines, reason = "one arm a kind reads better whole")]
    pub fn write_rows(&self, pair: &Pair, out: &mut Rows) {
        (out.count, out.disc) = (0, false);
        let at = Anchors::of(self, pair);
        let axis = |local: Vec2| pair.rots[0].apply(local);
        let angle_row = |value: Option<Real>| turn(pair, -1.0, value.unwrap_or(0.0));
        match &self.kind {
            JointKind::Distance { length, hold, min, max } => {
                out.push(held(hold, at.distance(length.unwrap_or(0.0)), self, 0));
                span(&at, *min, *max).into_iter().for_each(|row| out.push(row));
            }
            JointKind::Revolute { angle, travel } => {
                at.point().into_iter().for_each(|row| out.push(row.acting(Action::Hold)));
                self.travel(travel, angle_row(*angle), out);
            }
            JointKind::Prismatic { axis: given, angle, travel } => {
                let d = axis(given.vector());
                out.push(at.axial(perp(d)).acting(Action::Hold));
                out.push(angle_row(*angle).acting(Action::Hold));
                self.travel(travel, at.axial(d), out);
            }
            JointKind::Weld { angle, linear, angular } => {
                let [x, y] = at.point();
                out.push(held(linear, x, self, 0));
                out.push(held(linear, y, self, 1));
                out.push(held(angular, angle_row(*angle), self, 2));
            }
            JointKind::Wheel { axis: given, suspension, limits, motor } => {
                let d = axis(given.vector());
                out.push(at.axial(perp(d)).acting(Action::Hold));
                out.push(held(suspension, at.axial(d), self, 1));
                if let Some([low, high]) = *limits {
                    out.push(limit(at.axial(d), low, high));
                }
                if let Some(motor) = *motor {
                    out.push(driven(angle_row(None), motor));
                }
            }
            JointKind::Grab { hold, max_force } => self.carry(&at, (hold, *max_force), out),
            JointKind::Motor { offset, angle, linear, angular, max_force, max_torque } => {
                let target = at.arms[0] + pair.rots[0].apply(*offset);
                let at = Anchors::at([target, at.arms[1]], pair);
                self.carry(&at, (linear, *max_force), out);
                out.push(held(angular, angle_row(*angle), self, 2).within(*max_torque));
            }
            JointKind::Gear { ratio, phase } => {
                out.push(turn(pair, *ratio, phase.unwrap_or(0.0)).acting(Action::Hold));
            }
            JointKind::Pulley { over, ratio, length, slack } => {
                let action = if *slack { Action::Limit } else { Action::Hold };
                let over = over.map(|point| point - pair.origin);
                out.push(pulley(&at, pair, over, (*ratio, length.unwrap_or(0.0))).acting(action));
            }
            JointKind::Rack { axis: given, radius, offset } => {
                let way = at.axial(axis(given.vector()));
                let roll = angle_row(None);
                let mut row = Row { position: way.position - radius * roll.position, ..way };
                for side in 0..2 {
                    row.jacobian[side][2] -= radius * roll.jacobian[side][2];
                }
                row.position -= offset.unwrap_or(0.0);
                out.push(row.acting(Action::Hold));
            }
            JointKind::Ratchet { step, .. } => {
                let row = angle_row(Some(self.notch));
                let row = if *step > 0.0 { row } else { row.reversed() };
                out.push(row.acting(Action::Limit));
            }
            JointKind::Friction { max_force, max_torque } => {
                let rub = |row: Row, bound| row.acting(Action::Drive(0.0)).within(Some(bound));
                // As A's ground moves where B's anchor is, however far that has come from A's.
                at.carried().into_iter().for_each(|row| out.push(rub(row, *max_force)));
                out.push(rub(angle_row(None), *max_torque));
                out.disc = true;
            }
            JointKind::AngleSpring { angle, .. } => {
                let spring = Action::Spring(self.springs[0].unwrap_or_default());
                out.push(angle_row(*angle).acting(spring));
            }
            JointKind::Filter => {}
            JointKind::Custom => self.own_rows(pair, out),
        }
    }

    /// Limit, motor and spring along the coordinate that is free, whose value is C of `row`.
    fn travel(&self, travel: &Travel, row: Row, out: &mut Rows) {
        if let Some([low, high]) = travel.limits {
            out.push(limit(row, low, high));
        }
        if let Some(motor) = travel.motor {
            out.push(driven(row, motor));
        }
        if travel.spring.is_some() {
            let spring = Action::Spring(self.springs[out.count].unwrap_or_default());
            out.push(Row { position: row.position - travel.rest, ..row }.acting(spring));
        }
    }

    /// A point that is carried with a bounded force.
    fn carry(&self, at: &Anchors, (hold, bound): (&Hold, Option<Real>), out: &mut Rows) {
        for (k, row) in at.carried().into_iter().enumerate() {
            out.push(held(hold, row, self, k).within(bound));
        }
        out.disc = bound.is_some();
    }
}

/// The limits of a distance.
fn span(at: &Anchors, min: Real, max: Option<Real>) -> Option<Row> {
    match (min, max) {
        (0.0, None) => None,
        (0.0, Some(max)) => Some(at.distance(max).reversed().acting(Action::Limit)),
        (min, max) => Some(limit(at.distance(0.0), min, max.unwrap_or(Real::INFINITY))),
    }
}

/// C = length − l_a − ratio·l_b.
fn pulley(at: &Anchors, pair: &Pair, over: [Vec2; 2], (ratio, length): (Real, Real)) -> Row {
    let mut row = Row { position: length, ..Row::OFF };
    for (side, times) in [(0, 1.0), (1, ratio)] {
        let arm = at.arms[side];
        let rope = pair.centers[side] + arm - over[side];
        let now = rope.norm();
        let d = if now > 0.0 { rope / now } else { vec2(0.0, -1.0) };
        let twist = &pair.twists[side];
        let across = perp(d).dot(&twist.at(arm));
        let bend = if now > 0.0 { across * across / now } else { 0.0 };
        row.jacobian[side] = [-times * d.x, -times * d.y, -times * cross(arm, d)];
        row.position -= times * now;
        row.turning -= times * (bend - d.dot(&arm) * twist.angular * twist.angular);
    }
    row
}
