//! Dense output of DOP853, and the kinks of a force that it finds.

use crate::error::Result;
use crate::forces::Facets;
use crate::math::Real;
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
        let value = |i: usize| {
            let nested = self.coefficients.iter().enumerate().rev();
            nested.fold(0.0, |sum, (j, f)| (sum + f[i]) * if j % 2 == 0 { x } else { 1.0 - x })
        };
        (0..self.start.len()).map(|i| self.start[i] + value(i)).collect()
    }
}

/// Where in a step, as a fraction of it, a body first shows the air another facet than it is let see,
/// and the facets from there on. None where they stay the same.
pub fn first_kink(
    y: &mut Columns,
    system: &mut System<'_>,
    (time, h): (Real, Real),
) -> Result<Option<(Real, Facets)>> {
    const LOOKS: u32 = 16;
    const HALVINGS: u32 = 40;
    let dense = Dense::new(y, system, time, h)?;
    let shows = |x: Real| {
        let state = dense.at(x);
        let (poses, twists) = first_order::split(&state);
        system.forces.shows_facets(poses, twists)
    };
    let look = |k: u32| Real::from(k) / Real::from(LOOKS);
    let Some(k) = (1..=LOOKS).find(|&k| !shows(look(k))) else { return Ok(None) };
    let (mut before, mut after) = (look(k - 1), look(k));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        *(if shows(middle) { &mut before } else { &mut after }) = middle;
    }
    let state = dense.at(after);
    let (poses, twists) = first_order::split(&state);
    Ok(Some((after, system.forces.facets_of(poses, twists))))
}
