//! `culbuto._native`: the engine as Python sees it. Conversions only; the physics is in the `culbuto` crate.
//!
//! The Python package re-exports everything public from here, so classes and exceptions give
//! `culbuto` as their module: that is where users, pickles and tracebacks look for them.

use pyo3::prelude::*;

pub mod catalogue;
pub mod convert;
pub mod error;
pub mod vec2;

/// The engine of the culbuto package. Import `culbuto` instead.
#[pymodule]
#[pyo3(name = "_native")]
mod culbuto_native {
    #[pymodule_export]
    use crate::catalogue::{
        catalogue, exact_motion, measured_order, method_facts, scene_error, study, thrown_ball,
        verify,
    };
    #[pymodule_export]
    use crate::error::{SceneFileError, SimulationError, StaleHandleError};
    #[pymodule_export]
    use crate::vec2::Vec2;

    #[allow(non_upper_case_globals, reason = "the name Python gives to it")]
    #[pymodule_export]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
