//! The user's own code in a world: laws of fields, and rules of joints.

use culbuto::world::Snapshot;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::custom_joint::{Rule, RuleParts};
use crate::error::to_py;
use crate::law::{Law, LawParts};

/// Each in the order in which the fields and joints stand that have it.
#[derive(Default)]
pub struct Code {
    pub laws: Vec<Py<Law>>,
    pub rules: Vec<Py<Rule>>,
}

/// What makes it again, for pickles.
pub type CodeParts = (Vec<LawParts>, Vec<RuleParts>);

impl Code {
    pub fn parts(&self, py: Python<'_>) -> CodeParts {
        let laws = self.laws.iter().map(|law| law.get().parts(py)).collect();
        let rules = self.rules.iter().map(|rule| rule.get().parts(py)).collect();
        (laws, rules)
    }

    pub fn from_parts(py: Python<'_>, (laws, rules): CodeParts) -> PyResult<Self> {
        let law = |parts| Law::from_parts(py, parts).map(Bound::unbind);
        Ok(Self {
            laws: laws.into_iter().map(law).collect::<PyResult<_>>()?,
            rules: rules.into_iter().map(|parts| Rule::new(py, parts)).collect::<PyResult<_>>()?,
        })
    }

    /// A snapshot from bytes that go with this code.
    pub fn snapshot(&self, py: Python<'_>, bytes: &[u8]) -> PyResult<Snapshot> {
        let laws = self.laws.iter().map(|law| Law::shared(law.bind(py)));
        let rules = self.rules.iter().map(|rule| Rule::shared(rule.bind(py)));
        let (laws, rules) = (laws.collect::<PyResult<_>>()?, rules.collect::<PyResult<_>>()?);
        Snapshot::from_bytes_with(bytes, laws, rules).map_err(to_py)
    }

    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.laws.iter().try_for_each(|law| visit.call(law))?;
        self.rules.iter().try_for_each(|rule| visit.call(rule))
    }
}
