//! Bodies that move together, and the contacts between them.

use super::impacts::Watch;
use crate::collision::Manifold;
use crate::constraints::contact::Block;
use crate::constraints::{Place, Velocity};
use crate::forces::Ledger;
use crate::math::{Real, Twist, Vec2};

/// m (kg) and I (kg·m²), for energies; 0 of a body whose motion is given.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mass {
    /// m.
    pub mass: Real,
    /// I.
    pub inertia: Real,
}

impl Mass {
    /// The change of energy along a change of velocity: m Δv·v + I Δω ω.
    #[must_use]
    pub fn work(&self, change: &Twist, mean: &Twist) -> Real {
        self.mass * change.linear.dot(&mean.linear) + self.inertia * change.angular * mean.angular
    }
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
    /// J̇v of points that carry a load (m/s²).
    pub curvature: [Real; 2],
    /// Approach (m/s) up to which a contact rests and does not bounce: what the substep's kicks give it.
    pub resting: [Real; 2],
    /// Arrivals are looked for: it bounces, or moves too far in a substep for its rows to foresee.
    pub watched: bool,
    /// Points that are watched and stand beside the face, where there is nothing to touch.
    pub beside: [bool; 2],
    /// Normal impulses of impacts in the step (N·s), for events.
    pub impact: Real,
    /// Fastest approach of an impact in the step (m/s).
    pub approach: Real,
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
    /// Masses.
    pub masses: Vec<Mass>,
    /// Rows.
    pub blocks: Vec<Block>,
    /// The rest of each contact, in the order of the blocks.
    pub links: Vec<Link>,
    /// Some surface is driven: a kinematic body or a conveyor.
    pub driven: bool,
    /// Velocities before the rows.
    pub(super) free: Vec<Twist>,
    /// h²/8: times its acceleration, how far a body's path is beyond the place after a drift of h/2 (s²).
    pub(super) sag: Real,
    /// Where impacts may come.
    pub(super) watch: Watch,
}

impl Group {
    /// Forgets everything but the memory.
    pub fn clear(&mut self) {
        self.bodies.clear();
        self.velocities.clear();
        self.places.clear();
        self.masses.clear();
        self.blocks.clear();
        self.links.clear();
        self.driven = false;
        self.watch.clear();
    }

    /// Books what the rows of a substep took from the bodies.
    ///
    /// With half the drift before the rows and half after, an impulse p does the work p·½(v⁻ + v⁺), v⁻ the velocity
    /// at the start of the substep, whatever constant force acts meanwhile. What driven surfaces give is work.
    pub(super) fn book_rows(&self, h: Real, ledger: &mut Ledger) {
        let mut gained = 0.0;
        let bodies = self.velocities.iter().zip(&self.places).zip(&self.masses).zip(&self.free);
        for (((velocity, place), mass), free) in bodies {
            let (now, kick) = (&velocity.twist, place.kick(h));
            let change = Twist::new(now.linear - free.linear, now.angular - free.angular);
            let sum = Twist::new(
                now.linear + free.linear - kick.linear,
                now.angular + free.angular - kick.angular,
            );
            gained += 0.5 * mass.work(&change, &sum);
        }
        let given = if self.driven { self.driving_work() } else { 0.0 };
        ledger.work += given;
        ledger.dissipated += given - gained;
    }

    fn driving_work(&self) -> Real {
        let work = |block: &Block| {
            let bodies = block.bodies.map(|slot| &self.velocities[slot as usize]);
            driving_work(block, &block.impulse, bodies)
        };
        self.blocks.iter().map(work).sum()
    }

    /// Adds a contact, watched where it bounces or is swift.
    pub fn add_contact(&mut self, block: Block, link: Link) {
        if link.watched {
            self.watch.blocks.push(self.blocks.len() as u32);
        }
        self.blocks.push(block);
        self.links.push(link);
    }
}

/// Work (J) that bodies with given motion and conveyors do through the impulses of a block.
pub(super) fn driving_work(block: &Block, impulse: &[Real; 3], [a, b]: [&Velocity; 2]) -> Real {
    let (n, t) = (block.normal, block.tangent());
    let mut work = impulse[2] * block.target[2];
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
