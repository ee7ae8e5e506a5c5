#!/usr/bin/env bash
# Maps on a real Slurm: starts a controller and two nodes on the loopback interface, submits a job array, kills a node and jobs
# midway, and compares the map with the one that a single run makes; then the same through the queue, with a worker that dies. Everything is in one temporary
# folder and gone afterwards. Needs slurmctld, slurmd, sbatch, munged, and a Python with h5py (SLIPMAP_PYTHON).
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
python=${SLIPMAP_PYTHON:-python3}
export SLIPMAP=${SLIPMAP:-$root/target/release/slipmap}
# Seconds that any one thing may take; what it takes is far less.
PATIENCE=90
SHARDS=3

folder=$(mktemp -d "${TMPDIR:-/tmp}/slipmap-slurm.XXXXXX")
export SLURM_CONF=$folder/slurm.conf
PATH=$PATH:/usr/sbin:/sbin

say() { printf '%s\n' "$*" >&2; }
fail() {
    say "error: $*"
    exit 1
}

# ours [NAME=VALUE]: the processes that this script started, and all that came of them: they have its Slurm in their environment.
ours() {
    local environment pid
    for environment in /proc/[0-9]*/environ; do
        pid=${environment#/proc/} pid=${pid%/environ}
        if [ "$pid" != $$ ] && [ "$pid" != "$BASHPID" ] &&
            grep -qzx "SLURM_CONF=$SLURM_CONF" "$environment" 2>/dev/null &&
            { [ $# = 0 ] || grep -qzx "$1" "$environment" 2>/dev/null; }; then
            echo "$pid"
        fi
    done
}

# steps [NODE]: the processes of Slurm that watch over the jobs; they have nothing in their environment.
steps() {
    local pid parent
    for pid in $(ours ${1:+"SLURMD_NODENAME=$1"}); do
        parent=$(ps -o ppid= -p "$pid" | tr -d ' ')
        if [ -n "$parent" ] && [[ $(ps -o comm= -p "$parent") == slurmstepd* ]]; then
            echo "$parent"
        fi
    done | sort -u
}

clean_up() {
    local code=$? pids
    trap - EXIT
    if [ $code != 0 ]; then
        tail -n 15 "$folder"/*.log "$folder"/work/*.log >&2 2>/dev/null || true
    fi
    # More may have come while the first were being killed.
    for _ in 1 2 3; do
        mapfile -t pids < <(steps && ours)
        [ ${#pids[@]} = 0 ] || kill -KILL "${pids[@]}" 2>/dev/null || true
    done
    rm -rf "$folder"
    exit $code
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# wait_for WHAT COMMAND…: until the command succeeds.
wait_for() {
    local what=$1 end=$((SECONDS + PATIENCE))
    shift
    until "$@"; do
        [ $SECONDS -lt $end ] || fail "no $what within $PATIENCE seconds"
        sleep 0.1
    done
}

configure() {
    local user ports
    user=$(id -un)
    read -ra ports < <("$python" -c '
import socket
sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(3)]
print(*(s.getsockname()[1] for s in sockets))')
    # munged wants its socket to be reachable.
    chmod 755 "$folder"
    mkdir "$folder/state" "$folder/spool-n1" "$folder/spool-n2" "$folder/work"
    (umask 077 && head -c 1024 /dev/urandom >"$folder/munge.key")
    cat >"$SLURM_CONF" <<EOF
ClusterName=slipmap
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.sock,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/pgid
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1
SlurmdTimeout=4
ReturnToService=2
KillWait=5
MailProg=$(command -v true)
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=2
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=${ports[2]} CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
EOF
}

start_node() {
    SLIPMAP_NODE=$1 slurmd -D -N "$1" >>"$folder/slurmd-$1-said.log" 2>&1 &
    disown
}

start_slurm() {
    munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.sock" \
        --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/munged.seed" \
        >"$folder/munged-said.log" 2>&1 &
    disown
    wait_for "munged" test -S "$folder/munge.sock"
    slurmctld -D >"$folder/slurmctld-said.log" 2>&1 &
    disown
    start_node n1
    start_node n2
    wait_for "idle nodes" nodes_are_idle
}

nodes_are_idle() { [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ]; }

# pieces MAP SHARD: how many of the shard are computed and safe.
pieces() {
    "$SLIPMAP" status "$1" --json 2>/dev/null | "$python" -c '
import json, sys
shards = {s["shard"]: s["pieces_done"] for s in json.loads(sys.stdin.read() or "{\"shards\": []}")["shards"]}
print(shards.get(sys.argv[1], 0))' "$2/$SHARDS"
}

# more_than PIECES MAP SHARD: so many are computed, and more.
more_than() { [ "$(pieces "$2" "$3")" -gt "$1" ]; }

# task_on NODE: the shard that runs there.
task_on() { squeue -h -t RUNNING -w "$1" -o %K; }
runs_on() { [ -n "$(task_on "$1")" ]; }

# program_of SHARD: the process that computes it.
program_of() {
    local pid
    for pid in $(ours "SLURM_ARRAY_TASK_ID=$1"); do
        if [ "$(readlink "/proc/$pid/exe" 2>/dev/null)" = "$(readlink -f "$SLIPMAP")" ]; then
            echo "$pid"
        fi
    done
}

# kill_node NODE: its daemon, what watches over its jobs, and the jobs, at once.
kill_node() {
    local victims
    mapfile -t victims < <(ours "SLIPMAP_NODE=$1" && steps "$1" && ours "SLURMD_NODENAME=$1")
    [ ${#victims[@]} -ge 4 ] || fail "node $1 has only ${#victims[@]} processes"
    kill -KILL "${victims[@]}"
}

# restarts SHARD: how often its task was requeued.
restarts() { scontrol show job -o "${shards}_$1" 2>/dev/null | sed -n 's/.* Restarts=\([0-9]*\) .*/\1/p'; }

# restarted SHARD [TIMES]
restarted() { [ "$(restarts "$1")" = "${2:-1}" ]; }

gone() { [ -z "$(squeue -h -j "$1" -o %i 2>/dev/null)" ]; }

# went_on SHARD: each of its runs began with less to compute than the one before, on the threads of the allocation; its log tells.
went_on() {
    "$python" - "cluster.h5.$1-of-$SHARDS.log" <<'EOF'
import json, sys
runs = [run for run in map(json.loads, open(sys.argv[1])) if run["event"] == "started"]
left = [run["cells_left"] for run in runs]
print(f"shard {runs[0]['shard']}: cells left at each start: {left}")
assert {run["threads"] for run in runs} == {2}
assert len(left) > 1 and all(after < before for before, after in zip(left, left[1:]))
EOF
}

"$python" -c 'import h5py' || fail "$python has no h5py; SLIPMAP_PYTHON can name one that has"
configure
cd "$folder/work"
cp "$here/sweep.toml" .

say "one run"
"$SLIPMAP" run sweep.toml -o single.h5 --threads 2 --quiet >/dev/null

say "Slurm $(sbatch --version | cut -d' ' -f2), two nodes"
start_slurm
shards=$("$root/scripts/slurm/submit.sh" sweep.toml cluster.h5 $SHARDS --cpus-per-task=2 --time=10)
[[ $shards =~ ^[0-9]+$ ]] || fail "submit.sh said: $shards"

wait_for "shard on n1" runs_on n1
wait_for "shard on n2" runs_on n2
on_n1=$(task_on n1) on_n2=$(task_on n2)
wait_for "pieces of shard $on_n1" more_than 0 cluster.h5 "$on_n1"
wait_for "pieces of shard $on_n2" more_than 0 cluster.h5 "$on_n2"

say "node n1 fails under shard $on_n1"
kill_node n1

say "the program of shard $on_n2 is killed"
mapfile -t victims < <(program_of "$on_n2")
[ ${#victims[@]} = 1 ] || fail "shard $on_n2 has ${#victims[@]} processes"
kill -KILL "${victims[@]}"
wait_for "restart of shard $on_n2" restarted "$on_n2"

for third in 1 2 3; do
    if [ $third != "$on_n1" ] && [ $third != "$on_n2" ]; then break; fi
done
wait_for "pieces of shard $third" more_than 0 cluster.h5 "$third"
say "shard $third is told that its time is up"
scancel --batch --signal=USR1 "${shards}_$third"
wait_for "restart of shard $third" restarted "$third"
computed=$(pieces cluster.h5 "$third")
wait_for "more pieces of shard $third" more_than "$computed" cluster.h5 "$third"
say "shard $third is requeued"
scontrol requeue "${shards}_$third"
wait_for "second restart of shard $third" restarted "$third" 2

wait_for "restart of shard $on_n1" restarted "$on_n1"
wait_for "end of the array" gone "$shards"
cat slipmap-"${shards}"_*.log
for shard in 1 2 3; do
    went_on $shard
done
# What scontrol says when it is asked for more tasks than one.
if grep 'No error' slipmap-*.log; then fail "a shard has requeued others"; fi
"$python" "$here/same_map.py" single.h5 cluster.h5
[ ! -e cluster.h5.tiles ] || fail "tiles are left"

say "a task is cancelled"
shards=$(sbatch --parsable --array=1 --cpus-per-task=2 "$root/scripts/slurm/shard.sbatch" sweep.toml cancelled.h5 $SHARDS)
wait_for "pieces of shard 1" more_than 0 cancelled.h5 1
scancel "$shards"
wait_for "end of the cancelled task" gone "$shards"
state=$(scontrol show job -o "${shards}_1" | grep -o 'JobState=[A-Z]*')
[ "$state" = JobState=CANCELLED ] || fail "the cancelled task is in $state"
grep -q interrupted "slipmap-${shards}_1.log" || fail "the program was not told to end"
# The queue. A worker's sbatch is the real one; the first worker dies when it has submitted, before it knows.
mkdir bin
cat >bin/sbatch <<EOF
#!/bin/sh
echo submitted >>"$folder/submissions"
"$(command -v sbatch)" "\$@" || exit
if [ ! -e "$folder/worker-died" ]; then
    : >"$folder/worker-died"
    kill -KILL \$PPID
    sleep 1
fi
EOF
chmod +x bin/sbatch

# work [OPTION…]: a worker, which hands each sweep to Slurm as so many shards.
work() {
    PATH=$PWD/bin:$PATH "$SLIPMAP" work queued --slurm $SHARDS --poll-every 0.5 --first-pause 0 "$@" \
        -- --cpus-per-task=2 --time=10 >>work.log 2>&1
}

# job_is STATE: what the queue says of the sweep.
job_is() {
    "$SLIPMAP" jobs queued --json | "$python" -c '
import json, sys
jobs = json.load(sys.stdin)["jobs"]
sys.exit([job["state"] for job in jobs if job["name"] == "100000-sweep"] != [sys.argv[1]])' "$1"
}

array_is_there() { squeue -h -o %j | grep -q '^slipmap-100000-sweep-'; }
no_array_is_there() { ! array_is_there; }
worker_has_ended() { ! kill -0 "$worker" 2>/dev/null; }
queued_map=queued/100000-sweep.h5

start_node n1
wait_for "idle nodes" nodes_are_idle
say "a worker dies between sbatch and its note"
"$SLIPMAP" submit sweep.toml --to queued
if work --until-empty; then fail "the worker did not die"; fi
[ -e "$folder/worker-died" ] || fail "the worker died of something else"
array_is_there || fail "nothing was submitted"
work --until-empty &
worker=$!
disown
wait_for "shard on n1" runs_on n1
on_n1=$(task_on n1)
wait_for "pieces of shard $on_n1" more_than 0 $queued_map "$on_n1"
[ "$(wc -l <"$folder/submissions")" = 1 ] || fail "it was submitted twice"
job_is running || fail "the sweep is not running"

say "the sweep is held, and released"
"$SLIPMAP" jobs hold 100000-sweep --in queued
wait_for "end of the held array" no_array_is_there
job_is held || fail "the sweep is not held"
computed=$(pieces $queued_map "$on_n1")
[ "$computed" -gt 0 ] || fail "what was computed is gone"
wait_for "end of the worker" worker_has_ended
"$SLIPMAP" jobs release 100000-sweep --in queued
work --until-empty &
worker=$!
disown
wait_for "more pieces of shard $on_n1" more_than "$computed" $queued_map "$on_n1"

say "a node fails under the sweep"
wait_for "shard on n2" runs_on n2
kill_node n2
start_node n2
wait_for "end of the worker" worker_has_ended
cat work.log
job_is done || fail "the sweep is not done"
"$python" "$here/same_map.py" single.h5 $queued_map
[ ! -e $queued_map.tiles ] || fail "tiles are left"
[ -z "$(find queued -name '.*slurm*')" ] || fail "logs of Slurm are left"

say "bad input fails at once, and says why"
"$SLIPMAP" submit sweep.toml --to refused
cp single.h5 refused/100000-sweep.h5
sed -i 's/points = 801/points = 800/' refused/queue/100000-sweep.toml
touch -d '1 minute ago' refused/queue/100000-sweep.toml
if "$SLIPMAP" work refused --slurm 2 --poll-every 0.5 --until-empty; then fail "it did not fail"; fi
grep -q 'the map of another sweep' refused/failed/100000-sweep.txt || fail "it does not say why"
say "done in $SECONDS s"
