#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Takes pictures of the page with a session, at the size of a desktop and of a phone, in Chromium.
# usage: scripts/figures/web_shots.sh SESSION OUT   writes OUT/web.png, which docs/web.md shows, and OUT/web_phone.png
# Needs the page and puppeteer-core (scripts/web.sh) and Chromium.
set -euo pipefail
cd "$(dirname "$0")/../.."
mkdir -p "$2"
coproc server { exec scripts/sandwall web --port 0 "$1"; }
pid=$server_PID
trap 'kill "$pid"' EXIT
read -r address <&"${server[0]}"
node tests/web/browse.mjs chromium "$address" "$2/web.png" 960 640
node tests/web/browse.mjs chromium "$address" "$2/web_phone.png" 390 844 2
