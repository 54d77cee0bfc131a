//! How what hangs on springs moves: by the law, and as steps of a given length make it.

use super::{index_of, law_of, make, pair_of};
use crate::constraints::joint::{Action, Gains, Rates, Row, Swing};
use crate::error::{Result, check};
use crate::joint::{Joint, JointHandle};
use crate::math::Real;
use crate::world::{State, World};

/// The motion along one spring of a joint, whatever else holds its bodies left aside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringMotion {
    /// Which row of the joint, counted from 0.
    pub row: usize,
    /// By the law, with the effective mass where the bodies are now.
    pub exact: Swing,
    /// As steps make it. The same for a lone spring that a substep resolves; what swings faster than about half a turn a
    /// substep is slowed down, and among many springs all are slowed down a little.
    pub stepped: Swing,
}

impl World {
    /// Frequency and damping of a joint's springs, by the law and at steps of dt (s) with the world's substeps.
    ///
    /// # Errors
    /// A joint that is gone, a dt that is not allowed.
    pub fn spring_motions(&self, joint: JointHandle, dt: Real) -> Result<Vec<SpringMotion>> {
        let h = check::positive("dt", dt)? / Real::from(self.state.settings.substeps);
        let State { bodies, joints, .. } = &self.state;
        let joint = joints.get(joint)?;
        let rows = law_of(bodies, joint).rows(&pair_of(bodies, joint));
        let motions = rows.as_slice().iter().enumerate().filter_map(|(row, now)| {
            let Action::Spring(spring) = now.action else { return None };
            let mass = make::effective_mass(now, bodies, joint);
            if mass == 0.0 {
                return None;
            }
            let gains = Gains::new(&spring, &self.rates_around(joint), h);
            let exact = Swing::exact(&spring, mass);
            Some(SpringMotion { row, exact, stepped: Swing::stepped(&gains, mass, h) })
        });
        Ok(motions.collect())
    }

    /// Sums over the springs of a joint's bodies, as the contact step takes them.
    fn rates_around(&self, joint: &Joint) -> Rates {
        let State { bodies, joints, .. } = &self.state;
        let ends = [0, 1].map(|side| index_of(bodies, joint, side));
        let mut sum = Rates::default();
        for other in joints.values() {
            let places = [0, 1].map(|side| index_of(bodies, other, side));
            let shared = places.iter().flatten().filter(|i| ends.contains(&Some(**i))).count();
            if shared == 0 {
                continue;
            }
            let rows = law_of(bodies, other).rows(&pair_of(bodies, other));
            for row in rows.as_slice() {
                add_rates(&mut sum, row, (&places, &ends), bodies);
            }
        }
        sum
    }
}

fn add_rates(
    sum: &mut Rates,
    row: &Row,
    (places, ends): (&[Option<usize>; 2], &[Option<usize>; 2]),
    bodies: &crate::body::Bodies,
) {
    let Action::Spring(spring) = row.action else { return };
    for (side, place) in places.iter().enumerate() {
        let Some(i) = place.filter(|i| ends.contains(&Some(*i))) else { continue };
        let mass = &bodies.masses[i];
        let inverse = [mass.inverse.x, mass.inverse.y, mass.inverse_inertia];
        let response = row.response(side, inverse);
        sum.stiffness += spring.stiffness * response;
        sum.damping += spring.damping * response;
    }
}
