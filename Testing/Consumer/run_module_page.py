# SPDX-License-Identifier: BSD-3-Clause
"""usage: run_module_page.py PAGE FOLDER COMPILER INCLUDES

Commands and Python of a module's page run as they are written, on small files of the names that they read, and its C++ compiles: the blocks of
a page stand in one function, each in the scope of the one before, behind what CXX declares. INCLUDES: folders, by semicolons. Status 77: libcgal-demo is not installed."""
import json
import os
import shutil
import subprocess
import sys

import knotwork as kw
import knotwork_testing
import numpy as np
import page_snippets
from vtkmodules.vtkCommonDataModel import vtkSphere
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkImagingHybrid import vtkSampleFunction
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
PARTS = os.path.join(ROOT, "Testing", "Data", "Parts")


def copy(*pairs):
    for source, name in pairs:
        shutil.copyfile(os.path.join(PARTS if source.endswith(".step") else FOLDER, source), name)


def run(*words):
    done = knotwork_testing.run_program(*words, timeout=300)
    assert done.returncode == 0, (words, done.stderr)


def unpack(*pairs):
    """Meshes of libcgal-demo by names of the page."""
    files = knotwork_testing.Files(os.path.relpath(FOLDER, knotwork_testing.OUTPUT_DIR))
    files.unpack_meshes(*(name for name, _ in pairs))
    for name, file in pairs:
        os.replace(files.path(name + ".off"), file)


def source(shape, **options):
    made = kw.vtkSplineSource()
    made.SetShapeName(shape)
    for name, value in options.items():
        getattr(made, "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
    made.Update()
    return made


def terrain():
    x, y = (each.ravel() for each in np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 1, 25)))
    return np.c_[x, y, np.exp(-8 * ((x - 0.4) ** 2 + (y - 0.5) ** 2))]


def write_off(name, points, cells):
    with open(name, "w", encoding="ascii") as stream:
        stream.write(f"OFF\n{len(points)} {len(cells)} 0\n")
        stream.writelines(" ".join(map(repr, map(float, point))) + "\n" for point in points)
        stream.writelines(f"{len(cell)} " + " ".join(map(str, cell)) + "\n" for cell in cells)


def cube_sphere(n):
    """Points and quadrilaterals of six blocks of n x n on the unit sphere, seen from outside."""
    u, v = np.meshgrid(*2 * [np.tan(np.linspace(-1, 1, n + 1) * np.pi / 4)], indexing="ij")
    sides = [np.roll(np.stack([np.full_like(u, end), u, v], -1)[::int(end)], axis, -1) for axis in range(3) for end in (-1.0, 1.0)]
    points, number = np.unique(np.round(sides, 12).reshape(-1, 3), axis=0, return_inverse=True)
    number = number.reshape(6, n + 1, n + 1)
    quads = np.stack([number[:, :-1, :-1], number[:, 1:, :-1], number[:, 1:, 1:], number[:, :-1, 1:]], -1)
    return points / np.linalg.norm(points, axis=1)[:, None], quads.reshape(-1, 4)


def halves(quads):
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def cad_fitting():
    points, quads = cube_sphere(20)
    kw.mesh(points, halves(quads)).save("scan.vtp")
    write_off("quads.off", *cube_sphere(6))
    copy(("bracket.step", "part.step"))
    run("tessellate", "part.step", "-o", "scan.stl")
    kw.read("scan.stl").save("scan.ply")
    run("tetrahedralize", "part.step", "--edge-length", 8, "-o", "mesh.vtu")
    run("convert", "mesh.vtu", "-o", "mesh.msh")
    run("quads", "part.step", "-o", "quads.vtp")


def cad_meshing():
    copy(("piston.step", "part.step"), ("piston.step", "piston.step"), ("bracket.step", "bracket.step"), ("cylinder_on_cube.step", "assembly.step"))
    run("source", "--shape", "square", "--elements", 4, 4, 1, "-o", "square.vtu")
    run("tessellate", "square.vtu", "-o", "square.msh")
    run("convert", "square.msh", "-o", "section.vtu")
    angle = np.linspace(0, np.pi / 2, 30)
    line = vtkLineSource()
    line.SetPoints(kw.points(np.c_[5 * (1 - np.cos(angle)), 0 * angle, 5 * np.sin(angle)]).GetPoints())
    line.Update()
    kw.wrap(line.GetOutput()).save("bend.vtp")


def cad_model():
    copy(("piston.step", "piston.step"), ("bracket.step", "scan.step"))
    run("cadmodify", "piston.step", "--cut-plane", 0, 0, 20, 0, 0, 1, "-o", "part.step")


def domain_parameterization():
    corners = np.array([(0, 0), (10, 1), (11, 6), (1, 5), (0, 0)], float)
    line = np.concatenate([np.linspace(a, b, 20, endpoint=False) for a, b in zip(corners, corners[1:])])
    with open("outline.svg", "w", encoding="ascii") as stream:
        stream.write('<svg xmlns="http://www.w3.org/2000/svg"><path d="M ' + " ".join(f"{x},{y}" for x, y in line) + ' Z"/></svg>')
    with open("boundary.json", "w", encoding="ascii") as stream:
        json.dump({"curves": [{"degree": 1, "knots": [0, 0, 1, 1], "control_points": [list(a), list(b)]} for a, b in zip(corners, corners[1:])]}, stream)
    boundary, layout = kw.vtkDomainBoundaryReader(), vtkTrivialProducer()
    boundary.SetFileName("boundary.json")
    layout.SetOutput(kw.mesh(np.c_[corners[:4], np.zeros(4)], [[0, 1, 2, 3]]))
    run("convert", "boundary.json", "-o", "boundary.vtu")
    return {"boundary": boundary, "layout": layout}


def mesh_parameterization():
    unpack(("patch-30", "scan.off"), ("elephant", "elephant.off"), ("part", "shell.off"))
    kw.read("scan.off").save("scan.obj")
    run("features", "shell.off", "-o", "regions.vtp", "--lines", "mine.vtp")


def spline_analysis():
    blocks = page_snippets.fenced(PAGE, "json")
    with open("problem.json", "w", encoding="utf-8") as stream:
        stream.write(blocks[0])
    for name, elements in (("spline", 6), ("tets", 4), ("finer", 16)):
        kw.source("quarter-plate-with-hole", inner_radius=0.1, degree=2, elements=(elements, elements, 1)).save(name + ".vtu")


def spline_grid():
    unpack(("torus_quad", "part.off"))
    kw.source("square", elements=(4, 4, 1), degree=2).save("plate.vtu")
    shutil.copyfile("plate.vtu", "part.vtu")
    run("refine", "plate.vtu", "--sphere", 0, 0, 0, 0.3, "--local-space", "lr", "-o", "dependent.g2")
    with open("lines.csv", "w", encoding="ascii") as stream:
        stream.write("Direction,Value,Start,End,Multiplicity\n0,0.3,0,0.5,1\n1,0.6,0,0.75,2\n")
    plate, scan = source("Square", Center=(0.5, 0.5, 0.0)), kw.vtkSplineTessellate()
    scan.SetInputConnection(plate.GetOutputPort())
    return {"knotwork": kw, "surface": plate, "spline": plate, "scan": scan, "points": scan}


def spline_io():
    copy(("piston.step", "part.step"))
    unpack(("torus_quad", "part.off"))
    data = os.path.join(knotwork_testing.DATA_DIR, "SplineIO")
    shutil.copyfile(os.path.join(data, "nurbs.mesh"), "disc-nurbs.mesh")
    shutil.copyfile(os.path.join(data, "curved.mesh"), "part.mesh")
    kw.source("annulus-sector", elements=(3, 3, 1)).save("plate.xml").save("plate.g2")
    kw.source("solid-tube").save("tube.vtu")
    run("unstructured", "part.off", "-o", "part.vtu")
    run("source", "--shape", "square", "--elements", 2, 2, 1, "-o", "square.vtu")
    run("tessellate", "square.vtu", "-o", "part.msh")
    run("convert", "part.off", "-o", "klein-bottle.mesh")
    with open("part.inp", "w", encoding="ascii") as stream:
        stream.write("*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n*Element, type=CPS4, elset=all\n1, 1, 2, 3, 4\n")
    points = terrain()
    np.savetxt("scan.xyz", points)
    np.savetxt("scan.csv", points, delimiter=",", header="x,y,z", comments="")
    run("convert", "scan.xyz", "-o", "scan.vtp")
    kw.read("part.off").save("scan.ply")
    kw.fit(kw.points(points, Temperature=points[:, 0]), tolerance=0.01, all_fields=True).save("terrain.vtu")


def surface_remeshing():
    unpack(("cow", "cow.off"), ("fandisk", "fandisk.off"))
    points, quads = cube_sphere(12)
    write_off("open.off", points, halves(quads)[:-1])
    kw.read("open.off").save("scan.stl")
    part, lengths = kw.mesh(points, halves(quads)), kw.points(points, Length=0.1 + 0.05 * points[:, 2])
    part.GetPointData().AddArray(lengths.GetPointData().GetArray("Length"))
    part.save("part.vtp")


def surface_trimming():
    copy(("piston.step", "part.step"))
    unpack(("patch-30", "scan.off"), ("part", "shell.off"))
    kw.read("scan.off").save("scan.obj")
    np.savetxt("scan.xyz", terrain())
    kw.fit(terrain(), tolerance=0.01).save("surface.vtu")


def template_mapping():
    angle = np.linspace(0, 2 * np.pi, 80)
    for name, radius in (("template", 0.3 + 0 * angle), ("target", 0.3 + 0.04 * np.cos(3 * angle))):
        skeleton = kw.polyline(np.c_[0.5 + radius * np.cos(angle), 0.5 + radius * np.sin(angle)]).tessellate()
        skeleton.save(name + ".vtp")


def tet_meshing():
    unpack(("cow", "cow.off"))
    copy(("piston.step", "part.step"))
    kw.source("solid-cylinder").save("solid.vtu").save("rod.vtu").save("rod.step")
    run("tetrahedralize", "rod.step", "-o", "tets.vtu")
    run("tessellate", "part.step", "-o", "part.stl")
    run("tessellate", "part.step", "-o", "part.vtp")
    function = vtkSampleFunction()
    ball = vtkSphere()
    ball.SetRadius(0.8)
    function.SetImplicitFunction(ball)
    function.SetSampleDimensions(21, 21, 21)
    function.ComputeNormalsOff()
    writer = vtkXMLImageDataWriter()
    writer.SetInputConnection(function.GetOutputPort())
    writer.SetFileName("image.vti")
    writer.Write()


PREPARE = {"CADFitting": cad_fitting, "CADMeshing": cad_meshing, "CADModel": cad_model, "DomainParameterization": domain_parameterization,
           "MeshParameterization": mesh_parameterization, "SplineAnalysis": spline_analysis, "SplineGrid": spline_grid, "SplineIO": spline_io,
           "SurfaceRemeshing": surface_remeshing, "SurfaceTrimming": surface_trimming, "TemplateMapping": template_mapping, "TetMeshing": tet_meshing}
# What the C++ of a page takes as given: includes, then declarations.
CXX = {
    "CADModel": ("", ""),
    "JacobianValidation": ("#include <knotwork/SplineCore/Shapes.h>\n", "const knotwork::Spline<2> map; const std::vector<int> patchOfEachCell;"
                           "const std::vector<knotwork::ParametricBox<3>> boxOfEachCell; const knotwork::JacobianCertificate certificate;"),
    "SplineAnalysis": ("#include <knotwork/SplineAnalysis/AdaptiveSolution.h>\n", "const knotwork::Spline<2> spline;"),
    "SplineCore": ("".join(f"#include <knotwork/SplineCore/{name}.h>\n" for name in (
        "CompositeProjection", "CoonsMap", "MeshSpline", "MeshTraces", "MultiPatch", "UnstructuredSpace")),
        "const knotwork::Spline<3> volume, patch; const std::vector<knotwork::Spline<2>> patches; const knotwork::PointMatrix points;"
        "const knotwork::ElementFunction function;"),
    "SplineGrid": ("#include <knotwork/SplineGrid/vtkSplineDefinition.h>\n#include <vtkDoubleArray.h>\n#include <vtkNew.h>\n"
                   "#include <vtkUnstructuredGrid.h>\n#include <iostream>\n",
                   "vtkNew<vtkDoubleArray> degrees, knotsU, knotsV, controlPoints, weights;"),
}


def compile_cxx(parts):
    """The compiler looks at syntax and types; nothing is linked or run."""
    module = os.path.basename(os.path.dirname(PAGE))
    includes, given = CXX[module]
    lines = [line for part in parts for line in part.split("\n")]
    bodies = ["\n".join(line for line in part.split("\n") if not line.startswith("#include")) for part in parts]
    text = includes + "\n".join(line for line in lines if line.startswith("#include")) + "\nvoid Page()\n{\n" + given + "\n"
    text += "\n{\n".join(bodies) + "\n" + "}" * len(bodies) + "\n"
    with open("page.cxx", "w", encoding="utf-8") as stream:
        stream.write(text)
    done = subprocess.run([COMPILER, "-std=c++17", "-fsyntax-only", *(f"-I{each}" for each in INCLUDES.split(";") if each), "page.cxx"], stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise AssertionError(done.stderr[-4000:])


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    os.chdir(FOLDER)
    prepare = PREPARE.get(os.path.basename(os.path.dirname(PAGE)))
    names = prepare() if prepare else None
    _, count = page_snippets.run_page(PAGE, FOLDER, names, compile_cxx, commands=False)
    print(f"{count} blocks ran")
    return 0 if count else 1


PAGE, FOLDER, COMPILER, INCLUDES = sys.argv[1:]
PAGE, FOLDER = os.path.abspath(PAGE), os.path.abspath(FOLDER)
if __name__ == "__main__":
    sys.exit(main())
