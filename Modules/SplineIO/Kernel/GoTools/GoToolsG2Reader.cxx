// SPDX-License-Identifier: BSD-3-Clause
#include "GoToolsG2.h"

#include "GoToolsLR.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
constexpr long long MaxInt = std::numeric_limits<int>::max();
constexpr int MaxComponents = MaxG2Components;
constexpr int CurveClass = 100;
constexpr int SurfaceClass = 200;
constexpr int BoundedClass = 210;
constexpr int LRSurfaceClass = 293;
constexpr int PointCloudClass = 400;
constexpr int VolumeClass = 700;

struct KnownClass
{
  int Id;
  const char* Name;
};
constexpr KnownClass ReadableClasses[] = { { CurveClass, "spline curves" },
  { SurfaceClass, "surfaces" }, { BoundedClass, "bounded surfaces" },
  { LRSurfaceClass, "LR surfaces" }, { PointCloudClass, "point clouds" },
  { VolumeClass, "volumes" } };
constexpr KnownClass OtherClasses[] = { { 110, "CurveOnSurface" }, { 120, "Line" },
  { 130, "Circle" }, { 140, "Ellipse" }, { 250, "Plane" }, { 260, "Cylinder" }, { 270, "Sphere" },
  { 280, "Cone" }, { 290, "Torus" }, { 410, "LineCloud" } };

/// The class of that number; null without.
template <std::size_t N>
const KnownClass* FindClass(const KnownClass (&classes)[N], long long id)
{
  const auto found = std::find_if(std::begin(classes), std::end(classes),
    [&](const KnownClass& known) { return known.Id == id; });
  return found == std::end(classes) ? nullptr : found;
}

std::string NamesOfReadableClasses()
{
  std::string names;
  for (const KnownClass& known : ReadableClasses)
  {
    names += names.empty() ? "" : &known == std::end(ReadableClasses) - 1 ? " and " : ", ";
    names += std::string(known.Name) + " (" + std::to_string(known.Id) + ")";
  }
  return names;
}

class G2Parser : private G2Words
{
public:
  explicit G2Parser(std::string_view text) : G2Words(text) {}

  Result<SplineFile> ReadSplines()
  {
    SplineFile file;
    std::vector<double> coordinates;
    if (!this->ReadObjects(file, coordinates))
    {
      return this->Outcome;
    }
    if (file.Splines.empty())
    {
      return { ErrorCode::EmptyInput,
        coordinates.empty() ? "the g2 text holds no object"
                            : "the g2 text holds points only; read it as a point cloud" };
    }
    if (!coordinates.empty())
    {
      file.LeftOut.push_back(std::to_string(coordinates.size() / 3) +
        " points of point clouds (400) are left out; they are read as a point cloud");
    }
    return file;
  }

  Result<PointFile> ReadPoints()
  {
    SplineFile file;
    std::vector<double> coordinates;
    if (!this->ReadObjects(file, coordinates))
    {
      return this->Outcome;
    }
    if (coordinates.empty())
    {
      return { ErrorCode::EmptyInput, "the g2 text holds no point cloud (400)" };
    }
    PointFile points;
    points.Points = Eigen::Map<const PointMatrix>(
      coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3);
    points.Channels.resize(points.Points.rows(), 0);
    points.Groups = std::move(this->Groups);
    if (!file.Splines.empty())
    {
      points.LeftOut.push_back(std::to_string(file.Splines.size()) +
        " splines are left out; a reader of splines takes them");
    }
    return points;
  }

private:
  /// @param coordinates  of all point clouds, three a point.
  bool ReadObjects(SplineFile& file, std::vector<double>& coordinates)
  {
    while (this->Outcome && !this->Words.AtEnd())
    {
      this->ReadObject(file, coordinates);
    }
    return static_cast<bool>(this->Outcome);
  }

  void ReadObject(SplineFile& file, std::vector<double>& coordinates)
  {
    const long long id = this->Integer("class of an object", 0, MaxInt);
    if (const KnownClass* other = FindClass(OtherClasses, id); this->Outcome && other)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "an object of class " + std::to_string(id) + " (" + other->Name +
          ") cannot be read; keep only " + NamesOfReadableClasses());
    }
    if (this->Outcome && !FindClass(ReadableClasses, id))
    {
      this->Fail(ErrorCode::InvalidFormat,
        "an object has class " + std::to_string(id) + "; classes that can be read are " +
          NamesOfReadableClasses() +
          "; this is no g2 file, or the object before has more numbers than it says");
    }
    this->Integer("major version", 0, MaxInt);
    this->Integer("minor version", 0, MaxInt);
    const long long auxiliary = this->Integer("number of auxiliary integers", 0, MaxInt);
    std::array<long long, 4> color{};
    for (long long i = 0; i < auxiliary && this->Outcome; ++i)
    {
      const long long number = this->Integer("auxiliary integer",
        std::numeric_limits<long long>::min(), std::numeric_limits<long long>::max());
      color[static_cast<std::size_t>(std::min(i, 3LL))] = number;
    }
    if (this->Outcome)
    {
      id == CurveClass          ? this->Keep(file, this->ReadSpline<1>())
        : id == SurfaceClass    ? this->Keep(file, this->ReadSpline<2>())
        : id == BoundedClass    ? this->ReadBounded(file)
        : id == LRSurfaceClass  ? this->Keep(file, ReadLRSurface(*this))
        : id == PointCloudClass ? this->ReadCloud(auxiliary == 4, color, coordinates)
                                : this->Keep(file, this->ReadSpline<3>());
    }
  }

  void ReadCloud(
    bool colored, const std::array<long long, 4>& color, std::vector<double>& coordinates)
  {
    const long long count = this->Integer("number of points", 0, MaxInt);
    if (this->Outcome &&
      3.0 * static_cast<double>(count) > static_cast<double>(this->Words.Remaining()))
    {
      this->Fail(ErrorCode::InvalidFormat,
        "the text is too short for " + std::to_string(count) +
          " points; the file is truncated or its count is too large");
    }
    PointGroup group;
    group.Begin = static_cast<Eigen::Index>(coordinates.size() / 3);
    group.HasColor = colored;
    for (std::size_t i = 0; colored && i < 4 && this->Outcome; ++i)
    {
      group.Color[i] = static_cast<int>(color[i]);
      if (color[i] < 0 || color[i] > 255)
      {
        this->Fail(ErrorCode::InvalidFormat,
          "the colour of a point cloud has the share " + std::to_string(color[i]) +
            ", outside 0 to 255");
      }
    }
    if (this->Outcome && count > 0)
    {
      this->Groups.push_back(group);
      coordinates.reserve(coordinates.size() + 3 * static_cast<std::size_t>(count));
    }
    for (long long i = 0; i < 3 * count && this->Outcome; ++i)
    {
      coordinates.push_back(this->Real<double>("coordinate of a point"));
    }
  }

  std::vector<PointGroup> Groups;

  KnotVector ReadBasis()
  {
    const long long count = this->Integer("number of basis functions", 1, MaxInt);
    const long long order =
      this->Integer("order of a basis", 2, MaxDegree + 1, ErrorCode::InvalidDegree);
    if (this->Outcome && count < order)
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::to_string(count) + " basis functions of order " + std::to_string(order) +
          "; there must be at least as many as the order");
    }
    std::vector<double> knots;
    for (long long i = 0; i < count + order && this->Outcome; ++i)
    {
      knots.push_back(this->Real<double>("knot"));
    }
    if (!this->Outcome)
    {
      return {};
    }
    Result<KnotVector> made = KnotVector::Create(static_cast<int>(order) - 1, std::move(knots));
    if (!made)
    {
      this->Fail(made.Status.Code, "end of a knot vector: " + made.Status.Detail);
    }
    return made.Value;
  }

  void ReadBounded(SplineFile& file)
  {
    const long long id = this->Integer("class of the surface that is bounded", 0, MaxInt);
    if (this->Outcome && id != SurfaceClass && id != LRSurfaceClass)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "a bounded surface of class " + std::to_string(id) +
          " cannot be read; its surface must be of class 200 or 293");
    }
    if (!this->Outcome)
    {
      return;
    }
    BoundedSurface bounded;
    bounded.Spline = static_cast<int>(file.Splines.size());
    this->Keep(file, id == SurfaceClass ? this->ReadSpline<2>() : ReadLRSurface(*this));
    const long long loops = this->Integer("number of loops", 0, MaxInt);
    for (long long l = 0; l < loops && this->Outcome; ++l)
    {
      SurfaceLoop loop;
      const long long curves = this->Integer("number of curves of a loop", 1, MaxInt);
      loop.Tolerance = this->Real<double>("tolerance of a loop");
      for (long long c = 0; c < curves && this->Outcome; ++c)
      {
        loop.Curves.push_back(this->ReadBoundaryCurve());
      }
      bounded.Loops.push_back(std::move(loop));
    }
    if (this->Outcome)
    {
      file.Bounded.push_back(std::move(bounded));
    }
  }

  LoopCurve ReadBoundaryCurve()
  {
    LoopCurve curve;
    curve.PreferParameter = this->Integer("preference of a boundary curve", 0, 1) == 1;
    const bool inPlane = this->HasCurve("class of a curve in the parameter plane");
    const bool inSpace = this->HasCurve("class of a curve in space");
    if (this->Outcome && !inPlane && !inSpace)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "a boundary curve is neither in the parameter plane nor in space");
    }
    curve.Parameter = inPlane ? this->ReadBoundary(2) : Spline<1>();
    curve.Space = inSpace ? this->ReadBoundary(3) : Spline<1>();
    return curve;
  }

  /// 0 is none, 1 what older files have for 100.
  bool HasCurve(const char* meaning)
  {
    const long long id = this->Integer(meaning, 0, MaxInt);
    if (this->Outcome && id != 0 && id != 1 && id != CurveClass)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "a boundary curve of class " + std::to_string(id) +
          " cannot be read; make it a spline curve (100)");
    }
    return id != 0;
  }

  Spline<1> ReadBoundary(int components)
  {
    Spline<1> curve = this->ReadSpline<1>();
    if (this->Outcome && curve.NumComponents() != components)
    {
      this->Fail(ErrorCode::DimensionMismatch,
        "end of a boundary curve: it has " + std::to_string(curve.NumComponents()) +
          " coordinates where " + std::to_string(components) + " are needed");
    }
    return curve;
  }

  /// @return an empty spline when Outcome tells of a failure.
  template <int Dim>
  Spline<Dim> ReadSpline()
  {
    const auto components = static_cast<Eigen::Index>(this->Integer("dimension", 1, MaxComponents));
    const bool rational = this->Integer("rational flag", 0, 1) == 1;
    std::array<KnotVector, Dim> knots;
    double functions = 1.0;
    for (KnotVector& direction : knots)
    {
      direction = this->ReadBasis();
      functions *= direction.NumFunctions();
    }
    const Eigen::Index columns = components + (rational ? 1 : 0);
    if (this->Outcome &&
      functions * static_cast<double>(columns) > static_cast<double>(this->Words.Remaining()))
    {
      this->Fail(ErrorCode::InvalidFormat,
        "the text is too short for the control points of its bases; the file is truncated or its "
        "counts are too large");
    }
    if (!this->Outcome)
    {
      return {};
    }
    const auto rows = static_cast<Eigen::Index>(functions);
    Spline<Dim> spline;
    spline.ControlPoints.resize(rows, components);
    spline.Weights.resize(rational ? rows : 0);
    for (Eigen::Index i = 0; i < rows && this->Outcome; ++i)
    {
      rational ? this->ReadRationalRow(spline, i) : this->ReadRow(spline, i);
    }
    if (!this->Outcome)
    {
      return {};
    }
    Result<SplineSpacePtr<Dim>> space = MakeTensorSpace<Dim>(knots);
    if (!space)
    {
      this->Fail(space.Status.Code, space.Status.Detail);
      return {};
    }
    spline.Space = space.Value;
    if (Status status = spline.Check(); !status)
    {
      this->Fail(status.Code, "end of an object: " + status.Detail);
      return {};
    }
    return spline;
  }

  template <int Dim>
  void Keep(SplineFile& file, Spline<Dim> spline)
  {
    if (!this->Outcome)
    {
      return;
    }
    if (Status status = spline.Check(); !status)
    {
      this->Fail(status.Code, "end of an object: " + status.Detail);
      return;
    }
    file.Ids.push_back(static_cast<int>(file.Splines.size()));
    file.Splines.emplace_back(std::move(spline));
  }

  template <int Dim>
  void ReadRow(Spline<Dim>& spline, Eigen::Index row)
  {
    for (Eigen::Index c = 0; c < spline.ControlPoints.cols() && this->Outcome; ++c)
    {
      spline.ControlPoints(row, c) = this->Real<double>("coordinate of a control point");
    }
  }

  template <int Dim>
  void ReadRationalRow(Spline<Dim>& spline, Eigen::Index row)
  {
    std::array<long double, MaxComponents> product{};
    const auto columns = static_cast<std::size_t>(spline.ControlPoints.cols());
    for (std::size_t c = 0; c < columns && this->Outcome; ++c)
    {
      product[c] = this->Real<long double>("coordinate of a control point");
    }
    const double weight = this->Real<double>("weight");
    if (this->Outcome && !(weight > 0.0))
    {
      this->Fail(ErrorCode::InvalidWeight,
        "the weight of control point " + std::to_string(row) + " is not positive");
    }
    if (!this->Outcome)
    {
      return;
    }
    spline.Weights[row] = weight;
    for (std::size_t c = 0; c < columns; ++c)
    {
      spline.ControlPoints(row, static_cast<Eigen::Index>(c)) = Quotient(product[c], weight);
    }
    if (!spline.ControlPoints.row(row).allFinite())
    {
      this->Fail(ErrorCode::NonFiniteInput,
        "control point " + std::to_string(row) + " divided by its weight is not finite");
    }
  }
};
}

bool LooksLikeG2(std::string_view beginning)
{
  WordScanner words(beginning);
  std::array<long long, 4> header{};
  for (long long& number : header)
  {
    if (!ParseInteger(words.Next(), 0, 9999, number))
    {
      return false;
    }
  }
  return FindClass(ReadableClasses, header[0]) || FindClass(OtherClasses, header[0]);
}

Result<SplineFile> ReadG2(std::string_view text)
{
  return G2Parser(text).ReadSplines();
}

Result<PointFile> ReadG2Points(std::string_view text)
{
  return G2Parser(text).ReadPoints();
}

bool BeginsWithG2Points(std::string_view beginning)
{
  long long id = 0;
  return LooksLikeG2(beginning) &&
    ParseInteger(WordScanner(beginning).Next(), PointCloudClass, PointCloudClass, id);
}
}
