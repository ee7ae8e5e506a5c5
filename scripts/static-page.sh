#!/usr/bin/env bash
# The page of `slipmap serve` without a server: one folder of static files, in which WebAssembly computes.
#
#   scripts/static-page.sh [FOLDER]        # target/static-page, where none is named
#
# Any web server can hand it out, for example `python3 -m http.server -d target/static-page`; browsers do not load such pages
# from file:. Maps from files need `slipmap serve`. Takes Rust's standard library for WebAssembly, from rustup or, for a Rust
# of Debian or Ubuntu, from apt-get; nothing else.
set -euo pipefail

SLIPMAP_SETUP=cargo
# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

folder=${1:-$SLIPMAP_ROOT/target/static-page}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
cd "$SLIPMAP_ROOT"

have_wasm || die "there is no standard library for $WASM here: with Rust from https://rustup.rs, rustup target add $WASM"

say "building slipmap.wasm"
cargo rustc --quiet --profile wasm --locked --lib --crate-type cdylib --target "$WASM" --target-dir target/wasm \
    --no-default-features --features wasm

# What the page may load, as the server says it in a header, and WebAssembly besides.
policy="default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self';"
policy+=" img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'"
head='<meta charset="utf-8">'
marks="<meta name=\"slipmap-source\" content=\"wasm\">
<meta http-equiv=\"Content-Security-Policy\" content=\"$policy\">"
page=$(<src/serve/page/index.html)
case $page in
*"$head"*) ;;
*) die "src/serve/page/index.html has no line $head" ;;
esac

cp src/serve/page/* "$folder"
printf '%s\n%s\n%s\n' "${page%%"$head"*}$head" "$marks" "${page#*"$head"$'\n'}" >"$folder/index.html"
cp "target/wasm/$WASM/wasm/slipmap.wasm" "$folder"
say "$folder: $(wc -c <"$folder/slipmap.wasm") bytes of WebAssembly, $(gzip -9c "$folder/slipmap.wasm" | wc -c) compressed"
