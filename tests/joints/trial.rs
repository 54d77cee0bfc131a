use culbuto::joint::*;
use culbuto::math::*;
use culbuto::*;

fn rod() -> BodyDef {
    BodyDef { mass: Some(1.0), inertia: Some(1.0 / 12.0), ..BodyDef::default() }
}

#[test]
fn pendulum() {
    for (dt, sub) in [(1.0 / 60.0, 4), (1.0 / 120.0, 4)] {
        let mut w = World::new(vec2(0.0, -9.81)).unwrap();
        w.set_substeps(sub).unwrap();
        let b = w.add_body(BodyDef { position: vec2(1.0, 0.0), ..BodyDef::point(1.0) }).unwrap();
        let j = w.add_joint(JointDef::distance(None, b).anchored(vec2(0.0, 0.0), vec2(1.0, 0.0))).unwrap();
        let e0 = w.energy().unwrap();
        w.steps(dt, (10.0 / dt).round() as u32).unwrap();
        let p = w.body(b).unwrap().position();
        let e = w.energy().unwrap();
        println!("S9 {} err {:e} dE {:e} bal {:e} corr {:e} gap {:e} {:?}", 1.0/dt, atan2(p.x, -p.y) - 0.278680673570, (e.total() - e0.total())/9.81, e.balance() - e0.balance(), e.correction_work, w.joint(j).unwrap().gap(), w.joint(j).unwrap().reaction());
        let mut w = World::new(vec2(0.0, -9.81)).unwrap();
        let b = w.add_body(BodyDef { position: vec2(0.5, 0.0), ..rod() }).unwrap();
        let j = w.add_joint(JointDef::revolute(None, b).at(vec2(0.0, 0.0))).unwrap();
        let e0 = w.energy().unwrap();
        w.steps(dt, (10.0 / dt).round() as u32).unwrap();
        let e = w.energy().unwrap();
        println!("S10 {} err {:e} dE {:e} bal {:e} gap {:e}", 1.0/dt, w.body(b).unwrap().angle() + PI/2.0 - 0.770957622575, (e.total() - e0.total())/9.81, e.balance() - e0.balance(), w.joint(j).unwrap().gap());
        let mut w = World::new(vec2(0.0, -9.81)).unwrap();
        let a = w.add_body(BodyDef { position: vec2(0.5, 0.0), ..rod() }).unwrap();
        let b = w.add_body(BodyDef { position: vec2(1.5, 0.0), ..rod() }).unwrap();
        w.add_joint(JointDef::revolute(None, a).at(vec2(0.0, 0.0))).unwrap();
        let j = w.add_joint(JointDef::revolute(a, b).at(vec2(1.0, 0.0))).unwrap();
        let e0 = w.energy().unwrap();
        w.steps(dt, (3.0 / dt).round() as u32).unwrap();
        let e = w.energy().unwrap();
        println!("S11 {} err {:e} dE {:e} bal {:e} gap {:e}", 1.0/dt, (w.body(b).unwrap().position() - vec2(1.0925978301698, -0.9588351147544)).norm(), (e.total() - e0.total())/9.81, e.balance() - e0.balance(), w.joint(j).unwrap().gap());
    }
}

#[test]
fn chain_and_spring() {
    for ratio in [1.0, 1e3, 1e6] {
        let mut w = World::new(vec2(0.0, -9.81)).unwrap();
        let mut last = None;
        let mut js = vec![];
        for i in 0..20 {
            let m = if i == 19 { ratio } else { 1.0 };
            let b = w.add_body(BodyDef { position: vec2(0.0, -0.5 - i as f64), mass: Some(m), inertia: Some(m / 12.0), ..BodyDef::default() }).unwrap();
            js.push(w.add_joint(JointDef::revolute(last, b).at(vec2(0.0, -(i as f64)))).unwrap());
            last = Some(b);
        }
        w.steps(1.0 / 60.0, 120).unwrap();
        let gap = js.iter().map(|j| w.joint(*j).unwrap().gap()).fold(0.0, f64::max);
        println!("Q2 {ratio:e}: gap {gap:e} end {:e} top {:?}", w.body(last.unwrap()).unwrap().position().y + 19.5, w.joint(js[0]).unwrap().reaction());
    }
    for (zeta, exact) in [(0.0, -0.202254248594), (0.1, -0.0442471038396), (1.0, 3.48448762479e-7), (2.0, 3.38269244791e-3)] {
        let mut w = World::default();
        w.set_gravity(vec2(0.0, 0.0)).unwrap();
        let b = w.add_body(BodyDef { position: vec2(1.25, 0.0), ..BodyDef::point(2.0) }).unwrap();
        let kind = JointKind::Distance { length: Some(1.0), hold: Hold::soft(2.0, zeta), min: 0.0, max: None };
        w.add_joint(JointDef::new(None, b, kind).anchored(vec2(0.0, 0.0), vec2(1.25, 0.0))).unwrap();
        let e0 = w.energy().unwrap();
        w.steps(1.3 / 78.0, 78).unwrap();
        let e = w.energy().unwrap();
        println!("S7 {zeta}: {:e} bal {:e} diss {:e}", w.body(b).unwrap().position().x - 1.0 - exact, e.balance() - e0.balance(), e.dissipated);
    }
    for hertz in [1.0, 10.0, 100.0, 1e3, 1e6] {
      for zeta in [0.0, 1.0, 10.0] {
        let mut w = World::new(vec2(0.0, -9.81)).unwrap();
        let b = w.add_body(BodyDef { position: vec2(0.0, -1.0), ..BodyDef::point(2.0) }).unwrap();
        w.add_joint(JointDef::spring(None, b, Hold::soft(hertz, zeta)).anchored(vec2(0.0, 0.0), vec2(0.0, -1.0))).unwrap();
        w.steps(1.0 / 60.0, 600).unwrap();
        let om = 2.0 * PI * hertz;
        println!("X6 {hertz} {zeta}: sag/exact {} speed {:e}", (-1.0 - w.body(b).unwrap().position().y) / (9.81 / om / om), w.body(b).unwrap().velocity().norm());
      }
    }
}
