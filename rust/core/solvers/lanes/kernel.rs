//! A packet of eight blocks against the present velocities: `solvers::block::solve`, eight times side by side.
//!
//! Plain loops over the lanes, without branches, which the compiler makes wide instructions of. What a lane does is what
//! the scalar version does, in the same order; masks choose among the cases.

#![expect(clippy::needless_range_loop, reason = "lane l of several columns at once")]

use super::{FIRST, LANES, Lane, Mask, Packet, Response, SECOND, SLIDES};
use crate::constraints::Velocity;
use crate::math::{Real, Twist, vec2};

/// All bits where a lane is meant.
const YES: u64 = u64::MAX;

#[inline(always)]
pub(crate) fn mask(yes: bool) -> u64 {
    if yes { YES } else { 0 }
}

/// The first where the mask is set, else the second: a choice that no compiler makes a branch of.
#[inline(always)]
pub(crate) fn pick(mask: u64, yes: Real, no: Real) -> Real {
    Real::from_bits((yes.to_bits() & mask) | (no.to_bits() & !mask))
}

#[inline(always)]
pub(crate) fn any(mask: &Mask) -> bool {
    let mut any = 0;
    for lane in mask {
        any |= lane;
    }
    any != 0
}

/// Of a body in each lane: v, ω.
#[inline(always)]
fn twists(velocities: &[Velocity], slots: &[u32; LANES]) -> [Lane; 3] {
    let mut twists = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let twist = &velocities[slots[l] as usize].twist;
        twists[0][l] = twist.linear.x;
        twists[1][l] = twist.linear.y;
        twists[2][l] = twist.angular;
    }
    twists
}

/// Of a body in each lane: 1/m along x and y, 1/I.
#[inline(always)]
fn inverses(velocities: &[Velocity], slots: &[u32; LANES]) -> [Lane; 3] {
    let mut inverses = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let velocity = &velocities[slots[l] as usize];
        inverses[0][l] = velocity.inverse_mass.x;
        inverses[1][l] = velocity.inverse_mass.y;
        inverses[2][l] = velocity.inverse_inertia;
    }
    inverses
}

/// Solves a packet and gives the bodies the change; raises `changes` to the largest change of velocity along a row (m/s).
/// Lanes in which no mode is found are left alone, and returned with what their velocities are beyond the targets. Packets in
/// which nothing has two points go without the second row.
#[inline(always)]
pub fn solve<const TWO: bool>(
    packet: &mut Packet,
    response: &Response,
    velocities: &mut [Velocity],
    changes: &mut Lane,
) -> Option<(Mask, [Lane; 3])> {
    let a = twists(velocities, &packet.bodies[0]);
    let b = twists(velocities, &packet.bodies[1]);
    let error = lacking::<TWO>(packet, &a, &b);
    let mut busy = is_busy::<TWO>(packet, &error);
    if !any(&busy) {
        return None;
    }
    let (mut new, held) = sticking::<TWO>(packet, &error);
    let mut rest = [0; LANES];
    for l in 0..LANES {
        rest[l] = busy[l] & !held[l];
        packet.flags[l] &= !(busy[l] & held[l] & SLIDES);
    }
    let mut left = None;
    if any(&rest) {
        let modes = by_modes(packet, response, (&error, &rest));
        let mut failed = [0; LANES];
        for l in 0..LANES {
            failed[l] = rest[l] & !modes.found[l];
            busy[l] &= !failed[l];
            let found = rest[l] & modes.found[l] & SLIDES;
            packet.flags[l] = (packet.flags[l] & !found) | (modes.slides[l] & found);
        }
        for k in 0..3 {
            for l in 0..LANES {
                new[k][l] = pick(rest[l], modes.impulse[k][l], new[k][l]);
            }
        }
        if any(&failed) {
            left = Some((failed, error));
        }
    }
    let most = largest::<TWO>(packet, response, &new);
    for l in 0..LANES {
        let larger = (busy[l] != 0) & (most[l] > changes[l]);
        changes[l] = if larger { most[l] } else { changes[l] };
    }
    push::<TWO>(packet, &new, &busy, (velocities, &a, &b));
    left
}

/// Gives the bodies the impulses that the blocks remember.
#[inline(always)]
pub fn warm_start(packet: &mut Packet, velocities: &mut [Velocity]) {
    let a = twists(velocities, &packet.bodies[0]);
    let b = twists(velocities, &packet.bodies[1]);
    let mut busy = [0; LANES];
    let mut new = packet.impulse;
    for l in 0..LANES {
        let flags = packet.flags[l];
        let p = pick(mask(flags & FIRST != 0), new[0][l], 0.0);
        let q = pick(mask(flags & SECOND != 0), new[1][l], 0.0);
        let bound = packet.friction[0][l] * (p + q);
        let t = new[2][l];
        let t = pick(mask(t < -bound), -bound, t);
        let t = pick(mask(t > bound), bound, t);
        (new[0][l], new[1][l], new[2][l]) = (p, q, t);
        busy[l] = mask((p != 0.0) | (q != 0.0) | (t != 0.0));
    }
    packet.impulse = [[0.0; LANES]; 3];
    push::<true>(packet, &new, &busy, (velocities, &a, &b));
}

/// The velocities beyond the targets, as [`crate::constraints::contact::Block::velocity`] has them.
#[inline(always)]
fn lacking<const TWO: bool>(packet: &Packet, a: &[Lane; 3], b: &[Lane; 3]) -> [Lane; 3] {
    let Packet { normal, arms, target, .. } = packet;
    let mut error = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let (x, y) = (b[0][l] - a[0][l], b[1][l] - a[1][l]);
        let along_n = normal[0][l] * x + normal[1][l] * y;
        let along_t = -normal[1][l] * x + normal[0][l] * y;
        let spin = |k: usize| arms[k][1][l] * b[2][l] - arms[k][0][l] * a[2][l];
        error[0][l] = along_n + spin(0) - target[0][l];
        if TWO {
            error[1][l] = along_n + spin(1) - target[1][l];
        }
        error[2][l] = along_t + spin(2) - target[2][l];
    }
    error
}

/// Whether a lane has anything to do.
#[inline(always)]
fn is_busy<const TWO: bool>(packet: &Packet, error: &[Lane; 3]) -> Mask {
    let Packet { impulse, flags, .. } = packet;
    let mut busy = [0; LANES];
    for l in 0..LANES {
        let loaded = (impulse[0][l] != 0.0) | (impulse[2][l] != 0.0);
        let first = (flags[l] & FIRST != 0) & (error[0][l] < 0.0);
        busy[l] = mask(loaded | first);
        if TWO {
            let second = (flags[l] & SECOND != 0) & (error[1][l] < 0.0);
            busy[l] |= mask((impulse[1][l] != 0.0) | second);
        }
    }
    busy
}

/// The impulses that meet all targets, and whether the bounds allow them.
#[inline(always)]
fn sticking<const TWO: bool>(packet: &Packet, error: &[Lane; 3]) -> ([Lane; 3], Mask) {
    let Packet { inverse, impulse, friction, flags, .. } = packet;
    let (mut new, mut held) = ([[0.0; LANES]; 3], [0; LANES]);
    for l in 0..LANES {
        let (x, y, z) = (error[0][l], error[1][l], error[2][l]);
        let [n00, n11, n01, n0t, n1t, ntt] = [0, 1, 2, 3, 4, 5].map(|k| inverse[k][l]);
        let bound = pick(mask(flags[l] & SLIDES != 0), friction[1][l], friction[0][l]);
        let (p, q, t) = if TWO {
            (
                impulse[0][l] - (n00 * x + n01 * y + n0t * z),
                impulse[1][l] - (n01 * x + n11 * y + n1t * z),
                impulse[2][l] - (n0t * x + n1t * y + ntt * z),
            )
        } else {
            let (p, t) = (n00 * x + n0t * z, n0t * x + ntt * z);
            (impulse[0][l] - p, 0.0, impulse[2][l] - t)
        };
        let allowed = (p >= 0.0) & (q >= 0.0) & (t.abs() <= bound * (p + q));
        held[l] = mask(allowed & (ntt != 0.0));
        (new[0][l], new[1][l], new[2][l]) = (p, q, t);
    }
    (new, held)
}

/// Largest change of velocity that new impulses make along their rows.
#[inline(always)]
fn largest<const TWO: bool>(packet: &Packet, k: &Response, new: &[Lane; 3]) -> Lane {
    let mut largest = [0.0; LANES];
    for l in 0..LANES {
        let change = |row: usize, k: &Lane| ((new[row][l] - packet.impulse[row][l]) * k[l]).abs();
        let (mut most, t) = (change(0, &k[0]), change(2, &k[5]));
        if TWO {
            let q = change(1, &k[1]);
            most = if most > q { most } else { q };
        }
        largest[l] = if most > t { most } else { t };
    }
    largest
}

/// Gives busy lanes their new impulses, and their bodies the change, as
/// [`crate::constraints::contact::Block::push`] does.
#[inline(always)]
fn push<const TWO: bool>(
    packet: &mut Packet,
    new: &[Lane; 3],
    busy: &Mask,
    (velocities, a, b): (&mut [Velocity], &[Lane; 3], &[Lane; 3]),
) {
    let inverse_a = inverses(velocities, &packet.bodies[0]);
    let inverse_b = inverses(velocities, &packet.bodies[1]);
    let Packet { normal, arms, impulse, .. } = packet;
    let mut push = [[0.0; LANES]; 4];
    for l in 0..LANES {
        let p = new[0][l] - impulse[0][l];
        let q = new[1][l] - impulse[1][l];
        let t = new[2][l] - impulse[2][l];
        let (nx, ny, sum) = (normal[0][l], normal[1][l], p + q);
        push[0][l] = nx * sum + -ny * t;
        push[1][l] = ny * sum + nx * t;
        let torque = |side: usize| {
            let of_normals = arms[0][side][l] * p;
            if TWO { of_normals + arms[1][side][l] * q } else { of_normals }
        };
        push[2][l] = torque(0) + arms[2][0][l] * t;
        push[3][l] = torque(1) + arms[2][1][l] * t;
    }
    let (mut after_a, mut after_b) = (*a, *b);
    for (k, (of_a, of_b)) in [(0, 0), (1, 1), (2, 3)].into_iter().enumerate() {
        for l in 0..LANES {
            let on_a = a[k][l] - inverse_a[k][l] * push[of_a][l];
            after_a[k][l] = pick(busy[l], on_a, a[k][l]);
        }
        for l in 0..LANES {
            let on_b = b[k][l] + inverse_b[k][l] * push[of_b][l];
            after_b[k][l] = pick(busy[l], on_b, b[k][l]);
        }
        for l in 0..LANES {
            impulse[k][l] = pick(busy[l], new[k][l], impulse[k][l]);
        }
    }
    for l in 0..LANES {
        let twist = |of: &[Lane; 3]| Twist::new(vec2(of[0][l], of[1][l]), of[2][l]);
        velocities[packet.bodies[0][l] as usize].twist = twist(&after_a);
        velocities[packet.bodies[1][l] as usize].twist = twist(&after_b);
    }
}

/// Impulses by modes, whether a mode was found, and whether it slides.
struct Modes {
    impulse: [Lane; 3],
    found: Mask,
    slides: Mask,
}

/// Whether some lane that is wanted has no mode yet.
#[inline(always)]
fn lacks(modes: &Modes, wanted: &Mask) -> bool {
    let mut lacks = 0;
    for l in 0..LANES {
        lacks |= wanted[l] & !modes.found[l];
    }
    lacks != 0
}

/// As [`super::super::block`] has it: held, then sliding one way, then the other.
#[inline(always)]
fn by_modes(packet: &Packet, k: &Response, (error, wanted): (&[Lane; 3], &Mask)) -> Modes {
    let Packet { impulse: old, friction, flags, .. } = packet;
    let mut free = [[0.0; LANES]; 3];
    let (mut held, mut rest) = ([[0.0; LANES]; 4], [[0.0; LANES]; 2]);
    for l in 0..LANES {
        let (p, q, t) = (old[0][l], old[1][l], old[2][l]);
        let (k00, k11, k01) = (k[0][l], k[1][l], k[2][l]);
        let (k0t, k1t, ktt) = (k[3][l], k[4][l], k[5][l]);
        free[0][l] = error[0][l] - k00 * p - k01 * q - k0t * t;
        free[1][l] = error[1][l] - k01 * p - k11 * q - k1t * t;
        free[2][l] = error[2][l] - k0t * p - k1t * q - ktt * t;
        let (first, second) = (k0t / ktt, k1t / ktt);
        held[0][l] = k00 - k0t * first;
        held[1][l] = k01 - k0t * second;
        held[2][l] = k01 - k1t * first;
        held[3][l] = k11 - k1t * second;
        rest[0][l] = free[0][l] - first * free[2][l];
        rest[1][l] = free[1][l] - second * free[2][l];
    }
    let (x, solved) = complementary(&held, [&rest[0], &rest[1]], flags);
    let mut modes =
        Modes { impulse: [x[0], x[1], [0.0; LANES]], found: [0; LANES], slides: [0; LANES] };
    let mut slide = [0.0; LANES];
    for l in 0..LANES {
        let sum = x[0][l] + x[1][l];
        let solved = (solved[l] != 0) & (k[5][l] > 0.0);
        let t = -(free[2][l] + k[3][l] * x[0][l] + k[4][l] * x[1][l]) / k[5][l];
        let bound = pick(mask(flags[l] & SLIDES != 0), friction[1][l], friction[0][l]);
        modes.found[l] = mask(solved & (t.abs() <= bound * sum));
        modes.impulse[2][l] = t;
        slide[l] = if solved { (1.0_f64).copysign(t) } else { -(1.0_f64).copysign(free[2][l]) };
    }
    if !lacks(&modes, wanted) {
        return modes;
    }
    slide_along(packet, (k, &free, &slide), &mut modes);
    if !lacks(&modes, wanted) {
        return modes;
    }
    for slide in &mut slide {
        *slide = -*slide;
    }
    slide_along(packet, (k, &free, &slide), &mut modes);
    modes
}

/// Where no mode is found yet: sliding along `slide`.
#[inline(always)]
fn slide_along(
    packet: &Packet,
    (k, free, slide): (&Response, &[Lane; 3], &Lane),
    modes: &mut Modes,
) {
    let (mut rubbed, mut rub) = ([[0.0; LANES]; 4], [0.0; LANES]);
    for l in 0..LANES {
        let mu = slide[l] * packet.friction[1][l];
        rub[l] = mu;
        rubbed[0][l] = k[0][l] + k[3][l] * mu;
        rubbed[1][l] = k[2][l] + k[3][l] * mu;
        rubbed[2][l] = k[2][l] + k[4][l] * mu;
        rubbed[3][l] = k[1][l] + k[4][l] * mu;
    }
    let (x, solved) = complementary(&rubbed, [&free[0], &free[1]], &packet.flags);
    let mut take = [0; LANES];
    for l in 0..LANES {
        let normal = x[0][l] + x[1][l];
        let slip = free[2][l] + k[3][l] * x[0][l] + k[4][l] * x[1][l] + k[5][l] * rub[l] * normal;
        let right = (slip * slide[l] <= 1e-12 * free[2][l].abs()) | (normal == 0.0);
        take[l] = solved[l] & mask(right) & !modes.found[l];
        modes.slides[l] |= take[l] & mask(normal > 0.0);
        let tangent = rub[l] * normal;
        modes.impulse[2][l] = pick(take[l], tangent, modes.impulse[2][l]);
    }
    for l in 0..LANES {
        modes.impulse[0][l] = pick(take[l], x[0][l], modes.impulse[0][l]);
        modes.impulse[1][l] = pick(take[l], x[1][l], modes.impulse[1][l]);
        modes.found[l] |= take[l];
    }
}

/// x ≥ 0, w = Kx + b ≥ 0, x·w = 0 for the rows that are on, K as 00, 01, 10, 11; and whether there is such an x.
#[inline(always)]
fn complementary(k: &[Lane; 4], b: [&Lane; 2], flags: &Mask) -> ([Lane; 2], Mask) {
    let (mut x, mut solved) = ([[0.0; LANES]; 2], [0; LANES]);
    for l in 0..LANES {
        let (k00, k01, k10, k11) = (k[0][l], k[1][l], k[2][l], k[3][l]);
        let (b0, b1) = (b[0][l], b[1][l]);
        let (on0, on1) = (flags[l] & FIRST != 0, flags[l] & SECOND != 0);
        let scale = if b0.abs() > b1.abs() { b0.abs() } else { b1.abs() };
        let low = -1e-13 * scale;
        let det = k00 * k11 - k01 * k10;
        let (p, q) = ((k01 * b1 - k11 * b0) / det, (k10 * b0 - k00 * b1) / det);
        let both = on0 & on1 & (det > 1e-9 * (k00 * k11).abs()) & (p >= 0.0) & (q >= 0.0);
        let (r, s) = (-b0 / k00, -b1 / k11);
        let first = on0 & (k00 > 0.0) & (b0 <= 0.0) & (!on1 | (k10 * r + b1 >= low));
        let second = on1 & (k11 > 0.0) & (b1 <= 0.0) & (!on0 | (k01 * s + b0 >= low));
        let neither = (!on0 | (b0 >= low)) & (!on1 | (b1 >= low));
        let alone = if first { r } else { 0.0 };
        x[0][l] = if both { p } else { alone };
        let alone = if second & !first { s } else { 0.0 };
        x[1][l] = if both { q } else { alone };
        solved[l] = mask(both | first | second | neither);
    }
    (x, solved)
}
