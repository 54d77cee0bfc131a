//! What a world makes of two surfaces.

use culbuto::body::{ImpactLaw, Mixing, Rule};
use culbuto::math::Real;
use culbuto::solvers::Solver;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::record::record;
use crate::surface::{Coefficients, FrictionArg, coefficients};
use crate::world::World;

record! {
    /// What is known of two materials together: a row of a world's table. Their order does not matter.
    PairOfMaterials {
        /// Name of the one.
        a: String,
        /// Name of the other.
        b: String,
        /// Static and kinetic friction; None: by the world's rule.
        friction: Option<Coefficients>,
        /// Restitution; None: by the world's rule.
        restitution: Option<Real>,
    }
}

/// One of the things that have names.
fn by_name<T: Copy>(what: &str, object: Borrowed<'_, '_, PyAny>, all: &[(&str, T)]) -> PyResult<T> {
    let word = object.extract::<&str>().ok();
    if let Some((_, found)) = all.iter().find(|(name, _)| word == Some(name)) {
        return Ok(*found);
    }
    let names: Vec<_> = all.iter().map(|(name, _)| format!("'{name}'")).collect();
    let message = format!("{what} is {}; allowed: {}", object.repr()?, names.join(", "));
    Err(PyValueError::new_err(message))
}

/// The name of one of the things that have names.
fn name_of<T: PartialEq>(own: &T, all: &[(&'static str, T)]) -> &'static str {
    all.iter().find(|(_, one)| one == own).map_or("", |(name, _)| name)
}

/// A rule as an argument.
#[derive(Clone, Copy)]
pub struct RuleArg(pub Rule);

impl<'py> FromPyObject<'_, 'py> for RuleArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        by_name("the rule", object, &Rule::ALL).map(Self)
    }
}

/// A law of impact as an argument.
#[derive(Clone, Copy)]
pub struct ImpactLawArg(pub ImpactLaw);

impl<'py> FromPyObject<'_, 'py> for ImpactLawArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        by_name("impact_law", object, &ImpactLaw::ALL).map(Self)
    }
}

/// A way to solve rows as an argument.
#[derive(Clone, Copy)]
pub struct SolverArg(pub Solver);

impl<'py> FromPyObject<'_, 'py> for SolverArg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        by_name("solver", object, &Solver::ALL).map(Self)
    }
}

impl World {
    fn set_mixing(&self, py: Python<'_>, change: impl FnOnce(&mut Mixing)) -> PyResult<()> {
        self.set(py, |core| {
            let mut mixing = core.settings().mixing.clone();
            change(&mut mixing);
            core.set_mixing(mixing)
        })
    }
}

/// How bodies touch.
#[pymethods]
impl World {
    /// How the friction of two surfaces becomes that of the pair: "geometric_mean" √(ab), "hypotenuse" √(a² + b²),
    /// "product", "minimum", "maximum" or "average".
    #[getter]
    fn friction_rule(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(name_of(&self.core(py)?.settings().mixing.friction, &Rule::ALL))
    }

    #[setter]
    fn set_friction_rule(&self, py: Python<'_>, rule: RuleArg) -> PyResult<()> {
        self.set_mixing(py, |mixing| mixing.friction = rule.0)
    }

    /// How the restitution of two surfaces becomes that of the pair, by the same rules; at most 1.
    #[getter]
    fn restitution_rule(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(name_of(&self.core(py)?.settings().mixing.restitution, &Rule::ALL))
    }

    #[setter]
    fn set_restitution_rule(&self, py: Python<'_>, rule: RuleArg) -> PyResult<()> {
        self.set_mixing(py, |mixing| mixing.restitution = rule.0)
    }

    /// What restitution is a ratio of: "newton" velocities, "poisson" impulses, "stronge" works (its square).
    #[getter]
    fn impact_law(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(name_of(&self.core(py)?.settings().impact_law, &ImpactLaw::ALL))
    }

    #[setter]
    fn set_impact_law(&self, py: Python<'_>, law: ImpactLawArg) -> PyResult<()> {
        self.core(py)?.set_impact_law(law.0);
        Ok(())
    }

    /// How the rows of contacts and joints are solved: "sweep" one contact after the other, "newton" all of an island at
    /// once, "auto" as the island asks for.
    #[getter]
    fn solver(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(name_of(&self.core(py)?.settings().solver, &Solver::ALL))
    }

    #[setter]
    fn set_solver(&self, py: Python<'_>, solver: SolverArg) -> PyResult<()> {
        self.core(py)?.set_solver(solver.0);
        Ok(())
    }

    /// Whether bodies that have come to rest are left out of the work until something wakes them.
    #[getter]
    fn sleeping(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.core(py)?.settings().sleeping)
    }

    /// How many bodies sleep.
    #[getter]
    fn asleep(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.core(py)?.asleep())
    }

    #[setter]
    fn set_sleeping(&self, py: Python<'_>, on: bool) -> PyResult<()> {
        self.core(py)?.set_sleeping(on);
        Ok(())
    }

    /// The pairs of materials that are known, in the order in which they were set.
    #[getter]
    fn pairs(&self, py: Python<'_>) -> PyResult<Vec<PairOfMaterials>> {
        let core = self.core(py)?;
        let rows = core.settings().mixing.table.iter().map(|pair| PairOfMaterials {
            a: pair.a.clone(),
            b: pair.b.clone(),
            friction: pair.friction.map(coefficients),
            restitution: pair.restitution,
        });
        Ok(rows.collect())
    }

    /// Sets what two materials make together, instead of the rules. Their order does not matter; a pair of which
    /// nothing is given is forgotten.
    #[pyo3(signature = (material_a, material_b, *, friction=None, restitution=None))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn set_pair(
        &self,
        py: Python<'_>,
        material_a: String,
        material_b: String,
        friction: Option<FrictionArg>,
        restitution: Option<Real>,
    ) -> PyResult<()> {
        let friction = friction.map(|friction| friction.0);
        let pair =
            culbuto::body::PairOfMaterials { a: material_a, b: material_b, friction, restitution };
        self.set_mixing(py, |mixing| mixing.set_pair(pair))
    }
}
