# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A calibration from beginning to end over the network: simulate, connect, pivot, 15 placements, calibrate; against the truth.

calibrate_over_network.py HANDEYE WORK_FOLDER
"""
import json
import os
import shutil
import sys

import numpy as np

from support import Simulation, rotation_angle, run

handeye, work = sys.argv[1:]
shutil.rmtree(work, ignore_errors=True)
os.makedirs(work)
path = lambda name: os.path.join(work, name)
radius = 15


def server_of(simulation):
    return f"127.0.0.1:{simulation.port}"


# A pivot of 12 s, at three times its speed.
with Simulation(handeye, "--motion", "pivot", "--frames-per-sec", "1", "--speed", "3", "--seed", "5", "-o", path("truth.json")) as s:
    run(handeye, "record", "--server", server_of(s), "--seconds", "12", "--poses", path("pivot.igs.mha"))
run(handeye, "pivot", path("pivot.igs.mha"), "-o", path("stylus.json"))

with open(path("truth.json")) as file:
    truth = json.load(file)
with open(path("camera.json"), "w") as file:
    json.dump({"camera": truth["camera"]}, file)

with Simulation(handeye, "--motion", "placements", "--frames-per-sec", "15", "--speed", "2", "--seed", "5") as s:
    captured = run(handeye, "capture", "--server", server_of(s), "--session", path("session"), "--camera", path("camera.json"),
                   "--stylus", path("stylus.json"), "--ball-radius", radius, "--count", "15", "--seconds", "150")
print(captured["message"])
result = run(handeye, "calibrate", path("session"), "--camera", path("camera.json"), "--stylus", path("stylus.json"),
             "--ball-radius", radius, "-o", path("calibration.json"))

found, true = np.array(result["markerToCamera"]), np.array(truth["markerToCamera"])
# covariance: (rotation vector, translation) acting from the left in the camera's frame: found = (exp(w), v) * true.
error = found @ np.linalg.inv(true)
angle = rotation_angle(error[:3, :3])
skew = (error[:3, :3] - error[:3, :3].T) / 2
rotation = np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) * (angle / np.sin(angle) if angle > 1e-12 else 1)
difference = np.concatenate([rotation, error[:3, 3]])
covariance = np.array(result["covariance"])
# Six freedoms together: a Mahalanobis distance below 33.1 is the chi-square of 6 freedoms at 99.999 %. The samples' times depend on the
# machine, so each run has other ones: 99.73 % (3 sigma) would fail one run in 370.
distance = difference @ np.linalg.solve(covariance, difference)
sigma = np.sqrt(np.diag(covariance))
print(f"samples used {sum(sample['used'] for sample in result['samples'])}; rotation off by {np.rad2deg(angle):.3f} deg, "
      f"translation by {np.linalg.norm(error[:3, 3]):.2f} mm; in sigmas {np.round(difference / sigma, 2)}; chi-square {distance:.1f}")
assert distance < 33.1, "further from the truth than the predicted uncertainty (99.999 %) allows"
