//! Bodies that move together, and the contacts between them.

use super::impacts::Watch;
use super::joints::Ties;
use super::newton::Together;
use super::wide::Wide;
use crate::collision::Manifold;
use crate::constraints::contact::Block;
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Twist, Vec2};
use crate::solvers::Lanes;

/// m (kg) and I (kg·m²), for energies; 0 of a body whose motion is given.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mass {
    /// m.
    pub mass: Real,
    /// I.
    pub inertia: Real,
}

impl Mass {
    /// I/m (m²); 0 of a body without mass.
    #[must_use]
    pub fn gyration_squared(&self) -> Real {
        if self.mass > 0.0 { self.inertia / self.mass } else { 0.0 }
    }

    /// The change of energy along a change of velocity: m Δv·v + I Δω ω.
    #[must_use]
    pub fn work(&self, change: &Twist, mean: &Twist) -> Real {
        self.mass * change.linear.dot(&mean.linear) + self.inertia * change.angular * mean.angular
    }
}

/// Whether arrivals of a contact are looked for, so that an impact comes of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// No: its rows foresee it.
    No,
    /// It bounces: when the features that are nearest now meet.
    Bounces,
    /// It moves too far in a substep for its rows and features to foresee: when the shapes meet, wherever.
    Swift,
}

/// What the step needs of a contact beside its rows.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Its geometry.
    pub manifold: Manifold,
    /// From A's centre of mass to B's at the start of the step (m).
    pub apart: Vec2,
    /// Restitution.
    pub restitution: Real,
    /// Smaller width of the two colliders (m).
    pub width: Real,
    /// Where the contact is kept.
    pub place: u32,
    /// J̇v of points that carry a load or are apart (m/s²).
    pub curvature: [Real; 2],
    /// The same along the surface where the load sticks to it.
    pub turning: Real,
    /// Tangential velocity (m/s) of B against A at which nothing slides.
    pub tangent_speed: Real,
    /// Corners that come nearer and yet go past one another.
    pub passes: [bool; 2],
    /// Approach (m/s) up to which a contact rests and does not bounce: what the substep's kicks give it.
    pub resting: [Real; 2],
    /// Whether arrivals are looked for.
    pub watched: Watched,
    /// Of a contact that is watched, its place among those.
    pub number: u32,
    /// It met in this substep.
    pub met: bool,
    /// Its rows are placed where its bodies are after the middle of the substep.
    pub late: bool,
    /// It is apart in this substep: no row.
    pub apart_now: bool,
    /// Points that are watched and stand beside the face, where there is nothing to touch.
    pub beside: [bool; 2],
    /// Its impacts in the step.
    pub hit: Hit,
    /// Normal impulses of the rows in the step (N·s).
    pub passed: Real,
    /// Its part of the work that may be spent on solving all rows at once.
    pub credit: Real,
}

impl Link {
    /// Of a manifold that is kept at a place; all else as if nothing were known.
    #[must_use]
    pub fn new(manifold: Manifold, place: u32) -> Self {
        Self {
            manifold,
            apart: Vec2::zeros(),
            restitution: 0.0,
            width: 0.0,
            place,
            curvature: [0.0; 2],
            turning: 0.0,
            tangent_speed: 0.0,
            passes: [false; 2],
            resting: [0.0; 2],
            watched: Watched::No,
            number: 0,
            met: false,
            late: false,
            apart_now: false,
            beside: [false; 2],
            hit: Hit::default(),
            passed: 0.0,
            credit: 0.0,
        }
    }
}

/// Impacts of a contact in a step, for events. Time, place and speed are those of the fastest.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Normal impulses of all (N·s).
    pub impulse: Real,
    /// Approach (m/s); 0 where there was none.
    pub approach: Real,
    /// When (s).
    pub time: Real,
    /// Where, from A's centre of mass at the start of the step (m).
    pub point: Vec2,
    /// Normal, from A to B.
    pub normal: Vec2,
}

impl Default for Hit {
    fn default() -> Self {
        let zero = Vec2::zeros();
        Self { impulse: 0.0, approach: 0.0, time: 0.0, point: zero, normal: zero }
    }
}

/// What the rows of a substep do (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowWork {
    /// What they give the bodies beyond what driven surfaces do; below 0, as it should be, where they take.
    pub gain: Real,
    /// Done by driven surfaces.
    pub given: Real,
    /// ½ΔvᵀMΔv of the change of velocities that they make.
    pub changed: Real,
    /// What rounding may do to `gain`.
    pub rounding: Real,
}

/// Bodies that move together, in slots, and their contacts. Kept between steps, so that a warm step
/// allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// Which body of the world stands in each slot.
    pub bodies: Vec<u32>,
    /// Velocities.
    pub velocities: Vec<Velocity>,
    /// Places.
    pub places: Vec<Place>,
    /// Angles at the start of the step (rad).
    pub angles: Vec<Real>,
    /// How far from its start each body may get before what it can meet must be looked for anew (m).
    pub reach: Vec<Real>,
    /// Bodies that got farther, and how far (m).
    pub thrown: Vec<(u32, Real)>,
    /// Masses.
    pub masses: Vec<Mass>,
    /// Rows.
    pub blocks: Vec<Block>,
    /// The rest of each contact, in the order of the blocks.
    pub links: Vec<Link>,
    /// The joints.
    pub ties: Ties,
    /// The rows in packets.
    pub(super) lanes: Lanes,
    /// The rest of the contacts in packets.
    pub(super) wide: Wide,
    /// Some surface is driven: a kinematic body or a conveyor.
    pub driven: bool,
    /// Solves all rows at once.
    pub together: Option<Together>,
    /// Length of the substep (s).
    pub(super) h: Real,
    /// World time in the middle of the substep (s).
    pub(super) middle: Real,
    /// Velocities before the rows.
    pub(super) free: Vec<Twist>,
    /// Velocities that the rows left, before overlap is removed.
    #[cfg(test)]
    pub left: Vec<Velocity>,
    /// Where impacts may come.
    pub(super) watch: Watch,
    /// Of each contact that is watched, where it is going to meet if it is swift, and the manifold that the remembered
    /// impulses are of.
    pub(super) found: Vec<Manifold>,
    pub(super) loaded: Vec<Manifold>,
}

impl Group {
    /// Forgets everything but the memory.
    pub fn clear(&mut self) {
        self.bodies.clear();
        self.velocities.clear();
        self.places.clear();
        self.masses.clear();
        self.angles.clear();
        self.reach.clear();
        self.thrown.clear();
        self.blocks.clear();
        self.links.clear();
        self.ties.clear();
        self.lanes.clear();
        self.wide.on = false;
        self.driven = false;
        self.watch.clear();
        self.found.clear();
        self.loaded.clear();
    }

    /// Solves contacts one by one whatever pays, to compare.
    #[cfg(test)]
    pub fn one_by_one(&mut self) {
        self.lanes.off = true;
    }

    /// How often a group went by packets.
    #[cfg(test)]
    pub fn packings(&self) -> u32 {
        self.wide.packings
    }

    /// Notes which bodies have got beyond what was foreseen when what they can meet was looked for, and how far (m).
    pub(super) fn note_thrown(&mut self) {
        let ways = self.places.iter().map(|place| place.way.norm());
        let thrown =
            ways.zip(&self.reach).zip(&self.bodies).filter(|((way, reach), _)| way > *reach);
        self.thrown.extend(thrown.map(|((way, _), body)| (*body, way)));
    }

    /// The work of the rows of a substep.
    ///
    /// With half the drift before the rows and half after, an impulse p does the work p·½(v⁻ + v⁺), v⁻ the velocity
    /// at the start of the substep, whatever constant force acts meanwhile. What driven surfaces give is no gain.
    pub(super) fn row_work(&self, h: Real) -> RowWork {
        let mut work = RowWork::default();
        let bodies = self.velocities.iter().zip(&self.places).zip(&self.masses).zip(&self.free);
        for (((velocity, place), mass), free) in bodies {
            let (now, kick) = (&velocity.twist, place.kick(h));
            let change = Twist::new(now.linear - free.linear, now.angular - free.angular);
            let sum = Twist::new(
                now.linear + free.linear - kick.linear,
                now.angular + free.angular - kick.angular,
            );
            work.gain += 0.5 * mass.work(&change, &sum);
            work.changed += 0.5 * mass.work(&change, &change);
            work.rounding += Real::EPSILON * (mass.work(now, now) + mass.work(free, free));
        }
        work.given = if self.driven { self.driving_work() } else { 0.0 };
        work.gain -= work.given;
        work
    }

    fn driving_work(&self) -> Real {
        let work = |(block, link): (&Block, &Link)| {
            let bodies = block.bodies.map(|slot| &self.velocities[slot as usize]);
            driving_work(block, (&block.impulse, link.tangent_speed), bodies)
        };
        self.blocks.iter().zip(&self.links).map(work).sum()
    }

    /// Velocity of a body before the forces and rows of the substep of length h (s).
    #[must_use]
    pub fn before(&self, slot: u32, h: Real) -> Twist {
        let (free, kick) = (&self.free[slot as usize], self.places[slot as usize].kick(h));
        Twist::new(free.linear - kick.linear, free.angular - kick.angular)
    }

    /// Adds a contact, watched where it bounces or is swift.
    pub fn add_contact(&mut self, block: Block, mut link: Link) {
        if link.watched != Watched::No {
            link.number = self.watch.blocks.len() as u32;
            self.watch.blocks.push(self.blocks.len() as u32);
            self.found.push(link.manifold);
            self.loaded.push(link.manifold);
        }
        self.blocks.push(block);
        self.links.push(link);
    }
}

/// Work (J) that bodies with given motion and conveyors do through the impulses of a block.
pub(super) fn driving_work(
    block: &Block,
    (impulse, tangent_speed): (&[Real; 3], Real),
    [a, b]: [&Velocity; 2],
) -> Real {
    let (n, t) = (block.normal, block.tangent());
    let mut work = impulse[2] * tangent_speed;
    for (k, direction) in [n, n, t].into_iter().enumerate() {
        let [arm_a, arm_b] = block.arms[k];
        // On the other body acts p along the direction; at the speed of the surface it does this work.
        if a.is_fixed() {
            work += impulse[k] * a.along(direction, arm_a);
        }
        if b.is_fixed() {
            work -= impulse[k] * b.along(direction, arm_b);
        }
    }
    work
}
