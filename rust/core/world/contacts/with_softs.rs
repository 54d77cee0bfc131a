//! Groups that hold deformable bodies.

use super::surroundings::{Fields, Still};
use crate::error::Result;
use crate::forces::{Forces, Shown};
use crate::methods::Span;
use crate::methods::contact_step::matter;
use crate::methods::contact_step::{self, Outcome};
use crate::world::soft::members;
use crate::world::{State, World};

impl World {
    /// Moves the group at hand, which holds deformable bodies, through a span.
    pub(super) fn step_group_with_softs(&mut self, span: Span) -> Result<Outcome> {
        self.restore_members();
        let Self { state, scratch, plan, fields, report, .. } = self;
        let State { settings, bodies, contacts, softs, .. } = state;
        let (bodies, contacts) = (&*bodies, &*contacts);
        let how = contact_step::Settings {
            law: settings.impact_law,
            sweeps: settings.sweeps,
            solver: settings.solver,
        };
        let resistance = plan.as_ref().is_some_and(|plan| plan.resistance);
        let mut still = Still { bodies, contacts, air: settings.air, resistance };
        let (mut members, solve) =
            members(softs, (bodies, contacts), settings.gravity, &mut scratch.soft);
        let group = &mut scratch.contacts.group;
        if plan.as_ref().is_none_or(|plan| plan.together == 0) {
            return matter::run(group, span, how, (&mut still, &mut members, solve));
        }
        let forces = Forces {
            handles: &bodies.map,
            masses: &bodies.masses,
            infos: &bodies.infos,
            members: &[],
            steady: &scratch.steady,
            gravity: settings.gravity,
            air: settings.air,
            fields,
            resistance,
            buffers: &mut scratch.forces,
            shown: Shown::default(),
            evaluations: 0,
        };
        let (poses, twists, accelerations) = (Vec::new(), Vec::new(), Vec::new());
        let mut acting = Fields { still, forces, poses, twists, accelerations, before: None };
        let outcome = matter::run(group, span, how, (&mut acting, &mut members, solve));
        report.evaluations += acting.forces.evaluations;
        outcome
    }
}
