//! Triangles of six nodes, three points of integration, and an energy of which the forces are exact gradients.
//!
//! The energy is that of Smith, De Goes and Kim ("Stable neo-Hookean flesh simulation", 2018) in the plane,
//! ψ = μ/2 (|F|² − 2) − μ(J − 1) + (λ + μ)/2 (J − 1)² = μ/2 (s₁ − s₂)² + (λ + μ)/2 (s₁s₂ − 1)² with the stretches s: Hooke's law where the strain is
//! small, finite and with a way back where a triangle is flat or inside out.
//!
//! |F|² and J are quadratic in the places of the nodes, so the difference of each over a step is its derivative in the middle times the
//! way. With J − 1 as the mean of both ends the force in the middle therefore does exactly the work by which the energy changes (after Simo
//! and Tarnow, "The discrete energy-momentum method", 1992), and its moments add up to 0.

use super::material::Moduli;
use super::tensor::{
    IDENTITY, Tensor, apply, cofactor, determinant, difference, outer, scaled, sum, symmetric,
    times, transposed,
};
use crate::math::{Real, Vec2, cross, perp, vec2};

/// A triangle as the step sees it.
#[derive(Clone, Debug)]
pub struct Triangle {
    pub nodes: [u32; 6],
    /// At rest (m²).
    pub area: Real,
    /// Gradients of the shape functions of the nodes (1/m) at the points of integration.
    pub gradients: [[Vec2; 6]; 3],
}

/// Places of the points of integration in the triangle: each nearer to one corner. Exact for polynomials of degree 2.
const POINTS: [[Real; 3]; 3] = {
    const FAR: Real = 1.0 / 6.0;
    const NEAR: Real = 2.0 / 3.0;
    [[NEAR, FAR, FAR], [FAR, NEAR, FAR], [FAR, FAR, NEAR]]
};

/// ∫NᵢNⱼ over the area, times 180.
const MASS: [[Real; 6]; 6] = [
    [6.0, -1.0, -1.0, 0.0, -4.0, 0.0],
    [-1.0, 6.0, -1.0, 0.0, 0.0, -4.0],
    [-1.0, -1.0, 6.0, -4.0, 0.0, 0.0],
    [0.0, 0.0, -4.0, 32.0, 16.0, 16.0],
    [-4.0, 0.0, 0.0, 16.0, 32.0, 16.0],
    [0.0, -4.0, 0.0, 16.0, 16.0, 32.0],
];

/// A step as a triangle sees it: its length, viscosity included.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Length (s).
    pub h: Real,
    /// What forces are those of.
    pub rule: Rule,
}

/// Where a step is linearised.
#[derive(Clone, Copy, Debug)]
pub struct Middle<'a> {
    /// Places of the nodes in the middle of the step.
    pub at: &'a [Vec2],
    /// Half of their way in it; nothing where only the end counts.
    pub way: &'a [Vec2],
    /// Length of the step (s).
    pub h: Real,
}

/// Where forces are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// In the middle, so that energy is kept.
    Middle,
    /// At the end, which takes energy, for steps whose middle has no solution.
    End,
}

impl Triangle {
    pub fn new(nodes: [u32; 6], rest: &[Vec2]) -> Self {
        let [a, b, c] = [0, 1, 2].map(|k| rest[nodes[k] as usize]);
        let twice = cross(b - a, c - a);
        // ∇Lₖ is the inward normal of the side opposite to corner k over the height.
        let slope = [perp(c - b), perp(a - c), perp(b - a)].map(|side| side / twice);
        let gradients = POINTS.map(|l| {
            let corner = |i: usize| slope[i] * (4.0 * l[i] - 1.0);
            let side = |i: usize, j: usize| (slope[j] * l[i] + slope[i] * l[j]) * 4.0;
            [corner(0), corner(1), corner(2), side(0, 1), side(1, 2), side(2, 0)]
        });
        Self { nodes, area: 0.5 * twice, gradients }
    }

    pub fn gather(&self, column: &[Vec2]) -> [Vec2; 6] {
        self.nodes.map(|i| column[i as usize])
    }

    /// F at the points of integration. Places are counted from the first node, so that none far from the origin loses digits.
    pub fn deformation(&self, at: &[Vec2]) -> [Tensor; 3] {
        let places = self.gather(at);
        let from = places.map(|p| p - places[0]);
        self.gradients.map(|gradients| {
            let mut f = [0.0; 4];
            for (p, g) in from.iter().zip(&gradients).skip(1) {
                f = sum(&f, &outer(*p, *g));
            }
            f
        })
    }

    pub fn energy(&self, moduli: &Moduli, at: &[Vec2]) -> Real {
        self.deformation(at).iter().map(|f| self.area / 3.0 * density(moduli, f)).sum()
    }

    /// Adds the forces over a step from F₀, one for each point, to the places `end`.
    pub fn add_forces(
        &self,
        moduli: &Moduli,
        step: Step,
        (before, end): (&[Tensor], &[Vec2]),
        forces: &mut [Vec2],
    ) {
        for ((f0, f1), gradients) in before.iter().zip(&self.deformation(end)).zip(&self.gradients)
        {
            let stress = scaled(&first_piola(moduli, step, f0, f1), -self.area / 3.0);
            for (&i, g) in self.nodes.iter().zip(gradients) {
                forces[i as usize] += apply(&stress, *g);
            }
        }
    }

    /// Hands the blocks of M + αK + βB, B the damping matrix over β, in the middle of a step, where the stress is that of the whole of it.
    /// `definite`: without what makes K indefinite.
    pub fn tangent(
        &self,
        (density, moduli): (Real, &Moduli),
        (alpha, beta, definite): (Real, Real, bool),
        middle: Middle<'_>,
        add: &mut dyn FnMut((u32, u32), Tensor),
    ) {
        let mut blocks = [[[0.0; 4]; 6]; 6];
        for (row, masses) in blocks.iter_mut().zip(&MASS) {
            for (block, m) in row.iter_mut().zip(masses) {
                let m = m * density * self.area / 180.0;
                *block = [m, 0.0, 0.0, m];
            }
        }
        let weight = self.area / 3.0;
        let way = if middle.way.is_empty() { [[0.0; 4]; 3] } else { self.deformation(middle.way) };
        let points = self.deformation(middle.at).into_iter().zip(way);
        for ((f, half), gradients) in points.zip(&self.gradients) {
            let by = (alpha * weight, beta * weight, definite);
            let point = Linear::new(moduli, (&f, &half, middle.h), by);
            for (i, row) in blocks.iter_mut().enumerate() {
                for (j, block) in row.iter_mut().enumerate().take(i + 1) {
                    *block = sum(block, &point.block(gradients[i], gradients[j]));
                }
            }
        }
        for (i, row) in blocks.iter().enumerate() {
            for (j, block) in row.iter().enumerate().take(i + 1) {
                add((self.nodes[i], self.nodes[j]), *block);
                if i != j {
                    add((self.nodes[j], self.nodes[i]), transposed(block));
                }
            }
        }
    }

    /// Energy (J) that viscosity takes over a step: Sᵥ : ΔE.
    pub fn viscous_loss(
        &self,
        moduli: &Moduli,
        h: Real,
        (before, end): (&[Tensor], &[Vec2]),
    ) -> Real {
        let mut loss = 0.0;
        for (f0, f1) in before.iter().zip(&self.deformation(end)) {
            let f = scaled(&sum(f0, f1), 0.5);
            let e = symmetric(&times(&transposed(&f), &difference(f1, f0)));
            let square = e[0] * e[0] + 2.0 * e[1] * e[1] + e[3] * e[3];
            let trace = e[0] + e[3];
            loss += 2.0 * moduli.shear * square + (moduli.area - moduli.shear) * trace * trace;
        }
        loss * moduli.viscosity / h * self.area / 3.0
    }

    /// Adds M v.
    pub fn add_mass(&self, density: Real, of: &[Vec2], out: &mut [Vec2]) {
        let values = self.gather(of);
        let scale = density * self.area / 180.0;
        for (&i, masses) in self.nodes.iter().zip(&MASS) {
            let sum: Vec2 = masses.iter().zip(&values).map(|(m, v)| v * *m).sum();
            out[i as usize] += sum * scale;
        }
    }
}

/// ψ (J/m²).
pub fn density(moduli: &Moduli, f: &Tensor) -> Real {
    // (s₁ − s₂)² = |F|² − 2J = (xx − yy)² + (xy + yx)².
    let (stretch, shear) = (f[0] - f[3], f[1] + f[2]);
    let growth = determinant(f) - 1.0;
    0.5 * (moduli.shear * (stretch * stretch + shear * shear) + moduli.area * growth * growth)
}

/// First stress of Piola and Kirchhoff (Pa) over a step, viscous part included: F Sᵥ with Sᵥ = β(2μĖ + λ tr Ė), Ė the rate of Green's strain.
fn first_piola(moduli: &Moduli, step: Step, f0: &Tensor, f1: &Tensor) -> Tensor {
    let (f, growth) = match step.rule {
        Rule::Middle => {
            (scaled(&sum(f0, f1), 0.5), 0.5 * (determinant(f0) + determinant(f1)) - 1.0)
        }
        Rule::End => (*f1, determinant(f1) - 1.0),
    };
    let mut stress = elastic(moduli, &f, growth);
    if moduli.viscosity > 0.0 && step.rule == Rule::Middle {
        let change = symmetric(&times(&transposed(&f), &difference(f1, f0)));
        stress = sum(&stress, &times(&f, &viscous_stress(moduli, step.h, &change)));
    }
    stress
}

/// Sᵥ (Pa) where Green's strain changes by this in a step of length h.
fn viscous_stress(moduli: &Moduli, h: Real, change: &Tensor) -> Tensor {
    let by = moduli.viscosity / h;
    let mut second = scaled(change, 2.0 * moduli.shear * by);
    let trace = (moduli.area - moduli.shear) * (change[0] + change[3]) * by;
    second[0] += trace;
    second[3] += trace;
    second
}

/// μ(F − cof F) + (λ + μ)(J − 1) cof F.
fn elastic(moduli: &Moduli, f: &Tensor, growth: Real) -> Tensor {
    let cof = cofactor(f);
    sum(&scaled(&difference(f, &cof), moduli.shear), &scaled(&cof, moduli.area * growth))
}

/// Cauchy's stress P Fᵀ/J (Pa) without the viscous part; that of rest where the triangle is flat.
pub fn cauchy(moduli: &Moduli, f: &Tensor) -> Tensor {
    let growth = determinant(f);
    if growth == 0.0 {
        return [0.0; 4];
    }
    symmetric(&scaled(&times(&elastic(moduli, f, growth - 1.0), &transposed(f)), 1.0 / growth))
}

/// Green's strain ½(FᵀF − 1).
pub fn green(f: &Tensor) -> Tensor {
    symmetric(&scaled(&difference(&times(&transposed(f), f), &IDENTITY), 0.5))
}

/// The second derivative of the energy at a point, weighted.
struct Linear {
    /// Of |F|²/2.
    square: Real,
    /// Of J.
    growth: Real,
    /// (λ + μ), and the cofactors.
    area: Real,
    cof: Tensor,
    /// μ and λ of the damping, F, and F Fᵀ.
    viscous: [Real; 2],
    f: Tensor,
    left: Tensor,
    /// The viscous stress Sᵥ.
    stress: Tensor,
}

impl Linear {
    /// At F, half of whose change over the step of length h is given.
    fn new(
        moduli: &Moduli,
        (f, half, h): (&Tensor, &Tensor, Real),
        (alpha, beta, definite): (Real, Real, bool),
    ) -> Self {
        // The mean of J at both ends.
        let mean = determinant(f) + determinant(half);
        let (mut square, mut growth) = (moduli.shear, moduli.area * (mean - 1.0) - moduli.shear);
        let mut stress = [0.0; 4];
        if moduli.viscosity > 0.0 && !definite {
            let change = scaled(&symmetric(&times(&transposed(f), half)), 2.0);
            stress = scaled(&viscous_stress(moduli, h, &change), alpha);
        }
        if definite {
            // |F|²/2 = (|α|² + |β|²)/2 and J = (|α|² − |β|²)/2 in the parts α that keep angles and β that mirror: stiffness
            // along each is the sum and the difference; what is below 0 is left out.
            let (keeps, mirrors) = ((square + growth).max(0.0), (square - growth).max(0.0));
            (square, growth) = (0.5 * (keeps + mirrors), 0.5 * (keeps - mirrors));
        }
        let beta = beta * moduli.viscosity;
        Self {
            square: alpha * square,
            growth: alpha * growth,
            area: alpha * moduli.area,
            cof: cofactor(f),
            viscous: [beta * moduli.shear, beta * (moduli.area - moduli.shear)],
            f: *f,
            left: times(f, &transposed(f)),
            stress,
        }
    }

    fn block(&self, gi: Vec2, gj: Vec2) -> Tensor {
        let along = gi.dot(&gj);
        // ∂²J/∂xᵢ∂yⱼ.
        let turn = self.growth * cross(gi, gj);
        let (ci, cj) = (apply(&self.cof, gi), apply(&self.cof, gj));
        let mut block = scaled(&outer(ci, cj), self.area);
        block = sum(&block, &[self.square * along, turn, -turn, self.square * along]);
        if self.viscous[0] > 0.0 {
            let (ui, uj) = (apply(&self.f, gi), apply(&self.f, gj));
            let [shear, trace] = self.viscous;
            let taut = gi.dot(&apply(&self.stress, gj));
            block = sum(&block, &[taut, 0.0, 0.0, taut]);
            block = sum(&block, &scaled(&self.left, shear * along));
            block = sum(&block, &scaled(&outer(uj, ui), shear));
            block = sum(&block, &scaled(&outer(ui, uj), trace));
        }
        block
    }
}

/// A gradient as plastic flow leaves it: F F_p⁻¹ = Σ x (F_p⁻ᵀ g)ᵀ.
pub fn flowed(inverse: &Tensor, gradient: Vec2) -> Vec2 {
    vec2(
        inverse[0] * gradient.x + inverse[2] * gradient.y,
        inverse[1] * gradient.x + inverse[3] * gradient.y,
    )
}
