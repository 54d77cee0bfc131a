//! Impacts of what has met: by the law of impact, one contact after the other, the fastest first; several at once where they
//! are equally fast, and where nothing bounces all that touch, so that what rests on one another comes to rest at once
//! (Moreau 1988).

use super::lcp;
use super::modes::{Contact, Modes};
use super::rows::Responses;
use crate::body::ImpactLaw;
use crate::collision::{Anchor, Frame, Manifold, Normal};
use crate::constraints::contact::{Block, Memory, Touch};
use crate::math::{Pose, Real, Twist, Vec2, vec2};
use crate::methods::contact_step::law;

/// What an impact was, for events.
#[derive(Clone, Copy, Debug)]
pub struct Struck {
    /// Place of the pair in the island.
    pub pair: u32,
    /// World time (s).
    pub time: Real,
    /// Where, from A's centre of mass then, and where that was (m).
    pub point: Vec2,
    /// From A to B.
    pub normal: Vec2,
    /// Approach (m/s).
    pub approach: Real,
    /// Normal impulse (N·s).
    pub impulse: Real,
}

/// Speeds (m/s) up to which a contact does not move.
pub type Still<'a> = dyn Fn(&Contact) -> Real + 'a;

/// Whether a point that leaves at a speed under an acceleration towards the surface comes back so soon that its bounces are over.
pub type Low<'a> = dyn Fn(&Contact, Real, Real) -> bool + 'a;

/// What decides about impacts.
pub struct Rules<'a> {
    /// The law.
    pub law: ImpactLaw,
    /// Approach (m/s) up to which a contact does not move.
    pub still: &'a Still<'a>,
    /// Whether bounces are over.
    pub settled: &'a Low<'a>,
}

/// What impacts took.
#[derive(Debug, Default)]
pub struct Taken {
    /// Each of them.
    pub struck: Vec<Struck>,
    /// Energy that is gone (J).
    pub dissipated: Real,
    /// How long (s) bounces that were summed up would have gone on.
    pub bouncing: Real,
    /// The sequence did not end; what was left was stopped.
    pub endless: bool,
}

/// Resolves all impacts of what touches. `accelerations` are those before.
pub fn resolve(
    modes: &mut Modes,
    poses: &[Pose],
    twists: &mut [Twist],
    accelerations: &[Twist],
    rules: &Rules<'_>,
) -> Taken {
    let mut taken = Taken::default();
    modes.look(poses, twists);
    let responses = modes.responses(poses, twists);
    let most = 64 + 64 * modes.contacts.len();
    for round in 0.. {
        let approaching = approaches(&modes.contacts, &responses, twists, rules);
        let Some(fastest) = approaching.iter().map(|(_, speed)| *speed).reduce(Real::max) else {
            break;
        };
        taken.endless = round >= most;
        // Those that are as fast but for rounding meet together.
        let first: Vec<usize> = approaching
            .iter()
            .filter(|(_, speed)| *speed >= fastest * (1.0 - 1e-9))
            .map(|(k, _)| *k)
            .collect();
        let bounce = Bounce { modes, poses, responses: &responses, rules, accelerations };
        if taken.endless {
            bounce.stop_all(twists, &mut taken);
            break;
        }
        let bounces = first.iter().any(|k| bounce.restitution(*k, twists, &mut 0.0) != [0.0; 2]);
        match (&first[..], bounces) {
            ([one], true) => bounce.one(*one, twists, &mut taken),
            (_, true) => bounce.together(&first, twists, &mut taken),
            (_, false) => bounce.stop(twists, &mut taken),
        }
    }
    taken
}

/// Contacts that approach, and how fast.
fn approaches(
    contacts: &[Contact],
    responses: &Responses,
    twists: &[Twist],
    rules: &Rules<'_>,
) -> Vec<(usize, Real)> {
    let speed = |(k, contact): (usize, &Contact)| {
        let points = (0..contact.count).map(|p| -responses.along(3 * k + p, twists));
        let fastest = points.fold(Real::NEG_INFINITY, Real::max);
        (fastest > (rules.still)(contact)).then_some((k, fastest))
    };
    contacts.iter().enumerate().filter_map(speed).collect()
}

struct Bounce<'a> {
    modes: &'a Modes,
    poses: &'a [Pose],
    responses: &'a Responses,
    rules: &'a Rules<'a>,
    accelerations: &'a [Twist],
}

impl Bounce<'_> {
    /// Restitution of the points of a contact: 0 where the bounces that are left are too low to matter; adds how long they
    /// would have gone on: 2eu/(a(1 − e)) (s).
    fn restitution(&self, k: usize, twists: &[Twist], bouncing: &mut Real) -> [Real; 2] {
        let contact = &self.modes.contacts[k];
        let e = contact.touch.restitution;
        [0, 1].map(|p| {
            let row = 3 * k + p;
            let approach = -self.responses.along(row, twists);
            if p >= contact.count || approach <= 0.0 || e == 0.0 {
                return 0.0;
            }
            let pull = -(self.responses.along(row, self.accelerations) + self.responses.bias(row));
            let settled =
                e < 1.0 && pull > 0.0 && (self.rules.settled)(contact, e * approach, pull);
            if settled {
                *bouncing = bouncing.max(2.0 * e * approach / (pull * (1.0 - e)));
            }
            if settled { 0.0 } else { e }
        })
    }

    /// One contact by the law.
    fn one(&self, k: usize, twists: &mut [Twist], taken: &mut Taken) {
        let contact = &self.modes.contacts[k];
        let still = (self.rules.still)(contact);
        let restitution = self.restitution(k, twists, &mut taken.bouncing);
        let mut block = block_of(contact);
        let mut u = [0, 1, 2].map(|r| self.responses.along(3 * k + r, twists));
        u[2] -= contact.touch.tangent_speed;
        block.on = [0, 1].map(|p| p < contact.count && u[p] < still);
        let w = |i: usize, j: usize| self.responses.coupling(3 * k + i, 3 * k + j);
        block.respond([w(0, 0), w(1, 1), w(0, 1), w(0, 2), w(1, 2), w(2, 2)]);
        let impulse = law::impulses(self.rules.law, &block, u, restitution);
        taken.dissipated -= law::gain(&block, &u, &impulse);
        self.book(k, [u[0], u[1]], impulse, taken);
        for (r, p) in impulse.into_iter().enumerate() {
            self.responses.push(3 * k + r, p, twists);
        }
    }

    /// Several contacts that bounce at once: u⁺ ≥ −e u⁻, with Coulomb's friction at the velocities after.
    fn together(&self, which: &[usize], twists: &mut [Twist], taken: &mut Taken) {
        let speeds: Vec<[Real; 2]> = (0..self.modes.contacts.len())
            .map(|k| {
                let e = self.restitution(k, twists, &mut taken.bouncing);
                [0, 1].map(|p| -e[p] * self.responses.along(3 * k + p, twists))
            })
            .collect();
        self.jump(which, &speeds, twists, taken);
    }

    /// All contacts that do not bounce, at once.
    fn stop(&self, twists: &mut [Twist], taken: &mut Taken) {
        let mut bouncing = 0.0;
        let plastic = |k: &usize| self.restitution(*k, twists, &mut bouncing) == [0.0; 2];
        let which: Vec<usize> = (0..self.modes.contacts.len()).filter(plastic).collect();
        taken.bouncing = taken.bouncing.max(bouncing);
        let none = vec![[0.0; 2]; self.modes.contacts.len()];
        self.jump(&which, &none, twists, taken);
    }

    fn stop_all(&self, twists: &mut [Twist], taken: &mut Taken) {
        let which: Vec<usize> = (0..self.modes.contacts.len()).collect();
        let none = vec![[0.0; 2]; which.len()];
        self.jump(&which, &none, twists, taken);
    }

    /// Impulses on some contacts at once, after which their points leave at these speeds or faster.
    fn jump(&self, which: &[usize], leave: &[[Real; 2]], twists: &mut [Twist], taken: &mut Taken) {
        let before = twists.to_vec();
        let impulses = self.simultaneous(which, leave, twists);
        for (k, impulse) in which.iter().zip(&impulses) {
            for (r, p) in impulse.iter().enumerate() {
                self.responses.push(3 * k + r, *p, twists);
            }
        }
        for (k, impulse) in which.iter().zip(&impulses) {
            let u = [0, 1, 2].map(|r| self.responses.along(3 * k + r, &before));
            let after = [0, 1, 2].map(|r| self.responses.along(3 * k + r, twists));
            let driven = self.modes.contacts[*k].touch.tangent_speed;
            for r in 0..3 {
                let target = if r == 2 { driven } else { 0.0 };
                taken.dissipated -= impulse[r] * (0.5 * (u[r] + after[r]) - target);
            }
            if impulse[0] + impulse[1] > 0.0 {
                self.book(*k, [u[0], u[1]], *impulse, taken);
            }
        }
    }

    /// u⁺ − u_leave ⟂ p ≥ 0, and Coulomb's law at the slip after: for each contact two points, the tangent both ways, and its bound.
    fn simultaneous(
        &self,
        which: &[usize],
        leave: &[[Real; 2]],
        twists: &[Twist],
    ) -> Vec<[Real; 3]> {
        const SIZE: usize = 5;
        let n = SIZE * which.len();
        let mut matrix = vec![0.0; n * n];
        let mut q = vec![0.0; n];
        let scale = |k: usize| {
            let own = self.responses.coupling(3 * k, 3 * k);
            if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
        };
        // Row of the contact and sign of the first four unknowns.
        let rows = [(0, 1.0), (1, 1.0), (2, 1.0), (2, -1.0)];
        for (i, &k) in which.iter().enumerate() {
            let contact = &self.modes.contacts[k];
            let at = SIZE * i;
            for (a, (row, sign)) in rows.into_iter().enumerate() {
                let absent = row == 1 && contact.count < 2;
                let target = if row == 2 { contact.touch.tangent_speed } else { leave[k][row] };
                let u = self.responses.along(3 * k + row, twists) - target;
                q[at + a] = if absent { 0.0 } else { sign * u * scale(k) };
                for (j, &other) in which.iter().enumerate() {
                    let theirs = &self.modes.contacts[other];
                    for (b, (column, way)) in rows.into_iter().enumerate() {
                        if absent || (column == 1 && theirs.count < 2) {
                            continue;
                        }
                        let w = self.responses.coupling(3 * k + row, 3 * other + column);
                        matrix[(at + a) * n + SIZE * j + b] =
                            sign * way * w * scale(k) * scale(other);
                    }
                }
            }
            let mu = contact.touch.friction.sliding;
            let bound = at + 4;
            for b in 0..2 {
                matrix[bound * n + at + b] = mu;
                matrix[bound * n + at + 2 + b] = -1.0;
                matrix[(at + 2 + b) * n + bound] = 1.0;
            }
        }
        let Some(z) = lcp::solve(&matrix, &q) else { return vec![[0.0; 3]; which.len()] };
        let of = |(i, k): (usize, &usize)| {
            let at = SIZE * i;
            let s = scale(*k);
            [z[at] * s, z[at + 1] * s, (z[at + 2] - z[at + 3]) * s]
        };
        which.iter().enumerate().map(of).collect()
    }

    fn book(&self, k: usize, u: [Real; 2], impulse: [Real; 3], taken: &mut Taken) {
        let contact = &self.modes.contacts[k];
        let frames = self.modes.frames(contact.slots);
        taken.struck.push(struck((contact, frames), self.poses, u, impulse));
    }
}

/// What an impact was; its time is the run's to know.
fn struck(
    (contact, frames): (&Contact, [&Frame; 2]),
    poses: &[Pose],
    u: [Real; 2],
    impulse: [Real; 3],
) -> Struck {
    let seen = [0, 1].map(|p| contact.seen(p.min(contact.count - 1), frames));
    let bearing: Vec<usize> = (0..contact.count).filter(|p| impulse[*p] > 0.0).collect();
    let points: Vec2 = bearing.iter().map(|p| seen[*p].arms[0]).sum();
    Struck {
        pair: contact.pair,
        time: 0.0,
        point: poses[contact.slots[0] as usize].position + points / bearing.len().max(1) as Real,
        normal: seen[0].normal,
        approach: -u[0].min(u[1]),
        impulse: impulse[0] + impulse[1],
    }
}

/// Surfaces that jam: where sliding has no solution without a jump an impulse stops it at once, as in an impact without an
/// approach (Painlevé's paradox; Génot and Brogliato 1999). Whether anything was stopped.
pub fn stop_sliding(
    modes: &mut Modes,
    poses: &[Pose],
    twists: &mut [Twist],
    (still, taken): (&dyn Fn(&Contact) -> Real, &mut Taken),
) -> bool {
    modes.look(poses, twists);
    let responses = modes.responses(poses, twists);
    let mut stopped = false;
    for (k, contact) in modes.contacts.iter().enumerate() {
        for p in 0..contact.count {
            let un = responses.along(3 * k + p, twists);
            let slip = responses.along(3 * k + 2, twists) - contact.touch.tangent_speed;
            let mu = contact.touch.friction.sliding;
            let w = |i: usize, j: usize| responses.coupling(3 * k + i, 3 * k + j);
            let pushed = w(p, p) - slip.signum() * mu * w(p, 2);
            if un > still(contact) || slip.abs() <= still(contact) || pushed > 0.0 {
                continue;
            }
            let mut block = block_of(contact);
            block.on = [p == 0, p == 1];
            block.respond([w(0, 0), w(1, 1), w(0, 1), w(0, 2), w(1, 2), w(2, 2)]);
            let mut u = [0.0, 0.0, slip];
            u[p] = un.min(0.0);
            let impulse = law::impulses(ImpactLaw::Poisson, &block, u, [0.0; 2]);
            taken.dissipated -= law::gain(&block, &u, &impulse);
            taken.struck.push(struck(
                (contact, modes.frames(contact.slots)),
                poses,
                [u[0], u[1]],
                impulse,
            ));
            for (r, x) in impulse.into_iter().enumerate() {
                responses.push(3 * k + r, x, twists);
            }
            stopped = true;
        }
    }
    stopped
}

/// Stops points that leave so slowly, under forces that bring them back, that what follows is too low to matter: a block that rocks from
/// corner to corner ever faster comes to rest. Whether anything was stopped. `accelerations` are those in the modes chosen.
pub fn stop_low(
    modes: &mut Modes,
    (poses, twists): (&[Pose], &mut [Twist]),
    accelerations: &[Twist],
    (still, low): (&Still<'_>, &Low<'_>),
) -> bool {
    let responses = modes.responses(poses, twists);
    let mut stopped = false;
    for (k, contact) in modes.contacts.iter_mut().enumerate() {
        for p in (0..contact.count).filter(|p| !contact.on[*p]).collect::<Vec<_>>() {
            let speed = responses.along(3 * k + p, twists);
            let pull = -(responses.along(3 * k + p, accelerations) + responses.bias(3 * k + p));
            if speed > still(contact) && pull > 0.0 && low(contact, speed, pull) {
                contact.on[p] = true;
                stopped = true;
            }
        }
    }
    if stopped {
        modes.halt_all(poses, twists);
    }
    stopped
}

/// A block with the friction of a contact; its response is set by who knows it.
fn block_of(contact: &Contact) -> Block {
    let manifold = Manifold {
        normal: Normal::OnA(vec2(0.0, 1.0)),
        anchors: [Anchor::default(); 2],
        count: contact.count,
        radius_a: 0.0,
        radius_b: 0.0,
        face: [0.0; 2],
    };
    let touch: Touch = contact.touch;
    Block::new([0; 2], &manifold, &touch, &Memory::NEW)
}
