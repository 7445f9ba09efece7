# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Blender side of render_capture.py: what stands in the scene, and the rendering of it in linear light.

One Blender unit is one millimetre. Poses are 4x4 matrices to the scene's frame (z up, the table at z = 0).
"""
import contextlib
import os
import sys
import tempfile

import bpy
import cv2
import numpy as np
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

TOWARDS_Z = np.diag([1.0, -1.0, -1.0, 1.0])  # Blender's cameras look along -z with y up, OpenCV's along z with y down

# colour, roughness, metallic, second colour, size of the pattern in mm, height of the bumps in mm
MATERIALS = {
    "ball": ((0.62, 0.008, 0.012), 0.28, 0, None, 0, 0),
    "metal": ((0.62, 0.62, 0.64), 0.22, 1, None, 0, 0),
    "black": ((0.012, 0.012, 0.013), 0.45, 0, None, 0, 0),
    "marker": ((0.85, 0.85, 0.83), 0.6, 0, None, 0, 0),
    "dark red": ((0.20, 0.006, 0.010), 0.4, 0, None, 0, 0),
    "pink": ((0.60, 0.24, 0.20), 0.35, 0, (0.44, 0.13, 0.12), 6, 0.5),
    "wood": ((0.33, 0.17, 0.07), 0.5, 0, (0.19, 0.085, 0.03), 5, 0.1),
    "orange": ((0.80, 0.26, 0.02), 0.45, 0, None, 0, 0),
    "green": ((0.05, 0.27, 0.07), 0.45, 0, None, 0, 0),
    "white": ((0.72, 0.72, 0.70), 0.5, 0, None, 0, 0),
    "fat": ((0.70, 0.48, 0.16), 0.35, 0, (0.62, 0.38, 0.10), 4, 0.4),
    "plaster": ((0.76, 0.68, 0.52), 0.62, 0, (0.70, 0.61, 0.44), 3, 0.06),
    "base": ((0.07, 0.075, 0.085), 0.5, 0, None, 0, 0),
    "drape": ((0.010, 0.115, 0.165), 0.85, 0, (0.016, 0.175, 0.235), 30, 1.0),
    "grey": ((0.42, 0.43, 0.44), 0.7, 0, (0.36, 0.37, 0.38), 9, 0.3),
    "table": ((0.40, 0.25, 0.13), 0.4, 0, (0.27, 0.145, 0.065), 22, 0.15),
    "tissue": ((0.52, 0.15, 0.13), 0.30, 0, (0.36, 0.07, 0.065), 24, 1.6),
}


def pose(position, z_axis=(0, 0, 1), roll=0.0):
    """A pose whose z axis points along z_axis."""
    z = np.asarray(z_axis, float) / np.linalg.norm(z_axis)
    x = np.cross([0, 1, 0] if abs(z[1]) < 0.9 else [1, 0, 0], z)
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    result = np.eye(4)
    result[:3, 0], result[:3, 1] = np.cos(roll) * x + np.sin(roll) * y, np.cos(roll) * y - np.sin(roll) * x
    result[:3, 2], result[:3, 3] = z, position
    return result


def unit(vector):
    return np.asarray(vector, float) / np.linalg.norm(vector)


def rotation(vector):
    result = np.eye(4)
    result[:3, :3] = cv2.Rodrigues(np.asarray(vector, float))[0]
    return result


@contextlib.contextmanager
def quiet():
    """Keeps Blender's progress off the standard output."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


class Scene:
    def __init__(self, samples, threads=2):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = bpy.context.scene
        self.scene.render.engine = "CYCLES"
        self.scene.render.threads_mode, self.scene.render.threads = "FIXED", threads
        cycles = self.scene.cycles
        cycles.device, cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", samples, False, False
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
        cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces = 3, 2, 2
        cycles.caustics_reflective = cycles.caustics_refractive = False
        cycles.sample_clamp_indirect = 8.0
        self.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        self.scene.collection.objects.link(self.camera)
        self.scene.camera = self.camera
        self.camera.data.clip_start, self.camera.data.clip_end = 1.0, 20000.0

    # ---- what things are made of

    def material(self, name):
        if name in bpy.data.materials:
            return bpy.data.materials[name]
        colour, roughness, metallic, second, size, height = MATERIALS[name]
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes, link = material.node_tree.nodes, material.node_tree.links.new
        surface = nodes["Principled BSDF"]
        surface.inputs["Base Color"].default_value = (*colour, 1)
        surface.inputs["Roughness"].default_value = roughness
        surface.inputs["Metallic"].default_value = metallic
        if name in ("ball", "tissue", "pink", "fat"):
            surface.inputs["Coat Weight"].default_value = 0.5
            surface.inputs["Coat Roughness"].default_value = 0.08 if name == "ball" else 0.2
        if second:
            where = nodes.new("ShaderNodeNewGeometry")
            stretch = nodes.new("ShaderNodeVectorMath")
            stretch.operation = "MULTIPLY"
            stretch.inputs[1].default_value = (0.06, 1, 1) if name in ("table", "wood") else (1, 1, 1)
            noise = nodes.new("ShaderNodeTexNoise")
            noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 1 / size, 5
            noise.inputs["Distortion"].default_value = 0.6
            ramp = nodes.new("ShaderNodeValToRGB")
            ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.38, 0.62
            ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (*colour, 1), (*second, 1)
            bump = nodes.new("ShaderNodeBump")
            bump.inputs["Distance"].default_value, bump.inputs["Strength"].default_value = height, 1
            link(where.outputs["Position"], stretch.inputs[0])
            link(stretch.outputs[0], noise.inputs["Vector"])
            link(noise.outputs["Fac"], ramp.inputs["Fac"])
            link(ramp.outputs["Color"], surface.inputs["Base Color"])
            link(noise.outputs["Fac"], bump.inputs["Height"])
            link(bump.outputs["Normal"], surface.inputs["Normal"])
        return material

    def glow(self):
        """Pure emission, to measure outlines with."""
        material = bpy.data.materials.new("glow")
        material.use_nodes = True
        surface = material.node_tree.nodes["Principled BSDF"]
        surface.inputs["Base Color"].default_value, surface.inputs["Specular IOR Level"].default_value = (0, 0, 0, 1), 0
        surface.inputs["Emission Color"].default_value, surface.inputs["Emission Strength"].default_value = (1, 1, 1, 1), 1
        return material

    # ---- things

    def _finish(self, material, matrix, smooth=True):
        thing = bpy.context.object
        thing.matrix_world = Matrix(matrix)
        thing.data.materials.append(self.material(material) if isinstance(material, str) else material)
        if smooth:
            thing.data.shade_smooth()
        return thing

    def sphere(self, centre, radius, material, fine=False):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=384 if fine else 48, ring_count=192 if fine else 24, radius=radius)
        return self._finish(material, pose(centre))

    def ellipsoid(self, matrix, half_axes, material):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1)
        return self._finish(material, matrix @ np.diag([*half_axes, 1.0]))

    def box(self, matrix, sides, material):
        bpy.ops.mesh.primitive_cube_add(size=1)
        box = self._finish(material, matrix @ np.diag([*sides, 1.0]), smooth=False)
        bevel = box.modifiers.new("bevel", "BEVEL")
        bevel.width, bevel.segments = 0.02, 2
        return box

    def rod(self, start, end, radius, material):
        start, end = np.asarray(start, float), np.asarray(end, float)
        bpy.ops.mesh.primitive_cylinder_add(vertices=64, radius=radius, depth=np.linalg.norm(end - start), end_fill_type="NGON")
        rod = self._finish(material, pose((start + end) / 2, end - start), smooth=False)
        for face in rod.data.polygons:
            face.use_smooth = len(face.vertices) == 4
        return rod

    def ring(self, matrix, radius, thickness, material):
        bpy.ops.mesh.primitive_torus_add(major_radius=radius, minor_radius=thickness, major_segments=96, minor_segments=24)
        return self._finish(material, matrix)

    def mesh(self, name, points, faces, matrix, material):
        data = bpy.data.meshes.new(name)
        data.from_pydata(np.asarray(points, float).tolist(), [], np.asarray(faces).tolist())
        thing = bpy.data.objects.new(name, data)
        self.scene.collection.objects.link(thing)
        bpy.context.view_layer.objects.active = thing
        return self._finish(material, matrix)

    def ground(self, material, extent, waves, rng):
        """The table, drape or tissue: a surface with gentle waves (height, length in mm), nowhere above z = 0."""
        count = 161
        x, y = np.meshgrid(np.linspace(-extent, extent, count), np.linspace(-extent, extent, count))
        z = np.zeros_like(x)
        if waves:
            height, length = waves
            for _ in range(12):
                angle, phase, wave = rng.uniform(0, 2 * np.pi), rng.uniform(0, 2 * np.pi), length * rng.uniform(0.6, 1.8)
                z += height * rng.uniform(0.1, 0.4) * np.sin(2 * np.pi / wave * (x * np.cos(angle) + y * np.sin(angle)) + phase)
            z -= z.max()
        i = np.arange(count * (count - 1)).reshape(count - 1, count)[:, :-1].ravel()
        self.mesh("ground", np.stack([x, y, z], -1).reshape(-1, 3), np.stack([i, i + 1, i + count + 1, i + count], 1), np.eye(4), material)

    def stylus(self, ball, handle, radius, roll):
        """A red ball, a metal shaft to the dark handle, and four marker spheres about the stylus's own origin."""
        away = handle - ball
        length = np.linalg.norm(away)
        self.ball = self.sphere(ball, radius, "ball", fine=True)
        self.rod(ball + away * 0.5 * radius / length, ball + away * 0.72, 0.19 * radius, "metal")
        self.rod(ball + away * 0.62, ball + away * 1.15, 7.0, "black")
        across = pose(handle, away, roll)[:3]
        for x, y, z in ((34, 0, 4), (-30, 6, -6), (4, 28, 10), (-6, -38, 0)):
            at = handle + across[:, :3] @ [x, y, z]
            self.rod(handle, at, 2.2, "black")
            self.sphere(at, 5.5, "marker")

    # ---- light and pictures

    def sky(self, strength, colour=(1, 1, 1)):
        self.scene.world = bpy.data.worlds.new("sky")
        self.scene.world.use_nodes = True
        background = self.scene.world.node_tree.nodes["Background"]
        background.inputs[0].default_value, background.inputs[1].default_value = (*colour, 1), strength

    def lamp(self, position, target, size, strength, colour=(1, 1, 1)):
        """A square area light; strength is relative to a sky of 1."""
        position, target = np.asarray(position, float), np.asarray(target, float)
        light = bpy.data.lights.new("lamp", "AREA")
        light.size, light.color = size, colour
        light.energy = strength * np.pi ** 2 * np.sum((position - target) ** 2)
        lamp = bpy.data.objects.new("lamp", light)
        lamp.matrix_world = Matrix(pose(position, position - target))
        self.scene.collection.objects.link(lamp)

    def spot(self, matrix, angle, radius, strength):
        """A lamp in the camera's frame that shines where the camera looks, brightest in the middle."""
        light = bpy.data.lights.new("spot", "SPOT")
        light.spot_size, light.spot_blend, light.shadow_soft_size, light.energy = np.radians(angle), 1.0, radius, strength
        spot = bpy.data.objects.new("spot", light)
        spot.matrix_world = Matrix(matrix @ TOWARDS_Z)
        self.scene.collection.objects.link(spot)

    def look(self, camera_to_scene, pinhole):
        self.camera_to_scene = camera_to_scene
        self.camera.matrix_world = Matrix(camera_to_scene @ TOWARDS_Z)
        self.camera.data.sensor_fit, self.camera.data.sensor_width = "HORIZONTAL", 36.0
        self.camera.data.lens = 36.0 * pinhole.focal / pinhole.width
        self.scene.render.resolution_x, self.scene.render.resolution_y = pinhole.width, pinhole.height
        self.scene.render.resolution_percentage = 100
        bpy.context.view_layer.update()

    def first_hits(self, rays):
        """The first object along each unit ray of the camera frame, or None."""
        depths = bpy.context.evaluated_depsgraph_get()
        origin = Vector(self.camera_to_scene[:3, 3])
        directions = (self.camera_to_scene[:3, :3] @ np.asarray(rays).T).T
        return [self.scene.ray_cast(depths, origin, Vector(d))[4] for d in directions]

    def hits_alone(self, thing, rays):
        """Along which unit rays of the camera frame the object would be seen if it stood alone."""
        tree = BVHTree.FromObject(thing, bpy.context.evaluated_depsgraph_get())
        to_thing = np.linalg.inv(np.array(thing.matrix_world)) @ self.camera_to_scene
        origin, directions = Vector(to_thing[:3, 3]), (to_thing[:3, :3] @ np.asarray(rays).T).T
        return np.array([tree.ray_cast(origin, Vector(d))[0] is not None for d in directions])

    def render(self, seed):
        """Linear light, float32, RGB, first row on top."""
        self.scene.cycles.seed = int(seed) % 2 ** 31
        image = self.scene.render.image_settings
        image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
        with tempfile.TemporaryDirectory() as folder:
            self.scene.render.filepath = os.path.join(folder, "light.exr")
            with quiet():
                bpy.ops.render.render(write_still=True)
            picture = bpy.data.images.load(self.scene.render.filepath)
            width, height = picture.size
            pixels = np.empty(width * height * picture.channels, np.float32)
            picture.pixels.foreach_get(pixels)
            bpy.data.images.remove(picture)
        return pixels.reshape(height, width, -1)[::-1, :, :3].copy()
