//! `slipmap serve` while much is asked of it: charts beside slow requests, clients that go before
//! their answer comes, and those that only say that they send no more.

#![cfg(target_os = "linux")]

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use crate::alone;
use crate::processes::{cpu, until};
use crate::program::Folder;
use crate::server::Serving;

const POINT: &str = "[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n";
const PLANE: &str = "boundaries = true\n[axes]\nalpha_v = { from = -1.0, to = 0.2, points = 200 }\n\
    tau = { from = 0.0, to = 12.0, points = 200 }\n[fixed]\nmu_prime = -0.3\n";
/// A chart whose cells are motions.
const MOTIONS: &str = "fields = [\"outcome\"]\n[axes]\nv0 = { from = 0.05, to = 0.45, points = 30 }\n\
    tau = { from = 100.0, to = 120.0, points = 30 }\n[fixed]\nalpha_v = -0.33\n\
    [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

/// A chart of fewer motions, which takes some tenths of a second.
fn fewer() -> String {
    MOTIONS.replace("points = 30", "points = 10")
}

/// The text of a request for a critical velocity that takes many seconds; `n` makes it another one.
fn slow_vc(n: u32) -> String {
    format!(
        "[fixed]\nalpha_v = -0.33\ntau = {}\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n\
         v_s = 0.5\n",
        900.0 + f64::from(n)
    )
}

/// The text of a request for a chart of roots that accumulate, which takes many seconds.
const ROOTS: &str = "fields = [\"abscissa\"]\n\
    [axes]\nalpha_v = { from = -1.0, to = 0.2, points = 100 }\n\
    tau = { from = 10.0, to = 1000.0, points = 100 }\n\
    [fixed]\nmu_prime = -0.3\nmemory = 0.97\nlatency = 30\n";
/// A chart of the plane of both gains, whose curves are walked for many seconds.
const GAINS: &str = "boundaries = true\n\
    [axes]\nalpha_v = { from = -1.0, to = 1.0, points = 200 }\n\
    alpha_n = { from = -1.0, to = 1.0, points = 200 }\n\
    [fixed]\nmu_prime = -0.3\ntau = 1000.0\nmemory = 0.97\nlatency = 30\n";

/// The text of a request for a best setting where roots accumulate.
fn best() -> String {
    ROOTS.replace("fields = [\"abscissa\"]", "best = true")
}

/// The bytes of a request.
fn request(serving: &Serving, version: &str, what: &str, text: &str) -> Vec<u8> {
    let head = format!(
        "POST /api/v1/{what} HTTP/{version}\r\nHost: {}\r\nAuthorization: {}\r\n\
         Content-Type: application/toml\r\nContent-Length: {}\r\n\r\n{text}",
        serving.address,
        serving.bearer(),
        text.len()
    );
    head.into_bytes()
}

/// A connection on which somebody waits for an answer.
fn asking(serving: &Serving, what: &str, text: &str) -> TcpStream {
    let mut stream = TcpStream::connect(&serving.address).unwrap();
    let asked = request(serving, "1.1", what, text);
    stream.write_all(&asked).unwrap();
    stream
}

/// Whether nothing has been answered yet.
fn is_waited_for(stream: &mut TcpStream) -> bool {
    stream.set_nonblocking(true).unwrap();
    let read = stream.read(&mut [0; 64]);
    read.is_err_and(|error| error.kind() == ErrorKind::WouldBlock)
}

/// What a connection brings until it is closed.
fn rest(mut stream: impl Read) -> String {
    let mut read = Vec::new();
    drop(stream.read_to_end(&mut read));
    String::from_utf8_lossy(&read).into_owned()
}

/// Waits until the server computes.
fn busy(serving: &Serving) {
    let before = cpu(serving.child.id());
    until(20, "it computes", || {
        cpu(serving.child.id()) > before + Duration::from_millis(100)
    });
}

/// What the server computes ends at most half a second after the last client has gone, by the time
/// that its two threads take: beside other work on the machine that comes later.
fn ends(serving: &Serving, what: &str) {
    let gone = cpu(serving.child.id());
    std::thread::sleep(Duration::from_secs(3));
    let took = cpu(serving.child.id()).saturating_sub(gone);
    assert!(took <= Duration::from_secs(1), "{what}: {took:?}");
    println!("after the client has gone: {took:?} of {what:.20}");
}

/// A chart takes milliseconds, however many critical velocities are waited for.
#[test]
fn charts_do_not_wait_for_critical_velocities() {
    let _alone = alone();
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let mut slow: Vec<_> = (0..4)
        .map(|n| asking(&serving, "vc", &slow_vc(n)))
        .collect();
    busy(&serving);
    let mut took: Vec<Duration> = (0..50)
        .map(|_| {
            let begun = Instant::now();
            assert_eq!(serving.ask("chart", PLANE).status, 200);
            begun.elapsed()
        })
        .collect();
    assert!(slow.iter_mut().all(is_waited_for), "they take that long");
    took.sort_unstable();
    println!(
        "50 charts beside 4 vc: median {:?}, 95 % {:?}",
        took[25], took[47]
    );
    // On a machine that does nothing else it is a tenth of this.
    assert!(took[47] <= Duration::from_millis(200), "{took:?}");
    drop(slow);
    ends(&serving, "four vc");
}

/// Neither do charts of the letter wait for charts of roots beyond it, or of curves that are walked.
#[test]
fn charts_do_not_wait_for_slow_charts() {
    let _alone = alone();
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    for text in [ROOTS, GAINS] {
        let mut slow = [(); 4].map(|()| asking(&serving, "chart", text));
        busy(&serving);
        let begun = Instant::now();
        assert_eq!(serving.ask("chart", PLANE).status, 200);
        let took = begun.elapsed();
        assert!(slow.iter_mut().all(is_waited_for), "they take that long");
        println!("a chart beside 4 slow ones: {took:?}");
        // On a machine that does nothing else it is a tenth of this.
        assert!(took <= Duration::from_secs(2), "{took:?}");
    }
}

/// Whatever is computed ends when its client goes, on all threads.
#[test]
fn what_nobody_waits_for_ends() {
    let _alone = alone();
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    for (what, text) in [("vc", &*slow_vc(0)), ("chart", MOTIONS)] {
        let left = [(); 3].map(|()| asking(&serving, what, text));
        busy(&serving);
        drop(left);
        ends(&serving, what);
    }
    for text in [GAINS, ROOTS, &best()] {
        let mut left = [(); 2].map(|()| asking(&serving, "chart", text));
        busy(&serving);
        assert!(
            left.iter_mut().all(is_waited_for),
            "they take that long: {text}"
        );
        drop(left);
        ends(&serving, text);
    }
    assert_eq!(serving.ask("point", POINT).status, 200);
}

/// A client that closes one half of its connection waits for its answer; it may go later.
#[test]
fn who_only_sends_no_more_is_answered() {
    let _alone = alone();
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    for (version, what, text, asked) in [
        // What is quick is answered before anybody is asked, unless the machine is busy.
        ("1.1", "point", POINT, None),
        ("1.0", "point", POINT, Some(false)),
        ("1.1", "chart", &*fewer(), Some(true)),
        ("1.0", "chart", &*fewer(), Some(false)),
    ] {
        let mut stream = TcpStream::connect(&serving.address).unwrap();
        stream
            .write_all(&request(&serving, version, what, text))
            .unwrap();
        stream.shutdown(Shutdown::Write).unwrap();
        let read = rest(stream);
        let end = format!("HTTP/{version} 200 OK\r\n");
        let before = read.split(&end).next().unwrap();
        assert!(read.contains(&end), "{version} {what}: {read:.200}");
        let was_asked = before.contains("100 Continue");
        assert!(
            asked.is_none_or(|asked| asked == was_asked),
            "{before:.200}"
        );
        assert_eq!(before.replace("HTTP/1.1 100 Continue\r\n\r\n", ""), "");
    }
    let stream = asking(&serving, "vc", &slow_vc(0));
    stream.shutdown(Shutdown::Write).unwrap();
    busy(&serving);
    std::thread::sleep(Duration::from_millis(500));
    busy(&serving);
    drop(stream);
    ends(&serving, "who went after a while");
    // What has not come before that end is missing.
    let mut stream = TcpStream::connect(&serving.address).unwrap();
    let whole = request(&serving, "1.1", "point", POINT);
    stream.write_all(&whole[..whole.len() - 5]).unwrap();
    stream.shutdown(Shutdown::Write).unwrap();
    let read = rest(stream);
    assert!(read.starts_with("HTTP/1.1 400 "), "{read}");
}

/// The same over a socket in the file system, which tunnels use.
#[test]
fn who_goes_from_a_socket_is_missed() {
    let _alone = alone();
    let folder = Folder::new();
    let path = folder.path().join("socket");
    let mut command = folder.command(&["serve", "--threads", "2", "--socket"]);
    let serving = Serving::of(command.arg(&path));
    let asking = |half: bool, what: &str, text: &str| {
        let mut stream = UnixStream::connect(&path).unwrap();
        let asked = request(&serving, "1.1", what, text);
        stream.write_all(&asked).unwrap();
        if half {
            stream.shutdown(Shutdown::Write).unwrap();
        }
        stream
    };
    let read = rest(asking(true, "chart", &fewer()));
    assert!(read.contains("HTTP/1.1 200 OK\r\n"), "{read:.200}");
    for half in [false, true] {
        let left = [(); 2].map(|()| asking(half, "vc", &slow_vc(0)));
        busy(&serving);
        drop(left);
        ends(&serving, "vc over a socket");
    }
}
