//! Shapes: what a body looks like, and all that geometry says about it.
//!
//! A [`ShapeDef`] is what the user writes; [`Shape::new`] checks it, cleans it, and answers: area,
//! centroid and second moment to the last digits ([`Shape::mass_properties`]), extents
//! ([`Shape::projection`], [`Shape::bounds_at`]), membership, convex pieces for collision,
//! polylines for drawing. Several shapes of one body cast one [`Silhouette`].
//!
//! No length in metres is hidden in here: every tolerance is relative to the shape. Lengths from
//! 1e-70 to 1e70 m are accepted, since moments hold products of four lengths.

mod arc;
mod bounds;
mod chain;
mod crossing;
mod decompose;
mod def;
mod geometry;
mod limits;
mod mass;
mod polygon;
mod predicates;
mod round;
mod silhouette;

use std::fmt;
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use bounds::{Aabb, Interval};
pub use def::ShapeDef;
pub use geometry::Ring;
pub use mass::MassProperties;
pub use silhouette::{Facet, Silhouette};

use crate::error::{Error, Result};
use crate::math::{Pose, Real, Vec2, vec2};
use def::Built;
use geometry::{Geometry, rounded_outline};
use mass::Measures;

/// A shape that has been checked, and what follows from its definition. Clones share it.
///
/// It is serialised as its [`ShapeDef`], from which all else follows again bit for bit.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "ShapeDef", into = "ShapeDef")]
pub struct Shape(Arc<Inner>);

struct Inner {
    def: ShapeDef,
    geometry: Geometry,
    measures: Measures,
    bounds: Aabb,
    pieces: OnceLock<Vec<Vec<Vec2>>>,
}

/// Making shapes.
impl Shape {
    /// The shape of a definition.
    ///
    /// Polygons are cleaned: vertices that coincide with the next or lie on the line between their
    /// neighbours, up to four ulp of the largest coordinate, are merged; the outline is made
    /// counter-clockwise, holes clockwise.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not finite, lengths that are not above 0 or outside
    /// 1e-70 … 1e70 m, shapes smaller than rounding at their place, and outlines with fewer than
    /// three corners, spikes, edges that cross or touch, or holes that are not inside the outline
    /// and outside one another. Edges are named by the numbers of the vertices as given.
    pub fn new(def: ShapeDef) -> Result<Self> {
        let Built { def, geometry, measures } = def.build()?;
        for (what, x) in [
            ("area or length of the shape", measures.measure),
            ("second moment of the shape", measures.second_moment),
        ] {
            if !(x.is_normal() && x > 0.0) {
                return Err(Error::invalid(
                    what,
                    x,
                    "a number above 0 that does not over- or underflow",
                ));
            }
        }
        let axis = |direction| geometry.projection(direction);
        let bounds = Aabb::new(axis(vec2(1.0, 0.0)), axis(vec2(0.0, 1.0)));
        Ok(Self(Arc::new(Inner { def, geometry, measures, bounds, pieces: OnceLock::new() })))
    }

    /// A disk about the origin.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn circle(radius: Real) -> Result<Self> {
        Self::new(ShapeDef::Circle { radius, center: vec2(0.0, 0.0) })
    }

    /// A box about the origin.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn rectangle(width: Real, height: Real) -> Result<Self> {
        Self::new(ShapeDef::Box { width, height, center: vec2(0.0, 0.0), angle: 0.0 })
    }

    /// A regular polygon about the origin, its first vertex on +x, `radius` from the centre.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn regular_polygon(sides: u32, radius: Real) -> Result<Self> {
        Self::new(ShapeDef::RegularPolygon { sides, radius, center: vec2(0.0, 0.0), angle: 0.0 })
    }

    /// A simple polygon.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn polygon(vertices: &[Vec2]) -> Result<Self> {
        Self::rounded_polygon(vertices, 0.0)
    }

    /// A simple polygon with holes.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn polygon_with_holes(vertices: &[Vec2], holes: &[Vec<Vec2>]) -> Result<Self> {
        let (vertices, holes) = (vertices.to_vec(), holes.to_vec());
        Self::new(ShapeDef::Polygon { vertices, holes, radius: 0.0 })
    }

    /// A convex polygon grown by a disk of this radius.
    ///
    /// # Errors
    /// As [`Shape::new`], and for a radius above 0 on an outline that is not convex.
    pub fn rounded_polygon(vertices: &[Vec2], radius: Real) -> Result<Self> {
        Self::new(ShapeDef::Polygon { vertices: vertices.to_vec(), holes: Vec::new(), radius })
    }

    /// All points within `radius` of the segment from `a` to `b`.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn capsule(a: Vec2, b: Vec2, radius: Real) -> Result<Self> {
        Self::new(ShapeDef::Capsule { a, b, radius })
    }

    /// A thin straight wire.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn segment(a: Vec2, b: Vec2) -> Result<Self> {
        Self::new(ShapeDef::Segment { a, b })
    }

    /// A thin circular wire from the direction `start`, over the signed angle `sweep` (rad).
    ///
    /// # Errors
    /// As [`Shape::new`], and for a sweep of 0 or beyond ±2π.
    pub fn arc(center: Vec2, radius: Real, start: Real, sweep: Real) -> Result<Self> {
        Self::new(ShapeDef::Arc { center, radius, start, sweep })
    }

    /// Thin straight wires through these points, both sides solid.
    ///
    /// # Errors
    /// As [`Shape::new`], and for fewer than two points (three of a closed chain) and for two equal
    /// ones in a row.
    pub fn chain(points: &[Vec2], closed: bool) -> Result<Self> {
        Self::new(ShapeDef::Chain { points: points.to_vec(), closed, one_sided: false })
    }
}

/// Integrals.
impl Shape {
    /// The definition, cleaned (see [`Shape::new`]).
    #[must_use]
    pub fn def(&self) -> &ShapeDef {
        &self.0.def
    }

    /// Whether the shape is a thin wire: a segment, an arc or a chain.
    #[must_use]
    pub fn is_wire(&self) -> bool {
        self.0.geometry.is_wire()
    }

    /// Area (m²); 0 for wires.
    #[must_use]
    pub fn area(&self) -> Real {
        if self.is_wire() { 0.0 } else { self.0.measures.measure }
    }

    /// Length of the boundary, holes included; of wires, their length (m).
    #[must_use]
    pub fn perimeter(&self) -> Real {
        self.0.measures.perimeter
    }

    /// What density multiplies: the area (m²), or the length of a wire (m).
    #[must_use]
    pub fn measure(&self) -> Real {
        self.0.measures.measure
    }

    /// Centroid (m), in the frame of the body.
    #[must_use]
    pub fn centroid(&self) -> Vec2 {
        self.0.measures.centroid
    }

    /// ∫ r² about the centroid for unit density (m⁴; m³ for wires).
    #[must_use]
    pub fn second_moment(&self) -> Real {
        self.0.measures.second_moment
    }

    /// Mass, centre and inertia for a density in kg/m², or in kg/m for wires.
    #[must_use]
    pub fn mass_properties(&self, density: Real) -> MassProperties {
        let Measures { measure, centroid, second_moment, .. } = self.0.measures;
        MassProperties {
            mass: density * measure,
            center: centroid,
            inertia: density * second_moment,
        }
    }
}

/// Extents.
impl Shape {
    /// The smallest box along the axes of the body.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.0.bounds
    }

    /// The smallest box along the axes of the world, for a body at `pose`.
    #[must_use]
    pub fn bounds_at(&self, pose: &Pose) -> Aabb {
        let rot = pose.rot();
        let axis = |direction, at| self.projection(rot.apply_inverse(direction)).moved(at);
        Aabb::new(axis(vec2(1.0, 0.0), pose.position.x), axis(vec2(0.0, 1.0), pose.position.y))
    }

    /// Extent along a unit vector (m).
    #[must_use]
    pub fn projection(&self, direction: Vec2) -> Interval {
        self.0.geometry.projection(direction)
    }

    /// Largest distance of a point of the shape from `center` (m).
    #[must_use]
    pub fn extent_from(&self, center: Vec2) -> Real {
        self.0.geometry.extent_from(center)
    }

    /// Whether `p` belongs to the shape, its border included. Exact for polygons (as stored), up to
    /// rounding for round borders. Wires hold no point.
    #[must_use]
    pub fn contains(&self, p: Vec2) -> bool {
        self.0.geometry.contains(p)
    }
}

/// Pieces and outlines.
impl Shape {
    /// Convex polygons, counter-clockwise, that cover the polygon without overlap, holes left out;
    /// their vertices are its vertices. Of a rounded polygon the core, to be grown by
    /// [`Shape::rounding`]; none for circles, capsules and wires. Computed at the first call.
    #[must_use]
    pub fn convex_pieces(&self) -> &[Vec<Vec2>] {
        self.0.pieces.get_or_init(|| match &self.0.geometry {
            Geometry::Swept { core, .. } if core.len() > 2 => vec![core.clone()],
            Geometry::Polygon { rings, .. } => decompose::convex_pieces(rings),
            _ => Vec::new(),
        })
    }

    /// Radius of the disk that rounds a circle, a capsule or a rounded polygon (m); 0 for all else.
    #[must_use]
    pub fn rounding(&self) -> Real {
        if let Geometry::Swept { radius, .. } = self.0.geometry { radius } else { 0.0 }
    }

    /// Polylines for drawing: outline and holes closed, wires open (a whole circle closed). Arcs
    /// are drawn through points of theirs that are at most `max_angle` apart (rad; taken as at
    /// least 1e-4 and at most π/2).
    #[must_use]
    pub fn outline(&self, max_angle: Real) -> Vec<Ring> {
        match &self.0.geometry {
            Geometry::Swept { core, radius } if *radius > 0.0 => {
                vec![Ring { points: rounded_outline(core, *radius, max_angle), closed: true }]
            }
            Geometry::Swept { core, .. } => {
                vec![Ring { points: core.clone(), closed: core.len() > 2 }]
            }
            Geometry::Polygon { rings, .. } => {
                rings.iter().map(|ring| Ring { points: ring.clone(), closed: true }).collect()
            }
            Geometry::Arc(arc) => vec![arc.outline(max_angle)],
            Geometry::Chain { ring, .. } => vec![ring.clone()],
        }
    }

    /// Hull of the core (the core itself where it is convex; of an arc its centre), relative to `origin`, and the radius around it; computed from the
    /// definition, so that boxes far from the origin keep their digits.
    pub(crate) fn core_about(&self, origin: Vec2) -> (Vec<Vec2>, Real) {
        match (&self.0.def, &self.0.geometry) {
            (&ShapeDef::Box { width, height, center, angle }, _) => {
                (def::corners_of_box(width, height, center - origin, angle), 0.0)
            }
            (&ShapeDef::RegularPolygon { sides, radius, center, angle }, _) => {
                (def::corners_of_regular(sides, radius, center - origin, angle), 0.0)
            }
            (_, Geometry::Swept { core, radius }) => {
                (core.iter().map(|p| p - origin).collect(), *radius)
            }
            (_, Geometry::Polygon { hull, .. } | Geometry::Chain { hull, .. }) => {
                (hull.iter().map(|p| p - origin).collect(), 0.0)
            }
            (_, Geometry::Arc(arc)) => (vec![arc.center - origin], arc.radius),
        }
    }
}

impl TryFrom<ShapeDef> for Shape {
    type Error = Error;

    fn try_from(def: ShapeDef) -> Result<Self> {
        Self::new(def)
    }
}

impl From<Shape> for ShapeDef {
    fn from(shape: Shape) -> Self {
        shape.0.def.clone()
    }
}

impl PartialEq for Shape {
    fn eq(&self, other: &Self) -> bool {
        self.0.def == other.0.def
    }
}

impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.def.fmt(f)
    }
}
