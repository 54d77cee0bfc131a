//! What a scene is made of, said once for all engines.

use culbuto::body::BodyKind;
use culbuto::math::{Real, Vec2, vec2};
use serde::Serialize;

/// A convex shape in its body's frame (m).
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A disk.
    Circle {
        /// Its centre.
        center: Vec2,
        /// Its radius.
        radius: Real,
    },
    /// A box along the body's axes; engines have a faster path for it than for other polygons.
    Box {
        /// Its centre.
        center: Vec2,
        /// Half its width and height.
        half: Vec2,
    },
    /// A convex polygon, counter-clockwise.
    Polygon {
        /// Its corners.
        vertices: Vec<Vec2>,
    },
    /// All points within a radius of a line.
    Capsule {
        /// One end of the line.
        a: Vec2,
        /// The other.
        b: Vec2,
        /// The radius.
        radius: Real,
    },
    /// A line without thickness.
    Segment {
        /// One end.
        a: Vec2,
        /// The other.
        b: Vec2,
    },
}

impl Shape {
    /// A box about the body's origin.
    pub fn rectangle(half_width: Real, half_height: Real) -> Self {
        Self::Box { center: vec2(0.0, 0.0), half: vec2(half_width, half_height) }
    }

    /// A disk about the body's origin.
    pub fn disk(radius: Real) -> Self {
        Self::Circle { center: vec2(0.0, 0.0), radius }
    }

    /// Corners, counter-clockwise: one for a disk, two for a segment and a capsule.
    pub fn corners(&self) -> Vec<Vec2> {
        match self {
            Self::Circle { center, .. } => vec![*center],
            Self::Box { center, half } => [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| center + vec2(x * half.x, y * half.y))
                .to_vec(),
            Self::Polygon { vertices } => vertices.clone(),
            Self::Segment { a, b } | Self::Capsule { a, b, .. } => vec![*a, *b],
        }
    }

    /// Divides all lengths.
    fn divide(&mut self, unit: Real) {
        match self {
            Self::Circle { center, radius } => {
                *center /= unit;
                *radius /= unit;
            }
            Self::Box { center, half } => {
                *center /= unit;
                *half /= unit;
            }
            Self::Polygon { vertices } => vertices.iter_mut().for_each(|p| *p /= unit),
            Self::Capsule { a, b, radius } => {
                *a /= unit;
                *b /= unit;
                *radius /= unit;
            }
            Self::Segment { a, b } => {
                *a /= unit;
                *b /= unit;
            }
        }
    }

    /// How far the shape reaches beyond the hull of its corners.
    pub fn radius(&self) -> Real {
        match self {
            Self::Circle { radius, .. } | Self::Capsule { radius, .. } => *radius,
            _ => 0.0,
        }
    }
}

/// A body as it starts.
#[derive(Clone, Debug, Serialize)]
pub struct Body {
    /// Static, kinematic or dynamic.
    pub kind: BodyKind,
    /// Where its frame stands (m).
    pub position: Vec2,
    /// Angle of its frame (rad).
    pub angle: Real,
    /// Velocity of its centre of mass (m/s).
    pub velocity: Vec2,
    /// Angular velocity (rad/s).
    pub angular_velocity: Real,
    /// Its shapes.
    pub shapes: Vec<Shape>,
    /// Density of its shapes (kg/m²).
    pub density: Real,
    /// It starts asleep, where the engine can sleep.
    pub asleep: bool,
    /// Bodies of one group, 1 to 31, do not touch each other; 0: no group.
    pub group: u8,
}

impl Body {
    /// A dynamic body at rest.
    pub fn new(position: Vec2, shapes: Vec<Shape>) -> Self {
        Self {
            kind: BodyKind::Dynamic,
            position,
            angle: 0.0,
            velocity: vec2(0.0, 0.0),
            angular_velocity: 0.0,
            shapes,
            density: 1.0,
            asleep: false,
            group: 0,
        }
    }

    /// A body that never moves, at the origin.
    pub fn ground(shapes: Vec<Shape>) -> Self {
        Self { kind: BodyKind::Static, ..Self::new(vec2(0.0, 0.0), shapes) }
    }
}

/// A hinge, or a rod. Its bodies do not touch each other.
#[derive(Clone, Debug, Serialize)]
pub struct Joint {
    /// Which bodies.
    pub bodies: [usize; 2],
    /// Where it holds each, in its frame (m).
    pub anchors: [Vec2; 2],
    /// The anchors are kept at this distance (m) instead of together.
    pub distance: Option<Real>,
    /// Least and greatest angle of the second against the first (rad).
    pub limits: Option<[Real; 2]>,
    /// Draws the angle to 0; of a rod, stands in its place.
    pub spring: Option<Spring>,
}

/// A spring of an angle or a distance, by what is to be seen and by what follows for the two bodies alone.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spring {
    /// Frequency (Hz).
    pub hertz: Real,
    /// Damping ratio.
    pub damping_ratio: Real,
    /// k (N·m/rad, or N/m).
    pub stiffness: Real,
    /// c (N·m·s/rad, or N·s/m).
    pub damping: Real,
}

/// A kinematic body that swings: its place is `amplitude` · sin(`rate` · t) from where it started.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Swing {
    /// Which body.
    pub body: usize,
    /// Farthest place (m).
    pub amplitude: Vec2,
    /// rad/s.
    pub rate: Real,
}

impl Swing {
    /// The velocity that leads from the place at the start of a step to that at its end.
    pub fn velocity(&self, step: u32, dt: Real) -> Vec2 {
        let place = |step: u32| (self.rate * dt * Real::from(step)).sin();
        self.amplitude * ((place(step + 1) - place(step)) / dt)
    }
}

/// Where bodies belong; one whose centre is elsewhere at the end is lost.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// The whole plane.
    Everywhere,
    /// Above this height (m).
    Above(Real),
    /// In this disk.
    Disk {
        /// Its centre.
        center: Vec2,
        /// Its radius.
        radius: Real,
    },
}

impl Region {
    /// Whether a point belongs; what is not a number does not.
    pub fn holds(&self, point: Vec2) -> bool {
        match *self {
            Self::Everywhere => point.x.is_finite() && point.y.is_finite(),
            Self::Above(height) => point.x.is_finite() && point.y > height,
            Self::Disk { center, radius } => (point - center).norm() < radius,
        }
    }
}

/// A scene.
///
/// Friction and restitution are the scene's, not the body's, because engines differ in what they make
/// of two values: of two that are equal all make the same (but for products, of which the roots are
/// given).
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// Its name.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    /// Its bodies.
    pub bodies: Vec<Body>,
    /// What ties them.
    pub joints: Vec<Joint>,
    /// Gravity (m/s²).
    pub gravity: Vec2,
    /// Coefficient of friction of every contact.
    pub friction: Real,
    /// Coefficient of restitution of every contact.
    pub restitution: Real,
    /// Step (s).
    pub dt: Real,
    /// Substeps a step, of engines that divide it.
    pub substeps: u32,
    /// Iterations a step, of engines that do not divide it.
    pub iterations: u32,
    /// Steps of a run.
    pub steps: u32,
    /// Bodies at rest may sleep.
    pub sleeping: bool,
    /// What swings.
    pub swing: Option<Swing>,
    /// Where bodies belong.
    pub region: Region,
    /// Usual length (m) for engines that ask for one; none: theirs.
    pub size: Option<Real>,
}

impl Scene {
    /// The same scene with its lengths in another unit (m); masses are the same.
    pub fn in_units_of(&self, unit: Real) -> Self {
        let mut scene = self.clone();
        scene.gravity /= unit;
        for body in &mut scene.bodies {
            body.position /= unit;
            body.velocity /= unit;
            body.density *= unit * unit;
            body.shapes.iter_mut().for_each(|shape| shape.divide(unit));
        }
        for joint in &mut scene.joints {
            joint.anchors = joint.anchors.map(|anchor| anchor / unit);
            joint.distance = joint.distance.map(|length| length / unit);
        }
        scene
    }

    /// How many bodies are moved by forces.
    pub fn dynamic(&self) -> usize {
        self.bodies.iter().filter(|body| body.kind == BodyKind::Dynamic).count()
    }
}
