//! The parameters of joints by the names that Python gives to them.

use culbuto::Error;
use culbuto::joint::{Given, Hold, JointDef, JointKind, Motor, Spring, Travel};
use culbuto::math::{self, Real, vec2};
use culbuto::world::JointRef;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString, PyTuple};
use pyo3::{IntoPyObjectExt, PyErr};

use crate::convert::Vec2Arg;
use crate::error::to_py;
use crate::joint_springs::Aspect;
use crate::vec2::Vec2;

/// What a parameter can be.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    None,
    Flag(bool),
    Number(Real),
    Text(String),
    /// A vector.
    Two(math::Vec2),
    /// Two vectors.
    Four([math::Vec2; 2]),
    /// From low to high.
    Range([Real; 2]),
}

impl<'py> FromPyObject<'_, 'py> for Value {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if object.is_none() {
            Ok(Self::None)
        } else if let Ok(flag) = object.cast::<PyBool>() {
            Ok(Self::Flag(flag.is_true()))
        } else if let Ok(text) = object.cast::<PyString>() {
            Ok(Self::Text(text.to_string()))
        } else if let Ok(number) = object.extract::<Real>() {
            Ok(Self::Number(number))
        } else if let Ok(two) = object.extract::<Vec2Arg>() {
            Ok(Self::Two(two.0))
        } else if let Ok((a, b)) = object
            .try_iter()
            .and_then(|all| PyTuple::new(object.py(), all.collect::<PyResult<Vec<_>>>()?))
            .and_then(|all| all.extract::<(Vec2Arg, Vec2Arg)>())
        {
            Ok(Self::Four([a.0, b.0]))
        } else {
            let kind = object.get_type().name()?;
            Err(PyTypeError::new_err(format!(
                "expected a number, or two, or two points, got {kind}"
            )))
        }
    }
}

impl<'py> IntoPyObject<'py> for Value {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        match self {
            Self::None => Ok(py.None().into_bound(py)),
            Self::Flag(flag) => flag.into_bound_py_any(py),
            Self::Number(number) => number.into_bound_py_any(py),
            Self::Text(text) => text.into_bound_py_any(py),
            Self::Two(vector) => Vec2(vector).into_bound_py_any(py),
            Self::Four([a, b]) => (Vec2(a), Vec2(b)).into_bound_py_any(py),
            Self::Range([low, high]) => (low, high).into_bound_py_any(py),
        }
    }
}

/// A kind with everything as by default; what has no default is given by all who make one.
pub fn blank(kind: &str) -> Option<JointKind> {
    let (angle, hold, travel) = (None, Hold::Rigid, Travel::default());
    let (axis, origin) = (Given::Local(vec2(1.0, 0.0)), vec2(0.0, 0.0));
    let (max_force, max_torque) = (None, None);
    let (linear, angular) = (hold, hold);
    Some(match kind {
        "distance" => JointKind::Distance { length: None, hold, min: 0.0, max: None },
        "revolute" => JointKind::Revolute { angle, travel },
        "prismatic" => JointKind::Prismatic { axis, angle, travel },
        "weld" => JointKind::Weld { angle, linear, angular },
        "wheel" => JointKind::Wheel { axis, suspension: hold, limits: None, motor: None },
        "grab" => JointKind::Grab { hold, max_force },
        "motor" => {
            JointKind::Motor { offset: origin, angle, linear, angular, max_force, max_torque }
        }
        "gear" => JointKind::Gear { ratio: 1.0, phase: None },
        "pulley" => JointKind::Pulley { over: [origin; 2], ratio: 1.0, length: None, slack: false },
        "rack" => JointKind::Rack { axis, radius: 1.0, offset: None },
        "ratchet" => JointKind::Ratchet { step: 1.0, phase: 0.0 },
        "friction" => JointKind::Friction { max_force: 0.0, max_torque: 0.0 },
        "angle_spring" => JointKind::AngleSpring { angle, spring: Spring::new(1.0, 0.0) },
        "filter" => JointKind::Filter,
        "custom" => JointKind::Custom,
        _ => return None,
    })
}

/// Where a parameter stands in a definition.
enum Slot<'a> {
    Number(&'a mut Real),
    Maybe(&'a mut Option<Real>),
    Flag(&'a mut bool),
    Text(&'a mut Option<String>),
    Vector(&'a mut math::Vec2),
    Points(&'a mut [math::Vec2; 2]),
    Range(&'a mut Option<[Real; 2]>),
    Local(&'a mut Given),
    World(&'a mut Given),
    Both(&'a mut [Given; 2]),
    Speed(&'a mut Option<Motor>),
    Most(&'a mut Option<Motor>),
}

fn slot<'a>(def: &'a mut JointDef, name: &str) -> Option<Slot<'a>> {
    Some(match name {
        "anchor_a" => Slot::Local(&mut def.anchors[0]),
        "anchor_b" => Slot::Local(&mut def.anchors[1]),
        "target" => Slot::World(&mut def.anchors[0]),
        "point" | "points" => Slot::Both(&mut def.anchors),
        "collide_connected" => Slot::Flag(&mut def.collide_connected),
        "breaking_force" => Slot::Maybe(&mut def.breaking_force),
        "breaking_torque" => Slot::Maybe(&mut def.breaking_torque),
        "name" => Slot::Text(&mut def.name),
        _ => return slot_of_kind(&mut def.kind, name),
    })
}

fn slot_of_kind<'a>(kind: &'a mut JointKind, name: &str) -> Option<Slot<'a>> {
    use JointKind as K;
    Some(match (name, kind) {
        ("length", K::Distance { length, .. } | K::Pulley { length, .. }) => Slot::Maybe(length),
        ("min_length", K::Distance { min, .. }) => Slot::Number(min),
        ("max_length", K::Distance { max, .. }) => Slot::Maybe(max),
        (
            "reference_angle",
            K::Revolute { angle, .. } | K::Prismatic { angle, .. } | K::Weld { angle, .. },
        )
        | ("rest_angle", K::AngleSpring { angle, .. })
        | ("angular_offset", K::Motor { angle, .. }) => Slot::Maybe(angle),
        ("axis", K::Prismatic { axis, .. } | K::Wheel { axis, .. } | K::Rack { axis, .. }) => {
            Slot::Local(axis)
        }
        (
            "world_axis",
            K::Prismatic { axis, .. } | K::Wheel { axis, .. } | K::Rack { axis, .. },
        ) => Slot::World(axis),
        ("limits", K::Revolute { travel, .. } | K::Prismatic { travel, .. }) => {
            Slot::Range(&mut travel.limits)
        }
        ("limits", K::Wheel { limits, .. }) => Slot::Range(limits),
        ("motor_speed", K::Revolute { travel, .. } | K::Prismatic { travel, .. }) => {
            Slot::Speed(&mut travel.motor)
        }
        ("motor_speed", K::Wheel { motor, .. }) => Slot::Speed(motor),
        ("max_torque", K::Revolute { travel, .. }) | ("max_force", K::Prismatic { travel, .. }) => {
            Slot::Most(&mut travel.motor)
        }
        ("max_torque", K::Wheel { motor, .. }) => Slot::Most(motor),
        ("rest_angle", K::Revolute { travel, .. })
        | ("rest_translation", K::Prismatic { travel, .. }) => Slot::Number(&mut travel.rest),
        ("max_force", K::Grab { max_force, .. } | K::Motor { max_force, .. }) => {
            Slot::Maybe(max_force)
        }
        ("max_torque", K::Motor { max_torque, .. }) => Slot::Maybe(max_torque),
        ("max_force", K::Friction { max_force: most, .. })
        | ("max_torque", K::Friction { max_torque: most, .. }) => Slot::Number(most),
        ("linear_offset", K::Motor { offset, .. }) => Slot::Vector(offset),
        ("ratio", K::Gear { ratio, .. } | K::Pulley { ratio, .. }) => Slot::Number(ratio),
        ("phase", K::Gear { phase, .. }) => Slot::Maybe(phase),
        ("over", K::Pulley { over, .. }) => Slot::Points(over),
        ("slack", K::Pulley { slack, .. }) => Slot::Flag(slack),
        ("radius", K::Rack { radius, .. }) => Slot::Number(radius),
        ("offset", K::Rack { offset, .. }) => Slot::Maybe(offset),
        ("step", K::Ratchet { step, .. }) => Slot::Number(step),
        ("phase", K::Ratchet { phase, .. }) => Slot::Number(phase),
        _ => return None,
    })
}

impl Slot<'_> {
    fn get(&self) -> Value {
        let or_none = |number: Option<Real>| number.map_or(Value::None, Value::Number);
        match self {
            Self::Number(number) => Value::Number(**number),
            Self::Maybe(number) => or_none(**number),
            Self::Flag(flag) => Value::Flag(**flag),
            Self::Text(text) => (**text).clone().map_or(Value::None, Value::Text),
            Self::Vector(vector) => Value::Two(**vector),
            Self::Points(points) => Value::Four(**points),
            Self::Range(range) => range.map_or(Value::None, Value::Range),
            Self::Local(given) | Self::World(given) => Value::Two(given.vector()),
            Self::Both(given) => Value::Four(given.map(|given| given.vector())),
            Self::Speed(motor) => or_none(motor.map(|motor| motor.speed)),
            Self::Most(motor) => or_none(motor.and_then(|motor| motor.max)),
        }
    }

    /// Sets the parameter, or says what it can be.
    fn put(self, value: Value) -> Result<(), &'static str> {
        match (self, value) {
            (Self::Number(own), Value::Number(number)) => *own = number,
            (Self::Number(_), _) => return Err("a number"),
            (Self::Maybe(own), Value::Number(number)) => *own = Some(number),
            (Self::Maybe(own), Value::None) => *own = None,
            (Self::Maybe(_), _) => return Err("a number or None"),
            (Self::Flag(own), Value::Flag(flag)) => *own = flag,
            (Self::Flag(_), _) => return Err("True or False"),
            (Self::Text(own), Value::Text(text)) => *own = Some(text),
            (Self::Text(own), Value::None) => *own = None,
            (Self::Text(_), _) => return Err("a str or None"),
            (Self::Vector(own), Value::Two(vector)) => *own = vector,
            (Self::Local(own), Value::Two(vector)) => *own = Given::Local(vector),
            (Self::World(own), Value::Two(vector)) => *own = Given::World(vector),
            (Self::Both(own), Value::Two(point)) => *own = [Given::World(point); 2],
            (Self::Vector(_) | Self::Local(_) | Self::World(_), _) => return Err("two numbers"),
            (Self::Points(own), Value::Four(points)) => *own = points,
            (Self::Both(own), Value::Four(points)) => *own = points.map(Given::World),
            (Self::Points(_) | Self::Both(_), _) => return Err("two points"),
            (Self::Range(own), Value::Two(range)) => *own = Some([range.x, range.y]),
            (Self::Range(own), Value::None) => *own = None,
            (Self::Range(_), _) => return Err("two numbers, low and high, or None"),
            (Self::Speed(own), Value::Number(speed)) => {
                *own = Some(Motor { speed, max: own.and_then(|motor| motor.max) });
            }
            (Self::Speed(own), Value::None) => *own = None,
            (Self::Most(own), Value::Number(most)) => {
                *own = Some(Motor { speed: own.map_or(0.0, |motor| motor.speed), max: Some(most) });
            }
            (Self::Most(own), Value::None) => {
                *own = own.map(|Motor { speed, .. }| Motor { speed, max: None });
            }
            (Self::Speed(_) | Self::Most(_), _) => return Err("a number or None"),
        }
        Ok(())
    }
}

/// A number or None.
pub fn number_or_none(name: &str, value: &Value) -> PyResult<Option<Real>> {
    match value {
        Value::Number(number) => Ok(Some(*number)),
        Value::None => Ok(None),
        _ => Err(unlike(name, "a number or None")),
    }
}

fn unlike(name: &str, wanted: &str) -> PyErr {
    PyTypeError::new_err(format!("argument '{name}': expected {wanted}"))
}

/// A parameter of a definition; none if there is none of this name.
pub fn parameter(def: &JointDef, name: &str) -> Option<Value> {
    if matches!(name, "point" | "points" | "target" | "world_axis") {
        return None; // where they are now, the world knows
    }
    if let Some(aspect) = Aspect::of(name) {
        return aspect.get(&def.kind);
    }
    slot(&mut def.clone(), name).map(|slot| slot.get())
}

/// What is to be seen of a joint in a world.
pub fn seen(joint: &JointRef<'_>, name: &str) -> Value {
    let [way, speed] = joint.travel();
    let anchors = joint.anchors();
    match name {
        "points" => Value::Four(anchors),
        "target" => Value::Two(anchors[0]),
        "reaction_force" => Value::Two(joint.reaction().force),
        "reaction_torque" => Value::Number(joint.reaction().torque),
        "gap" => Value::Number(joint.gap()),
        "energy" => Value::Number(joint.energy()),
        "current_length" | "angle" | "translation" => Value::Number(way),
        "speed" => Value::Number(speed),
        _ => Aspect::of(name).map_or(Value::None, |aspect| aspect.seen(joint)),
    }
}

/// Changes a parameter. `made` is the joint, if it is made.
pub fn put(
    def: &mut JointDef,
    name: &str,
    value: Value,
    made: Option<&JointRef<'_>>,
) -> PyResult<()> {
    if let Some(aspect) = Aspect::of(name) {
        return aspect.put(&mut def.kind, number_or_none(name, &value)?, made);
    }
    let kind = def.kind.name();
    let slot = slot(def, name)
        .ok_or_else(|| PyTypeError::new_err(format!("a {kind} joint has no parameter '{name}'")))?;
    slot.put(value).map_err(|wanted| unlike(name, wanted))
}

/// An error of the engine's about a joint, in the words of Python.
pub fn joint_error(kind: &JointKind, error: Error) -> PyErr {
    use JointKind as K;
    to_py(match error {
        Error::Invalid { what, got, allowed } => {
            let what = match (what.as_str(), kind) {
                ("angle", K::AngleSpring { .. }) => "rest_angle",
                ("angle", K::Motor { .. }) => "angular_offset",
                ("angle", _) => "reference_angle",
                ("offset", K::Motor { .. }) => "linear_offset",
                ("rest", K::Prismatic { .. }) => "rest_translation",
                ("rest", _) => "rest_angle",
                ("motor speed", _) => "motor_speed",
                ("largest force or torque of the motor", K::Prismatic { .. }) => "max_force",
                ("largest force or torque of the motor", _) => "max_torque",
                _ => what.as_str(),
            };
            Error::Invalid { what: what.to_owned(), got, allowed }
        }
        other => other,
    })
}
