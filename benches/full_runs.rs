//! Runs scenes and prints what was asked and measured, as Markdown: those that take minutes, for
//! `make test-full`, or those named.

use std::process::ExitCode;
use std::time::Instant;

use culbuto::Result;
use culbuto::report::verify;
use culbuto::scenes::{LONG, Scene, scene};

fn main() -> Result<ExitCode> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let chosen: Vec<&Scene> = if names.is_empty() {
        LONG.to_vec()
    } else {
        names.iter().map(|name| scene(name)).collect::<Result<_>>()?
    };
    let mut pass = true;
    for scene in chosen {
        let start = Instant::now();
        let verdict = verify(scene)?;
        println!("\n## {} {}\n\n{}\n", verdict.id, verdict.title, scene.about);
        println!("| | asked | measured | |\n|---|---|---|---|");
        for row in &verdict.checks {
            let word = if row.pass { "" } else { "**missed**" };
            println!("| {} | {:e} | {:.2e} | {word} |", row.what, row.asked, row.measured);
        }
        println!("\n{:.0} s.", start.elapsed().as_secs_f64());
        pass &= verdict.pass;
    }
    Ok(if pass { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
