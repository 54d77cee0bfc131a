//! All rows of an island solved at once, by sparse factors of their saddle-point system.
//!
//! Impulses λ on rows J v + Σ λ = b of bodies of masses M that are at rest otherwise obey
//!
//! ```text
//! [ M   Jᵀ ] [  v ]   [ 0 ]
//! [ J  −Σ  ] [ −λ ] = [ b ],    hence  J M⁻¹ Jᵀ λ + Σ λ = b  and  v = M⁻¹ Jᵀ λ.
//! ```
//!
//! Bodies and links are nodes of three unknowns. Unlike J M⁻¹ Jᵀ this matrix is as sparse as the graph whatever hangs
//! on a body, and it stays well conditioned where that squares mass ratios (Baraff, "Linear-time dynamics using
//! Lagrange multipliers", 1996). It is scaled first: bodies by √M, so that a direction that cannot move is a
//! column of zeros, and rows so that the diagonal of J M⁻¹ Jᵀ + Σ is one. Then Σ is made larger by
//! a tiny ε, which makes the matrix quasi-definite however many rows depend on one another, and corrections
//! by what is left over (the proximal point method) make up for that: of all impulses that solve the rows, those
//! nearest to the ones given come out. Rounding in what is left over, 2⁻⁵³, would come back as 2⁻⁵³/ε where rows
//! share a load. With A = J M⁻¹ Jᵀ + Σ, such a share is what ε(A + ε)⁻¹ keeps of a correction, so that is taken out
//! of it: only the square of 2⁻⁵³/ε remains.

mod block;
mod bodies;
mod numeric;
mod order;
mod structure;
#[cfg(test)]
mod tests;
mod unsymmetric;

pub use block::{Block, Triple};
pub use bodies::BodyFactor;

use std::mem;

use block::{add, subtract, times, transposed, transposed_times};
use numeric::Numeric;
use structure::Structure;

use crate::constraints::Velocity;
use crate::math::{Real, Twist, vec2};

/// The two bodies of a link, by slot; none is the ground.
pub type Link = [Option<u32>; 2];

/// A link as its rows see it: what cannot move is the ground. A body that gives no way would leave the pivot of its link
/// to ε alone.
#[must_use]
pub fn on_ground(link: &Link, bodies: &[Velocity]) -> Link {
    link.map(|slot| slot.filter(|slot| !bodies[*slot as usize].is_fixed()))
}

/// ε where the graph has loops: compliance added to every row, against a diagonal of J M⁻¹ Jᵀ + Σ of one. A smaller
/// one is right for larger ratios of masses; with 1e-13 redundant rows share a load to 1e-6 only.
const LOOP_REGULARISATION: Real = 1e-12;

/// ε where it has none, so that rows seldom depend on one another.
const TREE_REGULARISATION: Real = 1e-14;

/// A pivot of a link below so many ε tells of rows that depend on one another although the graph has no loop.
const SMALL_PIVOT: Real = 10.0;

/// Corrections end where what is left over is rounding, in parts of the largest right-hand side.
const ROUNDING: Real = 1e-15;

/// Below that, corrections that gain little only stir the rounding.
const NEARLY: Real = 1e-12;

/// Or after so many; two are the rule, ten rare.
const CORRECTIONS: usize = 30;

/// The rows of one link: up to three.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    /// J for each body of the link: three rows of (x, y, θ). Of the ground it is not read.
    pub jacobian: [Block; 2],
    /// Σ ≥ 0 (velocity per impulse); 0 for a hard row.
    pub compliance: Triple,
    /// Which rows are there; the impulse of one that is off is zero.
    pub on: [bool; 3],
}

/// A link in scaled unknowns.
#[derive(Clone, Copy, Debug)]
struct Scaled {
    jacobian: [Block; 2],
    compliance: Triple,
    /// Length of each row before: √ of the diagonal of J M⁻¹ Jᵀ + Σ; 0 for a row that is off.
    length: Triple,
}

/// The factors of an island's rows, with all the room they need: nothing is allocated as long as the graph stays.
#[derive(Clone, Debug, Default)]
pub struct Factor {
    structure: Structure,
    numeric: Numeric,
    links: Vec<Scaled>,
    /// 1/√M.
    inverse_roots: Vec<Triple>,
    /// Scaled (v, λ) by node.
    solution: Vec<Triple>,
    /// What they leave over, by node.
    residual: Vec<Triple>,
    /// The solution before the last correction.
    previous: Vec<Triple>,
    /// Corrections, by column.
    correction: Vec<Triple>,
    /// The part of them that only shares loads anew between redundant rows.
    share: Vec<Triple>,
}

impl Factor {
    /// Prepares for the links of so many bodies; whether they are other ones than last time. Cheap if not.
    pub fn analyse(&mut self, bodies: usize, links: &[Link]) -> bool {
        self.structure.analyse(bodies, links)
    }

    /// Products of blocks that the factors of the analysed graph take.
    #[must_use]
    pub fn work(&self) -> usize {
        let filled = |column: usize| self.structure.below(column).len();
        (0..self.structure.len()).map(|column| filled(column) * (filled(column) + 1) / 2).sum()
    }

    /// Factors of the rows, one item a link as analysed, on bodies of these inverse masses. A row that nothing can
    /// give way to, or that is not finite, is switched off.
    pub fn factor(&mut self, bodies: &[Velocity], rows: &[Rows]) {
        debug_assert_eq!(bodies.len(), self.structure.bodies);
        debug_assert_eq!(rows.len(), self.structure.places.len());
        self.inverse_roots.clear();
        self.inverse_roots.extend(bodies.iter().map(|body| {
            [body.inverse_mass.x, body.inverse_mass.y, body.inverse_inertia].map(Real::sqrt)
        }));
        self.links.clear();
        for (k, rows) in rows.iter().enumerate() {
            self.links.push(self.scaled(k, rows));
        }
        self.fill();
        self.numeric.factor(&self.structure);
    }

    /// Solves J M⁻¹ Jᵀ λ + Σ λ = b. Takes a guess of λ and leaves λ there; of several answers it is the nearest to the
    /// guess, distances measured with √(J M⁻¹ Jᵀ + Σ) of each row. Writes v = M⁻¹ Jᵀ λ.
    /// Returns the largest error of a row in parts of the largest b, both divided by √(J M⁻¹ Jᵀ + Σ): about 1e-16, more
    /// where rows contradict one another.
    pub fn solve(&mut self, b: &[Triple], impulses: &mut [Triple], twists: &mut [Twist]) -> Real {
        self.solve_to(ROUNDING, b, impulses, twists)
    }

    /// The same, to an error of this size: what is corrected again later need not be exact now. v = M⁻¹ Jᵀ λ holds to
    /// rounding even so, hence momentum is kept.
    pub fn solve_to(
        &mut self,
        accuracy: Real,
        b: &[Triple],
        impulses: &mut [Triple],
        twists: &mut [Twist],
    ) -> Real {
        self.start(impulses);
        if impulses.iter().flatten().all(|impulse| *impulse == 0.0) {
            self.demand(b);
        } else if self.leftover(b) == 0.0 {
            return 0.0;
        }
        let mut error = Real::INFINITY;
        for _ in 0..CORRECTIONS {
            let finite = self.correct();
            let next = self.leftover(b);
            let better = finite && next < error;
            let slow = next > if error > NEARLY { 0.9 } else { 0.3 } * error;
            if !better {
                self.solution.clone_from(&self.previous);
                self.leftover(b);
                break;
            }
            error = next;
            if slow || error <= accuracy {
                break;
            }
        }
        if accuracy > ROUNDING {
            // What is left over of a body is Jᵀλ − v.
            self.solution
                .iter_mut()
                .zip(&self.residual)
                .take(twists.len())
                .for_each(|(v, left)| add(v, *left));
        }
        self.finish(impulses, twists);
        error
    }

    fn scaled(&self, link: usize, rows: &Rows) -> Scaled {
        let places = self.structure.places[link];
        let mut jacobian = [block::ZERO; 2];
        for ((scaled, place), rows) in jacobian.iter_mut().zip(places).zip(&rows.jacobian) {
            if let Some(place) = place {
                let [x, y, z] = self.inverse_roots[place.body];
                *scaled = rows.map(|row| [row[0] * x, row[1] * y, row[2] * z]);
            }
        }
        if let [Some(a), Some(b)] = places
            && a.body == b.body
        {
            let [own, other] = &mut jacobian;
            own.iter_mut().zip(other).for_each(|(own, other)| add(own, mem::take(other)));
        }
        let mut scaled = Scaled { jacobian, compliance: [1.0; 3], length: [0.0; 3] };
        for (r, &compliance) in rows.compliance.iter().enumerate() {
            let square = |side: &Block| side[r].iter().map(|x| x * x).sum::<Real>();
            let squared = scaled.jacobian.iter().map(square).sum::<Real>() + compliance;
            let usable = rows.on[r] && squared.is_normal() && squared > 0.0;
            let inverse = if usable { 1.0 / squared.sqrt() } else { 0.0 };
            for side in &mut scaled.jacobian {
                side[r] = if usable { side[r].map(|x| x * inverse) } else { [0.0; 3] };
            }
            if usable {
                scaled.compliance[r] = compliance / squared;
                scaled.length[r] = squared.sqrt();
            }
        }
        scaled
    }

    /// ε.
    fn regularisation(&self) -> Real {
        if self.structure.redundant { LOOP_REGULARISATION } else { TREE_REGULARISATION }
    }

    /// Writes the scaled, regularised matrix.
    fn fill(&mut self) {
        let epsilon = self.regularisation();
        let Self { structure, numeric, .. } = self;
        numeric.reset(structure);
        for node in 0..structure.bodies {
            numeric.diagonal[structure.columns[node] as usize] = diagonal([1.0; 3]);
        }
        for (k, link) in self.links.iter().enumerate() {
            let column = structure.columns[structure.bodies + k] as usize;
            numeric.diagonal[column] = diagonal(link.compliance.map(|s| -(s + epsilon)));
            for (jacobian, place) in link.jacobian.iter().zip(structure.places[k]) {
                if let Some(place) = place {
                    let block = if place.transposed { transposed(jacobian) } else { *jacobian };
                    for (to, row) in numeric.below[place.block].iter_mut().zip(block) {
                        add(to, row);
                    }
                }
            }
        }
    }

    /// Begins with the impulses given and bodies at rest.
    fn start(&mut self, impulses: &[Triple]) {
        self.solution.clear();
        self.solution.resize(self.structure.bodies, [0.0; 3]);
        let scaled =
            |(link, impulse): (&Scaled, &Triple)| [0, 1, 2].map(|r| impulse[r] * link.length[r]);
        self.solution.extend(self.links.iter().zip(impulses).map(scaled));
    }

    /// Writes what no impulses at all leave over.
    fn demand(&mut self, b: &[Triple]) {
        let Self { structure, links, residual, .. } = self;
        residual.clear();
        residual.resize(structure.bodies, [0.0; 3]);
        residual.extend(links.iter().zip(b).map(|(link, b)| link.unit(*b)));
    }

    /// Writes what the solution leaves over; returns how much of it there is against what the terms are.
    fn leftover(&mut self, b: &[Triple]) -> Real {
        let Self { structure, residual, .. } = self;
        let bodies = structure.bodies;
        let (velocities, impulses) = self.solution.split_at(bodies);
        residual.clear();
        residual.extend(velocities.iter().map(|v| v.map(|x| -x)));
        let mut speed = velocities.iter().map(size).fold(0.0, Real::max);
        let (mut error, mut push): (Real, Real) = (0.0, 0.0);
        for (k, (link, impulse)) in self.links.iter().zip(impulses).enumerate() {
            let unit = link.unit(b[k]);
            let mut left = [0, 1, 2].map(|r| unit[r] - link.compliance[r] * impulse[r]);
            for (jacobian, place) in link.jacobian.iter().zip(structure.places[k]) {
                if let Some(place) = place {
                    subtract(&mut left, times(jacobian, velocities[place.body]));
                    add(&mut residual[place.body], transposed_times(jacobian, *impulse));
                }
            }
            residual.push(left);
            error = error.max(size(&left));
            speed = speed.max(size(&unit));
            push = push.max(size(impulse));
        }
        let unbalanced = residual[..bodies].iter().map(size).fold(0.0, Real::max);
        let ratio = |x: Real, y: Real| if x == 0.0 { 0.0 } else { x / y };
        ratio(error, speed).max(ratio(unbalanced, push))
    }

    /// Adds the answer to what is left over; whether it is finite.
    fn correct(&mut self) -> bool {
        let Self { structure, numeric, residual, correction, .. } = self;
        correction.clear();
        correction.extend(structure.nodes().iter().map(|&node| residual[node as usize]));
        numeric.solve(structure, correction);
        if structure.redundant || numeric.least_pivot < SMALL_PIVOT * self.regularisation() {
            self.take_out_share();
        }
        let Self { structure, solution, correction, .. } = self;
        self.previous.clone_from(solution);
        for (node, &column) in structure.columns.iter().enumerate() {
            let change = correction[column as usize];
            if node < structure.bodies {
                add(&mut solution[node], change);
            } else {
                subtract(&mut solution[node], change);
            }
        }
        correction.iter().flatten().all(|x| x.is_finite())
    }

    /// Takes ε(A + ε)⁻¹ of it out of a correction.
    fn take_out_share(&mut self) {
        let epsilon = self.regularisation();
        let Self { structure, numeric, correction, share, .. } = self;
        share.clear();
        share.extend(structure.nodes().iter().zip(&*correction).map(|(&node, change)| {
            let part = if (node as usize) < structure.bodies { 0.0 } else { -epsilon };
            change.map(|x| part * x)
        }));
        numeric.solve(structure, share);
        correction.iter_mut().zip(share).for_each(|(to, x)| subtract(to, *x));
    }

    fn finish(&self, impulses: &mut [Triple], twists: &mut [Twist]) {
        let (velocities, scaled) = self.solution.split_at(self.structure.bodies);
        for ((impulse, link), scaled) in impulses.iter_mut().zip(&self.links).zip(scaled) {
            *impulse = link.unit(*scaled);
        }
        for ((twist, roots), v) in twists.iter_mut().zip(&self.inverse_roots).zip(velocities) {
            *twist = Twist::new(vec2(v[0] * roots[0], v[1] * roots[1]), v[2] * roots[2]);
        }
    }
}

impl Scaled {
    /// A right-hand side against rows of length one, or impulses back from them.
    fn unit(&self, x: Triple) -> Triple {
        let divided = |r: usize| if self.length[r] > 0.0 { x[r] / self.length[r] } else { 0.0 };
        [0, 1, 2].map(divided)
    }
}

fn size(x: &Triple) -> Real {
    x.iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

fn diagonal([x, y, z]: Triple) -> Block {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}
