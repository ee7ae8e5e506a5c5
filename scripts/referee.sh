#!/usr/bin/env bash
# Asks slipmap and the referee of its tests (tests/referee) the same questions by chance, as many as
# wanted:
#
#   scripts/referee.sh [N [SEED]]
#
# N motions (10,000 by default, some minutes), and N/10 critical velocities and phases at which
# control is switched on. Other seeds are other questions. Where answers differ, shell commands that
# ask slipmap again are printed, with both answers; the exit code is then 1.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

export SLIPMAP_CASES=${1:-10000}
export SLIPMAP_SEED=${2:-$RANDOM}
case $SLIPMAP_CASES$SLIPMAP_SEED in
*[!0-9]*) die "N and SEED are whole numbers" ;;
esac
say "seed $SLIPMAP_SEED"
# shellcheck disable=SC2086
cargo test --release --locked $SLIPMAP_CARGO_FEATURES --test referee -- \
    --nocapture --test-threads=1 by_chance || exit 1
