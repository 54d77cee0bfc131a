//! `culbuto._native`: the engine as Python sees it. Conversions only; the physics is in the `culbuto` crate.
//!
//! The Python package re-exports everything public from here, so classes and exceptions give
//! `culbuto` as their module: that is where users, pickles and tracebacks look for them.

use pyo3::prelude::*;

mod add_body;
mod add_soft;
mod arrays;
mod body;
mod body_def;
mod builders;
mod catalogue;
mod code;
mod contacts;
mod convert;
mod custom_joint;
mod drawing;
mod error;
mod field;
mod fluid;
mod found;
mod hooks;
mod joint;
mod joint_parameters;
mod joint_pickle;
mod joint_springs;
mod joints;
mod law;
mod laws;
mod mixing;
mod observe;
mod parts;
mod queries;
mod read_out;
mod record;
mod scene_file;
mod schedule;
mod shape;
mod shapes;
mod snapshot;
mod soft;
mod soft_found;
mod stepper;
mod stepping;
mod surface;
mod vec2;
mod words;
mod world;

/// The engine of the culbuto package. Import `culbuto` instead.
#[pymodule]
#[pyo3(name = "_native")]
mod culbuto_native {
    #[pymodule_export]
    use crate::body::Body;
    #[pymodule_export]
    use crate::builders::{bridge, chain, lattice, ragdoll, rope, vehicle};
    #[pymodule_export]
    use crate::catalogue::{
        catalogue, exact_motion, hard_scenes, measured_order, open_scene, scene_error,
        stability_of, study, thrown_ball, verify,
    };
    #[pymodule_export]
    use crate::contacts::{Contact, ContactEvent, ContactEvents, Contacts, Events};
    #[pymodule_export]
    use crate::error::{SceneFileError, SimulationError, StaleHandleError};
    #[pymodule_export]
    use crate::field::{Attraction, Central, Field, Oscillating};
    #[pymodule_export]
    use crate::fluid::{Fluid, Inflow};
    #[pymodule_export]
    use crate::found::{Distance, Nearest, RayHit};
    #[pymodule_export]
    use crate::hooks::PreSolve;
    #[pymodule_export]
    use crate::joint::Joint;
    #[pymodule_export]
    use crate::joint_springs::SpringMotion;
    #[pymodule_export]
    use crate::joints::{BrokenJoint, Joints};
    #[pymodule_export]
    use crate::law::State;
    #[pymodule_export]
    use crate::laws::{Audit, verify_laws};
    #[pymodule_export]
    use crate::mixing::PairOfMaterials;
    #[pymodule_export]
    use crate::observe::{Energy, Facts, methods};
    #[pymodule_export]
    use crate::queries::RayHits;
    #[pymodule_export]
    use crate::scene_file::{SceneFile, scene_schema};
    #[pymodule_export]
    use crate::schedule::Schedule;
    #[pymodule_export]
    use crate::shape::{MassProperties, Shape};
    #[pymodule_export]
    use crate::shapes::{
        Arc, Capsule, Chain, Circle, Polygon, Rectangle, RegularPolygon, RoundedPolygon, Segment,
    };
    #[pymodule_export]
    use crate::snapshot::Snapshot;
    #[pymodule_export]
    use crate::soft::SoftBody;
    #[pymodule_export]
    use crate::soft_found::{NearestSoft, SoftContact, SoftEvents, SoftRayHit};
    #[pymodule_export]
    use crate::stepper::{Frame, Stepper};
    #[pymodule_export]
    use crate::stepping::{StepReport, Trajectory};
    #[pymodule_export]
    use crate::vec2::Vec2;
    #[pymodule_export]
    use crate::world::World;

    #[allow(non_upper_case_globals, reason = "the name Python gives to it")]
    #[pymodule_export]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
