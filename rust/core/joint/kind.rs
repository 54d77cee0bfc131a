//! The kinds of joints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Given, Hold, Spring};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

/// What keeps a coordinate at a speed, with a bound on what it may use.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// Speed of the second body against the first (m/s, or rad/s).
    pub speed: Real,
    /// Largest force (N) or torque (N·m); none: whatever it takes.
    #[serde(default)]
    pub max: Option<Real>,
}

/// What acts along the one coordinate that a joint leaves free: an angle (rad) or a way (m).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Travel {
    /// Lowest and highest value.
    pub limits: Option<[Real; 2]>,
    /// Drives it.
    pub motor: Option<Motor>,
    /// Draws it to `rest`.
    pub spring: Option<Spring>,
    /// Where the spring is at rest.
    pub rest: Real,
}

/// What a joint does. A is its first body, B its second; angles are those of B against A. Values that are left open (`None`)
/// are taken from where the bodies stand when the joint is made.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JointKind {
    /// Keeps the anchors at a distance: a rod, a spring, or between limits a rope.
    Distance {
        /// Length at rest (m).
        #[serde(default)]
        length: Option<Real>,
        /// Rigid: a rod. A spring. Free: only the limits count.
        #[serde(default)]
        hold: Hold,
        /// Least length (m).
        #[serde(default, rename = "min_length")]
        min: Real,
        /// Greatest length (m); none: any.
        #[serde(default, rename = "max_length")]
        max: Option<Real>,
    },
    /// Keeps the anchors together: a hinge.
    Revolute {
        /// The angle that counts as 0 (rad).
        #[serde(default)]
        angle: Option<Real>,
        /// Limits, motor and spring of the angle.
        #[serde(default)]
        travel: Travel,
    },
    /// Lets B's anchor slide along an axis fixed to A, and not turn.
    Prismatic {
        /// Direction of the axis.
        axis: Given,
        /// The angle that is kept (rad).
        #[serde(default)]
        angle: Option<Real>,
        /// Limits, motor and spring of the way along the axis, 0 where the anchors meet.
        #[serde(default)]
        travel: Travel,
    },
    /// Keeps the anchors together and the angle.
    Weld {
        /// The angle that is kept (rad).
        #[serde(default)]
        angle: Option<Real>,
        /// How the anchors are held together.
        #[serde(default)]
        linear: Hold,
        /// How the angle is held.
        #[serde(default)]
        angular: Hold,
    },
    /// Lets B, a wheel, turn about its anchor and ride up and down along an axis fixed to A.
    Wheel {
        /// Direction of the suspension.
        axis: Given,
        /// The suspension's spring.
        #[serde(default)]
        suspension: Hold,
        /// Lowest and highest way along the axis (m), 0 where the anchors meet.
        #[serde(default)]
        limits: Option<[Real; 2]>,
        /// Drives the wheel's turn.
        #[serde(default)]
        motor: Option<Motor>,
    },
    /// Draws B's anchor to A's, which usually is a point of the world that a user moves: what a mouse does.
    Grab {
        /// Rigid or a spring.
        #[serde(default)]
        hold: Hold,
        /// Largest force (N); none: whatever it takes.
        #[serde(default)]
        max_force: Option<Real>,
    },
    /// Drives B's anchor to an offset from A's, in A's frame, and the angle to a value.
    Motor {
        /// Offset in A's frame (m).
        #[serde(default = "crate::math::zero")]
        #[schemars(with = "[Real; 2]")]
        offset: Vec2,
        /// Angle (rad).
        #[serde(default)]
        angle: Option<Real>,
        /// How firmly the offset is held.
        #[serde(default)]
        linear: Hold,
        /// How firmly the angle is held.
        #[serde(default)]
        angular: Hold,
        /// Largest force (N); none: whatever it takes.
        #[serde(default)]
        max_force: Option<Real>,
        /// Largest torque (N·m); none: whatever it takes.
        #[serde(default)]
        max_torque: Option<Real>,
    },
    /// Ties two turns: ratio·θ_a + θ_b stays. Its reaction on the pair as a whole goes to the world, as through a gearbox.
    Gear {
        /// Teeth of A over teeth of B: positive where they turn against each other.
        ratio: Real,
        /// The value of ratio·θ_a + θ_b (rad).
        #[serde(default)]
        phase: Option<Real>,
    },
    /// A rope from A's anchor over two fixed points to B's anchor: l_a + ratio·l_b stays.
    Pulley {
        /// Where the rope leaves for A and for B, in the world (m).
        #[schemars(with = "[[Real; 2]; 2]")]
        over: [Vec2; 2],
        /// How many times B's side counts.
        #[serde(default = "one")]
        ratio: Real,
        /// l_a + ratio·l_b (m).
        #[serde(default)]
        length: Option<Real>,
        /// The rope may go slack.
        #[serde(default)]
        slack: bool,
    },
    /// B, a pinion, rolls along a straight rack fixed to A.
    Rack {
        /// Direction of the rack.
        axis: Given,
        /// Pitch radius of the pinion (m): the way along the axis per radian.
        radius: Real,
        /// way − radius·angle (m).
        #[serde(default)]
        offset: Option<Real>,
    },
    /// Lets B turn one way only, from notch to notch.
    Ratchet {
        /// From one notch to the next (rad); below 0 it turns clockwise.
        step: Real,
        /// Where one of the notches is (rad).
        #[serde(default)]
        phase: Real,
    },
    /// Resists any motion of the anchors against each other and any turn, up to a bound.
    Friction {
        /// Largest force (N).
        max_force: Real,
        /// Largest torque (N·m).
        max_torque: Real,
    },
    /// Draws the angle to a value.
    AngleSpring {
        /// The angle at rest (rad).
        #[serde(default)]
        angle: Option<Real>,
        /// The spring.
        spring: Spring,
    },
    /// Nothing but that the two bodies do not touch.
    Filter,
    /// Rows of the user's own code: see [`Constraint`](super::Constraint). No file can hold it.
    #[schemars(skip)]
    Custom,
}

fn one() -> Real {
    1.0
}

impl JointKind {
    /// Name, as scene files and messages have it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Distance { .. } => "distance",
            Self::Revolute { .. } => "revolute",
            Self::Prismatic { .. } => "prismatic",
            Self::Weld { .. } => "weld",
            Self::Wheel { .. } => "wheel",
            Self::Grab { .. } => "grab",
            Self::Motor { .. } => "motor",
            Self::Gear { .. } => "gear",
            Self::Pulley { .. } => "pulley",
            Self::Rack { .. } => "rack",
            Self::Ratchet { .. } => "ratchet",
            Self::Friction { .. } => "friction",
            Self::AngleSpring { .. } => "angle_spring",
            Self::Filter => "filter",
            Self::Custom => "custom",
        }
    }

    /// The angle that counts as 0, of the kinds that have one (rad).
    #[must_use]
    pub fn angle(&self) -> Option<Real> {
        match self {
            Self::Revolute { angle, .. }
            | Self::Prismatic { angle, .. }
            | Self::Weld { angle, .. }
            | Self::Motor { angle, .. }
            | Self::AngleSpring { angle, .. } => *angle,
            _ => None,
        }
    }

    /// The spring of row k, if it is one.
    #[must_use]
    pub fn spring(&self, k: usize) -> Option<Spring> {
        match self {
            Self::Distance { hold, .. } | Self::Grab { hold, .. } => hold.spring(),
            Self::Wheel { suspension, .. } => suspension.spring(),
            Self::Revolute { travel, .. } | Self::Prismatic { travel, .. } => travel.spring,
            Self::Weld { linear, angular, .. } | Self::Motor { linear, angular, .. } => {
                if k < 2 {
                    linear.spring()
                } else {
                    angular.spring()
                }
            }
            Self::AngleSpring { spring, .. } => Some(*spring),
            _ => None,
        }
    }

    /// The axis, of the kinds that have one.
    pub(super) fn axis_mut(&mut self) -> Option<&mut Given> {
        match self {
            Self::Prismatic { axis, .. } | Self::Wheel { axis, .. } | Self::Rack { axis, .. } => {
                Some(axis)
            }
            _ => None,
        }
    }

    /// Every number checked; errors name the field.
    #[expect(clippy::too_many_lines, reason = "one arm a kind reads better whole")]
    pub(super) fn validated(&self) -> Result<()> {
        match self {
            Self::Distance { length, hold, min, max } => {
                length.map_or(Ok(0.0), |length| check::not_negative("length", length))?;
                hold.validated()?;
                check::not_negative("min_length", *min)?;
                in_order("max_length", *min, max.unwrap_or(Real::MAX))
            }
            Self::Revolute { angle, travel } => {
                finite("angle", *angle)?;
                travel.validated()
            }
            Self::Prismatic { axis, angle, travel } => {
                direction(axis)?;
                finite("angle", *angle)?;
                travel.validated()
            }
            Self::Weld { angle, linear, angular } => {
                finite("angle", *angle)?;
                linear.validated()?;
                angular.validated()
            }
            Self::Wheel { axis, suspension, limits, motor } => {
                direction(axis)?;
                suspension.validated()?;
                Travel { limits: *limits, motor: *motor, ..Travel::default() }.validated()
            }
            Self::Grab { hold, max_force } => {
                hold.validated()?;
                bound("max_force", *max_force)
            }
            Self::Motor { offset, angle, linear, angular, max_force, max_torque } => {
                check::finite_vec("offset", *offset)?;
                finite("angle", *angle)?;
                linear.validated()?;
                angular.validated()?;
                bound("max_force", *max_force)?;
                bound("max_torque", *max_torque)
            }
            Self::Gear { ratio, phase } => {
                not_zero("ratio", *ratio)?;
                finite("phase", *phase)
            }
            Self::Pulley { over, ratio, length, slack: _ } => {
                over.iter().try_for_each(|point| check::finite_vec("over", *point).map(drop))?;
                check::positive("ratio", *ratio)?;
                length.map_or(Ok(()), |length| check::positive("length", length).map(drop))
            }
            Self::Rack { axis, radius, offset } => {
                direction(axis)?;
                not_zero("radius", *radius)?;
                finite("offset", *offset)
            }
            Self::Ratchet { step, phase } => {
                not_zero("step", *step)?;
                check::finite("phase", *phase).map(drop)
            }
            Self::Friction { max_force, max_torque } => {
                bound("max_force", Some(*max_force))?;
                bound("max_torque", Some(*max_torque))
            }
            Self::AngleSpring { angle, spring } => {
                finite("angle", *angle)?;
                spring.validated()
            }
            Self::Filter | Self::Custom => Ok(()),
        }
    }
}

impl Travel {
    fn validated(&self) -> Result<()> {
        if let Some([low, high]) = self.limits {
            check::finite("lower limit", low)?;
            check::finite("upper limit", high)?;
            in_order("upper limit", low, high)?;
        }
        if let Some(motor) = self.motor {
            check::finite("motor speed", motor.speed)?;
            bound("largest force or torque of the motor", motor.max)?;
        }
        check::finite("rest", self.rest)?;
        self.spring.map_or(Ok(()), |spring| spring.validated())
    }
}

fn finite(what: &str, value: Option<Real>) -> Result<()> {
    value.map_or(Ok(()), |value| check::finite(what, value).map(drop))
}

fn bound(what: &str, value: Option<Real>) -> Result<()> {
    value.map_or(Ok(()), |value| check::not_negative(what, value).map(drop))
}

fn not_zero(what: &str, value: Real) -> Result<()> {
    if value.is_finite() && value != 0.0 {
        return Ok(());
    }
    Err(Error::invalid(what, value, "a finite number other than 0"))
}

fn in_order(what: &str, low: Real, high: Real) -> Result<()> {
    if high >= low {
        return Ok(());
    }
    Err(Error::invalid(what, high, format!("{low} or above")))
}

fn direction(axis: &Given) -> Result<()> {
    if check::finite_vec("axis", axis.vector())?.norm() > 0.0 {
        return Ok(());
    }
    Err(Error::invalid("axis", "(0, 0)", "a direction: any vector but (0, 0)"))
}
