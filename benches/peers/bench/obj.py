"""Meshes: OBJ files, and shapes made of triangles for programs that have nothing else."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Triangles:
    """Corners, a normal of each (or none: faceted), and triples of corners, counterclockwise seen from outside."""

    points: np.ndarray
    normals: np.ndarray | None
    corners: np.ndarray


def read_obj(path: Path, shading: str, placed: np.ndarray) -> Triangles:
    """The triangles of an OBJ file: only v, vn and f count. `shading` is vitrum's `normals`."""
    points, normals, corners = [], [], []
    for line in path.read_text().splitlines():
        key, *rest = line.split() or [""]
        if key == "v":
            points.append([float(x) for x in rest])
        elif key == "vn":
            normals.append([float(x) for x in rest])
        elif key == "f":
            face = [[int(x or 0) - 1 for x in (corner + "//").split("/")[:3]] for corner in rest]
            corners += [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
    points = np.array(points, float) @ placed[:3, :3].T + placed[:3, 3]
    corners = np.array(corners)
    triples = corners[..., 0]
    if shading == "smooth":
        return Triangles(points, smooth_normals(points, triples), triples)
    if shading == "flat" or not normals:
        return Triangles(points, None, triples)
    # A corner is a point with a normal. Transforms here only turn and move, so normals turn as points do.
    turned = np.array(normals, float) @ placed[:3, :3].T
    pairs, numbers = np.unique(corners[..., [0, 2]].reshape(-1, 2), axis=0, return_inverse=True)
    return Triangles(points[pairs[:, 0]], turned[pairs[:, 1]], numbers.reshape(-1, 3))


def smooth_normals(points, triples) -> np.ndarray:
    """Normals of the faces around each point, weighed by their angles there, as vitrum weighs them."""
    p = points[triples]
    face = unit(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]))
    normals = np.zeros_like(points)
    for i in range(3):
        to_next, to_last = unit(p[:, (i + 1) % 3] - p[:, i]), unit(p[:, (i + 2) % 3] - p[:, i])
        angle = np.arccos(np.clip((to_next * to_last).sum(1), -1, 1))
        np.add.at(normals, triples[:, i], face * angle[:, None])
    return unit(normals)


def unit(v) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def ball(divisions: int) -> Triangles:
    """The unit sphere, as an icosahedron whose faces are divided so many times: 20 * 4^divisions triangles."""
    g = (1 + 5**0.5) / 2
    points = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g]]
    points += [[0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]]
    triples = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2]]
    triples += [[10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11]]
    triples += [[6, 2, 10], [8, 6, 7], [9, 8, 1]]
    points, triples = unit(np.array(points, float)), np.array(triples)
    for _ in range(divisions):
        edges = np.sort(triples[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, numbers = np.unique(edges, axis=0, return_inverse=True)
        middle = numbers.reshape(-1, 3) + len(points)
        points = np.concatenate([points, unit(points[edges].sum(1))])
        (a, b, c), (ab, bc, ca) = triples.T, middle.T
        triples = np.concatenate([np.stack(t, 1) for t in [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]])
    return Triangles(points, points, triples)


def as_triangles(shape, divisions: int) -> Triangles:
    """Any shape as triangles; balls and disks are divided finely."""
    from scene import Box, Disk, Mesh, Rectangle, Sphere

    match shape:
        case Mesh():
            return shape.triangles
        case Sphere():
            unit_ball = ball(divisions)
            return Triangles(np.array(shape.center) + shape.radius * unit_ball.points, unit_ball.normals, unit_ball.corners)
        case Rectangle():
            corner, u, v = (np.array(x) for x in (shape.corner, shape.u, shape.v))
            points = np.stack([corner, corner + u, corner + u + v, corner + v])
            return Triangles(points, None, np.array([[0, 1, 2], [0, 2, 3]]))
        case Disk():
            return fan(shape)
        case Box():
            return box(shape)
    raise ValueError(f"{shape} has no triangles")


def fan(disk, around=4096) -> Triangles:
    """A disk as a polygon of many corners."""
    normal = np.array(disk.normal)
    across = unit(np.cross(normal, [1, 0, 0] if abs(normal[0]) < 0.9 else [0, 1, 0]))
    angle = np.arange(around)[:, None] / around * 2 * np.pi
    rim = np.cos(angle) * across + np.sin(angle) * np.cross(normal, across)
    points = np.concatenate([[disk.center], np.array(disk.center) + disk.radius * rim])
    i = np.arange(around)
    return Triangles(points, None, np.stack([0 * i, 1 + i, 1 + (i + 1) % around], 1))


def box(box) -> Triangles:
    low, high = np.array(box.low), np.array(box.high)
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
    squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return Triangles(points, None, np.array([t for a, b, c, d in squares for t in ([a, b, c], [a, c, d])]))
