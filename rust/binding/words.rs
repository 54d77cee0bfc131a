//! Words for what the core has enums for.

use culbuto::body::{BodyKind, DragWidth};
use culbuto::math::Real;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// "silhouette", "bounding_box", or a width (m).
#[derive(IntoPyObject)]
pub enum Width {
    /// By what it is.
    Name(&'static str),
    /// A width (m).
    Fixed(Real),
}

impl From<DragWidth> for Width {
    fn from(width: DragWidth) -> Self {
        match width {
            DragWidth::Silhouette => Self::Name("silhouette"),
            DragWidth::BoundingBox => Self::Name("bounding_box"),
            DragWidth::Fixed(width) => Self::Fixed(width),
        }
    }
}

/// A drag width as an argument.
#[derive(Clone, Copy)]
pub struct WidthArg(pub DragWidth);

impl<'py> FromPyObject<'_, 'py> for WidthArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(width) = object.extract::<Real>() {
            return Ok(Self(DragWidth::Fixed(width)));
        }
        match object.extract::<&str>() {
            Ok("silhouette") => Ok(Self(DragWidth::Silhouette)),
            Ok("bounding_box") => Ok(Self(DragWidth::BoundingBox)),
            _ => Err(PyValueError::new_err(format!(
                "drag_width is {}; allowed: 'silhouette', 'bounding_box', or a width in metres",
                object.repr()?
            ))),
        }
    }
}

/// A kind of body as an argument.
#[derive(Clone, Copy)]
pub struct KindArg(pub BodyKind);

impl<'py> FromPyObject<'_, 'py> for KindArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<&str>() {
            Ok("dynamic") => Ok(Self(BodyKind::Dynamic)),
            Ok("static") => Ok(Self(BodyKind::Static)),
            Ok("kinematic") => Ok(Self(BodyKind::Kinematic)),
            _ => Err(PyValueError::new_err(format!(
                "kind is {}; allowed: 'dynamic', 'static', 'kinematic'",
                object.repr()?
            ))),
        }
    }
}

/// The word for a kind of body.
pub fn kind_name(kind: BodyKind) -> &'static str {
    match kind {
        BodyKind::Dynamic => "dynamic",
        BodyKind::Static => "static",
        BodyKind::Kinematic => "kinematic",
    }
}
