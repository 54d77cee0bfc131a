//! Box2D 3, through its safe bindings.

use boxdd::filter::Filter;
use boxdd::shapes::{capsule, circle, segment};
use boxdd::{BodyId, BodyType, Foundation, Polygon, ShapeDef, SurfaceMaterial, Transform, World};
use culbuto::body::BodyKind;
use culbuto::math::{Pose, Real, Vec2, vec2};

use super::{Engine, State};
use crate::Result;
use crate::scene::{Body, Scene, Shape};

pub struct Box2d {
    world: World,
    bodies: Vec<BodyId>,
    /// Its unit of length (m). Its own setting can be made but once in a process, so lengths are handed over in it.
    unit: Real,
}

/// It computes in single precision.
fn number(x: Real) -> f32 {
    x as f32
}

fn pair(v: Vec2) -> [f32; 2] {
    [number(v.x), number(v.y)]
}

fn add_shape(body: &mut boxdd::Body<'_>, def: &ShapeDef, declared: &Shape) -> Result<()> {
    match *declared {
        Shape::Circle { center, radius } => {
            body.create_circle(def, &circle(pair(center), number(radius))?)?
        }
        Shape::Box { center, half } => {
            let place = Transform::from_pos_angle(pair(center), 0.0)?;
            let polygon = Polygon::offset_box_polygon(number(half.x), number(half.y), place)?;
            body.create_polygon(def, &polygon)?
        }
        Shape::Polygon { ref vertices } => {
            let polygon = Polygon::from_points(vertices.iter().copied().map(pair), 0.0)?;
            body.create_polygon(def, &polygon)?
        }
        Shape::Capsule { a, b, radius } => {
            body.create_capsule(def, &capsule(pair(a), pair(b), number(radius))?)?
        }
        Shape::Segment { a, b } => body.create_segment(def, &segment(pair(a), pair(b))?)?,
    };
    Ok(())
}

fn add_body(world: &mut World, scene: &Scene, declared: &Body) -> Result<BodyId> {
    let def = world
        .body_builder()
        .body_type(match declared.kind {
            BodyKind::Static => BodyType::Static,
            BodyKind::Kinematic => BodyType::Kinematic,
            BodyKind::Dynamic => BodyType::Dynamic,
        })
        .position(pair(declared.position))
        .angle(number(declared.angle))
        .linear_velocity(pair(declared.velocity))
        .angular_velocity(number(declared.angular_velocity))
        .allow_fast_rotation(true) // else it caps the angular velocity
        .awake(!(declared.asleep && scene.sleeping))
        .build()?;
    let material = SurfaceMaterial::new()
        .with_friction(number(scene.friction))?
        .with_restitution(number(scene.restitution))?;
    let filter = Filter { group_index: -i32::from(declared.group), ..Filter::default() };
    let density = number(declared.density);
    let shape = ShapeDef::builder().material(material).density(density).filter(filter).build()?;
    let id = world.create_body(def)?;
    let mut body = world.body(id)?;
    declared.shapes.iter().try_for_each(|part| add_shape(&mut body, &shape, part))?;
    Ok(id)
}

fn add_joint(world: &mut World, scene: &Scene, k: usize, bodies: &[BodyId]) -> Result<()> {
    let declared = &scene.joints[k];
    let [a, b] = declared.bodies.map(|body| bodies[body]);
    let [first, second] = [0, 1].map(|side| {
        let body = &scene.bodies[declared.bodies[side]];
        let frame = Pose { position: body.position, angle: body.angle };
        pair(frame.apply(declared.anchors[side]))
    });
    if let Some(length) = declared.distance {
        let rod = world.distance(a, b).anchors_world(first, second).length(number(length));
        let mut rod = rod.collide_connected(false);
        if let Some(spring) = declared.spring {
            rod = rod.spring(number(spring.hertz), number(spring.damping_ratio));
        }
        rod.build()?;
        return Ok(());
    }
    let mut hinge = world.revolute(a, b).anchor_world(first).collide_connected(false);
    if let Some([low, high]) = declared.limits {
        hinge = hinge.limit(number(low), number(high));
    }
    if let Some(spring) = declared.spring {
        hinge = hinge.spring(number(spring.hertz), number(spring.damping_ratio));
    }
    hinge.build()?;
    Ok(())
}

impl Engine for Box2d {
    fn build(scene: &Scene) -> Result<Self> {
        let unit = scene.size.unwrap_or(1.0);
        let scene = &scene.in_units_of(unit);
        let foundation = match Foundation::get() {
            Some(foundation) => foundation,
            None => Foundation::initialize_default()?,
        };
        let builder = foundation.world_builder();
        let def = builder.gravity(pair(scene.gravity)).enable_sleep(scene.sleeping).build()?;
        let mut world = foundation.create_world(def)?;
        let bodies = scene.bodies.iter().map(|body| add_body(&mut world, scene, body));
        let bodies = bodies.collect::<Result<Vec<_>>>()?;
        for k in 0..scene.joints.len() {
            add_joint(&mut world, scene, k, &bodies)?;
        }
        Ok(Self { world, bodies, unit })
    }

    fn steer(&mut self, body: usize, velocity: Vec2) -> Result<()> {
        let body = self.bodies[body];
        Ok(self.world.body(body)?.set_linear_velocity(pair(velocity / self.unit))?)
    }

    fn step(&mut self, scene: &Scene) -> Result<()> {
        let substeps = i32::try_from(scene.substeps)?;
        let done = self.world.step(number(scene.dt), substeps)?;
        done.post_step_error().map_or(Ok(()), |error| Err(error.into()))
    }

    fn state(&mut self) -> Result<Vec<State>> {
        let (world, unit) = (&mut self.world, self.unit);
        let state = |&id| {
            let body = world.body(id)?;
            let (place, velocity) = (body.position()?, body.linear_velocity()?);
            Ok(State {
                position: vec2(place.x.into(), place.y.into()) * unit,
                angle: body.rotation()?.angle().into(),
                velocity: vec2(velocity.x.into(), velocity.y.into()) * unit,
                angular_velocity: body.angular_velocity()?.into(),
            })
        };
        self.bodies.iter().map(state).collect()
    }
}
