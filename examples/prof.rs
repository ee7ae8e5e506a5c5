use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, Polynomial, RootCounter, System};
use slipmap::linear::row::Delays;
use slipmap::linear::track::RootTracker;
fn main() {
    let modes = [(1.0, 0.05), (1.7, 0.03), (2.6, 0.02), (4.1, 0.04)]
        .map(|(w, z): (f64, f64)| Polynomial::new(&[w * w, 2.0 * z * w, 1.0]).unwrap());
    let prod = |f: &[Polynomial]| f[1..].iter().fold(f[0], |p, q| p.times(q).unwrap());
    let lines: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let delays: Vec<f64> = (0..1000).map(|i| 0.01 + 0.01 * i as f64).collect();
    let row = Delays::new(&delays);
    let (mut n, mut status) = (vec![0; 1000], vec![0; 1000]);
    let mut tracker = RootTracker::new(1);
    let start = std::time::Instant::now();
    for l in 0..lines {
        let width = 0.01 + 0.5 * l as f64 / 19.0;
        let mut sum = Polynomial::ZERO;
        for i in 0..4 {
            let others: Vec<_> = (0..4).filter(|&j| j != i).map(|j| modes[j]).collect();
            sum = sum.plus(&prod(&others), -width);
        }
        let system = System::feedback(prod(&modes), sum, 0.0, 0.0);
        let line = DelayLine::of(&system);
        status.fill(0);
        line.fill_counts(&row, MarginalTolerance::default(), &mut n, &mut status);
        let counter = RootCounter::new(&system);
        tracker.follow(&counter, (&delays, 1.0), 0, &n, &mut status, |_, c| {
            std::hint::black_box(c.roots);
        });
    }
    println!("{:?} {:?}", tracker.work, start.elapsed());
}
