//! Bodies that touch or meet, moved from event to event to a tolerance.
//!
//! Between events every contact keeps its mode (it bears or not, sticks or slides) and the motion is smooth: a parabola where
//! nothing bears and forces are constant, else DOP853 on accelerations in which the rows of contacts and joints hold
//! exactly. Events are located on the path: shapes meet (impacts, by the law of impact), a contact lets go, breaks
//! away, comes to rest. Then modes are chosen anew (`choose.rs`). Bounces that have become too low to matter are summed: they end in a
//! plastic impact, which takes and gives in all what they would have.
//!
//! Pfeiffer and Glocker, "Multibody Dynamics with Unilateral Contacts" (1996).

mod arrival;
mod choose;
mod dense;
mod impact;
mod lcp;
mod leg;
mod modes;
mod path;
mod point;
mod rows;
mod switch;
mod touch;

pub use arrival::Pair;
pub use impact::Struck;
pub use modes::{Contact, Modes, Slip};
pub use touch::Touch;

use crate::body::ImpactLaw;
use crate::collision::Frame;
use crate::error::{Error, Result};
use crate::math::{Pose, Real, Twist};
use crate::methods::{Motion, Progress, Scratch, Sink, Span, System, Watch as Asks};
use choose::{Hint, choose};
use impact::{Rules, Taken, resolve, stop_low, stop_sliding};
use point::Point;

/// What an island is, and what is asked of its run.
pub struct Island<'a> {
    /// What may meet.
    pub pairs: Vec<Pair<'a>>,
    /// Law of impact.
    pub law: ImpactLaw,
    /// Forces are constant in time, place and velocity.
    pub constant: bool,
    /// Some surface is driven: by a body of given motion or as a conveyor.
    pub driven: bool,
    /// Sizes of the bodies, for errors (m).
    pub sizes: Vec<Real>,
    /// How far each body may get from its start (m).
    pub reach: Vec<Real>,
    /// Largest relative error of a step.
    pub tolerance: Real,
}

/// What a run took, and how it ended.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Steps and errors.
    pub progress: Progress,
    /// Impacts.
    pub struck: Vec<Struck>,
    /// Events located.
    pub events: u64,
    /// Bodies (slots) that got farther than was looked, and how far (m); the run ended there.
    pub thrown: Vec<(u32, Real)>,
    /// Pairs that began or ceased to touch; at first what each does.
    pub touched: Vec<Touch>,
    /// What bears at the end.
    pub bearing: Vec<Bearing>,
    /// When (s) and why events could not go on; the run ended there.
    pub gave_up: Option<(Real, &'static str)>,
}

/// Forces of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Bearing {
    /// Place of the pair in the island.
    pub pair: u32,
    /// Features of the points; of one alone twice the same.
    pub features: [u32; 2],
    /// Of the points along the normal, and along the tangent (N).
    pub force: [Real; 3],
    /// Whether the surfaces slide.
    pub slides: bool,
}

/// Events of one run.
const MOST_EVENTS: u64 = 1_000_000;

/// Events without time between them.
const MOST_AT_ONCE: u32 = 200;

/// An overlap beyond this part of the width is none that has come of rounding.
const DEEP: Real = 1e-7;

/// Bounces lower than this part of the tolerated error are over.
const LOW: Real = 0.1;

/// Moves an island through a span; `sink` takes the states at `samples` (s from the start of the span, increasing).
///
/// # Errors
/// Those of forces, of [`crate::methods::Adaptive::run`], and of `watch`.
pub fn run(
    island: &Island<'_>,
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    (span, samples): (Span, &[Real]),
    (scratch, sink, watch): (&mut Scratch, &mut Sink<'_>, &mut Asks<'_>),
) -> Result<Outcome> {
    let start: Vec<Pose> = motion.poses.to_vec();
    let mut run = Run {
        island,
        system,
        motion,
        span,
        samples,
        next: 0,
        passed: 0.0,
        start,
        hints: Vec::new(),
        met: Vec::new(),
        touching: Vec::new(),
        outcome: Outcome {
            progress: Progress { smallest: Real::INFINITY, ..Progress::default() },
            ..Outcome::default()
        },
    };
    let mut at_once = 0;
    while run.goes_on() {
        watch().map_err(|source| Error::Interrupted { source })?;
        let before = run.passed;
        run.settle_event()?;
        if run.goes_on() {
            run.leg((&mut *scratch, &mut *sink, &mut *watch))?;
        }
        at_once = if run.passed > before { 0 } else { at_once + 1 };
        if at_once > MOST_AT_ONCE || run.outcome.events > MOST_EVENTS {
            let time = run.time();
            run.outcome.gave_up.get_or_insert((time, "events follow one another without end"));
        }
    }
    run.hand_out_rest(sink);
    run.note_bearing()?;
    Ok(run.outcome)
}

struct Run<'r, 'a, 's, 'm> {
    island: &'r Island<'a>,
    system: &'r mut System<'s>,
    motion: &'r mut Motion<'m>,
    span: Span,
    samples: &'r [Real],
    /// The next sample.
    next: usize,
    /// Time since the start of the span (s).
    passed: Real,
    start: Vec<Pose>,
    /// What the last event found out.
    hints: Vec<Hint>,
    /// Points that have just met.
    met: Vec<(u32, Option<Point>)>,
    /// Which pairs touch, as far as that is known.
    touching: Vec<Option<bool>>,
    outcome: Outcome,
}

impl Run<'_, '_, '_, '_> {
    fn goes_on(&self) -> bool {
        self.passed < self.span.duration
            && self.outcome.thrown.is_empty()
            && self.outcome.gave_up.is_none()
    }

    fn time(&self) -> Real {
        self.span.start + self.passed
    }

    /// Accelerations in the present modes.
    fn accelerations(&mut self) -> Result<Vec<Twist>> {
        let mut out = vec![Twist::ZERO; self.motion.poses.len()];
        let time = self.time();
        self.system.accelerate(time, self.motion.poses, self.motion.twists, &mut out)?;
        Ok(out)
    }

    /// Accelerations by forces alone.
    fn free_accelerations(&mut self) -> Result<Vec<Twist>> {
        let modes = self.system.modes.take();
        let free = self.accelerations();
        self.system.modes = modes;
        free
    }

    /// Impacts of what meets, and modes of what touches then.
    fn settle_event(&mut self) -> Result<()> {
        const JAMS: u32 = 8;
        let accelerations = self.accelerations()?;
        let Some(contacts) = self.contacts() else { return Ok(()) };
        let (free, now_at) = (self.free_accelerations()?, self.time());
        let Self { island, system, motion, outcome, .. } = self;
        let Some(modes) = &mut system.modes else { return Ok(()) };
        modes.contacts = contacts;
        let speed = |contact: &Contact, twists: &[Twist]| still(island, contact, twists, &free);
        let before = motion.twists.to_vec();
        let masses = system.forces.masses;
        let energy = |twists: &[Twist]| -> Real {
            masses.iter().zip(twists).map(|(mass, twist)| mass.kinetic_energy(twist)).sum()
        };
        let mut taken = Taken::default();
        let mut bent = Vec::new();
        for jam in 0.. {
            let now = motion.twists.to_vec();
            let (settled, quiet) = (
                |c: &Contact, u: Real, a: Real| is_low(island, c, u, a),
                |c: &Contact| speed(c, &now),
            );
            let rules = Rules { law: island.law, still: &quiet, settled: &settled };
            let impacts = resolve(modes, motion.poses, motion.twists, &accelerations, &rules);
            taken.struck.extend(impacts.struck);
            taken.dissipated += impacts.dissipated;
            let now = motion.twists.to_vec();
            let quiet = |contact: &Contact| speed(contact, &now);
            let state = (&*motion.poses, &now[..]);
            if choose(modes, state, &free, (&self.hints, &quiet)) {
                bent.clone_from(&free);
                modes.accelerate(motion.poses, &now, &mut bent);
                let low = |c: &Contact, u: Real, a: Real| is_low(island, c, u, a);
                let stopped = stop_low(modes, (motion.poses, motion.twists), &bent, (&quiet, &low));
                if !stopped {
                    break;
                }
                taken.dissipated += energy(&now) - energy(motion.twists);
            } else if !stop_sliding(modes, motion.poses, motion.twists, (&quiet, &mut taken)) {
                outcome.gave_up = Some((now_at, "no modes of the contacts fit the forces"));
                return Ok(());
            }
            if jam == JAMS {
                outcome.gave_up = Some((now_at, "no modes of the contacts fit the forces"));
                return Ok(());
            }
        }
        motion.ledger.dissipated += taken.dissipated;
        if island.driven {
            motion.ledger.work += energy(motion.twists) - energy(&before) + taken.dissipated;
        }
        let time = self.span.start + self.passed;
        outcome.struck.extend(taken.struck.into_iter().map(|hit| Struck { time, ..hit }));
        self.note_touches(&bent);
        self.hints.clear();
        self.met.clear();
        Ok(())
    }

    /// What touches now; none, and a reason noted, where shapes overlap by more than rounding.
    fn contacts(&mut self) -> Option<Vec<Contact>> {
        let mut contacts = Vec::new();
        for (k, pair) in self.island.pairs.iter().enumerate() {
            let frames = pair.slots.map(|slot| Frame::of(&self.motion.poses[slot as usize]));
            let bodies = [0, 1].map(|side| (pair.colliders[side], &frames[side]));
            let just_met = self.met.iter().any(|(met, _)| *met as usize == k);
            let margin = pair.touching(&frames)
                + if just_met { self.island.tolerance.min(1e-3) * pair.width } else { 0.0 };
            for manifold in pair.manifolds(&frames, margin) {
                let mut points = [Point::of(&manifold, 0, bodies); 2];
                let mut count = 0;
                for p in 0..manifold.count {
                    let point = Point::of(&manifold, p, bodies);
                    let gap = point.seen([&frames[0], &frames[1]]).gap;
                    if gap < -self.deep() * pair.width {
                        self.outcome.gave_up =
                            Some((self.span.start + self.passed, "shapes overlap"));
                        return None;
                    }
                    let met = self.met.iter().any(|(met, features)| {
                        *met as usize == k
                            && features.is_none_or(|features| features.feature == point.feature)
                    });
                    if met || gap <= pair.touching(&frames) {
                        points[count] = point;
                        count += 1;
                    }
                }
                if count > 0 {
                    contacts.push(Contact {
                        pair: k as u32,
                        slots: pair.slots,
                        points,
                        count,
                        on: [false; 2],
                        slip: Slip::Sticks,
                        touch: pair.touch,
                        force: [0.0; 3],
                    });
                }
            }
        }
        Some(contacts)
    }

    fn deep(&self) -> Real {
        DEEP.max(4.0 * self.island.tolerance)
    }
}

/// Speeds (m/s) of a contact below which it does not move: rounding of what its bodies do, and of what forces do to them.
fn still(island: &Island<'_>, contact: &Contact, twists: &[Twist], forces: &[Twist]) -> Real {
    let pair = &island.pairs[contact.pair as usize];
    let of = |side: usize| {
        let (slot, reach) = (contact.slots[side] as usize, pair.colliders[side].reach);
        let speed = twists[slot].linear.norm() + reach * twists[slot].angular.abs();
        let pull = forces[slot].linear.norm() + reach * forces[slot].angular.abs();
        (speed, pull)
    };
    let [a, b] = [of(0), of(1)];
    1e-12 * (a.0 + b.0) + 1e-13 * ((a.1 + b.1) * pair.width).sqrt()
}

/// Whether what leaves at a speed under a pull comes no higher than matters.
fn is_low(island: &Island<'_>, contact: &Contact, speed: Real, pull: Real) -> bool {
    let size = contact.slots.map(|slot| island.sizes[slot as usize]);
    let width = island.pairs[contact.pair as usize].width;
    let size = size[0].min(size[1]).min(width).max(Real::MIN_POSITIVE);
    speed * speed <= 2.0 * pull * LOW * island.tolerance * size
}
