#!/usr/bin/env bash
# Charts the stability lobes of turning, of seven masses and of a tool with two modes by slipmap, by Python packages and by
# plain numpy, and counts wrong cells.
#
#   benches/peers/lobes.sh [ROUNDS] [FOLDER]
#
# ROUNDS is 2 unless given. FOLDER keeps the Python environment; without it that is made in a temporary folder and removed.
# Takes about seven minutes, ten on a busy machine. Needs Python 3.11 or newer with venv, and PyPI. $SLIPMAP names a
# program that is built already; without it one is built. What is measured stands at the heads of turning_lobes.py and
# matrix_lobes.py.
set -euo pipefail

peers=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=benches/peers/folder.sh
. "$peers/folder.sh"
started 2 "$@"
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
python_of "$script"
uptime
"$work/venv/bin/python" "$script" "$rounds"
"$work/venv/bin/python" "$peers/matrix_lobes.py" "$rounds"
uptime
