//! The page without a server: its folder is made, and its WebAssembly answers in Node as the
//! library does here, byte by byte.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use serde_json::json;
use slipmap::explore::{Limits, Request, answer};

const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const CONTROL: &str = "[fixed]\nalpha_v = -0.33\ntau = 4.15\n";

/// The folder, made once.
fn page() -> &'static Path {
    static PAGE: OnceLock<PathBuf> = OnceLock::new();
    PAGE.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("static-page");
        drop(std::fs::remove_dir_all(&folder));
        let made = Command::new("scripts/static-page.sh").arg(&folder).output();
        let made = made.unwrap();
        let says = String::from_utf8_lossy(&made.stderr);
        assert!(made.status.success(), "{says}");
        folder
    })
}

fn node(args: &[&Path]) {
    let told = Command::new("node").args(args).output().unwrap();
    let says = String::from_utf8_lossy(&told.stderr);
    assert!(told.status.success(), "{says}");
}

/// Everything that a page asks, with what is wrong among it.
fn requests() -> Vec<(Request, String)> {
    let plane = |head: &str, x: &str, fixed: &str| {
        format!(
            "{head}boundaries = true\n[axes]\n{x}\ntau = {{ from = 0.0, to = 12.0, points = 300 }}\n\
            [fixed]\n{fixed}\n"
        )
    };
    let gain = "alpha_v = { from = -1.0, to = 0.2, points = 400 }";
    let load = "alpha_n = { from = -4.0, to = 4.0, points = 300 }";
    let roots = "fields = [\"n_unstable\", \"abscissa\", \"frequency\", \"delay_margin\"]\n";
    let coarse = gain.replace("400", "20");
    let case = include_str!("../../sweeps/fig3a.toml").to_owned();
    let vcs = "fields = [\"vc\"]\n[axes]\ntau = [0.5, 4.15]\n";
    vec![
        (Request::Chart, plane("", gain, "mu_prime = -0.3")),
        (
            Request::Chart,
            plane("", load, "mu_prime = -0.7\nmu_k = 0.6\nalpha_v = 0.1"),
        ),
        (
            Request::Chart,
            plane(roots, &coarse, "mu_prime = -0.3\nalpha_n = 0.2"),
        ),
        (
            Request::Chart,
            format!("{vcs}[fixed]\nalpha_v = -0.33\n{LAW}"),
        ),
        (Request::Chart, plane("", gain, "mu_prime = nan")),
        (Request::Point, format!("{CONTROL}mu_prime = -0.3\n")),
        (
            Request::Point,
            format!("{CONTROL}v0 = 0.35\nmass = 0.1\n{LAW}"),
        ),
        (Request::Point, format!("{CONTROL}\n")),
        (Request::CriticalVelocity, format!("{CONTROL}{LAW}")),
        (
            Request::CriticalVelocity,
            format!("[fixed]\nalpha_n = -10\ntau = 0.5\n{LAW}"),
        ),
        (Request::Motion, case.clone()),
        (
            Request::Motion,
            case.replace("[trace]", "[trace]\ninterval = 1e-6"),
        ),
        (Request::Law, LAW.into()),
        (Request::Parameters, String::new()),
    ]
}

/// An answer without the time that it took.
fn timeless(request: Request, bytes: &[u8]) -> (serde_json::Value, Vec<u8>) {
    if request != Request::Chart {
        return (serde_json::Value::Null, bytes.to_vec());
    }
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    let mut head: serde_json::Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    head["milliseconds"].take();
    (head, bytes[(4 + length).next_multiple_of(8)..].to_vec())
}

#[test]
fn the_static_page_answers_as_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let asked: Vec<_> = requests()
        .iter()
        .map(|(request, text)| json!({ "name": request.name(), "text": text }))
        .collect();
    let list = folder.path().join("requests.json");
    std::fs::write(&list, serde_json::to_vec(&asked).unwrap()).unwrap();
    let answers = Path::new("tests/static_page/answers.mjs");
    node(&[answers, page(), &list, folder.path()]);
    let mut found = [0; 2];
    for (i, (request, text)) in requests().into_iter().enumerate() {
        let bytes = std::fs::read(folder.path().join(i.to_string())).unwrap();
        let status = std::fs::read_to_string(folder.path().join(format!("{i}.status"))).unwrap();
        let status = status.split(' ').next().unwrap().to_owned();
        let here = answer(
            request,
            &text,
            &Limits::default(),
            &Arc::new(AtomicBool::new(false)),
        );
        match here {
            Ok(here) => {
                assert_eq!(status, "200", "{text}");
                let [(head, arrays), (other, there)] =
                    [&here, &bytes].map(|bytes| timeless(request, bytes));
                assert_eq!(head, other, "{text}");
                assert!(arrays == there, "{request:?} {text}");
                found[0] += 1;
            }
            Err(problem) => {
                assert_eq!(status, problem.status.to_string());
                let there: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
                assert_eq!(serde_json::to_value(problem).unwrap(), there);
                found[1] += 1;
            }
        }
    }
    assert_eq!(found, [requests().len() - 2, 2]);
}

#[test]
fn the_static_page_asks_one_thing_at_a_time() {
    node(&[Path::new("tests/static_page/source.mjs"), page()]);
}

#[test]
fn the_static_page_says_that_there_is_no_server() {
    let front = std::fs::read_to_string(page().join("index.html")).unwrap();
    let own = std::fs::read_to_string("src/serve/page/index.html").unwrap();
    let added: Vec<_> = front
        .lines()
        .filter(|line| !own.lines().any(|other| other == *line))
        .collect();
    let [marker, policy] = added[..] else {
        panic!("{added:?}")
    };
    assert!(marker.contains("slipmap-source") && policy.contains("'wasm-unsafe-eval'"));
    assert!(front.starts_with("<!doctype html>") && front.ends_with("</html>\n"));
    for file in std::fs::read_dir("src/serve/page").unwrap() {
        assert!(page().join(file.unwrap().file_name()).exists());
    }
}
