//! What can be measured on a world, and what there is to know about the methods.

use culbuto::math::{Real, vec2};
use culbuto::methods::REGISTRY;
use pyo3::prelude::*;

use crate::convert::Vec2Arg;
use crate::record::record;
use crate::vec2::Vec2;
use crate::world::World;

record! {
    /// Where a world's energy is (J). `balance` stays what it was, whatever happens.
    Energy {
        /// Σ ½mv² + ½Iω².
        kinetic: Real,
        /// In gravity, against the origin, and in fields that have a potential.
        potential: Real,
        /// Done on the bodies by forces without a potential, since the world was made.
        work: Real,
        /// Taken by drag, damping, friction and impacts, since the world was made.
        dissipated: Real,
        /// Done where overlap was removed by moving bodies apart, since the world was made.
        correction_work: Real,
        /// Kinetic and potential energy.
        total: Real,
        /// total − work − correction_work + dissipated.
        balance: Real,
    }
}

record! {
    /// What holds of a method.
    Facts {
        /// Name, as `World.method` takes it.
        name: String,
        /// Error after a fixed time falls as h^order.
        order: u32,
        /// The map of a step is symplectic (forces that come from a potential; of semi-implicit Euler where nothing is joined).
        symplectic: bool,
        /// A run turned round comes back to its start.
        reversible: bool,
        /// Exact for a force that is constant in time and place.
        exact_for_constant_force: bool,
        /// Chooses its own step to a tolerance.
        adaptive: bool,
        /// Treats joints.
        joints: bool,
        /// Treats contacts.
        contacts: bool,
        /// What it does, in one sentence.
        about: String,
    }
}

/// Facts of every method, the default first.
#[pyfunction]
pub fn methods() -> Vec<Facts> {
    let facts = REGISTRY.iter().map(|method| {
        let facts = method.facts();
        Facts {
            name: facts.name.to_owned(),
            order: facts.order,
            symplectic: facts.symplectic,
            reversible: facts.reversible,
            exact_for_constant_force: facts.exact_for_constant_force,
            adaptive: facts.adaptive,
            joints: facts.joints,
            contacts: facts.contacts,
            about: facts.about.to_owned(),
        }
    });
    facts.collect()
}

const ORIGIN: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));

#[pymethods]
impl World {
    /// Energies of the dynamic bodies.
    #[getter]
    fn energy(&self, py: Python<'_>) -> PyResult<Energy> {
        let energy = self.work(py, |core| core.energy())?;
        let culbuto::observe::Energy { kinetic, potential, work, dissipated, correction_work } =
            energy;
        let (total, balance) = (energy.total(), energy.balance());
        Ok(Energy { kinetic, potential, work, dissipated, correction_work, total, balance })
    }

    /// Σ mv over the dynamic bodies (kg·m/s).
    #[getter]
    fn momentum(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.core(py)?.momentum()))
    }

    /// Σ m(r − p) × v + Iω over the dynamic bodies (kg·m²/s), about a point p (m).
    #[pyo3(signature = (about=ORIGIN))]
    fn angular_momentum(&self, py: Python<'_>, about: Vec2Arg) -> PyResult<Real> {
        Ok(self.core(py)?.angular_momentum(about.0))
    }

    /// Mass of the dynamic bodies (kg).
    #[getter]
    fn mass(&self, py: Python<'_>) -> PyResult<Real> {
        Ok(self.core(py)?.mass())
    }

    /// Centre of mass of the dynamic bodies (m); the origin where there is none.
    #[getter]
    fn center_of_mass(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.core(py)?.center_of_mass()))
    }

    /// Largest net force and torque of the fields that say they are internal, over the sum of their
    /// forces: 0 to rounding where that is true. None without such a field.
    fn third_law_residual(&self, py: Python<'_>) -> PyResult<Option<Real>> {
        self.work(py, |core| core.third_law_residual())
    }
}
