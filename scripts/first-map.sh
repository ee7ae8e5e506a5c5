#!/usr/bin/env bash
# From a fresh clone to the letter's Fig. 2: gets what is missing, builds slipmap, and computes both maps with their pictures
# into the current folder. Maps that are already there and complete are kept.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

manifest=$SLIPMAP_ROOT/Cargo.toml
# The features are words of their own, or nothing at all.
# shellcheck disable=SC2086
slipmap() { cargo run --quiet --release --locked --manifest-path "$manifest" $SLIPMAP_CARGO_FEATURES -- "$@"; }

# shellcheck disable=SC2086
cargo build --release --locked --manifest-path "$manifest" $SLIPMAP_CARGO_FEATURES

for name in fig2a fig2b; do
    slipmap run "$SLIPMAP_ROOT/sweeps/$name.toml"
done

printf '\nThe pictures of the two maps:\n'
for name in fig2a fig2b; do
    [ -s "$name.png" ] || die "$name.png is not there"
    printf '  %s/%s.png   (map: %s.h5)\n' "$PWD" "$name" "$name"
done
