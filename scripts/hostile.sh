#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a session undisturbed, then while somebody who means no good talks to its haptic server, then with such a one as
# its haptic server; prints what that did to the frames, the memory and the sand.
#
# usage: scripts/hostile.sh [FRAMES [SEED]]     1000000 hostile frames each time, and the time as the seed
set -euo pipefail
cd "$(dirname "$0")/.."
frames=${1:-1000000}
seed=${2:-$(date +%s)}
wall=walls/configs/desktop.toml
scene=scenes/writing.toml
bin=${SANDWALL_BIN:-build/release/bin}
folder=$(mktemp -d)
server=
trap 'exec 3>&- 2>/dev/null; [[ -z $server ]] || kill "$server" 2>/dev/null || true; rm -rf "$folder"' EXIT

resident() { awk '/VmRSS/ {printf "%.1f", $2 / 1024}' "/proc/$1/status"; }
master_of() { pgrep -n -f "sandwall-master .*--out $folder/$1( |\$)"; }

# start_session NAME HOST:PORT: with its own standard input, over which it is stopped
start_session() {
    mkfifo "$folder/$1.in"
    exec 3<>"$folder/$1.in"
    scripts/sandwall run --wall "$wall" --scene "$scene" --haptic "$2" --out "$folder/$1" --no-pictures \
        <"$folder/$1.in" >"$folder/$1.log" 2>&1 &
    session=$!
    sleep 5
    master=$(master_of "$1")
    before=$(resident "$master")
}

# end_session NAME
end_session() {
    after=$(resident "$master")
    echo stop >&3
    wait "$session"
    python3 - "$folder/$1/summary.json" "$1" "$before" "$after" "$("$bin/sandwall-replay" "$folder/$1/session.journal" --hash)" <<'PYTHON'
import json, sys
file, name, before, after, replayed = sys.argv[1:]
told = json.load(open(file))
ms = told["frame_ms"]
refused = told["haptic"].get("refused", {})
count = {side: sum(kinds.values()) for side, kinds in refused.items()}
same = "equal" if replayed.strip() == told["state_hash"] else "DIFFERENT"
print(f'| {name} | {ms["p50"]:.2f} | {ms["p99"]:.2f} | {ms["max"]:.2f} | {told["frames"]} | {before} → {after} | '
      f'{told["divergences"] + told["server_divergences"]} | {told["haptic"]["reconnects"]} | {count} | {same} |')
PYTHON
}

start_server() {
    rm -f "$folder/port"
    "$bin/sandwall-haptic-server" --scene "$scene" --device script:gis --listen 127.0.0.1:0 --port-file "$folder/port" \
        >"$folder/server.log" 2>&1 &
    server=$!
    while [[ ! -f $folder/port ]]; do sleep 0.1; done
    port=$(<"$folder/port")
}

echo "seed $seed, $frames hostile frames each"
echo "| run | frame p50 ms | p99 | max | frames | master MiB | divergences | reconnects | refused | hash of a replay |"
echo "|---|---|---|---|---|---|---|---|---|---|"
start_server
start_session undisturbed "127.0.0.1:$port"
sleep 20
end_session undisturbed
start_session "against-server" "127.0.0.1:$port"
memory=$(resident "$server")
"$bin/sandwall-hostile" --scene "$scene" --server "$port" --frames "$frames" --seed "$seed" >"$folder/hostile.log"
memory="$memory → $(resident "$server") MiB in the server; $(<"$folder/hostile.log")"
end_session "against-server"
kill "$server"; wait "$server" || true; server=
"$bin/sandwall-hostile" --scene "$scene" --frames "$frames" --seed "$seed" >"$folder/false.log" &
false_server=$!
while [[ ! -s $folder/false.log ]]; do sleep 0.1; done
start_session "against-master" "$(sed -n 's/listening on //p' "$folder/false.log")"
wait "$false_server"
end_session "against-master"
echo
echo "$memory"
sed -n '/seed/p' "$folder/false.log"
