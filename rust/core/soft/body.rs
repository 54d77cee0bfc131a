//! A deformable body: its columns, and what can be asked of it.

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

use super::factor::{Envelope, Matrix};
use super::gas::Filling;
use super::rod::{Bend, Rod, Stiffness};
use super::tensor::{Tensor, scaled, sum};
use super::triangle::{Triangle, cauchy, flowed, green};
use super::{Moduli, SoftDef, Spot};
use crate::arena::{Handle, Named};
use crate::body::{Filter, Surface};
use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Rot, Vec2, cross, perp};

/// Names a deformable body.
pub type SoftHandle = Handle<SoftBody>;

/// A deformable body. Columns are by nodes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SoftBody {
    pub(super) def: SoftDef,
    pub(super) moving: Moving,
    /// Constant forces (N); empty where there are none.
    pub(super) forces: Vec<Vec2>,
    pub(super) pinned: Vec<bool>,
    #[serde(skip)]
    pub(super) parts: Parts,
    #[serde(skip)]
    pub(super) work: Work,
}

/// What a step changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moving {
    /// Places of the nodes (m).
    pub(super) positions: Vec<Vec2>,
    /// Their velocities (m/s).
    pub(super) velocities: Vec<Vec2>,
    /// F_p⁻¹ at the points of integration; empty where nothing has yielded.
    pub(super) flow: Vec<Tensor>,
    /// Where the factors at hand are of, so that a body that is taken up again goes on to the same bits.
    pub(super) linear: Option<Linear>,
}

/// What factors are of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Linear {
    pub h: Real,
    pub at: Vec<Vec2>,
    /// Half of the way of the substep, if it is of its middle.
    pub way: Vec<Vec2>,
    /// Without what makes the stiffness indefinite.
    pub definite: bool,
    /// For relaxing: M + h²K.
    pub end: bool,
}

/// What follows from the mesh and the material.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub moduli: Moduli,
    pub stiffness: Stiffness,
    pub triangles: Vec<Triangle>,
    pub rods: Vec<Rod>,
    pub bends: Vec<Bend>,
    pub filling: Option<Filling>,
    pub envelope: Envelope,
    /// Σ over its row of the mass matrix (kg): what each node's acceleration and impulses weigh.
    pub shares: Vec<Real>,
    pub mass: Real,
    /// Mean side of the elements (m).
    pub side: Real,
}

/// Columns a step works in.
#[derive(Clone, Debug, Default)]
pub(super) struct Work {
    pub matrix: Matrix,
    /// Columns of its inverse, for the nodes that are touched.
    pub columns: FxHashMap<u32, [Vec<Vec2>; 2]>,
    /// Points that are held like nodes, numbered on from those.
    pub spots: Vec<Spot>,
    /// Whether the factors are those of [`Moving::linear`].
    pub factored: bool,
    /// A⁻¹∇A of the gas, and the factor of the rank it adds.
    pub gas: Vec<Vec2>,
    pub gas_by: Real,
    pub gas_slopes: Vec<Vec2>,
    pub start: Vec<Vec2>,
    pub before: Vec<Vec2>,
    pub end: Vec<Vec2>,
    pub change: Vec<Vec2>,
    pub residual: Vec<Vec2>,
    pub impulses: Vec<Vec2>,
    /// Of those, what Δv answers to; and the size of the error that the last step of Newton's method met, squared (J), infinite before the first.
    pub answered: Vec<Vec2>,
    pub size: Real,
    pub deformations: Vec<Tensor>,
    pub column: Vec<Vec2>,
    /// Where a rigid motion brings the nodes.
    pub carried: Vec<Vec2>,
    pub step: Vec<Vec2>,
    /// By how much the body has turned since it was linearised.
    pub turn: Rot,
    pub h: Real,
    pub acceleration: Vec2,
    /// The midpoint rule has no solution in reach in this substep.
    pub relaxes: bool,
    /// It has relaxed in this substep, under these impulses, to these velocities and this end.
    pub based: bool,
    pub base_impulses: Vec<Vec2>,
    pub base_velocities: Vec<Vec2>,
    pub base_end: Vec<Vec2>,
}

impl Named for SoftBody {
    const NAME: &'static str = "soft body";
}

/// Making and changing it.
impl SoftBody {
    /// The body of a definition.
    ///
    /// # Errors
    /// Numbers that are not allowed, and meshes that do not fit what is asked of them.
    pub fn new(def: SoftDef) -> Result<Self> {
        def.validated()?;
        let pose = Pose::new(def.position, def.angle);
        let positions: Vec<Vec2> = def.mesh.rest.iter().map(|p| pose.apply(*p)).collect();
        let mut pinned = vec![false; positions.len()];
        def.pins.iter().for_each(|pin| pinned[*pin as usize] = true);
        let moving = Moving { positions, velocities: Vec::new(), ..Moving::default() };
        let (parts, work) = (Parts::default(), Work::default());
        let mut body = Self { def, moving, forces: Vec::new(), pinned, parts, work };
        body.rebuild()?;
        let center = body.center();
        let (v, w) = (body.def.velocity, body.def.angular_velocity);
        body.moving.velocities =
            body.moving.positions.iter().map(|p| v + perp(p - center) * w).collect();
        body.rest_pins();
        Ok(body)
    }

    /// Derives what is not stored.
    pub(crate) fn rebuild(&mut self) -> Result<()> {
        self.parts = Parts::new(&self.def)?;
        self.work = Work::default();
        if !self.moving.flow.is_empty() {
            self.apply_flow();
        }
        Ok(())
    }

    fn rest_pins(&mut self) {
        for (v, _) in self.moving.velocities.iter_mut().zip(&self.pinned).filter(|(_, pin)| **pin) {
            *v = Vec2::zeros();
        }
    }

    /// Gradients of the elastic part, where something has yielded.
    pub(super) fn apply_flow(&mut self) {
        let rest = &self.def.mesh.rest;
        for (k, triangle) in self.parts.triangles.iter_mut().enumerate() {
            *triangle = Triangle::new(triangle.nodes, rest);
            for (q, gradients) in triangle.gradients.iter_mut().enumerate() {
                let inverse = self.moving.flow[3 * k + q];
                gradients.iter_mut().for_each(|g| *g = flowed(&inverse, *g));
            }
        }
    }

    /// Sets the places of all nodes (m).
    ///
    /// # Errors
    /// Another number of them, and places that are not finite.
    pub(crate) fn set_positions(&mut self, positions: &[Vec2]) -> Result<()> {
        self.check_column("positions", positions)?;
        self.moving.positions.copy_from_slice(positions);
        Ok(())
    }

    /// Sets the velocities of all nodes (m/s); those of pinned ones stay 0.
    ///
    /// # Errors
    /// Another number of them, and velocities that are not finite.
    pub(crate) fn set_velocities(&mut self, velocities: &[Vec2]) -> Result<()> {
        self.check_column("velocities", velocities)?;
        self.moving.velocities.copy_from_slice(velocities);
        self.rest_pins();
        Ok(())
    }

    /// Sets constant forces on all nodes (N).
    ///
    /// # Errors
    /// Another number of them, and forces that are not finite.
    pub(crate) fn set_forces(&mut self, forces: &[Vec2]) -> Result<()> {
        self.check_column("forces", forces)?;
        self.forces.clear();
        if forces.iter().any(|force| *force != Vec2::zeros()) {
            self.forces.extend_from_slice(forces);
        }
        Ok(())
    }

    /// Fixes a node where it is, or lets it go.
    ///
    /// # Errors
    /// No such node.
    pub(crate) fn set_pinned(&mut self, node: u32, on: bool) -> Result<()> {
        let Some(pinned) = self.pinned.get_mut(node as usize) else {
            return Err(Error::invalid("node", node, "the number of a node"));
        };
        *pinned = on;
        self.work.factored = false;
        self.moving.linear = None;
        self.rest_pins();
        Ok(())
    }

    /// Sets what fills it; none: what was in it is gone, as from a balloon that is pricked.
    ///
    /// # Errors
    /// Numbers that are not allowed, and a gas in what is no closed rope.
    pub(crate) fn set_gas(&mut self, gas: Option<super::Gas>) -> Result<()> {
        SoftDef { gas, ..self.def.clone() }.validated()?;
        self.def.gas = gas;
        self.moving.linear = None;
        self.rebuild()
    }

    /// How it has yielded: F_p⁻¹ at the points of integration; empty where it has not.
    #[must_use]
    pub fn flow(&self) -> &[[Real; 4]] {
        &self.moving.flow
    }

    /// Sets that.
    ///
    /// # Errors
    /// Another number of them, and what is not finite or has no area.
    pub(crate) fn set_flow(&mut self, flow: &[[Real; 4]]) -> Result<()> {
        let count = 3 * self.def.mesh.triangles.len();
        if flow.len() != count {
            let allowed = format!("{count}, three for each triangle");
            return Err(Error::invalid("flow", flow.len(), allowed));
        }
        for [xx, xy, yx, yy] in flow {
            check::positive("determinant of the flow", xx * yy - xy * yx)?;
        }
        self.moving.flow = flow.to_vec();
        self.moving.linear = None;
        self.apply_flow();
        Ok(())
    }

    pub(crate) fn set_surface(&mut self, surface: Surface) {
        self.def.surface = surface;
    }

    pub(crate) fn set_filter(&mut self, filter: Filter) {
        self.def.filter = filter;
    }

    fn check_column(&self, what: &str, column: &[Vec2]) -> Result<()> {
        if column.len() != self.pinned.len() {
            let allowed = format!("one for each of the {} nodes", self.pinned.len());
            return Err(Error::invalid(what, column.len(), allowed));
        }
        column.iter().try_for_each(|v| check::finite_vec(what, *v).map(drop))
    }
}

impl Parts {
    fn new(def: &SoftDef) -> Result<Self> {
        let mesh = &def.mesh;
        let moduli = def.material.moduli();
        let triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|nodes| Triangle::new(*nodes, &mesh.rest)).collect();
        let length = |[a, b]: [u32; 2]| (mesh.rest[b as usize] - mesh.rest[a as usize]).norm();
        let rods: Vec<Rod> =
            mesh.rods.iter().map(|nodes| Rod { nodes: *nodes, length: length(*nodes) }).collect();
        let rope = def.rope.unwrap_or_default();
        let stiffness = Stiffness {
            stretch: rope.stretch_stiffness,
            bending: rope.bending_stiffness,
            viscosity: moduli.viscosity,
        };
        let meets = mesh.bends();
        let bends: Vec<Bend> = meets.iter().map(|nodes| Bend::new(*nodes, &mesh.rest)).collect();
        let bent = meets.iter().map(|nodes| &nodes[..]).filter(|_| stiffness.bending > 0.0);
        let envelope = Envelope::new(mesh.rest.len(), mesh.cliques().chain(bent));
        let ring = || mesh.rods.iter().map(|[a, _]| *a).collect();
        let filling = def.gas.map(|_| Filling::new(ring(), &mesh.rest)).transpose()?;
        let ones = vec![Vec2::x(); mesh.rest.len()];
        let mut weights = vec![Vec2::zeros(); mesh.rest.len()];
        let density = def.material.density;
        triangles.iter().for_each(|triangle| triangle.add_mass(density, &ones, &mut weights));
        rods.iter().for_each(|rod| rod.add_mass(density, &ones, &mut weights));
        let shares: Vec<Real> = weights.iter().map(|w| w.x).collect();
        let mass = check::positive("mass of the soft body", shares.iter().sum())?;
        let sides = mesh.border.iter().map(|edge| length(*edge)).sum::<Real>();
        let side = sides / mesh.border.len() as Real;
        let bends = if stiffness.bending > 0.0 { bends } else { Vec::new() };
        Ok(Self {
            moduli,
            stiffness,
            triangles,
            rods,
            bends,
            filling,
            envelope,
            shares,
            mass,
            side,
        })
    }
}

/// What can be asked of it.
impl SoftBody {
    /// Its definition, as it was added.
    #[must_use]
    pub fn def(&self) -> &SoftDef {
        &self.def
    }

    /// Places of the nodes (m).
    #[must_use]
    pub fn positions(&self) -> &[Vec2] {
        &self.moving.positions
    }

    /// Velocities of the nodes (m/s).
    #[must_use]
    pub fn velocities(&self) -> &[Vec2] {
        &self.moving.velocities
    }

    /// Constant forces on the nodes (N); empty where there are none.
    #[must_use]
    pub fn forces(&self) -> &[Vec2] {
        &self.forces
    }

    /// Which nodes are fixed.
    #[must_use]
    pub fn pinned(&self) -> &[bool] {
        &self.pinned
    }

    /// What a step changes, to go back to.
    pub(crate) fn moving(&self) -> &Moving {
        &self.moving
    }

    /// Goes back to how it moved.
    pub(crate) fn go_back(&mut self, moving: &Moving) {
        if self.moving.linear != moving.linear {
            self.work.factored = false;
        }
        let flowed = self.moving.flow != moving.flow;
        self.moving.clone_from(moving);
        if flowed {
            if self.moving.flow.is_empty() {
                let rest = &self.def.mesh.rest;
                self.parts.triangles.iter_mut().for_each(|t| *t = Triangle::new(t.nodes, rest));
            } else {
                self.apply_flow();
            }
        }
    }

    /// Mass (kg).
    #[must_use]
    pub fn mass(&self) -> Real {
        self.parts.mass
    }

    /// What each node weighs where all move alike (kg): the rows of the mass matrix added up.
    #[must_use]
    pub fn shares(&self) -> &[Real] {
        &self.parts.shares
    }

    /// By how much its border is thicker than its nodes say (m).
    #[must_use]
    pub fn radius(&self) -> Real {
        self.def.radius.unwrap_or(THICK * self.parts.side)
    }

    /// Mean length of a piece of its border (m).
    #[must_use]
    pub fn side(&self) -> Real {
        self.parts.side
    }

    /// Centre of mass (m).
    #[must_use]
    pub fn center(&self) -> Vec2 {
        // About a node, so that a distant origin costs no digits.
        let from = self.moving.positions[0];
        let columns = self.parts.shares.iter().zip(&self.moving.positions);
        from + columns.map(|(m, p)| (p - from) * *m).sum::<Vec2>() / self.parts.mass
    }

    /// Momentum (kg·m/s).
    #[must_use]
    pub fn momentum(&self) -> Vec2 {
        self.parts.shares.iter().zip(&self.moving.velocities).map(|(m, v)| v * *m).sum()
    }

    /// Angular momentum about a point (kg·m²/s): Σ (x − p) × Mv.
    #[must_use]
    pub fn angular_momentum(&self, about: Vec2) -> Real {
        let mut weighted = vec![Vec2::zeros(); self.pinned.len()];
        self.add_mass_times(&self.moving.velocities, &mut weighted);
        self.moving.positions.iter().zip(&weighted).map(|(x, p)| cross(x - about, *p)).sum()
    }

    /// Kinetic energy ½ vᵀMv (J).
    #[must_use]
    pub fn kinetic_energy(&self) -> Real {
        let mut weighted = vec![Vec2::zeros(); self.pinned.len()];
        self.add_mass_times(&self.moving.velocities, &mut weighted);
        0.5 * self.moving.velocities.iter().zip(&weighted).map(|(v, p)| v.dot(p)).sum::<Real>()
    }

    /// Energy of what is strained, and of the gas in it (J).
    #[must_use]
    pub fn strain_energy(&self) -> Real {
        self.strain_energy_at(&self.moving.positions)
    }

    pub(super) fn strain_energy_at(&self, at: &[Vec2]) -> Real {
        let Parts { moduli, stiffness, triangles, rods, bends, .. } = &self.parts;
        let mut energy: Real = triangles.iter().map(|t| t.energy(moduli, at)).sum();
        energy += rods.iter().map(|rod| rod.energy(stiffness.stretch, at)).sum::<Real>();
        energy += bends.iter().map(|bend| bend.energy(stiffness.bending, at)).sum::<Real>();
        if let (Some(gas), Some(filling)) = (&self.def.gas, &self.parts.filling) {
            energy += filling.energy(gas, at);
        }
        energy
    }

    /// Adds M v.
    pub(super) fn add_mass_times(&self, v: &[Vec2], out: &mut [Vec2]) {
        let density = self.def.material.density;
        self.parts.triangles.iter().for_each(|triangle| triangle.add_mass(density, v, out));
        self.parts.rods.iter().for_each(|rod| rod.add_mass(density, v, out));
    }

    /// Area of the triangles (m²), or inside a rope that is filled.
    #[must_use]
    pub fn area(&self) -> Real {
        let at = &self.moving.positions;
        if let Some(filling) = &self.parts.filling {
            return filling.area_at(at);
        }
        let of = |t: &Triangle| {
            let [a, b, c, ab, bc, ca] = t.gather(at);
            let straight = 0.5 * cross(b - a, c - a);
            // Between a side's chord and the parabola through its middle node lie four thirds of the triangle they span.
            let bulge = |a: Vec2, m: Vec2, b: Vec2| 2.0 / 3.0 * cross(m - a, b - a);
            straight + bulge(a, ab, b) + bulge(b, bc, c) + bulge(c, ca, a)
        };
        self.parts.triangles.iter().map(of).sum()
    }

    /// Pressure of the gas in it above that outside (Pa); none without a gas.
    #[must_use]
    pub fn pressure(&self) -> Option<Real> {
        let (gas, filling) = (self.def.gas?, self.parts.filling.as_ref()?);
        Some(filling.pressure(&gas, &self.moving.positions))
    }

    /// Green's strain of each triangle, the mean over it: xx, yy, xy in the axes of the mesh. Of ropes the relative stretch of each rod, as
    /// xx.
    #[must_use]
    pub fn strains(&self) -> Vec<[Real; 3]> {
        self.per_element(green, |rod, at| (1.0 + 2.0 * rod.strain(at)).max(0.0).sqrt() - 1.0)
    }

    /// Cauchy's stress (Pa) of each triangle, the mean over it, without the viscous part: xx, yy, xy in the axes of the world. Of ropes the
    /// tension (N) of each rod, as xx.
    #[must_use]
    pub fn stresses(&self) -> Vec<[Real; 3]> {
        let Parts { moduli, stiffness, .. } = &self.parts;
        self.per_element(
            |f| cauchy(moduli, f),
            |rod, at| {
                let strain = rod.strain(at);
                stiffness.stretch * strain * (1.0 + 2.0 * strain).max(0.0).sqrt()
            },
        )
    }

    fn per_element(
        &self,
        of: impl Fn(&Tensor) -> Tensor,
        of_rod: impl Fn(&Rod, &[Vec2]) -> Real,
    ) -> Vec<[Real; 3]> {
        let at = &self.moving.positions;
        let triangle = |t: &Triangle| {
            let sums = t.deformation(at).iter().fold([0.0; 4], |all, f| sum(&all, &of(f)));
            let mean = scaled(&sums, 1.0 / 3.0);
            [mean[0], mean[3], mean[1]]
        };
        let triangles = self.parts.triangles.iter().map(triangle);
        triangles.chain(self.parts.rods.iter().map(|rod| [of_rod(rod, at), 0.0, 0.0])).collect()
    }

    pub(crate) fn is_finite(&self) -> bool {
        let sum = |column: &[Vec2]| column.iter().map(|v| v.x.abs() + v.y.abs()).sum::<Real>();
        (sum(&self.moving.positions) + sum(&self.moving.velocities)).is_finite()
    }
}

/// Radius of a border of which nothing else is said, as a part of the mean side of its pieces.
const THICK: Real = 0.02;
