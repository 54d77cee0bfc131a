//! Culbuto beside other engines: the same scenes, in one run, one thread each.

mod engines;
mod page;
mod race;
mod scene;
mod scenes;
mod stability;
mod study;
#[cfg(test)]
mod tests;
mod translate;
mod yardstick;

use std::fs;
use std::io::{Write, stderr, stdout};
use std::path::PathBuf;

use clap::Parser;

use engines::Entrant;
use page::Report;
use scene::Scene;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Races Culbuto beside other engines and prints how long a step takes and how each scene ends.
#[derive(Parser)]
struct Args {
    /// Scenes to run; none: all.
    scenes: Vec<String>,
    /// Entrants, the first being what others are compared with; none: all that can run.
    #[arg(long, value_delimiter = ',')]
    engines: Vec<String>,
    /// Runs of each scene by each entrant.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// At most so many steps a run.
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..))]
    steps: Option<u32>,
    /// A Python interpreter that has pymunk, and for studies box2d.
    #[arg(long)]
    python: Option<String>,
    /// File for all numbers, in JSON.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Instead of races: error against run time on the scenes of Culbuto's catalogue that all engines can have; needs --json.
    #[arg(long, requires = "json")]
    study: bool,
    /// File for the page, in Markdown.
    #[arg(long)]
    page: Option<PathBuf>,
}

/// The things of these names, in their own order; without names all.
fn chosen<T>(all: Vec<T>, names: &[String], name: impl Fn(&T) -> &str) -> Result<Vec<T>> {
    let known: Vec<&str> = all.iter().map(&name).collect();
    if let Some(unknown) = names.iter().find(|wanted| !known.contains(&wanted.as_str())) {
        return Err(format!("no {unknown}; there are {}", known.join(", ")).into());
    }
    let wanted = |thing: &T| names.is_empty() || names.iter().any(|wanted| wanted == name(thing));
    Ok(all.into_iter().filter(wanted).collect())
}

fn scenes(args: &Args) -> Result<Vec<Scene>> {
    let mut scenes = chosen(scenes::all(), &args.scenes, |scene| scene.name)?;
    for scene in &mut scenes {
        scene.steps = args.steps.unwrap_or(scene.steps).min(scene.steps);
    }
    Ok(scenes)
}

/// Names of entrants that could not be had, and why.
type Missing = Vec<(&'static str, String)>;

/// Those who take part. Packages of Python that are not installed are missing, unless they were asked for.
fn entrants(args: &Args) -> Result<(Vec<Box<dyn Entrant>>, Missing)> {
    let makers = chosen(engines::ALL.to_vec(), &args.engines, |maker| maker.0)?;
    // Without Python its engines take part only if they are asked for, and then say what they need.
    let can = |name: &str| match name {
        _ if !args.engines.is_empty() => true,
        // It races only when asked: it is for what falls by sweeps.
        engines::AT_ONCE => false,
        engines::BOX2D_2 => args.study && args.python.is_some(),
        _ => args.python.is_some() || !engines::PYTHON.contains(&name),
    };
    let able = makers.into_iter().filter(|(name, _)| can(name));
    let mut entrants = Vec::new();
    let mut missing = Vec::new();
    for (name, make) in able {
        let made = make(args.python.as_deref()).and_then(|mut made| {
            made.version()?;
            Ok(made)
        });
        match made {
            Ok(made) => entrants.push(made),
            Err(error) if engines::PYTHON.contains(&name) && args.engines.is_empty() => {
                writeln!(stderr(), "without {name}: {error}")?;
                missing.push((name, error.to_string()));
            }
            Err(error) => return Err(error),
        }
    }
    Ok((entrants, missing))
}

/// The processor's name where the system tells it, and the number of processors.
fn machine() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let count = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    format!("{} ({count} processors)", model.unwrap_or(std::env::consts::ARCH))
}

fn build() -> String {
    let width = if cfg!(target_feature = "avx2") { "with AVX2" } else { "without AVX2" };
    let flags = option_env!("CFLAGS").unwrap_or("none");
    format!("{}, Rust {width}, flags of C `{flags}`", std::env::consts::ARCH)
}

fn main() -> Result<()> {
    let args = Args::parse();
    let (mut entrants, missing) = entrants(&args)?;
    if let Some(path) = args.json.as_ref().filter(|_| args.study) {
        let (rows, left_out) = study::run(&args.scenes, &mut entrants, &mut stderr())?;
        let versions = engines::versions(&mut entrants)?;
        let stability = stability::run(&mut entrants, &mut stderr())?;
        let (machine, build) = (machine(), build());
        let found = study::Study { versions, missing, machine, build, rows, left_out, stability };
        return Ok(fs::write(path, serde_json::to_string_pretty(&found)?)?);
    }
    let mut report = Report {
        date: time::OffsetDateTime::now_utc().date().to_string(),
        machine: machine(),
        build: build(),
        versions: engines::versions(&mut entrants)?,
        rounds: args.rounds,
        outcomes: Vec::new(),
    };
    for scene in scenes(&args)? {
        let outcome = race::run(&scene, &mut entrants, args.rounds, &mut stderr())?;
        writeln!(stdout(), "{}", page::scene(&outcome))?;
        report.outcomes.push(outcome);
    }
    if let Some(path) = &args.json {
        fs::write(path, serde_json::to_string_pretty(&report)?)?;
    }
    if let Some(path) = &args.page {
        fs::write(path, page::page(&report))?;
    }
    Ok(())
}
