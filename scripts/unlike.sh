#!/usr/bin/env bash
# The same bytes on unlike processors:
#
#   scripts/unlike.sh
#
# Every shipped sweep with the C library's code for older processors, all of them smaller on an emulated x86-64 without AVX
# and, where a Rust for it can be had, as an aarch64 program. Says what was left out. Linux on x86-64 only; needs h5py.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

folder=$SLIPMAP_ROOT/target/unlike
python=${SLIPMAP_PYTHON:-$SLIPMAP_ROOT/target/readers-venv/bin/python}
triple=aarch64-unknown-linux-gnu
# Points along each axis where the processor is emulated.
FEW=${SLIPMAP_POINTS:-5}

left_out=()

# wrapper NAME WORDS…: a program that runs slipmap after these words.
wrapper() {
    local name=$1
    shift
    printf '#!/bin/sh\nexec %s "$@"\n' "$*" >"$folder/$name"
    chmod +x "$folder/$name"
}

# same NAME OPTIONS…: that program makes what the one of this machine makes.
same() {
    local name=$1
    shift
    say "== $name"
    "$python" scripts/compare_maps.py "$@" "$program" "$folder/$name"
}

# The libraries of an arm64 Debian and its Rust, unpacked into a folder: nothing is installed.
unpack_arm64() {
    local root=$folder/arm64 archive
    [ ! -e "$root/complete" ] || return 0
    rm -rf "$root"
    mkdir -p "$root/state/lists/partial" "$root/cache/archives/partial"
    : >"$root/status"
    cat >"$root/apt.conf" <<CONF
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "root";
Debug::NoLocking "true";
Dir::State "$root/state";
Dir::State::status "$root/status";
Dir::Cache "$root/cache";
CONF
    APT_CONFIG=$root/apt.conf apt-get -q update >&2 &&
        APT_CONFIG=$root/apt.conf apt-get -q install -y --download-only libhdf5-dev libstd-rust-web-dev >&2 || return 1
    for archive in "$root"/cache/archives/*.deb; do
        dpkg-deb -x "$archive" "$root" || return 1
    done
    mkdir -p "$root/sysroot/lib/rustlib"
    ln -sfn /usr/lib/rustlib/x86_64-unknown-linux-gnu "$root/sysroot/lib/rustlib/"
    ln -sfn "$root/usr/lib/rustlib/$triple" "$root/sysroot/lib/rustlib/"
    printf '#!/bin/sh\nexec /usr/bin/rustc --sysroot %s "$@"\n' "$root/sysroot" >"$root/rustc"
    chmod +x "$root/rustc"
    touch "$root/complete"
}

# An aarch64 program, by Debian's Rust for the web browsers, which is as new as the one that is needed.
build_aarch64() {
    have apt-get && apt_install qemu-user gcc-aarch64-linux-gnu rustc-web || return 1
    at_least "$(version_of /usr/bin/rustc)" "$CARGO_NEEDED" && unpack_arm64 || return 1
    local root=$folder/arm64 flags="" library
    # hdf5-metno-sys loads what it finds to learn its version: the one of this machine, of the same Debian.
    for library in "$root"{/lib/aarch64-linux-gnu,/usr/lib/aarch64-linux-gnu{,/hdf5/serial}}; do
        flags+=" -C link-arg=-Wl,-rpath-link,$library"
    done
    # Not where its C library is: that one names its parts by paths of a whole system.
    flags+=" -C link-arg=-L$root/usr/lib/aarch64-linux-gnu/hdf5/serial"
    RUSTC=$root/rustc CARGO_TARGET_DIR=$folder/build CARGO_PROFILE_RELEASE_DEBUG=false \
        PKG_CONFIG_ALLOW_CROSS=1 PKG_CONFIG_SYSROOT_DIR=$root \
        PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig \
        CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
        CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUSTFLAGS=$flags \
        cargo build --release --locked --bin slipmap --target $triple >&2 || die "no build for aarch64"
}

[ "$(uname -sm)" = "Linux x86_64" ] || die "unlike processors are emulated on Linux on x86-64 only"
"$python" -c 'import h5py' 2>/dev/null || die "h5py is not here; scripts/test.sh installs it"
mkdir -p "$folder"
# shellcheck disable=SC2086
cargo build --release --locked $SLIPMAP_CARGO_FEATURES >&2
program=$SLIPMAP_ROOT/target/release/slipmap

wrapper older-c-library env \
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4,-AVX512F "$program"
same older-c-library
if have qemu-x86_64 || { have apt-get && apt_install qemu-user; }; then
    wrapper without-avx qemu-x86_64 -cpu Westmere "$program"
    same without-avx --points "$FEW"
else
    left_out+=("x86-64 without AVX: there is no qemu-x86_64")
fi
if build_aarch64; then
    wrapper aarch64 qemu-aarch64 -L "$folder/arm64" "$folder/build/$triple/release/slipmap"
    same aarch64 --points "$FEW"
else
    left_out+=("aarch64: no emulator, compiler, Rust or libhdf5 for it can be had")
fi
for what in ${left_out[@]+"${left_out[@]}"}; do
    say "warning: left out: $what"
done
say "the same bytes everywhere; left out: ${#left_out[@]}"
