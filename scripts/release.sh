#!/usr/bin/env bash
# The packages that can be made on this machine, into target/release-files, with their checksums:
#
#   scripts/release.sh [crate] [tarball] [deb]      all three unless some are named
#
#   crate     what the crate registry would get, built once from what is packed (cargo publish --dry-run)
#   tarball   the program with libhdf5 in it, manual pages, completions of shells, sweeps; needs glibc and nothing else
#   deb       the same as a package for Debian and Ubuntu (cargo-deb)
#
# Tarball and package carry the licences of all that is in the program (scripts/licences.sh). scripts/try_packages.sh tries both
# in a fresh Debian 12. Nothing is published. A tree that differs from its revision is refused, unless SLIPMAP_DIRTY=1: what is released can be named.
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
debian=target/debian-texts
mkdir -p "$files"
# Equal sources make packages of equal times.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

# The program with libhdf5 in it. Other builds of this tree may link the system's: none may run beside this.
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
    scripts/licences.sh >target/licences-of-others
    built=1
}

make_crate() {
    local packed=slipmap-$version.crate places made
    # Where it is left differs between versions of cargo.
    places=("target/package/$packed" "target/package/tmp-crate/$packed")
    rm -f "${places[@]}"
    # With libhdf5 built from source: the system may have none.
    # shellcheck disable=SC2086
    cargo publish --dry-run --locked $SLIPMAP_CARGO_FEATURES ${dirty[@]+"${dirty[@]}"}
    for made in "${places[@]}"; do
        [ ! -e "$made" ] || { cp "$made" "$files/" && return; }
    done
    die "cargo left no $packed"
}

# What whoever unpacks the tarball needs to know.
install_text() {
    local glibc
    glibc=$(grep -aoE 'GLIBC_2\.[0-9]+' "$1" | sort -uV | tail -n 1)
    cat <<TEXT
slipmap $version, for Linux on $(uname -m) with glibc ${glibc#GLIBC_} or newer. The program stands alone:

    ./slipmap run sweeps/fig2a.toml     a map and its picture
    ./slipmap help                      all commands

To install it for all users, as root:

    install slipmap /usr/local/bin/
    install -D -m 644 -t /usr/local/share/man/man1 texts/man/*.1
    install -D -m 644 texts/slipmap.bash /usr/local/share/bash-completion/completions/slipmap
    install -D -m 644 texts/_slipmap /usr/local/share/zsh/site-functions/_slipmap
    install -D -m 644 texts/slipmap.fish /usr/local/share/fish/vendor_completions.d/slipmap.fish

README.md is that of the source: pictures, guide and scripts which it names are not in here. LICENSES-OF-OTHERS has the licences
of libhdf5 and of all else in the program.
TEXT
}

make_tarball() {
    build
    local name=slipmap-$version-$machine
    local folder=target/$name
    rm -rf "$folder"
    mkdir -p "$folder"
    cp -r target/release/slipmap "$texts" sweeps README.md CHANGELOG.md CITATION.cff LICENSE-APACHE LICENSE-MIT "$folder/"
    cp target/licences-of-others "$folder/LICENSES-OF-OTHERS"
    install_text "$folder/slipmap" >"$folder/INSTALL.txt"
    # Equal contents make equal bytes, but for the program itself.
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" \
        -C target -czf "$files/$name.tar.gz" "$name"
    rm -rf "$folder"
}

# What Debian wants beside the program: its own kind of changelog, and the Apache License by reference.
debian_texts() {
    local from='AND CONDITIONS FOR USE, REPRODUCTION' to='END OF TERMS AND CONDITIONS' others=target/licences-of-others
    [ "$(grep -c "$from" $others)" = "$(grep -c "$to" $others)" ] || die "an Apache License in $others has no end"
    rm -rf "$debian"
    mkdir -p "$debian"
    cat >"$debian/changelog" <<TEXT
slipmap ($version-1) unstable; urgency=medium

  * What is new in $version stands in changelog.gz.

 -- The slipmap developers <>  $(date -R -u -d "@$SOURCE_DATE_EPOCH")
TEXT
    {
        printf 'slipmap\n\n'
        sed -n '/^Copyright/p' LICENSE-MIT
        printf '\nIt is under the MIT licence below or, at your choice, the Apache License, Version 2.0, which is in\n'
        printf '/usr/share/common-licenses/Apache-2.0 on Debian.\n\n'
        cat LICENSE-MIT
        printf '\n'
        sed "/$from/,/$to/c\\
   (its terms and conditions are in /usr/share/common-licenses/Apache-2.0)" $others
    } >"$debian/copyright"
}

make_deb() {
    have dpkg || die "a package for Debian is made on Debian or Ubuntu"
    # What it compresses takes long without optimisation.
    cargo_tool cargo-deb "$CARGO_DEB" --config profile.release.opt-level=2 || die "cargo-deb cannot be built"
    build
    debian_texts
    cargo deb --no-build --strip --output "$files/"
    ! dpkg-deb -f "$files"/slipmap_"$version"-*.deb Depends | grep -q hdf5 ||
        die "the package asks for a libhdf5 of the system: another build replaced the program"
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
