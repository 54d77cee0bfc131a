//! Lanes against the scalar version: the same bits.

use proptest::prelude::*;

use crate::body::Friction;
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::{Real, Rot, Twist, Vec2, vec2};
use crate::solvers::Lanes;
use crate::solvers::sweep::{self, Budget};

/// How a body moves, and whether it gives way.
fn bodies() -> impl Strategy<Value = Vec<Velocity>> {
    let body = (-2.0..2.0, -2.0..2.0, -3.0..3.0, 0.1..10.0_f64, 0..6_u8);
    let velocity = |(x, y, spin, mass, kind): (Real, Real, Real, Real, u8)| Velocity {
        twist: Twist::new(vec2(x, y), spin),
        inverse_mass: if kind == 0 { Vec2::zeros() } else { vec2(1.0 / mass, 1.0 / mass) },
        inverse_inertia: if kind < 2 { 0.0 } else { 6.0 / mass },
    };
    prop::collection::vec(body.prop_map(velocity), 2..60)
}

/// Numbers of a block: its bodies, normal, arms, targets, impulses before, friction, and which rows take part.
type Numbers = ([u32; 2], Real, [Real; 4], [Real; 3], [Real; 3], [Real; 2], [bool; 4]);

fn numbers() -> impl Strategy<Value = Vec<Numbers>> {
    let arms = [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64];
    let target = [-0.5..0.5_f64, -0.5..0.5_f64, -0.1..0.1_f64];
    let impulse = [0.0..0.5_f64, 0.0..0.5_f64, -0.2..0.2_f64];
    let block = (
        any::<[u32; 2]>(),
        -3.2..3.2_f64,
        arms,
        target,
        impulse,
        [0.0..4.0_f64, 0.1..1.0_f64],
        any::<[bool; 4]>(),
    );
    prop::collection::vec(block, 16..120)
}

fn block(numbers: &Numbers, velocities: &[Velocity]) -> Block {
    let (slots, turn, arms, target, impulse, [sticking, part], flags) = *numbers;
    let count = velocities.len() as u32;
    let (a, mut b) = (slots[0] % count, slots[1] % count);
    if a == b {
        b = (a + 1) % count;
    }
    let [two, first, last, loaded] = flags;
    let on = if two { [first, last] } else { [true, false] };
    // What has one point bears nothing at a second.
    let second = if two { [arms[2], arms[3]] } else { [0.0; 2] };
    let impulse = if two { impulse } else { [impulse[0], 0.0, impulse[2]] };
    let n = Rot::new(turn).apply(vec2(1.0, 0.0));
    let mut block = Block {
        bodies: [a, b],
        normal: n,
        arms: [[arms[0], arms[1]], second, [arms[0] - 0.3, arms[1] + 0.4]],
        gap: [0.0; 2],
        target,
        response: [0.0; 6],
        inverse: [0.0; 6],
        impulse: if loaded { impulse } else { [0.0; 3] },
        rolling: 0.0,
        friction: Friction { sticking, sliding: sticking * part },
        rolling_resistance: 0.0,
        on,
        count: if two { 2 } else { 1 },
        sliding: loaded && first,
    };
    block.prepare([&velocities[a as usize], &velocities[b as usize]]);
    block
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn eight_at_a_time_give_the_bits_of_one_after_the_other(
        bodies in bodies(), numbers in numbers(), sweeps in 1..6_u32,
    ) {
        // Between two bodies that do not give way there is no contact.
        let gives_way = |block: &Block| block.bodies.iter().any(|slot| !bodies[*slot as usize].is_fixed());
        let blocks = numbers.iter().map(|numbers| block(numbers, &bodies));
        let blocks: Vec<Block> = blocks.filter(gives_way).collect();
        let budget = Budget { tolerance: 0.0, most: sweeps };
        let (mut one, mut rows) = (bodies.clone(), blocks.clone());
        let expected = sweep::solve(&mut one, &mut rows, budget);
        let (mut many, mut packed) = (bodies.clone(), blocks);
        let mut lanes = Lanes::default();
        lanes.pack(&many, &packed);
        let found = sweep::solve_packed(&mut many, &mut packed, &mut lanes, budget);
        prop_assert_eq!(expected, found);
        for (k, (one, many)) in one.iter().zip(&many).enumerate() {
            prop_assert_eq!(one.twist, many.twist, "body {}", k);
        }
        for (one, many) in rows.iter().zip(&packed) {
            prop_assert_eq!(one.impulse, many.impulse);
            prop_assert_eq!(one.sliding, many.sliding);
        }
    }
}
