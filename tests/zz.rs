use culbuto::report::verify;
use culbuto::scenes::CATALOGUE;
#[test]
fn zz() {
    let only = std::env::var("SCENES").unwrap_or_default();
    for scene in CATALOGUE {
        let wanted = if only.is_empty() {
            !"SN".contains(&scene.id[..1])
        } else {
            only.split(',').any(|x| x == scene.id)
        };
        if !wanted {
            continue;
        }
        let clock = std::time::Instant::now();
        match verify(scene) {
            Err(e) => println!("{} ERROR {e}", scene.id),
            Ok(v) => {
                println!(
                    "{} {} {} {:.2}s",
                    if v.pass { "ok  " } else { "FAIL" },
                    v.id,
                    v.name,
                    clock.elapsed().as_secs_f64()
                );
                let all = std::env::var("ALL").is_ok();
                for c in &v.checks {
                    if v.checks.len() < 12 || !c.pass || all {
                        println!(
                            "      {} {:60} asked {:8.1e} measured {:.3e}",
                            if c.pass { "ok" } else { "NO" },
                            c.what,
                            c.asked,
                            c.measured
                        );
                    }
                }
                for m in &v.methods {
                    println!(
                        "      {} {} error {:.2e} energy {:.2e} order {:?} exact {}",
                        if m.pass { "ok" } else { "NO" },
                        m.method,
                        m.error,
                        m.energy,
                        m.order_measured,
                        m.exact
                    );
                }
            }
        }
    }
}
