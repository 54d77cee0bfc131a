//! The extremes X1 to X15, where they are motions, and what is fast.

use super::{Hard, Should};
use crate::body::{BodyDef, BodyKind, Filter, Friction, Surface};
use crate::error::Result;
use crate::joint::{Coefficients, Hold, JointDef, JointKind, Spring};
use crate::math::{PI, Real, Vec2, cos, vec2};
use crate::scenes::extremes::{Layout, bin, pile};
use crate::scenes::stacks::{ground, tower};
use crate::scenes::stage::{G, heavy, rough, smooth};
use crate::scenes::weightless;
use crate::shapes::Shape;
use crate::world::World;

const PLAIN: Hard = Hard {
    id: "",
    name: "",
    about: "",
    build: weightless,
    should: Should::Stand,
    size: 1.0,
    seconds: 10.0,
    tempo: 1.0,
    varies: false,
};

pub static CHAINS: [Hard; 2] = [
    Hard {
        id: "X1",
        name: "chain, 1000 at its end",
        about: "20 bars of 1 m and a disk of 1000 times their mass, let go level",
        build: || chain(1e3),
        should: Should::Hold,
        ..PLAIN
    },
    Hard {
        id: "X1",
        name: "chain, 10⁶ at its end",
        about: "20 bars of 1 m and a disk of 10⁶ times their mass, let go level",
        build: || chain(1e6),
        should: Should::Hold,
        ..PLAIN
    },
];

/// Bars from a hinge at the origin, and a disk that is so many times as heavy as one of them. Nothing touches.
fn chain(times: Real) -> Result<World> {
    const BARS: u32 = 20;
    let mut world = heavy()?;
    let apart = Filter { group: -1, ..Filter::default() };
    let mut before = None;
    for k in 0..=BARS {
        let left = vec2(Real::from(k), 0.0);
        let last = k == BARS;
        let def = if last {
            BodyDef { mass: Some(0.2 * times), position: left, ..BodyDef::new(Shape::circle(0.5)?) }
        } else {
            let position = left + vec2(0.5, 0.0);
            BodyDef { mass: Some(0.2), position, ..BodyDef::new(Shape::rectangle(1.0, 0.2)?) }
        };
        let body = world.add_body(BodyDef { filter: apart, ..def })?;
        let ends = [if k == 0 { 0.0 } else { 0.5 }, if last { 0.0 } else { -0.5 }];
        let joint = JointDef::revolute(before, body);
        world.add_joint(joint.anchored_locally(vec2(ends[0], 0.0), vec2(ends[1], 0.0)))?;
        before = Some(body);
    }
    Ok(world)
}

/// Masses 1 : 10⁶ on a spring of 2 Hz, ¼ m too long at first.
pub static SPRING_RATIO: Hard = Hard {
    id: "X1",
    name: "spring, 10⁶ at its end",
    about: "two disks, masses 1 and 10⁶ kg, on a spring of 2 Hz, let go ¼ m too long",
    build: || {
        let mut world = weightless()?;
        let apart = Filter { group: -1, ..Filter::default() };
        let [near, far] = [(1.0, 0.0), (1e6, 1.25)].map(|(mass, x)| -> Result<_> {
            let disk = BodyDef::new(Shape::circle(0.1)?);
            let position = vec2(x, 0.0);
            world.add_body(BodyDef { mass: Some(mass), position, filter: apart, ..disk })
        });
        let omega = 4.0 * PI;
        let stiffness = omega * omega / (1.0 + 1e-6);
        let spring = Spring::Constants(Coefficients { stiffness, damping: 0.0 });
        let hold = Hold::Spring(spring);
        let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
        world.add_joint(JointDef::new(near?, far?, kind))?;
        Ok(world)
    },
    should: Should::End(|| {
        // After 9.8 s: where cos ωt is not at its turning point.
        let (shares, long) = ([1e6, -1.0], 0.25 * (1.0 - cos(4.0 * PI * 9.8)));
        let way = shares.map(|share| long * share / (1.0 + 1e6));
        vec![vec2(way[0], 0.0), vec2(1.25 + way[1], 0.0)]
    }),
    size: 0.25,
    seconds: 9.8,
    ..PLAIN
};

pub static GRAVITY: Hard = Hard {
    id: "X2",
    name: "gravity of 10⁴",
    about: "a stack of 20 boxes of 1 m under 10⁴ m/s²",
    build: || {
        let mut world = tower::<20>(false, 0.0)?;
        world.set_gravity(vec2(0.0, -1e4))?;
        Ok(world)
    },
    ..PLAIN
};

/// Ten boxes at a size: lengths times s, times times √s.
const SIZED: Hard = Hard { id: "X3", ..PLAIN };

pub static SMALL: Hard = Hard {
    name: "stack of 1 mm",
    about: "10 boxes of a millimetre, times by √size",
    build: || stack(10, 1e-3, Vec2::zeros()),
    size: 1e-3,
    seconds: 0.316,
    tempo: 0.0316,
    ..SIZED
};

pub static LARGE: Hard = Hard {
    name: "stack of 1000 km",
    about: "10 boxes of 10⁶ m, times by √size",
    build: || stack(10, 1e6, Vec2::zeros()),
    size: 1e6,
    seconds: 1e4,
    tempo: 1e3,
    ..SIZED
};

pub static FAR: Hard = Hard {
    id: "X7",
    name: "stack 10⁷ m away",
    about: "5 boxes of 1 m, 10⁷ m from the origin",
    build: || stack(5, 1.0, vec2(1e7, -1e7)),
    ..PLAIN
};

/// Boxes of this size on ground of their own.
fn stack(levels: u32, size: Real, origin: Vec2) -> Result<World> {
    let mut world = heavy()?;
    let (surface, kind) = (rough(0.6), BodyKind::Static);
    let floor = BodyDef::new(Shape::rectangle(40.0 * size, 2.0 * size)?);
    let position = origin - vec2(0.0, size);
    world.add_body(BodyDef { kind, position, surface: surface.clone(), ..floor })?;
    for level in 0..levels {
        let position = origin + vec2(0.0, (Real::from(level) + 0.5) * size);
        let square = BodyDef::new(Shape::rectangle(size, size)?);
        world.add_body(BodyDef { position, surface: surface.clone(), ..square })?;
    }
    Ok(world)
}

const NEEDLE: Hard = Hard {
    id: "X4",
    name: "needle 1000 : 1",
    about: "1 m long, 1 mm thick, falls on the ground",
    build: || fall(&needle(1e-3)),
    should: Should::Calm,
    ..PLAIN
};

pub static NEEDLES: [Hard; 2] = [
    NEEDLE,
    Hard {
        name: "needle 10⁶ : 1",
        about: "1 m long, 1 µm thick, falls on the ground",
        build: || fall(&needle(1e-6)),
        ..NEEDLE
    },
];

pub static SLIVER: Hard = Hard {
    name: "sliver",
    about: "a triangle of 1 m with an angle of 10⁻⁴ rad falls on the ground",
    build: || fall(&[vec2(-0.5, 0.0), vec2(0.5, 0.0), vec2(0.5, 1e-4)]),
    ..NEEDLE
};

fn needle(width: Real) -> [Vec2; 4] {
    [vec2(-0.5, 0.0), vec2(0.5, 0.0), vec2(0.5, width), vec2(-0.5, width)]
}

fn fall(outline: &[Vec2]) -> Result<World> {
    let mut world = ground()?;
    let (position, surface) = (vec2(0.0, 0.3), rough(0.6));
    let def = BodyDef::new(Shape::polygon(outline)?);
    world.add_body(BodyDef { position, angle: 0.05, surface, ..def })?;
    Ok(world)
}

const OMEGA: Real = 1e4;

/// Slips all the time: x = ½μgt².
pub static SPINNING_DISK: Hard = Hard {
    id: "X5",
    name: "disk at 10⁴ rad/s",
    about: "set down on the ground, μ = 0.6, it slips: x = ½μgt²",
    build: || spinning(Shape::circle(0.1)?, 0.1),
    should: Should::End(|| vec![vec2(0.5 * 0.6 * G * 4.0, 0.1)]),
    seconds: 2.0,
    ..PLAIN
};

pub static SPINNING_BOX: Hard = Hard {
    name: "box at 10⁴ rad/s",
    about: "half a metre large, falls on the ground from 1 m",
    build: || spinning(Shape::rectangle(0.5, 0.5)?, 1.0),
    should: Should::Calm,
    seconds: 5.0,
    ..SPINNING_DISK
};

fn spinning(shape: Shape, height: Real) -> Result<World> {
    let mut world = ground()?;
    let (position, surface) = (vec2(0.0, height), rough(0.6));
    world.add_body(BodyDef {
        position,
        angular_velocity: -OMEGA,
        surface,
        ..BodyDef::new(shape)
    })?;
    Ok(world)
}

const SPRING: Hard = Hard {
    id: "X6",
    name: "spring of 1000 Hz",
    about: "a disk hangs on it at rest, damping ratio 0.1",
    build: || hanging(1e3),
    ..PLAIN
};

pub static STIFF: [Hard; 2] =
    [SPRING, Hard { name: "spring of 10⁶ Hz", build: || hanging(1e6), ..SPRING }];

fn hanging(hertz: Real) -> Result<World> {
    let mut world = heavy()?;
    let omega = 2.0 * PI * hertz;
    let position = vec2(0.0, -1.0 - G / (omega * omega));
    let disk = BodyDef { mass: Some(1.0), ..BodyDef::new(Shape::circle(0.1)?) };
    let body = world.add_body(BodyDef { position, ..disk })?;
    let hold = Hold::soft(hertz, 0.1);
    let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
    let joint = JointDef::new(None, body, kind);
    world.add_joint(joint.anchored_locally(Vec2::zeros(), Vec2::zeros()))?;
    Ok(world)
}

pub static CROWD: Hard = Hard {
    id: "X8",
    name: "50 at one point",
    about: "disks of 0.2 m, without gravity",
    build: || {
        let mut world = weightless()?;
        for _ in 0..50 {
            let (position, surface) = (vec2(1.0, 2.0), rough(0.6));
            world.add_body(BodyDef { position, surface, ..BodyDef::new(Shape::circle(0.1)?) })?;
        }
        Ok(world)
    },
    should: Should::Part,
    size: 0.2,
    seconds: 60.0,
    ..PLAIN
};

pub static VARYING: Hard = Hard {
    id: "X10",
    name: "steps that vary",
    about: "a stack of 10 boxes, each step from a quarter to four times what is asked",
    build: || tower::<10>(false, 0.0),
    varies: true,
    ..PLAIN
};

pub static TILES: Hard = Hard {
    id: "X13",
    name: "box over seams",
    about: "slides at 5 m/s over a floor of tiles of 1 m, without friction",
    build: || {
        let mut world = heavy()?;
        for k in 0..30 {
            let tile = BodyDef::new(Shape::rectangle(1.0, 1.0)?);
            let position = vec2(Real::from(k), -0.5);
            let surface = smooth(0.0);
            world.add_body(BodyDef { kind: BodyKind::Static, position, surface, ..tile })?;
        }
        let square = BodyDef::new(Shape::rectangle(0.5, 0.5)?);
        let (position, velocity) = (vec2(1.0, 0.25), vec2(5.0, 0.0));
        world.add_body(BodyDef { position, velocity, surface: smooth(0.0), ..square })?;
        Ok(world)
    },
    should: Should::End(|| vec![vec2(26.0, 0.25)]),
    seconds: 5.0,
    ..PLAIN
};

pub static REPEAT: Hard = Hard {
    id: "X14",
    name: "the same again",
    about: "a pile of boxes and disks, twice",
    build: || {
        let mut world = pile(Layout::PLAIN)?;
        level(&mut world, &rough(0.6))?;
        Ok(world)
    },
    should: Should::Repeat,
    seconds: 5.0,
    ..PLAIN
};

pub static BIN: Hard = Hard {
    id: "X15",
    name: "random bin",
    about: "5 to 12 bodies of many shapes and densities thrown into a bin",
    build: || {
        let (mut world, _) = bin(1)?;
        let surface =
            Surface { restitution: 0.3, friction: Friction::of(0.6), ..Surface::default() };
        level(&mut world, &surface)?;
        Ok(world)
    },
    should: Should::Calm,
    ..PLAIN
};

/// Gives all bodies one surface, since engines differ in what they make of two.
fn level(world: &mut World, surface: &Surface) -> Result<()> {
    for handle in world.bodies().handles().to_vec() {
        world.body_mut(handle)?.set_surface(surface.clone())?;
    }
    Ok(())
}

pub static FAST: Hard = Hard {
    id: "C12",
    name: "fast disks",
    about: "20 disks of 0.2 m at 1000 m/s against a wall of 2 cm",
    build: || {
        let mut world = weightless()?;
        let wall = BodyDef::new(Shape::rectangle(0.02, 10.0)?);
        let (kind, position) = (BodyKind::Static, vec2(0.01, 0.0));
        world.add_body(BodyDef { kind, position, surface: rough(0.6), ..wall })?;
        for k in 0..20 {
            let k = Real::from(k);
            let disk = BodyDef::new(Shape::circle(0.1)?);
            let (position, velocity) = (vec2(-3.0 - 0.37 * k, 0.4 * k - 3.8), vec2(1e3, 0.0));
            world.add_body(BodyDef { position, velocity, surface: rough(0.6), ..disk })?;
        }
        Ok(world)
    },
    should: Should::Stop(0.0),
    size: 0.2,
    seconds: 0.5,
    ..PLAIN
};

pub static SPIN: Hard = Hard {
    id: "S13",
    name: "fast spin",
    about: "a bar turning at 10⁴ rad/s, alone",
    build: || {
        let mut world = weightless()?;
        let bar = BodyDef::new(Shape::rectangle(1.0, 0.1)?);
        world.add_body(BodyDef { angular_velocity: OMEGA, ..bar })?;
        Ok(world)
    },
    should: Should::Turn,
    seconds: 1.0,
    ..PLAIN
};
