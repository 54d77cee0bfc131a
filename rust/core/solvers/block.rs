//! One manifold solved exactly: two normals with Signorini's condition and one tangent with Coulomb's.
//!
//! With the impulses λ, u = b + Kλ are the velocities beyond the targets. The modes are tried in turn: all
//! stick, slide one way, slide the other; in each the two normals are a linear complementarity problem of
//! two, solved by looking at its four cases (Murty, "Linear Complementarity", 1988, ch. 1).

use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::Real;

/// Solves a block against the present velocities and gives the bodies the change. Returns the largest
/// change of velocity along a row (m/s).
pub fn solve(block: &mut Block, [a, b]: [&mut Velocity; 2]) -> Real {
    let mut error = block.velocity([a, b]);
    for (row, target) in error.iter_mut().zip(block.target) {
        *row -= target;
    }
    let idle = block.impulse == [0.0; 3]
        && (!block.on[0] || error[0] >= 0.0)
        && (!block.on[1] || error[1] >= 0.0);
    if idle {
        return 0.0;
    }
    take(block, &error, [a, b])
}

/// The same, but what sticks pushes by the change itself, not by the difference of rounded impulses: under a heavy load that rounding
/// is a velocity of what is light. Returns the change.
pub fn refine(block: &mut Block, [a, b]: [&mut Velocity; 2]) -> [Real; 3] {
    let mut error = block.velocity([a, b]);
    for (row, target) in error.iter_mut().zip(block.target) {
        *row -= target;
    }
    let old = block.impulse;
    let change = if let Some((new, change)) = sticking(block, &error) {
        block.impulse = new;
        change
    } else {
        block.impulse = by_modes(block, &error);
        [0, 1, 2].map(|k| block.impulse[k] - old[k])
    };
    block.push([a, b], change);
    change
}

/// Solves a block that has something to do, whose velocities are so far beyond the targets.
pub(super) fn take(block: &mut Block, error: &[Real; 3], bodies: [&mut Velocity; 2]) -> Real {
    let impulse = impulses(block, error);
    let change = [0, 1, 2].map(|k| impulse[k] - block.impulse[k]);
    block.impulse = impulse;
    block.push(bodies, change);
    let [k00, k11, _, _, _, ktt] = block.response;
    (change[0] * k00).abs().max((change[1] * k11).abs()).max((change[2] * ktt).abs())
}

/// The impulses of the block, given the velocities beyond the targets that the present ones leave.
pub fn impulses(block: &mut Block, error: &[Real; 3]) -> [Real; 3] {
    sticking(block, error).map_or_else(|| by_modes(block, error), |(new, _)| new)
}

/// The impulses that meet all targets, and their change, if the bounds allow them: the case of most contacts that rest.
fn sticking(block: &mut Block, error: &[Real; 3]) -> Option<([Real; 3], [Real; 3])> {
    let [a, b, c, d, e, f] = block.inverse;
    if f == 0.0 {
        return None;
    }
    let [x, y, z] = error;
    let change = [-(a * x + c * y + d * z), -(c * x + b * y + e * z), -(d * x + e * y + f * z)];
    let new = [0, 1, 2].map(|k| block.impulse[k] + change[k]);
    let bound = sticking_bound(block) * (new[0] + new[1]);
    let allowed = new[0] >= 0.0 && new[1] >= 0.0 && new[2].abs() <= bound;
    if allowed {
        block.sliding = false;
    }
    allowed.then_some((new, change))
}

/// A contact that slid holds again only if the kinetic coefficient is enough to hold it.
fn sticking_bound(block: &Block) -> Real {
    if block.sliding { block.friction.sliding } else { block.friction.sticking }
}

fn by_modes(block: &mut Block, error: &[Real; 3]) -> [Real; 3] {
    let [k00, k11, k01, k0t, k1t, ktt] = block.response;
    let old = block.impulse;
    // Velocities beyond the targets without any impulse of this block.
    let free = [
        error[0] - k00 * old[0] - k01 * old[1] - k0t * old[2],
        error[1] - k01 * old[0] - k11 * old[1] - k1t * old[2],
        error[2] - k0t * old[0] - k1t * old[1] - ktt * old[2],
    ];
    let tangent = |x: [Real; 2]| -(free[2] + k0t * x[0] + k1t * x[1]) / ktt;
    let mut direction = -free[2].signum();
    if ktt > 0.0 {
        let shares = [k0t / ktt, k1t / ktt];
        let held = [
            k00 - k0t * shares[0],
            k01 - k0t * shares[1],
            k01 - k1t * shares[0],
            k11 - k1t * shares[1],
        ];
        let rest = [free[0] - shares[0] * free[2], free[1] - shares[1] * free[2]];
        if let Some(x) = complementary(held, rest, block.on) {
            let t = tangent(x);
            if t.abs() <= sticking_bound(block) * (x[0] + x[1]) {
                block.sliding = false;
                return [x[0], x[1], t];
            }
            direction = t.signum();
        }
    }
    for slide in [direction, -direction] {
        let mu = slide * block.friction.sliding;
        let rubbed = [k00 + k0t * mu, k01 + k0t * mu, k01 + k1t * mu, k11 + k1t * mu];
        let Some(x) = complementary(rubbed, [free[0], free[1]], block.on) else { continue };
        let normal = x[0] + x[1];
        let slip = free[2] + k0t * x[0] + k1t * x[1] + ktt * mu * normal;
        if slip * slide <= 1e-12 * free[2].abs() || normal == 0.0 {
            block.sliding = normal > 0.0;
            return [x[0], x[1], mu * normal];
        }
    }
    row_by_row(block, error)
}

/// What is left where Coulomb's law has no solution (Painlevé) or rounding hides it: each row for itself.
fn row_by_row(block: &mut Block, error: &[Real; 3]) -> [Real; 3] {
    let [k00, k11, k01, k0t, k1t, ktt] = block.response;
    let [old0, old1, old_t] = block.impulse;
    let first = if block.on[0] { (old0 - error[0] / k00).max(0.0) } else { 0.0 };
    let moved = error[1] + k01 * (first - old0);
    let second = if block.on[1] { (old1 - moved / k11).max(0.0) } else { 0.0 };
    let slip = error[2] + k0t * (first - old0) + k1t * (second - old1);
    let bound = block.friction.sliding * (first + second);
    let wanted = if ktt > 0.0 { old_t - slip / ktt } else { 0.0 };
    block.sliding = wanted.abs() > bound;
    [first, second, wanted.clamp(-bound, bound)]
}

/// x ≥ 0, w = Kx + b ≥ 0, x·w = 0 for the rows that are on; K as 00, 01, 10, 11.
fn complementary(k: [Real; 4], b: [Real; 2], on: [bool; 2]) -> Option<[Real; 2]> {
    let [k00, k01, k10, k11] = k;
    // Velocities that are zero but for rounding count as zero.
    let scale = b[0].abs().max(b[1].abs());
    let low = -1e-13 * scale;
    if on[0] && on[1] {
        let det = k00 * k11 - k01 * k10;
        if det > 1e-9 * (k00 * k11).abs() {
            let x = [(k01 * b[1] - k11 * b[0]) / det, (k10 * b[0] - k00 * b[1]) / det];
            if x[0] >= 0.0 && x[1] >= 0.0 {
                return Some(x);
            }
        }
    }
    if on[0] && k00 > 0.0 && b[0] <= 0.0 {
        let x = -b[0] / k00;
        if !on[1] || k10 * x + b[1] >= low {
            return Some([x, 0.0]);
        }
    }
    if on[1] && k11 > 0.0 && b[1] <= 0.0 {
        let x = -b[1] / k11;
        if !on[0] || k01 * x + b[0] >= low {
            return Some([0.0, x]);
        }
    }
    ((!on[0] || b[0] >= low) && (!on[1] || b[1] >= low)).then_some([0.0, 0.0])
}
