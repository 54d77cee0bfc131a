//! From a scene file to a world.

use super::{BodyLabel, Material, SceneBody, SceneField, SceneFile, SceneJoint};
use super::{SCENE_VERSION, ScenePart, SceneSchedule, soft, wrong};
use crate::body::{BodyDef, BodyHandle, Part, SurfaceOverride};
use crate::error::{Error, Result, check};
use crate::forces::{BuiltInField, ForceSchedule, Oscillating};
use crate::math::{Real, Vec2, Wrench};
use crate::soft::SoftHandle;
use crate::world::World;

impl SceneFile {
    /// The world of this scene, at its beginning. Its energy books (work, dissipation) begin at 0.
    ///
    /// # Errors
    /// [`Error::SceneFile`] with the path of the value that is not allowed.
    pub fn world(&self) -> Result<World> {
        if self.culbuto != SCENE_VERSION {
            let got = format!("version {} is not known; allowed: 1", self.culbuto);
            return Err(wrong("culbuto", got));
        }
        let mut world = World::default();
        self.set_up(&mut world)?;
        self.check_what_no_world_knows()?;
        let mut bodies = Vec::with_capacity(self.bodies.len());
        for (i, body) in self.bodies.iter().enumerate() {
            bodies.push(self.add_body(&mut world, i, body)?);
        }
        let softs = self.soft_bodies.iter().enumerate();
        let softs = softs.map(|(i, soft)| soft.add(&mut world, &format!("soft_bodies[{i}]")));
        let softs = softs.collect::<Result<Vec<_>>>()?;
        for (i, joint) in self.joints.iter().enumerate() {
            self.add_joint(&mut world, (&bodies, &softs), (i, joint))?;
        }
        self.add_fluids(&mut world)?;
        for (i, schedule) in self.schedules.iter().enumerate() {
            let path = format!("schedules[{i}]");
            let body = self.find(&schedule.body, &bodies, &format!("{path}.body"))?;
            let forces = schedule.build(&path)?;
            world.add_schedule(body, forces).map_err(at(&path))?;
        }
        for (i, field) in self.fields.iter().enumerate() {
            let (path, built_in) = self.built_in(field, &bodies, i)?;
            world.add_shared_field(built_in.build().map_err(at(&path))?);
        }
        Ok(world)
    }

    fn set_up(&self, world: &mut World) -> Result<()> {
        let settings = &self.settings;
        world.set_gravity(self.gravity).map_err(at("."))?;
        check::not_negative("density", self.air.density).map_err(at("air"))?;
        world.set_air(self.air).map_err(at("air"))?;
        world.set_method(&settings.method).map_err(at("settings"))?;
        world.set_substeps(settings.substeps).map_err(at("settings"))?;
        world.set_closed_form(settings.closed_form);
        world.set_impact_law(settings.impact_law);
        world.set_solver(settings.solver);
        world.set_sleeping(settings.sleeping);
        for (i, pair) in settings.mixing.table.iter().enumerate() {
            let path = format!("settings.mixing.table[{i}]");
            self.material(&pair.a, &format!("{path}.a"))?;
            self.material(&pair.b, &format!("{path}.b"))?;
        }
        world.set_mixing(settings.mixing.clone()).map_err(at("settings.mixing"))?;
        world.set_clock(self.time, self.time_remainder).map_err(at("."))
    }

    fn check_what_no_world_knows(&self) -> Result<()> {
        for (name, material) in &self.materials {
            let &Material { density, friction, restitution, rolling_resistance } = material;
            let surface =
                SurfaceOverride { friction, restitution, rolling_resistance, ..Default::default() };
            check::not_negative("density", density.unwrap_or(0.0))
                .and_then(|_| surface.validated())
                .map_err(at(&format!("materials.{name}")))?;
        }
        check::positive("dt", self.run.dt).map_err(at("run"))?;
        check::not_negative("duration", self.run.duration).map_err(at("run"))?;
        Ok(())
    }

    fn add_body(&self, world: &mut World, i: usize, body: &SceneBody) -> Result<BodyHandle> {
        let path = format!("bodies[{i}]");
        let shapes = self.parts(body, &path)?;
        let def = BodyDef { shapes, ..body.def.clone() };
        let handle = world.add_body(def).map_err(at(&path))?;
        if let Some(center) = body.center_at {
            let mut body = world.body_mut(handle).map_err(at(&path))?;
            body.place_center_of_mass(center).map_err(at(&path))?;
        }
        Ok(handle)
    }

    fn add_joint(
        &self,
        world: &mut World,
        (bodies, softs): (&[BodyHandle], &[SoftHandle]),
        (i, joint): (usize, &SceneJoint),
    ) -> Result<()> {
        let path = format!("joints[{i}]");
        let mut pair = [None, None];
        for (side, (body, label)) in pair.iter_mut().zip(&joint.bodies).enumerate() {
            let find = |label| self.find(label, bodies, &format!("{path}.bodies[{side}]"));
            *body = label.as_ref().map(find).transpose()?;
        }
        let mut ends = [None, None];
        for (side, (soft, label)) in ends.iter_mut().zip(&joint.soft_bodies).enumerate() {
            let path = format!("{path}.soft_bodies[{side}]");
            let find = |label| soft::find(label, (&self.soft_bodies, softs), &path);
            *soft = label.as_ref().map(find).transpose()?;
        }
        let made = world
            .add_soft_joint(joint.def(pair), ends)
            .map_err(|error| joint.wrong(&path, &error))?;
        let made = world.joint_mut(made).map_err(at(&path))?;
        joint.state.resume(made, &format!("{path}.state"))
    }

    fn add_fluids(&self, world: &mut World) -> Result<()> {
        for (i, fluid) in self.fluids.iter().enumerate() {
            fluid.add(world, &format!("fluids[{i}]"))?;
        }
        if !self.drains.is_empty() {
            world.fluids_mut().set_drains(self.drains.clone());
        }
        let bodies = world.bodies().len();
        self.flow
            .as_ref()
            .map_or(Ok(()), |kept| world.fluids_mut().resume(kept, bodies).map_err(at("flow")))
    }

    /// The shapes of a body with their materials looked up.
    fn parts(&self, body: &SceneBody, path: &str) -> Result<Vec<Part>> {
        let usual = body.def.surface.material.as_ref();
        let usual =
            usual.map(|name| self.material(name, &format!("{path}.material"))).transpose()?;
        let part = |(j, part): (usize, &ScenePart)| {
            let path = format!("{path}.shapes[{j}]");
            let own = part.material.as_ref();
            let own =
                own.map(|name| self.material(name, &format!("{path}.material"))).transpose()?;
            let made = part.part(own.or(usual));
            check::not_negative("density", made.density.unwrap_or(0.0))
                .and_then(|_| made.surface.validated())
                .and_then(|()| made.role.unwrap_or_default().validated())
                .map_err(at(&path))?;
            Ok(made)
        };
        body.shapes.iter().enumerate().map(part).collect()
    }

    fn material(&self, name: &str, path: &str) -> Result<&Material> {
        self.materials.get(name).ok_or_else(|| {
            let known: Vec<_> = self.materials.keys().map(|known| format!("{known:?}")).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            wrong(path, format!("{name:?} is not in `materials`; there are: {known}"))
        })
    }

    /// The body that a label means.
    fn find(&self, label: &BodyLabel, bodies: &[BodyHandle], path: &str) -> Result<BodyHandle> {
        let index = match label {
            BodyLabel::Index(index) => *index,
            BodyLabel::Name(name) => {
                let named = |body: &SceneBody| body.def.name.as_ref() == Some(name);
                let mut found = (0..bodies.len()).filter(|i| named(&self.bodies[*i]));
                match (found.next(), found.next()) {
                    (Some(index), None) => index,
                    (None, _) => return Err(wrong(path, format!("no body is called {name:?}"))),
                    (Some(a), Some(b)) => {
                        let message = format!(
                            "bodies {a} and {b} are both called {name:?}; give the place instead"
                        );
                        return Err(wrong(path, message));
                    }
                }
            }
        };
        let outside =
            || wrong(path, format!("there is no body {index}; there are {}", bodies.len()));
        bodies.get(index).copied().ok_or_else(outside)
    }

    /// A field with the body it acts on looked up, and its path.
    fn built_in(
        &self,
        field: &SceneField,
        bodies: &[BodyHandle],
        i: usize,
    ) -> Result<(String, BuiltInField)> {
        Ok(match field.clone() {
            SceneField::Central(own) => {
                (format!("fields[{i}].central"), BuiltInField::Central(own))
            }
            SceneField::Attraction(own) => {
                (format!("fields[{i}].attraction"), BuiltInField::Attraction(own))
            }
            SceneField::Oscillating(own) => {
                let path = format!("fields[{i}].oscillating");
                let body = self.find(&own.body, bodies, &format!("{path}.body"))?;
                let (force, torque, hertz, phase) = (own.force, own.torque, own.hertz, own.phase);
                let oscillating = Oscillating { body, force, torque, hertz, phase };
                (path, BuiltInField::Oscillating(oscillating))
            }
        })
    }
}

impl SceneSchedule {
    fn build(&self, path: &str) -> Result<ForceSchedule> {
        let spans = self.times.len().saturating_sub(1);
        for (key, count) in [("forces", self.forces.len()), ("torques", self.torques.len())] {
            if count != 0 && count != spans {
                let message =
                    format!("{count} for {} times; allowed: {spans}, or none", self.times.len());
                return Err(wrong(format!("{path}.{key}"), message));
            }
        }
        let last = self.times.len().saturating_sub(1);
        let endless = self.times.iter().position(Option::is_none).filter(|k| *k != last);
        if let Some(k) = endless {
            let message = "null (for ever) is allowed only as the last time";
            return Err(wrong(format!("{path}.times[{k}]"), message));
        }
        let times = self.times.iter().map(|time| time.unwrap_or(Real::INFINITY)).collect();
        let wrench = |k: usize| {
            let force = self.forces.get(k).copied().unwrap_or(Vec2::zeros());
            Wrench::new(force, self.torques.get(k).copied().unwrap_or(0.0))
        };
        ForceSchedule::new(times, (0..spans).map(wrench).collect())
            .map_err(|error| wrong(path, error))
    }
}

/// An error of the engine's as one about a path: that of the field it names, where it names one.
pub(super) fn at(path: &str) -> impl Fn(Error) -> Error + '_ {
    move |error| {
        let field = match &error {
            Error::Invalid { what, .. } if is_key(what) => what.as_str(),
            _ => "",
        };
        let path = match (path, field) {
            (path, "") => path.to_owned(),
            (".", field) => field.to_owned(),
            (path, field) => format!("{path}.{field}"),
        };
        wrong(path, error)
    }
}

fn is_key(what: &str) -> bool {
    what.chars().all(|c| c.is_ascii_lowercase() || c == '_')
}
