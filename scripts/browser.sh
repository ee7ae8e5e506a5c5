#!/usr/bin/env bash
# Gets what the tests of the page need (Node, a Chromium, and the packages of tests/browser), and runs them in that browser with
# the program at target/release/slipmap. `scripts/browser.sh bench` runs benches/explorer.mjs instead.
#
# Sourced by test.sh for `have_browser` and `test_browser`.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

NODE_NEEDED=20.0
# Where the packages are, so that Node finds them from the copies of the tests beside them.
BROWSER_TESTS=$SLIPMAP_ROOT/target/browser

find_chromium() {
    local program
    for program in "${SLIPMAP_CHROMIUM:-}" chromium chromium-browser google-chrome \
        "/Applications/Chromium.app/Contents/MacOS/Chromium" \
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"; do
        if [ -n "$program" ] && have "$program"; then
            command -v "$program"
            return 0
        fi
    done
    return 1
}
new_enough_node() { have node && have npm && at_least "$(node --version | tr -d v)" "$NODE_NEEDED"; }

# Node, Chromium and the packages; false where they cannot be had.
have_browser() {
    if ! new_enough_node; then
        { have apt-get && apt_install nodejs npm; } || { have brew && brew_install node; } || true
        hash -r
        new_enough_node || return 1
    fi
    if ! find_chromium >/dev/null; then
        { have apt-get && apt_install chromium fonts-dejavu-core; } || true
        hash -r
    fi
    SLIPMAP_CHROMIUM=$(find_chromium) || return 1
    export SLIPMAP_CHROMIUM
    mkdir -p "$BROWSER_TESTS"
    local lock=tests/browser/package-lock.json
    if ! cmp -s "$SLIPMAP_ROOT/$lock" "$BROWSER_TESTS/installed.json"; then
        say "installing playwright-core and axe-core into target/browser"
        cp "$SLIPMAP_ROOT"/tests/browser/package*.json "$BROWSER_TESTS"
        (cd "$BROWSER_TESTS" && npm ci --silent --no-audit --no-fund --ignore-scripts >&2) || return 1
        cp "$SLIPMAP_ROOT/$lock" "$BROWSER_TESTS/installed.json"
    fi
}

# Node looks for packages in the folders above a file.
copied() {
    rm -rf "$BROWSER_TESTS/run"
    mkdir -p "$BROWSER_TESTS/run"
    cp "$SLIPMAP_ROOT"/tests/browser/*.mjs "$SLIPMAP_ROOT/benches/explorer.mjs" "$BROWSER_TESTS/run"
}

test_browser() {
    copied
    export SLIPMAP_ROOT SLIPMAP_PROGRAM=${SLIPMAP_PROGRAM:-$SLIPMAP_ROOT/target/release/slipmap}
    node --test --test-concurrency=1 --test-timeout=400000 --test-force-exit "$BROWSER_TESTS"/run/*.test.mjs
}

bench_browser() {
    copied
    export SLIPMAP_ROOT SLIPMAP_PROGRAM=${SLIPMAP_PROGRAM:-$SLIPMAP_ROOT/target/release/slipmap}
    node "$BROWSER_TESTS/run/explorer.mjs" "$@"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    have_browser || die "Node $NODE_NEEDED or newer, npm or Chromium is missing and cannot be installed"
    if [ "${1:-}" = bench ]; then
        shift
        bench_browser "$@"
    else
        # shellcheck disable=SC2086
        cargo build --release --locked $SLIPMAP_CARGO_FEATURES
        test_browser
    fi
fi
