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

/// Rows of the last group that was solved, with the bodies' velocities after. Where overlap is removed bodies are turned back, which
/// is no business of theirs.
fn rows(group: &Group) -> impl Iterator<Item = (&Block, [&Velocity; 2])> {
    group.blocks.iter().map(|block| (block, block.bodies.map(|slot| &group.left[slot as usize])))
}

/// By how many residuals the rows of block k may lack, at most. Its own turn left nothing, or, where Coulomb's law has no solution for it
/// alone, what its rows did to one another. Each row j in that turn or a later one changed its own velocity by no more than a residual
/// R, so its impulse by R/K_jj, and the bodies that both share carry K_kj R/K_jj to these. Where impulses were weakened, each body was given back no more than ½mR², hence R√(m k) along a row of
/// response k.
fn slack(group: &Group, k: usize) -> [Real; 3] {
    let block = &group.blocks[k];
    let direction = |block: &Block, r: usize| if r < 2 { block.normal } else { block.tangent() };
    let mut slack = [0.0; 3];
    for (r, slack) in slack.iter_mut().enumerate() {
        for (side, slot) in block.bodies.iter().enumerate() {
            let body = &group.velocities[*slot as usize];
            let row = (direction(block, r), block.arms[r][side]);
            *slack += (group.masses[*slot as usize].mass * body.coupling(row, row)).sqrt();
            for later in &group.blocks[k..] {
                let [p, q, _, _, _, t] = later.response;
                for (at, _) in later.bodies.iter().enumerate().filter(|(_, other)| *other == slot) {
                    for (s, own) in [p, q, t].into_iter().enumerate().filter(|(_, own)| *own > 0.0)
                    {
                        let other = (direction(later, s), later.arms[s][at]);
                        *slack += body.coupling(row, other).abs() / own;
                    }
                }
            }
        }
    }
    slack
}

/// Whether a block obeys both laws to a slack (m/s) of each row.
fn obeys(
    block: &Block,
    bodies: [&Velocity; 2],
    friction: Friction,
    slack: [Real; 3],
) -> Result<(), TestCaseError> {
    let [p, q, t] = block.impulse;
    prop_assert!(p >= 0.0 && q >= 0.0, "{:?}", block.impulse);
    let bound = friction.sticking * (p + q);
    prop_assert!(t.abs() <= bound * (1.0 + 1e-14), "{:?} beyond {}", block.impulse, bound);
    let u = block.velocity(bodies);
    for k in 0..usize::from(block.count) {
        let over = u[k] - block.target[k];
        if block.on[k] {
            prop_assert!(over >= -slack[k], "row {} is {:e} short of {:e}", k, over, slack[k]);
            prop_assert!(
                block.impulse[k] == 0.0 || over <= slack[k],
                "row {} pulls: {:e}",
                k,
                over
            );
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
        prop_assert!(slip * t.signum() <= slack[2], "pushed along: {:e} by {:e}", slip, t);
    } else {
        prop_assert!(slip.abs() <= slack[2], "creeps at {:e} of {:e}", slip, slack[2]);
    }
    Ok(())
}

fn weight(world: &World) -> Real {
    world.mass() * G
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// λ ≥ 0 and |λt| ≤ μ(λ0 + λ1) to the rounding of the product; what slides is at the bound and rubs
    /// against the slip; what does not slide sticks; a row with an impulse meets its target, and none falls
    /// below it. Velocities hold to what the last sweep left, see [`slack`].
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
            let residual = world.report().residual;
            let group = &world.scratch.contacts.group;
            for (k, (block, bodies)) in rows(group).enumerate() {
                let slack = slack(group, k).map(|by| by * residual + 1e-12);
                obeys(block, bodies, friction, slack)?;
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
