//! Semi-implicit (symplectic) Euler: v += a·h from the old place, then x += v·h with the new velocity.
//! What most game engines do: bounded energy, but a thrown ball is off by ½g·h·t.

use crate::error::Result;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System, drift, each_step, kick};

pub struct SemiImplicitEuler;

static FACTS: Facts = Facts {
    name: "semi_implicit_euler",
    order: 1,
    symplectic: true,
    reversible: false,
    exact_for_constant_force: false,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "v += a·h, then x += v·h with the new v: what most game engines do",
};

impl Method for SemiImplicitEuler {
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
            kick(motion.twists, a, h);
            drift(motion.poses, motion.twists, h);
        })
    }
}
