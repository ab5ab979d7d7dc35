"""Renders a scene with POV-Ray, as far as it can say what stands in it. What is set and why is in README.md.

POV-Ray traces rays from the camera to lights and through glass, asks a cache of samples for the light of the sky and of other
surfaces (radiosity), and shoots photons from lights through glass. It does not converge to the picture of the others.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import exr
import job as jobs
import numpy as np
import scene as scenes

PROGRAM = "povray"
# Its law of distance is 2 / (1 + (d / FADE)^2), which is that of light where FADE is small.
FADE = 1e-3
# Deeper, the stack overflows. Rays that weigh less than BAILOUT are not traced.
LEVEL, BAILOUT = 40, 1e-4
# The most rays that it takes for a sample of radiosity.
RAYS = 1600
# Photons for each pixel and sample.
PHOTONS = 4.0


class NotExpressible(Exception):
    """What POV-Ray has no words for."""


def vector(v):
    return "<" + ", ".join(repr(float(x)) for x in v) + ">"


def rgb(color):
    return "rgb " + vector(color)


def camera(scene):
    """`right` points to -x, which makes the frame right-handed."""
    camera, (width, height) = scene.camera, scene.size
    return (
        f"camera {{ location {vector(camera.position)} direction {float(0.5 / np.tan(np.radians(camera.fov) / 2))!r} * z "
        f"up y right {-width / height!r} * x sky {vector(camera.up)} look_at {vector(camera.target)} }}"
    )


def background(found):
    match found:
        case scenes.Gradient():
            stops = f"[0 {rgb(found.bottom)}] [1 {rgb(found.top)}]"
            return f"sky_sphere {{ pigment {{ gradient y color_map {{ {stops} }} scale 2 translate -y }} }}"
        case scenes.Image():
            # Its middle is -X in POV-Ray, and right of that -Z.
            image = f'image_map {{ exr "{found.file.resolve()}" map_type 1 interpolate 2 }} rotate -90 * y'
            return f"sky_sphere {{ pigment {{ {image} }} }}"
    return "background { rgb 0 }"


def checker(paint):
    """Cells are solid: along the third axis a cell ends nowhere near the rectangle."""
    third = ({0, 1, 2} - set(paint.axes)).pop()
    shift = np.array(paint.origin, float)
    shift[third] -= 0.5 * paint.size
    return f"checker {rgb(paint.even)} {rgb(paint.odd)} scale {paint.size!r} translate {vector(shift)}"


def texture(stuff):
    """Diffuse light has no 1 / pi."""
    match stuff:
        case scenes.Matte():
            pigment = checker(stuff.color) if isinstance(stuff.color, scenes.Checker) else rgb(stuff.color)
            return f"pigment {{ {pigment} }} finish {{ ambient 0 diffuse 1 }}"
        case scenes.Dielectric(roughness=0.0):
            surface = "finish { ambient 0 diffuse 0 conserve_energy reflection { 0, 1 fresnel on } }"
            photons = "photons { target reflection on refraction on collect off }"
            return f"pigment {{ rgbt 1 }} {surface} interior {{ ior {stuff.inside!r} }} {photons}"
        case scenes.Emissive():
            black = "interior_texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } }"
            # The light source that stands in its place lights others.
            shining = f"pigment {{ {rgb(stuff.radiance)} }} finish {{ ambient 0 diffuse 0 emission 1 }}"
            return f"{shining} {black} no_shadow no_radiosity"
    raise NotExpressible("no rough glass or metal")


def shape(found):
    match found:
        case scenes.Sphere():
            return f"sphere {{ {vector(found.center)}, {found.radius!r}"
        case scenes.Disk():
            return f"disc {{ {vector(found.center)}, {vector(found.normal)}, {found.radius!r}"
        case scenes.Box():
            return f"box {{ {vector(found.low)}, {vector(found.high)}"
        case scenes.Rectangle():
            corner, u, v = (np.array(x) for x in (found.corner, found.u, found.v))
            # Clockwise: the frame of its triangles is left-handed.
            return mesh(np.stack([corner, corner + u, corner + u + v, corner + v]), None, np.array([[0, 2, 1], [0, 3, 2]]))
        case scenes.Mesh():
            return mesh(found.triangles.points, found.triangles.normals, found.triangles.corners)


def mesh(points, normals, corners):
    def listed(name, vectors):
        return f"{name} {{ {len(vectors)}, " + ", ".join(vectors) + " }"

    lists = [listed("vertex_vectors", [vector(p) for p in points])]
    if normals is not None:
        lists.append(listed("normal_vectors", [vector(n) for n in normals]))
    lists.append(listed("face_indices", ["<%d, %d, %d>" % tuple(c) for c in corners]))
    return "mesh2 { " + " ".join(lists)


def lamp(found, radiance):
    """A light source in the place of a thing that shines: a grid of points, moved at random."""
    grid = "4, 4 jitter area_illumination on photons { area_light reflection on refraction on }"
    fade = f"fade_distance {FADE!r} fade_power 2"
    match found:
        case scenes.Sphere():
            # A disk that faces what it lights.
            across = 2 * found.radius
            color = np.array(radiance) * found.radius**2 / (2 * FADE**2)
            area = f"area_light {across!r} * x, {across!r} * y, {grid} circular orient"
            return f"light_source {{ {vector(found.center)}, {rgb(color)} {area} {fade} }}"
        case scenes.Rectangle():
            corner, u, v = (np.array(x) for x in (found.corner, found.u, found.v))
            normal, middle = np.cross(u, v), corner + (u + v) / 2
            color = np.array(radiance) * np.linalg.norm(normal) / (2 * np.pi * FADE**2)
            # A spot of tightness 1 is a cosine.
            cosine = f"spotlight radius 90 falloff 90 tightness 1 point_at {vector(middle + normal)}"
            area = f"area_light {vector(u)}, {vector(v)}, {grid}"
            return f"light_source {{ {vector(middle)}, {rgb(color)} {area} {cosine} {fade} }}"


def export(scene, job):
    photons = int(PHOTONS * scene.size[0] * scene.size[1] * job.spp)
    settings = [f"assumed_gamma 1 max_trace_level {LEVEL} adc_bailout {BAILOUT}"]
    is_lamp = [isinstance(each.material, scenes.Emissive) for each in scene.objects]
    if scene.lights or any(is_lamp):
        settings.append(f"photons {{ count {min(photons, 4_000_000)} autostop 0 max_trace_level {LEVEL} }}")
    if scene.background:
        # As fine as its cache goes.
        gather = f"count {min(RAYS, 25 * job.spp)} error_bound 0.4 nearest_count 8 low_error_factor 0.5 recursion_limit 3"
        settings.append(f"radiosity {{ {gather} pretrace_start 0.08 pretrace_end 0.01 gray_threshold 0 brightness 1 }}")
    lines = ["#version 3.7;", f"global_settings {{ {' '.join(settings)} }}", camera(scene), background(scene.background)]
    for light in scene.lights:
        color = np.array(light.intensity) / (2 * np.pi * FADE**2)
        fade = f"fade_distance {FADE!r} fade_power 2 photons {{ reflection on refraction on }}"
        lines.append(f"light_source {{ {vector(light.position)}, {rgb(color)} {fade} }}")
    for each in scene.objects:
        if isinstance(each.shape, scenes.Mesh) and getattr(each.material, "outside", 1.0) != 1.0:
            raise NotExpressible("surfaces between two media: a ray is inside of what it entered last")
        if isinstance(each.material, scenes.Emissive):
            lines.append(lamp(each.shape, each.material.radiance))
        lines.append(f"{shape(each.shape)} {texture(each.material)} }}")
    return "\n".join(lines) + "\n"


def main():
    job = jobs.Job()
    scene = scenes.read(job.scene)
    try:
        text = export(scene, job)
    except NotExpressible as reason:
        # Told from a failure by its number.
        print(reason, file=sys.stderr)
        sys.exit(3)
    (width, height), half = scene.size, (job.spp.bit_length() - 1) // 2
    # As many pixels as there are samples: what it does itself about aliasing takes other numbers than it is asked for.
    down = 1 << half
    across = job.spp // down
    with tempfile.TemporaryDirectory() as folder:
        source, picture = Path(folder) / "scene.pov", Path(folder) / "picture.exr"
        source.write_text(text)
        size = [f"+W{width * across}", f"+H{height * down}"]
        command = [PROGRAM, f"+I{source}", f"+O{picture}", "+FE", *size, "-A", "-D", f"+WT{job.threads}"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            sys.exit(done.stderr[-600:])
        found = exr.read(picture)
    exr.write(job.output, found.reshape(height, down, width, across, 3).mean((1, 3)))
    times = {name: float(time) for name, time in re.findall(r"(\w+) Time:.*\(([\d.]+) seconds\)", done.stderr)}
    version = re.search(r"Ray Tracer Version (\d[\d.]*\d)", done.stderr)
    job.told(version[1] if version else "", across * down, times.pop("Parse", 0.0), sum(times.values()))


if __name__ == "__main__":
    main()
