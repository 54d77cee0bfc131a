//! What can go wrong, said for people: what was wrong and what is allowed.
//!
//! Every public function that can fail leaves the world as it was before the call.

use std::fmt;

/// An error of the engine.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number, a shape or a setting that is not allowed.
    #[error("{what} is {got}; allowed: {allowed}")]
    Invalid {
        /// The quantity, as the user knows it ("mass", "dt").
        what: String,
        /// What was given.
        got: String,
        /// What would be right.
        allowed: String,
    },
    /// A handle to something that has been removed, or that belongs to another world.
    #[error("this {0} is no longer in the world: it was removed, or belongs to another world")]
    StaleHandle(&'static str),
    /// A force field of the user's failed; nothing was stepped.
    #[error("force field {name:?} failed: {source}")]
    Field {
        /// The field's name.
        name: String,
        /// What it reported.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A joint of the user's own failed; nothing was stepped.
    #[error("joint {name:?} failed: {source}")]
    Joint {
        /// The joint's name.
        name: String,
        /// What it reported.
        #[source]
        source: BoxError,
    },
    /// A contact hook of the user's failed; nothing was stepped.
    #[error("a contact hook failed: {source}")]
    Hook {
        /// What it reported.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Whoever watches a long run stopped it; nothing was stepped.
    #[error("interrupted: {source}")]
    Interrupted {
        /// Why.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The motion left the range of numbers; nothing was stepped.
    #[error("the motion is no longer finite at t = {time} s ({what} of body {body}); {hint}")]
    NotFinite {
        /// Time at which it was noticed (s).
        time: f64,
        /// The quantity.
        what: &'static str,
        /// Dense index of the body.
        body: usize,
        /// What to try.
        hint: &'static str,
    },
    /// The asked tolerance cannot be reached; nothing was stepped.
    #[error("the tolerance {tolerance:e} was not reached at t = {time} s: {why}")]
    Tolerance {
        /// What was asked.
        tolerance: f64,
        /// Time at which the method gave up (s).
        time: f64,
        /// Why.
        why: String,
    },
    /// A scene file that cannot be read.
    #[error("scene file, at {path}: {message}")]
    SceneFile {
        /// JSON path of the offending value, "." for the whole file.
        path: String,
        /// What was wrong and what is allowed.
        message: String,
    },
    /// A file that cannot be opened or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: String,
        /// The system's answer.
        #[source]
        source: std::io::Error,
    },
}

/// An error of the user's own code.
pub type BoxError = Box<dyn std::error::Error + Send + Sync>;

/// Result with the engine's error.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// "`what` is `got`; allowed: `allowed`".
    pub fn invalid(
        what: impl Into<String>,
        got: impl fmt::Display,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Invalid { what: what.into(), got: got.to_string(), allowed: allowed.into() }
    }
}

/// Checks at the border: each returns its argument, or says what was wrong.
pub(crate) mod check {
    use super::{Error, Result};
    use crate::math::{Real, Vec2};

    /// A finite number.
    pub fn finite(what: &str, x: Real) -> Result<Real> {
        if x.is_finite() { Ok(x) } else { Err(Error::invalid(what, x, "a finite number")) }
    }

    /// A finite number above zero.
    pub fn positive(what: &str, x: Real) -> Result<Real> {
        if x.is_finite() && x > 0.0 {
            Ok(x)
        } else {
            Err(Error::invalid(what, x, "a finite number above 0"))
        }
    }

    /// A finite number, zero or above.
    pub fn not_negative(what: &str, x: Real) -> Result<Real> {
        if x.is_finite() && x >= 0.0 {
            Ok(x)
        } else {
            Err(Error::invalid(what, x, "a finite number, 0 or above"))
        }
    }

    /// A vector of finite numbers.
    pub fn finite_vec(what: &str, v: Vec2) -> Result<Vec2> {
        if v.x.is_finite() && v.y.is_finite() {
            Ok(v)
        } else {
            Err(Error::invalid(what, format!("({}, {})", v.x, v.y), "two finite numbers"))
        }
    }
}
