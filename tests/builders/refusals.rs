//! What is not allowed is said, and leaves the world as it was.

use culbuto::builders::{BridgeDef, ChainDef, Elasticity, End, LatticeDef, RagdollDef, RopeDef};
use culbuto::builders::{RopeForm, VehicleDef};
use culbuto::joint::{Coefficients, Spring};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::{BodyDef, Error, Result, World};

use crate::earth;

const NAN: Real = Real::NAN;

fn refused<T>(named: &str, build: impl FnOnce(&mut World) -> Result<T>) {
    let mut world = earth();
    world.add_body(BodyDef::point(1.0)).unwrap();
    let before = world.snapshot().to_bytes().unwrap();
    let Err(error) = build(&mut world) else { panic!("{named} was not refused") };
    let message = error.to_string();
    assert!(message.contains(named), "{message} does not speak of {named}");
    assert_eq!(world.snapshot().to_bytes().unwrap(), before, "{named}");
}

fn ends() -> [End; 2] {
    [End::World(vec2(0.0, 0.0)), End::World(vec2(2.0, 0.0))]
}

#[test]
fn ropes_chains_and_bridges() {
    let rope = || RopeDef::new(ends());
    refused("length", |w| RopeDef { length: Some(1.9), ..rope() }.build(w));
    refused("length", |w| RopeDef { length: Some(2.0), ..rope() }.build(w));
    refused("length", |w| RopeDef { length: Some(NAN), ..rope() }.build(w));
    refused("links", |w| RopeDef { links: 0, ..rope() }.build(w));
    refused("links", |w| RopeDef { links: 1, length: Some(3.0), ..rope() }.build(w));
    refused("mass_per_length", |w| RopeDef { mass_per_length: 0.0, ..rope() }.build(w));
    refused("breaking_force", |w| RopeDef { breaking_force: Some(-1.0), ..rope() }.build(w));
    refused("radius", |w| {
        RopeDef { form: RopeForm::Links { radius: Some(0.0) }, ..rope() }.build(w)
    });
    let bending = Some(Coefficients { stiffness: -1.0, damping: 0.0 });
    refused("stiffness", |w| RopeDef { bending, ..rope() }.build(w));
    let bending = Some(Coefficients { stiffness: 1.0, damping: 0.0 });
    refused("bending", |w| RopeDef { bending, form: RopeForm::Points, ..rope() }.build(w));
    refused("end", |w| {
        RopeDef::new([End::Free(vec2(NAN, 0.0)), End::Free(vec2(1.0, 0.0))]).build(w)
    });
    refused("wire", |w| ChainDef { wire: Some(-0.1), ..ChainDef::new(ends()) }.build(w));
    refused("length", |w| ChainDef { length: Some(1.0), ..ChainDef::new(ends()) }.build(w));
    refused("box", |w| BridgeDef { thickness: Some(0.0), ..BridgeDef::new(ends()) }.build(w));
    refused("links", |w| BridgeDef { planks: 0, ..BridgeDef::new(ends()) }.build(w));
}

#[test]
fn figures() {
    let ragdoll = || RagdollDef::new(1.8, 70.0);
    refused("height", |w| RagdollDef { height: -1.0, ..ragdoll() }.build(w));
    refused("mass", |w| RagdollDef { mass: 0.0, ..ragdoll() }.build(w));
    refused("friction_torque", |w| RagdollDef { friction_torque: NAN, ..ragdoll() }.build(w));
    let spring = Some(Spring::new(-1.0, 0.5));
    refused("hertz", |w| RagdollDef { spring, ..ragdoll() }.build(w));
    refused("velocity", |w| RagdollDef { velocity: vec2(NAN, 0.0), ..ragdoll() }.build(w));
    let car = || VehicleDef::new(2.0, 100.0);
    refused("length", |w| VehicleDef::new(0.0, 100.0).build(w));
    refused("wheel_base", |w| VehicleDef { wheel_base: Some(0.2), ..car() }.build(w));
    refused("suspension_hertz", |w| VehicleDef { suspension_hertz: 0.0, ..car() }.build(w));
    refused("speed", |w| VehicleDef { speed: NAN, ..car() }.build(w));
    refused("max_torque", |w| VehicleDef { max_torque: Some(-1.0), ..car() }.build(w));
}

#[test]
fn lattices() {
    let outline: Vec<Vec2> = vec![vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0)];
    let lattice =
        |spacing: Real| LatticeDef::new(outline.clone(), spacing, Elasticity::Stiffness(10.0));
    refused("spacing", |w| lattice(0.0).build(w));
    refused("spacing", |w| lattice(3.0).build(w));
    refused("spacing", |w| lattice(1e-9).build(w));
    refused("stiffness", |w| {
        LatticeDef { elasticity: Elasticity::Stiffness(0.0), ..lattice(0.2) }.build(w)
    });
    refused("young", |w| {
        LatticeDef { elasticity: Elasticity::Young(NAN), ..lattice(0.2) }.build(w)
    });
    refused("damping_ratio", |w| LatticeDef { damping_ratio: -1.0, ..lattice(0.2) }.build(w));
    refused("radius", |w| LatticeDef { radius: Some(-1.0), ..lattice(0.2) }.build(w));
    let crossing = vec![vec2(0.0, 0.0), vec2(1.0, 1.0), vec2(1.0, 0.0), vec2(0.0, 1.0)];
    refused("", |w| LatticeDef { outline: crossing, ..lattice(0.2) }.build(w));
}

#[test]
fn bodies_that_are_gone() {
    let mut world = earth();
    let gone = world.add_body(BodyDef::point(1.0)).unwrap();
    world.remove_body(gone).unwrap();
    let before = world.snapshot().to_bytes().unwrap();
    let ends = [End::Body(gone, vec2(0.0, 0.0)), End::Free(vec2(1.0, 0.0))];
    assert!(matches!(RopeDef::new(ends).build(&mut world), Err(Error::StaleHandle(_))));
    assert_eq!(world.snapshot().to_bytes().unwrap(), before);
}
