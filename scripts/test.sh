#!/usr/bin/env bash
# Everything that is checked before a change goes in: formatting, lints, documentation, the whole test suite with other people's
# programs reading the maps, the page in a real browser, and a map on a Slurm of its own. Gets what is missing first. What
# cannot be had is left out with a warning, or fails where it is here on every platform.
set -euo pipefail

# shellcheck source=scripts/browser.sh
. "$(dirname "${BASH_SOURCE[0]}")/browser.sh"
cd "$SLIPMAP_ROOT"

# leave_out TEST WHY: the test suite goes without that test.
left_out=()
leave_out() {
    left_out+=(--skip "$1")
    warnings+=("$2")
}
warnings=()

# ncdump, h5dump, Octave and a Python that can make virtual environments.
install_readers() {
    local missing=() program
    for program in ncdump h5dump octave-cli; do
        have "$program" || missing+=("$program")
    done
    python_with_venv >/dev/null || missing+=("Python 3.11 or newer with venv")
    if [ ${#missing[@]} = 0 ]; then
        return
    fi
    case $(uname -s) in
    Darwin) have brew && brew_install netcdf hdf5 octave python || true ;;
    *) have apt-get && apt_install netcdf-bin hdf5-tools octave python3-venv || true ;;
    esac
    hash -r
    for program in ncdump h5dump octave-cli; do
        have "$program" || die "$program is not here and cannot be installed; the tests read maps with it"
    done
    python_with_venv >/dev/null ||
        die "there is no Python 3.11 or newer with venv, and none can be installed; the tests read maps with it"
}

install_python_packages() {
    export SLIPMAP_PYTHON=$SLIPMAP_ROOT/target/readers-venv/bin/python
    install_packages readers-venv requirements-readers.txt ||
        die "the packages of scripts/requirements-readers.txt cannot be installed: see above why; the tests read maps with them"
    export SLIPMAP_CF_CHECKER=$SLIPMAP_ROOT/target/cf-venv/bin/compliance-checker
    install_packages cf-venv requirements-cf.txt || leave_out the_compliance_checker \
        "maps are not checked against the CF conventions: compliance-checker cannot be installed"
}

# The Python package as a wheel in the environment of the readers: its tests, its types, and the notebooks of the guide.
install_module() {
    local venv=$SLIPMAP_ROOT/target/readers-venv made=target/module-wheel
    rm -rf "$made"
    # With the profile of the tests, so that what it needs is built once.
    PATH="$venv/bin:$PATH" step maturin build --manifest-path python/Cargo.toml --profile release --locked --compatibility linux --out "$made"
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall "$made"/*.whl >&2
}
test_module() {
    local venv=$SLIPMAP_ROOT/target/readers-venv
    (
        cd python
        # Not `python -m`: that would find the sources here before the module that is installed.
        step "$venv/bin/pytest"
        step "$venv/bin/pytest" --pyargs --doctest-modules slipmap
        step "$venv/bin/pytest" --doctest-glob="*.md" ../doc/guide/python.md
        step "$venv/bin/mypy"
        step "$venv/bin/stubtest" slipmap._core
        step "$venv/bin/basedpyright" --pythonpath "$venv/bin/python"
    )
}

octave_reads_netcdf() {
    octave-cli --no-gui --norc --quiet --eval "pkg load netcdf" >/dev/null 2>&1 && have gnuplot && have gs
}
r_reads_hdf5() { have Rscript && Rscript -e 'library(hdf5r)' >/dev/null 2>&1; }
julia_reads_netcdf() { have julia && julia -e 'using CairoMakie, Interpolations, NCDatasets' >/dev/null 2>&1; }

# What only the examples in scripts/read need.
install_languages() {
    if ! octave_reads_netcdf; then
        { have apt-get && apt_install octave-netcdf gnuplot-nox ghostscript fonts-freefont-otf; } || true
        octave_reads_netcdf || leave_out the_example_for_octave \
            "scripts/read/read_map.m is not run: Octave's package netcdf, gnuplot or Ghostscript is missing"
    fi
    if ! r_reads_hdf5; then
        { have apt-get && apt_install r-base-core r-cran-hdf5r; } || true
        r_reads_hdf5 || leave_out the_example_for_r_ "scripts/read/read_map.R is not run: R or its package hdf5r is missing"
    fi
    julia_reads_netcdf || leave_out the_example_for_julia \
        "scripts/read/read_map.jl is not run: Julia or one of NCDatasets, Interpolations, CairoMakie is missing"
}

# Rust for WebAssembly, and Node, which runs what is made with it.
check_static_page() {
    if ! have_wasm; then
        leave_out the_static_page "the page without a server is neither made nor checked: there is no standard library for $WASM here"
    elif ! have node; then
        leave_out the_static_page "the page without a server is not run: Node is missing"
    fi
}

# Slurm and what proves who one is to it.
have_slurm() {
    local program
    for program in slurmctld slurmd sbatch munged; do
        PATH="$PATH:/usr/sbin:/sbin" have "$program" || return 1
    done
}
install_slurm() {
    have_slurm || { have apt-get && apt_install slurm-wlm munge; } || true
    hash -r
    have_slurm || warnings+=("tests/slurm/run.sh is not run: Slurm or munge is missing and cannot be installed")
}

install_cargo_deny() {
    cargo_tool cargo-deny "$CARGO_DENY" ||
        warnings+=("licences and sources of dependencies are not checked, cargo-deny cannot be built")
}

# What the guide is made and checked with.
install_guide_tools() {
    cargo_tool mdbook "$MDBOOK" --no-default-features --features search || warnings+=("the guide is not built, mdbook cannot be built")
    install_packages guide-venv requirements-guide.txt ||
        warnings+=("spelling is not checked, the package of scripts/requirements-guide.txt cannot be installed")
}

# The guide as a book in target/guide, and its spelling.
check_guide() {
    local typos=target/guide-venv/bin/typos
    [ ! -x "$typos" ] || step "$typos"
    have mdbook || return 0
    step mdbook build doc
    [ -s target/guide/guide/equations.html ] || die "the guide has no equation index"
    export SLIPMAP_GUIDE=$SLIPMAP_ROOT/target/guide
}

# Advisories need the network, which may not be there; all else is in the manifests.
check_licences() {
    have cargo-deny || return 0
    step cargo deny --locked check bans licenses sources
    if ! cargo deny --locked check advisories; then
        cargo deny --locked --offline check advisories >/dev/null 2>&1 ||
            warnings+=("advisories on dependencies are not checked, or there are some: see above")
    fi
}

# step COMMAND…: runs it and says so.
step() {
    say ""
    say "== $*"
    "$@"
}

install_readers
install_python_packages
install_languages
if have_browser; then
    browser=1
else
    browser=
    warnings+=("the page is not tested in a browser: Node $NODE_NEEDED or newer, npm or Chromium is missing")
fi
check_static_page
install_slurm
install_cargo_deny
install_guide_tools
rust_is_tested=$(version_of rustc)
[ "$rust_is_tested" = "$RUST_TESTED" ] ||
    say "the Rust here is ${rust_is_tested:-unknown}; what is committed passed with $RUST_TESTED"

# Property tests draw the same cases every time; scripts/soak.sh draws others.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-1997}

features=(--features external-readers)
# shellcheck disable=SC2206
features+=($SLIPMAP_CARGO_FEATURES)

if cargo fmt --version >/dev/null 2>&1; then
    step cargo fmt --all --check
else
    warnings+=("formatting is not checked, rustfmt is not installed (rustup component add rustfmt)")
fi
if cargo clippy --version >/dev/null 2>&1; then
    step cargo clippy --locked --all-targets "${features[@]}" -- -D warnings
    step cargo clippy --locked --package slipmap-python -- -D warnings
else
    warnings+=("lints are not checked, clippy is not installed (rustup component add clippy)")
fi
step scripts/features.sh
RUSTDOCFLAGS="-D warnings" step cargo doc --locked --no-deps "${features[@]}"
check_licences
check_guide
install_module
step cargo test --release --locked "${features[@]}" -- ${left_out[@]+"${left_out[@]}"}
test_module
if [ -n "$browser" ]; then
    make_static_page
    step test_browser
fi
if have_slurm; then
    step tests/slurm/run.sh
fi
for warning in ${warnings[@]+"${warnings[@]}"}; do
    say "warning: $warning"
done
say "all that was tried passed; left out: ${#warnings[@]}"
