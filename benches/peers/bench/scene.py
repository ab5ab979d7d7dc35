"""Reads a scene file of vitrum into plain data for the exporters: only what scenes/bench uses; anything else is an error.

Everything that can be decided once is decided here: names are looked up, media become indices, transforms become matrices, and
meshes become arrays of corners in the world. So the exporters can't understand the same scene in different ways.
"""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from metals import METALS
from obj import Triangles, read_obj

Vector = tuple[float, float, float]


@dataclass
class Checker:
    """Cells of two colours along two axes (0, 1, 2 for x, y, z); `even` is the cell that starts at the origin."""

    even: Vector
    odd: Vector
    size: float
    origin: Vector
    axes: tuple[int, int]


@dataclass
class Matte:
    color: Vector | Checker


@dataclass
class Dielectric:
    """Absolute indices on both sides; roughness is the alpha of GGX."""

    inside: float
    outside: float
    roughness: float


@dataclass
class Conductor:
    n: Vector
    k: Vector
    roughness: float


@dataclass
class Emissive:
    """Shines on the outer side, and is black on both."""

    radiance: Vector


Material = Matte | Dielectric | Conductor | Emissive


@dataclass
class Sphere:
    center: Vector
    radius: float


@dataclass
class Rectangle:
    """Its outer side is that of u x v."""

    corner: Vector
    u: Vector
    v: Vector


@dataclass
class Disk:
    center: Vector
    normal: Vector
    radius: float


@dataclass
class Box:
    low: Vector
    high: Vector


@dataclass
class Mesh:
    """In the world; without normals it is faceted."""

    triangles: Triangles


Shape = Sphere | Rectangle | Disk | Box | Mesh


@dataclass
class Object:
    name: str
    shape: Shape
    material: Material


@dataclass
class PointLight:
    position: Vector
    intensity: Vector


@dataclass
class Camera:
    """A pinhole; `fov` is vertical, in degrees."""

    position: Vector
    target: Vector
    fov: float
    up: Vector = (0.0, 1.0, 0.0)


@dataclass
class Gradient:
    """Radiance, linear in the y of the direction."""

    bottom: Vector
    top: Vector


@dataclass
class Image:
    """By latitude and longitude: the middle is -Z, right of it +X."""

    file: Path


@dataclass
class Scene:
    name: str
    size: tuple[int, int]
    camera: Camera
    background: Gradient | Image | None = None
    lights: list[PointLight] = field(default_factory=list)
    objects: list[Object] = field(default_factory=list)


class Table:
    """A table of the file, that knows which keys were read: what is left over is not understood."""

    def __init__(self, values, where):
        self.values, self.where = dict(values), where

    def take(self, key, *default):
        if key not in self.values and not default:
            raise ValueError(f"{self.where}: `{key}` is missing")
        return self.values.pop(key, *default)

    def of(self, key, *allowed):
        """A word out of a few; the first is the default where it may be missing."""
        word = self.take(key)
        if word not in allowed:
            raise ValueError(f"{self.where}: {key} = {word!r} is not exported, only {', '.join(map(repr, allowed))}")
        return word

    def end(self):
        if self.values:
            raise ValueError(f"{self.where}: {', '.join(f'`{key}`' for key in self.values)} is not exported")


def vector(values) -> Vector:
    x, y, z = map(float, values)
    return x, y, z


def color(value) -> Vector:
    """A colour: one number for grey, or three."""
    return vector(value) if isinstance(value, list) else (float(value),) * 3


class Reader:
    def __init__(self, path: Path):
        self.folder = path.parent
        self.file = Table(tomllib.loads(path.read_text()), path.name)
        # What is around everything.
        self.media = {"air": 1.0, "vacuum": 1.0}
        for values in self.file.take("medium", []):
            table = Table(values, "medium")
            self.media[table.take("name")] = float(table.take("ior"))
            table.end()
        self.textures = dict(self.texture(values) for values in self.file.take("texture", []))
        self.materials = {values["name"]: values for values in self.file.take("material", [])}

    def scene(self, name: str) -> Scene:
        render = Table(self.file.take("render"), "render")
        render.of("integrator", "path")
        width, height = render.take("size")
        render.end()
        background = self.file.take("background", None)
        scene = Scene(
            name,
            (width, height),
            self.camera(),
            background and self.background(background),
            [self.light(values) for values in self.file.take("light", [])],
            [self.object(values) for values in self.file.take("object", [])],
        )
        self.file.end()
        return scene

    def camera(self) -> Camera:
        table = Table(self.file.take("camera"), "camera")
        table.of("type", "pinhole")
        camera = Camera(vector(table.take("position")), vector(table.take("target")), float(table.take("fov")))
        table.end()
        return camera

    def background(self, values) -> Gradient | Image:
        table = Table(values, "background")
        if table.of("type", "gradient", "image") == "image":
            found = Image(self.folder / table.take("file"))
        else:
            found = Gradient(color(table.take("bottom")), color(table.take("top")))
        table.end()
        return found

    def light(self, values) -> PointLight:
        table = Table(values, "light")
        table.take("name", None)
        table.of("type", "point")
        light = PointLight(vector(table.take("position")), color(table.take("intensity")))
        table.end()
        return light

    def texture(self, values) -> tuple[str, Checker]:
        table = Table(values, "texture")
        name = table.take("name")
        table.of("type", "checker")
        first, second = table.take("axes", "xz")
        checker = Checker(
            color(table.take("even")),
            color(table.take("odd")),
            float(table.take("size")),
            vector(table.take("origin", [0, 0, 0])),
            ("xyz".index(first), "xyz".index(second)),
        )
        table.end()
        return name, checker

    def material(self, value) -> Material:
        table = Table(self.materials[value] if isinstance(value, str) else value, f"material {value}")
        table.take("name", None)
        match table.of("type", "matte", "dielectric", "conductor", "emissive"):
            case "matte":
                paint = table.take("color")
                found = Matte(self.textures[paint] if isinstance(paint, str) else color(paint))
            case "dielectric":
                inside, outside = table.take("inside", None), self.media[table.take("outside", "air")]
                roughness = float(table.take("roughness", 0))
                if table.take("compensation", True) and roughness > 0:
                    raise ValueError(f"{table.where}: compensation is not exported, few programs have it")
                found = Dielectric(self.media[inside] if inside else float(table.take("ior")), outside, roughness)
            case "conductor":
                found = Conductor(*METALS[table.take("metal")], float(table.take("roughness", 0)))
            case _:
                found = Emissive(color(table.take("radiance")))
        table.end()
        return found

    def object(self, values) -> Object:
        table = Table(values, f"object {values.get('name', '')}")
        name = table.take("name", "")
        match table.of("shape", "sphere", "rectangle", "disk", "box", "mesh"):
            case "sphere":
                shape = Sphere(vector(table.take("center")), float(table.take("radius")))
            case "rectangle":
                shape = Rectangle(*(vector(table.take(key)) for key in ("corner", "edge_u", "edge_v")))
            case "disk":
                normal = np.array(table.take("normal"), float)
                center = vector(table.take("center"))
                shape = Disk(center, vector(normal / np.linalg.norm(normal)), float(table.take("radius")))
            case "box":
                shape = Box(vector(table.take("min")), vector(table.take("max")))
            case _:
                table.take("force", False)
                placed = matrix(table.take("transform", []))
                shape = Mesh(read_obj(self.folder / table.take("file"), table.take("normals", "file"), placed))
        found = Object(name, shape, self.material(table.take("material")))
        table.end()
        return found


def matrix(steps) -> np.ndarray:
    """The steps of a transform as one matrix: the first written acts first."""
    whole = np.eye(4)
    for values in steps:
        step, table = np.eye(4), Table(values, "transform")
        if "translate" in values:
            step[:3, 3] = table.take("translate")
        else:
            rotation = Table(table.take("rotate"), "rotate")
            step[:3, :3] = turn(rotation.take("axis"), rotation.take("angle"))
            rotation.end()
        table.end()
        whole = step @ whole
    return whole


def turn(axis, degrees) -> np.ndarray:
    """Counterclockwise, seen from where the axis points to."""
    x, y, z = np.array(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def read(path) -> Scene:
    path = Path(path)
    return Reader(path).scene(path.stem)
