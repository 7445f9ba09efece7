# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The phantom of render_capture.py: a mesh that stands on a plate with a tracked marker, and its landmarks as touched."""
import os
import re

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from render_scene import pose, rotation, unit

TOUCH_MM = 0.3  # noise of a touched landmark, per axis


class Phantom:
    """A mesh on a base plate at the middle of the table, its marker at the plate's far corner."""

    def __init__(self, path, up, rng):
        reader = {".ply": vtk.vtkPLYReader, ".stl": vtk.vtkSTLReader, ".vtk": vtk.vtkPolyDataReader}[os.path.splitext(path)[1].lower()]()
        reader.SetFileName(path)
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputConnection(reader.GetOutputPort())
        triangles.Update()
        mesh = triangles.GetOutput()
        self.points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
        self.faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        sign, axis = (-1 if up[0] == "-" else 1), "xyz".index(up[-1])
        towards = np.linalg.inv(pose((0, 0, 0), sign * np.eye(3)[axis], rng.uniform(0, 2 * np.pi)))
        self.to_scene = rotation((0, 0, rng.uniform(-0.5, 0.5))) @ towards
        low, high = (lambda p: (p.min(0), p.max(0)))(self.in_scene())
        self.size = high - low
        self.base = (self.size[0] + 96, self.size[1] + 24, 8.0)
        self.to_scene[:3, 3] = (-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, self.base[2] - low[2] - 0.2)
        self.middle = np.array([0, 0, self.base[2] + self.size[2] / 2])
        self.sample = self.in_scene()[:: max(1, len(self.points) // 1500)]
        self.reach = np.hypot(*self.base[:2]) / 2 + 12
        marker = (self.base[0] / 2 - 16, self.base[1] / 2 - 12, 34.0)
        self.marker_to_scene = pose(marker, unit((0.2, -0.6, 0.75))) @ rotation(rng.normal(0, 0.6, 3))
        self.model_to_phantom = np.linalg.inv(self.marker_to_scene) @ self.to_scene
        beside = os.path.join(os.path.dirname(path), "VertebraLandmarks.txt")
        if os.path.exists(beside):
            rows = [re.findall(r"[-+]?\d*\.?\d+(?:[eE][-+]?\d+)?", line)[-3:] for line in open(beside) if not line.startswith("#")]
            self.landmarks = np.array([row for row in rows if len(row) == 3], float)
        else:  # points of the mesh far from each other
            chosen = [self.points[:, 2].argmax()]
            for _ in range(6):
                chosen.append(np.min([np.linalg.norm(self.points - self.points[c], axis=1) for c in chosen], 0).argmax())
            self.landmarks = self.points[chosen]

    def in_scene(self):
        return self.points @ self.to_scene[:3, :3].T + self.to_scene[:3, 3]

    def build(self, scene):
        self.thing = scene.mesh("phantom", self.points, self.faces, self.to_scene, "plaster")
        scene.box(pose((0, 0, self.base[2] / 2)), self.base, "base")
        at = self.marker_to_scene[:3]
        scene.rod((at[0, 3], at[1, 3], 4), at[:, 3], 3, "black")
        for x, y in ((24, 0), (-20, 8), (3, 21), (-5, -17)):
            end = at[:, :3] @ [x, y, 0] + at[:, 3]
            scene.rod(at[:, 3], end, 1.8, "black")
            scene.sphere(end, 5.0, "marker")

    def write(self, folder, rng):
        touched = self.landmarks @ self.model_to_phantom[:3, :3].T + self.model_to_phantom[:3, 3]
        touched = touched + TOUCH_MM * rng.standard_normal(touched.shape)
        for name, points in (("model", self.landmarks), ("touched", touched)):
            np.savetxt(os.path.join(folder, "phantom_%s_points.txt" % name), points, "%.4f")
