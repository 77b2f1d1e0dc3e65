#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a session on an emulated cluster on this machine. Every host is a network namespace with its own name, its own
# address and its own link of 1 Gbit/s. Each host has one render rank, and the ranks communicate over TCP. Hosts share no
# folder with the machine of the master that a session writes. Needs root, or a kernel that allows unprivileged user namespaces. Removes the namespaces at its end. docs/cluster.md
set -euo pipefail

usage() {
    cat >&2 <<'END'
usage: scripts/checks/emulate_cluster.sh --out DIR [--wall FILE] [--scene FILE] [--hosts N] [--spares N] [--cut HOST@SECONDS] [--doctor] [-- OPTION...]
       scripts/checks/emulate_cluster.sh --check          # exit status 0 if this machine can emulate hosts, else 1
       scripts/checks/emulate_cluster.sh --tear-down      # removes the namespaces of a killed run
  --wall, --scene   default: walls/configs/tiled_3x4.toml, scenes/writing.toml
  --hosts N         number of hosts, over which the ranks are dealt in turn, so that each comes several times (default:
                    one host per rank)
  --spares N        number of spare hosts, which draw only when another host cannot (default: 0)
  --cut node03@10   takes the link of node03 down 10 seconds after the first frame; can be repeated
  --doctor          examines all hosts before the session, and ends with status 1 if a check is red
  --rate RATE       rate of every link in both directions (default: 1gbit)
  OPTION            more options of sandwall run, such as --steps 600
END
    exit 2
}

root=$(cd "$(dirname "$0")/../.." && pwd)
bin=${SANDWALL_BIN:-$root/build/release/bin}
wall=$root/walls/configs/tiled_3x4.toml scene=$root/scenes/writing.toml
out='' hosts='' spares=0 rate=1gbit doctor='' cuts=() more=()
network=10.77.0
prefix=sandwall-emulated-

# remove PREFIX: kills the processes in all namespaces whose name begins with PREFIX, and removes the namespaces with their
# links.
remove() {
    local name
    for name in $(ip netns list | awk -v prefix="$1" 'index($1, prefix) == 1 { print $1 }'); do
        ip netns pids "$name" | xargs --no-run-if-empty kill -KILL 2>/dev/null || true
        ip netns delete "$name" || true
    done
}

need() { command -v "$1" >/dev/null || { echo "emulate_cluster.sh: $1 is missing; run scripts/install_dependencies.sh" >&2; exit 2; }; }

# Succeeds if the kernel allows all that add_host() below needs.
can_make_hosts() {
    local name=${prefix}probe-$$ status=0
    ip netns add "$name" 2>/dev/null || return 1
    { ip netns exec "$name" unshare --uts true && ip -n "$name" link add veth0 type veth peer name veth1 &&
        ip -n "$name" link add switch0 type bridge &&
        tc -n "$name" qdisc add dev veth0 root tbf rate 1gbit burst 256kb latency 50ms; } 2>/dev/null || status=1
    ip netns delete "$name"
    return $status
}

# Runs a command as root of its own user namespace, with its own /run for the names of network namespaces.
# shellcheck disable=SC2016  # the inner shell expands it
in_user_namespace=(unshare --user --map-root-user --net --mount
    sh -c 'mount -t tmpfs none /run && mkdir /run/netns && exec "$@"' sh env SANDWALL_IN_USER_NAMESPACE=1)

arguments=("$@")
while [[ $# -gt 0 ]]; do
    case "$1" in
        --out) out=${2:?}; shift 2 ;;
        --wall) wall=${2:?}; shift 2 ;;
        --scene) scene=${2:?}; shift 2 ;;
        --hosts) [[ ${2:?} =~ ^[1-9][0-9]*$ ]] || usage; hosts=$2; shift 2 ;;
        --spares) spares=${2:?}; shift 2 ;;
        --cut) [[ ${2:?} =~ ^node[0-9]+@[0-9.]+$ ]] || usage; cuts+=("$2"); shift 2 ;;
        --doctor) doctor=1; shift ;;
        --rate) rate=${2:?}; shift 2 ;;
        --check)
            need ip; need tc; need unshare
            can_make_hosts && exit 0
            [[ -z ${SANDWALL_IN_USER_NAMESPACE:-} ]] && "${in_user_namespace[@]}" "$0" --check 2>/dev/null && exit 0
            exit 1 ;;
        --tear-down) need ip; remove "$prefix"; exit 0 ;;
        --) shift; more=("$@"); break ;;
        *) usage ;;
    esac
done
[[ -n $out ]] || usage
[[ -d $bin ]] || { echo "emulate_cluster.sh: SANDWALL_BIN: $bin is not a folder; unset it, or set it to the folder of the programs" >&2; exit 2; }
need ip; need tc; need unshare
if ! can_make_hosts; then
    if [[ -n ${SANDWALL_IN_USER_NAMESPACE:-} ]] || ! "${in_user_namespace[@]}" "$0" --check 2>/dev/null; then
        echo "emulate_cluster.sh: this machine does not allow network namespaces; run it with sudo, or allow user namespaces" >&2
        exit 2
    fi
    exec "${in_user_namespace[@]}" "$0" "${arguments[@]}"
fi

ranks=$("$bin/sandwall-check" "$wall" --ranks)
hosts=${hosts:-$ranks}
slots=$(((ranks + hosts - 1) / hosts)) # of a spare, which takes the place of any host
gl=osmesa
[[ -f $bin/sandwall-gl-osmesa.so ]] || gl=egl
mkdir -p "$out"
out=$(realpath "$out")
mine=$prefix$$-
folder=$(mktemp -d /tmp/sandwall-emulated-XXXXXX)
helpers=()
tear_down() {
    [[ ${#helpers[@]} -eq 0 ]] || kill "${helpers[@]}" 2>/dev/null || true
    remove "$mine"
    rm -rf "$folder"
}
trap tear_down EXIT
trap 'exit 130' INT TERM HUP

# The master's host holds the switch.
ip netns add "${mine}head"
ip -n "${mine}head" link set lo up
ip -n "${mine}head" link add switch type bridge
ip -n "${mine}head" address add "$network.1/24" dev switch
ip -n "${mine}head" link set switch up

# add_host NUMBER: makes a namespace with a link to the switch.
add_host() {
    local name
    name=$(printf 'node%02d' "$1")
    ip netns add "$mine$name"
    ip -n "$mine$name" link set lo up
    ip -n "${mine}head" link add "$name" type veth peer name eth0 netns "$mine$name"
    ip -n "${mine}head" link set "$name" master switch up
    ip -n "$mine$name" address add "$network.$((10 + $1))/24" dev eth0
    ip -n "$mine$name" link set eth0 up
    tc -n "${mine}head" qdisc add dev "$name" root tbf rate "$rate" burst 256kb latency 50ms
    tc -n "$mine$name" qdisc add dev eth0 root tbf rate "$rate" burst 256kb latency 50ms
    echo "$name $network.$((10 + $1))" >>"$folder/addresses"
}
for ((host = 1; host <= hosts + spares; ++host)); do
    add_host "$host"
done
for ((rank = 0; rank < ranks; ++rank)); do
    printf 'node%02d\n' $((1 + rank % hosts)) >>"$folder/hosts"
done
for ((host = hosts + 1; host <= hosts + spares; ++host)); do
    printf 'node%02d slots=%d spare\n' "$host" "$slots" >>"$folder/hosts"
done

# This program replaces ssh. To test whether a host can be reached, it connects to a closed port: a host that can be reached
# refuses the connection at once. Open MPI shares folders and memory within a machine; each host gets its own folder, so
# that these hosts share neither. An empty folder hides that of the session, as on a machine without a shared file system.
# SANDWALL_JOB is removed, so that the launcher cannot find their processes.
cat >"$folder/agent" <<END
#!/bin/bash
host=\$1; shift
address=\$(sed -n "s/^\$host //p" "$folder/addresses")
said=\$(timeout 3 bash -c "exec 3<>/dev/tcp/\$address/1" 2>&1)
case \$said in *refused*) ;; *) echo "connect to host \$host (\$address): No route to host" >&2; exit 255 ;; esac
export TMPDIR="$folder/tmp-\$host" OMPI_MCA_btl_vader_backing_directory="$folder/tmp-\$host"
unset SANDWALL_JOB
mkdir -p "\$TMPDIR"
exec ip netns exec "$mine\$host" unshare --uts --mount sh -c "hostname \$host; mount -t tmpfs none '$out'; \$*"
END
chmod +x "$folder/agent"

# on_head COMMAND...: runs a command on the master's host.
on_head() { exec ip netns exec "${mine}head" unshare --uts sh -c 'hostname head; exec "$@"' sh "$@"; }

# cut HOST SECONDS: takes the link of HOST down SECONDS after the first frame.
cut() {
    until [[ -S $out/control ]]; do sleep 0.1; done
    sleep "$2"
    ip -n "${mine}head" link set "$1" down
    echo "emulate_cluster.sh: the link of $1 is down" >&2
}
rm -f "$out/control"
for one in "${cuts[@]}"; do
    cut "${one%@*}" "${one#*@}" &
    helpers+=($!)
done

echo "emulate_cluster.sh: $hosts hosts for $ranks render ranks, $spares spares, one host for the master; links of $rate" >&2
export OMPI_MCA_plm_rsh_agent=$folder/agent TMPDIR=$folder/tmp-head
mkdir -p "$TMPDIR"
status=0
hosts_options=(--gl "$gl" --out "$out" --network "$network.0/24")
[[ -z $doctor ]] || (on_head "$root/scripts/sandwall" doctor "$folder/hosts" "${hosts_options[@]}") || exit 1
on_head "$root/scripts/sandwall" run --wall "$wall" --scene "$scene" --hosts "$folder/hosts" "${hosts_options[@]}" "${more[@]}" &
session=$!
trap 'kill -INT $session 2>/dev/null' INT TERM HUP
# A signal ends `wait` before the session ends.
while kill -0 "$session" 2>/dev/null; do
    wait "$session" && status=0 || status=$?
done
exit "$status"
