//! Worlds as pictures. The Python module `culbuto.drawing` draws them.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::world::World;

#[pymethods]
impl World {
    /// The world as it is, as an SVG: what a notebook shows of it.
    #[pyo3(name = "_repr_svg_")]
    fn svg<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("culbuto.drawing")?.call_method1("svg", (slf,))
    }

    /// Draws the world as it is on matplotlib axes, in metres, with or without its joints, and returns those axes;
    /// `style` goes to the patches of the shapes.
    #[pyo3(signature = (ax, *, joints=true, **style))]
    fn draw<'py>(
        slf: &Bound<'py, Self>,
        ax: &Bound<'py, PyAny>,
        joints: bool,
        style: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let keywords = style.unwrap_or_else(|| PyDict::new(slf.py()));
        keywords.set_item("joints", joints)?;
        slf.py().import("culbuto.drawing")?.call_method("draw", (slf, ax), Some(&keywords))
    }
}
