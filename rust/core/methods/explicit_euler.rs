//! Explicit Euler: x += v·h, v += a·h, both from the state before the step. For teaching: it gains
//! energy on every orbit, and a thrown ball flies too far.

use crate::error::Result;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System, drift, each_step, kick};

pub struct ExplicitEuler;

static FACTS: Facts = Facts {
    name: "explicit_euler",
    order: 1,
    symplectic: false,
    reversible: false,
    exact_for_constant_force: false,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "x += v·h, then v += a·h, both from the old state; for teaching",
};

impl Method for ExplicitEuler {
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
            drift(motion.poses, motion.twists, h);
            kick(motion.twists, a, h);
        })
    }
}
