#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs three sessions: one undisturbed, one while a hostile program sends frames to the haptic server, and one whose haptic
# server is a hostile program. Prints frame times, memory, refused frames and hashes. The exit status is 1 if the state hash
# of a session differs from its journal's. It is also 1 if ranks or server diverge, or if the master loses its link to the
# real server.
#
# usage: scripts/checks/hostile.sh [--tls] [FRAMES [SEED]]     (default: 1000000 hostile frames in each session; SEED: the time)
#        --secret-file FILE                             secrets for both roles; without FILE, --tls makes one
# With a secret, a false server can only send one bad frame per connection. It then sends 30 of them.
set -euo pipefail
link=() secret='' tls=
while [[ ${1:-} == --* ]]; do
    case $1 in
        --tls) tls=--tls; shift ;;
        --secret-file) secret=$(realpath "$2"); shift 2 ;;
        *) echo "hostile.sh: $1: unknown option; use --tls or --secret-file FILE" >&2; exit 2 ;;
    esac
done
cd "$(dirname "$0")/../.."
frames=${1:-1000000}
seed=${2:-$(date +%s)}
wall=walls/configs/desktop.toml
scene=scenes/writing.toml
bin=${SANDWALL_BIN:-build/release/bin}
[[ -d $bin ]] || { echo "hostile.sh: SANDWALL_BIN: $bin is not a folder; unset it, or set it to the folder of the programs" >&2; exit 2; }
folder=$(mktemp -d)
if [[ -n $tls && -z $secret ]]; then
    secret=$folder/secret
    (umask 077; printf '%s %s\n' move "$(openssl rand -hex 32)" watch "$(openssl rand -hex 32)" >"$secret")
fi
[[ -z $secret ]] || link=(--secret-file "$secret" ${tls:+"$tls"})
server=
trap 'exec 3>&- 2>/dev/null; [[ -z $server ]] || kill "$server" 2>/dev/null || true; rm -rf "$folder"' EXIT

resident() { awk '/VmRSS/ {printf "%.1f", $2 / 1024}' "/proc/$1/status"; }

# resident_meanwhile PID WORKER: prints the resident memory of PID [MiB] while WORKER runs. The five numbers are from the
# start, the end of each quarter of the time, and the end.
resident_meanwhile() {
    local seen=()
    while kill -0 "$2" 2>/dev/null; do
        seen+=("$(resident "$1")")
        sleep 1
    done
    local last=$((${#seen[@]} - 1)) quarter
    for quarter in 0 1 2 3 4; do
        printf '%s%s' "${seen[$((last * quarter / 4))]}" "$([[ $quarter == 4 ]] || echo ' → ')"
    done
}
# The command line of mpirun holds that of the master, but does not begin with it.
master_of() { pgrep -n -f "^[^ ]*/sandwall-master .*--out $folder/$1( |\$)"; }

# start_session NAME HOST:PORT: starts a session with its own standard input; end_session stops it over this input.
start_session() {
    mkfifo "$folder/$1.in"
    exec 3<>"$folder/$1.in"
    scripts/sandwall run --wall "$wall" --scene "$scene" --gl osmesa --haptic "$2" "${link[@]}" --out "$folder/$1" --no-pictures \
        <"$folder/$1.in" >"$folder/$1.log" 2>&1 &
    session=$!
    # On a busy machine mpirun takes many seconds to start the master.
    until master=$(master_of "$1"); do
        kill -0 "$session"
        sleep 0.2
    done
    sleep 5
    before=$(resident "$master")
}

# end_session NAME: stops the session and prints its row of the table.
end_session() {
    after=$(resident "$master")
    echo stop >&3
    wait "$session" || [[ $? == 1 ]]  # 1: the report is NOT GOOD, as when the only haptic server is a false one
    python3 - "$folder/$1/summary.json" "$1" "$before" "$after" \
        "$("$bin/sandwall-replay" "$folder/$1/session.journal" --hash)" <<'PYTHON' || failed=1
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, "scripts/launcher")
from ask import session_results
file, name, before, after, replayed = sys.argv[1:]
told = session_results.read_summary(file)
ms = told["frame_ms"]
refused = told["haptic"].get("refused", {})
count = {side: {kind: number for kind, number in kinds.items() if number} for side, kinds in refused.items()}
divergences, reconnects = told["divergences"] + told["server_divergences"], told["haptic"]["reconnects"]
same = "equal" if replayed.strip() == told["state_hash"] else "DIFFERENT"
print(f'| {name} | {ms["p50"]:.2f} | {ms["p99"]:.2f} | {ms["max"]:.2f} | {told["frames"]} | {before} → {after} | '
      f'{divergences} | {reconnects} | {count} | {same} |')
# In the run against-master every reconnection is to the false server, so reconnects are allowed there.
sys.exit(same != "equal" or divergences > 0 or (reconnects > 0 and name != "against-master"))
PYTHON
}

start_server() {
    rm -f "$folder/port"
    "$bin/sandwall-haptic-server" --scene "$scene" --device script:gis --listen 127.0.0.1:0 --port-file "$folder/port" "${link[@]}" \
        >"$folder/server.log" 2>&1 &
    server=$!
    while [[ ! -f $folder/port ]]; do sleep 0.1; done
    port=$(<"$folder/port")
}

echo "seed $seed, $frames hostile frames each"
echo "| run | frame p50 ms | p99 | max | frames | master MiB | divergences | reconnects | refused | hash of a replay |"
echo "|---|---|---|---|---|---|---|---|---|---|"
failed=0
start_server
start_session undisturbed "127.0.0.1:$port"
sleep 20
end_session undisturbed
start_session "against-server" "127.0.0.1:$port"
"$bin/sandwall-hostile" --scene "$scene" --server "$port" --frames "$frames" --seed "$seed" "${link[@]}" \
    >"$folder/hostile.log" &
hostile=$!
memory=$(resident_meanwhile "$server" "$hostile")
wait "$hostile"
memory="memory of the server at the start and after each quarter of that time: $memory MiB; $(<"$folder/hostile.log")"
end_session "against-server"
kill "$server"; wait "$server" || true; server=
SANDWALL_EVENTS=1 "$bin/sandwall-hostile" --scene "$scene" --frames "$([[ -n $secret ]] && echo 30 || echo "$frames")" --seed "$seed" \
    "${link[@]}" >"$folder/false.log" 2>"$folder/false.events" &
false_server=$!
address=$(python3 scripts/launcher/base/events.py "$folder/false.events" listening address)
start_session "against-master" "$address"
wait "$false_server"
end_session "against-master"
echo
echo "$memory"
sed -n '/seed/p' "$folder/false.log"
exit "$failed"
