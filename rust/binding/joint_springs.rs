//! The springs of joints, by hertz and damping_ratio or by stiffness and damping.

use culbuto::joint::{Coefficients, Hold, JointDef, JointKind, Spring};
use culbuto::math::Real;
use culbuto::world::JointRef;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::joint_parameters::{Value, number_or_none};
use crate::record::record;

record! {
    /// How what hangs on a spring moves, whatever else holds its bodies left aside.
    SpringMotion {
        /// Which row of the joint, counted from 0.
        row: usize,
        /// Frequency of the undamped swing by the law (Hz), with the mass that hangs on it where it is now.
        hertz: Real,
        /// Damping ratio by the law.
        damping_ratio: Real,
        /// Frequency as the steps make it (Hz).
        stepped_hertz: Real,
        /// Damping ratio as the steps make it.
        stepped_damping_ratio: Real,
    }
}

impl From<&culbuto::world::SpringMotion> for SpringMotion {
    fn from(motion: &culbuto::world::SpringMotion) -> Self {
        let culbuto::world::SpringMotion { row, exact, stepped } = *motion;
        Self {
            row,
            hertz: exact.hertz,
            damping_ratio: exact.damping_ratio,
            stepped_hertz: stepped.hertz,
            stepped_damping_ratio: stepped.damping_ratio,
        }
    }
}

/// What of a joint a spring holds.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Only,
    Linear,
    Angular,
}

#[derive(Clone, Copy)]
enum Word {
    Hertz,
    DampingRatio,
    Stiffness,
    Damping,
}

/// One number of a spring: "hertz", "linear_stiffness", …
#[derive(Clone, Copy)]
pub struct Aspect {
    part: Part,
    word: Word,
}

impl Aspect {
    /// By its name in Python, if it is one.
    pub fn of(name: &str) -> Option<Self> {
        let (part, rest) = match name.split_once('_') {
            Some(("linear", rest)) => (Part::Linear, rest),
            Some(("angular", rest)) => (Part::Angular, rest),
            _ => (Part::Only, name),
        };
        let word = match rest {
            "hertz" => Word::Hertz,
            "damping_ratio" => Word::DampingRatio,
            "stiffness" => Word::Stiffness,
            "damping" => Word::Damping,
            _ => return None,
        };
        Some(Self { part, word })
    }

    /// Of a definition, none where its row knows it.
    pub fn get(self, kind: &JointKind) -> Option<Value> {
        let number = match (self.word, self.part.hold(kind)?) {
            (Word::Hertz, Hold::Rigid) => 0.0,
            (Word::Hertz, Hold::Spring(Spring::Frequency { hertz, .. })) => hertz,
            (Word::DampingRatio, Hold::Spring(Spring::Frequency { damping_ratio, .. })) => {
                damping_ratio
            }
            (Word::Stiffness, Hold::Spring(Spring::Constants(own))) => own.stiffness,
            (Word::Damping, Hold::Spring(Spring::Constants(own))) => own.damping,
            (Word::Stiffness | Word::Damping, Hold::Spring(_)) => return None,
            _ => return Some(Value::None),
        };
        Some(Value::Number(number))
    }

    /// As its row has it.
    pub fn seen(self, joint: &JointRef<'_>) -> Value {
        let Some(own) = self.part.coefficients(joint) else { return Value::None };
        match self.word {
            Word::Stiffness => Value::Number(own.stiffness),
            Word::Damping => Value::Number(own.damping),
            Word::Hertz | Word::DampingRatio => Value::None,
        }
    }

    /// Sets it. `made` is the joint, if it is made.
    pub fn put(
        self,
        kind: &mut JointKind,
        number: Option<Real>,
        made: Option<&JointRef<'_>>,
    ) -> PyResult<()> {
        let now = self.part.hold(kind).ok_or_else(none_of_it)?;
        let resolved = || match now {
            Hold::Spring(Spring::Constants(own)) => own,
            _ => made.and_then(|joint| self.part.coefficients(joint)).unwrap_or_default(),
        };
        let new = match (self.word, number, now) {
            (Word::Hertz, None, _) => Hold::Free,
            (Word::Hertz, Some(hertz), Hold::Spring(Spring::Frequency { damping_ratio, .. })) => {
                Hold::soft(hertz, damping_ratio)
            }
            (Word::Hertz, Some(hertz), _) => Hold::soft(hertz, 0.0),
            (
                Word::DampingRatio,
                Some(damping_ratio),
                Hold::Spring(Spring::Frequency { hertz, .. }),
            ) => Hold::Spring(Spring::Frequency { hertz, damping_ratio }),
            (Word::Stiffness, Some(stiffness), _) => constants(stiffness, resolved().damping),
            (Word::Damping, Some(damping), Hold::Spring(_)) => {
                constants(resolved().stiffness, damping)
            }
            _ => return Err(mixed()),
        };
        self.part.set_hold(kind, new)
    }
}

impl Part {
    /// How a kind holds it; none: not by such a spring.
    fn hold(self, kind: &JointKind) -> Option<Hold> {
        use JointKind as K;
        Some(match (self, kind) {
            (Self::Only, K::Distance { hold, .. } | K::Grab { hold, .. })
            | (Self::Only, K::Wheel { suspension: hold, .. })
            | (Self::Linear, K::Weld { linear: hold, .. } | K::Motor { linear: hold, .. })
            | (Self::Angular, K::Weld { angular: hold, .. } | K::Motor { angular: hold, .. }) => {
                *hold
            }
            (Self::Only, K::Revolute { travel, .. } | K::Prismatic { travel, .. }) => {
                travel.spring.map_or(Hold::Free, Hold::Spring)
            }
            (Self::Only, K::AngleSpring { spring, .. }) => Hold::Spring(*spring),
            _ => return None,
        })
    }

    /// Sets how a kind holds it. What is free but for a spring cannot be rigid.
    fn set_hold(self, kind: &mut JointKind, new: Hold) -> PyResult<()> {
        use JointKind as K;
        match (self, kind) {
            (Self::Only, K::Distance { hold, .. } | K::Grab { hold, .. })
            | (Self::Only, K::Wheel { suspension: hold, .. })
            | (Self::Linear, K::Weld { linear: hold, .. } | K::Motor { linear: hold, .. })
            | (Self::Angular, K::Weld { angular: hold, .. } | K::Motor { angular: hold, .. }) => {
                *hold = new;
            }
            (Self::Only, K::Revolute { travel, .. } | K::Prismatic { travel, .. }) => {
                if new == Hold::Rigid {
                    let message = "hertz is 0; allowed: above 0, or None for no spring; \
                                   limits=(x, x) holds it at x";
                    return Err(PyValueError::new_err(message));
                }
                travel.spring = new.spring();
            }
            (Self::Only, K::AngleSpring { spring, .. }) => {
                let message = "an angle spring needs hertz above 0, or stiffness";
                *spring = new.spring().ok_or_else(|| PyValueError::new_err(message))?;
            }
            _ => return Err(none_of_it()),
        }
        Ok(())
    }

    /// The coefficients of its rows, which are the same for both directions of a point.
    fn coefficients(self, joint: &JointRef<'_>) -> Option<Coefficients> {
        let skipped = if self == Self::Angular { 2 } else { 0 };
        joint.springs().iter().skip(skipped).copied().flatten().next()
    }
}

/// Springs as they are given when a joint is made, each in up to four words.
#[derive(Default)]
pub struct Springs([Told; 3]);

#[derive(Clone, Copy, Default)]
struct Told {
    /// None is a word as well.
    hertz: Option<Option<Real>>,
    damping_ratio: Option<Real>,
    stiffness: Option<Real>,
    damping: Option<Real>,
}

impl Springs {
    /// Takes a keyword, if it is about a spring.
    pub fn take(&mut self, name: &str, value: &Value) -> PyResult<bool> {
        let Some(Aspect { part, word }) = Aspect::of(name) else { return Ok(false) };
        let number = number_or_none(name, value)?;
        let told = &mut self.0[part as usize];
        match word {
            Word::Hertz => told.hertz = Some(number),
            Word::DampingRatio => told.damping_ratio = number,
            Word::Stiffness => told.stiffness = number,
            Word::Damping => told.damping = number,
        }
        Ok(true)
    }

    /// Gives the springs to a definition.
    pub fn put(self, def: &mut JointDef) -> PyResult<()> {
        for (part, told) in [Part::Only, Part::Linear, Part::Angular].into_iter().zip(self.0) {
            if let Some(hold) = told.hold()? {
                part.set_hold(&mut def.kind, hold)?;
            }
        }
        Ok(())
    }
}

impl Told {
    fn hold(self) -> PyResult<Option<Hold>> {
        let (ratio, damping) = (self.damping_ratio.unwrap_or(0.0), self.damping.unwrap_or(0.0));
        match (self.hertz, self.stiffness) {
            (None | Some(None | Some(0.0)), Some(stiffness)) if ratio == 0.0 => {
                Ok(Some(constants(stiffness, damping)))
            }
            (Some(hertz), None) if damping == 0.0 => {
                Ok(Some(hertz.map_or(Hold::Free, |hertz| Hold::soft(hertz, ratio))))
            }
            (None, None) if ratio == 0.0 && damping == 0.0 => Ok(None),
            _ => Err(mixed()),
        }
    }
}

fn constants(stiffness: Real, damping: Real) -> Hold {
    Hold::Spring(Spring::Constants(Coefficients { stiffness, damping }))
}

fn mixed() -> PyErr {
    let message = "a spring is given by hertz and damping_ratio, or by stiffness and damping";
    PyValueError::new_err(message)
}

fn none_of_it() -> PyErr {
    PyTypeError::new_err("this joint has no such spring")
}
