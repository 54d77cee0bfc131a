//! Yoshida's compositions of leapfrog steps, some of them back in time: orders 4 and 6, symplectic
//! and reversible like leapfrog itself.
//!
//! Where joints hold bodies, steps of RATTLE (S. Reich, "Symplectic integration of constrained Hamiltonian systems by composition
//! methods", SIAM Journal on Numerical Analysis 33 (1996)).
//!
//! H. Yoshida, "Construction of higher order symplectic integrators", Physics Letters A 150 (1990):
//! the triple jump (eq. 2.11), and solution A of order 6 (table 1).

use crate::error::Result;
use crate::math::Real;
use crate::methods::{Facts, Method, Motion, Scratch, Span, System, leapfrog, rattle};

/// A symmetric composition: weights from the outside in, the last one standing once in the middle.
pub struct Yoshida {
    facts: &'static Facts,
    weights: &'static [Real],
}

/// 1/(2 − ∛2), and 1 − 2 of it in the middle.
const TRIPLE_JUMP: [Real; 2] = [1.351_207_191_959_657_6, -1.702_414_383_919_315_3];

const SOLUTION_A: [Real; 4] = [
    0.784_513_610_477_560,
    0.235_573_213_359_357,
    -1.177_679_984_178_87,
    1.0 - 2.0 * (0.784_513_610_477_560 + 0.235_573_213_359_357 - 1.177_679_984_178_87),
];

static FACTS4: Facts = Facts {
    name: "yoshida4",
    order: 4,
    symplectic: true,
    reversible: true,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "three leapfrog steps, the middle one back in time",
};

static FACTS6: Facts = Facts {
    name: "yoshida6",
    order: 6,
    symplectic: true,
    reversible: true,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "seven leapfrog steps, two of them back in time",
};

pub static YOSHIDA4: Yoshida = Yoshida { facts: &FACTS4, weights: &TRIPLE_JUMP };
pub static YOSHIDA6: Yoshida = Yoshida { facts: &FACTS6, weights: &SOLUTION_A };

impl Method for Yoshida {
    fn facts(&self) -> &'static Facts {
        self.facts
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let inward = self.weights.iter();
        let outward = self.weights.iter().rev().skip(1);
        let tied = system.joints.is_some();
        if tied {
            rattle::prepare(system, motion, span, scratch)?;
        } else {
            leapfrog::prepare(&mut system.forces, motion, span.start, scratch)?;
        }
        for k in 0..span.substeps {
            let mut time = span.time(k);
            for weight in inward.clone().chain(outward.clone()) {
                let h = weight * span.h();
                if tied {
                    rattle::step(system, motion, (time, h), scratch)?;
                } else {
                    leapfrog::step(&mut system.forces, motion, (time, h), scratch)?;
                }
                time += h;
            }
        }
        Ok(())
    }
}
