#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the README's two commands on another version of Debian, as a fresh machine would. docs/testing.md
#
# debootstrap makes a root folder of that Debian once, in a cache folder. Each run copies it, and copies the sources of this
# folder into the copy. Mounts end with this script, because it has a mount namespace of its own.
set -euo pipefail

usage() {
    cat >&2 <<'END'
usage: scripts/test_on.sh SUITE [--again] [--ccache] [--mirror URL] [--cache DIR] [-- COMMAND...]
       scripts/test_on.sh SUITE --arch arm64 [--again] [--ccache] [--mirror URL] [--cache DIR]
  SUITE         name of a version of Debian, such as trixie
  --arch arm64  cross-compiles all programs for arm64, and runs the golden tests under qemu
  --again       continues in the root folder of the last run, with the sources of now
  --ccache      compiles with ccache, whose files stay in the cache folder
  --mirror URL  Debian's mirror (default: the one in apt's configuration)
  --cache DIR   folder for the roots (default: ~/.cache/sandwall-roots)
  COMMAND       runs this in the sources, in place of the README's commands
END
    exit 2
}
refuse() { echo "test_on.sh: $1" >&2; exit 2; }

root=$(cd "$(dirname "$0")/.." && pwd)
suite='' arch=amd64 mirror='' cache=${XDG_CACHE_HOME:-$HOME/.cache}/sandwall-roots again='' ccache='' command=()
while [[ $# -gt 0 ]]; do
    case "$1" in
        --arch) [[ ${2:-} == arm64 ]] || usage; arch=arm64; shift 2 ;;
        --mirror) mirror=${2:?--mirror needs a URL}; shift 2 ;;
        --cache) cache=$(realpath -m "${2:?--cache needs a folder}"); shift 2 ;;
        --again) again=1; shift ;;
        --ccache) ccache=1; shift ;;
        --) shift; command=("$@"); break ;;
        -*) usage ;;
        *) [[ -z $suite ]] || usage; suite=$1; shift ;;
    esac
done
[[ $suite =~ ^[a-z]+$ ]] || usage
[[ $EUID -eq 0 ]] || refuse "needs root, for debootstrap and chroot; run it with sudo"
command -v debootstrap >/dev/null || refuse "debootstrap: not found; run apt-get install debootstrap"
if [[ -z ${SANDWALL_TEST_ON:-} ]]; then
    exec env SANDWALL_TEST_ON=1 unshare --mount --propagation private "$0" "$suite" \
        ${mirror:+--mirror "$mirror"} --cache "$cache" $([[ $arch == arm64 ]] && echo --arch arm64) \
        ${again:+--again} ${ccache:+--ccache} -- "${command[@]}"
fi

# Prints the URL of the mirror that apt takes Debian's packages from on this machine.
mirror_of_apt() {
    apt-get indextargets --format '$(REPO_URI) $(CREATED_BY) $(ORIGIN)' 2>/dev/null |
        awk '$2 == "Packages" && $3 == "Debian" { print $1; exit }'
}

base=$cache/$suite work=$cache/$suite-$arch
if [[ ! -f $base.made ]]; then
    [[ -n $mirror ]] || mirror=$(mirror_of_apt)
    [[ -n $mirror ]] || refuse "apt's configuration names no mirror of Debian; give --mirror URL"
    echo "== making a root of Debian $suite from $mirror"
    mkdir -p "$cache"
    rm -rf "$base"
    debootstrap --variant=minbase "$suite" "$base" "$mirror" >"$base.log" 2>&1 ||
        { tail -n 5 "$base.log" >&2; refuse "debootstrap failed; its output is in $base.log"; }
    touch "$base.made"
fi
if [[ -z $again || ! -d $work ]]; then
    rm -rf "$work"
    cp -a "$base" "$work"
fi

# Mounts what programs of a running system expect. The packages that apt loads are kept for the next root.
enter() {
    local folder=$1
    mkdir -p "$cache/packages" "$folder/root/sandwall"
    mount --bind "$folder" "$folder" # ip netns can only change the mounts of a root that is one
    mount -t proc proc "$folder/proc"
    mount --rbind /sys "$folder/sys"
    mount --rbind /dev "$folder/dev"
    mount -t tmpfs tmpfs "$folder/dev/shm" # not that of this machine, whose sessions have files there
    mount -t tmpfs tmpfs "$folder/run"
    mount --bind "$cache/packages" "$folder/var/cache/apt/archives"
    rm -f "$folder/etc/apt/apt.conf.d/docker-clean"
    cp /etc/resolv.conf "$folder/etc/resolv.conf"
    if [[ -n $ccache ]]; then
        mkdir -p "$cache/ccache" "$folder/root/.cache/ccache"
        mount --bind "$cache/ccache" "$folder/root/.cache/ccache"
    fi
}

# inside ROOT COMMAND...: runs a command in the sources in ROOT, with the environment of a fresh login.
inside() {
    local folder=$1
    shift
    chroot "$folder" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive ${TERM:+TERM="$TERM"} \
        ${ccache:+CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache} \
        sh -c 'cd /root/sandwall && exec "$@"' sh "$@"
}

install() { inside "$work" sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends "$@" >/dev/null' sh "$@"; }

# Copies the sources as they are now, also those that are not committed. Keeps what was built. A changed file gets the present
# time, because its own may be older than what was built. Some tests ask git for the files.
copy_sources() {
    local sources=$work/root/sandwall
    (cd "$root" && git ls-files --cached --others --exclude-standard -z | xargs -0 ls -d 2>/dev/null) >"$work/root/files"
    [[ -d $sources/.git ]] && inside "$work" git ls-files | while read -r file; do
        [[ -e $root/$file ]] || rm -f "$sources/$file"
    done
    (cd "$root" && tar --create --files-from "$work/root/files") | tar --extract --directory "$sources" --no-same-owner
    inside "$work" sh -c 'git init -q . 2>/dev/null; git add --all && git -c user.name=test -c user.email=test@localhost commit -q --allow-empty -m "the sources"
        if git rev-parse -q --verify HEAD~1 >/dev/null; then git diff --name-only -z HEAD~1 HEAD | xargs -0 --no-run-if-empty touch -c; fi'
}

enter "$work"
install ca-certificates git ${ccache:+ccache}
copy_sources
if [[ ${#command[@]} -gt 0 ]]; then
    inside "$work" "${command[@]}"
    exit
fi

if [[ $arch == arm64 ]]; then
    inside "$work" scripts/install_dependencies.sh --for-arm64
    inside "$work" cmake --preset arm64
    inside "$work" cmake --build build/arm64 --parallel "$(nproc)"
    # qemu is called by name, because the kernel need not know programs of arm64.
    for tests in base_tests sand_golden_tests; do
        echo "== $tests under qemu-aarch64"
        inside "$work" qemu-aarch64 "build/arm64/bin/$tests"
    done
    echo "test_on.sh: the programs for arm64 are in $work/root/sandwall/build/arm64/bin; they need the libraries of Debian $suite for arm64"
    exit
fi

echo "== the demo"
inside "$work" scripts/demo.sh
hash=$(inside "$work" python3 -c 'import json; print(json.load(open("out/demo/summary.json"))["state_hash"])')
if [[ -x $root/build/release/bin/sandwall-replay ]]; then
    here=$("$root/build/release/bin/sandwall-replay" "$work/root/sandwall/out/demo/session.journal" --hash | tail -n 1)
    [[ $here == "$hash" ]] || { echo "test_on.sh: the demo's hash is $hash on $suite, and $here when this machine replays its journal" >&2; exit 1; }
    echo "== the hash $hash of the demo is that of a replay on this machine"
else
    echo "== the hash of the demo is $hash; with a build in build/release, this script would compare it with a replay on this machine"
fi

echo "== all tests"
inside "$work" scripts/test.sh

echo "== sessions in which systems differ"
inside "$work" scripts/checks/system_sessions.py

echo "== the package, in another fresh root"
package=$(inside "$work" scripts/package.sh)
fresh=$cache/$suite-package
rm -rf "$fresh"
cp -a "$base" "$fresh"
enter "$fresh"
cp "$work$package" "$fresh/root/sandwall/"
inside "$fresh" sh -c 'apt-get update -qq && apt-get install -y -qq ./*.deb >/dev/null &&
    sandwall doctor && sandwall run --wall desktop --scene writing --device script:gis --pace fast --steps 30 --out /root/session'

cat <<END
To try it on another machine with Debian $suite:
    apt-get install ./${package##*/}        # the file is $work$package
    sandwall doctor
    sandwall run --wall desktop --scene writing --device script:gis
A shell in this root: scripts/test_on.sh $suite --again -- bash
END
