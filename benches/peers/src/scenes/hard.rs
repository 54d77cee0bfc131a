//! Scenes on which engines fall, and what they should do.

use std::f64::consts::PI;

use culbuto::body::BodyKind;
use culbuto::math::{Real, vec2};

use super::{floor, jointed, real, scene, squares};
use crate::scene::{Body, Joint, Region, Scene, Shape, Spring};

/// What a scene should do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Should {
    /// Stay where it is.
    Stand,
    /// Keep its joints together.
    Hold,
    /// Keep all bodies where they belong.
    Stop,
    /// Keep turning.
    Turn,
}

/// A hard scene.
pub struct Hard {
    /// The scene; its step and number of steps are for the run to set.
    pub scene: Scene,
    /// What it should do.
    pub should: Should,
    /// What its lengths are measured by (m).
    pub size: Real,
    /// How long it runs (s).
    pub seconds: Real,
}

fn standing(name: &'static str, about: &'static str, bodies: Vec<Body>) -> Hard {
    let scene = Scene { sleeping: false, region: Region::Everywhere, ..scene(name, about, bodies) };
    Hard { scene, should: Should::Stand, size: 1.0, seconds: 10.0 }
}

/// Squares of this size, one on the other, each of a density of its own.
fn stack(levels: u32, size: Real, density: impl Fn(u32) -> Real) -> Vec<Body> {
    let ground = Shape::Box { center: vec2(0.0, -size), half: vec2(20.0 * size, size) };
    let square = |i| Body {
        density: density(i),
        ..Body::new(
            vec2(0.0, (real(i) + 0.5) * size),
            vec![Shape::rectangle(size / 2.0, size / 2.0)],
        )
    };
    std::iter::once(Body::ground(vec![ground])).chain((0..levels).map(square)).collect()
}

/// All of them.
pub fn all() -> Vec<Hard> {
    let sized = |hard: Hard, size| Hard { size, ..hard };
    let heavy = |ratio: Real| stack(2, 1.0, move |i| if i == 0 { 1.0 } else { ratio });
    let pyramid = std::iter::once(floor(50.0)).chain(squares(20, vec2(0.0, 0.0))).collect();
    vec![
        standing("stack of 20", "unit squares", stack(20, 1.0, |_| 1.0)),
        standing("stack of 50", "unit squares", stack(50, 1.0, |_| 1.0)),
        standing("pyramid of 20", "210 unit squares", pyramid),
        standing(
            "top-heavy stack",
            "10 squares, each twice as heavy as the one below",
            stack(10, 1.0, |i| (1_u32 << i).into()),
        ),
        standing("1000 on 1", "a square on one of a thousandth of its mass", heavy(1e3)),
        standing("10⁶ on 1", "a square on one of a millionth of its mass", heavy(1e6)),
        sized(
            standing("stack of 1 mm", "10 squares of a millimetre", stack(10, 1e-3, |_| 1.0)),
            1e-3,
        ),
        sized(standing("stack of 1 km", "10 squares of a kilometre", stack(10, 1e3, |_| 1.0)), 1e3),
        stiff(),
        chain(),
        bullet(),
        spin(),
    ]
}

/// A mass that hangs on a spring of 1000 Hz, at rest but for a sag of a quarter of a micrometre.
fn stiff() -> Hard {
    let (hertz, damping_ratio, mass) = (1000.0, 0.1, 1.0);
    let omega = 2.0 * PI * hertz;
    let spring = Spring {
        hertz,
        damping_ratio,
        stiffness: mass * omega * omega,
        damping: 2.0 * mass * damping_ratio * omega,
    };
    let ends = [vec2(0.0, 0.0), vec2(0.0, 0.0)];
    let joint = Joint {
        bodies: [0, 1],
        anchors: ends,
        distance: Some(1.0),
        limits: None,
        spring: Some(spring),
    };
    let bodies =
        vec![Body::ground(vec![]), Body::new(vec2(0.0, -1.0), vec![Shape::rectangle(0.5, 0.5)])];
    let about = "a square on a spring of 1000 Hz, a metre long";
    let hard = standing("spring of 1000 Hz", about, bodies);
    Hard { scene: Scene { joints: vec![joint], ..hard.scene }, ..hard }
}

fn chain() -> Hard {
    let scene = jointed::weighted(20, 1000.0);
    Hard { scene, should: Should::Hold, size: 1.0, seconds: 10.0 }
}

fn bullet() -> Hard {
    let wall = Body::ground(vec![Shape::Box { center: vec2(0.01, 0.0), half: vec2(0.01, 5.0) }]);
    let ball = |i: u32| {
        let place = vec2(-3.0 - 0.37 * real(i), 0.4 * real(i) - 3.8);
        let velocity = vec2(1e3, 0.0);
        Body { velocity, ..Body::new(place, vec![Shape::disk(0.1)]) }
    };
    let bodies = std::iter::once(wall).chain((0..20).map(ball)).collect();
    let region = Region::LeftOf(0.0);
    let about = "20 disks of 0.2 m at 1000 m/s against a wall of 2 cm";
    let scene = Scene {
        sleeping: false,
        region,
        gravity: vec2(0.0, 0.0),
        ..scene("fast disks", about, bodies)
    };
    Hard { scene, should: Should::Stop, size: 0.2, seconds: 0.5 }
}

fn spin() -> Hard {
    let bar = Body {
        angular_velocity: 1e4,
        ..Body::new(vec2(0.0, 0.0), vec![Shape::rectangle(0.5, 0.05)])
    };
    let still = Body { kind: BodyKind::Static, ..Body::new(vec2(0.0, 0.0), vec![]) };
    let about = "a bar turning at 10⁴ rad/s, alone";
    let bodies = vec![still, bar];
    let scene = Scene {
        sleeping: false,
        region: Region::Everywhere,
        gravity: vec2(0.0, 0.0),
        ..scene("fast spin", about, bodies)
    };
    Hard { scene, should: Should::Turn, size: 1.0, seconds: 1.0 }
}
