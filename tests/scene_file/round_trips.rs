//! World → file → world goes on bit for bit; file → world → file stays.

use culbuto::body::{
    BodyKind, DragWidth, Filter, FilterOverride, Friction, ImpactLaw, Locks, Mixing,
};
use culbuto::body::{PairOfMaterials, Role, Rule, Surface, SurfaceOverride};
use culbuto::forces::{Air, Attraction, Central, ForceSchedule, Oscillating};
use culbuto::math::{Real, Vec2, Wrench, vec2};
use culbuto::scenes::SceneFile;
use culbuto::scenes::file::{SceneBody, ScenePart};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::solvers::Solver;
use culbuto::{BodyDef, Part, World, methods};
use proptest::prelude::*;

use crate::worlds::{bits, bytes};

fn number() -> impl Strategy<Value = Real> {
    prop_oneof![4 => -10.0..10.0, 1 => -1e6..1e6, 1 => Just(0.0), 1 => Just(-0.0)]
}

fn vector() -> impl Strategy<Value = Vec2> {
    (number(), number()).prop_map(|(x, y)| vec2(x, y))
}

fn shapes() -> impl Strategy<Value = ShapeDef> {
    let length = || 0.01..5.0;
    prop_oneof![
        (length(), vector()).prop_map(|(radius, center)| ShapeDef::Circle { radius, center }),
        (length(), length(), vector(), number()).prop_map(|(width, height, center, angle)| {
            ShapeDef::Box { width, height, center, angle }
        }),
        (3..9_u32, length(), vector(), number()).prop_map(|(sides, radius, center, angle)| {
            ShapeDef::RegularPolygon { sides, radius, center, angle }
        }),
        (vector(), length(), length()).prop_map(|(a, way, radius)| {
            ShapeDef::Capsule { a, b: a + vec2(way, -way), radius }
        }),
        (vector(), length()).prop_map(|(a, s)| ShapeDef::Polygon {
            vertices: [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
                .map(|(x, y)| a + s * vec2(x, y))
                .to_vec(),
            holes: Vec::new(),
            radius: 0.0,
        }),
        (vector(), length()).prop_map(|(a, way)| ShapeDef::Segment { a, b: a + vec2(way, way) }),
        (vector(), length(), number(), 0.1..6.0).prop_map(|(center, radius, start, sweep)| {
            ShapeDef::Arc { center, radius, start, sweep }
        }),
        (vector(), length(), any::<[bool; 2]>()).prop_map(|(a, s, [closed, one_sided])| {
            let points =
                [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)].map(|(x, y)| a + s * vec2(x, y)).to_vec();
            ShapeDef::Chain { points, closed, one_sided }
        }),
    ]
}

fn name() -> impl Strategy<Value = Option<String>> {
    prop::option::of(prop::sample::select(vec!["wood", "ice", "", "ü \"x\""]).prop_map(Into::into))
}

fn friction() -> impl Strategy<Value = Friction> {
    (0.0..2.0, prop_oneof![Just(1.0), Just(0.0), 0.0..1.0])
        .prop_map(|(sticking, share)| Friction { sticking, sliding: share * sticking })
}

fn surface_override() -> impl Strategy<Value = SurfaceOverride> {
    let of = |range| prop::option::of(range);
    (prop::option::of(friction()), of(0.0..1.0), of(0.0..1.0), of(-9.0..9.0), name()).prop_map(
        |(friction, restitution, rolling_resistance, tangent_speed, material)| SurfaceOverride {
            friction,
            restitution,
            rolling_resistance,
            tangent_speed,
            material,
        },
    )
}

fn filter_override() -> impl Strategy<Value = FilterOverride> {
    any::<(Option<u32>, Option<u32>, Option<i32>)>()
        .prop_map(|(category, mask, group)| FilterOverride { category, mask, group })
}

fn role() -> impl Strategy<Value = Role> {
    let one_way = vector().prop_map(|side| Role::OneWay(side + vec2(0.0, 2e7)));
    prop_oneof![2 => Just(Role::Solid), 1 => Just(Role::Sensor), 1 => one_way]
}

fn mixing() -> impl Strategy<Value = Mixing> {
    let rule = || prop::sample::select(Rule::ALL.map(|(_, rule)| rule).to_vec());
    let row = (name(), name(), prop::option::of(friction()), prop::option::of(0.0..1.0));
    (rule(), rule(), prop::collection::vec(row, 0..4)).prop_map(|(friction, restitution, rows)| {
        let mut mixing = Mixing { friction, restitution, ..Mixing::default() };
        for (a, b, friction, restitution) in rows {
            let (a, b) = (a.unwrap_or_default(), b.unwrap_or_default());
            mixing.set_pair(PairOfMaterials { a, b, friction, restitution });
        }
        mixing
    })
}

fn bodies() -> impl Strategy<Value = BodyDef> {
    let name = prop::option::of(prop::sample::select(vec!["a", "b", "c \"quoted\" ü"]));
    let kind = prop::sample::select(vec![BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic]);
    let own = (surface_override(), filter_override(), prop::option::of(role()));
    let part = (shapes(), prop::option::of(0.1..9.0), own).prop_filter_map(
        "shape",
        |(def, density, (surface, filter, role))| {
            let shape = Shape::new(def).ok()?;
            Some(Part { shape, density, surface, filter, role })
        },
    );
    let width = prop_oneof![
        Just(DragWidth::Silhouette),
        Just(DragWidth::BoundingBox),
        (0.0..3.0).prop_map(DragWidth::Fixed)
    ];
    let place = (vector(), number(), vector(), number(), vector(), number());
    let mass = (prop::option::of(0.1..9.0), prop::option::of(0.1..9.0), prop::option::of(vector()));
    let locks = (any::<bool>(), any::<bool>(), any::<bool>());
    let resists = (0.0..2.0, 0.0..2.0, 0.0..2.0, width, -2.0..2.0);
    let shapes = prop::collection::vec(part, 0..4);
    let touch = (surface_override(), filter_override(), role());
    (name, kind, shapes, place, mass, locks, resists, touch).prop_map(
        |(name, kind, shapes, place, mass, locks, resists, (surface, filter, role))| {
            let (x, y, rotation) = locks;
            let free = |lock: bool, v: Real| {
                let dynamic = kind == BodyKind::Dynamic;
                if kind == BodyKind::Static || (dynamic && lock) { 0.0 } else { v }
            };
            BodyDef {
                name: name.map(str::to_owned),
                kind,
                position: place.0,
                angle: place.1,
                velocity: vec2(free(x, place.2.x), free(y, place.2.y)),
                angular_velocity: free(rotation, place.3),
                force: place.4,
                torque: place.5,
                mass: if shapes.is_empty() { Some(mass.0.unwrap_or(1.0)) } else { mass.0 },
                inertia: mass.1,
                center_of_mass: mass.2,
                shapes,
                locks: Locks { x, y, rotation },
                linear_damping: resists.0,
                angular_damping: resists.1,
                drag_coefficient: resists.2,
                drag_width: resists.3,
                gravity_scale: resists.4,
                surface: surface.over(&Surface::default()),
                filter: filter.over(&Filter::default()),
                role,
                ..BodyDef::default()
            }
        },
    )
}

/// A world in the midst of its motion, with bodies that were removed before.
fn worlds() -> impl Strategy<Value = World> {
    let method = 0..methods::REGISTRY.len();
    let settings = (method, 1..4_u32, any::<bool>(), vector(), 0.0..2.0, vector());
    let schedule = (any::<prop::sample::Index>(), any::<bool>(), vector(), number());
    let schedules = prop::collection::vec(schedule, 0..3);
    let fields = (any::<bool>(), any::<bool>(), any::<bool>());
    let run = (prop::collection::vec(1e-3..0.03, 0..8), -3.0..3.0);
    let law = prop::sample::select(ImpactLaw::ALL.map(|(_, law)| law).to_vec());
    let solver = prop::sample::select(Solver::ALL.map(|(_, solver)| solver).to_vec());
    let contacts = (mixing(), law, solver, any::<bool>());
    (settings, prop::collection::vec(bodies(), 2..6), schedules, fields, run, contacts)
        .prop_map(|(settings, bodies, schedules, fields, run, (mixing, law, solver, sleeping))| {
            let mut world = World::new(settings.3).unwrap();
            world.set_method(methods::REGISTRY[settings.0].facts().name).unwrap();
            world.set_substeps(settings.1).unwrap();
            world.set_closed_form(settings.2);
            world.set_air(Air { density: settings.4, wind: settings.5 }).unwrap();
            world.set_mixing(mixing).unwrap();
            world.set_impact_law(law);
            world.set_solver(solver);
            world.set_sleeping(sleeping);
            world.set_time(run.1).unwrap();
            let handles: Vec<_> =
                bodies.into_iter().map(|def| world.add_body(def).unwrap()).collect();
            world.remove_body(handles[0]).unwrap();
            let handles = &handles[1..];
            for (body, endless, force, torque) in schedules {
                let times = vec![run.1, run.1 + 0.0123, if endless { Real::INFINITY } else { 9.0 }];
                let wrenches = vec![Wrench::new(force, torque), Wrench::new(-force, 0.0)];
                let forces = ForceSchedule::new(times, wrenches).unwrap();
                world.add_schedule(*body.get(handles), forces).unwrap();
            }
            if fields.0 {
                let center = vec2(0.3, -0.1);
                world.add_field(Central { center, strength: 1.5, exponent: 1.0, per_mass: true });
            }
            if fields.1 {
                world.add_field(Attraction { strength: 0.01, exponent: -2.0, softening: 1.0 });
            }
            if fields.2 {
                let (body, force) = (handles[0], vec2(0.1, -2.0));
                world.add_field(Oscillating { body, force, torque: 0.7, hertz: 3.0, phase: 0.2 });
            }
            for dt in run.0 {
                // Explicit methods may refuse what is too stiff for them; the world then stays.
                let _ = world.step(dt);
            }
            world
        })
        .boxed()
}

/// How the shapes of a world touch, and what the world makes of it, as text with every digit.
fn touch(world: &World) -> String {
    let defs = world.bodies().infos.iter().map(|info| &info.def);
    let parts = |def: &BodyDef| -> Vec<_> {
        let part = |part: &Part| (part.surface.clone(), part.filter, part.role);
        def.shapes.iter().map(part).collect()
    };
    let bodies: Vec<_> =
        defs.map(|def| (parts(def), def.surface.clone(), def.filter, def.role)).collect();
    format!("{bodies:?} {:?}", world.settings())
}

proptest! {
    #[test]
    fn a_world_goes_on_bit_for_bit_from_its_file(mut world in worlds()) {
        let file = SceneFile::from_world(&world).unwrap();
        let text = file.to_json();
        let read = SceneFile::from_json(&text).unwrap();
        prop_assert_eq!(&read, &file, "{}", text);
        let mut again = read.world().unwrap();
        prop_assert_eq!(bits(&world), bits(&again), "{}", text);
        prop_assert_eq!(touch(&world), touch(&again), "{}", text);
        // What contacts remember is not in the file: a world in which bodies can meet starts its contacts anew.
        if !world.explain().contains("nothing here can collide") {
            return Ok(());
        }
        for dt in [1.0 / 60.0, 0.004, 0.02] {
            let (one, other) = (world.step(dt), again.step(dt));
            prop_assert_eq!(one.is_ok(), other.is_ok());
            prop_assert_eq!(bits(&world), bits(&again), "{}", text);
        }
        let (one, other) = (world.advance(0.05, 1e-6).is_ok(), again.advance(0.05, 1e-6).is_ok());
        prop_assert_eq!(one, other);
        prop_assert_eq!(bits(&world), bits(&again));
    }

    #[test]
    fn a_file_of_a_world_stays_as_it_is(world in worlds()) {
        let text = SceneFile::from_world(&world).unwrap().to_json();
        let world = SceneFile::from_json(&text).unwrap().world().unwrap();
        prop_assert_eq!(SceneFile::from_world(&world).unwrap().to_json(), text);
    }

    #[test]
    fn every_finite_number_goes_through_text(x in any::<f64>(), y in any::<f64>()) {
        prop_assume!(x.is_finite() && y.is_finite());
        let mut scene = SceneFile { gravity: vec2(x, y), time: x, ..SceneFile::default() };
        scene.bodies.push(BodyDef { position: vec2(y, x), ..BodyDef::point(1.0) }.into());
        let read = SceneFile::from_json(&scene.to_json()).unwrap();
        prop_assert_eq!(read.gravity.x.to_bits(), x.to_bits());
        prop_assert_eq!(read.time.to_bits(), x.to_bits());
        prop_assert_eq!(read.bodies[0].def.position.x.to_bits(), y.to_bits());
    }
}

#[test]
fn a_body_far_from_its_frame_is_placed_by_its_centre_of_mass() {
    // The frame is 1e9 m away, where doubles lie 1e-7 m apart; the centre of mass at 0.1 m is kept.
    let part = Part::from(Shape::circle(1.0).unwrap());
    let far = BodyDef { center_of_mass: Some(vec2(1e9, 0.0)), ..BodyDef::new(part) };
    let mut world = World::default();
    let body = world.add_body(far).unwrap();
    world.body_mut(body).unwrap().place_center_of_mass(vec2(0.1, 0.2)).unwrap();
    let file = SceneFile::from_world(&world).unwrap();
    assert_eq!(file.bodies[0].center_at, Some(vec2(0.1, 0.2)));
    assert_eq!(bits(&file.world().unwrap()), bits(&world));
    assert!(file.to_json().contains(r#""center_at": [0.1, 0.2]"#));
}

#[test]
fn materials_give_shapes_their_density() {
    let disk = || Shape::circle(1.0).unwrap();
    let part = |material: Option<&str>, density| ScenePart {
        material: material.map(str::to_owned),
        density,
        ..Part::from(disk()).into()
    };
    let json = r#"{"culbuto": 1, "materials": {"wood": {"density": 600}, "plain": {}}}"#;
    let mut scene = SceneFile::from_json(json).unwrap();
    let own = [
        (part(Some("wood"), None), 600.0),
        (part(Some("wood"), Some(5.0)), 5.0),
        (part(Some("plain"), None), 3.0),
        (part(None, None), 3.0),
    ];
    for (part, density) in own {
        let def = BodyDef { density: 3.0, ..BodyDef::default() };
        scene.bodies = vec![SceneBody { def, shapes: vec![part], center_at: None }];
        let world = scene.world().unwrap();
        assert_eq!(world.bodies().masses[0].mass, disk().area() * density);
    }
}

#[test]
fn a_shape_has_its_own_values_else_its_materials_else_its_bodys() {
    let scene = SceneFile::from_json(
        r#"{"culbuto": 1,
        "materials": {"ice": {"friction": {"static": 0.1, "kinetic": 0.05}, "restitution": 0.3}, "plain": {}},
        "bodies": [{
            "mass": 1, "friction": 0.7, "restitution": 1, "rolling_resistance": 0.01, "material": "ice",
            "filter": {"category": 4}, "role": "sensor",
            "shapes": [
                {"shape": {"circle": {"radius": 1}}},
                {"shape": {"circle": {"radius": 1}}, "friction": 2},
                {"shape": {"circle": {"radius": 1}}, "material": "plain", "tangent_speed": -3,
                 "filter": {"mask": 6}, "role": {"one_way": [0, 1]}}
            ]
        }]}"#,
    )
    .unwrap();
    let world = scene.world().unwrap();
    let def = &world.bodies().infos[0].def;
    let own = |k: usize| def.surface_of(&def.shapes[k]);
    let ice = Surface {
        friction: Friction { sticking: 0.1, sliding: 0.05 },
        restitution: 0.3,
        rolling_resistance: 0.01,
        tangent_speed: 0.0,
        material: Some("ice".into()),
    };
    assert_eq!(own(0), ice);
    assert_eq!(own(1), Surface { friction: Friction::of(2.0), ..ice });
    let plain = Surface {
        friction: Friction::of(0.7),
        restitution: 1.0,
        rolling_resistance: 0.01,
        tangent_speed: -3.0,
        material: Some("plain".into()),
    };
    assert_eq!(own(2), plain);
    assert_eq!(def.filter_of(&def.shapes[0]), Filter { category: 4, ..Filter::default() });
    assert_eq!(def.filter_of(&def.shapes[2]), Filter { category: 4, mask: 6, group: 0 });
    assert_eq!(def.role_of(&def.shapes[0]), Role::Sensor);
    assert_eq!(def.role_of(&def.shapes[2]), Role::OneWay(vec2(0.0, 1.0)));
}

#[test]
fn what_is_as_usual_is_not_written() {
    let shape = r#"{"shape": {"circle": {"radius": 1.0}}"#;
    let plain = format!(r#"{{"culbuto": 1, "bodies": [{{"shapes": [{shape}}}]}}]}}"#);
    let text = SceneFile::from_json(&plain).unwrap().to_json();
    for key in
        ["friction", "filter", "role", "material", "mixing", "impact_law", "solver", "sleeping"]
    {
        assert!(!text.contains(key), "{key}: {text}");
    }
    let part = format!(r#"{shape}, "friction": 0.5, "filter": {{"group": -1}}}}"#);
    let rows = r#"{"friction": "product", "table": [{"a": "x", "b": "y", "restitution": 0.0}]}"#;
    let some = format!(
        r#"{{"culbuto": 1, "settings": {{"mixing": {rows}}}, "materials": {{"x": {{}}, "y": {{}}}},
        "bodies": [{{"shapes": [{part}], "friction": {{"static": 0.5, "kinetic": 0.4}}}}]}}"#
    );
    let scene = SceneFile::from_json(&some).unwrap();
    for text in [scene.to_json(), SceneFile::from_world(&scene.world().unwrap()).unwrap().to_json()]
    {
        assert!(text.contains(&part), "{text}");
        assert!(text.contains(&format!(r#""mixing": {rows}"#)), "{text}");
        assert!(text.contains(r#""friction": {"static": 0.5, "kinetic": 0.4}"#), "{text}");
    }
}

#[test]
fn a_chain_is_written_with_the_flags_it_has() {
    for (flags, written) in [
        (r#", "closed": false, "one_sided": false"#, ""),
        (r#", "one_sided": true, "closed": true"#, r#", "closed": true, "one_sided": true"#),
    ] {
        let chain = |flags: &str| {
            format!(r#"{{"chain": {{"points": [[0.0, 0.0], [1.0, 0.5], [2.0, 0.0]]{flags}}}}}"#)
        };
        let json = format!(
            r#"{{"culbuto": 1, "bodies": [{{"shapes": [{{"shape": {}}}]}}]}}"#,
            chain(flags)
        );
        let text = SceneFile::from_json(&json).unwrap().to_json();
        let dense = |text: &str| text.split_whitespace().collect::<String>();
        assert!(dense(&text).contains(&dense(&chain(written))), "{text}");
    }
}

#[test]
fn equal_scenes_make_equal_worlds_and_equal_text() {
    let scene = SceneFile::from_json(r#"{"culbuto": 1, "bodies": [{"mass": 1}]}"#).unwrap();
    assert_eq!(bytes(&scene.world().unwrap()), bytes(&scene.clone().world().unwrap()));
    assert_eq!(scene.to_json(), scene.clone().to_json());
}
