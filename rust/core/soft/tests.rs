//! A body by itself, without a world: the method of a substep.

use super::*;
use crate::constraints::Matter;
use crate::forces::Ledger;
use crate::math::{Real, Vec2, vec2};

fn steps(body: &mut SoftBody, h: Real, count: usize) -> Ledger {
    let mut ledger = Ledger::default();
    for _ in 0..count {
        body.accelerate(Vec2::zeros());
        body.begin(h);
        body.settle();
        ledger += body.finish();
    }
    ledger
}

fn block(stiff: Real, spin: Real) -> SoftBody {
    let mesh = Mesh::rectangle(1.0, 0.5, [4, 2]).unwrap();
    let material = Material { youngs_modulus: stiff, ..Material::default() };
    let def = SoftDef::new(mesh, material);
    SoftBody::new(SoftDef { velocity: vec2(1.0, 2.0), angular_velocity: spin, ..def }).unwrap()
}

/// Moves each node by some pseudo-random way.
fn shake(body: &mut SoftBody, by: Real) {
    let mut state: u64 = 0x2545_f491_4f6c_dd1d;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((state >> 33) as Real / (1_u64 << 31) as Real - 0.5) * by
    };
    let places: Vec<Vec2> = body.positions().iter().map(|p| p + vec2(next(), next())).collect();
    body.set_positions(&places).unwrap();
}

fn energy(body: &SoftBody) -> Real {
    body.kinetic_energy() + body.strain_energy()
}

#[test]
fn an_undamped_body_that_a_step_can_follow_keeps_its_energy() {
    for (stiff, by) in [(1e4, 0.01), (1e6, 0.01)] {
        let mut body = block(stiff, 3.0);
        shake(&mut body, by);
        let (e, p) = (energy(&body), body.momentum());
        let l = body.angular_momentum(Vec2::zeros());
        let ledger = steps(&mut body, 1e-3, 1000);
        assert_eq!(ledger.dissipated, 0.0);
        assert!((energy(&body) - e).abs() < 1e-10 * e);
        assert!((body.momentum() - p).norm() < 1e-13 * p.norm());
        assert!((body.angular_momentum(Vec2::zeros()) - l).abs() < 1e-10 * l.abs());
    }
}

#[test]
fn what_a_step_cannot_follow_only_loses_energy_and_keeps_momentum() {
    for (stiff, by, spin) in [(1e5, 2.0, 3.0), (1e11, 0.01, 3.0), (1e8, 0.0, 1e2), (1e11, 0.0, 1e4)]
    {
        let mut body = block(stiff, spin);
        shake(&mut body, by);
        let (e, l) = (energy(&body), body.angular_momentum(Vec2::zeros()));
        let ledger = steps(&mut body, 1.0 / 240.0, 500);
        assert!(energy(&body) <= e * (1.0 + 1e-10), "E = {stiff:e}, {by} m, {spin} rad/s");
        let off = energy(&body) + ledger.dissipated - e;
        assert!(off.abs() < 1e-9 * e, "E = {stiff:e}, {by} m, {spin} rad/s: {off:e} J of {e:e}");
        assert!((body.angular_momentum(Vec2::zeros()) - l).abs() < 1e-8 * l.abs());
    }
}

#[test]
fn what_yields_stays_bent_and_loses_energy() {
    let mesh = Mesh::rectangle(1.0, 0.1, [20, 2]).unwrap();
    let pins = mesh.nodes_where(|p| p.x < -0.4999);
    let base = Material { damping_ratio: 1.0, damping_frequency: 0.5, ..Material::default() };
    let bent = |yield_strain| {
        let material = Material { yield_strain, ..base };
        let def = SoftDef { pins: pins.clone(), ..SoftDef::new(mesh.clone(), material) };
        let mut body = SoftBody::new(def).unwrap();
        let mut forces = vec![Vec2::zeros(); body.positions().len()];
        let end = mesh.nodes_where(|p| p.x > 0.4999)[2] as usize;
        forces[end].y = -300.0;
        body.set_forces(&forces).unwrap();
        steps(&mut body, 0.01, 500);
        body.set_forces(&vec![Vec2::zeros(); forces.len()]).unwrap();
        let ledger = steps(&mut body, 0.01, 1000);
        assert!(ledger.dissipated >= 0.0);
        body.positions()[end].y - mesh.rest()[end].y
    };
    assert!(bent(None).abs() < 1e-3);
    assert!(bent(Some(0.02)) < -0.05);
}
