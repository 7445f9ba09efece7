#!/usr/bin/env bash
# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing and builds. With a display it opens NavigationDesktop with the module and a simulated operating room; without
# one, or with --headless, it runs the main job on the demo capture: pivot, calibrate, validate, register, overlay. Both programs are
# built in either case. Other arguments go to NavigationDesktop.
set -euo pipefail
cd "$(dirname "$0")"
# shellcheck source=Utilities/set_up.sh
. Utilities/set_up.sh

headless=
case ${1:-} in
  -h | --help)
    printf '%s\n' "./start.sh               builds; opens the desktop with a simulated room, or runs the demo where there is no display" \
      "./start.sh --headless    builds; runs the demo, never a window" \
      "./start.sh ARGUMENTS     builds; opens the desktop with them (build/release/bin/NavigationDesktop --help says which)"
    exit 0
    ;;
esac
if [ "${1:-}" = --headless ]; then
  headless=yes
  shift
  [ $# -eq 0 ] || fail "--headless takes no further arguments: '$*'"
elif [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}${QT_QPA_PLATFORM:-}" ]; then
  headless=yes
fi

if [ -z "$headless" ]; then
  set_up 'handeye NavigationDesktop' -DHANDEYE_WARNINGS_AS_ERRORS=
  desktop=$build_dir/bin/NavigationDesktop
  # The variables may be set and nothing be there: the program tries it, and is not heard if it fails.
  if (exec "$desktop" --check-display) >/dev/null 2>&1; then
    say "Opening NavigationDesktop with a simulated operating room (./start.sh --headless runs the demo without a window)"
    exec "$desktop" --demo "$@"
  fi
  say "The display does not answer: the demo runs without a window"
fi

set_up 'handeye NavigationDesktop' -DHANDEYE_WARNINGS_AS_ERRORS=
handeye=$build_dir/bin/handeye
demo=Resources/Demo
output=output/demo
mkdir -p "$output"

# step <words> <what to show of the output> <command...>
step()
{
  local words=$1 shown=$2
  shift 2
  say "$words"
  printf '   handeye %s\n' "$*"
  if ! "$handeye" "$@" >"$output/step.log" 2>&1; then
    cat "$output/step.log" >&2
    fail "this step of the demo did not work; the command above repeats it"
  fi
  grep -E "$shown" "$output/step.log" | sed 's/^/   /' || true
}

step "The stylus: where its tip is" '^(tip|residual|frames)' \
  pivot $demo/pivot.igs.mha -o $output/stylus.json
step "The camera: where it sits relative to its marker" '^(verdict|left out)' \
  calibrate $demo/calibration --camera $demo/camera.yml --stylus $output/stylus.json --ball-radius 15 -o $output/calibration.json
step "Validation on captures that were not fitted" '^(projection error|  |verdict)' \
  validate $demo/validation --calibration $output/calibration.json --report $output/report -o $output/validation.json
step "The phantom: touched landmarks to the model" '^residual' \
  landmarks $demo/phantom_model_points.txt $demo/phantom_touched_points.txt -o $output/phantom.json
step "The overlay: the vertebra on the video of its phantom" '^model drawn' \
  overlay $demo/validation --calibration $output/calibration.json --model Resources/Meshes/Vertebra.ply \
  --registration $output/phantom.json --color 20a8ff -o $output/overlay
rm -f "$output/step.log"

say "Done. Look at
   $output/overlay/0000.png and the others   the vertebra drawn over its phantom
   $output/report/report.html                the validation: figures, plot, and a picture of each frame
   $output/calibration.json                  the result (markerToCamera), for other programs"
