//! Runs scenes and prints what was asked and measured, as Markdown: those that take minutes, for
//! `make test-full`, or those of the catalogue that are named. A number is a time (s) after which no further one is begun.

#![allow(clippy::print_stdout)] // its output is what it is for

use std::fs;
use std::process::ExitCode;
use std::thread::available_parallelism;
use std::time::{Instant, SystemTime};

use culbuto::Result;
use culbuto::report::verify;
use culbuto::scenes::{LONG, Scene, scene};

fn main() -> Result<ExitCode> {
    let (limits, names): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|word| word.parse::<f64>().is_ok());
    let within = limits.first().and_then(|limit| limit.parse().ok()).unwrap_or(f64::INFINITY);
    let chosen: Vec<&Scene> = if names.is_empty() {
        LONG.to_vec()
    } else {
        names.iter().map(|name| scene(name)).collect::<Result<_>>()?
    };
    println!(
        "# Full runs\n\nBy the example `full-runs` (`make test-full`) on {}, {}.",
        today(),
        machine()
    );
    if within.is_finite() {
        println!("Cut short: no scene was begun after {within} s.");
    }
    let start = Instant::now();
    let mut pass = true;
    for scene in chosen {
        if start.elapsed().as_secs_f64() > within {
            println!("\n## {} {}\n\nNot run for want of time.", scene.id, scene.title);
        } else {
            pass &= run(scene)?;
        }
    }
    Ok(if pass { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Runs a scene, prints its table and tells whether it reaches all its figures.
fn run(scene: &Scene) -> Result<bool> {
    let start = Instant::now();
    let verdict = verify(scene)?;
    println!("\n## {} {}\n\n{}\n", verdict.id, verdict.title, scene.about);
    println!("| | asked | measured | |\n|---|---|---|---|");
    for row in &verdict.checks {
        let word = if row.pass { "" } else { "**missed**" };
        println!("| {} | {:e} | {:.2e} | {word} |", row.what, row.asked, row.measured);
    }
    println!("\n{:.0} s.", start.elapsed().as_secs_f64());
    Ok(verdict.pass)
}

/// What the processor calls itself, where the system tells, and how many threads it runs.
fn machine() -> String {
    let known = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = known.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split(": ").nth(1)).unwrap_or(std::env::consts::ARCH);
    format!("{name}, {} threads", available_parallelism().map_or(1, usize::from))
}

/// The date (UTC), from the days since 1970 by the Gregorian calendar's rules.
fn today() -> String {
    let seconds = SystemTime::UNIX_EPOCH.elapsed().map_or(0, |since| since.as_secs());
    let mut days = seconds / 86_400;
    let mut year = 1970;
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while days >= lengths[month] {
        days -= lengths[month];
        month += 1;
    }
    format!("{year}-{:02}-{:02}", month + 1, days + 1)
}
