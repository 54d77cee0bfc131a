//! What the scene contains, hence which stages run and how each body moves. Rebuilt only when the
//! content changes.

use std::fmt::Write as _;
use std::ops::Range;

use rustc_hash::FxHashSet;

use crate::body::{BodyKind, Info};
use crate::forces::has_drag;
use crate::math::Wrench;
use crate::world::joints::{index_of, tied};
use crate::world::{State, World};

/// How the bodies of a world move. Indices are places in body order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Bodies that move with a given velocity, and free bodies under constant forces: closed form.
    pub(super) closed: Vec<usize>,
    /// The same with damping, whose closed form costs more and reads what stands apart.
    pub(super) damped: Vec<usize>,
    /// Bodies that each move by a method, by themselves.
    pub(super) single: Vec<usize>,
    /// A field acts: all bodies, this many, move by a method, together.
    pub(super) together: usize,
    /// Air or damping acts on a body that a method moves.
    pub(super) resistance: bool,
    /// Some body has a constant force.
    pub(super) forces: bool,
    /// Bodies that move and have shapes, where there is anything they can meet.
    pub(super) colliding: Vec<u32>,
    /// Number of joints that do anything.
    pub(super) joints: usize,
    /// Number of deformable bodies.
    pub(super) softs: usize,
    /// Who meets whom.
    pub(super) meeting: Meeting,
}

/// Who meets whom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Meeting {
    /// Nobody.
    #[default]
    Apart,
    /// Bodies may meet.
    Bodies,
    /// There is a fluid.
    Fluid,
}

impl Plan {
    pub(super) fn new(state: &State, fields: usize) -> Self {
        let State { bodies, settings, contacts, .. } = state;
        let mut plan = Self {
            together: if fields > 0 { bodies.len() } else { 0 },
            forces: bodies.forces.iter().any(|wrench| *wrench != Wrench::ZERO),
            ..Self::default()
        };
        for (i, info) in bodies.infos.iter().enumerate().filter(|(i, _)| !contacts.is_asleep(*i)) {
            plan.resistance |= has_drag(info, settings.air) || is_damped(info);
            let dynamic = info.def.kind == BodyKind::Dynamic;
            let constant = settings.closed_form && !has_drag(info, settings.air);
            match info.def.kind {
                BodyKind::Static => {}
                _ if plan.together > 0 => {}
                _ if !dynamic => plan.closed.push(i),
                _ if constant && is_damped(info) => plan.damped.push(i),
                _ if constant => plan.closed.push(i),
                _ => plan.single.push(i),
            }
        }
        let ties = |joint: &&crate::joint::Joint| tied(bodies, joint).is_some();
        plan.joints = state.joints.values().iter().filter(ties).count() + state.softs.joints.len();
        plan.softs = state.softs.bodies.values().len();
        if contacts.touchable() > usize::from(plan.softs == 0) {
            let moving = (0..bodies.len()).filter(|i| {
                bodies.infos[*i].def.kind != BodyKind::Static && !contacts.is_asleep(*i)
            });
            plan.colliding.extend(moving.filter(|i| contacts.can_touch(*i)).map(|i| i as u32));
        }
        plan.meeting = if !state.fluids.list.values().is_empty() {
            Meeting::Fluid
        } else if plan.colliding.is_empty() && plan.softs == 0 {
            Meeting::Apart
        } else {
            Meeting::Bodies
        };
        plan
    }

    /// Whether bodies can meet, or give way.
    pub(super) fn meets(&self) -> bool {
        !self.colliding.is_empty() || self.softs > 0
    }

    /// Whether bodies may come to rest and be left out: not where all move together, or where a fluid moves.
    pub(super) fn may_rest(&self) -> bool {
        let ties = !self.colliding.is_empty() || self.joints > 0;
        self.together == 0 && self.meeting != Meeting::Fluid && ties
    }

    /// Every body that moves.
    pub(super) fn moving(&self) -> impl Iterator<Item = usize> {
        self.closed.iter().chain(&self.damped).copied().chain(self.runs().flatten())
    }

    /// The runs of bodies that a method moves, each an island of its own.
    pub(super) fn runs(&self) -> impl Iterator<Item = Range<usize>> {
        let together = (self.together > 0).then_some(0..self.together);
        together.into_iter().chain(self.single.iter().map(|&i| i..i + 1))
    }
}

/// Pairs of bodies that a joint keeps from touching each other.
fn kept_apart(state: &State) -> FxHashSet<[u32; 2]> {
    let apart = state.joints.values().iter().filter(|joint| !joint.def.collide_connected);
    let pairs = apart.filter_map(|joint| {
        let pair = [0, 1].map(|side| index_of(&state.bodies, joint, side));
        let [Some(i), Some(j)] = pair else { return None };
        Some([i.min(j) as u32, i.max(j) as u32])
    });
    pairs.collect()
}

fn is_damped(info: &Info) -> bool {
    info.def.linear_damping > 0.0 || info.def.angular_damping > 0.0
}

fn count(n: usize) -> String {
    format!("{n} {}", if n == 1 { "body" } else { "bodies" })
}

/// How joints move what they tie; `by` is what the world's method does with it, if it does.
fn explain_joints(plan: &Plan, by: Option<&str>, line: &mut dyn FnMut(&str, &str)) {
    if plan.joints == 0 {
        return;
    }
    let joints = if plan.joints == 1 { "joint" } else { "joints" };
    let what = match by {
        None => "what they tie moves together, by the contact step".into(),
        Some(name) => format!(
            "what they tie moves together, by {name}; where something touches or a joint has a bound (limits, motors, largest \
             forces, breaking), by the contact step"
        ),
    };
    line("advance", &format!("{} {joints}: {what}", plan.joints));
}

/// How deformable bodies move.
fn explain_softs(plan: &Plan, line: &mut dyn FnMut(&str, &str)) {
    if plan.softs > 0 {
        let bodies = if plan.softs == 1 { "body" } else { "bodies" };
        let what = format!("{} deformable {bodies}, by the midpoint rule", plan.softs);
        line("advance", &format!("{what}; what touches them with them, by the contact step"));
    }
}

/// What is done about fluids.
fn explain_fluid(plan: &Plan, particles: usize, line: &mut dyn FnMut(&str, &str)) {
    if plan.meeting == Meeting::Fluid {
        let what =
            "in substeps of their own, in each of which pressures and all above are found in turn";
        line("fluid", &format!("{particles} particles: {what}"));
    }
}

impl World {
    pub(super) fn planned(&mut self) -> &Plan {
        let Self { plan, state, fields, scratch, .. } = self;
        plan.get_or_insert_with(|| {
            // Groups of bodies that may be gone.
            scratch.contacts.forget();
            scratch.joined.forget();
            scratch.wet.forget();
            state.contacts.apart = kept_apart(state);
            Plan::new(state, fields.len())
        })
    }

    fn explain_sleep(&self, plan: &Plan, line: &mut dyn FnMut(&str, &str)) {
        if !self.state.settings.sleeping {
            return;
        }
        if plan.meeting == Meeting::Fluid {
            line("sleep", "not while there is a fluid");
        } else if plan.together > 0 {
            line("sleep", "not while fields act");
        } else {
            line("sleep", &format!("{} asleep", count(self.asleep())));
        }
    }

    /// Names of the stages that a step of this world runs now, in their order, as `explain` and the times of a report have them.
    #[must_use]
    pub fn stages(&self) -> Vec<&'static str> {
        let plan = Plan::new(&self.state, self.fields.len());
        let (meets, joins) = (plan.meets(), plan.joints > 0);
        let wades = plan.meeting == Meeting::Fluid;
        let all = [
            ("plan", true),
            ("fluid", wades),
            ("detect", meets && !wades),
            ("islands", (meets || joins) && !wades),
            ("advance", !wades),
            ("events", meets || self.state.contacts.touching.changed()),
            ("joints", joins),
            ("report", true),
            ("sleep", self.state.settings.sleeping && plan.may_rest()),
        ];
        all.into_iter().filter(|(_, runs)| *runs).map(|(name, _)| name).collect()
    }

    /// The stages a step of this world runs, which bodies each moves and how, and the time of each in
    /// the last run, if `timing` is on. What is not listed is not run, and not paid for.
    #[must_use]
    pub fn explain(&self) -> String {
        let settings = &self.state.settings;
        let plan = Plan::new(&self.state, self.fields.len());
        let by_method =
            format!("{}, {} substeps a step", self.method.facts().name, settings.substeps);
        let mut text = String::from("a step:\n");
        let mut line = |stage: &str, what: &str| {
            // OK because writing to a String cannot fail.
            let _ = writeln!(text, "  {stage:<8} {what}");
        };
        if !plan.colliding.is_empty() {
            let pairs = self.state.contacts.near.len();
            let moving = count(plan.colliding.len());
            line(
                "detect",
                &format!("{moving} that can meet others; {pairs} pairs near one another"),
            );
            line(
                "islands",
                "what touches moves together, by the contact step instead of the below",
            );
        }
        explain_softs(&plan, &mut line);
        let facts = self.method.facts();
        explain_joints(&plan, facts.joints.then_some(facts.name), &mut line);
        for (bodies, how) in [(&plan.closed, ""), (&plan.damped, " and damping")] {
            if !bodies.is_empty() {
                let how = format!("closed form, exact at any step (constant forces{how})");
                line("advance", &format!("{}: {how}", count(bodies.len())));
            }
        }
        if !plan.single.is_empty() {
            let air = if settings.air.density > 0.0 { ", air drag" } else { "" };
            line(
                "advance",
                &format!("{}, each by itself: {by_method}{air}", count(plan.single.len())),
            );
        }
        if plan.together > 0 {
            let names: Vec<_> = self.fields.iter().map(|field| field.name()).collect();
            let all = count(plan.together);
            line("advance", &format!("{all} together: {by_method}; fields: {}", names.join(", ")));
        }
        if !self.state.schedules.values().is_empty() {
            line("advance", "split where a scheduled force changes");
        }
        explain_fluid(&plan, self.state.fluids.particles.len(), &mut line);
        let fixed =
            plan.closed.is_empty() && plan.damped.is_empty() && plan.runs().next().is_none();
        if fixed && plan.softs == 0 && plan.meeting != Meeting::Fluid {
            line("advance", "nothing moves");
        }
        self.explain_sleep(&plan, &mut line);
        line("report", "finite check, counters");
        if !plan.meets() {
            line("not run", "detection: nothing here can collide");
        }
        for stage in &self.report.stages {
            line("time", &format!("{:<8} {:.3e} s in the last run", stage.name, stage.seconds));
        }
        text
    }
}
