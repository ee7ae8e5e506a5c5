#!/usr/bin/env bash
# Times slipmap's integrator, the Rust crate differential-equations and JiTCDDE on the same problems, in turn, and prints tables.
#
#   benches/peers/run.sh [ROUNDS] [FOLDER]
#
# ROUNDS is 5 unless given. FOLDER keeps the Python environment, the builds and the lines of all rounds; without it they
# are made in a temporary folder and removed. Needs Python 3.11 or newer with venv, a C compiler, and the package registries.
# Times are those of the clock for slipmap, whose runs are short, and of the processor for the others, which is never more.
set -euo pipefail

peers=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=benches/peers/folder.sh
. "$peers/folder.sh"
started 5 "$@"
# shellcheck source=scripts/setup.sh
. "$peers/../../scripts/setup.sh"
cd "$SLIPMAP_ROOT"
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

say "setting up in $work"
mkdir -p "$work/reference"
script=$peers/jitcdde_smooth.py
python_of "$script"
CARGO_TARGET_DIR=$work/target cargo build --quiet --release --locked --manifest-path "$peers/Cargo.toml"

# The executable itself: cargo may have to wait for other builds.
# shellcheck disable=SC2086
motion=$(cargo bench --quiet $SLIPMAP_CARGO_FEATURES --bench motion --no-run --message-format=json |
    sed -n 's/.*"executable":"\([^"]*motion[^"]*\)".*/\1/p')
"$motion" --write-reference "$work/reference"

lines=$work/rounds.txt
: >"$lines"
for ((round = 1; round <= rounds; round++)); do
    say "round $round of $rounds; $(uptime)"
    {
        "$motion" --reference "$work/reference"
        "$work/target/release/slipmap-peers" "$work/reference"
        "$work/venv/bin/python" "$script" "$work/reference" "$work/smooth.so"
    } >>"$lines"
done
"$work/venv/bin/python" "$peers/table.py" <"$lines"
