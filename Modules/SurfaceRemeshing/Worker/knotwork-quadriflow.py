# SPDX-License-Identifier: BSD-3-Clause
"""What blender runs to make quadrilaterals of triangles; see vtkQuadRemesher. Blender's own Python runs it.

usage: blender --background --python knotwork-quadriflow.py -- IN.off OUT.off FACES SHARP

SHARP is 1 where sharp edges are to be kept, else 0. Nothing is checked here: QuadriFlow may refuse and leave the triangles as they
are, and whoever reads OUT.off finds that out.
"""
import sys

import bpy


def read_mesh(name):
    with open(name, encoding="ascii") as stream:
        words = stream.read().split()
    num_points, num_faces = int(words[1]), int(words[2])
    at = 4 + 3 * num_points
    values = [float(word) for word in words[4:at]]
    points = [tuple(values[i:i + 3]) for i in range(0, len(values), 3)]
    faces = [tuple(int(word) for word in words[at + 4 * f + 1:at + 4 * f + 4]) for f in range(num_faces)]
    return points, faces


def write_mesh(name, mesh):
    with open(name, "w", encoding="ascii") as stream:
        stream.write(f"OFF\n{len(mesh.vertices)} {len(mesh.polygons)} 0\n")
        for vertex in mesh.vertices:
            stream.write("{:.9g} {:.9g} {:.9g}\n".format(*vertex.co))
        for face in mesh.polygons:
            stream.write(" ".join(str(number) for number in (len(face.vertices), *face.vertices)) + "\n")


def main():
    given, made, faces, sharp = sys.argv[sys.argv.index("--") + 1:]
    mesh = bpy.data.meshes.new("scan")
    points, triangles = read_mesh(given)
    mesh.from_pydata(points, [], triangles)
    mesh.update()
    scan = bpy.data.objects.new("scan", mesh)
    bpy.context.collection.objects.link(scan)
    bpy.context.view_layer.objects.active = scan
    scan.select_set(True)
    bpy.ops.object.quadriflow_remesh(use_mesh_symmetry=False, use_preserve_sharp=sharp == "1", use_preserve_boundary=False,
                                     mode="FACES", target_faces=int(faces), seed=0)
    write_mesh(made, scan.data)


main()
