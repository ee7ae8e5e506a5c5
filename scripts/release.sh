#!/usr/bin/env bash
# The packages that can be made on this machine, into target/release-files, with their checksums:
#
#   scripts/release.sh [crate] [tarball] [deb]      all three unless some are named
#
#   crate     what the crate registry would get, built once from what is packed (cargo publish --dry-run)
#   tarball   the program with libhdf5 in it, manual pages, completions of shells, sweeps; needs glibc and nothing else
#   deb       the same as a package for Debian and Ubuntu (cargo-deb)
#
# Nothing is published. A tree that differs from its revision is refused, unless SLIPMAP_DIRTY=1: what is released can be named.
set -euo pipefail

export SLIPMAP_STATIC_HDF5=1
# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

wanted=("$@")
[ ${#wanted[@]} -gt 0 ] || wanted=(crate tarball deb)
dirty=()
if [ -n "$(git status --porcelain)" ]; then
    [ "${SLIPMAP_DIRTY:-}" = 1 ] || die "the tree differs from its revision: commit first, or SLIPMAP_DIRTY=1"
    dirty=(--allow-dirty)
fi
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
machine=$(uname -m)-$(uname -s | tr '[:upper:]' '[:lower:]')
files=target/release-files
texts=target/texts
mkdir -p "$files"

# The program with libhdf5 in it, in a folder of its own: other builds of this tree may link the system's.
build() {
    [ -z "${built:-}" ] || return 0
    say "building the program with libhdf5 in it"
    # shellcheck disable=SC2086
    cargo build --release --locked $SLIPMAP_CARGO_FEATURES
    ! ldd target/release/slipmap 2>/dev/null | grep -q hdf5 || die "the program still asks for a libhdf5 of the system"
    rm -rf "$texts"
    mkdir -p "$texts/man"
    target/release/slipmap man -o "$texts/man"
    target/release/slipmap completions bash >"$texts/slipmap.bash"
    target/release/slipmap completions zsh >"$texts/_slipmap"
    target/release/slipmap completions fish >"$texts/slipmap.fish"
    built=1
}

make_crate() {
    cargo publish --dry-run --locked ${dirty[@]+"${dirty[@]}"}
    cp "target/package/slipmap-$version.crate" "$files/"
}

make_tarball() {
    build
    local name=slipmap-$version-$machine
    local folder=target/$name
    rm -rf "$folder"
    mkdir -p "$folder"
    cp -r target/release/slipmap "$texts" sweeps README.md CHANGELOG.md CITATION.cff LICENSE-APACHE LICENSE-MIT "$folder/"
    strip "$folder/slipmap" 2>/dev/null || true
    # Equal contents make equal bytes, but for the program itself.
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git log -1 --format=%ct)" \
        -C target -czf "$files/$name.tar.gz" "$name"
    rm -rf "$folder"
}

make_deb() {
    have dpkg || die "a package for Debian is made on Debian or Ubuntu"
    cargo_tool cargo-deb "$CARGO_DEB" || die "cargo-deb cannot be built"
    build
    cargo deb --no-build --output "$files/"
}

for package in "${wanted[@]}"; do
    case $package in
    crate | tarball | deb) "make_$package" ;;
    *) die "unknown package $package: crate, tarball or deb" ;;
    esac
done
(cd "$files" && rm -f SHA256SUMS && sha256sum -- * >SHA256SUMS)
say ""
cat "$files/SHA256SUMS"
