//! slipmap as a service on one's own machine: a page, and the interface that it uses.
//!
//! ```text
//! link with a token → cookie → page → /api/v1/chart, point, vc, motion, law → explore
//! ```
//!
//! Requests are TOML as in files, answers JSON or, for charts, arrays of numbers
//! ([`crate::explore::encoded`]). What is computed is [`crate::explore`]'s.

mod access;
mod api;
mod computed;
mod maps;
mod openapi;
mod page;
mod problem;
mod served;
mod work;

use std::net::{IpAddr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use access::Access;
use maps::Maps;
pub use maps::{ReaderCommand, read_map};
use work::Work;

/// What a server is asked to do.
#[derive(Debug, Clone)]
pub struct Serving {
    /// The address that it listens on.
    pub address: IpAddr,
    /// The port; 0 takes any free one.
    pub port: u16,
    /// Threads that compute.
    pub threads: usize,
    /// The folder whose maps are shown.
    pub folder: PathBuf,
    /// How to start a process that reads a map.
    pub reader: ReaderCommand,
}

/// A server that listens already.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    access: Arc<Access>,
    threads: usize,
    maps: Arc<Maps>,
}

impl Server {
    /// Listens, with a new token.
    ///
    /// # Errors
    /// When the system gives no such port, or no random numbers.
    pub fn listen(serving: &Serving) -> std::io::Result<Self> {
        let listener = TcpListener::bind((serving.address, serving.port))?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        Ok(Self {
            listener,
            address,
            access: Arc::new(Access::new(address.port())?),
            threads: serving.threads,
            maps: Arc::new(Maps::below(&serving.folder, serving.reader.clone())),
        })
    }

    /// The link that opens the page; whoever has it may use the server.
    #[must_use]
    pub fn link(&self) -> String {
        format!("http://{}/?token={}", self.address, self.access.token())
    }

    /// Answers until `stopped` says so, and the requests that are under way have their answers.
    ///
    /// # Errors
    /// When the system gives no threads, or ends the connection.
    pub fn run(self, stopped: impl Fn() -> bool + Send + 'static) -> std::io::Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(self.threads + 6)
            .enable_all()
            .build()?;
        let work = Work::new(self.threads);
        let app = api::routes(self.access, work, self.maps);
        let ended = runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let until = async move {
                while !stopped() {
                    tokio::time::sleep(work::PAUSE).await;
                }
            };
            tokio::select! {
                served = axum::serve(listener, app) => served,
                () = until => Ok(()),
            }
        });
        // What still computes is told to stop, and not waited for.
        runtime.shutdown_background();
        ended
    }
}
