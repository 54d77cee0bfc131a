//! Joints that are kept, copied and sent: drafts by what they are made of, the others by their place in a world.

use culbuto::joint::{Hold, Joint as Kind, JointKind};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use crate::custom_joint::{Rule, RuleParts};
use crate::joint::{Draft, Held, Joint};

#[pymethods]
impl Joint {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let (py, own, class) = (slf.py(), slf.get(), slf.get_type());
        let attributes = slf.getattr("__dict__")?;
        if let Some(place) = own.place.get() {
            let slot = place.slot().filter(|_| place.is_alive());
            let finder = py
                .import("operator")?
                .getattr("methodcaller")?
                .call1(("_part", "joint", slot, class))?;
            return (finder, (place.world.clone_ref(py),), attributes)
                .into_pyobject(py)
                .map(Bound::into_any);
        }
        let (def, bodies) = {
            let draft = own.draft();
            (serde_json::to_string(&draft.def), draft.bodies(py))
        };
        let def = def.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let [a, b] = bodies;
        let new = py.import("copyreg")?.getattr("__newobj__")?;
        let rule = own.rule().map(|rule| rule.get().parts(py));
        (new, (class,), (def, a, b, rule, attributes)).into_pyobject(py).map(Bound::into_any)
    }

    fn __setstate__(slf: &Bound<'_, Self>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let own = slf.getattr("__dict__")?.cast_into::<PyDict>()?;
        if let Ok(attributes) = state.cast::<PyDict>() {
            return own.update(attributes.as_mapping());
        }
        let (def, a, b, rule, attributes) = state.extract::<Drafted<'_>>()?;
        let rule = rule.map(|parts| Rule::new(slf.py(), parts)).transpose()?;
        slf.get().adopt(rule);
        own.update(attributes.as_mapping())?;
        let def = serde_json::from_str(&def)
            .map_err(|_| PyValueError::new_err("this is no pickled joint"))?;
        let old = std::mem::replace(&mut *slf.get().draft(), Draft { def, bodies: [a, b] });
        drop(old);
        Ok(())
    }
}

/// What a pickle holds of a draft.
type Drafted<'py> = (String, Option<Held>, Option<Held>, Option<RuleParts>, Bound<'py, PyDict>);

/// The classes of joints, by kind.
pub struct Classes<'py>(Bound<'py, PyAny>);

impl<'py> Classes<'py> {
    /// Those of `culbuto.joints`.
    pub fn known(py: Python<'py>) -> PyResult<Self> {
        Ok(Self(py.import("culbuto.joints")?.getattr("class_of")?))
    }

    /// That of a joint.
    pub fn of(&self, joint: &Kind) -> PyResult<Bound<'py, PyAny>> {
        let is_rope = matches!(joint.def.kind, JointKind::Distance { hold, max: Some(_), min: 0.0, .. }
            if hold == Hold::Free);
        self.0.call1((if is_rope { "rope" } else { joint.def.kind.name() },))
    }
}

/// A class of joints, as an argument.
pub fn joint_class<'py>(class: Option<Bound<'py, PyType>>) -> PyResult<Bound<'py, PyType>> {
    let of_joints = |class: &Bound<'py, PyType>| class.is_subclass_of::<Joint>().unwrap_or(false);
    class.filter(of_joints).ok_or_else(|| PyTypeError::new_err("this is no class of joints"))
}
