# SPDX-License-Identifier: BSD-3-Clause
# What demo.sh and test.sh share: packages, build, and how to start ranks. To be sourced.

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${DSM_BUILD_DIRECTORY:-$project/build}

say() { printf '%s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# The packages that the build, the demonstration and the tests need, on Debian 12 (bookworm).
packages=(
  g++ cmake ninja-build
  paraview paraview-dev python3-paraview
  libopenmpi-dev openmpi-bin
  libglm-dev libhwy-dev nlohmann-json3-dev libcli11-dev libxxhash-dev
  pkg-config libhdf5-dev zlib1g-dev libdeflate-dev libblosc-dev libzstd-dev
  liblz4-dev liblzma-dev libbz2-dev libcurl4-openssl-dev
  libx11-dev libgl-dev libopengl-dev libglew-dev libpng-dev libpython3-dev
  xvfb xauth libgl1-mesa-dri
)
# And those that the tests need besides.
test_packages=(libgtest-dev clang-format doxygen iproute2 python3-numpy python3-mpi4py
  python3-h5py python3-zarr python3-netcdf4 teem-apps hdf5-filter-plugin hdf5-filter-plugin-blosc-serial
  hdf5-filter-plugin-zfp-serial)

# Prints what ParaView's development files need besides and do not demand: from Debian 14 on, ParaView uses
# the VTK that is packaged for itself; and the panel needs the Qt that ParaView has. Nothing where the package
# lists are not there yet. (sh runs it, too.)
packages_of_paraview() {
  if apt-cache depends paraview 2>/dev/null | grep -q 'libvtk9\.'; then echo libvtk9-dev libvtk9-qt-dev; fi
  if apt-cache depends paraview 2>/dev/null | grep -q 'libqt5'; then echo qtbase5-dev; fi
  if apt-cache depends paraview 2>/dev/null | grep -q 'libqt6'; then echo qt6-base-dev; fi
}

# Prints the packages among the arguments that are not installed.
missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      printf '%s ' "$package"
  done
}

# Installs what is missing of the packages named; says what it needs when it cannot.
install_packages() {
  command -v dpkg-query >/dev/null ||
    fail "this script installs Debian packages, but this system is not Debian. Install the equivalents of: $*"
  local missing as_root=()
  missing=$(missing_packages "$@" $(packages_of_paraview))
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "these packages are missing, and neither root nor sudo is available to install them: $missing
       Ask an administrator for: apt-get install --no-install-recommends $missing"
    as_root=(sudo)
  fi
  say "Installing packages (the first time, this takes some minutes): $missing"
  mkdir -p "$build"
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install --yes --no-install-recommends $missing $(packages_of_paraview); } \
    >"$build/packages.log" 2>&1; then
    tail -n 20 "$build/packages.log" >&2
    fail "cannot install the packages; the complete log is $build/packages.log. Packages: $missing"
  fi
}

# Whether $build is configured with the tests.
builds_tests() { grep -qs DSM_BUILD_TESTING:BOOL=ON "$build/CMakeCache.txt"; }

# Builds into $build; a second run only checks what has changed. --with-tests: the tests as well;
# without it, they are built where they were before.
build_project() {
  local tests=OFF
  mkdir -p "$build"
  if [ "${1:-}" = --with-tests ] || builds_tests; then tests=ON; fi
  if [ ! -f "$build/build.ninja" ] || { [ $tests = ON ] && ! builds_tests; }; then
    say "Configuring ..."
    cmake -S "$project" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DDSM_BUILD_TESTING=$tests \
      -DDSM_WARNINGS_AS_ERRORS="${DSM_WARNINGS_AS_ERRORS:-OFF}" >"$build/configure.log" 2>&1 || {
      tail -n 30 "$build/configure.log" >&2
      rm -f "$build/build.ninja"
      fail "cannot configure the project; the complete log is $build/configure.log"
    }
  fi
  say "Building (only what has changed) ..."
  cmake --build "$build" >"$build/build.log" 2>&1 || {
    grep -E -A 5 'error|FAILED' "$build/build.log" | head -n 60 >&2
    fail "cannot build the project; the complete log is $build/build.log"
  }
}

# The folder that holds the plugin.
plugin_directory() {
  local directory=$build/lib/DSMRayTracer
  [ -f "$directory/DSMRayTracer.so" ] ||
    fail "DSMRayTracer.so is not in $directory; did the build stop early?"
  say "$directory"
}

# mpirun with N ranks, also where ranks are more than cores, or the user is root.
start_ranks() {
  local ranks=$1
  shift
  # A rank that waits gives its core to those that trace.
  local options=(--oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -np "$ranks")
  [ "$(id -u)" -ne 0 ] || options+=(--allow-run-as-root)
  # Without a screen, ParaView draws into a virtual one. -noreset: X would reset between clients.
  xvfb-run --auto-servernum --server-args "-noreset -screen 0 1280x1024x24" \
    mpirun "${options[@]}" "$@"
}

# Keeps all that tests say in ctest's JUnit file, where count_tests looks for the scripts and cases of a test.
keep_output=(--test-output-size-passed 4000000 --test-output-size-failed 4000000)

# Prints the slowest tests of a ctest run, those that were skipped, those that failed, and counts all, from its JUnit
# file; fails unless some passed and none failed.
count_tests() {
  [ -s "$1" ] || fail "ctest did not write $1"
  python3 "$project/scripts/count_tests.py" "$1"
}
