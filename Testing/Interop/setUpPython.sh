#!/usr/bin/env bash
# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# setUpPython.sh FOLDER: a virtual environment with what requirements.txt pins. Safe to run again: done once per list.
set -euo pipefail
folder=$1
list="$(cd "$(dirname "$0")" && pwd)/requirements.txt"
if [ -f "$folder/installed.txt" ] && cmp -s "$list" "$folder/installed.txt"; then
  echo "$folder has what $list asks for"
  exit 0
fi
rm -rf "$folder"
/usr/bin/python3 -m venv "$folder" || { echo "python3-venv is missing: run ./test.sh, which installs it" >&2; exit 1; }
"$folder/bin/pip" install --quiet --disable-pip-version-check --retries 5 --no-deps -r "$list" ||
  { echo "pip could not install what $list pins: is there a network connection?" >&2; exit 1; }
cp "$list" "$folder/installed.txt"
