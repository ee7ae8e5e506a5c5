//! The limit of open files of this process.

/// Raises the limit that a user gives to programs to the one that the system gives to users: a
/// merge holds one file of every shard. Where the system refuses, the limit stays, and opening one
/// more says so.
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
                // macOS refuses more than this, whatever it tells of users.
                #[cfg(target_os = "macos")]
                {
                    // OPEN_MAX of its headers, which libc does not have.
                    limit.rlim_cur = limit.rlim_cur.min(10_240);
                }
                libc::setrlimit(libc::RLIMIT_NOFILE, &raw const limit);
            }
        }
    }
}
