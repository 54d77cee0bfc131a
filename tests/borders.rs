//! Bad input never gets in: a clear error, and the world to the bit as before the call. Nothing panics.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use std::fmt::Debug;

use culbuto::body::SurfaceOverride;
use culbuto::body::{BodyKind, DragWidth, Filter, FilterOverride, Friction, Locks, Role, Surface};
use culbuto::forces::{Air, Central, ForceSchedule, Oscillating};
use culbuto::math::{Real, Vec2, Wrench, vec2};
use culbuto::shapes::Shape;
use culbuto::world::{Column, Snapshot, Stepper};
use culbuto::{BodyDef, BodyHandle, Error, World};
use worlds::{FailsAfter, Righting, bits, bytes};

const BAD: [Real; 3] = [Real::NAN, Real::INFINITY, Real::NEG_INFINITY];

fn bad_vectors() -> impl Iterator<Item = Vec2> {
    BAD.into_iter().flat_map(|x| [vec2(x, 0.0), vec2(0.0, x)])
}

/// A world with some of everything.
fn world() -> (World, BodyHandle) {
    let mut world = World::default();
    world.set_air(Air { density: 1.2, wind: vec2(1.0, 0.0) }).unwrap();
    let rod = BodyDef::new(Shape::rectangle(1.0, 0.2).unwrap());
    let body = world.add_body(BodyDef { velocity: vec2(1.0, 2.0), ..rod.clone() }).unwrap();
    let beside = vec2(0.0, -2.0);
    world.add_body(BodyDef { kind: BodyKind::Static, position: beside, ..rod.clone() }).unwrap();
    let locks = Locks { x: true, ..Locks::default() };
    world.add_body(BodyDef { locks, position: vec2(3.0, 0.0), ..rod }).unwrap();
    let forces = ForceSchedule::new(vec![0.0, 0.05, 1.0], vec![Wrench::ZERO; 2]).unwrap();
    world.add_schedule(body, forces).unwrap();
    world.step(0.01).unwrap();
    world.body_mut(body).unwrap().apply_force(vec2(1.0, 1.0), None).unwrap();
    (world, body)
}

/// The call fails with a message that has these words in it, and nothing changes.
#[track_caller]
fn refuses<T: Debug>(words: &str, call: impl FnOnce(&mut World, BodyHandle) -> Result<T, Error>) {
    let (mut world, body) = world();
    let (before, report) = (bytes(&world), world.report().clone());
    let error = call(&mut world, body).unwrap_err().to_string();
    assert!(error.contains(words), "{error}");
    assert_eq!(bytes(&world), before, "{error}: the world has changed");
    assert_eq!(*world.report(), report, "{error}: the report has changed");
    world.step(0.01).unwrap();
}

fn refuses_def(words: &str, def: BodyDef) {
    refuses(words, |world, _| world.add_body(def));
}

#[test]
fn definitions_with_bad_numbers_are_refused() {
    let point = || BodyDef::point(1.0);
    let disk = || BodyDef::new(Shape::circle(1.0).unwrap());
    for bad in BAD {
        refuses_def("angle is", BodyDef { angle: bad, ..point() });
        refuses_def("angular_velocity is", BodyDef { angular_velocity: bad, ..point() });
        refuses_def("torque is", BodyDef { torque: bad, ..point() });
        refuses_def("gravity_scale is", BodyDef { gravity_scale: bad, ..point() });
    }
    for bad in bad_vectors() {
        refuses_def("position is", BodyDef { position: bad, ..point() });
        refuses_def("velocity is", BodyDef { velocity: bad, ..point() });
        refuses_def("force is", BodyDef { force: bad, ..point() });
        refuses_def("center_of_mass is", BodyDef { center_of_mass: Some(bad), ..point() });
    }
    for bad in BAD.into_iter().chain([-1.0]) {
        refuses_def("density is", BodyDef { density: bad, ..disk() });
        refuses_def("linear_damping is", BodyDef { linear_damping: bad, ..point() });
        refuses_def("angular_damping is", BodyDef { angular_damping: bad, ..point() });
        refuses_def("drag_coefficient is", BodyDef { drag_coefficient: bad, ..point() });
        refuses_def("drag_width is", BodyDef { drag_width: DragWidth::Fixed(bad), ..point() });
    }
    for bad in BAD.into_iter().chain([-1.0, 0.0]) {
        refuses_def("mass is", BodyDef::point(bad));
        refuses_def("inertia is", BodyDef { inertia: Some(bad), ..point() });
    }
    refuses_def("mass of a dynamic body is 0", BodyDef::default());
    refuses_def("mass of a dynamic body is 0", BodyDef { density: 0.0, ..disk() });
    refuses_def("1 / mass is inf", BodyDef::point(1e-310));
    refuses_def("1 / inertia is inf", BodyDef { inertia: Some(1e-310), ..point() });
    refuses_def("mass from the shapes", BodyDef { density: 1e308, ..disk() });
    let locks = Locks { y: true, ..Locks::default() };
    refuses_def("that axis is locked", BodyDef { locks, velocity: vec2(1.0, 1.0), ..point() });
    refuses_def("is static", BodyDef { kind: BodyKind::Static, angular_velocity: 1.0, ..point() });
}

#[test]
fn surfaces_that_are_not_allowed_are_refused() {
    let disk = || BodyDef::new(Shape::circle(1.0).unwrap());
    let friction = |sticking, sliding| Friction { sticking, sliding };
    let with = |friction| Surface { friction, ..Surface::default() };
    let bad = BAD.into_iter().chain([-1.0]);
    let mut surfaces: Vec<(&str, Surface)> = bad
        .flat_map(|x| {
            [
                ("friction is", with(Friction::of(x))),
                ("static friction is", with(friction(x, 0.1))),
                ("kinetic friction is", with(friction(1.0, x))),
                ("restitution is", Surface { restitution: x, ..Surface::default() }),
                ("rolling_resistance is", Surface { rolling_resistance: x, ..Surface::default() }),
            ]
        })
        .collect();
    surfaces.extend(
        BAD.map(|x| ("tangent_speed is", Surface { tangent_speed: x, ..Surface::default() })),
    );
    surfaces.push(("kinetic friction is 0.3; allowed: 0 to", with(friction(0.2, 0.3))));
    surfaces.push(("restitution is 1.01", Surface { restitution: 1.01, ..Surface::default() }));
    for (words, surface) in surfaces {
        let own = SurfaceOverride {
            friction: Some(surface.friction),
            restitution: Some(surface.restitution),
            rolling_resistance: Some(surface.rolling_resistance),
            tangent_speed: Some(surface.tangent_speed),
            material: None,
        };
        refuses(words, |w, b| w.body_mut(b)?.set_surface(surface.clone()));
        refuses(words, |w, b| w.body_mut(b)?.set_part_surface(0, own.clone()));
        refuses_def(words, BodyDef { surface, ..disk() });
        let mut def = disk();
        def.shapes[0].surface = own;
        refuses_def(words, def);
    }
    for side in bad_vectors().chain([vec2(0.0, 0.0)]) {
        refuses_def("one_way is", BodyDef { role: Role::OneWay(side), ..disk() });
        refuses("one_way is", |w, b| w.body_mut(b)?.set_part_role(0, Some(Role::OneWay(side))));
    }
    refuses("part is 1; allowed: a shape of the body, which has 1", |w, b| {
        w.body_mut(b)?.set_part_filter(1, FilterOverride::default())
    });
}

#[test]
fn surfaces_are_changed_and_nothing_else_is() {
    let (mut world, handle) = world();
    let before = bits(&world);
    let surface = Surface { restitution: 0.4, ..Surface::default() };
    let own = SurfaceOverride { friction: Some(Friction::of(0.1)), ..SurfaceOverride::default() };
    let group = FilterOverride { group: Some(-2), ..FilterOverride::default() };
    let mut body = world.body_mut(handle).unwrap();
    body.set_surface(surface.clone()).unwrap();
    body.set_part_surface(0, own).unwrap();
    body.set_filter(Filter { category: 8, mask: 1, group: 0 }).unwrap();
    body.set_part_filter(0, group).unwrap();
    body.set_role(Role::Sensor).unwrap();
    body.set_part_role(0, None).unwrap();
    let def = body.get().def();
    let part = &def.shapes[0];
    assert_eq!(def.surface_of(part), Surface { friction: Friction::of(0.1), ..surface });
    assert_eq!(def.filter_of(part), Filter { category: 8, mask: 1, group: -2 });
    assert_eq!(def.role_of(part), Role::Sensor);
    body.set_part_role(0, Some(Role::Solid)).unwrap();
    let def = body.get().def();
    assert_eq!(def.role_of(&def.shapes[0]), Role::Solid);
    assert_eq!(bits(&world), before);
}

#[test]
fn settings_that_are_not_allowed_are_refused() {
    for bad in bad_vectors() {
        refuses("gravity is", |world, _| world.set_gravity(bad));
        refuses("wind is", |world, _| world.set_air(Air { density: 1.0, wind: bad }));
    }
    for bad in BAD.into_iter().chain([-1.0]) {
        let wind = vec2(0.0, 0.0);
        refuses("air density is", |world, _| world.set_air(Air { density: bad, wind }));
    }
    for bad in BAD {
        refuses("time is", |world, _| world.set_time(bad));
    }
    refuses("method is \"magic\"; allowed: leapfrog", |world, _| world.set_method("magic"));
    refuses("substeps is 0", |world, _| world.set_substeps(0));
    refuses("substeps is 65537", |world, _| world.set_substeps(65_537));
}

#[test]
fn changes_that_are_not_allowed_are_refused() {
    for bad in bad_vectors() {
        refuses("position is", |w, b| w.body_mut(b)?.set_position(bad));
        refuses("center_at is", |w, b| w.body_mut(b)?.place_center_of_mass(bad));
        refuses("velocity is", |w, b| w.body_mut(b)?.set_velocity(bad));
        refuses("force is", |w, b| w.body_mut(b)?.set_force(Wrench::new(bad, 0.0)));
        refuses("force is", |w, b| w.body_mut(b)?.apply_force(bad, None));
        refuses("at is", |w, b| w.body_mut(b)?.apply_force(vec2(1.0, 0.0), Some(bad)));
        refuses("impulse is", |w, b| w.body_mut(b)?.apply_impulse(bad, None));
        refuses("at is", |w, b| w.body_mut(b)?.apply_impulse(vec2(1.0, 0.0), Some(bad)));
        refuses("center_of_mass is", |w, b| w.body_mut(b)?.set_center_of_mass(Some(bad)));
    }
    for bad in BAD {
        refuses("angle is", |w, b| w.body_mut(b)?.set_angle(bad));
        refuses("angular_velocity is", |w, b| w.body_mut(b)?.set_angular_velocity(bad));
        refuses("torque is", |w, b| w.body_mut(b)?.apply_torque(bad));
        refuses("impulse is", |w, b| w.body_mut(b)?.apply_angular_impulse(bad));
        refuses("gravity_scale is", |w, b| w.body_mut(b)?.set_gravity_scale(bad));
        refuses("linear_damping is", |w, b| w.body_mut(b)?.set_damping(bad, 0.0));
        refuses("drag_width is", |w, b| w.body_mut(b)?.set_drag(0.1, DragWidth::Fixed(bad)));
    }
    for bad in BAD.into_iter().chain([0.0, -1.0]) {
        refuses("mass is", |w, b| w.body_mut(b)?.set_mass(Some(bad)));
        refuses("inertia is", |w, b| w.body_mut(b)?.set_inertia(Some(bad)));
    }
    refuses("mass of a dynamic body", |w, b| w.body_mut(b)?.set_density(0.0));
    refuses("mass of a dynamic body", |w, b| w.body_mut(b)?.set_shapes(Vec::new()));
}

#[test]
fn columns_are_written_all_or_nothing() {
    for (column, name) in [
        (Column::Positions, "positions"),
        (Column::Angles, "angles"),
        (Column::Velocities, "velocities"),
        (Column::AngularVelocities, "angular_velocities"),
        (Column::Forces, "forces"),
        (Column::Torques, "torques"),
    ] {
        let count = 3 * column.width();
        refuses("numbers", |world, _| world.write_column(column, &vec![1.0; count - 1]));
        let mut values = vec![0.5; count];
        values[count - 1] = Real::NAN;
        refuses(&format!("{name}[2] is NaN"), |world, _| world.write_column(column, &values));
    }
    refuses("the body is static", |world, _| world.write_column(Column::Velocities, &[1.0; 6]));
    let values = [1.0, 1.0, 0.0, 0.0, 1.0, 1.0];
    refuses("axis is locked", |world, _| world.write_column(Column::Velocities, &values));
}

#[test]
fn steps_that_are_not_allowed_are_refused() {
    for bad in BAD.into_iter().chain([0.0, -0.1]) {
        refuses("dt is", |world, _| world.step(bad));
        refuses("dt is", |world, _| world.steps(bad, 3));
        refuses("dt is", |world, _| world.record(bad, 3, 1));
        refuses("duration is", |world, _| world.advance(bad, 1e-6).map(drop));
        refuses("tolerance is", |world, _| world.advance(0.1, bad).map(drop));
    }
    refuses("tolerance is", |world, _| world.advance(0.1, 0.2).map(drop));
    refuses("every is 0", |world, _| world.record(0.1, 3, 0));
    for times in [vec![-0.1], vec![0.2], vec![0.05, 0.01], vec![Real::NAN]] {
        refuses("times[", |world, _| world.advance_sampled(0.1, 1e-6, &times));
    }
    assert!(Stepper::new(0.0).is_err());
    assert!(Stepper::new(Real::NAN).is_err());
    refuses("elapsed is", |world, _| Stepper::new(60.0)?.frame(world, -1.0));
}

#[test]
fn schedules_and_fields_with_bad_numbers_are_refused() {
    let build = |times: &[Real]| ForceSchedule::new(times.to_vec(), vec![Wrench::ZERO; 2]);
    for times in [
        &[0.0, 1.0][..],
        &[0.0, 0.0, 1.0],
        &[1.0, 0.0, 2.0],
        &[Real::NAN, 0.0, 1.0],
        &[0.0, Real::NAN, 1.0],
        &[0.0, 1.0, Real::NAN],
        &[Real::NEG_INFINITY, 0.0, 1.0],
        &[0.0, Real::INFINITY, Real::INFINITY],
    ] {
        assert!(build(times).is_err(), "{times:?}");
    }
    build(&[0.0, 1.0, Real::INFINITY]).unwrap();
    assert!(ForceSchedule::new(vec![0.0], Vec::new()).is_err());
    let nan = Wrench::new(vec2(Real::NAN, 0.0), 0.0);
    assert!(ForceSchedule::new(vec![0.0, 1.0], vec![nan]).is_err());
}

#[test]
fn handles_of_what_is_gone_are_errors() {
    let stale = |error: Error| assert!(matches!(error, Error::StaleHandle("body")), "{error}");
    let (mut world, old) = world();
    world.remove_body(old).unwrap();
    for reused in [false, true] {
        if reused {
            let new = world.add_body(BodyDef::point(1.0)).unwrap();
            assert_eq!(new.slot(), old.slot(), "the slot is reused");
            assert_ne!(new, old);
        }
        let before = bytes(&world);
        stale(world.body(old).map(drop).unwrap_err());
        stale(world.body_mut(old).map(drop).unwrap_err());
        stale(world.remove_body(old).unwrap_err());
        let forces = ForceSchedule::new(vec![0.0, 1.0], vec![Wrench::ZERO]).unwrap();
        stale(world.add_schedule(old, forces).map(drop).unwrap_err());
        assert_eq!(bytes(&world), before);
    }
    assert!(world.schedules().is_empty(), "schedules go with their body");

    let center = vec2(0.0, 0.0);
    let field = world.add_field(Central { center, strength: 1.0, exponent: 1.0, per_mass: false });
    world.remove_field(field).unwrap();
    assert!(matches!(world.remove_field(field), Err(Error::StaleHandle("force field"))));
    // A field on a body that is gone acts on nothing.
    let (force, torque) = (vec2(1.0, 0.0), 0.0);
    world.add_field(Oscillating { body: old, force, torque, hertz: 1.0, phase: 0.0 });
    world.step(0.1).unwrap();
    world.advance(0.1, 1e-6).unwrap();
}

#[test]
fn a_motion_that_overflows_is_refused_as_a_whole() {
    for method in culbuto::methods::REGISTRY.iter().map(|method| method.facts().name) {
        let (mut world, _) = world();
        world.set_method(method).unwrap();
        world.set_gravity(vec2(0.0, 1e300)).unwrap();
        let before = bytes(&world);
        // Drag may hold the motion finite for long, or the solution of an implicit kick may fail first.
        assert!(world.steps(1e8, 10).is_err(), "{method}");
        assert_eq!(bytes(&world), before, "{method}");
    }
    // The fourth of six steps fails; the first three are taken back, and the time with them.
    let mut world = World::default();
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    world.add_body(BodyDef { velocity: vec2(4e307, 0.0), ..BodyDef::point(1.0) }).unwrap();
    let before = bytes(&world);
    let error = world.steps(1.0, 6).unwrap_err();
    assert!(matches!(error, Error::NotFinite { body: 0, .. }), "{error}");
    assert_eq!(bytes(&world), before);
    world.steps(1.0, 3).unwrap();
}

#[test]
fn a_field_that_fails_midway_leaves_the_world_as_it_was() {
    for method in culbuto::methods::REGISTRY.iter().map(|method| method.facts().name) {
        let (mut world, _) = world();
        world.set_method(method).unwrap();
        let own = vec![
            std::sync::Arc::new(Righting { strength: 1.0 })
                as std::sync::Arc<dyn culbuto::forces::ForceField>,
            std::sync::Arc::new(FailsAfter(0.105)),
        ];
        for field in &own {
            world.add_shared_field(field.clone());
        }
        let failed = |error: Error| {
            assert!(matches!(&error, Error::Field { name, .. } if name == "tired"), "{error}");
            assert!(error.to_string().contains("too tired"), "{error}");
        };
        let before = bytes(&world);
        failed(world.steps(0.01, 20).unwrap_err());
        assert_eq!(bytes(&world), before, "{method}");
        failed(world.advance(0.5, 1e-6).map(drop).unwrap_err());
        assert_eq!(bytes(&world), before, "{method}");
        failed(world.record(0.01, 20, 1).map(drop).unwrap_err());
        assert_eq!(bytes(&world), before, "{method}");
        // And goes on as if nothing had been tried.
        let mut plain = Snapshot::from_bytes(&before, own).unwrap().to_world();
        world.steps(0.01, 5).unwrap();
        plain.steps(0.01, 5).unwrap();
        assert_eq!(bytes(&world), bytes(&plain), "{method}");
    }
}

#[test]
fn broken_snapshots_are_refused() {
    let (world, _) = world();
    let bytes = bytes(&world);
    for cut in 0..bytes.len() {
        assert!(Snapshot::from_bytes(&bytes[..cut], Vec::new()).is_err());
    }
    let mut other = bytes.clone();
    other[0] = 200;
    let error = Snapshot::from_bytes(&other, Vec::new()).map(drop).unwrap_err();
    assert!(error.to_string().contains("snapshot is"), "{error}");
    other[0] = bytes[0] + 1;
    let error = Snapshot::from_bytes(&other, Vec::new()).map(drop).unwrap_err();
    assert!(error.to_string().contains("snapshot is version"), "{error}");
    let own = vec![std::sync::Arc::new(Righting { strength: 1.0 }) as _];
    assert!(Snapshot::from_bytes(&bytes, own).is_err(), "a field too many");
}

/// Counts how often it is asked, and pushes without a potential.
struct Counting(std::sync::Arc<std::sync::atomic::AtomicU64>);

impl culbuto::forces::ForceField for Counting {
    fn name(&self) -> &'static str {
        "counting"
    }

    fn add_forces(
        &self,
        _: f64,
        _: &culbuto::forces::BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), culbuto::forces::BoxError> {
        self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        out.iter_mut().for_each(|wrench| wrench.force.x += 1.0);
        Ok(())
    }
}

#[test]
fn a_field_is_asked_once_an_evaluation_whatever_else_acts() {
    let asked = std::sync::Arc::default();
    let mut world = World::default();
    let force = vec2(2.0, 0.0);
    world.add_body(BodyDef { force, ..BodyDef::point(1.0) }).unwrap();
    world.add_field(Counting(std::sync::Arc::clone(&asked)));
    world.add_field(Counting(std::sync::Arc::clone(&asked)));
    world.step(0.5).unwrap();
    let evaluations = world.report().evaluations;
    assert!(evaluations > 0);
    assert_eq!(asked.load(std::sync::atomic::Ordering::Relaxed), 2 * evaluations);
    // 2 + 1 + 1 N on 1 kg for half a second, all of it booked as work.
    assert!((world.bodies().twists[0].linear.x - 2.0).abs() < 1e-15);
    assert!((world.energy().unwrap().work - 2.0).abs() < 1e-14);
}
