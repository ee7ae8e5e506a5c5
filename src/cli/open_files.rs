//! The limit of open files of this process.

/// Raises the soft limit of open files to the hard limit: a merge has one file of every shard open.
/// If the system refuses, the limit stays, and opening too many files fails.
pub(super) fn as_many_as_allowed() {
    #[cfg(unix)]
    {
        let mut limit = libc::rlimit {
            rlim_cur: 0,
            rlim_max: 0,
        };
        // SAFETY: the limit is live during both calls.
        unsafe {
            if libc::getrlimit(libc::RLIMIT_NOFILE, &raw mut limit) == 0 {
                limit.rlim_cur = limit.rlim_max;
                // macOS refuses more than this, whatever hard limit it reports.
                #[cfg(target_os = "macos")]
                {
                    // OPEN_MAX from its headers, which libc lacks.
                    limit.rlim_cur = limit.rlim_cur.min(10_240);
                }
                libc::setrlimit(libc::RLIMIT_NOFILE, &raw const limit);
            }
        }
    }
}
