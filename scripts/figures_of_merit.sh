#!/usr/bin/env bash
# All benches in one go, and the tables of doc/guide/figures.md, with machine and date:
#
#   scripts/figures_of_merit.sh [--peers] [--browser] [--short]
#
#   --peers     also the crate differential-equations and JiTCDDE (benches/peers/run.sh), and charts by Python packages and
#               numpy (benches/peers/lobes.sh)
#   --browser   also the page in a headless browser beside plotly.js and h5web (scripts/browser.sh bench --peers)
#   --short     as little of each as shows that it works: its figures mean nothing
#
# What each bench prints is kept in target/figures-of-merit, and scripts/figures_table.py makes the tables of it. On a machine with
# other work ratios mean more than times. Takes 15 minutes on two idle cores with peers and browser, 6 without.
set -euo pipefail

# shellcheck source=scripts/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$SLIPMAP_ROOT"

peers='' browser='' short=''
for argument in "$@"; do
    case $argument in
    --peers) peers=1 ;;
    --browser) browser=1 ;;
    --short) short=1 ;;
    *) die "unknown argument $argument: see the head of scripts/figures_of_merit.sh" ;;
    esac
done
[ -z "$short" ] || export SLIPMAP_BENCH_CELLS=60 SLIPMAP_CELLS=5

folder=target/figures-of-merit
mkdir -p "$folder"
rm -f "$folder"/*.txt

# kept NAME COMMAND…: runs it, shows what it prints and keeps that.
kept() {
    local name=$1
    shift
    say ""
    say "== $*"
    "$@" 2>&1 | tee "$folder/$name.txt"
}

for bench in throughput roots general margins motion critical; do
    # The features are words of their own, or nothing at all.
    # shellcheck disable=SC2086
    kept "$bench" cargo bench --locked $SLIPMAP_CARGO_FEATURES --bench "$bench"
done
[ -z "$peers" ] || kept peers benches/peers/run.sh ${short:+1}
[ -z "$peers" ] || kept lobes benches/peers/lobes.sh ${short:+1}
[ -z "$browser" ] || kept browser scripts/browser.sh bench --peers

processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
[ -n "$processor" ] || processor=$(sysctl -n machdep.cpu.brand_string 2>/dev/null || uname -m)
threads=$(getconf _NPROCESSORS_ONLN)
load=$(uptime | sed 's/.*load average[s]*: //')
revision=$(git describe --always --dirty 2>/dev/null || echo unknown)
{
    printf '%s, %s threads, load %s, %s, revision %s%s\n\n' "$processor" "$threads" "$load" "$(date +%F)" "$revision" \
        "${short:+, SHORT RUN: figures mean nothing}"
    python3 scripts/figures_table.py "$folder"
} | tee "$folder/table.md"
