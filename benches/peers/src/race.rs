//! The race: every entrant runs every scene once a round, so that what disturbs the machine disturbs
//! all alike.

use std::io::Write;

use culbuto::math::Real;
use serde::Serialize;

use crate::Result;
use crate::engines::Entrant;
use crate::scene::Scene;
use crate::yardstick::{self, End};

/// What one entrant made of one scene.
#[derive(Debug, Serialize)]
pub struct Entry {
    /// Who.
    pub entrant: String,
    /// CPU time a step (ms), a number for each round.
    pub times: Vec<Real>,
    /// How the scene ended in the last round.
    pub end: Option<End>,
    /// What went wrong, if something did.
    pub error: Option<String>,
}

impl Entry {
    /// Median, least and greatest time a step (ms).
    pub fn spread(&self) -> Option<[Real; 3]> {
        let mut times = self.times.clone();
        times.sort_by(Real::total_cmp);
        let (&least, &greatest) = (times.first()?, times.last()?);
        let middle = (times[(times.len() - 1) / 2] + times[times.len() / 2]) / 2.0;
        Some([middle, least, greatest])
    }
}

/// What all made of one scene.
#[derive(Debug, Serialize)]
pub struct Outcome {
    /// The scene's name.
    pub scene: &'static str,
    /// What it shows.
    pub about: &'static str,
    /// Number of dynamic bodies.
    pub bodies: usize,
    /// Steps taken.
    pub steps: u32,
    /// Bodies at rest could sleep.
    pub sleeping: bool,
    /// The same measures at the start.
    pub start: End,
    /// In the order of the entrants.
    pub entries: Vec<Entry>,
}

impl Outcome {
    /// How many times as long as the first entrant's each entrant's step takes.
    pub fn ratio(&self, entry: &Entry) -> Option<Real> {
        let [first, ..] = self.entries.first()?.spread()?;
        entry.spread().map(|[middle, ..]| middle / first)
    }
}

/// Runs a scene in so many rounds; a dot goes to `progress` for each run.
pub fn run(
    scene: &Scene,
    entrants: &mut [Box<dyn Entrant>],
    rounds: u32,
    progress: &mut impl Write,
) -> Result<Outcome> {
    let blank =
        |name: &str| Entry { entrant: name.into(), times: Vec::new(), end: None, error: None };
    let mut entries: Vec<Entry> = entrants.iter().map(|entrant| blank(entrant.name())).collect();
    write!(progress, "{} ", scene.name)?;
    for _ in 0..rounds {
        for (entrant, entry) in entrants.iter_mut().zip(&mut entries) {
            if entry.error.is_none() {
                entry.error = once(scene, entrant.as_mut(), entry).err().map(|e| e.to_string());
            }
            write!(progress, ".")?;
            progress.flush()?;
        }
    }
    writeln!(progress)?;
    Ok(Outcome {
        scene: scene.name,
        about: scene.about,
        bodies: scene.dynamic(),
        steps: scene.steps,
        sleeping: scene.sleeping,
        start: yardstick::measure(scene, &yardstick::start(scene))?,
        entries,
    })
}

/// One run. The first step is not timed: engines build their structures in it.
fn once(scene: &Scene, entrant: &mut dyn Entrant, entry: &mut Entry) -> Result<()> {
    entrant.start(scene)?;
    entrant.advance(scene, 0..1)?;
    let time = entrant.advance(scene, 1..scene.steps)?;
    entry.times.push(1e3 * time.as_secs_f64() / Real::from(scene.steps - 1));
    entry.end = Some(yardstick::measure(scene, &entrant.state()?)?);
    Ok(())
}
