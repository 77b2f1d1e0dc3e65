#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages of Debian 12 or 13 that Sandwall needs. Prints nothing and needs no password if all of them are installed.
set -euo pipefail

tools=(
    g++ cmake ninja-build pkg-config python3 python3-glad   # build and launcher
    openmpi-bin                                             # the cluster
    xvfb iproute2                                           # tests; an emulated cluster
    libstb-dev fonts-dejavu-core                            # letters, which the build draws
)
libraries=(
    libopenmpi-dev                                          # the cluster
    libboost-dev                                            # Asio, Endian, Lockfree: headers alone
    libosmesa6-dev libglm-dev                               # drawing
    libegl-dev libgl1-mesa-dri                              # off screen on graphics cards
    libglfw3-dev libx11-dev libxrandr-dev libxcursor1       # windows, monitors by name, hiding the cursor
    libtomlplusplus-dev libcli11-dev libfmt-dev             # files, options, messages
    libxxhash-dev libzstd-dev libpng-dev nlohmann-json3-dev # hashes, states, pictures, summaries
    libfast-float-dev                                       # numbers in texts
    libgdal-dev libmuparser-dev                             # terrain from rasters, pictures and formulas
    libssl-dev                                              # secrets and TLS on the haptic link
    libgtest-dev libbenchmark-dev libcgal-dev               # tests and benchmarks
)
cross=''
refuse() { echo "install_dependencies.sh: $*" >&2; exit 2; }

# Adds node and npm where they are missing. They may have come from elsewhere, and Debian's packages would conflict with them.
add_node() {
    if ! command -v node >/dev/null; then
        tools+=(nodejs)
    else
        local version
        version=$(node --version)
        [[ $version =~ ^v([0-9]+)\. && ${BASH_REMATCH[1]} -ge 18 ]] || refuse "node is $version; the web page needs node 18 or later"
    fi
    if ! command -v npm >/dev/null; then
        # The package nodejs of another source contains npm, and conflicts with Debian's package.
        local conflicts
        conflicts=$(dpkg-query -W -f='${Conflicts}' nodejs 2>/dev/null || true)
        [[ -z $(command -v node) || " ${conflicts//,/ } " != *" npm "* ]] || refuse "node has another source; install its own npm"
        tools+=(npm)
    fi
}

# The tests also build with clang, to prove that the state hash does not depend on the compiler. They validate the files and
# events of sessions against the schemas. They make and check a Debian package, and move pointer and windows with xdotool and
# openbox. They switch the monitors of Xorg's dummy driver. scripts/test.sh builds faster with ccache. The report draws its
# curves with matplotlib, and ffmpeg makes a video of a film's pictures. A bar separates packages that replace each other: the
# script installs the first that this Debian has.
for option in "$@"; do
    case "$option" in
        --with-tests) tools+=("clang-14|clang-19" python3-jsonschema dpkg-dev file help2man lintian openbox \
            universal-ctags xdotool xserver-xorg-core xserver-xorg-video-dummy ccache) ;;
        --with-web) tools+=(emscripten); add_node ;;                      # the web page; docs/web.md
        --with-browsers) tools+=(chromium firefox-esr xauth) ;;         # its tests in browsers
        --with-report) tools+=(python3-matplotlib) ;;
        --with-film) tools+=(ffmpeg) ;;                                  # docs/film.md
        --for-arm64) cross=arm64; tools+=(g++-aarch64-linux-gnu qemu-user) ;; # for cmake/Arm64.cmake; docs/testing.md
        *) echo "usage: scripts/install_dependencies.sh [--with-tests] [--with-web] [--with-browsers] [--with-report] [--with-film] [--for-arm64]" >&2; exit 2 ;;
    esac
done
packages=("${tools[@]}" "${libraries[@]/%/${cross:+:$cross}}")

# One line PACKAGE:ARCHITECTURE for each of these packages that is installed.
native=$(dpkg --print-architecture)
names=(${packages[@]//|/ })
installed=$(dpkg-query -W -f='${Package}:${Architecture} ${db:Status-Status}\n' "${names[@]%:*}" 2>/dev/null | sed -n 's/ installed$//p' || true)

# is_installed PACKAGE[:ARCHITECTURE]: succeeds if it is installed for this architecture or for all (default: this machine's).
is_installed() {
    local architecture=$native
    [[ $1 != *:* ]] || architecture=${1#*:}
    [[ $'\n'$installed$'\n' == *$'\n'"${1%:*}:$architecture"$'\n'* || $'\n'$installed$'\n' == *$'\n'"${1%:*}:all"$'\n'* ]]
}

missing=()
for package in "${packages[@]}"; do
    found=''
    for alternative in ${package//|/ }; do
        is_installed "$alternative" && found=$alternative
    done
    [[ -n $found ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || { echo "install_dependencies.sh: run it as root, or install sudo; missing packages: ${missing[*]}" >&2; exit 2; }
    as_root=(sudo)
fi
[[ -z $cross ]] || "${as_root[@]}" dpkg --add-architecture "$cross"
"${as_root[@]}" apt-get update -qq
for i in "${!missing[@]}"; do
    [[ ${missing[i]} == *[:\|]* ]] || continue
    alternatives=(${missing[i]//|/ })
    missing[i]=${alternatives[-1]%:*} # apt knows a package for all architectures by its plain name alone
    for alternative in "${alternatives[@]}"; do
        [[ $(apt-cache policy "$alternative") == *"Candidate: "[0-9]* ]] && missing[i]=$alternative && break
    done
done
echo "installing: ${missing[*]}"
# Tools first: otherwise apt takes the compiler of the other architecture, which its libraries ask for.
mapfile -t first < <(printf '%s\n' "${missing[@]}" | grep -v ":" || true)
mapfile -t then < <(printf '%s\n' "${missing[@]}" | grep ":" || true)
install() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null; }
[[ ${#first[@]} -eq 0 ]] || install "${first[@]}"
[[ ${#then[@]} -eq 0 ]] || install "${then[@]}"
