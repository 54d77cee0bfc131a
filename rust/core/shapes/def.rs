//! What the user writes, and its way to geometry and measures.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::arc::WireArc;
use super::geometry::{Geometry, Ring};
use super::mass::{self, Measures};
use super::predicates::{convex_hull, is_convex};
use super::{chain, limits, polygon, round};
use crate::error::{Error, Result, check};
use crate::math::{Real, Rot, Vec2, vec2};

/// A shape as the user writes it and as scene files and snapshots hold it (lengths in m, angles in
/// rad, counter-clockwise, in the frame of the body). Nothing is checked before
/// [`Shape::new`](super::Shape::new).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeDef {
    /// A disk.
    Circle {
        /// Above 0.
        radius: Real,
        /// Its centre.
        #[serde(default)]
        #[schemars(with = "[Real; 2]")]
        center: Vec2,
    },
    /// A rectangle.
    Box {
        /// Along x before turning, above 0.
        width: Real,
        /// Along y before turning, above 0.
        height: Real,
        /// Its centre.
        #[serde(default)]
        #[schemars(with = "[Real; 2]")]
        center: Vec2,
        /// By which it is turned.
        #[serde(default)]
        angle: Real,
    },
    /// A polygon of equal sides and angles.
    RegularPolygon {
        /// 3 to 65 536.
        sides: u32,
        /// Distance of the vertices from the centre, above 0.
        radius: Real,
        /// Its centre.
        #[serde(default)]
        #[schemars(with = "[Real; 2]")]
        center: Vec2,
        /// Direction of the first vertex.
        #[serde(default)]
        angle: Real,
    },
    /// A simple polygon, convex or not, with or without holes; or a convex one rounded by a disk.
    Polygon {
        /// The outline. Either direction may be given; counter-clockwise is kept.
        #[schemars(with = "Vec<[Real; 2]>")]
        vertices: Vec<Vec2>,
        /// Outlines of holes inside the outline and outside one another. Clockwise is kept.
        #[serde(default)]
        #[schemars(with = "Vec<Vec<[Real; 2]>>")]
        holes: Vec<Vec<Vec2>>,
        /// Of the disk by which the polygon grows (their Minkowski sum), 0 for sharp corners.
        #[serde(default)]
        radius: Real,
    },
    /// All points within `radius` of a segment.
    Capsule {
        /// One end of the segment.
        #[schemars(with = "[Real; 2]")]
        a: Vec2,
        /// The other end.
        #[schemars(with = "[Real; 2]")]
        b: Vec2,
        /// Above 0.
        radius: Real,
    },
    /// A thin straight wire.
    Segment {
        /// One end.
        #[schemars(with = "[Real; 2]")]
        a: Vec2,
        /// The other end.
        #[schemars(with = "[Real; 2]")]
        b: Vec2,
    },
    /// A thin circular wire.
    Arc {
        /// Of its circle.
        #[serde(default)]
        #[schemars(with = "[Real; 2]")]
        center: Vec2,
        /// Above 0.
        radius: Real,
        /// Direction of its first point, from the centre.
        start: Real,
        /// Angle from its first point to its last: counter-clockwise above 0, clockwise below, a
        /// whole circle at ±2π.
        sweep: Real,
    },
    /// Thin straight wires, one after another. What slides along them does not catch on the points
    /// between.
    Chain {
        /// The points they join, two or more; a chain may cross itself.
        #[schemars(with = "Vec<[Real; 2]>")]
        points: Vec<Vec2>,
        /// Whether a last wire leads from the last point to the first; three points or more then.
        #[serde(default)]
        closed: bool,
        /// Whether only its left side, seen from each point towards the next, is solid: ground
        /// drawn from left to right carries what is above it and lets through what comes from
        /// below; a closed chain drawn counter-clockwise holds what is inside.
        #[serde(default)]
        one_sided: bool,
    },
}

/// A definition made clean, with what follows from it.
pub(super) struct Built {
    pub def: ShapeDef,
    pub geometry: Geometry,
    pub measures: Measures,
}

impl ShapeDef {
    /// Checks the definition and derives the rest.
    pub(super) fn build(self) -> Result<Built> {
        let (geometry, measures) = match self {
            Self::Circle { radius, center } => {
                limits::length("radius of the circle", radius)?;
                limits::point("center of the circle", center)?;
                swept(vec![center], radius)
            }
            Self::Box { width, height, center, angle } => {
                limits::length("width of the box", width)?;
                limits::length("height of the box", height)?;
                let core = corners_of_box(width, height, center, angle);
                sharp("box", core, angle, round::rectangle(width, height, center))?
            }
            Self::RegularPolygon { sides, radius, center, angle } => {
                if !(3..=MOST_SIDES).contains(&sides) {
                    let allowed = format!("3 to {MOST_SIDES}");
                    return Err(Error::invalid("sides of the regular polygon", sides, allowed));
                }
                limits::length("radius of the regular polygon", radius)?;
                let core = corners_of_regular(sides, radius, center, angle);
                sharp("regular polygon", core, angle, round::regular(sides, radius, center))?
            }
            Self::Polygon { vertices, holes, radius } => {
                return build_polygon(&vertices, &holes, radius);
            }
            Self::Capsule { a, b, radius } => {
                limits::ends("capsule", a, b)?;
                limits::length("radius of the capsule", radius)?;
                swept(vec![a, b], radius)
            }
            Self::Segment { a, b } => {
                limits::ends("segment", a, b)?;
                (Geometry::Swept { core: vec![a, b], radius: 0.0 }, round::segment(a, b))
            }
            Self::Arc { center, radius, start, sweep } => wire_arc(center, radius, start, sweep)?,
            Self::Chain { ref points, closed, .. } => {
                let ring = Ring { points: points.clone(), closed };
                chain::check(&ring)?;
                let measures = chain::measures(&ring);
                (Geometry::Chain { hull: convex_hull(points), ring }, measures)
            }
        };
        Ok(Built { def: self, geometry, measures })
    }
}

/// All points within `radius` of a convex core.
fn swept(core: Vec<Vec2>, radius: Real) -> (Geometry, Measures) {
    let measures = round::swept(&core, radius);
    (Geometry::Swept { core, radius }, measures)
}

/// A convex polygon whose measures are known in closed form.
fn sharp(
    what: &str,
    core: Vec<Vec2>,
    angle: Real,
    measures: Measures,
) -> Result<(Geometry, Measures)> {
    limits::point(&format!("center of the {what}"), measures.centroid)?;
    check::finite(&format!("angle of the {what}"), angle)?;
    limits::convex(what, &core)?;
    Ok((Geometry::Swept { core, radius: 0.0 }, measures))
}

fn wire_arc(center: Vec2, radius: Real, start: Real, sweep: Real) -> Result<(Geometry, Measures)> {
    limits::point("center of the arc", center)?;
    limits::length("radius of the arc", radius)?;
    check::finite("start of the arc", start)?;
    if !(sweep.abs() <= TAU && sweep.abs() > 0.0) {
        return Err(Error::invalid("sweep of the arc", sweep, "−2π to 2π, not 0"));
    }
    let arc = WireArc::new(center, radius, start, sweep);
    Ok((Geometry::Arc(arc), round::arc(center, radius, start, sweep)))
}

fn build_polygon(vertices: &[Vec2], holes: &[Vec<Vec2>], radius: Real) -> Result<Built> {
    check::not_negative("radius of the rounded polygon", radius)?;
    let mut rings = polygon::clean(vertices, holes)?;
    let convex = rings.len() == 1 && is_convex(&rings[0]);
    let def = |mut rings: Vec<Vec<Vec2>>| {
        let vertices = rings.remove(0);
        ShapeDef::Polygon { vertices, holes: rings, radius }
    };
    if convex {
        let core = rings.remove(0);
        let (geometry, measures) = swept(core.clone(), radius);
        return Ok(Built { def: def(vec![core]), geometry, measures });
    }
    if radius > 0.0 {
        return Err(Error::invalid(
            "radius of the rounded polygon",
            radius,
            "0, unless the outline is convex and without holes",
        ));
    }
    let measures = mass::polygon(&rings);
    let geometry = Geometry::Polygon { hull: convex_hull(&rings[0]), rings: rings.clone() };
    Ok(Built { def: def(rings), geometry, measures })
}

/// Corners of a box, counter-clockwise from the lower left one.
pub(super) fn corners_of_box(width: Real, height: Real, center: Vec2, angle: Real) -> Vec<Vec2> {
    let (w, h) = (width / 2.0, height / 2.0);
    let rot = Rot::new(angle);
    let corners = [vec2(-w, -h), vec2(w, -h), vec2(w, h), vec2(-w, h)];
    corners.into_iter().map(|corner| center + rot.apply(corner)).collect()
}

/// Corners of a regular polygon, counter-clockwise.
pub(super) fn corners_of_regular(sides: u32, radius: Real, center: Vec2, angle: Real) -> Vec<Vec2> {
    let corner = |k: u32| {
        let turn = Rot::new(TAU * Real::from(k) / Real::from(sides));
        center + Rot::new(angle).apply(turn.apply(vec2(radius, 0.0)))
    };
    (0..sides).map(corner).collect()
}

const MOST_SIDES: u32 = 65_536;
