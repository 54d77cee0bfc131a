//! Scenes against their answers.

use serde::Serialize;

use crate::error::Result;
use crate::math::Real;
use crate::methods::{Method, REGISTRY};
use crate::report::order::{Order, order_by};
use crate::report::study::{Mode, Mover, error_of, movers};
use crate::scenes::{Answer, Column, Judged, Motion, Scene};

/// A figure that was asked for, and what was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckRow {
    /// What was measured.
    pub what: String,
    /// How it was run.
    pub column: Column,
    /// Largest value allowed.
    pub asked: Real,
    /// The value.
    pub measured: Real,
    /// Whether it is within.
    pub pass: bool,
}

/// One method on one scene, moving also what the closed form would have solved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodRow {
    /// The method.
    pub method: &'static str,
    /// Its error at the scene's fixed step.
    pub error: Real,
    /// |E − E₀ − work + dissipated| there, over the largest kinetic energy.
    pub energy: Real,
    /// The order it states.
    pub order_stated: u32,
    /// The order that was measured; none where it is exact or nothing clear can be measured.
    pub order_measured: Option<Real>,
    /// It makes no error here beyond rounding.
    pub exact: bool,
    /// Within 0.2 of the stated order, or exact.
    pub pass: bool,
}

/// What came of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Number in the catalogue.
    pub id: &'static str,
    /// The scene's name.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// What was asked of the engine as it comes.
    pub checks: Vec<CheckRow>,
    /// Every method.
    pub methods: Vec<MethodRow>,
    /// Whether everything passed.
    pub pass: bool,
}

fn row(what: impl Into<String>, column: Column, asked: Real, measured: Real) -> CheckRow {
    CheckRow { what: what.into(), column, asked, measured, pass: measured <= asked }
}

/// Measures everything that is asked of a scene, and the order of every method on it.
///
/// # Errors
/// Those of the runs.
pub fn verify(scene: &Scene) -> Result<Verdict> {
    verify_by(scene, REGISTRY)
}

/// The same with these methods in place of those of the registry; they may be your own.
///
/// # Errors
/// Those of the runs.
pub fn verify_by(scene: &Scene, by: &[&'static dyn Method]) -> Result<Verdict> {
    let mut checks = Vec::new();
    let mut methods = Vec::new();
    match scene.answer {
        Answer::Motion(motion) => {
            checks.extend(errors(&motion)?);
            let most = match motion.judged {
                Judged::AsItComes | Judged::Contact { order: false } => 0,
                // The contact step alone, which is the first.
                Judged::Joined { orders: false } => 1,
                Judged::AllMethods | Judged::Contact { order: true } | Judged::Joined { .. } => {
                    usize::MAX
                }
            };
            for mover in movers(&motion, by).into_iter().take(most) {
                methods.push(method_row(&motion, mover)?);
            }
        }
        Answer::Numbers(numbers) => {
            let numbers = numbers()?;
            checks.extend(
                numbers.iter().map(|n| row(n.what.clone(), Column::Fixed, n.asked, n.error())),
            );
        }
    }
    for check in scene.checks {
        checks.push(row(check.what, check.column, check.asked, (check.measure)()?));
    }
    let pass = checks.iter().all(|check| check.pass) && methods.iter().all(|method| method.pass);
    Ok(Verdict { id: scene.id, name: scene.name, title: scene.title, checks, methods, pass })
}

/// The engine as it comes, at the fixed step and with the tolerance, if one is asked for.
fn errors(motion: &Motion) -> Result<Vec<CheckRow>> {
    let (fixed, _) = error_of(motion, &mut (motion.build)()?, Mode::Step(motion.dt))?;
    let what = format!("error, dt = {:.4} s", motion.dt);
    let mut rows = vec![row(what, Column::Fixed, motion.fixed, fixed)];
    if let Some(asked) = motion.toleranced {
        let mode = Mode::Tolerance(asked.tolerance);
        let (error, _) = error_of(motion, &mut (motion.build)()?, mode)?;
        let what = format!("error, tolerance {:e}", asked.tolerance);
        rows.push(row(what, Column::Tolerance, asked.error, error));
    }
    Ok(rows)
}

fn method_row(motion: &Motion, mover: Mover) -> Result<MethodRow> {
    let mut world = (motion.build)()?;
    let substeps = world.settings().substeps;
    mover.prepare(&mut world)?;
    world.set_substeps(substeps)?;
    // What a method refuses to step has no error; it says why to whoever asks for it.
    let measured = error_of(motion, &mut world, Mode::Step(motion.dt));
    let (error, energy) = measured.unwrap_or((Real::NAN, Real::NAN));
    let order = order_by(motion, mover)?;
    let slope = if let Order::Slope(slope) = order { Some(slope) } else { None };
    let off = slope.map(|slope| (slope - Real::from(mover.order())).abs());
    Ok(MethodRow {
        method: mover.name(),
        error,
        energy,
        order_stated: mover.order(),
        order_measured: slope,
        exact: order == Order::Exact,
        pass: order == Order::Exact || off.is_some_and(|off| off <= 0.2),
    })
}
