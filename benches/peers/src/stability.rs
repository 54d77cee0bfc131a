//! Where engines fall: Culbuto's hard scenes by all engines, judged by the same watch.

use std::io::Write;
use std::ops::Range;

use culbuto::math::{Pose, Real, Twist};
use culbuto::report::stability::{self, Cell, Line, RATES, Watch};
use culbuto::scenes::hard::{HARD, Hard};

use crate::Result;
use crate::engines::{self, Entrant};
use crate::scene::Scene;
use crate::translate::translate;

/// Runs all hard scenes by Culbuto's solvers and by all other engines, at the settings they come with.
pub fn run(entrants: &mut [Box<dyn Entrant>], progress: &mut dyn Write) -> Result<Vec<Line>> {
    let mut lines = Vec::new();
    for hard in HARD {
        write!(progress, "{} ", hard.name)?;
        let mut line = stability::line(hard, &RATES)?;
        match translate(hard.name, hard.about, &(hard.build)()?) {
            Err(why) => line.left_out = Some(why),
            Ok(mut scene) => {
                scene.size = Some(hard.size);
                let others = entrants.iter_mut().filter(|e| !engines::is_own(e.name()));
                for entrant in others {
                    for rate in RATES {
                        line.cells.push(cell(hard, &mut scene, entrant.as_mut(), rate)?);
                    }
                    write!(progress, ".")?;
                    progress.flush()?;
                }
            }
        }
        writeln!(progress)?;
        lines.push(line);
    }
    Ok(lines)
}

fn cell(hard: &Hard, scene: &mut Scene, entrant: &mut dyn Entrant, rate: Real) -> Result<Cell> {
    let dt = hard.tempo / rate;
    let mut watch = Watch::start(hard)?;
    let mut last = Vec::new();
    for _ in 0..watch.runs() {
        scene.dt = dt;
        let started = entrant.start(scene).is_ok();
        last =
            watch.run(
                dt,
                |steps| {
                    if started { advance(hard, scene, entrant, steps).ok() } else { None }
                },
            );
    }
    Ok(watch.cell(entrant.name(), rate, &last))
}

fn advance(
    hard: &Hard,
    scene: &mut Scene,
    entrant: &mut dyn Entrant,
    steps: Range<u32>,
) -> Result<Vec<stability::State>> {
    if hard.varies {
        let dt = scene.dt;
        for k in steps {
            scene.dt = hard.step(k, dt);
            entrant.advance(scene, k..k + 1)?;
        }
        scene.dt = dt;
    } else {
        entrant.advance(scene, steps)?;
    }
    let state = |state: &engines::State| stability::State {
        pose: Pose { position: state.position, angle: state.angle },
        twist: Twist::new(state.velocity, state.angular_velocity),
    };
    Ok(entrant.state()?.iter().map(state).collect())
}
