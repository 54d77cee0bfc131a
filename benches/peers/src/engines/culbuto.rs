//! Culbuto.

use culbuto::body::{BodyDef, Filter, Friction, Part, Surface};
use culbuto::joint::{self, Hold, JointDef, JointKind, Travel};
use culbuto::math::{Twist, Vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::solvers::Solver;
use culbuto::{BodyHandle, World};

use super::{Engine, State};
use crate::Result;
use crate::scene::{Body, Joint, Scene, Shape as Declared};

/// All rows of a group at once, or by sweeps.
pub struct Culbuto<const AT_ONCE: bool> {
    world: World,
    handles: Vec<BodyHandle>,
}

fn shape(declared: &Declared) -> Result<Shape> {
    Ok(match *declared {
        Declared::Circle { center, radius } => Shape::new(ShapeDef::Circle { radius, center })?,
        Declared::Box { center, half } => {
            let (width, height) = (2.0 * half.x, 2.0 * half.y);
            Shape::new(ShapeDef::Box { width, height, center, angle: 0.0 })?
        }
        Declared::Polygon { ref vertices } => Shape::polygon(vertices)?,
        Declared::Capsule { a, b, radius } => Shape::capsule(a, b, radius)?,
        Declared::Segment { a, b } => Shape::segment(a, b)?,
    })
}

fn def(body: &Body, surface: &Surface) -> Result<BodyDef> {
    let parts = body.shapes.iter().map(|declared| shape(declared).map(Part::from));
    Ok(BodyDef {
        kind: body.kind,
        position: body.position,
        angle: body.angle,
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
        shapes: parts.collect::<Result<_>>()?,
        density: body.density,
        surface: surface.clone(),
        filter: Filter { group: -i32::from(body.group), ..Filter::default() },
        ..BodyDef::default()
    })
}

fn tie(declared: &Joint, handles: &[BodyHandle]) -> JointDef {
    let spring = declared.spring.map(|s| joint::Spring::new(s.hertz, s.damping_ratio));
    let travel = Travel { limits: declared.limits, spring, ..Travel::default() };
    let [a, b] = declared.bodies.map(|k| handles[k]);
    let [at_a, at_b] = declared.anchors;
    let kind = match declared.distance {
        None => JointKind::Revolute { angle: Some(0.0), travel },
        length => {
            let hold = spring.map_or(Hold::Rigid, Hold::Spring);
            JointKind::Distance { length, hold, min: 0.0, max: None }
        }
    };
    JointDef::new(a, b, kind).anchored_locally(at_a, at_b)
}

impl<const AT_ONCE: bool> Engine for Culbuto<AT_ONCE> {
    fn build(scene: &Scene) -> Result<Self> {
        let mut world = World::new(scene.gravity)?;
        world.set_substeps(scene.substeps)?;
        if AT_ONCE {
            world.set_solver(Solver::Newton);
        }
        world.set_sleeping(scene.sleeping); // it has no body that starts asleep
        let surface = Surface {
            friction: Friction::of(scene.friction),
            restitution: scene.restitution,
            ..Surface::default()
        };
        let handles = scene.bodies.iter().map(|body| Ok(world.add_body(def(body, &surface)?)?));
        let handles = handles.collect::<Result<Vec<_>>>()?;
        for declared in &scene.joints {
            world.add_joint(tie(declared, &handles))?;
        }
        Ok(Self { world, handles })
    }

    fn steer(&mut self, body: usize, velocity: Vec2) -> Result<()> {
        let twist = Twist::new(velocity, 0.0);
        Ok(self.world.body_mut(self.handles[body])?.set_twist(twist)?)
    }

    fn step(&mut self, scene: &Scene) -> Result<()> {
        Ok(self.world.step(scene.dt)?)
    }

    fn state(&mut self) -> Result<Vec<State>> {
        let state = |&handle| {
            let body = self.world.body(handle)?;
            Ok(State {
                position: body.position(),
                angle: body.angle(),
                velocity: body.velocity(),
                angular_velocity: body.angular_velocity(),
            })
        };
        self.handles.iter().map(state).collect()
    }
}
