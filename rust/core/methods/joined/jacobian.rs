//! How accelerations by springs change with places and velocities.

use super::Joints;
use crate::constraints::joint::Action;
use crate::math::{Pose, Real, Twist};

impl Joints {
    /// Adds ∂a/∂q = −P M⁻¹Jᵀk J and ∂a/∂v = −P M⁻¹Jᵀc J of the springs, by columns; P leaves what the rows that hold allow.
    ///
    /// How J turns is left out: forces over lengths, which stiffness does not make larger. Differences of accelerations would not do:
    /// what rounding leaves of the stiff directions would drown what is soft across them.
    pub fn add_spring_jacobian(
        &mut self,
        (poses, twists): (&[Pose], &[Twist]),
        [by_places, by_velocities]: [&mut [Real]; 2],
    ) {
        self.look(poses, twists);
        self.factor();
        let n = 3 * poses.len();
        let mut column = vec![Twist::ZERO; poses.len()];
        for k in 0..n {
            for (velocity, matrix) in [(false, &mut *by_places), (true, &mut *by_velocities)] {
                column.fill(Twist::ZERO);
                if !self.pull_of_shift(k, velocity, &mut column) {
                    continue;
                }
                if self.holds() {
                    self.solve(&column, |row, a| -row.velocity(a));
                    column.iter_mut().zip(self.response()).for_each(|(a, change)| *a += *change);
                }
                let into = &mut matrix[k * n..(k + 1) * n];
                into.iter_mut()
                    .zip(bytemuck::cast_slice(&column))
                    .for_each(|(x, a): (_, &Real)| *x += a);
            }
        }
    }

    /// Accelerations by springs per unit of a component of places, or of velocities; whether there are any.
    fn pull_of_shift(&self, component: usize, velocity: bool, out: &mut [Twist]) -> bool {
        let mut any = false;
        for (tie, rows) in self.ties.iter().zip(&self.rows) {
            for (side, slot) in tie.bodies.iter().enumerate() {
                if slot.map(|slot| slot as usize) != Some(component / 3) {
                    continue;
                }
                for row in rows.as_slice() {
                    let Action::Spring(spring) = row.action else { continue };
                    let strength = if velocity { spring.damping } else { spring.stiffness };
                    self.push(tie, row, -strength * row.jacobian[side][component % 3], out);
                    any = true;
                }
            }
        }
        any
    }
}
