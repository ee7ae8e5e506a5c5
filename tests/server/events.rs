//! What has changed, as a stream, over real connections.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use crate::jobs::{SMALL, other};
use crate::processes::peak;
use crate::program::{Folder, expect, signal};
use crate::server::Serving;
use crate::with_many_connections;

/// A stream.
struct Stream(BufReader<TcpStream>);

/// An event: its name, id and revision.
type Event = (String, String, u64);

impl Stream {
    fn of(serving: &Serving, last: Option<&str>) -> Self {
        let mut stream = TcpStream::connect(&serving.address).unwrap();
        let patience = Some(Duration::from_secs(30));
        stream.set_read_timeout(patience).unwrap();
        let last = last.map(|last| format!("Last-Event-ID: {last}\r\n"));
        let head = format!(
            "GET /api/v1/events HTTP/1.1\r\nHost: {}\r\nAuthorization: {}\r\n{}\r\n",
            serving.address,
            serving.bearer(),
            last.unwrap_or_default()
        );
        stream.write_all(head.as_bytes()).unwrap();
        Self(BufReader::new(stream))
    }

    fn line(&mut self) -> Option<String> {
        let mut line = String::new();
        let read = self.0.read_line(&mut line).unwrap();
        (read > 0).then(|| line.trim_end().to_owned())
    }

    fn status(&mut self) -> String {
        let line = self.line().unwrap();
        line.split(' ').nth(1).unwrap().to_owned()
    }

    /// The next event; lengths of chunks are skipped.
    fn event(&mut self) -> Event {
        let (mut name, mut id) = (String::new(), String::new());
        loop {
            let line = self.line().expect("the stream goes on");
            match line.split_once(": ") {
                Some(("event", of)) => of.clone_into(&mut name),
                Some(("id", of)) => of.clone_into(&mut id),
                Some(("data", data)) => {
                    let data: serde_json::Value = serde_json::from_str(data).unwrap();
                    return (name, id, data["revision"].as_u64().unwrap());
                }
                _ => {}
            }
        }
    }

    /// The next event of this name.
    fn next(&mut self, of: &str) -> Event {
        loop {
            let event = self.event();
            if event.0 == of {
                return event;
            }
        }
    }

    /// Whether only signs of life come for some seconds.
    fn is_quiet(&mut self) -> bool {
        let begun = Instant::now();
        loop {
            let line = self.line().unwrap();
            let waited = begun.elapsed() > Duration::from_secs(4);
            match line {
                line if line.starts_with("event") => return false,
                // An earlier one may have come before.
                line if line.starts_with(": ") && waited => return true,
                _ => {}
            }
        }
    }
}

#[test]
fn what_other_processes_change_is_told() {
    let folder = Folder::with(&[("a.toml", SMALL), ("b.toml", &other(-0.2))]);
    let serving = Serving::submitting(&folder, &[]);
    let mut stream = Stream::of(&serving, None);
    assert_eq!(stream.status(), "200");
    let first = [stream.event(), stream.event()];
    assert_eq!(first.each_ref().map(|event| &*event.0), ["jobs", "maps"]);
    // What the first look brings.
    while !stream.is_quiet() {}
    expect(&folder.run(&["submit", "a.toml"]), 0, "waits");
    let submitted = stream.next("jobs");
    assert!(submitted.2 > first[0].2);
    assert_eq!(
        serving.get("/api/v1/jobs").json()["jobs"][0]["state"],
        "waiting"
    );
    let begun = Instant::now();
    assert_eq!(serving.ask("jobs", &other(-0.1)).status, 201);
    let own = stream.next("jobs");
    assert!(
        begun.elapsed() < Duration::from_millis(900),
        "{:?}",
        begun.elapsed()
    );
    expect(&folder.run(&["work", "--until-empty"]), 0, "done");
    let made = stream.next("maps");
    while !stream.is_quiet() {}
    let list = serving.get("/api/v1/jobs").json();
    assert!(
        list["jobs"]
            .as_array()
            .unwrap()
            .iter()
            .all(|job| job["state"] == "done"),
        "{list}"
    );
    let mut one = Stream::of(&serving, None);
    let all = [one.event(), one.event()];
    assert!(all[0].2 > own.2 && all[1].2 >= made.2);
}

/// A client that has all is told nothing; one that lacks something, that; any other one, all.
#[test]
fn a_stream_goes_on_where_another_one_ended() {
    let folder = Folder::with(&[("a.toml", SMALL)]);
    let serving = Serving::submitting(&folder, &[]);
    let mut first = Stream::of(&serving, None);
    while !first.is_quiet() {}
    let mut one = Stream::of(&serving, None);
    let [jobs, maps] = [one.event(), one.event()];
    let last = &maps.1;
    let mut known = Stream::of(&serving, Some(last));
    assert_eq!(known.status(), "200");
    assert!(known.is_quiet());
    assert_eq!(Stream::of(&serving, Some(&jobs.1)).event(), maps);
    let of_another_map = format!("{last}9");
    for (odd, next) in [
        ("", &jobs),
        ("x", &jobs),
        ("1-2-3", &jobs),
        (&last[1..], &jobs),
        (&of_another_map, &maps),
    ] {
        assert_eq!(Stream::of(&serving, Some(odd)).event().0, next.0, "{odd}");
    }
    expect(&folder.run(&["submit", "a.toml", "--hold"]), 0, "held");
    assert_eq!(known.event().0, "jobs");
}

#[test]
fn there_are_so_many_streams() {
    let _alone = with_many_connections();
    let folder = Folder::new();
    let mut serving = Serving::submitting(&folder, &[]);
    let one_by_one = (0..256).map(|_| {
        let mut stream = Stream::of(&serving, None);
        assert_eq!(stream.status(), "200");
        stream
    });
    let mut streams: Vec<Stream> = one_by_one.collect();
    eprintln!("{} MB with 256 streams", peak(serving.child.id()));
    assert!(peak(serving.child.id()) < 200);
    let mut more = Stream::of(&serving, None);
    assert_eq!(more.status(), "503");
    // Everything else is answered, and every stream is told of what changes.
    assert_eq!(serving.ask("jobs", SMALL).status, 201);
    for stream in &mut streams {
        while serving_revision(stream) < 3 {}
    }
    // Those that have gone make room.
    streams.truncate(200);
    let begun = Instant::now();
    while Stream::of(&serving, None).status() != "200" {
        assert!(begun.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(200));
    }
    let begun = Instant::now();
    signal(serving.child.id(), "-INT");
    assert!(serving.child.wait().unwrap().success());
    assert!(
        begun.elapsed() < Duration::from_secs(2),
        "{:?}",
        begun.elapsed()
    );
}

/// The revision of the next event about jobs.
fn serving_revision(stream: &mut Stream) -> u64 {
    stream.next("jobs").2
}
