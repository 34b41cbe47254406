// SPDX-License-Identifier: BSD-3-Clause
// MFEM's meshes. The oracle of curved ones is a polynomial map: the test numbers the nodes itself,
// by the format's description and by positions alone, puts the map's values there, and every cell
// that is read must be the map, whatever its orientation.
#include "FileCases.h"
#include <knotwork/SplineIO/MfemMesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace knotwork;
using oracle::Random;

namespace
{
using Place = Eigen::Vector3d;

struct Shape
{
  int Dimension;
  std::vector<Place> Corners;
  std::vector<std::array<int, 2>> Edges;
  std::vector<std::vector<int>> Faces;
};

/// The reference cells of the format.
const Shape& ShapeOf(int type)
{
  const Place o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  static const std::map<int, Shape> shapes = {
    { 1, { 1, { o, x }, {}, {} } },
    { 2, { 2, { o, x, y }, { { 0, 1 }, { 1, 2 }, { 2, 0 } }, {} } },
    { 3, { 2, { o, x, x + y, y }, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } }, {} } },
    { 4,
      { 3, { o, x, y, z }, { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } },
        { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } } } },
    { 5,
      { 3, { o, x, x + y, y, z, x + z, x + y + z, y + z },
        { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 4, 5 }, { 5, 6 }, { 7, 6 }, { 4, 7 }, { 0, 4 },
          { 1, 5 }, { 2, 6 }, { 3, 7 } },
        { { 3, 2, 1, 0 }, { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 },
          { 4, 5, 6, 7 } } } },
    { 6,
      { 3, { o, x, y, z, x + z, y + z },
        { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 },
          { 2, 5 } },
        { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } } } },
  };
  return shapes.at(type);
}

bool IsTensor(int type)
{
  return type == 1 || type == 3 || type == 5;
}

/// Nodes on [0, 1] in closed form.
std::vector<double> NodesOf(const std::string& family, int p)
{
  if (family == "Lobatto")
  {
    const double a = 0.5 - 0.5 / std::sqrt(5.0);
    const double b = 0.5 - std::sqrt(21.0) / 14.0;
    return std::vector<std::vector<double>>{ { 0, 1 }, { 0, 0.5, 1 }, { 0, a, 1 - a, 1 },
      { 0, b, 0.5, 1 - b, 1 } }[static_cast<std::size_t>(p - 1)];
  }
  if (family == "Legendre")
  {
    const double a = 0.5 - 0.5 / std::sqrt(3.0);
    const double b = 0.5 - std::sqrt(15.0) / 10.0;
    return p == 1 ? std::vector<double>{ a, 1 - a } : std::vector<double>{ b, 0.5, 1 - b };
  }
  std::vector<double> nodes;
  for (int i = 0; i <= p; ++i)
  {
    nodes.push_back(family == "Closed" ? double(i) / p
        : family == "Open"             ? (i + 1.0) / (p + 2)
                                       : (i + 0.5) / (p + 1));
  }
  return nodes;
}

struct TestCell
{
  int Type;
  std::vector<int> Corners;
};

struct TestMesh
{
  int Dimension = 0;
  std::vector<Place> Vertices;
  std::vector<TestCell> Cells;
};

/// Another numbering of the same cell: corners change places by a symmetry of the shape.
void Turn(TestCell& cell, Random& random)
{
  const Shape& shape = ShapeOf(cell.Type);
  std::vector<int> order(cell.Corners.size());
  if (!IsTensor(cell.Type) && cell.Type != 6)
  {
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(random.Int(0, 1 << 20)));
  }
  else
  {
    std::array<int, 3> axes{ 0, 1, 2 };
    std::array<int, 3> three{ 0, 1, 2 }; // corners of a wedge's triangle
    std::mt19937 engine(random.Int(0, 1 << 20));
    std::shuffle(axes.begin(), axes.begin() + shape.Dimension, engine);
    std::shuffle(three.begin(), three.end(), engine);
    const Place flip(random.Int(0, 1), random.Int(0, 1), random.Int(0, 1));
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      if (cell.Type == 6)
      {
        order[k] = three[k % 3] + 3 * (static_cast<int>(k / 3) ^ static_cast<int>(flip[2]));
        continue;
      }
      Place at = Place::Zero();
      for (int d = 0; d < shape.Dimension; ++d)
      {
        at[axes[d]] = std::abs(shape.Corners[k][d] - flip[d]);
      }
      order[k] = static_cast<int>(std::find_if(shape.Corners.begin(), shape.Corners.end(),
                                    [&](const Place& corner) { return corner == at; }) -
        shape.Corners.begin());
    }
  }
  std::vector<int> turned;
  for (const int corner : order)
  {
    turned.push_back(cell.Corners[static_cast<std::size_t>(corner)]);
  }
  cell.Corners = turned;
}

/// Boxes side by side, some of them cut, all turned and numbered at random.
TestMesh RandomMesh(int dimension, bool isCut, unsigned seed)
{
  Random random(seed);
  TestMesh mesh;
  mesh.Dimension = dimension;
  const int n[3] = { 3, dimension > 1 ? 2 : 0, dimension > 2 ? 2 : 0 };
  std::map<std::array<int, 3>, int> number;
  for (int k = 0; k <= n[2]; ++k)
  {
    for (int j = 0; j <= n[1]; ++j)
    {
      for (int i = 0; i <= n[0]; ++i)
      {
        number[{ i, j, k }] = static_cast<int>(mesh.Vertices.size());
        mesh.Vertices.emplace_back(i, j, k);
      }
    }
  }
  const auto add = [&](int type, const std::vector<std::array<int, 3>>& corners)
  {
    TestCell cell{ type, {} };
    for (const auto& corner : corners)
    {
      cell.Corners.push_back(number.at(corner));
    }
    Turn(cell, random);
    mesh.Cells.push_back(cell);
  };
  for (int k = 0; k < std::max(n[2], 1); ++k)
  {
    for (int j = 0; j < std::max(n[1], 1); ++j)
    {
      for (int i = 0; i < n[0]; ++i)
      {
        const auto at = [&](int a, int b, int c) {
          return std::array<int, 3>{ i + a, j + b, k + c };
        };
        if (dimension == 1)
        {
          add(1, { at(0, 0, 0), at(1, 0, 0) });
        }
        else if (dimension == 2 && isCut && i > 0)
        {
          add(2, { at(0, 0, 0), at(1, 0, 0), at(0, 1, 0) });
          add(2, { at(1, 0, 0), at(1, 1, 0), at(0, 1, 0) });
        }
        else if (dimension == 2)
        {
          add(3, { at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0) });
        }
        else if (isCut && seed % 2 == 0)
        {
          // Kuhn's six tetrahedra along the diagonal
          const int axes[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 },
            { 2, 1, 0 } };
          for (const auto& axis : axes)
          {
            std::vector<std::array<int, 3>> corners{ at(0, 0, 0) };
            for (const int d : axis)
            {
              corners.push_back(corners.back());
              ++corners.back()[static_cast<std::size_t>(d)];
            }
            add(4, corners);
          }
        }
        else if (isCut && i > 0)
        {
          add(6, { at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1) });
          add(6, { at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1) });
        }
        else
        {
          add(5,
            { at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1),
              at(1, 1, 1), at(0, 1, 1) });
        }
      }
    }
  }
  std::vector<int> shuffled(mesh.Vertices.size());
  std::iota(shuffled.begin(), shuffled.end(), 0);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(seed));
  std::vector<Place> vertices(mesh.Vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    vertices[static_cast<std::size_t>(shuffled[v])] = mesh.Vertices[v];
  }
  mesh.Vertices = vertices;
  for (TestCell& cell : mesh.Cells)
  {
    for (int& corner : cell.Corners)
    {
      corner = shuffled[static_cast<std::size_t>(corner)];
    }
  }
  return mesh;
}

/// A place in a cell, which is affine.
Place Inside(const TestMesh& mesh, const TestCell& cell, const Place& local)
{
  const Place& origin = mesh.Vertices[static_cast<std::size_t>(cell.Corners[0])];
  const Shape& shape = ShapeOf(cell.Type);
  Place at = origin;
  for (std::size_t k = 1; k < cell.Corners.size(); ++k)
  {
    for (int d = 0; d < 3; ++d)
    {
      if (shape.Corners[k] == Place::Unit(d))
      {
        at += local[d] * (mesh.Vertices[static_cast<std::size_t>(cell.Corners[k])] - origin);
      }
    }
  }
  return at;
}

/// Local places of all nodes of a cell, first direction fastest; @param inner  those inside alone.
std::vector<Place> LocalNodes(int type, const std::vector<double>& x, bool inner)
{
  const int p = static_cast<int>(x.size()) - 1;
  const int dimension = ShapeOf(type).Dimension;
  const auto at = [&x](int i) { return x[static_cast<std::size_t>(i)]; };
  const int low = inner ? 1 : 0;
  std::vector<Place> places;
  for (int k = dimension > 2 ? low : 0; k <= (dimension > 2 ? p - low : 0); ++k)
  {
    for (int j = dimension > 1 ? low : 0; j <= (dimension > 1 ? p - low : 0); ++j)
    {
      for (int i = low; i <= p - low; ++i)
      {
        if (IsTensor(type))
        {
          places.emplace_back(at(i), dimension > 1 ? at(j) : 0, dimension > 2 ? at(k) : 0);
          continue;
        }
        const int rest = p - i - j - (type == 4 ? k : 0);
        if (rest >= low)
        {
          const double sum = at(i) + at(j) + at(rest) + (type == 4 ? at(k) : 0.0);
          places.emplace_back(at(i) / sum, at(j) / sum,
            type == 4     ? at(k) / sum
              : type == 6 ? at(k)
                          : 0.0);
        }
      }
    }
  }
  return places;
}

/// Places of the nodes of continuous elements in the order of the format.
std::vector<Place> SharedNodes(const TestMesh& mesh, const std::vector<double>& x)
{
  const int p = static_cast<int>(x.size()) - 1;
  std::vector<Place> nodes = mesh.Vertices;
  const auto vertex = [&](int v) { return mesh.Vertices[static_cast<std::size_t>(v)]; };
  std::set<std::set<int>> known;
  for (const TestCell& cell : mesh.Cells)
  {
    for (const auto& edge : ShapeOf(cell.Type).Edges)
    {
      const int a = cell.Corners[static_cast<std::size_t>(edge[0])];
      const int b = cell.Corners[static_cast<std::size_t>(edge[1])];
      for (int i = 1; i < p && known.count({ a, b }) == 0; ++i)
      {
        const double t = x[static_cast<std::size_t>(i)];
        nodes.emplace_back((1 - t) * vertex(std::min(a, b)) + t * vertex(std::max(a, b)));
      }
      known.insert({ a, b });
    }
  }
  for (const TestCell& cell : mesh.Cells)
  {
    for (const auto& face : ShapeOf(cell.Type).Faces)
    {
      std::vector<int> corners;
      for (const int corner : face)
      {
        corners.push_back(cell.Corners[static_cast<std::size_t>(corner)]);
      }
      if (known.insert(std::set<int>(corners.begin(), corners.end())).second)
      {
        const TestCell as{ corners.size() == 3 ? 2 : 3, corners };
        for (const Place& local : LocalNodes(as.Type, x, true))
        {
          nodes.push_back(Inside(mesh, as, local));
        }
      }
    }
  }
  for (const TestCell& cell : mesh.Cells)
  {
    for (const Place& local : LocalNodes(cell.Type, x, true))
    {
      nodes.push_back(Inside(mesh, cell, local));
    }
  }
  return nodes;
}

std::string Number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string TextOfCells(const TestMesh& mesh)
{
  std::string text = "MFEM mesh v1.0\n\n# made by a test\n\ndimension\n" +
    std::to_string(mesh.Dimension) + "\n\nelements\n" + std::to_string(mesh.Cells.size()) + "\n";
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    text += std::to_string(c + 7) + " " + std::to_string(mesh.Cells[c].Type);
    for (const int corner : mesh.Cells[c].Corners)
    {
      text += " " + std::to_string(corner);
    }
    text += "\n";
  }
  return text + "\nboundary\n0\n\nvertices\n" + std::to_string(mesh.Vertices.size()) + "\n";
}

std::string TextOfNodes(
  const std::string& name, const std::vector<Place>& values, int components, bool byNodes)
{
  std::string text = "\nnodes\nFiniteElementSpace\nFiniteElementCollection: " + name +
    "\nVDim: " + std::to_string(components) + "\nOrdering: " + (byNodes ? "0" : "1") + "\n\n";
  const auto count = values.size();
  for (std::size_t i = 0; i < count * static_cast<std::size_t>(components); ++i)
  {
    const auto wide = static_cast<std::size_t>(components);
    text += byNodes ? Number(values[i % count][static_cast<int>(i / count)])
                    : Number(values[i / wide][static_cast<int>(i % wide)]);
    text += "\n";
  }
  return text;
}

/// A polynomial of total degree p in every coordinate.
Place Map(const Place& at, int p, int components)
{
  Place value(at[0] + 0.3 * std::pow(at[1] - 0.2 * at[2], p), at[1] - 0.2 * std::pow(at[0], p),
    at[2] + 0.1 * std::pow(at[0] + at[1], p));
  value.tail(3 - components).setZero();
  return value;
}

/// Bernstein's sum over the coefficients of one cell.
Place Evaluate(const MfemMesh& mesh, std::size_t cell, const Place& local)
{
  const int type = static_cast<int>(mesh.Cells[cell].Shape);
  const int p = mesh.Degree;
  const auto term = [](double x, int e) { return std::pow(x, e) / std::tgamma(e + 1.0); };
  const double factorial = std::tgamma(p + 1.0);
  Place sum = Place::Zero();
  auto next = static_cast<std::size_t>(mesh.CellBegin[cell]);
  const int dimension = ShapeOf(type).Dimension;
  const bool isTensor = IsTensor(type);
  for (int k = 0; k <= (dimension > 2 ? p : 0); ++k)
  {
    for (int j = 0; j <= (dimension > 1 ? p : 0); ++j)
    {
      for (int i = 0; i <= p; ++i)
      {
        double value = 1.0;
        const std::array<int, 3> e{ i, j, k };
        if (isTensor)
        {
          for (int d = 0; d < dimension; ++d)
          {
            const int n = e[static_cast<std::size_t>(d)];
            value *= factorial * term(local[d], n) * term(1 - local[d], p - n);
          }
        }
        else
        {
          const int solid = type == 4 ? k : 0;
          const int rest = p - i - j - solid;
          if (rest < 0)
          {
            continue;
          }
          const double other = 1 - local[0] - local[1] - (type == 4 ? local[2] : 0.0);
          value = factorial * term(local[0], i) * term(local[1], j) * term(other, rest) *
            (type == 4 ? term(local[2], k) : 1.0);
          value *= type == 6 ? factorial * term(local[2], k) * term(1 - local[2], p - k) : 1.0;
        }
        sum += value * mesh.Points.row(mesh.CellPoints[next++]).transpose();
      }
    }
  }
  EXPECT_EQ(next, static_cast<std::size_t>(mesh.CellBegin[cell + 1]));
  return sum;
}

/// Every cell is the map. Largest values are 3^4, conditions of the bases up to 1e2.
void ExpectMap(const TestMesh& mesh, const MfemMesh& read, int p, int components)
{
  ASSERT_EQ(read.Cells.size(), mesh.Cells.size());
  ASSERT_EQ(read.Degree, p);
  Random random(1);
  double worst = 0.0;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    EXPECT_EQ(read.Cells[c].Attribute, static_cast<int>(c) + 7);
    for (int sample = 0; sample < 5; ++sample)
    {
      Place local(random.Unit(), random.Unit(), random.Unit());
      local *= IsTensor(mesh.Cells[c].Type) ? 1.0 : 1.0 / 3.0;
      local.tail(3 - mesh.Dimension).setZero();
      const Place expected = Map(Inside(mesh, mesh.Cells[c], local), p, components);
      worst = std::max(worst, (Evaluate(read, c, local) - expected).cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LT(worst, 2e-12);
}

/// Values of the map at the nodes.
std::vector<Place> Mapped(std::vector<Place> places, int p, int components)
{
  for (Place& place : places)
  {
    place = Map(place, p, components);
  }
  return places;
}

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}
}

TEST(MfemMesh, ContinuousNodes_PolynomialOracle)
{
  for (unsigned seed = 0; seed < 24; ++seed)
  {
    for (int p = 1; p <= 4; ++p)
    {
      const int dimension = 1 + static_cast<int>(seed) % 3;
      const TestMesh mesh = RandomMesh(dimension, seed % 4 > 1, seed);
      const std::vector<double> x = NodesOf("Lobatto", p);
      const std::vector<Place> places = SharedNodes(mesh, x);
      const int components = std::max(dimension, 1 + static_cast<int>(seed / 3) % 3);
      const auto read = ReadMfemMesh(TextOfCells(mesh) +
        TextOfNodes("H1_" + std::to_string(dimension) + "D_P" + std::to_string(p),
          Mapped(places, p, components), components, seed % 5 > 2));
      SCOPED_TRACE("seed " + std::to_string(seed) + ", degree " + std::to_string(p));
      ASSERT_TRUE(read) << read.Status.Message();
      // no point stands twice, none is missing
      EXPECT_EQ(read->Points.rows(), static_cast<Eigen::Index>(places.size()));
      ExpectMap(mesh, read.Value, p, components);
    }
  }
}

TEST(MfemMesh, CollectionsByName_PolynomialOracle)
{
  for (unsigned seed = 2; seed < 14; ++seed)
  {
    const int dimension = 1 + static_cast<int>(seed) % 3;
    const TestMesh mesh = RandomMesh(dimension, seed % 4 > 1, seed);
    const std::string middle = std::to_string(dimension) + "D_P";
    struct Case
    {
      std::string Name;
      std::string Family;
      int Degree;
    };
    for (const Case& one : { Case{ "Linear", "Closed", 1 }, Case{ "Quadratic", "Closed", 2 },
           Case{ "Cubic", "Closed", 3 }, Case{ "H1@G_" + middle + "3", "Lobatto", 3 },
           Case{ "H1@U_" + middle + "4", "Closed", 4 } })
    {
      const auto read = ReadMfemMesh(TextOfCells(mesh) +
        TextOfNodes(one.Name,
          Mapped(SharedNodes(mesh, NodesOf(one.Family, one.Degree)), one.Degree, 3), 3, false));
      SCOPED_TRACE(one.Name + ", seed " + std::to_string(seed));
      ASSERT_TRUE(read) << read.Status.Message();
      ExpectMap(mesh, read.Value, one.Degree, 3);
    }
    for (const Case& one :
      { Case{ "L2_T1_" + middle + "1", "Lobatto", 1 },
        Case{ "L2_T1_" + middle + "3", "Lobatto", 3 }, Case{ "L2_" + middle + "2", "Legendre", 2 },
        Case{ "L2_T0_" + middle + "1", "Legendre", 1 }, Case{ "L2_T3_" + middle + "3", "Open", 3 },
        Case{ "L2_T4_" + middle + "4", "Closed", 4 }, Case{ "L2_T5_" + middle + "2", "Half", 2 } })
    {
      std::vector<Place> places;
      for (const TestCell& cell : mesh.Cells)
      {
        for (const Place& local : LocalNodes(cell.Type, NodesOf(one.Family, one.Degree), false))
        {
          places.push_back(Inside(mesh, cell, local));
        }
      }
      const auto read = ReadMfemMesh(
        TextOfCells(mesh) + TextOfNodes(one.Name, Mapped(places, one.Degree, 3), 3, seed % 2 == 0));
      SCOPED_TRACE(one.Name + ", seed " + std::to_string(seed));
      ASSERT_TRUE(read) << read.Status.Message();
      ExpectMap(mesh, read.Value, one.Degree, 3);
      // neighbours have the same points again
      EXPECT_EQ(read->Points.rows(),
        static_cast<Eigen::Index>(SharedNodes(mesh, NodesOf("Closed", one.Degree)).size()));
    }
  }
}

TEST(MfemMesh, BernsteinCoefficients_ExactOracle)
{
  const std::string text = "MFEM mesh v1.2\ndimension 1 elements 1 4 1 0 1 boundary 2 1 0 0 1 0 1 "
                           "vertices 2 nodes FiniteElementSpace FiniteElementCollection: ";
  for (const char* name : { "H1Pos_1D_P2", "H1@P_1D_P2" })
  {
    const auto read = ReadMfemMesh(text + name + " VDim: 2 Ordering: 1 0 0 2 0 1 5 mfem_mesh_end");
    ASSERT_TRUE(read) << read.Status.Message();
    ASSERT_EQ(read->CellPoints.size(), 3U);
    EXPECT_EQ(read->Points.row(read->CellPoints[1]), Eigen::RowVector3d(1, 5, 0));
    EXPECT_EQ(read->Points.row(read->CellPoints[2]), Eigen::RowVector3d(2, 0, 0));
  }
}

TEST(MfemMesh, LinearCells_ExactOracle)
{
  const auto read = ReadMfemMesh(
    "MFEM mesh v1.3\n# a mesh\ndimension\n3\n\nelements\n2\n3 7 0 1 2 3 4\n-2 6 1 5 2 4 6 7\n"
    "attribute_sets\n2\n\"a b\" 2 3 -2\n\"c\" 0\nboundary\n1\n1 2 0 1 4\nbdr_attribute_sets\n1\n"
    "\"d\" 1 1\nvertices\n8\n3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n2 0 0\n1 0 1\n2.5 0 1\n"
    "mfem_mesh_end\n");
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(read->Degree, 0);
  EXPECT_EQ(read->Dimension, 3);
  EXPECT_EQ(read->Points.row(7), Eigen::RowVector3d(2.5, 0, 1));
  EXPECT_EQ(read->Cells[0].Shape, MfemShape::Pyramid);
  EXPECT_EQ(read->Cells[1].Attribute, -2);
  EXPECT_EQ(read->Cells[1].Corners, (std::array<int, 8>{ 1, 5, 2, 4, 6, 7, -1, -1 }));
  EXPECT_TRUE(read->Warnings.empty());
}

/// A ring of three quadrilaterals in the plane, unrolled: what its seam identifies is at two
/// places.
TEST(MfemMesh, PeriodicNodes_ExactOracle)
{
  std::string text = "MFEM mesh v1.0\ndimension\n2\nelements\n3\n1 3 0 1 4 3\n1 3 1 2 5 4\n"
                     "1 3 2 0 3 5\nboundary\n0\nvertices\n6\nnodes\nFiniteElementSpace\n"
                     "FiniteElementCollection: L2_T1_2D_P1\nVDim: 2\nOrdering: 1\n";
  for (int cell = 0; cell < 3; ++cell)
  {
    for (const char* corner : { "0 0", "1 0", "0 1", "1 1" })
    {
      text += std::to_string(cell + corner[0] - '0') + " " + corner[2] + "\n";
    }
  }
  const auto read = ReadMfemMesh(text);
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(read->Points.rows(), 8);
  EXPECT_EQ(read->Points.col(0).maxCoeff(), 3.0);
  EXPECT_EQ(read->CellPoints[1], read->CellPoints[4]);
  EXPECT_NE(read->CellPoints[0], read->CellPoints[9]);
}

/// Patches of a box, turned at random; control points at Greville's abscissae make each of them an
/// affine map, which unequal knots betray when they run the wrong way.
TEST(MfemMesh, NurbsPatches_LinearPrecisionOracle)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    Random random(seed);
    const int dimension = 2 + static_cast<int>(seed) % 2;
    TestMesh mesh = RandomMesh(dimension, false, seed);
    // of every axis, the same in all patches
    std::vector<std::vector<double>> knots;
    std::vector<int> degrees;
    for (int d = 0; d < dimension; ++d)
    {
      const int p = 2; // of the collection
      std::vector<double> t(3, 0.0);
      for (int e = 0; e <= d; ++e)
      {
        t.push_back(t.back() + random.In(0.1, 0.3));
      }
      t.insert(t.end(), 3, 1.0);
      knots.push_back(t);
      degrees.push_back(p);
    }
    const auto greville = [&](int d, int i, bool forward)
    {
      const std::vector<double>& t = knots[static_cast<std::size_t>(d)];
      const int n = static_cast<int>(t.size()) - 3;
      const auto k = static_cast<std::size_t>(forward ? i : n - 1 - i);
      return (t[k + 1] + t[k + 2]) / 2;
    };
    const auto count = [&](int d) { return static_cast<int>(knots[d].size()) - 3; };
    const auto vertex = [&](int v) { return mesh.Vertices[static_cast<std::size_t>(v)]; };
    const auto axis = [](const Place& step)
    {
      int d = 0;
      step.cwiseAbs().maxCoeff(&d);
      return d;
    };
    std::vector<Place> nodes = mesh.Vertices;
    // along a step from a place: n places inside
    const auto line = [&](const Place& from, const Place& to)
    {
      const int d = axis(to - from);
      std::vector<Place> inside;
      for (int i = 1; i + 1 < count(d); ++i)
      {
        const double low = std::min(from[d], to[d]);
        Place at = from;
        at[d] = low + greville(d, i, to[d] > from[d]);
        inside.push_back(at - from);
      }
      return inside;
    };
    std::string edges;
    int numEdges = 0;
    std::set<std::set<int>> known;
    for (const TestCell& cell : mesh.Cells)
    {
      for (const auto& edge : ShapeOf(cell.Type).Edges)
      {
        int a = cell.Corners[static_cast<std::size_t>(edge[0])];
        int b = cell.Corners[static_cast<std::size_t>(edge[1])];
        if (!known.insert({ a, b }).second)
        {
          continue;
        }
        for (const Place& step : line(vertex(std::min(a, b)), vertex(std::max(a, b))))
        {
          nodes.push_back(vertex(std::min(a, b)) + step);
        }
        const int d = axis(vertex(b) - vertex(a));
        // knot vector 2 d runs along the axis, 2 d + 1 against it
        const bool isForward = vertex(b)[d] > vertex(a)[d];
        edges += std::to_string(2 * d + (isForward ? 0 : 1)) + " " + std::to_string(a) + " " +
          std::to_string(b) + "\n";
        ++numEdges;
      }
    }
    for (const TestCell& cell : mesh.Cells)
    {
      for (const auto& face : ShapeOf(cell.Type).Faces)
      {
        std::vector<int> c;
        for (const int corner : face)
        {
          c.push_back(cell.Corners[static_cast<std::size_t>(corner)]);
        }
        if (known.insert(std::set<int>(c.begin(), c.end())).second)
        {
          for (const Place& up : line(vertex(c[0]), vertex(c[3])))
          {
            for (const Place& across : line(vertex(c[0]), vertex(c[1])))
            {
              nodes.push_back(vertex(c[0]) + up + across);
            }
          }
        }
      }
    }
    for (const TestCell& cell : mesh.Cells)
    {
      const Place origin = vertex(cell.Corners[0]);
      const std::vector<Place> above =
        dimension > 2 ? line(origin, vertex(cell.Corners[4])) : std::vector<Place>{ Place::Zero() };
      for (const Place& k : above)
      {
        for (const Place& j : line(origin, vertex(cell.Corners[3])))
        {
          for (const Place& i : line(origin, vertex(cell.Corners[1])))
          {
            nodes.push_back(origin + i + j + k);
          }
        }
      }
    }
    std::string text = With(TextOfCells(mesh), "MFEM mesh", "MFEM NURBS mesh");
    text =
      With(text, "vertices", "edges\n" + std::to_string(numEdges) + "\n" + edges + "\nvertices");
    text += "knotvectors\n" + std::to_string(2 * dimension) + "\n";
    for (int d = 0; d < dimension; ++d)
    {
      for (const bool isForward : { true, false })
      {
        text += "2 " + std::to_string(count(d));
        const std::vector<double>& t = knots[static_cast<std::size_t>(d)];
        for (std::size_t k = 0; k < t.size(); ++k)
        {
          text += " " + Number(isForward ? t[k] : 1 - t[t.size() - 1 - k]);
        }
        text += "\n";
      }
    }
    text += "weights\n";
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      text += "0.5\n"; // all equal: rational by form
    }
    text += With(TextOfNodes("NURBS2", nodes, dimension, seed % 2 == 0), "nodes", "");
    const auto read = ReadMfemMesh(text);
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_TRUE(read) << read.Status.Message();
    ASSERT_EQ(read->Splines.Splines.size(), mesh.Cells.size());
    const auto check = [&](auto dim)
    {
      constexpr int Dim = decltype(dim)::value;
      for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
      {
        const auto& spline = std::get<Spline<Dim>>(read->Splines.Splines[c]);
        const TestCell& cell = mesh.Cells[c];
        for (int sample = 0; sample < 3; ++sample)
        {
          Place local(random.Unit(), random.Unit(), Dim > 2 ? random.Unit() : 0.0);
          Place value = Place::Zero();
          std::array<std::vector<double>, 3> basis{ std::vector<double>{ 1 }, { 1 }, { 1 } };
          for (std::size_t d = 0; d < Dim; ++d)
          {
            const std::vector<double>& t = spline.Space->Knots[d].Knots();
            const int span = oracle::FindSpan(2, t, local[static_cast<int>(d)]);
            basis[d].clear();
            for (int i = 0; i < spline.Space->Knots[d].NumFunctions(); ++i)
            {
              basis[d].push_back(static_cast<double>(oracle::Basis(
                i, 2, t, span, static_cast<long double>(local[static_cast<int>(d)]))));
            }
          }
          Eigen::Index row = 0;
          for (const double w : basis[2])
          {
            for (const double v : basis[1])
            {
              for (const double u : basis[0])
              {
                value.head(Dim) += u * v * w * spline.ControlPoints.row(row++).transpose();
              }
            }
          }
          EXPECT_LT((value - Inside(mesh, cell, local)).cwiseAbs().maxCoeff(), 1e-13);
        }
      }
    };
    dimension == 2 ? check(std::integral_constant<int, 2>())
                   : check(std::integral_constant<int, 3>());
    // 3 x 2 (x 2) boxes
    const PatchTopology& topology = read->Splines.MultiPatches.at(0).Topology;
    EXPECT_EQ(topology.Interfaces.size(), dimension == 2 ? 7U : 20U);
    EXPECT_EQ(topology.Boundary.size(), dimension == 2 ? 10U : 32U);
    EXPECT_TRUE(CheckTopology(topology, static_cast<int>(mesh.Cells.size()), dimension));
    // what is stated is what the control points say
    const auto same = [&](auto dim)
    {
      constexpr int Dim = decltype(dim)::value;
      std::vector<Spline<Dim>> patches;
      for (const AnySpline& one : read->Splines.Splines)
      {
        patches.push_back(std::get<Spline<Dim>>(one));
      }
      const auto found = FindInterfaces<Dim>(patches);
      ASSERT_EQ(found.size(), topology.Interfaces.size());
      for (std::size_t i = 0; i < found.size(); ++i)
      {
        EXPECT_EQ(found[i].Sides, topology.Interfaces[i].Sides);
        EXPECT_EQ(found[i].Orientation, topology.Interfaces[i].Orientation);
      }
    };
    dimension == 2 ? same(std::integral_constant<int, 2>())
                   : same(std::integral_constant<int, 3>());
  }
}
