//! What the user writes, and its way to geometry and measures.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::arc::WireArc;
use super::geometry::Geometry;
use super::mass::{self, Measures};
use super::predicates::{convex_hull, is_convex, magnitude};
use super::{polygon, round};
use crate::error::{Error, Result, check};
use crate::math::{Real, Rot, Vec2, vec2};

/// A shape as the user writes it and as scene files and snapshots hold it (lengths in m, angles in rad,
/// counter-clockwise, in the frame of the body). Nothing is checked before [`Shape::new`](super::Shape::new).
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
        #[schemars(with = "[Real; 2]")]
        center: Vec2,
        /// Above 0.
        radius: Real,
        /// Direction of its first point, from the centre.
        start: Real,
        /// Angle from its first point to its last: counter-clockwise above 0, clockwise below, a whole circle at ±2π.
        sweep: Real,
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
                length("radius of the circle", radius)?;
                point("center of the circle", center)?;
                swept(vec![center], radius)
            }
            Self::Box { width, height, center, angle } => {
                length("width of the box", width)?;
                length("height of the box", height)?;
                point("center of the box", center)?;
                check::finite("angle of the box", angle)?;
                let core = corners_of_box(width, height, center, angle);
                check_convex("box", &core)?;
                (Geometry::Swept { core, radius: 0.0 }, round::rectangle(width, height, center))
            }
            Self::RegularPolygon { sides, radius, center, angle } => {
                if !(3..=MOST_SIDES).contains(&sides) {
                    let allowed = format!("3 to {MOST_SIDES}");
                    return Err(Error::invalid("sides of the regular polygon", sides, allowed));
                }
                length("radius of the regular polygon", radius)?;
                point("center of the regular polygon", center)?;
                check::finite("angle of the regular polygon", angle)?;
                let core = corners_of_regular(sides, radius, center, angle);
                check_convex("regular polygon", &core)?;
                (Geometry::Swept { core, radius: 0.0 }, round::regular(sides, radius, center))
            }
            Self::Polygon { vertices, holes, radius } => {
                return build_polygon(&vertices, &holes, radius);
            }
            Self::Capsule { a, b, radius } => {
                ends("capsule", a, b)?;
                length("radius of the capsule", radius)?;
                swept(vec![a, b], radius)
            }
            Self::Segment { a, b } => {
                ends("segment", a, b)?;
                (Geometry::Swept { core: vec![a, b], radius: 0.0 }, round::segment(a, b))
            }
            Self::Arc { center, radius, start, sweep } => {
                point("center of the arc", center)?;
                length("radius of the arc", radius)?;
                check::finite("start of the arc", start)?;
                if !(sweep.abs() <= TAU && sweep.abs() > 0.0) {
                    return Err(Error::invalid("sweep of the arc", sweep, "−2π to 2π, not 0"));
                }
                let arc = WireArc::new(center, radius, start, sweep);
                (Geometry::Arc(arc), round::arc(center, radius, start, sweep))
            }
        };
        Ok(Built { def: self, geometry, measures })
    }
}

fn build_polygon(vertices: &[Vec2], holes: &[Vec<Vec2>], radius: Real) -> Result<Built> {
    check::not_negative("radius of the rounded polygon", radius)?;
    for &vertex in vertices.iter().chain(holes.iter().flatten()) {
        point("vertex of the polygon", vertex)?;
    }
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

fn swept(core: Vec<Vec2>, radius: Real) -> (Geometry, Measures) {
    let measures = round::swept(&core, radius);
    (Geometry::Swept { core, radius }, measures)
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

/// Lengths and coordinates that leave room for products of four of them, and for what cancels in these.
const SMALLEST: Real = 1e-70;
const LARGEST: Real = 1e70;

fn length(what: &str, x: Real) -> Result<()> {
    check::positive(what, x)?;
    if (SMALLEST..=LARGEST).contains(&x) {
        Ok(())
    } else {
        Err(Error::invalid(what, x, format!("{SMALLEST:e} to {LARGEST:e} m")))
    }
}

fn point(what: &str, p: Vec2) -> Result<()> {
    check::finite_vec(what, p)?;
    if p.amax() <= LARGEST {
        Ok(())
    } else {
        let got = format!("({:e}, {:e})", p.x, p.y);
        Err(Error::invalid(what, got, format!("coordinates up to {LARGEST:e} m")))
    }
}

fn ends(what: &str, a: Vec2, b: Vec2) -> Result<()> {
    point(&format!("end a of the {what}"), a)?;
    point(&format!("end b of the {what}"), b)?;
    length(&format!("distance between the ends of the {what}"), (b - a).norm())
}

/// Refuses corners that rounding has bent or merged: a shape too small for where it is.
fn check_convex(what: &str, ring: &[Vec2]) -> Result<()> {
    if is_convex(ring) {
        return Ok(());
    }
    Err(Error::invalid(
        format!("size of the {what}"),
        "lost in rounding",
        format!("sizes well above {:e} m so far from the origin", magnitude(ring) * Real::EPSILON),
    ))
}
