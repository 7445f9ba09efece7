# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
#
# Sourced by start.sh and test.sh: installs what is missing, configures and builds. Every step says what it does, and a step that
# fails says what to do about it. Safe to run again: what is there already is left alone.

packages_file=Utilities/debian-packages.txt
build_dir=build/release

say() { printf '\n== %s\n' "$*"; }

fail()
{
  printf '\n%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 2
}

# The packages of the list that are not installed.
missing_packages()
{
  local package
  grep -v -E '^ *(#|$)' "$packages_file" | while read -r package; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || printf '%s ' "$package"
  done
}

check_system()
{
  local id='' version='' line
  if [ -r /etc/os-release ]; then
    # shellcheck disable=SC1091
    line=$(. /etc/os-release && printf '%s %s' "${ID:-}" "${VERSION_ID:-}")
    id=${line%% *} version=${line#* }
  fi
  if [ "$id" != debian ] || [ "$version" != 12 ]; then
    [ -n "${HANDEYE_ANY_SYSTEM:-}" ] ||
      fail "this is ${id:-an unknown system} ${version}, and the libraries are taken from Debian 12 by name." \
        "Use a Debian 12 machine or container, or set HANDEYE_ANY_SYSTEM=1 to try with packages of the same names."
    command -v apt-get >/dev/null || fail "there is no apt-get here. Install what $packages_file lists by other means, then run cmake --preset release."
  fi
}

install_packages()
{
  local missing as_root=()
  missing=$(missing_packages)
  if [ -z "$missing" ]; then
    say "All packages of $packages_file are installed"
    return
  fi
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "these packages are missing, and installing them needs root or sudo: ${missing}" \
        "Ask an administrator to run: apt-get install ${missing}"
    as_root=(sudo)
  fi
  say "Installing packages (a few minutes the first time): ${missing}"
  mkdir -p build
  if ! "${as_root[@]}" apt-get -qq update >build/apt.log 2>&1; then
    tail -n 5 build/apt.log >&2
    fail "apt-get update did not work: is there a network connection, and are the package sources in order? The whole of it is in build/apt.log"
  fi
  # shellcheck disable=SC2086
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -qq install --no-install-recommends $missing >>build/apt.log 2>&1; then
    tail -n 5 build/apt.log >&2
    fail "apt-get install did not work: is there a network connection and space on the disk? The whole of it is in build/apt.log"
  fi
}

# build_project <targets> <extra cmake arguments...>
build_project()
{
  local target=$1
  shift
  say "Configuring in $build_dir"
  mkdir -p build
  if ! cmake --preset release "$@" >build/configure.log 2>&1; then
    tail -n 20 build/configure.log >&2
    fail "the build could not be configured; the whole of it is in build/configure.log"
  fi
  say "Building with $(nproc) cores (the first time 10 to 40 minutes, and 3 GB of disk)"
  # shellcheck disable=SC2086
  NINJA_STATUS='[%f of %t, %es] ' cmake --build --preset release --target $target ||
    fail "the build failed or was interrupted: an error above says where, without one run this again to go on"
}

# set_up <targets> <extra cmake arguments...>
set_up()
{
  check_system
  install_packages
  build_project "$@"
}
