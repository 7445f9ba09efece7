# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""pyigtl is the server, our client receives: values compared exactly, columns and the image's origin included.

pyigtl_serves.py HANDEYE
"""
import json
import os
import subprocess
import sys
import time

import numpy as np
import pyigtl

from support import free_port

handeye = sys.argv[1]
port = free_port()
server = pyigtl.OpenIGTLinkServer(port=port, local_server=True)

# Every entry is different, so that a swapped one shows; and exactly a float32.
angle = np.deg2rad(30)
turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]) @ \
    np.array([[1, 0, 0], [0, np.cos(0.7), -np.sin(0.7)], [0, np.sin(0.7), np.cos(0.7)]])
pose = np.eye(4)
pose[:3, :3] = turn
pose[:3, 3] = [10.5, -200.25, 1234.125]
pose = pose.astype(np.float32).astype(float)

image = np.arange(3 * 5 * 3, dtype=np.uint8).reshape(1, 3, 5, 3)  # slice, row, column, RGB
grey = np.arange(2 * 3, dtype=np.uint16).reshape(1, 2, 3) * 1000
placing = np.eye(4)
placing[:3, :3] = turn * np.array([0.5, 0.25, 2.0])
placing[:3, 3] = [7, -8, 9]

# pyigtl 0.3.4 packs POSITION as a list of points, 152 bytes each, which is not the protocol's: that type is compared with libopenigtlink.
messages = [
    pyigtl.TransformMessage(pose, device_name="StylusToTracker", timestamp=1234.5),
    pyigtl.TransformMessage(np.eye(4), device_name="MarkerToTracker", timestamp=1234.5),
    pyigtl.ImageMessage(image, ijk_to_world_matrix=placing, device_name="Video", timestamp=1234.5),
    pyigtl.ImageMessage(grey, ijk_to_world_matrix=placing, world_coordinate_system="ras", device_name="Grey", timestamp=1234.5),
    pyigtl.StringMessage("pivot begins", device_name="Phase", timestamp=1234.5),
]
for message in messages:
    message.header_version = 1
with_metadata = pyigtl.TransformMessage(pose, device_name="HiddenToTracker", timestamp=1234.5)
with_metadata.header_version = 2
with_metadata.metadata = {"TransformStatus": "INVALID", "Tool": "wand"}
messages.append(with_metadata)

client = subprocess.Popen([handeye, "streams", "--server", f"127.0.0.1:{port}", "--seconds", "1", "--json"],
                          stdout=subprocess.PIPE, text=True)
deadline = time.time() + 60
index = 0
while client.poll() is None and time.time() < deadline:
    if server.is_connected():
        # Times go on, so that the client sees its second pass; the values stay.
        for message in messages:
            message.timestamp = 1234.5 + 0.25 * index
            server.send_message(message, wait=False)  # waiting would never end once the client has gone
        index += 1
    time.sleep(0.1)
output = client.communicate(timeout=20)[0]
assert client.returncode == 0, output
streams = {stream["name"]: stream for stream in json.loads(output)["streams"]}
print("received:", ", ".join(f"{name} ({stream['type']})" for name, stream in streams.items()))
assert json.loads(output)["sources"][0]["refused"] == 0


def expect(what, found, expected, tolerance=0.0):
    error = np.abs(np.asarray(found, float) - np.asarray(expected, float)).max()
    print(f"{what}: differs by {error:.3g}")
    assert error <= tolerance, f"{what}: expected {expected}, found {found}"


expect("StylusToTracker", streams["StylusToTracker"]["matrix"], pose)
assert streams["StylusToTracker"]["isValid"]
assert not streams["HiddenToTracker"]["isValid"] and streams["HiddenToTracker"]["metadata"]["Tool"] == "wand"
expect("HiddenToTracker's numbers", streams["HiddenToTracker"]["matrix"], pose)
assert streams["Phase"]["text"] == "pivot begins"
video = streams["Video"]
assert (video["width"], video["height"], video["channels"], video["bits"]) == (5, 3, 3, 8)
expect("Video's first pixels", video["firstPixels"], image[0, 0, :4, ::-1].reshape(-1))  # RGB in the message, BGR with us
assert (streams["Grey"]["width"], streams["Grey"]["bits"]) == (3, 16)
expect("Grey's first pixels", streams["Grey"]["firstPixels"], grey[0, 0, :])
lps_to_ras = np.diag([-1, -1, 1, 1])
expect("Video's first pixel in RAS", video["imageToReference"], lps_to_ras @ placing, 1e-5)  # float32, through the centre
expect("Grey's first pixel in RAS", streams["Grey"]["imageToReference"], placing, 1e-5)
sys.stdout.flush()
os._exit(0)  # pyigtl's threads wait for a client that has gone
