"""Renders a Mitsuba 3 scene with Blender's Cycles, for `tachylite bench --external`:

  blender --background --factory-startup --python-exit-code 1 --python render.py -- SCENE.xml SAMPLES SEED OUT.exr

Further arguments: -D name=value; --pattern sobol|pmj (of the samples; pmj); --threads N (2).

Same camera, materials, lights, box filter and path length as the scene; roulette as Cycles likes; no clamping, no
adaptive sampling, no denoising, no filtering of glossy paths; float EXR. The last line on stdout is what the bench
reads: {"render_cpu_seconds", "render_wall_seconds"} of the samples alone. Cycles does not tell it, so a render of one
sample is taken off: (t(N) - t(1)) N / (N - 1), both with everything warm.
"""
import argparse
import json
import math
import os
import resource
import sys
import tempfile
import time

import bpy
from mathutils import Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import mitsuba_scene  # noqa: E402
from mitsuba_scene import fail, numbers, to_world, value  # noqa: E402

# Mitsuba's y is up and its environment looks to -z at u = 0; Blender's z is up and its u = 1/2 looks to +x. This
# cyclic change of axes, (x, y, z) -> (z, x, y), makes both environments the same.
AXES = Matrix(((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
FLIP_XZ = Matrix.Diagonal((-1, 1, -1, 1))  # camera: +x left, +z forward -> +x right, -z forward; also for lamps
# Radiance of an area lamp of Cycles is energy / (4 area): found by rendering it, the manual does not say.
LAMP_WATTS = 4.0
LAMP_BACK = 1e-4  # distance of a lamp's back


def world_matrix(element):
    return AXES @ Matrix(to_world(element))


def add_camera(scene, sensor):
    if sensor.get("type") != "perspective":
        fail(f"sensor {sensor.get('type')}")
    film = sensor.find("film")
    width, height = int(value(film, "width")), int(value(film, "height"))
    filter_kind = film.find("rfilter")
    if filter_kind is None or filter_kind.get("type") != "box":
        fail("a reconstruction filter other than box")
    fov, axis = math.radians(float(value(sensor, "fov"))), value(sensor, "fov_axis", "x")
    if axis in ("smaller", "larger"):
        axis = "x" if (width <= height) == (axis == "smaller") else "y"
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "HORIZONTAL" if axis == "x" else "VERTICAL"
    camera.angle = fov
    camera.clip_start, camera.clip_end = 1e-2, 1e4
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = world_matrix(sensor) @ FLIP_XZ
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100


def new_material(name):
    """(material, its emptied node tree's nodes, links, output)"""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree.nodes, tree.links, tree.nodes.new("ShaderNodeOutputMaterial")


def color(text):
    return (*numbers(text), 1.0)


def make_material(bsdf):
    material, nodes, links, output = new_material("bsdf")
    kind = bsdf.get("type") if bsdf is not None else "diffuse"
    if kind == "diffuse":
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        reflectance = value(bsdf, "reflectance", "0.5") if bsdf is not None else "0.5"
        shader.inputs["Color"].default_value = color(reflectance)
        shader.inputs["Roughness"].default_value = 0
    elif kind == "dielectric":
        shader = nodes.new("ShaderNodeBsdfGlass")
        shader.distribution = "SHARP"
        shader.inputs["Color"].default_value = (1, 1, 1, 1)
        shader.inputs["Roughness"].default_value = 0
        shader.inputs["IOR"].default_value = float(value(bsdf, "int_ior")) / float(value(bsdf, "ext_ior"))
    elif kind == "roughconductor":
        if value(bsdf, "material") != "none" or value(bsdf, "distribution") != "ggx":
            fail("a roughconductor other than material none, distribution ggx")
        shader = nodes.new("ShaderNodeBsdfGlossy")
        shader.distribution = "GGX"
        shader.inputs["Color"].default_value = color(value(bsdf, "specular_reflectance", "1"))
        shader.inputs["Roughness"].default_value = math.sqrt(float(value(bsdf, "alpha")))
    else:
        fail(f"bsdf {kind}")
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_mesh(scene, positions, indices, matrix, material, smooth):
    mesh = bpy.data.meshes.new("mesh")
    triangles = len(indices) // 3
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(len(indices))
    mesh.loops.foreach_set("vertex_index", indices)
    mesh.polygons.add(triangles)
    mesh.polygons.foreach_set("loop_start", range(0, 3 * triangles, 3))
    mesh.polygons.foreach_set("loop_total", [3] * triangles)
    mesh.polygons.foreach_set("use_smooth", [smooth] * triangles)
    mesh.update(calc_edges=True)
    mesh.materials.append(material)
    thing = bpy.data.objects.new("mesh", mesh)
    thing.matrix_world = matrix
    scene.collection.objects.link(thing)


def add_lamp(scene, radiance, matrix):
    rgb = numbers(radiance)
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.shape = "RECTANGLE"
    lamp.size, lamp.size_y = 2 * matrix.col[0].length, 2 * matrix.col[1].length
    lamp.color = [c / max(rgb) for c in rgb]
    lamp.energy = LAMP_WATTS * max(rgb) * lamp.size * lamp.size_y
    lamp.cycles.max_bounces = 1024
    thing = bpy.data.objects.new("lamp", lamp)
    place, rotation, _ = (matrix @ FLIP_XZ).decompose()
    thing.matrix_world = Matrix.Translation(place) @ rotation.to_matrix().to_4x4()
    thing.visible_camera = True
    scene.collection.objects.link(thing)


def add_environment(scene, path):
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(path)
    texture.image.colorspace_settings.name = "Linear"
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def configure(scene, integrator, arguments):
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.seed = arguments.seed
    cycles.sampling_pattern = {"sobol": "SOBOL", "pmj": "PROGRESSIVE_MULTI_JITTER"}[arguments.pattern]
    # Bounces are counted after the first surface; Mitsuba counts the segments of a path.
    bounces = max(int(value(integrator, "max_depth")) - 2, 0)
    for name in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, name + "_bounces", bounces)
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    scene.render.threads_mode, scene.render.threads = "FIXED", arguments.threads
    scene.render.use_persistent_data = True
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"


def timed_render(scene, samples, path):
    def now():
        usage = resource.getrusage(resource.RUSAGE_SELF)
        return usage.ru_utime + usage.ru_stime, time.perf_counter()

    scene.cycles.samples = samples
    scene.render.filepath = path
    cpu, wall = now()
    bpy.ops.render.render(write_still=True)
    return [end - start for end, start in zip(now(), (cpu, wall))]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("samples", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("out")
    parser.add_argument("-D", action="append", default=[])
    parser.add_argument("--pattern", choices=("sobol", "pmj"), default="pmj")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    source = mitsuba_scene.Scene(arguments.scene, dict(define.split("=", 1) for define in arguments.D))
    configure(scene, source.root.find("integrator"), arguments)
    add_camera(scene, source.root.find("sensor"))
    for emitter in source.root.findall("emitter"):
        if emitter.get("type") != "envmap" or emitter.find("transform") is not None:
            fail(f"emitter {emitter.get('type')}, or its transform,")
        add_environment(scene, source.file(emitter))
    for shape in source.root.findall("shape"):
        light, matrix = shape.find("emitter"), world_matrix(shape)
        if light is not None:
            if shape.get("type") != "rectangle":
                fail(f"light of shape {shape.get('type')}")
            add_lamp(scene, value(light, "radiance"), matrix)
            # A lamp lets light from behind pass; what stands just behind it does not.
            matrix = Matrix.Translation(-LAMP_BACK * matrix.col[2].to_3d().normalized()) @ matrix
        add_mesh(scene, *source.mesh_of(shape), matrix, make_material(source.bsdf_of(shape)),
                 shape.get("type") == "ply")

    out = os.path.abspath(arguments.out)
    with tempfile.TemporaryDirectory() as folder:
        scratch = os.path.join(folder, "one.exr")
        timed_render(scene, 1, scratch)  # builds trees and loads kernels
        first = timed_render(scene, 1, scratch)
        seconds = timed_render(scene, arguments.samples, out)
    n = arguments.samples
    cpu, wall = ((t - t1) * n / (n - 1) if n > 1 else t for t, t1 in zip(seconds, first))
    print(json.dumps({"render_cpu_seconds": cpu, "render_wall_seconds": wall}), flush=True)


main()
