"""Renders a scene with Cycles, as it is in Blender. What is set and why is in README.md."""

import contextlib
import os
import tempfile
import warnings
from pathlib import Path

import bpy
import exr
import job as jobs
import numpy as np
import scene as scenes
import sky
from mathutils import Matrix
from obj import as_triangles, ball

# Blender tells of what will be different in later versions.
warnings.simplefilter("ignore", DeprecationWarning)

# Cycles has no balls that light goes through: 20 * 4^6 triangles are one.
DIVISIONS = 6
# More than any path has; roulette ends them.
BOUNCES = 1024


class Nodes:
    """A tree of shader nodes, from nothing."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def node(self, kind, inputs=(), **properties):
        """A node; inputs that are sockets are linked, others are values."""
        node = self.tree.nodes.new(kind)
        for key, value in properties.items():
            setattr(node, key, value)
        for key, value in dict(inputs).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def shader(self, kind, inputs=(), **properties):
        return self.node(kind, inputs, **properties).outputs[0]


def rgba(color):
    return (*color, 1.0)


class Export:
    def __init__(self, scene, folder):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.target, self.folder = bpy.context.scene, folder
        # Objects that are alike but for their place share a mesh, by what it is made of.
        self.balls, self.materials = {}, {}
        self.has_points = bool(scene.lights)
        self.camera(scene)
        self.world(scene)
        for each in scene.lights:
            self.light(each)
        for each in scene.objects:
            self.thing(each)

    def link(self, name, data, matrix):
        found = bpy.data.objects.new(name, data)
        found.matrix_world = Matrix(matrix.tolist())
        self.target.collection.objects.link(found)
        return found

    def camera(self, scene):
        camera, data = scene.camera, bpy.data.cameras.new("camera")
        data.sensor_fit = "VERTICAL"
        data.angle = np.radians(camera.fov)
        distance = np.linalg.norm(np.subtract(camera.target, camera.position))
        data.clip_start, data.clip_end = 1e-3 * distance, 1e4 * distance
        # It looks along its own -Z.
        backward = np.subtract(camera.position, camera.target) / distance
        right = np.cross(camera.up, backward)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3] = np.stack([right, np.cross(backward, right), backward, camera.position], 1)
        self.target.camera = self.link("camera", data, matrix)

    def world(self, scene):
        world = bpy.data.worlds.new("world")
        self.target.world = world
        world.use_nodes = True
        nodes = Nodes(world.node_tree)
        color = (0.0, 0.0, 0.0, 1.0)
        if scene.background:
            exr.write(self.folder / "sky.exr", sky.texels(scene.background))
            image = bpy.data.images.load(str(self.folder / "sky.exr"))
            image.colorspace_settings.name = "Linear Rec.709"
            # The middle is +X, up is +Z, and right of the middle is -Y: what is asked for is (-z, -x, y).
            to = nodes.node("ShaderNodeSeparateXYZ", {0: nodes.node("ShaderNodeTexCoord").outputs["Generated"]}).outputs
            minus = [nodes.node("ShaderNodeMath", {0: to[i], 1: -1.0}, operation="MULTIPLY").outputs[0] for i in (2, 0)]
            turned = nodes.node("ShaderNodeCombineXYZ", {0: minus[0], 1: minus[1], 2: to[1]}).outputs[0]
            color = nodes.shader("ShaderNodeTexEnvironment", {0: turned}, image=image)
            # As many cells as the picture has.
            world.cycles.sampling_method = "MANUAL"
            world.cycles.sample_map_resolution = min(2048, max(image.size))
        background = nodes.shader("ShaderNodeBackground", {"Color": color})
        nodes.node("ShaderNodeOutputWorld", {"Surface": background})

    def light(self, light):
        data = bpy.data.lights.new("light", "POINT")
        data.shadow_soft_size = 0.0
        # Watts.
        data.energy = 4 * np.pi * max(light.intensity)
        data.color = [x / max(light.intensity) for x in light.intensity]
        data.cycles.is_caustics_light = True
        matrix = np.eye(4)
        matrix[:3, 3] = light.position
        self.link("light", data, matrix)

    def thing(self, thing):
        shape, placed = thing.shape, np.eye(4)
        key = repr(thing.material)
        if key not in self.materials:
            self.materials[key] = self.material(thing.material)
        if isinstance(shape, scenes.Sphere):
            if key not in self.balls:
                self.balls[key] = self.mesh(ball(DIVISIONS), thing.material, self.materials[key])
            data = self.balls[key]
            placed[:3, :3] *= shape.radius
            placed[:3, 3] = shape.center
        else:
            data = self.mesh(as_triangles(shape, DIVISIONS), thing.material, self.materials[key])
        found = self.link(thing.name or "thing", data, placed)
        if self.has_points:
            is_glass = isinstance(thing.material, scenes.Dielectric)
            found.cycles.is_caustics_caster, found.cycles.is_caustics_receiver = is_glass, not is_glass

    def mesh(self, triangles, stuff, material):
        mesh, count = bpy.data.meshes.new("mesh"), len(triangles.corners)
        mesh.vertices.add(len(triangles.points))
        mesh.vertices.foreach_set("co", triangles.points.astype(np.float32).ravel())
        mesh.loops.add(3 * count)
        mesh.loops.foreach_set("vertex_index", triangles.corners.astype(np.int32).ravel())
        mesh.polygons.add(count)
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
        mesh.update(calc_edges=True)
        smooth = triangles.normals is not None
        mesh.polygons.foreach_set("use_smooth", np.full(count, smooth))
        if smooth:
            mesh.normals_split_custom_set_from_vertices(triangles.normals.astype(np.float32))
        paint = getattr(stuff, "color", None)
        if isinstance(paint, scenes.Checker):
            places = triangles.points[triangles.corners.ravel()]
            uv = np.stack([(places[:, a] - paint.origin[a]) / paint.size for a in paint.axes], 1)
            mesh.uv_layers.new(name="uv").data.foreach_set("uv", uv.astype(np.float32).ravel())
        mesh.materials.append(material)
        return mesh

    def material(self, stuff):
        material = bpy.data.materials.new("material")
        material.use_nodes = True
        nodes = Nodes(material.node_tree)
        # What Cycles calls roughness is the square root of alpha.
        roughness = getattr(stuff, "roughness", 0.0) ** 0.5
        match stuff:
            case scenes.Matte(color=scenes.Checker() as paint):
                uv = nodes.node("ShaderNodeUVMap", uv_map="uv").outputs[0]
                # Its second colour is where both cells are even, in a plane of even z.
                inputs = {"Vector": uv, "Color1": rgba(paint.odd), "Color2": rgba(paint.even), "Scale": 1.0}
                shader = nodes.shader("ShaderNodeBsdfDiffuse", {"Color": nodes.shader("ShaderNodeTexChecker", inputs)})
            case scenes.Matte():
                shader = nodes.shader("ShaderNodeBsdfDiffuse", {"Color": rgba(stuff.color)})
            case scenes.Dielectric():
                inputs = {"Color": rgba([1.0] * 3), "IOR": stuff.inside / stuff.outside, "Roughness": roughness}
                shader = nodes.shader("ShaderNodeBsdfGlass", inputs, distribution="GGX")
            case scenes.Conductor():
                inputs = {"IOR": stuff.n, "Extinction": stuff.k, "Roughness": roughness}
                kind = {"distribution": "GGX", "fresnel_type": "PHYSICAL_CONDUCTOR"}
                shader = nodes.shader("ShaderNodeBsdfMetallic", inputs, **kind)
            case scenes.Emissive():
                strength = max(stuff.radiance)
                inputs = {"Color": rgba([x / strength for x in stuff.radiance]), "Strength": strength}
                light = nodes.shader("ShaderNodeEmission", inputs)
                black = nodes.shader("ShaderNodeBsdfDiffuse", {"Color": rgba([0.0] * 3)})
                behind = nodes.node("ShaderNodeNewGeometry").outputs["Backfacing"]
                shader = nodes.shader("ShaderNodeMixShader", {0: behind, 1: light, 2: black})
                material.cycles.emission_sampling = "FRONT"
        nodes.node("ShaderNodeOutputMaterial", {"Surface": shader})
        return material


def settings(target, scene, job):
    """How it renders."""
    render, cycles = target.render, target.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = scene.size
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", job.threads
    render.filepath = str(job.output)
    image = render.image_settings
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
    cycles.device = "CPU"
    cycles.samples, cycles.seed = job.spp, job.seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", BOUNCES)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.use_light_tree = True
    cycles.use_auto_tile = False


@contextlib.contextmanager
def quiet():
    """Blender prints from C."""
    out, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    yield
    os.dup2(out, 1)


def seconds(text):
    """Of a text such as 01:02.34."""
    total = 0.0
    for part in text.split(":"):
        total = 60 * total + float(part)
    return total


def main():
    job = jobs.Job()
    scene = scenes.read(job.scene)
    with tempfile.TemporaryDirectory() as folder, quiet():
        export = Export(scene, Path(folder))
        settings(export.target, scene, job)
        job.begin()
        bpy.ops.render.render(write_still=True)
    # The picture says how long was rendered; the rest is copying the scene, building trees and the map of the sky.
    rendering = seconds(exr.attribute(job.output, "cycles.ViewLayer.render_time"))
    job.rendered(bpy.app.version_string, job.spp, rendering)


if __name__ == "__main__":
    main()
