//! The stage that finds what touches or may touch during the step.

use super::hooks::{ContactHooks, allowed};
use super::near::{Apart, Kind};
use super::view::place_of;
use super::{Contacts, FAR, Near, Patch, ahead, margin, swept};
use crate::body::{Bodies, Mixing, Role};
use crate::collision::{Collider, Frame, Manifold, ProxyId, collide};
use crate::constraints::contact::{Touch, moved};
use crate::error::Result;
use crate::math::{Real, Twist, Vec2};
use crate::world::World;

impl World {
    /// Broad phase, then narrow phase.
    ///
    /// # Errors
    /// What a hook reports.
    pub(in crate::world) fn detect(&mut self, dt: Real) -> Result<()> {
        let step = Step { dt, gravity: self.state.settings.gravity };
        // What is about to be touched wakes, and may touch others that sleep.
        loop {
            let called = self.find_near(&step)?;
            if called.is_empty() {
                return self.ask_before_solving();
            }
            self.wake_islands(&called);
            self.planned();
        }
    }

    /// Finds pairs and manifolds. Returns the sleeping islands that are about to be touched.
    fn find_near(&mut self, step: &Step) -> Result<Vec<u32>> {
        let Self { state, plan, scratch, hooks, .. } = self;
        let Some(plan) = plan else { return Ok(Vec::new()) };
        let (contacts, bodies, settings) = (&mut state.contacts, &state.bodies, &state.settings);
        contacts.follow(bodies, &plan.colliding, step);
        contacts.pair_up(bodies, &settings.mixing, hooks.as_deref())?;
        contacts.find_manifolds(bodies, step, &mut scratch.contacts.found);
        Ok(contacts.called(bodies, |i| {
            let (way, turn) = step.motion(bodies, i);
            Twist::new(way, turn * bodies.twists[i].angular.signum())
        }))
    }
}

/// What bounds the motion of a step.
struct Step {
    dt: Real,
    gravity: Vec2,
}

impl Step {
    /// Way and turn of a body, by its velocity and gravity.
    fn motion(&self, bodies: &Bodies, body: usize) -> (Vec2, Real) {
        let twist = &bodies.twists[body];
        let fall = self.gravity.component_mul(&bodies.masses[body].gravity_scale);
        (twist.linear * self.dt + fall * (0.5 * self.dt * self.dt), twist.angular.abs() * self.dt)
    }
}

impl Contacts {
    /// How far one of these bodies may be thrown in the step (m).
    pub(super) fn spread_of<const N: usize>(&self, bodies: [usize; N]) -> Real {
        let of = |i: usize| self.spread.get(i).copied().unwrap_or_default();
        bodies.into_iter().map(of).fold(0.0, Real::max)
    }

    /// Bodies that were thrown farther than was looked may be thrown twice as far.
    pub(in crate::world) fn spread_out(&mut self, thrown: &[(u32, Real)]) {
        self.spread.resize(self.of_body.len(), 0.0);
        for (body, way) in thrown {
            let spread = &mut self.spread[*body as usize];
            *spread = spread.max(2.0 * way);
        }
    }

    /// Moves the boxes after the bodies.
    fn follow(&mut self, bodies: &Bodies, moving: &[u32], step: &Step) {
        let moved = std::mem::take(&mut self.moved);
        self.far = false;
        self.room.clear();
        self.room.resize(bodies.len(), 0.0);
        for body in moved.iter().chain(moving) {
            let i = *body as usize;
            let frame = Frame::of(&bodies.poses[i]);
            self.frames[i] = frame;
            let motion = step.motion(bodies, i);
            let spread = self.spread_of([i]);
            let entry = |proxy: &ProxyId| &self.entries[proxy.0 as usize];
            let width = self.of_body[i].iter().map(|proxy| entry(proxy).collider.width);
            let width = width.fold(Real::INFINITY, Real::min);
            let bounces = self.of_body[i].iter().any(|proxy| entry(proxy).bounces);
            let room = if bounces { (ROOM * width).min(2.0 * motion.0.norm()) } else { 0.0 };
            for proxy in &self.of_body[i] {
                let collider = &entry(proxy).collider;
                let tight = swept(collider, &frame, motion, spread).grown(room);
                self.broad.post(*proxy, &tight, margin(collider), ahead(collider, motion.0));
            }
            // An impact that is missed costs energy, one that rows meet late is parted by and by.
            let beyond = if bounces { room + 0.5 * MARGIN * width } else { 0.5 * width };
            self.covered[i] = motion.0.norm().max(spread) + beyond;
            self.room[i] = room;
            self.far |= spread > 0.0 || motion.0.norm() > FAR * width || motion.1 > FAR;
        }
        self.broad.settle();
        self.moved = moved;
        self.moved.clear();
    }

    /// Drops pairs whose boxes have parted, and takes in those whose boxes have met.
    fn pair_up(
        &mut self,
        bodies: &Bodies,
        mixing: &Mixing,
        hooks: Option<&dyn ContactHooks>,
    ) -> Result<()> {
        self.drop_parted(bodies);
        let mut broad = std::mem::take(&mut self.broad);
        let Self { entries, map, .. } = &*self;
        let allow = |a: ProxyId, b: ProxyId| {
            let [x, y] = [a, b].map(|proxy| &entries[proxy.0 as usize]);
            let [i, j] = [x, y].map(|entry| entry.collider.body as usize);
            if i == j
                || !x.filter.allows(&y.filter)
                || map.contains(a, b)
                || self.sleep_apart([i, j])
                || self.kept_apart([i, j])
            {
                return false;
            }
            let sensors = [x, y].map(|entry| entry.role == Role::Sensor);
            if sensors == [true; 2] {
                return false;
            }
            sensors != [false; 2] || bodies.masses[i].is_free() || bodies.masses[j].is_free()
        };
        let mut new = Vec::new();
        broad.find_pairs(allow, |a, b| new.push([a, b]));
        self.broad = broad;
        for proxies in new {
            let [x, y] = proxies.map(|proxy| &self.entries[proxy.0 as usize]);
            if let Some(hooks) = hooks
                && !allowed(hooks, bodies, [&x.collider, &y.collider])?
            {
                continue;
            }
            let kind = match (&x.role, &y.role) {
                (Role::Sensor, _) | (_, Role::Sensor) => Kind::Sensor,
                (Role::OneWay(_), _) | (_, Role::OneWay(_)) => Kind::OneWay { solid: false },
                _ => Kind::Solid,
            };
            self.map.insert(proxies[0], proxies[1], 0);
            let touch = touch(bodies, mixing, [&x.collider, &y.collider]);
            let pair = Near {
                proxies,
                touch,
                kind,
                touching: false,
                first: 0,
                count: 0,
                apart: Apart::default(),
            };
            self.take_in(pair, bodies);
        }
        Ok(())
    }

    /// Drops pairs whose boxes have parted, or that a joint keeps apart.
    fn drop_parted(&mut self, bodies: &Bodies) {
        if !self.broad.has_any_moved() && self.apart.is_empty() {
            return;
        }
        let parted = |pair: &Near, own: &Self| {
            let [a, b] = pair.proxies;
            let moved = own.broad.has_moved(a) || own.broad.has_moved(b);
            (moved && !own.broad.overlaps(a, b))
                || own.kept_apart(pair.proxies.map(|proxy| own.body_of(proxy) as usize))
        };
        self.drop_near(bodies.handles(), parted);
    }

    /// Whether a joint keeps two bodies from touching each other.
    fn kept_apart(&self, [i, j]: [usize; 2]) -> bool {
        !self.apart.is_empty() && self.apart.contains(&[i.min(j) as u32, i.max(j) as u32])
    }

    /// Narrow phase over all pairs. Points whose features were there before keep their impulses.
    fn find_manifolds(&mut self, bodies: &Bodies, step: &Step, found: &mut Vec<Manifold>) {
        let Self { entries, near, patches, before, frames, spread, room, .. } = self;
        let spread = |i: usize| spread.get(i).copied().unwrap_or_default() + room[i];
        std::mem::swap(patches, before);
        patches.clear();
        for (place, pair) in near.iter_mut().enumerate() {
            let old = &before[pair.first as usize..(pair.first + pair.count) as usize];
            (pair.first, pair.count) = (patches.len() as u32, 0);
            if pair.kind == Kind::Sensor {
                continue;
            }
            let [x, y] = pair.proxies.map(|proxy| &entries[proxy.0 as usize].collider);
            let [i, j] = [x.body as usize, y.body as usize];
            let way = way_to_meet(bodies, step, [x, y], pair.touch.restitution);
            let margin = MARGIN * x.width.min(y.width) + way + spread(i) + spread(j);
            let stands = frames[j].seen_from(&frames[i]);
            if pair.kind == Kind::Solid && pair.apart.holds(&stands, y.reach, margin) {
                continue;
            }
            found.clear();
            let gap = collide(&x.geometry, &y.geometry, &stands, margin, found);
            pair.apart = Apart::new(stands, gap);
            if let Kind::OneWay { solid } = &mut pair.kind {
                let roles = pair.proxies.map(|proxy| &entries[proxy.0 as usize].role);
                let slop = ONE_WAY_SLOP * x.width.min(y.width);
                *solid = (*solid && pair.touching)
                    || comes_from_its_side(found, roles, [&frames[i], &frames[j]], slop);
            }
            for manifold in &*found {
                patches.push(Patch::remembering(place as u32, *manifold, old));
            }
            pair.count = patches.len() as u32 - pair.first;
        }
    }
}

/// How far beyond their own ways shapes are looked for, as a part of the smaller width.
const MARGIN: Real = 0.02;

/// How far beyond its way a body that bounces may be thrown before the step is taken again, as a part of its width.
const ROOM: Real = 0.25;

/// Overlap, as a part of the smaller width, with which a shape still counts as wholly on one side of a platform.
const ONE_WAY_SLOP: Real = 1e-3;

/// Whether a shape is wholly on that side of a platform from which the platform is solid: the surfaces do not overlap
/// by more than `slop`, and the normal is within 60° of the side.
fn comes_from_its_side(
    found: &[Manifold],
    roles: [&Role; 2],
    [a, b]: [&Frame; 2],
    slop: Real,
) -> bool {
    let apart = b.position - a.position;
    let places = [place_of(a), place_of(b)];
    let stands = |manifold: &Manifold| {
        let at = moved(manifold, apart, [&places[0], &places[1]]);
        // From the platform to the other.
        let faces = [(roles[0], a, at.normal), (roles[1], b, -at.normal)];
        let faces_side = faces.iter().all(|(role, frame, normal)| match role {
            Role::OneWay(side) => frame.rot.apply(*side).dot(normal) >= 0.5 * side.norm(),
            _ => true,
        });
        faces_side && at.gap[..manifold.count].iter().all(|gap| *gap >= -slop)
    };
    !found.is_empty() && found.iter().all(stands)
}

/// How far two colliders can come together in a step (m). One that moves far may be stopped or turned, so that it counts by
/// itself, and what bounces counts twice; slower ones count by how they move against one another.
fn way_to_meet(bodies: &Bodies, step: &Step, pair: [&Collider; 2], restitution: Real) -> Real {
    let motions = pair.map(|collider| step.motion(bodies, collider.body as usize));
    let turns: Real = (0..2).map(|k| motions[k].1.min(2.0) * pair[k].reach).sum();
    let lengths = motions.map(|(way, _)| way.norm());
    let far = (0..2).any(|k| lengths[k] > FAR * pair[k].width);
    let [shorter, longer] = [lengths[0].min(lengths[1]), lengths[0].max(lengths[1])];
    let ways = if far {
        longer + restitution.min(1.0) * shorter
    } else {
        (motions[1].0 - motions[0].0).norm()
    };
    ways + turns
}

/// What the surfaces of two colliders make of their values.
fn touch(bodies: &Bodies, mixing: &Mixing, colliders: [&Collider; 2]) -> Touch {
    let [a, b] = colliders.map(|collider| {
        let def = &bodies.infos[collider.body as usize].def;
        def.surface_of(&def.shapes[collider.part as usize])
    });
    let mixed = mixing.mix(&a, &b);
    Touch {
        friction: mixed.friction,
        restitution: mixed.restitution,
        rolling_resistance: mixed.rolling_resistance,
        tangent_speed: mixed.tangent_speeds.iter().sum(),
    }
}
