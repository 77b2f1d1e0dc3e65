#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Opens sessions in a browser, and compares them with the native program. usage:
#   browser_test.sh chromium|firefox SESSION_FILES           two sessions, in the test run
#   browser_test.sh chromium|firefox SESSION_FILES --all     all sessions that SESSION_FILES writes
#   browser_test.sh chromium SESSION_FILES --pictures        the pictures of a grid, a TIN and three tools, with the wall's
#   browser_test.sh chromium|firefox FOLDER_OF_A_SESSION...  these sessions, such as out/demo
# Builds the page with what scripts/web.sh has fetched. Without that or the browser it says so, and its status is 77.
set -euo pipefail
cd "$(dirname "$0")/../.."
browser=$1
leave_out() {
    echo "web_in_${browser}_test is left out: $1" >&2
    exit 77
}
program=/usr/bin/chromium
[[ $browser == firefox ]] && program=/usr/bin/firefox-esr
[[ -x $program ]] || leave_out "$program is missing; scripts/install_dependencies.sh --with-browsers"
if why=$(scripts/web.sh --missing); then
    leave_out "$why"
fi
[[ -d web/node_modules/puppeteer-core && -d web/node_modules/three ]] || leave_out "web/node_modules is not whole; scripts/web.sh"
scripts/web.sh --page
display=()
if [[ $browser == firefox ]]; then
    command -v xvfb-run >/dev/null || leave_out "xvfb-run is missing; scripts/install_dependencies.sh --with-browsers"
    display=(xvfb-run -a)
fi
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
if [[ -d $2 ]]; then
    for session in "${@:2}"; do
        name=$(basename "$session")
        for part in "$session"/session.journal*; do
            cp "$part" "$folder/$name.journal${part#"$session/session.journal"}"
        done
        verified=$(build/release/bin/sandwall-replay "$session" --verify)
        hashes=$(sed -n 's/^hashes *\([0-9]*\) of .*/\1/p' <<<"$verified")
        steps=$(sed -n 's/^steps *\([0-9]*\) .*/\1/p' <<<"$verified")
        hash=$(build/release/bin/sandwall-replay "$session" --hash)
        echo "$name.journal 1 $steps $hashes $hash" >>"$folder/list"
    done
    "${display[@]}" node tests/web/browser_test.mjs "$browser" "$folder" "$folder/list"
    exit
fi
if [[ ${3:-} == --pictures ]]; then
    "$2" "$folder" pictures
    node scripts/figures/web_pictures.mjs "$folder/pictures" "$folder"/*.journal
    exit
fi
what=(browser)
[[ ${3:-} == --all ]] && what=()
"$2" "$folder" "${what[@]}" >"$folder/list"
"${display[@]}" node tests/web/browser_test.mjs "$browser" "$folder" "$folder/list"
if [[ $browser == chromium ]]; then
    node tests/web/no_picture_test.mjs "$folder/gis_tin.journal"
    node tests/web/touch_in_browser.mjs "$folder/gis_tin.journal"
    node tests/web/page_in_browser.mjs
    node tests/web/kept_in_browser.mjs
fi
