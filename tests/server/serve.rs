//! `slipmap serve` over real connections: who is answered, what, and what it survives.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

#[cfg(target_os = "linux")]
use crate::processes::peak;
use crate::program::{self, Folder, err, signal};
use crate::server::{Answer, Serving, decoded};
use crate::with_many_connections;
use slipmap::linear::Crossings;
use slipmap::model::Groups;

const POINT: &str = "[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n";
const PLANE: &str = "boundaries = true\n[axes]\nalpha_v = { from = -1.0, to = 0.2, points = 60 }\n\
    tau = { from = 0.0, to = 12.0, points = 80 }\n[fixed]\nmu_prime = -0.3\n";

/// The answer without its warning, of which there is none, with what its own command line says of
/// it.
fn with_command(folder: &Folder, answer: &Answer) -> [serde_json::Value; 2] {
    assert_eq!(answer.status, 200, "{}", answer.head);
    let mut found = answer.json();
    let command = found.as_object_mut().unwrap().remove("command").unwrap();
    assert_eq!(
        found.as_object_mut().unwrap().remove("warning").unwrap(),
        serde_json::Value::Null
    );
    let words: Vec<&str> = command.as_str().unwrap().split(' ').skip(1).collect();
    let told = folder.run(&[&words[..], &["--json"]].concat());
    let mut told = program::json(&told);
    for of_commands in ["schema_version", "inputs"] {
        told.as_object_mut().unwrap().remove(of_commands);
    }
    [found, told]
}

#[test]
fn a_point_is_what_the_command_says() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let weakening = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n";
    let sliding = format!("[fixed]\nv0 = 0.35\nalpha_n = -1e-9\ntau = 0.1\n{weakening}v_s = 0.5\n");
    let heavy = "[fixed]\nmu_prime = -0.1\nmu_k = 0.4\nmass = 2.5e3\nstiffness = 0.3333333333333333\n\
        alpha_v = -0.0\ntau = 7e-3\n";
    for point in [POINT, &sliding, heavy] {
        let [found, told] = with_command(&folder, &serving.ask("point", point));
        assert_eq!(found, told);
        let [line, abscissa] = ["certified_line", "abscissa"].map(|key| found[key].as_f64());
        assert!(line > abscissa && abscissa.is_some(), "{found}");
    }
    let stated = format!("[fixed]\nalpha_v = -0.33\ntau = 4.15\n{weakening}");
    for law in [
        format!("{stated}v_s = 0.5\n"),
        format!("{stated}mu_prime_rest = -1\n"),
    ] {
        let [found, told] = with_command(&folder, &serving.ask("vc", &law));
        assert_eq!(found, told);
        assert!((found["vc"].as_f64().unwrap() - 0.3).abs() < 0.1, "{found}");
        let phase = format!("protocol = \"switch-on\"\nstart.switch_on_phase = 0.25\n{law}");
        let [found, told] = with_command(&folder, &serving.ask("vc", &phase));
        assert_eq!((&found, &found["protocol"]), (&told, &"switch-on".into()));
    }
    let flags = [
        "--mu-prime=-0.3",
        "--alpha-v=-0.33",
        "--tau=4.15",
        "--roots=16",
    ];
    let command = serving.ask("point", POINT).json()["command"].clone();
    assert_eq!(command, format!("slipmap point {}", flags.join(" ")));
    let table = "[fixed]\nv0 = 0.1\ntau = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [0.9, 0.5]\n";
    assert!(serving.ask("point", table).json()["command"].is_null());
}

/// What leaves the velocities of a measured friction law is warned of in the words of the command.
#[test]
fn velocities_that_were_not_measured_are_warned_of() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let law = "[friction]\nlaw = \"table\"\nspeeds = [0, 0.1, 0.5]\nmu_k = [0.5, 0.45, 0.4]\n";
    let law = format!("[fixed]\nalpha_v = 0.1\ntau = 1\n{law}");
    let sliding = law.replace("[fixed]", "[fixed]\nv0 = 2");
    let slow = law.replace("[fixed]", "[fixed]\nv0 = 0.1");
    let case = format!("{slow}[start]\nx_dot0 = 0.6\n");
    for (request, command, text, of) in [
        ("point", "point", &sliding, "v0 = 2"),
        ("vc", "vc", &law, "v_c = 3.28"),
        ("motion", "simulate", &case, "the speed of the block up to "),
    ] {
        std::fs::write(folder.path().join("text.toml"), text).unwrap();
        let words: &[&str] = match command {
            "simulate" => &["simulate", "text.toml", "-o", "-"],
            _ => &[command, "--setting", "text.toml"],
        };
        let said = err(&folder.run(words));
        let answer = serving.ask(request, text);
        let warning = match request {
            "motion" => decoded(&answer.body).0["warning"].clone(),
            _ => answer.json()["warning"].clone(),
        };
        let warning = warning.as_str().unwrap();
        assert!(
            warning.starts_with(of) && warning.contains("lies beyond the curve"),
            "{warning}"
        );
        assert!(
            said.contains(&format!("warning: {warning}\n")),
            "{said}{warning}"
        );
    }
    // Between the points the slope is doubted where they are far apart.
    std::fs::write(folder.path().join("slow.toml"), &slow).unwrap();
    let told = serving.ask("point", &slow).json()["warning"].clone();
    let said = err(&folder.run(&["point", "--setting", "slow.toml"]));
    let told = told.as_str().unwrap();
    assert!(
        told.contains("the slope of the measured curve at v0"),
        "{told}"
    );
    assert!(said.contains(&format!("warning: {told}\n")), "{said}{told}");
}

#[test]
fn a_motion_is_what_the_command_says() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let case = include_str!("../../sweeps/fig3a.toml");
    let answer = serving.ask("motion", case);
    assert_eq!(answer.status, 200, "{}", answer.head);
    let (head, arrays) = decoded(&answer.body);
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    let words = head["command"].as_str().unwrap().split(' ').skip(1);
    let told = folder.run(&[&words.collect::<Vec<_>>()[..], &["--json"]].concat());
    let told = program::json(&told);
    for (key, value) in told.as_object().unwrap() {
        let of_command = ["trace", "schema_version", "inputs"].contains(&key.as_str());
        assert!(of_command || head[key] == *value, "{key}");
    }
    let array = |name: &str| {
        let of = &head["arrays"][name];
        assert_eq!(of["type"], "f64", "{name}");
        let [at, length] = ["offset", "length"].map(|key| of[key].as_u64().unwrap() as usize);
        let bytes = arrays[at..at + 8 * length].chunks(8);
        bytes
            .map(|n| f64::from_le_bytes(n.try_into().unwrap()))
            .collect::<Vec<_>>()
    };
    let t = array("t");
    assert!(t.len() > 1000 && t.len() <= 20_000 && t.windows(2).all(|w| w[0] < w[1]));
    for event in head["events"].as_array().unwrap() {
        let [at, a] = ["t", "a"].map(|key| event[key].as_f64().unwrap());
        // To the last digit that JSON is read to.
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-14 * y.abs();
        let sample = t.iter().position(|t| near(*t, at));
        assert!(sample.is_some_and(|i| near(array("a")[i], a)) || at > t[t.len() - 1]);
    }
    for name in ["x", "x_dot", "v", "N"] {
        assert_eq!(array(name).len(), t.len());
    }
    assert_eq!(head["arrays"]["mode"]["length"], t.len());
    assert!(head.get("unit_t").is_none());
    let units = "\n[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
    let answer = serving.ask("motion", &format!("{case}{units}"));
    assert_eq!(decoded(&answer.body).0["unit_x_dot"], "mm s-1");
}

#[test]
fn laws_and_tables_are_told() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let law = "[fixed]\nv0 = 0.25\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let found = serving.ask("law", law).json();
    assert_eq!(found["v"].as_array().unwrap().len(), 201);
    assert_eq!(found["at"]["mu_k"].as_f64(), Some(0.5 / 1.5));
    assert_eq!(serving.ask("law", POINT).status, 422);
    let bearer = serving.bearer();
    let asked = serving.request("GET /api/v1/parameters", &[("Authorization", &bearer)], "");
    let known = asked.json();
    let names = |of: &str| {
        let list = known[of].as_array().unwrap().iter();
        list.map(|row| row["name"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert!(names("parameters").contains(&"alpha_v".to_owned()));
    let laws = [
        "coulomb",
        "weakening",
        "stribeck",
        "hyperbolic",
        "rate-and-state",
        "table",
        "formula",
    ];
    assert_eq!(names("laws"), laws);
    let formula = "[friction]\nlaw = \"formula\"\nmu_k = \"mu0 + sigma*v\"\n";
    let found = serving.ask("formula", formula).json();
    assert_eq!(found["known"], serde_json::json!(["mu0"]));
    assert_eq!(found["own"][0]["name"], "sigma");
    let refused = serving.ask("formula", &formula.replace("sigma", "mass"));
    let place = serde_json::json!(formula.find("sigma"));
    assert_eq!(refused.status, 422);
    assert_eq!(refused.json()["span"][0], place);
    assert!(names("fields").contains(&"n_unstable".to_owned()));
}

/// Every cell of a chart by the closed form, from the bytes as a page reads them.
#[test]
fn a_chart_is_that_of_the_closed_form() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let Answer { status, body, .. } = serving.ask("chart", PLANE);
    assert_eq!(status, 200);
    let (head, arrays) = decoded(&body);
    let field = &head["fields"][0];
    assert_eq!(
        (&field["name"], &field["type"]),
        (&"n_unstable".into(), &"u16".into())
    );
    let values = |axis: usize| {
        let of = &head["axes"][axis]["values"];
        let [at, length] = ["offset", "length"].map(|key| of[key].as_u64().unwrap() as usize);
        let bytes = arrays[at..at + 8 * length].chunks(8);
        bytes
            .map(|n| f64::from_le_bytes(n.try_into().unwrap()))
            .collect::<Vec<_>>()
    };
    let (gains, delays) = (values(0), values(1));
    assert_eq!((gains.len(), delays.len()), (60, 80));
    // Counts come in runs: so many counts, and where each run ends.
    let number = |key: &str| field[key].as_u64().unwrap() as usize;
    let (at, runs) = (number("offset"), number("runs"));
    assert_eq!(number("length"), 60 * 80);
    let count = |run: usize| {
        let bytes = &arrays[at + 2 * run..];
        u16::from_le_bytes([bytes[0], bytes[1]])
    };
    let ends = arrays[at + (2 * runs).next_multiple_of(8)..].chunks(4);
    let ends = ends.map(|n| u32::from_le_bytes(n.try_into().unwrap()) as usize);
    let mut from = 0;
    let mut counts = ends.take(runs).enumerate().flat_map(|(run, end)| {
        let length = end - std::mem::replace(&mut from, end);
        std::iter::repeat_n(count(run), length)
    });
    for &gain in &gains {
        let crossings = Crossings::of(Groups::new(-0.3, gain, 0.0));
        for &tau in &delays {
            let expected = crossings.n_unstable(tau);
            assert_eq!(u64::from(counts.next().unwrap()), expected, "{gain} {tau}");
        }
    }
    let curves = head["curves"].as_array().unwrap();
    assert!(curves.iter().any(|curve| curve["stable_side"] != 0));
    let last = curves.last().unwrap();
    let end = last["offset"].as_u64().unwrap() + 8 * last["length"].as_u64().unwrap();
    assert!(end as usize <= arrays.len());
}

#[test]
fn only_the_own_page_is_answered() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let bearer = serving.bearer();
    let known = ("Authorization", &*bearer);
    let toml = ("Content-Type", "application/toml");
    let post = "POST /api/v1/point";
    let own = format!("http://{}", serving.address);
    for (line, headers, status) in [
        ("GET /", &[][..], 401),
        ("GET /explorer.js", &[], 401),
        (post, &[toml], 401),
        ("GET /?token=0123", &[], 401),
        ("GET /", &[("Authorization", "Bearer 0")], 401),
        ("GET /", &[known, ("Host", "evil.example")], 421),
        ("GET /", &[known, ("Host", "127.0.0.1")], 421),
        (post, &[known, toml, ("Origin", "http://evil.example")], 403),
        (post, &[known, toml, ("Sec-Fetch-Site", "cross-site")], 403),
        (post, &[known, toml, ("Origin", &own)], 200),
        (post, &[known, ("Content-Type", "text/plain")], 415),
        (
            post,
            &[
                known,
                toml,
                ("Origin", &own),
                ("Origin", "http://evil.example"),
            ],
            403,
        ),
        (
            post,
            &[
                known,
                toml,
                ("Origin", "http://evil.example"),
                ("Origin", &own),
            ],
            403,
        ),
        ("GET /api/v1/point", &[known], 405),
        ("GET /%2e%2e/%2e%2e/etc/passwd", &[known], 404),
        ("GET /..%2f..%2fetc%2fpasswd", &[known], 404),
        ("GET /api/v1/nothing", &[known], 404),
        ("GET /%ff", &[known], 404),
        ("GET /api/v1/maps/%ff", &[known], 404),
        ("GET /?token=a&token=b", &[], 401),
    ] {
        let body = if line == post { POINT } else { "" };
        let answer = serving.request(line, headers, body);
        assert_eq!(answer.status, status, "{line} {headers:?}: {}", answer.head);
        assert!(
            answer.head.contains("default-src 'none'"),
            "{}",
            answer.head
        );
        let problem = answer.head.contains("application/problem+json");
        assert!(problem || answer.status == 200, "{line}: {}", answer.head);
        assert!(answer.head.contains("referrer-policy: no-referrer"));
    }
}

#[test]
fn the_link_becomes_a_cookie() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    // Not by a redirect: the page brings the cookie also if another page has led to the link.
    let answer = serving.request(&format!("GET /?token={}", serving.token), &[], "");
    assert_eq!(answer.status, 200, "{}", answer.head);
    let onwards = String::from_utf8(answer.body).unwrap();
    assert!(onwards.contains("url=/") && !onwards.contains(&serving.token));
    let cookie = answer
        .head
        .lines()
        .find_map(|l| l.strip_prefix("set-cookie: "))
        .unwrap();
    assert!(
        cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"),
        "{cookie}"
    );
    let cookie = cookie.split(';').next().unwrap();
    let page = serving.request("GET /", &[("Cookie", cookie)], "");
    assert_eq!(page.status, 200);
    assert!(String::from_utf8(page.body).unwrap().contains("<canvas"));
    for file in [
        "explorer.js",
        "plane.js",
        "source.js",
        "uplot.js",
        "explorer.css",
    ] {
        let answer = serving.request(&format!("GET /{file}"), &[("Cookie", cookie)], "");
        assert_eq!(answer.status, 200, "{file}");
    }
}

#[test]
fn mistakes_are_problems_with_their_place() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let text = POINT.replace("4.15", "-1");
    let answer = serving.ask("point", &text);
    assert!(
        answer.head.contains("application/problem+json"),
        "{}",
        answer.head
    );
    let problem = answer.json();
    let span = [0, 1].map(|i| problem["span"][i].as_u64().unwrap() as usize);
    assert_eq!((answer.status, &text[span[0]..span[1]]), (422, "-1"));
    for (what, text, status) in [
        ("point", "nonsense", 422),
        ("point", "[fixed]\ntau = nan\nmu_prime = 1\n", 422),
        ("chart", "[axes]\ntau = []\n", 422),
        (
            "chart",
            &PLANE
                .replace("points = 60", "points = 70")
                .replace("points = 80", "points = 65536"),
            413,
        ),
        (
            "chart",
            &PLANE.replace("points = 80", "points = 65537"),
            422,
        ),
        (
            "chart",
            &PLANE.replace("points = 80", "points = 100000000000"),
            422,
        ),
        ("vc", POINT, 422),
    ] {
        let answer = serving.ask(what, text);
        assert_eq!(answer.status, status, "{what} {text}: {}", answer.head);
        assert!(answer.json()["detail"].is_string());
    }
    let long = format!("# {}\n{POINT}", "x".repeat(1 << 20));
    assert_eq!(serving.ask("point", &long).status, 413);
    assert_eq!(serving.ask("point", POINT).status, 200, "it goes on");
}

/// Garbage, endless headers, and connections that say nothing: others are answered all the while.
#[test]
fn others_are_answered_while_some_do_harm() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let silent: Vec<_> = (0..200)
        .map(|_| TcpStream::connect(&serving.address).unwrap())
        .collect();
    let huge = format!(
        "GET / HTTP/1.1\r\nHost: {}\r\nX: {}\r\n\r\n",
        serving.address,
        "a".repeat(10_000_000)
    );
    assert_ne!(serving.send(huge.as_bytes()).status, 200);
    assert_ne!(serving.send(b"\0\xff\r\n\r\n\r\n").status, 200);
    assert_eq!(serving.ask("point", POINT).status, 200);
    drop(silent);
}

/// A connection on which somebody waits for a chart.
fn asking(serving: &Serving, text: &str) -> TcpStream {
    let mut stream = TcpStream::connect(&serving.address).unwrap();
    let head = format!(
        "POST /api/v1/chart HTTP/1.1\r\nHost: {}\r\nAuthorization: {}\r\n\
         Content-Type: application/toml; charset=utf-8\r\nContent-Length: {}\r\n\r\n{text}",
        serving.address,
        serving.bearer(),
        text.len()
    );
    stream.write_all(head.as_bytes()).unwrap();
    stream
}

/// Who has no token cannot take connections from who has one, nor memory, by bodies that do not come.
#[test]
fn bodies_without_a_token_are_not_waited_for() {
    let _alone = with_many_connections();
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let head = format!(
        "GET / HTTP/1.1\r\nHost: {}\r\nContent-Length: 262144\r\n\r\n",
        serving.address
    );
    let waiting: Vec<_> = (0..600)
        .filter_map(|_| {
            let mut stream = TcpStream::connect(&serving.address).ok()?;
            stream.write_all(head.as_bytes()).ok()?;
            Some(stream)
        })
        .collect();
    let begun = Instant::now();
    assert_eq!(serving.ask("point", POINT).status, 200);
    assert!(
        begun.elapsed() < Duration::from_secs(4),
        "{:?}",
        begun.elapsed()
    );
    drop(waiting);
}

/// As many of the largest charts as are asked for, which nobody reads, take no more memory than some.
#[cfg(target_os = "linux")]
#[test]
fn answers_that_are_not_read_take_limited_memory() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let many = PLANE
        .replace("points = 60", "points = 2000")
        .replace("points = 80", "points = 2000");
    let axes = PLANE
        .replace("points = 60", "points = 61")
        .replace("points = 80", "points = 65536");
    // Margins differ from cell to cell, so nothing of them is stored as runs.
    let margins = format!("fields = [\"delay_margin\"]\n{PLANE}")
        .replace("points = 60", "points = 1000")
        .replace("points = 80", "points = 900");
    let mut unread: Vec<_> = [
        &many, &axes, &margins, &margins, &margins, &margins, &margins,
    ]
    .map(|text| asking(&serving, text))
    .into();
    std::thread::sleep(Duration::from_secs(4));
    assert_eq!(serving.ask("point", POINT).status, 200);
    let most = peak(serving.child.id());
    assert!((40..250).contains(&most), "{most} MB");
    let mut first = [0; 12];
    unread[0].read_exact(&mut first).unwrap();
    assert_eq!(&first, b"HTTP/1.1 200");
}

/// What is on a command line is seen by all users of a machine, so the token is not.
#[cfg(all(unix, not(target_os = "macos")))]
#[test]
fn a_browser_is_led_to_the_link_by_a_file_of_the_users_own() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let opener = folder.path().join("xdg-open");
    let told = folder.path().join("told");
    let script = format!(
        "#!/bin/sh\necho \"$@\" > {0}.part; mv {0}.part {0}\n",
        told.display()
    );
    std::fs::write(&opener, script).unwrap();
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", folder.path().display());
    let mut serving = Serving::of(
        folder
            .command(&["serve", "--port=0", "--open"])
            .env("PATH", path),
    );
    let until = Instant::now() + Duration::from_secs(20);
    while !told.exists() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(20));
    }
    let arguments = std::fs::read_to_string(&told).unwrap();
    assert!(!arguments.contains(&serving.token), "{arguments}");
    let page = std::path::PathBuf::from(arguments.trim());
    let mode = page.metadata().unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let text = std::fs::read_to_string(&page).unwrap();
    let link = format!("http://{}/?token={}", serving.address, serving.token);
    assert!(text.contains(&link), "{text}");
    signal(serving.child.id(), "-INT");
    assert!(serving.child.wait().unwrap().success());
    assert!(!page.exists(), "it goes with the server");
}

/// The link is one that the server answers, whichever address it listens on.
#[cfg(target_os = "linux")]
#[test]
fn another_address_of_this_machine_is_answered() {
    let folder = Folder::new();
    for address in ["127.0.0.2", "127.0.0.1", "0.0.0.0"] {
        let serving = Serving::with(&folder, &["--address", address]);
        assert_eq!(serving.ask("point", POINT).status, 200, "{address}");
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_soon() {
    let folder = Folder::new();
    let mut serving = Serving::new(&folder);
    // Somebody waits for what takes long.
    let text = "fields = [\"abscissa\"]\n".to_owned()
        + &PLANE.replace("12.0, points = 80", "1e5, points = 9000");
    let _waiting = asking(&serving, &text);
    std::thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    signal(serving.child.id(), "-INT");
    let ended = serving.child.wait().unwrap();
    assert!(
        ended.success() && begun.elapsed() < Duration::from_secs(2),
        "{ended}"
    );
}
