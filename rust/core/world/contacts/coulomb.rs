//! Coulomb's and Signorini's laws, read from the rows themselves after each step of random piles.

use crate::body::{BodyDef, BodyKind, Friction};
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::{Real, vec2};
use crate::methods::contact_step::Group;
use crate::shapes::Shape;
use crate::solvers::Solver;
use crate::world::World;
use proptest::prelude::*;

const DT: Real = 1.0 / 60.0;
const G: Real = 10.0;

/// Sizes, what each is, and where over its column it lies.
type Heap = Vec<(u8, Real, Real)>;

fn heaps() -> impl Strategy<Value = Heap> {
    prop::collection::vec((0..3_u8, 0.5..1.0_f64, -0.3..0.3_f64), 2..9)
}

fn fixed(width: Real, height: Real, x: Real, y: Real, friction: Friction) -> BodyDef {
    let mut def = BodyDef {
        kind: BodyKind::Static,
        position: vec2(x, y),
        ..BodyDef::new(Shape::rectangle(width, height).unwrap())
    };
    def.surface.friction = friction;
    def
}

/// A bin two wide, so that all that lies in it ends in one heap.
fn bin(heap: &Heap, friction: Friction) -> World {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    world.set_sweeps(200).unwrap();
    world.add_body(fixed(20.0, 2.0, 0.0, -1.0, friction)).unwrap();
    for side in [-1.0, 1.0] {
        world.add_body(fixed(1.0, 40.0, 1.6 * side, 19.0, friction)).unwrap();
    }
    for (k, (what, size, aside)) in heap.iter().enumerate() {
        let shape = match what {
            0 => Shape::circle(0.5 * size).unwrap(),
            1 => Shape::rectangle(*size, 0.7 * size).unwrap(),
            _ => Shape::regular_polygon(5, 0.5 * size).unwrap(),
        };
        let mut def = BodyDef {
            position: vec2(*aside, 0.6 + 1.1 * k as Real),
            angle: 3.0 * aside,
            ..BodyDef::new(shape)
        };
        def.surface.friction = friction;
        world.add_body(def).unwrap();
    }
    world
}

/// Rows of the last group that was solved, with the bodies' velocities after.
fn rows(group: &Group) -> impl Iterator<Item = (&Block, [&Velocity; 2])> {
    group
        .blocks
        .iter()
        .map(|block| (block, block.bodies.map(|slot| &group.velocities[slot as usize])))
}

fn weight(world: &World) -> Real {
    world.mass() * G
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// λ ≥ 0 and |λt| ≤ μ(λ0 + λ1) to the rounding of the product; what slides is at the bound and rubs
    /// against the slip; what does not slide sticks; a row with an impulse meets its target, and none falls
    /// below it. Velocities hold to what the sweeps left: rows seen early in the last sweep were moved once by each
    /// neighbour since, so by a few residuals.
    #[test]
    fn every_contact_of_a_heap_obeys_signorini_and_coulomb(
        heap in heaps(), sticking in 0.1..0.9_f64, part in 0.5..=1.0_f64,
        solver in prop::sample::select(Solver::ALL.map(|(_, solver)| solver).to_vec()),
    ) {
        let friction = Friction { sticking, sliding: sticking * part };
        let mut world = bin(&heap, friction);
        world.set_solver(solver);
        for _ in 0..150 {
            world.step(DT).unwrap();
            let slack = 20.0 * world.report().residual + 1e-12;
            for (block, bodies) in rows(&world.scratch.contacts.group) {
                let [p, q, t] = block.impulse;
                prop_assert!(p >= 0.0 && q >= 0.0, "{:?}", block.impulse);
                let bound = sticking * (p + q);
                prop_assert!(t.abs() <= bound * (1.0 + 1e-14), "{:?} beyond {}", block.impulse, bound);
                let u = block.velocity(bodies);
                for (k, speed) in u.iter().enumerate().take(usize::from(block.count)) {
                    let over = speed - block.target[k];
                    if block.on[k] {
                        prop_assert!(over >= -slack, "row {} is {:e} short of {:e}", k, over, slack);
                        prop_assert!(block.impulse[k] == 0.0 || over <= slack, "row {} pulls: {:e}", k, over);
                    } else {
                        prop_assert_eq!(block.impulse[k], 0.0);
                    }
                }
                let slip = u[2] - block.target[2];
                if p + q == 0.0 {
                    prop_assert_eq!(t, 0.0);
                } else if block.sliding {
                    let bound = friction.sliding * (p + q);
                    prop_assert!((t.abs() - bound).abs() <= 1e-14 * bound, "slides at {} of {}", t, bound);
                    prop_assert!(slip * t.signum() <= slack, "pushed along: {:e} by {:e}", slip, t);
                } else {
                    prop_assert!(slip.abs() <= slack, "creeps at {:e}, residual {:e}", slip, slack);
                }
            }
        }
    }

    /// Σ of the impulses that the bin gives to what rests in it, over the substep, is its weight.
    #[test]
    fn the_bin_bears_the_weight_of_a_heap_at_rest(heap in heaps()) {
        let mut world = bin(&heap, Friction::of(0.6));
        world.steps(DT, 400).unwrap();
        let moving = world.bodies().twists.iter().map(|v| v.linear.norm()).fold(0.0, Real::max);
        prop_assume!(moving < 1e-6);
        let h = DT / 4.0;
        let contacts = &world.state.contacts;
        let mut sum = vec2(0.0, 0.0);
        for patch in &contacts.patches {
            let near = &contacts.near[patch.near as usize];
            let bodies = near.proxies.map(|proxy| contacts.body_of(proxy) as usize);
            let fixed = bodies.map(|i| !world.bodies().masses[i].is_free());
            if fixed == [false, false] {
                continue;
            }
            let rot = bodies.map(|i| world.bodies().poses[i].rot());
            let normal = match patch.manifold.normal {
                crate::collision::Normal::OnA(n) => rot[0].apply(n),
                crate::collision::Normal::OnB(n) => rot[1].apply(n),
                _ => {
                    let at = [0, 1].map(|s| world.bodies().poses[bodies[s]].position);
                    let anchor = &patch.manifold.anchors[0];
                    ((at[1] - at[0]) + (rot[1].apply(anchor.on_b) - rot[0].apply(anchor.on_a))).normalize()
                }
            };
            let [p, q, t] = patch.memory.impulse;
            let on_b = normal * (p + q) + crate::math::perp(normal) * t;
            sum += if fixed[0] { on_b } else { -on_b };
        }
        let balance = sum / h - vec2(0.0, weight(&world));
        prop_assert!(balance.norm() <= 1e-3 * weight(&world), "{:?} of {}", balance, weight(&world));
    }
}
