#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the web page as static files in build/web/page. docs/web.md
#
# usage: scripts/web.sh             installs what web/package-lock.json names, and builds all
#        scripts/web.sh --page      builds all with what is installed; fetches nothing
#        scripts/web.sh --replica   builds only the replica for WebAssembly; fetches nothing
#        scripts/web.sh --missing   prints what --replica would miss and succeeds; fails if nothing is missing
set -euo pipefail
cd "$(dirname "$0")/.."

missing() {
    command -v emcmake >/dev/null || { echo "emscripten is missing; scripts/install_dependencies.sh --with-web"; return; }
    command -v node >/dev/null || { echo "node is missing; scripts/install_dependencies.sh --with-web"; return; }
    [[ -d web/node_modules/zstd-napi/deps/zstd/lib ]] || { echo "web/node_modules is missing; scripts/web.sh"; return; }
    return 1
}

# In a subshell, because the native compiler must not get what ccache needs for em++.
build_replica() (
    local launcher=()
    if command -v ccache >/dev/null; then
        # ccache does not know em++ by its name. Its flags are those of clang.
        export CCACHE_COMPILERTYPE=clang CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    # Debian's emscripten finds its JavaScript parser here.
    export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}
    emcmake cmake -S . -B build/web -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 "${launcher[@]}" >/dev/null
    cmake --build build/web --parallel "$(nproc)" --target replica
)

# Encodes the sample scenes for the page. Only the native program reads scene files.
build_scenes() {
    [[ -f build/release/CMakeCache.txt ]] || cmake --preset release >/dev/null
    cmake --build build/release --parallel "$(nproc)" --target page_scenes
    build/release/bin/page_scenes "$1" scenes/*.toml
}

build_page() {
    build_replica
    page=build/web/page
    mkdir -p "$page"
    (cd web && node build.mjs "../$page")
    cp build/web/bin/replica.mjs build/web/bin/replica.wasm "$page"
    build_scenes "$page"
    # The bundles and replica.wasm contain these works.
    for licence in web/node_modules/three/LICENSE web/node_modules/zstd-napi/deps/zstd/LICENSE \
        /usr/share/doc/{libxxhash-dev,libfmt-dev,libfast-float-dev,libglm-dev,emscripten}/copyright; do
        printf '==== %s\n\n' "$licence"
        cat "$licence"
    done >"$page/licences.txt"
    echo "$page: the page"
}

case ${1:-} in
    --missing) missing ;;
    --replica) build_replica ;;
    --page) build_page ;;
    '')
        (cd web && npm ci --ignore-scripts)
        build_page
        ;;
    *) echo "usage: scripts/web.sh [--page|--replica|--missing]" >&2; exit 2 ;;
esac
