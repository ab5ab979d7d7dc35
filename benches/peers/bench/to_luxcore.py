"""Renders a scene with LuxCore. What is set and why is in README.md."""

import os
import tempfile
import time
from pathlib import Path

import exr
import job as jobs
import numpy as np
import pyluxcore
import scene as scenes
import sky
from obj import Triangles, as_triangles, ball

# LuxCore has triangles only: a ball has 20 * 4^6 of them.
DIVISIONS = 6
# Segments of a path; there is no "without limit".
DEPTH = 64


def write_ply(path: Path, triangles: Triangles, uv=None):
    names = ["x", "y", "z"]
    columns = [triangles.points]
    if triangles.normals is not None:
        names += ["nx", "ny", "nz"]
        columns.append(triangles.normals)
    if uv is not None:
        names += ["s", "t"]
        columns.append(uv)
    corners = np.empty(len(triangles.corners), [("count", "u1"), ("corners", "<i4", 3)])
    corners["count"], corners["corners"] = 3, triangles.corners
    with open(path, "wb") as file:
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(triangles.points)}"]
        header += [f"property float {name}" for name in names]
        header += [f"element face {len(corners)}", "property list uchar int vertex_indices", "end_header", ""]
        file.write("\n".join(header).encode())
        file.write(np.concatenate(columns, 1).astype("<f4").tobytes())
        file.write(corners.tobytes())


class Export:
    """Properties of LuxCore, and files that they refer to."""

    def __init__(self, scene, folder):
        self.folder, self.values, self.ball = folder, {}, None
        self.camera(scene)
        if scene.background:
            exr.write(folder / "sky.exr", sky.texels(scene.background))
            self.add("scene.lights.sky", {"type": "infinite", "file": str(folder / "sky.exr"), "gamma": 1.0})
            # Its middle is -X, its upper edge +Z, and what is right of its middle -Y, as seen in a mirror: brought to -Z, +Y, +X.
            turn = np.array([[0, -1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], float)
            self.add("scene.lights.sky", {"transformation": turn.T.ravel().tolist()})
        for number, light in enumerate(scene.lights):
            # Its colour is divided by 4 pi, as that of a light of so many watts.
            gain = [4 * np.pi * x for x in light.intensity]
            values = {"type": "point", "position": list(light.position), "gain": gain, "color": [1.0, 1.0, 1.0]}
            self.add(f"scene.lights.light{number}", values)
        for number, each in enumerate(scene.objects):
            self.thing(f"thing{number}", each)

    def add(self, prefix, values):
        self.values.update({f"{prefix}.{key}": value for key, value in values.items()})

    def camera(self, scene):
        """The window is in units of the field of view. Pictures of LuxCore lie a row too low, so it is put a row lower."""
        camera, (width, height) = scene.camera, scene.size
        across, row = width / height, 2 / height
        values = {"type": "perspective", "fieldofview": camera.fov, "lookat.orig": list(camera.position)}
        values["screenwindow"] = [-across, across, -1 - row, 1 - row]
        values |= {"lookat.target": list(camera.target), "up": list(camera.up), "cliphither": 1e-6}
        self.add("scene.camera", values)

    def thing(self, name, thing):
        shape, uv = thing.shape, None
        self.material(name, thing.material)
        values = {"material": name}
        if isinstance(shape, scenes.Sphere):
            # One file and one tree for all of them.
            if not self.ball:
                self.ball = str(self.folder / "ball.ply")
                write_ply(Path(self.ball), ball(DIVISIONS))
                self.add("scene.shapes.ball", {"type": "mesh", "ply": self.ball})
            placed = np.diag([shape.radius] * 3 + [1.0])
            placed[:3, 3] = shape.center
            values |= {"shape": "ball", "transformation": placed.T.ravel().tolist()}
        else:
            triangles = as_triangles(shape, DIVISIONS)
            paint = getattr(thing.material, "color", None)
            if isinstance(paint, scenes.Checker):
                uv = np.stack([(triangles.points[:, a] - paint.origin[a]) / paint.size for a in paint.axes], 1)
            write_ply(self.folder / f"{name}.ply", triangles, uv)
            self.add(f"scene.shapes.{name}", {"type": "mesh", "ply": str(self.folder / f"{name}.ply")})
            values["shape"] = name
        self.add(f"scene.objects.{name}", values)

    def material(self, name, stuff):
        match stuff:
            case scenes.Matte():
                color = stuff.color
                if isinstance(color, scenes.Checker):
                    values = {"type": "checkerboard2d", "texture1": list(color.even), "texture2": list(color.odd)}
                    self.add(f"scene.textures.{name}", values)
                    color = name
                values = {"type": "matte", "kd": color if isinstance(color, str) else list(color)}
            case scenes.Dielectric():
                values = {"type": "glass", "kr": [1.0] * 3, "kt": [1.0] * 3}
                values |= {"interiorior": stuff.inside, "exteriorior": stuff.outside}
                if stuff.roughness > 0:
                    values |= {"type": "roughglass", "uroughness": stuff.roughness, "vroughness": stuff.roughness}
            case scenes.Conductor():
                self.add(f"scene.textures.{name}", {"type": "fresnelconst", "n": list(stuff.n), "k": list(stuff.k)})
                values = {"type": "metal2", "fresnel": name, "uroughness": stuff.roughness, "vroughness": stuff.roughness}
            case scenes.Emissive():
                values = {"type": "matte", "kd": [0.0] * 3, "emission": list(stuff.radiance), "emission.theta": 90.0}
        self.add(f"scene.materials.{name}", values)


def properties(values):
    found = pyluxcore.Properties()
    for key, value in values.items():
        found.Set(pyluxcore.Property(key, value))
    return found


def settings(scene, job):
    """How it renders."""
    width, height = scene.size
    values = {
        "renderengine.type": "PATHCPU",
        "renderengine.seed": job.seed,
        "native.threads.count": job.threads,
        "sampler.type": "SOBOL",
        "batch.haltspp": job.spp,
        "film.width": width,
        "film.height": height,
        "film.filter.type": "NONE",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "picture.exr",
        "path.pathdepth.total": DEPTH,
        "path.pathdepth.diffuse": DEPTH,
        "path.pathdepth.glossy": DEPTH,
        "path.pathdepth.specular": DEPTH,
        # Without roulette: it begins where paths end anyway.
        "path.russianroulette.depth": DEPTH,
        "path.clamping.variance.maxvalue": 0.0,
    }
    is_small = [isinstance(each.material, scenes.Emissive) and isinstance(each.shape, scenes.Sphere) for each in scene.objects]
    if scene.lights or any(is_small):
        # Light of a point gets through glass only from the light on, and that of a small lamp better: bidirectional paths.
        values |= {"renderengine.type": "BIDIRCPU", "path.maxdepth": DEPTH, "light.maxdepth": DEPTH}
    return values


def main():
    pyluxcore.Init()
    pyluxcore.SetLogHandler(lambda message: None)
    job = jobs.Job()
    scene = scenes.read(job.scene)
    with tempfile.TemporaryDirectory() as folder:
        export = Export(scene, Path(folder))
        config = settings(scene, job)
        job.begin()
        loaded = pyluxcore.Scene()
        loaded.Parse(properties(export.values))
        session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(config), loaded))
        session.Start()
        job.loaded()
        while not session.HasDone():
            time.sleep(0.005)
            session.UpdateStats()
        session.Stop()
    width, height = scene.size
    film, picture = session.GetFilm(), np.empty((height, width, 3), np.float32)
    film.GetOutputFloat(pyluxcore.FilmOutputType.RGB, picture)
    taken = session.GetStats().Get("stats.renderengine.pass").GetInt()
    # Rows are from below.
    exr.write(job.output, picture[::-1])
    job.rendered(pyluxcore.Version(), taken)
    # Its threads are not ended in order when Python ends.
    os._exit(0)


if __name__ == "__main__":
    main()
