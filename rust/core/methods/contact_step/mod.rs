//! The contact step: the midpoint rule with impacts, after Moreau ("Numerical aspects of the sweeping
//! process", 1999) and Jean ("The non-smooth contact dynamics method", 1999).
//!
//! A substep of length h: drift by h/2; half kick; impacts, located inside the substep; half kick; contact and
//! friction rows at the level of velocities, with the geometry of the midpoint; drift by h/2; what overlaps too far is
//! moved apart, positions only, and the work that costs against the forces is booked.
//!
//! It is exact for constant forces, and a contact that persists along a curve obeys J(v⁻ + v⁺) = 0, so that a
//! smooth ball in a bowl keeps its energy.

mod group;
mod impacts;
pub mod joints;
pub(in crate::methods) mod law;
pub mod matter;
mod matter_direct;
mod matter_energy;
mod matter_lever;
pub mod matter_ties;
pub mod newton;
mod path;
mod project;
mod purse;
mod settle;
mod wide;

use crate::body::ImpactLaw;
use crate::collision::{Manifold, Sweep};
use crate::constraints::Place;
use crate::constraints::contact::{Block, curvature, moved};
use crate::error::Result;
use crate::forces::Ledger;
use crate::math::{Real, Twist};
use crate::methods::Span;
use crate::solvers::Solver;
use crate::solvers::sweep::{self, Budget};
pub use group::{Group, Hit, Link, Mass, Watched};
pub use joints::Tie;
pub(in crate::methods) use path::first_root;

/// What else acts on the bodies of a group.
pub trait Surroundings {
    /// Writes the accelerations that hold over the substep of length h around a time into the places.
    ///
    /// # Errors
    /// Those of the user's fields.
    fn accelerate(&mut self, span: (Real, Real), group: &mut Group) -> Result<()>;

    /// Work (J) that forces without a potential did over the substep, its rows solved.
    fn work(&mut self, _group: &Group) -> Real {
        0.0
    }

    /// Moves the bodies for a time h with no force but the air's and damping; returns what those take (J).
    ///
    /// # Errors
    /// Motion that the flow of the drag cannot give.
    fn drift(&mut self, h: Real, group: &mut Group) -> Result<Real>;

    /// First fraction of the ways of the two bodies of a contact at which their shapes are within `target` (m) of
    /// one another, and the manifold there. The ways are counted from A's centre of mass at the start of the step.
    fn meet(&self, link: &Link, ways: &[Sweep; 2], target: Real) -> Option<(Real, Manifold)>;

    /// The manifold at the start of two ways with all that may touch along them; none if nothing may.
    fn look(&self, link: &Link, ways: &[Sweep; 2]) -> Option<Manifold>;
}

/// How hard to try.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Law of impact.
    pub law: ImpactLaw,
    /// Most sweeps over the rows a substep.
    pub sweeps: u32,
    /// How rows are solved.
    pub solver: Solver,
}

/// What a run took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// Energy across the group's border.
    pub ledger: Ledger,
    /// Sweeps in all.
    pub sweeps: u64,
    /// Factorisations of the rows of a group.
    pub factorisations: u64,
    /// Impacts resolved.
    pub impacts: u64,
    /// Largest change of velocity in the last sweep of a substep (m/s): what the rows still lack.
    pub residual: Real,
}

/// Moves a group through a span.
///
/// # Errors
/// Those of the surroundings.
pub fn run(
    group: &mut Group,
    span: Span,
    settings: Settings,
    around: &mut dyn Surroundings,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let h = span.h();
    joints::start(group);
    if settings.solver == Solver::Sweep {
        wide::start(group);
    }
    for k in 0..span.substeps {
        joints::remember(group);
        outcome.ledger.dissipated += around.drift(h / 2.0, group)?;
        around.accelerate((span.time(k) + h / 2.0, h), group)?;
        if group.wide.on {
            wide::place(group, h);
        } else {
            place_blocks(group);
        }
        joints::place(group);
        kick(group, h / 2.0);
        group.middle = span.time(k) + h / 2.0;
        impacts::resolve(group, h, settings.law, (around, &mut outcome));
        kick(group, h / 2.0);
        solve_rows(group, h, settings, &mut outcome);
        outcome.ledger.work += around.work(group);
        if group.watch.has_swift(group) {
            impacts::resolve_turned(group, h, settings.law, (around, &mut outcome));
        }
        outcome.ledger.dissipated += around.drift(h / 2.0, group)?;
        project::apart(group, h, &mut outcome);
        if !group.ties.is_empty() {
            outcome.ledger.correction_work += joints::close(group, h);
            joints::book_dampers(group, &mut outcome.ledger);
        }
        if !group.watch.blocks.is_empty() {
            group.note_thrown();
        }
    }
    if group.wide.on {
        wide::finish(group);
    }
    Ok(outcome)
}

/// Geometry of the midpoint.
fn place_blocks(group: &mut Group) {
    for k in 0..group.blocks.len() {
        place_block(group, k, 0.0);
    }
}

/// Geometry of block k at a time from the middle.
fn place_block(group: &mut Group, k: usize, time: Real) {
    let Group { velocities, places, blocks, links, .. } = group;
    let (block, link) = (&mut blocks[k], &mut links[k]);
    let [a, b] = block.bodies.map(|slot| slot as usize);
    let later: [Place; 2];
    let bodies = if time > 0.0 {
        later = [a, b].map(|slot| {
            let mut place = places[slot];
            place.drift(&velocities[slot].twist, time);
            place
        });
        [&later[0], &later[1]]
    } else {
        [&places[a], &places[b]]
    };
    let at = moved(&link.manifold, link.apart, bodies);
    block.place(&link.manifold, &at, [&velocities[a], &velocities[b]]);
    link.late = time > 0.0;
    block.target[2] = link.tangent_speed;
    link.turning = 0.0;
    let load = block.impulse[0] + block.impulse[1];
    let twists = [&velocities[a].twist, &velocities[b].twist];
    for p in 0..link.manifold.count {
        link.beside[p] =
            link.watched == Watched::Bounces && !path::on_face(&link.manifold, &at, p, link.width);
        let (loaded, apart) = (block.impulse[p] > 0.0, at.gap[p] > 0.0);
        link.passes[p] = !loaded && apart && path::passes(&link.manifold, &at, p, twists);
        link.curvature[p] = 0.0;
        if loaded || apart {
            let [normal, tangent] = curvature(&link.manifold, &at, (link.apart, p), bodies, twists);
            link.curvature[p] = normal;
            // Of several points the friction acts as if at the one where their load is.
            let share = if block.sliding || !loaded { 0.0 } else { block.impulse[p] / load };
            link.turning += share * tangent;
        }
    }
}

/// v += a·h.
fn kick(group: &mut Group, h: Real) {
    for (velocity, place) in group.velocities.iter_mut().zip(&group.places) {
        velocity.twist += place.kick(h);
    }
}

/// Contact and friction rows on the velocities after the kicks.
fn solve_rows(group: &mut Group, h: Real, settings: Settings, outcome: &mut Outcome) {
    group.free.clear();
    group.free.extend(group.velocities.iter().map(|velocity| velocity.twist));
    let fastest = if group.wide.on {
        group.lanes.take_velocities(&group.velocities);
        group.lanes.warm_start();
        group.wide.fastest
    } else {
        prepare_rows(group, h)
    };
    joints::prepare(group, h);
    let most =
        settings.sweeps.max(SMALL / (group.blocks.len() as u32).max(1)).min(5 * settings.sweeps);
    let budget = Budget { tolerance: CALM * fastest, most };
    let mut work = settle::settle(group, (h, budget), settings.solver, outcome);
    if !group.ties.is_empty() {
        work.gain -= joints::book(group, h, &mut outcome.ledger);
    } else if work.gain > work.rounding {
        let part = settle::weaken(group, &work, outcome);
        work.gain = part * (work.gain + (part - 1.0) * work.changed);
        work.given *= part;
    }
    outcome.ledger.work += work.given;
    outcome.ledger.dissipated -= work.gain;
    #[cfg(test)]
    group.left.clone_from(&group.velocities);
    if group.wide.on {
        wide::pass(group);
        return;
    }
    for (block, link) in group.blocks.iter().zip(&mut group.links) {
        link.passed += block.impulse[0] + block.impulse[1];
    }
    if !group.watch.blocks.is_empty() {
        project::turn_back_late(group, h, outcome);
    }
}

/// Targets and responses of the rows, and the impulses they remember. Returns the largest normal velocity that the kick
/// of the substep gives.
fn prepare_rows(group: &mut Group, h: Real) -> Real {
    let Group { velocities, places, blocks, links, .. } = group;
    let mut fastest: Real = 0.0;
    for (block, link) in blocks.iter_mut().zip(&*links) {
        let [a, b] = block.bodies.map(|slot| slot as usize);
        let bodies = [&velocities[a], &velocities[b]];
        let along = block.velocity(bodies);
        // A look within the step may have found fewer points.
        block.on = [false; 2];
        for (k, along) in along.iter().enumerate().take(link.manifold.count) {
            let kick = kicked(block, k, [&places[a], &places[b]], h);
            (block.target[k], block.on[k]) = row(link, (block, k), (*along, kick), h);
        }
        // What sticks obeys J(v⁻ + v⁺) = 0 along the surface as well, so that a rod that pivots keeps its energy.
        block.target[2] = link.tangent_speed - 0.5 * h * link.turning;
        block.prepare(bodies);
        fastest = fastest.max(kick_along(block, [&places[a], &places[b]], h));
    }
    sweep::warm_start(velocities, blocks);
    fastest
}

/// Part of the substep's kick to which the velocities of the rows must settle.
const CALM: Real = 1e-6;

/// Blocks times sweeps that cost next to nothing: small groups may sweep more often, up to five times.
const SMALL: u32 = 600;

/// Normal velocity that a kick of length h gives a block.
fn kick_along(block: &Block, [a, b]: [&Place; 2], h: Real) -> Real {
    let apart = b.acceleration.linear - a.acceleration.linear;
    block.normal.dot(&apart).abs() * h
}

/// Velocity of row k that a kick of length h gives.
fn kicked(block: &Block, k: usize, [a, b]: [&Place; 2], h: Real) -> Real {
    let (a, b) = (&a.acceleration, &b.acceleration);
    let spin = block.arms[k][1] * b.angular - block.arms[k][0] * a.angular;
    (block.normal.dot(&(b.linear - a.linear)) + spin) * h
}

/// Target of a normal row, and whether it takes part.
///
/// Touching: v ≥ 0, or along a curve v ≥ −½h·J̇v, which with the velocity before makes J(v⁻ + v⁺) = 0. Not yet
/// touching: s + vh + ½J̇v·h² ≥ 0 in the next middle, where the curve opens. Under a load, a gap below what the curve
/// itself opens in half a step counts as touching. Never is more asked than that it leaves as fast as it came, v ≤ −v⁻: an
/// impulse p does the work p·½(v⁻ + v), which must not be above 0.
fn row(
    link: &Link,
    (block, k): (&Block, usize),
    (along, kick): (Real, Real),
    h: Real,
) -> (Real, bool) {
    if link.apart_now {
        return (0.0, false);
    }
    let gap = block.gap[k];
    let bend = link.curvature[k] * h;
    let loaded = block.impulse[k] > 0.0;
    // What arrives by an impact is not braked before, and what passes by the face not at all.
    let arrives = link.watched != Watched::No && along < -link.resting[k];
    if gap <= 0.0 || (loaded && gap <= (bend * h).abs()) {
        let wanted = if loaded { (-0.5 * bend).min((kick - along).max(0.0)) } else { 0.0 };
        return (wanted, !(arrives && link.beside[k]));
    }
    let opening = if loaded { 0.0 } else { 0.5 * bend.max(0.0) };
    (-gap / h - opening, !arrives && !link.passes[k])
}

impl std::ops::AddAssign for Twist {
    fn add_assign(&mut self, other: Self) {
        self.linear += other.linear;
        self.angular += other.angular;
    }
}
