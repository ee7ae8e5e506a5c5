//! `slipmap read-map`: a process of `slipmap serve` that reads one map.

use std::path::PathBuf;

use signal_hook::low_level;

use super::failure::Failure;

/// The name of the subcommand.
pub(super) const NAME: &str = "read-map";
/// Address space that such a process may use: damaged files can ask for much.
#[cfg(unix)]
const MOST_MEMORY: libc::rlim_t = 2 << 30;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    limit();
    let input = std::io::stdin().lock();
    let read = slipmap::serve::read_map(&args.map, input, std::io::stdout());
    // Not by way of the hooks at exit: the HDF5 library would close what is being read.
    low_level::exit(i32::from(read.is_err()))
}

/// Little memory, and no image of it where it crashes. Where the system refuses, it goes on
/// without.
fn limit() {
    #[cfg(unix)]
    for (resource, most) in [(libc::RLIMIT_AS, MOST_MEMORY), (libc::RLIMIT_CORE, 0)] {
        let mut limit = libc::rlimit {
            rlim_cur: 0,
            rlim_max: 0,
        };
        // SAFETY: the limit is live during both calls.
        unsafe {
            if libc::getrlimit(resource, &raw mut limit) == 0 {
                limit.rlim_cur = most.min(limit.rlim_max);
                libc::setrlimit(resource, &raw const limit);
            }
        }
    }
}
