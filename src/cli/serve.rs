//! `slipmap serve`: the page in a browser.

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use slipmap::serve::{ReaderCommand, Server, Serving};

use super::failure::Failure;
use super::read_map;
use super::run::default_threads;
use super::say;
use super::signals::Signals;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap serve --port 0")]
pub(super) struct Args {
    /// Folder whose maps are shown, and those of the folders in it
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// Port on this machine; 0 takes any free one
    #[arg(long, value_name = "N", default_value_t = 8417)]
    port: u16,
    /// Threads that compute [default: all that this process may use]
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let serving = Serving {
        address: IpAddr::V4(Ipv4Addr::LOCALHOST),
        port: args.port,
        threads: args.threads.map_or_else(default_threads, usize::from),
        folder: args.folder.clone(),
        reader: ReaderCommand {
            program: std::env::current_exe()?,
            arguments: vec![read_map::NAME.into()],
        },
    };
    let server = Server::listen(&serving).map_err(|error| {
        Failure::bad_input_with_help(
            format!("cannot listen on port {}: {error}", args.port),
            "--port 0 takes any free one",
        )
    })?;
    writeln!(std::io::stdout().lock(), "{}", server.link())?;
    say::remark("whoever has this link may use the server; Ctrl-C ends it");
    let stop = std::sync::Arc::clone(&signals.stop);
    server.run(move || stop.load(std::sync::atomic::Ordering::Relaxed))?;
    Ok(())
}
