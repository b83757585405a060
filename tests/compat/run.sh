#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the project in a folder that holds another Debian release, and runs the tests there. What is
# installed on this machine does not matter, and nothing is changed on it outside that folder.
# usage (as root): tests/compat/run.sh RELEASE FLAVOUR [ctest arguments]
#   RELEASE  bookworm (ParaView 5.11, VTK 9.1), trixie (ParaView 5.13, VTK 9.3), forky (ParaView 6.1,
#            VTK 9.6), or any later one
#   FLAVOUR  paraview         the plugin, against Debian's ParaView
#            vtk              the VTK modules alone, against Debian's VTK, which excludes its ParaView
#            vtk-without-mpi  the same, with DSM_USE_MPI=OFF
# Environment:
#   DSM_COMPAT_DIRECTORY  where the releases and builds are kept (/var/tmp/dsm-compat); 3 to 5 GiB each
#   DSM_COMPAT_MIRROR     Debian mirror (http://deb.debian.org/debian)
#   DSM_TEST_DATA         folder with the larger data of the image tests; without it they are skipped
# Needs debootstrap and network. The last line counts the tests; the log of the build stays beside it.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"

[ $# -ge 2 ] || fail "usage: $0 RELEASE paraview|vtk|vtk-without-mpi [ctest arguments]"
release=$1
flavour=$2
shift 2
options=()
with=("${packages[@]}")
without_paraview=()
for package in "${packages[@]}"; do
  [[ $package == *paraview* ]] || without_paraview+=("$package")
done
case $flavour in
  paraview) ;;
  vtk) options=(-DDSM_BUILD_PARAVIEW_PLUGIN=OFF) ;;
  vtk-without-mpi) options=(-DDSM_BUILD_PARAVIEW_PLUGIN=OFF -DDSM_USE_MPI=OFF) ;;
  *) fail "the flavour is paraview, vtk or vtk-without-mpi, not '$flavour'" ;;
esac
tree_flavour=${flavour%-without-mpi}
[ "$tree_flavour" = paraview ] || with=("${without_paraview[@]}" libvtk9-dev python3-vtk9)
[ "$(id -u)" -eq 0 ] || fail "only root may enter another Debian's folder; run this as root or with sudo"
for program in debootstrap unshare chroot; do
  command -v "$program" >/dev/null || fail "$program is missing: apt-get install debootstrap util-linux"
done

directory=${DSM_COMPAT_DIRECTORY:-/var/tmp/dsm-compat}
mirror=${DSM_COMPAT_MIRROR:-http://deb.debian.org/debian}
tree=$directory/$release-$tree_flavour
log=$directory/$release-$flavour.log
mkdir -p "$directory"
: >"$log"

if [ ! -e "$tree/.complete" ]; then
  say "Fetching Debian $release to $tree ..."
  rm -rf --one-file-system "$tree"
  # A debootstrap that is older than the release has no script of its name; all newer ones are as sid's.
  scripts=${DEBOOTSTRAP_DIR:-/usr/share/debootstrap}/scripts
  script=()
  [ -e "$scripts/$release" ] || script=("$scripts/sid")
  debootstrap --variant=minbase "$release" "$tree" "$mirror" "${script[@]}" >>"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    fail "debootstrap could not make $tree; the whole log is $log"
  }
  touch "$tree/.complete"
fi
# MPI looks the machine's name up whenever it starts, and waits seconds for a server that knows nothing of it.
cp /etc/hosts "$tree/etc/hosts"

# Mounts of a namespace of its own end with it, however this script ends.
mkdir -p "$tree/project" "$tree/build-$flavour" "$tree/data" "$tree/ccache"
cat >"$tree/run-$flavour" <<INSIDE
set -eu
say() { printf '%s\\n' "\$*"; }
$(declare -f packages_of_paraview)
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 CCACHE_DIR=/ccache
packages="${with[*]} ${test_packages[*]} ccache"
[ $flavour != paraview ] || packages="\$packages \$(packages_of_paraview)"
for package in \$packages; do
  if [ "\$(dpkg-query -W -f '\${db:Status-Status}' \$package 2>/dev/null)" != installed ]; then
    say "Installing packages ..."
    # A mirror that lags behind is good enough to test with.
    apt-get -o Acquire::Check-Valid-Until=false update >>/log 2>&1
    [ $flavour != paraview ] || packages="\$packages \$(packages_of_paraview)"
    apt-get install --yes --no-install-recommends \$packages >>/log 2>&1
    break
  fi
done
say "Configuring and building ..."
cmake -S /project -B /build-$flavour -G Ninja -DCMAKE_BUILD_TYPE=Release \\
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DDSM_BUILD_TESTING=ON -DDSM_TEST_ALL_RANKS=ON -DDSM_TEST_DATA=/data \\
  ${options[*]} >>/log 2>&1
cmake --build /build-$flavour >>/log 2>&1
cd /build-$flavour
ctest --parallel 2 --output-on-failure --output-junit /build-$flavour/tests.xml ${keep_output[*]} "\$@" || true
INSIDE
rm -f "$tree/build-$flavour/tests.xml"
# shellcheck disable=SC2016
unshare --mount --propagation private sh -c '
  set -e
  tree=$1 project=$2 log=$3 data=$4 script=$5
  shift 5
  touch "$tree/log"
  mount --bind "$log" "$tree/log"
  mount --bind "$project" "$tree/project"
  mount -o remount,bind,ro "$tree/project"
  [ -z "$data" ] || mount --bind "$data" "$tree/data"
  mount -t proc proc "$tree/proc"
  mount -t sysfs -o ro sysfs "$tree/sys"
  mount --rbind /dev "$tree/dev"
  mount -t tmpfs tmpfs "$tree/dev/shm"
  mount -t tmpfs tmpfs "$tree/tmp"
  exec chroot "$tree" /bin/sh "$script" "$@"
' sh "$tree" "$project" "$log" "${DSM_TEST_DATA:-}" "/run-$flavour" "$@" || {
  tail -n 40 "$log" >&2
  fail "the build in $tree failed; the whole log is $log"
}
count_tests "$tree/build-$flavour/tests.xml"
