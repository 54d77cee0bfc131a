//! The stage that moves what touches: each group of bodies that contacts tie by the contact step.

use rustc_hash::FxHashMap;

use super::hooks::Answer;
use super::order::{Rank, upwards};
use super::surroundings::{Fields, Still};
use super::view::{place_of, seen};
use super::{Contacts, FAR, Patch};
use crate::body::Bodies;
use crate::collision::{Anchor, Collider, Manifold, Normal};
use crate::constraints::contact::{Block, Touch, moved};
use crate::constraints::{Place, Velocity};
use crate::error::Result;
use crate::forces::{Forces, Shown};
use crate::islands::Islands;
use crate::math::{Real, Rot, Twist, Vec2, Wrench, perp};
use crate::methods::Span;
use crate::methods::contact_step::newton::Together;
use crate::methods::contact_step::{
    self, Group, Link, Mass, Outcome, Surroundings, Watched, matter,
};
use crate::solvers::links::LinkSolver;
use crate::world::joints::{index_of, is_smooth, keep, tie, tied};
use crate::world::soft::{keep as keep_ties, members, take_ends};
use crate::world::{State, World};

/// Columns of the stage; kept between steps so that a warm step allocates nothing.
#[derive(Clone, Default)]
pub(in crate::world) struct ContactScratch {
    pub found: Vec<Manifold>,
    islands: Islands,
    links: Vec<[u32; 2]>,
    /// Patches of the first links, and the order in which they are swept: those that bear a load before those that do not, both from
    /// above down.
    solid: Vec<u32>,
    ranks: Vec<(bool, Rank, u32)>,
    /// Joints of the others.
    joined: Vec<u32>,
    /// Whether groups of smooth joints in which nothing touches are left to a method.
    pub methods: bool,
    /// The groups that are left to it; none told of: none.
    left: Vec<bool>,
    /// Groups that are not are moved from event to event.
    pub by_events: Option<super::ByEvents>,
    /// Pairs of shapes with joins that show no features to one another now and may do so on the way.
    pub bare: Vec<u32>,
    /// Solvers of the groups with joints, by the first of those: they know its graph.
    solvers: FxHashMap<u32, LinkSolver>,
    /// Systems of all rows of the groups that need one, by their first bodies.
    systems: FxHashMap<u32, Together>,
    pub(super) group: Group,
    /// Slot of each body in the group at work; valid where the mark is the group's.
    slots: Vec<(u32, u32)>,
    mark: u32,
    /// Bodies that are moved in groups.
    moved: Vec<bool>,
    /// What the hooks said of each patch; empty where there are none.
    pub answers: Vec<Answer>,
    /// When the step began (s).
    pub start: Real,
    /// Some body may bounce or moves far in a step.
    pub watched: bool,
    /// Bodies that were thrown so that they may have met what was not looked for, and how far (m).
    pub thrown: Vec<(u32, Real)>,
}

impl ContactScratch {
    /// Whether a body is moved in a group.
    pub fn moves(&self, body: usize) -> bool {
        self.moved.get(body).copied().unwrap_or(false)
    }

    /// Number of groups.
    pub fn groups(&self) -> usize {
        self.islands.len()
    }

    /// Bodies of the links of a group.
    pub fn links_of(&self, k: usize) -> impl Iterator<Item = [u32; 2]> {
        self.islands.group(k).iter().map(|link| self.links[*link as usize])
    }

    /// Patches of all groups, as they are gone through.
    pub fn patches(&self) -> impl Iterator<Item = u32> + Clone {
        let links = (0..self.groups()).flat_map(|k| self.islands.group(k));
        links.filter_map(|link| self.solid.get(*link as usize).copied())
    }

    /// Patches of a group, and the bodies of each.
    pub fn patches_of(&self, k: usize) -> impl Iterator<Item = (u32, [u32; 2])> {
        self.islands.group(k).iter().filter_map(|link| {
            let place = self.solid.get(*link as usize)?;
            Some((*place, self.links[*link as usize]))
        })
    }

    /// Joints of a group.
    pub fn joints_of(&self, k: usize) -> impl Iterator<Item = u32> {
        let first = self.solid.len();
        self.islands.group(k).iter().filter_map(move |link| {
            (*link as usize).checked_sub(first).and_then(|joint| self.joined.get(joint).copied())
        })
    }

    /// Whether a group is left to a method.
    pub fn leaves(&self, k: usize) -> bool {
        self.left.get(k).copied().unwrap_or(false)
    }

    /// Whether any group is.
    pub fn leaves_any(&self) -> bool {
        self.left.contains(&true)
    }

    /// Whether there is nothing for the contact step to do.
    pub fn is_idle(&self) -> bool {
        (0..self.groups()).all(|k| self.leaves(k))
    }

    /// Begins a split: no links, and no body is moved in a group. Fields move all.
    fn begin(&mut self, bodies: usize, fields: bool) {
        // What was marked in the last step, so that those that sleep cost nothing.
        for i in self.links.drain(..).flatten() {
            self.moved.get_mut(i as usize).into_iter().for_each(|moved| *moved = false);
        }
        self.solid.clear();
        self.ranks.clear();
        if fields {
            self.moved.clear();
        }
        self.moved.resize(bodies, false);
        self.thrown.clear();
    }

    /// Links what touches or may touch.
    fn link_contacts(&mut self, state: &State) {
        let State { bodies, contacts, .. } = state;
        let up = upwards(state.settings.gravity);
        for near in contacts.near.iter().filter(|near| near.count > 0 && near.resists()) {
            let pair = near.proxies.map(|proxy| contacts.body_of(proxy));
            let rank = contacts.rank(near, bodies, up);
            for place in near.patches() {
                if self.answers.get(place).is_some_and(|answer| !answer.on) {
                    continue;
                }
                self.links.push(pair);
                self.solid.push(place as u32);
                // What bore nothing comes last: eight that are idle cost little, one among seven that are not as much as
                // those.
                let idle = !contacts.patches[place].bears();
                self.ranks.push((idle, rank, place as u32 - near.first));
                for i in pair.map(|i| i as usize) {
                    let asleep = contacts.is_asleep(i);
                    self.moved[i] = bodies.masses[i].is_free() && !asleep;
                    // One that strikes a sleeping one takes the step again.
                    self.watched |= asleep;
                }
                self.watched |= near.touch.restitution > 0.0;
            }
        }
    }

    /// Forgets the groups, where there is nothing to look for.
    pub fn forget(&mut self) {
        self.islands.clear();
        self.moved.clear();
        self.solvers.clear();
        self.systems.clear();
    }
}

impl World {
    /// Splits what touches or is joined into groups.
    pub(in crate::world) fn find_islands(&mut self) {
        let Self { state, scratch, plan, .. } = self;
        let meets = plan.as_ref().is_some_and(|plan| !plan.colliding.is_empty());
        let (contacts, masses) = (&state.contacts, &state.bodies.masses);
        let gives_way = |i: u32| masses[i as usize].is_free() && !contacts.is_asleep(i as usize);
        let fields = plan.as_ref().is_some_and(|plan| plan.together > 0);
        scratch.contacts.begin(masses.len(), fields);
        scratch.contacts.watched = contacts.far;
        if meets {
            scratch.contacts.link_contacts(state);
        }
        let ContactScratch { islands, links, ranks, joined, moved, .. } = &mut scratch.contacts;
        joined.clear();
        for (place, joint) in state.joints.values().iter().enumerate() {
            let Some(pair) = tied(&state.bodies, joint) else { continue };
            if pair.iter().any(|i| gives_way(*i)) {
                links.push(pair);
                joined.push(place as u32);
                pair.iter().for_each(|i| moved[*i as usize] = gives_way(*i));
            }
        }
        let softs = plan.as_ref().map_or(0, |plan| plan.softs);
        if softs > 0 {
            let mark = |i: u32| moved[i as usize] = gives_way(i);
            scratch.soft.add_links(&state.softs, masses.len(), links, mark);
        }
        // Fields act on all bodies at once, which then are one group.
        let together = fields && !links.is_empty();
        if together {
            moved.fill(true);
            islands.unite_all(links.len());
        } else if softs > 0 {
            let ties = |i: u32| i as usize >= masses.len() || gives_way(i);
            islands.split(masses.len() + softs, links, ties);
        } else {
            islands.split(masses.len(), links, gives_way);
        }
        if !ranks.is_empty() {
            islands.arrange(ranks.len(), |link| ranks[link as usize]);
        }
        self.leave_to_method();
    }

    /// Chooses the groups that are left to a method: those of smooth joints in which nothing touches.
    fn leave_to_method(&mut self) {
        let State { bodies, joints, .. } = &self.state;
        let ContactScratch { islands, solid, joined, methods, left, .. } =
            &mut self.scratch.contacts;
        left.clear();
        if !*methods || joined.is_empty() {
            return;
        }
        let smooth = |link: &u32| {
            let joint = (*link as usize).checked_sub(solid.len());
            let joint = joint.and_then(|k| joined.get(k));
            joint.is_some_and(|k| is_smooth(bodies, &joints.values()[*k as usize]))
        };
        left.extend((0..islands.len()).map(|k| islands.group(k).iter().all(smooth)));
    }

    /// Moves every group through a span.
    pub(in crate::world) fn advance_contacts(&mut self, span: Span) -> Result<()> {
        if self.scratch.contacts.islands.is_empty() {
            return Ok(());
        }
        if self.plan.as_ref().is_some_and(|plan| !plan.colliding.is_empty()) {
            self.state.contacts.scale_impulses(span.h());
        }
        let ContactScratch { islands, systems, .. } = &mut self.scratch.contacts;
        if systems.len() > 2 * islands.len() + SPARE {
            systems.clear();
        }
        let softs = self.has_softs();
        if softs {
            self.begin_grips();
        }
        for k in 0..self.scratch.contacts.islands.len() {
            if !self.scratch.contacts.leaves(k) {
                self.advance_group(k, span)?;
            }
        }
        if softs {
            self.end_grips(span);
        }
        Ok(())
    }

    /// Takes the solvers that belong to the group, or new ones.
    fn take_solver(
        group: &mut Group,
        (solvers, systems): (&mut FxHashMap<u32, LinkSolver>, &mut FxHashMap<u32, Together>),
    ) {
        group.together = None;
        if let Some(first) = group.bodies.first().filter(|_| !systems.is_empty()) {
            group.together = systems.remove(first);
        }
        if let Some(first) = group.ties.list.first() {
            group.ties.solver = solvers.remove(&first.place).unwrap_or_default();
        }
    }

    pub(super) fn keep_solver(&mut self) {
        let ContactScratch { group, solvers, systems, .. } = &mut self.scratch.contacts;
        if let Some(system) = group.together.take() {
            systems.insert(group.bodies[0], system);
        }
        if let Some(first) = group.ties.list.first() {
            solvers.insert(first.place, std::mem::take(&mut group.ties.solver));
        }
    }

    /// Fills the group with the bodies, contacts and joints of island k.
    pub(super) fn gather(&mut self, k: usize, span: Span) {
        let Self { state, scratch, plan, .. } = self;
        let State { bodies, settings, contacts, joints, .. } = state;
        let steady = &scratch.steady;
        let ContactScratch {
            islands,
            links,
            solid,
            joined,
            group,
            slots,
            mark,
            answers,
            solvers,
            systems,
            ..
        } = &mut scratch.contacts;
        group.clear();
        let members = &mut scratch.soft.members;
        members.clear();
        *mark = mark.wrapping_add(1);
        slots.resize(bodies.len(), (0, 0));
        let (h, gravity) = (span.h(), settings.gravity);
        let mut slot_of = |group: &mut Group, body: u32| {
            let entry = &mut slots[body as usize];
            if entry.0 != *mark {
                *entry = (*mark, group.bodies.len() as u32);
                let steady = steady.get(body as usize).copied().unwrap_or(Wrench::ZERO);
                add_body(group, (bodies, contacts), body, (gravity, steady));
            }
            entry.1
        };
        if plan.as_ref().is_some_and(|plan| plan.together > 0) {
            for body in 0..bodies.len() as u32 {
                slot_of(group, body);
            }
        }
        for link in islands.group(k) {
            let pair = links[*link as usize];
            let Some(place) = solid.get(*link as usize).copied() else {
                let Some(place) = joined.get(*link as usize - solid.len()).copied() else {
                    take_ends(pair, bodies.len(), members, |i| slot_of(group, i));
                    continue;
                };
                let joint = &joints.values()[place as usize];
                let ends = [0, 1].map(|side| {
                    let body = index_of(bodies, joint, side)?;
                    Some(slot_of(group, body as u32))
                });
                group.ties.list.push(tie(bodies, (joint, place), ends, h));
                continue;
            };
            let slots = pair.map(|body| slot_of(group, body));
            let answer = answers.get(place as usize);
            let (touch, link) = link_of((bodies, contacts), (place, pair), answer, span);
            group.driven |= touch.tangent_speed != 0.0;
            let memory = contacts.patches[place as usize].memory.scaled(h / contacts.substep);
            let block = Block::new(slots, &link.manifold, &touch, &memory);
            group.add_contact(block, link);
        }
        Self::take_solver(group, (solvers, systems));
    }

    pub(super) fn step_group(&mut self, span: Span) -> Result<Outcome> {
        let gives_way = !self.scratch.soft.members.is_empty();
        if gives_way {
            self.restore_members();
        }
        let Self { state, scratch, plan, fields, report, .. } = self;
        let State { settings, bodies, contacts, softs, joints, .. } = state;
        let how = contact_step::Settings {
            law: settings.impact_law,
            sweeps: settings.sweeps,
            solver: settings.solver,
        };
        let resistance = plan.as_ref().is_some_and(|plan| plan.resistance);
        let (bodies, contacts) = (&*bodies, &*contacts);
        let mut around = Still { bodies, contacts, air: settings.air, resistance };
        let (gravity, soft) = (settings.gravity, &mut scratch.soft);
        let group = &mut scratch.contacts.group;
        let mut soft = gives_way
            .then(|| members(softs, (bodies, contacts), (joints, group, span), (gravity, soft)));
        let mut run = |around: &mut dyn Surroundings| match &mut soft {
            None => contact_step::run(group, span, how, around),
            Some((members, solve)) => {
                let outcome = matter::run(group, span, how, (around, members, solve));
                keep_ties(joints, &solve.ties, (span.duration, span.h()));
                outcome
            }
        };
        if plan.as_ref().is_none_or(|plan| plan.together == 0) {
            return run(&mut around);
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
        let mut acting = Fields {
            still: around,
            forces,
            poses: Vec::new(),
            twists: Vec::new(),
            accelerations: Vec::new(),
            before: None,
        };
        let outcome = run(&mut acting);
        report.evaluations += acting.forces.evaluations;
        outcome
    }

    /// Brings the group's motion and impulses back to the columns.
    pub(super) fn scatter(&mut self, outcome: Outcome, span: Span) {
        let Self { state, scratch, report, events, plan, .. } = self;
        // Fields book the work of steady forces with their own, and no one else moves the bodies then.
        let together = plan.as_ref().is_some_and(|plan| plan.together > 0);
        let State { bodies, contacts, joints, ledger, .. } = state;
        let group = &scratch.contacts.group;
        keep(joints.values_mut(), group, (span.duration, span.h()));
        // Before the bodies move: hits are told from where they were.
        contacts.book_hits(bodies, group, span, &mut events.hit);
        for (slot, body) in group.bodies.iter().enumerate() {
            let (i, velocity, place) =
                (*body as usize, &group.velocities[slot], &group.places[slot]);
            if velocity.is_fixed() && !together {
                continue;
            }
            bodies.twists[i] = velocity.twist;
            bodies.poses[i].position += place.way;
            bodies.poses[i].angle += place.turn;
            if let Some(steady) = scratch.steady.get(i).filter(|_| !together) {
                let way = Twist::new(place.way, place.turn);
                ledger.work += crate::forces::power(steady, &way, &bodies.masses[i]);
            }
        }
        for (block, link) in group.blocks.iter().zip(&group.links) {
            let memory = block.memory(link.credit).scaled(contacts.substep / span.h());
            contacts.patches[link.place as usize].memory = memory;
        }
        *ledger += outcome.ledger;
        scratch.contacts.thrown.extend_from_slice(&scratch.contacts.group.thrown);
        report.sweeps += outcome.sweeps;
        report.factorisations += outcome.factorisations;
        report.impacts += outcome.impacts;
        report.residual = report.residual.max(outcome.residual);
    }
}

/// Systems of groups that are no more, which are kept until there are so many.
const SPARE: usize = 16;

/// What the contact step needs of a patch between two bodies beside its rows.
fn link_of(
    (bodies, contacts): (&Bodies, &Contacts),
    (place, [i, j]): (u32, [u32; 2]),
    answer: Option<&Answer>,
    span: Span,
) -> (Touch, Link) {
    let patch = &contacts.patches[place as usize];
    let near = &contacts.near[patch.near as usize];
    let touch = answer.map_or(near.touch, |answer| answer.touch);
    let [i, j] = [i as usize, j as usize];
    let apart = bodies.poses[j].position - bodies.poses[i].position;
    let [x, y] = near.proxies.map(|p| &contacts.entries[p.0 as usize].collider);
    let width = x.width.min(y.width);
    let holder = if matches!(patch.manifold.normal, Normal::OnB(_)) { j } else { i };
    let manifold = (&patch.manifold, contacts.frames[holder].rot);
    let moves = |length, h| moves_far(bodies, [x, y], manifold, (length, h));
    let (bounces, round) = (touch.restitution > 0.0, x.is_round() && y.is_round());
    let turns = || {
        let loaded = patch.memory.impulse != [0.0; 3];
        let places = [i, j].map(|body| place_of(&contacts.frames[body]));
        let at = moved(&patch.manifold, apart, [&places[0], &places[1]]);
        let gap = at.gap[..patch.manifold.count].iter().copied().fold(Real::INFINITY, Real::min);
        let arrives = !loaded && moves(gap.max(LITTLE * width), span.duration);
        arrives || moves(TURNS * width, span.duration)
    };
    let far = (contacts.spread_of([i, j]) > FAR * width || moves(FAR * width, span.h()))
        && (bounces || !is_closed(bodies, patch, [i, j], width));
    let watched = watched(far, (bounces, !round && bounces && turns()), round);
    let tangent_speed = touch.tangent_speed;
    let link = Link {
        apart,
        restitution: touch.restitution,
        width,
        tangent_speed,
        watched,
        credit: patch.memory.credit,
        ..Link::new(patch.manifold, place)
    };
    (touch, link)
}

fn add_body(
    group: &mut Group,
    (bodies, contacts): (&Bodies, &Contacts),
    body: u32,
    (gravity, steady): (Vec2, Wrench),
) {
    let i = body as usize;
    let mass = &bodies.masses[i];
    let mut acceleration = mass.acceleration(&steady);
    acceleration.linear += gravity.component_mul(&mass.gravity_scale);
    let mut velocity = Velocity::new(bodies.twists[i], mass);
    if contacts.is_asleep(i) {
        (velocity.inverse_mass, velocity.inverse_inertia) = (Vec2::zeros(), 0.0);
    }
    group.reach.push(contacts.covered[i]);
    let fixed = velocity.is_fixed();
    group.driven |= fixed && velocity.twist != Twist::ZERO;
    group.bodies.push(body);
    group.angles.push(bodies.poses[i].angle);
    group.velocities.push(velocity);
    let acceleration = if fixed { Twist::ZERO } else { acceleration };
    group.places.push(Place::start(&bodies.poses[i], acceleration));
    group.masses.push(if fixed {
        Mass::default()
    } else {
        Mass { mass: mass.mass, inertia: mass.inertia }
    });
}

/// How arrivals of a contact are looked for. Features are known from the start of the step; those of round shapes stay
/// the nearest ones, others may give way to others when the bodies turn.
fn watched(far: bool, (bounces, turns): (bool, bool), round: bool) -> Watched {
    match (far || (bounces && turns), round) {
        (true, false) => Watched::Swift,
        (true, true) => Watched::Bounces,
        (false, _) if bounces => Watched::Bounces,
        (false, _) => Watched::No,
    }
}

/// Whether all points of a patch touch: their rows hold them, however fast the bodies are.
fn is_closed(bodies: &Bodies, patch: &Patch, [i, j]: [usize; 2], width: Real) -> bool {
    const CLOSED: Real = 1e-3;
    let gaps = seen(&patch.manifold, [&bodies.poses[i], &bodies.poses[j]]).gaps;
    gaps[..patch.manifold.count].iter().all(|gap| *gap <= CLOSED * width)
}

/// A motion in a step beyond this part of the width may bring other features together.
const TURNS: Real = 0.25;

/// One below this part of the width does not, or by less than bodies may overlap.
const LITTLE: Real = 1e-2;

/// Whether two bodies move farther against one another in a time h than a length, so that other features than those of
/// the manifold may meet. What slides along a face and stays on it does not.
fn moves_far(
    bodies: &Bodies,
    colliders: [&Collider; 2],
    (manifold, rot): (&Manifold, Rot),
    (length, h): (Real, Real),
) -> bool {
    let [a, b] = colliders.map(|collider| &bodies.twists[collider.body as usize]);
    let turn = a.angular.abs() * colliders[0].reach + b.angular.abs() * colliders[1].reach;
    let speed = b.linear - a.linear;
    let way = speed.norm() * h;
    if way + turn * h <= length {
        return false;
    }
    let (normal, on_face): (Vec2, fn(&Anchor) -> Vec2) = match manifold.normal {
        Normal::OnA(normal) => (normal, |anchor| anchor.on_a),
        Normal::OnB(normal) => (normal, |anchor| anchor.on_b),
        Normal::Between | Normal::Inside => return true,
    };
    let [low, high] = manifold.face;
    let stays = manifold.anchors[..manifold.count].iter().all(|anchor| {
        let along = perp(normal).dot(&on_face(anchor));
        along - way >= low && along + way <= high
    });
    let way = if stays { rot.apply(normal).dot(&speed).abs() * h } else { way };
    way + turn * h > length
}
