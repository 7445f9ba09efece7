# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The lens and the sensor of render_capture.py: from linear light through a pinhole to the pixels of a real camera.

Integer pixel coordinates are pixel centres, as in OpenCV, here and in the oversampled pinhole picture.
"""
import cv2
import numpy as np

# width, height, fx, fy, offset of the principal point, k1 k2 p1 p2 k3, light left in the corners, full well in electrons
PRESETS = {
    "webcam": (640, 480, 530.0, 534.0, 15.0, (-0.12, 0.05, 0.0011, -0.0008, -0.006), 0.80, 9000),
    "laparoscope": (720, 576, 796.0, 812.0, 9.0, (-0.28, 0.11, -0.0006, 0.0009, -0.015), 0.45, 6000),
    "wide": (640, 480, 338.0, 337.0, 8.0, (-0.21, 0.045, 0.0005, 0.0007, -0.004), 0.60, 8000),
}


class Lens:
    """A Brown-Conrady camera, somewhat different for every seed."""

    def __init__(self, name, rng):
        width, height, fx, fy, offset, coefficients, self.corner_light, self.full_well = PRESETS[name]
        focal = rng.uniform(0.99, 1.01)
        angle = rng.uniform(0, 2 * np.pi)
        self.width, self.height = width, height
        self.K = np.array([[round(fx * focal, 1), 0, round((width - 1) / 2 + offset * np.cos(angle), 1)],
                           [0, round(fy * focal, 1), round((height - 1) / 2 + offset * np.sin(angle), 1)],
                           [0, 0, 1]])
        self.distortion = np.round(np.array(coefficients) * rng.uniform(0.95, 1.05, 5), 5)
        u, v = np.meshgrid(np.linspace(-1, width, 60), np.linspace(-1, height, 60))
        self.reach = np.abs(self.undistort(np.stack([u, v], -1))).reshape(-1, 2).max(0) * 1.005

    def undistort(self, pixels):
        """Pinhole coordinates x/z, y/z of pixels (any shape, 2 last)."""
        until = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 200, 1e-12)
        flat = np.ascontiguousarray(pixels, float).reshape(-1, 1, 2)
        return cv2.undistortPointsIter(flat, self.K, self.distortion, None, None, until).reshape(pixels.shape)

    def project(self, points):
        """Pixels of points in the camera frame (n, 3)."""
        zero = np.zeros(3)
        return cv2.projectPoints(np.asarray(points, float).reshape(-1, 1, 3), zero, zero, self.K, self.distortion)[0].reshape(-1, 2)

    def sees(self, points):
        """Which points (n, 3) fall onto the picture; beyond the field of view the distortion polynomial folds back, so ask there first."""
        points = np.asarray(points, float).reshape(-1, 3)
        z = np.maximum(points[:, 2], 1e-9)
        near = (points[:, 2] > 0) & (np.abs(points[:, :2] / z[:, None]) <= self.reach).all(1)
        pixels = self.project(np.where(near[:, None], points, [0, 0, 1]))
        return near & (pixels > -0.5).all(1) & (pixels < [self.width - 0.5, self.height - 0.5]).all(1)

    def write(self, path):
        with open(path, "w") as out:
            out.write("%%YAML:1.0\n---\nimage_width: %d\nimage_height: %d\n" % (self.width, self.height))
            for name, matrix in (("camera_matrix", self.K), ("distortion_coefficients", self.distortion.reshape(-1, 1))):
                out.write("%s: !!opencv-matrix\n   rows: %d\n   cols: %d\n   dt: d\n" % (name, *matrix.shape))
                out.write("   data: [ %s ]\n" % ", ".join(repr(float(x)) for x in matrix.ravel()))


class Pinhole:
    """The picture to render: undistorted, wide enough for the whole lens, `oversample` times finer than the sensor."""

    def __init__(self, lens, oversample):
        self.focal = oversample * max(lens.K[0, 0], lens.K[1, 1])
        self.width, self.height = (2 * np.ceil(lens.reach * self.focal).astype(int) + 4).tolist()


class Sensor:
    def __init__(self, lens, pinhole, per_pixel=4):
        """Where each sensor pixel's per_pixel x per_pixel samples lie in the pinhole picture, once for all frames."""
        self.lens = lens
        u, v = np.meshgrid(np.arange(lens.width), np.arange(lens.height))
        centre = np.array([pinhole.width - 1, pinhole.height - 1]) / 2
        steps = (np.arange(per_pixel) + 0.5) / per_pixel - 0.5
        self.maps = [(lens.undistort(np.stack([u + du, v + dv], -1)) * pinhole.focal + centre).astype(np.float32)
                     for dv in steps for du in steps]
        corner = np.hypot(u - lens.K[0, 2], v - lens.K[1, 2]) / np.hypot(lens.width, lens.height) * 2
        self.vignette = (1 - (1 - lens.corner_light) * np.minimum(corner, 1.2) ** 3).astype(np.float32)[..., None]

    def distort(self, linear, blur=0.45):
        """The light that falls onto each pixel: area average of the pinhole picture, and the lens's slight blur (sigma in px)."""
        light = sum(cv2.remap(linear, m, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE) for m in self.maps) / len(self.maps)
        return cv2.GaussianBlur(light, (0, 0), blur) if blur else light

    def expose(self, light, rng, mean=0.17, highlights=0.85, read_noise=0.0035):
        """Automatic exposure, shot and read noise in linear light, sRGB encoding; 8 bit RGB."""
        light = light * self.vignette
        grey = light.mean(2)
        light = light * min(mean / grey.mean(), highlights / np.percentile(light.max(2), 98))
        deviation = np.sqrt(np.clip(light, 0, None) / self.lens.full_well + read_noise ** 2)
        light = np.clip(light + deviation * rng.standard_normal(light.shape), 0, 1)
        encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        return np.round(encoded * 255).astype(np.uint8)


def write_jpeg(path, picture, most_bytes, quality=92):
    """Quality 92, or less if the file would be larger than most_bytes."""
    while True:
        data = cv2.imencode(".jpg", picture[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        if len(data) <= most_bytes or quality <= 70:
            break
        quality -= 1
    with open(path, "wb") as out:
        out.write(data.tobytes())


def outline(centre, radius, count=360):
    """Unit rays that touch the ball: its exact outline. centre in the camera frame."""
    distance = np.linalg.norm(centre)
    axis = np.asarray(centre) / distance
    side = np.cross(axis, [0, 1, 0] if abs(axis[1]) < 0.9 else [1, 0, 0])
    side /= np.linalg.norm(side)
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)[:, None]
    across = np.cos(angle) * side + np.sin(angle) * np.cross(axis, side)
    sine = radius / distance
    return np.sqrt(1 - sine ** 2) * axis + sine * across


def edge_offsets(lens, light, centre, radius, reach=4.0):
    """How far (px, outwards positive) the edge of a bright ball on black lies from the projected outline, and the outward normals."""
    points = lens.project(outline(centre, radius, 720))
    normals = np.roll(points, -1, 0) - np.roll(points, 1, 0)
    normals = np.stack([normals[:, 1], -normals[:, 0]], 1) / np.linalg.norm(normals, axis=1, keepdims=True)
    normals *= np.sign(np.sum(normals * (points - points.mean(0)), 1, keepdims=True))
    steps = np.arange(-reach, reach, 0.02) + 0.01
    at = points[:, None] + normals[:, None] * steps[:, None]
    inside = ((at > 1) & (at < [lens.width - 2, lens.height - 2])).all((1, 2))
    at = at[inside]
    x0, y0 = np.floor(at[..., 0]).astype(int), np.floor(at[..., 1]).astype(int)  # bilinear in full precision: cv2.remap rounds to 1/32 px
    fx, fy = at[..., 0] - x0, at[..., 1] - y0
    g = light.mean(2).astype(float)
    profile = ((1 - fx) * (1 - fy) * g[y0, x0] + fx * (1 - fy) * g[y0, x0 + 1]
               + (1 - fx) * fy * g[y0 + 1, x0] + fx * fy * g[y0 + 1, x0 + 1])
    bright, dark = profile[:, :25].mean(1), profile[:, -25:].mean(1)
    share = (profile.mean(1) - dark) / (bright - dark)
    return (share * 2 - 1) * reach, normals[inside]
