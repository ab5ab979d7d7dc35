"""Renders a scene with Mitsuba 3. What is set and why is in README.md."""

import os
from pathlib import Path

import job as jobs
import mitsuba as mi
import numpy as np
import scene as scenes
import sky

# A wavefront of so many samples a pixel at most: more are several renders, so that memory suffices.
PASS = 512
# Roulette weighs a path by what it carries in glass, which makes noise; it only has to end what is caught.
ROULETTE_DEPTH = 64


def choose_variant():
    """The vectorised variant where its compiler works, or else the scalar one."""
    try:
        mi.set_variant("llvm_ad_rgb")
        import drjit as dr

        dr.eval(dr.llvm.Float(1) + dr.arange(dr.llvm.Float, 2))
    except Exception as error:
        print(f"Mitsuba: no LLVM that works ({error}), scalar_rgb is taken")
        mi.set_variant("scalar_rgb")


def rgb(color):
    return {"type": "rgb", "value": list(color)}


def transform(matrix):
    return mi.ScalarTransform4f(matrix)


def rectangle(corner, u, v):
    """Mitsuba's goes from -1 to 1, and its outer side is +Z."""
    corner, u, v = (np.array(x, float) for x in (corner, u, v))
    normal = np.cross(u, v)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = u / 2, v / 2, normal / np.linalg.norm(normal)
    matrix[:3, 3] = corner + (u + v) / 2
    return matrix


def checker(paint, shape):
    """Cells are half a unit of uv wide; `color0` is where both halves are equal."""
    if not isinstance(shape, scenes.Rectangle):
        raise ValueError(f"a checker on {shape} is not exported, only on rectangles")
    uv = np.eye(4)
    for row, axis in enumerate(paint.axes):
        cells = 2 * paint.size
        uv[row, :2] = shape.u[axis] / cells, shape.v[axis] / cells
        uv[row, 3] = (shape.corner[axis] - paint.origin[axis]) / cells
    return {"type": "checkerboard", "color0": rgb(paint.even), "color1": rgb(paint.odd), "to_uv": transform(uv)}


def material(stuff, shape):
    match stuff:
        case scenes.Matte():
            is_plain = isinstance(stuff.color, tuple)
            paint = rgb(stuff.color) if is_plain else checker(stuff.color, shape)
            # Matte on both sides, as in vitrum.
            return {"bsdf": {"type": "twosided", "inner": {"type": "diffuse", "reflectance": paint}}}
        case scenes.Dielectric():
            kind = {"type": "dielectric"}
            if stuff.roughness > 0:
                kind = {"type": "roughdielectric", "distribution": "ggx", "alpha": stuff.roughness}
            return {"bsdf": {**kind, "int_ior": stuff.inside, "ext_ior": stuff.outside}}
        case scenes.Conductor():
            metal = {"type": "roughconductor", "distribution": "ggx", "alpha": stuff.roughness}
            return {"bsdf": {**metal, "eta": rgb(stuff.n), "k": rgb(stuff.k)}}
        case scenes.Emissive():
            black = {"type": "diffuse", "reflectance": rgb((0.0, 0.0, 0.0))}
            return {"bsdf": black, "emitter": {"type": "area", "radiance": rgb(stuff.radiance)}}


def thing(thing):
    shape, matter = thing.shape, material(thing.material, thing.shape)
    match shape:
        case scenes.Sphere():
            return {"type": "sphere", "center": list(shape.center), "radius": shape.radius, **matter}
        case scenes.Rectangle():
            return {"type": "rectangle", "to_world": transform(rectangle(shape.corner, shape.u, shape.v)), **matter}
        case scenes.Disk():
            target = np.array(shape.center) + shape.normal
            up = [1, 0, 0] if abs(shape.normal[0]) < 0.9 else [0, 1, 0]
            placed = mi.ScalarTransform4f().look_at(origin=list(shape.center), target=target.tolist(), up=up)
            return {"type": "disk", "to_world": placed.scale(shape.radius), **matter}
        case scenes.Box():
            low, high = np.array(shape.low), np.array(shape.high)
            placed = mi.ScalarTransform4f().translate((low + high) / 2).scale((high - low) / 2)
            return {"type": "cube", "to_world": placed, **matter}
        case scenes.Mesh():
            return mesh(thing.name, shape.triangles, matter)


def mesh(name, triangles, matter):
    """From memory."""
    properties = mi.Properties()
    for key, value in matter.items():
        properties[key] = mi.load_dict(value)
    smooth = triangles.normals is not None
    properties["face_normals"] = not smooth
    found = mi.Mesh(name or "mesh", len(triangles.points), len(triangles.corners), properties, smooth, False)
    values = mi.traverse(found)
    values["vertex_positions"] = triangles.points.astype(np.float32).ravel()
    values["faces"] = triangles.corners.astype(np.uint32).ravel()
    if smooth:
        values["vertex_normals"] = triangles.normals.astype(np.float32).ravel()
    values.update()
    return found


def environment(texels):
    """The left edge is -Z here, and the first and the last row lie at the poles."""
    return {"type": "envmap", "bitmap": mi.Bitmap(texels), "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 180)}


def build(scene, texels):
    camera, film = scene.camera, {"type": "hdrfilm", "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    film["width"], film["height"] = scene.size
    # Light of a point gets through glass only from the light on.
    kind = "ptracer" if scene.lights else "path"
    parts = {
        "type": "scene",
        "integrator": {"type": kind, "max_depth": -1, "rr_depth": ROULETTE_DEPTH},
        "sensor": {
            "type": "perspective",
            "fov": camera.fov,
            "fov_axis": "y",
            # Both in single precision: 1e-3 is too close where the scene is small.
            "near_clip": 1e-3 * float(np.linalg.norm(np.subtract(camera.target, camera.position))),
            "to_world": mi.ScalarTransform4f().look_at(
                origin=list(camera.position), target=list(camera.target), up=list(camera.up)
            ),
            "film": film,
            "sampler": {"type": "independent" if scene.lights else "multijitter"},
        },
    }
    if texels is not None:
        parts["environment"] = environment(texels)
    for number, light in enumerate(scene.lights):
        parts[f"light {number}"] = {"type": "point", "position": list(light.position), "intensity": rgb(light.intensity)}
    for number, each in enumerate(scene.objects):
        parts[f"object {number}"] = thing(each)
    return mi.load_dict(parts)


def main():
    choose_variant()
    # Where a sampler takes more samples than it is asked for, the report says how many.
    mi.set_log_level(mi.LogLevel.Error)
    job = jobs.Job()
    if mi.variant().startswith("llvm"):
        import drjit as dr

        dr.set_thread_count(job.threads)
    scene = scenes.read(job.scene)
    texels = sky.texels(scene.background, rows_at_poles=True) if scene.background else None
    job.begin()
    scene = build(scene, texels)
    job.loaded()
    sampler = scene.sensors()[0].sampler()
    total, taken, asked = 0.0, 0, 0
    while asked < job.spp:
        count = min(PASS, job.spp - asked)
        # Seeds of passes differ.
        seed = (job.seed * 10_007 + asked // PASS) % 2**32
        picture = np.array(mi.render(scene, spp=count, seed=seed), np.float64)
        asked += count
        # The sampler rounds up.
        sampler.set_sample_count(count)
        total = total + sampler.sample_count() * picture
        taken += sampler.sample_count()
    mi.Bitmap((total / taken).astype(np.float32)).write(str(job.output))
    library = Path(os.environ.get("DRJIT_LIBLLVM_PATH", "")).stem
    job.rendered(f"{mi.__version__} {mi.variant()} {library}".strip(), taken)


if __name__ == "__main__":
    main()
