//! Rows that give way a little, solved on the bodies alone: of the saddle-point system the links are eliminated first.
//!
//! With W = (Σ + ε)⁻¹ rows that push along P and measure along J obey
//!
//! ```text
//! (M + Pᵀ W J) v = Pᵀ W b,    λ = W (b − J v),
//! ```
//!
//! which has one node a body and, where bodies touch many others, far fewer blocks than the system of bodies and links. It
//! loses digits as ε falls: ε = 1e-8 leaves half of them, so that what is left over is solved again.

use super::block::{self, Block, Triple, add, times, transposed, transposed_times};
use super::numeric::Numeric;
use super::structure::Structure;
use super::unsymmetric::Unsymmetric;
use super::{Link, Rows, diagonal};
use crate::constraints::Velocity;
use crate::math::Real;

/// A link in scaled unknowns: velocities times √M.
#[derive(Clone, Copy, Debug)]
struct Scaled {
    measures: [Block; 2],
    pushes: [Block; 2],
    /// W; 0 for a row that is off.
    weights: Triple,
    /// Columns of its bodies.
    columns: [Option<u32>; 2],
    /// The block that they share.
    shared: usize,
}

/// Factors of the bodies' system, with all the room they need.
#[derive(Clone, Debug, Default)]
pub struct BodyFactor {
    structure: Structure,
    /// The graph that its order is of.
    edges: Vec<[u32; 2]>,
    /// Orders found since work was last asked for.
    orders: Real,
    numeric: Numeric,
    unsymmetric: Unsymmetric,
    /// Whether the factors are those of the unsymmetric matrix.
    pushing: bool,
    links: Vec<Scaled>,
    /// 1/√M.
    inverse_roots: Vec<Triple>,
    /// Right-hand side, then velocities, by column.
    change: Vec<Triple>,
}

/// Work of finding an order, in parts of that of the factors.
const ORDER: Real = 1.5;

impl BodyFactor {
    /// Takes the graph that is expected: the pairs of bodies that bear on one another. The order of elimination follows from it, not
    /// from what was before, so that a run that is taken up again has the same bits.
    pub fn expect(&mut self, bodies: usize, edges: impl Iterator<Item = [u32; 2]> + Clone) {
        if self.structure.len() != bodies || !self.edges.iter().copied().eq(edges.clone()) {
            self.edges.clear();
            self.edges.extend(edges);
            self.structure.analyse_edges(bodies, self.edges.iter().copied());
            self.orders += 1.0;
        }
    }

    /// Factors of rows on bodies of these inverse masses; `pushes` where some push along other directions than those in which
    /// they measure. ε is a part of each row's J M⁻¹ Jᵀ.
    pub fn factor(
        &mut self,
        bodies: &[Velocity],
        links: &[Link],
        (rows, pushes): (&[Rows], Option<&[[Block; 2]]>),
        epsilon: Real,
    ) {
        self.extend(links, rows);
        self.inverse_roots.clear();
        self.inverse_roots.extend(bodies.iter().map(|body| body.inverse().map(Real::sqrt)));
        self.links.clear();
        for (k, (link, rows)) in links.iter().zip(rows).enumerate() {
            let pushes = pushes.map_or(&rows.jacobian, |pushes| &pushes[k]);
            self.links.push(self.scaled(link, (rows, pushes), epsilon));
        }
        self.pushing = pushes.is_some();
        if self.pushing {
            self.fill_unsymmetric();
            self.unsymmetric.factor(&self.structure);
        } else {
            self.fill();
            self.numeric.factor(&self.structure);
        }
    }

    /// What the last factors took, in products of blocks, with the orders of elimination that were found since those before.
    pub fn work(&mut self) -> Real {
        let filled = |column: usize| self.structure.below(column).len();
        let products =
            (0..self.structure.len()).map(|column| filled(column) * (filled(column) + 3) / 2);
        let once = products.sum::<usize>() as Real;
        let factors = if self.pushing { 2.0 } else { 1.0 };
        once * (factors + ORDER * std::mem::take(&mut self.orders))
    }

    /// Solves J M⁻¹ Pᵀ λ + (Σ + ε) λ = b, once.
    pub fn solve(&mut self, b: &[Triple], impulses: &mut [Triple]) {
        let Self { structure, numeric, unsymmetric, pushing, links, change, .. } = self;
        change.clear();
        change.resize(structure.len(), [0.0; 3]);
        for (link, b) in links.iter().zip(b) {
            let pull = [0, 1, 2].map(|r| link.weights[r] * b[r]);
            for (column, pushes) in link.columns.iter().zip(&link.pushes) {
                if let Some(column) = column {
                    add(&mut change[*column as usize], transposed_times(pushes, pull));
                }
            }
        }
        if *pushing {
            unsymmetric.solve(structure, change);
        } else {
            numeric.solve(structure, change);
        }
        for ((link, b), impulse) in links.iter().zip(b).zip(impulses) {
            let mut along = [0.0; 3];
            for (column, measures) in link.columns.iter().zip(&link.measures) {
                if let Some(column) = column {
                    add(&mut along, times(measures, change[*column as usize]));
                }
            }
            *impulse = [0, 1, 2].map(|r| link.weights[r] * (b[r] - along[r]));
        }
    }

    /// Takes another order where bodies bear on one another that are not linked in the one there is.
    fn extend(&mut self, links: &[Link], rows: &[Rows]) {
        let bearing = || {
            links.iter().zip(rows).filter_map(|(link, rows)| match link {
                [Some(a), Some(b)] if a != b && rows.on != [false; 3] => Some([*a, *b]),
                _ => None,
            })
        };
        let structure = &mut self.structure;
        let known = |pair: [u32; 2]| {
            structure.shared(pair.map(|slot| structure.columns[slot as usize])).is_some()
        };
        if !bearing().all(known) {
            // All of them: what another order fills in differs.
            self.edges.extend(bearing());
            structure.analyse_edges(structure.len(), self.edges.iter().copied());
            self.orders += 1.0;
        }
    }

    fn scaled(&self, link: &Link, (rows, pushes): (&Rows, &[Block; 2]), epsilon: Real) -> Scaled {
        let Self { structure, inverse_roots, .. } = self;
        let mut scaled = Scaled {
            measures: [block::ZERO; 2],
            pushes: [block::ZERO; 2],
            weights: [0.0; 3],
            columns: [None; 2],
            shared: usize::MAX,
        };
        if rows.on == [false; 3] {
            return scaled;
        }
        for (side, slot) in link.iter().enumerate() {
            let Some(slot) = slot.map(|slot| slot as usize) else { continue };
            scaled.columns[side] = Some(structure.columns[slot]);
            let roots = inverse_roots[slot];
            let by_roots = |row: Triple| [0, 1, 2].map(|k| row[k] * roots[k]);
            scaled.measures[side] = rows.jacobian[side].map(by_roots);
            scaled.pushes[side] = pushes[side].map(by_roots);
        }
        for r in (0..3).filter(|r| rows.on[*r]) {
            let square = |side: &Block| side[r].iter().map(|x| x * x).sum::<Real>();
            let squared = scaled.measures.iter().map(square).sum::<Real>();
            let gives = rows.compliance[r] + epsilon * (squared + rows.compliance[r]);
            if gives.is_normal() && gives > 0.0 {
                scaled.weights[r] = 1.0 / gives;
            }
        }
        if let [Some(a), Some(b)] = scaled.columns
            && a != b
        {
            // OK because the order is one of a graph in which these two bodies are linked.
            scaled.shared = structure.shared([a, b]).unwrap_or(usize::MAX);
        }
        scaled
    }

    /// Writes M + Jᵀ W J, scaled: the identity and what the links add.
    fn fill(&mut self) {
        let Self { structure, numeric, links, .. } = self;
        numeric.reset(structure);
        numeric.diagonal.fill(diagonal([1.0; 3]));
        for link in links {
            for (column, measures) in link.columns.iter().zip(&link.measures) {
                if let Some(column) = column {
                    let to = &mut numeric.diagonal[*column as usize];
                    add_product(to, measures, &link.weights, measures);
                }
            }
            if let [Some(a), Some(b)] = link.columns {
                let [of_a, of_b] = &link.measures;
                if a == b {
                    let to = &mut numeric.diagonal[a as usize];
                    add_product(to, of_a, &link.weights, of_b);
                    add_product(to, of_b, &link.weights, of_a);
                } else {
                    let [row, column] = if a > b { [of_a, of_b] } else { [of_b, of_a] };
                    add_product(&mut numeric.below[link.shared], row, &link.weights, column);
                }
            }
        }
    }

    /// Writes M + Pᵀ W J, scaled.
    fn fill_unsymmetric(&mut self) {
        let Self { structure, unsymmetric, links, .. } = self;
        unsymmetric.reset(structure);
        unsymmetric.diagonal.fill(diagonal([1.0; 3]));
        for link in links {
            for (side, column) in link.columns.iter().enumerate() {
                let Some(column) = *column else { continue };
                for (other, row) in link.columns.iter().enumerate() {
                    let Some(row) = *row else { continue };
                    let (pushes, measures) = (&link.pushes[other], &link.measures[side]);
                    if row == column {
                        let to = &mut unsymmetric.diagonal[row as usize];
                        add_product(to, pushes, &link.weights, measures);
                    } else if row > column {
                        let to = &mut unsymmetric.below[link.shared];
                        add_product(to, pushes, &link.weights, measures);
                    } else {
                        let to = &mut unsymmetric.beside[link.shared];
                        add_product(to, measures, &link.weights, pushes);
                    }
                }
            }
        }
    }
}

/// target + Aᵀ W B.
fn add_product(target: &mut Block, a: &Block, weights: &Triple, b: &Block) {
    let a = transposed(a);
    for (row, a) in target.iter_mut().zip(a) {
        let weighted = [0, 1, 2].map(|r| a[r] * weights[r]);
        add(row, transposed_times(b, weighted));
    }
}
