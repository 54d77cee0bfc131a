use culbuto::body::*;
use culbuto::math::*;
use culbuto::scenes::*;
use culbuto::{BodyDef, World, shapes::Shape};
#[test]
fn painleve() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    let s = Surface { friction: Friction::of(1.6), ..Surface::default() };
    world
        .add_body(BodyDef {
            kind: BodyKind::Static,
            position: vec2(0.0, -0.5),
            surface: s.clone(),
            ..BodyDef::new(Shape::rectangle(200.0, 1.0).unwrap())
        })
        .unwrap();
    let a = 2f64.atan();
    world
        .add_body(BodyDef {
            position: vec2(0.5 * a.cos(), 0.5 * a.sin()),
            angle: a,
            velocity: vec2(-5.0, 0.0),
            surface: s,
            ..BodyDef::new(Shape::segment(vec2(-0.5, 0.0), vec2(0.5, 0.0)).unwrap())
        })
        .unwrap();
    let e0 = world.energy().unwrap().total();
    let mut b = world.energy().unwrap();
    for k in 0..180 {
        world.step(1.0 / 60.0).unwrap();
        let e = world.energy().unwrap();
        let p = world.bodies().poses[1];
        let t = world.bodies().twists[1];
        if k < 6 || e.total() > b.total() {
            println!(
                "{k} total {:.9} d/e0 {:.2e} corr {:.3e} diss {:.3e} bal {:.2e} angle {:.5} y {:.6} v {:?} w {:.4} tip {:.2e} {:.2e} imp {}",
                e.total(),
                (e.total() - b.total()) / e0,
                e.correction_work - b.correction_work,
                e.dissipated - b.dissipated,
                e.balance() - b.balance(),
                p.angle,
                p.position.y,
                t.linear.as_slice(),
                t.angular,
                p.position.y - 0.5 * p.angle.sin(),
                p.position.y + 0.5 * p.angle.sin(),
                world.report().impacts
            );
        }
        b = e;
    }
}
#[test]
fn gas() {
    let s = || Surface { friction: Friction::of(0.0), restitution: 1.0, ..Surface::default() };
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    for side in [-1.0, 1.0] {
        for (p, d) in [(vec2(side * 10.5, 0.0), [1.0, 22.0]), (vec2(0.0, side * 10.5), [22.0, 1.0])]
        {
            world
                .add_body(BodyDef {
                    kind: BodyKind::Static,
                    position: p,
                    surface: s(),
                    ..BodyDef::new(Shape::rectangle(d[0], d[1]).unwrap())
                })
                .unwrap();
        }
    }
    let mut r = 1u64;
    let mut rnd = move || {
        r = r.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = r;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        -5.0 + 10.0 * ((z >> 11) as f64 / (1u64 << 53) as f64)
    };
    for row in 0..10 {
        for col in 0..10 {
            let pl = |k: i32| 10.0 * ((2.0 * k as f64 + 1.0) / 10.0 - 1.0);
            world
                .add_body(BodyDef {
                    position: vec2(pl(col), pl(row)),
                    velocity: vec2(rnd(), rnd()),
                    surface: s(),
                    ..BodyDef::new(Shape::circle(0.3).unwrap())
                })
                .unwrap();
        }
    }
    let mut b = world.energy().unwrap();
    let e0 = b.kinetic;
    for k in 0..3600 {
        let before = world.clone();
        world.step(1.0 / 60.0).unwrap();
        let e = world.energy().unwrap();
        if (e.total() - b.total()).abs() / e0 > 1e-12 {
            println!(
                "{k} d {:.2e} corr {:.2e} diss {:.2e} imp {}",
                (e.total() - b.total()) / e0,
                e.correction_work - b.correction_work,
                e.dissipated - b.dissipated,
                world.report().impacts
            );
            for i in 0..world.bodies().len() {
                let (v, w) = (before.bodies().twists[i], world.bodies().twists[i]);
                if v != w {
                    println!(
                        "   {i} {:?} {:?} -> {:?}",
                        before.bodies().poses[i].position.as_slice(),
                        v.linear.as_slice(),
                        w.linear.as_slice()
                    );
                }
            }
        }
        b = e;
    }
}
