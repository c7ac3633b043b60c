# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the frames of a run into Blender (3.4 or later), with velocities for Cycles' motion blur.

    blender --python scripts/blender_import.py -- out/splash [--start 1] [--scale 1] [--step 1] [--save splash.blend]

One mesh object a frame, in a collection named after the directory, each shown at its own frame only. 1 cm becomes
`scale` Blender units. Each mesh has the vertex attributes `velocity` (Blender units a second as the scene plays, which
is what Cycles blurs by), `drop` and `contact`. Nothing has to run when the .blend file is opened again.
"""
import argparse
import math
import pathlib
import re
import sys

import bpy
import numpy as np

TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
         "float": "<f4", "double": "<f8"}


def read_ply(path: pathlib.Path):
    """A frame of `meniscus evolve`: its vertices as a record array, its triangles and its time (s)."""
    data = path.read_bytes()
    end = data.find(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii", "replace")
    if "format binary_little_endian" not in header or "property list uchar int vertex_indices" not in header:
        raise SystemExit(f"{path}: is not a frame that meniscus wrote")
    number = {name: int(n) for name, n in re.findall(r"element (\w+) (\d+)", header)}
    vertex = np.dtype([(name, TYPES[kind]) for kind, name in re.findall(r"property (\w+) (\w+)\n", header)])
    face = np.dtype([("n", "u1"), ("corners", "<i4", 3)])
    vertices = np.frombuffer(data, vertex, number["vertex"], end)
    faces = np.frombuffer(data, face, number["face"], end + vertices.nbytes)
    time = re.search(r"comment time (\S+)", header)
    return vertices, faces["corners"], float(time[1]) if time else None


def columns(vertices, names) -> np.ndarray:
    return np.stack([vertices[name] for name in names], axis=1).astype(np.float32)


def make_mesh(name: str, vertices, triangles, scale: float, velocity_scale: float) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.loops.add(3 * len(triangles))
    mesh.polygons.add(len(triangles))
    mesh.vertices.foreach_set("co", (scale * columns(vertices, "xyz")).ravel())
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    if bpy.app.version < (4, 1, 0):  # later ones count it themselves
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), dtype=bool))
    if "vx" in vertices.dtype.names:
        velocity = mesh.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
        velocity.data.foreach_set("vector", (velocity_scale * columns(vertices, ("vx", "vy", "vz"))).ravel())
    for own in ("drop", "contact"):
        if own in vertices.dtype.names:
            attribute = mesh.attributes.new(own, "INT", "POINT")
            attribute.data.foreach_set("value", vertices[own].astype(np.int32))
    mesh.update(calc_edges=True)
    return mesh


def water() -> bpy.types.Material:
    material = bpy.data.materials.new("water")
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    for name, value in {"Transmission": 1, "Transmission Weight": 1, "IOR": 1.333, "Roughness": 0}.items():
        if name in inputs:
            inputs[name].default_value = value
    return material


def show_only_at(item: bpy.types.Object, frame: int, is_first: bool, is_last: bool) -> None:
    """Keys that hide an object but at one frame; the first and the last frame stay before and after."""
    for path in ("hide_viewport", "hide_render"):
        for at, hidden in ((frame - 1, not is_first), (frame, False), (frame + 1, not is_last)):
            setattr(item, path, hidden)
            item.keyframe_insert(path, frame=at)
    for curve in item.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "CONSTANT"


def load(directory: pathlib.Path, start: int, scale: float, step: int) -> int:
    paths = sorted(directory.glob("frame_*.ply"), key=lambda path: (len(path.name), path.name))[::step]
    if not paths:
        raise SystemExit(f"{directory}: holds no frames (frame_0000.ply, ...)")
    scene = bpy.context.scene
    fps = scene.render.fps / scene.render.fps_base
    frames = [read_ply(path) for path in paths]
    times = [time for _, _, time in frames]
    spacing = times[1] - times[0] if len(times) > 1 and None not in times[:2] else 1 / fps
    collection = bpy.data.collections.new(directory.resolve().name)
    scene.collection.children.link(collection)
    material = water()
    for k, (path, (vertices, triangles, _)) in enumerate(zip(paths, frames)):
        mesh = make_mesh(path.stem, vertices, triangles, scale, scale * spacing * fps)
        mesh.materials.append(material)
        item = bpy.data.objects.new(path.stem, mesh)
        collection.objects.link(item)
        show_only_at(item, start + k, k == 0, k == len(paths) - 1)
    scene.frame_start, scene.frame_end = start, start + len(paths) - 1
    scene.frame_set(start)
    scene.render.use_motion_blur = True
    print(f"{len(paths)} frames of {directory}; they play {1 / (spacing * fps):.3g} times slower than life"
          if not math.isclose(spacing * fps, 1) else f"{len(paths)} frames of {directory}, in real time")
    return len(paths)


def main() -> None:
    parser = argparse.ArgumentParser(prog="blender --python blender_import.py --", description=__doc__.split("\n")[0])
    parser.add_argument("directory", type=pathlib.Path, help="what meniscus evolve wrote")
    parser.add_argument("--start", type=int, default=1, help="Blender's frame for the first one (1)")
    parser.add_argument("--scale", type=float, default=1, help="Blender units a cm (1)")
    parser.add_argument("--step", type=int, default=1, help="take every Nth frame (1)")
    parser.add_argument("--save", type=pathlib.Path, help="write a .blend file")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    load(arguments.directory, arguments.start, arguments.scale, arguments.step)
    if arguments.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(arguments.save.resolve()))


if __name__ == "__main__":
    main()
