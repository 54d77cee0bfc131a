//! Tables of a race, in Markdown that reads well as it stands.

use std::fmt::Write;

use culbuto::math::Real;
use serde::Serialize;

use crate::race::{Entry, Outcome};

/// All that is known about a race.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Day of the race, in UTC.
    pub date: String,
    /// The processor.
    pub machine: String,
    /// What the programs were compiled for.
    pub build: String,
    /// Names and versions of the engines.
    pub versions: Vec<(String, String)>,
    /// Runs of each scene by each entrant.
    pub rounds: u32,
    /// Scene by scene.
    pub outcomes: Vec<Outcome>,
}

/// A table with its columns aligned, the first to the left.
fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let mut text = String::new();
    for (i, row) in rows.iter().enumerate() {
        for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            let padding = " ".repeat(width - cell.chars().count());
            text += &if column == 0 {
                format!("| {cell}{padding} ")
            } else {
                format!("| {padding}{cell} ")
            };
        }
        text += "|\n";
        if i == 0 {
            for (column, &width) in widths.iter().enumerate() {
                let line = "-".repeat(width + usize::from(column == 0));
                text += &if column == 0 { format!("|-{line}") } else { format!("|-{line}:") };
            }
            text += "|\n";
        }
    }
    text
}

/// Three digits of a number, without an exponent where that is short.
fn three(x: Real) -> String {
    let size = x.abs();
    match size {
        0.0 => "0".into(),
        _ if !(1e-3..1e5).contains(&size) => format!("{x:.2e}"),
        _ if size < 0.1 => format!("{x:.4}"),
        _ if size < 1.0 => format!("{x:.3}"),
        _ if size < 10.0 => format!("{x:.2}"),
        _ if size < 100.0 => format!("{x:.1}"),
        _ => format!("{x:.0}"),
    }
}

fn cells<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(String::from).to_vec()
}

const HEAD: [&str; 10] = [
    "engine",
    "ms a step",
    "least … greatest",
    "× first",
    "overlap, mm",
    "gap, mm",
    "kinetic, J",
    "energy, J",
    "rms speed, m/s",
    "lost",
];

fn row(outcome: &Outcome, entry: &Entry) -> Vec<String> {
    let mut row = vec![entry.entrant.clone()];
    match entry.spread() {
        Some([middle, least, greatest]) => {
            row.extend([three(middle), format!("{} … {}", three(least), three(greatest))]);
        }
        None => row.extend(cells(["failed", ""])),
    }
    row.push(outcome.ratio(entry).map_or(String::new(), three));
    if let Some(end) = entry.end {
        row.extend(
            [1e3 * end.overlap, 1e3 * end.gap, end.kinetic, end.total, end.rms_speed].map(three),
        );
        row.push(end.lost.to_string());
    }
    row.resize(HEAD.len(), String::new());
    row
}

/// What all made of a scene.
pub fn scene(outcome: &Outcome) -> String {
    let sleep = if outcome.sleeping { "sleeping allowed" } else { "no sleeping" };
    let mut rows = vec![cells(HEAD)];
    rows.extend(outcome.entries.iter().map(|entry| row(outcome, entry)));
    let mut text = format!(
        "## {}\n\n{}. {} dynamic bodies, {} steps, {sleep}. Energy at the start {} J.\n\n{}",
        outcome.scene.replace('_', " "),
        outcome.about,
        outcome.bodies,
        outcome.steps,
        three(outcome.start.total),
        table(&rows),
    );
    for entry in &outcome.entries {
        if let Some(error) = &entry.error {
            let _ = write!(text, "\n{} failed: {error}\n", entry.entrant); // strings take all
        }
    }
    text
}

/// Median times of all scenes.
fn summary(report: &Report) -> String {
    let Some(first) = report.outcomes.first() else { return String::new() };
    let mut head = cells(["ms a step", "bodies"]);
    head.extend(first.entries.iter().map(|entry| entry.entrant.clone()));
    let mut rows = vec![head];
    for outcome in &report.outcomes {
        let mut row = vec![outcome.scene.replace('_', " "), outcome.bodies.to_string()];
        let middle = |entry: &Entry| entry.spread().map_or("failed".into(), |[m, ..]| three(m));
        row.extend(outcome.entries.iter().map(middle));
        rows.push(row);
    }
    table(&rows)
}

/// The page.
pub fn page(report: &Report) -> String {
    let versions: Vec<&str> = report.versions.iter().map(|(_, version)| &version[..]).collect();
    let mut text = format!(
        "# Beside other engines\n\n{}\n\n{}, {}; {}. {} rounds. {}.\n\n{}",
        include_str!("page.md").trim_end(),
        report.date,
        report.machine,
        report.build,
        report.rounds,
        versions.join(", "),
        summary(report),
    );
    for outcome in &report.outcomes {
        text += "\n";
        text += &scene(outcome);
    }
    text
}
