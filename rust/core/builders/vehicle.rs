//! Vehicles.

use super::plan::Plan;
use crate::body::{BodyDef, BodyHandle};
use crate::error::{Error, Result, check};
use crate::joint::{Coefficients, Given, Hold, JointDef, JointHandle, JointKind, Motor, Spring};
use crate::math::{PI, Pose, Real, Vec2, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// A chassis on two wheels with suspension; the front is on the right.
///
/// It is built in the balance of its springs on level ground, so that it does not drop when the world starts.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleDef {
    /// Bodies are called "`name` chassis", "`name` rear wheel" and "`name` front wheel", joints "`name` rear axle" and so on.
    pub name: String,
    /// The point of the ground midway between its wheels (m).
    pub position: Vec2,
    /// Angle of the ground (rad).
    pub angle: Real,
    /// Velocity with which it starts, wheels not turning (m/s).
    pub velocity: Vec2,
    /// Length of the chassis (m).
    pub length: Real,
    /// Height of the chassis (m); none: a quarter of its length.
    pub height: Option<Real>,
    /// Mass of the chassis (kg).
    pub mass: Real,
    /// Distance of the axles (m); none: 0.6 of the length.
    pub wheel_base: Option<Real>,
    /// Radius of the wheels (m); none: an eighth of the length.
    pub wheel_radius: Option<Real>,
    /// Mass of a wheel (kg); none: a twentieth of the chassis.
    pub wheel_mass: Option<Real>,
    /// Frequency (Hz) at which the chassis bounces on its springs.
    pub suspension_hertz: Real,
    /// Damping ratio of that.
    pub suspension_damping: Real,
    /// How far a wheel can go up and down from where it rests (m); none: half its radius.
    pub suspension_travel: Option<Real>,
    /// Speed that the motor drives at, to the right (m/s).
    pub speed: Real,
    /// Largest torque on a driven wheel (N·m); none: an eighth of the vehicle's weight times the wheel's radius.
    pub max_torque: Option<Real>,
    /// Whether the rear wheel is driven, and the front wheel.
    pub driven: [bool; 2],
    /// Surface, filter, damping and the like of chassis and wheels. Place, shape and mass come from the vehicle.
    pub body: BodyDef,
}

/// A vehicle in a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vehicle {
    /// Its chassis.
    pub chassis: BodyHandle,
    /// Rear and front wheel.
    pub wheels: [BodyHandle; 2],
    /// Wheel joints from the chassis to the rear and the front wheel.
    pub axles: [JointHandle; 2],
    /// Radius of the wheels (m).
    pub wheel_radius: Real,
}

/// The default's lengths and masses, filled in.
struct Sizes {
    height: Real,
    base: Real,
    radius: Real,
    wheel: Real,
    travel: Real,
    torque: Real,
    /// How far the weight presses the springs in (m).
    sag: Real,
}

impl VehicleDef {
    /// A chassis of this length (m) and mass (kg), standing still with its motor at rest.
    #[must_use]
    pub fn new(length: Real, mass: Real) -> Self {
        Self {
            name: "vehicle".into(),
            position: vec2(0.0, 0.0),
            angle: 0.0,
            velocity: vec2(0.0, 0.0),
            length,
            height: None,
            mass,
            wheel_base: None,
            wheel_radius: None,
            wheel_mass: None,
            suspension_hertz: 2.0,
            suspension_damping: 0.7,
            suspension_travel: None,
            speed: 0.0,
            max_torque: None,
            driven: [true, false],
            body: BodyDef::default(),
        }
    }

    /// Adds the vehicle.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not allowed. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Vehicle> {
        let sizes = self.sizes(world)?;
        let ground = Pose::new(self.position, self.angle);
        let wheel_shape = Shape::circle(sizes.radius)?;
        let body = |part: &str, place: Vec2, shape: Shape, mass: Real| BodyDef {
            name: Some(format!("{} {part}", self.name)),
            position: ground.apply(place),
            angle: self.angle,
            velocity: self.velocity,
            shapes: vec![shape.into()],
            mass: Some(mass),
            ..self.body.clone()
        };
        let mut plan = Plan::default();
        let up = sizes.radius + 0.5 * sizes.height;
        let shape = Shape::rectangle(self.length, sizes.height)?;
        let chassis = plan.body(body("chassis", vec2(0.0, up), shape, self.mass));
        for (k, (which, side)) in [("rear", -0.5), ("front", 0.5)].into_iter().enumerate() {
            let x = side * sizes.base;
            let part = format!("{which} wheel");
            let wheel = body(&part, vec2(x, sizes.radius), wheel_shape.clone(), sizes.wheel);
            let wheel = plan.body(wheel);
            let motor = self.driven[k]
                .then(|| Motor { speed: -self.speed / sizes.radius, max: Some(sizes.torque) });
            let axle = JointDef {
                name: Some(format!("{} {which} axle", self.name)),
                anchors: [vec2(x, -0.5 * sizes.height - sizes.sag), vec2(0.0, 0.0)]
                    .map(Given::Local),
                ..JointDef::new(None, None, self.axle(&sizes, motor))
            };
            plan.joint([chassis, wheel], axle);
        }
        let added = plan.add(world)?;
        let (bodies, joints) = (added.bodies, added.joints);
        Ok(Vehicle {
            chassis: bodies[0],
            wheels: [bodies[1], bodies[2]],
            axles: [joints[0], joints[1]],
            wheel_radius: sizes.radius,
        })
    }

    /// The wheel joint: half the chassis on a spring k = (m/2)ω².
    fn axle(&self, sizes: &Sizes, motor: Option<Motor>) -> JointKind {
        let omega = 2.0 * PI * self.suspension_hertz;
        let half = 0.5 * self.mass;
        let spring = Spring::Constants(Coefficients {
            stiffness: half * omega * omega,
            damping: 2.0 * half * self.suspension_damping * omega,
        });
        JointKind::Wheel {
            axis: Given::Local(vec2(0.0, 1.0)),
            suspension: Hold::Spring(spring),
            limits: Some([sizes.sag - sizes.travel, sizes.sag + sizes.travel]),
            motor,
        }
    }

    fn sizes(&self, world: &World) -> Result<Sizes> {
        let length = check::positive("length", self.length)?;
        let mass = check::positive("mass", self.mass)?;
        let or = |what: &str, given: Option<Real>, usual: Real| {
            check::positive(what, given.unwrap_or(usual))
        };
        check::finite_vec("position", self.position)?;
        check::finite("angle", self.angle)?;
        check::finite("speed", self.speed)?;
        let omega = 2.0 * PI * check::positive("suspension_hertz", self.suspension_hertz)?;
        check::not_negative("suspension_damping", self.suspension_damping)?;
        let radius = or("wheel_radius", self.wheel_radius, length / 8.0)?;
        let wheel = or("wheel_mass", self.wheel_mass, mass / 20.0)?;
        let gravity = world.settings().gravity;
        let weight = (mass + 2.0 * wheel) * gravity.norm();
        let up = Pose::new(vec2(0.0, 0.0), self.angle).apply(vec2(0.0, 1.0));
        let torque = self.max_torque.unwrap_or(0.125 * weight * radius);
        let sizes = Sizes {
            height: or("height", self.height, length / 4.0)?,
            base: or("wheel_base", self.wheel_base, 0.6 * length)?,
            radius,
            wheel,
            travel: or("suspension_travel", self.suspension_travel, 0.5 * radius)?,
            torque: check::not_negative("max_torque", torque)?,
            sag: -self.body.gravity_scale * gravity.dot(&up) / (omega * omega),
        };
        if sizes.base <= 2.0 * radius {
            let allowed = format!("above {}, or the wheels overlap", 2.0 * radius);
            return Err(Error::invalid("wheel_base", sizes.base, allowed));
        }
        Ok(sizes)
    }
}

impl Vehicle {
    /// Drives at another speed to the right (m/s); wheels without a motor roll on.
    ///
    /// # Errors
    /// [`Error::StaleHandle`] if an axle is gone; [`Error::Invalid`] for a speed that is not finite.
    pub fn drive(&self, world: &mut World, speed: Real) -> Result<()> {
        check::finite("speed", speed)?;
        for axle in self.axles {
            world.joint(axle)?;
        }
        for axle in self.axles {
            world.edit_joint(axle, |def| {
                if let JointKind::Wheel { motor: Some(motor), .. } = &mut def.kind {
                    motor.speed = -speed / self.wheel_radius;
                }
            })?;
        }
        Ok(())
    }
}
