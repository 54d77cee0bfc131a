//! Rows of the user's own, written for the bodies' frames, as the other rows are: about the centres of mass.

use super::{Action, Law, Pair, Row, Rows};
use crate::joint::CustomRow;
use crate::math::{Pose, Real, Twist, Vec2, cross, vec2};

/// How the bodies' frames move, and where they are from the centres of mass.
struct Frames {
    arms: [Vec2; 2],
    twists: [Twist; 2],
}

impl Law {
    /// The user's rows, each of which holds.
    pub(super) fn own_rows(&self, pair: &Pair, out: &mut Rows) {
        let Some(custom) = &self.custom else { return };
        let arms = [0, 1].map(|side| -pair.rots[side].apply(self.locals[side]));
        let twists = [0, 1].map(|side| {
            let twist = &pair.twists[side];
            Twist::new(twist.at(arms[side]), twist.angular)
        });
        let frames = Frames { arms, twists };
        let at = |time: Real| custom.evaluate(&self.poses(pair, time));
        let (rows, count) = at(0.0);
        let span = pair.short_time();
        let around = if span > 0.0 { [at(-span).0, at(span).0] } else { [rows, rows] };
        for (k, own) in rows.iter().enumerate().take(count) {
            // (J₊ − J₋)v/2t, and the swing of the frames about the centres.
            let [before, after] = [&around[0][k], &around[1][k]].map(|own| frames.rate(own));
            let bend = if span > 0.0 { (after - before) / (2.0 * span) } else { 0.0 };
            let row = Row {
                jacobian: [0, 1].map(|side| frames.about_center(own, side)),
                position: own.position,
                turning: bend + frames.swing(own),
                ..Row::OFF
            };
            out.push(row.acting(Action::Hold));
        }
    }

    /// Where the bodies' frames stand a time after now, by the present twists.
    fn poses(&self, pair: &Pair, time: Real) -> [Pose; 2] {
        [0, 1].map(|side| {
            let (twist, turn) = (&pair.twists[side], pair.twists[side].angular * time);
            let center = pair.origin + pair.centers[side] + twist.linear * time;
            let arm = pair.rots[side].turned(turn).apply(self.locals[side]);
            Pose::new(center - arm, pair.angles[side] + turn)
        })
    }
}

impl Frames {
    /// Jv of a row.
    fn rate(&self, own: &CustomRow) -> Real {
        let row = Row { jacobian: own.jacobian, ..Row::OFF };
        row.velocity([&self.twists[0], &self.twists[1]])
    }

    /// J of one side about the centre of mass.
    fn about_center(&self, own: &CustomRow, side: usize) -> [Real; 3] {
        let [x, y, turn] = own.jacobian[side];
        [x, y, turn + cross(self.arms[side], vec2(x, y))]
    }

    /// What the frames' turning about the centres adds to C̈: −ω² J·arm.
    fn swing(&self, own: &CustomRow) -> Real {
        let of_side = |side: usize| {
            let ([x, y, _], spin) = (own.jacobian[side], self.twists[side].angular);
            -spin * spin * vec2(x, y).dot(&self.arms[side])
        };
        of_side(0) + of_side(1)
    }
}

impl Pair {
    /// A time in which the bodies move by 1e-5 of their distance or of a radian; 0 where they rest.
    fn short_time(&self) -> Real {
        let apart = (self.centers[1] - self.centers[0]).norm();
        let rate = self.twists.iter().map(|twist| {
            let along = if apart > 0.0 { twist.linear.norm() / apart } else { 0.0 };
            along + twist.angular.abs()
        });
        let rate: Real = rate.sum();
        if rate > 0.0 { 1e-5 / rate } else { 0.0 }
    }
}
