#!/usr/bin/env bash
# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds, and runs all tests. Arguments go to ctest, for instance: ./test.sh -L core
set -euo pipefail
cd "$(dirname "$0")"
# shellcheck source=Utilities/set_up.sh
. Utilities/set_up.sh

# On the way into the main branch a warning is an error.
set_up all "-DHANDEYE_WARNINGS_AS_ERRORS=${CI:+ON}"
say "Running the tests (no display is needed)"
env -u DISPLAY ctest --preset release -j "$(nproc)" --no-tests=error "$@"
