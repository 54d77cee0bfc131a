//! How rows are solved.

mod block;
pub mod direct;
pub mod lanes;
pub mod links;
pub mod newton;
mod relaxed;
pub mod sweep;

pub use block::impulses as block_impulses;
pub use lanes::Lanes;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the rows of contacts and joints are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Solver {
    /// One contact after the other, again and again; joints all at once.
    #[default]
    Sweep,
    /// All at once.
    Newton,
    /// As the island asks for.
    Auto,
}

impl Solver {
    /// All of them, with their names in scene files.
    pub const ALL: [(&'static str, Self); 3] =
        [("sweep", Self::Sweep), ("newton", Self::Newton), ("auto", Self::Auto)];
}
