//! Limits on memory that the system sets, such as those of `ulimit -v`: memory that it refuses ends
//! the program with a message.

use std::alloc::{GlobalAlloc, Layout, System};

/// The allocator of the system. Where it has no memory left, the program ends with exit code 1: all
/// that is written is complete, and the next run goes on.
pub struct Refusing;

// SAFETY: every call is passed on as it is, and a result is passed back, unless the process ends.
unsafe impl GlobalAlloc for Refusing {
    #[inline]
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of `System`.
        given(unsafe { System.alloc(layout) })
    }

    #[inline]
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) };
    }

    #[inline]
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.alloc_zeroed(layout) })
    }

    #[inline]
    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.realloc(at, layout, size) })
    }
}

#[inline]
fn given(at: *mut u8) -> *mut u8 {
    if at.is_null() {
        end();
    }
    at
}

/// Ends the process without taking memory.
#[cold]
fn end() -> ! {
    const MESSAGE: &[u8] = b"error: the system refuses more memory\n  \
        help: fewer --threads take less; `ulimit -v` shows the limit of a shell, `slipmap plan` \
        what a run may take\n";
    #[cfg(unix)]
    // SAFETY: the message lives, and ending the process runs no code of it.
    unsafe {
        libc::write(libc::STDERR_FILENO, MESSAGE.as_ptr().cast(), MESSAGE.len());
        libc::_exit(1)
    }
    #[cfg(not(unix))]
    {
        let _ = MESSAGE;
        std::process::abort()
    }
}

/// The limit on the address space of this process, in bytes; none without one.
#[cfg(unix)]
fn limit() -> Option<u64> {
    let mut limit = libc::rlimit {
        rlim_cur: 0,
        rlim_max: 0,
    };
    // SAFETY: the limit is live during the call.
    let asked = unsafe { libc::getrlimit(libc::RLIMIT_AS, &raw mut limit) };
    let limited = asked == 0 && limit.rlim_cur != libc::RLIM_INFINITY;
    #[allow(
        clippy::useless_conversion,
        clippy::unnecessary_fallible_conversions,
        reason = "limits have 32 bits on some systems"
    )]
    let bytes = u64::try_from(limit.rlim_cur).ok();
    bytes.filter(|_| limited)
}

#[cfg(not(unix))]
fn limit() -> Option<u64> {
    None
}

/// Prepares the process for a limit on its address space, if there is one: its threads then share
/// one heap, as each heap of its own would reserve 64 MiB or more.
pub(super) fn prepare() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    if limit().is_some() {
        // SAFETY: the call takes numbers alone; no other thread runs yet.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// The bytes of address space that this process may still take; none without a limit.
pub(super) fn left() -> Option<u64> {
    let limit = limit()?;
    let taken = std::fs::read_to_string("/proc/self/statm").ok();
    let pages = taken.and_then(|text| text.split(' ').next()?.parse::<u64>().ok());
    Some(limit.saturating_sub(pages.unwrap_or(0).saturating_mul(page())))
}

/// The bytes of a page of memory.
#[cfg(unix)]
pub(super) fn page() -> u64 {
    // SAFETY: the call takes a number alone.
    let size = unsafe { libc::sysconf(libc::_SC_PAGESIZE) };
    u64::try_from(size).unwrap_or(4096)
}

#[cfg(not(unix))]
pub(super) fn page() -> u64 {
    4096
}
