//! Whole columns at once: what arrays in Python read and write. All or nothing.

use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Twist, Vec2, Wrench};
use crate::world::World;

fn vectors(out: &mut [Real], vectors: impl Iterator<Item = Vec2>) {
    for (pair, v) in out.as_chunks_mut().0.iter_mut().zip(vectors) {
        *pair = [v.x, v.y];
    }
}

fn numbers(out: &mut [Real], numbers: impl Iterator<Item = Real>) {
    out.iter_mut().zip(numbers).for_each(|(x, number)| *x = number);
}

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

    /// Name, as Python writes it.
    #[must_use]
    pub const fn name(self) -> &'static str {
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
        let start = out.len();
        out.resize(start + self.state.bodies.len() * column.width(), 0.0);
        // OK because the length is that of the column.
        let _ = self.fill_column(column, &mut out[start..]);
    }

    /// Fills `out` with a column, in the order of [`World::read_column`].
    ///
    /// # Errors
    /// A wrong length; `out` stays as it was.
    pub fn fill_column(&self, column: Column, out: &mut [Real]) -> Result<()> {
        self.check_length(column, out.len())?;
        let bodies = &self.state.bodies;
        match column {
            Column::Positions => vectors(out, bodies.origins().map(|pose| pose.position)),
            Column::Velocities => vectors(out, bodies.twists.iter().map(|twist| twist.linear)),
            Column::Forces => vectors(out, bodies.forces.iter().map(|wrench| wrench.force)),
            Column::Angles => numbers(out, bodies.poses.iter().map(|pose| pose.angle)),
            Column::AngularVelocities => numbers(out, bodies.twists.iter().map(|v| v.angular)),
            Column::Torques => numbers(out, bodies.forces.iter().map(|wrench| wrench.torque)),
        }
        Ok(())
    }

    fn check_length(&self, column: Column, length: usize) -> Result<()> {
        let n = self.state.bodies.len();
        if length == n * column.width() {
            return Ok(());
        }
        let allowed = format!("{} numbers for {n} bodies", n * column.width());
        Err(Error::invalid(column.name(), format!("{length} numbers"), allowed))
    }

    /// Sets a column from as many numbers as [`World::read_column`] gives.
    ///
    /// # Errors
    /// A wrong count, a number that is not finite, a velocity that a static body or a locked axis
    /// does not allow; the world stays as it was.
    pub fn write_column(&mut self, column: Column, values: &[Real]) -> Result<()> {
        self.check_length(column, values.len())?;
        let n = self.state.bodies.len();
        for (place, value) in values.iter().enumerate() {
            let named = || format!("{}[{}]", column.name(), place / column.width());
            if !value.is_finite() {
                check::finite(&named(), *value)?;
            }
        }
        let vector = |i: usize| Vec2::new(values[2 * i], values[2 * i + 1]);
        self.wake_all();
        if matches!(column, Column::Positions | Column::Angles) {
            self.state.contacts.touch_all();
            self.strays.take();
        }
        let bodies = &mut self.state.bodies;
        match column {
            Column::Positions => {
                for i in 0..n {
                    bodies.set_origin(i, Pose::new(vector(i), bodies.poses[i].angle));
                }
                self.state.contacts.touch_all();
            }
            Column::Angles => {
                for (i, angle) in values.iter().enumerate() {
                    bodies.set_origin(i, Pose::new(bodies.origin(i).position, *angle));
                }
                self.state.contacts.touch_all();
            }
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
