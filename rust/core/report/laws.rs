//! Conservation laws on any scene, a user's own included.

use serde::Serialize;

use crate::body::{BodyHandle, BodyKind};
use crate::error::Result;
use crate::math::{Real, Vec2, vec2};
use crate::methods::Facts;
use crate::world::World;

/// A law, and how well it was kept.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Law {
    /// "energy", "momentum", "angular momentum", "third law".
    pub name: &'static str,
    /// Largest relative deviation; none where the law does not apply.
    pub measured: Option<Real>,
    /// Largest deviation allowed.
    pub allowed: Real,
    /// Why it does not apply, or what it was measured against.
    pub why: &'static str,
}

impl Law {
    /// Whether the law was kept, or does not apply.
    #[must_use]
    pub fn kept(&self) -> bool {
        self.measured.is_none_or(|measured| measured <= self.allowed)
    }
}

/// The laws of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Laws {
    /// Method of the run.
    pub method: &'static str,
    /// Its laws.
    pub laws: Vec<Law>,
    /// Whether all were kept.
    pub pass: bool,
}

/// Deviations that are allowed, relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of E − E₀ − work + dissipated, against the largest kinetic energy.
    pub energy: Real,
    /// Of momentum, against Σ m|v|.
    pub momentum: Real,
    /// Of angular momentum about the centre of mass, against Σ m|r||v| + I|ω|.
    pub angular_momentum: Real,
    /// Of the sum of internal forces, against the sum of their sizes.
    pub third_law: Real,
}

impl Default for Limits {
    fn default() -> Self {
        Self { energy: 1e-3, momentum: 1e-9, angular_momentum: 1e-9, third_law: 1e-12 }
    }
}

/// Which laws a world obeys by itself.
struct Applies {
    momentum: std::result::Result<(), &'static str>,
    angular: std::result::Result<(), &'static str>,
}

/// Runs a world by a method for a duration and measures its laws after every step.
///
/// # Errors
/// Those of the run.
pub fn verify_laws(
    world: &World,
    facts: &'static Facts,
    (dt, duration): (Real, Real),
    limits: Limits,
) -> Result<Laws> {
    let mut world = world.clone();
    world.set_method(facts.name)?;
    let steps = (duration / dt).round().max(1.0) as u32;
    let mut audit = Audit::start(&world)?;
    for _ in 0..steps {
        world.step(dt)?;
        audit.look(&world)?;
    }
    let laws = audit.laws(&world, limits);
    let pass = laws.iter().all(Law::kept);
    Ok(Laws { method: facts.name, laws, pass })
}

/// The conservation laws of a world from one moment on.
///
/// ```
/// # use culbuto::{World, math::vec2, report::{Audit, Limits}};
/// let mut world = World::new(vec2(0.0, -9.81))?;
/// let mut audit = Audit::start(&world)?;
/// world.steps(0.01, 100)?;
/// audit.look(&world)?;
/// assert!(audit.laws(&world, Limits::default()).iter().all(|law| law.kept()));
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Audit {
    start: Measured,
    worst: Deviations,
}

impl Audit {
    /// Begins with a world as it is.
    ///
    /// # Errors
    /// A field whose potential fails.
    pub fn start(world: &World) -> Result<Self> {
        Ok(Self { start: Measured::of(world)?, worst: Deviations::default() })
    }

    /// Looks at the world again: the largest deviations count.
    ///
    /// # Errors
    /// A field whose potential fails.
    pub fn look(&mut self, world: &World) -> Result<()> {
        self.worst.update(&self.start, &Measured::of(world)?, world);
        Ok(())
    }

    /// What was found, against limits; what holds for the world as it is decides which laws apply.
    #[must_use]
    pub fn laws(&self, world: &World, limits: Limits) -> Vec<Law> {
        judged(&self.worst, &applies(world), limits)
    }
}

fn judged(worst: &Deviations, applies: &Applies, limits: Limits) -> Vec<Law> {
    let Applies { momentum, angular } = *applies;
    let third = worst.third_law;
    let law = |name, measured, allowed, why| Law { name, measured, allowed, why };
    vec![
        law(
            "energy",
            Some(worst.energy),
            limits.energy,
            "E − E₀ − work + dissipated over the largest kinetic energy",
        ),
        law(
            "momentum",
            momentum.is_ok().then_some(worst.momentum),
            limits.momentum,
            momentum.err().unwrap_or("P − P₀ − (Mg + ΣF)t over Σ m|v|"),
        ),
        law(
            "angular momentum",
            angular.is_ok().then_some(worst.angular),
            limits.angular_momentum,
            angular.err().unwrap_or("about the centre of mass, over Σ m|r||v| + I|ω|"),
        ),
        law(
            "third law",
            third,
            limits.third_law,
            if third.is_some() {
                "sum of internal forces over the sum of their sizes"
            } else {
                "no internal field"
            },
        ),
    ]
}

/// What is measured at a moment.
#[derive(Clone, Debug)]
struct Measured {
    time: Real,
    balance: Real,
    kinetic: Real,
    momentum: Vec2,
    angular: Real,
    momentum_scale: Real,
    angular_scale: Real,
}

impl Measured {
    fn of(world: &World) -> Result<Self> {
        let energy = world.energy()?;
        let center = world.center_of_mass();
        let bodies = world.bodies();
        let (mut momentum_scale, mut angular_scale) = (0.0, 0.0);
        for ((pose, twist), mass) in bodies.poses.iter().zip(&bodies.twists).zip(&bodies.masses) {
            if mass.is_free() {
                let momentum = mass.mass * twist.linear.norm();
                momentum_scale += momentum;
                angular_scale +=
                    momentum * (pose.position - center).norm() + mass.inertia * twist.angular.abs();
            }
        }
        Ok(Self {
            time: world.time(),
            balance: energy.balance(),
            kinetic: energy.kinetic,
            momentum: world.momentum(),
            angular: world.angular_momentum(center),
            momentum_scale,
            angular_scale,
        })
    }
}

/// The largest deviations so far, and the scales they are measured against.
#[derive(Clone, Debug, Default)]
struct Deviations {
    energy: Real,
    momentum: Real,
    angular: Real,
    third_law: Option<Real>,
    kinetic: Real,
    momentum_scale: Real,
    angular_scale: Real,
}

impl Deviations {
    fn update(&mut self, start: &Measured, now: &Measured, world: &World) {
        self.kinetic = self.kinetic.max(start.kinetic).max(now.kinetic);
        self.momentum_scale = self.momentum_scale.max(start.momentum_scale).max(now.momentum_scale);
        self.angular_scale = self.angular_scale.max(start.angular_scale).max(now.angular_scale);
        let ratio = |x: Real, of: Real| if x == 0.0 { 0.0 } else { x / of };
        let given = constant_force(world) * (now.time - start.time);
        let momentum = (now.momentum - start.momentum - given).norm();
        self.energy = self.energy.max(ratio((now.balance - start.balance).abs(), self.kinetic));
        self.momentum = self.momentum.max(ratio(momentum, self.momentum_scale));
        let angular = (now.angular - start.angular).abs();
        self.angular = self.angular.max(ratio(angular, self.angular_scale));
        if let Ok(Some(residual)) = world.third_law_residual() {
            self.third_law = Some(residual.max(self.third_law.unwrap_or(0.0)));
        }
    }
}

/// Whether a joint ties to the world, or to a body that is not dynamic.
fn held(world: &World) -> bool {
    let bodies = world.bodies();
    let gives_way = |body: &Option<BodyHandle>| {
        body.is_some_and(|b| bodies.index(b).is_ok_and(|i| bodies.is(i, BodyKind::Dynamic)))
    };
    world.joints().iter().any(|joint| !joint.def.bodies.iter().all(gives_way))
}

/// Whether bodies can meet, and one of them is not dynamic.
fn backed(world: &World) -> bool {
    let bodies = world.bodies();
    let fixed =
        |i: usize| !bodies.is(i, BodyKind::Dynamic) && !bodies.infos[i].def.shapes.is_empty();
    world.stages().contains(&"detect") && (0..bodies.len()).any(fixed)
}

/// Σ mg + F over the dynamic bodies (N).
fn constant_force(world: &World) -> Vec2 {
    let bodies = world.bodies();
    let gravity = world.settings().gravity;
    let of_body = |i: usize| {
        let mass = &bodies.masses[i];
        gravity.component_mul(&mass.gravity_scale) * mass.mass + bodies.forces[i].force
    };
    let dynamic = (0..bodies.len()).filter(|&i| bodies.is(i, BodyKind::Dynamic));
    dynamic.map(of_body).fold(vec2(0.0, 0.0), |sum, force| sum + force)
}

fn applies(world: &World) -> Applies {
    let bodies = world.bodies();
    let dynamic = || (0..bodies.len()).filter(|&i| bodies.is(i, BodyKind::Dynamic));
    let def = |i: usize| &bodies.infos[i].def;
    let in_air =
        world.settings().air.density > 0.0 && dynamic().any(|i| def(i).drag_coefficient > 0.0);
    let momentum = if world.fields().iter().any(|field| !field.facts().internal) {
        Err("an outside field acts")
    } else if in_air || dynamic().any(|i| def(i).linear_damping > 0.0) {
        Err("the air takes momentum")
    } else if dynamic().any(|i| def(i).locks.x || def(i).locks.y) {
        Err("a locked axis gives momentum")
    } else if !world.schedules().is_empty() {
        Err("a scheduled force acts")
    } else if held(world) {
        Err("a joint holds to what does not give way")
    } else if backed(world) {
        Err("bodies can meet one that does not give way")
    } else {
        Ok(())
    };
    let scale = |i: usize| bodies.masses[i].gravity_scale;
    let uneven = dynamic().zip(dynamic().skip(1)).any(|(i, j)| scale(i) != scale(j));
    let angular =
        momentum.and(if dynamic().any(|i| bodies.forces[i] != crate::math::Wrench::ZERO) {
            Err("a constant force or torque acts")
        } else if dynamic().any(|i| def(i).angular_damping > 0.0 || def(i).locks.rotation) {
            Err("a rotation is damped or locked")
        } else if uneven {
            Err("gravity acts unevenly")
        } else {
            Ok(())
        });
    Applies { momentum, angular }
}
