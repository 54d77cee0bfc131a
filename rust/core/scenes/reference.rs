//! Where answers come from, and how far they may be off themselves.

use super::{Answer, Motion, Scene};
use crate::error::Result;
use crate::math::{Pose, Real};
use crate::world::{Trajectory, World};

/// What a scene is compared with.
#[derive(Clone, Copy, Debug)]
pub enum Reference {
    /// A formula, or a series or iteration that is carried on to the last digit.
    ClosedForm,
    /// Figures that were printed, or a theory that leaves something out: off by this, relative.
    Figures(Real),
    /// A differential equation that is integrated; the function gives by how much that is off, over the scene's length.
    Integrated(fn() -> Real),
    /// A law, a bound, a refusal, or two runs that must be alike: what must be nothing is nothing exactly.
    Law,
}

impl Reference {
    /// In words.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form, to rounding",
            Self::Figures(_) => "figures of a series, a table or a theory",
            Self::Integrated(_) => "an equation integrated, by its own estimate",
            Self::Law => "a law or a bound, which is exact",
        }
    }
}

impl Scene {
    /// How far the answer may be off itself, relative as errors of the scene are.
    ///
    /// # Errors
    /// Those of making the world.
    pub fn uncertainty(&self) -> Result<Real> {
        match (self.reference, self.answer) {
            (Reference::Law, _) => Ok(0.0),
            (Reference::Figures(part), _) => Ok(part),
            (Reference::Integrated(estimate), _) => Ok(estimate()),
            (Reference::ClosedForm, Answer::Motion(motion)) => motion.rounding(),
            // Some operations, each off by half a unit in the last place.
            (Reference::ClosedForm, Answer::Numbers(_)) => Ok(4.0 * Real::EPSILON),
        }
    }
}

/// Times at which the answer is looked at.
const LOOKS: u32 = 64;

impl Motion {
    /// What rounding makes of the answer: how far it moves when the time is off in its last place, and the last place of
    /// its own numbers.
    fn rounding(&self) -> Result<Real> {
        let world = (self.build)()?;
        let times: Vec<Real> =
            (0..=LOOKS).map(|k| self.duration * Real::from(k) / Real::from(LOOKS)).collect();
        let by_time = |t: Real| (self.exact)(t * (1.0 + Real::EPSILON));
        let by_digits = |t: Real| (self.exact)(t).iter().map(last_place).collect();
        Ok(self.moved(&world, &times, by_time) + self.moved(&world, &times, by_digits))
    }

    /// Error of other poses at these times.
    fn moved(&self, world: &World, times: &[Real], poses: impl Fn(Real) -> Vec<Pose>) -> Real {
        let poses = times.iter().flat_map(|t| poses(*t)).collect();
        let bodies = world.bodies().len();
        self.error(world, &Trajectory { times: times.to_vec(), bodies, poses, twists: Vec::new() })
    }
}

/// A pose whose numbers are off by a unit in their last place.
fn last_place(pose: &Pose) -> Pose {
    let off = 1.0 + Real::EPSILON;
    Pose::new(pose.position * off, pose.angle * off)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{CATALOGUE, scene};

    #[test]
    fn what_is_asked_of_a_motion_is_above_what_its_answer_is_off() {
        for scene in CATALOGUE {
            let off = scene.uncertainty().unwrap();
            assert!((0.0..=0.05).contains(&off), "{}: {off}", scene.name);
            let Answer::Motion(motion) = scene.answer else { continue };
            let asked = motion.toleranced.map_or(motion.fixed, |t| t.error.min(motion.fixed));
            assert!(off > 0.0 && off <= asked, "{}: {off} of {asked}", scene.name);
        }
    }

    /// x = 12t m: half a unit of its last place and of that of t each, over 24 m.
    #[test]
    fn rounding_is_that_of_the_numbers() {
        let off = scene("projectile").unwrap().uncertainty().unwrap();
        assert!(off > Real::EPSILON && off < 5.0 * Real::EPSILON, "{off}");
    }
}
