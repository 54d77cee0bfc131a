//! Lattices of springs: soft bodies out of points.

use super::Assembly;
use super::cells::{Bond, Cells};
use super::plan::{Plan, Side};
use crate::body::{BodyDef, Locks};
use crate::error::{Result, check};
use crate::joint::{Coefficients, Hold, JointDef, Spring};
use crate::math::{Real, Vec2, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// How the points of a lattice stand, and which springs there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Equilateral triangles: the same in all directions.
    #[default]
    Triangular,
    /// Squares without diagonals: stiff along the axes, and nothing resists shear.
    Square,
    /// Squares with both diagonals at half the stiffness of the sides: the same in all directions.
    BracedSquare,
}

/// How stiff a lattice is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elasticity {
    /// k of a spring between two points inside (N/m).
    Stiffness(Real),
    /// Young's modulus times depth: force per length of a cut, per strain (N/m).
    Young(Real),
}

/// What a lattice amounts to as an elastic sheet under small strains, in plane stress and times its depth.
///
/// Every cell gives half a k to each of its sides, so springs on the border have half of those inside, and the lattice is what
/// finite elements with linear displacements make of the sheet, without an edge effect. A triangle has the energy
/// ¼k Σ(a nᵢ·ε·nᵢ)², which is that of an isotropic sheet with E = 2k/√3, ν = 1/3, G = √3k/4. A square with diagonals of ½k has
/// E = 4k/3, ν = 1/3, G = k/2; without them E = k along its axes, ν = 0, G = 0.
/// (M. Ostoja-Starzewski, "Lattice models in micromechanics", Applied Mechanics Reviews 55, 2002.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moduli {
    /// k of a spring between two points inside (N/m).
    pub stiffness: Real,
    /// Young's modulus E (N/m).
    pub young: Real,
    /// Poisson's ratio ν.
    pub poisson: Real,
    /// Shear modulus G (N/m).
    pub shear: Real,
}

impl Pattern {
    /// What a lattice of springs of stiffness k (N/m) amounts to.
    #[must_use]
    pub fn moduli(self, stiffness: Real) -> Moduli {
        let (young, poisson, shear) = match self {
            Self::Triangular => (2.0 / 3.0_f64.sqrt(), 1.0 / 3.0, 3.0_f64.sqrt() / 4.0),
            Self::Square => (1.0, 0.0, 0.0),
            Self::BracedSquare => (4.0 / 3.0, 1.0 / 3.0, 0.5),
        };
        Moduli { stiffness, young: young * stiffness, poisson, shear: shear * stiffness }
    }
}

/// Points that fill a polygon, with springs between neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeDef {
    /// Bodies are called "`name` 0" and so on, joints "`name` joint 0".
    pub name: String,
    /// A simple polygon in the world (m).
    pub outline: Vec<Vec2>,
    /// Holes in it (m).
    pub holes: Vec<Vec<Vec2>>,
    /// Distance of neighbours (m). Cells that are not wholly inside the outline are left out.
    pub spacing: Real,
    /// How the points stand.
    pub pattern: Pattern,
    /// How stiff it is.
    pub elasticity: Elasticity,
    /// Damping ratio of a spring between two points inside alone: c = 2ζ√(km/2); in proportion on the border.
    pub damping_ratio: Real,
    /// Mass per area (kg/m²): of each cell an equal part goes to its corners.
    pub mass_per_area: Real,
    /// Radius of the disks by which it touches what is around it (m); none: half the spacing. 0: it touches nothing.
    pub radius: Option<Real>,
    /// Velocity of all points (m/s).
    pub velocity: Vec2,
    /// Force (N) above which a spring breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Surface, filter, damping and the like of all points. Place, shape and mass come from the lattice.
    pub body: BodyDef,
}

/// A lattice in a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Its points, row by row from below, and its springs.
    pub parts: Assembly,
    /// What it amounts to.
    pub moduli: Moduli,
    /// Area of its cells (m²).
    pub area: Real,
}

impl LatticeDef {
    /// A triangular lattice of 1 kg/m², hardly damped.
    #[must_use]
    pub fn new(outline: Vec<Vec2>, spacing: Real, elasticity: Elasticity) -> Self {
        Self {
            name: "lattice".into(),
            outline,
            holes: Vec::new(),
            spacing,
            pattern: Pattern::default(),
            elasticity,
            damping_ratio: 0.02,
            mass_per_area: 1.0,
            radius: None,
            velocity: vec2(0.0, 0.0),
            breaking_force: None,
            body: BodyDef::default(),
        }
    }

    /// Adds the lattice, its springs at rest.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for an outline that is no simple polygon, for numbers that are not allowed, and for a spacing at
    /// which no cell is inside or more than a million points are. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Lattice> {
        check::positive("spacing", self.spacing)?;
        check::positive("mass_per_area", self.mass_per_area)?;
        check::not_negative("damping_ratio", self.damping_ratio)?;
        let moduli = self.moduli()?;
        let shape = Shape::polygon_with_holes(&self.outline, &self.holes)?;
        let cells = Cells::fill(&shape, self.spacing, self.pattern)?;
        let area: Real = cells.areas.iter().sum();
        let inside = cells.areas.iter().copied().fold(0.0, Real::max) * self.mass_per_area;
        let mut plan = Plan::default();
        self.plan_points(&cells, &mut plan)?;
        for (k, bond) in cells.bonds.iter().enumerate() {
            let hold = Hold::Spring(Spring::Constants(self.spring(bond, &moduli, inside)));
            let spring = JointDef {
                name: Some(format!("{} joint {k}", self.name)),
                breaking_force: self.breaking_force,
                ..JointDef::spring(None, None, hold)
            };
            plan.joint(bond.ends.map(Side::New), spring);
        }
        Ok(Lattice { parts: plan.add(world)?, moduli, area })
    }

    /// What it will amount to.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for a stiffness or a modulus that is not above 0.
    pub fn moduli(&self) -> Result<Moduli> {
        let stiffness = match self.elasticity {
            Elasticity::Stiffness(k) => check::positive("stiffness", k)?,
            Elasticity::Young(young) => {
                check::positive("young", young)? / self.pattern.moduli(1.0).young
            }
        };
        Ok(self.pattern.moduli(stiffness))
    }

    fn plan_points(&self, cells: &Cells, plan: &mut Plan) -> Result<()> {
        let radius = check::not_negative("radius", self.radius.unwrap_or(0.5 * self.spacing))?;
        let shapes = if radius > 0.0 { vec![Shape::circle(radius)?.into()] } else { Vec::new() };
        for (k, (point, area)) in cells.points.iter().zip(&cells.areas).enumerate() {
            plan.body(BodyDef {
                name: Some(format!("{} {k}", self.name)),
                position: *point,
                velocity: self.velocity,
                shapes: shapes.clone(),
                mass: Some(self.mass_per_area * area),
                // Springs end in the middle and could not keep a disk from turning: it would roll where it should rub.
                locks: Locks { rotation: true, ..self.body.locks },
                ..self.body.clone()
            });
        }
        Ok(())
    }

    /// k and c of a bond, given the mass of a point inside.
    fn spring(&self, bond: &Bond, moduli: &Moduli, inside: Real) -> Coefficients {
        let k = moduli.stiffness;
        let damping = 2.0 * self.damping_ratio * (0.5 * k * inside).sqrt();
        // A side belongs to two cells or, on the border, to one; diagonals have half the stiffness of a side.
        let part = if bond.brace { 0.5 } else { 0.5 * Real::from(bond.cells) };
        Coefficients { stiffness: part * k, damping: part * damping }
    }
}
