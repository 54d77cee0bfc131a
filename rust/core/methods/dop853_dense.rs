//! Dense output of DOP853, and the kinks of a force that it finds.

use crate::error::Result;
use crate::forces::{Facets, Forces};
use crate::math::{Pose, Real, Twist, vec2};
use crate::methods::System;
use crate::methods::dop853::{DENSE_STAGES, STAGES};
use crate::methods::dop853_table::{A, C, D};
use crate::methods::first_order::{self, Columns};

/// The interpolant of order 7 over one step.
pub struct Dense {
    start: Vec<Real>,
    coefficients: [Vec<Real>; 7],
}

impl Dense {
    /// Needs slopes 0 to 12, the state and, in `y.stage`, the end of the step, which stays there.
    pub fn new(y: &mut Columns, system: &mut System<'_>, time: Real, h: Real) -> Result<Self> {
        let end = y.stage.clone();
        for j in STAGES..DENSE_STAGES {
            y.combine(h, A[j]);
            y.slope_of_stage(j, system, time + C[j] * h)?;
        }
        y.stage.copy_from_slice(&end);
        let (start, first, last) = (&y.state, &y.slopes[0], &y.slopes[12]);
        let column = |f: &dyn Fn(usize) -> Real| (0..start.len()).map(f).collect::<Vec<_>>();
        let high = |row: &[Real; DENSE_STAGES], i: usize| -> Real {
            h * row.iter().zip(&y.slopes).map(|(d, slope)| d * slope[i]).sum::<Real>()
        };
        let coefficients = [
            column(&|i| end[i] - start[i]),
            column(&|i| h * first[i] - (end[i] - start[i])),
            column(&|i| 2.0 * (end[i] - start[i]) - h * (last[i] + first[i])),
            column(&|i| high(&D[0], i)),
            column(&|i| high(&D[1], i)),
            column(&|i| high(&D[2], i)),
            column(&|i| high(&D[3], i)),
        ];
        Ok(Self { start: start.clone(), coefficients })
    }

    /// The state at a fraction of the step: y₀ + x(F₁ + (1 − x)(F₂ + x(F₃ + (1 − x)(…)))).
    pub fn at(&self, x: Real) -> Vec<Real> {
        (0..self.start.len()).map(|i| self.component(i, x)).collect()
    }

    /// One body at a fraction of the step.
    pub fn body(&self, i: usize, x: Real) -> (Pose, Twist) {
        let (q, v) = (3 * i, 3 * (first_order::bodies(&self.start) + i));
        let [px, py, angle, vx, vy, spin] =
            [q, q + 1, q + 2, v, v + 1, v + 2].map(|k| self.component(k, x));
        (Pose::new(vec2(px, py), angle), Twist::new(vec2(vx, vy), spin))
    }

    fn component(&self, i: usize, x: Real) -> Real {
        let nested = self.coefficients.iter().enumerate().rev();
        let way =
            nested.fold(0.0, |sum, (j, f)| (sum + f[i]) * if j % 2 == 0 { x } else { 1.0 - x });
        self.start[i] + way
    }
}

/// The state at a fraction of a step.
type At<'a> = &'a dyn Fn(Real) -> Vec<Real>;

/// Where in a step, as a fraction of it, a body first shows the air another facet than it is let see,
/// and the facets from there on. None where they stay the same.
pub fn first_kink(at: At<'_>, forces: &Forces<'_>) -> Option<(Real, Facets)> {
    let shows = |x: Real| {
        let state = at(x);
        let (poses, twists) = first_order::split(&state);
        forces.shows_facets(poses, twists)
    };
    let mut looks: Vec<Real> = (1..=LOOKS).map(look).collect();
    for body in 0..forces.shown.facets.len() {
        extremes(|x| turns_left(at, forces, body, x), &mut looks);
    }
    looks.sort_unstable_by(Real::total_cmp);
    let k = looks.iter().position(|x| !shows(*x))?;
    let before = if k > 0 { looks[k - 1] } else { 0.0 };
    let after = last_change(before, looks[k], shows);
    let state = at(after);
    let (poses, twists) = first_order::split(&state);
    Some((after, forces.facets_of(poses, twists)))
}

/// How often a step is looked at.
const LOOKS: u32 = 16;

fn look(k: u32) -> Real {
    Real::from(k) / Real::from(LOOKS)
}

/// Adds where, between two looks, what is true at one and not at the other changes. Kinks stand at given directions of
/// the air: one that is passed and passed back between two looks lies around such a place.
fn extremes(left: impl Fn(Real) -> bool, looks: &mut Vec<Real>) {
    let mut before = left(0.0);
    for k in 1..=LOOKS {
        let now = left(look(k));
        if now != before {
            looks.push(last_change(look(k - 1), look(k), |x| left(x) == before));
        }
        before = now;
    }
}

/// Where what is true at `before` and not at `after` ceases to be, from above.
fn last_change(mut before: Real, mut after: Real, is: impl Fn(Real) -> bool) -> Real {
    const HALVINGS: u32 = 40;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        *(if is(middle) { &mut before } else { &mut after }) = middle;
    }
    after
}

/// Whether the air's direction, seen from a body, turns to the left at a fraction of a step.
fn turns_left(at: At<'_>, forces: &Forces<'_>, body: usize, x: Real) -> bool {
    /// A difference of angles over this part of a step is far above rounding.
    const APART: Real = 1e-4;
    let ends = [x - 0.5 * APART, x + 0.5 * APART].map(|x| {
        let state = at(x);
        let (poses, twists) = first_order::split(&state);
        forces.heading(&poses[body], &twists[body])
    });
    ends[0].perp(&ends[1]) > 0.0
}
