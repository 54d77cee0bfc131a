//! Where engines fall: hard scenes at several steps, and how they end.

use std::io::Write;

use culbuto::body::BodyKind;
use culbuto::math::{Real, Vec2};
use serde::Serialize;

use crate::Result;
use crate::engines::{Entrant, State};
use crate::scene::Scene;
use crate::scenes::hard::{Hard, Should, all};

/// How a scene ended.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does what it should.
    Right,
    /// It stays together, but moves or stretches where it should not.
    Creeps,
    /// It does not do what it should.
    Falls,
    /// It flies apart.
    Explodes,
    /// Numbers are lost.
    Nan,
}

/// One scene by one engine at one step.
#[derive(Serialize)]
pub struct Cell {
    scene: &'static str,
    engine: String,
    /// Step (s).
    step: Real,
    verdict: Verdict,
    /// The figure behind it, see [`Hard`]: way over size, gap over size, bodies lost, part of the spin lost.
    figure: Option<Real>,
    /// Where its bodies end, at the middle step: outlines.
    picture: Option<Vec<Vec<Vec2>>>,
}

/// A scene of the matrix.
#[derive(Serialize)]
pub struct Line {
    name: &'static str,
    about: &'static str,
    /// What the figure is.
    figure: &'static str,
    seconds: Real,
}

/// The matrix.
#[derive(Serialize)]
pub struct Matrix {
    scenes: Vec<Line>,
    cells: Vec<Cell>,
}

/// Steps a second, the usual in the middle.
const RATES: [Real; 5] = [15.0, 30.0, 60.0, 120.0, 240.0];
const USUAL: Real = 60.0;

/// Ways and gaps over the size, and speeds over √(size·g), from which on a scene creeps, falls, explodes.
const CREEP: Real = 0.02;
const FALL: Real = 0.5;
const SLOW: Real = 1e-2;
const FAR: Real = 1e3;
const FAST: Real = 1e2;

/// Runs all hard scenes by all engines, at the settings they come with.
pub fn run(entrants: &mut [Box<dyn Entrant>], progress: &mut dyn Write) -> Result<Matrix> {
    let mut matrix = Matrix { scenes: Vec::new(), cells: Vec::new() };
    for mut hard in all() {
        write!(progress, "{} ", hard.scene.name)?;
        for entrant in &mut *entrants {
            for rate in RATES {
                matrix.cells.push(cell(&mut hard, entrant.as_mut(), rate)?);
            }
            write!(progress, ".")?;
            progress.flush()?;
        }
        writeln!(progress)?;
        let figure = match hard.should {
            Should::Stand => "largest way over its size",
            Should::Hold => "widest gap over a link",
            Should::Stop => "bodies that passed",
            Should::Turn => "part of the spin that is lost",
        };
        let Scene { name, about, .. } = hard.scene;
        matrix.scenes.push(Line { name, about, figure, seconds: hard.seconds });
    }
    Ok(matrix)
}

fn cell(hard: &mut Hard, entrant: &mut dyn Entrant, rate: Real) -> Result<Cell> {
    let scene = &mut hard.scene;
    scene.dt = 1.0 / rate;
    scene.steps = (hard.seconds * rate).round() as u32;
    // An engine that gives up has fallen.
    let ended = entrant.start(scene).and_then(|()| {
        entrant.advance(scene, 0..scene.steps)?;
        entrant.state()
    });
    let states = ended.unwrap_or_default();
    let (verdict, figure) = judge(hard, &states)?;
    let picture = (rate == USUAL && verdict != Verdict::Nan && !states.is_empty())
        .then(|| outlines(&hard.scene, &states));
    let engine = entrant.name().to_owned();
    Ok(Cell { scene: hard.scene.name, engine, step: hard.scene.dt, verdict, figure, picture })
}

/// How a state is judged, and the figure behind it.
pub fn judge(hard: &Hard, states: &[State]) -> Result<(Verdict, Option<Real>)> {
    let finite = |state: &State| {
        let State { position, angle, velocity, angular_velocity } = *state;
        let sum = position.x + position.y + angle + velocity.x + velocity.y + angular_velocity;
        sum.is_finite()
    };
    if states.is_empty() || !states.iter().all(finite) {
        return Ok((Verdict::Nan, None));
    }
    let Hard { scene, should, size, .. } = hard;
    let end = crate::yardstick::measure(scene, states)?;
    let moving = || {
        let pairs = scene.bodies.iter().zip(states);
        pairs.filter(|(body, _)| body.kind == BodyKind::Dynamic)
    };
    let far =
        |(body, state): (&crate::scene::Body, &State)| (state.position - body.position).norm();
    let way = moving().map(far).fold(0.0, Real::max) / size;
    let graded = |figure: Real, creeps: bool| match figure {
        x if x > FALL => Verdict::Falls,
        x if x > CREEP || creeps => Verdict::Creeps,
        _ => Verdict::Right,
    };
    Ok(match should {
        Should::Stand => {
            let speed = end.rms_speed / (size * scene.gravity.norm()).sqrt();
            let explodes = way > FAR || speed > FAST;
            let verdict = if explodes { Verdict::Explodes } else { graded(way, speed > SLOW) };
            (verdict, Some(way))
        }
        Should::Hold if end.gap / size > FAR => (Verdict::Explodes, Some(end.gap / size)),
        Should::Hold => (graded(end.gap / size, false), Some(end.gap / size)),
        Should::Stop => {
            let lost = end.lost as Real;
            (if end.lost == 0 { Verdict::Right } else { Verdict::Falls }, Some(lost))
        }
        Should::Turn => {
            let lost = |(body, state): (&crate::scene::Body, &State)| {
                (1.0 - state.angular_velocity / body.angular_velocity).abs()
            };
            let lost = moving().map(lost).fold(0.0, Real::max);
            (graded(lost, false), Some(lost))
        }
    })
}

/// Outlines of all shapes where they are now; a disk is a polygon, and what is far away is left out.
fn outlines(scene: &Scene, states: &[State]) -> Vec<Vec<Vec2>> {
    const SIDES: u32 = 16;
    let mut outlines = Vec::new();
    for (body, state) in scene.bodies.iter().zip(states) {
        let pose = culbuto::math::Pose { position: state.position, angle: state.angle };
        for shape in &body.shapes {
            let corners = shape.corners();
            let around = if let crate::scene::Shape::Circle { center, radius } = *shape {
                let turn = |k| {
                    culbuto::math::Rot::new(
                        std::f64::consts::TAU * Real::from(k) / Real::from(SIDES),
                    )
                };
                (0..SIDES).map(|k| center + turn(k).apply(Vec2::new(radius, 0.0))).collect()
            } else {
                corners
            };
            outlines.push(around.into_iter().map(|p| pose.apply(p)).collect());
        }
    }
    outlines
}
