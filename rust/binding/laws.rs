//! The conservation laws, measured on worlds.

use culbuto::methods;
use culbuto::report::{self, Law, Limits};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::error::to_py;
use crate::world::World;

/// The conservation laws on a run of a copy of a world. Limits: energy, momentum, angular momentum,
/// third law.
#[pyfunction]
pub fn verify_laws(
    world: &Bound<'_, World>,
    method: &str,
    dt: f64,
    duration: f64,
    limits: [f64; 4],
) -> PyResult<String> {
    let limits = allowed(limits);
    let facts = methods::method(method).map_err(to_py)?.facts();
    world.get().work(world.py(), |core| {
        let found = report::verify_laws(core, facts, (dt, duration), limits)?;
        let laws: Value = found.laws.iter().map(law).collect();
        Ok(json!({ "method": found.method, "laws": laws, "pass": found.pass }).to_string())
    })
}

/// A law. JSON has no infinity, so whether the law applies stands by itself.
fn law(law: &Law) -> Value {
    json!({
        "name": law.name,
        "applies": law.measured.is_some(),
        "measured": law.measured,
        "allowed": law.allowed,
        "why": law.why,
    })
}

fn allowed([energy, momentum, angular_momentum, third_law]: [f64; 4]) -> Limits {
    Limits { energy, momentum, angular_momentum, third_law }
}

/// The laws of a world from one moment on.
#[pyclass(module = "culbuto._native")]
pub struct Audit(report::Audit);

#[pymethods]
impl Audit {
    #[new]
    fn new(world: &Bound<'_, World>) -> PyResult<Self> {
        world.get().work(world.py(), |core| report::Audit::start(core)).map(Self)
    }

    /// Looks at the world again; the largest deviations so far, as JSON. Limits as those of `verify_laws`.
    fn look(&mut self, world: &Bound<'_, World>, limits: [f64; 4]) -> PyResult<String> {
        let audit = &mut self.0;
        world.get().work(world.py(), |core| {
            audit.look(core)?;
            let laws: Value = audit.laws(core, allowed(limits)).iter().map(law).collect();
            Ok(laws.to_string())
        })
    }
}
