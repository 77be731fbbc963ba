"""Blender's ABF on the charts given: blender -b --factory-startup --python abf_blender.py -- MESH...

CPU seconds of the whole operator uv.unwrap(method='ANGLE_BASED'), all threads, start-up and reading left out."""
import sys
import time

import bpy


def read(path):
    vertices, faces = [], []
    with open(path) as lines:
        words = [line.split() for line in lines]
    if words[0] == ["OFF"]:
        nv, nf = int(words[1][0]), int(words[1][1])
        vertices = [tuple(map(float, w[:3])) for w in words[2 : 2 + nv]]
        faces = [tuple(map(int, w[1 : 1 + int(w[0])])) for w in words[2 + nv : 2 + nv + nf]]
        return vertices, faces
    for w in words:
        if w[:1] == ["v"]:
            vertices.append(tuple(map(float, w[1:4])))
        elif w[:1] == ["f"]:
            faces.append(tuple(int(c.split("/")[0]) - 1 for c in w[1:]))
    return vertices, faces


def unwrap(path):
    vertices, faces = read(path)
    mesh = bpy.data.meshes.new("chart")
    mesh.from_pydata(vertices, [], faces)
    mesh.uv_layers.new()
    thing = bpy.data.objects.new("chart", mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    start = time.process_time()
    bpy.ops.uv.unwrap(method="ANGLE_BASED", fill_holes=False, correct_aspect=False, margin=0.0)
    seconds = time.process_time() - start
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(thing)
    return len(faces), seconds


for path in sys.argv[sys.argv.index("--") + 1 :]:
    print("blender %s %d %.4f" % ((path.split("/")[-1],) + unwrap(path)))
