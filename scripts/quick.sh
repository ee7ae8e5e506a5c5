#!/usr/bin/env bash
# What is worth checking after every small change:
#
#   scripts/quick.sh [TEST …]
#
# Formatting, lints, the structure of the source, unit tests of the library without features, that is of the model, of linear
# stability, of motions and of the critical velocity, and quick tests in tests/linear. A name picks the tests that contain it, as
# in cargo test. Takes forty seconds on two cores when all is built, and minutes the first time. scripts/test.sh checks everything.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

# Files of tests/linear.
QUICK=(counts:: letter:: general_row:: general_curves::)

step() {
    say ""
    say "== $*"
    "$@"
}

names=("${QUICK[@]}")
[ $# = 0 ] || names=("$@")
step cargo fmt --check
# The features are words of their own, or nothing at all.
# shellcheck disable=SC2086
step cargo clippy --locked --all-targets --features external-readers $SLIPMAP_CARGO_FEATURES -- -D warnings
step cargo test --release --locked --no-default-features --lib --test guards -- "$@"
step cargo test --release --locked --no-default-features --test linear -- "${names[@]}"
say "the quick checks passed"
