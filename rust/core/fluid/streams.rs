//! Where particles come from and go: inflows, drains, lifetimes.

use serde::{Deserialize, Serialize};

use super::kernel::SUPPORT;
use super::{FluidHandle, Fluids, Particles};
use crate::error::{Error, Result, check};
use crate::math::{Real, Twist, Vec2};
use crate::shapes::Shape;

/// A nozzle: through a segment flows fluid with one velocity, whatever presses against it. Rows of particles are born a
/// support behind the segment and keep that velocity until they have passed it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inflow {
    /// One end of the segment (m).
    #[schemars(with = "[Real; 2]")]
    pub start: Vec2,
    /// The other (m).
    #[schemars(with = "[Real; 2]")]
    pub end: Vec2,
    /// Velocity (m/s) of what comes out; not along the segment.
    #[schemars(with = "[Real; 2]")]
    pub velocity: Vec2,
    /// Way (m) of the last row since it was born, up to a spacing; none: there was no row yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub progress: Option<Real>,
}

/// Particles that are born at once by one inflow at most.
const MOST_IN_A_ROW: Real = 1e6;

impl Inflow {
    fn validated(self, spacing: Real, what: &str) -> Result<Self> {
        for (key, v) in [("start", self.start), ("end", self.end), ("velocity", self.velocity)] {
            check::finite_vec(&format!("{what}.{key}"), v)?;
        }
        let progress = self.progress.unwrap_or(0.0);
        if !(0.0..=spacing).contains(&progress) {
            return Err(Error::invalid(format!("{what}.progress"), progress, "0 to a spacing"));
        }
        let length = (self.end - self.start).norm();
        check::positive(&format!("{what} (its length)"), length)?;
        if length > MOST_IN_A_ROW * spacing {
            let what = format!("{what} (its length)");
            return Err(Error::invalid(what, length, "at most 10⁶ spacings"));
        }
        if self.speed().is_nan() || self.speed() <= 1e-6 * self.velocity.norm() {
            let allowed = "a velocity across the segment";
            return Err(Error::invalid(format!("{what}.velocity"), self.velocity, allowed));
        }
        Ok(self)
    }

    /// Along the segment, and across it to where it flows.
    fn axes(&self) -> (Vec2, Vec2) {
        let along = (self.end - self.start).normalize();
        let across = crate::math::perp(along);
        (along, if across.dot(&self.velocity) < 0.0 { -across } else { across })
    }

    /// Velocity across the segment (m/s).
    fn speed(&self) -> Real {
        self.axes().1.dot(&self.velocity)
    }

    /// Whether a particle at x has not passed the segment yet.
    fn holds(&self, x: Vec2, spacing: Real) -> bool {
        let (along, across) = self.axes();
        let behind = (self.start - x).dot(&across);
        if !(0.0..=SUPPORT * spacing * (1.0 + 1e-9)).contains(&behind) {
            return false;
        }
        let place = x + self.velocity * (behind / across.dot(&self.velocity));
        (0.0..=(self.end - self.start).norm()).contains(&(place - self.start).dot(&along))
    }

    /// Places of the particles of a row that has gone this far (m) since it was born.
    fn row(&self, spacing: Real, gone: Real) -> impl Iterator<Item = Vec2> + use<> {
        let (along, across) = self.axes();
        let length = (self.end - self.start).norm();
        let count = (length / spacing + 1e-9).floor().max(1.0);
        let first = 0.5 * (length - (count - 1.0) * spacing);
        let back = (SUPPORT * spacing - gone) / across.dot(&self.velocity);
        let start = self.start - self.velocity * back;
        (0..count as u32).map(move |k| start + along * (first + Real::from(k) * spacing))
    }
}

/// What a step changes of how particles come and go.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Streams {
    /// Inflows, each with the fluid it is of.
    inflows: Vec<(u32, Inflow)>,
    /// Number of the next particle.
    pub(super) next: u64,
    /// When particles were born (s): those from this number on, up to that of the next entry.
    pub(super) births: Vec<(u64, Real)>,
}

/// A particle that an inflow holds.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// The particle.
    pub particle: u32,
    /// Its velocity (m/s).
    pub velocity: Vec2,
}

/// Inflows, drains and lifetimes.
impl Fluids {
    /// The inflows of a fluid.
    ///
    /// # Errors
    /// A handle to a fluid that is gone.
    pub fn inflows(&self, fluid: FluidHandle) -> Result<Vec<Inflow>> {
        self.list.get(fluid)?;
        let kind = fluid.slot() as u32;
        let own = self.streams.inflows.iter().filter(|(of, _)| *of == kind);
        Ok(own.map(|(_, inflow)| *inflow).collect())
    }

    /// Sets the inflows of a fluid. One at a segment where there was one goes on from its last row.
    ///
    /// # Errors
    /// Numbers that are not finite, a segment without length or longer than 10⁶ spacings, a velocity along it, a progress of more than a
    /// spacing; a handle to a fluid that is gone.
    pub fn set_inflows(&mut self, fluid: FluidHandle, inflows: &[Inflow]) -> Result<()> {
        let before = self.inflows(fluid)?;
        let mut new = Vec::with_capacity(inflows.len());
        for (i, inflow) in inflows.iter().enumerate() {
            let mut inflow = inflow.validated(self.spacing, &format!("inflows[{i}]"))?;
            let same = |old: &&Inflow| (old.start, old.end) == (inflow.start, inflow.end);
            inflow.progress =
                inflow.progress.or(before.iter().find(same).and_then(|old| old.progress));
            new.push((fluid.slot() as u32, inflow));
        }
        self.forget_inflows(fluid.slot() as u32);
        self.streams.inflows.extend(new);
        Ok(())
    }

    pub(super) fn forget_inflows(&mut self, kind: u32) {
        self.streams.inflows.retain(|(of, _)| *of != kind);
    }

    /// Speed (m/s) of the fastest inflow; 0 without any. Substeps are short enough for it even while none of its particles is there.
    pub(super) fn fastest_inflow(&self) -> Real {
        let speeds = self.streams.inflows.iter().map(|(_, inflow)| inflow.velocity.norm());
        speeds.fold(0.0, Real::max)
    }

    /// Regions, in the frame of the world, whatever particle enters which is removed.
    #[must_use]
    pub fn drains(&self) -> &[Shape] {
        &self.drains
    }

    /// Sets the drains.
    pub fn set_drains(&mut self, drains: Vec<Shape>) {
        self.drains = drains;
    }

    /// Sets how long (s) particles of a fluid are there, counted from when they were added or from when this was set for the
    /// first time; none: for ever.
    ///
    /// # Errors
    /// A time that is not above 0; a handle to a fluid that is gone.
    pub fn set_lifetime(&mut self, fluid: FluidHandle, lifetime: Option<Real>) -> Result<()> {
        let own = self.list.get_mut(fluid)?;
        check::positive("lifetime", lifetime.unwrap_or(1.0))?;
        own.lifetime = lifetime;
        Ok(())
    }

    /// Whether particles come or go.
    #[must_use]
    pub fn streams(&self) -> bool {
        let mortal = || self.list.values().iter().any(|fluid| fluid.lifetime.is_some());
        !self.streams.inflows.is_empty() || !self.drains.is_empty() || mortal()
    }

    /// Notes that particles without a birthday were born at this time (s).
    pub fn date(&mut self, now: Real) {
        let known = self.streams.births.last().map_or(0, |(id, _)| *id);
        let next = self.streams.next;
        if next > known && self.list.values().iter().any(|fluid| fluid.lifetime.is_some()) {
            // An entry says from which number on; the last one is for those to come.
            match self.streams.births.last_mut() {
                Some(last) => last.1 = now,
                None => self.streams.births.push((0, now)),
            }
            self.streams.births.push((next, Real::MAX));
        }
    }

    /// Lets particles come and go at the end of a substep of length h (s) that ends at `now` (s).
    pub fn exchange(&mut self, h: Real, now: Real) {
        self.date(now - h);
        let spacing = self.spacing;
        let Self { particles, streams, .. } = self;
        for (kind, inflow) in &mut streams.inflows {
            let mut gone = inflow.progress.map_or(spacing, |gone| gone + inflow.speed() * h);
            // Rows that were due before this substep's end are where they would be.
            while gone >= spacing {
                gone -= spacing;
                for place in inflow.row(spacing, gone) {
                    particles.push((place, inflow.velocity), *kind, streams.next);
                    streams.next += 1;
                }
            }
            inflow.progress = Some(gone);
        }
        self.date(now);
        if !self.drains.is_empty() {
            let Self { particles, drains, .. } = self;
            let positions = std::mem::take(&mut particles.positions);
            let drained = |x: Vec2| {
                drains.iter().any(|shape| shape.bounds().contains(x) && shape.contains(x))
            };
            let keep: Vec<bool> = positions.iter().map(|x| !drained(*x)).collect();
            particles.positions = positions;
            if keep.contains(&false) {
                particles.retain(|i| keep[i]);
            }
        }
        self.bury(now);
    }

    /// Removes particles whose time is over.
    fn bury(&mut self, now: Real) {
        let Self { particles, streams, list, .. } = self;
        let mut oldest = streams.births.len();
        for (handle, fluid) in list.handles().iter().zip(list.values()) {
            let Some(lifetime) = fluid.lifetime else { continue };
            let over = |(_, born): &(u64, Real)| now - born >= lifetime * (1.0 - 1e-9);
            let first = streams.births.partition_point(over);
            oldest = oldest.min(first);
            let alive = streams.births.get(first).map_or(0, |(id, _)| *id);
            let kind = handle.slot() as u32;
            let Particles { kinds, ids, .. } = &*particles;
            if first > 0 && kinds.iter().zip(ids).any(|(of, id)| *of == kind && *id < alive) {
                let keep: Vec<bool> =
                    kinds.iter().zip(ids).map(|(of, id)| *of != kind || *id >= alive).collect();
                particles.retain(|i| keep[i]);
            }
        }
        streams.births.drain(..oldest.min(streams.births.len()));
    }

    /// The particles that inflows hold.
    pub(super) fn held(&self, held: &mut Vec<Held>) {
        held.clear();
        if self.streams.inflows.is_empty() {
            return;
        }
        for (i, x) in self.particles.positions.iter().enumerate() {
            let by = self.streams.inflows.iter().find(|(_, own)| own.holds(*x, self.spacing));
            held.extend(by.map(|(_, own)| Held { particle: i as u32, velocity: own.velocity }));
        }
    }
}

/// What a step changes of the fluids, to go back to.
#[derive(Clone, Debug, Default)]
pub struct Moving {
    particles: Particles,
    streams: Streams,
    others: Vec<Twist>,
    surface: Option<Real>,
}

impl Moving {
    /// Keeps it.
    pub fn save(&mut self, fluids: &Fluids) {
        self.particles.clone_from(&fluids.particles);
        self.others.clone_from(&fluids.others);
        self.streams.inflows.clone_from(&fluids.streams.inflows);
        self.streams.births.clone_from(&fluids.streams.births);
        self.streams.next = fluids.streams.next;
        self.surface = fluids.surface;
    }

    /// Puts it back.
    pub fn restore(&self, fluids: &mut Fluids) {
        fluids.particles.clone_from(&self.particles);
        fluids.others.clone_from(&self.others);
        fluids.streams.inflows.clone_from(&self.streams.inflows);
        fluids.streams.births.clone_from(&self.streams.births);
        fluids.streams.next = self.streams.next;
        fluids.surface = self.surface;
    }
}
