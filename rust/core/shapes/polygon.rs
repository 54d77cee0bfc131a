//! From what the user drew to clean rings: vertices merged, outlines that cannot be refused,
//! orientation set.

use super::predicates::{self, Place, place};
use super::{crossing, limits};
use crate::error::{Error, Result};
use crate::math::{Real, Vec2, cross};

/// A ring with the user's numbers of its vertices.
struct Ring {
    name: String,
    points: Vec<Vec2>,
    numbers: Vec<usize>,
}

/// Clean rings, ready for use: the outline first, counter-clockwise, then the holes, clockwise. No
/// two vertices coincide, none lies on the line between its neighbours, no edges cross or touch,
/// every hole lies inside the outline and outside the other holes. Cleaning clean rings again
/// changes nothing.
pub(super) fn clean(vertices: &[Vec2], holes: &[Vec<Vec2>]) -> Result<Vec<Vec<Vec2>>> {
    let mut rings = vec![tidy("the outline".to_string(), vertices)?];
    for (i, hole) in holes.iter().enumerate() {
        rings.push(tidy(format!("hole {i}"), hole)?);
    }
    refuse_crossings(&rings)?;
    refuse_stray_holes(&rings)?;
    let orient = |(i, ring): (usize, Ring)| {
        let mut points = ring.points;
        if predicates::is_counter_clockwise(&points) != (i == 0) {
            points[1..].reverse(); // the first vertex stays the first
        }
        points
    };
    Ok(rings.into_iter().enumerate().map(orient).collect())
}

/// Merges duplicate and collinear vertices. Rounding leaves a coordinate uncertain by an ulp or so
/// of the largest one; what differs by no more than four of those is the same.
fn tidy(name: String, vertices: &[Vec2]) -> Result<Ring> {
    for (i, &vertex) in vertices.iter().enumerate() {
        limits::point(&format!("vertex {i} of {name}"), vertex)?;
    }
    let mut ring: Vec<(usize, Vec2)> = vertices.iter().copied().enumerate().collect();
    loop {
        let before = ring.len();
        let largest = ring.iter().fold(0.0, |m: Real, (_, p)| p.amax().max(m));
        let tolerance = 4.0 * Real::EPSILON * largest;
        // Far below rounding, but products of such numbers would underflow in the exact predicates.
        let negligible = largest * 2.0_f64.powi(-100);
        for (_, p) in &mut ring {
            p.apply(|x| *x = if x.abs() <= negligible { 0.0 } else { *x });
        }
        merge_duplicates(&mut ring, tolerance);
        check_corners(&name, ring.len())?;
        merge_straight(&name, &mut ring, tolerance)?;
        check_corners(&name, ring.len())?;
        if ring.len() == before {
            let (numbers, points) = ring.into_iter().unzip();
            return Ok(Ring { name, points, numbers });
        }
    }
}

fn check_corners(name: &str, corners: usize) -> Result<()> {
    if corners >= 3 {
        return Ok(());
    }
    let got = format!("left with {corners} after merging what coincides");
    Err(Error::invalid(
        format!("the number of corners of {name}"),
        got,
        "three or more, not on one line",
    ))
}

fn merge_duplicates(ring: &mut Vec<(usize, Vec2)>, tolerance: Real) {
    let same = |p: Vec2, q: Vec2| (p - q).amax() <= tolerance;
    ring.dedup_by(|later, kept| same(later.1, kept.1));
    while ring.len() > 1 && same(ring[0].1, ring[ring.len() - 1].1) {
        ring.pop();
    }
}

/// Drops vertices on the line between their neighbours; refuses those at which the outline runs
/// back on itself.
fn merge_straight(name: &str, ring: &mut Vec<(usize, Vec2)>, tolerance: Real) -> Result<()> {
    let n = ring.len();
    let mut kept: Vec<(usize, Vec2)> = Vec::with_capacity(n);
    for i in 0..n {
        let (before, a) = *kept.last().unwrap_or(&ring[n - 1]);
        let (number, b) = ring[i];
        let (after, c) = if i + 1 < n { ring[i + 1] } else { *kept.first().unwrap_or(&ring[0]) };
        let (ab, bc) = (b - a, c - b);
        let turn = cross(ab, bc).abs();
        if ab.dot(&bc) >= 0.0 {
            // Distance of b from the line through a and c.
            if turn <= tolerance * (c - a).norm() {
                continue;
            }
        } else if turn <= tolerance * ab.norm().max(bc.norm()) {
            // The end of the shorter edge lies on the longer one.
            return Err(Error::invalid(
                name,
                format!(
                    "folded back at vertex {number} (edges {before}–{number} and {number}–{after})"
                ),
                "an outline that encloses an area and has no spikes",
            ));
        }
        kept.push((number, b));
    }
    *ring = kept;
    Ok(())
}

fn refuse_crossings(rings: &[Ring]) -> Result<()> {
    let points: Vec<&[Vec2]> = rings.iter().map(|ring| &ring.points[..]).collect();
    let Some(conflict) = crossing::find(&points) else { return Ok(()) };
    let edge = |(ring, place): (usize, usize)| {
        let Ring { name, numbers, .. } = &rings[ring];
        let label = format!("edge {}–{}", numbers[place], numbers[(place + 1) % numbers.len()]);
        if rings.len() == 1 { label } else { format!("{label} of {name}") }
    };
    let [first, second] = conflict.edges.map(edge);
    let verb = if conflict.cross { "crosses" } else { "touches" };
    Err(Error::invalid(
        "the polygon",
        format!("not simple: {first} {verb} {second}"),
        "edges that meet only at the vertex between neighbours",
    ))
}

/// No ring touches another here, so one vertex of a hole tells where all of it is.
fn refuse_stray_holes(rings: &[Ring]) -> Result<()> {
    let (outline, holes) = (&rings[0], &rings[1..]);
    let inside = |ring: &Ring, hole: &Ring| place(&ring.points, hole.points[0]) == Place::Inside;
    if let Some(hole) = holes.iter().find(|hole| !inside(outline, hole)) {
        return Err(Error::invalid(&hole.name, "outside the outline", "holes inside the outline"));
    }
    for (i, hole) in holes.iter().enumerate() {
        let mut others = holes.iter().enumerate().filter(|&(j, _)| j != i);
        if let Some((_, other)) = others.find(|(_, other)| inside(other, hole)) {
            return Err(Error::invalid(
                &hole.name,
                format!("inside {}", other.name),
                "holes outside one another",
            ));
        }
    }
    Ok(())
}
