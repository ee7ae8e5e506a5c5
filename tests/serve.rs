//! `slipmap serve` over real connections: who is answered, what, and what it survives.

#[path = "common/program.rs"]
mod program;
#[path = "common/server.rs"]
mod server;

use std::net::TcpStream;
use std::time::{Duration, Instant};

use program::{Folder, out};
use server::{Answer, Serving};
use slipmap::linear::Crossings;
use slipmap::model::Groups;

const POINT: &str = "[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n";
const PLANE: &str = "boundaries = true\n[axes]\nalpha_v = { from = -1.0, to = 0.2, points = 60 }\n\
    tau = { from = 0.0, to = 12.0, points = 80 }\n[fixed]\nmu_prime = -0.3\n";

#[test]
fn a_point_is_what_the_command_says() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let answer = serving.ask("point", POINT);
    assert_eq!(answer.status, 200, "{}", answer.head);
    let flags = [
        "--mu-prime=-0.3",
        "--alpha-v=-0.33",
        "--tau=4.15",
        "--roots=16",
        "--json",
    ];
    let told = folder.run(&[&["point"], &flags[..]].concat());
    let told: serde_json::Value = serde_json::from_str(&out(&told)).unwrap();
    assert_eq!(answer.json(), told);
    let law = "[fixed]\nalpha_v = -0.33\ntau = 4.15\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let found = serving.ask("vc", law).json();
    let flags = [
        "--friction=weakening",
        "--mu0=0.5",
        "--v-s=0.5",
        "--alpha-v=-0.33",
        "--tau=4.15",
    ];
    let told = folder.run(&[&["vc", "--json"], &flags[..]].concat());
    let told: serde_json::Value = serde_json::from_str(&out(&told)).unwrap();
    assert_eq!(found, told);
}

/// Every cell of a chart by the closed form, from the bytes as a page reads them.
#[test]
fn a_chart_is_that_of_the_closed_form() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let Answer { status, body, .. } = serving.ask("chart", PLANE);
    assert_eq!(status, 200);
    let length = u32::from_le_bytes(body[..4].try_into().unwrap()) as usize;
    let head: serde_json::Value = serde_json::from_slice(&body[4..4 + length]).unwrap();
    let arrays = &body[(4 + length).next_multiple_of(8)..];
    let field = &head["fields"][0];
    assert_eq!(
        (&field["name"], &field["type"]),
        (&"n_unstable".into(), &"u16".into())
    );
    let values = |axis: usize| {
        let values = head["axes"][axis]["values"].as_array().unwrap();
        values
            .iter()
            .map(|v| v.as_f64().unwrap())
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
        ("GET /api/v1/point", &[known], 405),
        ("GET /%2e%2e/%2e%2e/etc/passwd", &[known], 404),
        ("GET /..%2f..%2fetc%2fpasswd", &[known], 404),
        ("GET /api/v1/nothing", &[known], 404),
    ] {
        let body = if line == post { POINT } else { "" };
        let answer = serving.request(line, headers, body);
        assert_eq!(answer.status, status, "{line} {headers:?}: {}", answer.head);
        assert!(
            answer.head.contains("default-src 'none'"),
            "{}",
            answer.head
        );
        assert!(answer.head.contains("referrer-policy: no-referrer"));
    }
    // The link becomes a cookie, which the page then brings.
    let answer = serving.request(&format!("GET /?token={}", serving.token), &[], "");
    assert_eq!(answer.status, 303, "{}", answer.head);
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
    for file in ["explorer.js", "chart.js", "request.js", "explorer.css"] {
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
            &PLANE.replace("points = 80", "points = 1000000"),
            413,
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

#[cfg(unix)]
#[test]
fn a_signal_ends_it_soon() {
    let folder = Folder::new();
    let mut serving = Serving::new(&folder);
    let id = serving.child.id().to_string();
    let begun = Instant::now();
    let sent = std::process::Command::new("kill")
        .args(["-INT", &id])
        .status();
    assert!(sent.unwrap().success());
    let ended = serving.child.wait().unwrap();
    assert!(
        ended.success() && begun.elapsed() < Duration::from_secs(2),
        "{ended}"
    );
}
