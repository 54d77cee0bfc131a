//! Scenes on which engines fall, and what they should do: the rows of the report's matrix. Apart from the catalogue, whose
//! scenes ask figures of Culbuto alone, each is one world that other engines can have as well, and ends well or does not.

mod extremes;
mod structures;

use crate::error::Result;
use crate::math::{Real, Vec2};
use crate::world::World;

/// What a scene should do.
#[derive(Clone, Copy, Debug)]
pub enum Should {
    /// Its bodies stay where they are.
    Stand,
    /// Its joints stay together.
    Hold,
    /// No body comes beyond this x (m).
    Stop(Real),
    /// It keeps turning.
    Turn,
    /// Its dynamic bodies end where the answer has their frames (m).
    End(fn() -> Vec<Vec2>),
    /// It gains no energy, and no body sinks into the ground at y = 0.
    Calm,
    /// Its disks, all in one place at first, part without being thrown about.
    Part,
    /// A second run has the same bits.
    Repeat,
}

/// A hard scene.
pub struct Hard {
    /// The scene of the catalogue that it is, or is taken from.
    pub id: &'static str,
    /// Its name.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Makes the world.
    pub build: fn() -> Result<World>,
    /// What it should do.
    pub should: Should,
    /// What its lengths are measured by (m). Engines that ask for a usual length are given this one.
    pub size: Real,
    /// How long it runs (s).
    pub seconds: Real,
    /// By what steps are multiplied: the root of the size where that is not 1 m, so that gravity does as much in each.
    pub tempo: Real,
    /// Steps vary, from a quarter to four times what is asked.
    pub varies: bool,
}

/// Every hard scene.
pub static HARD: &[&Hard] = &[
    &structures::TWENTY,
    &structures::HUNDRED,
    &structures::PYRAMID,
    &structures::TOP_HEAVY,
    &structures::DOUBLING,
    &structures::THOUSAND,
    &structures::MILLION,
    &structures::CARDS,
    &structures::OVERHANG,
    &extremes::CHAINS[0],
    &extremes::CHAINS[1],
    &extremes::SPRING_RATIO,
    &extremes::GRAVITY,
    &extremes::SMALL,
    &extremes::LARGE,
    &extremes::NEEDLES[0],
    &extremes::NEEDLES[1],
    &extremes::SLIVER,
    &extremes::SPINNING_DISK,
    &extremes::SPINNING_BOX,
    &extremes::STIFF[0],
    &extremes::STIFF[1],
    &extremes::FAR,
    &extremes::CROWD,
    &extremes::VARYING,
    &extremes::TILES,
    &extremes::REPEAT,
    &extremes::BIN,
    &extremes::FAST,
    &extremes::SPIN,
];

impl Hard {
    /// The step (s) with this number of a run at steps of `dt`.
    #[must_use]
    pub fn step(&self, number: u32, dt: Real) -> Real {
        // Fractional parts of multiples of the golden ratio are spread evenly.
        let part = (Real::from(number) * 0.618_033_988_749_894_9).fract();
        if self.varies { dt * libm::pow(4.0, 2.0 * part - 1.0) } else { dt }
    }

    /// How many steps of `dt` (s) a run takes.
    #[must_use]
    pub fn steps(&self, dt: Real) -> u32 {
        (self.seconds / dt).round() as u32
    }
}
