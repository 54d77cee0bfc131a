//! Deformable bodies in the groups of the contact step.

use super::events::{Other, Touch};
use super::touch::{Borders, PIECE};
use super::{Softs, follow, ties};
use crate::arena::Arena;
use crate::body::{Bodies, Friction};
use crate::collision::ProxyId;
use crate::constraints::Matter;
use crate::constraints::matter::{Grip, Point};
use crate::joint::Joint;
use crate::math::{Real, Vec2};
use crate::methods::Span;
use crate::methods::contact_step::Group;
use crate::methods::contact_step::matter::{Matters, Scratch};
use crate::shapes::Aabb;
use crate::soft::{Moving, SoftBody};
use crate::world::World;
use crate::world::contacts::Contacts;

/// What a deformable body may touch in a step.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub soft: u32,
    pub against: Against,
    /// What both surfaces make together.
    pub friction: Friction,
    pub restitution: Real,
    pub tangent_speed: Real,
}

/// The other side of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// A collider, and its body.
    Proxy(ProxyId, u32),
    /// A deformable body, maybe the same.
    Soft(u32),
}

/// Columns of the stage; kept between steps.
#[derive(Clone, Debug, Default)]
pub struct SoftScratch {
    pub pairs: Vec<Pair>,
    pub boxes: Vec<Aabb>,
    /// What joints tie: bodies by their places, deformable ones on from those.
    pub joined: Vec<[u32; 2]>,
    /// What points did in the step.
    pub touches: Vec<Touch>,
    /// Where those of the group at work begin.
    begun: usize,
    /// Of those, what does not touch.
    pub apart: Vec<[u32; 2]>,
    pub borders: Borders,
    /// Deformable bodies of the group at work.
    pub members: Vec<u32>,
    /// How they moved when the span began.
    saved: Vec<Moving>,
    /// Grips of the groups that are done in this span, and of all after the last one.
    grips: Vec<Grip>,
    solve: Scratch,
}

impl SoftScratch {
    /// Adds the links of what may touch, and tells of the rigid bodies in them.
    pub fn add_links(
        &self,
        softs: &Softs,
        bodies: usize,
        links: &mut Vec<[u32; 2]>,
        tell: impl FnMut(u32),
    ) {
        let first = links.len();
        links.extend(self.links(softs, bodies as u32));
        let ends = links[first..].iter().flatten().copied();
        ends.filter(|i| (*i as usize) < bodies).for_each(tell);
    }

    /// Links of what may touch: bodies by their places, deformable ones from `bodies` on.
    fn links(&self, softs: &Softs, bodies: u32) -> impl Iterator<Item = [u32; 2]> {
        let alone = (0..softs.bodies.values().len() as u32).map(move |k| [bodies + k; 2]);
        let pairs = self.pairs.iter().map(move |pair| {
            let other = match pair.against {
                Against::Proxy(_, body) => body,
                Against::Soft(other) => bodies + other,
            };
            [other, bodies + pair.soft]
        });
        alone.chain(pairs).chain(self.joined.iter().copied())
    }
}

/// Takes the ends of a link that only deformable bodies have: rigid ones to `rigid`, deformable ones among the members.
pub fn take_ends(
    pair: [u32; 2],
    bodies: usize,
    members: &mut Vec<u32>,
    mut rigid: impl FnMut(u32) -> u32,
) {
    for i in pair {
        match (i as usize).checked_sub(bodies).map(|soft| soft as u32) {
            None => {
                rigid(i);
            }
            Some(soft) if !members.contains(&soft) => members.push(soft),
            Some(_) => {}
        }
    }
}

/// The deformable bodies of a group.
pub struct Members<'a> {
    list: &'a [u32],
    softs: &'a mut [SoftBody],
    pairs: &'a [Pair],
    borders: &'a mut Borders,
    bodies: &'a Bodies,
    contacts: &'a Contacts,
    /// What points remember, in the order of their keys, and the substep it is of; what is kept.
    grips: (&'a [Grip], Real),
    kept: &'a mut Vec<Grip>,
    /// What the last substep in this span kept.
    last: Vec<Grip>,
    first: bool,
    gravity: Vec2,
    /// What its points did in the step, and where those of the group begin.
    touches: (usize, &'a mut Vec<Touch>),
}

impl World {
    /// Keeps how the members of the group at hand move.
    pub(in crate::world) fn save_members(&mut self) {
        let Self { state, scratch, .. } = self;
        let softs = state.softs.bodies.values();
        let soft = &mut scratch.soft;
        soft.saved.clear();
        soft.begun = soft.touches.len();
        soft.saved.extend(soft.members.iter().map(|k| softs[*k as usize].moving().clone()));
    }

    /// Puts them back.
    pub(in crate::world) fn restore_members(&mut self) {
        let Self { state, scratch, .. } = self;
        let softs = state.softs.bodies.values_mut();
        scratch.soft.touches.truncate(scratch.soft.begun);
        for (k, moving) in scratch.soft.members.iter().zip(&scratch.soft.saved) {
            softs[*k as usize].go_back(moving);
        }
    }

    /// Begins a span: no group has kept grips yet.
    pub(in crate::world) fn begin_grips(&mut self) {
        self.scratch.soft.grips.clear();
    }

    /// Ends a span: what its groups kept is what points remember.
    pub(in crate::world) fn end_grips(&mut self, span: Span) {
        let Self { state, scratch, .. } = self;
        let grips = &mut scratch.soft.grips;
        grips.sort_unstable_by_key(|grip| grip.key);
        state.softs.grips.clone_from(grips);
        state.softs.substep = span.h();
        follow(&state.softs, &mut state.joints);
    }
}

/// The members of the group at hand, and the columns of their solve.
pub(in crate::world) fn members<'a>(
    softs: &'a mut Softs,
    (bodies, contacts): (&'a Bodies, &'a Contacts),
    (joints, group, span): (&Arena<Joint>, &Group, Span),
    (gravity, soft): (Vec2, &'a mut SoftScratch),
) -> (Members<'a>, &'a mut Scratch) {
    let SoftScratch { pairs, borders, members, grips, solve, touches, .. } = soft;
    ties((softs, members), (bodies, joints), (group, span.h()), &mut solve.ties);
    let Softs { bodies: list, grips: before, substep, .. } = softs;
    let softs = list.values_mut();
    for k in &*members {
        let body = &mut softs[*k as usize];
        let scale = body.def().gravity_scale;
        body.accelerate(gravity * scale);
    }
    let members = Members {
        list: members,
        softs,
        pairs,
        borders,
        bodies,
        contacts,
        grips: (before, *substep),
        kept: grips,
        last: Vec::new(),
        first: true,
        gravity,
        touches: (touches.len(), touches),
    };
    (members, solve)
}

impl Matters for Members<'_> {
    fn count(&self) -> usize {
        self.list.len()
    }

    fn piece(&mut self, k: usize) -> &mut dyn Matter {
        &mut self.softs[self.list[k] as usize]
    }

    fn find(&mut self, group: &Group, h: Real, points: &mut Vec<Point>) {
        points.clear();
        let Self { list, softs, pairs, borders, bodies, contacts, grips, last, first, .. } = self;
        for &k in *list {
            borders.follow(k as usize, &softs[k as usize]);
        }
        for pair in pairs.iter().filter(|pair| list.contains(&pair.soft)) {
            borders.touch(pair, (softs, list), (group, bodies, contacts), (h, points));
        }
        points.sort_by(|a, b| a.grip.key.cmp(&b.grip.key).then(a.gap.total_cmp(&b.gap)));
        points.dedup_by_key(|point| point.grip.key);
        let (known, scale) = if *first { (grips.0, h / grips.1) } else { (&last[..], 1.0) };
        for point in points {
            if let Ok(at) = known.binary_search_by_key(&point.grip.key, |grip| grip.key) {
                point.grip = known[at];
                point.grip.impulse =
                    if scale.is_finite() { known[at].impulse.map(|p| p * scale) } else { [0.0; 2] };
            }
        }
    }

    fn keep(&mut self, group: &Group, h: Real, points: &[Point]) {
        self.first = false;
        self.note(group, h, points);
        self.last.clear();
        self.last.extend(points.iter().map(|point| point.grip));
    }
}

impl Members<'_> {
    /// A piece of matter as a body, and the acceleration (m/s²) that gravity gives it.
    pub fn body_of(&self, k: u32) -> (&SoftBody, Vec2) {
        let body = &self.softs[self.list[k as usize] as usize];
        (body, self.gravity * body.def().gravity_scale)
    }

    /// Notes what the points of a substep did, pair by pair.
    fn note(&mut self, group: &Group, h: Real, points: &[Point]) {
        let (first, touches) = (self.touches.0, std::mem::take(self.touches.1));
        let mut touches = touches;
        touches[first..].iter_mut().for_each(Touch::open);
        let begun = touches.len();
        for point in points {
            let [soft, _, number, _] = point.grip.key;
            let other = if number & PIECE == 0 {
                let entry = self.contacts.entry(ProxyId(number));
                Other::Body(entry.collider.body, entry.collider.part)
            } else {
                Other::Soft(number & !PIECE)
            };
            let touch = Touch::new(((soft, other), point), self, (group, h));
            // Points of a pair stand one after another.
            match touches[begun..].last_mut().filter(|last| last.pair == touch.pair) {
                Some(last) => last.join(&touch),
                None => touches.push(touch),
            }
        }
        *self.touches.1 = touches;
    }
}

impl Drop for Members<'_> {
    fn drop(&mut self) {
        self.kept.append(&mut self.last);
    }
}
