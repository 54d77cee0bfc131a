//! Any row of calls, good and bad, leaves a sound world.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::body::{BodyKind, Locks};
use culbuto::forces::Air;
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

fn actions() -> impl Strategy<Value = Action> {
    let which = any::<prop::sample::Index>;
    let add = (any::<u8>(), vector(), positive());
    prop_oneof![
        4 => add.prop_map(|(name, place, mass)| Action::Add { name, place, mass }),
        2 => which().prop_map(Action::Remove),
        7 => (which(), edits()).prop_map(|(i, edit)| Action::Edit(i, edit)),
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
    time: Real,
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

/// Does it, to the model too where the world agrees; an action on a body is none in an empty world.
fn perform(
    action: &Action,
    world: &mut World,
    model: &mut Model,
    kept: &mut Option<(Snapshot, Model)>,
) -> Result<(), Error> {
    let body = |i: &prop::sample::Index| (!model.bodies.is_empty()).then(|| i.get(&model.bodies).0);
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
            if let Some(body) = body(i) {
                world.remove_body(body)?;
                let place = model.bodies.iter().position(|entry| entry.0 == body).unwrap();
                model.bodies.swap_remove(place);
                model.gone.push(body);
            }
        }
        Action::Edit(i, edit) => {
            if let Some(body) = body(i) {
                edit_body(edit, world.body_mut(body)?)?;
            }
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
            model.time += dt;
        }
        Action::Advance(duration) => {
            world.advance(*duration, 1e-6)?;
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
