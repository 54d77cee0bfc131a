//! Surface tension and adhesion: the edges of the border of each fluid pull their ends together.
//!
//! The border is that of the α-shape of its particles (Edelsbrunner, Kirkpatrick and Seidel, "On the shape of a set of
//! points in the plane", 1983): two particles are joined by an edge if a disk of radius α touches both and holds no third
//! of the fluid. With α = H/2 the neighbours of the two tell. An edge pulls with σ, so that a polygon of edges presses on
//! what is inside by Laplace's law, σ is what it is called, and momentum and angular momentum are kept. The energy is
//! E = Σ (σ − W s) ℓ over the edges of length ℓ.
//!
//! Where the outer side of an edge is a solid, s is 1 (0 far from it), and what is gained there is the work of adhesion W:
//! by Young and Dupré W = σ(1 + cos θ) for a contact angle θ.

use super::kernel::lattice;
use super::pairs::{Pair, Pairs};
use super::solid::{Touches, moment};
use crate::math::{Real, Twist, Vec2, perp};

/// An edge of the border of a fluid.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// The particles at its ends.
    ends: [u32; 2],
    /// From the first to the second (m).
    way: Vec2,
    /// Unit vector away from the fluid.
    outward: Vec2,
}

/// Particles as the surface sees them.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// Where they are (m).
    pub positions: &'a [Vec2],
    /// Which fluid each is of.
    pub kinds: &'a [u32],
    /// Surface tension of each (N/m).
    pub tension: &'a [Real],
    /// Work of adhesion of each (N/m).
    pub adhesion: &'a [Real],
    /// H (m).
    pub support: Real,
}

/// The borders of the fluids that have surface tension.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    edges: Vec<Edge>,
    /// Where the neighbours of each particle end.
    ends: Vec<u32>,
    neighbours: Vec<u32>,
    /// Where the touches of each particle are.
    touches: Vec<[u32; MOST_TOUCHES]>,
}

/// Bodies that a particle can adhere to at once.
const MOST_TOUCHES: usize = 2;

const NONE: u32 = u32::MAX;

/// What is given to particles (N) and bodies (N·s).
type Given<'a> = (&'a mut [Pair], &'a mut [Twist]);

impl Surface {
    /// Adds the forces on particles and, times h, the impulses on bodies. Gives the energy of the surface (J).
    pub fn pull(
        &mut self,
        (pairs, touches): (&Pairs, &Touches),
        seen: Seen<'_>,
        (forces, impulses): Given<'_>,
        h: Real,
    ) -> Real {
        self.gather(pairs, seen);
        self.find(seen);
        if seen.adhesion.iter().any(|work| *work > 0.0) {
            self.place(touches, seen.positions.len());
        }
        let mut energy = 0.0;
        for edge in &self.edges {
            let length = edge.way.norm();
            let first = edge.ends[0] as usize;
            let (mut pull, work) = (seen.tension[first], 0.5 * seen.adhesion[first]);
            if work > 0.0 {
                for end in edge.ends {
                    let out = (&mut *forces, &mut *impulses);
                    pull -= self.adhere(touches, (end as usize, edge), (work, h), out);
                }
            }
            energy += pull * length;
            let force = edge.way * (pull / length);
            add(&mut forces[first], force);
            add(&mut forces[edge.ends[1] as usize], -force);
        }
        energy
    }

    /// Finds the edges: pairs of neighbours with an empty disk on one side, or on both.
    fn find(&mut self, seen: Seen<'_>) {
        let Self { edges, ends, neighbours, .. } = self;
        edges.clear();
        let x = seen.positions;
        let square = 0.25 * seen.support * seen.support;
        // Of four on one circle none is inside by rounding.
        let inside = square * (1.0 - 1e-9);
        let mut start = 0;
        for (i, end) in ends.iter().enumerate() {
            let near = &neighbours[start..*end as usize];
            start = *end as usize;
            for &j in near.iter().filter(|j| **j as usize > i) {
                let way = x[j as usize] - x[i];
                let length = way.norm();
                if length == 0.0 {
                    continue;
                }
                let (middle, across) = (x[i] + way / 2.0, perp(way) / length);
                let rise = (square - 0.25 * length * length).max(0.0).sqrt();
                for outward in [across, -across] {
                    let center = middle + outward * rise;
                    let holds = |k: &u32| (x[*k as usize] - center).norm_squared() < inside;
                    if !near.iter().any(|k| *k != j && holds(k)) {
                        edges.push(Edge { ends: [i as u32, j], way, outward });
                    }
                }
            }
        }
    }

    /// Collects the neighbours of each particle in its own fluid.
    fn gather(&mut self, pairs: &Pairs, Seen { positions, kinds, tension, .. }: Seen<'_>) {
        let Self { ends, neighbours, .. } = self;
        let tied = |i: usize, j: usize| kinds[i] == kinds[j] && tension[i] > 0.0;
        ends.clear();
        ends.resize(positions.len(), 0);
        pairs.visit(|i, j| {
            if tied(i, j) {
                ends[i] += 1;
                ends[j] += 1;
            }
        });
        let mut sum = 0;
        for end in ends.iter_mut() {
            // Where the neighbours begin; filling moves it to where they end.
            sum += std::mem::replace(end, sum);
        }
        neighbours.clear();
        neighbours.resize(sum as usize, 0);
        let mut put = |i: usize, j: usize| {
            neighbours[ends[i] as usize] = j as u32;
            ends[i] += 1;
        };
        pairs.visit(|i, j| {
            if tied(i, j) {
                put(i, j);
                put(j, i);
            }
        });
    }

    /// Where each particle's touches are in their list.
    fn place(&mut self, touches: &Touches, particles: usize) {
        self.touches.clear();
        self.touches.resize(particles, [NONE; MOST_TOUCHES]);
        for (k, touch) in touches.list.iter().enumerate() {
            let places = &mut self.touches[touch.particle as usize];
            if let Some(place) = places.iter_mut().find(|place| **place == NONE) {
                *place = k as u32;
            }
        }
    }

    /// Draws an end of an edge to the solids that its outer side is turned to. Gives what the edge pulls less (N).
    fn adhere(
        &self,
        touches: &Touches,
        (i, edge): (usize, &Edge),
        (work, h): (Real, Real),
        (forces, impulses): Given<'_>,
    ) -> Real {
        let mut gain = 0.0;
        for k in self.touches[i].into_iter().filter(|k| *k != NONE) {
            let touch = &touches.list[k as usize];
            let steep = touch.slope.norm();
            let faces = if steep > 0.0 { edge.outward.dot(&touch.slope) / steep } else { 0.0 };
            let near = touch.part / lattice().first;
            let work = work * faces.max(0.0);
            gain += work * near.min(1.0);
            if near < 1.0 {
                let force = touch.slope * (work * edge.way.norm() / lattice().first);
                add(&mut forces[i], force);
                impulses[touch.wet as usize] += moment(touch.arm, force * -h);
            }
        }
        gain
    }
}

fn add(own: &mut Pair, force: Vec2) {
    *own = [own[0] + force.x, own[1] + force.y];
}
