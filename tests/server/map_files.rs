//! The file of a map over real connections, whole and in ranges.

use std::fs;

use crate::jobs::SMALL;
use crate::program::{Folder, expect};
use crate::server::{Answer, Serving};

fn header<'a>(answer: &'a Answer, name: &str) -> Option<&'a str> {
    let mut lines = answer.head.lines().filter_map(|line| line.split_once(": "));
    lines.find_map(|(of, value)| (of == name).then_some(value))
}

/// A server with a map, and the bytes of its file.
struct Shown {
    folder: Folder,
    serving: Serving,
    maps: serde_json::Value,
    bytes: Vec<u8>,
}

impl Shown {
    fn new() -> Self {
        let folder = Folder::with(&[("a.toml", SMALL), ("damaged.h5", "no map")]);
        expect(&folder.run(&["run", "a.toml"]), 0, "");
        let serving = Serving::new(&folder);
        Self {
            bytes: fs::read(folder.path().join("a.h5")).unwrap(),
            maps: serving.get("/api/v1/maps").json(),
            folder,
            serving,
        }
    }

    /// The address of the file of a map.
    fn path(&self, name: &str) -> String {
        let mut maps = self.maps["maps"].as_array().unwrap().iter();
        let map = maps.find(|map| map["name"] == name).unwrap();
        format!("/api/v1/maps/{}/file", map["id"].as_str().unwrap())
    }

    fn ask(&self, method: &str, more: &[(&str, &str)]) -> Answer {
        let bearer = self.serving.bearer();
        let headers = [&[("Authorization", &*bearer)], more].concat();
        let line = format!("{method} {}", self.path("a.h5"));
        self.serving.request(&line, &headers, "")
    }
}

#[test]
fn the_whole_file_is_sent() {
    let shown = Shown::new();
    let whole = shown.ask("GET", &[]);
    assert!(whole.status == 200 && whole.body == shown.bytes);
    let length = shown.bytes.len().to_string();
    for (name, value) in [
        ("accept-ranges", "bytes"),
        ("content-type", "application/x-hdf5"),
        ("content-disposition", "attachment; filename=\"a.h5\""),
        ("cache-control", "no-store"),
        ("content-length", &length),
    ] {
        assert_eq!(header(&whole, name), Some(value));
    }
    let head = shown.ask("HEAD", &[("Range", "bytes=0-99")]);
    assert_eq!((head.status, head.body.len()), (206, 0));
    assert_eq!(header(&head, "content-length"), Some("100"));
    for all in ["bytes=0-1,5-6", "lines=1-2", "bytes=5-2"] {
        let answer = shown.ask("GET", &[("Range", all)]);
        assert!(answer.status == 200 && answer.body == shown.bytes, "{all}");
    }
}

#[test]
fn ranges_of_a_file_are_its_bytes() {
    let shown = Shown::new();
    let (bytes, length) = (&shown.bytes, shown.bytes.len());
    let head = shown.ask("HEAD", &[]);
    let tag = header(&head, "etag").unwrap();
    for (range, of) in [
        ("bytes=0-99".to_owned(), 0..100),
        ("bytes=1000-".into(), 1000..length),
        ("bytes=-100".into(), length - 100..length),
        (
            format!("bytes={}-{}", length - 1, 2 * length),
            length - 1..length,
        ),
    ] {
        let range = ("Range", &*range);
        for more in [&[range][..], &[range, ("If-Range", tag)]] {
            let part = shown.ask("GET", more);
            assert!(
                part.status == 206 && part.body == bytes[of.clone()],
                "{range:?}"
            );
            let told = format!("bytes {}-{}/{length}", of.start, of.end - 1);
            assert_eq!(header(&part, "content-range"), Some(&*told));
        }
        let other = shown.ask("GET", &[range, ("If-Range", "\"other\"")]);
        assert!(other.status == 200 && other.body == *bytes);
    }
    let behind = shown.ask("GET", &[("Range", &format!("bytes={length}-"))]);
    assert_eq!(behind.status, 416);
    let told = format!("bytes */{length}");
    assert_eq!(header(&behind, "content-range"), Some(&*told));
    assert!(behind.json()["detail"].is_string());
}

/// A map in the place of another one has another tag; a range of the old one is not mixed with it.
#[test]
fn a_file_that_is_replaced_is_another_one() {
    let shown = Shown::new();
    let head = shown.ask("HEAD", &[]);
    let tag = header(&head, "etag").unwrap();
    let at = |name: &str| shown.folder.path().join(name);
    fs::write(at("a.toml"), SMALL.replace("-0.3", "-0.2")).unwrap();
    fs::remove_file(at("a.h5")).unwrap();
    expect(&shown.folder.run(&["run", "a.toml"]), 0, "");
    let replaced = fs::read(at("a.h5")).unwrap();
    // The folder was looked at before.
    std::thread::sleep(std::time::Duration::from_millis(1200));
    let part = shown.ask("GET", &[("Range", "bytes=0-99"), ("If-Range", tag)]);
    assert!(part.status == 200 && part.body == replaced && replaced != shown.bytes);
}

#[test]
fn what_is_no_complete_map_is_not_sent() {
    let shown = Shown::new();
    for (path, status) in [
        (shown.path("damaged.h5"), 409),
        ("/api/v1/maps/0123456789abcdef/file".into(), 404),
        ("/api/v1/maps/..%2Fa.h5/file".into(), 404),
    ] {
        assert_eq!(shown.serving.get(&path).status, status, "{path}");
    }
    let line = format!("GET {}", shown.path("a.h5"));
    assert_eq!(shown.serving.request(&line, &[], "").status, 401);
}
