//! The engine's errors as Python exceptions.

use culbuto::Error;
use pyo3::create_exception;
use pyo3::exceptions::{PyLookupError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    culbuto,
    StaleHandleError,
    PyLookupError,
    "A body, joint or other part that was removed, or that belongs to another world."
);
create_exception!(
    culbuto,
    SimulationError,
    PyRuntimeError,
    "The motion left the range of numbers, or a tolerance cannot be reached. Nothing was stepped."
);
create_exception!(
    culbuto,
    SceneFileError,
    PyValueError,
    "A scene file that cannot be read; says where in the file, and what is allowed there."
);

/// The exception for an error of the engine. An exception that a user's own force field raised
/// comes back as itself, with its traceback.
pub fn to_py(error: Error) -> PyErr {
    let message = error.to_string();
    match error {
        Error::Invalid { .. } => PyValueError::new_err(message),
        Error::StaleHandle(_) => StaleHandleError::new_err(message),
        Error::SceneFile { .. } => SceneFileError::new_err(message),
        Error::Field { source, .. }
        | Error::Joint { source, .. }
        | Error::Hook { source }
        | Error::Interrupted { source } => match source.downcast::<PyErr>() {
            Ok(raised) => *raised,
            Err(_) => SimulationError::new_err(message),
        },
        Error::Io { path, source } => io_error(path, &source, message),
        // NotFinite, Tolerance, and whatever the engine adds.
        _ => SimulationError::new_err(message),
    }
}

/// An `OSError` from a number and a file becomes the right subclass (`FileNotFoundError`, …).
fn io_error(path: String, source: &std::io::Error, message: String) -> PyErr {
    match source.raw_os_error() {
        Some(number) => PyOSError::new_err((number, source.to_string(), path)),
        None => std::io::Error::new(source.kind(), message).into(),
    }
}
