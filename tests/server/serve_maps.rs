//! Maps from files over real connections: what is listed, whether windows show the cells of the
//! files, maps that grow, damaged ones, and what does harm.

#![cfg(target_os = "linux")]
#![allow(clippy::too_many_lines, reason = "a test tells one story")]

mod brute;
mod decoded;
mod told;

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::symlink;
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::chance::Chance;
use crate::map;
use crate::processes::{self, until};
use crate::program::{self, Folder, Started, err, expect, signal};
use crate::server::Serving;
use crate::with_many_connections;
use brute::{Window, check, complete};
use decoded::Decoded;
use serde_json::Value;
use slipmap::linear::Crossings;
use slipmap::linear::status::{CERTIFIED, MARGINAL, SAMPLED};
use slipmap::maps::maker::make_in_memory;
use slipmap::model::Groups;
use slipmap::setting::Field;
use slipmap::store::MapFile;
use slipmap::sweep::Plan;
use slipmap::sweep::described::root::Provenance;

const SMALL: &str = "title = \"Small\"\nboundaries = true\n[axes]\nmu_prime = [-0.1, -0.2, -0.5]\n\
    alpha_v = { from = -1.2, to = 0.1, points = 60 }\ntau = { from = 0.05, to = 9.0, points = 70, \
    spacing = \"log\" }\n";

/// Computes the map of a sweep, without a picture.
fn make(folder: &Folder, name: &str, sweep: &str) {
    let plan = Arc::new(Plan::new(sweep.parse().unwrap()).unwrap());
    let path = folder.path().join(format!("{name}.h5"));
    // A process that another test starts meanwhile holds the lock of what is written for a moment.
    until(20, "the map is made", || {
        make_in_memory(&plan, &path, 2, &Provenance::default()).is_ok()
    });
    map::settle(&path);
}

fn entry(serving: &Serving, name: &str) -> Value {
    let list = serving.get("/api/v1/maps").json();
    let maps = list["maps"].as_array().unwrap();
    let found = maps.iter().find(|map| map["name"] == name);
    found
        .unwrap_or_else(|| panic!("{name} is not in {list}"))
        .clone()
}

fn id(serving: &Serving, name: &str) -> String {
    entry(serving, name)["id"].as_str().unwrap().to_owned()
}

#[test]
fn maps_are_listed_and_described() {
    let folder = Folder::new();
    make(&folder, "small", SMALL);
    fs::create_dir_all(folder.path().join("inner/deeper")).unwrap();
    fs::copy(
        folder.path().join("small.h5"),
        folder.path().join("inner/deeper/copy.h5"),
    )
    .unwrap();
    let serving = Serving::new(&folder);
    let list = serving.get("/api/v1/maps").json();
    assert_eq!(list["maps"].as_array().unwrap().len(), 2);
    let small = entry(&serving, "small.h5");
    assert_eq!(small["state"], "complete");
    assert_eq!(
        (&small["cells"], &small["cells_done"]),
        (&12_600.into(), &12_600.into())
    );
    assert_eq!(small["axes"][2]["name"], "tau");
    assert_eq!(small["axes"][2]["to"], 9.0);
    assert_eq!(small["fields"], serde_json::json!(["n_unstable"]));
    let copy = entry(&serving, "inner/deeper/copy.h5");
    assert_ne!(copy["id"], small["id"]);
    let id = small["id"].as_str().unwrap();
    let told = serving.get(&format!("/api/v1/maps/{id}")).json();
    assert_eq!(
        (&told["title"], &told["state"]),
        (&"Small".into(), &"complete".into())
    );
    assert_eq!(
        told["axes"][0]["values"],
        serde_json::json!([-0.1, -0.2, -0.5])
    );
    assert_eq!(told["curves_plane"], serde_json::json!(["alpha_v", "tau"]));
    assert_eq!(told["fields"][0]["storage"], "count");
    assert!(
        told["scalars"]
            .as_array()
            .unwrap()
            .iter()
            .any(|s| s["name"] == "alpha_n")
    );
    assert_eq!(told["sweep"], SMALL);
    let sweep = serving.get(&format!("/api/v1/maps/{id}/sweep"));
    assert_eq!(String::from_utf8(sweep.body).unwrap(), SMALL);
    // The same ids after a restart.
    drop(serving);
    assert_eq!(entry(&Serving::new(&folder), "small.h5")["id"], small["id"]);
}

/// Windows on maps of one to four axes, both ways round, even and logarithmic, near and far, and
/// beyond their ends.
#[test]
fn windows_show_the_cells_of_the_file() {
    let folder = Folder::new();
    make(&folder, "counts", SMALL);
    make(
        &folder,
        "line",
        "[axes]\ntau = { from = 0.1, to = 9.0, points = 5000 }\n[fixed]\nmu_prime = -0.3\nalpha_v = -0.4\n",
    );
    make(
        &folder,
        "four",
        "fields = [\"n_unstable\", \"abscissa\"]\n[axes]\nmu_k = [2.0, 1.0, 0.4]\n\
         alpha_v = { from = -0.9, to = 0.1, points = 9 }\nalpha_n = [-0.7, -0.1, 0.0, 0.4, 0.45]\n\
         tau = { from = 0.1, to = 6.0, points = 8 }\n[fixed]\nmu_prime = -0.2\n",
    );
    make(
        &folder,
        "motions",
        "fields = [\"outcome\", \"n_min\"]\n[axes]\na0 = { from = -0.6, to = 2.0, points = 9 }\n\
         x_dot0 = { from = -1.0, to = 1.5, points = 8 }\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n\
         v_s = 0.5\n[fixed]\nv0 = 0.118\nalpha_n = -7.0\ntau = 1.0\n",
    );
    let mut chance = Chance(7);
    for name in ["counts", "four"] {
        map::edit(&folder.path().join(format!("{name}.h5")), |file| {
            let dataset = file.dataset("status").unwrap();
            let mut all = dataset.read_raw::<u8>().unwrap();
            for status in &mut all {
                *status = [0, CERTIFIED, SAMPLED][chance.of(3)];
                if chance.of(20) == 0 {
                    *status |= MARGINAL;
                }
            }
            dataset.write_raw(&all).unwrap();
        });
    }
    let serving = Serving::new(&folder);
    for name in ["counts", "line", "four", "motions"] {
        let id = id(&serving, &format!("{name}.h5"));
        let file = MapFile::open(&folder.path().join(format!("{name}.h5"))).unwrap();
        let map = &file;
        let count = map.axes().len();
        for number in 0..40 {
            let x = chance.of(count);
            let y = Some(chance.of(count)).filter(|&y| y != x);
            let at = map
                .axes()
                .iter()
                .map(|axis| chance.of(axis.values.len()))
                .collect();
            let is_tau = |axis: usize| map.axes()[axis].parameter.name() == "tau";
            let mut stretch = |axis: usize| {
                let (first, last) = {
                    let values = &map.axes()[axis].values;
                    (values[0], values[values.len() - 1])
                };
                let scale = if is_tau(axis) && chance.of(2) == 0 {
                    "log"
                } else {
                    "linear"
                };
                let beyond = if scale == "log" { 0.01 } else { 0.4 };
                let ends =
                    [0, 1].map(|_| first + (last - first) * chance.between(-beyond, 1.0 + beyond));
                let whole = chance.of(3) == 0;
                (Some((ends[0], ends[1])).filter(|_| !whole), scale)
            };
            let (x_ends, x_scale) = stretch(x);
            let (y_ends, y_scale) = stretch(y.unwrap_or(x));
            let window = Window {
                field: map.fields()[number % map.fields().len()],
                x,
                y,
                at,
                x_ends,
                y_ends,
                size: (1 + chance.of(40), 1 + chance.of(40)),
                scales: (x_scale, y_scale),
            };
            check(&serving, &id, map, &window);
        }
    }
}

/// Pixels that lie beside an axis show nothing, however far away they are.
#[test]
fn beyond_a_map_there_is_nothing() {
    let folder = Folder::new();
    make(&folder, "map", SMALL);
    let serving = Serving::new(&folder);
    let id = id(&serving, "map.h5");
    let window = format!("/api/v1/maps/{id}/window?field=n_unstable&x=alpha_v&y=tau&w=4&h=4");
    for (ends, there) in [
        ("x0=-50&x1=-10", 0),
        ("y0=9.5&y1=20", 0),
        ("x0=-1.2&x1=0.1", 16),
        ("x0=-2.5&x1=0.1", 8),
        ("x0=-1e308&x1=1.2e308", 4),
        ("x0=-1e308&x1=1.2e308&y0=1.2e308&y1=-1e308", 1),
    ] {
        let told = complete(&serving, &format!("{window}&{ends}"));
        let [bits, values, status] =
            ["bits", "values", "status"].map(|name| told.numbers(&told.head[name]));
        let shows = |place: &usize| bits[*place] as u8 & 8 == 0;
        assert_eq!((0..16).filter(shows).count(), there, "{ends}: {bits:?}");
        for place in (0..16).filter(|place| !shows(place)) {
            let found = (bits[place], values[place], status[place]);
            assert_eq!(found, (8.0, 65535.0, 255.0), "{ends}");
        }
    }
}

/// Cells of a map of more chunks than one, by the closed form; and its curves.
#[test]
fn windows_show_the_closed_form() {
    let folder = Folder::new();
    make(
        &folder,
        "large",
        "boundaries = true\n[axes]\nmu_prime = { from = -0.9, to = 0.1, points = 31 }\n\
         alpha_v = { from = -3.0, to = 1.0, points = 301 }\ntau = { from = 0.01, to = 12.0, points = 203 }\n",
    );
    let serving = Serving::new(&folder);
    let id = id(&serving, "large.h5");
    for (x, y, at) in [
        ("alpha_v", "tau", "mu_prime:17"),
        ("mu_prime", "alpha_v", "tau:101"),
        ("tau", "mu_prime", "alpha_v:150"),
    ] {
        let path =
            format!("/api/v1/maps/{id}/window?field=n_unstable&x={x}&y={y}&at={at}&w=57&h=43");
        let told = complete(&serving, &path);
        let values = told.numbers(&told.head["values"]);
        let along = |axis: &str| told.numbers(&told.head[axis]["values"]);
        let (xs, ys) = (along("x"), along("y"));
        let other = told.head["at"][0]["value"].as_f64().unwrap();
        for (place, &value) in values.iter().enumerate() {
            let pair = (xs[place / ys.len()], ys[place % ys.len()]);
            let (mu_prime, alpha_v, tau) = match x {
                "alpha_v" => (other, pair.0, pair.1),
                "mu_prime" => (pair.0, pair.1, other),
                _ => (pair.1, other, pair.0),
            };
            let expected = Crossings::of(Groups::new(mu_prime, alpha_v, 0.0)).n_unstable(tau);
            assert_eq!(value, expected as f64, "{mu_prime} {alpha_v} {tau}");
        }
    }
    let map = MapFile::open(&folder.path().join("large.h5")).unwrap();
    // Pixels that hide cells of more chunks than one.
    for (x, y, size) in [(1, 2, (13, 17)), (0, 1, (9, 21)), (2, 0, (5, 7))] {
        let window = Window {
            field: Field::NUnstable,
            x,
            y: Some(y),
            at: vec![17, 150, 101],
            x_ends: None,
            y_ends: None,
            size,
            scales: ("linear", "linear"),
        };
        assert!(check(&serving, &id, &map, &window) > 10);
    }
    let at = map.axes()[0].values[17];
    let curves = map.curves_where(|outer| outer == [at]).unwrap();
    for (x, y) in [("alpha_v", "tau"), ("tau", "alpha_v")] {
        let path = format!("/api/v1/maps/{id}/curves?x={x}&y={y}&at=mu_prime:17");
        let told = Decoded::of(&serving.get(&path));
        let heads = told.head["curves"].as_array().unwrap();
        assert!(!heads.is_empty() && heads.len() == curves.len());
        for (head, curve) in heads.iter().zip(&curves) {
            let vertices = curve.piece.vertices.iter();
            let expected = vertices.flat_map(|v| match x {
                "tau" => [v.q, v.p],
                _ => [v.p, v.q],
            });
            assert!(told.numbers(head).into_iter().eq(expected));
        }
    }
    let path = format!("/api/v1/maps/{id}/curves?x=mu_prime&y=tau&at=alpha_v:17");
    assert_eq!(
        Decoded::of(&serving.get(&path)).head["curves"],
        serde_json::json!([])
    );
}

/// What a cell says can be asked there gives what the cell holds.
#[test]
fn a_cell_says_how_to_ask_for_it() {
    let folder = Folder::new();
    make(&folder, "counts", SMALL);
    make(
        &folder,
        "units",
        "[axes]\nv0 = { from = 0.1, to = 0.4, points = 5 }\ntau = [0.3, 1.7, 4.15]\n[fixed]\n\
         alpha_v = -0.33\nmass = 1.7\n[friction]\nlaw = \"table\"\nspeeds = [0.0, 0.1, 0.3, 0.7]\n\
         mu_k = [0.6, 0.5, 0.3, 0.25]\nmu_s = 0.7\n[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n",
    );
    make(
        &folder,
        "critical",
        "fields = [\"vc\", \"outcome\"]\n[axes]\nalpha_n = { from = -9.0, to = -1.0, points = 3 }\n\
         tau = [0.1, 0.5]\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n",
    );
    let serving = Serving::new(&folder);
    let ids = ["counts", "units", "critical"].map(|name| id(&serving, &format!("{name}.h5")));
    let mut stable = 0;
    for number in 0..20_usize {
        let at = format!(
            "mu_prime:{},alpha_v:{},tau:{}",
            number % 3,
            number * 3,
            number * 2 + 31
        );
        let cell = serving
            .get(&format!("/api/v1/maps/{}/cell?at={at}", ids[0]))
            .json();
        assert_eq!(cell["computed"], true);
        let point = serving.ask("point", cell["point"].as_str().unwrap()).json();
        assert_eq!(point["n_unstable"], cell["fields"]["n_unstable"], "{cell}");
        assert_eq!(point["tau"], cell["axes"]["tau"]);
        let command = cell["command"].as_str().unwrap();
        let args: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
        let said = program::json(&folder.run(&args));
        assert_eq!(said["n_unstable"], cell["fields"]["n_unstable"]);
        stable += u64::from(point["stable"] == true);
    }
    assert!((1..20).contains(&stable), "{stable}");
    for number in 0..5 {
        let at = format!("v0:{number},tau:{}", number % 3);
        let cell = serving
            .get(&format!("/api/v1/maps/{}/cell?at={at}", ids[1]))
            .json();
        let point = serving.ask("point", cell["point"].as_str().unwrap()).json();
        assert_eq!(point["n_unstable"], cell["fields"]["n_unstable"], "{cell}");
        assert_eq!(cell["command"], Value::Null);
        assert!(cell["point"].as_str().unwrap().contains("length = \"mm\""));
    }
    let cell = serving
        .get(&format!("/api/v1/maps/{}/cell?at=alpha_n:1,tau:1", ids[2]))
        .json();
    assert_eq!(
        (&cell["point"], &cell["motion"]),
        (&Value::Null, &Value::Null)
    );
    let vc = serving.ask("vc", cell["vc"].as_str().unwrap()).json();
    let (held, found) = (&cell["fields"]["vc"], &vc["vc"]);
    let off = held.as_f64().unwrap() / found.as_f64().unwrap() - 1.0;
    assert!(off.abs() < 1e-3, "{held} {found}");
    assert_eq!(vc["outcome"], cell["kinds"]["outcome"]);
}

/// A map that is computed while it is looked at, is stopped, and goes on to its end. The run is held
/// while it is looked at: how fast it is tells nothing.
#[test]
fn a_map_grows_while_it_is_looked_at() {
    let lines = if cfg!(debug_assertions) { 40 } else { 400 };
    let sweep = format!(
        "fields = [\"abscissa\"]\nboundaries = true\n[axes]\n\
         mu_prime = {{ from = -0.4, to = -0.1, points = {lines} }}\n\
         alpha_v = {{ from = -1.2, to = 0.1, points = 140 }}\n\
         tau = {{ from = 0.05, to = 9.0, points = 110 }}\n"
    );
    let folder = Folder::with(&[("slow.toml", &sweep)]);
    let serving = Serving::new(&folder);
    assert_eq!(
        serving.get("/api/v1/maps").json()["maps"],
        serde_json::json!([])
    );
    let args = [
        "run",
        "-q",
        "slow.toml",
        "--threads",
        "1",
        "--save-every",
        "0.1",
    ];
    let mut run = folder.start(&args);
    let tiles = || {
        let files = fs::read_dir(folder.path().join("slow.h5.tiles/1-of-1"));
        let names = files
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.file_name());
        let names = names.filter_map(|name| name.into_string().ok());
        names.filter(|name| name.starts_with("tiles-")).count()
    };
    let go_on_until = |count: usize| {
        run.signal("-CONT");
        while tiles() < count {
            std::thread::sleep(Duration::from_millis(5));
        }
        run.signal("-STOP");
    };
    go_on_until(2);
    let state = |wanted: &str| {
        let list = serving.get("/api/v1/maps").json();
        let maps = list["maps"].as_array().unwrap();
        let is_so = |map: &Value| map["name"] == "slow.h5" && map["state"] == wanted;
        maps.iter().any(is_so)
    };
    until(20, "it is running", || state("running"));
    let id = id(&serving, "slow.h5");
    let path = format!(
        "/api/v1/maps/{id}/window?field=abscissa&x=mu_prime&y=alpha_v&at=tau:50&w={lines}&h=140"
    );
    let there = |window: &Decoded| {
        let bits = window.numbers(&window.head["bits"]);
        bits.iter().filter(|bits| **bits as u8 & 4 == 0).count()
    };
    // Curves come first, and may fill the first files alone.
    let mut first = complete(&serving, &path);
    while there(&first) == 0 {
        go_on_until(tiles() + 1);
        std::thread::sleep(Duration::from_millis(2500));
        first = complete(&serving, &path);
    }
    assert!(there(&first) < lines * 140, "{}", there(&first));
    until(20, "it is known how long it takes", || {
        entry(&serving, "slow.h5")["seconds_left"].is_number()
    });
    go_on_until(tiles() + 2);
    until(20, "more of it is there", || {
        let later = complete(&serving, &path);
        there(&later) > there(&first) && later.head["version"] != first.head["version"]
    });
    let told = serving.get(&format!("/api/v1/maps/{id}")).json();
    assert_eq!(told["state"], "running");
    assert!(told["cells_done"].as_u64().unwrap() < told["cells"].as_u64().unwrap());
    run.signal("-KILL");
    run.wait();
    until(10, "it is interrupted", || state("interrupted"));
    let curves = format!("/api/v1/maps/{id}/curves?x=alpha_v&y=tau&at=mu_prime:3");
    let curves = Decoded::of(&serving.get(&curves)).head["curves"].clone();
    assert!(!curves.as_array().unwrap().is_empty());
    // Nothing is left beside it that the run did not make.
    let made = |name: &String| name == "slow.h5.log" || name.starts_with(".slow.h5.slipmap");
    let others: Vec<String> = folder
        .files()
        .into_iter()
        .filter(|name| !made(name))
        .collect();
    assert_eq!(others, ["slow.h5.tiles", "slow.toml"]);
    expect(&folder.run(&["run", "-q", "slow.toml"]), 0, "");
    until(10, "it is complete", || state("complete"));
    let all = complete(&serving, &path);
    assert_eq!(there(&all), lines * 140);
    let map = MapFile::open(&folder.path().join("slow.h5")).unwrap();
    let window = Window {
        field: Field::Abscissa,
        x: 0,
        y: Some(1),
        at: vec![0, 0, 50],
        x_ends: None,
        y_ends: None,
        size: (23, 51),
        scales: ("linear", "linear"),
    };
    check(&serving, &id, &map, &window);
}

/// Damaged maps are messages; the server and the maps beside them go on.
#[test]
fn damaged_maps_are_messages() {
    let folder = Folder::new();
    make(&folder, "good", SMALL);
    let bytes = fs::read(folder.path().join("good.h5")).unwrap();
    let mut chance = Chance(3);
    for number in 0..300 {
        let mut damaged = bytes.clone();
        match number % 3 {
            0 => damaged.truncate(chance.of(bytes.len())),
            1 => {
                for _ in 0..=chance.of(20) {
                    let place = chance.of(bytes.len());
                    damaged[place] = chance.next() as u8;
                }
            }
            _ => {
                let from = chance.of(bytes.len());
                let to = (from + 1 + chance.of(200)).min(bytes.len());
                damaged[from..to].fill(chance.next() as u8);
            }
        }
        fs::write(
            folder.path().join(format!("damaged{number:03}.h5")),
            damaged,
        )
        .unwrap();
    }
    let made = std::process::Command::new("mkfifo")
        .arg(folder.path().join("pipe.h5"))
        .status();
    assert!(made.unwrap().success());
    let _socket = UnixListener::bind(folder.path().join("socket.h5")).unwrap();
    symlink("/dev/zero", folder.path().join("zero.h5")).unwrap();
    let outside = Folder::new();
    make(&outside, "secret", SMALL);
    symlink(
        outside.path().join("secret.h5"),
        folder.path().join("secret.h5"),
    )
    .unwrap();
    symlink(outside.path(), folder.path().join("elsewhere")).unwrap();
    let serving = Serving::new(&folder);
    let list = || serving.get("/api/v1/maps").json();
    until(30, "all are known", || {
        let list = list();
        let maps = list["maps"].as_array().unwrap();
        maps.len() == 303 && maps.iter().all(|map| map["state"] != "unknown")
    });
    let list = list();
    assert_eq!(list["links_skipped"], 2);
    let maps = list["maps"].as_array().unwrap();
    assert!(
        maps.iter()
            .all(|map| !map["name"].as_str().unwrap().contains("secret"))
    );
    let damaged: Vec<&Value> = maps
        .iter()
        .filter(|map| map["state"] == "damaged")
        .collect();
    assert!(damaged.len() > 100, "{}", damaged.len());
    assert!(damaged.iter().all(|map| map["why"].is_string()), "{list}");
    for name in ["pipe.h5", "socket.h5"] {
        assert_eq!(entry(&serving, name)["why"], "it is no regular file");
    }
    assert_eq!(entry(&serving, "good.h5")["state"], "complete");
    // Whatever can be asked of them has an answer.
    let window = "window?field=n_unstable&x=alpha_v&y=tau&at=mu_prime:1&w=30&h=20";
    for map in maps.iter().step_by(7) {
        let id = map["id"].as_str().unwrap();
        for what in [
            window,
            "curves?x=alpha_v&y=tau",
            "cell?at=mu_prime:0,alpha_v:5,tau:9",
        ] {
            let answer = serving.get(&format!("/api/v1/maps/{id}/{what}"));
            assert!(
                [200, 422, 502].contains(&answer.status),
                "{map} {what}: {}",
                answer.head
            );
        }
    }
    let id = id(&serving, "good.h5");
    complete(&serving, &format!("/api/v1/maps/{id}/{window}"));
    let all = processes::children(serving.child.id());
    let peaks = all
        .into_iter()
        .chain([serving.child.id()])
        .map(processes::peak);
    let peak: u64 = peaks.sum();
    assert!((5..300).contains(&peak), "{peak} MB");
}

#[test]
fn nothing_but_what_there_is_can_be_asked_for() {
    let folder = Folder::new();
    make(&folder, "map", SMALL);
    let serving = Serving::new(&folder);
    let id = id(&serving, "map.h5");
    let window = "field=n_unstable&x=alpha_v&y=tau&w=9&h=9";
    for (path, status) in [
        ("/api/v1/maps/..", 404),
        ("/api/v1/maps/..%2f..%2fetc%2fpasswd", 404),
        ("/api/v1/maps/../../../etc/passwd", 404),
        ("/api/v1/maps/map.h5", 404),
        ("/api/v1/maps/0000000000000000", 404),
        (
            "/api/v1/maps/0000000000000000/window?field=n_unstable&x=tau",
            404,
        ),
        ("/api/v1/maps/ID/../ID", 404),
        ("/api/v1/maps/ID/nothing", 404),
        ("/api/v1/maps/ID/window", 422),
        ("/api/v1/maps/ID/window?field=../../etc/passwd&x=tau", 422),
        ("/api/v1/maps/ID/window?field=n_unstable&x=../tau", 422),
        ("/api/v1/maps/ID/window?field=abscissa&x=tau", 422),
        ("/api/v1/maps/ID/window?field=n_unstable&x=tau&y=tau", 422),
        ("/api/v1/maps/ID/window?WINDOW&w=0", 422),
        ("/api/v1/maps/ID/window?field=n_unstable&x=tau&w=0", 422),
        ("/api/v1/maps/ID/window?field=n_unstable&x=tau&w=2049", 422),
        (
            "/api/v1/maps/ID/window?field=n_unstable&x=tau&w=1000000000000",
            422,
        ),
        ("/api/v1/maps/ID/window?field=n_unstable&x=tau&w=-1", 422),
        (
            "/api/v1/maps/ID/window?field=n_unstable&x=tau&y=alpha_v&h=4294967297",
            422,
        ),
        ("/api/v1/maps/ID/window?WINDOW&at=mu_prime:3", 422),
        ("/api/v1/maps/ID/window?WINDOW&at=mu_prime:-1", 422),
        (
            "/api/v1/maps/ID/window?WINDOW&at=mu_prime:18446744073709551616",
            422,
        ),
        ("/api/v1/maps/ID/window?WINDOW&at=../mu_prime:1", 422),
        ("/api/v1/maps/ID/window?WINDOW&at=mu_prime", 422),
        (
            "/api/v1/maps/ID/window?WINDOW&at=mu_prime:1,mu_prime:1",
            422,
        ),
        ("/api/v1/maps/ID/window?WINDOW&x0=nan", 422),
        ("/api/v1/maps/ID/window?WINDOW&x0=inf&x1=2", 422),
        ("/api/v1/maps/ID/window?WINDOW&y0=0&yscale=log", 422),
        ("/api/v1/maps/ID/window?WINDOW&y0=-1&yscale=log", 422),
        ("/api/v1/maps/ID/window?WINDOW&xscale=cubic", 422),
        ("/api/v1/maps/ID/curves?x=alpha_v", 422),
        ("/api/v1/maps/ID/curves?x=alpha_v&y=nothing", 422),
        ("/api/v1/maps/ID/cell?at=tau:0", 422),
        ("/api/v1/maps/ID/cell?at=mu_prime:0,alpha_v:60,tau:0", 422),
        ("/api/v1/maps/ID/cell", 422),
    ] {
        let path = path.replace("ID", &id).replace("WINDOW", window);
        let answer = serving.get(&path);
        assert_eq!(answer.status, status, "{path}: {}", answer.head);
        assert!(
            answer.head.contains("application/problem+json"),
            "{path}: {}",
            answer.head
        );
        assert!(answer.json()["detail"].is_string());
    }
    let long = format!("/api/v1/maps/{id}/cell?at={}", "a".repeat(20_000));
    assert!((400..500).contains(&serving.get(&long).status));
    let long = format!(
        "/api/v1/maps/{id}/window?{window}&at={}",
        "tau:0,".repeat(300)
    );
    assert_eq!(serving.get(&long).status, 422);
    let post = serving.ask(&format!("maps/{id}/window?{window}"), "");
    assert_eq!(post.status, 405);
    let refused = serving.request(&format!("GET /api/v1/maps/{id}/sweep"), &[], "");
    assert_eq!(refused.status, 401);
    complete(&serving, &format!("/api/v1/maps/{id}/window?{window}"));
}

/// A process that is killed or hangs while it is asked is a message, and the next request has an
/// answer; processes end with the server however that ends.
#[test]
fn processes_that_read_maps_come_and_go() {
    let folder = Folder::new();
    make(&folder, "map", SMALL);
    let mut serving = Serving::new(&folder);
    let id = id(&serving, "map.h5");
    let path = format!("/api/v1/maps/{id}/window?field=n_unstable&x=alpha_v&y=tau&w=9&h=9");
    complete(&serving, &path);
    let readers = || processes::children(serving.child.id());
    let [reader] = readers()[..] else {
        panic!("{:?}", readers())
    };
    signal(reader, "-STOP");
    std::thread::scope(|scope| {
        let asking = scope.spawn(|| serving.get(&path));
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(
            serving.get("/api/v1/maps").status,
            200,
            "others are answered"
        );
        signal(reader, "-KILL");
        let answer = asking.join().unwrap();
        assert_eq!(answer.status, 502, "{}", answer.head);
        assert!(answer.json()["detail"].as_str().unwrap().contains("ended"));
    });
    complete(&serving, &path);
    let [reader] = readers()[..] else {
        panic!("{:?}", readers())
    };
    // Another map takes its name.
    make(
        &folder,
        "other",
        &SMALL.replace("points = 60", "points = 50"),
    );
    fs::rename(folder.path().join("other.h5"), folder.path().join("map.h5")).unwrap();
    until(5, "the other map is read", || {
        let told = serving.get(&format!("/api/v1/maps/{id}")).json();
        told["axes"][1]["points"] == 50
    });
    until(5, "the first process ends", || !processes::is_there(reader));
    let left = readers();
    assert!(!left.is_empty());
    serving.child.kill().unwrap();
    serving.child.wait().unwrap();
    until(5, "they end with the server", || {
        !left.iter().any(|&id| processes::is_there(id))
    });
}

/// However many maps are asked at once, few processes read them, and all are answered.
#[test]
fn few_processes_read_many_maps() {
    let folder = Folder::new();
    make(&folder, "map", SMALL);
    for number in 0..30 {
        let copy = folder.path().join(format!("copy{number}.h5"));
        fs::copy(folder.path().join("map.h5"), copy).unwrap();
    }
    let serving = Serving::new(&folder);
    let known = || {
        let list = serving.get("/api/v1/maps").json();
        let maps = list["maps"].as_array().unwrap().clone();
        let is_known = |map: &Value| map["state"] == "complete";
        maps.iter().all(is_known).then_some(maps)
    };
    until(60, "all are known", || known().is_some());
    let maps = known().unwrap();
    let children = || processes::children(serving.child.id());
    until(10, "those for the list have ended", || {
        children().is_empty()
    });
    let (mut most, answered) = (0, std::sync::atomic::AtomicUsize::new(0));
    let refused = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for map in maps.iter().chain(&maps).chain(&maps) {
            let path = format!("/api/v1/maps/{}", map["id"].as_str().unwrap());
            let (serving, answered, refused) = (&serving, &answered, &refused);
            scope.spawn(move || {
                let answer = serving.get(&path);
                let busy = answer.status == 503 && answer.head.contains("retry-after: ");
                assert!(answer.status == 200 || busy, "{}", answer.head);
                refused.fetch_add(usize::from(busy), std::sync::atomic::Ordering::Relaxed);
                answered.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            });
        }
        while answered.load(std::sync::atomic::Ordering::Relaxed) < 3 * maps.len() {
            most = most.max(children().len());
            std::thread::sleep(Duration::from_millis(5));
        }
    });
    // Two that are looked at.
    assert!((1..=2).contains(&most), "{most} processes");
    let refused = refused.into_inner();
    assert!(refused < maps.len(), "{refused} of {}", 3 * maps.len());
}

/// Who says nothing, or trickles, makes room for others.
#[test]
fn slow_clients_make_room() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let connect = || {
        let stream = TcpStream::connect(&serving.address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        stream
    };
    let ended = |mut stream: TcpStream| {
        let mut read = Vec::new();
        let result = stream.read_to_end(&mut read);
        let text = String::from_utf8_lossy(&read).into_owned();
        let gone = result.is_ok()
            || result.is_err_and(|error| error.kind() == std::io::ErrorKind::ConnectionReset);
        (gone, text)
    };
    let begun = Instant::now();
    let mut headers = connect();
    write!(
        headers,
        "GET / HTTP/1.1\r\nHost: {}\r\nX-Slow: ",
        serving.address
    )
    .unwrap();
    let mut body = connect();
    let known = format!(
        "Authorization: {}\r\nContent-Type: application/toml",
        serving.bearer()
    );
    let head = format!(
        "POST /api/v1/point HTTP/1.1\r\nHost: {}\r\n{known}",
        serving.address
    );
    write!(body, "{head}\r\nContent-Length: 1000\r\n\r\n[fixed]").unwrap();
    let mut idle = connect();
    let head = format!(
        "GET /api/v1/maps HTTP/1.1\r\nHost: {}\r\n{known}\r\n\r\n",
        serving.address
    );
    idle.write_all(head.as_bytes()).unwrap();
    std::thread::scope(|scope| {
        let trickling = [&headers, &body].map(|stream| {
            let mut stream = stream.try_clone().unwrap();
            scope.spawn(move || {
                while begun.elapsed() < Duration::from_secs(18) {
                    if stream.write_all(b"a").is_err() {
                        break;
                    }
                    std::thread::sleep(Duration::from_millis(300));
                }
            })
        });
        assert!(ended(headers).0);
        let (gone, text) = ended(body);
        assert!(gone && (text.is_empty() || text.contains("408")), "{text}");
        let (gone, text) = ended(idle);
        assert!(gone && text.starts_with("HTTP/1.1 200"), "{text}");
        drop(trickling);
    });
    assert!(
        begun.elapsed() < Duration::from_secs(17),
        "{:?}",
        begun.elapsed()
    );
}

#[test]
fn a_thousand_connections_do_not_keep_others_out() {
    let _alone = with_many_connections();
    let folder = Folder::new();
    make(&folder, "map", SMALL);
    let serving = Serving::new(&folder);
    let id = id(&serving, "map.h5");
    let silent: Vec<_> = (0..1000)
        .filter_map(|_| TcpStream::connect(&serving.address).ok())
        .collect();
    assert!(silent.len() > 900, "{}", silent.len());
    let begun = Instant::now();
    let path = format!("/api/v1/maps/{id}/window?field=n_unstable&x=alpha_v&y=tau&w=9&h=9");
    complete(&serving, &path);
    assert!(
        begun.elapsed() < Duration::from_secs(5),
        "{:?}",
        begun.elapsed()
    );
    assert!(processes::peak(serving.child.id()) < 300);
}

/// A request over a socket in the file system.
fn over_socket(path: &Path, host: &str, token: &str) -> String {
    let mut stream = UnixStream::connect(path).unwrap();
    let head = format!("GET /api/v1/maps HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n");
    write!(stream, "{head}Authorization: Bearer {token}\r\n\r\n").unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    text
}

#[test]
fn a_socket_is_for_tunnels() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let path = folder.path().join("s");
    let mut serving = Serving::with(&folder, &["--socket", "s"]);
    let mode = fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    for (host, status) in [
        ("127.0.0.1:8417", 200),
        ("localhost:9999", 200),
        ("[::1]:80", 200),
        ("evil.example:8417", 421),
        ("192.0.2.1:8417", 421),
    ] {
        let text = over_socket(&path, host, &serving.token);
        assert!(
            text.starts_with(&format!("HTTP/1.1 {status}")),
            "{host}: {text}"
        );
    }
    assert_eq!(serving.address, "127.0.0.1:8417");
    let second = folder.run(&["serve", "--socket", "s"]);
    expect(&second, 2, "another server listens there");
    fs::write(folder.path().join("file"), "text").unwrap();
    expect(
        &folder.run(&["serve", "--socket", "file"]),
        2,
        "no socket is there",
    );
    signal(serving.child.id(), "-TERM");
    serving.child.wait().unwrap();
    assert!(!path.exists());
    // One that was left behind is replaced.
    drop(UnixListener::bind(&path).unwrap());
    let serving = Serving::with(&folder, &["--socket", "s"]);
    assert!(over_socket(&path, "localhost:1", &serving.token).starts_with("HTTP/1.1 200"));
}

#[test]
fn options_say_what_they_mean() {
    let folder = Folder::new();
    expect(
        &folder.run(&["serve", "nowhere"]),
        2,
        "nowhere is no folder",
    );
    // A browser that is there, and one that is not.
    let opener = "#!/bin/sh\ncat \"$1\" > opened\n";
    let path = folder.path().join("xdg-open");
    fs::write(&path, opener).unwrap();
    let mut mode = fs::metadata(&path).unwrap().permissions();
    std::os::unix::fs::PermissionsExt::set_mode(&mut mode, 0o755);
    fs::set_permissions(&path, mode).unwrap();
    let ends = |args: &[&str], path: &Path| {
        let mut command = folder.command(&[&["serve", "--port", "0"], args].concat());
        let found = std::env::join_paths([path, Path::new("/usr/bin"), Path::new("/bin")]).unwrap();
        command.env("PATH", found);
        let child = Started::of(&mut command);
        std::thread::sleep(Duration::from_millis(700));
        child.signal("-INT");
        child.ended()
    };
    let output = ends(&["--open"], folder.path());
    let link = String::from_utf8(output.stdout).unwrap();
    let opened = fs::read_to_string(folder.path().join("opened")).unwrap();
    assert!(opened.contains(link.trim()), "{opened}");
    assert_eq!(link.lines().count(), 1);
    fs::write(&path, "#!/bin/sh\nexit 3\n").unwrap();
    let output = ends(&["--open"], folder.path());
    assert!(
        err(&output).contains("did not open the link"),
        "{}",
        err(&output)
    );
    assert_eq!(output.status.code(), Some(0));
    let output = ends(&["--address", "0.0.0.0"], folder.path());
    let said = err(&output);
    assert!(
        said.contains("everyone who can reach") && said.contains("not encrypted"),
        "{said}"
    );
    assert!(
        String::from_utf8(output.stdout)
            .unwrap()
            .starts_with("http://127.0.0.1:")
    );
}
