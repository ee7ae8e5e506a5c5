//! `slipmap serve`: the page in a browser.

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempPath;

use crate::queue::room::KEEP_FREE;
use crate::serve::{Place, ReaderCommand, Server, Serving};

use super::failure::Failure;
use super::memory;
use super::read_map;
use super::run::default_threads;
use super::say;
use super::signals::Signals;

/// The default port.
const DEFAULT_PORT: u16 = 8417;
/// The program that opens a link in a browser.
const OPENER: &str = if cfg!(target_os = "macos") {
    "open"
} else {
    "xdg-open"
};

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: slipmap serve maps --open\n          \
    slipmap serve maps --submit, and slipmap work maps elsewhere\n          \
    slipmap serve --socket ~/slipmap.sock, and ssh -L 8417:/home/me/slipmap.sock HOST elsewhere")]
pub(super) struct Args {
    /// Folder whose maps are shown, and those of the folders in it
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// Port on this machine; 0 takes any free one. With --socket: where the tunnel begins
    #[arg(long, value_name = "N", default_value_t = DEFAULT_PORT)]
    port: u16,
    /// Listen on a new socket of this name instead, for `ssh -L`
    #[cfg(unix)]
    #[arg(long, value_name = "PATH", conflicts_with_all = ["address", "open"])]
    socket: Option<PathBuf>,
    /// Open the link in a browser
    #[arg(long)]
    open: bool,
    /// Listen on this address instead of this machine's own: others can then reach the server
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    address: IpAddr,
    /// Threads for quick requests, and as many for slow ones [default: all that this process may
    /// use]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Take sweeps and put them into the queue of the folder, for `slipmap work`. A second link is
    /// for who may only look
    #[arg(long)]
    submit: bool,
    /// Bytes of the disk that stay free; a sweep that may need them is refused
    #[arg(long, value_name = "SIZE", requires = "submit", default_value = KEEP_FREE,
          value_parser = memory::parse)]
    keep_free: u64,
}

impl Args {
    fn place(&self) -> Place {
        #[cfg(unix)]
        if let Some(path) = self.socket.clone() {
            let port = if self.port == 0 {
                DEFAULT_PORT
            } else {
                self.port
            };
            return Place::Socket { path, port };
        }
        Place::Address {
            address: self.address,
            port: self.port,
        }
    }

    /// The failure of a server that cannot listen.
    fn refused(&self, error: &std::io::Error) -> Failure {
        match self.place() {
            Place::Address { address, port } => Failure::bad_input_with_help(
                format!("cannot listen on port {port} of {address}: {error}"),
                "--port 0 takes any free one",
            ),
            #[cfg(unix)]
            Place::Socket { path, .. } => {
                Failure::bad_input(format!("cannot listen on {}: {error}", path.display()))
            }
        }
    }

    /// Reports who may use the server, and how.
    fn tell(&self) {
        match self.place() {
            #[cfg(unix)]
            Place::Socket { path, port } => say::note(format_args!(
                "on the machine with the browser: ssh -L {port}:{} HOST, then open the link; \
                Ctrl-C ends the server",
                std::path::absolute(&path).unwrap_or(path).display()
            )),
            Place::Address { address, .. } if !address.is_loopback() => say::remark(format_args!(
                "warning: everyone who can reach {address} and has this link may use the server \
                and see its maps, and what is sent is not encrypted; Ctrl-C ends it"
            )),
            Place::Address { .. } if self.submit => {
                say::note("whoever has these links may use the server; Ctrl-C ends it");
            }
            Place::Address { .. } => {
                say::note("whoever has this link may use the server; Ctrl-C ends it");
            }
        }
        if self.submit {
            say::note(format_args!(
                "with the first link sweeps can be handed in, the second one only shows; \
                `slipmap work {}` computes them",
                self.folder.display()
            ));
        }
    }
}

/// A file, readable by this user alone, that leads a browser to a link. On a command line, all
/// users of the machine would see the link.
fn leading_to(link: &str) -> std::io::Result<TempPath> {
    let named = tempfile::Builder::new()
        .prefix("slipmap-")
        .suffix(".html")
        .tempfile();
    let mut file = named?;
    write!(
        file,
        "<!doctype html><meta charset=\"utf-8\"><title>slipmap</title>\
        <meta http-equiv=\"refresh\" content=\"0; url={link}\"><a href=\"{link}\">slipmap</a>"
    )?;
    Ok(file.into_temp_path())
}

/// Opens a file in a browser. If that fails, the user can open the link.
fn open(file: &Path) {
    let mut command = Command::new(OPENER);
    command.arg(file).stdin(Stdio::null());
    match command.stdout(Stdio::null()).stderr(Stdio::null()).spawn() {
        Ok(mut child) => {
            std::thread::spawn(move || match child.wait() {
                Ok(ended) if ended.success() => {}
                _ => say::remark(format_args!(
                    "{OPENER} did not open the link, open it by hand"
                )),
            });
        }
        Err(error) => say::remark(format_args!(
            "cannot run {OPENER} to open the link: {error}"
        )),
    }
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    if !args.folder.is_dir() {
        let folder = args.folder.display();
        return Err(Failure::bad_input(format!("{folder} is no folder")));
    }
    let serving = Serving {
        place: args.place(),
        threads: args.threads.map_or_else(default_threads, usize::from),
        folder: args.folder.clone(),
        reader: ReaderCommand {
            program: std::env::current_exe()?,
            arguments: vec![read_map::NAME.into()],
        },
        submit: args.submit.then_some(args.keep_free),
    };
    let server = Server::listen(&serving).map_err(|error| args.refused(&error))?;
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", server.link())?;
    if args.submit {
        writeln!(out, "{}", server.link_to_look())?;
    }
    drop(out);
    args.tell();
    let leading = args.open.then(|| leading_to(&server.link()));
    match &leading {
        Some(Ok(file)) => open(file),
        Some(Err(error)) => say::remark(format_args!(
            "no file can be made that leads a browser to the link, open it by hand: {error}"
        )),
        None => {}
    }
    let stop = std::sync::Arc::clone(&signals.stop);
    server.run(move || stop.load(std::sync::atomic::Ordering::Relaxed))?;
    Ok(())
}
