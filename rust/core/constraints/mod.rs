//! What restricts motion. Each constraint gives rows: a Jacobian J, a target for Jv and bounds on the
//! impulse.

pub mod contact;
pub mod joint;
pub mod matter;
mod motion;

pub use matter::Matter;
pub use motion::{Place, Velocity};
