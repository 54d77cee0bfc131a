//! A world of Culbuto's catalogue as a scene for all engines, where all of them have what is in it.

use std::f64::consts::PI;

use culbuto::body::{BodyKind, Filter, Locks, Mixing, Role};
use culbuto::joint::{Hold, JointDef, JointKind, Spring as CoreSpring, Travel};
use culbuto::math::{Real, Vec2, Wrench, vec2};
use culbuto::shapes::{Shape as CoreShape, ShapeDef};
use culbuto::{BodyDef, World};

use crate::scene::{Body, Joint, Region, Scene, Shape, Spring};

/// A scene, or why not all engines can have it.
type Translated<T> = Result<T, &'static str>;

/// Radius (m) of the disk that stands for a point.
const POINT: Real = 0.05;

/// Translates a world. Bodies stand in its order; what is tied to the world is tied to one more, which is static.
pub fn translate(name: &'static str, about: &'static str, world: &World) -> Translated<Scene> {
    let columns = world.bodies();
    if !world.fields().is_empty() || !world.schedules().is_empty() {
        return Err("a field or a schedule of forces acts");
    }
    if columns.forces.iter().any(|force| *force != Wrench::ZERO) {
        return Err("a constant force acts");
    }
    let defs: Vec<BodyDef> = (0..columns.len()).map(|i| columns.def(i)).collect();
    if world.settings().air.density > 0.0 && defs.iter().any(|def| def.drag_coefficient > 0.0) {
        return Err("the air resists");
    }
    let touches = surface(&defs, &world.settings().mixing)?;
    let alone = touches.is_none();
    let body = |(i, def): (usize, &BodyDef)| {
        let stand_in = alone.then(|| disk_of(world, i)).flatten();
        body(def, matter(def).or_else(|why| stand_in.ok_or(why))?)
    };
    let mut bodies = defs.iter().enumerate().map(body).collect::<Translated<Vec<_>>>()?;
    if touches.is_none() {
        bodies.iter_mut().for_each(|body| body.group = 1);
    } else if defs.iter().any(|def| def.filter != Filter::default()) {
        return Err("some shapes cannot touch all");
    }
    let (friction, restitution) = touches.unwrap_or_default();
    let joints = world.joint_handles().iter().map(|handle| {
        // OK because the handle is one of the world's own.
        let joint = world.joint(*handle).map_err(|_| "a joint is gone")?;
        tie(world, joint.def(), joint.anchors())
    });
    let joints = joints.collect::<Translated<Vec<_>>>()?;
    bodies.push(Body::ground(vec![]));
    Ok(Scene {
        name,
        about,
        bodies,
        joints,
        gravity: world.settings().gravity,
        friction,
        restitution,
        dt: 0.0,
        substeps: 4,
        iterations: 10,
        steps: 0,
        sleeping: false,
        swing: None,
        region: Region::Everywhere,
        size: None,
    })
}

fn body(def: &BodyDef, (shapes, density): (Vec<Shape>, Real)) -> Translated<Body> {
    if def.linear_damping > 0.0 || def.angular_damping > 0.0 {
        return Err("motion is damped");
    }
    if def.gravity_scale != 1.0 || def.locks != Locks::default() {
        return Err("gravity is scaled or an axis locked");
    }
    if def.role != Role::Solid {
        return Err("not all shapes are solid");
    }
    Ok(Body {
        kind: def.kind,
        angle: def.angle,
        velocity: def.velocity,
        angular_velocity: def.angular_velocity,
        density,
        ..Body::new(def.position, shapes)
    })
}

/// A disk with the mass, the inertia, I = ½mr², and the centre of body i; for what touches nothing. None where nothing turns it.
fn disk_of(world: &World, i: usize) -> Option<(Vec<Shape>, Real)> {
    let (mass, center) = (&world.bodies().masses[i], world.bodies().local_centers[i]);
    let radius = (2.0 * mass.inertia / mass.mass).sqrt();
    let turns = mass.is_free() && mass.inverse_inertia > 0.0 && radius > 0.0;
    let density = mass.mass / (PI * radius * radius);
    turns.then(|| (vec![Shape::Circle { center, radius }], density))
}

/// Shapes and their density.
fn matter(def: &BodyDef) -> Translated<(Vec<Shape>, Real)> {
    if def.inertia.is_some() || def.center_of_mass.is_some() {
        return Err("inertia or centre of mass are not those of the shapes");
    }
    let mut shapes =
        def.shapes.iter().map(|part| shape(&part.shape)).collect::<Translated<Vec<_>>>()?;
    let wire = |shape: &Shape| matches!(shape, Shape::Segment { .. });
    if def.kind == BodyKind::Dynamic && shapes.iter().any(wire) {
        return Err("a wire that weighs something");
    }
    let mut density = def.density;
    if def.shapes.is_empty() && def.kind == BodyKind::Dynamic {
        shapes = vec![Shape::disk(POINT)];
        density = def.mass.unwrap_or(1.0) / (PI * POINT * POINT);
    } else if let Some(mass) = def.mass {
        let area: Real = def.shapes.iter().map(|part| part.shape.area()).sum();
        density = mass / area;
    }
    if def.shapes.iter().any(|part| part.density.is_some_and(|own| own != def.density)) {
        return Err("shapes of a body differ in density");
    }
    Ok((shapes, density))
}

fn shape(shape: &CoreShape) -> Translated<Shape> {
    match *shape.def() {
        ShapeDef::Circle { radius, center } => Ok(Shape::Circle { center, radius }),
        ShapeDef::Box { width, height, center, angle: 0.0 } => {
            Ok(Shape::Box { center, half: vec2(0.5 * width, 0.5 * height) })
        }
        ShapeDef::Capsule { a, b, radius } => Ok(Shape::Capsule { a, b, radius }),
        ShapeDef::Segment { a, b } => Ok(Shape::Segment { a, b }),
        _ => match shape.convex_pieces() {
            [vertices] if shape.rounding() == 0.0 => {
                Ok(Shape::Polygon { vertices: vertices.clone() })
            }
            _ => Err("a shape that not all engines have"),
        },
    }
}

/// What pairs of shapes that can touch make together: friction and restitution, the same of all; none where nothing can.
fn surface(defs: &[BodyDef], mixing: &Mixing) -> Translated<Option<(Real, Real)>> {
    let solid = |def: &&BodyDef| !def.shapes.is_empty();
    let mut found = None;
    for (k, one) in defs.iter().enumerate().filter(|(_, def)| solid(def)) {
        for other in defs[k + 1..].iter().filter(solid) {
            let moves = [one, other].iter().any(|def| def.kind == BodyKind::Dynamic);
            if !moves || !one.filter.allows(&other.filter) {
                continue;
            }
            let pair = mixing.mix(&one.surface, &other.surface);
            let plain = pair.friction.sticking == pair.friction.sliding
                && pair.rolling_resistance == 0.0
                && pair.tangent_speeds == [0.0; 2];
            if !plain {
                return Err("a surface that not all engines have");
            }
            let own = (pair.friction.sticking, pair.restitution);
            if found.is_some_and(|other| other != own) {
                return Err("surfaces differ");
            }
            found = Some(own);
        }
    }
    Ok(found)
}

fn tie(world: &World, joint: &JointDef, anchors: [Vec2; 2]) -> Translated<Joint> {
    let bodies = world.bodies();
    let mut places = [bodies.len(); 2];
    let mut locals = anchors;
    let mut inverse = 0.0;
    for side in 0..2 {
        let Some(handle) = joint.bodies[side] else { continue };
        let i = bodies.index(handle).map_err(|_| "a joint is gone")?;
        places[side] = i;
        locals[side] = bodies.origin(i).apply_inverse(anchors[side]);
        inverse += bodies.masses[i].inverse.x;
    }
    let at_centers = |at: Vec2, i: usize| i == bodies.len() || at == bodies.local_centers[i];
    match joint.kind {
        JointKind::Revolute { travel, .. } if travel == Travel::default() => Ok(Joint {
            bodies: places,
            anchors: locals,
            distance: None,
            limits: None,
            spring: None,
        }),
        JointKind::Distance { length, hold, min: 0.0, max: None } => {
            let spring = match hold {
                Hold::Rigid => None,
                Hold::Free => return Err("a joint that not all engines have"),
                Hold::Spring(_) if !(0..2).all(|k| at_centers(locals[k], places[k])) => {
                    return Err("a spring that does not hold centres of mass");
                }
                Hold::Spring(spring) => Some(by(&spring, 1.0 / inverse)),
            };
            let distance = Some(length.unwrap_or((anchors[1] - anchors[0]).norm()));
            Ok(Joint { bodies: places, anchors: locals, distance, limits: None, spring })
        }
        _ => Err("a joint that not all engines have"),
    }
}

/// A spring between two masses that amount to this one (kg).
fn by(spring: &CoreSpring, mass: Real) -> Spring {
    let constants = spring.coefficients(mass);
    let omega = (constants.stiffness / mass).sqrt();
    Spring {
        hertz: omega / (2.0 * PI),
        damping_ratio: constants.damping / (2.0 * mass * omega),
        stiffness: constants.stiffness,
        damping: constants.damping,
    }
}
