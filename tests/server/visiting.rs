//! Maps that are handed over to be looked at: they show what the file in a folder shows, are kept
//! nowhere, and damaged ones lead to words.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;

use crate::chance::Chance;
use crate::program::{Folder, expect, signal};
use crate::server::{Answer, Serving, decoded};

const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\n[axes]\n\
    alpha_v = { from = -1.0, to = 0.5, points = 12 }\ntau = { from = 0.1, to = 9.0, points = 10 }\n\
    [fixed]\nmu_prime = -0.3\n";
const WINDOW: &str = "window?field=abscissa&x=alpha_v&y=tau&w=12&h=10";
/// So many are kept, and the most bytes of one.
const KEPT: usize = 4;
const MOST: usize = 64 << 20;

fn hand_over(serving: &Serving, kind: &str, name: &str, map: &[u8]) -> Answer {
    let head = format!(
        "POST /api/v1/maps?name={name} HTTP/1.1\r\nHost: {}\r\nAuthorization: {}\r\n\
         Content-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        serving.address,
        serving.bearer(),
        map.len()
    );
    serving.send(&[head.as_bytes(), map].concat())
}

/// Files of maps among those that do not last.
fn left(scratch: &Path) -> usize {
    let inside = |folder: &Path| {
        let entries = fs::read_dir(folder).unwrap();
        entries
            .map(|entry| entry.unwrap().path())
            .collect::<Vec<_>>()
    };
    let folders = inside(scratch).into_iter();
    let folders = folders.filter(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.starts_with("slipmap-")
    });
    folders.map(|folder| inside(&folder).len()).sum()
}

#[test]
fn a_map_that_visits_is_looked_at_and_not_kept() {
    let folder = Folder::with(&[("sweep.toml", SWEEP)]);
    let run = ["run", "sweep.toml", "-o", "map.h5", "--quiet"];
    expect(&folder.run(&run), 0, "");
    let map = fs::read(folder.path().join("map.h5")).unwrap();
    let (scratch, before) = (Folder::new(), folder.files());
    let mut command = folder.command(&["serve", "--port", "0", "--threads", "2"]);
    let mut serving = Serving::of(command.env("TMPDIR", scratch.path()));
    let list = serving.get("/api/v1/maps").json();
    let id = |answer: &Answer| answer.json()["id"].as_str().unwrap().to_owned();
    let own = list["maps"][0]["id"].as_str().unwrap();
    let window = |id: &str| serving.get(&format!("/api/v1/maps/{id}/{WINDOW}"));
    let visit = hand_over(&serving, "application/x-hdf5", "a%20map.h5", &map);
    assert_eq!(visit.status, 201, "{}", visit.head);
    let first = id(&visit);
    let [(visitor, arrays), (listed, others)] = [&first, own].map(|id| {
        let body = window(id).body;
        let (head, arrays) = decoded(&body);
        (head["shown"].clone(), arrays.to_vec())
    });
    assert!(visitor == listed && arrays == others && arrays.len() > 960);
    let told = serving.get(&format!("/api/v1/maps/{first}")).json();
    assert_eq!(
        (&told["name"], &told["state"]),
        (&"a map.h5".into(), &"complete".into())
    );
    let again = serving.get("/api/v1/maps").json();
    assert_eq!(again["maps"].as_array().unwrap().len(), 1);
    // What is refused is not kept either.
    let long = vec![0; MOST + 1];
    for (kind, map, status) in [
        ("application/toml", &map[..], 415),
        ("application/x-hdf5", b"", 422),
        ("application/x-hdf5", b"no map", 422),
        ("application/x-hdf5", &map[..map.len() / 2], 422),
        ("application/x-hdf5", &long, 413),
    ] {
        let answer = hand_over(&serving, kind, "m.h5", map);
        assert_eq!(answer.status, status, "{}", answer.head);
        assert!(!answer.json()["detail"].as_str().unwrap().is_empty());
    }
    let name = "n".repeat(256);
    let answer = hand_over(&serving, "application/x-hdf5", &name, &map);
    assert_eq!(answer.status, 422);
    assert_eq!(left(scratch.path()), 1);
    for _ in 0..KEPT {
        let visit = hand_over(&serving, "application/x-hdf5", "m.h5", &map);
        assert_eq!(window(&id(&visit)).status, 200);
    }
    assert_eq!(window(&first).status, 404);
    assert_eq!(left(scratch.path()), KEPT);
    assert_eq!(folder.files(), before);
    // One that stays connected does not keep them.
    let mut open = TcpStream::connect(&serving.address).unwrap();
    let bearer = serving.bearer();
    let ask = format!(
        "GET /api/v1/maps HTTP/1.1\r\nHost: {}\r\nAuthorization: {bearer}\r\n\r\n",
        serving.address
    );
    open.write_all(ask.as_bytes()).unwrap();
    assert!(open.read(&mut [0; 64]).unwrap() > 0);
    signal(serving.child.id(), "-TERM");
    assert!(serving.child.wait().unwrap().success());
    assert_eq!(left(scratch.path()), 0);
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 0);
}

#[test]
fn maps_come_in_pieces_and_not_from_those_who_look() {
    let folder = Folder::with(&[("sweep.toml", SWEEP)]);
    let run = ["run", "sweep.toml", "-o", "map.h5", "--quiet"];
    expect(&folder.run(&run), 0, "");
    let map = fs::read(folder.path().join("map.h5")).unwrap();
    let serving = Serving::submitting(&folder, &[]);
    let head = |token: &str, more: &str| {
        format!(
            "POST /api/v1/maps HTTP/1.1\r\nHost: {}\r\nAuthorization: Bearer {token}\r\n\
             Content-Type: application/x-hdf5\r\nConnection: close\r\n{more}\r\n\r\n",
            serving.address
        )
    };
    let token = serving.bearer().replace("Bearer ", "");
    let chunked = head(&token, "Transfer-Encoding: chunked");
    let chunks = map
        .iter()
        .flat_map(|byte| [b'1', b'\r', b'\n', *byte, b'\r', b'\n']);
    let body: Vec<u8> = chunks.chain(*b"0\r\n\r\n").collect();
    let answer = serving.send(&[chunked.as_bytes(), &body[..]].concat());
    assert_eq!(answer.status, 201, "{}", answer.head);
    // A length that is too much is refused before a byte has come.
    let long = head(&token, "Content-Length: 99999999999");
    assert_eq!(serving.send(long.as_bytes()).status, 413);
    let own = head(serving.token_to_look.as_ref().unwrap(), "Content-Length: 3");
    let answer = serving.send(&[own.as_bytes(), &b"abc"[..]].concat());
    assert_eq!(answer.status, 403, "{}", answer.head);
    assert!(answer.head.to_lowercase().contains("connection: close"));
}

#[test]
fn damaged_maps_lead_to_words_and_the_server_goes_on() {
    let folder = Folder::with(&[("sweep.toml", SWEEP)]);
    let run = ["run", "sweep.toml", "-o", "map.h5", "--quiet"];
    expect(&folder.run(&run), 0, "");
    let map = fs::read(folder.path().join("map.h5")).unwrap();
    let serving = Serving::new(&folder);
    let mut chance = Chance(11);
    let mut refused = 0;
    for number in 0..200 {
        let mut bytes = map.clone();
        for _ in 0..1 << (number % 8) {
            let place = chance.below(bytes.len() as u64) as usize;
            bytes[place] = chance.below(256) as u8;
        }
        if number % 5 == 0 {
            bytes.truncate(chance.below(bytes.len() as u64) as usize);
        }
        let answer = hand_over(&serving, "application/x-hdf5", "m.h5", &bytes);
        match answer.status {
            201 => {
                let id = answer.json()["id"].as_str().unwrap().to_owned();
                let window = serving.get(&format!("/api/v1/maps/{id}/{WINDOW}"));
                assert!([200, 422, 502].contains(&window.status), "{}", window.head);
            }
            422 => {
                let detail = answer.json()["detail"].as_str().unwrap().to_owned();
                assert!(detail.starts_with("the map cannot be read: "), "{detail}");
                refused += 1;
            }
            other => panic!("{number}: {other} {}", answer.head),
        }
    }
    assert!(refused > 50, "{refused}");
    assert_eq!(serving.get("/api/v1/maps").status, 200);
}
