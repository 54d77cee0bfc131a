//! Impacts.

mod bounce;
mod bullet;
mod many;
mod oblique;
mod pairs;

pub(super) use bounce::{DROPS, ELASTIC_BALL};
pub(super) use bullet::BULLETS;
pub(super) use many::{BILLIARD, GALPERIN, GAS};
pub(super) use oblique::OBLIQUE;
pub(super) use pairs::{CRADLE, HEAD_ON, SMOOTH_DISKS};
