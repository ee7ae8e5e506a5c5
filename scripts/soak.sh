#!/usr/bin/env bash
# What the test command asks some times, asked as often as wanted:
#
#   scripts/soak.sh [HOURS]
#
# The shipped sweeps on unlike processors (scripts/unlike.sh), every fault of every command (tests/timed/faults.rs), every
# loss of power (tests/files/crash.rs), kills of a queue (tests/timed/queue.rs), requests to the server by schemathesis, the memory
# of each command (tests/guards/memory.rs) and of the Python module, and what other programs of the kind take; then in turn, with
# new seeds, until the time is over (1 hour by default): property tests of the model, kills of runs, damaged tiles and maps, flipped bits,
# losses of power, motions and critical velocities against the referee.
# Stops at the first thing that fails, with its output.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

hours=${1:-1}
case $hours in
'' | *[!0-9]*) die "HOURS is a whole number" ;;
esac
until=$((SECONDS + 3600 * hours))

# tests NAME…: those tests, with their output where one fails.
tests() {
    # shellcheck disable=SC2086
    cargo test --release --locked $SLIPMAP_CARGO_FEATURES "$@"
}

say "unlike processors"
scripts/unlike.sh
say "every fault"
SLIPMAP_FAULTS=all tests --test timed faults::
say "every loss of power"
SLIPMAP_FAULTS=all tests --test files crash::
say "a thousand kills of a queue"
SLIPMAP_QUEUE_KILLS=1000 tests --test timed queue::
say "memory of every command"
SLIPMAP_MEMORY=all tests --test guards memory:: -- --nocapture
# scripts/test.sh has put the module there.
if [ -x target/readers-venv/bin/pytest ]; then
    say "memory of the Python module"
    SLIPMAP_CALLS=100000 target/readers-venv/bin/pytest python/tests/test_memory.py
    say "requests by chance to every address of the server"
    requests=target/schemathesis-venv
    [ -x "$requests/bin/python" ] || python3 -m venv "$requests"
    "$requests/bin/pip" install --quiet --disable-pip-version-check schemathesis==4.32.5
    SLIPMAP_SCHEMATHESIS=$PWD/$requests/bin/schemathesis tests/schemathesis/run.sh 1000
    say "roots by the module and by other people's programs"
    others=target/peers-venv
    [ -x "$others/bin/python" ] || python3 -m venv "$others"
    "$others/bin/pip" install --quiet --disable-pip-version-check numpy qpmr==0.1.0 tdcpy==0.0.1
    "$others/bin/pip" install --quiet --disable-pip-version-check --no-deps --force-reinstall target/module-wheel/*.whl
    "$others/bin/python" benches/peers/roots.py
    say "motions by slipmap and by other people's programs"
    benches/peers/run.sh 1
fi
round=0
while [ $SECONDS -lt $until ]; do
    round=$((round + 1))
    export SLIPMAP_SEED=$((RANDOM * 32768 + RANDOM))
    say "round $round, seed $SLIPMAP_SEED"
    SLIPMAP_KILLS=200 SLIPMAP_DAMAGES=1000 tests --test timed overnight::
    SLIPMAP_DAMAGED=2000 tests --test program damaged::
    SLIPMAP_FLIPS=2500 SLIPMAP_TILE_FLIPS=1000 tests --test program flips::
    tests --test files crash::
    SLIPMAP_CASES=2000 tests --test referee -- --test-threads=1 by_chance
    SLIPMAP_CASES=100 tests --test referee -- --test-threads=2 motions_with_memory
    SLIPMAP_CASES=10000 tests --test linear general_latency_random::
    SLIPMAP_CASES=100000 tests --test linear general_random::
    SLIPMAP_CASES=2000 tests --test linear chains::
    SLIPMAP_CASES=100000 tests --test linear near_resonance::
    SLIPMAP_CASES=1000 tests --test linear best_general::
    PROPTEST_CASES=20000 tests --lib model::
    SLIPMAP_CASES=1000 tests --test program fits::
    SLIPMAP_CASES=100 SLIPMAP_GRID=40 SLIPMAP_PLACES=1000 tests --test linear robust_beyond::
done
say "$round rounds"
