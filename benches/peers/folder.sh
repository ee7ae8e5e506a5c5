# Sourced by the scripts of this folder: what they share before they measure.

# shellcheck shell=bash

# started ROUNDS_BY_DEFAULT [ROUNDS] [FOLDER]: sets rounds and work, the folder of the run; a temporary one is removed at
# the end.
started() {
    rounds=${2:-$1}
    [[ $rounds =~ ^[1-9][0-9]*$ ]] || {
        echo "usage: $0 [ROUNDS] [FOLDER]; ROUNDS is a number from 1 on" >&2
        exit 2
    }
    if [ -n "${3:-}" ]; then
        mkdir -p "$3"
        work=$(cd "$3" && pwd)
    else
        work=$(mktemp -d)
        trap 'rm -rf "$work"' EXIT
    fi
}

# python_of SCRIPT: an environment in $work/venv with what the head of the script asks for.
python_of() {
    if [ ! -x "$work/venv/bin/python" ]; then
        "${PYTHON:-python3}" -m venv "$work/venv"
    fi
    sed -n 's/^#   "\(.*\)",$/\1/p' "$1" >"$work/requirements.txt"
    "$work/venv/bin/pip" install --quiet --disable-pip-version-check -r "$work/requirements.txt"
}
