//! Incompressible fluids of particles: divergence-free smoothed particle hydrodynamics (Bender and Koschier,
//! "Divergence-free SPH for incompressible and viscous fluids", 2017) with the density as an inequality, bodies inside the
//! operator of pressure, and their borders integrated exactly instead of sampled.
//!
//! Positions, velocities and pressures of particles are columns of the world's state; all else is found anew in each
//! substep. A substep of length h: what is near what; pressures that take back the divergence; gravity, viscosity;
//! pressures that keep the density, found together with what contacts and joints do to the bodies; motion.

mod balance;
mod cells;
mod flow;
mod kept;
mod kernel;
mod pairs;
mod particles;
mod pressure;
mod read;
mod shore;
mod solid;
mod streams;
mod team;
mod tension;
mod viscosity;

pub use flow::Flow;
pub use kept::Kept;
pub use particles::Particles;
pub use pressure::Effort;
pub use solid::Wet;
pub use streams::{Inflow, Moving};
pub use team::{MOST_THREADS, Team};

use serde::{Deserialize, Serialize};

use crate::arena::{Arena, Handle, Named};
use crate::error::{Error, Result, check};
use crate::math::{Real, Twist, Vec2, cross};
use crate::shapes::Shape;
use streams::Streams;

/// What names a fluid.
pub type FluidHandle = Handle<Fluid>;

/// What a fluid is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Density at rest (kg/m²).
    pub density: Real,
    /// Viscosity (Pa·s).
    pub viscosity: Real,
    /// Surface tension σ (N/m). Where two fluids meet, both pull.
    #[serde(default)]
    pub tension: Real,
    /// Work of adhesion (N/m) to solids: σ(1 + cos θ) for a contact angle θ. Of fluids with surface tension.
    #[serde(default)]
    pub adhesion: Real,
}

impl Default for Material {
    fn default() -> Self {
        Self { density: 1000.0, viscosity: 0.0, tension: 0.0, adhesion: 0.0 }
    }
}

impl Material {
    fn validated(self) -> Result<Self> {
        check::positive("density", self.density)?;
        check::not_negative("viscosity", self.viscosity)?;
        check::not_negative("tension", self.tension)?;
        check::not_negative("adhesion", self.adhesion)?;
        Ok(self)
    }
}

/// A fluid: particles of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fluid {
    /// A name to find it by; need not be unique.
    pub name: Option<String>,
    /// What it is made of.
    pub material: Material,
    /// How long (s) its particles are there; none: for ever.
    pub lifetime: Option<Real>,
}

impl Named for Fluid {
    const NAME: &'static str = "fluid";
}

/// All fluids of a world.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Fluids {
    /// Distance (m) of the particles of a fluid at rest; the same for all of them.
    pub spacing: Real,
    /// The particles.
    pub particles: Particles,
    /// The fluids.
    pub list: Arena<Fluid>,
    /// Regions that remove particles.
    drains: Vec<Shape>,
    /// How particles come and go.
    streams: Streams,
    /// Energy (J) of the surfaces at the start of the last substep; none: not known.
    pub surface: Option<Real>,
    /// Materials by the slots of the fluids' handles.
    table: Vec<Material>,
    /// What all but the fluids did to each body in the last substep, a second: what is expected of the next.
    pub others: Vec<Twist>,
}

impl Default for Fluids {
    fn default() -> Self {
        Self {
            spacing: 0.0,
            particles: Particles::default(),
            list: Arena::default(),
            drains: Vec::new(),
            streams: Streams::default(),
            surface: None,
            table: Vec::new(),
            others: Vec::new(),
        }
    }
}

impl Fluids {
    /// Area that a particle stands for (m²).
    #[must_use]
    pub fn area(&self) -> Real {
        kernel::lattice().area * self.spacing * self.spacing
    }

    /// Mass of a particle of a fluid (kg).
    #[must_use]
    pub fn particle_mass(&self, kind: u32) -> Real {
        self.table[kind as usize].density * self.area()
    }

    fn materials(&self) -> &[Material] {
        &self.table
    }

    /// The longest substep (s) that the shortest waves of the surfaces allow: 0.2 √(ρ d³/(2πσ)), a part of what Brackbill, Kothe
    /// and Zemach give ("A continuum method for modeling surface tension", 1992).
    fn longest_wave(&self) -> Real {
        let each = self.list.values().iter().map(|fluid| &fluid.material);
        let most = each.map(|material| material.tension / material.density).fold(0.0, Real::max);
        0.2 * (self.spacing.powi(3) / (2.0 * crate::math::PI * most)).sqrt()
    }

    /// Adds a fluid without particles.
    ///
    /// # Errors
    /// A number that is not allowed; a spacing that is not that of the fluids there are.
    pub fn add(
        &mut self,
        name: Option<String>,
        material: Material,
        spacing: Real,
    ) -> Result<FluidHandle> {
        let material = material.validated()?;
        check::positive("spacing", spacing)?;
        if !self.list.values().is_empty() && spacing != self.spacing {
            let allowed = format!("{}, the spacing of the world's other fluids", self.spacing);
            return Err(Error::invalid("spacing", spacing, allowed));
        }
        self.spacing = spacing;
        let handle = self.list.insert(Fluid { name, material, lifetime: None });
        let slot = handle.slot();
        self.table.resize(self.table.len().max(slot + 1), Material::default());
        self.table[slot] = material;
        Ok(handle)
    }

    /// Removes a fluid and its particles.
    ///
    /// # Errors
    /// A handle to a fluid that is gone.
    pub fn remove(&mut self, fluid: FluidHandle) -> Result<()> {
        self.list.remove(fluid)?;
        let kind = fluid.slot() as u32;
        let kinds = self.particles.kinds.clone();
        self.particles.retain(|i| kinds[i] != kind);
        self.forget_inflows(kind);
        Ok(())
    }

    /// Gives a fluid another name, or none.
    ///
    /// # Errors
    /// A handle to a fluid that is gone.
    pub fn rename(&mut self, fluid: FluidHandle, name: Option<String>) -> Result<()> {
        self.list.get_mut(fluid)?.name = name;
        Ok(())
    }

    /// Changes what a fluid is made of.
    ///
    /// # Errors
    /// A number that is not allowed, or a handle to a fluid that is gone.
    pub fn set_material(&mut self, fluid: FluidHandle, material: Material) -> Result<()> {
        let own = self.list.get_mut(fluid)?;
        own.material = material.validated()?;
        self.table[fluid.slot()] = own.material;
        Ok(())
    }

    /// Adds particles to a fluid, all with one velocity (m/s).
    ///
    /// # Errors
    /// Numbers that are not finite, a handle to a fluid that is gone.
    pub fn pour(&mut self, fluid: FluidHandle, positions: &[Vec2], velocity: Vec2) -> Result<()> {
        self.list.get(fluid)?;
        check::finite_vec("velocity", velocity)?;
        for (i, position) in positions.iter().enumerate() {
            check::finite_vec(&format!("points[{i}]"), *position)?;
        }
        for position in positions {
            self.particles.push((*position, velocity), fluid.slot() as u32, self.streams.next);
            self.streams.next += 1;
        }
        Ok(())
    }

    /// ½ Σ mv² (J).
    #[must_use]
    pub fn kinetic_energy(&self) -> Real {
        let each = self.particles.kinds.iter().zip(&self.particles.velocities);
        each.map(|(kind, v)| 0.5 * self.particle_mass(*kind) * v.norm_squared()).sum()
    }

    /// −Σ m g·x (J).
    #[must_use]
    pub fn potential_energy(&self, gravity: Vec2) -> Real {
        let each = self.particles.kinds.iter().zip(&self.particles.positions);
        each.map(|(kind, x)| -self.particle_mass(*kind) * gravity.dot(x)).sum()
    }

    /// Kinetic energy and that in gravity (J).
    #[must_use]
    pub fn mechanical_energy(&self, gravity: Vec2) -> Real {
        self.kinetic_energy() + self.potential_energy(gravity)
    }

    /// Σ m (kg).
    #[must_use]
    pub fn mass(&self) -> Real {
        self.particles.kinds.iter().map(|kind| self.particle_mass(*kind)).sum()
    }

    /// Σ m x (kg·m) about a point.
    #[must_use]
    pub fn first_moment(&self, about: Vec2) -> Vec2 {
        let each = self.particles.kinds.iter().zip(&self.particles.positions);
        each.map(|(kind, x)| (x - about) * self.particle_mass(*kind)).sum()
    }

    /// Σ m v (kg·m/s).
    #[must_use]
    pub fn momentum(&self) -> Vec2 {
        let each = self.particles.kinds.iter().zip(&self.particles.velocities);
        each.map(|(kind, v)| v * self.particle_mass(*kind)).sum()
    }

    /// Σ m (x − p) × v (kg·m²/s).
    #[must_use]
    pub fn angular_momentum(&self, about: Vec2) -> Real {
        let Particles { positions, velocities, kinds, .. } = &self.particles;
        let each = positions.iter().zip(velocities).zip(kinds);
        each.map(|((x, v), kind)| self.particle_mass(*kind) * cross(x - about, *v)).sum()
    }
}

/// Points of a square lattice of this spacing (m) inside a shape, its rows half a spacing from the shape's lowest and
/// leftmost places.
///
/// # Errors
/// A spacing that is not above 0, or so small that there would be more than 10⁸ points.
pub fn lattice_in(shape: &Shape, spacing: Real) -> Result<Vec<Vec2>> {
    check::positive("spacing", spacing)?;
    let bounds = shape.bounds();
    let size = bounds.max - bounds.min;
    let count = |length: Real| (length / spacing - 0.5 + 1e-9).ceil().max(0.0);
    let (columns, rows) = (count(size.x), count(size.y));
    if columns * rows > 1e8 {
        return Err(Error::invalid("spacing", spacing, "at most 10⁸ particles"));
    }
    let mut points = Vec::new();
    for row in 0..rows as u32 {
        for column in 0..columns as u32 {
            let place = Vec2::new(Real::from(column) + 0.5, Real::from(row) + 0.5) * spacing;
            points.push(bounds.min + place);
        }
    }
    points.retain(|point| shape.contains(*point));
    Ok(points)
}
