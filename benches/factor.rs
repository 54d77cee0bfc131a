//! What the direct solution of joints costs: a graph prepared, factors, a solution, on chains and a lattice.

use criterion::{Criterion, criterion_group, criterion_main};
use culbuto::constraints::Velocity;
use culbuto::math::{Real, Twist, vec2};
use culbuto::solvers::direct::{Block, Factor, Link, Rows};

struct Island {
    bodies: Vec<Velocity>,
    links: Vec<Link>,
    rows: Vec<Rows>,
}

impl Island {
    fn of(count: usize) -> Self {
        let box_of_one_kilogram =
            Velocity { twist: Twist::ZERO, inverse_mass: vec2(1.0, 1.0), inverse_inertia: 6.0 };
        Self { bodies: vec![box_of_one_kilogram; count], links: Vec::new(), rows: Vec::new() }
    }

    /// A pin half a metre from both centres.
    fn pin(&mut self, link: Link, [x, y]: [Real; 2]) {
        let side = |sign: Real| -> Block { [[sign, 0.0, y], [0.0, sign, -x], [0.0; 3]] };
        let jacobian = [side(-1.0), side(1.0)];
        self.links.push(link);
        self.rows.push(Rows { jacobian, compliance: [0.0; 3], on: [true, true, false] });
    }
}

fn chain(count: u32) -> Island {
    let mut island = Island::of(count as usize);
    for k in 0..count {
        // Bent, so that every block is full.
        let turn = Real::from(k % 7) * 0.1;
        island.pin([k.checked_sub(1), Some(k)], [0.5 * turn, 0.5 - 0.3 * turn]);
    }
    island
}

fn lattice(side: u32) -> Island {
    let mut island = Island::of((side * side) as usize);
    for k in 0..side * side {
        if k % side > 0 {
            island.pin([Some(k - 1), Some(k)], [0.5, 0.0]);
        }
        if k >= side {
            island.pin([Some(k - side), Some(k)], [0.0, 0.5]);
        }
    }
    island
}

fn measure(criterion: &mut Criterion, name: &str, island: &Island) {
    let Island { bodies, links, rows } = island;
    let smaller = links.len() - 1;
    let mut factor = Factor::default();
    criterion.bench_function(&format!("factor: {name}, analyse"), |b| {
        b.iter(|| {
            factor.analyse(bodies.len(), &links[..smaller]);
            factor.analyse(bodies.len(), links)
        });
    });
    criterion.bench_function(&format!("factor: {name}, factor"), |b| {
        b.iter(|| factor.factor(bodies, rows));
    });
    let right = vec![[0.1, -1.0, 0.0]; links.len()];
    let mut twists = vec![Twist::ZERO; bodies.len()];
    let mut impulses = vec![[0.0; 3]; links.len()];
    criterion.bench_function(&format!("factor: {name}, solve"), |b| {
        b.iter(|| {
            impulses.fill([0.0; 3]);
            factor.solve(&right, &mut impulses, &mut twists)
        });
    });
}

fn factor(criterion: &mut Criterion) {
    for count in [1, 2, 5, 20, 100, 1000] {
        measure(criterion, &format!("chain of {count}"), &chain(count));
    }
    measure(criterion, "lattice of 30 × 30", &lattice(30));
}

criterion_group!(benches, factor);
criterion_main!(benches);
