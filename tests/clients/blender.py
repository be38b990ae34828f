"""Reads files of many frames in Blender and compares each vertex of each frame with a run of OBJ files.

    blender -b --factory-startup --python-exit-code 1 -P blender.py -- RUN FRAMES FILE...

RUN is the path of the OBJ files with %04d for the frame, FRAMES are 1..FRAMES. .pc2 and .mdd go through the modifier
Mesh Cache and must be equal as floats; .glb and .gltf through the importer, where a position is the sum of two floats.
Ends with an error where a file differs.
"""

import sys
from array import array

import bpy
import numpy

# A name that the importer of Blender 3.4 uses and Debian's numpy no longer has.
if "bool" not in vars(numpy):
    numpy.bool = bool


def read_obj(path):
    """The coordinates of all vertices as floats."""
    numbers = array("f")
    with open(path) as file:
        for line in file:
            if line.startswith("v "):
                numbers.extend(float(word) for word in line.split()[1:4])
    return numbers


def coordinates(thing):
    """Of the vertices as the modifiers and shape keys of the present frame leave them."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    numbers = array("f", [0.0]) * (3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", numbers)
    evaluated.to_mesh_clear()
    return numbers


def with_mesh_cache(path, kind, first):
    mesh = bpy.data.meshes.new("cached")
    mesh.from_pydata(list(zip(first[0::3], first[1::3], first[2::3])), [], [])
    thing = bpy.data.objects.new("cached", mesh)
    bpy.context.scene.collection.objects.link(thing)
    cache = thing.modifiers.new("cache", "MESH_CACHE")
    cache.cache_format = kind
    cache.filepath = path
    cache.interpolation = "NONE"
    cache.time_mode = "FRAME"
    cache.play_mode = "SCENE"
    cache.frame_start = 1
    cache.forward_axis = "POS_Y"
    cache.up_axis = "POS_Z"
    return thing, lambda numbers: numbers


def imported(path):
    bpy.ops.import_scene.gltf(filepath=path)
    things = [thing for thing in bpy.context.selected_objects if thing.type == "MESH"]
    if len(things) != 1:
        raise RuntimeError(f"{path}: expected one mesh, found {len(things)}")

    def with_y_up(numbers):
        # The importer turns (x, y, z) into (x, -z, y).
        for i in range(0, len(numbers), 3):
            numbers[i + 1], numbers[i + 2] = numbers[i + 2], -numbers[i + 1]
        return numbers

    return things[0], with_y_up


def difference(found, expected):
    """The largest of all coordinates; infinite where there are more or fewer."""
    if len(found) != len(expected):
        print(f"expected {len(expected) // 3} vertices, found {len(found) // 3}")
        return float("inf")
    return max(abs(a - b) for a, b in zip(found, expected))


def check(path, run, frames):
    kind = path.rsplit(".", 1)[1].upper()
    cached = kind in ("PC2", "MDD")
    first = read_obj(run % 1)
    thing, as_file = with_mesh_cache(path, kind, first) if cached else imported(path)
    # A sum of two floats, both within the size of the shape, is rounded twice.
    allowed = 0.0 if cached else 2.0**-22 * max(abs(x) for x in first)
    worst, worst_frame = -1.0, 0
    for frame in range(1, frames + 1):
        bpy.context.scene.frame_set(frame)
        by = difference(as_file(coordinates(thing)), read_obj(run % frame))
        if by > worst:
            worst, worst_frame = by, frame
    good = worst <= allowed
    print(f"{'equal' if good else 'DIFFERENT'}: {path}: {frames} frames of {len(first) // 3} vertices, "
          f"at most {worst:.3g} apart (frame {worst_frame}, allowed {allowed:.3g})")
    return good


def main():
    run, frames, *paths = sys.argv[sys.argv.index("--") + 1:]
    bpy.context.scene.render.fps = 24
    if not all([check(path, run, int(frames)) for path in paths]):
        raise RuntimeError("Blender does not see what was written")


main()
