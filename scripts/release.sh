#!/usr/bin/env bash
# The packages that can be made on this machine, into target/release-files, with their checksums:
#
#   scripts/release.sh [crate] [tarball] [deb] [program-wheel] [module-wheel]      all unless some are named
#
#   crate     what the crate registry would get, built once from what is packed (cargo publish --dry-run)
#   tarball   the program with libhdf5 in it, manual pages, completions of shells, sweeps; needs glibc and nothing else
#   deb       the same as a package for Debian and Ubuntu (cargo-deb)
#   program-wheel   the command slipmap alone as a Python wheel, with libhdf5 in it, for glibc 2.17 and newer (maturin and zig)
#   module-wheel    the Python package slipmap as a source distribution, and as the wheel made of it for the same glibc and for
#                   CPython 3.10 and newer
#
# All but the crate carry the licences of all that is linked (scripts/licences.sh). scripts/try_packages.sh tries them in a
# fresh Debian 12. Nothing is published. A tree that differs from its revision is refused, unless SLIPMAP_DIRTY=1: what is released can be named.
set -euo pipefail

export SLIPMAP_STATIC_HDF5=1
# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

wanted=("$@")
[ ${#wanted[@]} -gt 0 ] || wanted=(crate tarball deb program-wheel module-wheel)
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

# The most bytes of what is fetched by pip, and of the module unpacked.
MOST_PROGRAM_WHEEL=15000000
MOST_MODULE_WHEEL=2000000
MOST_MODULE=4000000
MOST_SOURCE=2000000

# at_most BYTES FILE
at_most() {
    [ "$(wc -c <"$2")" -le "$1" ] || die "$2 has more than $1 bytes"
}

need_maturin() {
    venv=$SLIPMAP_ROOT/target/wheels-venv
    install_packages wheels-venv requirements-wheels.txt ||
        die "the packages of scripts/requirements-wheels.txt cannot be installed: they make the wheels"
}

# build_wheel FOLDER OUT: from that folder's pyproject.toml. zig has the symbols of old glibcs, and compiles libhdf5 for them as
# well. Messages of panics name files: crates without the folder that cargo keeps them in.
build_wheel() {
    (cd "$1" && PATH="$venv/bin:$PATH" CARGO_TARGET_DIR=$SLIPMAP_ROOT/target \
        RUSTFLAGS="--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}/registry/src=crates ${RUSTFLAGS:-}" \
        maturin build --zig --target "$(uname -m)-unknown-linux-gnu" --out "$SLIPMAP_ROOT/$2" "${@:3}")
}

# check_wheel WHEEL NAME: what it needs is old, and it installs by itself into an empty environment.
check_wheel() {
    local told
    told=$("$venv/bin/auditwheel" show "$1" | tr '\n' ' ')
    grep -q '"manylinux_2_17_' <<<"$told" || die "auditwheel says of $1: $told"
    tried=target/$2-tried
    rm -rf "$tried"
    "$venv/bin/python" -m venv "$tried"
    "$tried/bin/pip" install --quiet --disable-pip-version-check --no-index --no-deps "$1"
}

# The program as a wheel.
program_wheel() {
    local folder=target/program-wheel made=target/program-wheels venv tried wheel
    need_maturin
    rm -rf "$folder" "$made"
    mkdir -p "$folder"
    # A wheel takes licences from its own folder alone. Both folders are equally deep: the manifest is found from either.
    cp python/program/* LICENSE-APACHE LICENSE-MIT "$folder/"
    scripts/licences.sh >"$folder/LICENSES-OF-OTHERS"
    say "building the program for glibc 2.17"
    build_wheel "$folder" "$made" --release
    wheel=$(echo "$made"/*.whl)
    at_most $MOST_PROGRAM_WHEEL "$wheel"
    check_wheel "$wheel" slipmap-program
    "$tried/bin/slipmap" --version >&2
    grep -rq 'The HDF Group' "$tried"/lib/python*/site-packages/slipmap_program-*/licenses || die "the licence of libhdf5 is missing"
    cp "$wheel" "$files/"
}

# The source of the Python package with what it needs of the crate, unpacked in target/slipmap-VERSION.
module_source() {
    local made=target/module-source sha1 changed=false
    rm -rf "$made" "target/$name"
    (cd python && "$venv/bin/maturin" sdist --out "$SLIPMAP_ROOT/$made")
    tar -C target -xzf "$made/$name.tar.gz"
    scripts/licences.sh module >"target/$name/LICENSES-OF-OTHERS"
    # The crate's own has taken its place.
    cp python/README.md "target/$name/"
    # As cargo writes it: maps of a module built from this name the revision.
    sha1=$(git rev-parse HEAD)
    [ ${#dirty[@]} = 0 ] || changed=true
    printf '{"git": {"sha1": "%s", "dirty": %s}}\n' "$sha1" "$changed" >"target/$name/.cargo_vcs_info.json"
}

# The Python package as a source distribution, and as the wheel made of it.
module_wheel() {
    local made=target/module-wheels name=slipmap-$version venv tried wheel site text
    need_maturin
    module_source
    rm -rf "$made"
    say "building the module for glibc 2.17"
    build_wheel "target/$name" "$made"
    wheel=$(echo "$made"/*.whl)
    at_most $MOST_MODULE_WHEEL "$wheel"
    check_wheel "$wheel" slipmap-module
    site=$(echo "$tried"/lib/python*/site-packages)
    at_most $MOST_MODULE "$site/slipmap/_core.abi3.so"
    for text in LICENSE-MIT LICENSE-APACHE LICENSES-OF-OTHERS; do
        [ -s "$site/$name.dist-info/licenses/$text" ] || die "$text is missing"
    done
    # What maturin wrote for the source does not know of its licences.
    cp "$site/$name.dist-info/METADATA" "target/$name/PKG-INFO"
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -C target -cf - "$name" |
        gzip -9n >"$files/$name.tar.gz"
    at_most $MOST_SOURCE "$files/$name.tar.gz"
    cp "$wheel" "$files/"
}

for package in "${wanted[@]}"; do
    case $package in
    crate | tarball | deb) "make_$package" ;;
    program-wheel) program_wheel ;;
    module-wheel) module_wheel ;;
    *) die "unknown package $package: crate, tarball, deb, program-wheel or module-wheel" ;;
    esac
done
(cd "$files" && rm -f SHA256SUMS && sha256sum -- * >SHA256SUMS)
say ""
cat "$files/SHA256SUMS"
