# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the interop tests share: running handeye, reading its recordings, waiting with a limit."""
import json
import re
import socket
import subprocess
import time

import numpy as np


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(condition, what, timeout=60):
    end = time.time() + timeout
    while not condition():
        if time.time() > end:
            raise AssertionError(f"waited {timeout} s in vain for {what}")
        time.sleep(0.01)


class Simulation:
    """`handeye simulate` on a free port of loopback, ended with the block."""

    def __init__(self, handeye, *options):
        self.process = subprocess.Popen([handeye, "simulate", "--port", "0", *options], stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        match = re.search(r"127\.0\.0\.1:(\d+)", line)
        assert match, f"no port in: {line}"
        self.port = int(match.group(1))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise


def run(handeye, *arguments, timeout=200):
    """Runs a command with --json; its result."""
    done = subprocess.run([handeye, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=timeout)
    assert done.returncode == 0, f"{arguments}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    return json.loads(done.stdout)


def read_metafile(path):
    """Fields of the file, frames as dictionaries, pixels as (n, rows, columns, channels) or None."""
    with open(path, "rb") as file:
        data = file.read()
    marker = b"ElementDataFile = LOCAL"
    end = data.index(b"\n", data.index(marker)) + 1
    fields, frames = {}, {}
    for line in data[:end].decode().splitlines():
        key, _, value = line.partition(" = ")
        match = re.match(r"Seq_Frame(\d+)_(.*)", key)
        if match:
            frames.setdefault(int(match.group(1)), {})[match.group(2)] = value.strip()
        else:
            fields[key.strip()] = value.strip()
    size = [int(word) for word in fields["DimSize"].split()]
    pixels = None
    if size[0] > 0:
        channels = int(fields.get("ElementNumberOfChannels", 1))
        pixels = np.frombuffer(data[end:], np.uint8).reshape(size[-1], size[1], size[0], channels)
    return fields, [frames[i] for i in sorted(frames)], pixels


def matrix_of(text):
    return np.array([float(word) for word in text.split()]).reshape(4, 4)


def rotation_angle(rotation):
    return np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1))
