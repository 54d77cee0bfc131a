//! Semi-implicit (symplectic) Euler: v += a·h from the old place, then x += v·h with the new velocity.
//! What most game engines do: bounded energy, but a thrown ball is off by ½g·h·t.

use crate::error::Result;
use crate::forces::Forces;
use crate::math::Twist;
use crate::methods::{Facts, Method, Motion, Scratch, Span, drift, kick};

pub struct SemiImplicitEuler;

static FACTS: Facts = Facts {
    name: "semi_implicit_euler",
    order: 1,
    symplectic: true,
    reversible: false,
    exact_for_constant_force: false,
    adaptive: false,
    joints: false,
    contacts: false,
    about: "v += a·h, then x += v·h with the new v: what most game engines do",
};

impl Method for SemiImplicitEuler {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        forces: &mut Forces<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let accelerations = &mut scratch.accelerations;
        accelerations.resize(motion.poses.len(), Twist::ZERO);
        for k in 0..span.substeps {
            let power =
                forces.accelerate(span.time(k), motion.poses, motion.twists, accelerations)?;
            motion.ledger.book(power, span.h());
            kick(motion.twists, accelerations, span.h());
            drift(motion.poses, motion.twists, span.h());
        }
        Ok(())
    }
}
