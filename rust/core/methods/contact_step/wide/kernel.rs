//! Geometry and rows of eight contacts side by side: [`moved`], [`Block::place`], [`curvature`], [`path::passes`], [`row`] and
//! [`Block::prepare`], in the same order of operations, masks in place of branches.
//!
//! [`moved`]: crate::constraints::contact::moved
//! [`curvature`]: crate::constraints::contact::curvature
//! [`Block::place`]: crate::constraints::contact::Block::place
//! [`Block::prepare`]: crate::constraints::contact::Block::prepare
//! [`path::passes`]: super::super::path::passes
//! [`row`]: super::super::row

#![expect(clippy::needless_range_loop, reason = "lane l of several columns at once")]

use super::{BETWEEN, INSIDE, ON_B, Shape, TWO};
use crate::constraints::contact::SINGULAR;
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Rot, Twist, Vec2, cross, perp, vec2};
use crate::solvers::lanes::kernel::{any, mask, pick};
use crate::solvers::lanes::{FIRST, LANES, Lane, Mask, Packet, Response, SECOND, SLIDES};

/// A vector in each lane.
pub(super) type Lane2 = [Lane; 2];

/// One side of eight contacts: bodies gathered.
pub(super) struct Side {
    pub way: Lane2,
    pub rot: Lane2,
    pub twist: [Lane; 3],
    pub inverse: [Lane; 3],
    pub acceleration: [Lane; 3],
}

#[inline(always)]
pub(super) fn get(of: &Lane2, l: usize) -> Vec2 {
    vec2(of[0][l], of[1][l])
}

#[inline(always)]
fn set(of: &mut Lane2, l: usize, to: Vec2) {
    (of[0][l], of[1][l]) = (to.x, to.y);
}

#[inline(always)]
pub(super) fn twist(of: &[Lane; 3], l: usize) -> Twist {
    Twist::new(vec2(of[0][l], of[1][l]), of[2][l])
}

#[inline(always)]
pub(super) fn choose(mask: u64, yes: Vec2, no: Vec2) -> Vec2 {
    vec2(pick(mask, yes.x, no.x), pick(mask, yes.y, no.y))
}

#[inline(always)]
pub(super) fn rot(of: &Lane2, l: usize) -> Rot {
    Rot { cos: of[0][l], sin: of[1][l] }
}

#[inline(always)]
pub(super) fn gather(velocities: &[Velocity], places: &[Place], slots: &[u32; LANES]) -> Side {
    let zero = [0.0; LANES];
    let mut side = Side {
        way: [zero; 2],
        rot: [zero; 2],
        twist: [zero; 3],
        inverse: [zero; 3],
        acceleration: [zero; 3],
    };
    for l in 0..LANES {
        let (velocity, place) = (&velocities[slots[l] as usize], &places[slots[l] as usize]);
        set(&mut side.way, l, place.way);
        (side.rot[0][l], side.rot[1][l]) = (place.rot.cos, place.rot.sin);
        let Twist { linear, angular } = velocity.twist;
        (side.twist[0][l], side.twist[1][l], side.twist[2][l]) = (linear.x, linear.y, angular);
        let [x, y, spin] = velocity.inverse();
        (side.inverse[0][l], side.inverse[1][l], side.inverse[2][l]) = (x, y, spin);
        let Twist { linear, angular } = place.acceleration;
        (side.acceleration[0][l], side.acceleration[1][l]) = (linear.x, linear.y);
        side.acceleration[2][l] = angular;
    }
    side
}

/// Places a packet by the bodies in the middle of the substep of length h, before the kicks, and derives its rows for after
/// them. Raises `most` to the normal velocities that the substep's kick gives.
#[inline(always)]
pub fn place(
    (packet, response): (&mut Packet, &mut Response),
    shape: &mut Shape,
    (velocities, places): (&[Velocity], &[Place]),
    (h, most): (Real, &mut Lane),
) {
    let a = gather(velocities, places, &packet.bodies[0]);
    let b = gather(velocities, places, &packet.bodies[1]);
    let mut gap = [[0.0; LANES]; 2];
    let points = points(shape, [&a, &b], (&mut packet.normal, &mut gap));
    shape.gap = gap;
    arms(packet, shape, &points, [&a, &b]);
    let curves = curves(packet, shape, &points, [&a, &b]);
    targets(packet, shape, (&curves, h), [&a, &b]);
    respond(packet, response, [&a, &b]);
    note_fastest(packet, h, [&a, &b], most);
}

/// Points of eight manifolds in world coordinates.
pub(super) struct Points {
    apart: Lane2,
    on_a: [Lane2; 2],
    on_b: [Lane2; 2],
    between: [Lane2; 2],
    arms: [[Lane2; 2]; 2],
}

#[inline(always)]
pub(super) fn points(
    shape: &Shape,
    [a, b]: [&Side; 2],
    (normal, gaps): (&mut Lane2, &mut [Lane; 2]),
) -> Points {
    let zero = [[0.0; LANES]; 2];
    let mut points = Points {
        apart: zero,
        on_a: [zero; 2],
        on_b: [zero; 2],
        between: [zero; 2],
        arms: [[zero; 2]; 2],
    };
    for l in 0..LANES {
        let apart = get(&shape.apart, l) + (get(&b.way, l) - get(&a.way, l));
        set(&mut points.apart, l, apart);
    }
    for k in 0..2 {
        for l in 0..LANES {
            let on_a = rot(&a.rot, l).apply(get(&shape.on_a[k], l));
            let on_b = rot(&b.rot, l).apply(get(&shape.on_b[k], l));
            set(&mut points.on_a[k], l, on_a);
            set(&mut points.on_b[k], l, on_b);
            set(&mut points.between[k], l, get(&points.apart, l) + on_b - on_a);
        }
    }
    for l in 0..LANES {
        let on_b = mask(shape.kind[l] & ON_B != 0);
        let (ra, rb) = (rot(&a.rot, l), rot(&b.rot, l));
        let holder = Rot { cos: pick(on_b, rb.cos, ra.cos), sin: pick(on_b, rb.sin, ra.sin) };
        set(normal, l, holder.apply(get(&shape.normal, l)));
    }
    if shape.corners {
        for l in 0..LANES {
            let corners = mask(shape.kind[l] & (BETWEEN | INSIDE) != 0);
            let between = get(&points.between[0], l);
            let length = (between.x * between.x + between.y * between.y).sqrt();
            let sign = if shape.kind[l] & INSIDE != 0 { -1.0 } else { 1.0 };
            let along = choose(mask(length > 0.0), between * (sign / length), vec2(0.0, 1.0));
            let face = get(normal, l);
            set(normal, l, choose(corners, along, face));
        }
    }
    for k in 0..2 {
        for l in 0..LANES {
            let kind = shape.kind[l];
            let (corners, on_b) = (mask(kind & (BETWEEN | INSIDE) != 0), mask(kind & ON_B != 0));
            let (at_a, at_b) = (get(&points.on_a[k], l), get(&points.on_b[k], l));
            let apart = get(&points.apart, l);
            let there = mask(k == 0 || kind & TWO != 0);
            let from_a = choose(corners | on_b, at_a, apart + at_b);
            let from_b = choose(on_b, at_a - apart, at_b);
            set(&mut points.arms[k][0], l, from_a);
            set(&mut points.arms[k][1], l, from_b);
            let n = get(normal, l);
            let gap = n.dot(&get(&points.between[k], l)) - (shape.radii[0][l] + shape.radii[1][l]);
            gaps[k][l] = pick(there, gap, 0.0);
        }
    }
    points
}

/// Lever arms of the normal rows.
#[inline(always)]
pub(super) fn arms_of(shape: &Shape, normal: &Lane2, points: &Points) -> [[Lane; 2]; 2] {
    let mut arms = [[[0.0; LANES]; 2]; 2];
    for k in 0..2 {
        for l in 0..LANES {
            let there = if k == 0 { mask(true) } else { mask(shape.kind[l] & TWO != 0) };
            let n = get(normal, l);
            arms[k][0][l] = pick(there, cross(get(&points.arms[k][0], l), n), 0.0);
            arms[k][1][l] = pick(there, cross(get(&points.arms[k][1], l), n), 0.0);
        }
    }
    arms
}

/// Lever arms of the three rows.
#[inline(always)]
fn arms(packet: &mut Packet, shape: &Shape, points: &Points, [a, b]: [&Side; 2]) {
    let [first, second] = arms_of(shape, &packet.normal, points);
    (packet.arms[0], packet.arms[1]) = (first, second);
    let mut heights = [[0.0; LANES]; 2];
    for k in 0..2 {
        for l in 0..LANES {
            let kind = shape.kind[l];
            let there = mask(k == 0 || kind & TWO != 0);
            let (corners, on_b) = (mask(kind & (BETWEEN | INSIDE) != 0), mask(kind & ON_B != 0));
            let n = get(&packet.normal, l);
            let (from_a, from_b) = (get(&points.arms[k][0], l), get(&points.arms[k][1], l));
            let (of_a, of_b) = (n.dot(&from_a), n.dot(&from_b));
            let (radius_a, radius_b, gap) = (shape.radii[0][l], shape.radii[1][l], shape.gap[k][l]);
            let a_height = pick(corners | on_b, of_a + radius_a, of_a - radius_b - gap);
            let b_height = pick(on_b, of_b + radius_a + gap, of_b - radius_b);
            let fixed = |side: &Side| {
                let [x, y, spin] = [0, 1, 2].map(|k| side.inverse[k][l] == 0.0);
                x & y & spin
            };
            let (a_fixed, b_fixed) = (fixed(a), fixed(b));
            let (a_alone, b_alone) = (mask(a_fixed & !b_fixed), mask(b_fixed & !a_fixed));
            let share_a = pick(a_alone, 1.0, pick(b_alone, 0.0, 0.5));
            let share_b = pick(b_alone, 1.0, pick(a_alone, 0.0, 0.5));
            heights[0][l] += pick(there, a_height + share_a * gap, 0.0);
            heights[1][l] += pick(there, b_height - share_b * gap, 0.0);
        }
    }
    for l in 0..LANES {
        let mean = if shape.kind[l] & TWO != 0 { 0.5 } else { 1.0 };
        packet.arms[2][0][l] = heights[0][l] * mean;
        packet.arms[2][1][l] = heights[1][l] * mean;
    }
}

/// J̇v of the normals, and of the tangent where the load sticks; points that go past one another.
struct Curves {
    normal: [Lane; 2],
    turning: Lane,
    passes: [[u64; LANES]; 2],
}

#[inline(always)]
fn curves(packet: &Packet, shape: &Shape, points: &Points, [a, b]: [&Side; 2]) -> Curves {
    let mut curves =
        Curves { normal: [[0.0; LANES]; 2], turning: [0.0; LANES], passes: [[0; LANES]; 2] };
    curves_of_point(0, packet, shape, points, ([a, b], &mut curves));
    if packet.two {
        curves_of_point(1, packet, shape, points, ([a, b], &mut curves));
    }
    curves
}

#[inline(always)]
fn curves_of_point(
    k: usize,
    packet: &Packet,
    shape: &Shape,
    points: &Points,
    ([a, b], curves): ([&Side; 2], &mut Curves),
) {
    let (mut face, mut corner) = ([[0.0; LANES]; 2], ([[0.0; LANES]; 2], [0; LANES]));
    if shape.faces {
        face = of_faces(k, packet, shape, points, [a, b]);
    }
    if shape.corners {
        corner = of_corners(k, packet, shape, points, [a, b]);
    }
    let (corner, passes) = corner;
    for l in 0..LANES {
        let kind = shape.kind[l];
        let there = if k == 0 { mask(true) } else { mask(kind & TWO != 0) };
        let corners = mask(kind & (BETWEEN | INSIDE) != 0);
        let loaded = mask(packet.impulse[k][l] > 0.0);
        let apart = mask(shape.gap[k][l] > 0.0);
        let counts = (loaded | apart) & there;
        curves.normal[k][l] = pick(counts, pick(corners, corner[0][l], face[0][l]), 0.0);
        let tangent = pick(counts, pick(corners, corner[1][l], face[1][l]), 0.0);
        let load = packet.impulse[0][l] + packet.impulse[1][l];
        let sticks = loaded & mask(packet.flags[l] & SLIDES == 0);
        let share = pick(sticks, packet.impulse[k][l] / load, 0.0);
        curves.turning[l] += pick(counts, share * tangent, 0.0);
        curves.passes[k][l] = passes[l] & apart & !loaded & mask(kind & BETWEEN != 0);
    }
}

/// J̇v of normals and tangents where a face holds the normal.
#[inline(always)]
fn of_faces(
    k: usize,
    packet: &Packet,
    shape: &Shape,
    points: &Points,
    [a, b]: [&Side; 2],
) -> [Lane; 2] {
    let mut face = [[0.0; LANES]; 2];
    for l in 0..LANES {
        // The body of the face turns with wf, the point of the other is r away from that one's centre.
        let on_b = mask(shape.kind[l] & ON_B != 0);
        let (va, vb) = (twist(&a.twist, l), twist(&b.twist, l));
        let (at_a, at_b) = (get(&points.on_a[k], l), get(&points.on_b[k], l));
        let (wa, wb) = (va.angular, vb.angular);
        let r = choose(on_b, at_a, at_b);
        let (wr, wf) = (pick(on_b, wa, wb), pick(on_b, wb, wa));
        let of_point = choose(on_b, va.at(at_a), vb.at(at_b));
        let of_face = choose(on_b, vb.linear, va.linear);
        let arm = choose(on_b, at_a - get(&points.apart, l), get(&points.apart, l) + at_b);
        let rate = of_point - of_face;
        let along = -r * (wr * wr) - perp(rate) * (2.0 * wf) - arm * (wf * wf);
        let n = get(&packet.normal, l);
        let (normal, tangent) = (n.dot(&along), perp(n).dot(&along));
        let turns = mask((wa != 0.0) | (wb != 0.0));
        face[0][l] = pick(turns, pick(on_b, -normal, normal), 0.0);
        face[1][l] = pick(turns, pick(on_b, -tangent, tangent), 0.0);
    }
    face
}

/// The same of two corners, sharp or round, and whether they come nearer and yet go past.
#[inline(always)]
fn of_corners(
    k: usize,
    packet: &Packet,
    shape: &Shape,
    points: &Points,
    [a, b]: [&Side; 2],
) -> ([Lane; 2], Mask) {
    let (mut corner, mut passes) = ([[0.0; LANES]; 2], [0; LANES]);
    for l in 0..LANES {
        let (va, vb) = (twist(&a.twist, l), twist(&b.twist, l));
        let (at_a, at_b) = (get(&points.on_a[k], l), get(&points.on_b[k], l));
        let (wa, wb) = (va.angular, vb.angular);
        let n = get(&packet.normal, l);
        let t = perp(n);
        let rate = vb.at(at_b) - va.at(at_a);
        let spin = at_a * (wa * wa) - at_b * (wb * wb);
        let (aside, length) = (rate.dot(&t), get(&points.between[k], l).dot(&n));
        let turning = pick(mask(length == 0.0), 0.0, aside / length);
        corner[0][l] = n.dot(&spin) + aside * turning;
        corner[1][l] = t.dot(&spin) - rate.dot(&n) * turning;
        let radii = shape.radii[0][l] + shape.radii[1][l];
        let speed = (rate.x * rate.x + rate.y * rate.y).sqrt();
        passes[l] = mask((shape.gap[k][l] + radii) * t.dot(&rate).abs() > radii * speed);
    }
    (corner, passes)
}

/// Targets of the rows, and which take part.
#[inline(always)]
fn targets(packet: &mut Packet, shape: &Shape, (curves, h): (&Curves, Real), [a, b]: [&Side; 2]) {
    let mut kicked = [[[0.0; LANES]; 3]; 2];
    for (of, side) in [(0, a), (1, b)] {
        for k in 0..3 {
            for l in 0..LANES {
                // Two halves of a kick.
                let half = side.acceleration[k][l] * (h / 2.0);
                kicked[of][k][l] = side.twist[k][l] + half + half;
            }
        }
    }
    normal_target(0, packet, shape, (curves, h), ([a, b], &kicked));
    if packet.two {
        normal_target(1, packet, shape, (curves, h), ([a, b], &kicked));
    }
    for l in 0..LANES {
        packet.target[2][l] = shape.tangent_speed[l] - 0.5 * h * curves.turning[l];
    }
}

/// Target of the normal row of a point, and whether it takes part.
#[inline(always)]
fn normal_target(
    k: usize,
    packet: &mut Packet,
    shape: &Shape,
    (curves, h): (&Curves, Real),
    ([a, b], kicked): ([&Side; 2], &[[Lane; 3]; 2]),
) {
    for l in 0..LANES {
        let there = mask(k == 0 || shape.kind[l] & TWO != 0);
        let n = get(&packet.normal, l);
        let (arm_a, arm_b) = (packet.arms[k][0][l], packet.arms[k][1][l]);
        let (va, vb) = (twist(&kicked[0], l), twist(&kicked[1], l));
        let along = n.dot(&(vb.linear - va.linear)) + (arm_b * vb.angular - arm_a * va.angular);
        let (fa, fb) = (twist(&a.acceleration, l), twist(&b.acceleration, l));
        let spin = arm_b * fb.angular - arm_a * fa.angular;
        let kick = (n.dot(&(fb.linear - fa.linear)) + spin) * h;
        let (gap, bend) = (shape.gap[k][l], curves.normal[k][l] * h);
        let loaded = packet.impulse[k][l] > 0.0;
        let left = kick - along;
        let left = pick(mask(left > 0.0), left, 0.0);
        let curve = -0.5 * bend;
        let wanted = pick(mask(loaded), pick(mask(curve < left), curve, left), 0.0);
        let opens = pick(mask(bend > 0.0), bend, 0.0);
        let opening = pick(mask(loaded), 0.0, 0.5 * opens);
        let touches = mask((gap <= 0.0) | (loaded & (gap <= (bend * h).abs())));
        let target = pick(touches, wanted, -gap / h - opening);
        packet.target[k][l] = pick(there, target, 0.0);
        let on = there & (touches | !curves.passes[k][l]);
        let flag = if k == 0 { FIRST } else { SECOND };
        packet.flags[l] = (packet.flags[l] & !flag) | (on & flag);
    }
}

/// J M⁻¹ Jᵀ, and its inverse over the rows that are on.
#[inline(always)]
fn respond(packet: &mut Packet, response: &mut Response, [a, b]: [&Side; 2]) {
    response[0] = coupling(packet, (0, 0), [a, b]);
    response[3] = coupling(packet, (0, 2), [a, b]);
    response[5] = coupling(packet, (2, 2), [a, b]);
    let mut inverse = [[0.0; LANES]; 6];
    if packet.two {
        response[1] = coupling(packet, (1, 1), [a, b]);
        response[2] = coupling(packet, (0, 1), [a, b]);
        response[4] = coupling(packet, (1, 2), [a, b]);
        inverse = inverse_of_three(packet, response);
    }
    let mut single = [0; LANES];
    for l in 0..LANES {
        let flags = packet.flags[l];
        single[l] = mask(flags & FIRST != 0) ^ mask(flags & SECOND != 0);
    }
    if any(&single) {
        add_inverse_of_two(packet, response, &single, &mut inverse);
    }
    packet.inverse = inverse;
}

/// Inverses where both points are on; zero elsewhere.
#[inline(always)]
fn inverse_of_three(packet: &Packet, response: &Response) -> [Lane; 6] {
    let mut inverse = [[0.0; LANES]; 6];
    for l in 0..LANES {
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k| response[k][l]);
        let minors = [
            b * f - e * e,
            a * f - d * d,
            d * e - c * f,
            c * e - b * d,
            c * d - a * e,
            a * b - c * c,
        ];
        let det = a * minors[0] + c * minors[2] + d * minors[3];
        let both = mask(packet.flags[l] & FIRST != 0) & mask(packet.flags[l] & SECOND != 0);
        let regular = mask(det > SINGULAR * a * b * f) & both;
        for k in 0..6 {
            inverse[k][l] = pick(regular, minors[k] / det, 0.0);
        }
    }
    inverse
}

/// The same where a single one is.
#[inline(always)]
fn add_inverse_of_two(
    packet: &Packet,
    response: &Response,
    single: &Mask,
    inverse: &mut [Lane; 6],
) {
    for l in 0..LANES {
        let first = mask(packet.flags[l] & FIRST != 0);
        let p = pick(first, response[0][l], response[1][l]);
        let c = pick(first, response[3][l], response[4][l]);
        let q = response[5][l];
        let det = p * q - c * c;
        let regular = mask(det > SINGULAR * p * q) & single[l];
        let (own, mixed, t) = (q / det, -c / det, p / det);
        let (of_first, of_second) = (regular & first, regular & !first);
        inverse[0][l] = pick(of_first, own, inverse[0][l]);
        inverse[1][l] = pick(of_second, own, inverse[1][l]);
        inverse[3][l] = pick(of_first, mixed, inverse[3][l]);
        inverse[4][l] = pick(of_second, mixed, inverse[4][l]);
        inverse[5][l] = pick(regular, t, inverse[5][l]);
    }
}

/// J M⁻¹ J'ᵀ of rows i and j, of which 2 is the tangent.
#[inline(always)]
fn coupling(packet: &Packet, (i, j): (usize, usize), [a, b]: [&Side; 2]) -> Lane {
    let mut sum = [0.0; LANES];
    for l in 0..LANES {
        let n = get(&packet.normal, l);
        let (d, e) = (if i == 2 { perp(n) } else { n }, if j == 2 { perp(n) } else { n });
        let of_a = vec2(a.inverse[0][l], a.inverse[1][l]).component_mul(&d).dot(&e)
            + a.inverse[2][l] * packet.arms[i][0][l] * packet.arms[j][0][l];
        let of_b = vec2(b.inverse[0][l], b.inverse[1][l]).component_mul(&d).dot(&e)
            + b.inverse[2][l] * packet.arms[i][1][l] * packet.arms[j][1][l];
        sum[l] = of_a + of_b;
    }
    sum
}

/// Raises `fastest` to the normal velocities that the kick gives.
#[inline(always)]
fn note_fastest(packet: &Packet, h: Real, [a, b]: [&Side; 2], fastest: &mut Lane) {
    for l in 0..LANES {
        let (fa, fb) = (twist(&a.acceleration, l), twist(&b.acceleration, l));
        let speed = get(&packet.normal, l).dot(&(fb.linear - fa.linear)).abs() * h;
        fastest[l] = if speed > fastest[l] { speed } else { fastest[l] };
    }
}

/// Which of eight contacts will overlap; see [`super::super::project`].
#[inline(always)]
pub(super) fn coming(
    packet: &Packet,
    shape: &Shape,
    velocities: &[Velocity],
    (h, slop): (Real, Real),
) -> Mask {
    let along = normal_velocities(packet, velocities);
    let mut coming = [0; LANES];
    for k in 0..2 {
        let flag = if k == 0 { FIRST } else { SECOND };
        for l in 0..LANES {
            let overlaps = shape.gap[k][l] + 0.5 * h * along[k][l] < -slop * shape.width[l];
            coming[l] |= mask(overlaps & (packet.flags[l] & flag != 0));
        }
    }
    coming
}

/// Velocities along the normals.
#[inline(always)]
pub(super) fn normal_velocities(packet: &Packet, velocities: &[Velocity]) -> [Lane; 2] {
    let mut twists = [[[0.0; LANES]; 3]; 2];
    for side in 0..2 {
        for l in 0..LANES {
            let Twist { linear, angular } = velocities[packet.bodies[side][l] as usize].twist;
            (twists[side][0][l], twists[side][1][l]) = (linear.x, linear.y);
            twists[side][2][l] = angular;
        }
    }
    let mut along = [[0.0; LANES]; 2];
    for k in 0..2 {
        for l in 0..LANES {
            let (va, vb) = (twist(&twists[0], l), twist(&twists[1], l));
            let spin = packet.arms[k][1][l] * vb.angular - packet.arms[k][0][l] * va.angular;
            along[k][l] = get(&packet.normal, l).dot(&(vb.linear - va.linear)) + spin;
        }
    }
    along
}

/// No row asks for more than that it leaves as fast as it came.
pub fn limit(packet: &mut Packet, shape: &Shape, starts: &[Velocity]) {
    let came = normal_velocities(packet, starts);
    for k in 0..2 {
        for l in 0..LANES {
            if k == 0 || shape.kind[l] & TWO != 0 {
                packet.target[k][l] = packet.target[k][l].min(-came[k][l]);
            }
        }
    }
}
