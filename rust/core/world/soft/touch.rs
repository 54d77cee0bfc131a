//! Where the borders of deformable bodies touch what is around them.

use super::advance::{Against, Pair};
use super::look::bounds;
use crate::body::{Bodies, Role};
use crate::collision::{Convex, Frame, Geometry, Manifold, Normal, collide};
use crate::constraints::matter::{Grip, Point, Side};
use crate::math::{Real, Vec2, perp};
use crate::methods::contact_step::Group;
use crate::shapes::Aabb;
use crate::soft::SoftBody;
use crate::world::contacts::{Contacts, Entry};

/// Pieces of the borders as shapes, where they are now.
#[derive(Clone, Debug, Default)]
pub struct Borders {
    of_body: Vec<Border>,
    found: Vec<Manifold>,
}

#[derive(Clone, Debug, Default)]
struct Border {
    /// What places are counted from, so that none far from the world's origin loses digits (m).
    origin: Vec2,
    pieces: Vec<Geometry>,
    boxes: Vec<Aabb>,
    bounds: Option<Aabb>,
    /// Fastest of its nodes (m/s).
    speed: Real,
}

/// A number of a feature that is a piece of a border, not a node.
pub const PIECE: u32 = 1 << 31;

/// A point nearer to a node than this part of its piece is at the node.
const AT_NODE: Real = 1e-6;

/// Part of the mean side of a border within which things count as near whatever they do.
const NEAR: Real = 0.02;

impl Borders {
    /// Moves the pieces of a border to where its nodes are.
    pub fn follow(&mut self, k: usize, body: &SoftBody) {
        if self.of_body.len() <= k {
            self.of_body.resize(k + 1, Border::default());
        }
        let border = &mut self.of_body[k];
        let edges = body.def().mesh.border();
        let (at, radius) = (body.positions(), body.radius());
        border.origin = at[0];
        if border.pieces.len() != edges.len() {
            let empty = || Geometry::Convex(Convex::new(vec![Vec2::zeros(), Vec2::x()], radius));
            border.pieces = edges.iter().map(|_| empty()).collect();
        }
        border.boxes.clear();
        for (piece, edge) in border.pieces.iter_mut().zip(edges) {
            let [p, q] = edge.map(|i| at[i as usize] - border.origin);
            let Geometry::Convex(convex) = piece else { continue };
            convex.radius = radius;
            convex.vertices.copy_from_slice(&[p, q]);
            let way = q - p;
            let length = way.norm();
            // A piece without a length has no face; any direction does.
            let normal = if length > 0.0 { -perp(way) / length } else { Vec2::y() };
            convex.normals.copy_from_slice(&[normal, -normal]);
            border.boxes.push(Aabb { min: p.inf(&q), max: p.sup(&q) });
        }
        border.bounds = Some(bounds(body).moved(-border.origin));
        border.speed = body.velocities().iter().map(Vec2::norm).fold(0.0, Real::max);
    }

    /// Adds the points at which a pair touches or may touch in a substep of length h (s).
    pub fn touch(
        &mut self,
        pair: &Pair,
        (softs, list): (&[SoftBody], &[u32]),
        (group, bodies, contacts): (&Group, &Bodies, &Contacts),
        (h, points): (Real, &mut Vec<Point>),
    ) {
        match pair.against {
            Against::Proxy(proxy, body) => {
                let entry = contacts.entry(proxy);
                let Some(rigid) = Rigid::new(entry, body, group, bodies) else { return };
                self.touch_rigid(pair, (softs, list), (&rigid, proxy.0), (h, points));
            }
            Against::Soft(other) => self.touch_soft(pair, other, (softs, list), (h, points)),
        }
    }

    fn touch_rigid(
        &mut self,
        pair: &Pair,
        (softs, list): (&[SoftBody], &[u32]),
        (rigid, number): (&Rigid<'_>, u32),
        (h, points): (Real, &mut Vec<Point>),
    ) {
        let Self { of_body, found } = self;
        let (border, body) = (&of_body[pair.soft as usize], &softs[pair.soft as usize]);
        let frame = Frame { position: rigid.frame.position - border.origin, rot: rigid.frame.rot };
        let margin = NEAR * body.side() + (border.speed + rigid.speed) * h;
        let around = rigid.entry.collider.geometry.bounds_at(&frame).grown(margin + body.radius());
        if border.bounds.is_none_or(|bounds| !bounds.overlaps(&around)) {
            return;
        }
        let edges = body.def().mesh.border();
        let piece_of = |k: u32| list.iter().position(|member| *member == k).unwrap_or(0) as u32;
        for (e, (piece, own)) in border.pieces.iter().zip(&border.boxes).enumerate() {
            if !own.overlaps(&around) {
                continue;
            }
            found.clear();
            collide(piece, &rigid.entry.collider.geometry, &frame, margin, found);
            for manifold in &*found {
                for anchor in &manifold.anchors[..manifold.count] {
                    let (a, b) = (anchor.on_a, frame.apply(anchor.on_b));
                    let normal = normal_of(manifold, (a, b), (&Frame::IDENTITY, &frame));
                    if rigid.is_passable(normal) {
                        continue;
                    }
                    let on_piece = if matches!(manifold.normal, Normal::OnA(_)) { b } else { a };
                    let foot = Foot::new(piece, edges[e], e, on_piece);
                    let feature = if foot.feature & PIECE == 0 { 0 } else { anchor.feature };
                    let arm = foot.place - frame.position;
                    points.push(Point {
                        sides: [foot.side(piece_of(pair.soft)), Side::Body(rigid.slot, arm)],
                        normal,
                        gap: normal.dot(&(b - a)) - manifold.radius_a - manifold.radius_b,
                        ..pair.point(body.side(), [pair.soft, foot.feature, number, feature])
                    });
                }
            }
        }
    }

    fn touch_soft(
        &mut self,
        pair: &Pair,
        other: u32,
        (softs, list): (&[SoftBody], &[u32]),
        (h, points): (Real, &mut Vec<Point>),
    ) {
        let Self { of_body, found } = self;
        let [x, y] = [pair.soft, other].map(|k| &of_body[k as usize]);
        let [a_body, b_body] = [pair.soft, other].map(|k| &softs[k as usize]);
        let itself = pair.soft == other;
        let frame = Frame { position: y.origin - x.origin, ..Frame::IDENTITY };
        let side = a_body.side().min(b_body.side());
        let margin = NEAR * side + (x.speed + y.speed) * h;
        let reach = margin + a_body.radius() + b_body.radius();
        let Some(around) = y.bounds.map(|bounds| bounds.moved(frame.position).grown(reach)) else {
            return;
        };
        let [a_edges, b_edges] = [a_body, b_body].map(|body| body.def().mesh.border());
        let rest = a_body.def().mesh.rest();
        let numbers = [pair.soft, other]
            .map(|k| list.iter().position(|member| *member == k).unwrap_or(0) as u32);
        for (i, (piece, own)) in x.pieces.iter().zip(&x.boxes).enumerate() {
            if !own.overlaps(&around) {
                continue;
            }
            let own = own.grown(reach);
            for (j, (against, its)) in y.pieces.iter().zip(&y.boxes).enumerate() {
                if !own.overlaps(&its.moved(frame.position))
                    || (itself && (j <= i || are_close(rest, a_edges[i], b_edges[j], side)))
                {
                    continue;
                }
                found.clear();
                collide(piece, against, &frame, margin, found);
                for manifold in &*found {
                    for anchor in &manifold.anchors[..manifold.count] {
                        let (a, b) = (anchor.on_a, frame.apply(anchor.on_b));
                        let normal = normal_of(manifold, (a, b), (&Frame::IDENTITY, &frame));
                        let (on_a, on_b) = match manifold.normal {
                            Normal::OnA(_) => (b, b),
                            Normal::OnB(_) => (a, a),
                            _ => (a, b),
                        };
                        let feet = [
                            Foot::new(piece, a_edges[i], i, on_a),
                            Foot::new(against, b_edges[j], j, on_b - frame.position),
                        ];
                        let key = [pair.soft, feet[0].feature, other | PIECE, feet[1].feature];
                        points.push(Point {
                            sides: [feet[0].side(numbers[0]), feet[1].side(numbers[1])],
                            normal,
                            gap: normal.dot(&(b - a)) - manifold.radius_a - manifold.radius_b,
                            ..pair.point(side, key)
                        });
                    }
                }
            }
        }
    }
}

/// Whether two pieces of one border are neighbours, or so near at rest that they always touch.
fn are_close(rest: &[Vec2], a: [u32; 2], b: [u32; 2], side: Real) -> bool {
    let middle = |edge: [u32; 2]| (rest[edge[0] as usize] + rest[edge[1] as usize]) * 0.5;
    a.iter().any(|i| b.contains(i)) || (middle(a) - middle(b)).norm() < 3.0 * side
}

/// Direction of a manifold's normal, A to B.
fn normal_of(manifold: &Manifold, (a, b): (Vec2, Vec2), frames: (&Frame, &Frame)) -> Vec2 {
    let along = |sign: Real| {
        let way = b - a;
        let length = way.norm();
        if length > 0.0 { way * (sign / length) } else { Vec2::y() }
    };
    match manifold.normal {
        Normal::OnA(normal) => frames.0.rot.apply(normal),
        Normal::OnB(normal) => frames.1.rot.apply(normal),
        Normal::Between => along(1.0),
        Normal::Inside => along(-1.0),
    }
}

/// A point of a piece of a border.
struct Foot {
    nodes: [u32; 2],
    weights: [Real; 2],
    /// From the origin of the border (m).
    place: Vec2,
    /// The node, or the piece where it is between its nodes.
    feature: u32,
}

impl Foot {
    fn new(piece: &Geometry, nodes: [u32; 2], number: usize, near: Vec2) -> Self {
        let [p, q] = match piece {
            Geometry::Convex(convex) => [convex.vertices[0], convex.vertices[1]],
            Geometry::Arc(_) => [near; 2],
        };
        let way = q - p;
        let square = way.norm_squared();
        let part = if square > 0.0 { way.dot(&(near - p)) / square } else { 0.0 };
        let part = part.clamp(0.0, 1.0);
        let (part, feature) = if part < AT_NODE {
            (0.0, nodes[0])
        } else if part > 1.0 - AT_NODE {
            (1.0, nodes[1])
        } else {
            (part, number as u32 | PIECE)
        };
        Self { nodes, weights: [1.0 - part, part], place: p + way * part, feature }
    }

    fn side(&self, piece: u32) -> Side {
        Side::Nodes(piece, self.nodes, self.weights)
    }
}

impl Pair {
    /// A point of this pair, its geometry to be filled in.
    fn point(&self, side: Real, key: [u32; 4]) -> Point {
        Point {
            sides: [Side::Body(0, Vec2::zeros()); 2],
            normal: Vec2::y(),
            gap: 0.0,
            width: side,
            friction: self.friction,
            restitution: self.restitution,
            tangent_speed: self.tangent_speed,
            grip: Grip { key, ..Grip::default() },
            handed: Vec2::zeros(),
        }
    }
}

/// A collider where it is in the middle of the substep.
struct Rigid<'a> {
    entry: &'a Entry,
    slot: u32,
    frame: Frame,
    /// Fastest of its points (m/s).
    speed: Real,
}

impl<'a> Rigid<'a> {
    fn new(entry: &'a Entry, body: u32, group: &Group, bodies: &Bodies) -> Option<Self> {
        let slot = group.bodies.iter().position(|other| *other == body)?;
        let place = &group.places[slot];
        let position = bodies.poses[body as usize].position + place.way;
        let twist = &group.velocities[slot].twist;
        let speed = twist.linear.norm() + twist.angular.abs() * entry.collider.reach;
        Some(Self { entry, slot: slot as u32, frame: Frame { position, rot: place.rot }, speed })
    }

    /// Whether what comes along a normal from the border passes: a platform that is touched from its other side.
    fn is_passable(&self, normal: Vec2) -> bool {
        match self.entry.role {
            Role::OneWay(side) => self.frame.rot.apply(side).dot(&-normal) < 0.5 * side.norm(),
            _ => false,
        }
    }
}
