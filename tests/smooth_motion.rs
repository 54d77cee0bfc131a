//! Orders of the methods, and exact solutions.
use culbuto::forces::Central;
use culbuto::math::{Twist, vec2};
use culbuto::{BodyDef, World};

fn kepler(method: &str) -> World {
    let mut w = World::new(vec2(0.0, 0.0)).unwrap();
    w.set_method(method).unwrap();
    w.set_substeps(1).unwrap();
    w.add_field(Central { center: vec2(0.0, 0.0), strength: 1.0, exponent: -2.0, per_mass: true });
    w.add_body(BodyDef {
        position: vec2(0.4, 0.0),
        velocity: vec2(0.0, 2.0),
        ..BodyDef::point(1.0)
    })
    .unwrap();
    w
}

#[test]
fn orders() {
    let exact = vec2(-0.628948176827, 0.799664730970);
    for m in culbuto::methods::REGISTRY {
        let f = m.facts();
        let mut last = f64::NAN;
        print!("{} ", f.name);
        for k in 4..13 {
            let n = 1 << k;
            let mut w = kepler(f.name);
            w.steps(1.0 / n as f64, n).unwrap();
            let e = (w.bodies().poses[0].position - exact).norm();
            print!(" {:.1e}({:.2})", e, (last / e).log2());
            last = e;
        }
        println!(" evals {}", {
            let mut w = kepler(f.name);
            w.steps(1.0 / 16.0, 16).unwrap();
            w.report().evaluations
        });
    }
    for tol in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
        let mut w = kepler("leapfrog");
        let r = w.advance(1.0, tol).unwrap().clone();
        println!("{tol:e} {:e} {r:?}", (w.bodies().poses[0].position - exact).norm());
    }
    let mut w = kepler("leapfrog");
    let e0 = w.energy().unwrap().balance();
    let t = std::time::Instant::now();
    w.advance(1000.0 * std::f64::consts::TAU, 1e-13).unwrap();
    println!(
        "1000 orbits {:e} {:?} {:?}",
        w.energy().unwrap().balance() - e0,
        w.report(),
        t.elapsed()
    );
    let _ = Twist::ZERO;
}
