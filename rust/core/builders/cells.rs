//! A grid of equal cells laid over a polygon.

use std::collections::BTreeMap;

use super::lattice::Pattern;
use crate::error::{Error, Result};
use crate::math::{Real, Vec2, floor, vec2};
use crate::shapes::{Ring, Shape};

/// The cells of a grid that lie inside a polygon, as what a lattice needs of them.
pub(super) struct Cells {
    /// Corners of cells (m), row by row from below.
    pub points: Vec<Vec2>,
    /// Area (m²) that belongs to each: of every cell around it its share.
    pub areas: Vec<Real>,
    /// Sides and diagonals of cells.
    pub bonds: Vec<Bond>,
}

/// A side or a diagonal of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bond {
    /// Numbers of its ends.
    pub ends: [usize; 2],
    /// Number of cells to which it belongs: 1 on the border and of a diagonal, else 2.
    pub cells: u32,
    /// Whether it is a diagonal.
    pub brace: bool,
}

/// Most points of a grid: more is a slip of the pen.
const MOST: Real = 1e6;

/// What is this close to the border, in parts of the spacing, is on it.
const BORDER: Real = 1e-9;

struct Grid<'a> {
    shape: &'a Shape,
    rings: Vec<Ring>,
    pattern: Pattern,
    spacing: Real,
    corner: Vec2,
    size: [usize; 2],
}

impl Cells {
    /// Cells of this spacing inside a polygon, the grid in the middle of its bounds. A cell is inside if its corners, the
    /// middles of its sides and its own middle are.
    ///
    /// # Errors
    /// A spacing so small that there are more than a million points, or so large that no cell is inside.
    pub fn fill(shape: &Shape, spacing: Real, pattern: Pattern) -> Result<Self> {
        let grid = Grid::over(shape, spacing, pattern)?;
        let cells = grid.cells();
        if cells.is_empty() {
            return Err(Error::invalid("spacing", spacing, "so small that a cell fits inside"));
        }
        let mut numbers: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for node in cells.iter().flatten() {
            numbers.insert([node[1], node[0]], 0);
        }
        let mut points = Vec::with_capacity(numbers.len());
        for ([row, column], number) in &mut numbers {
            *number = points.len();
            points.push(grid.point([*column, *row]));
        }
        let mut areas = vec![0.0; points.len()];
        let mut bonds: BTreeMap<[usize; 2], (u32, bool)> = BTreeMap::new();
        for cell in &cells {
            let corners: Vec<usize> = cell.iter().map(|[i, j]| numbers[&[*j, *i]]).collect();
            let share = pattern.cell_area(spacing) / corners.len() as Real;
            corners.iter().for_each(|corner| areas[*corner] += share);
            for (ends, brace) in pattern.bonds_of(&corners) {
                bonds.entry(ends).or_insert((0, brace)).0 += 1;
            }
        }
        let bonds = bonds.into_iter().map(|(ends, (cells, brace))| Bond { ends, cells, brace });
        Ok(Self { points, areas, bonds: bonds.collect() })
    }
}

impl Pattern {
    /// Height of a row of cells in parts of the spacing.
    fn row(self) -> Real {
        if self == Self::Triangular { 0.75_f64.sqrt() } else { 1.0 }
    }

    /// Area of a cell (m²).
    fn cell_area(self, spacing: Real) -> Real {
        let square = self.row() * spacing * spacing;
        if self == Self::Triangular { 0.5 * square } else { square }
    }

    /// Sides and diagonals of a cell with these corners.
    fn bonds_of(self, corners: &[usize]) -> Vec<([usize; 2], bool)> {
        let ordered = |a: usize, b: usize| [a.min(b), a.max(b)];
        let count = corners.len();
        let side = |k: usize| (ordered(corners[k], corners[(k + 1) % count]), false);
        let mut bonds: Vec<_> = (0..count).map(side).collect();
        if self == Self::BracedSquare {
            bonds.extend([0, 1].map(|k| (ordered(corners[k], corners[k + 2]), true)));
        }
        bonds
    }
}

impl<'a> Grid<'a> {
    fn over(shape: &'a Shape, spacing: Real, pattern: Pattern) -> Result<Self> {
        let bounds = shape.bounds();
        let steps = [spacing, spacing * pattern.row()];
        let extent = vec2(bounds.width(), bounds.height());
        let counts = [extent.x / steps[0], extent.y / steps[1]].map(|n| floor(n + BORDER));
        let points = (counts[0] + 1.0) * (counts[1] + 1.0);
        if points.is_nan() || points > MOST {
            let allowed = "so large that there are at most a million points";
            return Err(Error::invalid("spacing", spacing, allowed));
        }
        let left = vec2(extent.x - counts[0] * steps[0], extent.y - counts[1] * steps[1]);
        let size = counts.map(|n| n as usize);
        let rings = shape.outline(1.0);
        Ok(Self { shape, rings, pattern, spacing, corner: bounds.min + left * 0.5, size })
    }

    fn point(&self, [column, row]: [usize; 2]) -> Vec2 {
        let odd = self.pattern == Pattern::Triangular && row % 2 == 1;
        let shift = if odd { 0.5 } else { 0.0 };
        let (x, y) = (column as Real + shift, row as Real * self.pattern.row());
        self.corner + vec2(x, y) * self.spacing
    }

    fn contains(&self, p: Vec2) -> bool {
        self.shape.contains(p)
            || self.rings.iter().any(|ring| {
                let ends = ring.points.iter().zip(ring.points.iter().cycle().skip(1));
                ends.into_iter().any(|(a, b)| distance(p, *a, *b) <= BORDER * self.spacing)
            })
    }

    /// Corners, by column and row, of the cells inside, counter-clockwise.
    fn cells(&self) -> Vec<Vec<[usize; 2]>> {
        let mut cells = Vec::new();
        for j in 0..self.size[1] {
            for i in 0..=self.size[0] {
                let (right, up) = (i + 1, j + 1);
                let candidates = match (self.pattern, j % 2) {
                    (Pattern::Triangular, 0) => vec![
                        vec![[i, j], [right, j], [i, up]],
                        vec![[right, j], [right, up], [i, up]],
                    ],
                    (Pattern::Triangular, _) => vec![
                        vec![[i, j], [right, j], [right, up]],
                        vec![[i, j], [right, up], [i, up]],
                    ],
                    _ => vec![vec![[i, j], [right, j], [right, up], [i, up]]],
                };
                cells.extend(candidates.into_iter().filter(|cell| self.has(cell)));
            }
        }
        cells
    }

    fn has(&self, cell: &[[usize; 2]]) -> bool {
        let corners: Vec<Vec2> = cell.iter().map(|node| self.point(*node)).collect();
        let middle = corners.iter().sum::<Vec2>() / corners.len() as Real;
        let next = corners.iter().cycle().skip(1);
        corners.iter().all(|p| self.contains(*p))
            && corners.iter().zip(next).all(|(a, b)| self.contains((a + b) * 0.5))
            && self.contains(middle)
    }
}

/// From a point to a segment (m).
fn distance(p: Vec2, a: Vec2, b: Vec2) -> Real {
    let along = b - a;
    let square = along.norm_squared();
    let part = if square > 0.0 { ((p - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (p - a - along * part).norm()
}
