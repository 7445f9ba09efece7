# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""pyigtl is the client of `handeye simulate`: poses and pictures are those that our own client recorded from the same server.

pyigtl_listens.py HANDEYE WORK_FOLDER
"""
import os
import subprocess
import sys
import time

import numpy as np
import pyigtl

from support import Simulation, matrix_of, read_metafile, wait_until

handeye, work = sys.argv[1:]
os.makedirs(work, exist_ok=True)
video, poses = os.path.join(work, "video.igs.mha"), os.path.join(work, "poses.igs.mha")


class Collector(pyigtl.OpenIGTLinkClient):
    """pyigtl keeps the newest message of a name; this one keeps all."""

    def __init__(self, port):
        self.all = []
        super().__init__("127.0.0.1", port, start_now=False)

    def _receive_message_from_socket(self, socket):
        received = super()._receive_message_from_socket(socket)
        self.all.extend(self.get_latest_messages())
        return received


def collect(protocol):
    with Simulation(handeye, "--motion", "free", "--frames-per-sec", "8", "--poses-per-sec", "40", "--protocol", str(protocol),
                    "--drop-outs", "0.15") as simulation:
        client = Collector(simulation.port)
        client.start()
        recorder = subprocess.Popen([handeye, "record", "--server", f"127.0.0.1:{simulation.port}", "--seconds", "4", "-o", video,
                                     "--poses", poses])
        wait_until(lambda: recorder.poll() is not None, "the recorder")
        assert recorder.returncode == 0
        client.stop()
    return client.all


def compare_poses(messages, protocol):
    _, frames, _ = read_metafile(poses)
    recorded = {round(float(frame["Timestamp"]), 4): frame for frame in frames}
    compared, hidden, worst = 0, 0, 0.0
    for message in messages:
        frame = recorded.get(round(message.timestamp, 4), {})
        name = message.device_name + "Transform"
        if message.message_type != "TRANSFORM" or name not in frame:
            continue
        status = message.metadata.get("TransformStatus", "OK")
        assert frame[name + "Status"] == status, f"{name}: {frame[name + 'Status']} and {status}"
        hidden += status != "OK"
        # The recording holds the nearest rotation to the float32 numbers of the message.
        worst = max(worst, np.abs(matrix_of(frame[name]) - message.matrix).max()) if status == "OK" else worst
        compared += 1
    print(f"protocol {protocol}: {compared} poses compared, {hidden} of them hidden, differ by {worst:.3g} at most")
    assert compared > 150 and worst < 2e-6
    assert (hidden > 0) == (protocol == 3)  # before protocol 3 a hidden tool is not sent


def compare_pictures(messages):
    fields, frames, pixels = read_metafile(video)
    recorded = {round(float(frame["Timestamp"]), 4): index for index, frame in enumerate(frames)}
    compared = 0
    for message in messages:
        index = recorded.get(round(message.timestamp, 4))
        if message.message_type == "IMAGE" and index is not None:
            assert message.image.shape == (1, 480, 640, 3)
            assert (message.image[0] == pixels[index]).all(), f"the picture of {message.timestamp} differs"
            assert np.allclose(np.abs(message.ijk_to_world_matrix), np.eye(4), atol=1e-4)
            compared += 1
    print(f"{compared} pictures are the same, byte by byte")
    assert compared >= 3


for protocol in (3, 1):
    received = collect(protocol)
    compare_poses(received, protocol)
    compare_pictures(received)
