//! Worlds with joints.
