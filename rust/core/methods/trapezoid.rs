//! The trapezoid of a beginner's textbook: v₁ = v₀ + a·h, x += ½(v₀ + v₁)h. Exact for a constant
//! force, first order for any other, because the velocity is still Euler's.

use crate::error::Result;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System, drift, each_step, kick};

pub struct Trapezoid;

static FACTS: Facts = Facts {
    name: "trapezoid",
    order: 1,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "v₁ = v₀ + a·h, then x += ½(v₀ + v₁)·h; for teaching",
};

impl Method for Trapezoid {
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
        each_step(system, motion, span, scratch, |motion, a, h| {
            drift(motion.poses, motion.twists, h / 2.0);
            kick(motion.twists, a, h);
            drift(motion.poses, motion.twists, h / 2.0);
        })
    }
}
