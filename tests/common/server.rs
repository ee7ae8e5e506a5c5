//! A server of the real program, and requests to it.

#![allow(dead_code, reason = "no test uses all of it")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStdout, Stdio};
use std::time::Duration;

use super::program::{Folder, LONGEST, ends_within};

/// A server of the real program.
pub(crate) struct Serving {
    pub child: Child,
    out: BufReader<ChildStdout>,
    pub address: String,
    pub token: String,
    /// The token of who may only look, where there is one.
    pub token_to_look: Option<String>,
}

impl Drop for Serving {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// What came back.
pub(crate) struct Answer {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).unwrap()
    }
}

impl Serving {
    pub(crate) fn new(folder: &Folder) -> Self {
        Self::with(folder, &[])
    }

    /// With more arguments.
    pub(crate) fn with(folder: &Folder, more: &[&str]) -> Self {
        let usual = ["serve", "--port", "0", "--threads", "2"];
        Self::of(&mut folder.command(&[&usual, more].concat()))
    }

    /// One that takes sweeps.
    pub(crate) fn submitting(folder: &Folder, more: &[&str]) -> Self {
        let mut serving = Self::with(folder, &[&["--submit"], more].concat());
        let (address, token) = link(&mut serving.out);
        assert_eq!(address, serving.address);
        serving.token_to_look = Some(token);
        serving
    }

    /// By a command.
    pub(crate) fn of(command: &mut std::process::Command) -> Self {
        command.stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = ends_within(command, LONGEST).spawn().unwrap();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let (address, token) = link(&mut out);
        Self {
            address,
            token,
            token_to_look: None,
            child,
            out,
        }
    }

    /// Sends bytes and reads until the server closes the connection.
    pub(crate) fn send(&self, bytes: &[u8]) -> Answer {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(30)))
            .unwrap();
        // A server that refuses early may close before it has read all.
        drop(stream.write_all(bytes));
        let mut read = Vec::new();
        drop(stream.read_to_end(&mut read));
        let end = read
            .windows(4)
            .position(|w| w == b"\r\n\r\n")
            .unwrap_or(read.len());
        let head = String::from_utf8_lossy(&read[..end]).into_owned();
        let status = head.split(' ').nth(1).and_then(|code| code.parse().ok());
        Answer {
            status: status.unwrap_or(0),
            body: read.get(end + 4..).unwrap_or_default().to_vec(),
            head,
        }
    }

    pub(crate) fn request(&self, line: &str, headers: &[(&str, &str)], body: &str) -> Answer {
        let mut text = format!("{line} HTTP/1.1\r\nConnection: close\r\n");
        if !headers.iter().any(|(name, _)| *name == "Host") {
            text += &format!("Host: {}\r\n", self.address);
        }
        for (name, value) in headers {
            text += &format!("{name}: {value}\r\n");
        }
        text += &format!("Content-Length: {}\r\n\r\n{body}", body.len());
        self.send(text.as_bytes())
    }

    pub(crate) fn bearer(&self) -> String {
        format!("Bearer {}", self.token)
    }

    /// What is at an address, for who has the token.
    pub(crate) fn get(&self, path: &str) -> Answer {
        let bearer = self.bearer();
        self.request(&format!("GET {path}"), &[("Authorization", &bearer)], "")
    }

    /// A request for what a text describes, by who has the token.
    pub(crate) fn ask(&self, what: &str, toml: &str) -> Answer {
        let bearer = self.bearer();
        let headers = [
            ("Authorization", &*bearer),
            ("Content-Type", "application/toml"),
        ];
        self.request(&format!("POST /api/v1/{what}"), &headers, toml)
    }
}

/// The address and the token of a link, a line of its own.
fn link(out: &mut impl BufRead) -> (String, String) {
    let mut line = String::new();
    out.read_line(&mut line).unwrap();
    let link = line.trim().strip_prefix("http://").unwrap();
    let (address, token) = link.split_once("/?token=").unwrap();
    (address.to_owned(), token.to_owned())
}

/// The head of an answer in bytes, and its arrays.
pub(crate) fn decoded(body: &[u8]) -> (serde_json::Value, &[u8]) {
    let length = u32::from_le_bytes(body[..4].try_into().unwrap()) as usize;
    let head = serde_json::from_slice(&body[4..4 + length]).unwrap();
    (head, &body[(4 + length).next_multiple_of(8)..])
}
