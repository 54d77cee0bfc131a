//! Triangles of good shape inside an outline: constrained Delaunay triangulation with refinement (Ruppert, "A Delaunay refinement
//! algorithm for quality 2-dimensional mesh generation", 1995), by the `spade` crate.

use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};

use crate::error::{Error, Result};
use crate::math::{Real, Vec2, vec2};

/// Smallest angle that is asked for (degrees); outlines with sharper corners keep those.
const ANGLE: Real = 25.0;

/// Points and triangles of clean rings (an outline and holes), with sides of about `size` (m).
pub(super) fn refined(rings: &[Vec<Vec2>], size: Real) -> Result<(Vec<Vec2>, Vec<[u32; 3]>)> {
    // Numbers near 1, as spade asks.
    let all: Vec<Vec2> = rings.iter().flatten().copied().collect();
    let (low, high) = all.iter().fold((all[0], all[0]), |(low, high), p| (low.inf(p), high.sup(p)));
    let (middle, scale) = ((low + high) * 0.5, (high - low).amax());
    let mut points = Vec::new();
    let mut edges = Vec::new();
    for ring in rings {
        let first = points.len();
        for (i, &from) in ring.iter().enumerate() {
            let to = ring[(i + 1) % ring.len()];
            let pieces = ((to - from).norm() / size).ceil().max(1.0);
            for k in 0..pieces as usize {
                let p = (from + (to - from) * (k as Real / pieces) - middle) / scale;
                points.push(Point2::new(p.x, p.y));
            }
        }
        let n = points.len() - first;
        edges.extend((0..n).map(|i| [first + i, first + (i + 1) % n]));
    }
    let failed =
        |what: &str| Error::invalid("the outline", what, "a simple outline that can be meshed");
    let most = 100 * points.len() + (40.0 * (scale / size) * (scale / size)) as usize;
    let mesh = ConstrainedDelaunayTriangulation::<Point2<Real>>::bulk_load_cdt(points, edges);
    let mut mesh = mesh.map_err(|error| failed(&error.to_string()))?;
    let side = size / scale;
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(ANGLE))
        .with_max_allowed_area(0.5 * side * side)
        .with_max_additional_vertices(most);
    let refinement = mesh.refine(parameters);
    if !refinement.refinement_complete {
        return Err(failed("not meshed with so few triangles"));
    }
    let outside: std::collections::HashSet<_> = refinement.excluded_faces.into_iter().collect();
    let mut number = vec![u32::MAX; mesh.num_vertices()];
    let (mut places, mut triangles) = (Vec::new(), Vec::new());
    for face in mesh.inner_faces().filter(|face| !outside.contains(&face.fix())) {
        triangles.push(face.vertices().map(|vertex| {
            let entry = &mut number[vertex.index()];
            if *entry == u32::MAX {
                *entry = places.len() as u32;
                let p = vertex.position();
                places.push(vec2(p.x, p.y) * scale + middle);
            }
            *entry
        }));
    }
    Ok((places, triangles))
}
