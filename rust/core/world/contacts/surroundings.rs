//! What else acts on bodies that touch: air, damping and fields; and where swift shapes meet.

use super::Contacts;
use crate::body::Bodies;
use crate::collision::{Collider, Frame, Manifold, Sweep, collide, first_impact};
use crate::error::{Error, Result};
use crate::forces::{Air, Forces, drift_body, has_resistance};
use crate::math::{Pose, Real, Twist, Vec2};
use crate::methods::contact_step::{Group, Link, Surroundings};

/// Surroundings whose forces stay the same over a span.
pub(super) struct Still<'a> {
    pub bodies: &'a Bodies,
    pub contacts: &'a Contacts,
    pub air: Air,
    pub resistance: bool,
}

impl Surroundings for Still<'_> {
    fn accelerate(&mut self, _span: (Real, Real), _group: &mut Group) -> Result<()> {
        Ok(())
    }

    fn drift(&mut self, h: Real, group: &mut Group) -> Result<Real> {
        let Group { bodies, velocities, places, .. } = group;
        let mut dissipated = 0.0;
        for (slot, (velocity, place)) in velocities.iter_mut().zip(places).enumerate() {
            let i = bodies[slot] as usize;
            let (mass, info) = (&self.bodies.masses[i], &self.bodies.infos[i]);
            if !self.resistance || velocity.is_fixed() || !has_resistance(info, self.air) {
                place.drift(&velocity.twist, h);
                continue;
            }
            let before = mass.kinetic_energy(&velocity.twist);
            let start = self.bodies.poses[i].angle + place.turn;
            // Counted from where the body is, so that the way is not rounded at its place.
            let mut pose = Pose::new(Vec2::zeros(), start);
            drift_body(mass, info, self.air, (h, &mut pose, &mut velocity.twist))?;
            place.way += pose.position;
            place.rotate(pose.angle - start);
            dissipated += before - mass.kinetic_energy(&velocity.twist);
        }
        Ok(dissipated)
    }

    fn meet(&self, link: &Link, ways: &[Sweep; 2], target: Real) -> Option<(Real, Manifold)> {
        let [a, b] = self.colliders(link);
        let hit = first_impact((&a.geometry, &ways[0]), (&b.geometry, &ways[1]), target)?;
        let rest = ways.map(|way| Sweep { from: way.at(hit.fraction), to: way.to });
        self.look(link, &rest).map(|manifold| (hit.fraction, manifold))
    }

    fn look(&self, link: &Link, ways: &[Sweep; 2]) -> Option<Manifold> {
        let [a, b] = self.colliders(link);
        let [way_a, way_b] = ways.map(|way| way.to.position - way.from.position);
        let turns = [(0, a), (1, b)].map(|(side, collider)| {
            (ways[side].to.angle - ways[side].from.angle).abs().min(2.0) * collider.reach
        });
        let margin = 0.04 * link.width + (way_b - way_a).norm() + turns[0] + turns[1];
        let [frame_a, frame_b] = ways.map(|way| Frame::of(&way.from));
        let mut found = Vec::new();
        collide(&a.geometry, &b.geometry, &frame_b.seen_from(&frame_a), margin, &mut found);
        found.first().copied()
    }
}

impl Still<'_> {
    fn colliders(&self, link: &Link) -> [&Collider; 2] {
        let near = &self.contacts.near[self.contacts.patches[link.place as usize].near as usize];
        near.proxies.map(|proxy| &self.contacts.entries[proxy.0 as usize].collider)
    }
}

/// Surroundings with fields, which see all bodies, in body order, and change as those move.
pub(super) struct Fields<'a> {
    pub still: Still<'a>,
    pub forces: Forces<'a>,
    /// Columns of the bodies as they are in the middle of the substep.
    pub poses: Vec<Pose>,
    pub twists: Vec<Twist>,
    pub accelerations: Vec<Twist>,
    /// Velocities at the start of the substep, and half its length (s), until its work is booked.
    pub before: Option<(Vec<Twist>, Real)>,
}

impl Fields<'_> {
    /// a(t, x, ½(v⁻ + v⁺)) without the contacts, by iteration where forces depend on velocities.
    fn settle(&mut self, (time, h): (Real, Real), group: &Group) -> Result<()> {
        const MOST: usize = 60;
        self.accelerations.clear();
        self.accelerations.resize(group.bodies.len(), Twist::ZERO);
        let tries = if self.forces.velocity_dependent() { MOST } else { 1 };
        for _ in 0..tries {
            let Self { forces, poses, twists, accelerations, .. } = self;
            forces.accelerate_without_resistance(time, poses, twists, accelerations)?;
            let mut change: Real = 0.0;
            for ((twist, a), velocity) in
                twists.iter_mut().zip(accelerations).zip(&group.velocities)
            {
                let start = &velocity.twist;
                let middle = Twist::new(
                    start.linear + a.linear * (0.5 * h),
                    start.angular + a.angular * (0.5 * h),
                );
                let size = start.linear.amax().max(middle.linear.amax()) + start.angular.abs();
                let moved =
                    (middle.linear - twist.linear).amax() + (middle.angular - twist.angular).abs();
                change = change.max(if moved == 0.0 { 0.0 } else { moved / size });
                *twist = middle;
            }
            if tries == 1 || change <= 4.0 * Real::EPSILON {
                return Ok(());
            }
        }
        let hint =
            "a smaller step (or more substeps): a force field changes too fast with the velocity";
        Err(Error::invalid("dt", h, hint))
    }
}

impl Surroundings for Fields<'_> {
    fn accelerate(&mut self, (time, h): (Real, Real), group: &mut Group) -> Result<()> {
        self.poses.clear();
        self.twists.clear();
        for (slot, place) in group.places.iter().enumerate() {
            let start = &self.still.bodies.poses[slot];
            self.poses.push(Pose::new(start.position + place.way, start.angle + place.turn));
            self.twists.push(group.velocities[slot].twist);
        }
        let before = self.twists.clone();
        self.settle((time, h), group)?;
        for ((place, a), velocity) in
            group.places.iter_mut().zip(&self.accelerations).zip(&group.velocities)
        {
            place.acceleration = if velocity.is_fixed() { Twist::ZERO } else { *a };
        }
        self.before = Some((before, 0.5 * h));
        Ok(())
    }

    fn drift(&mut self, h: Real, group: &mut Group) -> Result<Real> {
        self.still.drift(h, group)
    }

    /// Over a substep a force does the work F·½(v⁻ + v⁺)·h.
    fn work(&mut self, group: &Group) -> Real {
        let Some((before, half)) = self.before.take() else { return 0.0 };
        if !self.forces.works() {
            return 0.0;
        }
        let after: Vec<Twist> = group.velocities.iter().map(|velocity| velocity.twist).collect();
        half * (self.forces.working_power(&before) + self.forces.working_power(&after))
    }

    fn meet(&self, link: &Link, ways: &[Sweep; 2], target: Real) -> Option<(Real, Manifold)> {
        self.still.meet(link, ways, target)
    }

    fn look(&self, link: &Link, ways: &[Sweep; 2]) -> Option<Manifold> {
        self.still.look(link, ways)
    }
}
