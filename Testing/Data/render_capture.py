# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Renders a capture with truth: a red ball-tip stylus in clutter, path-traced (Cycles), seen through a real lens and sensor.

    pip install bpy==4.2.0 "numpy<2" opencv-python-headless vtk          (Python 3.11)
    render_capture.py --lens webcam --seed 101 --frames 12 --empty 2 --partial 4 --jpeg-kb 90 --out held_webcam
    render_capture.py --lens laparoscope --seed 102 --frames 12 --empty 2 --partial 4 --samples 5 --jpeg-kb 90 --out held_laparoscope
    render_capture.py --lens webcam --seed 7 --frames 15 --validation-frames 8 --samples 8 --phantom Vertebra.ply --out demo
    render_capture.py --lens wide --check                                is the geometry exact? prints the outline's offset in px

OUT receives camera.yml, calibration/ and validation/ (frames/0000.jpg... and tracking.igs.mha), pivot.igs.mha and truth.json; the same
seed gives the same capture. With --phantom a mesh stands on the table with a tracked marker: PhantomToTracker in the tracking files,
modelToPhantom in truth.json, phantom_model_points.txt and phantom_touched_points.txt for landmark registration (VertebraLandmarks.txt
beside the mesh is used if it is there), and mask/0000.png: 255 where the phantom is seen, 128 where something stands before it.
truth.json also says which pivot poses are wrong and, for each frame, whether the ball is in view (if not, where it is is null) and which
share of its outline is seen.
"""
import argparse
import json
import os
import time

import cv2
import numpy as np

from render_camera import PRESETS, Lens, Pinhole, Sensor, edge_offsets, outline, write_jpeg
from render_phantom import Phantom
from render_scene import Scene, pose, rotation, unit

NOISE_MM, NOISE_DEG = 0.12, 0.025
# ball radius; the ball's nearest and farthest distance; the camera's distance from what it looks at (mm) and its height above it (deg)
SITUATIONS = {
    "webcam": dict(radius=15.0, near=120, far=500, distance=520, elevation=58, ground="table", clutter=(32, 95), count=18),
    "laparoscope": dict(radius=10.0, near=60, far=250, distance=285, elevation=68, ground="tissue", clutter=(12, 34), count=14),
    "wide": dict(radius=12.5, near=90, far=420, distance=430, elevation=66, ground="grey", clutter=(26, 75), count=20),
}
COLOURS = ("pink", "wood", "orange", "green", "white", "dark red")


def noisy(transform, rng):
    """A pose as the tracker reports it: noise about the marker's own origin."""
    result = transform @ rotation(np.radians(NOISE_DEG) * rng.standard_normal(3))
    result[:3, 3] += NOISE_MM * rng.standard_normal(3)
    return result


def write_tracking(path, frames, step):
    """A sequence metafile with transforms only; frames: one {name: 4x4} each."""
    with open(path, "w") as out:
        out.write("ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
                  "CenterOfRotation = 0 0 0\nCompressedData = False\nDimSize = 0 0 %d\nKinds = domain domain list\n"
                  "ElementNumberOfChannels = 1\nElementSpacing = 1 1 1\nElementType = MET_OTHER\nOffset = 0 0 0\n"
                  "TransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = XX\nUltrasoundImageType = XX\n" % len(frames))
        for i, transforms in enumerate(frames):
            key = "Seq_Frame%04d_" % i
            for name, matrix in transforms.items():
                out.write("%s%sTransform = %s\n" % (key, name, " ".join(repr(float(x)) for x in matrix.ravel())))
                out.write("%s%sTransformStatus = OK\n" % (key, name))
            for name in ("Timestamp", "UnfilteredTimestamp"):
                out.write("%s%s = %.6f\n" % (key, name, 100 + i * step))
            out.write("%sFrameNumber = %d\n%sImageStatus = INVALID\n" % (key, i, key))
        out.write("ElementDataFile = LOCAL\n")


class Capture:
    def __init__(self, options):
        self.options = options
        rng = np.random.default_rng(options.seed)
        self.lens = Lens(options.lens, rng)
        self.pinhole = Pinhole(self.lens, options.oversample)
        self.sensor = Sensor(self.lens, self.pinhole)
        self.case = dict(SITUATIONS[options.lens])
        self.radius = options.ball_radius or self.case["radius"]
        self.ground = options.ground or ("drape" if options.phantom else self.case["ground"])
        self.marker_to_camera = rotation(unit(rng.normal(size=3)) * rng.uniform(0.4, 2.4))
        self.marker_to_camera[:3, 3] = rng.uniform((-60, -70, -35), (60, 70, 35))
        self.tip = np.array([-2, 1, 180]) + rng.normal(0, 1.5, 3)
        eye = np.array([rng.choice([-1, 1]) * rng.uniform(500, 800), rng.uniform(-1300, -900), rng.uniform(800, 1200)])
        self.tracker_to_scene = pose(eye, eye, rng.uniform(-0.4, 0.4))
        self.pivot = (np.linalg.inv(self.tracker_to_scene) @ [*rng.uniform(-150, 150, 2), 40, 1])[:3]
        self.lamps = [(np.array([side * rng.uniform(350, 900), rng.uniform(-700, 600), rng.uniform(700, 1100)]), rng.uniform(150, 420), power)
                      for side, power in ((-1, rng.uniform(1.4, 2.2)), (1, rng.uniform(0.5, 1.2)), (rng.uniform(-1, 1), 0.6))]
        self.phantom = Phantom(options.phantom, options.phantom_up, rng) if options.phantom else None
        self.target = np.array([0, 0, 10.0])
        if self.phantom:  # it is to fill 0.29 of the picture's width
            self.target = self.phantom.middle
            distance = self.lens.K[0, 0] * self.phantom.size[0] / (0.29 * self.lens.width)
            self.case.update(distance=distance, elevation=47, near=max(110.0, 0.45 * distance), far=1.7 * distance)
        self.layout = self.clutter(rng, self.camera(np.random.default_rng(options.seed), still=True)) if self.phantom else None

    # ---- where things are

    def camera(self, rng, still=False):
        """A pose of the hand-held camera, cameraToScene."""
        wobble = (lambda s: 0.0) if still else (lambda s: s * rng.uniform(-1, 1))
        elevation, azimuth = np.radians(self.case["elevation"] + wobble(5)), np.radians(wobble(8))
        back = [np.cos(elevation) * np.sin(azimuth), -np.cos(elevation) * np.cos(azimuth), np.sin(elevation)]
        eye = self.target + self.case["distance"] * (1 + wobble(0.06)) * np.array(back)
        z = unit(self.target + self.case["distance"] * np.array([wobble(0.06), wobble(0.06), 0]) - eye)
        x = unit(np.cross(z, [0, 0, 1]))
        result = np.eye(4)
        result[:3, :3], result[:3, 3] = np.stack([x, np.cross(z, x), z], 1), eye
        return result @ rotation((0, 0, np.radians(wobble(6))))

    def ray(self, pixel):
        return unit([*self.lens.undistort(np.array([pixel], float))[0], 1])

    def place_ball(self, rng, camera, kind, depth, spot):
        """The ball's centre in the camera frame. kind: whole, cut (by the border) or absent (out of the picture)."""
        size = np.array([self.lens.width, self.lens.height])
        for attempt in range(4000):
            distance = depth * 0.997 ** max(0, attempt - 60)
            if attempt > 3:
                spot = rng.uniform(0, 1, 2)
            if kind == "absent":
                centre = distance * unit([*(rng.choice([-1, 1], 2) * self.lens.reach * rng.uniform((1.3, 0.2), (2.0, 2.0))), 1])
            else:
                edge = self.lens.K[0, 0] * self.radius / distance
                pixel = (edge * 1.15 + 8) + spot * (size - 2 * edge * 1.15 - 16)
                if kind == "cut":
                    axis, side = rng.integers(2), rng.integers(2)
                    pixel[axis] = abs(side * size[axis] - edge * rng.uniform(0.05, 0.6))
                centre = distance * self.ray(pixel)
            at = (camera @ [*centre, 1])[:3]
            share = self.lens.sees(outline(centre, self.radius * (1 if kind == "cut" else 1.1))).mean()
            if at[2] < self.radius + 4 or not {"whole": share == 1, "cut": 0.4 < share < 0.9, "absent": share == 0}[kind]:
                continue
            if self.phantom and not self.clear_of_phantom(camera, centre, at, attempt):
                continue
            return centre
        raise RuntimeError("no place for the ball")

    def clear_of_phantom(self, camera, centre, at, attempt):
        marker = self.phantom.marker_to_scene[:3, 3]
        if np.linalg.norm(self.phantom.sample - at, axis=1).min() < self.radius + 6 or np.linalg.norm(marker - at) < self.radius + 35:
            return False
        seen = (self.phantom.sample - camera[:3, 3]) @ camera[:3, :3]
        angle = np.arccos(np.clip(seen @ unit(centre) / np.linalg.norm(seen, axis=1), -1, 1))
        touching = angle < np.arcsin(self.radius / np.linalg.norm(centre)) + 0.01
        nearer = np.linalg.norm(seen, axis=1) < np.linalg.norm(centre)
        return not (touching & nearer).any() and touching.mean() < (0.03 if attempt < 1500 else 0.12)

    def place_stylus(self, rng, camera, ball):
        """stylusToScene: the handle above the table, the shaft not between the camera and the ball, nor before the phantom."""
        for attempt in range(3000):
            away = unit(rng.normal(size=3))
            handle = ball + away * np.linalg.norm(self.tip)
            view = unit(ball - camera[:3, 3])
            along = ball + np.linspace(0.1, 1.15, 30)[:, None] * (handle - ball)
            if not -0.3 < away @ view < 0.75 or along[:, 2].min() < 14 or np.linalg.norm(along - camera[:3, 3], axis=1).min() < 70:
                continue
            if self.phantom and attempt < 2500:
                seen, shaft = [(p - camera[:3, 3]) @ camera[:3, :3] for p in (self.phantom.sample, along)]
                gap = np.linalg.norm(seen[:, None, :2] / seen[:, None, 2:] - shaft[None, :, :2] / np.maximum(shaft[None, :, 2:], 1), axis=2)
                if gap.min() < 0.035 or np.linalg.norm(self.phantom.sample[:, None] - along, axis=2).min() < 12:
                    continue
            turn = pose((0, 0, 0), -away, rng.uniform(0, 2 * np.pi)) @ np.linalg.inv(pose((0, 0, 0), self.tip))
            turn[:3, 3] = ball - turn[:3, :3] @ self.tip
            return turn
        raise RuntimeError("no way to hold the stylus")

    def clutter(self, rng, camera):
        """(kind, pose, dimensions, material) of things lying on the table in view."""
        things, (small, large) = [], self.case["clutter"]
        if self.phantom:
            small, large = 16, 40
        while len(things) < self.case["count"]:
            ray = camera[:3, :3] @ self.ray(rng.uniform((-40, -40), (self.lens.width + 40, self.lens.height + 40)))
            if ray[2] > -0.1:
                continue
            at = camera[:3, 3] - ray * camera[2, 3] / ray[2]
            size = rng.uniform(small, large)
            if self.phantom and (np.linalg.norm(at[:2]) < self.phantom.reach + size or at[1] < 0 and abs(at[0]) < self.phantom.reach):
                continue
            kind = ("ring", "ellipsoid", "box", "box")[len(things) % 4] if len(things) < 12 else rng.choice(["ring", "ellipsoid", "box"])
            turn = rng.uniform(0, 2 * np.pi)
            if kind == "ring":
                tilt = rng.uniform(0, 1.4) * rng.integers(0, 2)
                where = pose(at + [0, 0, size * 0.05 + np.sin(tilt) * size * 0.45], (np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)))
                things.append((kind, where, (size * 0.45, size * rng.uniform(0.045, 0.09)), "dark red"))
            elif kind == "ellipsoid":
                axes = size * rng.uniform(0.25, 0.5, 3)
                material = "fat" if self.ground == "tissue" and rng.random() < 0.5 else "pink"
                things.append((kind, pose(at + [0, 0, axes[2] * 0.85], (0, 0, 1), turn), axes, material))
            else:
                sides = size * rng.uniform(0.35, 1.0, 3)
                things.append((kind, pose(at + [0, 0, sides[2] / 2], (0, 0, 1), turn), sides, COLOURS[rng.integers(len(COLOURS) - 1)]))
        return things

    def occluder(self, rng, camera, centre):
        """A thing between the camera and the ball, over a part of the ball."""
        distance = np.linalg.norm(centre)
        size = self.radius * rng.uniform(0.8, 1.3)
        ball, own = np.arcsin(self.radius / distance), np.arcsin(size / (0.78 * distance))
        axis = unit(centre)
        side = unit(np.cross(axis, rng.normal(size=3)))
        angle = ball + own - ball * rng.uniform(0.45, 0.8)
        at = camera[:3, :3] @ (0.78 * distance * (np.cos(angle) * axis + np.sin(angle) * side)) + camera[:3, 3]
        where = pose(at, rng.normal(size=3), rng.uniform(0, 6))
        if rng.random() < 0.5:
            return "ellipsoid", where, size * rng.uniform(0.8, 1.0, 3), "pink"
        return "box", where, size * rng.uniform(1.0, 1.5, 3), COLOURS[rng.integers(len(COLOURS))]

    # ---- a frame

    def frame(self, part, index, kind, depth, spot):
        """The picture (8 bit RGB), the true poses, the entry of truth.json and the phantom's mask (or None)."""
        rng = np.random.default_rng([self.options.seed, part, index])
        camera = self.camera(rng)
        centre = self.place_ball(rng, camera, "whole" if kind == "hidden" else kind, depth, spot)
        ball = (camera @ [*centre, 1])[:3]
        stylus = self.place_stylus(rng, camera, ball)
        scene = Scene(self.options.samples, self.options.threads)
        self.light(scene, camera, rng)
        waves = {"drape": (3.0, 180), "tissue": (14.0, 90)}.get(self.ground)
        scene.ground(self.ground, 500 if self.ground == "tissue" else 2500, waves, np.random.default_rng(self.options.seed))
        if self.ground == "table":
            scene.box(pose((rng.uniform(-120, 120), rng.uniform(-60, 160), 0.6), (0, 0, 1), rng.uniform(-0.5, 0.5)), (340, 240, 2), "grey")
        scene.stylus(ball, stylus[:3, 3], self.radius, rng.uniform(0, 6))
        if self.phantom:
            self.phantom.build(scene)
        along = ball + np.linspace(0, 1.15, 40)[:, None] * (stylus[:3, 3] - ball)
        things = [self.add(scene, t) for t in self.layout or self.clutter(rng, camera)
                  if np.linalg.norm(t[1][:3, 3] - along, axis=1).min() > self.radius + self.extent(t)]
        if kind == "hidden":
            self.add(scene, self.occluder(rng, camera, centre))
        scene.look(camera, self.pinhole)
        inner = outline(centre, self.radius * 0.99)
        hits = [hit.name if hit else "" for hit in scene.first_hits(inner)]
        for thing in [t for t in things if t.name in hits]:  # clutter hides nothing by chance
            scene.scene.collection.objects.unlink(thing)
            scene.look(camera, self.pinhole)
        seen = [hit is not None and hit.name == scene.ball.name for hit in scene.first_hits(inner)]
        share = float(np.mean(seen & self.lens.sees(inner)))
        light = self.sensor.distort(scene.render(rng.integers(2 ** 31)))
        picture = self.sensor.expose(light, rng, mean=0.14 if self.ground == "tissue" else 0.19)
        entry = {"ball_Camera_Mm": None, "ball_Image_Px": None, "visible": False, "visibleShare": 0.0}
        if kind != "absent":
            entry = {"ball_Camera_Mm": centre.tolist(), "ball_Image_Px": self.lens.project(centre)[0].tolist(), "visible": True, "visibleShare": round(share, 4)}
        to_tracker = np.linalg.inv(self.tracker_to_scene)
        poses = {"MarkerToTracker": to_tracker @ camera @ self.marker_to_camera, "StylusToTracker": to_tracker @ stylus}
        if self.phantom:
            poses["PhantomToTracker"] = to_tracker @ self.phantom.marker_to_scene
        return picture, {name: noisy(matrix, rng) for name, matrix in poses.items()}, entry, self.mask(scene) if self.phantom else None

    def light(self, scene, camera, rng):
        if self.ground == "tissue":  # an endoscope's: two fibre ends beside the lens
            scene.sky(0.004)
            for x in (-3.2, 3.2):
                at = camera.copy()
                at[:3, 3] = (camera @ [x, -1.5, -1, 1])[:3]
                scene.spot(at, 92, 1.2, 4e6)
            return
        scene.sky(0.30, (0.93, 0.97, 1.0))
        for position, size, strength in self.lamps:
            scene.lamp(position + rng.normal(0, 25, 3), (0, 0, 0), size, strength * rng.uniform(0.9, 1.1), (1.0, 0.97, 0.92))

    @staticmethod
    def extent(thing):
        kind, _, dimensions, _ = thing
        return {"ring": np.sum, "ellipsoid": np.max, "box": lambda sides: np.linalg.norm(sides) / 2}[kind](dimensions)

    @staticmethod
    def add(scene, thing):
        kind, where, dimensions, material = thing
        return scene.ring(where, *dimensions, material) if kind == "ring" else getattr(scene, kind)(where, dimensions, material)

    def mask(self, scene):
        u, v = np.meshgrid(np.arange(self.lens.width), np.arange(self.lens.height))
        rays = np.concatenate([self.lens.undistort(np.stack([u, v], -1)), np.ones((*u.shape, 1))], -1).reshape(-1, 3)
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        mask = np.where(scene.hits_alone(self.phantom.thing, rays), 128, 0).astype(np.uint8)
        where = np.flatnonzero(mask)
        mask[where] = [255 if hit is not None and hit.name == self.phantom.thing.name else 128 for hit in scene.first_hits(rays[where])]
        return mask.reshape(u.shape)

    # ---- the whole capture

    def kinds(self, part, count):
        """What is special about each frame: empty ones in both parts, cut and hidden ones in the validation only."""
        special = ["absent"] * self.options.empty + (["cut", "hidden"] * self.options.partial)[: self.options.partial] * part
        kinds = special + ["whole"] * (count - len(special))
        np.random.default_rng([self.options.seed, part]).shuffle(kinds)
        return kinds

    def write(self):
        options = self.options
        folder = options.out.rstrip("/") + ".part"
        truth = {"markerToCamera": self.marker_to_camera.tolist(), "tip_Stylus_Mm": self.tip.tolist(),
                 "pivot_Tracker_Mm": self.pivot.tolist(), "ballRadiusMm": self.radius}
        counts = {"calibration": options.frames, "validation": options.validation_frames or options.frames}
        for part, (name, count) in enumerate(counts.items()):
            os.makedirs(os.path.join(folder, name, "frames"), exist_ok=True)
            if self.phantom:
                os.makedirs(os.path.join(folder, name, "mask"), exist_ok=True)
            rng = np.random.default_rng([options.seed, part, 10 ** 6])
            depths = self.case["near"] * (self.case["far"] / self.case["near"]) ** ((rng.permutation(count) + rng.uniform(0.1, 0.9, count)) / count)
            spots = (rng.uniform(0, 1, 2) + np.arange(count)[:, None] * [0.7549, 0.5698]) % 1
            tracking, truth[name] = [], []
            for i, kind in enumerate(self.kinds(part, count)):
                start = time.time()
                picture, poses, entry, mask = self.frame(part, i, kind, depths[i], spots[i])
                write_jpeg(os.path.join(folder, name, "frames", "%04d.jpg" % i), picture, options.jpeg_kb * 1000)
                if mask is not None:
                    cv2.imwrite(os.path.join(folder, name, "mask", "%04d.png" % i), mask)
                tracking.append(poses)
                truth[name].append(entry)
                print("%s %d (%s, %.2f seen): %.0f s" % (name, i, kind, entry["visibleShare"], time.time() - start), flush=True)
            write_tracking(os.path.join(folder, name, "tracking.igs.mha"), tracking, 3.0)
        rng = np.random.default_rng([options.seed, 2])
        self.lens.write(os.path.join(folder, "camera.yml"))
        poses, truth["pivotWrongFrames"] = self.pivoting(rng)
        write_tracking(os.path.join(folder, "pivot.igs.mha"), poses, 0.05)
        if self.phantom:
            self.phantom.write(folder, rng)
            truth["modelToPhantom"] = self.phantom.model_to_phantom.tolist()
        with open(os.path.join(folder, "truth.json"), "w") as out:
            json.dump(truth, out, indent=1)
        os.rename(folder, options.out)

    def pivoting(self, rng, count=320, wrong=8):
        """The stylus swung about its tip within a cone of up to 38 degrees; a few poses are off by millimetres to centimetres."""
        wrong = sorted(rng.choice(count, wrong, replace=False).tolist())
        upright, frames = unit(rng.normal(0, 0.2, 3) + [0, 0, -1]), []
        for i in range(count):
            tilt, turn = np.radians(38) * abs(np.sin(i * 0.043)) ** 0.7, i * 0.117
            axis = pose((0, 0, 0), upright) @ [np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt), 0]
            matrix = pose((0, 0, 0), axis[:3], 0.9 * np.sin(i * 0.021)) @ np.linalg.inv(pose((0, 0, 0), self.tip))
            matrix[:3, 3] = self.pivot - matrix[:3, :3] @ self.tip
            if i in wrong:
                matrix[:3, 3] += unit(rng.normal(size=3)) * rng.uniform(3, 18)
            frames.append({"StylusToTracker": noisy(matrix, rng)})
        return frames, wrong

    def check(self):
        """Clean frames of a glowing ball: the outline in the picture against the projected outline."""
        size = np.array([self.lens.width, self.lens.height])
        for spot in ((0.5, 0.5), (0.2, 0.25), (0.82, 0.3), (0.25, 0.8), (0.8, 0.78)):
            centre = 0.4 * self.case["far"] * self.ray(np.array(spot) * size)
            scene = Scene(16, self.options.threads)
            scene.sky(0.0)
            scene.sphere(centre, self.radius, scene.glow(), fine=True)
            scene.look(np.eye(4), self.pinhole)
            offset, normals = edge_offsets(self.lens, self.sensor.distort(scene.render(1)), centre, self.radius)
            shift = np.linalg.lstsq(normals, offset - offset.mean(), rcond=None)[0]
            print("ball at (%.0f, %.0f) px: shifted by (%+.4f, %+.4f) px, radius by %+.4f px, rms %.4f px, %d edge points"
                  % (*self.lens.project(centre)[0], *shift, offset.mean(), np.sqrt(np.mean(offset ** 2)), len(offset)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lens", choices=sorted(PRESETS), default="webcam")
    parser.add_argument("--out", help="the folder to make")
    parser.add_argument("--frames", type=int, default=12, help="calibration frames")
    parser.add_argument("--validation-frames", type=int, help="validation frames, else as many")
    parser.add_argument("--empty", type=int, default=0, help="frames of each part without a ball")
    parser.add_argument("--partial", type=int, default=0, help="validation frames whose ball is cut by the border or partly hidden")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--phantom", metavar="MESH", help="PLY, STL or legacy VTK, in mm")
    parser.add_argument("--phantom-up", choices=("x", "y", "z", "-x", "-y", "-z"), default="z", help="the mesh's axis that points up")
    parser.add_argument("--ground", choices=("table", "grey", "drape", "tissue"))
    parser.add_argument("--ball-radius", type=float)
    parser.add_argument("--samples", type=int, default=10, help="paths per pixel of the oversampled picture")
    parser.add_argument("--oversample", type=float, default=2.0)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--jpeg-kb", type=int, default=60, help="largest JPEG, kB")
    parser.add_argument("--check", action="store_true", help="measure the geometry instead")
    options = parser.parse_args()
    if options.check:
        Capture(options).check()
    elif options.out:
        Capture(options).write()
    else:
        parser.error("--out is needed")


if __name__ == "__main__":
    main()
