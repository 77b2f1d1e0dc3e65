#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the page's replica, and compares it with the native program, also what is dug in it.
# usage: replica_test.sh SESSION_FILES PAGE_SCENES REPLAY
set -euo pipefail
cd "$(dirname "$0")/../.."
if why=$(scripts/web.sh --missing); then
    echo "web_replica_test is left out: $why" >&2
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
scripts/web.sh --replica
node tests/web/keyframes_test.mjs
node tests/web/fetched_test.mjs
node tests/web/keeper_test.mjs
node tests/web/keys_test.mjs
node tests/web/beginnings_test.mjs
node tests/web/hand_source_test.mjs
node tests/web/hidden_tool_test.mjs
"$1" "$folder" >"$folder/list"
node tests/web/replica_test.mjs build/web/bin "$folder" "$folder/list"

"$2" "$folder" scenes/stroke.toml scenes/gis_tin.toml
node tests/web/panel_test.mjs build/web/bin "$folder/stroke.scene"
node tests/web/dig_test.mjs build/web/bin "$folder" "$folder"/{stroke,gis_tin}.scene >"$folder/dug"
count=0
while read -r file steps hash; do
    said=$("$3" --verify "$folder/$file")
    [[ $(grep -c "^steps *$steps without\|^left out *0 steps" <<<"$said") = 2 ]] || { echo "$file: $said"; exit 1; }
    found=$("$3" --hash "$folder/$file")
    [[ $found = "$hash" ]] || { echo "$file: the native program has $found, the page $hash"; exit 1; }
    echo "$file: dug in $steps steps, $hash in the native program, too"
    count=$((count + 1))
done <"$folder/dug"
[[ $count = 3 ]]
