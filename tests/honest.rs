//! The report cannot flatter: a method that is broken on purpose gets the order it has and a failing row, whatever it
//! states.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

use culbuto::error::Result;
use culbuto::math::Twist;
use culbuto::methods::{Facts, Method, Motion, REGISTRY, Scratch, Span, System};
use culbuto::report::{MethodRow, Study, study_by, verify_by};
use culbuto::scenes::scene;

/// What an honest leapfrog states.
const fn stated(name: &'static str) -> Facts {
    Facts {
        name,
        order: 2,
        symplectic: true,
        reversible: true,
        exact_for_constant_force: true,
        adaptive: false,
        joints: false,
        contacts: false,
        about: "kick, drift, kick, but for what is broken",
    }
}

static SOUND: Facts = stated("sound");
static FIRST_ORDER: Facts = stated("first_order");
static SIGN: Facts = stated("sign");
static LOST: Facts = stated("lost");

/// Kick, drift, kick, with one thing broken.
struct Broken(&'static Facts);

impl Method for Broken {
    fn facts(&self) -> &'static Facts {
        self.0
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        _: &mut Scratch,
    ) -> Result<()> {
        let h = span.h();
        let mut a = vec![Twist::ZERO; motion.poses.len()];
        for k in 0..span.substeps {
            // A whole kick at the start of the step and none at its end is semi-implicit Euler.
            let halves = if self.0.name == "first_order" { [1.0, 0.0] } else { [0.5, 0.5] };
            for (half, part) in halves.into_iter().enumerate() {
                let time = if half == 0 { span.time(k) } else { span.time(k + 1) };
                system.accelerate(time, motion.poses, motion.twists, &mut a)?;
                let wrong = match self.0.name {
                    "sign" => -1.0,
                    // The first half kick after 0 s and after 0.5 s.
                    "lost" if half == 0 && (time / 0.5).fract() * 0.5 < h && time < 1.0 => 0.0,
                    _ => 1.0,
                };
                for (pose, (twist, a)) in
                    motion.poses.iter_mut().zip(motion.twists.iter_mut().zip(&a))
                {
                    twist.linear += a.linear * (part * wrong * h);
                    twist.angular += a.angular * (part * wrong * h);
                    if half == 0 {
                        pose.position += twist.linear * h;
                        pose.angle += twist.angular * h;
                    }
                }
            }
        }
        Ok(())
    }
}

fn row(method: &'static dyn Method) -> MethodRow {
    let verdict = verify_by(scene("kepler").unwrap(), &[method]).unwrap();
    let [row] = <[MethodRow; 1]>::try_from(verdict.methods).unwrap();
    assert_eq!(verdict.pass, row.pass, "a method that fails fails the scene");
    row
}

#[test]
fn the_unbroken_one_passes() {
    static METHOD: Broken = Broken(&SOUND);
    let row = row(&METHOD);
    assert!(row.pass, "{row:?}");
    assert!((row.order_measured.unwrap() - 2.0).abs() < 0.2, "{row:?}");
}

#[test]
fn a_lower_order_than_stated_is_measured_and_fails() {
    static METHOD: Broken = Broken(&FIRST_ORDER);
    let row = row(&METHOD);
    assert!(!row.pass, "{row:?}");
    assert!((row.order_measured.unwrap() - 1.0).abs() < 0.2, "{row:?}");
}

#[test]
fn a_sign_error_has_no_order_and_fails() {
    static METHOD: Broken = Broken(&SIGN);
    let row = row(&METHOD);
    assert!(!row.pass && row.order_measured.is_none() && !row.exact, "{row:?}");
    assert!(row.error > 0.1, "{row:?}");
}

#[test]
fn a_lost_impulse_costs_the_order_and_fails() {
    static METHOD: Broken = Broken(&LOST);
    let row = row(&METHOD);
    assert!(!row.pass, "{row:?}");
    assert!(row.order_measured.is_none_or(|order| order < 1.5), "{row:?}");
}

#[test]
fn rows_of_a_broken_method_show_its_errors() {
    static METHOD: Broken = Broken(&SIGN);
    let what =
        Study { steps: vec![64, 1024], tolerances: Vec::new(), repeats: 1, ..Study::default() };
    let kepler = scene("kepler").unwrap();
    let broken = study_by(kepler, &what, &[&METHOD]).unwrap();
    assert_eq!(broken.len(), 2);
    assert!(broken.iter().all(|row| row.method == "sign" && row.error > 0.1), "{broken:?}");
    let sound = study_by(kepler, &what, &REGISTRY[..1]).unwrap();
    assert!(sound[1].error < sound[0].error / 100.0, "{sound:?}");
}
