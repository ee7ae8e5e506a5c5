//! slipmap as a service on the user's own machine: a page, and the interface that it uses.
//!
//! ```text
//! link with a token → cookie → page → /api/v1/chart, point, vc, motion, law, formula → explore
//!                                  → /api/v1/maps → maps → processes that read files
//!                                  → /api/v1/jobs, plan, events → jobs → queue
//! ```
//!
//! Requests are TOML as in files. Answers are JSON or, for charts, arrays of numbers
//! ([`crate::explore::encoded`]). [`crate::explore`] computes them.
//!
//! - `access`: who may use the server
//! - `api`: addresses and their answers
//! - `asked`: what requests carry
//! - `computed`: requests that are computed on demand
//! - `connections`: how many connections there are, and for how long
//! - `jobs`: sweeps that wait in the folder: handed in, changed, told
//! - `leaving`: whether the client of a request is still there
//! - `maps`: maps from files: a list, and windows on them
//! - `openapi`: the description of the interface
//! - `page`: the page's files, `src/serve/page`, which are part of the program
//! - `patient`: a connection that is closed if the other end does not read in time
//! - `problem`: problems as answers of the server
//! - `room`: memory for answers, until they are sent
//! - `served`: the state that all answers share
//! - `socket`: a socket in the file system, for tunnels
//! - `streamed`: answers whose parts are made one after the other
//! - `work`: computations on few threads, quick ones beside slow ones, for a limited time, ended
//!   when the client has gone

mod access;
mod api;
mod asked;
mod computed;
mod connections;
mod jobs;
mod leaving;
mod maps;
mod openapi;
mod page;
mod patient;
mod problem;
mod room;
mod served;
#[cfg(unix)]
mod socket;
mod streamed;
mod work;

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use access::{Access, Hosts, Role};
use connections::Listener;
use jobs::{Jobs, Submission};
use maps::Maps;
pub use maps::{ReaderCommand, read_map};
use work::Work;

/// Threads that may wait for files and processes.
const BESIDES: usize = 12;

/// Where a server listens.
#[derive(Debug, Clone)]
pub enum Place {
    /// At an address of this machine.
    Address {
        /// The address.
        address: IpAddr,
        /// The port; 0 takes any free one.
        port: u16,
    },
    /// At a socket in the file system, which is created.
    #[cfg(unix)]
    Socket {
        /// Its name.
        path: PathBuf,
        /// The port at which a tunnel to it is expected to begin.
        port: u16,
    },
}

/// The options of a server.
#[derive(Debug, Clone)]
pub struct Serving {
    /// Where it listens.
    pub place: Place,
    /// Number of threads that compute what is quick, and as many for what is slow.
    pub threads: usize,
    /// The folder whose maps are shown.
    pub folder: PathBuf,
    /// How to start a process that reads a map.
    pub reader: ReaderCommand,
    /// Whether sweeps may be handed in, and how many bytes of the disk then stay free.
    pub submit: Option<u64>,
}

/// A bound socket.
#[derive(Debug)]
enum Bound {
    Tcp(TcpListener),
    #[cfg(unix)]
    Unix(std::os::unix::net::UnixListener, socket::Socket),
}

/// A server that is listening.
#[derive(Debug)]
pub struct Server {
    bound: Bound,
    address: SocketAddr,
    access: Arc<Access>,
    threads: usize,
    jobs: Jobs,
}

impl Server {
    /// Listens, with a new token.
    ///
    /// # Errors
    /// When the system gives no such port or socket, or no random numbers.
    pub fn listen(serving: &Serving) -> std::io::Result<Self> {
        let (bound, address, hosts) = match &serving.place {
            &Place::Address { address, port } => {
                let listener = TcpListener::bind((address, port))?;
                listener.set_nonblocking(true)?;
                let bound = listener.local_addr()?;
                let own = address == Ipv4Addr::LOCALHOST || address == Ipv6Addr::LOCALHOST;
                let hosts = match own {
                    true => Hosts::Own(bound.port()),
                    false => Hosts::And(address, bound.port()),
                };
                (Bound::Tcp(listener), bound, hosts)
            }
            #[cfg(unix)]
            Place::Socket { path, port } => {
                let (socket, listener) = socket::Socket::listen(path)?;
                listener.set_nonblocking(true)?;
                let bound = Bound::Unix(listener, socket);
                (bound, (Ipv4Addr::LOCALHOST, *port).into(), Hosts::Tunnel)
            }
        };
        let maps = Arc::new(Maps::below(&serving.folder, serving.reader.clone()));
        let submission = Submission {
            keep_free: serving.submit,
            threads: serving.threads,
        };
        Ok(Self {
            bound,
            address,
            access: Arc::new(Access::new(hosts)?),
            threads: serving.threads,
            jobs: Jobs::of(&serving.folder, submission, maps)?,
        })
    }

    /// The link that opens the page; whoever has it may use the server. For a socket it leads to
    /// the near end of a tunnel.
    #[must_use]
    pub fn link(&self) -> String {
        self.link_of(Role::Any)
    }

    /// The link for those who may only look.
    #[must_use]
    pub fn link_to_look(&self) -> String {
        self.link_of(Role::Look)
    }

    fn link_of(&self, role: Role) -> String {
        let mut address = self.address;
        if address.ip().is_unspecified() {
            // The server listens at all addresses; a browser on this machine can use this one.
            address.set_ip(Ipv4Addr::LOCALHOST.into());
        }
        format!("http://{address}/?token={}", self.access.token(role))
    }

    /// Answers until `stopped` is true.
    ///
    /// # Errors
    /// When the system cannot start threads.
    pub fn run(self, stopped: impl Fn() -> bool + Send + 'static) -> std::io::Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(work::most(self.threads) + BESIDES)
            .enable_all()
            .build()?;
        let work = Work::new(self.threads);
        let maps = Arc::clone(&self.jobs.maps);
        let app = api::routes(self.access, work, self.jobs);
        let ended = runtime.block_on(async move {
            let (listener, _socket) = self.bound.listener()?;
            let until = async move {
                while !stopped() {
                    tokio::time::sleep(work::PAUSE).await;
                }
            };
            tokio::select! {
                () = connections::answer(listener, app) => {}
                () = until => {}
            }
            Ok(())
        });
        maps.close();
        // Running computations are told to stop, but not waited for.
        runtime.shutdown_background();
        ended
    }
}

/// The name of a socket; dropping it removes the socket.
#[cfg(unix)]
type Named = Option<socket::Socket>;
#[cfg(not(unix))]
type Named = ();

impl Bound {
    /// The listener of the runtime.
    fn listener(self) -> std::io::Result<(Listener, Named)> {
        match self {
            Self::Tcp(listener) => {
                let listener = tokio::net::TcpListener::from_std(listener)?;
                Ok((Listener::Tcp(listener), Named::default()))
            }
            #[cfg(unix)]
            Self::Unix(listener, socket) => {
                let listener = tokio::net::UnixListener::from_std(listener)?;
                Ok((Listener::Unix(listener), Some(socket)))
            }
        }
    }
}
