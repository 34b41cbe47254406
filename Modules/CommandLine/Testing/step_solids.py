# SPDX-License-Identifier: BSD-3-Clause
"""STEP files of upright prisms and cylinders in millimetres, written here: names and colours of faces, every solid a body of one product."""
import numpy as np

CONTEXT = """#1=APPLICATION_CONTEXT('core data for automotive mechanical design processes');
#2=APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#1);
#3=PRODUCT_CONTEXT('',#1,'mechanical');
#4=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');
#5=PRODUCT('%(name)s','%(name)s','',(#3));
#6=PRODUCT_DEFINITION_FORMATION('','',#5);
#7=PRODUCT_DEFINITION('design','',#6,#4);
#8=PRODUCT_DEFINITION_SHAPE('','',#7);
#9=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#10=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#11=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#12=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#9,'distance_accuracy_value','');
#13=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#12))GLOBAL_UNIT_ASSIGNED_CONTEXT((#9,#10,#11))REPRESENTATION_CONTEXT('',''));
"""


class Solids:
    """Collects statements."""

    def __init__(self):
        self.lines = []
        self.bodies = []
        self.styles = []

    def add(self, text):
        self.lines.append(text)
        return "#%d" % (len(self.lines) + 100)

    def place(self, kind, point, axis, across):
        numbers = [",".join("%.17E" % x for x in v) for v in (point, axis, across)]
        frame = self.add("AXIS2_PLACEMENT_3D('',%s,%s,%s)" % (self.add("CARTESIAN_POINT('',(%s))" % numbers[0]),
                         self.add("DIRECTION('',(%s))" % numbers[1]), self.add("DIRECTION('',(%s))" % numbers[2])))
        return self.add(kind % frame)

    def vertex(self, point):
        return self.add("VERTEX_POINT('',%s)" % self.add("CARTESIAN_POINT('',(%s))" % ",".join("%.17E" % x for x in point)))

    def line(self, a, b, ends):
        way = np.subtract(b, a)
        length = np.linalg.norm(way)
        vector = self.add("VECTOR('',%s,1.)" % self.add("DIRECTION('',(%s))" % ",".join("%.17E" % x for x in way / length)))
        begin = self.add("CARTESIAN_POINT('',(%s))" % ",".join("%.17E" % x for x in a))
        return self.add("EDGE_CURVE('',%s,%s,%s,.T.)" % (*ends, self.add("LINE('',%s,%s)" % (begin, vector))))

    def face(self, name, surface, loops, colour=None):
        """Loops of pairs of an edge and T or F."""
        bounds = []
        for loop in loops:
            uses = ",".join(self.add("ORIENTED_EDGE('',*,*,%s,.%s.)" % use) for use in loop)
            bounds.append(self.add("FACE_BOUND('',%s,.T.)" % self.add("EDGE_LOOP('',(%s))" % uses)))
        face = self.add("ADVANCED_FACE('%s',(%s),%s,.T.)" % (name, ",".join(bounds), surface))
        if colour:
            rgb = self.add("COLOUR_RGB('',%.17E,%.17E,%.17E)" % colour)
            fill = self.add("FILL_AREA_STYLE('',(%s))" % self.add("FILL_AREA_STYLE_COLOUR('',%s)" % rgb))
            side = self.add("SURFACE_SIDE_STYLE('',(%s))" % self.add("SURFACE_STYLE_FILL_AREA(%s)" % fill))
            style = self.add("PRESENTATION_STYLE_ASSIGNMENT((%s))" % self.add("SURFACE_STYLE_USAGE(.BOTH.,%s)" % side))
            self.styles.append(self.add("STYLED_ITEM('',(%s),%s)" % (style, face)))
        return face

    def close(self, name, faces):
        self.bodies.append(self.add("MANIFOLD_SOLID_BREP('%s',%s)" % (name, self.add("CLOSED_SHELL('',(%s))" % ",".join(faces)))))

    def prism(self, polygon, height, base=0.0, name="", names=None, colours=None):
        """A polygon that is passed anticlockwise, carried upwards. Faces: one a side, the bottom, the top."""
        n = len(polygon)
        points = [[(*p, z) for p in polygon] for z in (base, base + height)]
        vertices = [[self.vertex(p) for p in row] for row in points]
        rims = [[self.line(row[i], row[(i + 1) % n], (ids[i], ids[(i + 1) % n])) for i in range(n)] for row, ids in zip(points, vertices)]
        posts = [self.line(points[0][i], points[1][i], (vertices[0][i], vertices[1][i])) for i in range(n)]
        names, colours = names or ("",) * (n + 2), colours or (None,) * (n + 2)
        faces = []
        for i in range(n):
            j = (i + 1) % n
            along = np.subtract(points[0][j], points[0][i])
            plane = self.place("PLANE('',%s)", points[0][i], np.cross(along, (0, 0, 1)) / np.linalg.norm(along), along / np.linalg.norm(along))
            faces.append(self.face(names[i], plane, [[(rims[0][i], "T"), (posts[j], "T"), (rims[1][i], "F"), (posts[i], "F")]], colours[i]))
        bottom, top = (self.place("PLANE('',%s)", row[0], (0, 0, up), (1, 0, 0)) for row, up in zip(points, (-1, 1)))
        faces.append(self.face(names[n], bottom, [[(edge, "F") for edge in reversed(rims[0])]], colours[n]))
        faces.append(self.face(names[n + 1], top, [[(edge, "T") for edge in rims[1]]], colours[n + 1]))
        self.close(name, faces)

    def box(self, lower, size, name="", names=None, colours=None):
        """Faces in the order y lower, x upper, y upper, x lower, z lower, z upper."""
        (x, y, z), (a, b, c) = lower, size
        self.prism([(x, y), (x + a, y), (x + a, y + b), (x, y + b)], c, z, name, names, colours)

    def cylinder(self, base, radius, height, name=""):
        """Faces in the order side, bottom, top."""
        ends = [np.array(base, float), np.add(base, (0, 0, height))]
        seam = [end + (radius, 0, 0) for end in ends]
        vertices = [self.vertex(point) for point in seam]
        circles = []
        for end, vertex in zip(ends, vertices):
            curve = self.place("CIRCLE('',%%s,%.17E)" % radius, end, (0, 0, 1), (1, 0, 0))
            circles.append(self.add("EDGE_CURVE('',%s,%s,%s,.T.)" % (vertex, vertex, curve)))
        line = self.line(*seam, vertices)
        side = self.place("CYLINDRICAL_SURFACE('',%%s,%.17E)" % radius, ends[0], (0, 0, 1), (1, 0, 0))
        faces = [self.face("", side, [[(circles[0], "T"), (line, "T"), (circles[1], "F"), (line, "F")]]),
                 self.face("", self.place("PLANE('',%s)", ends[0], (0, 0, -1), (1, 0, 0)), [[(circles[0], "F")]]),
                 self.face("", self.place("PLANE('',%s)", ends[1], (0, 0, 1), (1, 0, 0)), [[(circles[1], "T")]])]
        self.close(name, faces)

    def write(self, file, name="Part"):
        lines = ["#%d=%s;" % (i + 101, text) for i, text in enumerate(self.lines)]
        last = len(lines) + 101
        lines.append("#%d=ADVANCED_BREP_SHAPE_REPRESENTATION('',(%s),#13);" % (last, ",".join(self.bodies)))
        lines.append("#%d=SHAPE_DEFINITION_REPRESENTATION(#8,#%d);" % (last + 1, last))
        if self.styles:
            lines.append("#%d=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(%s),#13);" % (last + 2, ",".join(self.styles)))
        with open(file, "w") as stream:
            stream.write("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('solids'),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n")
            stream.write(CONTEXT % {"name": name} + "\n".join(lines) + "\nENDSEC;\nEND-ISO-10303-21;\n")
        return file
