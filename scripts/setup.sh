#!/usr/bin/env bash
# Gets what a build of slipmap needs: cargo, a C compiler, pkg-config and libhdf5.
#
# Debian and Ubuntu: by apt-get, as root or with sudo. macOS: by Homebrew. Anywhere else, or without those rights, libhdf5
# is built from source and linked statically (some minutes, once). SLIPMAP_STATIC_HDF5=1 asks for that right away.
#
# Sourced by first-map.sh and test.sh, and can be run by itself. It exports
#   SLIPMAP_CARGO_FEATURES   what to hand to cargo: empty or "--features static-hdf5"
#   HDF5_DIR, CMAKE          for the build, where they are needed
set -euo pipefail

SLIPMAP_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# Older ones do not know all of the language and the manifest used here.
CARGO_NEEDED=1.89
# With this one the tests passed; others may lint otherwise.
RUST_TESTED=1.95.0
CARGO_DENY=0.18.9
MDBOOK=0.5.4
CARGO_DEB=3.8.0
CMAKE_NEEDED=3.26
WASM=wasm32-unknown-unknown

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}
have() { command -v "$1" >/dev/null 2>&1; }

# at_least FOUND NEEDED: versions of two numbers and anything after them.
at_least() {
    local found_major found_minor needed_major needed_minor rest
    IFS=. read -r found_major found_minor rest <<<"$1"
    IFS=. read -r needed_major needed_minor rest <<<"$2"
    found_major=${found_major//[!0-9]/} found_minor=${found_minor%%[!0-9]*}
    ((${found_major:-0} > needed_major)) ||
        { ((${found_major:-0} == needed_major)) && ((${found_minor:-0} >= needed_minor)); }
}

# What `PROGRAM --version` calls its version: the first word that starts with a digit.
version_of() { "$@" --version 2>/dev/null | grep -Eo '[0-9]+\.[0-9]+[.0-9]*' | head -n 1 || true; }

# as_root COMMAND…: as root, or with sudo. Asks for a password only on a terminal; fails rather than hangs.
as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif ! have sudo; then
        return 1
    elif sudo -n true 2>/dev/null; then
        sudo -n "$@"
    elif [ -t 0 ] && [ -t 2 ]; then
        say "packages are missing; sudo asks for your password to install them"
        sudo "$@"
    else
        return 1
    fi
}

# apt_missing PACKAGE…: those that are not installed, one per line.
apt_missing() {
    local package
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
            printf '%s\n' "$package"
    done
}

# apt_install PACKAGE…: false if they are not all there in the end.
apt_install() {
    local missing
    mapfile -t missing < <(apt_missing "$@")
    if [ ${#missing[@]} = 0 ]; then
        return 0
    fi
    # Once, so that a password is asked for once.
    as_root true || return 1
    say "installing ${missing[*]} (apt-get)"
    local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
    # An update may fail for some source that has nothing to do with these packages; the install then decides.
    as_root "${apt[@]}" update >&2 || true
    as_root "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2
}

# brew_install FORMULA…
brew_install() {
    local formula
    for formula in "$@"; do
        brew list --formula "$formula" >/dev/null 2>&1 || brew install "$formula" >&2 || return 1
    done
}

# make_venv FOLDER: an empty Python environment, whatever was there.
make_venv() {
    local folder=$1
    rm -rf "$folder"
    if have python3 && python3 -c 'import ensurepip, venv' 2>/dev/null; then
        python3 -m venv "$folder" >&2
    elif have uv; then
        uv venv --quiet --seed "$folder" >&2
    else
        return 1
    fi
}

# The first Python that is new enough and can make virtual environments.
python_with_venv() {
    local python
    for python in python3 python3.13 python3.12 python3.11 /usr/bin/python3; do
        if have "$python" &&
            "$python" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            printf '%s\n' "$python"
            return 0
        fi
    done
    return 1
}

# install_packages VENV REQUIREMENTS: the packages of a file in scripts, in an environment below target. The stamp says which
# ones are there.
install_packages() {
    local venv=$SLIPMAP_ROOT/target/$1 requirements=scripts/$2
    if cmp -s "$requirements" "$venv/$2" && "$venv/bin/python" -c '' 2>/dev/null; then
        return
    fi
    say "installing the Python packages of $requirements into target/$1"
    rm -rf "$venv"
    mkdir -p target
    "$(python_with_venv)" -m venv "$venv" || return 1
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes -r "$requirements" >&2 || return 1
    cp "$requirements" "$venv/$2"
}

need_cargo() {
    have cargo || PATH="$PATH:${CARGO_HOME:-$HOME/.cargo}/bin"
    have cargo || die "cargo is not here. Install Rust from https://rustup.rs and run this again."
    local version
    version=$(cd "$SLIPMAP_ROOT" && version_of cargo)
    at_least "$version" "$CARGO_NEEDED" ||
        die "cargo is version ${version:-unknown}, $CARGO_NEEDED or newer is needed. With Rust from https://rustup.rs: rustup update"
}

# cargo_tool PROGRAM VERSION FLAG…: a program of the crate of that name, built once into target/tools; false where it cannot be.
# It runs for seconds, so it is built without the optimisation that its own profile asks for, which takes minutes.
cargo_tool() {
    local program=$1 version=$2
    shift 2
    have "$program" && return
    case ":$PATH:" in *":$SLIPMAP_ROOT/target/tools/bin:"*) ;; *) export PATH="$SLIPMAP_ROOT/target/tools/bin:$PATH" ;; esac
    have "$program" && return
    say "building $program into target/tools"
    CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_OPT_LEVEL=0 CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
        CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_STRIP=true \
        cargo install --quiet --locked --root "$SLIPMAP_ROOT/target/tools" "$@" "$program@$version" >&2
}

# Rust's standard library for WebAssembly, from where Rust comes from; false where it cannot be had.
have_wasm() {
    local library
    library=$(rustc --print sysroot)/lib/rustlib/$WASM
    if [ ! -e "$library" ] && have rustup; then
        rustup --quiet target add "$WASM" >&2 || true
    elif [ ! -e "$library" ] && [ "$(rustc --print sysroot)" = /usr ] && have apt-get; then
        apt_install libstd-rust-dev-wasm32 || true
    fi
    [ -e "$library" ]
}

have_compiler() { have "${CC:-cc}" || have gcc || have clang; }

# A C compiler, pkg-config and libhdf5 of the system; false where there are none to be had.
system_hdf5() {
    if [ -n "${HDF5_DIR:-}" ]; then
        return 0
    fi
    case $(uname -s) in
    Darwin)
        have brew && brew_install hdf5 pkg-config || return 1
        HDF5_DIR=$(brew --prefix hdf5)
        export HDF5_DIR
        ;;
    *)
        if have_compiler && have pkg-config && { pkg-config --exists hdf5 || pkg-config --exists hdf5-serial; }; then
            return 0
        fi
        have apt-get || return 1
        local packages=(libhdf5-dev pkg-config)
        have_compiler || packages+=(gcc libc6-dev)
        apt_install "${packages[@]}"
        ;;
    esac
}

# What building libhdf5 from source takes: a C compiler, make, and a cmake that is new enough.
static_hdf5() {
    SLIPMAP_CARGO_FEATURES="--features static-hdf5"
    have_compiler || die "there is no C compiler (cc, gcc or clang): install one and run this again"
    have make || have ninja || die "there is no make: install it and run this again"
    if [ -n "${CMAKE:-}" ] && at_least "$(version_of "$CMAKE")" "$CMAKE_NEEDED"; then
        return
    fi
    if have cmake && at_least "$(version_of cmake)" "$CMAKE_NEEDED"; then
        unset CMAKE
        return
    fi
    local venv=$SLIPMAP_ROOT/target/cmake-venv
    export CMAKE=$venv/bin/cmake
    if ! at_least "$(version_of "$CMAKE")" "$CMAKE_NEEDED"; then
        say "installing cmake from PyPI into target/cmake-venv"
        { make_venv "$venv" && "$venv/bin/pip" install --quiet 'cmake>=3.26,<5' >&2; } ||
            die "cmake $CMAKE_NEEDED or newer is needed to build libhdf5, and could not be installed: put one on the PATH, or install libhdf5 with its headers and pkg-config"
    fi
}

slipmap_setup() {
    SLIPMAP_CARGO_FEATURES=""
    need_cargo
    # A script may need no more.
    if [ "${SLIPMAP_SETUP:-}" = cargo ]; then
        :
    elif [ "${SLIPMAP_STATIC_HDF5:-0}" = 1 ]; then
        static_hdf5
    elif ! system_hdf5; then
        say "libhdf5 is not here and cannot be installed: building it from source, which takes some minutes once"
        static_hdf5
    fi
    export PATH SLIPMAP_CARGO_FEATURES
}

slipmap_setup
