//! The classical Runge–Kutta method of order 4 (Kutta 1901).

use crate::error::Result;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

pub struct Rk4;

static FACTS: Facts = Facts {
    name: "rk4",
    order: 4,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "the classical Runge–Kutta method: four evaluations a step",
};

impl Method for Rk4 {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let y = &mut scratch.flat;
        y.load(motion, 4);
        y.settle_state(system, motion);
        let h = span.h();
        for k in 0..span.substeps {
            let (start, end) = (span.time(k), span.time(k + 1));
            let middle = start + h / 2.0;
            y.slope_of_state(0, system, start)?;
            y.combine(h, &[0.5]);
            y.slope_of_stage(1, system, middle)?;
            y.combine(h, &[0.0, 0.5]);
            y.slope_of_stage(2, system, middle)?;
            y.combine(h, &[0.0, 0.0, 1.0]);
            y.slope_of_stage(3, system, end)?;
            y.combine(h, &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]);
            y.settle_stage(system, motion);
            std::mem::swap(&mut y.state, &mut y.stage);
        }
        y.store(motion);
        Ok(())
    }
}
