use slipmap::linear::general::*;
use slipmap::linear::row::Delays;
use slipmap::linear::MarginalTolerance;
fn polynomial(c: &[f64]) -> Polynomial { Polynomial::new(c).unwrap() }
fn times(a: &Polynomial, b: &Polynomial) -> Polynomial { a.times(b).unwrap() }
#[test]
fn scratch() {
    let values: Vec<f64> = (0..1000).map(|i| 0.01 + i as f64 * 0.01).collect();
    let row = Delays::new(&values);
    let (mut n, mut status) = (vec![0; 1000], vec![0; 1000]);
    let mut line = DelayLine::default();
    let made: Vec<(Polynomial, Polynomial)> = (0..1000).map(|i| {
        let a_n = 4.0 * f64::from(i) / 999.0 - 3.0;
        let [load, sensor] = [0.3, 0.1].map(|lag| polynomial(&[1.0, lag]));
        let velocity = polynomial(&[-0.2 * -0.3, -0.2]);
        (times(&times(&polynomial(&[1.0, -0.3, 1.0]), &load), &sensor), polynomial(&[a_n]).plus(&times(&velocity, &load), 1.0))
    }).collect();
    let start = std::time::Instant::now();
    let rounds: u32 = std::env::var("ROUNDS").ok().and_then(|s| s.parse().ok()).unwrap_or(2000);
    for _ in 0..rounds {
        for (open, gain) in &made {
            status.fill(0);
            line.find(&System::feedback(*open, *gain, 0.0, 0.0));
            line.fill_counts(&row, MarginalTolerance::default(), &mut n, &mut status);
            std::hint::black_box((&n, &status));
        }
    }
    println!("{:.3} us", start.elapsed().as_secs_f64() * 1e3 / f64::from(rounds));
}
