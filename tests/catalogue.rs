//! Every scene of the catalogue reaches the figures that are asked of it, and every method has the order it states.

use culbuto::report::{Verdict, verify};
use culbuto::scenes::CATALOGUE;

#[test]
fn every_scene_reaches_its_figures() {
    let verdicts: Vec<Verdict> = CATALOGUE.iter().map(|scene| verify(scene).unwrap()).collect();
    let mut failures = Vec::new();
    for verdict in &verdicts {
        println!("{} {}", verdict.id, verdict.name);
        for check in &verdict.checks {
            println!(
                "   {} {:?} asked {:e} measured {:e}",
                check.what, check.column, check.asked, check.measured
            );
            if !check.pass {
                failures.push(format!("{}: {check:?}", verdict.id));
            }
        }
        for method in &verdict.methods {
            println!(
                "   {:20} error {:.1e} energy {:.1e} order {} measured {:?} exact {}",
                method.method,
                method.error,
                method.energy,
                method.order_stated,
                method.order_measured,
                method.exact
            );
            if !method.pass {
                failures.push(format!("{}: {method:?}", verdict.id));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
