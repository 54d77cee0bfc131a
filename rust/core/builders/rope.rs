//! Ropes.

use super::Assembly;
use super::line::{End, Hinges, Layout, Line};
use super::plan::{Plan, Side};
use crate::body::BodyDef;
use crate::error::{Error, Result, check};
use crate::joint::{Coefficients, Given, Hold, JointDef, JointKind, Spring, Travel};
use crate::math::{Real, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// What a rope consists of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RopeForm {
    /// Capsules hinged end to end, which touch what is around them.
    Links {
        /// Half the rope's thickness (m); none: a tenth of a link's length.
        radius: Option<Real>,
    },
    /// Points with rods between them, which touch nothing: a link's mass is shared by its two ends.
    Points,
}

/// A rope.
///
/// It is laid out straight if it is as long as its ends are apart, else on an arc that hangs down.
#[derive(Clone, Debug, PartialEq)]
pub struct RopeDef {
    /// Bodies are called "`name` 0" and so on, joints "`name` joint 0".
    pub name: String,
    /// Where it begins and ends.
    pub ends: [End; 2],
    /// Length (m); none: as far as the ends are apart, and a thousandth more where both are fixed.
    pub length: Option<Real>,
    /// Number of links.
    pub links: usize,
    /// Mass per length (kg/m).
    pub mass_per_length: Real,
    /// What it consists of.
    pub form: RopeForm,
    /// Bending stiffness EI (N·m²) and its damping (N·m²·s), which draw it straight: a hinge has them over the length of a
    /// link. None: it bends freely. Only for links.
    pub bending: Option<Coefficients>,
    /// Force (N) above which a joint breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Surface, filter, damping and the like of all links. Place, shape and mass come from the rope.
    pub body: BodyDef,
}

impl RopeDef {
    /// Twenty links of 1 kg/m from one end to the other.
    #[must_use]
    pub fn new(ends: [End; 2]) -> Self {
        Self {
            name: "rope".into(),
            ends,
            length: None,
            links: 20,
            mass_per_length: 1.0,
            form: RopeForm::Links { radius: None },
            bending: None,
            breaking_force: None,
            body: BodyDef::default(),
        }
    }

    /// Adds the rope.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not allowed, among them a length below the distance of the ends, or no
    /// slack between fixed ones;
    /// [`Error::StaleHandle`] for a body that is gone. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Assembly> {
        check::positive("mass_per_length", self.mass_per_length)?;
        let layout = Layout { ends: self.ends, length: self.length, count: self.links };
        let line = layout.line(world)?;
        let mut plan = Plan::default();
        match self.form {
            RopeForm::Links { radius } => self.plan_links(&line, radius, &mut plan)?,
            RopeForm::Points => self.plan_points(&line, &mut plan)?,
        }
        plan.add(world)
    }

    fn plan_links(&self, line: &Line, radius: Option<Real>, plan: &mut Plan) -> Result<()> {
        let half = vec2(0.5 * line.pitch, 0.0);
        let shape = Shape::capsule(-half, half, radius.unwrap_or(0.1 * line.pitch))?;
        let spring = self.bending.map(|Coefficients { stiffness, damping }| {
            let [stiffness, damping] = [stiffness, damping].map(|whole| whole / line.pitch);
            Spring::Constants(Coefficients { stiffness, damping })
        });
        let (name, ends, breaking_force) = (self.name.as_str(), self.ends, self.breaking_force);
        line.hinge(plan, &Hinges { name, ends, spring, breaking_force }, |_| BodyDef {
            shapes: vec![shape.clone().into()],
            mass: Some(self.mass_per_length * line.pitch),
            ..self.body.clone()
        });
        Ok(())
    }

    fn plan_points(&self, line: &Line, plan: &mut Plan) -> Result<()> {
        if self.bending.is_some() {
            return Err(Error::invalid("bending", "given", "none for a rope of points, or links"));
        }
        let last = line.points.len() - 1;
        let link = self.mass_per_length * line.pitch;
        let points: Vec<Side> = (line.points.iter().enumerate())
            .map(|(k, point)| {
                plan.body(BodyDef {
                    name: Some(format!("{} {k}", self.name)),
                    position: *point,
                    mass: Some(if k == 0 || k == last { 0.5 * link } else { link }),
                    ..self.body.clone()
                })
            })
            .collect();
        let own = Given::Local(vec2(0.0, 0.0));
        let joint = |name: String, kind: JointKind, anchors: [Given; 2]| JointDef {
            name: Some(name),
            anchors,
            breaking_force: self.breaking_force,
            ..JointDef::new(None, None, kind)
        };
        for (k, pair) in points.windows(2).enumerate() {
            let name = format!("{} joint {k}", self.name);
            let length = Some(line.pitch);
            let rod = JointKind::Distance { length, hold: Hold::Rigid, min: 0.0, max: None };
            plan.joint([pair[0], pair[1]], joint(name, rod, [own, own]));
        }
        for (end, (point, which)) in
            self.ends.iter().zip([(points[0], "first"), (points[last], "last")])
        {
            if let Some((side, at)) = end.hold() {
                let name = format!("{} {which} end", self.name);
                let pin = JointKind::Revolute { angle: None, travel: Travel::default() };
                plan.joint([side, point], joint(name, pin, [at, own]));
            }
        }
        Ok(())
    }
}
