//! Area, centroid and inertia of polygons.

use super::{Answer, Number, Reference, Scene};
use crate::error::Result;
use crate::math::{Real, Rot, Vec2, vec2};
use crate::shapes::Shape;

pub static POLYGONS: Scene = Scene {
    id: "S18",
    name: "polygons",
    title: "Area, centroid and second moment of a square, an L and a needle 10⁶:1, also 10⁶ from the origin",
    about: "Exact rationals; a needle that is turned has vertices that are rounded, hence 10⁻¹⁰ there.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

/// A polygon and its exact area (m²), centroid (m) and second moment about it (m⁴).
struct Known {
    name: &'static str,
    vertices: Vec<Vec2>,
    area: Real,
    centroid: Vec2,
    second_moment: Real,
}

fn known() -> [Known; 3] {
    let points = |list: &[(Real, Real)]| list.iter().map(|&(x, y)| vec2(x, y)).collect();
    let long = 1e6;
    [
        Known {
            name: "unit square",
            vertices: points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]),
            area: 1.0,
            centroid: vec2(0.5, 0.5),
            second_moment: 1.0 / 6.0,
        },
        Known {
            name: "L",
            vertices: points(&[
                (0.0, 0.0),
                (2.0, 0.0),
                (2.0, 1.0),
                (1.0, 1.0),
                (1.0, 2.0),
                (0.0, 2.0),
            ]),
            area: 3.0,
            centroid: vec2(5.0 / 6.0, 5.0 / 6.0),
            second_moment: 11.0 / 6.0,
        },
        Known {
            name: "needle",
            vertices: points(&[(0.0, 0.0), (long, 0.0), (long, 1.0), (0.0, 1.0)]),
            area: long,
            centroid: vec2(long / 2.0, 0.5),
            second_moment: long * (long * long + 1.0) / 12.0,
        },
    ]
}

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for Known { name, vertices, area, centroid, second_moment } in known() {
        for offset in [0.0, 1e6] {
            let moved: Vec<_> = vertices.iter().map(|v| v + vec2(offset, -offset)).collect();
            let shape = Shape::polygon(&moved)?;
            let mut push = |what: &str, value: Real, exact: Real| {
                let what = format!("{what} of the {name} at {offset:e}");
                numbers.push(Number { what, value, exact, asked: 1e-13 });
            };
            push("area", shape.area(), area);
            push("centroid x", shape.centroid().x, centroid.x + offset);
            push("centroid y", shape.centroid().y, centroid.y - offset);
            push("second moment", shape.second_moment(), second_moment);
        }
    }
    let [_, _, needle] = known();
    for angle in [0.1, 0.7, 2.0, 3.3] {
        let turned: Vec<_> = needle.vertices.iter().map(|v| Rot::new(angle).apply(*v)).collect();
        let shape = Shape::polygon(&turned)?;
        let mut push = |what: &str, value: Real, exact: Real| {
            let what = format!("{what} of the needle turned by {angle} rad");
            numbers.push(Number { what, value, exact, asked: 1e-10 });
        };
        push("area", shape.area(), needle.area);
        push("second moment", shape.second_moment(), needle.second_moment);
    }
    Ok(numbers)
}
