#!/usr/bin/env bash
# The library with every set of features that makes sense, as clippy sees it, and how many packages each takes:
#
#   scripts/features.sh
#
# Without features it takes 60 packages at most, and none that needs a C compiler, libhdf5 or threads. It, `sweep` and `wasm`
# are checked for WebAssembly as well, where that target can be had; says so where it cannot.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

MOST_OF_CORE=60

# packages FEATURES: names of all that a build takes, slipmap among them.
packages() {
    cargo tree --locked --no-default-features --features "$1" --edges normal,build --prefix none |
        sed 's/ (\*)$//' | sort -u
}

check=(cargo check)
strict=()
if cargo clippy --version >/dev/null 2>&1; then
    check=(cargo clippy)
    strict=(-- -D warnings)
fi
for features in "" sweep fit explore store picture serve cli; do
    say "features: ${features:-none}, $(packages "$features" | wc -l) packages"
    with=$features
    # Where libhdf5 is built from source, whatever needs it says so.
    case $features in "" | sweep | fit | explore) ;; *) [ -z "$SLIPMAP_CARGO_FEATURES" ] || with=$features,static-hdf5 ;; esac
    "${check[@]}" --quiet --locked --lib --no-default-features --features "$with" ${strict[@]+"${strict[@]}"}
done

core=$(packages "")
[ "$(wc -l <<<"$core")" -le $MOST_OF_CORE ] || die "without features more than $MOST_OF_CORE packages are needed"
! grep -E '^(hdf5|rayon|cc |cmake|clap|miette|plotters|[^ ]*-sys )' <<<"$core" >&2 || die "these are not for the core"

if have_wasm; then
    for features in "" sweep wasm; do
        "${check[@]}" --quiet --locked --lib --no-default-features --features "$features" --target "$WASM" \
            ${strict[@]+"${strict[@]}"}
    done
else
    say "warning: left out: $WASM, for which there is no standard library here"
fi
