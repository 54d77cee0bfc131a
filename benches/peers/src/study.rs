//! Error against run time of all engines, on the scenes of Culbuto's catalogue whose motion is known.

use std::io::Write;

use culbuto::math::{Pose, Real};
use culbuto::report::stability::Line;
use culbuto::scenes::{Answer, CATALOGUE, Motion};
use culbuto::world::{Trajectory, World};
use serde::Serialize;

use crate::Result;
use crate::engines::{self, Entrant, State};
use crate::scene::Scene;
use crate::translate::translate;

/// One run of one scene by one engine.
#[derive(Serialize)]
pub struct Row {
    scene: &'static str,
    engine: String,
    /// What was set beside the step.
    setting: String,
    /// Step (s).
    step: Real,
    /// Largest error over times and bodies, relative to the scene's length; none where it is no number.
    error: Option<Real>,
    /// Median CPU time of a run (s).
    seconds: Real,
    seconds_per_second: Real,
}

/// A scene that not all engines can have.
#[derive(Serialize)]
pub struct LeftOut {
    scene: &'static str,
    why: &'static str,
}

/// All that was measured.
#[derive(Serialize)]
pub struct Study {
    /// Names and versions of the engines.
    pub versions: Vec<(String, String)>,
    /// Engines that could not be had, and why.
    pub missing: Vec<(&'static str, String)>,
    /// What it ran on, and how it was built.
    pub machine: String,
    /// See [`machine`](Self::machine).
    pub build: String,
    /// The runs.
    pub rows: Vec<Row>,
    /// Scenes without runs.
    pub left_out: Vec<LeftOut>,
    /// Hard scenes.
    pub stability: Vec<Line>,
}

/// Substeps of engines that have them, the default first; iterations of those that have not.
const SUBSTEPS: [u32; 3] = [4, 1, 16];
const ITERATIONS: [u32; 2] = [10, 50];

/// 2^FEWEST … 2^MOST steps a run.
const FEWEST: u32 = 4;
const MOST: u32 = 12;

/// Times at which a run is compared with the answer.
const SAMPLES: u32 = 16;

/// Timed runs of a row, of which the median counts.
const REPEATS: usize = 5;

/// Runs longer than this (s) are not repeated, and none finer follows.
const LONG: Real = 0.5;

/// Studies the scenes of these names; all, where there is none.
pub fn run(
    names: &[String],
    entrants: &mut [Box<dyn Entrant>],
    progress: &mut dyn Write,
) -> Result<(Vec<Row>, Vec<LeftOut>)> {
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    let wanted = |name: &str, id: &str| {
        let same = |own: &String| own.eq_ignore_ascii_case(name) || own.eq_ignore_ascii_case(id);
        names.is_empty() || names.iter().any(same)
    };
    for scene in CATALOGUE.iter().filter(|scene| wanted(scene.name, scene.id)) {
        let Answer::Motion(motion) = scene.answer else { continue };
        let world = (motion.build)()?;
        match translate(scene.name, scene.title, &world) {
            Err(why) => left_out.push(LeftOut { scene: scene.name, why }),
            Ok(mut declared) => {
                declared.size = Some(usual_size(&world).unwrap_or(motion.length));
                write!(progress, "{} ", scene.name)?;
                for entrant in &mut *entrants {
                    ladder(&mut declared, (&motion, &world), entrant.as_mut(), &mut rows)?;
                    write!(progress, ".")?;
                    progress.flush()?;
                }
                writeln!(progress)?;
            }
        }
    }
    Ok((rows, left_out))
}

/// The median width of the bodies that move (m); none where they are points.
fn usual_size(world: &World) -> Option<Real> {
    let bodies = world.bodies();
    let moving = (0..bodies.len()).filter(|i| bodies.masses[*i].is_free());
    let mut sizes: Vec<Real> = moving.map(|i| 2.0 * bodies.infos[i].size).collect();
    sizes.sort_by(Real::total_cmp);
    sizes.get(sizes.len() / 2).copied().filter(|size| *size > 0.0)
}

/// All settings and steps of one engine on a scene.
fn ladder(
    scene: &mut Scene,
    (motion, world): (&Motion, &World),
    entrant: &mut dyn Entrant,
    rows: &mut Vec<Row>,
) -> Result<()> {
    let divides = !engines::ITERATE.contains(&entrant.name());
    let settings: &[u32] = if divides { &SUBSTEPS } else { &ITERATIONS };
    for &setting in settings {
        if divides {
            scene.substeps = setting;
        } else {
            scene.iterations = setting;
        }
        let word = if divides { "substep" } else { "iteration" };
        let setting = format!("{setting} {word}{}", if setting == 1 { "" } else { "s" });
        for k in FEWEST..=MOST {
            scene.steps = 1 << k;
            scene.dt = motion.duration / Real::from(scene.steps);
            let Ok(error) = error_of(scene, (motion, world), entrant) else { continue };
            let seconds = time_of(scene, entrant)?;
            rows.push(Row {
                scene: scene.name,
                engine: entrant.name().into(),
                setting: setting.clone(),
                step: scene.dt,
                error: error.is_finite().then_some(error),
                seconds,
                seconds_per_second: seconds / motion.duration,
            });
            if seconds > LONG {
                break;
            }
        }
    }
    Ok(())
}

fn error_of(
    scene: &Scene,
    (motion, world): (&Motion, &World),
    entrant: &mut dyn Entrant,
) -> Result<Real> {
    entrant.start(scene)?;
    let parts = SAMPLES.min(scene.steps);
    let every = scene.steps / parts;
    let mut seen = Trajectory { bodies: world.bodies().len(), ..Trajectory::default() };
    for part in 0..parts {
        entrant.advance(scene, part * every..(part + 1) * every)?;
        let time = scene.dt * Real::from((part + 1) * every);
        let exact = (motion.exact)(time);
        seen.times.push(time);
        let states = entrant.state()?;
        seen.poses.extend(states.iter().zip(&exact).map(|(state, exact)| unwrapped(state, exact)));
    }
    Ok(motion.error(world, &seen))
}

/// Engines that keep a direction instead of an angle lose whole turns; they are given back.
fn unwrapped(state: &State, exact: &Pose) -> Pose {
    const TURN: Real = std::f64::consts::TAU;
    let turns = ((exact.angle - state.angle) / TURN).round();
    Pose { position: state.position, angle: state.angle + turns * TURN }
}

fn time_of(scene: &Scene, entrant: &mut dyn Entrant) -> Result<Real> {
    let mut times = Vec::new();
    for _ in 0..REPEATS {
        entrant.start(scene)?;
        let seconds = entrant.advance(scene, 0..scene.steps)?.as_secs_f64();
        times.push(seconds);
        if seconds > LONG {
            break;
        }
    }
    times.sort_by(Real::total_cmp);
    Ok(times[times.len() / 2])
}
