//! Sweeps over real connections: handed in, told, changed, taken out, and whatever is refused.

use std::fs;
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::openapi::Described;
use crate::processes::until;
use crate::program::{Folder, expect, out, signal};
use crate::server::{Answer, Serving};

/// A sweep that takes no time.
pub(crate) const SMALL: &str = "title = \"Small, & quick\"\nfields = [\"n_unstable\"]\n[axes]\n\
    alpha_v = { from = -1.0, to = 0.5, points = 31 }\n\
    tau = { from = 0.05, to = 9.0, points = 40 }\n[fixed]\nmu_prime = -0.3\n";
/// More than anybody waits for, and whose map the disk has room for.
const LONG: &str = "fields = [\"vc\"]\nboundaries = false\n[axes]\n\
    alpha_v = { from = -1.0, to = 0.5, points = 1000 }\n\
    tau = { from = 0.05, to = 9.0, points = 1000 }\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n\
    v_s = 0.5\n";
const TOML: (&str, &str) = ("Content-Type", "application/toml");
const JSON: (&str, &str) = ("Content-Type", "application/json");

/// Requests that change something.
const CHANGES: [(&str, (&str, &str), &str); 3] = [
    ("POST jobs", TOML, SMALL),
    ("PATCH jobs/100000-a", JSON, "{\"state\": \"held\"}"),
    ("DELETE jobs/100000-a?tiles", JSON, ""),
];

/// Sweeps of other plans.
pub(crate) fn other(mu_prime: f64) -> String {
    SMALL.replace("-0.3", &format!("{mu_prime:?}"))
}

/// A request about jobs by who has a token.
fn ask(serving: &Serving, token: &str, line: &str, more: &[(&str, &str)], body: &str) -> Answer {
    let (method, path) = line.split_once(' ').unwrap();
    let bearer = format!("Bearer {token}");
    let headers = [&[("Authorization", &*bearer)], more].concat();
    serving.request(&format!("{method} /api/v1/{path}"), &headers, body)
}

fn submit(serving: &Serving, path: &str, toml: &str) -> Answer {
    ask(
        serving,
        &serving.token,
        &format!("POST {path}"),
        &[TOML],
        toml,
    )
}

fn patch(serving: &Serving, name: &str, to: &Value) -> Answer {
    let line = format!("PATCH jobs/{name}");
    ask(serving, &serving.token, &line, &[JSON], &to.to_string())
}

fn take_out(serving: &Serving, path: &str) -> Answer {
    ask(
        serving,
        &serving.token,
        &format!("DELETE jobs/{path}"),
        &[],
        "",
    )
}

fn hold(serving: &Serving, name: &str) -> Answer {
    patch(serving, name, &json!({"state": "held"}))
}

/// States and names of all jobs.
fn jobs(serving: &Serving) -> Vec<(String, String)> {
    let list = serving.get("/api/v1/jobs").json();
    let text = |job: &Value, key: &str| job[key].as_str().unwrap().to_owned();
    let all = list["jobs"].as_array().unwrap().iter();
    all.map(|job| (text(job, "state"), text(job, "name")))
        .collect()
}

fn expect_jobs(serving: &Serving, expected: &[(&str, &str)]) {
    let found = jobs(serving);
    let found: Vec<_> = found.iter().map(|(a, b)| (&**a, &**b)).collect();
    assert_eq!(found, expected);
}

/// A refusal with this status, whose detail or help says this.
#[track_caller]
fn refused(answer: &Answer, status: u16, says: &str) {
    assert_eq!(answer.status, status, "{}", answer.head);
    assert!(
        answer
            .head
            .contains("content-type: application/problem+json")
    );
    let problem = String::from_utf8_lossy(&answer.body);
    assert!(problem.contains(says), "{problem}");
}

fn is_there(folder: &Folder, file: &str) -> bool {
    folder.path().join(file).exists()
}

#[test]
fn sweeps_are_handed_in() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let described = Described::of(&serving);
    let answer = submit(&serving, "jobs", SMALL);
    assert_eq!(answer.status, 201, "{}", answer.head);
    assert!(
        answer
            .head
            .contains("location: jobs/100000-small-quick\r\n")
    );
    let submitted = answer.json();
    let entry = described.answer("/api/v1/jobs", "post", "201");
    described.check(entry, &submitted, "submitted");
    for (key, value) in [
        ("name", json!("100000-small-quick")),
        ("state", json!("waiting")),
        ("place", json!(0)),
        ("map", json!("100000-small-quick.h5")),
        ("map_id", Value::Null),
    ] {
        assert_eq!(submitted[key], value, "{key}");
    }
    let written = fs::read_to_string(folder.path().join("queue/100000-small-quick.toml"));
    assert_eq!(written.unwrap(), SMALL);
    // The same plan is the same job, whatever its text.
    let again = submit(&serving, "jobs?name=again", &SMALL.replace("quick", "slow"));
    assert_eq!((again.status, again.json()), (200, submitted));
    let first = "jobs?first&name=../../Etc%2Fpasswd.toml";
    let named = submit(&serving, first, &other(-0.2));
    let name = json!("099990-etc-passwd-toml");
    assert_eq!((named.status, &named.json()["name"]), (201, &name));
    let held = submit(&serving, "jobs?hold&name=%E6%BC%A2", &other(-0.1));
    assert_eq!((held.status, &held.json()["state"]), (201, &json!("held")));
    let list = serving.get("/api/v1/jobs").json();
    described.check(
        described.answer("/api/v1/jobs", "get", "200"),
        &list,
        "list",
    );
    assert_eq!(list["attended"], false);
    assert_eq!(list["may_change"], true);
    expect_jobs(
        &serving,
        &[
            ("waiting", "099990-etc-passwd-toml"),
            ("waiting", "100000-small-quick"),
            ("held", "100010-sweep"),
        ],
    );
}

#[test]
fn a_map_that_is_there_is_not_made_again() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let described = Described::of(&serving);
    for (name, mu_prime) in [("a", -0.3), ("b", -0.2)] {
        let answer = submit(&serving, &format!("jobs?name={name}"), &other(mu_prime));
        assert_eq!(answer.status, 201);
    }
    expect(&folder.run(&["work", "--until-empty"]), 0, "done");
    expect_jobs(&serving, &[("done", "100000-a"), ("done", "100010-b")]);
    let told = serving.get("/api/v1/jobs/100000-a").json();
    let of_job = described.answer("/api/v1/jobs/{name}", "get", "200");
    described.check(of_job, &told, "job");
    let log = told["log"].as_str().unwrap();
    let last = log.lines().last().unwrap();
    assert!(last.contains("\"finished\""), "{log}");
    // The list of maps may be a second old.
    let begun = std::time::Instant::now();
    let map = loop {
        let maps = serving.get("/api/v1/maps").json();
        let of_name = |map: &&Value| map["name"] == told["map"] && map["state"] == "complete";
        if let Some(map) = maps["maps"].as_array().unwrap().iter().find(of_name) {
            break map.clone();
        }
        assert!(begun.elapsed().as_secs() < 20, "{maps}");
        std::thread::sleep(std::time::Duration::from_millis(50));
    };
    assert_eq!(map["id"], told["map_id"]);
    assert_eq!(map["state"], "complete");
    // The server knows it without opening it.
    let done = submit(&serving, "jobs", SMALL);
    assert_eq!((done.status, &done.json()["state"]), (200, &json!("done")));
    // So it does one that was made by hand after it has seen the others.
    fs::write(folder.path().join("own.toml"), other(-0.05)).unwrap();
    expect(&folder.run(&["run", "own.toml"]), 0, "");
    let own = submit(&serving, "jobs", &other(-0.05));
    assert_eq!((own.status, &own.json()["name"]), (200, &json!("own")));
    refused(&take_out(&serving, "100000-a?tiles"), 409, "is done");
    refused(&hold(&serving, "100000-a"), 409, "is done");
    assert!(is_there(&folder, "100000-a.h5"));
}

/// Two jobs that wait.
fn two() -> (Folder, Serving) {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    for (name, mu_prime) in [("a", -0.3), ("b", -0.2)] {
        let answer = submit(&serving, &format!("jobs?name={name}"), &other(mu_prime));
        assert_eq!(answer.status, 201);
    }
    (folder, serving)
}

#[test]
fn jobs_are_held_released_and_put_first() {
    let (_folder, serving) = two();
    let described = Described::of(&serving);
    let held = hold(&serving, "100000-a");
    let entry = described.answer("/api/v1/jobs/{name}", "patch", "200");
    described.check(entry, &held.json(), "held");
    assert_eq!((held.status, &held.json()["state"]), (200, &json!("held")));
    let to_first = json!({"first": true});
    refused(
        &patch(&serving, "100000-a", &to_first),
        409,
        "release it first",
    );
    let both = json!({"state": "waiting", "first": true});
    let first = patch(&serving, "100000-a", &both);
    assert_eq!((first.status, &first.json()["place"]), (200, &json!(0)));
    let first = patch(&serving, "100010-b", &to_first).json();
    assert_eq!(first["name"], "099990-b");
    assert_eq!(first["place"], 0);
    refused(
        &patch(&serving, "100010-b", &to_first),
        404,
        "no sweep of this name",
    );
    for unclear in [
        json!({}),
        json!({"state": "held", "first": true}),
        json!({"state": "running"}),
        json!({"stat": "held"}),
        json!([]),
    ] {
        assert_eq!(
            patch(&serving, "099990-b", &unclear).status,
            422,
            "{unclear}"
        );
    }
    let body = "{\"state\": \"held\"}";
    let as_toml = ask(
        &serving,
        &serving.token,
        "PATCH jobs/099990-b",
        &[TOML],
        body,
    );
    assert_eq!(as_toml.status, 415);
    expect_jobs(
        &serving,
        &[("waiting", "099990-b"), ("waiting", "100000-a")],
    );
}

#[test]
fn jobs_are_taken_out_and_nothing_else_is() {
    let (folder, serving) = two();
    assert_eq!(take_out(&serving, "100010-b?tile").status, 422);
    assert_eq!(take_out(&serving, "100010-b?tiles=yes").status, 422);
    assert_eq!(take_out(&serving, "100010-b").status, 204);
    assert_eq!(take_out(&serving, "100010-b").status, 404);
    // No name leads out of the queue.
    fs::write(folder.path().join("precious.toml"), SMALL).unwrap();
    for name in [
        "..%2Fprecious",
        "..%2F..%2Fprecious",
        ".",
        "%2e%2e",
        "a%00b",
        "%FF",
        "100000-a.toml",
    ] {
        assert_eq!(take_out(&serving, name).status, 404, "{name}");
        assert_eq!(hold(&serving, name).status, 404, "{name}");
        let told = serving.get(&format!("/api/v1/jobs/{name}"));
        assert_eq!(told.status, 404, "{name}");
    }
    assert!(is_there(&folder, "precious.toml"));
    expect_jobs(&serving, &[("waiting", "100000-a")]);
}

#[test]
fn a_sweep_that_failed_says_why() {
    let (folder, serving) = two();
    fs::write(folder.path().join("queue/bad.toml"), "= 1").unwrap();
    expect(&folder.run(&["work", "--until-empty"]), 1, "failed");
    let bad = serving.get("/api/v1/jobs/bad").json();
    assert_eq!(bad["state"], "failed");
    assert!(!bad["why"].as_str().unwrap().is_empty(), "{bad}");
    refused(&hold(&serving, "bad"), 409, "has failed");
    let again = patch(&serving, "bad", &json!({"state": "waiting"})).json();
    assert_eq!(again["state"], "waiting");
    assert_eq!(again["why"], Value::Null);
    // The list has not more than the beginning of a long one.
    let long = "é".repeat(20_000);
    fs::rename(
        folder.path().join("queue/bad.toml"),
        folder.path().join("failed/bad.toml"),
    )
    .unwrap();
    fs::write(folder.path().join("failed/bad.txt"), &long).unwrap();
    let list = serving.get("/api/v1/jobs").json();
    let jobs = list["jobs"].as_array().unwrap();
    let bad = jobs.iter().find(|job| job["name"] == "bad").unwrap();
    assert_eq!(bad["why"].as_str().unwrap().len(), 1000);
    assert_eq!(serving.get("/api/v1/jobs/bad").json()["why"], long);
}

/// A sweep that runs is told with its shards, held within a second, and keeps its tiles.
#[test]
fn a_sweep_that_runs_is_told_and_stopped() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    assert_eq!(submit(&serving, "jobs?name=long", LONG).status, 201);
    let mut worker = folder.start(&["work"]);
    let job = || serving.get("/api/v1/jobs/100000-long").json();
    until(60, "some of it is computed", || {
        job()["cells_done"].as_u64() > Some(0)
    });
    let told = job();
    assert_eq!(
        (&told["state"], &told["cells"]),
        (&json!("running"), &json!(1_000_000))
    );
    assert_eq!(told["shards"][0]["running"], true);
    assert!(
        told["map_id"].is_string() && told["host"].is_string(),
        "{told}"
    );
    assert!(serving.get("/api/v1/jobs").json()["attended"] == true);
    let map = format!("/api/v1/maps/{}/file", told["map_id"].as_str().unwrap());
    refused(&serving.get(&map), 409, "not complete");
    refused(
        &take_out(&serving, "100000-long?tiles"),
        409,
        "hold it first",
    );
    refused(
        &patch(&serving, "100000-long", &json!({"first": true})),
        409,
        "runs already",
    );
    let held = patch(&serving, "100000-long", &json!({"state": "held"})).json();
    assert_eq!(held["state"], "held");
    until(20, "its run has ended", || {
        job()["shards"][0]["running"] == false
    });
    assert!(job()["cells_done"].as_u64() > Some(0));
    assert!(worker.goes_on());
    let tiles = "100000-long.h5.tiles";
    assert!(is_there(&folder, tiles));
    // The worker may still be writing its note.
    until(20, "it is taken out", || {
        take_out(&serving, "100000-long?tiles").status == 204
    });
    assert!(!is_there(&folder, tiles));
    // The server has started none of it: it goes, the worker stays.
    drop(serving);
    assert!(worker.goes_on());
    worker.signal("-INT");
    worker.wait();
}

#[test]
fn who_may_only_look_changes_nothing() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let look = serving.token_to_look.clone().unwrap();
    assert_eq!(submit(&serving, "jobs?name=a", SMALL).status, 201);
    let list = ask(&serving, &look, "GET jobs", &[], "");
    assert_eq!(
        (list.status, &list.json()["may_change"]),
        (200, &json!(false))
    );
    for line in ["GET jobs/100000-a", "GET maps", "GET parameters"] {
        assert_eq!(ask(&serving, &look, line, &[], "").status, 200, "{line}");
    }
    assert_eq!(
        ask(&serving, &look, "POST plan", &[TOML], SMALL).status,
        200
    );
    for (line, kind, body) in CHANGES {
        refused(
            &ask(&serving, &look, line, &[kind], body),
            403,
            "another link",
        );
        assert_eq!(ask(&serving, "", line, &[kind], body).status, 401, "{line}");
        for page in [
            ("Origin", "http://evil.example"),
            ("Sec-Fetch-Site", "cross-site"),
        ] {
            let answer = ask(&serving, &serving.token, line, &[kind, page], body);
            refused(&answer, 403, "another page");
        }
    }
    expect_jobs(&serving, &[("waiting", "100000-a")]);
}

/// Each link becomes a cookie of its own role.
#[test]
fn a_link_to_look_stays_one() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let look = serving.token_to_look.clone().unwrap();
    for (token, may_change) in [(&look, false), (&serving.token, true)] {
        let front = serving.request(&format!("GET /?token={token}"), &[], "");
        assert_eq!(front.status, 200);
        let cookie = front.head.split("set-cookie: ").nth(1).unwrap();
        let cookie = ("Cookie", cookie.split(';').next().unwrap());
        assert!(cookie.1.ends_with(token.as_str()));
        let list = serving.request("GET /api/v1/jobs", &[cookie], "");
        assert_eq!(list.json()["may_change"], may_change);
    }
}

/// Without the flag nobody changes anything, and there is one link.
#[test]
fn a_server_that_only_shows_takes_nothing() {
    let folder = Folder::with(&[("a.toml", SMALL)]);
    expect(&folder.run(&["submit", "a.toml"]), 0, "waits");
    let showing = Serving::new(&folder);
    assert_eq!(showing.get("/api/v1/jobs").json()["may_change"], false);
    for (line, kind, body) in CHANGES {
        let answer = ask(&showing, &showing.token, line, &[kind], body);
        refused(&answer, 403, "--submit");
    }
    assert_eq!(submit(&showing, "plan", SMALL).status, 200);
    expect_jobs(&showing, &[("waiting", "100000-a")]);
}

#[test]
fn whatever_is_sent_is_refused_at_its_place() {
    let folder = Folder::new();
    let secret = "mass = 2.5 # a secret\n";
    fs::write(folder.path().join("x.toml"), secret).unwrap();
    let serving = Serving::submitting(&folder, &[]);
    let axes = "[axes]\ntau = [1, 2]\nv0 = [0.1]\n";
    for (text, at) in [
        ("[axes]\ntau = [1, -2]\n[fixed]\nmu_prime = -0.3\n".to_owned(), "-2"),
        (format!("{axes}[friction]\nlaw = \"table\"\ntable = \"/etc/passwd\"\n"), "\"/etc/passwd\""),
        (format!("{axes}friction.table = {{ file = '/etc/passwd' }}\n").replace("[axes]\n", ""), ""),
        (format!("system = \"x.toml\"\n{axes}"), "\"x.toml\""),
        (format!("system = \"/dev/zero\"\n{axes}"), "\"/dev/zero\""),
        (format!("{axes}[start]\nx_dot0 = 0.1\n"), ""),
        ("[".repeat(100_000), ""),
        (format!("a = {}", "[".repeat(100_000)), ""),
        ("[axes]\ntau = { from = 0, to = 1, points = 1e300 }\n".into(), ""),
        ("[axes]\nalpha_v = { from = 0, to = 1, points = 1000000000 }\ntau = { from = 0, to = 1, \
          points = 1000000000 }\n[fixed]\nmu_prime = -0.3\n".into(), ""),
        ("\u{0}".into(), ""),
        (String::new(), ""),
    ] {
        for path in ["jobs", "plan", "plan?timed"] {
            let answer = submit(&serving, path, &text);
            let start: String = text.chars().take(60).collect();
            assert_eq!(answer.status, 422, "{path} {start}");
            let problem = answer.json();
            assert!(!problem.to_string().contains("secret"), "{problem}");
            if let Some(span) = problem["span"][0].as_u64() {
                assert!(text[span as usize..].starts_with(at), "{problem}");
            } else {
                assert_eq!(at, "", "{problem}");
            }
        }
    }
    expect_jobs(&serving, &[]);
    // A system that is shipped is no file.
    let shipped = "system = \"turning\"\n[axes]\nK = [0.1]\ntau = [1]\n";
    let answer = submit(&serving, "plan", shipped);
    assert!(!String::from_utf8_lossy(&answer.body).contains("names no files"));
}

#[test]
fn what_is_too_much_or_of_another_kind_is_refused() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let long = format!("{SMALL}#{}", "x".repeat(1 << 18));
    for path in ["jobs", "plan"] {
        assert_eq!(submit(&serving, path, &long).status, 413, "{path}");
        let line = format!("POST {path}");
        let answer = |kind| ask(&serving, &serving.token, &line, &[kind], SMALL).status;
        assert_eq!(answer(("Content-Type", "text/plain")), 415, "{path}");
        assert_eq!(answer(JSON), 415, "{path}");
        assert_eq!(
            submit(&serving, &format!("{path}?other"), SMALL).status,
            422
        );
    }
    assert_eq!(submit(&serving, "jobs?first=perhaps", SMALL).status, 422);
    let wide = SMALL.replace("points = 40", "points = 131073");
    refused(&submit(&serving, "jobs", &wide), 422, "2 to 131072");
    expect_jobs(&serving, &[]);
    let keeping = Serving::submitting(&folder, &["--keep-free", "900000TB"]);
    refused(&submit(&keeping, "jobs", SMALL), 507, "--keep-free");
    expect_jobs(&keeping, &[]);
}

#[test]
fn a_plan_says_what_a_sweep_costs() {
    let folder = Folder::with(&[("a.toml", SMALL)]);
    let serving = Serving::submitting(&folder, &[]);
    let described = Described::of(&serving);
    let told = crate::program::json(&folder.run(&["plan", "a.toml", "--threads", "2", "--json"]));
    let mut plan = submit(&serving, "plan", SMALL).json();
    for key in ["cells", "bytes", "memory", "threads"] {
        assert_eq!(plan[key], told[key], "{key}");
    }
    assert!(
        plan["timed"].is_null() && plan["bytes_free"].as_u64() > Some(0),
        "{plan}"
    );
    for _ in 0..2 {
        let schema = described.answer("/api/v1/plan", "post", "200");
        described.check(schema, &plan, "plan");
        plan = submit(&serving, "plan?timed", SMALL).json();
    }
    let seconds: Vec<f64> = plan["timed"]["seconds"]
        .as_array()
        .unwrap()
        .iter()
        .map(|seconds| seconds.as_f64().unwrap())
        .collect();
    assert!(seconds[0] <= seconds[1] && seconds[1] <= seconds[2] && seconds[1] > 0.0);
    // A sample nobody waits for any more ends.
    let mut slow = Vec::new();
    for _ in 0..6 {
        let mut stream = TcpStream::connect(&serving.address).unwrap();
        let head = format!(
            "POST /api/v1/plan?timed HTTP/1.1\r\nHost: {}\r\nAuthorization: {}\r\n\
             Content-Type: application/toml\r\nContent-Length: {}\r\n\r\n{LONG}",
            serving.address,
            serving.bearer(),
            LONG.len()
        );
        std::io::Write::write_all(&mut stream, head.as_bytes()).unwrap();
        slow.push(stream);
    }
    std::thread::sleep(Duration::from_millis(300));
    drop(slow);
    let begun = Instant::now();
    assert_eq!(submit(&serving, "plan?timed", SMALL).status, 200);
    assert!(
        begun.elapsed() < Duration::from_secs(10),
        "{:?}",
        begun.elapsed()
    );
}

/// A thousand sweeps may wait, not more; they are listed soon.
#[test]
fn a_thousand_sweeps_wait() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    assert_eq!(submit(&serving, "jobs?name=a", SMALL).status, 201);
    for number in 1..1000 {
        let file = format!("queue/{:06}-a.toml", 100_000 + 10 * number);
        let mu_prime = -0.3 - 1e-4 * f64::from(number);
        fs::write(folder.path().join(file), other(mu_prime)).unwrap();
    }
    let begun = Instant::now();
    let found = jobs(&serving);
    eprintln!("1,000 sweeps are listed in {:?}", begun.elapsed());
    assert_eq!(found.len(), 1000);
    assert!(
        begun.elapsed() < Duration::from_secs(2),
        "{:?}",
        begun.elapsed()
    );
    let begun = Instant::now();
    refused(
        &submit(&serving, "jobs", &other(-0.9)),
        429,
        "1000 sweeps wait",
    );
    eprintln!("and one more is refused in {:?}", begun.elapsed());
    // One that is there is no more.
    assert_eq!(submit(&serving, "jobs", SMALL).status, 200);
    assert_eq!(take_out(&serving, "100000-a").status, 204);
    assert_eq!(submit(&serving, "jobs", &other(-0.9)).status, 201);
}

/// Many at once: each sweep gets a name of its own, and the same sweep is one job.
#[test]
fn sweeps_that_come_at_once_are_put_in_one_by_one() {
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let post = |number: i32| {
        let text = other(-0.3 - 0.01 * f64::from(number / 2));
        submit(&serving, "jobs?name=a", &text).status
    };
    let mut found: Vec<u16> = std::thread::scope(|scope| {
        let posting: Vec<_> = (0..12)
            .map(|number| scope.spawn(move || post(number)))
            .collect();
        posting.into_iter().map(|one| one.join().unwrap()).collect()
    });
    found.sort_unstable();
    assert_eq!(found, [[200; 6], [201; 6]].concat());
    let names: std::collections::BTreeSet<_> =
        jobs(&serving).into_iter().map(|job| job.1).collect();
    assert_eq!(names.len(), 6);
}

/// What lies in the queue cannot end the server, and damaged maps are read by others.
#[test]
fn odd_files_are_survived() {
    let folder = Folder::new();
    let mut serving = Serving::submitting(&folder, &[]);
    assert_eq!(submit(&serving, "jobs?name=a", SMALL).status, 201);
    let at = |name: &str| folder.path().join(name);
    fs::write(at("100070-x.h5"), "\u{89}HDF\r\n\u{1a}\n and no more").unwrap();
    fs::create_dir(at("queue/100020-folder.toml")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", at("queue/100030-zero.toml")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", at("100030-zero.h5")).unwrap();
    fs::create_dir_all(at("100000-a.h5.tiles/1-of-1")).unwrap();
    fs::write(at("100000-a.h5.tiles/1-of-1/manifest.json"), "{").unwrap();
    assert!(
        std::process::Command::new("mkfifo")
            .arg(at("queue/100040-pipe.toml"))
            .status()
            .unwrap()
            .success()
    );
    fs::write(at("100000-a.h5.log"), [0xff; 10_000]).unwrap();
    let found = jobs(&serving);
    assert!(found.len() >= 5, "{found:?}");
    for (_, name) in &found {
        assert_eq!(
            serving.get(&format!("/api/v1/jobs/{name}")).status,
            200,
            "{name}"
        );
    }
    assert_eq!(submit(&serving, "jobs", &other(-0.2)).status, 201);
    assert!(serving.child.try_wait().unwrap().is_none());
    fs::remove_dir_all(at("queue")).unwrap();
    fs::remove_dir_all(at("held")).unwrap();
    assert_eq!(submit(&serving, "jobs", &other(-0.1)).status, 201);
    signal(serving.child.id(), "-INT");
    assert!(serving.child.wait().unwrap().success());
}

/// The command prints both links, and says which is which.
#[test]
fn both_links_are_printed() {
    let folder = Folder::new();
    let started = folder.start(&["serve", "--port", "0", "--submit"]);
    std::thread::sleep(Duration::from_secs(1));
    started.signal("-INT");
    let ended = started.ended();
    let links: Vec<String> = out(&ended).lines().map(str::to_owned).collect();
    assert!(links.len() == 2 && links[0] != links[1], "{links:?}");
    expect(&ended, 0, "the second one only shows");
    expect(&folder.run(&["serve", "--keep-free", "1GB"]), 2, "--submit");
    assert!(!Path::new("queue").exists());
}
