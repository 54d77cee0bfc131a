//! Any row of calls, good and bad, leaves a sound world.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::body::{BodyKind, Locks};
use culbuto::forces::Air;
use culbuto::joint::{Hold, JointDef, JointHandle, JointKind, Motor, Spring, Travel};
use culbuto::math::{Real, Twist, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::world::{BodyMut, Snapshot};
use culbuto::{BodyDef, BodyHandle, Error, World};
use proptest::prelude::*;
use worlds::{Righting, bytes};

/// What can be done to a world, with numbers good and bad.
#[derive(Clone, Debug)]
enum Action {
    Add { name: u8, place: Vec2, mass: Real },
    Remove(prop::sample::Index),
    Edit(prop::sample::Index, Edit),
    Join(prop::sample::Index, Option<prop::sample::Index>, JointKind, bool),
    Part(prop::sample::Index),
    Change(prop::sample::Index, JointKind, Real),
    Air(Real),
    Field(bool),
    Step(Real),
    Advance(Real),
    Keep,
    Restore,
}

/// What can be done to a body.
#[derive(Clone, Debug)]
enum Edit {
    Place(Vec2),
    Speed(Twist),
    Weigh(Real),
    Push(Vec2),
    Hit(Vec2),
    Lock(bool),
    Kind(BodyKind),
}

/// Mostly ordinary numbers.
fn number() -> impl Strategy<Value = Real> {
    prop_oneof![
        12 => -5.0..5.0,
        1 => prop::sample::select(vec![0.0, -0.0, Real::NAN, Real::INFINITY, 1e300, -1e300, 1e-300]),
    ]
}

fn vector() -> impl Strategy<Value = Vec2> {
    (number(), number()).prop_map(|(x, y)| vec2(x, y))
}

fn positive() -> impl Strategy<Value = Real> {
    number().prop_map(Real::abs)
}

fn edits() -> impl Strategy<Value = Edit> {
    let kinds = vec![BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic];
    prop_oneof![
        vector().prop_map(Edit::Place),
        (vector(), number()).prop_map(|(v, w)| Edit::Speed(Twist::new(v, w))),
        positive().prop_map(Edit::Weigh),
        vector().prop_map(Edit::Push),
        vector().prop_map(Edit::Hit),
        any::<bool>().prop_map(Edit::Lock),
        prop::sample::select(kinds).prop_map(Edit::Kind),
    ]
}

/// Kinds of joints, with numbers good and bad.
fn kinds() -> impl Strategy<Value = JointKind> {
    let hold = || {
        prop_oneof![
            Just(Hold::Rigid),
            Just(Hold::Free),
            (positive(), positive()).prop_map(|(hertz, damping_ratio)| Hold::Spring(
                Spring::Frequency { hertz, damping_ratio }
            )),
        ]
    };
    let motor = (number(), positive()).prop_map(|(speed, max)| Motor { speed, max: Some(max) });
    let travel = (prop::option::of(motor), prop::option::of((number(), number()))).prop_map(
        |(motor, limits)| Travel {
            motor,
            limits: limits.map(|(low, high)| [low, high]),
            ..Travel::default()
        },
    );
    prop_oneof![
        (hold(), positive()).prop_map(|(hold, max)| JointKind::Distance {
            length: None,
            hold,
            min: 0.0,
            max: Some(max),
        }),
        travel.prop_map(|travel| JointKind::Revolute { angle: None, travel }),
        (hold(), hold()).prop_map(|(linear, angular)| JointKind::Weld {
            angle: None,
            linear,
            angular
        }),
        (hold(), positive()).prop_map(|(hold, max)| JointKind::Grab { hold, max_force: Some(max) }),
        number().prop_map(|ratio| JointKind::Gear { ratio, phase: None }),
        number().prop_map(|step| JointKind::Ratchet { step, phase: 0.1 }),
        Just(JointKind::Filter),
    ]
}

fn actions() -> impl Strategy<Value = Action> {
    let which = any::<prop::sample::Index>;
    let add = (any::<u8>(), vector(), positive());
    prop_oneof![
        4 => add.prop_map(|(name, place, mass)| Action::Add { name, place, mass }),
        2 => which().prop_map(Action::Remove),
        7 => (which(), edits()).prop_map(|(i, edit)| Action::Edit(i, edit)),
        3 => (which(), prop::option::of(which()), kinds(), any::<bool>())
            .prop_map(|(a, b, kind, touch)| Action::Join(a, b, kind, touch)),
        1 => which().prop_map(Action::Part),
        2 => (which(), kinds(), positive()).prop_map(|(i, kind, most)| Action::Change(i, kind, most)),
        1 => positive().prop_map(Action::Air),
        1 => any::<bool>().prop_map(Action::Field),
        3 => number().prop_map(|x| Action::Step(x / 50.0)),
        1 => number().prop_map(|x| Action::Advance(x / 50.0)),
        1 => Just(Action::Keep),
        1 => Just(Action::Restore),
    ]
}

/// What must be true of a world: who is in it, in which order, and the time.
#[derive(Clone, Debug, Default, PartialEq)]
struct Model {
    bodies: Vec<(BodyHandle, String)>,
    gone: Vec<BodyHandle>,
    joints: Vec<(JointHandle, [Option<BodyHandle>; 2])>,
    time: Real,
}

impl Model {
    /// Those that broke in the last call are no longer there.
    fn forget_broken(&mut self, world: &World) {
        for broken in world.broken_joints() {
            self.joints.retain(|joint| joint.0 != broken.joint);
        }
    }
}

fn edit_body(edit: &Edit, mut body: BodyMut<'_>) -> Result<(), Error> {
    match edit {
        Edit::Place(to) => body.set_position(*to),
        Edit::Speed(to) => body.set_twist(*to),
        Edit::Weigh(mass) => body.set_mass(Some(*mass)),
        Edit::Push(force) => body.apply_force(*force, Some(*force)),
        Edit::Hit(impulse) => body.apply_impulse(*impulse, None),
        Edit::Lock(x) => body.set_locks(Locks { x: *x, ..Locks::default() }),
        Edit::Kind(kind) => body.set_kind(*kind),
    }
}

fn body_of(model: &Model, i: &prop::sample::Index) -> Option<BodyHandle> {
    (!model.bodies.is_empty()).then(|| i.get(&model.bodies).0)
}

/// Does to joints what it says, to the model too.
fn perform_on_joints(action: &Action, world: &mut World, model: &mut Model) -> Result<(), Error> {
    match action {
        Action::Join(a, b, kind, collide_connected) => {
            if let Some(body) = body_of(model, a) {
                let bodies = [b.as_ref().and_then(|b| body_of(model, b)), Some(body)];
                let def = JointDef::new(bodies[0], bodies[1], *kind);
                let def = JointDef { collide_connected: *collide_connected, ..def };
                model.joints.push((world.add_joint(def)?, bodies));
            }
        }
        Action::Part(i) if !model.joints.is_empty() => {
            let joint = i.get(&model.joints).0;
            world.remove_joint(joint)?;
            model.joints.retain(|own| own.0 != joint);
        }
        Action::Change(i, kind, most) if !model.joints.is_empty() => {
            world.edit_joint(i.get(&model.joints).0, |def| {
                def.kind = *kind;
                def.breaking_force = Some(*most);
            })?;
        }
        _ => {}
    }
    Ok(())
}

/// Does it, to the model too where the world agrees; an action on a body or a joint is none where there is none.
fn perform(
    action: &Action,
    world: &mut World,
    model: &mut Model,
    kept: &mut Option<(Snapshot, Model)>,
) -> Result<(), Error> {
    match action {
        Action::Add { name, place, mass } => {
            let name = format!("body {name}");
            let shape = Shape::rectangle(1.0, 0.3).unwrap();
            let def = BodyDef {
                name: Some(name.clone()),
                position: *place,
                mass: Some(*mass),
                ..BodyDef::new(shape)
            };
            model.bodies.push((world.add_body(def)?, name));
        }
        Action::Remove(i) => {
            if let Some(body) = body_of(model, i) {
                world.remove_body(body)?;
                let place = model.bodies.iter().position(|entry| entry.0 == body).unwrap();
                model.bodies.swap_remove(place);
                model.gone.push(body);
                model.joints.retain(|joint| !joint.1.contains(&Some(body)));
            }
        }
        Action::Edit(i, edit) => {
            if let Some(body) = body_of(model, i) {
                edit_body(edit, world.body_mut(body)?)?;
            }
        }
        Action::Join(..) | Action::Part(_) | Action::Change(..) => {
            perform_on_joints(action, world, model)?;
        }
        Action::Air(density) => world.set_air(Air { density: *density, wind: vec2(0.3, 0.0) })?,
        Action::Field(true) => drop(world.add_field(Righting { strength: 2.0 })),
        Action::Field(false) => {
            if let Some(&field) = world.field_handles().last() {
                world.remove_field(field)?;
            }
        }
        Action::Step(dt) => {
            world.step(*dt)?;
            model.forget_broken(world);
            model.time += dt;
        }
        Action::Advance(duration) => {
            world.advance(*duration, 1e-6)?;
            model.forget_broken(world);
            model.time += duration;
        }
        Action::Keep => *kept = Some((world.snapshot(), model.clone())),
        Action::Restore => {
            if let Some((snapshot, then)) = kept {
                world.restore(snapshot);
                // Bodies added since are strangers to the world of then.
                *model = then.clone();
            }
        }
    }
    Ok(())
}

/// The world as bytes, the user's own fields told only by their number.
fn agree(world: &World, model: &Model) -> Result<(), TestCaseError> {
    let handles: Vec<_> = model.bodies.iter().map(|entry| entry.0).collect();
    prop_assert_eq!(world.bodies().handles(), &handles[..]);
    for (body, name) in &model.bodies {
        let body = world.body(*body).unwrap();
        prop_assert_eq!(body.info().def.name.as_ref(), Some(name));
        let (pose, twist) = (body.pose(), body.twist());
        prop_assert!(pose.position.iter().chain(&twist.linear).all(|x| x.is_finite()));
        prop_assert!(pose.angle.is_finite() && twist.angular.is_finite());
        if body.info().def.kind == BodyKind::Static {
            prop_assert_eq!(twist, Twist::ZERO);
        }
    }
    let mut joints: Vec<_> = world.joint_handles().to_vec();
    let mut known: Vec<_> = model.joints.iter().map(|joint| joint.0).collect();
    joints.sort_by_key(|joint| format!("{joint:?}"));
    known.sort_by_key(|joint| format!("{joint:?}"));
    prop_assert_eq!(joints, known);
    for joint in world.joint_handles() {
        let joint = world.joint(*joint).unwrap();
        // Of masses of 1e300 kg forces are numbers, their squares none.
        prop_assert!(joint.reaction().force.iter().all(|x| x.is_finite()));
        prop_assert!(joint.gap() >= 0.0);
    }
    for body in &model.gone {
        prop_assert!(world.body(*body).is_err());
    }
    prop_assert!((world.time() - model.time).abs() <= 1e-12 * (1.0 + model.time.abs()));
    Ok(())
}

proptest! {
    /// Whatever is done, in whatever order: the world agrees with the model, what fails changes nothing,
    /// and a world that is restored goes on as the one that was kept.
    #[test]
    fn any_row_of_calls_leaves_a_sound_world(actions in prop::collection::vec(actions(), 1..40)) {
        let (mut world, mut model, mut kept) = (World::default(), Model::default(), None);
        for action in &actions {
            let before = bytes(&world);
            if let Err(error) = perform(action, &mut world, &mut model, &mut kept) {
                prop_assert_eq!(before, bytes(&world), "{:?}: {}", action, error);
                prop_assert!(error.to_string().len() > 10);
            }
            agree(&world, &model)?;
        }
        if let Some((snapshot, _)) = kept {
            let (mut one, mut other) = (snapshot.to_world(), snapshot.to_world());
            let results = (one.steps(0.01, 3).is_ok(), other.steps(0.01, 3).is_ok());
            prop_assert_eq!(results.0, results.1);
            prop_assert_eq!(bytes(&one), bytes(&other));
        }
    }
}
