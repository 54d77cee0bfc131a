//! The stage that moves what touches or may to a tolerance: each small group from event to event.

use super::events::ContactEvent;
use super::near::Kind;
use super::{ContactScratch, Contacts, FAR, MARGIN};
use crate::body::Bodies;
use crate::collision::{Geometry, ProxyId};
use crate::constraints::contact::Memory;
use crate::error::Result;
use crate::forces::has_resistance;
use crate::math::{Pose, Real, Twist, Vec2};
use crate::methods::events::{Bearing, Island, Outcome, Pair, Struck, Touch, run};
use crate::methods::{Sink, Span, Watch};
use crate::world::joints::{JoinedGroup, is_smooth};
use crate::world::{Trajectory, World};

/// Groups that are moved from event to event in a stretch, and what came of it.
#[derive(Clone, Debug, Default)]
pub(in crate::world) struct ByEvents {
    /// Bodies that got farther than was looked, and how far (m).
    pub thrown: Vec<(u32, Real)>,
    /// When, and why, events could not go on.
    pub gave_up: Option<(Real, &'static str)>,
    /// Events located.
    pub events: u64,
    /// What began or ceased to touch, and between which colliders.
    pub touched: Vec<([ProxyId; 2], Touch)>,
    /// What bears at the end, and between which colliders.
    pub bearing: Vec<([ProxyId; 2], Bearing)>,
}

/// Bodies of a group that is moved from event to event: beyond, the contact step is cheaper.
const MOST_BODIES: usize = 24;

/// Pairs of one.
const MOST_PAIRS: usize = 300;

impl World {
    /// Bodies that give way in the largest group that is not left to a method.
    pub(in crate::world) fn largest_group(&self) -> usize {
        let scratch = &self.scratch.contacts;
        (0..scratch.groups())
            .filter(|k| !scratch.leaves(*k))
            .map(|k| self.bodies_of(k).len())
            .max()
            .unwrap_or(0)
    }

    fn bodies_of(&self, k: usize) -> Vec<u32> {
        let gives_way = |i: &u32| self.state.bodies.masses[*i as usize].is_free();
        let mut bodies: Vec<u32> =
            self.scratch.contacts.links_of(k).flatten().filter(gives_way).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// Whether all groups that are not left to a method can be moved from event to event: small ones, whose joints have no
    /// bounds, and nothing in them that the modes do not know.
    pub(in crate::world) fn suits_events(&mut self) -> bool {
        let Self { state, scratch, .. } = self;
        state.contacts.find_bare(&mut scratch.contacts.bare);
        let scratch = &self.scratch.contacts;
        let (contacts, bodies) = (&self.state.contacts, &self.state.bodies);
        let plain = |place: u32| {
            let near = &contacts.near[contacts.patches[place as usize].near as usize];
            near.kind == Kind::Solid && near.touch.rolling_resistance == 0.0
        };
        scratch.answers.is_empty()
            && (0..scratch.groups()).filter(|k| !scratch.leaves(*k)).all(|k| {
                let joints = self.state.joints.values();
                self.bodies_of(k).len() <= MOST_BODIES
                    && scratch.links_of(k).count() <= MOST_PAIRS
                    && scratch.patches_of(k).all(|(place, _)| plain(place))
                    && scratch.joints_of(k).all(|j| is_smooth(bodies, &joints[j as usize]))
            })
    }

    /// Moves every such group through a span, where that is asked for; samples go to the trajectory. Returns the largest
    /// estimate of a group's error.
    pub(in crate::world) fn advance_by_events(
        &mut self,
        span: Span,
        (tolerance, samples): (Real, &[Real]),
        (first, trajectory): (usize, &mut Trajectory),
        watch: &mut Watch<'_>,
    ) -> Result<Real> {
        let mut worst: Real = 0.0;
        if self.scratch.contacts.by_events.is_none() {
            return Ok(worst);
        }
        for k in 0..self.scratch.contacts.groups() {
            if self.scratch.contacts.leaves(k) {
                continue;
            }
            self.with_island(k, |world| {
                let members = world.scratch.joined.group.members.clone();
                let mut sink = |sample: usize, poses: &[Pose], twists: &[Twist]| {
                    for (slot, body) in members.iter().enumerate() {
                        let (pose, twist) = (&poses[slot..=slot], &twists[slot..=slot]);
                        trajectory.write(first + sample, *body as usize, pose, twist);
                    }
                };
                let handlers: (&mut Sink<'_>, _) = (&mut sink, &mut *watch);
                let outcome = world.run_group(span, (tolerance, samples), handlers)?;
                worst = worst.max(outcome.progress.estimate);
                world.book_events(&outcome, &members);
                Ok(())
            })?;
        }
        Ok(worst)
    }

    /// Runs the group at work and brings its motion back.
    fn run_group(
        &mut self,
        span: Span,
        (tolerance, samples): (Real, &[Real]),
        (sink, watch): (&mut Sink<'_>, &mut Watch<'_>),
    ) -> Result<Outcome> {
        let plan = self.plan.as_ref();
        let together = plan.is_some_and(|plan| plan.together > 0);
        let resists = plan.is_some_and(|plan| plan.resistance);
        let (air, law) = (self.state.settings.air, self.state.settings.impact_law);
        let (bodies, group) = (&self.state.bodies, &self.scratch.joined.group);
        let resisted = |i: &u32| resists && has_resistance(&bodies.infos[*i as usize], air);
        let constant = !together && !group.members.iter().any(resisted);
        let spread = |i: &u32| self.state.contacts.spread_of([*i as usize]);
        let reach: Vec<Real> = group.members.iter().map(spread).collect();
        let sizes = group.sizes.clone();
        let near = group.pairs.clone();
        let given =
            |slot: usize| !group.masses[slot].is_free() && group.twists[slot] != Twist::ZERO;
        let driven = (0..group.masses.len()).any(given);
        let mut outcome = Outcome::default();
        let ledger = self.run_joined(true, |system, motion, (scratch, contacts)| {
            let pairs = contacts.pairs_of(&near, tolerance);
            let driven = driven || pairs.iter().any(|pair| pair.touch.tangent_speed != 0.0);
            let island = Island { pairs, law, constant, driven, sizes, reach, tolerance };
            outcome = run(&island, system, motion, (span, samples), (scratch, sink, watch))?;
            Ok(())
        })?;
        self.scatter_joined(ledger);
        Ok(outcome)
    }

    fn book_events(&mut self, outcome: &Outcome, members: &[u32]) {
        let JoinedGroup { pairs, .. } = &self.scratch.joined.group;
        let contacts = &self.state.contacts;
        let hit =
            |hit: &Struck| contacts.hit_of((pairs[hit.pair as usize].0, hit), &self.state.bodies);
        self.events.hit.extend(outcome.struck.iter().map(hit));
        self.report.book_progress(&outcome.progress);
        self.report.impacts += outcome.struck.len() as u64;
        let Some(booked) = &mut self.scratch.contacts.by_events else { return };
        booked.events += outcome.events;
        let thrown = outcome.thrown.iter();
        booked.thrown.extend(thrown.map(|(slot, way)| (members[*slot as usize], *way)));
        booked.gave_up = booked.gave_up.or(outcome.gave_up);
        let proxies = |pair: u32| contacts.near[pairs[pair as usize].0 as usize].proxies;
        booked.bearing.extend(outcome.bearing.iter().map(|b| (proxies(b.pair), *b)));
        booked.touched.extend(outcome.touched.iter().map(|t| (proxies(t.pair), *t)));
    }
}

impl Contacts {
    /// Pairs of shapes with joins that show no features to one another.
    fn find_bare(&self, bare: &mut Vec<u32>) {
        bare.clear();
        for (place, near) in self.near.iter().enumerate() {
            let joined = near.proxies.iter().any(|proxy| {
                let geometry = &self.entries[proxy.0 as usize].collider.geometry;
                matches!(geometry, Geometry::Convex(convex) if convex.joins.is_some())
            });
            if joined && near.count == 0 && near.kind == Kind::Solid {
                bare.push(place as u32);
            }
        }
    }

    /// Pairs of a group, each once, in order, and their bodies.
    pub(in crate::world) fn pairs_of_group(
        &self,
        scratch: &ContactScratch,
        k: usize,
    ) -> Vec<(u32, [u32; 2])> {
        let of_patch = |(place, pair): (u32, [u32; 2])| (self.patches[place as usize].near, pair);
        let mut pairs: Vec<(u32, [u32; 2])> = scratch.patches_of(k).map(of_patch).collect();
        if !pairs.is_empty() && !scratch.bare.is_empty() {
            let mut members: Vec<u32> = pairs.iter().flat_map(|(_, pair)| *pair).collect();
            members.sort_unstable();
            for place in &scratch.bare {
                let pair = self.near[*place as usize].proxies.map(|proxy| self.body_of(proxy));
                if pair.iter().any(|body| {
                    members.binary_search(body).is_ok() && scratch.moves(*body as usize)
                }) {
                    pairs.push((*place, pair));
                }
            }
        }
        pairs.sort_unstable_by_key(|(near, _)| self.near[*near as usize].proxies);
        pairs.dedup();
        pairs
    }

    /// The same as what may meet.
    fn pairs_of(&self, pairs: &[(u32, [u32; 2])], tolerance: Real) -> Vec<Pair<'_>> {
        let pair = |(near, slots): &(u32, [u32; 2])| {
            let near = &self.near[*near as usize];
            let colliders = near.proxies.map(|proxy| &self.entries[proxy.0 as usize].collider);
            let width = colliders[0].width.min(colliders[1].width);
            let slack = tolerance.min(1e-3);
            Pair { slots: *slots, colliders, touch: near.touch, width, slack }
        };
        pairs.iter().map(pair).collect()
    }

    /// Gives the patches the impulses that forces have over a substep: what contacts bear can be read, and steps that follow begin
    /// with it.
    pub(in crate::world) fn remember(
        &mut self,
        bearing: &[([ProxyId; 2], Bearing)],
        substep: Real,
    ) {
        if self.substep <= 0.0 {
            self.substep = substep;
        }
        let Self { near, patches, substep, .. } = self;
        for patch in patches {
            patch.memory = Memory::NEW;
            let proxies = near[patch.near as usize].proxies;
            for (_, b) in bearing.iter().filter(|(pair, _)| *pair == proxies) {
                for k in 0..patch.manifold.count {
                    let feature = patch.manifold.anchors[k].feature;
                    let Some(p) = b.features.iter().position(|f| *f == feature) else { continue };
                    patch.memory.impulse[k] = b.force[p] * *substep;
                    patch.memory.impulse[2] = b.force[2] * *substep;
                    patch.memory.sliding = b.slides;
                }
            }
        }
    }

    fn hit_of(&self, (near, hit): (u32, &Struck), bodies: &Bodies) -> ContactEvent {
        let near = &self.near[near as usize];
        let (pair, flipped) = self.shapes_of(near, bodies.handles());
        ContactEvent {
            time: hit.time,
            bodies: pair.bodies,
            parts: pair.parts.map(|part| part as usize),
            point: Some(hit.point),
            normal: Some(if flipped { -hit.normal } else { hit.normal }),
            approach_speed: hit.approach,
            impulse: hit.impulse,
        }
    }

    /// How far (m) each body that can touch others may get in a time, at first: as fast as it is under the forces on it, and a part of
    /// its size.
    pub(in crate::world) fn spread_by(
        &mut self,
        dt: Real,
        bodies: &Bodies,
        pull: impl Fn(usize) -> Vec2,
    ) {
        let spread = |i: usize| {
            let entries = || self.of_body[i].iter().map(|p| &self.entries[p.0 as usize]);
            let bounces = entries().any(|entry| entry.bounces);
            let sizes = entries().map(|entry| (entry.collider.width, entry.collider.reach));
            let (width, reach) = sizes.fold((0.0, 0.0), |(w, r): (Real, Real), (width, reach)| {
                (w.max(width), r.max(reach))
            });
            if !bodies.masses[i].is_free() {
                return bodies.twists[i].linear.norm() * dt;
            }
            let twist = &bodies.twists[i];
            let turn = (twist.angular.abs() * dt).min(2.0);
            let way = twist.linear.norm() * dt + 0.5 * pull(i).norm() * dt * dt + turn * reach;
            let way = 1.1 * way + 0.01 * width;
            // Boxes have a margin for short ways, and are grown all around for those that count as far: also for what bounces, which may be
            // thrown while it rests.
            let far = bounces || way > 0.5 * MARGIN * width;
            if far { way.max(1.01 * FAR * width) } else { way }
        };
        self.spread = (0..self.of_body.len()).map(spread).collect();
    }

    /// The shortest time (s) worth while: in which no body gets farther than a part of its size.
    pub(in crate::world) fn short_stretch(
        &self,
        bodies: &Bodies,
        pull: impl Fn(usize) -> Vec2,
    ) -> Real {
        let time = |i: usize| {
            let widths = self.of_body[i].iter().map(|p| self.entries[p.0 as usize].collider.width);
            let way = 0.1 * widths.fold(Real::INFINITY, Real::min);
            let (speed, pull) = (bodies.twists[i].linear.norm(), pull(i).norm());
            let root = (speed * speed + 2.0 * pull * way).sqrt();
            if speed + root > 0.0 { 2.0 * way / (speed + root) } else { Real::INFINITY }
        };
        (0..self.of_body.len())
            .filter(|i| !self.of_body[*i].is_empty() && bodies.masses[*i].is_free())
            .map(time)
            .fold(Real::INFINITY, Real::min)
    }
}
