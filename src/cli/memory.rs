//! The memory that a run may take, and the threads that stay within it.

use std::path::Path;

use bytesize::ByteSize;

use crate::report::numbers::bytes;
use crate::sweep::{Memory, Plan};

use super::failure::Failure;
use super::{address_space, cgroup};

/// The least that a run takes by default, in bytes; all but the longest delays do with it.
const LEAST: u64 = 500_000_000;

/// Reads the bytes of a `--memory` flag.
pub(super) fn parse(text: &str) -> Result<u64, String> {
    text.parse::<ByteSize>()
        .map(|size| size.as_u64())
        .map_err(|_| "expected a size such as 500MB or 2GiB".to_owned())
}

/// The memory that a run may take, and who says so.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowed {
    /// In bytes.
    pub bytes: u64,
    by: By,
}

#[derive(Debug, Clone, Copy)]
enum By {
    Flag,
    Default,
    System,
}

impl Allowed {
    /// What `--memory` allows, or the default where it is not given, shared by so many runs. It is
    /// never more than the address space that is left.
    pub(super) fn of(flag: Option<u64>, sharers: u64) -> Self {
        let (asked, by) = match flag {
            Some(bytes) => (bytes, By::Flag),
            None => (default_memory(sharers), By::Default),
        };
        match address_space::left().filter(|left| *left < asked) {
            Some(bytes) => Self {
                bytes,
                by: By::System,
            },
            None => Self { bytes: asked, by },
        }
    }

    /// Who allows how much, for a message.
    pub(super) fn told(&self) -> String {
        let allowed = bytes(self.bytes);
        match self.by {
            By::Flag => format!("--memory allows {allowed}"),
            By::Default => format!("--memory allows {allowed} by default"),
            By::System => format!("the system allows {allowed}"),
        }
    }

    /// The number of useful threads, at most `asked`, that stays within the memory.
    pub(super) fn threads(&self, plan: &Plan, asked: usize) -> Result<usize, Failure> {
        let needs = Memory::of(plan);
        let threads = needs.threads_within(self.bytes, useful(plan, asked));
        threads.ok_or_else(|| {
            let help = match self.by {
                By::Flag | By::Default => "--memory with a larger size, such as 2GB, allows it",
                By::System => "`ulimit -v` shows the limit of a shell, in kB, and sets it",
            };
            let (least, told) = (bytes(needs.on(1)), self.told());
            let message = format!("one thread takes up to {least} of memory in this sweep, {told}");
            Failure::bad_input_with_help(message, help)
        })
    }
}

/// The number of threads that have a piece to compute, at most `asked`.
pub(super) fn useful(plan: &Plan, asked: usize) -> usize {
    usize::try_from(plan.pieces().total()).map_or(asked, |pieces| asked.min(pieces))
}

/// The bytes that each of so many runs on this machine may take by default: together half of what
/// is free.
pub(super) fn default_memory(sharers: u64) -> u64 {
    let variable = |name: &str| std::env::var(name).ok();
    let free = [
        machine(),
        cgroup::left(),
        address_space::left(),
        of_slurm(variable),
    ];
    share(free.into_iter().flatten().min(), sharers)
}

fn share(free: Option<u64>, sharers: u64) -> u64 {
    (free.unwrap_or(0) / 2 / sharers.max(1)).max(LEAST)
}

/// The bytes of memory that the machine has available, or all of its bytes where it does not tell.
fn machine() -> Option<u64> {
    let told = cgroup::text(Path::new("/proc/meminfo"));
    let available = told.and_then(|text| cgroup::number_of("MemAvailable:", &text));
    available.map(|kib| kib << 10).or_else(installed)
}

#[cfg(unix)]
fn installed() -> Option<u64> {
    // SAFETY: the call takes a number alone.
    let pages = unsafe { libc::sysconf(libc::_SC_PHYS_PAGES) };
    let pages = u64::try_from(pages).ok()?;
    Some(pages.saturating_mul(address_space::page()))
}

#[cfg(not(unix))]
fn installed() -> Option<u64> {
    None
}

/// The bytes of an allocation of Slurm on this node, which it tells in MiB in the environment; 0
/// stands for all that the node has.
fn of_slurm(variable: impl Fn(&str) -> Option<String>) -> Option<u64> {
    let number = |name: &str| variable(name)?.trim().parse::<u64>().ok();
    let per_cpu =
        || Some(number("SLURM_MEM_PER_CPU")?.saturating_mul(number("SLURM_CPUS_ON_NODE")?));
    let mib = number("SLURM_MEM_PER_NODE").or_else(per_cpu);
    mib.filter(|mib| *mib > 0)
        .map(|mib| mib.saturating_mul(1 << 20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_default_is_a_share_of_half_of_what_is_free() {
        assert_eq!(share(Some(64_000_000_000), 1), 32_000_000_000);
        assert_eq!(share(Some(64_000_000_000), 4), 8_000_000_000);
        assert_eq!(share(Some(64_000_000_000), 0), 32_000_000_000);
        assert_eq!(share(Some(900_000_000), 1), LEAST);
        assert_eq!(share(None, 8), LEAST);
        assert!(machine().is_none_or(|bytes| bytes > 1 << 20));
    }

    #[test]
    fn slurm_tells_its_allocation() {
        let told = |variables: &[(&str, &str)]| {
            of_slurm(|name| {
                let found = variables.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| (*value).to_owned())
            })
        };
        let (node, cpu, cpus) = (
            "SLURM_MEM_PER_NODE",
            "SLURM_MEM_PER_CPU",
            "SLURM_CPUS_ON_NODE",
        );
        assert_eq!(told(&[(node, "4096")]), Some(4 << 30));
        assert_eq!(told(&[(cpu, "2048"), (cpus, "8")]), Some(16 << 30));
        assert_eq!(told(&[(cpu, "2048")]), None);
        assert_eq!(told(&[(node, "0")]), None);
        assert_eq!(told(&[(node, "all"), (cpus, "8")]), None);
        assert_eq!(told(&[]), None);
    }

    #[test]
    fn sizes_are_read() {
        assert_eq!(parse("500MB"), Ok(LEAST));
        assert_eq!(parse("2GiB"), Ok(2 << 30));
        assert!(parse("lots").is_err() && parse("").is_err());
    }
}
