//! What happened between shapes during a call: touches that began or ended, hits, and what sensors noticed.

use serde::{Deserialize, Serialize};

use crate::body::BodyHandle;
use crate::math::{Real, Vec2};
use crate::world::World;

/// Something that happened between two shapes.
///
/// The body whose slot is smaller comes first; of a sensor and what it notices, the sensor. A body may have been
/// removed since: its handle is stale then, and asking the world for it is an error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactEvent {
    /// World time (s): of hits, the moment in the step; of all else, the end of the step that noticed it, or the moment where
    /// a run to a tolerance went from event to event.
    pub time: Real,
    /// A and B.
    pub bodies: [BodyHandle; 2],
    /// Which shape of each, counted from 0.
    pub parts: [usize; 2],
    /// Where they touch (m). Of beginnings and hits.
    pub point: Option<Vec2>,
    /// Unit vector from A to B there. Of beginnings and hits.
    pub normal: Option<Vec2>,
    /// How fast they came together along the normal (m/s). Of hits; 0 else.
    pub approach_speed: Real,
    /// Along the normal (N·s): of a hit, all it took; of a beginning, that of the last substep; 0 else.
    pub impulse: Real,
}

/// What happened during a call, in the order of time; of one step, in an order that only the scene decides.
///
/// Two shapes touch while they press on one another or leave no gap. Of a shape in several pieces (a chain, a
/// concave polygon) it counts once, whatever piece is touched. For each two shapes beginnings and ends take turns. A
/// touch ends, too, when a body is removed, when a shape or a filter changes so that they no longer meet, or
/// when something lets them pass; the next call says so. What touches and leaves within one step is only a hit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Events {
    /// Shapes that began to touch.
    pub begin: Vec<ContactEvent>,
    /// Shapes that no longer touch.
    pub end: Vec<ContactEvent>,
    /// Impacts, and new contacts that came faster than the forces of a substep make them. Those of two shapes within
    /// one step count as one: their impulses are summed, time, place and speed are those of the fastest.
    pub hit: Vec<ContactEvent>,
    /// Shapes that a sensor began to overlap. Sensors do not notice sensors.
    pub sensor_begin: Vec<ContactEvent>,
    /// Shapes that a sensor no longer overlaps.
    pub sensor_end: Vec<ContactEvent>,
}

impl Events {
    /// Forgets all and keeps the memory.
    pub(in crate::world) fn clear(&mut self) {
        self.lists().into_iter().for_each(Vec::clear);
    }

    /// Whether nothing happened.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let lists = [&self.begin, &self.end, &self.hit, &self.sensor_begin, &self.sensor_end];
        lists.into_iter().all(Vec::is_empty)
    }

    /// Adds what happened after.
    pub fn append(&mut self, mut later: Self) {
        for (list, later) in self.lists().into_iter().zip(later.lists()) {
            list.append(later);
        }
    }

    fn lists(&mut self) -> [&mut Vec<ContactEvent>; 5] {
        let Self { begin, end, hit, sensor_begin, sensor_end } = self;
        [begin, end, hit, sensor_begin, sensor_end]
    }
}

/// What happened.
impl World {
    /// What happened between shapes during the last call that moved the world on; nothing if it failed.
    #[must_use]
    pub fn events(&self) -> &Events {
        &self.events
    }

    /// Has [`World::events`] tell these until the next call: those of several calls that are one to the user.
    pub fn set_events(&mut self, events: Events) {
        self.events = events;
    }
}
