"""The scenes of race.py: five of glass, for both programs.

vitrum's are the files in scenes/race, Mitsuba's the dictionaries here: the same shapes, indices, lights and cameras. Meshes and
the environment are written here for both.
"""

import shutil
from pathlib import Path

import mitsuba as mi
import numpy as np
from common import environment, floor, glass, lamp, sensor, write_environment

HERE = Path(__file__).parent
BRILLIANT = HERE.parents[2] / "scenes/gallery/meshes/brilliant.obj"
NAMES = ["ball", "bubbles", "mesh", "glass", "diamond"]
SIZE = (320, 240)


def write_scenes(folder):
    """Writes all that the scenes of both programs read."""
    for name in NAMES:
        shutil.copy(HERE / f"scenes/race/{name}.toml", folder)
    shutil.copy(BRILLIANT, folder)
    write_environment(folder)
    write_knot(folder / "knot.obj")
    write_glass_of_water(folder)


def scene(name, folder, sampler, max_depth, rr_depth):
    """A scene for Mitsuba."""
    camera, objects = OBJECTS[name](folder)
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": max_depth, "rr_depth": rr_depth},
        "sensor": sensor(*camera, SIZE, sampler, 1),
        "environment": environment(folder),
        "floor": floor(10),
        **objects,
    }


def sphere(centre, radius, bsdf):
    return {"type": "sphere", "center": centre, "radius": radius, "bsdf": bsdf}


def box(low, high, bsdf):
    low, high = np.array(low), np.array(high)
    to_world = mi.ScalarTransform4f().translate((low + high) / 2).scale((high - low) / 2)
    return {"type": "cube", "to_world": to_world, "bsdf": bsdf}


def mesh(file, bsdf, **rest):
    return {"type": "obj", "filename": str(file), "bsdf": bsdf, **rest}


def ball(_folder):
    return ([0, 1.8, 5], [0, 0.85, 0], 36), {
        "lamp": lamp([-1, 4, -1], [2, 0, 0], [0, 0, 2], 4.0),
        "ball": sphere([0, 1, 0], 1, glass(1.5, 1.0)),
    }


def bubbles(_folder):
    return ([0, 1.8, 5], [0, 0.75, 0], 36), {
        "outside": sphere([-1, 0.85, 0], 0.85, glass(1.5, 1.0)),
        "inside": sphere([-1, 0.85, 0], 0.7, glass(1.0, 1.5)),
        "water": box([0.3, 0.01, -0.7], [1.8, 1.51, 0.7], glass(1.33, 1.0)),
        "bubble": sphere([1.05, 0.8, 0], 0.45, glass(1.0, 1.33)),
    }


def smooth_mesh(folder):
    return ([0, 2.2, 5], [0, 0.75, 0], 36), {
        "lamp": lamp([-1, 4, -1], [2, 0, 0], [0, 0, 2], 4.0),
        "knot": mesh(folder / "knot.obj", glass(1.5, 1.0)),
    }


def glass_of_water(folder):
    return ([0, 1.7, 4], [0, 0.65, 0], 32), {
        "lamp": lamp([-1, 3, -1.5], [2, 0, 0], [0, 0, 2], 4.0),
        "outside": mesh(folder / "outside.obj", glass(1.5, 1.0)),
        "above": mesh(folder / "above.obj", glass(1.5, 1.0)),
        "below": mesh(folder / "below.obj", glass(1.5, 1.33)),
        "water": mesh(folder / "water.obj", glass(1.33, 1.0)),
    }


def diamond(folder):
    placed = mi.ScalarTransform4f().translate([0, 0.5, 0]).rotate([0, 1, 0], 7)
    stone = mesh(folder / "brilliant.obj", glass(2.42, 1.0), face_normals=True, to_world=placed)
    return ([0, 1.6, 2.4], [0, 0.3, 0], 30), {"stone": stone}


OBJECTS = {"ball": ball, "bubbles": bubbles, "mesh": smooth_mesh, "glass": glass_of_water, "diamond": diamond}


def write_obj(file, points, normals, triangles):
    """A mesh whose corners have a normal each."""
    with open(file, "w") as out:
        np.savetxt(out, points, "v %.9g %.9g %.9g")
        np.savetxt(out, normals, "vn %.9g %.9g %.9g")
        np.savetxt(out, np.repeat(triangles + 1, 2, axis=1), "f %d//%d %d//%d %d//%d")


def grid(rows, columns, first, close_rows=False):
    """Triangles between rows of vertices that are closed to rings; `first` is the number of the first vertex."""
    i, j = np.meshgrid(np.arange(rows if close_rows else rows - 1), np.arange(columns), indexing="ij")
    below, right = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = (first + x * columns + y for x, y in [(i, j), (below, j), (below, right), (i, right)])
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def write_knot(file, along=1250, around=40, thickness=0.27):
    """A knot of 2 * along * around triangles: a tube around a curve that winds around a torus, twice one way and three times the
    other."""
    t = np.arange(along)[:, None] / along * 2 * np.pi
    s = np.arange(around)[None, :, None] / around * 2 * np.pi

    def curve(t):
        r = 0.95 + 0.4 * np.cos(3 * t)
        return np.concatenate([r * np.cos(2 * t), 0.4 * np.sin(3 * t), r * np.sin(2 * t)], -1)

    step = 1e-4
    tangent = unit(curve(t + step) - curve(t - step))
    across = unit(np.cross(tangent, [0.0, 1.0, 0.0]))
    over = np.cross(across, tangent)
    normals = np.cos(s) * across[:, None] + np.sin(s) * over[:, None]
    points = curve(t)[:, None] + thickness * normals + [0, 0.69, 0]
    write_obj(file, points.reshape(-1, 3), normals.reshape(-1, 3), outwards(points, normals, grid(along, around, 0, True)))


def outwards(points, normals, triangles):
    """Triangles wound so that they are counterclockwise where their normals point to."""
    points, normals = points.reshape(-1, 3), normals.reshape(-1, 3)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    wrong = (np.cross(b - a, c - a) * normals[triangles].sum(1)).sum(-1) < 0
    return np.where(wrong[:, None], triangles[:, ::-1], triangles)


def arc(centre, radius, start, end, steps=16):
    """Points of a profile (radius and height), with their normals, from one angle to another in degrees."""
    angle = np.radians(np.linspace(start, end, steps + 1))
    normal = np.stack([np.cos(angle), np.sin(angle)], -1)
    return np.array(centre) + radius * normal, normal


def line(start, end, normal, steps=1):
    t = np.linspace(0, 1, steps + 1)[:, None]
    return np.array(start) * (1 - t) + np.array(end) * t, np.tile(np.array(normal, float), (steps + 1, 1))


def lathe(file, *parts, around=192):
    """Turns a profile around the axis y."""
    profile = np.concatenate([p for p, _ in parts])
    normal = np.concatenate([n for _, n in parts])
    # What two parts share, stands once.
    keep = np.append(True, np.linalg.norm(np.diff(profile, axis=0), axis=1) > 1e-9)
    profile, normal = profile[keep], normal[keep]
    angle = np.arange(around) / around * 2 * np.pi

    def turned(p):
        x, z = np.outer(p[:, 0], np.cos(angle)), np.outer(p[:, 0], np.sin(angle))
        return np.stack([x, np.repeat(p[:, 1:], around, axis=1), z], -1).reshape(-1, 3)

    points, normals = turned(profile), turned(normal)
    triangles = grid(len(profile), around, 0)
    # Where the profile meets the axis, a ring is a point.
    on_axis = np.repeat(np.abs(profile[:, 0]) < 1e-12, around)
    ring = np.arange(len(points)) // around * around
    triangles = np.where(on_axis[triangles], ring[triangles], triangles)
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (a != c)]
    used, compact = np.unique(triangles, return_inverse=True)
    points, normals = points[used], normals[used]
    write_obj(file, points, normals, outwards(points, normals, compact.reshape(-1, 3)))


def write_glass_of_water(folder):
    """A tumbler with straight walls, all its edges rounded, filled to two thirds."""
    bottom, top, level = 0.01, 1.30, 0.85
    outer, inner, rounded = 0.55, 0.47, 0.10
    rim = (outer - inner) / 2
    ground = bottom + 0.12
    lathe(
        folder / "outside.obj",
        line([0, bottom], [outer - rounded, bottom], [0, -1]),
        arc([outer - rounded, bottom + rounded], rounded, -90, 0),
        line([outer, bottom + rounded], [outer, top], [1, 0], 8),
        arc([inner + rim, top], rim, 0, 180),
    )
    lathe(folder / "above.obj", line([inner, top], [inner, level], [-1, 0], 4))
    lathe(
        folder / "below.obj",
        line([inner, level], [inner, ground + rounded], [-1, 0], 4),
        arc_inside([inner - rounded, ground + rounded], rounded),
        line([inner - rounded, ground], [0, ground], [0, 1]),
    )
    lathe(folder / "water.obj", line([inner, level], [0, level], [0, 1]))


def arc_inside(centre, radius):
    """The rounded edge of a hollow, seen from the hollow."""
    points, normals = arc(centre, radius, 0, -90)
    return points, -normals
