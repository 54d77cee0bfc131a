//! What a scene file says of fluids beyond where particles are, so that a world made from it goes on to the same bits.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Fluids, Particles};
use crate::error::{Error, Result, check};
use crate::math::{Real, Twist, Vec2};

/// What the next substep begins with. Lists are by particle, in the order of the world's columns, unless said otherwise.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// Which particle it is, counted through the fluids, oldest first.
    order: Vec<u32>,
    /// Numbers that tell older from younger ones.
    ids: Vec<u64>,
    /// Pressures (Pa) that keep the density.
    pressures: Vec<Real>,
    /// Pressures (Pa) that keep the divergence.
    relaxing: Vec<Real>,
    /// Densities over those at rest.
    compressions: Vec<Real>,
    /// Number of the next particle.
    next: u64,
    /// From which particle on they were born when (s).
    births: Vec<(u64, Real)>,
    /// What all but the fluids did to each body in the last substep, a second (m/s², m/s², rad/s²).
    others: Vec<[Real; 3]>,
    /// Energy (J) of the surfaces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<Real>,
}

impl Fluids {
    /// Places of all particles in the columns, fluid by fluid, oldest first.
    fn places(&self) -> Vec<usize> {
        let kinds = self.list.handles().iter().map(|handle| handle.slot() as u32);
        kinds.flat_map(|kind| self.particles.of(kind)).collect()
    }

    /// What is to be kept.
    #[must_use]
    pub fn kept(&self) -> Kept {
        let mut order = vec![0; self.particles.len()];
        self.places().into_iter().enumerate().for_each(|(k, place)| order[place] = k as u32);
        let Particles { ids, pressures, relaxing, compressions, .. } = self.particles.clone();
        let flat = |own: &Twist| [own.linear.x, own.linear.y, own.angular];
        Kept {
            order,
            ids,
            pressures,
            relaxing,
            compressions,
            next: self.streams.next,
            births: self.streams.births.clone(),
            others: self.others.iter().map(flat).collect(),
            surface: self.surface,
        }
    }

    /// Goes on from what was kept of these particles.
    ///
    /// # Errors
    /// Lists of wrong lengths, an order that is none, numbers that are not finite.
    pub fn resume(&mut self, kept: &Kept, bodies: usize) -> Result<()> {
        let n = self.particles.len();
        kept.check(n, bodies)?;
        let places = self.places();
        let before = self.particles.clone();
        for (k, of) in kept.order.iter().enumerate() {
            let from = places[*of as usize];
            self.particles.positions[k] = before.positions[from];
            self.particles.velocities[k] = before.velocities[from];
            self.particles.kinds[k] = before.kinds[from];
        }
        self.particles.ids.clone_from(&kept.ids);
        self.particles.pressures.clone_from(&kept.pressures);
        self.particles.relaxing.clone_from(&kept.relaxing);
        self.particles.compressions.clone_from(&kept.compressions);
        self.streams.next = kept.next;
        self.streams.births.clone_from(&kept.births);
        let twist = |[x, y, turn]: &[Real; 3]| Twist::new(Vec2::new(*x, *y), *turn);
        self.others = kept.others.iter().map(twist).collect();
        self.surface = kept.surface;
        Ok(())
    }
}

impl Kept {
    fn check(&self, particles: usize, bodies: usize) -> Result<()> {
        let Self { order, ids, pressures, relaxing, compressions, others, .. } = self;
        let lengths = [
            ("order", order.len()),
            ("ids", ids.len()),
            ("pressures", pressures.len()),
            ("relaxing", relaxing.len()),
            ("compressions", compressions.len()),
        ];
        for (key, length) in lengths {
            if length != particles {
                let got = format!("{length} entries");
                return Err(Error::invalid(key, got, format!("{particles}, one a particle")));
            }
        }
        if !others.is_empty() && others.len() != bodies {
            let got = format!("{} entries", others.len());
            return Err(Error::invalid("others", got, format!("{bodies}, one a body, or none")));
        }
        let mut seen = vec![false; particles];
        for &k in order {
            let once = seen.get_mut(k as usize).filter(|seen| !**seen);
            *once.ok_or_else(|| Error::invalid("order", k, "each particle once"))? = true;
        }
        for (key, list) in [("pressures", pressures), ("relaxing", relaxing)] {
            list.iter().try_for_each(|p| check::not_negative(key, *p).map(drop))?;
        }
        let numbers = compressions.iter().chain(others.as_flattened()).chain(&self.surface);
        numbers.into_iter().try_for_each(|x| check::finite("compressions", *x).map(drop))?;
        if let Some(id) = ids.iter().find(|id| **id >= self.next) {
            return Err(Error::invalid(
                "next",
                self.next,
                format!("above {id}, that of a particle"),
            ));
        }
        Ok(())
    }
}
