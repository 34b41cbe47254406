// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

/// Grids of cells of all kinds whose verdict is known. Valid cells are so by construction: the
/// identity plus a displacement whose derivative is too small to turn det J (entries sum to less
/// than 1 in each row), under a projective map of positive determinant and a change of parameters
/// when rational. Folded ones have points of both signs, found at a lattice by VTK's own
/// derivatives (nodal cells) or by the definition in extended precision (Bezier cells), well apart
/// from zero. Everything else is thrown away.
namespace corpus
{
using Real = long double;
using Point = std::array<double, 3>;

struct Cell
{
  int Type = 0;
  std::array<int, 3> Degree{};
  std::vector<Point> Points;
  std::vector<double> Weights;
  int Expected = 0; ///< 1 valid, -1 folded, 2 reversed
};

struct Kind
{
  int Type;
  int Parameters;
  int MostDegree; ///< 0: the type's own
  int NumPoints;
  bool Simplex;
};

inline const std::vector<Kind>& Kinds()
{
  static const std::vector<Kind> kinds{ { VTK_BEZIER_QUADRILATERAL, 2, 4, 0, false },
    { VTK_BEZIER_HEXAHEDRON, 3, 2, 0, false }, { VTK_QUAD, 2, 0, 4, false },
    { VTK_QUADRATIC_QUAD, 2, 0, 8, false }, { VTK_BIQUADRATIC_QUAD, 2, 0, 9, false },
    { VTK_TRIANGLE, 2, 0, 3, true }, { VTK_QUADRATIC_TRIANGLE, 2, 0, 6, true },
    { VTK_HEXAHEDRON, 3, 0, 8, false }, { VTK_QUADRATIC_HEXAHEDRON, 3, 0, 20, false },
    { VTK_TRIQUADRATIC_HEXAHEDRON, 3, 0, 27, false }, { VTK_TETRA, 3, 0, 4, true },
    { VTK_QUADRATIC_TETRA, 3, 0, 10, true }, { VTK_WEDGE, 3, 0, 6, true },
    { VTK_LAGRANGE_QUADRILATERAL, 2, 3, 0, false }, { VTK_LAGRANGE_HEXAHEDRON, 3, 2, 0, false } };
  return kinds;
}

inline bool IsBezier(int type)
{
  return type >= VTK_BEZIER_CURVE && type <= VTK_BEZIER_WEDGE;
}
inline bool IsWedge(int type)
{
  return type == VTK_WEDGE || type == VTK_LAGRANGE_WEDGE || type == VTK_BEZIER_WEDGE;
}

class Generator
{
public:
  explicit Generator(unsigned seed) : Engine(seed) {}
  double Unit() { return static_cast<double>(this->Engine() >> 11) * 0x1p-53; }
  double In(double a, double b) { return a + (b - a) * this->Unit(); }
  int Int(int a, int b) { return a + static_cast<int>(this->Unit() * (b - a + 1)); }

  /// @param logWeights  weights of rational cells lie within 10^-+ this.
  /// @param bent  of two parameters: a surface in space, which has no right way round.
  Cell Make(const Kind& kind, bool rational, double logWeights, bool bent)
  {
    Cell cell;
    while (cell.Expected == 0)
    {
      cell = this->Try(kind, rational, logWeights, bent);
    }
    if (this->Unit() >= 0.2)
    {
      return cell;
    }
    for (Point& x : cell.Points)
    {
      if (bent)
      {
        std::swap(x[1], x[2]);
      }
      else if (cell.Expected == 1)
      {
        x[1] = -x[1];
      }
    }
    cell.Expected = cell.Expected == 1 && !bent ? 2 : cell.Expected;
    return cell;
  }

private:
  Cell Try(const Kind& kind, bool rational, double logWeights, bool bent)
  {
    Cell cell;
    cell.Type = kind.Type;
    cell.Degree = { 1, 1, kind.Parameters == 3 ? 1 : 0 };
    int count = kind.NumPoints;
    if (kind.MostDegree > 0)
    {
      count = kind.Simplex ? 0 : 1;
      for (int d = 0; !kind.Simplex && d < kind.Parameters; ++d)
      {
        cell.Degree[static_cast<std::size_t>(d)] = this->Int(1, kind.MostDegree);
        count *= cell.Degree[static_cast<std::size_t>(d)] + 1;
      }
    }
    if (kind.MostDegree > 0 && kind.Simplex)
    {
      const int p = this->Int(1, kind.MostDegree);
      cell.Degree = { p, p, kind.Parameters == 3 ? p : 0 };
      const int triangle = (p + 1) * (p + 2) / 2;
      count = IsWedge(kind.Type) ? triangle * (p + 1)
        : kind.Parameters == 3   ? triangle * (p + 3) / 3
                                 : triangle;
    }
    cell.Points.assign(static_cast<std::size_t>(count), Point{});
    cell.Weights.assign(static_cast<std::size_t>(count), 1.0);
    vtkNew<vtkGenericCell> vtk;
    const auto grid = Grid({ cell });
    grid->GetCell(0, vtk);
    const double* places = vtk->GetParametricCoords();
    const bool fold = this->Unit() < 0.5 && !bent;
    const int d = kind.Parameters;
    // row sums of the displacement's derivative: at most size * steepness * d
    const double steepness = this->Steepness(kind, cell, vtk);
    const double size = fold ? this->In(0.2, 0.9) : this->In(0.1, 0.9) / (steepness * d);
    const double z = d == 2 && this->Unit() < 0.5 ? this->In(-1, 1) : 0.0;
    std::array<double, 3> slope{};
    for (double& s : slope)
    {
      s = rational ? this->In(-0.3, 0.3) : 0.0;
    }
    const std::array<double, 3> powers{ this->In(-1, 1), this->In(-1, 1), this->In(-1, 1) };
    for (std::size_t i = 0; i < cell.Points.size(); ++i)
    {
      Point x{};
      for (int c = 0; c < d; ++c)
      {
        x[static_cast<std::size_t>(c)] =
          places[3 * i + static_cast<std::size_t>(c)] + this->In(-size, size);
      }
      if (rational && !fold)
      {
        double w = 1.0;
        double exponent = 0.0;
        for (std::size_t c = 0; c < static_cast<std::size_t>(d); ++c)
        {
          w += slope[c] * x[c]; // |x| < 2, so w > 0 in two and three dimensions: see the loop below
          exponent += powers[c] * places[3 * i + c];
        }
        if (w < 0.05)
        {
          return cell; // thrown away
        }
        for (double& c : x)
        {
          c /= w;
        }
        cell.Weights[i] = w * std::pow(10.0, exponent * logWeights / d);
      }
      else if (rational)
      {
        cell.Weights[i] = std::pow(10.0, this->In(-logWeights, logWeights));
      }
      x[2] = d == 3 ? x[2] : bent ? this->In(-1, 1) : z;
      cell.Points[i] = x;
    }
    cell.Expected = fold ? this->Folded(kind, cell) : 1;
    return cell;
  }

  /// Most of the sums of |derivatives| of the shape functions by one parameter.
  double Steepness(const Kind& kind, const Cell& cell, vtkGenericCell* vtk)
  {
    if (IsBezier(kind.Type))
    {
      return 2.0 * std::max({ cell.Degree[0], cell.Degree[1], cell.Degree[2] });
    }
    static std::map<std::pair<int, std::array<int, 3>>, double> known;
    double& most = known[{ kind.Type, cell.Degree }];
    if (most > 0.0)
    {
      return 1.2 * most;
    }
    Lattice(kind, 12,
      [&](const Point& u)
      {
        const std::vector<double> derivatives = Derivatives(kind, cell, vtk, u);
        const std::size_t n = cell.Points.size();
        for (int d = 0; d < kind.Parameters; ++d)
        {
          double sum = 0.0;
          for (std::size_t i = 0; i < n; ++i)
          {
            sum += std::fabs(derivatives[static_cast<std::size_t>(d) * n + i]);
          }
          most = std::max(most, sum);
        }
      });
    return 1.2 * most; // between the lattice's points
  }

  /// Of the shape functions, by differences of VTK's own.
  static std::vector<double> Derivatives(
    const Kind& kind, const Cell& cell, vtkGenericCell* vtk, const Point& u)
  {
    constexpr double h = 1e-5; // an error of 1e-9 of polynomials of small degree
    const std::size_t n = cell.Points.size();
    std::vector<double> derivatives;
    std::vector<double> low(n);
    std::vector<double> high(n);
    for (std::size_t d = 0; d < static_cast<std::size_t>(kind.Parameters); ++d)
    {
      Point at = u;
      at[d] = u[d] - h;
      vtk->InterpolateFunctions(at.data(), low.data());
      at[d] = u[d] + h;
      vtk->InterpolateFunctions(at.data(), high.data());
      for (std::size_t i = 0; i < n; ++i)
      {
        derivatives.push_back((high[i] - low[i]) / (2.0 * h));
      }
    }
    return derivatives;
  }

  template <typename Visit>
  static void Lattice(const Kind& kind, int n, const Visit& visit)
  {
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; j <= n; ++j)
      {
        for (int k = 0; k <= (kind.Parameters == 3 ? n : 0); ++k)
        {
          if (!kind.Simplex || i + j + (IsWedge(kind.Type) ? 0 : k) <= n)
          {
            visit(Point{ 1.0 * i / n, 1.0 * j / n, 1.0 * k / n });
          }
        }
      }
    }
  }

  static Real Choose(int n, int k)
  {
    Real c = 1;
    for (int i = 1; i <= k; ++i)
    {
      c = c * (n - k + i) / i;
    }
    return c;
  }
  /// Value and derivative of a Bernstein polynomial.
  static std::array<Real, 2> Bernstein(int p, int i, Real t)
  {
    const auto b = [&](int n, int k)
    {
      return k < 0 || k > n ? Real(0)
                            : Choose(n, k) * std::pow(t, Real(k)) * std::pow(1 - t, Real(n - k));
    };
    return { b(p, i), p * (b(p - 1, i - 1) - b(p - 1, i)) };
  }

  /// Function of a point of the lattice (k = 0), or its derivative by parameter k - 1.
  static Real BasisFunction(
    const Kind& kind, const Cell& cell, const double* place, const Point& u, std::size_t k)
  {
    const std::size_t d = static_cast<std::size_t>(kind.Parameters);
    const std::size_t simplex = !kind.Simplex ? 0 : IsWedge(kind.Type) ? 2 : d;
    std::array<int, 3> index{};
    Real f = 1;
    for (std::size_t r = 0; r < d; ++r)
    {
      const int p = cell.Degree[r];
      index[r] = static_cast<int>(std::lround(p * place[r]));
      f *= r >= simplex ? Bernstein(p, index[r], u[r])[k == r + 1 ? 1 : 0] : 1;
    }
    if (simplex == 0)
    {
      return f;
    }
    // p! / (i! j! ... l!) u^i v^j ... (1 - u - v ...)^l
    int left = cell.Degree[0];
    Real rest = 1;
    Real product = 1;
    for (std::size_t r = 0; r < simplex; ++r)
    {
      product *= Choose(left, index[r]);
      left -= index[r];
      rest -= u[r];
    }
    const auto power = [](Real x, int n) { return n < 0 ? Real(0) : std::pow(x, Real(n)); };
    const auto term = [&](std::size_t derived)
    {
      Real value = product;
      for (std::size_t r = 0; r < simplex; ++r)
      {
        const Real x = u[r];
        value *= r + 1 == derived ? index[r] * power(x, index[r] - 1) : power(x, index[r]);
      }
      return value;
    };
    if (k == 0 || k > simplex)
    {
      return f * term(0) * power(rest, left);
    }
    return f * (term(k) * power(rest, left) - term(0) * left * power(rest, left - 1));
  }

  /// The derivative's determinant at a point, over a typical size of it.
  static Real Determinant(const Kind& kind, const Cell& cell, vtkGenericCell* vtk, const Point& u)
  {
    const std::size_t d = static_cast<std::size_t>(kind.Parameters);
    const std::size_t n = cell.Points.size();
    std::array<std::array<Real, 3>, 3> j{};
    if (!IsBezier(kind.Type))
    {
      const auto derivatives = Derivatives(kind, cell, vtk, u);
      for (std::size_t r = 0; r < d; ++r)
      {
        for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t c = 0; c < d; ++c)
          {
            j[c][r] += derivatives[r * n + i] * static_cast<Real>(cell.Points[i][c]);
          }
        }
      }
    }
    else
    {
      const double* places = vtk->GetParametricCoords();
      std::array<std::array<Real, 4>, 4> s{}; // (x, y, z, w) and its derivatives
      for (std::size_t i = 0; i < n; ++i)
      {
        for (std::size_t k = 0; k <= d; ++k)
        {
          const Real f = cell.Weights[i] * BasisFunction(kind, cell, places + 3 * i, u, k);
          for (std::size_t c = 0; c < 3; ++c)
          {
            s[k][c] += f * cell.Points[i][c];
          }
          s[k][3] += f;
        }
      }
      for (std::size_t r = 0; r < d; ++r)
      {
        for (std::size_t c = 0; c < d; ++c)
        {
          j[c][r] = (s[r + 1][c] - s[0][c] / s[0][3] * s[r + 1][3]) / s[0][3];
        }
      }
    }
    Real det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    Real size = std::hypot(j[0][0], j[1][0]) * std::hypot(j[0][1], j[1][1]);
    if (d == 3)
    {
      det = det * j[2][2] - (j[0][0] * j[2][1] - j[0][1] * j[2][0]) * j[1][2] +
        (j[1][0] * j[2][1] - j[1][1] * j[2][0]) * j[0][2];
      size = 1;
      for (std::size_t r = 0; r < 3; ++r)
      {
        size *= std::hypot(j[0][r], j[1][r], j[2][r]);
      }
    }
    return size > 0 ? det / size : 0;
  }

  /// -1 when it has points of both signs at which angles are clear of zero, else 0.
  static int Folded(const Kind& kind, const Cell& cell)
  {
    vtkNew<vtkGenericCell> vtk;
    const auto grid = Grid({ cell });
    grid->GetCell(0, vtk);
    Real least = 0;
    Real most = 0;
    Lattice(kind, kind.Parameters == 3 ? 5 : 8,
      [&](const Point& u)
      {
        const Real det = Determinant(kind, cell, vtk, u);
        least = std::min(least, det);
        most = std::max(most, det);
      });
    return least < -1e-3 && most > 1e-3 ? -1 : 0;
  }

public:
  static vtkSmartPointer<vtkUnstructuredGrid> Grid(
    const std::vector<Cell>& cells, double scale = 1.0, double shift = 0.0)
  {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkDoubleArray> weights;
    weights->SetName("RationalWeights");
    vtkNew<vtkDoubleArray> degrees;
    degrees->SetName("HigherOrderDegrees");
    degrees->SetNumberOfComponents(3);
    grid->Allocate(static_cast<vtkIdType>(cells.size()));
    bool rational = false;
    for (const Cell& cell : cells)
    {
      vtkNew<vtkIdList> ids;
      for (std::size_t i = 0; i < cell.Points.size(); ++i)
      {
        const Point& x = cell.Points[i];
        ids->InsertNextId(points->InsertNextPoint(
          scale * x[0] + shift, scale * x[1] - shift, scale * x[2] + shift));
        weights->InsertNextValue(cell.Weights[i]);
        rational = rational || cell.Weights[i] != 1.0;
      }
      grid->InsertNextCell(cell.Type, ids);
      degrees->InsertNextTuple3(cell.Degree[0], cell.Degree[1], cell.Degree[2]);
    }
    grid->SetPoints(points);
    grid->GetCellData()->SetHigherOrderDegrees(degrees);
    if (rational)
    {
      grid->GetPointData()->SetRationalWeights(weights);
    }
    return grid;
  }

private:
  std::mt19937_64 Engine;
};

struct Counts
{
  int Cells = 0;
  int Wrong = 0;
  int Undecided = 0;
};

inline vtkSmartPointer<vtkUnstructuredGrid> Validate(vtkUnstructuredGrid* grid)
{
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(grid);
  filter->InjectivityOff();
  filter->MeasuresOff();
  filter->SetThreads(1);
  filter->Update();
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

inline double Value(vtkUnstructuredGrid* grid, const char* name, vtkIdType cell)
{
  vtkDataArray* array = grid->GetCellData()->GetArray(name);
  return array ? array->GetComponent(cell, 0) : std::numeric_limits<double>::quiet_NaN();
}

/// Validates a grid of cells, and some of them alone.
inline void Check(
  const std::vector<Cell>& cells, double scale, double shift, int alone, Counts& counts)
{
  const auto together = Validate(Generator::Grid(cells, scale, shift));
  ASSERT_EQ(together->GetNumberOfCells(), static_cast<vtkIdType>(cells.size()));
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const vtkIdType cell = static_cast<vtkIdType>(c);
    const double verdict = Value(together, "JacobianVerdict", cell);
    const bool reversed = Value(together, "JacobianReversed", cell) == 1.0;
    const int said = verdict == 1.0 ? 1 : verdict == 0.0 ? 0 : reversed ? 2 : -1;
    ++counts.Cells;
    counts.Undecided += said == 0;
    const bool wrong = said != 0 && said != cells[c].Expected;
    counts.Wrong += wrong;
    EXPECT_FALSE(wrong) << "cell " << c << " of type " << cells[c].Type << " degree "
                        << cells[c].Degree[0] << " " << cells[c].Degree[1] << " "
                        << cells[c].Degree[2] << " is " << said << ", not " << cells[c].Expected;
    if (static_cast<int>(c) % std::max(1, static_cast<int>(cells.size()) / alone) == 0)
    {
      const auto single = Validate(Generator::Grid({ cells[c] }, scale, shift));
      for (const char* name :
        { "JacobianVerdict", "JacobianReversed", "JacobianDegenerate", "JacobianLimit",
          "JacobianMinLower", "JacobianMinUpper", "JacobianMaxLower", "JacobianMaxUpper" })
      {
        EXPECT_EQ(Value(single, name, 0), Value(together, name, cell)) << name << " of cell " << c;
      }
    }
  }
}

/// Cells that a grid of the corpus is made of.
struct Group
{
  const char* Name;
  int Parameters; // 0: all
  double LogWeights;
  double Bent; // how many of two parameters
};

inline const std::vector<Group>& Groups()
{
  static const std::vector<Group> groups{ { "planar polynomial", 2, 0, 0 },
    { "planar rational", 2, 1, 0 }, { "planar, weights 1e-3 to 1e3", 2, 3, 0 },
    { "surfaces polynomial", 2, 0, 1 }, { "surfaces rational", 2, 1, 1 },
    { "volumes polynomial", 3, 0, 0 }, { "volumes rational", 3, 1, 0 },
    { "volumes, weights 1e-3 to 1e3", 3, 3, 0 }, { "mixed polynomial", 0, 0, 0.2 },
    { "mixed rational", 0, 1.5, 0.2 } };
  return groups;
}

/// Grids of one group, at several sizes and places.
inline void RunCorpus(const Group& group, unsigned firstSeed, int seeds, int cellsEach, int alone)
{
  const double scales[] = { 1.0, 1e-9, 1e-4, 1e5, 1e9 };
  for (const bool shifted : { false, true })
  {
    Counts counts;
    for (int s = 0; s < seeds; ++s)
    {
      const unsigned seed = firstSeed + static_cast<unsigned>(s);
      SCOPED_TRACE(
        std::string(group.Name) + (shifted ? " shifted" : "") + " seed " + std::to_string(seed));
      Generator generator(1000 * seed + (shifted ? 1 : 0));
      std::vector<Cell> cells;
      while (static_cast<int>(cells.size()) < cellsEach)
      {
        const Kind& kind =
          Kinds()[static_cast<std::size_t>(generator.Int(0, static_cast<int>(Kinds().size()) - 1))];
        const bool rational = group.LogWeights > 0 && IsBezier(kind.Type);
        const bool wanted = group.Parameters == 0 || kind.Parameters == group.Parameters;
        if (wanted && (rational || group.LogWeights == 0 || group.Parameters == 0))
        {
          const bool bent = kind.Parameters == 2 && generator.Unit() < group.Bent;
          cells.push_back(
            generator.Make(kind, rational && generator.Unit() < 0.8, group.LogWeights, bent));
        }
      }
      const double scale = scales[static_cast<std::size_t>(s) % std::size(scales)];
      Check(cells, scale, shifted ? 1e6 * scale : 0.0, alone, counts);
    }
    std::printf("%-30s%-9s %6d cells, %d wrong, %d undecided\n", group.Name,
      shifted ? "shifted" : "", counts.Cells, counts.Wrong, counts.Undecided);
    EXPECT_EQ(counts.Wrong, 0) << group.Name;
    EXPECT_LE(100 * counts.Undecided, counts.Cells) << group.Name << (shifted ? " shifted" : "");
  }
}
}
