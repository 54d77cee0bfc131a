//! Error against run time: every scene, by every method, at a row of steps and tolerances.

mod laws;
mod order;
pub mod stability;
mod study;
mod verify;

pub use laws::{Audit, Law, Laws, Limits, verify_laws};
pub use order::{Order, measured_order};
pub use study::{
    Mode, Path, Row, Study, ladder_of_steps, ladder_of_tolerances, study, study_by, thrown_ball,
};
pub use verify::{CheckRow, MethodRow, Verdict, verify, verify_by};
