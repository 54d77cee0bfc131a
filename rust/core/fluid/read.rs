//! What can be asked of fluids, and changed by the particle: columns of a fluid in the order in which its particles were
//! added, probes.

use super::kernel::Kernel;
use super::{FluidHandle, Fluids, Material};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

/// Columns of one fluid, oldest particle first.
impl Fluids {
    fn column<T>(&self, fluid: FluidHandle, of: impl Fn(usize) -> T) -> Result<Vec<T>> {
        self.list.get(fluid)?;
        Ok(self.particles.of(fluid.slot() as u32).into_iter().map(of).collect())
    }

    /// What a fluid is made of.
    ///
    /// # Errors
    /// A handle to a fluid that is gone, as of all below.
    pub fn material(&self, fluid: FluidHandle) -> Result<Material> {
        Ok(self.list.get(fluid)?.material)
    }

    /// Positions (m).
    pub fn positions(&self, fluid: FluidHandle) -> Result<Vec<Vec2>> {
        self.column(fluid, |i| self.particles.positions[i])
    }

    /// Velocities (m/s).
    pub fn velocities(&self, fluid: FluidHandle) -> Result<Vec<Vec2>> {
        self.column(fluid, |i| self.particles.velocities[i])
    }

    /// Densities (kg/m²) in the last substep: what is near a particle counts, at a free surface that is less.
    pub fn densities(&self, fluid: FluidHandle) -> Result<Vec<Real>> {
        let density = self.material(fluid)?.density;
        self.column(fluid, |i| density * self.particles.compressions[i])
    }

    /// Pressures (Pa) in the last substep.
    pub fn pressures(&self, fluid: FluidHandle) -> Result<Vec<Real>> {
        self.column(fluid, |i| self.pressure(i))
    }

    fn pressure(&self, i: usize) -> Real {
        self.particles.pressures[i] + self.particles.relaxing[i]
    }

    /// Sets the velocities (m/s) of a fluid's particles, oldest first.
    ///
    /// # Errors
    /// Another number of them than of particles; numbers that are not finite.
    pub fn set_velocities(&mut self, fluid: FluidHandle, velocities: &[Vec2]) -> Result<()> {
        self.list.get(fluid)?;
        let places = self.particles.of(fluid.slot() as u32);
        if places.len() != velocities.len() {
            let got = format!("{} velocities", velocities.len());
            return Err(Error::invalid("velocities", got, format!("{}", places.len())));
        }
        for (i, velocity) in velocities.iter().enumerate() {
            check::finite_vec(&format!("velocities[{i}]"), *velocity)?;
        }
        for (place, velocity) in places.into_iter().zip(velocities) {
            self.particles.velocities[place] = *velocity;
        }
        Ok(())
    }

    /// Removes particles of a fluid, by their numbers among its own, oldest first.
    ///
    /// # Errors
    /// A number that is no particle's.
    pub fn take(&mut self, fluid: FluidHandle, numbers: &[usize]) -> Result<()> {
        self.list.get(fluid)?;
        let places = self.particles.of(fluid.slot() as u32);
        let mut gone = vec![false; self.particles.len()];
        for number in numbers {
            let Some(place) = places.get(*number) else {
                let allowed = format!("0 to {}", places.len().saturating_sub(1));
                return Err(Error::invalid("particle", number, allowed));
            };
            gone[*place] = true;
        }
        self.particles.retain(|i| !gone[i]);
        Ok(())
    }
}

/// Probes.
impl Fluids {
    /// Pressure (Pa) at a point: the mean of the particles around it, weighted by the kernel; none where there is none.
    #[must_use]
    pub fn pressure_at(&self, point: Vec2) -> Option<Real> {
        let kernel = Kernel::new(self.spacing);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (i, position) in self.particles.positions.iter().enumerate() {
            let weight = kernel.value((position - point).norm());
            sum += weight * self.pressure(i);
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    }

    /// Height (m) of the highest free surface above a place x: of the highest particle within a spacing that is not alone,
    /// and half a spacing.
    #[must_use]
    pub fn height_at(&self, x: Real) -> Option<Real> {
        let each = self.particles.positions.iter().zip(&self.particles.compressions);
        let near =
            each.filter(|(p, part)| (p.x - x).abs() <= self.spacing && **part > super::flow::ALONE);
        near.map(|(p, _)| p.y + 0.5 * self.spacing).reduce(Real::max)
    }
}
