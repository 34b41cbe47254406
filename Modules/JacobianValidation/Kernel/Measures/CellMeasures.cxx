// SPDX-License-Identifier: BSD-3-Clause
#include "CellMeasures.h"
#include "CellGluing.h"
#include "PatchIntegrals.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <string>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;
constexpr std::size_t LargestTable = std::size_t(1) << 20;

/// The uniform lattice with n points along every edge.
std::vector<std::array<double, 3>> LatticePoints(CellShape shape, int n)
{
  const int dim = NumParameters(shape);
  std::vector<std::array<double, 3>> points;
  for (int k = 0; k < (dim > 2 ? n : 1); ++k)
  {
    for (int j = 0; j < (dim > 1 ? n : 1); ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const int sum = shape == CellShape::Tetrahedron               ? i + j + k
          : shape == CellShape::Triangle || shape == CellShape::Wedge ? i + j
                                                                      : 0;
        if (sum < n)
        {
          const double h = 1.0 / (n - 1);
          points.push_back({ i * h, j * h, k * h });
        }
      }
    }
  }
  return points;
}

using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Values and derivatives of all basis functions: 1 + dim rows a point.
Table MakeTable(CellShape shape, const CellDegree& degree,
  const std::vector<std::array<double, 3>>& points, std::size_t begin, std::size_t end)
{
  const int n = NumCellCoefficients(shape, degree);
  const int rows = 1 + NumParameters(shape);
  Table table(static_cast<Eigen::Index>(end - begin) * rows, n);
  for (std::size_t i = begin; i < end; ++i)
  {
    double* row = table.data() + static_cast<std::ptrdiff_t>(i - begin) * rows * n;
    EvaluateCellBasis(shape, degree, points[i].data(), row, row + n);
  }
  return table;
}

/// What the derivatives at a point say.
struct Sample
{
  double Det = 0.0;
  double Scaled = 0.0;
  double Condition = 0.0;
};

/// det J or its counterpart for more components, scaled Jacobian, condition number.
Sample MakeSample(const Table& values, Eigen::Index row, int dim, int components, bool rational)
{
  Sample s;
  const double w = rational ? values(row, components) : 1.0;
  Eigen::Matrix<double, 3, 3> j = Eigen::Matrix<double, 3, 3>::Zero();
  for (int c = 0; c < components; ++c)
  {
    const double x = values(row, c) / w;
    for (int d = 0; d < dim; ++d)
    {
      const double slope = rational ? values(row + 1 + d, components) : 0.0;
      j(c, d) = (values(row + 1 + d, c) - x * slope) / w;
    }
  }
  double inverse = 0.0; // |J^-1|_F |det J|
  if (dim == 1)
  {
    s.Det = components == 1 ? j(0, 0) : j.col(0).norm();
    inverse = 1.0;
  }
  else if (dim == 2)
  {
    s.Det =
      components == 2 ? j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0) : j.col(0).cross(j.col(1)).norm();
    inverse = j.norm();
  }
  else
  {
    s.Det = j.col(0).cross(j.col(1)).dot(j.col(2));
    inverse = std::sqrt(j.col(0).cross(j.col(1)).squaredNorm() +
      j.col(1).cross(j.col(2)).squaredNorm() + j.col(2).cross(j.col(0)).squaredNorm());
  }
  double lengths = 1.0;
  for (int d = 0; d < dim; ++d)
  {
    lengths *= j.col(d).norm();
  }
  s.Scaled = lengths > 0.0 ? std::clamp(s.Det / lengths, -1.0, 1.0) : 0.0;
  s.Condition = s.Det != 0.0 ? std::max(1.0, j.norm() * inverse / (dim * std::abs(s.Det)))
                             : std::numeric_limits<double>::infinity();
  return s;
}

/// Works on one cell at a time; keeps the tables of lattices, sides and rules it met.
class CellMeasurer
{
public:
  CellMeasurer(const BernsteinCells& cells, const CellMeasuresParams& params)
    : Cells(cells), Params(params)
  {
  }

  CellMeasure Measure(int cell)
  {
    this->Start(cell);
    CellMeasure m;
    m.Centroid.fill(std::numeric_limits<double>::quiet_NaN());
    const PatchIntegral sum =
      this->Dim == 1 && this->Components == 1 ? this->SignedLength() : this->Integrate();
    m.Measure = sum.Measure;
    m.MeasureError = sum.Error + 64.0 * UnitRoundoff * sum.Absolute;
    m.Converged = sum.Converged;
    m.Points = sum.Points;
    if (sum.Measure != 0.0)
    {
      for (std::size_t c = 0; c < static_cast<std::size_t>(this->Components); ++c)
      {
        m.Centroid[c] = this->Origin[c] + sum.Moment[c] / sum.Measure;
      }
    }
    this->Quality(m);
    return m;
  }

private:
  void Start(int cell)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    this->Cell = cell;
    this->Shape = this->Cells.Shapes[at];
    this->Degree = this->Cells.Degrees[at];
    this->Dim = NumParameters(this->Shape);
    this->Components = this->Cells.NumComponents;
    const int n = NumCellCoefficients(this->Shape, this->Degree);
    const double* block = this->Cells.Block(cell);
    this->Block = Eigen::Map<const Eigen::MatrixXd>(block, n, this->Cells.NumPlanes());
    // coordinates relative to the middle of the control points: far from the origin nothing cancels
    this->Size = 0.0;
    for (int c = 0; c < this->Components; ++c)
    {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (int i = 0; i < n; ++i)
      {
        const double w = this->Cells.Rational ? this->Block(i, this->Components) : 1.0;
        low = std::min(low, this->Block(i, c) / w);
        high = std::max(high, this->Block(i, c) / w);
      }
      double& origin = this->Origin[static_cast<std::size_t>(c)];
      origin = low + 0.5 * (high - low);
      this->Size = std::max(this->Size, 0.5 * (high - low));
      if (this->Cells.Rational)
      {
        this->Block.col(c) -= origin * this->Block.col(this->Components);
      }
      else
      {
        this->Block.col(c).array() -= origin;
      }
    }
    this->Size = this->Size > 0.0 ? this->Size : 1.0;
  }

  PatchIntegral SignedLength() const
  {
    const auto end = [&](int i)
    { return this->Cells.Rational ? this->Block(i, 0) / this->Block(i, 1) : this->Block(i, 0); };
    const double first = end(0);
    const double last = end(static_cast<int>(this->Block.rows()) - 1);
    PatchIntegral sum;
    sum.Measure = last - first;
    sum.Absolute = std::max(std::abs(first), std::abs(last));
    sum.Moment[0] = 0.5 * (last - first) * (last + first);
    return sum;
  }

  /// A side of the cells of one shape and degree; the cell itself when it has more components than
  /// parameters.
  struct SideTable
  {
    CellShape Shape = CellShape::Curve;
    CellDegree Degree{};
    std::vector<int> Coefficients;
  };
  const std::vector<SideTable>& Sides()
  {
    const auto [at, isNew] =
      this->SideTables.try_emplace({ static_cast<int>(this->Shape), this->Degree });
    if (isNew && this->Dim == this->Components)
    {
      for (int side = 0; side < NumSides(this->Shape); ++side)
      {
        const SideFrame& frame = GetSideFrame(this->Shape, side);
        at->second.push_back({ frame.Shape, SideDegree(this->Shape, this->Degree, frame),
          SideCoefficients(this->Shape, this->Degree, frame) });
      }
    }
    else if (isNew)
    {
      std::vector<int> all(static_cast<std::size_t>(this->Block.rows()));
      std::iota(all.begin(), all.end(), 0);
      at->second.push_back({ this->Shape, this->Degree, std::move(all) });
    }
    return at->second;
  }

  /// Areas and volumes by the divergence theorem from the cell's sides: one dimension less, and an
  /// integrand without roots whatever folds inside.
  PatchIntegral Integrate()
  {
    PatchIntegralParams params;
    params.Integrand = this->Dim == this->Components ? PatchIntegrand::Flux : PatchIntegrand::Size;
    params.Rational = this->Cells.Rational;
    params.Size = this->Size;
    params.Tolerance = this->Params.Tolerance;
    params.MaxDepth = this->Params.MaxDepth;
    params.MaxPoints = this->Params.MaxPoints;
    std::vector<PatchForm> patches;
    for (const SideTable& side : this->Sides())
    {
      patches.push_back(MakePatchForm(
        this->Cells, this->Cell, side.Shape, side.Degree, side.Coefficients, this->Origin));
    }
    return IntegratePatches(std::move(patches), params, this->Rules);
  }

  template <typename Use>
  void ForSamples(
    const std::vector<std::array<double, 3>>& points, const Table* table, Use&& use) const
  {
    const std::size_t rows = static_cast<std::size_t>(1 + this->Dim);
    const std::size_t step = std::max<std::size_t>(
      1, LargestTable / (rows * static_cast<std::size_t>(this->Block.rows())));
    for (std::size_t begin = 0; begin < points.size(); begin += step)
    {
      const std::size_t end = std::min(points.size(), begin + step);
      const Table values = table
        ? Table(*table * this->Block)
        : Table(MakeTable(this->Shape, this->Degree, points, begin, end) * this->Block);
      for (std::size_t i = begin; i < end; ++i)
      {
        use(MakeSample(values, static_cast<Eigen::Index>((i - begin) * rows), this->Dim,
          this->Components, this->Cells.Rational));
      }
    }
  }

  /// The lattice at which quality is sampled, with the basis at its points where it is not large.
  struct Lattice
  {
    std::vector<std::array<double, 3>> Points;
    knotwork::Table Table;
    bool HasTable = false;
  };
  const Lattice& SampleLattice()
  {
    const auto [at, isNew] =
      this->Lattices.try_emplace({ static_cast<int>(this->Shape), this->Degree });
    Lattice& lattice = at->second;
    if (isNew)
    {
      lattice.Points = LatticePoints(this->Shape, this->Params.SamplesPerEdge);
      const std::size_t size = lattice.Points.size();
      lattice.HasTable =
        size * static_cast<std::size_t>((1 + this->Dim) * this->Block.rows()) <= LargestTable;
      if (lattice.HasTable)
      {
        lattice.Table = MakeTable(this->Shape, this->Degree, lattice.Points, 0, size);
      }
    }
    return lattice;
  }

  void Quality(CellMeasure& m)
  {
    const Lattice& lattice = this->SampleLattice();
    m.ScaledMin = std::numeric_limits<double>::infinity();
    m.ScaledMax = -m.ScaledMin;
    m.UniformityMin = m.ScaledMin;
    m.UniformityMax = m.ScaledMax;
    this->ForSamples(lattice.Points, lattice.HasTable ? &lattice.Table : nullptr,
      [&](const Sample& s)
      {
        m.ScaledMin = std::min(m.ScaledMin, s.Scaled);
        m.ScaledMax = std::max(m.ScaledMax, s.Scaled);
        m.ScaledMean += s.Scaled;
        m.ConditionMax = std::max(m.ConditionMax, s.Condition);
        m.ConditionMean += s.Condition;
        m.UniformityMin = std::min(m.UniformityMin, s.Det);
        m.UniformityMax = std::max(m.UniformityMax, s.Det);
      });
    const double n = static_cast<double>(lattice.Points.size());
    m.ScaledMean /= n;
    m.ConditionMean /= n;
    m.ScaledLower = this->ScaledBound(m.ScaledMin);
  }

  /// Lower bound of the scaled Jacobian on a piece: the derivatives' directions lie in balls around
  /// their mean, and det of unit vectors (or the cross product's length) changes by at most the sum
  /// of their changes; a ball of radius r at distance m is seen under an angle of sine r / m, and
  /// the chord of an angle is at most sqrt(2) times its sine up to 90 degrees.
  double PieceBound(const CellLattice& lattice, const CellPiece& piece) const
  {
    const bool rational = this->Cells.Rational;
    const int n = lattice.Size;
    const int components = this->Components;
    const PieceHull hull = MakeHull(lattice, components, rational, piece);
    if (!std::isfinite(hull.Error))
    {
      return -1.0;
    }
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0.0;
    double largest = 0.0;
    for (int c = 0; c < components; ++c)
    {
      const std::size_t at = static_cast<std::size_t>(c);
      centre[c] = 0.5 * (hull.Lower[at] + hull.Upper[at]);
      radius += std::pow(hull.Upper[at] - hull.Lower[at], 2);
      largest = std::max(largest, std::max(std::abs(hull.Lower[at]), std::abs(hull.Upper[at])));
    }
    radius = 0.5 * std::sqrt(radius) * (1.0 + 1e-12);
    const double* weights = rational ? piece.Data.data() + components * n : nullptr;
    // Differences along the piece's own edges from its corner 0, by the coefficient they start at.
    Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
    std::array<std::vector<int>, 3> starts;
    std::array<Eigen::Matrix3Xd, 3> slopes;
    Eigen::Vector3d losses = Eigen::Vector3d::Zero();
    for (int k = 0; k < this->Dim; ++k)
    {
      const std::size_t index = static_cast<std::size_t>(k);
      const auto& direction =
        lattice.Directions[this->Shape == CellShape::Wedge && k == 2 ? 3 : index];
      for (int d = 0; d < this->Dim; ++d)
      {
        const std::size_t at = static_cast<std::size_t>(d);
        edges(d, k) = piece.Corners[static_cast<std::size_t>(direction.To)][at] -
          piece.Corners[static_cast<std::size_t>(direction.From)][at];
      }
      slopes[index] = Eigen::Matrix3Xd::Zero(3, n);
      double weightSlope = 0.0;
      double rounding = 0.0;
      for (const auto& line : direction.Lines)
      {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
        {
          const int a = line[i];
          const int b = line[i + 1];
          starts[index].push_back(a);
          const double dw = weights ? weights[b] - weights[a] : 0.0;
          for (int c = 0; c < components; ++c)
          {
            const double* x = piece.Data.data() + c * n;
            slopes[index](c, a) = (x[b] - x[a]) - centre[c] * dw;
          }
          weightSlope = std::max(weightSlope, std::abs(dw) + 2.0 * piece.Error);
          const double size = weights ? std::max(weights[a], weights[b]) : 1.0;
          rounding =
            std::max(rounding, 4.0 * piece.Error * (1.0 + largest) + 1e-15 * largest * size);
        }
      }
      losses[k] = 2.0 * rounding + (weights ? radius * weightSlope : 0.0);
    }
    // From the edges to the cell's parameters: edges of one simplex start at the same coefficients,
    // the others do not mix.
    const Eigen::Matrix3d inverse = edges.inverse();
    Eigen::Matrix3d derivatives = Eigen::Matrix3d::Zero();
    Eigen::Vector3d spread = Eigen::Vector3d::Zero();
    for (int d = 0; d < this->Dim; ++d)
    {
      Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, n);
      const std::vector<int>* used = nullptr;
      for (int k = 0; k < this->Dim; ++k)
      {
        if (inverse(k, d) != 0.0)
        {
          sum += inverse(k, d) * slopes[static_cast<std::size_t>(k)];
          spread[d] += std::abs(inverse(k, d)) * losses[k];
          used = &starts[static_cast<std::size_t>(k)];
        }
      }
      for (const int a : *used)
      {
        derivatives.col(d) += sum.col(a) / static_cast<double>(used->size());
      }
      double r = 0.0;
      for (const int a : *used)
      {
        r = std::max(r, (sum.col(a) - derivatives.col(d)).norm());
      }
      spread[d] = (spread[d] + r) * (1.0 + 1e-12) + 1e-15 * derivatives.col(d).norm();
    }
    Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
    double loss = 0.0;
    for (int d = 0; d < this->Dim; ++d)
    {
      const double length = derivatives.col(d).norm();
      if (!(spread[d] < length))
      {
        return -1.0;
      }
      unit.col(d) = derivatives.col(d) / length;
      loss += 1.4142135623730952 * spread[d] / length;
    }
    double value = 0.0;
    if (this->Dim == components)
    {
      value = unit.topLeftCorner(this->Dim, this->Dim).determinant();
    }
    else if (this->Dim == 2)
    {
      value = unit.col(0).cross(unit.col(1)).norm();
    }
    else
    {
      value = 1.0;
    }
    return std::max(-1.0, value - loss - 1e-12);
  }

  double ScaledBound(double least)
  {
    if (this->Params.BoundBoxes == 0)
    {
      return -1.0;
    }
    const CellLattice& lattice =
      this->CoefficientLattices
        .try_emplace({ static_cast<int>(this->Shape), this->Degree }, this->Shape, this->Degree)
        .first->second;
    const int planes = this->Cells.NumPlanes();
    const double error =
      this->Cells.Errors.empty() ? 0.0 : this->Cells.Errors[static_cast<std::size_t>(this->Cell)];
    struct Open
    {
      double Bound;
      CellPiece Piece;
      bool operator<(const Open& other) const { return this->Bound > other.Bound; }
    };
    std::priority_queue<Open> open;
    CellPiece whole = MakePiece(lattice, planes, this->Cells.Block(this->Cell), error);
    const double first = this->PieceBound(lattice, whole);
    open.push({ first, std::move(whole) });
    for (int boxes = 1; boxes + 2 <= this->Params.BoundBoxes; boxes += 2)
    {
      if (open.top().Bound >= least - 0.01)
      {
        break;
      }
      const CellPiece piece = open.top().Piece;
      open.pop();
      const PieceHull hull = MakeHull(lattice, this->Components, this->Cells.Rational, piece);
      for (CellPiece& half : Bisect(lattice, planes, piece, LongestDirection(lattice, hull)))
      {
        const double bound = this->PieceBound(lattice, half);
        open.push({ bound, std::move(half) });
      }
    }
    return open.top().Bound;
  }

  const BernsteinCells& Cells;
  const CellMeasuresParams& Params;
  int Cell = 0;
  CellShape Shape = CellShape::Curve;
  CellDegree Degree{};
  int Dim = 1;
  int Components = 1;
  Eigen::MatrixXd Block;
  std::array<double, 3> Origin{};
  double Size = 1.0; ///< largest distance of a control point from the origin, by a coordinate
  std::map<std::pair<int, CellDegree>, Lattice> Lattices;
  std::map<std::pair<int, CellDegree>, std::vector<SideTable>> SideTables;
  CellLatticeTable CoefficientLattices;
  PatchRules Rules;
};

Status CheckMeasures(const BernsteinCells& cells, const CellMeasuresParams& params)
{
  Status status = cells.Check();
  if (!status)
  {
    return status;
  }
  if (cells.NumCells() == 0)
  {
    return { ErrorCode::EmptyInput, "there are no cells to measure" };
  }
  const int dim = NumParameters(cells.Shapes[0]);
  for (int c = 0; c < cells.NumCells(); ++c)
  {
    if (NumParameters(cells.Shapes[static_cast<std::size_t>(c)]) != dim)
    {
      return { ErrorCode::DimensionMismatch,
        "cell " + std::to_string(c) + " has another number of parameters than cell 0" };
    }
  }
  if (cells.NumComponents < dim || cells.NumComponents > 3)
  {
    return { ErrorCode::DimensionMismatch,
      "points have " + std::to_string(cells.NumComponents) + " components; " + std::to_string(dim) +
        " to 3 are needed" };
  }
  const auto outside = [](const char* name, const char* range)
  { return Status(ErrorCode::InvalidParameter, std::string(name) + " must lie in " + range); };
  if (!(params.Tolerance >= 1e-15 && params.Tolerance <= 1.0))
  {
    return outside("Tolerance", "[1e-15, 1]");
  }
  if (params.MaxDepth < 0 || params.MaxDepth > 60)
  {
    return outside("MaxDepth", "[0, 60]");
  }
  if (params.MaxPoints < 1)
  {
    return outside("MaxPoints", "[1, ...)");
  }
  if (params.SamplesPerEdge < 2 || params.SamplesPerEdge > 64)
  {
    return outside("SamplesPerEdge", "[2, 64]");
  }
  if (params.BoundBoxes < 0 || params.BoundBoxes > 65536)
  {
    return outside("BoundBoxes", "[0, 65536]");
  }
  if (params.Threads < 0)
  {
    return outside("Threads", "[0, ...)");
  }
  if (!params.ParametricVolumes.empty())
  {
    if (params.ParametricVolumes.size() != cells.Shapes.size())
    {
      return { ErrorCode::SizeMismatch, "ParametricVolumes must be empty or one a cell" };
    }
    for (const double v : params.ParametricVolumes)
    {
      if (!(v > 0.0 && std::isfinite(v)))
      {
        return outside("ParametricVolumes", "(0, infinity)");
      }
    }
  }
  return {};
}

/// Sum of the cells, and det J relative to its mean.
void Summarize(
  const BernsteinCells& cells, const CellMeasuresParams& params, CellMeasures& measures)
{
  CellMeasure& total = measures.Total;
  const auto volume = [&](std::size_t c)
  { return params.ParametricVolumes.empty() ? 1.0 : params.ParametricVolumes[c]; };
  double parametric = 0.0;
  double moments[3] = {};
  double samples = 0.0;
  total.ScaledMin = std::numeric_limits<double>::infinity();
  total.ScaledMax = -total.ScaledMin;
  total.UniformityMin = total.ScaledMin;
  total.UniformityMax = total.ScaledMax;
  total.ScaledLower = 1.0;
  for (std::size_t c = 0; c < measures.Cells.size(); ++c)
  {
    const CellMeasure& m = measures.Cells[c];
    const CellShape shape = cells.Shapes[c];
    total.Measure += m.Measure;
    total.MeasureError += m.MeasureError;
    total.Points += m.Points;
    total.Converged = total.Converged && m.Converged;
    if (m.Measure != 0.0)
    {
      for (std::size_t d = 0; d < 3; ++d)
      {
        moments[d] += m.Measure * m.Centroid[d];
      }
    }
    const double n = static_cast<double>(LatticePoints(shape, params.SamplesPerEdge).size());
    samples += n;
    total.ScaledMin = std::min(total.ScaledMin, m.ScaledMin);
    total.ScaledMax = std::max(total.ScaledMax, m.ScaledMax);
    total.ScaledMean += n * m.ScaledMean;
    total.ScaledLower = std::min(total.ScaledLower, m.ScaledLower);
    total.ConditionMax = std::max(total.ConditionMax, m.ConditionMax);
    total.ConditionMean += n * m.ConditionMean;
    const double reference = shape == CellShape::Tetrahedron      ? 1.0 / 6.0
      : shape == CellShape::Triangle || shape == CellShape::Wedge ? 0.5
                                                                  : 1.0;
    parametric += volume(c) * reference;
  }
  total.ScaledMean /= samples;
  total.ConditionMean /= samples;
  for (std::size_t d = 0; d < 3; ++d)
  {
    total.Centroid[d] = total.Measure != 0.0 && static_cast<int>(d) < cells.NumComponents
      ? moments[d] / total.Measure
      : std::numeric_limits<double>::quiet_NaN();
  }
  const double mean = total.Measure / parametric;
  for (std::size_t c = 0; c < measures.Cells.size(); ++c)
  {
    CellMeasure& m = measures.Cells[c];
    m.UniformityMin /= mean * volume(c);
    m.UniformityMax /= mean * volume(c);
    if (m.UniformityMin > m.UniformityMax)
    {
      std::swap(m.UniformityMin, m.UniformityMax); // a negative mean turns the order round
    }
    total.UniformityMin = std::min(total.UniformityMin, m.UniformityMin);
    total.UniformityMax = std::max(total.UniformityMax, m.UniformityMax);
  }
}
}

Result<CellMeasures> MeasureCells(const BernsteinCells& cells, const CellMeasuresParams& params)
{
  Status status = CheckMeasures(cells, params);
  if (!status)
  {
    return status;
  }
  CellMeasures measures;
  measures.Cells.resize(cells.Shapes.size());
  ParallelFor(measures.Cells.size(), 64, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      CellMeasurer measurer(cells, params);
      for (std::size_t c = begin; c < end; ++c)
      {
        measures.Cells[c] = measurer.Measure(static_cast<int>(c));
      }
    });
  Summarize(cells, params, measures);
  return measures;
}
}
