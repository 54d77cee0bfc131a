//! From a world to a scene file.

use std::collections::BTreeMap;

use super::{
    BodyLabel, Material, SceneBody, SceneField, SceneFile, SceneFluid, SceneJoint,
    SceneOscillating, SceneSchedule, SceneSettings, SceneSoft, soft, wrong,
};
use crate::body::{BodyHandle, Info};
use crate::error::Result;
use crate::forces::{BuiltInField, ForceField, Schedule};
use crate::joint::Joint;
use crate::math::{Pose, Real, Vec2, Wrench};
use crate::world::World;

impl SceneFile {
    /// The scene that begins where a world is: the world made from it goes on to the same bits; with deformable bodies
    /// to what their iterations leave, since their factors are made anew. Name,
    /// description and `run` are the defaults; the energy books (work, dissipation) are not in it.
    ///
    /// # Errors
    /// [`crate::Error::SceneFile`] for what a file cannot hold: a field that is the user's own code or
    /// acts on a body that is gone, and forces that wait for the next step only.
    pub fn from_world(world: &World) -> Result<Self> {
        let bodies = world.bodies();
        if let Some(i) = bodies.applied.iter().position(|wrench| *wrench != Wrench::ZERO) {
            let message = "a force was applied for the next step only, which a file cannot hold; \
                           step first, or give the body a constant force";
            return Err(wrong(format!("bodies[{i}]"), message));
        }
        let settings = world.settings();
        let (time, time_remainder) = world.clock();
        let fluids = world.fluids().list.handles();
        let fields = world.fields().iter().enumerate();
        Ok(Self {
            gravity: settings.gravity,
            air: settings.air,
            settings: SceneSettings::from(settings),
            time,
            time_remainder,
            materials: materials(world),
            bodies: (0..bodies.len()).map(|i| body(world, i)).collect(),
            soft_bodies: world.soft_bodies().iter().map(SceneSoft::from).collect(),
            joints: joints(world)?,
            fluids: fluids.iter().map(|own| SceneFluid::of(world, *own)).collect::<Result<_>>()?,
            drains: world.fluids().drains().to_vec(),
            flow: (!fluids.is_empty()).then(|| world.fluids().kept()),
            schedules: world
                .schedules()
                .iter()
                .map(|own| schedule(world, own))
                .collect::<Result<_>>()?,
            fields: fields.map(|(i, own)| field(world, i, own.as_ref())).collect::<Result<_>>()?,
            ..Self::default()
        })
    }
}

/// All materials by name. Their values stand with the shapes.
fn materials(world: &World) -> BTreeMap<String, Material> {
    let table = &world.settings().mixing.table;
    let pairs = table.iter().flat_map(|pair| [Some(&pair.a), Some(&pair.b)]);
    let bodies = world.bodies().infos.iter().flat_map(|Info { def, .. }| {
        let parts = def.shapes.iter().map(|part| part.surface.material.as_ref());
        parts.chain([def.surface.material.as_ref()])
    });
    let named = |name: &String| (name.clone(), Material::default());
    let softs = world.soft_bodies().iter().map(|body| body.def().surface.material.as_ref());
    pairs.chain(bodies).chain(softs).flatten().map(named).collect()
}

/// A body, by its frame if that gives the centre of mass back to the bit, else by its centre of mass.
fn body(world: &World, i: usize) -> SceneBody {
    let bodies = world.bodies();
    let def = bodies.def(i);
    let frame = Pose::new(def.position, def.angle);
    let (center, found) = (bodies.poses[i].position, frame.apply(bodies.local_centers[i]));
    let mut body = SceneBody::from(def);
    if bits(center) != bits(found) {
        body.center_at = Some(center);
        body.def.position = Vec2::zeros();
    }
    body
}

fn bits(v: Vec2) -> [u64; 2] {
    [v.x.to_bits(), v.y.to_bits()]
}

/// The name of a body if no other has it, else its place.
fn label(world: &World, body: BodyHandle, path: &str) -> Result<BodyLabel> {
    let bodies = world.bodies();
    let index = bodies.index(body).map_err(|error| wrong(path, error))?;
    let name = |i: usize| bodies.infos[i].def.name.as_ref();
    Ok(match name(index) {
        Some(own) if (0..bodies.len()).all(|i| i == index || name(i) != Some(own)) => {
            BodyLabel::Name(own.clone())
        }
        _ => BodyLabel::Index(index),
    })
}

fn joints(world: &World) -> Result<Vec<SceneJoint>> {
    let joint = |(i, joint): (usize, &Joint)| {
        if let Some(custom) = &joint.custom {
            let message =
                format!("the joint {custom:?} is code of your own, which a file cannot hold");
            return Err(wrong(format!("joints[{i}]"), message));
        }
        let mut labels = [None, None];
        for (side, (own, body)) in labels.iter_mut().zip(joint.def.bodies).enumerate() {
            let path = format!("joints[{i}].bodies[{side}]");
            *own = body.map(|body| label(world, body, &path)).transpose()?;
        }
        let softs = world.soft_ends(world.joint_handles()[i])?;
        let soft_labels = softs.map(|soft| soft.and_then(|soft| soft::label(world, soft)));
        Ok(SceneJoint::new(joint, labels).holding(soft_labels))
    };
    world.joints().iter().enumerate().map(joint).collect()
}

fn schedule(world: &World, own: &Schedule) -> Result<SceneSchedule> {
    let wrenches = own.forces.wrenches();
    let finite = |time: &Real| time.is_finite().then_some(*time);
    let mut schedule = SceneSchedule {
        body: label(world, own.body, "schedules")?,
        times: own.forces.times().iter().map(finite).collect(),
        forces: wrenches.iter().map(|wrench| wrench.force).collect(),
        torques: wrenches.iter().map(|wrench| wrench.torque).collect(),
    };
    if wrenches.iter().all(|wrench| bits(wrench.force) == [0, 0]) {
        schedule.forces.clear();
    }
    if wrenches.iter().all(|wrench| wrench.torque.to_bits() == 0) {
        schedule.torques.clear();
    }
    Ok(schedule)
}

fn field(world: &World, i: usize, own: &dyn ForceField) -> Result<SceneField> {
    let path = format!("fields[{i}]");
    match own.built_in() {
        Some(BuiltInField::Central(own)) => Ok(SceneField::Central(own)),
        Some(BuiltInField::Attraction(own)) => Ok(SceneField::Attraction(own)),
        Some(BuiltInField::Oscillating(own)) => Ok(SceneField::Oscillating(SceneOscillating {
            body: label(world, own.body, &path)?,
            force: own.force,
            torque: own.torque,
            hertz: own.hertz,
            phase: own.phase,
        })),
        None => {
            let name = own.name();
            let message = format!(
                "the field {name:?} is code of your own; a file can hold central, attraction and \
                 oscillating fields"
            );
            Err(wrong(path, message))
        }
    }
}
