//! The rows of links solved one link after the other, again and again (block Gauss–Seidel), to and fro: for graphs with
//! so many loops that factors of all their rows at once cost too much. The same rows and the same answers as
//! [`direct`](super::direct), as far as the sweeps get.

use super::direct::{Link, Rows, Triple};
use crate::constraints::Velocity;
use crate::math::{Real, Twist};

/// One link: what its bodies give way, J M⁻¹, and the inverse of J M⁻¹ Jᵀ + Σ over the rows that are on.
#[derive(Clone, Copy, Debug)]
struct Local {
    rows: Rows,
    gives: [[Triple; 3]; 2],
    inverse: [Triple; 3],
}

/// The links of an island, prepared.
#[derive(Clone, Debug, Default)]
pub struct Relaxed {
    links: Vec<Link>,
    locals: Vec<Local>,
}

impl Relaxed {
    /// Prepares the links' rows on bodies of these inverse masses.
    pub fn prepare(&mut self, bodies: &[Velocity], links: &[Link], rows: &[Rows]) {
        self.links.clear();
        self.links.extend_from_slice(links);
        self.locals.clear();
        self.locals
            .extend(links.iter().zip(rows).map(|(link, rows)| Local::new(bodies, link, rows)));
    }

    /// Sweeps to and fro over J M⁻¹ Jᵀ λ + Σ λ = b from λ = 0, the given number of times; writes λ and v = M⁻¹ Jᵀ λ.
    pub fn solve(&self, b: &[Triple], sweeps: u32, impulses: &mut [Triple], twists: &mut [Twist]) {
        impulses.fill([0.0; 3]);
        twists.fill(Twist::ZERO);
        for _ in 0..sweeps {
            for k in 0..self.links.len() {
                self.relax(k, b, impulses, twists);
            }
            for k in (0..self.links.len()).rev() {
                self.relax(k, b, impulses, twists);
            }
        }
    }

    fn relax(&self, k: usize, b: &[Triple], impulses: &mut [Triple], twists: &mut [Twist]) {
        let local = &self.locals[k];
        let mut lacks = [0.0; 3];
        for (i, lacks) in lacks.iter_mut().enumerate().filter(|(i, _)| local.rows.on[*i]) {
            let along: Real = (self.links[k].iter().zip(&local.rows.jacobian))
                .filter_map(|(slot, rows)| {
                    let (v, [x, y, turn]) = (&twists[(*slot)? as usize], rows[i]);
                    Some(x * v.linear.x + y * v.linear.y + turn * v.angular)
                })
                .sum();
            *lacks = b[k][i] - along - local.rows.compliance[i] * impulses[k][i];
        }
        let change =
            local.inverse.map(|row| row[0] * lacks[0] + row[1] * lacks[1] + row[2] * lacks[2]);
        for (slot, gives) in self.links[k].iter().zip(&local.gives) {
            let Some(slot) = slot else { continue };
            let v = &mut twists[*slot as usize];
            for (push, [x, y, turn]) in change.iter().zip(gives) {
                v.linear.x += push * x;
                v.linear.y += push * y;
                v.angular += push * turn;
            }
        }
        impulses[k].iter_mut().zip(change).for_each(|(sum, change)| *sum += change);
    }
}

impl Local {
    fn new(bodies: &[Velocity], link: &Link, rows: &Rows) -> Self {
        let mut gives = [[[0.0; 3]; 3]; 2];
        let mut response = [[0.0; 3]; 3];
        for ((slot, gives), jacobian) in link.iter().zip(&mut gives).zip(&rows.jacobian) {
            let Some(slot) = slot else { continue };
            let body = &bodies[*slot as usize];
            *gives = jacobian.map(|[x, y, turn]| {
                [x * body.inverse_mass.x, y * body.inverse_mass.y, turn * body.inverse_inertia]
            });
            for (i, row) in response.iter_mut().enumerate() {
                for (k, entry) in row.iter_mut().enumerate() {
                    let other = jacobian[k];
                    *entry +=
                        gives[i][0] * other[0] + gives[i][1] * other[1] + gives[i][2] * other[2];
                }
            }
        }
        for (i, row) in response.iter_mut().enumerate() {
            row[i] += rows.compliance[i];
        }
        Self { rows: *rows, gives, inverse: inverse(response, rows.on) }
    }
}

/// Inverse over the rows that are on, by elimination without a change of order, which a positive definite matrix does not
/// need. A row that depends on those before it is left out.
fn inverse(mut a: [Triple; 3], on: [bool; 3]) -> [Triple; 3] {
    let mut inverse = [[0.0; 3]; 3];
    let diagonal = [a[0][0], a[1][1], a[2][2]];
    let mut used = [false; 3];
    for k in (0..3).filter(|k| on[*k]) {
        let pivot = a[k][k];
        if pivot.is_nan() || pivot <= SINGULAR * diagonal[k] {
            continue;
        }
        used[k] = true;
        inverse[k][k] = 1.0;
        for column in 0..3 {
            a[k][column] /= pivot;
            inverse[k][column] /= pivot;
        }
        for row in (0..3).filter(|row| *row != k) {
            let factor = a[row][k];
            for column in 0..3 {
                a[row][column] -= factor * a[k][column];
                inverse[row][column] -= factor * inverse[k][column];
            }
        }
    }
    for row in 0..3 {
        for column in 0..3 {
            if !used[row] || !used[column] {
                inverse[row][column] = 0.0;
            }
        }
    }
    inverse
}

/// A pivot below this part of its diagonal says that a row depends on the others.
const SINGULAR: Real = 1e-10;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    /// A chain that hangs from the ground: many sweeps give what the factors give.
    #[test]
    fn many_sweeps_agree_with_the_factors() {
        let body =
            Velocity { twist: Twist::ZERO, inverse_mass: vec2(1.0, 1.0), inverse_inertia: 6.0 };
        let bodies = [body; 4];
        let links: Vec<Link> = (0..4).map(|k: u32| [k.checked_sub(1), Some(k)]).collect();
        let point = |sign: Real, arm: Real| [[sign, 0.0, 0.0], [0.0, sign, sign * arm], [0.0; 3]];
        let rows = Rows {
            jacobian: [point(-1.0, 0.5), point(1.0, -0.5)],
            compliance: [0.0, 0.01, 0.0],
            on: [true, true, false],
        };
        let (rows, b) = (vec![rows; 4], vec![[0.3, 1.0, 0.0]; 4]);
        let (mut ours, mut theirs) = (vec![[0.0; 3]; 4], vec![[0.0; 3]; 4]);
        let mut twists = vec![Twist::ZERO; 4];
        let mut relaxed = Relaxed::default();
        relaxed.prepare(&bodies, &links, &rows);
        relaxed.solve(&b, 2000, &mut ours, &mut twists);
        let mut factor = super::super::direct::Factor::default();
        factor.analyse(4, &links);
        factor.factor(&bodies, &rows);
        factor.solve(&b, &mut theirs, &mut twists);
        for (x, y) in ours.iter().flatten().zip(theirs.iter().flatten()) {
            assert!((x - y).abs() < 1e-9, "{ours:?} {theirs:?}");
        }
    }
}
