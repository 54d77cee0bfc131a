//! Conservation: momentum, angular momentum, energy.

use culbuto::World;
use culbuto::joint::{Hold, JointKind};
use culbuto::math::{Real, Vec2, perp, vec2};
use proptest::prelude::*;

use crate::common::{
    DT, H, Thrown, Tied, at_a_point, chain, fewer, joined, joints, pairs, scales, vector,
};

/// Whether a joint holds at one place, with any force, what is not there.
fn is_put(tied: &Tied) -> bool {
    let hard = |hold: &Hold, most: Option<Real>| *hold == Hold::Rigid && most.is_none();
    match &tied.kind {
        JointKind::Grab { hold, max_force } => hard(hold, *max_force),
        JointKind::Motor { linear, max_force, .. } => hard(linear, *max_force),
        _ => false,
    }
}

/// Largest changes of momentum and angular momentum in a second, of the largest Σm|v| and Σ(m|r||v| + I|ω|).
fn changes(world: &mut World) -> (Real, Real) {
    let center = world.center_of_mass();
    let start = (world.momentum(), world.angular_momentum(center));
    let (mut linear, mut angular): (Real, Real) = (0.0, 0.0);
    let mut scale = scales(world, center);
    for _ in 0..60 {
        world.step(DT).unwrap();
        let now = scales(world, center);
        scale = (scale.0.max(now.0), scale.1.max(now.1));
        linear = linear.max((world.momentum() - start.0).norm());
        angular = angular.max((world.angular_momentum(center) - start.1).abs());
    }
    let part = |x: Real, of: Real| if x == 0.0 { 0.0 } else { x / of };
    (part(linear, scale.0), part(angular, scale.1))
}

proptest! {
    #![proptest_config(fewer(2))]

    /// Each impulse is given to one body and taken from the other along one line: rounding is all that is left, some ε
    /// for each of 240 substeps.
    #[test]
    fn no_joint_changes_momentum_or_angular_momentum(bodies in pairs(), tied in joints()) {
        // What is made apart and held hard is put where it belongs first.
        prop_assume!(!is_put(&tied));
        let (linear, angular) = changes(&mut joined(&bodies, &tied));
        prop_assert!(linear <= 1e-12, "momentum {:e}", linear);
        prop_assert!(angular <= 1e-12, "angular momentum {:e}", angular);
    }

    /// A gear's torques are τ·ratio and τ: the difference goes to the gearbox, so that only momentum stays.
    #[test]
    fn a_gear_keeps_momentum(bodies in pairs(), ratio in 0.2..4.0_f64) {
        let kind = JointKind::Gear { ratio, phase: None };
        let tied = Tied { kind, anchors: [bodies[0].place, bodies[1].place] };
        let (linear, _) = changes(&mut joined(&bodies, &tied));
        prop_assert!(linear <= 1e-12, "momentum {:e}", linear);
    }

    /// Two bodies that move as one: what holds them does no work, but for what a step of second order gets wrong in each of
    /// 240 substeps, (Ωh)³, and the energy stays to (Ωh)².
    #[test]
    fn reactions_do_no_work_on_rigid_motion(
        bodies in pairs(), tied in at_a_point(), velocity in vector(2.0), spin in -3.0..3.0_f64,
    ) {
        let rigid = |body: &Thrown| {
            Thrown { velocity: velocity + perp(body.place) * spin, spin, ..*body }
        };
        let free = Hold::Rigid;
        let kind = match tied.kind {
            // Motors and springs would move what is to move as one.
            JointKind::Revolute { .. } => JointKind::Revolute { angle: None, travel: Default::default() },
            JointKind::Prismatic { axis, .. } => JointKind::Prismatic { axis, angle: None, travel: Default::default() },
            _ => JointKind::Weld { angle: None, linear: free, angular: free },
        };
        if matches!(kind, JointKind::Prismatic { .. }) {
            // It would fly apart along the axis.
            return Ok(());
        }
        prop_assume!(velocity.norm() > 0.1);
        let pair = bodies.each_ref().map(rigid);
        let mut world = joined(&pair, &Tied { kind, ..tied });
        let start = world.energy().unwrap();
        world.steps(DT, 60).unwrap();
        let end = world.energy().unwrap();
        let turn = spin * H;
        let off = end.dissipated.abs() / start.kinetic;
        prop_assert!(off <= 240.0 * turn.abs().powi(3) + 1e-12, "work of the rows {:e}", off);
        let off = (end.balance() - start.balance()).abs() / start.kinetic;
        prop_assert!(off <= 1e-12, "balance {:e}", off);
        let off = (end.kinetic / start.kinetic - 1.0).abs();
        prop_assert!(off <= turn * turn + 1e-12, "energy {:e}", off);
    }

    /// Whatever a joint does is in the books. Undamped springs are not closed by them: what the step gets wrong shows.
    #[test]
    fn the_books_balance(bodies in pairs(), tied in joints()) {
        let mut world = joined(&bodies, &tied);
        let undamped = world.joints()[0].springs.iter().flatten().any(|s| s.damping == 0.0);
        prop_assume!(!undamped);
        let start = world.energy().unwrap();
        let mut scale = start.kinetic;
        for _ in 0..60 {
            world.step(DT).unwrap();
            let now = world.energy().unwrap();
            scale = scale.max(now.kinetic).max(now.work.abs()).max(now.dissipated.abs());
            let off = (now.balance() - start.balance()).abs() / scale;
            prop_assert!(off <= 1e-9, "{:e}", off);
        }
    }

    /// 0.1 % in ten seconds, whatever hangs on either end and wherever: an undamped spring between two bodies that tumble. A
    /// light body that is held off its centre swings faster than the spring's own frequency: leapfrog's energy is off by
    /// (ωh)²/4 at most, ω² = k(1/m + r²/I) of both.
    #[test]
    fn springs_keep_their_energy(bodies in pairs(), hertz in 0.3..1.5_f64, a in vector(0.2), b in vector(0.2)) {
        let hold = Hold::soft(hertz, 0.0);
        // Longer than it is drawn out: it must not get to its other end.
        let kind = JointKind::Distance { length: Some(1.6), hold, min: 0.0, max: None };
        let slow = |body: &Thrown| Thrown { velocity: body.velocity * 0.1, spin: 0.3 * body.spin, ..*body };
        let tied = Tied { kind, anchors: [bodies[0].place + a, bodies[1].place + b] };
        let mut world = joined(&bodies.each_ref().map(slow), &tied);
        let start = world.energy().unwrap().total();
        let stiffness = world.joints()[0].springs[0].unwrap().stiffness;
        let soft = |(mass, r): (&culbuto::body::Mass, Vec2)| {
            mass.inverse.x + r.norm_squared() * mass.inverse_inertia
        };
        let rates: Real = world.bodies().masses.iter().zip([a, b]).map(soft).sum();
        let most = 1e-3 + 0.25 * stiffness * rates * H * H;
        for _ in 0..600 {
            world.step(DT).unwrap();
            let off = (world.energy().unwrap().total() / start - 1.0).abs();
            prop_assert!(off <= most, "{:e} of {:e}", off, most);
        }
    }
}

/// The motion of a chain, and back: as the step is symmetric up to its error, what is missing falls with its square at
/// least.
#[test]
fn a_swinging_chain_runs_backwards() {
    let back = |parts: u32| {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        chain(&mut world, 3, vec2(0.0, 0.0));
        let start = world.bodies().poses.clone();
        let dt = DT / Real::from(parts);
        world.steps(dt, 40 * parts).unwrap();
        let gone = (world.bodies().poses[2].position - start[2].position).norm();
        assert!(gone > 1.0, "{gone}");
        for body in world.bodies().handles().to_vec() {
            let twist = world.body(body).unwrap().twist();
            let back = culbuto::math::Twist::new(-twist.linear, -twist.angular);
            world.body_mut(body).unwrap().set_twist(back).unwrap();
        }
        world.steps(dt, 40 * parts).unwrap();
        let off = |(a, b): (&culbuto::math::Pose, &culbuto::math::Pose)| {
            (a.position - b.position).norm() + (a.angle - b.angle).abs()
        };
        start.iter().zip(&world.bodies().poses).map(off).fold(0.0, Real::max)
    };
    let (coarse, fine) = (back(1), back(2));
    assert!(coarse <= 1e-3, "{coarse:e}");
    assert!(fine <= coarse / 3.5 || coarse <= 1e-10, "{coarse:e}, {fine:e}");
}
