#!/usr/bin/env bash
# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds, and runs the main job on the demo capture: pivot, calibrate, validate, register, overlay.
set -euo pipefail
cd "$(dirname "$0")"
# shellcheck source=Utilities/set_up.sh
. Utilities/set_up.sh

set_up handeye -DHANDEYE_WARNINGS_AS_ERRORS=
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
