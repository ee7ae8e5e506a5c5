#!/usr/bin/env bash
# Tries the packages that scripts/release.sh left in target/release-files, each in a fresh Debian 12 with nothing added:
#
#   scripts/try_packages.sh [deb] [tarball] [program-wheel] [module-wheel]      all unless some are named
#
# The .deb is installed by dpkg, the tarball unpacked, the program's wheel installed by this machine's pip: there is no Python in
# there. An ordinary user without a network then runs a shipped sweep, looks at the map, draws it, verifies it and asks for a
# point. At last the .deb is removed, and nothing may be left of it. The module's wheel is tried with Debian's Python, which gets
# it and what it needs from this machine's pip.
# Needs root on Debian or Ubuntu, debootstrap (it is installed where it is missing), Debian's mirror, and some minutes.
# scripts/test.sh does not run it.
set -euo pipefail

SLIPMAP_SETUP=cargo
# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

wanted=("$@")
[ ${#wanted[@]} -gt 0 ] || wanted=(deb tarball program-wheel module-wheel)
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
files=target/release-files
folder=$SLIPMAP_ROOT/target/try-packages
root=$folder/root

[ "$(id -u)" = 0 ] || die "a root of its own needs root"
have debootstrap || { have apt-get && apt_install debootstrap; } || die "debootstrap is not here and cannot be installed"
(cd "$files" && sha256sum --strict --check SHA256SUMS >&2) || die "run scripts/release.sh first"
mkdir -p "$folder"
trap 'rm -rf "$root"' EXIT

# fresh_root [PACKAGE]: with that package of Debian's. What debootstrap made once is kept as an archive: each package of ours gets
# a root that no other has touched.
fresh_root() {
    local fresh=$folder/bookworm${1:+-$1}.tar
    rm -rf "$root"
    if [ ! -e "$fresh" ]; then
        say "making a Debian 12${1:+ with $1}"
        debootstrap --variant=minbase ${1:+--include="$1"} bookworm "$root" >"$folder/debootstrap.log" || die "debootstrap failed: $folder/debootstrap.log"
        tar -C "$root" -cf "$fresh.part" .
        mv "$fresh.part" "$fresh"
        rm -rf "$root"
    fi
    mkdir "$root"
    tar -C "$root" -xpf "$fresh"
}

# inside USER COMMANDS: they run in the root, each printed first, with its own /proc and without a network.
inside() {
    # shellcheck disable=SC2016 # for the shell within
    unshare --mount --net --pid --fork sh -c \
        'mount -t proc proc "$1/proc" && exec chroot --userspec="$2" "$1" /usr/bin/env -i HOME=/tmp/user \
            PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin bash -euxo pipefail -c "$3"' sh "$root" "$1" "$2"
}

# use SWEEPS: a user's first minutes with the program and the sweeps in that folder.
use() {
    mkdir -m 777 "$root/tmp/user"
    # shellcheck disable=SC2016 # for the shell within
    inside 1000:1000 "sweeps=$1
"'cd /tmp/user
slipmap --version
# The libraries of glibc, and nothing else.
libraries=$(ldd "$(command -v slipmap)")
if grep -Ev "linux-(vdso|gate)|ld-linux|lib(c|m|gcc_s|dl|pthread|rt)\.so" <<<"$libraries"; then exit 1; fi
slipmap run --quiet "$sweeps/fig2a.toml"
slipmap info fig2a.h5
slipmap verify fig2a.h5
for kind in png svg pdf; do slipmap plot fig2a.h5 -o "again.$kind"; done
for picture in fig2a.png again.png; do [ "$(head -c 4 $picture | tail -c 3)" = PNG ]; done
slipmap point --mu-prime=-0.3 --alpha-v=-0.5 --tau 4
slipmap point --system "$sweeps/systems/turning.toml" --set width=0.1 --tau 8
slipmap simulate --quiet "$sweeps/fig3a.toml"
slipmap info fig3a.h5
[ "$(head -c 4 fig3a.png | tail -c 3)" = PNG ]
ls -l'
}

# texts FILE…: they are there, and not empty.
texts() {
    local file
    for file in "$@"; do
        [ -s "$root$file" ] || die "$file is missing"
    done
}

try_deb() {
    local doc=/usr/share/doc/slipmap pages before
    fresh_root
    before=$(cd "$root" && find . -xdev | grep -Ev '^\./(tmp|proc|var/(lib/dpkg|log))' | sort)
    cp "$files/slipmap_$version"-*.deb "$root/tmp/slipmap.deb"
    inside 0:0 'dpkg -i /tmp/slipmap.deb; dpkg --verify slipmap'
    texts /usr/share/bash-completion/completions/slipmap /usr/share/zsh/vendor-completions/_slipmap \
        /usr/share/fish/vendor_completions.d/slipmap.fish $doc/copyright
    grep -q 'The HDF Group' "$root$doc/copyright" || die "the licence of libhdf5 is missing"
    pages=$(find "$root/usr/share/man/man1" -name 'slipmap*.1.gz' | wc -l)
    [ "$pages" -ge 10 ] || die "$pages manual pages"
    use $doc/sweeps
    rm -r "$root/tmp/user"
    inside 0:0 'dpkg -r slipmap'
    diff <(echo "$before") <(cd "$root" && find . -xdev | grep -Ev '^\./(tmp|proc|var/(lib/dpkg|log))' | sort) ||
        die "the package leaves these behind"
}

try_tarball() {
    local name
    name=$(cd "$files" && echo "slipmap-$version"-*.tar.gz)
    fresh_root
    cp "$files/$name" "$root/tmp/"
    name=${name%.tar.gz}
    inside 0:0 "tar -C /opt -xzf /tmp/$name.tar.gz; ln -s /opt/$name/slipmap /usr/local/bin/"
    texts /opt/"$name"/{texts/slipmap.bash,texts/_slipmap,texts/slipmap.fish,texts/man/slipmap.1,LICENSE-MIT,LICENSE-APACHE}
    grep -q 'The HDF Group' "$root/opt/$name/LICENSES-OF-OTHERS" || die "the licence of libhdf5 is missing"
    use "/opt/$name/sweeps"
}

try_program_wheel() {
    local venv=$folder/venv site
    make_venv "$venv" || die "there is no Python with venv: the wheel is installed by pip"
    fresh_root
    "$venv/bin/pip" install --quiet --disable-pip-version-check --no-index --find-links "$files" --ignore-installed \
        --root "$root" --prefix /usr/local slipmap-program
    site=/$(cd "$root" && echo usr/local/lib/python*/site-packages/slipmap_program-*.dist-info)
    [ -z "$(find "$root/usr/local" -name '*.py' -o -name '*.so')" ] || die "there is more in the wheel than the program"
    texts "$site"/licenses/{LICENSE-MIT,LICENSE-APACHE,LICENSES-OF-OTHERS}
    grep -q 'The HDF Group' "$root$site/licenses/LICENSES-OF-OTHERS" || die "the licence of libhdf5 is missing"
    cp -r sweeps "$root/opt/"
    use /opt/sweeps
}

try_module_wheel() {
    local venv=$folder/venv site=/usr/local/lib/python3.11/dist-packages
    make_venv "$venv" || die "there is no Python with venv: the wheel is installed by pip"
    fresh_root python3
    # By its path: another package may have its name somewhere.
    "$venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: --python-version 3.11 --ignore-installed \
        --target "$root$site" "$(echo "$files/slipmap-$version"-*.whl)[maps]"
    texts "$site/slipmap-$version.dist-info"/licenses/{LICENSE-MIT,LICENSE-APACHE,LICENSES-OF-OTHERS}
    cp -r sweeps "$root/opt/"
    mkdir -m 777 "$root/tmp/user"
    # shellcheck disable=SC2016 # for the shell within
    inside 1000:1000 "module=$site/slipmap/_core.abi3.so
"'cd /tmp/user
if ldd $module | grep -Ev "linux-(vdso|gate)|ld-linux|lib(c|m|gcc_s|dl|pthread|rt)\.so"; then exit 1; fi
python3 -c "
import slipmap
assert slipmap.n_unstable(mu_prime=-0.3, alpha_v=-0.33, tau=[1.0, 4.15]).tolist() == [2, 0]
small = slipmap.run({\"axes\": {\"alpha_v\": [-0.33, 0.1], \"tau\": [1.0, 4.15]}, \"fixed\": {\"mu_prime\": -0.3}})
small.to_netcdf(\"small.nc\", engine=\"h5netcdf\")
print(slipmap.open_map(\"small.nc\"))
tree = slipmap.run(\"/opt/sweeps/fig2a.toml\")
tree.slipmap.plot().figure.savefig(\"fig2a.png\")
print(slipmap.simulate(\"/opt/sweeps/fig3a.toml\").attrs[\"outcome\"])
"
[ "$(head -c 4 fig2a.png | tail -c 3)" = PNG ]
ls -l'
}

for package in "${wanted[@]}"; do
    case $package in
    deb | tarball) "try_$package" ;;
    program-wheel) try_program_wheel ;;
    module-wheel) try_module_wheel ;;
    *) die "unknown package $package: deb, tarball, program-wheel or module-wheel" ;;
    esac
    say "$package: good"
done
