use super::*;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use proptest::prelude::*;

/// Rounding of one operation.
const EPSILON: Real = Real::EPSILON;

/// Bodies, links and their rows, with a right-hand side.
#[derive(Clone, Debug, Default)]
struct Island {
    bodies: Vec<Velocity>,
    links: Vec<Link>,
    rows: Vec<Rows>,
    b: Vec<Triple>,
}

#[derive(Clone, Debug)]
struct Answer {
    impulses: Vec<Triple>,
    twists: Vec<Twist>,
    error: Real,
}

impl Island {
    /// A disk-like body of radius of gyration 1/2.
    fn body(&mut self, mass: Real) -> u32 {
        self.body_of([1.0 / mass, 1.0 / mass, 4.0 / mass])
    }

    fn body_of(&mut self, [x, y, z]: Triple) -> u32 {
        let twist = Twist::ZERO;
        self.bodies.push(Velocity { twist, inverse_mass: vec2(x, y), inverse_inertia: z });
        self.bodies.len() as u32 - 1
    }

    fn link(&mut self, link: Link, jacobian: [Block; 2], on: [bool; 3]) {
        self.links.push(link);
        self.rows.push(Rows { jacobian, compliance: [0.0; 3], on });
        self.b.push([0.0; 3]);
    }

    /// A pin through the points `arms` of its two bodies.
    fn pin(&mut self, link: Link, arms: [[Real; 2]; 2]) {
        let side = |sign: Real, [x, y]: [Real; 2]| {
            [[sign, 0.0, -sign * y], [0.0, sign, sign * x], [0.0; 3]]
        };
        self.link(link, [side(-1.0, arms[0]), side(1.0, arms[1])], [true, true, false]);
    }

    /// What stops bodies that all move with this velocity.
    fn stop(&mut self, velocity: Triple) {
        for ((b, rows), link) in self.b.iter_mut().zip(&self.rows).zip(&self.links) {
            *b = [0.0; 3];
            for (jacobian, _) in rows.jacobian.iter().zip(link).filter(|(_, end)| end.is_some()) {
                subtract(b, times(jacobian, velocity));
            }
        }
    }

    fn solve_from(&self, factor: &mut Factor, guess: &[Triple]) -> Answer {
        factor.analyse(self.bodies.len(), &self.links);
        factor.factor(&self.bodies, &self.rows);
        let mut impulses = guess.to_vec();
        let mut twists = vec![Twist::ZERO; self.bodies.len()];
        let error = factor.solve(&self.b, &mut impulses, &mut twists);
        Answer { impulses, twists, error }
    }

    fn solve(&self) -> Answer {
        self.solve_from(&mut Factor::default(), &vec![[0.0; 3]; self.links.len()])
    }

    /// 1/M of every unknown velocity.
    fn inverse_masses(&self) -> DVector<Real> {
        let own = |v: &Velocity| [v.inverse_mass.x, v.inverse_mass.y, v.inverse_inertia];
        DVector::from_iterator(3 * self.bodies.len(), self.bodies.iter().flat_map(own))
    }

    /// J, rows that are off left zero.
    fn jacobian(&self) -> DMatrix<Real> {
        let mut dense = DMatrix::zeros(3 * self.links.len(), 3 * self.bodies.len());
        for (k, (link, rows)) in self.links.iter().zip(&self.rows).enumerate() {
            for (end, side) in link.iter().zip(&rows.jacobian) {
                let Some(body) = end else { continue };
                for r in (0..3).filter(|&r| rows.on[r]) {
                    for (c, value) in side[r].iter().enumerate() {
                        dense[(3 * k + r, 3 * *body as usize + c)] += value;
                    }
                }
            }
        }
        dense
    }

    fn flat(x: &[Triple]) -> DVector<Real> {
        DVector::from_iterator(3 * x.len(), x.iter().flatten().copied())
    }

    fn compliance(&self) -> DVector<Real> {
        Self::flat(&self.rows.iter().map(|rows| rows.compliance).collect::<Vec<_>>())
    }

    /// √(J M⁻¹ Jᵀ + Σ) of every row; 1 of one that is off.
    fn lengths(&self) -> DVector<Real> {
        let j = self.jacobian();
        let inverse = self.inverse_masses();
        DVector::from_fn(j.nrows(), |r, _| {
            let rows = &self.rows[r / 3];
            let sum = (0..j.ncols()).map(|c| j[(r, c)] * j[(r, c)] * inverse[c]).sum::<Real>();
            if rows.on[r % 3] { (sum + rows.compliance[r % 3]).sqrt() } else { 1.0 }
        })
    }

    /// J v + Σ λ − b and M v − Jᵀ λ, in parts of the largest term, both scaled as the solver scales.
    fn faults(&self, answer: &Answer) -> (Real, Real) {
        let (j, lengths) = (self.jacobian(), self.lengths());
        let roots = self.inverse_masses().map(Real::sqrt);
        let twist = |t: &Twist| [t.linear.x, t.linear.y, t.angular];
        let v = Self::flat(&answer.twists.iter().map(twist).collect::<Vec<_>>());
        let lambda = Self::flat(&answer.impulses);
        let mut b = Self::flat(&self.b);
        for (r, value) in b.iter_mut().enumerate() {
            *value *= Real::from(u8::from(self.rows[r / 3].on[r % 3]));
        }
        let left = &j * &v + self.compliance().component_mul(&lambda) - &b;
        let push = (j.transpose() * &lambda).component_mul(&roots);
        let unbalanced = v.zip_zip_map(
            &roots,
            &push,
            |v, root, push| {
                if root > 0.0 { v / root - push } else { v }
            },
        );
        let largest = lambda.component_mul(&lengths).amax();
        (
            left.component_div(&lengths).amax() / b.component_div(&lengths).amax(),
            unbalanced.amax() / largest,
        )
    }

    /// The scaled impulses of least norm, and the condition number, by eigenvectors.
    fn dense(&self) -> (DVector<Real>, Real) {
        let lengths = self.lengths();
        let roots = self.inverse_masses().map(Real::sqrt);
        let mut j = self.jacobian();
        for r in 0..j.nrows() {
            for c in 0..j.ncols() {
                j[(r, c)] *= roots[c] / lengths[r];
            }
        }
        let mut matrix = &j * j.transpose();
        for (r, compliance) in self.compliance().iter().enumerate() {
            matrix[(r, r)] += compliance / (lengths[r] * lengths[r]);
        }
        let b = Self::flat(&self.b).component_div(&lengths);
        let SymmetricEigen { eigenvectors, eigenvalues } = matrix.symmetric_eigen();
        let kept = eigenvalues.map(|value| if value > 1e-11 { 1.0 / value } else { 0.0 });
        let exact = &eigenvectors * (eigenvectors.transpose() * &b).component_mul(&kept);
        (exact, eigenvalues.amax() * kept.amax())
    }

    fn scaled(&self, impulses: &[Triple]) -> DVector<Real> {
        Self::flat(impulses).component_mul(&self.lengths())
    }
}

/// Numbers that look random, from −1 to 1.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> Real {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as Real / (1_u64 << 52) as Real - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() + 1.0) / 2.0 * n as Real) as usize % n
    }

    /// Far from singular, so that masses alone make a system hard.
    fn block(&mut self) -> Block {
        [0, 1, 2].map(|r| [0, 1, 2].map(|c| self.next() + if r == c { 3.0 } else { 0.0 }))
    }

    fn link(&mut self, island: &mut Island, link: Link) {
        let on = [true, self.next() > -0.5, self.next() > 0.0];
        let jacobian = [self.block(), self.block()];
        island.link(link, jacobian, on);
        let own = island.rows.last_mut().expect("just added");
        own.compliance = [(); 3].map(|()| self.next().max(0.0));
        *island.b.last_mut().expect("just added") =
            [0, 1, 2].map(|r| if on[r] { self.next() } else { 0.0 });
    }

    /// A random tree on the ground, masses over so many decades, with some links more that are soft.
    fn island(&mut self, bodies: usize, loops: usize, decades: Real) -> Island {
        let mut island = Island::default();
        for k in 0..bodies {
            let mass = crate::math::powf(10.0, self.next() * decades / 2.0);
            let body = island.body(mass);
            let parent = (k > 0).then(|| self.below(k) as u32);
            let link = if self.next() > 0.0 { [parent, Some(body)] } else { [Some(body), parent] };
            self.link(&mut island, link);
        }
        for _ in 0..loops {
            let ends = [(); 2].map(|()| Some(self.below(bodies) as u32));
            self.link(&mut island, ends);
            let own = island.rows.last_mut().expect("just added");
            own.compliance = own.compliance.map(|s| s + 0.1);
        }
        island
    }
}

/// A chain of unit boxes that hangs from the ground, with a last mass of its own.
fn chain(count: usize, last: Real) -> Island {
    let mut island = Island::default();
    for k in 0..count {
        let body = island.body(if k + 1 == count { last } else { 1.0 });
        let above = (k > 0).then(|| body - 1);
        island.pin([above, Some(body)], [[0.0, -0.5], [0.0, 0.5]]);
    }
    island
}

/// A square lattice of bodies pinned to their neighbours.
fn lattice(side: u32) -> Island {
    let mut island = Island::default();
    for k in 0..side * side {
        let body = island.body(1.0);
        if k % side > 0 {
            island.pin([Some(body - 1), Some(body)], [[0.5, 0.0], [-0.5, 0.0]]);
        }
        if k >= side {
            island.pin([Some(body - side), Some(body)], [[0.0, 0.5], [0.0, -0.5]]);
        }
    }
    island
}

/// Products of blocks that factors cost.
fn operations(island: &Island) -> usize {
    let mut factor = Factor::default();
    factor.analyse(island.bodies.len(), &island.links);
    let degrees = (0..factor.structure.len()).map(|c| factor.structure.below(c).len());
    degrees.map(|d| d + d * (d + 1) / 2).sum()
}

proptest! {
    #[test]
    fn trees_and_loops_agree_with_dense_eigenvectors(
        seed: u64, bodies in 1_usize..12, loops in 0_usize..6,
    ) {
        let island = Dice(seed).island(bodies, loops, 2.0);
        let answer = island.solve();
        let (exact, condition) = island.dense();
        let fault = (island.scaled(&answer.impulses) - &exact).amax() / exact.amax();
        // The error of the eigenvectors, which is the larger one.
        let rounding = 4.0 * EPSILON * condition * (3 * island.links.len()) as Real;
        prop_assert!(condition > 1e10 || fault <= rounding, "{fault:e} {condition:e}");
    }

    #[test]
    fn rows_of_trees_hold_with_masses_over_twelve_decades(seed: u64, bodies in 1_usize..40) {
        let island = Dice(seed).island(bodies, 0, 12.0);
        let (row, balance) = island.faults(&island.solve());
        prop_assert!(row <= 1e-10 && balance <= 1e-10, "{row:e} {balance:e}");
    }

    #[test]
    fn rows_of_loops_hold_with_masses_over_ten_decades(
        seed: u64, bodies in 1_usize..40, loops in 1_usize..10,
    ) {
        let island = Dice(seed).island(bodies, loops, 10.0);
        let (row, balance) = island.faults(&island.solve());
        prop_assert!(row <= 1e-10 && balance <= 1e-10, "{row:e} {balance:e}");
    }

    #[test]
    fn order_of_creation_is_seen_in_rounding_only(seed: u64, bodies in 2_usize..20) {
        let mut dice = Dice(seed);
        let island = dice.island(bodies, bodies / 3, 2.0);
        let slot = |body: u32| bodies as u32 - 1 - body;
        let mut turned = island.clone();
        turned.bodies.reverse();
        turned.links.reverse();
        turned.rows.reverse();
        turned.b.reverse();
        turned.links.iter_mut().for_each(|link| *link = link.map(|end| end.map(slot)));
        let (first, mut second) = (island.solve(), turned.solve());
        second.impulses.reverse();
        let condition = island.dense().1;
        let scaled = [&first, &second].map(|answer| island.scaled(&answer.impulses));
        let fault = (&scaled[0] - &scaled[1]).amax() / scaled[0].amax();
        prop_assert!(condition > 1e10 || fault <= 16.0 * EPSILON * condition, "{fault:e}");
    }
}

#[test]
fn a_heavy_end_hangs_on_a_light_chain() {
    for (count, last) in [(2, 1e6), (20, 1e6), (20, 1e-6), (100, 1e6)] {
        let mut island = chain(count, last);
        island.stop([0.0, -1.0, 0.0]);
        let answer = island.solve();
        let (row, balance) = island.faults(&answer);
        assert!(row <= 1e-10 && balance <= 1e-10, "{count} {last}: {row:e} {balance:e}");
        for (k, [x, y, _]) in answer.impulses.iter().enumerate() {
            let carried = last + (count - 1 - k) as Real;
            assert!((y - carried).abs() <= 1e-10 * carried, "{count} {last} {k}: {y} {carried}");
            assert!(x.abs() <= 1e-10 * carried, "{x}");
        }
    }
}

/// What rounding may leave between rows that share a load: the square of some 2⁻⁵³ over the regularisation.
const SHARE: Real = (4.0 * EPSILON / LOOP_REGULARISATION) * (4.0 * EPSILON / LOOP_REGULARISATION);

#[test]
fn equal_supports_carry_equal_halves() {
    let mut island = Island::default();
    let beam = Some(island.body(3.0));
    island.pin([None, beam], [[0.0, 0.0], [-1.0, 0.0]]);
    island.pin([None, beam], [[0.0, 0.0], [1.0, 0.0]]);
    island.stop([0.2, -1.0, 0.0]);
    let answer = island.solve();
    for impulse in &answer.impulses {
        assert!(
            (impulse[0] + 0.3).abs() <= SHARE && (impulse[1] - 1.5).abs() <= SHARE,
            "{impulse:?}"
        );
    }
    assert!(answer.error <= 4.0 * EPSILON, "{:e}", answer.error);
}

#[test]
fn doubled_joints_and_a_four_bar_in_a_line_have_least_impulses() {
    let mut doubled = chain(3, 5.0);
    doubled.pin([Some(1), Some(2)], [[0.0, -0.5], [0.0, 0.5]]);
    doubled.stop([0.3, -1.0, 0.1]);
    let mut line = Island::default();
    for k in 0..3 {
        let body = line.body(1.0 + Real::from(k));
        line.pin([body.checked_sub(1), Some(body)], [[0.5, 0.0], [-0.5, 0.0]]);
    }
    line.pin([Some(2), None], [[0.5, 0.0], [0.0, 0.0]]);
    line.stop([0.3, -1.0, 0.1]);
    for island in [doubled, line] {
        let answer = island.solve();
        let exact = island.dense().0;
        let fault = (island.scaled(&answer.impulses) - &exact).amax() / exact.amax();
        assert!(fault <= SHARE, "{fault:e}");
        assert!(island.faults(&answer).0 <= 1e-14, "{:e}", island.faults(&answer).0);
    }
}

#[test]
fn redundant_rows_stay_where_the_guess_had_them() {
    let mut island = Island::default();
    let body = Some(island.body(1.0));
    for _ in 0..2 {
        island.pin([None, body], [[0.0; 2]; 2]);
    }
    island.stop([0.0, -1.0, 0.0]);
    let guess = [[0.0, 0.9, 0.0], [0.0, 0.3, 0.0]];
    let impulses = island.solve_from(&mut Factor::default(), &guess).impulses;
    assert!(
        (impulses[0][1] - 0.8).abs() <= SHARE && (impulses[1][1] - 0.2).abs() <= SHARE,
        "{impulses:?}"
    );
    island.b = vec![[0.0; 3]; 2];
    let impulses = island.solve_from(&mut Factor::default(), &guess).impulses;
    assert!(
        (impulses[0][1] - 0.3).abs() <= SHARE && (impulses[1][1] + 0.3).abs() <= SHARE,
        "{impulses:?}"
    );
}

#[test]
fn rows_that_nothing_can_solve_give_no_nan() {
    let mut island = Island::default();
    let fixed = Some(island.body_of([0.0; 3]));
    let rail = Some(island.body_of([1.0, 0.0, 0.0]));
    let arms = [[0.0, 0.5], [0.3, 0.0]];
    for link in
        [[None, None], [fixed, None], [fixed, rail], [rail, rail], [rail, None], [None, rail]]
    {
        island.pin(link, arms);
    }
    island.b = vec![[1.0, 2.0, 3.0]; 6];
    island.rows[4].jacobian[0][1][0] = Real::NAN;
    island.rows[5].jacobian[1][0][0] = Real::INFINITY;
    let answer = island.solve();
    assert!(answer.impulses.iter().flatten().all(|x| x.is_finite()), "{answer:?}");
    assert!(answer.twists.iter().all(|t| t.linear.x.is_finite()), "{answer:?}");
    assert_eq!(answer.impulses[0], [0.0; 3]);
    assert_eq!(answer.impulses[4][1], 0.0);
    assert_eq!(answer.impulses[3], [0.0; 3], "a body does not pull itself along");

    island.b[2][0] = Real::NAN;
    let answer = island.solve();
    assert!(answer.impulses.iter().flatten().all(|x| x.is_finite()), "{answer:?}");
}

#[test]
fn rows_that_contradict_one_another_are_told_and_meet_in_the_middle() {
    let mut island = Island::default();
    let body = Some(island.body(1.0));
    for x in [0.0, 1.0] {
        island.pin([None, body], [[0.0; 2]; 2]);
        island.b.last_mut().expect("just added")[0] = x;
    }
    let answer = island.solve();
    assert!((answer.error - 0.5).abs() <= 1e-6, "{answer:?}");
    assert!((answer.twists[0].linear.x - 0.5).abs() <= 1e-6, "{answer:?}");
}

#[test]
fn the_same_rows_give_the_same_bits() {
    let (mut dice, mut used) = (Dice(7), Factor::default());
    let (first, second) = (dice.island(9, 4, 12.0), dice.island(30, 9, 3.0));
    for island in [&first, &second, &first, &first] {
        let guess = vec![[0.0; 3]; island.links.len()];
        let (fresh, reused) = (island.solve(), island.solve_from(&mut used, &guess));
        assert_eq!(fresh.impulses, reused.impulses);
        assert_eq!(fresh.twists, reused.twists);
    }
    assert!(!used.analyse(9, &first.links), "the graph is the same");
    assert!(used.analyse(10, &first.links), "there is one body more");
}

#[test]
fn trees_cost_as_many_products_as_they_have_links() {
    let costs = [100, 1000].map(|count| operations(&chain(count, 1.0)));
    assert_eq!(costs[0], 2 * (2 * 100 - 1));
    assert_eq!(costs[1], 2 * (2 * 1000 - 1));
    // Nothing is filled in: one block an end, and each is multiplied once.
    let tree = Dice(3).island(500, 0, 1.0);
    assert_eq!(operations(&tree), 2 * (2 * 500 - 1));
}

#[test]
fn a_link_goes_after_a_body_of_its_own_and_blocks_hold_all_fill() {
    let mut dice = Dice(11);
    for island in [chain(9, 1.0), lattice(6), dice.island(30, 20, 1.0), dice.island(9, 40, 1.0)] {
        let mut factor = Factor::default();
        factor.analyse(island.bodies.len(), &island.links);
        let structure = &factor.structure;
        for (k, link) in island.links.iter().enumerate() {
            let own = structure.columns[island.bodies.len() + k];
            assert!(link.iter().flatten().any(|body| structure.columns[*body as usize] < own));
        }
        for column in 0..structure.len() {
            let below = &structure.rows[structure.below(column)];
            for (first, row) in below.iter().enumerate() {
                let rows = &structure.rows[structure.below(*row as usize)];
                assert!(below[first + 1..].iter().all(|other| rows.contains(other)), "{column}");
            }
        }
    }
}

#[test]
fn loops_are_told_from_trees() {
    let redundant = |island: &Island| {
        let mut factor = Factor::default();
        factor.analyse(island.bodies.len(), &island.links);
        factor.structure.redundant
    };
    let mut island = chain(5, 1.0);
    island.body(1.0);
    assert!(!redundant(&island));
    let mut twice = island.clone();
    twice.pin([Some(1), Some(2)], [[0.0; 2]; 2]);
    let mut closed = island.clone();
    closed.pin([Some(4), Some(1)], [[0.0; 2]; 2]);
    let mut held = island.clone();
    held.pin([Some(4), None], [[0.0; 2]; 2]);
    assert!(redundant(&twice) && redundant(&closed) && redundant(&held));
}

#[test]
fn lattices_cost_little_more_than_their_bodies() {
    // The best order takes N^(3/2) of them, 8 times as many for 4 times the bodies; a band takes 16 times.
    let costs = [10, 20, 40].map(|side| operations(&lattice(side)));
    assert!(costs[1] < 12 * costs[0] && costs[2] < 10 * costs[1], "{costs:?}");
}
