//! Where engines fall: hard scenes at several steps, and how they end.

mod watch;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use serde::Serialize;

pub use self::watch::Watch;
use crate::error::Result;
use crate::math::{Pose, Real, Twist, Vec2};
use crate::scenes::hard::{Hard, Should};
use crate::solvers::Solver;
use crate::world::World;

/// Steps a second at which scenes run.
pub const RATES: [Real; 5] = [15.0, 30.0, 60.0, 120.0, 240.0];
/// The one of them at which pictures are made.
pub const USUAL: Real = 60.0;
/// How often a run is looked at.
pub const LOOKS: u32 = 20;

/// How a scene ended.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does what it should.
    Right,
    /// It stays together, but moves, stretches or gains where it should not.
    Creeps,
    /// It does not do what it should.
    Falls,
    /// It flies apart.
    Explodes,
    /// Numbers are lost.
    Nan,
    /// The engine refuses it, or to go on.
    Refuses,
}

/// One scene by one engine at one step.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// The engine.
    pub engine: String,
    /// Step (s).
    pub step: Real,
    /// How it ended.
    pub verdict: Verdict,
    /// The figure behind it; none where there is no state to measure.
    pub figure: Option<Real>,
    /// Where its bodies end, at the usual step: outlines.
    pub picture: Option<Vec<Vec<Vec2>>>,
}

/// A scene of the matrix.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Its number in the catalogue.
    pub id: &'static str,
    /// Its name.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// What the figure is.
    pub figure: &'static str,
    /// How long it runs (s).
    pub seconds: Real,
    /// How it ends.
    pub cells: Vec<Cell>,
    /// Why there are no other engines, where they cannot have it.
    pub left_out: Option<&'static str>,
}

/// Where a body's frame stands, the velocity of its centre of mass and its angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The frame.
    pub pose: Pose,
    /// How it moves.
    pub twist: Twist,
}

/// The states of a world's bodies.
#[must_use]
pub fn states(world: &World) -> Vec<State> {
    let bodies = world.bodies();
    let pairs = bodies.origins().zip(&bodies.twists);
    pairs.map(|(pose, twist)| State { pose, twist: *twist }).collect()
}

/// Culbuto's ways to solve rows, as engines of the matrix.
pub const OWN: [(&str, Solver); 3] = [
    ("culbuto", Solver::Sweep),
    ("culbuto-newton", Solver::Newton),
    ("culbuto-auto", Solver::Auto),
];

/// A scene by all solvers of Culbuto at all steps, on as many threads as the machine has.
///
/// # Errors
/// Those of making the world.
pub fn line(hard: &'static Hard, rates: &[Real]) -> Result<Line> {
    let runs: Vec<_> =
        OWN.iter().flat_map(|engine| rates.iter().map(move |rate| (engine, *rate))).collect();
    let (next, all) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some((engine, rate)) = runs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let cell = run(hard, engine, *rate);
            // OK because a thread that panics ends the scope, and with it the run.
            all.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(cell);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let cells = all.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut cells = cells.into_iter().collect::<Result<Vec<Cell>>>()?;
    let place = |cell: &Cell| OWN.iter().position(|(name, _)| *name == cell.engine);
    cells.sort_by(|a, b| place(a).cmp(&place(b)).then(b.step.total_cmp(&a.step)));
    let Hard { id, name, about, seconds, .. } = *hard;
    Ok(Line { id, name, about, figure: figure(hard.should), seconds, cells, left_out: None })
}

/// What the figure behind a verdict is.
#[must_use]
pub fn figure(should: Should) -> &'static str {
    match should {
        Should::Stand => "largest way over its size",
        Should::Hold => "widest gap over a link",
        Should::Stop(_) => "bodies that passed",
        Should::Turn => "part of the spin that is lost",
        Should::End(_) => "distance from the answer over the size",
        Should::Calm => "energy gained, relative",
        Should::Part => "overlap over the size",
        Should::Repeat => "numbers that differ",
    }
}

fn run(hard: &Hard, (engine, solver): &(&str, Solver), rate: Real) -> Result<Cell> {
    let dt = hard.tempo / rate;
    let mut watch = Watch::start(hard)?;
    let mut last = Vec::new();
    for _ in 0..watch.runs() {
        let mut world = (hard.build)()?;
        world.set_solver(*solver);
        last = watch.run(dt, |steps| {
            for k in steps {
                world.step(hard.step(k, dt)).ok()?;
            }
            Some(states(&world))
        });
    }
    Ok(watch.cell(engine, rate, &last))
}
