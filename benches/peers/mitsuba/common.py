"""What the comparisons with Mitsuba share: parts of scenes, the environment, pictures.

A variant of Mitsuba must be set before anything here is called.
"""

import mitsuba as mi
import numpy as np


def grey(x):
    return {"type": "rgb", "value": x}


def rectangle(corner, u, v, **rest):
    corner, u, v = (np.array(x, float) for x in (corner, u, v))
    normal = np.cross(u, v)
    to_world = np.eye(4)
    to_world[:3, 0], to_world[:3, 1] = u / 2, v / 2
    to_world[:3, 2] = normal / np.linalg.norm(normal)
    to_world[:3, 3] = corner + (u + v) / 2
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(to_world), **rest}


def floor(half, bright=0.8, dark=0.2):
    """A square floor around the origin, checkered in squares of half a metre."""
    checker = {
        "type": "checkerboard",
        "color0": grey(bright),
        "color1": grey(dark),
        "to_uv": mi.ScalarTransform4f().scale([2 * half, 2 * half, 1]),
    }
    edges = [2 * half, 0, 0], [0, 0, -2 * half]
    return rectangle([-half, 0, half], *edges, bsdf={"type": "diffuse", "reflectance": checker})


def lamp(corner, u, v, radiance):
    """A rectangle that shines on its outer side and is black on the other."""
    black = {"type": "diffuse", "reflectance": grey(0.0)}
    return rectangle(corner, u, v, bsdf=black, emitter={"type": "area", "radiance": grey(radiance)})


def glass(inside, outside):
    return {"type": "dielectric", "int_ior": inside, "ext_ior": outside}


def sensor(position, target, fov, size, sampler, samples):
    return {
        "type": "perspective",
        "fov": fov,
        "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(origin=position, target=target, up=[0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
        },
        "sampler": {"type": sampler, "sample_count": samples},
    }


def softbox(azimuth, elevation, at, half, edge=4.0):
    """1 in a box of azimuths and elevations (degrees), 0 outside, smooth over its edge."""

    def inside(distance, half):
        t = np.clip((half + edge / 2 - np.abs(distance)) / edge, 0, 1)
        return t * t * (3 - 2 * t)

    across = (azimuth - at[0] + 180) % 360 - 180
    return inside(across, half[0]) * inside(elevation - at[1], half[1])


def radiance(azimuth, elevation):
    """The environment: a sky above a ground, and three soft boxes of different colours, so that no turn or mirror image of it
    is like it. Azimuths from -Z towards +X, elevations above the horizon, in degrees."""
    up = np.sin(np.radians(elevation))[..., None]
    sky = np.array([0.75, 0.78, 0.80]) * (1 - np.clip(up, 0, 1)) + np.array([0.20, 0.34, 0.62]) * np.clip(up, 0, 1)
    ground = np.array([0.30, 0.26, 0.22])
    t = np.clip(up / 0.1 + 0.5, 0, 1)
    light = ground + (sky - ground) * (t * t * (3 - 2 * t))
    for at, half, colour in [
        ((-60, 40), (18, 12), [5.0, 4.5, 3.8]),
        ((50, 25), (8, 16), [2.5, 3.5, 5.0]),
        ((165, 55), (25, 8), [3.0, 3.0, 3.0]),
    ]:
        light = light + softbox(azimuth, elevation, at, half)[..., None] * np.array(colour)
    return light


def write_environment(folder, width=1024, height=512):
    """Writes the environment for both programs: `environment.exr` for vitrum, `environment_mitsuba.exr` for Mitsuba.

    In vitrum's the middle is in the direction -Z, in Mitsuba's the left edge (`environment` turns it), and in both what is right
    of that lies towards +X. Rows have their centres half a row from the poles in vitrum, and the first and the last of Mitsuba's
    lie at the poles: so each gets the same function at its own rows.
    """
    azimuth = ((np.arange(width) + 0.5) / width - 0.5) * 360
    rows = {
        "environment.exr": (np.arange(height) + 0.5) / height,
        "environment_mitsuba.exr": np.arange(height) / (height - 1),
    }
    for name, down in rows.items():
        texels = radiance(*np.meshgrid(azimuth, 90 - 180 * down))
        mi.Bitmap(texels.astype(np.float32)).write(str(folder / name))


def environment(folder, rotation=0.0, scale=1.0):
    to_world = mi.ScalarTransform4f().rotate([0, 1, 0], 180 + rotation)
    return {"type": "envmap", "filename": str(folder / "environment_mitsuba.exr"), "to_world": to_world, "scale": scale}


def read(picture):
    return np.array(mi.Bitmap(str(picture)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))


def tiles(image, across, down):
    """Mean colours of so many tiles."""
    height, width, _ = image.shape
    return image.reshape(down, height // down, across, width // across, 3).mean((1, 3))
