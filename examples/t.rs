use slipmap::model::FrictionLaw;
use slipmap::slip::motion::*;
use std::time::Instant;
fn main() {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    for (v0, av, an, tau, name) in [(0.35, -0.33, 0.0, 4.15, "3a"), (0.1, 0.0, -10.0, 0.5, "3b")] {
        let mut refr = 0.0;
        for tol in [1e-15, 1e-6, 1e-8, 1e-10, 1e-12] {
            for kinks in [true, false] {
                let p = Parameters {
                    law,
                    velocity_unit: 1.0,
                    alpha_v: av,
                    alpha_n: an,
                    tau,
                    v0,
                    switch_on: 70.0,
                };
                let mut best = f64::INFINITY;
                let mut steps = 0;
                let mut last = 0.0;
                let mut end = 0.0;
                for _ in 0..200 {
                    let t = Instant::now();
                    let mut m = Motion::new(
                        p,
                        Accuracy {
                            tolerance: tol,
                            step_on_kinks: kinks,
                        },
                        1.01 * v0,
                        law.mu_k(v0),
                    );
                    steps = 0;
                    while m.t < 150.0 {
                        if let Some(Event::Release) = m.advance(150.0) {
                            last = m.t;
                        }
                        steps += 1;
                    }
                    end = m.a;
                    best = best.min(t.elapsed().as_secs_f64());
                }
                if tol == 1e-15 && kinks {
                    refr = last;
                }
                println!(
                    "{name} tol {tol:e} kinks {kinks} {:.3} µs/unit steps {steps} last release {last:.12} err {:.1e} a {end}",
                    best * 1e6 / 150.0,
                    last - refr
                );
            }
        }
        // smooth: start near sliding, control from 0
        for tol in [1e-6, 1e-8, 1e-10, 1e-12] {
            let p = Parameters {
                law,
                velocity_unit: 1.0,
                alpha_v: av,
                alpha_n: an,
                tau,
                v0,
                switch_on: 0.0,
            };
            let mut best = f64::INFINITY;
            let mut steps = 0;
            let mut a = 0.0;
            let mut r = Motion::new(
                p,
                Accuracy {
                    tolerance: 1e-15,
                    step_on_kinks: true,
                },
                1.1 * v0,
                law.mu_k(v0),
            );
            while r.t < 150.0 {
                r.advance(150.0);
            }
            for _ in 0..200 {
                let t = Instant::now();
                let mut m = Motion::new(
                    p,
                    Accuracy {
                        tolerance: tol,
                        step_on_kinks: true,
                    },
                    1.1 * v0,
                    law.mu_k(v0),
                );
                steps = 0;
                while m.t < 150.0 {
                    m.advance(150.0);
                    steps += 1;
                }
                a = m.a;
                best = best.min(t.elapsed().as_secs_f64());
            }
            println!(
                "smooth {name} tol {tol:e} {:.3} µs/unit steps {steps} err {:.1e}",
                best * 1e6 / 150.0,
                a - r.a
            );
        }
    }
}
