//! Whole columns at once: what arrays in Python read and write. All or nothing.

use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Twist, Vec2, Wrench};
use crate::world::World;

/// A quantity of every body, in body order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Positions of the bodies' frames (m).
    Positions,
    /// Angles (rad).
    Angles,
    /// Velocities of the centres of mass (m/s).
    Velocities,
    /// Angular velocities (rad/s).
    AngularVelocities,
    /// Constant forces (N).
    Forces,
    /// Constant torques (N·m).
    Torques,
}

impl Column {
    /// Numbers a body has in this column: 2 or 1.
    #[must_use]
    pub const fn width(self) -> usize {
        match self {
            Self::Positions | Self::Velocities | Self::Forces => 2,
            Self::Angles | Self::AngularVelocities | Self::Torques => 1,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Positions => "positions",
            Self::Angles => "angles",
            Self::Velocities => "velocities",
            Self::AngularVelocities => "angular_velocities",
            Self::Forces => "forces",
            Self::Torques => "torques",
        }
    }
}

impl World {
    /// Appends a column to `out`: x, y, x, y, … of vectors, one number after the other of scalars.
    pub fn read_column(&self, column: Column, out: &mut Vec<Real>) {
        let bodies = &self.state.bodies;
        let mut vector = |v: Vec2| out.extend([v.x, v.y]);
        match column {
            Column::Positions => {
                (0..bodies.len()).for_each(|i| vector(bodies.origin(i).position));
            }
            Column::Velocities => bodies.twists.iter().for_each(|twist| vector(twist.linear)),
            Column::Forces => bodies.forces.iter().for_each(|wrench| vector(wrench.force)),
            Column::Angles => out.extend(bodies.poses.iter().map(|pose| pose.angle)),
            Column::AngularVelocities => out.extend(bodies.twists.iter().map(|v| v.angular)),
            Column::Torques => out.extend(bodies.forces.iter().map(|wrench| wrench.torque)),
        }
    }

    /// Sets a column from as many numbers as [`World::read_column`] gives.
    ///
    /// # Errors
    /// A wrong count, a number that is not finite, a velocity that a static body or a locked axis
    /// does not allow; the world stays as it was.
    pub fn write_column(&mut self, column: Column, values: &[Real]) -> Result<()> {
        let n = self.state.bodies.len();
        if values.len() != n * column.width() {
            let allowed = format!("{} numbers for {n} bodies", n * column.width());
            return Err(Error::invalid(
                column.name(),
                format!("{} numbers", values.len()),
                allowed,
            ));
        }
        for (place, value) in values.iter().enumerate() {
            let named = || format!("{}[{}]", column.name(), place / column.width());
            if !value.is_finite() {
                check::finite(&named(), *value)?;
            }
        }
        let vector = |i: usize| Vec2::new(values[2 * i], values[2 * i + 1]);
        let bodies = &mut self.state.bodies;
        match column {
            Column::Positions => (0..n).for_each(|i| {
                bodies.set_origin(i, Pose::new(vector(i), bodies.poses[i].angle));
            }),
            Column::Angles => (0..n).for_each(|i| {
                bodies.set_origin(i, Pose::new(bodies.origin(i).position, values[i]));
            }),
            Column::Velocities => {
                self.write_twists(|i, twist| Twist::new(vector(i), twist.angular))?;
            }
            Column::AngularVelocities => {
                self.write_twists(|i, twist| Twist::new(twist.linear, values[i]))?;
            }
            Column::Forces => self.write_forces(|i, old| Wrench::new(vector(i), old.torque)),
            Column::Torques => self.write_forces(|i, old| Wrench::new(old.force, values[i])),
        }
        Ok(())
    }

    fn write_twists(&mut self, new: impl Fn(usize, &Twist) -> Twist) -> Result<()> {
        let bodies = &mut self.state.bodies;
        for (i, (info, twist)) in bodies.infos.iter().zip(&bodies.twists).enumerate() {
            let twist = new(i, twist);
            info.def.allows_velocity(twist.linear, twist.angular)?;
        }
        for (i, twist) in bodies.twists.iter_mut().enumerate() {
            *twist = new(i, twist);
        }
        Ok(())
    }

    fn write_forces(&mut self, new: impl Fn(usize, &Wrench) -> Wrench) {
        for (i, wrench) in self.state.bodies.forces.iter_mut().enumerate() {
            *wrench = new(i, wrench);
        }
        self.plan = None;
    }
}
