#!/usr/bin/env bash
# Computes a map in N shards on one machine, JOBS at a time, and merges them: what an array scheduler does, in plain shell.
#
#     scripts/shards.sh SWEEP.toml MAP.h5 N [JOBS]
#
# The cores are shared out among the jobs (default: one job for each core). slipmap is looked for on the PATH, or is what the
# variable SLIPMAP names. The same command again goes on with what is missing.
set -euo pipefail

if [ $# -lt 3 ] || [ $# -gt 4 ]; then
    echo "usage: shards.sh SWEEP.toml MAP.h5 N [JOBS]" >&2
    exit 2
fi
sweep=$1 map=$2 shards=$3
slipmap=${SLIPMAP:-slipmap}
cores=$(getconf _NPROCESSORS_ONLN)
jobs=${4:-$cores}
threads=$((cores > jobs ? cores / jobs : 1))

seq "$shards" |
    xargs -P "$jobs" -I I "$slipmap" run "$sweep" -o "$map" --shard "I/$shards" --threads "$threads" --quiet
exec "$slipmap" merge "$map"
