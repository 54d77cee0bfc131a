//! Yielding: what is strained beyond a bound stays so.

use super::body::SoftBody;
use super::tensor::{IDENTITY, Tensor, determinant, times, transposed};
use super::tensor::{outer, scaled, sum};
use super::triangle::density;
use crate::forces::Ledger;
use crate::math::{Real, Vec2, exp, hypot, ln, vec2};

impl SoftBody {
    /// Energy (J) that viscosity took in the substep.
    pub(super) fn viscous_loss(&self) -> Real {
        let (parts, work) = (&self.parts, &self.work);
        let (h, end) = (work.h, &work.end[..]);
        let befores = work.deformations.chunks_exact(3);
        let triangles = parts.triangles.iter().zip(befores);
        let ends = [&work.start[..], end];
        triangles.map(|(t, before)| t.viscous_loss(&parts.moduli, h, (before, end))).sum::<Real>()
            + parts.rods.iter().map(|r| r.viscous_loss(&parts.stiffness, h, ends)).sum::<Real>()
            + parts.bends.iter().map(|b| b.viscous_loss(&parts.stiffness, h, ends)).sum::<Real>()
    }

    /// Lets what is strained beyond the bound flow back to it, at the same area, and books what that takes.
    pub(super) fn yield_where_strained(&mut self, ledger: &mut Ledger) {
        let Some(bound) = self.def.material.yield_strain else { return };
        let mut flows: Vec<(usize, Tensor)> = Vec::new();
        for (k, triangle) in self.parts.triangles.iter().enumerate() {
            for (q, f) in triangle.deformation(&self.moving.positions).iter().enumerate() {
                let Some(back) = flow_back(f, bound) else { continue };
                let moduli = &self.parts.moduli;
                let lost = density(moduli, f) - density(moduli, &times(f, &back));
                ledger.dissipated += lost * triangle.area / 3.0;
                flows.push((3 * k + q, back));
            }
        }
        if flows.is_empty() {
            return;
        }
        self.moving.flow.resize(3 * self.parts.triangles.len(), IDENTITY);
        for (place, back) in flows {
            let flow = &mut self.moving.flow[place];
            *flow = times(flow, &back);
        }
        self.moving.linear = None;
        self.work.factored = false;
        self.apply_flow();
    }
}

/// F_e ← F_e B with B = Σ r^±1 N Nᵀ along the principal directions, so that ln(s₁/s₂) becomes the bound; none where it is below, or where
/// the matter is inside out.
fn flow_back(f: &Tensor, bound: Real) -> Option<Tensor> {
    let c = times(&transposed(f), f);
    let (mean, half) = (0.5 * (c[0] + c[3]), 0.5 * (c[0] - c[3]));
    let radius = hypot(half, c[1]);
    let growth = determinant(f);
    if growth <= 0.0 || radius == 0.0 {
        return None;
    }
    // s₁²/s₂² from s₁²s₂² = J².
    let first = mean + radius;
    let difference = ln(first / growth);
    if difference <= bound {
        return None;
    }
    let along = principal(half, c[1], radius);
    let by = exp(0.5 * (bound - difference));
    let across = vec2(-along.y, along.x);
    Some(sum(&scaled(&outer(along, along), by), &scaled(&outer(across, across), 1.0 / by)))
}

/// Unit vector along the larger principal value of [[half, shear], [shear, −half]].
fn principal(half: Real, shear: Real, radius: Real) -> Vec2 {
    let direction =
        if half > 0.0 { vec2(half + radius, shear) } else { vec2(shear, radius - half) };
    direction.normalize()
}
