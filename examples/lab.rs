use culbuto::body::*;
use culbuto::math::*;
use culbuto::shapes::Shape;
use culbuto::*;
use std::time::Instant;
struct Rng(u64);
impl Rng {
    fn f(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn r(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.f()
    }
}
fn st(shape: Shape, p: Vec2, a: f64, mu: f64, e: f64) -> BodyDef {
    let mut d = BodyDef { kind: BodyKind::Static, position: p, angle: a, ..BodyDef::new(shape) };
    d.surface.friction = Friction::of(mu);
    d.surface.restitution = e;
    d
}
fn dy(shape: Shape, p: Vec2, a: f64, mu: f64, e: f64) -> BodyDef {
    BodyDef { kind: BodyKind::Dynamic, ..st(shape, p, a, mu, e) }
}
fn bx(x: f64, y: f64) -> Shape {
    Shape::rectangle(2. * x, 2. * y).unwrap()
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let sweeps: u32 = a.get(2).map_or(8, |s| s.parse().unwrap());
    let tend_o: Option<f64> = a.get(3).map(|s| s.parse().unwrap());
    for sc in a[1].split('/') {
        let mut r = Rng(88172645463325252);
        let (k, arg) = sc.split_at(sc.find(|c: char| c.is_ascii_digit()).unwrap_or(sc.len()));
        let n: usize = arg.parse().unwrap_or(0);
        let mut w = World::new(vec2(0., -10.)).unwrap();
        w.set_sweeps(sweeps).unwrap();
        let mut tend = 10.;
        let ground = |w: &mut World, mu: f64, e: f64| {
            w.add_body(st(bx(200., 5.), vec2(0., -5.), 0., mu, e)).unwrap();
        };
        match k {
            "slide" => {
                ground(&mut w, 0.5, 0.);
                let mut d = dy(bx(0.5, 0.5), vec2(-100., 0.5), 0., 0.5, 0.);
                d.velocity = vec2(10., 0.);
                w.add_body(d).unwrap();
                tend = 4.
            }
            "ball" => {
                ground(&mut w, 0., 1.);
                w.add_body(dy(Shape::circle(0.1).unwrap(), vec2(0., 5.), 0., 0., 1.)).unwrap();
                tend = 20.
            }
            "box" => {
                ground(&mut w, 0.5, 0.);
                w.add_body(dy(bx(0.5, 0.5), vec2(0., 0.5), 0., 0.5, 0.)).unwrap();
            }
            "gas" => {
                w.set_gravity(vec2(0., 0.)).unwrap();
                for (x, y, p) in [
                    (10., 1., vec2(0., -6.)),
                    (10., 1., vec2(0., 6.)),
                    (1., 10., vec2(-6., 0.)),
                    (1., 10., vec2(6., 0.)),
                ] {
                    w.add_body(st(bx(x, y), p, 0., 0., 1.)).unwrap();
                }
                for i in 0..n {
                    let mut d = dy(
                        Shape::circle(0.2).unwrap(),
                        vec2(-4.5 + (i % 10) as f64, -4.5 + (i / 10) as f64),
                        0.,
                        0.,
                        1.,
                    );
                    d.velocity = vec2(r.r(-5., 5.), r.r(-5., 5.));
                    w.add_body(d).unwrap();
                }
                tend = 20.
            }
            "cradle" => {
                w.set_gravity(vec2(0., 0.)).unwrap();
                for i in 0..5 {
                    let mut d = dy(
                        Shape::circle(0.5).unwrap(),
                        vec2(if i == 0 { -3. } else { i as f64 }, 0.),
                        0.,
                        0.,
                        1.,
                    );
                    if i == 0 {
                        d.velocity = vec2(5., 0.)
                    }
                    w.add_body(d).unwrap();
                }
                tend = 2.
            }
            "stack" => {
                ground(&mut w, 0.6, 0.);
                for i in 0..n {
                    w.add_body(dy(
                        bx(0.5, 0.5),
                        vec2(r.r(-0.01, 0.01), 0.5 + i as f64 + 0.01 * (i as f64 + 1.)),
                        0.,
                        0.6,
                        0.,
                    ))
                    .unwrap();
                }
                tend = 15.
            }
            "xstack" => {
                ground(&mut w, 0.6, 0.);
                for i in 0..n {
                    w.add_body(dy(bx(0.5, 0.5), vec2(0., 0.5 + i as f64), 0., 0.6, 0.)).unwrap();
                }
                tend = 10.
            }
            "pyr" => {
                ground(&mut w, 0.6, 0.);
                for i in 0..n {
                    for j in 0..n - i {
                        w.add_body(dy(
                            bx(0.5, 0.5),
                            vec2((j as f64 - (n - i) as f64 * 0.5) * 1.1, 0.5 + 1.005 * i as f64),
                            0.,
                            0.6,
                            0.,
                        ))
                        .unwrap();
                    }
                }
                tend = 8.
            }
            "ratio" => {
                ground(&mut w, 0.6, 0.);
                w.add_body(dy(bx(0.5, 0.5), vec2(0., 0.5), 0., 0.6, 0.)).unwrap();
                let mut d = dy(bx(0.5, 0.5), vec2(0., 1.51), 0., 0.6, 0.);
                d.density = n as f64;
                w.add_body(d).unwrap();
            }
            "card" => {
                w.add_body(st(bx(200., 5.), vec2(0., -5.), 0., 0.8, 0.)).unwrap();
                let (hx, hy) = (0.02, 0.6);
                let al = 25f64.to_radians();
                let (ww, hh) =
                    (2. * (hy * al.sin() + hx * al.cos()), 2. * (hy * al.cos() + hx * al.sin()));
                let lv = n;
                for i in 0..lv {
                    let c = lv - i;
                    let y0 = i as f64 * (hh + 2. * hx);
                    for j in 0..c {
                        let x = (j as f64 - (c as f64 - 1.) * 0.5) * 2. * ww;
                        for s in [-1., 1.] {
                            w.add_body(dy(
                                bx(hx, hy),
                                vec2(x + s * 0.5 * ww, y0 + 0.5 * hh),
                                s * al,
                                0.8,
                                0.,
                            ))
                            .unwrap();
                        }
                    }
                    for j in 0..c.saturating_sub(1) {
                        let x = (j as f64 - (c as f64 - 2.) * 0.5) * 2. * ww;
                        w.add_body(dy(bx(ww * 0.98, hx), vec2(x, y0 + hh + hx), 0., 0.8, 0.))
                            .unwrap();
                    }
                }
            }
            "bin" => {
                ground(&mut w, 0.6, 0.);
                w.add_body(st(bx(1., 30.), vec2(-9., 20.), 0., 0.6, 0.)).unwrap();
                w.add_body(st(bx(1., 30.), vec2(9., 20.), 0., 0.6, 0.)).unwrap();
                for i in 0..n {
                    let p = vec2(
                        -7. + 14. / 13. * (i % 14) as f64 + r.r(-0.1, 0.1),
                        1. + 1.1 * (i / 14) as f64,
                    );
                    if i % 2 == 0 {
                        w.add_body(dy(Shape::circle(r.r(0.25, 0.45)).unwrap(), p, 0., 0.6, 0.))
                            .unwrap();
                    } else {
                        let s = bx(r.r(0.2, 0.4), r.r(0.2, 0.4));
                        w.add_body(dy(s, p, r.r(0., 6.), 0.6, 0.)).unwrap();
                    }
                }
                tend = 12.
            }
            _ => panic!("scene"),
        }
        if let Some(t) = tend_o {
            tend = t
        }
        w.set_timing(true);
        let p0: Vec<Vec2> = w.bodies().poses.iter().map(|p| p.position).collect();
        let e0 = w.energy().unwrap();
        let dt = 1. / 60.;
        let ns = (tend / dt).round() as usize;
        let t0 = Instant::now();
        let mut sw = 0;
        let mut vmax = 0f64;
        let (mut bal, mut emax) = (0f64, f64::MIN);
        let mut st = std::collections::BTreeMap::new();
        let mut dmin = 0.;
        let mut res = 0f64;
        let mut corr = 0.;
        let mut imp = 0;
        for i in 0..ns {
            w.step(dt).unwrap();
            let rep = w.report();
            sw += rep.sweeps;
            imp += rep.impacts;
            res = rep.residual;
            for s in &rep.stages {
                *st.entry(s.name).or_insert(0.) += s.seconds;
            }
            let e = w.energy().unwrap();
            bal = bal.max((e.balance() - e0.balance()).abs());
            emax = emax.max(e.total() - e0.total() - e.work - e.correction_work);
            dmin = f64::min(dmin, e.dissipated);
            corr = e.correction_work;
            if i + 60 >= ns {
                for t in &w.bodies().twists {
                    vmax = vmax.max(t.linear.norm()).max(t.angular.abs() * 0.5)
                }
            }
        }
        let el = t0.elapsed().as_secs_f64();
        let mut drift = 0f64;
        let mut fell = 0;
        for (p, q) in w.bodies().poses.iter().zip(&p0) {
            drift = drift.max((p.position.x - q.x).abs());
            if p.position.y < q.y - 0.4 {
                fell += 1
            }
        }
        let sc_e = e0.total().abs().max(1.);
        println!(
            "{sc:10} sweeps<= {sweeps} vmax {vmax:.1e} drift {drift:.2e} fell {fell} | E rel bal {:.1e} gain {:.1e} diss>= {dmin:.1e} corr {corr:.1e} res {res:.1e} | {:.0} us/step sweeps/sub {:.2} impacts {imp} | {}",
            bal / sc_e,
            emax / sc_e,
            el / ns as f64 * 1e6,
            sw as f64 / ns as f64 / 4.,
            st.iter()
                .map(|(k, v)| format!("{k} {:.0}", v / ns as f64 * 1e6))
                .collect::<Vec<_>>()
                .join(" ")
        );
        match k {
            "slide" => println!(
                "   stop err {:e} {:?}",
                w.bodies().poses[1].position.x + 90.,
                w.bodies().poses[1]
            ),
            "cradle" => println!(
                "   {:?}",
                w.bodies().twists.iter().map(|t| t.linear.x).collect::<Vec<_>>()
            ),
            _ => {}
        }
    }
}
