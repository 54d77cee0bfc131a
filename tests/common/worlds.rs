//! What the tests of motion share: bits of a world, fields of force, a reference integrator.
#![allow(dead_code)] // each test file uses its own part

use culbuto::World;
use culbuto::body::Filter;
use culbuto::forces::{BodyColumns, BoxError, FieldFacts, ForceField};
use culbuto::math::{Real, Vec2, Wrench, perp, sin_cos, vec2};

pub const EPS: Real = Real::EPSILON;

/// Of bodies that touch nothing, where a test is about free motion.
pub const APART: Filter = Filter { category: 1, mask: 0, group: 0 };

/// Positions, angles and velocities of all bodies and the time, to the bit.
pub fn bits(world: &World) -> Vec<u64> {
    let bodies = world.bodies();
    let poses = bodies.poses.iter().flat_map(|p| [p.position.x, p.position.y, p.angle]);
    let twists = bodies.twists.iter().flat_map(|v| [v.linear.x, v.linear.y, v.angular]);
    poses.chain(twists).chain([world.time()]).map(Real::to_bits).collect()
}

/// Everything a snapshot holds.
pub fn bytes(world: &World) -> Vec<u8> {
    world.snapshot().to_bytes().unwrap()
}

/// An empty world without gravity that steps with this method, one substep a step.
pub fn world_with(method: &str) -> World {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    world.set_method(method).unwrap();
    world.set_substeps(1).unwrap();
    world
}

/// The order that errors at steps h and h/2 speak of.
pub fn order(coarse: Real, fine: Real) -> Real {
    (coarse / fine).log2()
}

/// Springs between all pairs of bodies: F = −k(r − r₀).
pub struct Springs {
    pub stiffness: Real,
    pub length: Real,
}

impl ForceField for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        for i in 0..out.len() {
            for j in 0..i {
                let arm = bodies.poses[i].position - bodies.poses[j].position;
                let force = arm * (self.stiffness * (self.length / arm.norm() - 1.0));
                out[i].force += force;
                out[j].force -= force;
            }
        }
        Ok(())
    }

    fn potential(&self, _: Real, bodies: &BodyColumns<'_>) -> Result<Option<Real>, BoxError> {
        let mut sum = 0.0;
        for i in 0..bodies.poses.len() {
            for j in 0..i {
                let r = (bodies.poses[i].position - bodies.poses[j].position).norm();
                sum += 0.5 * self.stiffness * (r - self.length).powi(2);
            }
        }
        Ok(Some(sum))
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, conservative: true, internal: true }
    }
}

/// A torque that turns bodies back to angle 0: τ = −strength·sin θ.
pub struct Righting {
    pub strength: Real,
}

impl ForceField for Righting {
    fn name(&self) -> &'static str {
        "righting"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        for (pose, wrench) in bodies.poses.iter().zip(out) {
            wrench.torque -= self.strength * sin_cos(pose.angle).0;
        }
        Ok(())
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, ..FieldFacts::default() }
    }
}

/// The force of a magnetic field of strength a + b·x on unit charges: F = −B·perp(v). It does no work.
pub struct Lorentz {
    pub field: Real,
    pub gradient: Real,
}

impl ForceField for Lorentz {
    fn name(&self) -> &'static str {
        "magnetic"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        for ((pose, twist), wrench) in bodies.poses.iter().zip(bodies.twists).zip(out) {
            wrench.force -= (self.field + self.gradient * pose.position.x) * perp(twist.linear);
        }
        Ok(())
    }
}

/// A field that fails from a time on.
pub struct FailsAfter(pub Real);

impl ForceField for FailsAfter {
    fn name(&self) -> &'static str {
        "tired"
    }

    fn add_forces(
        &self,
        time: Real,
        _: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        out.iter_mut().for_each(|wrench| wrench.force += vec2(1.0, 2.0));
        if time > self.0 { Err("too tired".into()) } else { Ok(()) }
    }
}

/// y after a time t of y' = f(t, y), by n steps of Runge and Kutta's classic method. Its error falls
/// with n⁻⁴; callers compare n and 2n where they state a bound.
pub fn reference<const N: usize>(
    f: impl Fn(Real, &[Real; N]) -> [Real; N],
    mut y: [Real; N],
    t: Real,
    n: u32,
) -> [Real; N] {
    let h = t / Real::from(n);
    let along = |y: &[Real; N], k: &[Real; N], h: Real| -> [Real; N] {
        std::array::from_fn(|i| y[i] + h * k[i])
    };
    for step in 0..n {
        let t = h * Real::from(step);
        let k1 = f(t, &y);
        let k2 = f(t + h / 2.0, &along(&y, &k1, h / 2.0));
        let k3 = f(t + h / 2.0, &along(&y, &k2, h / 2.0));
        let k4 = f(t + h, &along(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    y
}

/// |a − b| over the larger of |b| and `scale`.
pub fn relative(a: Vec2, b: Vec2, scale: Real) -> Real {
    (a - b).norm() / b.norm().max(scale)
}

#[track_caller]
pub fn assert_below(what: &str, value: Real, bound: Real) {
    assert!(value <= bound, "{what}: {value:e} is above {bound:e}");
}
