#!/usr/bin/env bash
# Charts the stability lobes of turning by slipmap, by Python packages and by plain numpy, and counts wrong cells.
#
#   benches/peers/lobes.sh [ROUNDS] [FOLDER]
#
# ROUNDS is 2 unless given. FOLDER keeps the Python environment; without it that is made in a temporary folder and removed.
# Takes about seven minutes, ten on a busy machine. Needs Python 3.11 or newer with venv, and PyPI. $SLIPMAP names a
# program that is built already; without it one is built. What is measured stands at the head of turning_lobes.py.
set -euo pipefail

rounds=${1:-2}
[[ $rounds =~ ^[1-9][0-9]*$ ]] || {
    echo "usage: $0 [ROUNDS] [FOLDER]; ROUNDS is a number from 1 on" >&2
    exit 2
}
if [ -n "${2:-}" ]; then
    mkdir -p "$2"
    work=$(cd "$2" && pwd)
else
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi
peers=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ -z "${SLIPMAP:-}" ]; then
    # shellcheck source=scripts/setup.sh
    . "$peers/../../scripts/setup.sh"
    cd "$SLIPMAP_ROOT"
    # shellcheck disable=SC2086
    cargo build --quiet --release --locked $SLIPMAP_CARGO_FEATURES
    export SLIPMAP=${CARGO_TARGET_DIR:-target}/release/slipmap
fi
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

script=$peers/turning_lobes.py
if [ ! -x "$work/venv/bin/python" ]; then
    "${PYTHON:-python3}" -m venv "$work/venv"
fi
# What the script's header asks for.
sed -n 's/^#   "\(.*\)",$/\1/p' "$script" >"$work/requirements.txt"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check -r "$work/requirements.txt"
uptime
"$work/venv/bin/python" "$script" "$rounds"
uptime
