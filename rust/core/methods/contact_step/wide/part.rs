//! Eight overlaps at a time moved apart: [`super::super::project`]'s passes, masks in place of branches.

#![expect(clippy::needless_range_loop, reason = "lane l of several columns at once")]

use super::kernel::{Lane2, Points, Side, arms_of, coming, gather, get, points, rot, twist};
use super::{Shape, TWO};
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Rot, Twist, cross, perp, vec2};
use crate::methods::contact_step::Mass;
use crate::methods::contact_step::project::{MOST, PART, SLOP};
use crate::solvers::lanes::kernel::{any, mask, pick};
use crate::solvers::lanes::{FIRST, LANES, Lane, Mask, Packet, SECOND};

/// Bodies of a group, with one more that empty lanes move.
pub struct Bodies<'a> {
    pub velocities: &'a mut [Velocity],
    pub places: &'a mut [Place],
    pub masses: &'a [Mass],
}

/// What parting a packet's overlaps did: which lanes, the work against forces of A and B, what turning them back took, and
/// the largest change of velocity.
pub struct Parted {
    pub lanes: Mask,
    pub work: [Lane; 4],
    pub largest: Lane,
}

/// Parts what overlaps in a packet. In the first pass only what is foreseen to overlap at the end of the substep of length h.
#[inline(always)]
pub fn part(
    packet: &Packet,
    shape: &Shape,
    bodies: &mut Bodies<'_>,
    (pass, h): (usize, Real),
) -> Option<Parted> {
    let foreseen = if pass == 0 {
        coming(packet, shape, bodies.velocities, (h, SLOP))
    } else {
        [mask(true); LANES]
    };
    if !any(&foreseen) {
        return None;
    }
    let a = gather(bodies.velocities, bodies.places, &packet.bodies[0]);
    let b = gather(bodies.velocities, bodies.places, &packet.bodies[1]);
    let (mut normal, mut gap) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
    let points = points(shape, [&a, &b], (&mut normal, &mut gap));
    let now = Now { normal, gap, points };
    let overlaps = overlaps(shape, &now.gap, &foreseen);
    if !any(&overlaps) {
        return None;
    }
    let arms = arms_of(shape, &now.normal, &now.points);
    let wanted = wanted(packet, (shape, &now), (&arms, h), ([&a, &b], &overlaps));
    if !any(&wanted.acts) {
        return None;
    }
    let push = pushes((&now.normal, &arms), &wanted, [&a, &b]);
    let moved = [
        moved(&now.normal, (&arms, 0), (&push, -1.0), &a),
        moved(&now.normal, (&arms, 1), (&push, 1.0), &b),
    ];
    let masses = [0, 1].map(|side| masses(bodies.masses, &packet.bodies[side]));
    let works = [0, 1].map(|side| work(&masses[side], &moved[side], [&a, &b][side]));
    let back = turn_back(shape, (&moved, &masses), [&a, &b], &wanted.acts);
    for side in 0..2 {
        let slots = &packet.bodies[side];
        put(bodies, slots, (&moved[side], [&a, &b][side]), &wanted.acts);
        turn(bodies, slots, (&back.change[side], [&a, &b][side]), &back.acts);
    }
    let [first, second] = works;
    let [third, fourth] = back.work;
    Some(Parted { lanes: wanted.acts, work: [first, second, third, fourth], largest: back.largest })
}

/// Geometry at hand.
struct Now {
    normal: Lane2,
    gap: [Lane; 2],
    points: Points,
}

#[inline(always)]
fn overlaps(shape: &Shape, gap: &[Lane; 2], among: &Mask) -> Mask {
    let mut overlaps = [0; LANES];
    for l in 0..LANES {
        let least = -(SLOP * shape.width[l]);
        let second = (shape.kind[l] & TWO != 0) & (gap[1][l] < least);
        overlaps[l] = among[l] & mask((gap[0][l] < least) | second);
    }
    overlaps
}

/// How far points are to be moved apart, and lanes in which any is.
struct Wanted {
    on: [Mask; 2],
    way: [Lane; 2],
    acts: Mask,
}

#[inline(always)]
fn wanted(
    packet: &Packet,
    (shape, now): (&Shape, &Now),
    (arms, h): (&[[Lane; 2]; 2], Real),
    ([a, b], among): ([&Side; 2], &Mask),
) -> Wanted {
    let mut wanted = Wanted { on: [[0; LANES]; 2], way: [[0.0; LANES]; 2], acts: [0; LANES] };
    for k in 0..2 {
        let flag = if k == 0 { FIRST } else { SECOND };
        for l in 0..LANES {
            let (va, vb) = (twist(&a.twist, l), twist(&b.twist, l));
            let along = get(&now.normal, l).dot(&(vb.linear - va.linear))
                + (arms[k][1][l] * vb.angular - arms[k][0][l] * va.angular);
            let (gap, slop) = (now.gap[k][l], SLOP * shape.width[l]);
            let stays = gap + 2.0 * h * along < 0.0;
            let there = (k == 0) | (shape.kind[l] & TWO != 0);
            let on = stays & there & (gap < -slop) & (packet.flags[l] & flag != 0);
            let on = mask(on) & among[l];
            let (part, most) = (-PART * (gap + slop), MOST * shape.width[l]);
            wanted.on[k][l] = on;
            wanted.way[k][l] = pick(on, if most < part { most } else { part }, 0.0);
            wanted.acts[l] |= on;
        }
    }
    wanted
}

/// Shares of the two points that move both by what is wanted, or one of them at least that much.
#[inline(always)]
fn pushes(
    (normal, arms): (&Lane2, &[[Lane; 2]; 2]),
    wanted: &Wanted,
    [a, b]: [&Side; 2],
) -> [Lane; 2] {
    let mut push = [[0.0; LANES]; 2];
    for l in 0..LANES {
        let n = get(normal, l);
        let straight =
            |side: &Side| vec2(side.inverse[0][l], side.inverse[1][l]).component_mul(&n).dot(&n);
        let (of_a, of_b) = (straight(a), straight(b));
        let k = |i: usize, j: usize| {
            (of_a + a.inverse[2][l] * arms[i][0][l] * arms[j][0][l])
                + (of_b + b.inverse[2][l] * arms[i][1][l] * arms[j][1][l])
        };
        let (k00, k11, k01) = (k(0, 0), k(1, 1), k(0, 1));
        let (x, y) = (wanted.way[0][l], wanted.way[1][l]);
        let det = k00 * k11 - k01 * k01;
        let (p, q) = ((k11 * x - k01 * y) / det, (k00 * y - k01 * x) / det);
        let both = mask((det > 1e-6 * k00 * k11) & (p >= 0.0) & (q >= 0.0))
            & wanted.on[0][l]
            & wanted.on[1][l];
        let first = pick(mask(k00 > 0.0), x / k00, 0.0);
        let second = pick(mask(k11 > 0.0), y / k11, 0.0);
        let larger = mask(first > second);
        push[0][l] = pick(both, p, pick(larger, first, 0.0));
        push[1][l] = pick(both, q, pick(larger, 0.0, second));
    }
    push
}

/// Ways and turns of one side's bodies.
struct Moves {
    way: Lane2,
    turn: Lane,
}

#[inline(always)]
fn moved(
    normal: &Lane2,
    (arms, of): (&[[Lane; 2]; 2], usize),
    (push, sign): (&[Lane; 2], Real),
    side: &Side,
) -> Moves {
    let mut moves = Moves { way: [[0.0; LANES]; 2], turn: [0.0; LANES] };
    for l in 0..LANES {
        let (p, q) = (sign * push[0][l], sign * push[1][l]);
        let torque = arms[0][of][l] * p + arms[1][of][l] * q;
        let sum = get(normal, l) * (p + q);
        moves.way[0][l] = side.inverse[0][l] * sum.x;
        moves.way[1][l] = side.inverse[1][l] * sum.y;
        moves.turn[l] = side.inverse[2][l] * torque;
    }
    moves
}

/// m and I.
#[inline(always)]
fn masses(masses: &[Mass], slots: &[u32; LANES]) -> [Lane; 2] {
    let mut columns = [[0.0; LANES]; 2];
    for l in 0..LANES {
        let Mass { mass, inertia } = masses[slots[l] as usize];
        (columns[0][l], columns[1][l]) = (mass, inertia);
    }
    columns
}

/// Work of the forces along a move.
#[inline(always)]
fn work([mass, inertia]: &[Lane; 2], moves: &Moves, side: &Side) -> Lane {
    let mut work = [0.0; LANES];
    for l in 0..LANES {
        let force = twist(&side.acceleration, l);
        work[l] = mass[l] * force.linear.dot(&get(&moves.way, l))
            + inertia[l] * force.angular * moves.turn[l];
    }
    work
}

/// Changes of velocity that give back the angular momentum which moving took.
struct Back {
    acts: Mask,
    change: [[Lane; 3]; 2],
    work: [Lane; 2],
    largest: Lane,
}

#[inline(always)]
fn turn_back(
    shape: &Shape,
    (moves, masses): (&[Moves; 2], &[[Lane; 2]; 2]),
    [a, b]: [&Side; 2],
    among: &Mask,
) -> Back {
    let zero = [0.0; LANES];
    let mut back =
        Back { acts: [0; LANES], change: [[zero; 3]; 2], work: [zero; 2], largest: zero };
    for l in 0..LANES {
        let carried = |side: usize, of: &Side| {
            masses[side][0][l] * cross(get(&moves[side].way, l), twist(&of.twist, l).linear)
        };
        let carried = carried(0, a) + carried(1, b);
        let free = |side: &Side| {
            let [x, y, spin] = [0, 1, 2].map(|k| side.inverse[k][l] > 0.0);
            x & y & spin
        };
        let acts = mask((carried != 0.0) & free(a) & free(b)) & among[l];
        let ways =
            (get(&b.way, l) + get(&moves[1].way, l)) - (get(&a.way, l) + get(&moves[0].way, l));
        let apart = get(&shape.apart, l) + ways;
        let (m, n) = (masses[0][0][l], masses[1][0][l]);
        let shares = [-n / (m + n), m / (m + n)];
        let square = apart.x * apart.x + apart.y * apart.y;
        let inertia = masses[0][1][l] + masses[1][1][l] + n * shares[1] * square;
        let turn = -carried / inertia;
        back.acts[l] = acts;
        for (side, of) in [(0, a), (1, b)] {
            let change = perp(apart) * (shares[side] * turn);
            let old = twist(&of.twist, l);
            let new = Twist::new(old.linear + change, old.angular + turn);
            let mean =
                Twist::new((old.linear + new.linear) * 0.5, 0.5 * (old.angular + new.angular));
            let work = masses[side][0][l] * change.dot(&mean.linear)
                + masses[side][1][l] * turn * mean.angular;
            let length = (change.x * change.x + change.y * change.y).sqrt();
            let size = pick(acts, length + turn.abs() * shape.width[l], 0.0);
            back.change[side][0][l] = change.x;
            back.change[side][1][l] = change.y;
            back.change[side][2][l] = turn;
            back.work[side][l] = pick(acts, work, 0.0);
            back.largest[l] = if size > back.largest[l] { size } else { back.largest[l] };
        }
    }
    back
}

/// Moves bodies, as [`Place::rotate`] and its way do.
#[inline(always)]
fn put(bodies: &mut Bodies<'_>, slots: &[u32; LANES], (moves, side): (&Moves, &Side), acts: &Mask) {
    let mut rots: Lane2 = [[0.0; LANES]; 2];
    let mut far = [0; LANES];
    for l in 0..LANES {
        let (turned, angle) = (rot(&side.rot, l).turned_little(moves.turn[l]), moves.turn[l]);
        let (still, old) = (mask(angle == 0.0), rot(&side.rot, l));
        rots[0][l] = pick(still, old.cos, turned.cos);
        rots[1][l] = pick(still, old.sin, turned.sin);
        far[l] = mask(!Rot::is_little(angle));
    }
    for l in 0..LANES {
        if acts[l] == 0 {
            continue;
        }
        let place = &mut bodies.places[slots[l] as usize];
        place.way += get(&moves.way, l);
        place.turn += moves.turn[l];
        place.rot = if far[l] != 0 { place.rot.turned(moves.turn[l]) } else { rot(&rots, l) };
    }
}

#[inline(always)]
fn turn(
    bodies: &mut Bodies<'_>,
    slots: &[u32; LANES],
    (change, side): (&[Lane; 3], &Side),
    acts: &Mask,
) {
    for l in 0..LANES {
        if acts[l] != 0 {
            let (old, change) = (twist(&side.twist, l), twist(change, l));
            bodies.velocities[slots[l] as usize].twist =
                Twist::new(old.linear + change.linear, old.angular + change.angular);
        }
    }
}
