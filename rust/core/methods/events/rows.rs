//! Rows of contacts and joints as one system sees them.

use crate::math::{Real, Twist, vec2};

/// Values up to so many times their rounding are rounding.
pub(super) const ROUNDING: Real = 4.0 * Real::EPSILON;

/// A row of the system.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub slots: [Option<u32>; 2],
    /// J.
    pub jacobian: [[Real; 3]; 2],
    /// Direction in which its force acts: J, or with the friction of what slides.
    pub push: [[Real; 3]; 2],
    /// J̇v.
    pub bias: Real,
    /// C or gap, and its rounding; 0 for what has none.
    pub position: Real,
    pub rounding: Real,
    /// The speed it asks for.
    pub speed: Real,
    pub origin: Origin,
    pub scale: Real,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// Tie and row among those it holds.
    Joint(usize, usize),
    /// Contact and point; 2: the tangent.
    Contact(usize, usize),
}

/// Rows of all contacts, three each: two points and the tangent, and what bodies do under a unit impulse along each.
pub struct Responses {
    pub(super) rows: Vec<Line>,
    pub(super) moves: Vec<Vec<Twist>>,
}

impl Responses {
    /// J M⁻¹ Jᵀ of two rows, joints holding.
    #[must_use]
    pub fn coupling(&self, i: usize, j: usize) -> Real {
        self.rows[i].along(&self.moves[j])
    }

    /// J·v of a row.
    #[must_use]
    pub fn along(&self, i: usize, twists: &[Twist]) -> Real {
        self.rows[i].along(twists)
    }

    /// J̇v of a row.
    #[must_use]
    pub fn bias(&self, i: usize) -> Real {
        self.rows[i].bias
    }

    /// Gives the bodies an impulse along a row.
    pub fn push(&self, i: usize, impulse: Real, twists: &mut [Twist]) {
        for (twist, change) in twists.iter_mut().zip(&self.moves[i]) {
            *twist += Twist::new(change.linear * impulse, change.angular * impulse);
        }
    }

    /// Speeds (m/s) of which what a row says is a difference.
    #[must_use]
    pub fn speeds(&self, i: usize, twists: &[Twist]) -> Real {
        self.rows[i].speeds(twists)
    }
}

impl Line {
    pub fn along(&self, twists: &[Twist]) -> Real {
        self.sum(twists, |jacobian, v| jacobian * v)
    }

    pub fn speeds(&self, twists: &[Twist]) -> Real {
        self.sum(twists, |jacobian, v| (jacobian * v).abs())
    }

    pub fn speed_rounding(&self, twists: &[Twist]) -> Real {
        ROUNDING * (self.speeds(twists) + self.speed.abs())
    }

    pub fn sum(&self, twists: &[Twist], of: impl Fn(Real, Real) -> Real) -> Real {
        let side = |(slot, jacobian): (&Option<u32>, &[Real; 3])| {
            slot.map_or(0.0, |slot| {
                let v = parts(&twists[slot as usize]);
                (0..3).map(|c| of(jacobian[c], v[c])).sum()
            })
        };
        self.slots.iter().zip(&self.jacobian).map(side).sum()
    }

    /// J M⁻¹ pᵀ with the direction `push` of another row.
    pub fn coupled(&self, push: &[[Real; 3]; 2], other: &Self, inverse: &[[Real; 3]]) -> Real {
        let mut sum = 0.0;
        for (slot, jacobian) in self.slots.iter().zip(&self.jacobian) {
            for (theirs, push) in other.slots.iter().zip(push) {
                if let (Some(slot), true) = (slot, slot == theirs) {
                    let inverse = &inverse[*slot as usize];
                    sum += (0..3).map(|c| jacobian[c] * inverse[c] * push[c]).sum::<Real>();
                }
            }
        }
        sum
    }
}

/// What takes forces or impulses along rows.
pub(super) trait Push {
    /// Adds M⁻¹ pᵀ x for a direction p.
    fn push_along(&mut self, line: &Line, push: &[[Real; 3]; 2], x: (Real, &[[Real; 3]]));

    /// Adds M⁻¹ Jᵀ x.
    fn push_all(&mut self, lines: &[Line], values: &[Real], inverse: &[[Real; 3]]);
}

impl Push for [Twist] {
    fn push_along(
        &mut self,
        line: &Line,
        push: &[[Real; 3]; 2],
        (x, inverse): (Real, &[[Real; 3]]),
    ) {
        for (slot, push) in line.slots.iter().zip(push) {
            let Some(slot) = slot.map(|slot| slot as usize) else { continue };
            let change = |c: usize| inverse[slot][c] * push[c] * x;
            self[slot] += Twist::new(vec2(change(0), change(1)), change(2));
        }
    }

    fn push_all(&mut self, lines: &[Line], values: &[Real], inverse: &[[Real; 3]]) {
        for (line, x) in lines.iter().zip(values) {
            self.push_along(line, &line.jacobian, (*x, inverse));
        }
    }
}

pub(super) trait Terms {
    /// Adds |M⁻¹ pᵀ x|.
    fn add(&mut self, line: &Line, push: &[[Real; 3]; 2], x: (Real, &[[Real; 3]]));
}

impl Terms for Vec<[Real; 3]> {
    fn add(&mut self, line: &Line, push: &[[Real; 3]; 2], (x, inverse): (Real, &[[Real; 3]])) {
        for (slot, push) in line.slots.iter().zip(push) {
            let Some(slot) = slot.map(|slot| slot as usize) else { continue };
            for c in 0..3 {
                self[slot][c] += (inverse[slot][c] * push[c] * x).abs();
            }
        }
    }
}

pub(super) fn parts(twist: &Twist) -> [Real; 3] {
    [twist.linear.x, twist.linear.y, twist.angular]
}

pub(super) fn combined(a: &[[Real; 3]; 2], b: &[[Real; 3]; 2], by: Real) -> [[Real; 3]; 2] {
    [0, 1].map(|side| [0, 1, 2].map(|c| a[side][c] + by * b[side][c]))
}
