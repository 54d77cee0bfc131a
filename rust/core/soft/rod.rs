//! Rods between two nodes, which stretch, and where two of them meet, which bend.
//!
//! As of triangles the strains are quadratic in the places, so that forces in the middle of a step do exactly the work by which the energy
//! changes.

use super::tensor::{Tensor, outer, scaled, sum};
use super::triangle::{Middle, Rule, Step};
use crate::math::{Real, Vec2, perp};

/// Stretch: ½ EA L e², e = ½(l²/L² − 1).
#[derive(Clone, Copy, Debug)]
pub struct Rod {
    pub nodes: [u32; 2],
    /// At rest (m).
    pub length: Real,
}

/// Bending: ½ EI |κ|² over half of both rods, κ the second difference along the rope (Wardetzky and others, "Discrete quadratic curvature
/// energies", 2007): quadratic, and right as long as rods hardly stretch.
#[derive(Clone, Copy, Debug)]
pub struct Bend {
    pub nodes: [u32; 3],
    /// κ = Σ weight · place (1/m²).
    pub weights: [Real; 3],
    /// Length (m) that it stands for.
    pub length: Real,
}

/// Stiffnesses of a rope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// EA (N).
    pub stretch: Real,
    /// EI (N·m²).
    pub bending: Real,
    /// Viscosity over stiffness (s).
    pub viscosity: Real,
}

impl Rod {
    fn way(&self, at: &[Vec2]) -> Vec2 {
        at[self.nodes[1] as usize] - at[self.nodes[0] as usize]
    }

    /// e.
    pub fn strain(&self, at: &[Vec2]) -> Real {
        0.5 * (self.way(at).norm_squared() / (self.length * self.length) - 1.0)
    }

    pub fn energy(&self, stretch: Real, at: &[Vec2]) -> Real {
        let strain = self.strain(at);
        0.5 * stretch * self.length * strain * strain
    }

    pub fn add_forces(
        &self,
        of: &Stiffness,
        step: Step,
        [start, end]: [&[Vec2]; 2],
        forces: &mut [Vec2],
    ) {
        let (e0, e1) = (self.strain(start), self.strain(end));
        let (way, strain) = match step.rule {
            Rule::Middle => ((self.way(start) + self.way(end)) * 0.5, 0.5 * (e0 + e1)),
            Rule::End => (self.way(end), e1),
        };
        let viscosity = if step.rule == Rule::Middle { of.viscosity } else { 0.0 };
        let force = of.stretch * (strain + viscosity / step.h * (e1 - e0)) / self.length;
        forces[self.nodes[0] as usize] += way * force;
        forces[self.nodes[1] as usize] -= way * force;
    }

    /// Energy (J) that viscosity takes over a step.
    pub fn viscous_loss(&self, of: &Stiffness, h: Real, [start, end]: [&[Vec2]; 2]) -> Real {
        let change = self.strain(end) - self.strain(start);
        of.stretch * self.length * of.viscosity / h * change * change
    }

    pub fn tangent(
        &self,
        (density, of): (Real, &Stiffness),
        (alpha, beta, definite): (Real, Real, bool),
        middle: Middle<'_>,
        add: &mut dyn FnMut((u32, u32), Tensor),
    ) {
        let way = self.way(middle.at);
        let half = if middle.way.is_empty() { Vec2::zeros() } else { self.way(middle.way) };
        // ½(e₀ + e₁) and e₁ − e₀ of the whole step.
        let square = self.length * self.length;
        let mean = 0.5 * ((way.norm_squared() + half.norm_squared()) / square - 1.0);
        let change = 2.0 * way.dot(&half) / square;
        let pull = of.stretch * (mean + of.viscosity / middle.h * change) / self.length;
        let along =
            of.stretch * (alpha + beta * of.viscosity) / (self.length * self.length * self.length);
        let across = alpha * if definite { pull.max(0.0) } else { pull };
        let block = sum(&scaled(&outer(way, way), along), &[across, 0.0, 0.0, across]);
        let mass = density * self.length / 6.0;
        for (i, a) in self.nodes.iter().enumerate() {
            for (j, b) in self.nodes.iter().enumerate() {
                let (m, sign) = if i == j { (2.0 * mass, 1.0) } else { (mass, -1.0) };
                add((*a, *b), sum(&scaled(&block, sign), &[m, 0.0, 0.0, m]));
            }
        }
    }

    pub fn add_mass(&self, density: Real, of: &[Vec2], out: &mut [Vec2]) {
        let [a, b] = self.nodes.map(|i| i as usize);
        let mass = density * self.length / 6.0;
        out[a] += (of[a] * 2.0 + of[b]) * mass;
        out[b] += (of[b] * 2.0 + of[a]) * mass;
    }
}

impl Bend {
    pub fn new(nodes: [u32; 3], rest: &[Vec2]) -> Self {
        let [a, b, c] = nodes.map(|i| rest[i as usize]);
        let (before, after) = ((b - a).norm(), (c - b).norm());
        let length = 0.5 * (before + after);
        let (first, last) = (1.0 / (length * before), 1.0 / (length * after));
        Self { nodes, weights: [first, -first - last, last], length }
    }

    fn curvature(&self, at: &[Vec2]) -> Vec2 {
        // From the middle node, so that none far from the origin loses digits.
        let [a, b, c] = self.nodes.map(|i| at[i as usize]);
        (a - b) * self.weights[0] + (c - b) * self.weights[2]
    }

    pub fn energy(&self, bending: Real, at: &[Vec2]) -> Real {
        0.5 * bending * self.length * self.curvature(at).norm_squared()
    }

    /// Derivatives of the angle between the rods by the places; none where one has no length.
    fn angle_slopes([a, b, c]: [Vec2; 3]) -> [Vec2; 3] {
        let slope = |way: Vec2| {
            let square = way.norm_squared();
            if square > 0.0 { perp(way) / square } else { Vec2::zeros() }
        };
        let (before, after) = (slope(b - a), slope(c - b));
        [before, -before - after, after]
    }

    pub fn add_forces(
        &self,
        of: &Stiffness,
        step: Step,
        [start, end]: [&[Vec2]; 2],
        forces: &mut [Vec2],
    ) {
        let (k0, k1) = (self.curvature(start), self.curvature(end));
        let curvature = match step.rule {
            Rule::Middle => (k0 + k1) * 0.5,
            Rule::End => k1,
        };
        let pull = curvature * (-of.bending * self.length);
        for (i, weight) in self.nodes.iter().zip(&self.weights) {
            forces[*i as usize] += pull * *weight;
        }
        if of.viscosity > 0.0 && step.rule == Rule::Middle {
            let (slopes, turn) = self.turn([start, end]);
            let moment = of.bending / self.length * of.viscosity * turn / step.h;
            for (i, slope) in self.nodes.iter().zip(&slopes) {
                forces[*i as usize] -= slope * moment;
            }
        }
    }

    /// Slopes of the angle in the middle of a step, and by how much it changes.
    fn turn(&self, [start, end]: [&[Vec2]; 2]) -> ([Vec2; 3], Real) {
        let middle = self.nodes.map(|i| (start[i as usize] + end[i as usize]) * 0.5);
        let slopes = Self::angle_slopes(middle);
        let way = |i: u32| end[i as usize] - start[i as usize];
        (slopes, slopes.iter().zip(&self.nodes).map(|(s, i)| s.dot(&way(*i))).sum())
    }

    /// Energy (J) that viscosity takes over a step.
    pub fn viscous_loss(&self, of: &Stiffness, h: Real, ends: [&[Vec2]; 2]) -> Real {
        let (_, turn) = self.turn(ends);
        of.bending / self.length * of.viscosity / h * turn * turn
    }

    pub fn tangent(
        &self,
        of: &Stiffness,
        (alpha, beta): (Real, Real),
        at: &[Vec2],
        add: &mut dyn FnMut((u32, u32), Tensor),
    ) {
        let slopes = Self::angle_slopes(self.nodes.map(|i| at[i as usize]));
        let stiffness = alpha * of.bending * self.length;
        let damping = beta * of.bending / self.length * of.viscosity;
        for (i, a) in self.nodes.iter().enumerate() {
            for (j, b) in self.nodes.iter().enumerate() {
                let along = stiffness * self.weights[i] * self.weights[j];
                let block = scaled(&outer(slopes[i], slopes[j]), damping);
                add((*a, *b), sum(&block, &[along, 0.0, 0.0, along]));
            }
        }
    }
}
