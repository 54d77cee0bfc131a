//! Lattices of springs are the elastic sheets that they say they are.

use culbuto::builders::{Elasticity, Lattice, LatticeDef, Pattern};
use culbuto::math::{PI, Real, Twist, Vec2, sin_cos, vec2};
use culbuto::{BodyKind, World};

use crate::{DT, assert_close, earth, with_ground};

const ALL: [Pattern; 3] = [Pattern::Triangular, Pattern::Square, Pattern::BracedSquare];

fn space() -> World {
    World::new(vec2(0.0, 0.0)).unwrap()
}

fn rectangle(width: Real, height: Real) -> Vec<Vec2> {
    vec![vec2(0.0, 0.0), vec2(width, 0.0), vec2(width, height), vec2(0.0, height)]
}

/// Energy per area of the lattice if every point goes where a strain takes it.
fn energy(world: &World, lattice: &Lattice, strain: impl Fn(Vec2) -> Vec2) -> Real {
    let mut world = world.clone();
    for body in &lattice.parts.bodies {
        let from = world.body(*body).unwrap().position();
        world.body_mut(*body).unwrap().set_position(from + strain(from)).unwrap();
    }
    world.spring_energy() / lattice.area
}

/// ½Eε² where the sheet may narrow by νε, more where it may not, and ½Gγ² in shear: for any lattice, however small, since its
/// border springs have half the stiffness. Strains of 1e-6 leave a part of that order beyond the quadratic law.
#[test]
fn a_strained_lattice_stores_what_an_elastic_sheet_does() {
    let small = 1e-6;
    for pattern in ALL {
        let mut world = space();
        let given = Elasticity::Stiffness(50.0);
        let def = LatticeDef { pattern, ..LatticeDef::new(rectangle(4.0, 4.0), 0.7, given) };
        let lattice = def.build(&mut world).unwrap();
        let moduli = lattice.moduli;
        let stretched = |narrowing: Real| {
            energy(&world, &lattice, |p| vec2(p.x * small, -narrowing * p.y * small))
        };
        let young = 0.5 * moduli.young * small * small;
        assert_close(stretched(moduli.poisson), young, 1e-5);
        assert!(stretched(moduli.poisson + 0.1) > young && stretched(moduli.poisson - 0.1) > young);
        let sheared = energy(&world, &lattice, |p| vec2(p.y * small, 0.0));
        let shear = 0.5 * moduli.shear * small * small;
        assert!((sheared - shear).abs() <= 1e-5 * young, "{pattern:?}: {sheared} {shear}");
    }
}

#[test]
fn moduli_are_those_of_the_literature() {
    let triangular = Pattern::Triangular.moduli(3.0);
    assert_close(triangular.young, 2.0 * 3.0 / 3.0_f64.sqrt(), 1e-15);
    assert_close(triangular.shear, 3.0_f64.sqrt() / 4.0 * 3.0, 1e-15);
    for pattern in [Pattern::Triangular, Pattern::BracedSquare] {
        let isotropic = pattern.moduli(3.0);
        assert_close(isotropic.shear, isotropic.young / 2.0 / (1.0 + isotropic.poisson), 1e-15);
    }
    for pattern in ALL {
        let by = |elasticity| {
            let outline = rectangle(1.0, 1.0);
            LatticeDef { pattern, ..LatticeDef::new(outline, 0.2, elasticity) }.moduli().unwrap()
        };
        let young = by(Elasticity::Stiffness(7.0)).young;
        assert_close(by(Elasticity::Young(young)).stiffness, 7.0, 1e-15);
    }
}

/// A strip held on the left and pulled on the right by F, at rest: between two cross sections an end away from either it is
/// stretched by F/(EH). What the ends do decays like e^(−πx/H) or faster: 1e-3 after twice the height.
#[test]
fn a_strip_stretches_by_its_modulus() {
    let (spacing, rows, columns) = (0.25, 4_u32, 32_u32);
    let row = 0.75_f64.sqrt() * spacing;
    let (width, height) = (spacing * Real::from(columns), row * Real::from(rows));
    let mut world = space();
    let outline = rectangle(width, height);
    let def = LatticeDef::new(outline, spacing, Elasticity::Young(1000.0));
    let def = LatticeDef { damping_ratio: 4.0, radius: Some(0.0), ..def };
    let strip = def.build(&mut world).unwrap();
    let place = |world: &World, k: usize| world.body(strip.parts.bodies[k]).unwrap().position();
    let count = strip.parts.bodies.len();
    let at: Vec<Vec2> = (0..count).map(|k| place(&world, k)).collect();
    let area = height * (width - 0.5 * spacing);
    assert_close(strip.area, area, 1e-12);
    let pulled: Vec<usize> = (0..count).filter(|k| at[*k].x > width - 0.6 * spacing).collect();
    let force = 1e-3 * 1000.0 * height;
    for (k, p) in at.iter().enumerate() {
        let mut body = world.body_mut(strip.parts.bodies[k]).unwrap();
        if p.x < 0.6 * spacing {
            body.set_kind(BodyKind::Static).unwrap();
        } else if pulled.contains(&k) {
            let share = vec2(force / pulled.len() as Real, 0.0);
            body.set_force(culbuto::math::Wrench::new(share, 0.0)).unwrap();
        }
    }
    // Long steps: springs are implicit, and only the rest counts.
    world.steps(1.0, 400).unwrap();
    let slow = (0..count).map(|k| world.body(strip.parts.bodies[k]).unwrap().velocity().norm());
    assert!(slow.fold(0.0, Real::max) < 1e-9);
    let section = |x: Real| -> Real {
        let there: Vec<usize> = (0..count).filter(|k| (at[*k].x - x).abs() < 1e-9).collect();
        let moved: Real = there.iter().map(|k| place(&world, *k).x - at[*k].x).sum();
        moved / there.len() as Real
    };
    let (left, right) = (8.0 * spacing, 24.0 * spacing);
    let strain = (section(right) - section(left)) / (right - left);
    // Strains of 1e-3 leave about as much beyond Hooke's law.
    assert_close(strain, force / (strip.moduli.young * height), 3e-3);
}

/// The mass is that of the cells, and cells fill a disk up to a border of one spacing.
#[test]
fn any_outline_is_filled() {
    let spacing = 0.05;
    let corner = |k: u32| {
        let (sin, cos) = sin_cos(2.0 * PI * Real::from(k) / 200.0);
        vec2(cos, sin)
    };
    let disk: Vec<Vec2> = (0..200).map(corner).collect();
    let hole = vec![vec![vec2(-0.4, -0.2), vec2(-0.4, 0.3), vec2(0.4, 0.3), vec2(0.4, -0.2)]];
    for pattern in ALL {
        let mut world = space();
        let given = Elasticity::Stiffness(1.0);
        let def = LatticeDef::new(disk.clone(), spacing, given);
        let def = LatticeDef { pattern, holes: hole.clone(), mass_per_area: 3.0, ..def };
        let lattice = def.build(&mut world).unwrap();
        assert_close(lattice.parts.mass(&world).unwrap(), 3.0 * lattice.area, 1e-12);
        let (whole, border) = (PI - 0.8 * 0.5, 2.0 * PI + 2.6);
        assert!(lattice.area < whole && lattice.area > whole - spacing * border);
        for body in &lattice.parts.bodies {
            let p = world.body(*body).unwrap().position();
            assert!(p.norm() <= 1.0 && !(p.x.abs() < 0.399 && p.y > -0.199 && p.y < 0.299));
        }
    }
}

/// A disk of springs that is thrown and turns keeps its momenta, and shakes with the energy it was given.
#[test]
fn a_free_lattice_keeps_momentum_and_energy() {
    let mut world = space();
    let def = LatticeDef::new(rectangle(1.0, 1.0), 0.25, Elasticity::Young(100.0));
    let lattice = LatticeDef { damping_ratio: 0.0, ..def }.build(&mut world).unwrap();
    let middle = lattice.parts.center_of_mass(&world).unwrap();
    for body in &lattice.parts.bodies {
        let mut body = world.body_mut(*body).unwrap();
        let arm = body.get().position() - middle;
        let twist = Twist::new(vec2(1.0 - 0.5 * arm.y, 0.5 * arm.x), 0.0);
        body.set_twist(twist).unwrap();
    }
    let before = [world.momentum().x, world.momentum().y, world.angular_momentum(middle)];
    let energy = world.energy().unwrap().total();
    world.steps(DT, 240).unwrap();
    let about = middle + vec2(4.0, 0.0);
    let after = [world.momentum().x, world.momentum().y, world.angular_momentum(about)];
    for (a, b) in after.iter().zip(before) {
        assert!((a - b).abs() < 1e-10, "{after:?}, not {before:?}");
    }
    assert_close(world.energy().unwrap().total(), energy, 1e-3);
}

#[test]
fn a_soft_block_bounces_on_the_ground_and_stays_whole() {
    let mut world = earth();
    with_ground(&mut world);
    let mut outline = rectangle(1.0, 1.0);
    outline.iter_mut().for_each(|p| p.y += 0.5);
    let def = LatticeDef::new(outline, 0.25, Elasticity::Young(400.0));
    let block = LatticeDef { damping_ratio: 0.1, ..def }.build(&mut world).unwrap();
    let before = world.energy().unwrap().balance();
    world.steps(DT, 180).unwrap();
    let energy = world.energy().unwrap();
    assert!((energy.balance() - before).abs() < 1e-2 * before, "{energy:?}");
    let middle = block.parts.center_of_mass(&world).unwrap();
    assert!(middle.y > 0.4 && middle.y < 0.65, "its middle is at {middle:?}");
}
