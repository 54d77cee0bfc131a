//! Every scene of the catalogue reaches the figures that are asked of it, and on every scene each
//! method has the order it states.

use culbuto::report::verify;
use culbuto::scenes::CATALOGUE;

#[test]
fn every_scene_reaches_its_figures() {
    let mut failures = Vec::new();
    for scene in CATALOGUE {
        let verdict = verify(scene).unwrap();
        let checks = verdict.checks.iter().filter(|check| !check.pass);
        failures.extend(checks.map(|check| format!("{}: {check:?}", scene.id)));
        let methods = verdict.methods.iter().filter(|method| !method.pass);
        failures.extend(methods.map(|method| format!("{}: {method:?}", scene.id)));
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
