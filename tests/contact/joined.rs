//! Impacts on bodies that are joined: what they strike feels all that hangs on them.

use culbuto::body::Friction;
use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, JointDef, World};

/// Without friction or loss.
fn elastic(mut def: BodyDef) -> BodyDef {
    (def.surface.restitution, def.surface.friction) = (1.0, Friction::of(0.0));
    def
}

/// A rod of 1 m that turns clockwise by 1 rad/s about a pin at its end, the origin.
fn pinned_rod(world: &mut World) -> BodyHandle {
    let rod = BodyDef {
        position: vec2(0.5, 0.0),
        velocity: vec2(0.0, -0.5),
        angular_velocity: -1.0,
        ..BodyDef::new(Shape::rectangle(1.0, 0.1).unwrap())
    };
    let rod = world.add_body(elastic(rod)).unwrap();
    world.add_joint(JointDef::revolute(None, rod).at(vec2(0.0, 0.0))).unwrap();
    rod
}

#[test]
fn a_pinned_rod_bounces_off_a_wall_as_fast_as_it_came() {
    let mut world = World::default();
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    let wall = BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.0, -1.0),
        ..BodyDef::new(Shape::rectangle(4.0, 1.0).unwrap())
    };
    world.add_body(elastic(wall)).unwrap();
    let rod = pinned_rod(&mut world);
    world.steps(1.0 / 60.0, 12).unwrap();
    let before = world.body(rod).unwrap().angular_velocity();
    world.steps(1.0 / 60.0, 60).unwrap();
    let after = world.body(rod).unwrap().angular_velocity();
    // As a free rod it would keep 0.44 of its spin. What is left is by the turn in half a substep, (ωh/2)² = 4e-6.
    assert!((after + before).abs() < 4e-6, "{before} {after}");
}

#[test]
fn a_pinned_rod_and_a_ball_keep_energy_and_angular_momentum_about_the_pin() {
    let mut world = World::default();
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    let rod = pinned_rod(&mut world);
    let ball = BodyDef { position: vec2(0.8, -0.5), ..BodyDef::new(Shape::circle(0.1).unwrap()) };
    world.add_body(elastic(ball)).unwrap();
    let measure = |world: &World| -> (Real, Real) {
        (world.energy().unwrap().kinetic, world.angular_momentum(vec2(0.0, 0.0)))
    };
    world.steps(1.0 / 60.0, 12).unwrap();
    let (energy, momentum) = measure(&world);
    world.steps(1.0 / 60.0, 60).unwrap();
    let (later, turned) = measure(&world);
    assert!(world.body(rod).unwrap().angular_velocity() > -0.2, "it struck the ball");
    // By the turn in half a substep, (ωh/2)² = 4e-6.
    assert!((later / energy - 1.0).abs() < 4e-6, "{energy} {later}");
    assert!((turned / momentum - 1.0).abs() < 4e-6, "{momentum} {turned}");
}
