//! Rows of error against run time.

use std::time::Instant;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::math::Real;
use crate::methods::{Facts, Method, REGISTRY};
use crate::scenes::{Answer, Judged, Motion, Scene};
use crate::world::{Trajectory, World};

/// How a scene is run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// At a fixed step (s), which is the method's own: one substep.
    Step(Real),
    /// With a tolerance.
    Tolerance(Real),
}

/// One run of one scene by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The scene's name.
    pub scene: &'static str,
    /// The method's name; "closed_form" for the exact solution of constant forces.
    pub method: &'static str,
    /// Step or tolerance.
    #[serde(flatten)]
    pub mode: Mode,
    /// Largest error over times and bodies, relative to the scene's length.
    pub error: Real,
    /// How far the answer may be off itself, likewise.
    pub uncertainty: Real,
    /// Median wall time of a run (s).
    pub seconds: f64,
    /// The same for each second of world time.
    pub seconds_per_second: f64,
    /// How far the timed runs are apart: from the lower to the upper quartile, relative to the median; 0 of a single run.
    pub spread: f64,
    /// Steps taken.
    pub steps: u64,
    /// Steps tried again.
    pub rejected: u64,
    /// Force evaluations.
    pub evaluations: u64,
    /// Largest |E − E₀ − work + dissipated| over the largest kinetic energy, at the end of the run.
    pub energy: Real,
}

/// What to run.
#[derive(Clone, Debug)]
pub struct Study {
    /// Steps per run.
    pub steps: Vec<u32>,
    /// Tolerances.
    pub tolerances: Vec<Real>,
    /// Names of methods; empty: all.
    pub methods: Vec<String>,
    /// Timed runs of each row, of which the median counts.
    pub repeats: u32,
}

impl Default for Study {
    fn default() -> Self {
        Self {
            steps: ladder_of_steps(4, 14),
            tolerances: ladder_of_tolerances(),
            methods: Vec::new(),
            repeats: 5,
        }
    }
}

/// 2^from … 2^to steps a run.
#[must_use]
pub fn ladder_of_steps(from: u32, to: u32) -> Vec<u32> {
    (from..=to).map(|k| 1 << k).collect()
}

/// 1e-2 … 1e-12.
#[must_use]
pub fn ladder_of_tolerances() -> Vec<Real> {
    (2..=12).map(|k| libm::pow(10.0, -Real::from(k))).collect()
}

/// Most samples at which a run is compared with the answer.
const SAMPLES: u32 = 64;

/// Runs a scene by each method at each step, and at each tolerance. The methods move also what the
/// closed form would have solved, so that their own errors show; where the scene as it stands takes
/// the closed form, that has a row of its own.
///
/// # Errors
/// A scene whose answer is not a motion, unknown methods, and those of the runs.
pub fn study(scene: &Scene, what: &Study) -> Result<Vec<Row>> {
    study_by(scene, what, &chosen(&what.methods)?)
}

/// The same by these methods, which may be your own; names in `what` do not count.
///
/// # Errors
/// Those of [`study`].
pub fn study_by(scene: &Scene, what: &Study, methods: &[&'static dyn Method]) -> Result<Vec<Row>> {
    let Answer::Motion(motion) = scene.answer else {
        return Err(Error::invalid("scene", scene.name, "a scene whose answer is a motion"));
    };
    let mut rows = Vec::new();
    let uncertainty = scene.uncertainty()?;
    if !is_contact(&motion) && takes_closed_form(&motion)? {
        let mut row = run(&motion, Mode::Step(motion.duration), what.repeats, &|_| Ok(()))?;
        (row.scene, row.method, row.uncertainty) = (scene.name, "closed_form", uncertainty);
        rows.push(row);
    }
    for mover in movers(&motion, methods) {
        let prepare = |world: &mut World| mover.prepare(world);
        let steps = what.steps.iter().map(|n| Mode::Step(motion.duration / Real::from(*n)));
        let tolerances = what.tolerances.iter().map(|tolerance| Mode::Tolerance(*tolerance));
        let tolerances = tolerances.filter(|_| mover.is_adaptive());
        for mode in steps.chain(tolerances) {
            // A step that a method refuses (it says why) has no row.
            if let Ok(mut row) = run(&motion, mode, what.repeats, &prepare) {
                (row.scene, row.method, row.uncertainty) = (scene.name, mover.name(), uncertainty);
                rows.push(row);
            }
        }
    }
    Ok(rows)
}

fn is_contact(motion: &Motion) -> bool {
    matches!(motion.judged, Judged::Contact { .. } | Judged::Joined { .. })
}

/// What moves the bodies of a run.
#[derive(Clone, Copy)]
pub(super) enum Mover {
    /// A method moves all, also what has a closed form.
    Method(&'static dyn Method),
    /// The contact step moves what touches, and closed forms the rest.
    ContactStep,
}

impl Mover {
    /// Sets up a world for it, one substep a step.
    pub(super) fn prepare(self, world: &mut World) -> Result<()> {
        if let Self::Method(method) = self {
            world.set_closed_form(false);
            world.use_method(method);
        }
        world.set_substeps(1)
    }

    /// Its name in rows.
    pub(super) fn name(self) -> &'static str {
        self.facts().map_or("contact_step", |facts| facts.name)
    }

    /// The order it states.
    pub(super) fn order(self) -> u32 {
        self.facts().map_or(2, |facts| facts.order)
    }

    /// Whether it is a method that moves what joints tie by itself.
    fn holds_joints(self) -> bool {
        self.facts().is_some_and(|facts| facts.joints)
    }

    fn is_adaptive(self) -> bool {
        self.facts().is_some_and(|facts| facts.adaptive)
    }

    fn facts(self) -> Option<&'static Facts> {
        if let Self::Method(method) = self { Some(method.facts()) } else { None }
    }
}

/// What moves a scene's bodies in turn: the contact step where they touch, which the method does not change.
pub(super) fn movers(motion: &Motion, methods: &[&'static dyn Method]) -> Vec<Mover> {
    let by_methods = methods.iter().copied().map(Mover::Method);
    match motion.judged {
        Judged::Contact { .. } => vec![Mover::ContactStep],
        Judged::Joined { .. } => [Mover::ContactStep]
            .into_iter()
            .chain(by_methods.filter(|m| m.holds_joints()))
            .collect(),
        Judged::AllMethods | Judged::AsItComes => by_methods.collect(),
    }
}

/// The methods of these names; all, where there is none.
fn chosen(names: &[String]) -> Result<Vec<&'static dyn Method>> {
    if names.is_empty() {
        return Ok(REGISTRY.to_vec());
    }
    names.iter().map(|name| crate::methods::method(name)).collect()
}

fn takes_closed_form(motion: &Motion) -> Result<bool> {
    let mut world = (motion.build)()?;
    world.step(motion.dt)?;
    Ok(world.report().evaluations == 0 && world.schedules().is_empty())
}

/// Runs once for the error, and again for the time.
fn run(
    motion: &Motion,
    mode: Mode,
    repeats: u32,
    prepare: &dyn Fn(&mut World) -> Result<()>,
) -> Result<Row> {
    let mut world = (motion.build)()?;
    prepare(&mut world)?;
    let start = world.clone();
    let (error, energy) = error_of(motion, &mut world, mode)?;
    let mut times = Vec::new();
    for _ in 0..repeats.max(1) {
        let mut world = start.clone();
        let clock = Instant::now();
        match mode {
            Mode::Step(h) => world.steps(h, count(motion, h))?,
            Mode::Tolerance(tolerance) => world.advance(motion.duration, tolerance).map(drop)?,
        }
        times.push(clock.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let quartile = |k: usize| times[(k * (times.len() - 1) + 2) / 4];
    let seconds = quartile(2);
    let report = world.report();
    Ok(Row {
        scene: "",
        method: "",
        mode,
        error,
        uncertainty: 0.0,
        seconds,
        spread: (quartile(3) - quartile(1)) / seconds,
        seconds_per_second: seconds / motion.duration,
        steps: report.steps,
        rejected: report.rejected,
        evaluations: report.evaluations,
        energy,
    })
}

fn count(motion: &Motion, h: Real) -> u32 {
    (motion.duration / h).round() as u32
}

/// Error of a run, and the drift of the energy balance at its end.
pub(super) fn error_of(motion: &Motion, world: &mut World, mode: Mode) -> Result<(Real, Real)> {
    let before = world.energy()?;
    let trajectory = match mode {
        Mode::Step(h) => {
            let n = count(motion, h);
            world.record(h, n, (n / SAMPLES).max(1))?
        }
        Mode::Tolerance(tolerance) => {
            let times: Vec<Real> = (0..=SAMPLES)
                .map(|k| motion.duration * Real::from(k) / Real::from(SAMPLES))
                .collect();
            world.advance_sampled(motion.duration, tolerance, &times)?
        }
    };
    let after = world.energy()?;
    let size = before.kinetic.max(after.kinetic).max(Real::MIN_POSITIVE);
    Ok((
        error_at_end(motion, world, &trajectory),
        (after.balance() - before.balance()).abs() / size,
    ))
}

/// The recorded samples, and the end of the run where the samples do not reach it.
fn error_at_end(motion: &Motion, world: &World, trajectory: &Trajectory) -> Real {
    let sampled = motion.error(world, trajectory);
    let bodies = world.bodies();
    let end = Trajectory {
        times: vec![world.time()],
        bodies: bodies.len(),
        poses: (0..bodies.len()).map(|i| bodies.origin(i)).collect(),
        twists: bodies.twists.clone(),
    };
    sampled.max(motion.error(world, &end))
}

/// Where a thrown ball went at some ticks a second, by some method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Path {
    /// The method.
    pub method: String,
    /// Ticks a second.
    pub ticks_per_second: u32,
    /// Position (m) after each tick, the start first.
    pub points: Vec<[Real; 2]>,
}

/// The picture every beginner's guide opens with: the ball of scene S1 at several ticks a second, by
/// each of these methods, moved by the method even where the exact solution is known.
///
/// # Errors
/// An unknown method, or no ticks.
pub fn thrown_ball(methods: &[&str], ticks_per_second: &[u32]) -> Result<Vec<Path>> {
    let Answer::Motion(motion) = crate::scenes::scene("projectile")?.answer else {
        return Ok(Vec::new());
    };
    let mut paths = Vec::new();
    for method in methods {
        for &ticks in ticks_per_second {
            let mut world = (motion.build)()?;
            world.set_closed_form(false);
            world.set_method(method)?;
            world.set_substeps(1)?;
            let seconds = motion.duration.ceil() as u32;
            let path = world.record(1.0 / Real::from(ticks), ticks * seconds, 1)?;
            let points = path.poses.iter().map(|pose| pose.position.into()).collect();
            paths.push(Path { method: (*method).to_owned(), ticks_per_second: ticks, points });
        }
    }
    Ok(paths)
}
