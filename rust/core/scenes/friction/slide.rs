//! Blocks that slide, or do not.

use crate::body::{Friction, Surface};
use crate::error::Result;
use crate::forces::{BodyColumns, BoxError, FieldFacts, ForceField, ForceSchedule};
use crate::math::{Pose, Real, Wrench, atan2, vec2};
use crate::scenes::stage::{
    DT, G, HALF, TOLERANCE, add_ground, at_fixed_step, ground, heavy, on_plane, rough, standing,
    with_tolerance,
};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced};
use crate::shapes::Shape;
use crate::world::World;

/// A block of 1 × 0.5 m on a plane.
const SIZE: [Real; 2] = [1.0, 0.5];

/// Where the block is when it has gone a way along the plane.
fn block(slope: Real, way: Real) -> Pose {
    on_plane(slope, [way, 0.5 * SIZE[1]], 0.0)
}

/// A block on a plane, with the same surface, moving down it at a speed.
fn on_slope(slope: Real, surface: &Surface, speed: Real) -> Result<World> {
    let mut world = heavy()?;
    add_ground(&mut world, slope, surface.clone())?;
    let shape = Shape::rectangle(SIZE[0], SIZE[1])?;
    let mut def = standing(shape, block(slope, 0.0), surface.clone());
    def.velocity = on_plane(slope, [speed, 0.0], 0.0).position;
    world.add_body(def)?;
    Ok(world)
}

/// How far the block has gone from where it was put (m).
fn gone(world: &World, slope: Real) -> Real {
    (world.bodies().poses[1].position - block(slope, 0.0).position).norm()
}

/// sin α, cos α and α of the incline with tan α = ½.
fn incline() -> [Real; 3] {
    let long = libm::sqrt(1.0 + HALF * HALF);
    [HALF / long, 1.0 / long, atan2(HALF, 1.0)]
}

pub static INCLINE: Scene = Scene {
    id: "F1",
    name: "incline",
    title: "A block on an incline, friction a thousandth above and below what holds it",
    about: "It stays for ever with μ ≥ tan α, and slides with less: ½g(sin α − μ cos α)t².",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| Ok(Vec::new())),
    checks: &[
        at_fixed_step("way in 60 s with μ = 1.001 tan α (m)", 1e-6, || {
            let [_, _, slope] = incline();
            let mut world = on_slope(slope, &rough(1.001 * HALF), 0.0)?;
            world.steps(DT, 3600)?;
            Ok(gone(&world, slope))
        }),
        at_fixed_step("way in 60 s with μ = 0.999 tan α, relative", 1e-5, || {
            let [sin, _, slope] = incline();
            let mut world = on_slope(slope, &rough(0.999 * HALF), 0.0)?;
            world.steps(DT, 3600)?;
            let exact = 0.5 * G * sin * 1e-3 * 3600.0;
            Ok((gone(&world, slope) / exact - 1.0).abs())
        }),
        with_tolerance("way in 60 s with μ = 1.001 tan α (m)", 1e-12, || {
            let [_, _, slope] = incline();
            let mut world = on_slope(slope, &rough(1.001 * HALF), 0.0)?;
            world.advance(60.0, TOLERANCE)?;
            Ok(gone(&world, slope))
        }),
        with_tolerance("way in 60 s with μ = 0.999 tan α, relative", 1e-11, || {
            let [sin, _, slope] = incline();
            let mut world = on_slope(slope, &rough(0.999 * HALF), 0.0)?;
            world.advance(60.0, TOLERANCE)?;
            let exact = 0.5 * G * sin * 1e-3 * 3600.0;
            Ok((gone(&world, slope) / exact - 1.0).abs())
        }),
    ],
};

pub static SLIDING: Scene = Scene {
    id: "F2",
    name: "sliding_block",
    title: "A block slides down an incline, tan α = ½, μ = 0.3",
    about: "a = g(sin α − μ cos α) = 1.75486614874 m/s².",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || on_slope(incline()[2], &rough(0.3), 0.0),
        exact: |t| {
            let [sin, cos, slope] = incline();
            vec![ground(slope), block(slope, 0.5 * G * (sin - 0.3 * cos) * t * t)]
        },
        duration: 4.0,
        dt: DT,
        length: 14.0,
        fixed: 1e-5,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-12 }),
        judged: Judged::Contact { order: true },
    }),
    checks: &[at_fixed_step("acceleration against 1.75486614874 m/s², relative", 1e-5, || {
        let [_, _, slope] = incline();
        let mut world = on_slope(slope, &rough(0.3), 0.0)?;
        world.steps(DT, 120)?;
        Ok((world.bodies().twists[1].linear.norm() / 2.0 / 1.754_866_148_74 - 1.0).abs())
    })],
};

/// Start of the stopping block (m/s) and its deceleration (m/s²).
const SPEED: Real = 10.0;
const BRAKE: Real = 0.5 * G;

pub static STOPPING: Scene = Scene {
    id: "F3",
    name: "stopping_block",
    title: "A block slides to rest from 10 m/s, μ = 0.5",
    about: "At rest after v²/2μg = 10.1936799185 m and v/μg = 2.03873598369 s.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || on_slope(0.0, &rough(0.5), SPEED),
        exact: |t| {
            let t = t.min(SPEED / BRAKE);
            vec![ground(0.0), block(0.0, SPEED * t - 0.5 * BRAKE * t * t)]
        },
        duration: 3.0,
        dt: DT,
        length: 10.193_679_918_5,
        fixed: 1e-4,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-10 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("way to rest against 10.1936799185 m, relative", 1e-4, || {
            let mut world = on_slope(0.0, &rough(0.5), SPEED)?;
            world.steps(DT, 180)?;
            let moves = world.bodies().twists[1].linear.norm() > 1e-9;
            let off = (gone(&world, 0.0) / 10.193_679_918_5 - 1.0).abs();
            Ok(if moves { Real::INFINITY } else { off })
        }),
        at_fixed_step("time to rest against 2.03873598369 s, relative", 1e-4, || {
            // From the line through the last two speeds before.
            let mut world = on_slope(0.0, &rough(0.5), SPEED)?;
            let (mut speeds, mut last) = ([SPEED; 2], 0.0);
            loop {
                world.step(DT)?;
                let speed = world.bodies().twists[1].linear.x;
                if speed <= 1e-9 * SPEED || world.time() > 3.0 {
                    break;
                }
                (speeds, last) = ([speeds[1], speed], world.time());
            }
            let rest = speeds[1] * DT / (speeds[0] - speeds[1]);
            Ok(((last + rest) / 2.038_735_983_69 - 1.0).abs())
        }),
    ],
};

/// Static and kinetic friction, and the rate of the pull on 1 kg (N/s).
const STATIC: Real = 0.5;
const KINETIC: Real = 0.3;
const RATE: Real = 0.97;
const BREAK: Real = STATIC * G / RATE;
/// Length of a substep (s).
const SUBSTEP: Real = DT / 4.0;

/// The block that is to be pulled, at rest.
fn resting() -> Result<World> {
    let mut world = heavy()?;
    let surface =
        Surface { friction: Friction { sticking: STATIC, sliding: KINETIC }, ..rough(0.0) };
    add_ground(&mut world, 0.0, surface.clone())?;
    let mut def = standing(Shape::rectangle(SIZE[0], SIZE[1])?, block(0.0, 0.0), surface);
    def.mass = Some(1.0);
    world.add_body(def)?;
    Ok(world)
}

/// How far the block has gone (m).
fn way_pulled(t: Real) -> Real {
    let since = (t - BREAK).max(0.0);
    let jump = (STATIC - KINETIC) * G;
    since * since * (0.5 * jump + RATE * since / 6.0)
}

/// The pull on the block, F = ct.
struct Ramp;

impl ForceField for Ramp {
    fn name(&self) -> &'static str {
        "ramp"
    }

    fn add_forces(
        &self,
        time: Real,
        _: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> std::result::Result<(), BoxError> {
        out[1].force.x += RATE * time;
        Ok(())
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, ..FieldFacts::default() }
    }
}

/// A block that is pulled ever harder: the force of each substep is the one in its middle.
fn pulled() -> Result<World> {
    let mut world = resting()?;
    let body = world.bodies().handles()[1];
    let pieces = 0..=2400;
    let times = pieces.clone().map(|k| SUBSTEP * Real::from(k)).collect();
    let pull = |k: i32| Wrench::new(vec2(RATE * SUBSTEP * (Real::from(k) + 0.5), 0.0), 0.0);
    world.add_schedule(
        body,
        ForceSchedule::new(times, pieces.skip(1).map(|k| pull(k - 1)).collect())?,
    )?;
    // The steps end where the force changes: a substep each.
    world.set_substeps(1)?;
    Ok(world)
}

pub static BREAKAWAY: Scene = Scene {
    id: "F4",
    name: "breakaway",
    title: "A block pulled ever harder breaks away, static friction above kinetic",
    about: "Pulled by F = ct it stays until μs·m·g/c, and goes with (ct − μk·m·g)/m from then on. The pull is a schedule that changes with each substep.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: pulled,
        exact: |t| vec![ground(0.0), block(0.0, way_pulled(t))],
        duration: 10.0,
        dt: DT,
        length: 43.5,
        fixed: 1e-3,
        // The pull is a staircase here; to a tolerance it is the ramp itself, below.
        toleranced: None,
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        with_tolerance("way under the ramp itself, over ten samples, of 43.5 m", 1e-9, || {
            let mut world = resting()?;
            world.add_field(Ramp);
            let times: Vec<Real> = (1..=10).map(Real::from).collect();
            let run = world.advance_sampled(10.0, TOLERANCE, &times)?;
            let off = |k: usize| (run.pose(k, 1).position.x - way_pulled(times[k])).abs() / 43.5;
            Ok((0..10).map(off).fold(0.0, Real::max))
        }),
        at_fixed_step("moment at which it breaks away, relative", 1e-3, || {
            let mut world = pulled()?;
            while world.bodies().twists[1].linear.x < 1e-9 && world.time() < 10.0 {
                world.step(SUBSTEP)?;
            }
            Ok(((world.time() - 0.5 * SUBSTEP) / BREAK - 1.0).abs())
        }),
    ],
};

/// Speed (m/s) and friction of the conveyor.
const BELT: Real = 2.0;
const GRIP: Real = 0.3;

pub static CONVEYOR: Scene = Scene {
    id: "F14",
    name: "conveyor",
    title: "A block is put on a conveyor of 2 m/s, μ = 0.3",
    about: "It catches up after u/μg, having slipped u²/2μg.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = heavy()?;
            // The border runs counter-clockwise: at the top towards −x.
            let belt = Surface { tangent_speed: -BELT, ..rough(GRIP) };
            add_ground(&mut world, 0.0, belt)?;
            let shape = Shape::rectangle(SIZE[0], SIZE[1])?;
            world.add_body(standing(shape, block(0.0, 0.0), rough(GRIP)))?;
            Ok(world)
        },
        exact: |t| {
            let slipping = t.min(BELT / (GRIP * G));
            let way = 0.5 * GRIP * G * slipping * slipping + BELT * (t - slipping);
            vec![ground(0.0), block(0.0, way)]
        },
        duration: 2.0,
        dt: DT,
        length: 3.0,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-10 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("way slipped against u²/2μg, relative", 1e-3, || {
            let Answer::Motion(motion) = CONVEYOR.answer else { return Ok(Real::INFINITY) };
            let mut world = (motion.build)()?;
            world.steps(DT, 120)?;
            let slipped = BELT * world.time() - gone(&world, 0.0);
            Ok((slipped / (BELT * BELT / (2.0 * GRIP * G)) - 1.0).abs())
        }),
        at_fixed_step("speed when carried along against u, relative", 1e-3, || {
            let Answer::Motion(motion) = CONVEYOR.answer else { return Ok(Real::INFINITY) };
            let mut world = (motion.build)()?;
            world.steps(DT, 120)?;
            Ok((world.bodies().twists[1].linear.x / BELT - 1.0).abs())
        }),
    ],
};
