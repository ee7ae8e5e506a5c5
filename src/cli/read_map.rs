//! `slipmap read-map`: a process of `slipmap serve` that reads one map.

use std::path::PathBuf;

use signal_hook::low_level;

use super::failure::Failure;

/// The name of the subcommand.
pub(super) const NAME: &str = "read-map";
/// The address space of this process: a damaged file can ask for much memory.
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
    let read = crate::serve::read_map(&args.map, input, std::io::stdout());
    // Exit without exit hooks: with them the HDF5 library would close what is being read.
    low_level::exit(i32::from(read.is_err()))
}

/// Limits the memory and disables core dumps. If the system refuses, the process continues without
/// limits.
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
