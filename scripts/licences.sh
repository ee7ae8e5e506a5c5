#!/usr/bin/env bash
# The licences of all that is in the program with libhdf5 in it, or in the module of the Python package, as one text on standard
# output:
#
#   scripts/licences.sh [program | module]      of the program unless the module is named
#
# First a line for every crate that is linked, then their texts, equal ones once: libhdf5, zlib and a font are parts of crates.
# uPlot, in the page of the browser, comes last. scripts/release.sh puts the text into the packages.
set -euo pipefail

SLIPMAP_SETUP=cargo
# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"
export LC_ALL=C

case ${1:-program} in
program) of=(--features static-hdf5) parts=(uPlot) ;;
module) of=(--package slipmap-python) parts=() ;;
*) die "unknown argument $1: program or module" ;;
esac
texts=$(mktemp -d)
trap 'rm -rf "$texts"' EXIT

# add WHOSE FILE: that text, filed by its words: spaces and ends of lines make no other text.
add() {
    local key
    key=$(tr -s ' \t\r\n' ' ' <"$2" | cksum | tr ' ' -)
    [ -e "$texts/$key" ] || { tr -d '\r' <"$2" && echo; } >"$texts/$key"
    printf '%s\n' "$1" >>"$texts/$key.whose"
}

# licence_files FOLDER: the files of a crate that are licences and notices, of its tests and of what is not linked none. One
# that may be used under the MIT licence is: the texts of others are left out there.
licence_files() {
    local found
    found=$(cd "$1" && find . -maxdepth 3 -type f \( -iname 'licen[cs]e*' -o -iname 'copying*' -o -iname 'copyright*' \
        -o -iname 'notice*' -o -path './licenses/*' \) | grep -Ev '^./(tests|scripts|src/zlib-ng)/' | sort)
    if grep -q '^\./LICENSE-MIT' <<<"$found"; then
        found=$(grep -Evi '^\./(LICENSE-(APACHE|ZLIB|0BSD|BOOST)[^/]*|COPYING)$' <<<"$found")
    fi
    printf '%s\n' "$found"
}

# NAME VERSION LICENCE of all that is linked but slipmap; macros that run in the compiler are not.
linked=$(cargo tree --locked "${of[@]}" --edges normal,no-proc-macro --prefix none --format '{p}|{l}' |
    sed -n 's/ (\*)$//; s/^\([^ ]*\) v\([^ |]*\)|\(.*\)$/\1 \2 \3/p' | sort -u)
manifests=$(cargo metadata --locked --format-version 1 --features static-hdf5 | grep -o '"manifest_path":"[^"]*"' | cut -d '"' -f 4)

cat <<HEAD
slipmap has these in it, beside Rust's standard library (MIT OR Apache-2.0). Their licences follow.

HEAD
while read -r name version licence; do
    folder=$(dirname "$(grep -F "/$name-$version/Cargo.toml" <<<"$manifests" | head -n 1)")
    [ -e "$folder/Cargo.toml" ] || die "the source of $name $version is not where cargo keeps crates"
    printf '%s %s: %s\n' "$name" "$version" "${licence:-see below}"
    while read -r file; do
        [ -z "$file" ] || add "$name $version" "$folder/$file"
    done < <(licence_files "$folder")
done <<<"$linked"
[ ${#parts[@]} = 0 ] || printf '%s: MIT\n' "${parts[@]}"

for whose in "$texts"/*.whose; do
    printf '%s %s\n' "$(head -n 1 "$whose")" "${whose%.whose}"
done | sort | while read -r _ _ text; do
    printf '\n%s\n\n' ------------------------------------------------------------------------
    sort -u "$text.whose" | tr '\n' ',' | sed 's/,$/:/; s/,/, /g' | fold -s -w 100
    printf '\n\n'
    cat "$text"
done
[ ${#parts[@]} != 0 ] || exit 0
printf '\n%s\n\nuPlot:\n\n' ------------------------------------------------------------------------
cat src/serve/page/uplot-license.txt
