#!/usr/bin/env bash
# What a refactoring is to leave as it was, a line with a checksum for each thing:
#
#   scripts/freeze.sh PROGRAM [FOLDER] >before.txt
#   scripts/freeze.sh OTHER_PROGRAM [FOLDER] >after.txt; diff before.txt after.txt
#
# Maps, traces and pictures of every shipped sweep and case, long ones with fewer points, and of small sweeps of every kind of
# system; what commands say, as text and as JSON; answers of the server; help, schemas and the guide's reference; messages on
# mistakes. Not when and by which revision a file was made. FOLDER keeps all of it, to see what differs in a line. Takes six
# minutes on two cores. Needs curl and h5py: SLIPMAP_PYTHON, or what scripts/test.sh installs.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}
[ $# = 1 ] || [ $# = 2 ] || die "usage: scripts/freeze.sh PROGRAM [FOLDER]"
program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
[ -x "$program" ] || die "$1 is no program"
python=${SLIPMAP_PYTHON:-$root/target/readers-venv/bin/python}
"$python" -c 'import h5py' 2>/dev/null || die "h5py is not here; scripts/test.sh installs it"
command -v curl >/dev/null || die "curl is not here"

server='' own_folder=''
# Ends what is still running, and leaves no files.
clean_up() {
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    [ -z "$own_folder" ] || rm -rf "$own_folder"
}
trap clean_up EXIT
if [ $# = 2 ]; then
    mkdir -p "$2"
    folder=$(cd "$2" && pwd)
    [ -z "$(ls -A "$folder")" ] || die "$2 is not empty"
else
    own_folder=$(mktemp -d)
    folder=$own_folder
fi
cd "$folder"
mkdir said
export LC_ALL=C.UTF-8 NO_COLOR=1
unset COLUMNS
revision=$("$program" --version | sed -n 's/.*(\(.*\))/\1/p')

# sum_of FILE: its SHA-256.
sum_of() { if command -v sha256sum >/dev/null; then sha256sum "$1"; else shasum -a 256 "$1"; fi | cut -d ' ' -f 1; }

# kept NAME: a line for what is read, which is kept under that name; without the revision, times of day and how long plans take.
kept() {
    local file
    file=said/$(printf '%s' "$1" | tr -c 'A-Za-z0-9_=.,-' '_' | cut -c 1-200)
    sed -E -e "s/${revision:-no revision}/REVISION/g" -e 's/[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z/TIME/g' \
        -e '/^time  .* (tiles|cells) timed$/d' -e 's/"(seconds|(tiles|cells)_timed)":(\[[^]]*\]|[^,}]*)/"\1":0/g' >"$file"
    printf '%s  %s\n' "$(sum_of "$file")" "$1"
}

# told WORDS…: a line for all that slipmap says, and its exit code.
told() {
    { "$program" "$@" 2>&1 </dev/null && echo "exit 0" || echo "exit $?"; } | kept "slipmap $*"
}

# both WORDS…: the same as text and as JSON.
both() {
    told "$@"
    told "$@" --json
}

# made VERB FILE: lines for the map or trace of a file here and its picture; a line for the message where there is none.
made() {
    local name=${2%.toml}
    if "$program" -q "$1" "$2" >"$name.out" 2>"$name.err"; then
        "$python" "$root/scripts/map_sums.py" "$name.h5"
        [ ! -e "$name.png" ] || printf '%s  %s\n' "$(sum_of "$name.png")" "$name.png"
        [ "$1" = run ] || kept "slipmap $1 $2" <"$name.out"
    else
        kept "slipmap $1 $2" <"$name.err"
    fi
}

# points_of SWEEP: the most points along an axis, where all of them would take long.
points_of() {
    case $1 in
    coulomb_load) echo 25 ;;
    basin_share) echo 24 ;;
    robust_velocity) echo 6 ;;
    robust_load) echo 15 ;;
    vc_velocity | vc_mixed) echo 15 ;;
    velocity_at_fig3b | velocity_at_fig3b_lobe) echo 49 ;;
    *) echo 1000000 ;;
    esac
}

shipped() {
    local sweep name
    for sweep in "$root"/sweeps/*.toml; do
        name=$(basename "$sweep" .toml)
        awk -v most="$(points_of "$name")" '
            match($0, /points = [0-9]+/) && substr($0, RSTART + 9, RLENGTH - 9) + 0 > most + 0 {
                $0 = substr($0, 1, RSTART - 1) "points = " most substr($0, RSTART + RLENGTH)
            }
            { print }' "$sweep" >"$name.toml"
        if grep -q '^\[axes\]' "$name.toml"; then made run "$name.toml"; else made simulate "$name.toml"; fi
    done
}

# swept NAME LINE…: a sweep of these lines.
swept() {
    local name=$1
    shift
    printf '%s\n' "$@" >"$name.toml"
    made run "$name.toml"
}

STATE_LAW='[friction]
law = "rate-and-state"
mu0 = 0.6
v_star = 1.0
direct_effect = 0.1
evolution_effect = 0.4
slip_distance = 1.0'
WEAKENING='[friction]
law = "weakening"
mu0 = 0.5
v_s = 0.5'
OF_ROOTS='"n_unstable", "delay_margin", "abscissa", "abscissa_2", "abscissa_5", "frequency", "frequency_2", "relaxation_time",
    "certificate_margin", "reason", "d_abscissa_d_tau", "d_abscissa_d_alpha_v", "d_abscissa_d_alpha_n"'
OF_MARGINS='"n_unstable", "gain_margin_lower", "gain_margin_upper", "phase_margin", "latency_margin"'
TAU='tau = { from = 0.0, to = 9.0, points = 19 }'

# Every kind of feedback and friction, over velocity control and over load control.
small_sweeps() {
    local kind fixed control axis name lags='load_lag = 0.1
velocity_lag = 0.2
sensor_lag = 0.05'
    for kind in letter memory latency lags all; do
        case $kind in
        letter) fixed='' ;;
        memory) fixed='memory = 0.6' ;;
        latency) fixed='latency = 0.3' ;;
        lags) fixed=$lags ;;
        all) fixed="memory = -0.4
latency = 0.2
$lags" ;;
        esac
        for control in velocity load; do
            case $control in
            velocity) axis='alpha_v = { from = -0.9, to = 0.1, points = 13 }' ;;
            load) axis='alpha_n = { from = -6.0, to = 0.6, points = 13 }' ;;
            esac
            name=${kind}_${control}
            swept "roots_$name" "fields = [$OF_ROOTS, \"d_abscissa_d_mu_prime\", \"essential_abscissa\"]" 'boundaries = true' \
                '[axes]' 'mu_prime = [-0.3, 0.2]' "$axis" "$TAU" '[fixed]' 'mass = 2.0' 'stiffness = 1.5' "$fixed"
            swept "margins_$name" "fields = [$OF_MARGINS]" '[axes]' "${axis/points = 13/points = 7}" \
                "${TAU/points = 19/points = 10}" '[fixed]' 'mu_prime = -0.2' "$fixed"
            swept "best_$name" 'best = true' 'degree_of_stability = [0.05]' '[axes]' "$axis" "$TAU" \
                '[fixed]' 'mu_prime = -0.3' "$fixed"
            swept "roots_state_$name" "fields = [$OF_ROOTS, \"stiffness_ratio\"]" 'boundaries = true' \
                '[axes]' 'stiffness = [0.3, 0.7]' "$axis" "$TAU" '[fixed]' 'v0 = 1.0' 'mass = 0.1' "$fixed" "$STATE_LAW"
        done
    done
    swept radius 'fields = ["n_unstable", "stability_radius"]' '[axes]' 'alpha_v = [-0.5, -0.3, 0.1]' 'tau = [3.5, 4.5]' \
        '[fixed]' 'mu_prime = -0.2'
    swept axes_beyond "fields = [$OF_ROOTS]" '[axes]' 'memory = [-0.5, 0.0, 0.5]' 'latency = [0.0, 0.4]' \
        'sensor_lag = [0.0, 0.2]' 'alpha_v = [-0.5, 0.0]' "$TAU" '[fixed]' 'mu_prime = -0.3'
    for kind in letter memory latency; do
        case $kind in
        letter) fixed='' ;;
        memory) fixed='memory = 0.5' ;;
        latency) fixed='latency = 0.1' ;;
        esac
        swept "motions_$kind" 'fields = ["n_unstable", "outcome", "settle_time", "last_release", "n_min", "peak_force"]' '[axes]' \
            'alpha_n = { from = -12.0, to = -1.0, points = 9 }' 'tau = { from = 0.1, to = 1.2, points = 9 }' \
            '[fixed]' 'v0 = 0.1' "$fixed" "$WEAKENING" '[start]' 'switch_on_phase = 0.5'
        swept "critical_$kind" 'fields = ["vc", "vc_lower", "vc_upper", "outcome", "method", "v_liftoff", "v_smooth"]' '[axes]' \
            'alpha_v = [-0.4, -0.2]' 'tau = [2.0, 4.15]' '[fixed]' "$fixed" "$WEAKENING"
        swept "switched_on_$kind" 'fields = ["vc", "outcome", "v_liftoff"]' 'protocol = "switch-on"' '[axes]' \
            'alpha_n = [-10.0, -5.0]' 'tau = [0.3, 0.5]' '[fixed]' "$fixed" "$WEAKENING"
        swept "basin_$kind" 'fields = ["basin_share", "basin_share_error", "basin_share_upper"]' '[axes]' 'alpha_n = [-10.0, -4.0]' \
            'tau = [0.3, 0.5]' '[fixed]' 'v0 = 0.1' "$fixed" "$WEAKENING" '[basin]' 'starts = 64'
    done
    local of_system='fields = ["n_unstable", "abscissa", "abscissa_3", "frequency", "delay_margin", "certificate_margin"]'
    while read -r name axis fixed; do
        swept "system_$name" "system = \"$name\"" "$of_system" 'boundaries = true' '[axes]' \
            "${axis/:/ = } points = 13 }" "$TAU" '[fixed]' "${fixed//;/
}"
    done <<'SYSTEMS'
letter alpha_v:{from=-0.9,to=0.1, mu_prime=-0.3;alpha_n=-0.5;memory=0.3;latency=0.2
lags alpha_n:{from=-4,to=1, mu_prime=-0.2;alpha_v=-0.1;load_lag=0.1;velocity_lag=0.0;sensor_lag=0.2
rate_state alpha_v:{from=-1.5,to=0.5, direct=0.2;evolution=0.5;state_time=1.5;load_memory=0.3;alpha_n=-0.5
turning width:{from=0,to=0.6, zeta=0.04
turning_two_modes width:{from=0,to=0.4, zeta=0.03
pd k_p:{from=-1,to=3, damping=0.2;stiffness=1;k_d=0.4;k_a=0.3
delayed_oscillator b:{from=-1,to=1, delta=1.5
pyragas_focus gain:{from=0,to=3, mu=0.2
SYSTEMS
}

commands() {
    local words
    local -a of
    local letter='--mu-prime=-0.3 --alpha-v=-0.33 --tau=4.15' load='--mu-prime=-0.3 --alpha-n=-3.65 --tau=0.465'
    local lags='--load-lag=0.1 --velocity-lag=0.2 --sensor-lag=0.05'
    local rig='--units=SI --mass=2 --stiffness=50 --normal-load=20 --mu-prime=-0.02 --mu-k=0.4 --alpha-v=-2 --tau=0.8'
    local weakening='--friction=weakening --mu0=0.5 --v-s=0.5' state='--friction=rate-and-state --mu0=0.6 --v-star=1
        --direct-effect=0.1 --evolution-effect=0.4 --slip-distance=1 --v0=1 --mass=0.1 --stiffness=0.4'
    printf '0,0.9\n0.2,0.7\n0.5,0.6\n1,0.5\n2,0.45\n' >law.csv

    for words in "$letter" "$load" "$load --alpha-v=-0.1" "$letter --memory=0.5" "$letter --latency=0.2" \
        "$load --memory=-0.3 --latency=0.1" "$letter $lags" "$load --memory=0.2 --latency=0.1 $lags" "$rig" \
        "$weakening --v0=0.35 --alpha-v=-0.33 --tau=4.15" "--friction=table --table=law.csv --v0=0.3 --alpha-v=-0.3 --tau=3" \
        "--friction=stribeck --mu0=0.4 --mu-s=0.6 --v-s=0.3 --v0=0.2 --alpha-n=-5 --tau=0.3" \
        "--friction=coulomb --mu0=0.5 --v0=0.2 --alpha-n=-5 --tau=0.3" "$state --alpha-v=-0.5 --tau=2" \
        "$state --alpha-n=-2 --tau=0.5 --load-memory=0.2 --memory=0.3 --latency=0.1" '--mu-prime=0.2 --tau=1'; do
        read -ra of <<<"$(tr '\n' ' ' <<<"$words")"
        both point "${of[@]}" --roots=8 --line=-0.1
        both margins "${of[@]}"
    done
    both margins --mu-prime=-0.3 --alpha-n=-3.65 --tau=0.465 --decay=0.1
    for words in '--mu-prime=-0.3' '--mu-prime=-0.3 --control=load' '--mu-prime=-0.3 --memory=0.5' '--mu-prime=-0.3 --latency=0.2' \
        "--mu-prime=-0.2 --control=load $lags" '--mu-prime=-0.3 --control=load --robust=0.05' "$weakening --v0=0.35" \
        '--mu-prime=-0.2 --memory=0.3 --latency=0.2 --sensor-lag=0.1' "$state"; do
        read -ra of <<<"$(tr '\n' ' ' <<<"$words")"
        both best "${of[@]}"
    done
    while read -r words; do
        read -ra of <<<"$words"
        both point --system "${of[@]}" --roots=6
        # The last parameter is searched.
        words=${of[${#of[@]} - 1]#--set=}
        unset "of[${#of[@]}-1]"
        both best --system "${of[@]/--tau=*/--tau-to=9}" --search="${words%%=*}" --search-from=-1 --search-to=1
    done <<'SYSTEMS'
letter --tau=4.15 --set=mu_prime=-0.3 --set=alpha_n=0 --set=alpha_v=-0.33
letter --tau=4.15 --set=mu_prime=-0.3 --set=alpha_n=0 --set=memory=0.4 --set=latency=0.2 --set=alpha_v=-0.33
lags --tau=0.5 --set=mu_prime=-0.2 --set=alpha_v=0 --set=load_lag=0.1 --set=velocity_lag=0.1 --set=sensor_lag=0 --set=alpha_n=-0.9
rate_state --tau=2 --set=direct=0.2 --set=evolution=0.5 --set=state_time=1.5 --set=load_memory=0.3 --set=alpha_n=0 --set=alpha_v=-0.5
turning --tau=7 --set=zeta=0.04 --set=width=0.2
turning_two_modes --tau=7 --set=width=0.1
pd --tau=0.4 --set=damping=0.1 --set=stiffness=1 --set=k_d=0.4 --set=k_a=0.2 --set=k_p=0.5
delayed_oscillator --tau=2 --set=delta=1.5 --set=b=0.2
pyragas_focus --tau=2 --set=mu=0.2 --set=gain=0.9
SYSTEMS
    for words in '--alpha-v=-0.33 --tau=4.15' '--alpha-n=-10 --tau=0.5' '--alpha-n=-10 --tau=0.5 --memory=0.4' \
        '--alpha-v=-0.33 --tau=4.15 --latency=0.1' '--alpha-v=-0.33 --tau=4.15 --protocol=switch-on --phase=0.2'; do
        read -ra of <<<"$weakening $words"
        both vc "${of[@]}"
    done
    both vc --friction=coulomb --mu0=0.5 --alpha-n=-5 --tau=0.3
    both vc --friction=stribeck --mu0=0.4 --mu-s=0.6 --v-s=0.3 --alpha-n=-5 --tau=0.3
    both vc --friction=table --table=law.csv --mu-s=1 --alpha-v=-0.3 --tau=3
    both vc --protocol=limit --gamma=0.25 --mu-ratio=0.5
    for words in '--alpha-v=-0.33 --tau=4.15 --v0=0.35' '--alpha-n=-10 --tau=0.5 --v0=0.1' \
        '--alpha-n=-10 --tau=0.5 --v0=0.1 --memory=0.4 --latency=0.05'; do
        read -ra of <<<"$weakening $words"
        both simulate "${of[@]}" --fresh
        both basin "${of[@]}" --starts=256
        both basin "${of[@]}" --starts=64 --over=phase
    done
    both plan fig3a.toml
    for words in fig2a fig4 rate_state_load velocity_memory_late turning_lobes vc_load basin_share; do
        both plan "$words.toml" --threads=2 --memory=500MB
    done
    told best --mu-prime=-0.3 --robust=0.05 --save=saved.toml
    both point --setting=saved.toml
    both margins --setting=saved.toml
    told best --friction=weakening --mu0=0.5 --v-s=0.5 --v0=0.35 --save=saved_law.toml
    both simulate saved_law.toml
    both point --map=fig2a.h5 --at=mu_prime=-0.3 --at=alpha_v=-0.4 --at=tau=4
    both point --map=roots_all_velocity.h5 --at=mu_prime=-0.3 --at=alpha_v=-0.4 --at=tau=4
    both vc --map=vc_load.h5 --at=mu_prime_rest=-1 --at=alpha_n=-10 --at=tau=0.5
    both simulate --map=motions_latency.h5 --at=alpha_n=-10 --at=tau=0.5 --fresh
    told -q reproduce --quick --json
    for words in fig2a fig3a fig4 rate_state_load velocity_memory_late turning_lobes roots_all_velocity system_pd best_letter_load; do
        both info "$words.h5"
        told export "$words.h5" --comments
        both verify "$words.h5"
    done
    told export best_letter_load.h5 --table=boundaries
    told export fig3a.h5 --table=events
}

# The head and the arrays of a chart, but for the time that it took.
WITHOUT_TIME='
import json, sys
body = sys.stdin.buffer.read()
end = 4 + int.from_bytes(body[:4], "little")
head = json.loads(body[4:end])
head.pop("milliseconds")
print(json.dumps(head))
print(body[(end + 7) // 8 * 8 :].hex())
'

# The server's answers to the same texts as in files.
answers() {
    local link address token what
    "$program" serve --port 0 --threads 2 said >link 2>/dev/null &
    server=$!
    for _ in 1 2 3 4 5 6 7 8 9 10; do
        [ -s link ] && break
        sleep 0.5
    done
    link=$(head -n 1 link)
    address=${link%%/\?token=*} token=${link##*token=}
    ask() {
        curl -sS -i -H "Authorization: Bearer $token" "${@:2}" "$address/api/v1/$1" |
            grep -avi '^date:' | kept "server $1 ${3:-}"
    }
    for what in parameters openapi.json; do
        ask "$what"
    done
    printf '%s\n' '[fixed]' 'mu_prime = -0.3' 'alpha_v = -0.33' 'tau = 4.15' >asked_letter
    printf '%s\n' '[fixed]' 'mu_prime = -0.3' 'alpha_v = -0.33' 'tau = 4.15' 'memory = 0.4' 'latency = 0.1' >asked_late
    printf '%s\n' '[fixed]' 'v0 = 1.0' 'mass = 0.1' 'alpha_v = -0.5' 'tau = 2.0' "$STATE_LAW" >asked_state
    printf '%s\n' '[fixed]' 'v0 = 0.35' 'alpha_v = -0.33' 'tau = 4.15' "$WEAKENING" >asked_law
    for what in letter late state law; do
        ask point --data-binary "@asked_$what" -H 'Content-Type: application/toml'
        ask law --data-binary "@asked_$what" -H 'Content-Type: application/toml'
    done
    for what in vc motion; do
        ask $what --data-binary @asked_law -H 'Content-Type: application/toml'
    done
    for what in roots_letter_velocity roots_all_load roots_state_memory_velocity motions_latency system_pd; do
        curl -sS -H "Authorization: Bearer $token" -H 'Content-Type: application/toml' --data-binary "@$what.toml" \
            "$address/api/v1/chart" | "$python" -c "$WITHOUT_TIME" | kept "server chart $what.toml"
    done
    kill "$server"
    wait "$server" 2>/dev/null || true
    server=''
}

texts() {
    local name
    told --help
    told help
    for name in $("$program" help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p'); do
        told help "$name"
        told "$name" -h
        [ "$name" = help ] || told man "$name"
        told schema "$name"
    done
    for name in command-line fields laws map-file parameters sweep-files; do
        told reference "$name"
    done
    for name in bash zsh fish; do
        told completions "$name"
    done
}

mistakes() {
    local name=0 line
    told
    told points
    told point
    told point --mu-prime=-0.3 --tau=-1
    told point --mu-prime=nan --tau=1
    told point --mu-prime=-0.3 --tau=1 --memory=1.5
    told point --mu-prime=-0.3 --tau=1 --latency=-1
    told point --mu-prime=-0.3 --tau=1 --friction=weakening
    told point --system=lags --tau=1
    told point --system=none.toml --tau=1
    told point --system=turning --tau=1 --set=zeta=1 --set=none=2
    told point --system=pd --tau=1 --mu-prime=1
    told best
    told best --mu-prime=-0.3 --alpha-from=1 --alpha-to=0
    told vc --friction=weakening --mu0=0.5 --v-s=0.5 --tau=1 --load-lag=1
    told vc --friction=rate-and-state --tau=1
    told vc --protocol=limit --gamma=-1
    told simulate --friction=weakening --mu0=0.5 --v-s=0.5 --tau=1
    told basin --starts=100
    told margins --system=pd --tau=1
    told run none.toml
    told info none.h5
    told info law.csv
    told plot fig4.h5 --field=none
    told export fig4.h5 --at=none=1
    told schema run
    while IFS= read -r line; do
        name=$((name + 1))
        printf '%b' "$line" >"mistake_$name.toml"
        told run "mistake_$name.toml"
    done <<'SWEEPS'

title = "no axes"\n
[axes\n
[axes]\nmu_prime = { from = 0, to = 1 }\n
[axes]\nmu_primo = [1.0]\ntau = [1.0]\n
[axes]\ntau = { from = 2, to = 1, points = 5 }\n[fixed]\nmu_prime = -0.3\nalpha_q = 1\n
fields = ["abscisa"]\n[axes]\ntau = [1.0]\n
fields = ["vc"]\n[axes]\ntau = [1.0]\n[fixed]\nmu_prime = 1.0\n
fields = ["latency_margin"]\n[axes]\ntau = [1.0]\n[fixed]\nv0 = 1\n[friction]\nlaw = "rate-and-state"\n
fields = ["outcome"]\n[axes]\ntau = [1.0]\n[fixed]\nv0 = 1\nload_lag = 0.1\n[friction]\nlaw = "coulomb"\nmu0 = 0.5\n
system = "pdd"\n[axes]\ntau = [1.0]\n
system = "pd"\nfields = ["gain_margin_upper"]\n[axes]\ntau = [1.0]\nk_p = [1.0]\n
system = { P = "s^2 + ", Q = "1" }\n[axes]\ntau = [1.0]\n
system = { P = "s + k", Q = "s^2" }\n[axes]\ntau = [1.0]\nk = [1.0]\n
SWEEPS
}

shipped
small_sweeps
commands
answers
texts
mistakes
