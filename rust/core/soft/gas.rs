//! A gas inside a closed rope: p = p₀(A₀/A)^γ, against a constant pressure outside.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::tensor::Tensor;
use super::triangle::{Rule, Step};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2, cross, ln, perp, powf};

/// A gas in a closed rope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// Pressure (Pa) that it has in the area which the rope encloses at rest.
    pub pressure: Real,
    /// Pressure outside (Pa).
    #[serde(default)]
    pub outside: Real,
    /// γ of p Aᵞ = constant: 1, at a constant temperature, or above.
    #[serde(default = "one")]
    pub exponent: Real,
}

fn one() -> Real {
    1.0
}

/// A part of the area at rest below which the gas pushes no harder: so an outline that is crushed flat, or inside out, is pushed apart.
const FLAT: Real = 1e-3;

/// The gas as the step sees it.
#[derive(Clone, Debug)]
pub struct Filling {
    /// Nodes around it, counter-clockwise.
    pub ring: Vec<u32>,
    /// Area at rest (m²).
    pub area: Real,
}

impl Gas {
    /// The gas, if it is one.
    ///
    /// # Errors
    /// Pressures below 0, an exponent below 1.
    pub fn validated(&self) -> Result<()> {
        check::not_negative("pressure", self.pressure)?;
        check::not_negative("outside", self.outside)?;
        if !(self.exponent >= 1.0 && self.exponent <= 10.0) {
            return Err(Error::invalid("exponent", self.exponent, "1 to 10"));
        }
        Ok(())
    }

    /// Pressure above that outside (Pa) in this part of the area at rest, and how it falls with that part.
    fn pressure_at(&self, part: Real) -> [Real; 2] {
        let held = part.max(FLAT);
        let inside = self.pressure * powf(held, -self.exponent);
        let slope = if part > FLAT { -self.exponent * inside / held } else { 0.0 };
        [inside - self.outside, slope]
    }

    /// Energy (J/m²) per area at rest: −∫(p − p outside) d part, from the area at rest.
    fn energy_at(&self, part: Real) -> Real {
        let held = part.max(FLAT);
        let work = if self.exponent == 1.0 {
            ln(held)
        } else {
            (powf(held, 1.0 - self.exponent) - 1.0) / (1.0 - self.exponent)
        };
        let [below, _] = self.pressure_at(FLAT);
        let beneath = if part < FLAT { (below + self.outside) * (part - FLAT) } else { 0.0 };
        self.outside * (part - 1.0) - self.pressure * work - beneath
    }
}

impl Filling {
    /// Inside a ring of nodes, whichever way round; turns it counter-clockwise.
    ///
    /// # Errors
    /// A ring without an area.
    pub fn new(mut ring: Vec<u32>, rest: &[Vec2]) -> Result<Self> {
        let signed = area(&ring, rest);
        if signed < 0.0 {
            ring.reverse();
        }
        Ok(Self { ring, area: check::positive("area inside the rope", signed.abs())? })
    }

    /// Area inside (m²).
    pub fn area_at(&self, at: &[Vec2]) -> Real {
        area(&self.ring, at)
    }

    /// Pressure above that outside (Pa).
    pub fn pressure(&self, gas: &Gas, at: &[Vec2]) -> Real {
        gas.pressure_at(self.area_at(at) / self.area)[0]
    }

    pub fn energy(&self, gas: &Gas, at: &[Vec2]) -> Real {
        self.area * gas.energy_at(self.area_at(at) / self.area)
    }

    /// Adds the forces over a step: −ΔU/ΔA ∇A in the middle, which do exactly the work −ΔU.
    pub fn add_forces(
        &self,
        gas: &Gas,
        step: Step,
        [start, end]: [&[Vec2]; 2],
        forces: &mut [Vec2],
    ) {
        let [before, after] = [start, end].map(|at| self.area_at(at) / self.area);
        let change = after - before;
        let pressure = match step.rule {
            Rule::End => gas.pressure_at(after)[0],
            // Below, rounding of the difference is worse than the error of the middle, change²/24.
            Rule::Middle if change.abs() < 1e-5 => gas.pressure_at(0.5 * (before + after))[0],
            Rule::Middle => (gas.energy_at(before) - gas.energy_at(after)) / change,
        };
        let middle = |i: usize| match step.rule {
            Rule::Middle => (start[i] + end[i]) * 0.5,
            Rule::End => end[i],
        };
        self.each_slope(middle, |i, slope| forces[i] += slope * pressure);
    }

    /// ∂A/∂x of each node, and −dp/dA (Pa/m²): the gas adds (−dp/dA)∇A ∇Aᵀ to the stiffness, a full matrix, which is kept apart.
    pub fn slopes(&self, gas: &Gas, at: &[Vec2], slopes: &mut Vec<Vec2>) -> Real {
        slopes.clear();
        slopes.resize(at.len(), Vec2::zeros());
        self.each_slope(|i| at[i], |i, slope| slopes[i] += slope);
        -gas.pressure_at(self.area_at(at) / self.area)[1] / self.area
    }

    /// Hands the blocks of −αp ∂²A/∂x², which ties neighbours in the ring.
    pub fn tangent(
        &self,
        gas: &Gas,
        alpha: Real,
        at: &[Vec2],
        add: &mut dyn FnMut((u32, u32), Tensor),
    ) {
        let turn = -0.5 * alpha * self.pressure(gas, at);
        for k in 0..self.ring.len() {
            let pair = (self.ring[k], self.ring[(k + 1) % self.ring.len()]);
            add(pair, [0.0, turn, -turn, 0.0]);
            add((pair.1, pair.0), [0.0, -turn, turn, 0.0]);
        }
    }

    /// ∂A/∂xᵢ = ½ of the way from the node before to the node after, turned clockwise.
    fn each_slope(&self, at: impl Fn(usize) -> Vec2, mut take: impl FnMut(usize, Vec2)) {
        let n = self.ring.len();
        for k in 0..n {
            let [before, here, after] =
                [k + n - 1, k, k + 1].map(|place| self.ring[place % n] as usize);
            take(here, -perp(at(after) - at(before)) * 0.5);
        }
    }
}

/// Signed area inside a ring of nodes.
fn area(ring: &[u32], at: &[Vec2]) -> Real {
    let from = at[ring[0] as usize];
    let piece = |pair: &[u32]| cross(at[pair[0] as usize] - from, at[pair[1] as usize] - from);
    0.5 * ring.windows(2).map(piece).sum::<Real>()
}
