#!/usr/bin/env bash
# Computes a map on Slurm: a job array of N shards, of which the last one makes the map.
#
#     scripts/slurm/submit.sh SWEEP.toml MAP.h5 N [options of sbatch]
#     scripts/slurm/submit.sh decay_load.toml /scratch/decay_load.h5 64 --cpus-per-task=8 --time=4:00:00
#
# Prints the number of the array. N may be N%M: at most M shards at once. MAP.h5 has to be on a file system that all nodes share.
# slipmap is looked for on the PATH, or is what the variable SLIPMAP names. The same command again goes on with what is missing.
set -euo pipefail

die() {
    printf 'error: %s\n' "$*" >&2
    exit 2
}

[ $# -ge 3 ] || die "usage: submit.sh SWEEP.toml MAP.h5 N [options of sbatch]"
sweep=$1 map=$2 array=$3
shift 3
[[ $array =~ ^[1-9][0-9]*(%[1-9][0-9]*)?$ ]] || die "the number of shards is 1 or more, N or N%M: $array"
[ -f "$sweep" ] || die "$sweep: there is no such file"
for option in "$@"; do
    case $option in
    -a* | --array*) die "$option: the array is set here" ;;
    esac
done
command -v "${SLIPMAP:-slipmap}" >/dev/null || die "slipmap is not on the PATH; the variable SLIPMAP can name it"
command -v sbatch >/dev/null || die "sbatch is not on the PATH: this is no machine from which Slurm takes jobs"
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

shards=$(sbatch --parsable "$@" --array="1-$array" "$here/shard.sbatch" "$sweep" "$map" "${array%%%*}")
# With the name of a cluster behind it where there are several.
printf '%s\n' "${shards%%;*}"
