//! Which modes hold: each point bears or lets go, the surfaces of each contact stick or slide.
//!
//! For given velocities the accelerations of what touches are a linear complementarity problem: n·a ⟂ λ ≥ 0, and of surfaces
//! at rest against one another |λ_t| ≤ μλ with t·a = 0 or against the force (Lötstedt, "Coulomb friction in
//! two-dimensional rigid body systems", 1981; Glocker and Pfeiffer, 1993). Surfaces that slide already rub with μ of
//! sliding, those that begin to break away at μ of sticking.

use super::impact::Still;
use super::lcp;
use super::modes::{Contact, Modes, Slip};
use super::rows::Responses;
use crate::collision::Frame;
use crate::math::{Pose, Real, Twist};

/// What an event has found out that rounding would hide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hint {
    /// This point of this pair bears no more.
    LetsGo(u32, u32),
    /// The surfaces of the contact with this first point have come to rest against one another.
    Stopped(u32, u32),
    /// They begin to slide, along the tangent or against it.
    Breaks(u32, u32, Real),
}

/// A force below this part of the largest is none.
const NONE: Real = 1e-11;

/// An acceleration along the surface below this part of the largest is none: rows that depend on one another leave a little.
const AWAY: Real = 1e-9;

/// Chooses the modes for accelerations by other forces, `free`. False where there is no solution without a jump.
pub fn choose(
    modes: &mut Modes,
    (poses, twists): (&[Pose], &[Twist]),
    free: &[Twist],
    (hints, still): (&[Hint], &Still<'_>),
) -> bool {
    modes.look(poses, twists);
    // Friction acts at the points that may bear.
    for k in 0..modes.contacts.len() {
        let contact = &modes.contacts[k];
        let may = may_bear(contact, modes.frames(contact.slots), twists, (hints, still));
        modes.contacts[k].on = may;
    }
    let responses = modes.responses(poses, twists);
    let mut wishes = Vec::new();
    for contact in &modes.contacts {
        let slip = contact.slip_speed(modes.frames(contact.slots), twists);
        wishes.push(Wish::of(contact, slip, (hints, still)));
    }
    modes.contacts.iter_mut().for_each(|contact| contact.on = [false; 2]);
    let mut start = free.to_vec();
    modes.accelerate(poses, twists, &mut start);
    // Each round one contact more breaks away, with the friction of sliding from then on.
    loop {
        let Some(answer) = solve(&modes.contacts, &wishes, &responses, &start) else {
            return false;
        };
        let mut broke = false;
        for (wish, answer) in wishes.iter_mut().zip(&answer) {
            let differs = wish.touch.sticking != wish.touch.sliding;
            if let (None, Slip::Slides(sigma), true) = (wish.slides, answer.slip, differs) {
                wish.slides = Some(sigma);
                broke = true;
            }
        }
        if !broke {
            for (contact, answer) in modes.contacts.iter_mut().zip(&answer) {
                (contact.on, contact.slip) = (answer.on, answer.slip);
            }
            return true;
        }
    }
}

/// What is known of a contact before its modes are chosen.
struct Wish {
    /// Points that may bear.
    may: [bool; 2],
    /// Which way it slides, if it does.
    slides: Option<Real>,
    touch: crate::body::Friction,
}

struct Answer {
    on: [bool; 2],
    slip: Slip,
}

/// Points of a contact that may bear: those that do not leave.
fn may_bear(
    contact: &Contact,
    frames: [&Frame; 2],
    twists: &[Twist],
    (hints, still): (&[Hint], &Still<'_>),
) -> [bool; 2] {
    let pair = contact.slots.map(|slot| &twists[slot as usize]);
    [0, 1].map(|p| {
        if p >= contact.count {
            return false;
        }
        let seen = contact.seen(p, frames);
        let leaves = seen.normal.dot(&seen.velocity(pair)) > still(contact);
        !leaves && !hints.contains(&Hint::LetsGo(contact.pair, contact.points[p].feature))
    })
}

impl Wish {
    fn of(contact: &Contact, slip: Real, (hints, still): (&[Hint], &Still<'_>)) -> Self {
        let (may, speed) = (contact.on, still(contact));
        let name = (contact.pair, contact.points[0].feature);
        let stopped = hints.contains(&Hint::Stopped(name.0, name.1)) || slip.abs() <= speed;
        let breaks = hints.iter().find_map(|hint| match *hint {
            Hint::Breaks(pair, feature, sigma) if (pair, feature) == name => Some(sigma),
            _ => None,
        });
        let slides = breaks.or(if stopped { None } else { Some(slip.signum()) });
        Self { may, slides, touch: contact.touch.friction }
    }
}

/// An unknown of the problem, and its row.
#[derive(Clone, Copy)]
enum Unknown {
    /// Force of a point.
    Normal(usize, usize),
    /// Force along the tangent, or against it.
    Along(usize, Real),
    /// How far the surfaces get away from it.
    Away(usize),
}

fn unknowns(wishes: &[Wish]) -> Vec<Unknown> {
    let mut all = Vec::new();
    for (k, wish) in wishes.iter().enumerate() {
        all.extend((0..2).filter(|p| wish.may[*p]).map(|p| Unknown::Normal(k, p)));
        if wish.slides.is_none() && wish.touch.sticking > 0.0 && wish.may != [false; 2] {
            all.extend([Unknown::Along(k, 1.0), Unknown::Along(k, -1.0), Unknown::Away(k)]);
        }
    }
    all
}

fn solve(
    contacts: &[Contact],
    wishes: &[Wish],
    responses: &Responses,
    start: &[Twist],
) -> Option<Vec<Answer>> {
    let all = unknowns(wishes);
    let problem = Problem { wishes, responses };
    let matrix: Vec<Real> =
        all.iter().flat_map(|i| all.iter().map(|j| problem.entry(*i, *j))).collect();
    let q: Vec<Real> = all.iter().map(|i| problem.constant(*i, start)).collect();
    let forces = lcp::solve(&matrix, &q)?;
    let largest = forces.iter().copied().fold(0.0, Real::max);
    let fastest = q.iter().fold(0.0, |most: Real, x| most.max(x.abs()));
    let mut answer: Vec<Answer> = wishes
        .iter()
        .zip(contacts)
        .map(|(wish, _)| Answer {
            on: [false; 2],
            slip: wish.slides.map_or(Slip::Sticks, Slip::Slides),
        })
        .collect();
    let mut along = vec![0.0; wishes.len()];
    for (unknown, force) in all.iter().zip(&forces) {
        match *unknown {
            Unknown::Normal(k, p) => answer[k].on[p] = *force > NONE * largest,
            Unknown::Along(k, sign) => along[k] += sign * force,
            Unknown::Away(k) => {
                if *force > AWAY * fastest {
                    // Friction acts against the way the surfaces go.
                    answer[k].slip = Slip::Slides(-along[k].signum());
                }
            }
        }
    }
    for (wish, answer) in wishes.iter().zip(&mut answer) {
        if wish.slides.is_none() && wish.touch.sticking == 0.0 {
            answer.slip = Slip::Slides(1.0);
        }
    }
    Some(answer)
}

struct Problem<'a> {
    wishes: &'a [Wish],
    responses: &'a Responses,
}

impl Problem<'_> {
    /// What makes rows of a contact ones.
    fn scale(&self, k: usize) -> Real {
        let own = self.responses.coupling(3 * k, 3 * k);
        if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
    }

    /// Rows along which an unknown pushes, and how much.
    fn pushes(&self, unknown: Unknown) -> [(usize, Real); 2] {
        match unknown {
            Unknown::Normal(k, p) => {
                let wish = &self.wishes[k];
                let friction = wish.slides.map_or(0.0, |sigma| -sigma * wish.touch.sliding);
                [(3 * k + p, 1.0), (3 * k + 2, friction)]
            }
            Unknown::Along(k, sign) => [(3 * k + 2, sign), (3 * k + 2, 0.0)],
            Unknown::Away(k) => [(3 * k + 2, 0.0); 2],
        }
    }

    fn entry(&self, i: Unknown, j: Unknown) -> Real {
        match (i, j) {
            (Unknown::Away(k), Unknown::Normal(l, _)) if k == l => self.wishes[k].touch.sticking,
            (Unknown::Away(k), Unknown::Along(l, _)) if k == l => -1.0,
            (Unknown::Away(_), _) => 0.0,
            (Unknown::Along(k, _), Unknown::Away(l)) => {
                if k == l {
                    1.0
                } else {
                    0.0
                }
            }
            (Unknown::Normal(..), Unknown::Away(_)) => 0.0,
            _ => {
                let (row, sign) = self.row(i);
                let push = |(other, x): (usize, Real)| {
                    if x == 0.0 { 0.0 } else { x * self.responses.coupling(row, other) }
                };
                let sum: Real = self.pushes(j).into_iter().map(push).sum();
                sign * sum * self.scale(row / 3) * self.scale(j.contact())
            }
        }
    }

    fn constant(&self, i: Unknown, start: &[Twist]) -> Real {
        if let Unknown::Away(_) = i {
            return 0.0;
        }
        let (row, sign) = self.row(i);
        let free = self.responses.along(row, start) + self.responses.bias(row);
        // What is below rounding of its terms is none.
        let terms = self.responses.speeds(row, start) + self.responses.bias(row).abs();
        let free = if free.abs() <= 64.0 * Real::EPSILON * terms { 0.0 } else { free };
        sign * free * self.scale(row / 3)
    }

    fn row(&self, unknown: Unknown) -> (usize, Real) {
        match unknown {
            Unknown::Normal(k, p) => (3 * k + p, 1.0),
            Unknown::Along(k, sign) => (3 * k + 2, sign),
            Unknown::Away(k) => (3 * k + 2, 0.0),
        }
    }
}

impl Unknown {
    fn contact(self) -> usize {
        match self {
            Self::Normal(k, _) | Self::Along(k, _) | Self::Away(k) => k,
        }
    }
}
