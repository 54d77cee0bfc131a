//! Rapier; which of its crates, the parent says.

use culbuto::body::BodyKind;
use culbuto::math::{Real, Vec2, vec2};

use super::engine::math::Real as Number;
use super::engine::prelude::{
    ColliderBuilder, Group, InteractionGroups, InteractionTestMode, MotorModel, PhysicsWorld,
    RevoluteJointBuilder, RigidBody, RigidBodyBuilder, RigidBodyHandle, RopeJointBuilder,
    SpringJointBuilder, Vector,
};
use crate::Result;
use crate::engines::{Engine, State};
use crate::scene::{Body, Joint, Scene, Shape, Spring};

pub struct Rapier {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
}

// In one of the two crates their numbers are ours already.
#[allow(clippy::unnecessary_cast)]
fn number(x: Real) -> Number {
    x as Number
}

#[allow(clippy::useless_conversion)]
fn real(x: Number) -> Real {
    x.into()
}

fn vector(v: Vec2) -> Vector {
    Vector::new(number(v.x), number(v.y))
}

fn shape(declared: &Shape) -> Result<ColliderBuilder> {
    Ok(match *declared {
        Shape::Circle { center, radius } => {
            ColliderBuilder::ball(number(radius)).translation(vector(center))
        }
        Shape::Box { center, half } => {
            ColliderBuilder::cuboid(number(half.x), number(half.y)).translation(vector(center))
        }
        Shape::Polygon { ref vertices } => {
            ColliderBuilder::convex_polyline(vertices.iter().copied().map(vector).collect())
                .ok_or("not a convex polygon")?
        }
        Shape::Capsule { a, b, radius } => {
            ColliderBuilder::capsule_from_endpoints(vector(a), vector(b), number(radius))
        }
        Shape::Segment { a, b } => ColliderBuilder::segment(vector(a), vector(b)),
    })
}

fn body(body: &Body, sleeping: bool) -> RigidBody {
    let builder = match body.kind {
        BodyKind::Static => RigidBodyBuilder::fixed(),
        BodyKind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
        BodyKind::Dynamic => RigidBodyBuilder::dynamic(),
    };
    builder
        .translation(vector(body.position))
        .rotation(number(body.angle))
        .linvel(vector(body.velocity))
        .angvel(number(body.angular_velocity))
        .allow_fast_rotation(true) // else it caps the angular velocity
        .can_sleep(sleeping)
        .sleeping(sleeping && body.asleep)
        .build()
}

/// A bit for each group, and no such bit in its own filter.
fn groups(group: u8) -> InteractionGroups {
    let own = Group::from_bits_retain(1 << group);
    let filter = if group == 0 { Group::ALL } else { !own };
    InteractionGroups::new(own, filter, InteractionTestMode::And)
}

fn hinge(declared: &Joint) -> RevoluteJointBuilder {
    let [a, b] = declared.anchors.map(vector);
    let mut hinge =
        RevoluteJointBuilder::new().contacts_enabled(false).local_anchor1(a).local_anchor2(b);
    if let Some(limits) = declared.limits {
        hinge = hinge.limits(limits.map(number));
    }
    if let Some(spring) = declared.spring {
        hinge = hinge.motor_model(MotorModel::ForceBased).motor_position(
            0.0,
            number(spring.stiffness),
            number(spring.damping),
        );
    }
    hinge
}

/// It has no rod; what pulls on one all the time does not notice.
fn rope(declared: &Joint, length: Number) -> RopeJointBuilder {
    let [a, b] = declared.anchors.map(vector);
    RopeJointBuilder::new(length).contacts_enabled(false).local_anchor1(a).local_anchor2(b)
}

fn spring(declared: &Joint, length: Number, by: &Spring) -> SpringJointBuilder {
    let [a, b] = declared.anchors.map(vector);
    SpringJointBuilder::new(length, number(by.stiffness), number(by.damping))
        .contacts_enabled(false)
        .local_anchor1(a)
        .local_anchor2(b)
}

impl Engine for Rapier {
    fn build(scene: &Scene) -> Result<Self> {
        let mut world = PhysicsWorld { gravity: vector(scene.gravity), ..PhysicsWorld::default() };
        // Contacts of pairs that hardly moved are used again, as in Box2D: the default of both.
        world.integration_parameters.contact_recycling = true;
        world.integration_parameters.num_solver_iterations = scene.substeps as usize;
        if let Some(size) = scene.size {
            world.integration_parameters.length_unit = number(size);
        }
        let mut handles = Vec::with_capacity(scene.bodies.len());
        for declared in &scene.bodies {
            let handle = world.insert_body(body(declared, scene.sleeping));
            for part in &declared.shapes {
                let collider = shape(part)?
                    .density(number(declared.density))
                    .friction(number(scene.friction))
                    .restitution(number(scene.restitution))
                    .collision_groups(groups(declared.group));
                world.insert_collider(collider, Some(handle));
            }
            handles.push(handle);
        }
        for declared in &scene.joints {
            let [a, b] = declared.bodies.map(|k| handles[k]);
            match (declared.distance, declared.spring) {
                (None, _) => world.insert_impulse_joint(a, b, hinge(declared)),
                (Some(length), None) => {
                    world.insert_impulse_joint(a, b, rope(declared, number(length)))
                }
                (Some(length), Some(by)) => {
                    world.insert_impulse_joint(a, b, spring(declared, number(length), &by))
                }
            };
        }
        Ok(Self { world, handles })
    }

    fn steer(&mut self, body: usize, velocity: Vec2) -> Result<()> {
        self.world.bodies[self.handles[body]].set_linvel(vector(velocity), true);
        Ok(())
    }

    fn step(&mut self, scene: &Scene) -> Result<()> {
        self.world.integration_parameters.dt = number(scene.dt);
        self.world.step();
        Ok(())
    }

    fn state(&mut self) -> Result<Vec<State>> {
        let state = |&handle: &RigidBodyHandle| {
            let body: &RigidBody = &self.world.bodies[handle];
            let (place, velocity) = (body.translation(), body.linvel());
            State {
                position: vec2(real(place.x), real(place.y)),
                angle: real(body.rotation().angle()),
                velocity: vec2(real(velocity.x), real(velocity.y)),
                angular_velocity: real(body.angvel()),
            }
        };
        Ok(self.handles.iter().map(state).collect())
    }
}
