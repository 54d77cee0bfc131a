//! What is not allowed is named, and changes nothing.

use super::{STEP, block, material};
use culbuto::World;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::soft::{Gas, Material, Mesh, Plane, Rope, SoftDef};

#[test]
fn numbers_out_of_range_are_named() {
    let fine = material(1e5, 0.1);
    let bad = [
        ("density", Material { density: 0.0, ..fine }),
        ("youngs_modulus", Material { youngs_modulus: Real::NAN, ..fine }),
        ("poissons_ratio", Material { poissons_ratio: 0.5, plane: Plane::Strain, ..fine }),
        ("poissons_ratio", Material { poissons_ratio: -1.0, ..fine }),
        ("damping_ratio", Material { damping_ratio: -0.1, ..fine }),
    ];
    let mut world = World::default();
    for (name, material) in bad {
        let error = world.add_soft_body(block(material)).unwrap_err().to_string();
        assert!(error.starts_with(name), "{error}");
    }
    let without = block(fine);
    let rope = Rope { stretch_stiffness: 1.0, bending_stiffness: 0.0 };
    assert!(world.add_soft_body(SoftDef { rope: Some(rope), ..without.clone() }).is_err());
    let gas = Gas { pressure: 1.0, outside: 0.0, exponent: 1.0 };
    assert!(world.add_soft_body(SoftDef { gas: Some(gas), ..without.clone() }).is_err());
    assert!(world.add_soft_body(SoftDef { pins: vec![1_000_000], ..without }).is_err());
    assert!(world.soft_bodies().is_empty());
}

#[test]
fn meshes_that_are_none_are_refused() {
    let square = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0)];
    assert!(Mesh::new(&square, &[[0, 1, 2], [0, 2, 3]]).is_ok());
    assert!(Mesh::new(&square, &[[0, 1, 2]]).is_err(), "a point in no triangle");
    assert!(Mesh::new(&square, &[[0, 1, 7], [0, 2, 3]]).is_err());
    assert!(Mesh::new(&[vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(2.0, 0.0)], &[[0, 1, 2]]).is_err());
    let crossing = [vec2(0.0, 0.0), vec2(1.0, 1.0), vec2(1.0, 0.0), vec2(0.0, 1.0)];
    assert!(Mesh::polygon(&crossing, &[], 0.2).is_err());
    assert!(Mesh::polygon(&square, &[], 1e-9).is_err());
    assert!(Mesh::rope(&square[..1], false).is_err());
}

#[test]
fn a_body_that_is_gone_is_an_error_and_runs_to_a_tolerance_are_refused() {
    let mut world = World::default();
    let body = world.add_soft_body(block(material(1e5, 0.1))).unwrap();
    assert!(world.set_soft_velocities(body, &[Vec2::zeros()]).is_err());
    assert!(world.advance(1.0, 1e-6).is_err());
    world.step(STEP).unwrap();
    world.remove_soft_body(body).unwrap();
    assert!(world.soft_body(body).is_err());
    assert!(world.remove_soft_body(body).is_err());
    world.step(STEP).unwrap();
}
