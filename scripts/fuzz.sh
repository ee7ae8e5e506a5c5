#!/usr/bin/env bash
# Fuzzes what slipmap reads, guided by coverage (libFuzzer, on a stable toolchain):
#
#   scripts/fuzz.sh TARGET [EXECUTIONS] [LIBFUZZER-FLAGS…]
#
# TARGET: sweep, case, manifest, tiles, rows or map; 10 million executions by default. It starts from the inputs that are kept in
# the archives of tests/fuzz/corpus and adds what it finds to target/fuzz/found/TARGET; inputs that are answered wrongly go to
# tests/fuzz/regressions, where the test suite replays them. No execution may take longer than 10 s or more than 1 GiB.
#
#   scripts/fuzz.sh TARGET keep      replaces the kept inputs by the smallest set that covers as much as all that was found
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

target=${1:?"which target? sweep, case, manifest, tiles, rows or map"}
executions=${2:-10000000}
shift $(($# < 2 ? $# : 2))

# What cargo-fuzz sets on a nightly toolchain, without the sanitizers.
instrument=(
    -Cpasses=sancov-module
    -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters
    -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares
)
host=$(rustc -vV | sed -n 's/^host: //p')
features=()
[ -z "$SLIPMAP_CARGO_FEATURES" ] || features=(--features static-hdf5)
RUSTFLAGS="${instrument[*]}" cargo build --release --manifest-path tests/fuzz/Cargo.toml --target "$host" \
    --target-dir target/fuzz "${features[@]}"
program=$PWD/target/fuzz/$host/release/slipmap-fuzz

export SLIPMAP_FUZZ_TARGET=$target
archive=tests/fuzz/corpus/$target.tar
kept=target/fuzz/kept/$target
found=target/fuzz/found/$target
rm -rf "$kept"
mkdir -p "$kept" "$found" tests/fuzz/regressions
[ ! -e "$archive" ] || tar -xf "$archive" -C "$kept"

if [ "$executions" = keep ]; then
    smallest=$(mktemp -d)
    "$program" -merge=1 "$smallest" "$kept" "$found"
    # The same inputs make the same archive, with GNU's tar.
    (cd "$smallest" && ls) | LC_ALL=C sort |
        tar -cf "$archive.part" --format=ustar -C "$smallest" --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 \
            --no-recursion -T -
    mv "$archive.part" "$archive"
    rm -rf "$smallest"
    exit
fi
flags=(-runs="$executions" -timeout=10 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1)
case $target in
sweep | case | manifest) flags+=(-dict=tests/fuzz/words.dict) ;;
esac
exec "$program" "${flags[@]}" -artifact_prefix="tests/fuzz/regressions/$target-" "$@" "$found" "$kept"
