#!/usr/bin/env bash
# Gets what the tests of the page need (Node, a Chromium, and the packages of tests/browser), and runs them in that browser.
#
#   scripts/browser.sh              # the tests
#   scripts/browser.sh bench [--seconds N] [--map FOLDER] [--peers]
#                                   # benches/explorer.mjs; with --peers it also gets the heat maps of
#                                   # others that are timed beside slipmap's
#   scripts/browser.sh pictures     # those of the page in README.md
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
    mkdir -p "$BROWSER_TESTS/run/explorer"
    cp "$SLIPMAP_ROOT"/tests/browser/*.mjs "$SLIPMAP_ROOT/benches/explorer.mjs" "$BROWSER_TESTS/run"
    cp "$SLIPMAP_ROOT"/benches/explorer/*.mjs "$BROWSER_TESTS/run/explorer"
}

# The packages of benches/explorer/peers, and the page of one of them, bundled; false where they
# cannot be had. What an earlier run bundled goes away first: nothing is measured that is half new.
get_peers() {
    local from=$SLIPMAP_ROOT/benches/explorer/peers to=$BROWSER_TESTS/peers
    mkdir -p "$to"
    rm -rf "$to/bundled"
    cp "$from"/* "$from/.npmrc" "$to"
    if ! cmp -s "$from/package-lock.json" "$to/installed.json"; then
        say "installing the peers of the benchmark into target/browser/peers"
        (cd "$to" && npm ci --silent --no-audit --no-fund --ignore-scripts >&2) || return 1
        cp "$from/package-lock.json" "$to/installed.json"
    fi
    (cd "$to" && node_modules/.bin/esbuild h5web.jsx --bundle --minify --format=iife --jsx=automatic \
        --define:process.env.NODE_ENV='"production"' --outfile=bundled/h5web.js --log-level=error)
}

# The page without a server and the guide are tested where they were made.
test_browser() {
    copied
    [ -n "${SLIPMAP_STATIC_PAGE:-}" ] || rm "$BROWSER_TESTS/run/static.test.mjs"
    [ -n "${SLIPMAP_GUIDE:-}" ] || rm "$BROWSER_TESTS/run/guide.test.mjs"
    export SLIPMAP_ROOT SLIPMAP_PROGRAM=${SLIPMAP_PROGRAM:-$SLIPMAP_ROOT/target/release/slipmap}
    node --test --test-concurrency=1 --test-timeout=900000 --test-force-exit "$BROWSER_TESTS"/run/*.test.mjs
}

# Leaves SLIPMAP_STATIC_PAGE empty where it cannot be made.
make_static_page() {
    SLIPMAP_STATIC_PAGE=
    if have_wasm; then
        SLIPMAP_STATIC_PAGE=$BROWSER_TESTS/page
        "$SLIPMAP_ROOT/scripts/static-page.sh" "$SLIPMAP_STATIC_PAGE"
    fi
    export SLIPMAP_STATIC_PAGE
}

# pages PROGRAM …: one of the other programs beside the tests.
pages() {
    copied
    export SLIPMAP_ROOT SLIPMAP_PROGRAM=${SLIPMAP_PROGRAM:-$SLIPMAP_ROOT/target/release/slipmap}
    node "$BROWSER_TESTS/run/$1" "${@:2}"
}

bench_browser() {
    case " $* " in
    *" --peers "*) get_peers || say "not all peers of the benchmark could be had" ;;
    esac
    export SLIPMAP_PEERS=$BROWSER_TESTS/peers
    pages explorer.mjs "$@"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    have_browser || die "Node $NODE_NEEDED or newer, npm or Chromium is missing and cannot be installed"
    from=$PWD
    cd "$SLIPMAP_ROOT"
    # shellcheck disable=SC2086
    cargo build --release --locked $SLIPMAP_CARGO_FEATURES
    case ${1:-} in
    bench)
        # FOLDER is meant from there.
        cd "$from"
        bench_browser "${@:2}"
        ;;
    pictures) pages pictures.mjs ;;
    *)
        make_static_page
        test_browser
        ;;
    esac
fi
