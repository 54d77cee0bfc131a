//! What the user writes to make a body; scene files hold the same.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::{Filter, FilterOverride, Mass, Role, Surface, SurfaceOverride};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2, vec2};
use crate::shapes::{MassProperties, Shape};

/// How a body takes part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Never moves.
    Static,
    /// Moves with the velocity it is given, whatever acts on it.
    Kinematic,
    /// Moves by Newton's laws.
    #[default]
    Dynamic,
}

/// Axes along which a body cannot move. The velocity along a locked axis is 0 and stays 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Locks {
    /// No motion along x.
    pub x: bool,
    /// No motion along y.
    pub y: bool,
    /// No rotation.
    pub rotation: bool,
}

/// The width A that air drag ½ρCAv² acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DragWidth {
    /// The true projected width of the silhouette across the motion.
    #[default]
    Silhouette,
    /// The extent of the axis-aligned bounding box across the motion: the shortcut of simple
    /// engines, kept to show the difference.
    BoundingBox,
    /// A width (m) that does not depend on the direction.
    Fixed(Real),
}

/// One shape of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The shape, in the body's frame.
    pub shape: Shape,
    /// Density (kg/m², or kg/m of a wire); none: the body's.
    #[serde(default)]
    pub density: Option<Real>,
    /// Friction, restitution and the like; what is not there: the body's.
    #[serde(default)]
    pub surface: SurfaceOverride,
    /// What it can touch; what is not there: the body's.
    #[serde(default)]
    pub filter: FilterOverride,
    /// Solid, a sensor, or a platform that is open from one side; none: as the body.
    #[serde(default)]
    pub role: Option<Role>,
}

impl From<Shape> for Part {
    fn from(shape: Shape) -> Self {
        let (surface, filter) = (SurfaceOverride::default(), FilterOverride::default());
        Self { shape, density: None, surface, filter, role: None }
    }
}

/// Everything about a body that is about to be made. Fill in what differs from the default:
///
/// ```
/// use culbuto::{BodyDef, shapes::Shape, math::vec2};
/// let ball = BodyDef { position: vec2(0.0, 2.0), ..BodyDef::new(Shape::circle(0.1)?) };
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BodyDef {
    /// A name to find the body by; need not be unique.
    pub name: Option<String>,
    /// Static, kinematic or dynamic.
    pub kind: BodyKind,
    /// Where the body's frame stands (m). The shapes are given in that frame.
    #[schemars(with = "[Real; 2]")]
    pub position: Vec2,
    /// Angle of the body's frame (rad).
    pub angle: Real,
    /// Velocity of the centre of mass (m/s).
    #[schemars(with = "[Real; 2]")]
    pub velocity: Vec2,
    /// Angular velocity (rad/s).
    pub angular_velocity: Real,
    /// The shapes, each with its density or the body's. None: a point.
    #[schemars(skip)] // scene files have parts of their own
    pub shapes: Vec<Part>,
    /// Density of shapes that have none of their own (kg/m²; kg/m of a wire).
    pub density: Real,
    /// Mass (kg) instead of the one that follows from the densities.
    pub mass: Option<Real>,
    /// Moment of inertia about the centre of mass (kg·m²) instead of the one that follows from
    /// shapes and mass. A point that is given none does not rotate.
    pub inertia: Option<Real>,
    /// Centre of mass in the body's frame (m) instead of the shapes'.
    #[schemars(with = "Option<[Real; 2]>")]
    pub center_of_mass: Option<Vec2>,
    /// Locked axes.
    pub locks: Locks,
    /// Gravity acts this many times.
    pub gravity_scale: Real,
    /// Rate at which the velocity against the air decays (1/s).
    pub linear_damping: Real,
    /// Rate at which the angular velocity decays (1/s).
    pub angular_damping: Real,
    /// C in ½ρCAv²; acts only where the world's air has a density.
    pub drag_coefficient: Real,
    /// A in ½ρCAv².
    pub drag_width: DragWidth,
    /// Friction, restitution and the like of shapes that have none of their own.
    #[schemars(flatten)]
    pub surface: Surface,
    /// What shapes that have no filter of their own can touch.
    pub filter: Filter,
    /// What shapes that have no role of their own are there for.
    pub role: Role,
    /// A constant force through the centre of mass (N), until changed.
    #[schemars(with = "[Real; 2]")]
    pub force: Vec2,
    /// A constant torque (N·m), until changed.
    pub torque: Real,
}

impl Default for BodyDef {
    fn default() -> Self {
        Self {
            name: None,
            kind: BodyKind::Dynamic,
            position: vec2(0.0, 0.0),
            angle: 0.0,
            velocity: vec2(0.0, 0.0),
            angular_velocity: 0.0,
            shapes: Vec::new(),
            density: 1.0,
            mass: None,
            inertia: None,
            center_of_mass: None,
            locks: Locks::default(),
            gravity_scale: 1.0,
            linear_damping: 0.0,
            angular_damping: 0.0,
            drag_coefficient: 0.4,
            drag_width: DragWidth::Silhouette,
            surface: Surface::default(),
            filter: Filter::default(),
            role: Role::Solid,
            force: vec2(0.0, 0.0),
            torque: 0.0,
        }
    }
}

impl BodyDef {
    /// A dynamic body of one shape, density 1.
    #[must_use]
    pub fn new(shape: impl Into<Part>) -> Self {
        Self { shapes: vec![shape.into()], ..Self::default() }
    }

    /// A dynamic body of several shapes.
    #[must_use]
    pub fn compound(parts: impl IntoIterator<Item = Part>) -> Self {
        Self { shapes: parts.into_iter().collect(), ..Self::default() }
    }

    /// A point of this mass (kg). It does not rotate unless it is given an inertia.
    #[must_use]
    pub fn point(mass: Real) -> Self {
        Self { mass: Some(mass), ..Self::default() }
    }

    /// Every number checked; errors name the field.
    pub(crate) fn validated(&self) -> Result<()> {
        check::finite_vec("position", self.position)?;
        check::finite("angle", self.angle)?;
        check::finite_vec("velocity", self.velocity)?;
        check::finite("angular_velocity", self.angular_velocity)?;
        check::not_negative("density", self.density)?;
        for density in self.shapes.iter().filter_map(|part| part.density) {
            check::not_negative("density of a shape", density)?;
        }
        check::finite("gravity_scale", self.gravity_scale)?;
        check::not_negative("linear_damping", self.linear_damping)?;
        check::not_negative("angular_damping", self.angular_damping)?;
        check::not_negative("drag_coefficient", self.drag_coefficient)?;
        if let DragWidth::Fixed(width) = self.drag_width {
            check::not_negative("drag_width", width)?;
        }
        self.surface.validated()?;
        self.role.validated()?;
        for part in &self.shapes {
            part.surface.validated()?;
            part.role.unwrap_or_default().validated()?;
        }
        check::finite_vec("force", self.force)?;
        check::finite("torque", self.torque)?;
        if let Some(center) = self.center_of_mass {
            check::finite_vec("center_of_mass", center)?;
        }
        self.allows_velocity(self.velocity, self.angular_velocity)
    }

    /// Whether this body may move so: a static body not at all, a dynamic one not along locked axes.
    pub(crate) fn allows_velocity(&self, velocity: Vec2, angular: Real) -> Result<()> {
        let still = |axis: bool| self.kind == BodyKind::Static || (self.is_dynamic() && axis);
        let why = match self.kind {
            BodyKind::Static => "0, because the body is static",
            _ => "0, because that axis is locked",
        };
        if still(self.locks.x) && velocity.x != 0.0 {
            return Err(Error::invalid("velocity x", velocity.x, why));
        }
        if still(self.locks.y) && velocity.y != 0.0 {
            return Err(Error::invalid("velocity y", velocity.y, why));
        }
        if still(self.locks.rotation) && angular != 0.0 {
            return Err(Error::invalid("angular_velocity", angular, why));
        }
        Ok(())
    }

    /// The surface of one of its shapes: the shape's own values, else the body's.
    #[must_use]
    pub fn surface_of(&self, part: &Part) -> Surface {
        part.surface.over(&self.surface)
    }

    /// The filter of one of its shapes, likewise.
    #[must_use]
    pub fn filter_of(&self, part: &Part) -> Filter {
        part.filter.over(&self.filter)
    }

    /// The role of one of its shapes, likewise.
    #[must_use]
    pub fn role_of(&self, part: &Part) -> Role {
        part.role.unwrap_or(self.role)
    }

    pub(crate) fn is_dynamic(&self) -> bool {
        self.kind == BodyKind::Dynamic
    }

    /// Mass, centre and inertia of the shapes by their densities, then what was given instead.
    pub(crate) fn mass_properties(&self) -> Result<MassProperties> {
        let mut sum = MassProperties::combine(
            self.shapes
                .iter()
                .map(|part| part.shape.mass_properties(part.density.unwrap_or(self.density))),
        );
        if let Some(mass) = self.mass {
            check::positive("mass", mass)?;
            sum.inertia *= if sum.mass > 0.0 { mass / sum.mass } else { 0.0 };
            sum.mass = mass;
        }
        if let Some(center) = self.center_of_mass {
            sum.inertia += sum.mass * (center - sum.center).norm_squared();
            sum.center = center;
        }
        if let Some(inertia) = self.inertia {
            sum.inertia = check::positive("inertia", inertia)?;
        }
        if !self.is_dynamic() {
            return Ok(sum);
        }
        if sum.mass == 0.0 {
            return Err(Error::invalid(
                "mass of a dynamic body",
                0,
                "above 0: give it mass=, or a shape whose density is above 0",
            ));
        }
        check::positive("mass from the shapes' densities", sum.mass)?;
        check::positive("1 / mass", 1.0 / sum.mass)?;
        if sum.inertia != 0.0 {
            check::positive("inertia", sum.inertia)?;
            check::positive("1 / inertia", 1.0 / sum.inertia)?;
        }
        Ok(sum)
    }

    /// The hot numbers of that mass: zero inverses where the body does not answer to forces.
    pub(crate) fn mass_column(&self, sum: &MassProperties) -> Mass {
        let dynamic = self.is_dynamic();
        let free = |axis: bool, value: Real| if dynamic && !axis { value } else { 0.0 };
        let inverse = |x: Real| if x > 0.0 { 1.0 / x } else { 0.0 };
        Mass {
            inverse: vec2(
                free(self.locks.x, inverse(sum.mass)),
                free(self.locks.y, inverse(sum.mass)),
            ),
            inverse_inertia: free(self.locks.rotation, inverse(sum.inertia)),
            mass: sum.mass,
            inertia: sum.inertia,
            gravity_scale: vec2(
                free(self.locks.x, self.gravity_scale),
                free(self.locks.y, self.gravity_scale),
            ),
        }
    }
}
