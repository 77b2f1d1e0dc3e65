#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the sand, draws the curves and writes docs/report: README.md, pictures, and their tables.
#
#   scripts/report.sh           Everything: some 50 minutes on two quiet cores, plus the curves of a TIN.
#   scripts/report.sh --quick   Smaller fields and fewer runs, less than five minutes.
#   scripts/report.sh --draw    Only the pictures and the text, from the tables that exist.
set -euo pipefail
cd "$(dirname "$0")/.."
usage="usage: scripts/report.sh [--quick | --draw] [--out DIR]"

quick=no draw=no out=docs/report
while [[ $# -gt 0 ]]; do
    case "$1" in
        --quick) quick=yes; shift ;;
        --draw) draw=yes; shift ;;
        --out) [[ $# -gt 1 ]] || { echo "$usage" >&2; exit 2; }; out=$2; shift 2 ;;
        *) echo "$usage" >&2; exit 2 ;;
    esac
done
# Debian's own interpreter, because another python3 may come first in PATH, without Debian's matplotlib.
/usr/bin/python3 -c 'import matplotlib' 2>/dev/null ||
    { echo "report.sh: Debian's python3-matplotlib is missing; run scripts/install_dependencies.sh --with-report" >&2; exit 2; }
data=$out/data
mkdir -p "$data"
jobs=$(nproc)

# curve NAME FULL... -- QUICK...: runs the subcommand NAME with the options FULL, or QUICK under --quick.
curve() {
    local name=$1 kind=full
    shift
    local full=() small=()
    for word in "$@"; do
        if [[ $word == -- ]]; then kind=small; elif [[ $kind == full ]]; then full+=("$word"); else small+=("$word"); fi
    done
    [[ $quick == no ]] || full=("${small[@]}")
    echo "== $name"
    "$bench" "$name" "${full[@]}" --out "$data/$name.csv" 2>"$out/progress.txt" || { cat "$out/progress.txt" >&2; exit 1; }
}

# Hashes of every build that exists. The full report first makes the builds that are missing.
hash_table() {
    local presets=(release golden-clang-O3 golden-g++-O0 golden-g++-O2 golden-clang-O0)
    rm -f "$data"/hashes-*.csv
    for preset in "${presets[@]}"; do
        if [[ $quick == no ]]; then
            cmake --preset "$preset" >/dev/null
            cmake --build "build/$preset" --parallel "$jobs" --target sandwall_bench >/dev/null
        fi
        if [[ -x build/$preset/bin/sandwall-bench ]]; then
            echo "== hashes, $preset"
            "build/$preset/bin/sandwall-bench" hashes --sizes 64 --out "$data/hashes-$preset.csv" 2>"$out/progress.txt"
        fi
    done
}

# Whole sessions over 1, 4 and 12 render ranks, and the hash that one process gets from their journals.
rank_table() {
    echo "ranks,session_hash,replay_hash,divergences" >"$data/ranks.csv"
    local folder wall replay
    for wall in 1x1 2x2 3x4; do
        echo "== session on $wall tiles"
        folder=$(mktemp -d)
        sed "s/^columns = .*/columns = ${wall#*x}/; s/^rows = .*/rows = ${wall%x*}/" walls/configs/tiled_3x4.toml >"$folder/wall.toml"
        scripts/sandwall run --wall "$folder/wall.toml" --scene scenes/writing.toml --device script:gis --gl osmesa --pace fast \
            --steps 60 --out "$folder/out" >"$folder/log.txt" 2>&1 || { cat "$folder/log.txt" >&2; exit 1; }
        replay=$(build/release/bin/sandwall-replay "$folder/out/session.journal" --hash | grep -oE '[0-9a-f]{16}' | tail -1)
        /usr/bin/python3 - "$folder/out/summary.json" "$((${wall%x*} * ${wall#*x}))" "$replay" >>"$data/ranks.csv" <<'PYTHON'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, "scripts/launcher")
import session_results
summary = session_results.read_summary(sys.argv[1])
print(sys.argv[2], summary["state_hash"], sys.argv[3], summary["divergences"], sep=",")
PYTHON
        rm -r "$folder"
    done
}

# Latency from the hand to whole walls, directly and over an impaired link.
latency_table() {
    echo "== latency"
    "$bench" latency --out "$data/latency.csv" >"$out/progress.txt" 2>&1 || { cat "$out/progress.txt" >&2; exit 1; }
}

# Measures pictures of a large field with each bound of the level of detail.
detail_curve() {
    local options=(--sizes 1024,2048 --runs 5 --frames 12)
    [[ $quick == no ]] || options=(--sizes 2048 --runs 3 --frames 4)
    echo "== detail"
    build/release/bin/detail_bench "${options[@]}" --out "$data/detail.csv" 2>"$out/progress.txt" || { cat "$out/progress.txt" >&2; exit 1; }
}

measure() {
    scripts/install_dependencies.sh
    cmake --preset release >/dev/null
    if [[ $quick == yes ]]; then
        cmake --build build/release --parallel "$jobs" --target sandwall_bench detail_bench
    else
        cmake --build build/release --parallel "$jobs"
    fi
    bench=build/release/bin/sandwall-bench

    curve work-precision --sizes 16,32,64,128,256,512 --runs 10 -- --sizes 16,32,64,128 --runs 3
    curve error-at-rest --sizes 32,64,128,256,512 -- --sizes 32,64,128
    curve sweeps --sizes 32,64,128,256,512 -- --sizes 32,64,128
    curve anisotropy --sizes 64,256 -- --sizes 64,128
    curve decay --sizes 128 -- --sizes 64
    curve height-bits --sizes 32,64,128 -- --sizes 32,64
    curve band --sizes 128 -- --sizes 64
    curve edit --sizes 512,1024,2048 --runs 10 -- --sizes 512,2048 --runs 3
    curve dig --sizes 512,2048 --runs 10 -- --sizes 512,2048 --runs 1
    curve throughput --sizes 64,128,256,512,1024,2048,4096 --runs 10 -- --sizes 64,256,1024 --runs 5
    curve mass-drift --sizes 128 -- --sizes 64
    curve certificate --sizes 32,64,128,256 -- --sizes 32,64
    curve budget --sizes 64,128,256 -- --sizes 64
    curve force-rate --sizes 256 --runs 10 -- --sizes 256 --runs 2
    curve force-work --sizes 256 -- --sizes 256
    curve parts --sizes 512,1024,2048 --runs 10 -- --sizes 512 --runs 3
    curve stability --runs 10 -- --runs 1
    curve guarded-sweep --runs 10 -- --runs 1
    curve explain scenes/dunes.toml -- scenes/dunes.toml
    hash_table
    [[ $quick == yes ]] || rank_table
    [[ $quick == yes ]] || latency_table
    curve rest --sizes 512 --runs 10 -- --sizes 512 --runs 1
    curve rest-moving --sizes 256,512 --runs 10 -- --sizes 256 --runs 1
    detail_curve
    curve tin-piles --sizes 32,64,128,256 -- --sizes 32,64
    curve tin-simplify --sizes 256,1024 --runs 10 -- --sizes 256 --runs 1
    curve tin-imprint --sizes 512 --runs 10 -- --sizes 256 --runs 2
    curve tin-active --sizes 500 --runs 10 -- --sizes 200 --runs 3
    rm -f "$out/progress.txt"
}

[[ $draw == yes ]] || measure
/usr/bin/python3 scripts/figures/report_page.py "$data" "$out"
echo "the report: $out/README.md"
