#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the page's replica, and compares it with the native program. usage: replica_test.sh SESSION_FILES
set -euo pipefail
cd "$(dirname "$0")/../.."
if why=$(scripts/web.sh --missing); then
    echo "web_replica_test is left out: $why" >&2
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
scripts/web.sh --replica
"$1" "$folder" >"$folder/list"
node tests/web/replica_test.mjs build/web/bin "$folder" "$folder/list"
