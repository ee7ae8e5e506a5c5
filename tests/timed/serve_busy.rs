//! A run while many look: 200 streams of changes stay open and 50 readers ask for windows of the map that grows.
//!
//! `SLIPMAP_TURNS=10` lets more runs alone and with readers take turns than the one each of the suite.

use std::io::Write;
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::alone;
use crate::chance::asked;
use crate::processes::{children, peak};
use crate::program::{Folder, expect};
use crate::server::Serving;

/// A sweep of critical velocities, some seconds of work on two threads.
const SWEEP: &str = include_str!("../../sweeps/vc_velocity.toml");
const STREAMS: usize = 200;
const READERS: usize = 50;
/// Each reader asks that often, as a page does that shows a map which grows.
const ONE: Duration = Duration::from_secs(1);

/// The time that a run takes.
fn run(folder: &Folder, map: &str) -> Duration {
    let begun = Instant::now();
    let ended = folder.run(&["run", "sweep.toml", "-o", map, "-q", "--threads", "2"]);
    expect(&ended, 0, map);
    begun.elapsed()
}

/// A stream of changes, which nobody reads.
fn stream(serving: &Serving) -> TcpStream {
    let mut stream = TcpStream::connect(&serving.address).unwrap();
    let head = format!(
        "GET /api/v1/events HTTP/1.1\r\nHost: {}\r\nAuthorization: {}\r\n\r\n",
        serving.address,
        serving.bearer()
    );
    stream.write_all(head.as_bytes()).unwrap();
    stream
}

/// Where a map's window is, once the map is listed.
fn window(serving: &Serving, map: &str) -> Option<String> {
    let list = serving.get("/api/v1/maps").json();
    let maps = list["maps"].as_array().unwrap();
    let id = maps.iter().find(|of| of["name"] == map)?["id"].as_str()?;
    let shown = "field=vc&x=alpha_v&y=tau&at=mu_prime_rest:0&w=400&h=300";
    Some(format!("/api/v1/maps/{id}/window?{shown}"))
}

/// Asks for windows until the run has ended; how long each answer took.
fn read(serving: &Serving, map: &str, number: usize, ended: &AtomicBool) -> Vec<Duration> {
    let mut took = Vec::new();
    // They do not all ask at once.
    std::thread::sleep(ONE * u32::try_from(number).unwrap() / READERS as u32);
    let mut window_of_map = None;
    while !ended.load(Ordering::Relaxed) {
        let begun = Instant::now();
        window_of_map = window_of_map.or_else(|| window(serving, map));
        if let Some(path) = &window_of_map {
            let asked = Instant::now();
            let answer = serving.get(path);
            assert_eq!(answer.status, 200, "{}", answer.head);
            took.push(asked.elapsed());
        }
        std::thread::sleep(ONE.saturating_sub(begun.elapsed()));
    }
    took
}

/// The time that a run takes beside streams and readers, and the times of answers.
fn run_beside(folder: &Folder, map: &str, serving: &Serving) -> (Duration, Vec<Duration>) {
    let ended = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let ended = &ended;
        let readers: Vec<_> = (0..READERS)
            .map(|number| scope.spawn(move || read(serving, map, number, ended)))
            .collect();
        let took = run(folder, map);
        ended.store(true, Ordering::Relaxed);
        let answers = readers
            .into_iter()
            .flat_map(|reader| reader.join().unwrap());
        (took, answers.collect())
    })
}

fn median(times: &mut [Duration]) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

#[test]
fn a_run_goes_on_beside_streams_and_readers() {
    let _alone = alone();
    let turns = asked("SLIPMAP_TURNS", 1);
    let fewer = SWEEP.replace("points = 41", "points = 21");
    let sweep = if turns > 1 { SWEEP } else { &fewer };
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    let (mut alone, mut beside, mut answers) = (Vec::new(), Vec::new(), Vec::new());
    let mut most = 0;
    for turn in 0..turns {
        alone.push(run(&folder, &format!("alone{turn}.h5")));
        let serving = Serving::with(&folder, &["--submit"]);
        let streams: Vec<_> = (0..STREAMS).map(|_| stream(&serving)).collect();
        let (took, asked) = run_beside(&folder, &format!("beside{turn}.h5"), &serving);
        beside.push(took);
        answers.extend(asked);
        let server = serving.child.id();
        let all = children(server).into_iter().chain([server]);
        most = most.max(all.map(peak).sum::<u64>());
        drop(streams);
    }
    answers.sort_unstable();
    let last = answers[answers.len() * 99 / 100];
    println!("alone {alone:.2?}, beside {beside:.2?}");
    let rate = median(&mut alone).as_secs_f64() / median(&mut beside).as_secs_f64();
    println!(
        "{STREAMS} streams, {READERS} readers: {rate:.3} of the rate alone; {} windows, median {:?}, 99 % {last:?}; {most} MB",
        answers.len(),
        answers[answers.len() / 2]
    );
    assert!(answers.len() > READERS, "{}", answers.len());
    assert!(most <= 300, "{most} MB");
    // With many turns on a machine that does nothing else: 0.9 and 250 ms.
    assert!(rate > 0.75, "{rate}");
    assert!(last <= Duration::from_secs(1), "{last:?}");
}
