//! Laws of impact: which impulse an approach brings about.

use crate::body::{Friction, ImpactLaw};
use crate::constraints::contact::Block;
use crate::math::Real;
use crate::solvers::block_impulses;

/// Impulses of the three rows for an approach with velocities `u` beyond the tangential target. None gives energy.
///
/// `block` holds response and inverse of the rows that are on, and no impulse.
#[must_use]
pub fn impulses(law: ImpactLaw, block: &Block, u: [Real; 3], restitution: [Real; 2]) -> [Real; 3] {
    let full = match law {
        ImpactLaw::Newton => newton(block, u, restitution),
        ImpactLaw::Poisson | ImpactLaw::Stronge => {
            let point = if block.on[0] { 0 } else { 1 };
            if block.on == [true, true] {
                poisson_of_two(block, u, restitution)
            } else {
                let [k00, k11, _, k0t, k1t, ktt] = block.response;
                let (normal, mixed) = if point == 0 { (k00, k0t) } else { (k11, k1t) };
                let path = Path { normal, mixed, tangent: ktt, friction: block.friction };
                let [p, t] = path.follow([u[point], u[2]], restitution[point], law);
                if point == 0 { [p, 0.0, t] } else { [0.0, p, t] }
            }
        }
    };
    limited(block, u, full)
}

/// u·p + ½p·Kp: the energy that impulses give (J).
#[must_use]
pub fn gain(block: &Block, u: &[Real; 3], p: &[Real; 3]) -> Real {
    let q = response(block, p);
    (0..3).map(|k| p[k] * (u[k] + 0.5 * q[k])).sum()
}

fn response(block: &Block, p: &[Real; 3]) -> [Real; 3] {
    let [k00, k11, k01, k0t, k1t, ktt] = block.response;
    [
        k00 * p[0] + k01 * p[1] + k0t * p[2],
        k01 * p[0] + k11 * p[1] + k1t * p[2],
        k0t * p[0] + k1t * p[1] + ktt * p[2],
    ]
}

/// Newton's law: leaves at e times the approach.
fn newton(block: &Block, u: [Real; 3], e: [Real; 2]) -> [Real; 3] {
    let error = [u[0] * (1.0 + e[0]), u[1] * (1.0 + e[1]), u[2]];
    block_impulses(&mut block.clone(), &error)
}

/// With Coulomb's friction an impact can gain energy (Kane 1984), by Newton's law and where two points share an impulse; it is
/// then limited so that ½p·(u⁺ + u⁻) ≤ 0.
fn limited(block: &Block, u: [Real; 3], full: [Real; 3]) -> [Real; 3] {
    if gain(block, &u, &full) <= 0.0 {
        return full;
    }
    // Between the plastic impulse, which takes energy, and the full one: the last that gains none. The gain is
    // convex along the way: g(s) = g₀ + s g₁ + s² g₂ with g₀ ≤ 0.
    let plastic = newton(block, u, [0.0; 2]);
    let way = [0, 1, 2].map(|k| full[k] - plastic[k]);
    let (at, along) = (response(block, &plastic), response(block, &way));
    let g0 = gain(block, &u, &plastic).min(0.0);
    let g1: Real = (0..3).map(|k| way[k] * (u[k] + at[k])).sum();
    let g2: Real = (0..3).map(|k| 0.5 * way[k] * along[k]).sum();
    let root = (g1 * g1 - 4.0 * g2 * g0).max(0.0).sqrt();
    let s = if g2 > 0.0 { ((root - g1) / (2.0 * g2)).clamp(0.0, 1.0) } else { 0.0 };
    [0, 1, 2].map(|k| plastic[k] + s * way[k])
}

/// Two points at once: compression to rest, then e times its normal impulses, and friction with the whole.
fn poisson_of_two(block: &Block, u: [Real; 3], e: [Real; 2]) -> [Real; 3] {
    let compression = block_impulses(&mut block.clone(), &u);
    let normal = [compression[0] * (1.0 + e[0]), compression[1] * (1.0 + e[1])];
    let [_, _, _, k0t, k1t, ktt] = block.response;
    let held = if ktt > 0.0 { -(u[2] + k0t * normal[0] + k1t * normal[1]) / ktt } else { 0.0 };
    let sum = normal[0] + normal[1];
    let bound = |mu: Real| mu * sum;
    let tangent = if held.abs() <= bound(block.friction.sticking) {
        held
    } else {
        held.clamp(-bound(block.friction.sliding), bound(block.friction.sliding))
    };
    [normal[0], normal[1], tangent]
}

/// One point: velocities as the normal impulse grows (Routh 1860; Stronge, "Impact Mechanics", 2000, ch. 3).
struct Path {
    normal: Real,
    mixed: Real,
    tangent: Real,
    friction: Friction,
}

impl Path {
    /// Follows the impulse from [u_n, u_t] through compression and restitution; returns [p_n, p_t].
    fn follow(&self, start: [Real; 2], e: Real, law: ImpactLaw) -> [Real; 2] {
        // Slip can stop once and turn round once in each phase.
        const PIECES: usize = 8;
        let [mut un, mut ut] = start;
        let (mut p, mut t) = (0.0, 0.0);
        let (mut work, mut compression) = (0.0, None);
        for _ in 0..PIECES {
            let rate_t = self.tangential_impulse(ut);
            let (dun, dut) =
                (self.normal + self.mixed * rate_t, self.mixed + self.tangent * rate_t);
            let to_stop = if ut * dut < 0.0 { -ut / dut } else { Real::INFINITY };
            let to_end = match compression {
                None if dun > 0.0 => -un / dun,
                None => Real::INFINITY,
                Some((pc, wc)) => match law {
                    ImpactLaw::Stronge => to_work(un, dun, (1.0 - e * e) * wc - work),
                    _ => (1.0 + e) * pc - p,
                },
            };
            let step = to_stop.min(to_end).max(0.0);
            if !step.is_finite() {
                break;
            }
            work += step * (un + 0.5 * dun * step);
            (p, t) = (p + step, t + rate_t * step);
            un += dun * step;
            ut = if to_stop <= to_end { 0.0 } else { ut + dut * step };
            if to_end <= to_stop {
                if compression.is_some() {
                    break;
                }
                un = 0.0;
                compression = Some((p, work));
            }
        }
        [p, t]
    }

    /// Tangential impulse per normal impulse at a slip velocity.
    fn tangential_impulse(&self, slip: Real) -> Real {
        if slip != 0.0 {
            return -slip.signum() * self.friction.sliding;
        }
        let held = if self.tangent > 0.0 { -self.mixed / self.tangent } else { 0.0 };
        if held.abs() <= self.friction.sticking {
            held
        } else {
            held.signum() * self.friction.sliding
        }
    }
}

/// Impulse over which the normal force does a work, from a velocity that grows by `rate`.
fn to_work(velocity: Real, rate: Real, work: Real) -> Real {
    if work <= 0.0 {
        return 0.0;
    }
    let root = (velocity * velocity + 2.0 * rate * work).sqrt();
    2.0 * work / (velocity + root)
}
