//! Deformable bodies of a scene file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BodyLabel, wrong};
use crate::body::{Filter, Surface};
use crate::error::{Result, check};
use crate::math::{Real, Vec2};
use crate::shapes::Shape;
use crate::soft::{Gas, Material, Mesh, Rope, SoftBody, SoftDef, SoftHandle};
use crate::world::World;

/// A deformable body: a shape that is cut into triangles, triangles between points, or a rope through points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneSoft {
    /// Name.
    pub name: Option<String>,
    /// A shape, which is cut; none: there are points.
    pub shape: Option<Shape>,
    /// About how long the sides of its triangles are (m).
    pub size: Option<Real>,
    /// Points of triangles, or of a rope (m).
    #[schemars(with = "Vec<[Real; 2]>")]
    pub points: Vec<Vec2>,
    /// Numbers of the points of each triangle; none, with a rope.
    pub triangles: Vec<[u32; 3]>,
    /// What a rope is like.
    pub rope: Option<Rope>,
    /// The rope comes back to its first point.
    pub closed: bool,
    /// What it is made of.
    pub material: Material,
    /// The gas in a closed rope.
    pub gas: Option<Gas>,
    /// Where its frame stands (m).
    #[schemars(with = "[Real; 2]")]
    pub position: Vec2,
    /// By how much that is turned (rad).
    pub angle: Real,
    /// Velocity of its centre of mass (m/s).
    #[schemars(with = "[Real; 2]")]
    pub velocity: Vec2,
    /// Angular velocity (rad/s).
    pub angular_velocity: Real,
    /// What gravity is multiplied by; none: 1.
    pub gravity_scale: Option<Real>,
    /// Numbers of nodes that stay where they are: points first, then those half-way along sides.
    pub pins: Vec<u32>,
    /// By how much its border is thicker than its nodes say (m); none: a fiftieth of the mean side of its border.
    pub radius: Option<Real>,
    /// What it is like to touch.
    pub surface: Surface,
    /// What it touches.
    pub filter: Filter,
    /// Whether its border touches itself.
    pub touches_itself: bool,
    /// What it has become. Programs write it.
    pub state: SceneSoftState,
}

/// What a deformable body has become.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneSoftState {
    /// Places of the nodes (m); none: as it is at rest.
    #[schemars(with = "Vec<[Real; 2]>")]
    pub positions: Vec<Vec2>,
    /// Their velocities (m/s); none: of a rigid motion.
    #[schemars(with = "Vec<[Real; 2]>")]
    pub velocities: Vec<Vec2>,
    /// Constant forces on them (N); none: 0.
    #[schemars(with = "Vec<[Real; 2]>")]
    pub forces: Vec<Vec2>,
    /// How it has yielded, F_p⁻¹ (xx, xy, yx, yy) at three points of each triangle; none: not.
    pub flow: Vec<[Real; 4]>,
}

impl From<&SoftBody> for SceneSoft {
    fn from(body: &SoftBody) -> Self {
        let def = body.def();
        let (mesh, rods) = (&def.mesh, def.mesh.rods());
        let corners = |nodes: &[u32; 6]| [nodes[0], nodes[1], nodes[2]];
        let triangles: Vec<[u32; 3]> = mesh.triangles().iter().map(corners).collect();
        let count = triangles.iter().flatten().max().map_or(mesh.rest().len(), |i| *i as usize + 1);
        let pins = (0..).zip(body.pinned()).filter(|(_, on)| **on).map(|(node, _)| node).collect();
        Self {
            name: def.name.clone(),
            shape: None,
            size: None,
            points: mesh.rest()[..count].to_vec(),
            triangles,
            rope: def.rope,
            closed: !rods.is_empty() && rods.len() == mesh.rest().len(),
            material: def.material,
            gas: def.gas,
            position: def.position,
            angle: def.angle,
            velocity: Vec2::zeros(),
            angular_velocity: 0.0,
            gravity_scale: (def.gravity_scale != 1.0).then_some(def.gravity_scale),
            pins,
            radius: def.radius,
            surface: def.surface.clone(),
            filter: def.filter,
            touches_itself: def.touches_itself,
            state: SceneSoftState {
                positions: body.positions().to_vec(),
                velocities: body.velocities().to_vec(),
                forces: body.forces().to_vec(),
                flow: body.flow().to_vec(),
            },
        }
    }
}

impl SceneSoft {
    fn mesh(&self) -> Result<Mesh> {
        if let Some(shape) = &self.shape {
            return Mesh::of_shape(shape, check::positive("size", self.size.unwrap_or(0.0))?);
        }
        if self.rope.is_some() {
            Mesh::rope(&self.points, self.closed)
        } else {
            Mesh::new(&self.points, &self.triangles)
        }
    }

    fn def(&self) -> Result<SoftDef> {
        Ok(SoftDef {
            rope: self.rope,
            gas: self.gas,
            position: self.position,
            angle: self.angle,
            velocity: self.velocity,
            angular_velocity: self.angular_velocity,
            gravity_scale: self.gravity_scale.unwrap_or(1.0),
            pins: self.pins.clone(),
            radius: self.radius,
            surface: self.surface.clone(),
            filter: self.filter,
            touches_itself: self.touches_itself,
            name: self.name.clone(),
            ..SoftDef::new(self.mesh()?, self.material)
        })
    }

    /// Adds the body.
    ///
    /// # Errors
    /// Those of a mesh and of a body, with the path.
    pub(super) fn add(&self, world: &mut World, path: &str) -> Result<SoftHandle> {
        let soft = self.def().and_then(|def| world.add_soft_body(def));
        let soft = soft.map_err(|error| wrong(path, error))?;
        let SceneSoftState { positions, velocities, forces, flow } = &self.state;
        let path = format!("{path}.state");
        let at = |error| wrong(path.as_str(), error);
        if !positions.is_empty() {
            world.set_soft_positions(soft, positions).map_err(at)?;
        }
        if !velocities.is_empty() {
            world.set_soft_velocities(soft, velocities).map_err(at)?;
        }
        if !forces.is_empty() {
            world.set_soft_forces(soft, forces).map_err(at)?;
        }
        if !flow.is_empty() {
            world.set_soft_flow(soft, flow).map_err(at)?;
        }
        Ok(soft)
    }
}

/// The name of a deformable body if no other has it, else its place.
pub(super) fn label(world: &World, soft: SoftHandle) -> Option<BodyLabel> {
    let index = world.soft_handles().iter().position(|own| *own == soft)?;
    let bodies = world.soft_bodies();
    let name = |i: usize| bodies[i].def().name.as_ref();
    Some(match name(index) {
        Some(own) if (0..bodies.len()).all(|i| i == index || name(i) != Some(own)) => {
            BodyLabel::Name(own.clone())
        }
        _ => BodyLabel::Index(index),
    })
}

/// The deformable body that a label names.
///
/// # Errors
/// None or several of a name, a place that is not there.
pub(super) fn find(
    label: &BodyLabel,
    (list, softs): (&[SceneSoft], &[SoftHandle]),
    path: &str,
) -> Result<SoftHandle> {
    let index = match label {
        BodyLabel::Index(index) => *index,
        BodyLabel::Name(name) => {
            let named = |soft: &SceneSoft| soft.name.as_ref() == Some(name);
            let mut found = list.iter().enumerate().filter(|(_, soft)| named(soft));
            match (found.next(), found.next()) {
                (Some((index, _)), None) => index,
                (None, _) => {
                    let message = format!("no deformable body is called {name:?}");
                    return Err(wrong(path, message));
                }
                _ => {
                    let message = format!("several deformable bodies are called {name:?}");
                    return Err(wrong(path, message));
                }
            }
        }
    };
    let none = || wrong(path, format!("{index} for {} deformable bodies", softs.len()));
    softs.get(index).copied().ok_or_else(none)
}
