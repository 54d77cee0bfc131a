//! Real time to fixed steps.

use crate::error::{Error, Result, check};
use crate::math::Real;
use crate::world::World;

/// Turns the time between frames into whole steps: a fixed number of ticks a second, a time scale, a
/// cap on how many are caught up at once, and the fraction of a tick that is left, to draw in between.
///
/// ```
/// use culbuto::{World, world::Stepper};
/// let mut world = World::default();
/// let mut clock = Stepper::new(100.0)?;
/// let frame = clock.frame(&mut world, 0.025)?; // 25 ms since the last frame
/// assert_eq!(frame.ticks, 2);
/// assert!((frame.fraction - 0.5).abs() < 1e-9);
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stepper {
    tick: Real,
    time_scale: Real,
    most_ticks: u32,
    waiting: Real,
}

/// What a frame amounted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Steps taken.
    pub ticks: u32,
    /// Part of the next step that has passed, 0 to 1: draw at old + fraction·(new − old).
    pub fraction: Real,
    /// Time (s, scaled) given up because the cap was reached.
    pub dropped: Real,
}

impl Stepper {
    /// A clock with this many ticks a second; time scale 1, at most 8 ticks a frame.
    pub fn new(ticks_per_second: Real) -> Result<Self> {
        let tick = 1.0 / check::positive("ticks_per_second", ticks_per_second)?;
        check::positive("1 / ticks_per_second", tick)?;
        Ok(Self { tick, time_scale: 1.0, most_ticks: 8, waiting: 0.0 })
    }

    /// Length of a tick (s).
    #[must_use]
    pub fn tick(&self) -> Real {
        self.tick
    }

    /// How much faster than real time the world runs.
    #[must_use]
    pub fn time_scale(&self) -> Real {
        self.time_scale
    }

    /// Sets how much faster than real time the world runs; 0 pauses it.
    pub fn set_time_scale(&mut self, scale: Real) -> Result<()> {
        self.time_scale = check::not_negative("time_scale", scale)?;
        Ok(())
    }

    /// Most ticks that a frame catches up.
    #[must_use]
    pub fn most_ticks(&self) -> u32 {
        self.most_ticks
    }

    /// Sets the most ticks that a frame catches up (1 or more); what is beyond is given up.
    pub fn set_most_ticks(&mut self, ticks: u32) -> Result<()> {
        if ticks == 0 {
            return Err(Error::invalid("most_ticks", ticks, "1 or more"));
        }
        self.most_ticks = ticks;
        Ok(())
    }

    /// Takes the real time since the last frame (s) and steps the world as often as a tick's worth
    /// has come together. Time that a failed step would have used stays waiting.
    pub fn frame(&mut self, world: &mut World, elapsed: Real) -> Result<Frame> {
        check::not_negative("elapsed", elapsed)?;
        let waiting = check::finite("elapsed", self.waiting + elapsed * self.time_scale)?;
        // A frame of exactly a tick must not wait for the next because of a rounding.
        let due = (waiting / self.tick + 1e-9).floor();
        let ticks = due.min(Real::from(self.most_ticks));
        if ticks > 0.0 {
            world.steps(self.tick, ticks as u32)?;
        }
        self.waiting = (waiting - due * self.tick).max(0.0);
        Ok(Frame {
            ticks: ticks as u32,
            fraction: (self.waiting / self.tick).min(1.0),
            dropped: (due - ticks) * self.tick,
        })
    }
}
