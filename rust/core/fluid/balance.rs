//! Fluids much lighter than others: the same pressure everywhere exerts no force, and what moves under it is braked.
//!
//! A pressure p that is the same everywhere pulls at particle i with −2p V s_i, s_i = Σ V ∇W_ij + ½ Σ_B ∇∫_B W dA, which is 0
//! on a lattice but not among particles that lie anyhow. Under the pressure of a heavy fluid that little force throws a light
//! one about; and heavy fluid sinks through light particles that slip past one another, since the sum of their rates Σ D_i u
//! is not the flow through their border, as by Gauss's theorem it should be. So the slopes of pairs are lessened by
//! w_ij (φ_i − φ_j), w = V W, with φ from
//!
//! Σ_j w_ij (φ_i − φ_j) = s_i at each light particle inside, φ = 0 elsewhere,
//!
//! found by conjugate gradients. What one gets the other loses: momentum is kept; angular momentum only as far as φ is small.
//! Rates then no longer are those of each particle's own part, so that pressures keep means over neighbours, and particles
//! are spread out along −s.

use super::pairs::{Around, Pair, Pairs};
use super::solid::Touch;
use super::team::Team;
use crate::math::{Real, Vec2};

/// Density over that of the heaviest fluid up to which a fluid is light.
const LIGHT: Real = 0.5;

/// What may be left of s, over what it was.
const SMALL: Real = 1e-4;

/// Most steps.
const MOST: u32 = 60;

/// Part of the diagonal that ties φ to 0, so that a pocket between walls alone has a solution.
const TIE: Real = 1e-4;

/// How often what is filled is replaced by its mean over neighbours.
const PASSES: u32 = 4;

/// How far particles are spread in a substep, over s d².
const SPREAD: Real = 0.5;

/// The same at most, over the spacing.
const FARTHEST: Real = 0.05;

/// How far (hω)² of jitter may go before it is braked.
const FREE: Real = 0.1;

/// Columns that φ is found in; empty where no fluid is light.
#[derive(Clone, Debug, Default)]
pub struct Balance {
    /// Of light fluids.
    light: Vec<bool>,
    /// Σ_j w_ij of what is light and inside, 0 elsewhere.
    diagonal: Vec<Real>,
    /// s of what is light and inside.
    lean: Vec<Pair>,
    potential: Vec<Pair>,
    rest: Vec<Pair>,
    search: Vec<Pair>,
    image: Vec<Pair>,
}

impl Balance {
    /// Looks which particles are light.
    pub fn choose(&mut self, density: &[Real]) {
        let heaviest = density.iter().copied().fold(0.0, Real::max);
        self.light.clear();
        if density.iter().any(|density| *density <= LIGHT * heaviest) {
            self.light.extend(density.iter().map(|density| *density <= LIGHT * heaviest));
        }
        self.diagonal.clear();
    }

    /// Whether some are.
    pub fn at_work(&self) -> bool {
        !self.light.is_empty()
    }

    /// Those of them that are not at a free surface.
    pub fn keep(&mut self, inside: impl Fn(usize) -> bool) {
        let own = self.light.iter().enumerate();
        self.diagonal.extend(own.map(|(i, light)| Real::from(u8::from(*light && inside(i)))));
    }

    /// Changes the slopes of the pairs.
    pub fn correct(
        &mut self,
        pairs: &mut Pairs,
        (around, touches): (&[Around], &[Touch]),
        team: &Team,
    ) {
        self.lean.clear();
        self.lean.extend(around.iter().map(|around| around.slope));
        for touch in touches {
            let lean = &mut self.lean[touch.particle as usize];
            *lean = [lean[0] + 0.5 * touch.slope.x, lean[1] + 0.5 * touch.slope.y];
        }
        for ((d, lean), around) in self.diagonal.iter_mut().zip(&mut self.lean).zip(around) {
            *lean = [*d * lean[0], *d * lean[1]];
            *d *= around.part * (1.0 + TIE);
        }
        self.rest.clone_from(&self.lean);
        for column in [&mut self.potential, &mut self.search, &mut self.image] {
            column.clear();
            column.resize(around.len(), [0.0; 2]);
        }
        self.solve(pairs, team);
        pairs.lean(&self.potential, team);
    }

    fn solve(&mut self, pairs: &Pairs, team: &Team) {
        let Self { diagonal, potential, rest, search, image, .. } = self;
        let (mut before, mut first) = (1.0, None);
        for _ in 0..MOST {
            let size = dot(rest, rest, |k| over(diagonal[k]));
            if size <= SMALL * SMALL * *first.get_or_insert(size) || size == 0.0 {
                break;
            }
            let factor = size / before;
            before = size;
            for ((q, r), d) in search.iter_mut().zip(&*rest).zip(&*diagonal) {
                *q = [0, 1].map(|axis| r[axis] * over(*d) + factor * q[axis]);
            }
            let give = |i: usize, j: usize, weight: Real, _: Pair| {
                [0, 1].map(|axis| weight * (search[i][axis] - search[j][axis]))
            };
            pairs.exchange(&give, image, team);
            for ((image, q), d) in image.iter_mut().zip(&*search).zip(&*diagonal) {
                let keep = Real::from(u8::from(*d > 0.0));
                *image = [0, 1].map(|axis| keep * image[axis] + TIE * d * q[axis]);
            }
            let step = size / dot(image, search, |_| 1.0);
            for (k, x) in potential.iter_mut().enumerate() {
                *x = [0, 1].map(|axis| x[axis] + step * search[k][axis]);
                rest[k] = [0, 1].map(|axis| rest[k][axis] - step * image[k][axis]);
            }
        }
    }

    /// Replaces what is filled by its mean over light neighbours.
    pub fn even(&mut self, pairs: &Pairs, filled: &mut [Real], team: &Team) {
        if self.light.is_empty() {
            return;
        }
        let Self { diagonal, image, .. } = self;
        for _ in 0..PASSES {
            let own = &*filled;
            let give = |i: usize, j: usize, weight: Real, _: Pair| {
                let both = diagonal[i] > 0.0 && diagonal[j] > 0.0;
                [if both { weight * (own[j] - own[i]) } else { 0.0 }, 0.0]
            };
            pairs.exchange(&give, image, team);
            filled.iter_mut().zip(&*image).for_each(|(own, image)| *own += image[0]);
        }
    }

    /// Spreads particles out.
    pub fn spread(&self, positions: &mut [Vec2], spacing: Real) {
        if self.light.is_empty() {
            return;
        }
        for (x, lean) in positions.iter_mut().zip(&self.lean) {
            let way = Vec2::new(lean[0], lean[1]) * (SPREAD * spacing * spacing);
            *x -= way * (FARTHEST * spacing / way.norm().max(FARTHEST * spacing));
        }
    }

    /// What brakes light particles: their jitter under a pressure p has ω² of about p/(ρ d²), and steps as long as those of
    /// the heavy fluid make it grow. The viscosity h p − ρ d² · 0.1/h slows what is faster, and is 0 for short steps.
    pub fn stiffen(
        &self,
        (pressures, relaxing): (&[Real], &[Real]),
        density: &[Real],
        (area, h): (Real, Real),
        stiff: &mut Vec<Real>,
    ) {
        stiff.clear();
        stiff.resize(density.len(), 0.0);
        for (i, own) in
            stiff.iter_mut().enumerate().filter(|(i, _)| self.light.get(*i) == Some(&true))
        {
            *own = (h * (pressures[i] + relaxing[i]) - FREE * density[i] * area / h).max(0.0);
        }
    }
}

/// Σ a·b w.
fn dot(a: &[Pair], b: &[Pair], weight: impl Fn(usize) -> Real) -> Real {
    let each = a.iter().zip(b).enumerate();
    each.map(|(k, (a, b))| (a[0] * b[0] + a[1] * b[1]) * weight(k)).sum()
}

fn over(d: Real) -> Real {
    if d > 0.0 { 1.0 / d } else { 0.0 }
}
