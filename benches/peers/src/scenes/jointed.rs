//! Scenes of joints.

use std::f64::consts::PI;

use culbuto::body::BodyKind;
use culbuto::math::{Real, Vec2, vec2};

use super::{floor, real, scene};
use crate::scene::{Body, Joint, Region, Scene, Shape, Spring};

fn hinge(bodies: [usize; 2], anchors: [Vec2; 2]) -> Joint {
    Joint { bodies, anchors, distance: None, limits: None, spring: None }
}

/// Bars in a row from a hinge at the origin, a metre each, and at the end what hangs on it.
fn row(count: u32, end: Option<Body>) -> (Vec<Body>, Vec<Joint>) {
    let bar = |k| Body {
        group: 1,
        ..Body::new(vec2(real(k) + 0.5, 0.0), vec![Shape::rectangle(0.5, 0.1)])
    };
    let mut bodies = vec![Body::ground(vec![])];
    bodies.extend((0..count).map(bar));
    let mut joints = vec![hinge([0, 1], [vec2(0.0, 0.0), vec2(-0.5, 0.0)])];
    let ends = [vec2(0.5, 0.0), vec2(-0.5, 0.0)];
    joints.extend((1..count as usize).map(|k| hinge([k, k + 1], ends)));
    if let Some(end) = end {
        let last = bodies.len() - 1;
        joints.push(hinge([last, last + 1], [ends[0], vec2(0.0, 0.0)]));
        bodies.push(end);
    }
    (bodies, joints)
}

pub fn chain() -> Scene {
    let (bodies, joints) = row(100, None);
    let (sleeping, region) = (false, Region::Everywhere);
    let about = "100 bars hinged end to end, let go level";
    Scene { joints, sleeping, region, ..scene("chain_100", about, bodies) }
}

/// Bars with a disk at the end that is so many times as heavy as one of them, let go level.
pub fn weighted(bars: u32, times: Real) -> Scene {
    // A bar weighs 0.2 kg.
    let density = times * 0.2 / (PI * 0.25);
    let end =
        Body { density, group: 1, ..Body::new(vec2(real(bars), 0.0), vec![Shape::disk(0.5)]) };
    let (bodies, joints) = row(bars, Some(end));
    let (sleeping, region) = (false, Region::Everywhere);
    let about = "20 bars hinged end to end with a disk of 1000 times their mass, let go level";
    Scene { joints, sleeping, region, ..scene("chain, 1000 at its end", about, bodies) }
}

pub fn rope() -> Scene {
    let about =
        "30 bars hinged end to end with a disk of 100 times their mass at the end, let go level";
    Scene { name: "rope_30", about, ..weighted(30, 100.0) }
}

pub fn joint_grid() -> Scene {
    let n = 100;
    let mut bodies: Vec<Body> = Vec::new();
    let mut joints = Vec::new();
    for column in 0..n {
        for row in 0..n {
            let held = row == 0 && column + 3 >= n / 2 && column <= n / 2 + 3;
            let kind = if held { BodyKind::Static } else { BodyKind::Dynamic };
            let place = vec2(real(column), -real(row));
            bodies.push(Body { kind, group: 1, ..Body::new(place, vec![Shape::disk(0.4)]) });
            let number = bodies.len() - 1;
            if row > 0 {
                joints.push(hinge([number - 1, number], [vec2(0.0, -0.5), vec2(0.0, 0.5)]));
            }
            if column > 0 {
                let left = number - n as usize;
                joints.push(hinge([left, number], [vec2(0.5, 0.0), vec2(-0.5, 0.0)]));
            }
        }
    }
    // What is static needs no hinge.
    joints.retain(|joint: &Joint| {
        joint.bodies.iter().any(|body| bodies[*body].kind == BodyKind::Dynamic)
    });
    let about = "100 × 100 disks hinged to their neighbours, hung up by seven of them";
    let (sleeping, region) = (false, Region::Everywhere);
    Scene { joints, sleeping, region, ..scene("joint_grid", about, bodies) }
}

/// A bone: what it hangs on and at which height, its lower and upper end, half its width, limits of its angle.
type Bone = (Option<(usize, Real)>, [Real; 2], Real, [Real; 2]);

/// For a figure 1.8 m tall.
const BONES: [Bone; 11] = [
    (None, [0.9, 1.1], 0.11, [0.0, 0.0]),
    (Some((0, 1.1)), [1.1, 1.5], 0.13, [-1.2, 0.4]),
    (Some((1, 1.5)), [1.5, 1.8], 0.1, [-0.8, 0.8]),
    (Some((1, 1.45)), [1.1, 1.45], 0.045, [-0.9, 3.0]),
    (Some((3, 1.1)), [0.7, 1.1], 0.04, [0.0, 2.5]),
    (Some((1, 1.45)), [1.1, 1.45], 0.045, [-0.9, 3.0]),
    (Some((5, 1.1)), [0.7, 1.1], 0.04, [0.0, 2.5]),
    (Some((0, 0.95)), [0.5, 0.95], 0.07, [-0.4, 2.0]),
    (Some((7, 0.5)), [0.0, 0.5], 0.055, [-2.4, 0.0]),
    (Some((0, 0.95)), [0.5, 0.95], 0.07, [-0.4, 2.0]),
    (Some((9, 0.5)), [0.0, 0.5], 0.055, [-2.4, 0.0]),
];

/// Adds a figure of eleven boxes, its soles at a place; its hinges have limits and springs of 5 Hz, damping ratio ½.
fn ragdoll(feet: Vec2, group: u8, bodies: &mut Vec<Body>, joints: &mut Vec<Joint>) {
    let first = bodies.len();
    let middle = |bone: &Bone| 0.5 * (bone.1[0] + bone.1[1]);
    for bone in &BONES {
        let (_, [low, high], half, _) = bone;
        let shape = Shape::rectangle(*half, 0.5 * (high - low));
        bodies.push(Body { group, ..Body::new(feet + vec2(0.0, middle(bone)), vec![shape]) });
    }
    for (k, bone) in BONES.iter().enumerate() {
        let Some((parent, height)) = bone.0 else { continue };
        let pair = [first + parent, first + k];
        let at = |bone: &Bone| vec2(0.0, height - middle(bone));
        let effective = 1.0 / (1.0 / inertia(&BONES[parent]) + 1.0 / inertia(bone));
        let (hertz, damping_ratio) = (5.0, 0.5);
        let omega = 2.0 * PI * hertz;
        let stiffness = effective * omega * omega;
        let damping = 2.0 * effective * damping_ratio * omega;
        let spring = Some(Spring { hertz, damping_ratio, stiffness, damping });
        let anchors = [at(&BONES[parent]), at(bone)];
        joints.push(Joint { limits: Some(bone.3), spring, ..hinge(pair, anchors) });
    }
}

/// m(a² + b²)/3 of a box of half width a and half height b, at a density of 1.
fn inertia((_, [low, high], a, _): &Bone) -> Real {
    let b = 0.5 * (high - low);
    4.0 * a * b * (a * a + b * b) / 3.0
}

pub fn ragdolls() -> Scene {
    let mut ground = floor(6.0);
    let wall = |x| Shape::Box { center: vec2(x, 20.0), half: vec2(1.0, 21.0) };
    ground.shapes.extend([wall(-6.0), wall(6.0)]);
    let (mut bodies, mut joints) = (vec![ground], Vec::new());
    for k in 0..25_u8 {
        let (column, line) = (Real::from(k % 5), Real::from(k / 5));
        let feet = vec2(1.8 * (column - 2.0) + 0.2 * (line % 2.0), 1.0 + 2.2 * line);
        ragdoll(feet, k + 1, &mut bodies, &mut joints);
    }
    let about = "25 ragdolls of eleven bones falling into a bin";
    Scene { joints, sleeping: false, ..scene("ragdolls_25", about, bodies) }
}
