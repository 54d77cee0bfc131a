//! How a scene ends, measured alike for all engines: from places and velocities, the declared shapes
//! and nothing else.

use std::collections::HashSet;

use culbuto::body::BodyKind;
use culbuto::math::{Pose, Real, Vec2, perp, vec2};
use culbuto::shapes::{self, MassProperties};
use serde::Serialize;

use crate::Result;
use crate::engines::State;
use crate::scene::{Body, Joint, Scene, Shape};

/// The measures.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct End {
    /// Deepest overlap of two shapes (m): the shortest way that parts them.
    pub overlap: Real,
    /// Farthest that the two anchors of a joint are apart (m); infinite where a body is lost to numbers.
    pub gap: Real,
    /// ½mv² + ½Iω² of all dynamic bodies (J).
    pub kinetic: Real,
    /// The same and −m g·r, r from the origin (J).
    pub total: Real,
    /// Root of the mean square of their speeds (m/s).
    pub rms_speed: Real,
    /// How many dynamic bodies are not where they belong, or nowhere.
    pub lost: usize,
}

/// The state a scene starts in.
pub fn start(scene: &Scene) -> Vec<State> {
    let state = |body: &Body| State {
        position: body.position,
        angle: body.angle,
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
    };
    scene.bodies.iter().map(state).collect()
}

/// Measures a state. Bodies whose numbers are not finite are lost, and left out of all else.
pub fn measure(scene: &Scene, states: &[State]) -> Result<End> {
    if states.len() != scene.bodies.len() {
        return Err("a state of another number of bodies".into());
    }
    let (overlap, gap) = (deepest(&pieces(scene, states), &scene.joints), widest(scene, states));
    let mut end = End { overlap, gap, kinetic: 0.0, total: 0.0, rms_speed: 0.0, lost: 0 };
    let mut squares = 0.0;
    let dynamic = scene.bodies.iter().zip(states).filter(|(body, _)| is_dynamic(body));
    for (body, state) in dynamic {
        let mass = mass(body)?;
        let center = pose(state).apply(mass.center);
        end.lost += usize::from(!(finite(state) && scene.region.holds(center)));
        if finite(state) {
            let square = state.velocity.norm_squared();
            let spin = mass.inertia * state.angular_velocity.powi(2);
            let kinetic = 0.5 * (mass.mass * square + spin);
            squares += square;
            end.kinetic += kinetic;
            end.total += kinetic - mass.mass * scene.gravity.dot(&center);
        }
    }
    let count = u32::try_from(scene.dynamic().max(1))?;
    end.rms_speed = (squares / Real::from(count)).sqrt();
    Ok(end)
}

/// Farthest that anchors of a joint are apart.
fn widest(scene: &Scene, states: &[State]) -> Real {
    let gap = |joint: &Joint| {
        let [a, b] =
            [0, 1].map(|side| pose(&states[joint.bodies[side]]).apply(joint.anchors[side]));
        let gap = (b - a).norm();
        if gap.is_nan() { Real::INFINITY } else { gap }
    };
    scene.joints.iter().map(gap).fold(0.0, Real::max)
}

fn is_dynamic(body: &Body) -> bool {
    body.kind == BodyKind::Dynamic
}

fn pose(state: &State) -> Pose {
    Pose { position: state.position, angle: state.angle }
}

fn finite(state: &State) -> bool {
    let State { position, angle, velocity, angular_velocity } = *state;
    let numbers = [position.x, position.y, angle, velocity.x, velocity.y, angular_velocity];
    numbers.iter().all(|x| x.is_finite())
}

/// Mass, centre and moment of inertia by the declared shapes; segments weigh nothing.
fn mass(body: &Body) -> Result<MassProperties> {
    let shapes = body.shapes.iter().filter_map(|shape| match *shape {
        Shape::Circle { center, radius } => {
            Some(shapes::Shape::new(shapes::ShapeDef::Circle { radius, center }))
        }
        Shape::Capsule { a, b, radius } => Some(shapes::Shape::capsule(a, b, radius)),
        Shape::Segment { .. } => None,
        _ => Some(shapes::Shape::polygon(&shape.corners())),
    });
    let parts = shapes.map(|shape| Ok(shape?.mass_properties(body.density)));
    Ok(MassProperties::combine(parts.collect::<Result<Vec<_>>>()?))
}

/// A shape in the world.
struct Piece {
    body: usize,
    group: u8,
    dynamic: bool,
    corners: Vec<Vec2>,
    radius: Real,
    low: Vec2,
    high: Vec2,
}

fn piece(number: usize, body: &Body, corners: Vec<Vec2>, radius: Real) -> Piece {
    let around = vec2(radius, radius);
    let low = corners.iter().fold(corners[0], |m, p| m.inf(p)) - around;
    let high = corners.iter().fold(corners[0], |m, p| m.sup(p)) + around;
    let (dynamic, group) = (is_dynamic(body), body.group);
    Piece { body: number, group, dynamic, corners, radius, low, high }
}

fn pieces(scene: &Scene, states: &[State]) -> Vec<Piece> {
    let placed = scene.bodies.iter().zip(states).enumerate();
    let finite = placed.filter(|(_, (_, state))| finite(state));
    let pieces = finite.flat_map(|(i, (body, state))| {
        body.shapes.iter().map(move |shape| {
            let corners = shape.corners().into_iter().map(|p| pose(state).apply(p)).collect();
            piece(i, body, corners, shape.radius())
        })
    });
    let mut pieces: Vec<Piece> = pieces.collect();
    pieces.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
    pieces
}

/// The deepest overlap among pieces sorted by their left ends (sweep and prune), of those that may touch.
fn deepest(pieces: &[Piece], joints: &[Joint]) -> Real {
    let joined: HashSet<[usize; 2]> =
        joints.iter().flat_map(|Joint { bodies: [a, b], .. }| [[*a, *b], [*b, *a]]).collect();
    let mut deepest: Real = 0.0;
    for (i, a) in pieces.iter().enumerate() {
        for b in pieces[i + 1..].iter().take_while(|b| b.low.x < a.high.x) {
            let apart = a.low.y >= b.high.y || b.low.y >= a.high.y;
            let grouped = a.group == b.group && a.group != 0;
            let may = a.body != b.body && (a.dynamic || b.dynamic) && !grouped;
            if !apart && may && !joined.contains(&[a.body, b.body]) {
                deepest = deepest.max(overlap(a, b));
            }
        }
    }
    deepest
}

/// The shortest way that parts two pieces; not above 0 if they are apart.
fn overlap(a: &Piece, b: &Piece) -> Real {
    let distance = match (&a.corners[..], &b.corners[..]) {
        ([p], [q]) => (p - q).norm(),
        ([p], polygon) | (polygon, [p]) => distance_to(polygon, *p),
        (p, q) => separation(p, q).max(separation(q, p)),
    };
    a.radius + b.radius - distance
}

fn edges(polygon: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().copied().zip(next.copied())
}

/// Largest distance of all of `others` from the line of an edge of a counter-clockwise polygon.
/// The larger of the two ways round is below 0 where polygons overlap, and its size is then the
/// shortest way that parts them (separating axes: the facets of their Minkowski difference).
fn separation(polygon: &[Vec2], others: &[Vec2]) -> Real {
    let beyond = edges(polygon).map(|(p, q)| {
        let normal = -perp(q - p).normalize();
        others.iter().map(|other| normal.dot(&(other - p))).fold(Real::INFINITY, Real::min)
    });
    beyond.fold(Real::NEG_INFINITY, Real::max)
}

/// Distance of a point from a counter-clockwise polygon; below 0 inside.
fn distance_to(polygon: &[Vec2], point: Vec2) -> Real {
    let inside = separation(polygon, &[point]);
    if inside <= 0.0 && polygon.len() > 2 {
        return inside;
    }
    let to_edge = edges(polygon).map(|(p, q)| {
        let (edge, arm) = (q - p, point - p);
        let along = (arm.dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0);
        (arm - edge * along).norm()
    });
    to_edge.fold(Real::INFINITY, Real::min)
}
