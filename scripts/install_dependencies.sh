#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that Sandwall needs. Prints nothing and needs no password if all of them are installed.
set -euo pipefail

packages=(
    g++ cmake ninja-build pkg-config python3                # build and launcher
    openmpi-bin libopenmpi-dev                              # the cluster
    libboost-dev                                            # Asio, Endian, Lockfree: headers alone
    libosmesa6-dev libglm-dev python3-glad                  # drawing
    libegl-dev libgl1-mesa-dri                              # off screen on graphics cards
    libglfw3-dev libx11-dev libxrandr-dev libxcursor1       # windows, monitors by name, hiding the cursor
    libtomlplusplus-dev libcli11-dev libfmt-dev             # files, options, messages
    libxxhash-dev libzstd-dev libpng-dev nlohmann-json3-dev # hashes, states, pictures, summaries
    libfast-float-dev                                       # numbers in texts
    libgdal-dev libmuparser-dev                             # terrain from rasters, pictures and formulas
    libssl-dev                                              # secrets and TLS on the haptic link
    libgtest-dev libbenchmark-dev libcgal-dev xvfb iproute2 # tests and benchmarks; an emulated cluster
)
# The tests also build with clang, to prove that the state hash does not depend on the compiler. They validate the files and
# events of sessions against the schemas, make and check a Debian package, and move the pointer with xdotool. The report
# draws its curves with matplotlib.
for option in "$@"; do
    case "$option" in
        --with-tests) packages+=(clang-14 python3-jsonschema dpkg-dev file help2man lintian xdotool) ;;
        --with-report) packages+=(python3-matplotlib) ;;
        *) echo "usage: scripts/install_dependencies.sh [--with-tests] [--with-report]" >&2; exit 2 ;;
    esac
done

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ "$status" == "installed" ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || { echo "install_dependencies.sh: run it as root, or install sudo; missing packages: ${missing[*]}" >&2; exit 2; }
    as_root=(sudo)
fi
echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
