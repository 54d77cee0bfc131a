//! Plain results: immutable, compared by value, printed in full, picklable.

/// A Python class of read-only fields: `record! { /// Doc. Name { /// Doc. field: Type = default, … } }`.
macro_rules! record {
    ($(#[$about:meta])* $name:ident { $($(#[$doc:meta])* $field:ident: $type:ty $(= $default:expr)?),* $(,)? }) => {
        $(#[$about])*
        #[pyo3::pyclass(frozen, get_all, eq, module = "culbuto")]
        #[derive(Clone, PartialEq)]
        pub struct $name { $($(#[$doc])* pub $field: $type),* }

        #[pyo3::pymethods]
        impl $name {
            #[classattr]
            #[pyo3(name = "__match_args__")]
            fn match_args(py: pyo3::Python<'_>) -> pyo3::PyResult<pyo3::Py<pyo3::types::PyTuple>> {
                Ok(pyo3::types::PyTuple::new(py, [$(stringify!($field)),*])?.unbind())
            }

            #[new]
            #[pyo3(signature = ($($field $(= $default)?),*))]
            #[allow(clippy::too_many_arguments, reason = "as many as it has fields")]
            fn new($($field: $type),*) -> Self {
                Self { $($field),* }
            }

            fn __repr__(&self, py: pyo3::Python<'_>) -> pyo3::PyResult<String> {
                let fields = [$(format!(
                    "{}={}",
                    stringify!($field),
                    $crate::record::repr(py, self.$field.clone())?,
                )),*];
                Ok(format!("{}({})", stringify!($name), fields.join(", ")))
            }

            fn __reduce__<'py>(
                slf: &pyo3::Bound<'py, Self>,
            ) -> pyo3::PyResult<(pyo3::Bound<'py, pyo3::PyAny>, pyo3::Bound<'py, pyo3::types::PyTuple>)> {
                use pyo3::IntoPyObjectExt as _;
                use pyo3::types::PyAnyMethods as _;
                let (py, own) = (slf.py(), slf.get());
                let fields = [$(own.$field.clone().into_bound_py_any(py)?),*];
                Ok((slf.get_type().into_any(), pyo3::types::PyTuple::new(py, fields)?))
            }
        }
    };
}
pub(crate) use record;

/// What Python prints for a value.
pub fn repr<'py, T: pyo3::IntoPyObjectExt<'py>>(
    py: pyo3::Python<'py>,
    value: T,
) -> pyo3::PyResult<String> {
    use pyo3::types::PyAnyMethods as _;
    Ok(value.into_bound_py_any(py)?.repr()?.to_string())
}
