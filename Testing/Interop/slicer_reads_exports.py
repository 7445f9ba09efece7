# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""3D Slicer's own libraries read what `handeye export` writes; the matrices they report must be ours.

slicer_reads_exports.py HANDEYE CAMERA_FILE MESH WORK_FOLDER
"""
import json
import os
import subprocess
import sys

import numpy as np
import slicer_core as slicer
import vtk
from vtk.util.numpy_support import vtk_to_numpy

handeye, camera_file, mesh, work = sys.argv[1:]
os.makedirs(work, exist_ok=True)


def rigid(rotation_vector, translation):
    """Rodrigues' formula."""
    angle = np.linalg.norm(rotation_vector)
    x, y, z = np.asarray(rotation_vector) / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    matrix[:3, 3] = translation
    return matrix


marker_to_camera = rigid([1.9, -1.1, 0.7], [18, -61, 34])
model_to_phantom = rigid([-0.4, 2.2, 0.3], [-7, 105, 12])
tip = [1.5, -2.5, -150.25]


def write(name, content):
    path = os.path.join(work, name)
    with open(path, "w") as file:
        json.dump(content, file)
    return path


calibration = write("calibration.json", {
    "status": "ok", "markerToCamera": marker_to_camera.tolist(), "tip_Stylus_Mm": tip, "ballRadiusMm": 15,
    "camera": {"width": 640, "height": 480, "cameraMatrix": [[600, 0, 320], [0, 601, 240], [0, 0, 1]],
               "distortionCoefficients": [0.1, -0.2, 0.001, 0.002]}})
stylus = write("stylus.json", {"status": "ok", "tip_Stylus_Mm": tip})
phantom = write("phantom.json", {"status": "ok", "modelToPhantom": model_to_phantom.tolist()})


def export(format_name, name, *more):
    path = os.path.join(work, name)
    subprocess.run([handeye, "export", calibration, "--format", format_name, "-o", path, *more], check=True, timeout=60)
    return path


def matrix_of(node):
    matrix = vtk.vtkMatrix4x4()
    node.GetMatrixTransformToParent(matrix)
    return np.array([[matrix.GetElement(r, c) for c in range(4)] for r in range(4)])


def expect(what, found, expected, tolerance):
    error = np.abs(np.asarray(found) - np.asarray(expected)).max()
    print(f"{what}: differs by {error:.3g} at most")
    assert error <= tolerance, f"{what}: expected\n{expected}\nfound\n{found}"


def read_tfm():
    scene = slicer.vtkMRMLScene()
    node = slicer.vtkMRMLLinearTransformNode()
    scene.AddNode(node)
    storage = slicer.vtkMRMLTransformStorageNode()
    scene.AddNode(storage)
    storage.SetFileName(export("tfm", "MarkerToCamera.tfm"))
    assert storage.ReadData(node) == 1, "Slicer did not read the .tfm"
    expect("MarkerToCamera.tfm", matrix_of(node), marker_to_camera, 1e-9)


def read_scene():
    scene = slicer.vtkMRMLScene()
    path = export("mrml", "scene.mrml", "--stylus", stylus, "--registration", phantom, "--model", mesh)
    scene.SetURL(path)
    assert scene.Connect() == 1, f"Slicer did not read the scene: {scene.GetErrorMessage()}"
    tip_pose = np.eye(4)
    tip_pose[:3, 3] = tip
    for name, expected in (("MarkerToCamera", marker_to_camera), ("ModelToPhantom", model_to_phantom),
                           ("StylusTipToStylus", tip_pose)):
        node = scene.GetFirstNodeByName(name)
        assert node is not None, f"{name} is not in the scene"
        expect(name, matrix_of(node), expected, 1e-12)
    model = scene.GetFirstNodeByClass("vtkMRMLModelNode")
    assert model is not None and model.GetPolyData() is not None, "the model is not in the scene, or has no mesh"
    assert model.GetParentTransformNode().GetName() == "ModelToPhantom"
    reader = vtk.vtkPLYReader()
    reader.SetFileName(mesh)
    reader.Update()
    points = vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).astype(float)
    expect("the model's points", vtk_to_numpy(model.GetPolyData().GetPoints().GetData()), points, 1e-5)
    # In place: where Slicer puts a point of the model in the phantom's frame.
    to_world = vtk.vtkGeneralTransform()
    model.GetParentTransformNode().GetTransformToWorld(to_world)
    expect("a point in place", to_world.TransformPoint(points[17]), (model_to_phantom @ np.append(points[17], 1))[:3], 1e-4)
    assert model.GetDisplayNode() is not None and model.GetDisplayNode().GetVisibility() == 1


read_tfm()
read_scene()
