// SPDX-License-Identifier: BSD-3-Clause
#include "ChartCases.h"
#include "ClosestDeviation.h"

#include <knotwork/SplineCore/TriangleIndex.h>
#include <knotwork/SurfaceTrimming/TrimSurface.h>

#include <gtest/gtest.h>
#include <random>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// Charts with their surfaces, bounded by equal parameters.
struct Case
{
  std::vector<ChartMesh> Charts;
  std::vector<TrimmedFace> Faces;
  std::vector<ChartDeviation> Deviations;

  void Add(ChartMesh chart, Spline<2> surface)
  {
    auto deviation = BoundDeviation(chart, surface);
    ASSERT_TRUE(deviation) << deviation.Status.Message();
    this->Deviations.push_back(std::move(deviation.Value));
    this->Charts.push_back(std::move(chart));
    this->Faces.emplace_back();
    this->Faces.back().Surface = std::move(surface);
  }

  double Bound() const
  {
    double bound = 0.0;
    for (const ChartDeviation& deviation : this->Deviations)
    {
      bound = std::max(bound, deviation.MaxBound);
    }
    return bound;
  }

  double Found() const
  {
    double found = 0.0;
    for (const ChartDeviation& deviation : this->Deviations)
    {
      found = std::max(found, deviation.MaxFound);
    }
    return found;
  }
};

/// Triangles of all charts, each cut into parts^2, with points of the mesh or of the surfaces.
struct Sampled
{
  PointMatrix Points;
  std::vector<MeshTriangle> Triangles;
};
Sampled Sample(const std::vector<ChartMesh>& charts, const std::vector<TrimmedFace>& faces,
  int parts, bool ofSurface)
{
  Sampled sampled;
  std::vector<Eigen::RowVector3d> points;
  for (std::size_t c = 0; c < charts.size(); ++c)
  {
    const BezierForm<2> form = MakeBezierForm<2>(faces[c].Surface, 1);
    for (const auto& corners : charts[c].Triangles)
    {
      std::vector<std::vector<int>> number(static_cast<std::size_t>(parts) + 1);
      PointMatrix uv((parts + 1) * (parts + 2) / 2, 2);
      PointMatrix x(uv.rows(), 3);
      Eigen::Index row = 0;
      for (int j = 0; j <= parts; ++j)
      {
        for (int i = 0; i + j <= parts; ++i)
        {
          const double a = static_cast<double>(i) / parts;
          const double b = static_cast<double>(j) / parts;
          const auto combine = [&](const PointMatrix& at) -> Eigen::RowVectorXd {
            return (1.0 - a - b) * at.row(corners[0]) + a * at.row(corners[1]) +
              b * at.row(corners[2]);
          };
          number[static_cast<std::size_t>(j)].push_back(
            static_cast<int>(points.size()) + static_cast<int>(row));
          uv.row(row) = combine(charts[c].UV);
          x.row(row++) = combine(charts[c].Points);
        }
      }
      EvaluationBatch batch;
      EXPECT_TRUE(EvaluateParameters<2>(form, uv, { 0, 1 }, batch));
      for (Eigen::Index k = 0; k < row; ++k)
      {
        points.emplace_back(ofSurface ? batch.Values.row(k) : x.row(k));
      }
      for (std::size_t j = 0; j + 1 < number.size(); ++j)
      {
        for (std::size_t i = 0; i + 1 < number[j].size(); ++i)
        {
          sampled.Triangles.push_back({ number[j][i], number[j][i + 1], number[j + 1][i] });
          if (i + 1 < number[j + 1].size())
          {
            sampled.Triangles.push_back(
              { number[j][i + 1], number[j + 1][i + 1], number[j + 1][i] });
          }
        }
      }
    }
  }
  sampled.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    sampled.Points.row(static_cast<Eigen::Index>(k)) = points[k];
  }
  return sampled;
}

/// Largest distance of rows from a triangulation.
double LargestDistance(const PointMatrix& from, const TriangleIndex<3>& to)
{
  double largest = 0.0;
  for (Eigen::Index k = 0; k < from.rows(); ++k)
  {
    const Eigen::RowVector3d point = from.row(k);
    largest = std::max(largest, to.Nearest(point.data()).SquaredDistance);
  }
  return std::sqrt(largest);
}

/// Distance of mesh and surfaces, both ways, of dense points.
double SampledDistance(
  const std::vector<ChartMesh>& charts, const std::vector<TrimmedFace>& faces, int parts = 8)
{
  const Sampled mesh = Sample(charts, faces, parts, false);
  const Sampled surface = Sample(charts, faces, parts, true);
  const TriangleIndex<3> toMesh(mesh.Points, mesh.Triangles);
  const TriangleIndex<3> toSurface(surface.Points, surface.Triangles);
  return std::max(LargestDistance(mesh.Points, toSurface), LargestDistance(surface.Points, toMesh));
}

/// Cells [first, last) x [0, n) of the unit square's n x n.
ChartMesh Columns(int n, int first, int last, const Place3& lift)
{
  GridChart grid;
  grid.Columns = grid.Rows = n;
  grid.Plane = [n](int i, int j)
  { return Eigen::RowVector2d(static_cast<double>(i) / n, static_cast<double>(j) / n); };
  grid.Lift = lift;
  grid.Keep = [=](int i, int) { return i >= first && i < last; };
  return grid.Make();
}

/// The place slides along the surface inside of the unit square, not on its boundary.
Place3 Slide(double size, const Place3& place)
{
  const double pi = std::acos(-1.0);
  return [=](double u, double v)
  { return place(u + size * std::sin(2.0 * pi * u) * std::sin(pi * v), v); };
}

void Refine(Case& data, double enough)
{
  ClosestDeviationParams params;
  params.Enough = enough;
  const Status status = RefineDeviations(data.Charts, data.Faces, params, data.Deviations);
  ASSERT_TRUE(status) << status.Message();
}

TEST(ClosestDeviation, SlidingInAPlaneIsNoDistance_ExactOracle)
{
  Case data;
  const ChartMesh chart = Columns(12, 0, 12, Flat);
  data.Add(chart, InterpolatingSurface(Slide(0.06, Flat), 3, 12, BoxOf(chart)));
  EXPECT_GT(data.Bound(), 0.05);
  Refine(data, 6e-3);
  EXPECT_LE(data.Bound(), 6e-3);
  EXPECT_GE(data.Bound(), data.Found());
  EXPECT_LE(data.Deviations[0].PointDeviation.maxCoeff(), 6e-3);
}

TEST(ClosestDeviation, BoundsAreWithinTwiceTheSampledDistance_CrossOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const double slide = 0.02 + 0.06 * number(random);
    const double height = 0.002 + 0.02 * number(random);
    const double phase = 6.0 * number(random);
    const Place3 wavy = [=](double u, double v)
    {
      Eigen::RowVector3d x = Saddle(u, v);
      x[2] += height * std::sin(7.0 * u + phase) * std::cos(5.0 * v);
      return x;
    };
    Case data;
    const int n = 10;
    const bool two = seed % 2 == 0; // charts with a common border
    for (const auto& [first, last] : two
        ? std::vector<std::array<int, 2>>{ { 0, n / 2 }, { n / 2, n } }
        : std::vector<std::array<int, 2>>{ { 0, n } })
    {
      const ChartMesh chart = Columns(n, first, last, Saddle);
      data.Add(chart, InterpolatingSurface(Slide(slide, wavy), 3, 14, BoxOf(chart)));
    }
    const double equal = data.Bound();
    Refine(data, 1e-6);
    const double truth = SampledDistance(data.Charts, data.Faces);
    EXPECT_LT(data.Bound(), equal);
    EXPECT_GE(data.Bound(), truth);
    EXPECT_LE(data.Bound(), 2.0 * truth);
    EXPECT_LE(data.Found(), data.Bound());
    for (const ChartDeviation& deviation : data.Deviations)
    {
      EXPECT_TRUE((deviation.TriangleFound.array() <= deviation.TriangleBound.array()).all());
      EXPECT_EQ(deviation.MaxBound, deviation.TriangleBound.maxCoeff());
    }
  }
}

/// Numbers of single points and triangles, not the largest ones alone.
TEST(ClosestDeviation, NoNumberIsSmallerThanTheSampledDistance_CrossOracle)
{
  constexpr double Sag = 3e-5; // of triangles whose corners are the samples of the surface, at most
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const double slide = 0.03 + 0.05 * number(random);
    const double height = 0.005 + 0.02 * number(random);
    const double phase = 6.0 * number(random);
    const Place3 wavy = [=](double u, double v)
    {
      Eigen::RowVector3d x = Saddle(u, v);
      x[2] += height * std::sin(9.0 * u + phase) * std::cos(8.0 * v + phase);
      return x;
    };
    Case data;
    for (const auto& [first, last] : std::vector<std::array<int, 2>>{ { 0, 4 }, { 4, 8 } })
    {
      const ChartMesh chart = Columns(8, first, last, Saddle);
      data.Add(chart, InterpolatingSurface(Slide(slide, wavy), 3, 14, BoxOf(chart)));
    }
    Refine(data, 1e-6);
    const Sampled mesh = Sample(data.Charts, data.Faces, 1, false);
    const Sampled surface = Sample(data.Charts, data.Faces, 24, true);
    const TriangleIndex<3> toMesh(mesh.Points, mesh.Triangles);
    const TriangleIndex<3> toSurface(surface.Points, surface.Triangles);
    for (std::size_t c = 0; c < data.Charts.size(); ++c)
    {
      const ChartDeviation& deviation = data.Deviations[c];
      for (Eigen::Index k = 0; k < data.Charts[c].Points.rows(); ++k)
      {
        EXPECT_GE(deviation.PointDeviation[k] + Sag,
          LargestDistance(PointMatrix(data.Charts[c].Points.row(k)), toSurface));
      }
      for (std::size_t t = 0; t < data.Charts[c].Triangles.size(); ++t)
      {
        ChartMesh one = data.Charts[c];
        one.Triangles = { data.Charts[c].Triangles[t] };
        const std::vector<TrimmedFace> face{ data.Faces[c] };
        const double bound = deviation.TriangleBound[static_cast<Eigen::Index>(t)];
        EXPECT_GE(bound + Sag, LargestDistance(Sample({ one }, face, 12, false).Points, toSurface));
        EXPECT_GE(bound, LargestDistance(Sample({ one }, face, 12, true).Points, toMesh));
      }
    }
  }
}

/// A rectangle of the plane, one side of which has a point that lies beside it by next to nothing.
ChartMesh WithNeedle(double height, double angle, const Eigen::RowVector2d& offset)
{
  Eigen::Matrix<double, 5, 2> places;
  places << 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.37, height;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  ChartMesh chart;
  chart.UV = (places * turn).rowwise() + offset;
  chart.Points = PointMatrix::Zero(5, 3);
  chart.Points.leftCols(2) = chart.UV;
  chart.Triangles = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } };
  return chart;
}

/// The mesh lies in one of two planes of surfaces, the other one is at a height and slides along
/// itself: nothing of it is nearer, whatever way the rounding of corners turns a needle.
TEST(ClosestDeviation, RoundingOfNeedlesLowersNoBound_ExactOracle)
{
  constexpr double Height = 0.02;
  int tried = 0;
  for (unsigned seed = 1; seed <= 80; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const double least = std::pow(10.0, -17.0 + 3.0 * number(random));
    const double far = seed % 4 == 0 ? 40.0 : 0.0;
    const ChartMesh chart = WithNeedle(seed % 2 == 0 ? 1e-13 : least, 6.0 * number(random),
      Eigen::RowVector2d(far * number(random), far * number(random)));
    if (!chart.Check())
    {
      continue; // rounding has turned the needle over: no chart
    }
    ++tried;
    const double slide = 0.05 + 0.1 * number(random);
    const auto plane = [=](double u, double v)
    {
      return Eigen::RowVector3d(
        u + slide * std::sin(5.0 * u), v + slide * std::cos(4.0 * v), Height);
    };
    Case data;
    data.Add(chart, InterpolatingSurface(plane, 3, 4, BoxOf(chart)));
    data.Add(chart, InterpolatingSurface(Flat, 1, 1, BoxOf(chart)));
    EXPECT_GE(data.Deviations[0].TriangleBound.minCoeff(), Height);
    Refine(data, 1e-3);
    EXPECT_GE(data.Deviations[0].TriangleBound.minCoeff(), Height);
    EXPECT_TRUE(std::isfinite(data.Bound()));
  }
  EXPECT_GE(tried, 40);
}

/// Each chart's bound holds for its own triangles: the surface of one has a bump that slides.
TEST(ClosestDeviation, ABumpStaysABump_ExactOracle)
{
  const Place3 bump = [](double u, double v)
  {
    const double r = ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5)) / 0.02;
    return Eigen::RowVector3d(u + 0.08 * std::exp(-r), v, 0.05 * std::exp(-r));
  };
  Case data;
  const ChartMesh chart = Columns(12, 0, 12, Flat);
  data.Add(chart, InterpolatingSurface(bump, 3, 24, BoxOf(chart)));
  EXPECT_GT(data.Bound(), 0.09);
  Refine(data, 1e-3);
  EXPECT_GE(data.Bound(), 0.0499);
  EXPECT_LE(data.Bound(), 1.15 * 0.05);
}

TEST(ClosestDeviation, TheMeshIsProvedToBeNearAnyFace_ExactOracle)
{
  // the surface of the left half ends before its chart does; that of the right one reaches over it
  const auto squeezed = [](double u, double v)
  { return Eigen::RowVector3d(u - 0.1 * std::max(0.0, u - 0.25), v, 0.0); };
  Case data;
  const ChartMesh left = Columns(12, 0, 6, Flat);
  ChartMesh right = Columns(12, 6, 12, Flat);
  data.Add(left, InterpolatingSurface(squeezed, 1, 44, BoxOf(left)));
  const auto drawn = [](double u, double v) { return Eigen::RowVector3d(1.1 * u - 0.1, v, 0.0); };
  data.Add(right, InterpolatingSurface(drawn, 1, 2, BoxOf(right)));
  EXPECT_GT(data.Bound(), 0.024);
  Refine(data, 5e-3);
  EXPECT_LE(data.Bound(), 5e-3);
}

TEST(ClosestDeviation, WhatIsEnoughStaysAsItIs_ExactOracle)
{
  Case data;
  const ChartMesh chart = Columns(6, 0, 6, Saddle);
  data.Add(chart, InterpolatingSurface(Slide(0.03, Saddle), 3, 8, BoxOf(chart)));
  const Eigen::VectorXd before = data.Deviations[0].TriangleBound;
  Refine(data, data.Bound());
  EXPECT_TRUE(before == data.Deviations[0].TriangleBound);
  ClosestDeviationParams params;
  params.Enough = 1e-4;
  params.Progress = [](double) { return false; };
  EXPECT_EQ(
    RefineDeviations(data.Charts, data.Faces, params, data.Deviations).Code, ErrorCode::Aborted);
  params.Progress = {};
  params.MaxPieces = 0; // no time: the bounds that are known
  ASSERT_TRUE(RefineDeviations(data.Charts, data.Faces, params, data.Deviations));
  EXPECT_TRUE(before == data.Deviations[0].TriangleBound);
}

/// Nets that are too coarse, so that the tolerance is missed by far.
TEST(ClosestDeviation, TrimmedSurfacesAreNotWorseThanTwiceTheirDistance_CrossOracle)
{
  const double pi = std::acos(-1.0);
  const std::vector<std::pair<const char*, Place3>> places{
    { "roll",
      [](double u, double v)
      { return Eigen::RowVector3d(0.5 * std::cos(3.0 * u), 0.5 * std::sin(3.0 * u), v); } },
    { "book", [](double u, double v) { return Eigen::RowVector3d(u, v, std::abs(u - 0.5)); } },
    { "edge across",
      [](double u, double v)
      { return Eigen::RowVector3d(u, v, 0.7 * std::abs(u + 0.5 * v - 0.7)); } },
    { "waves",
      [=](double u, double v)
      { return Eigen::RowVector3d(u, v, 0.1 * std::sin(2.0 * pi * u) * std::sin(2.0 * pi * v)); } },
    { "box corner",
      [](double u, double v) { return Eigen::RowVector3d(u, v, std::min(std::min(u, v), 0.3)); } }
  };
  for (const auto& [name, place] : places)
  {
    for (const int elements : { 3, 6, 10 })
    {
      SCOPED_TRACE(std::string(name) + ", elements " + std::to_string(elements));
      const ChartMesh chart = Columns(12, 0, 12, place);
      TrimParams params;
      params.Tolerance = 1e-4;
      params.Triangulation = false;
      params.BackMap.Elements = elements;
      const auto trimmed = TrimSurface({ chart }, params);
      ASSERT_TRUE(trimmed) << trimmed.Status.Message();
      const double truth = SampledDistance({ chart }, trimmed->Model.Faces);
      EXPECT_GE(trimmed->MaxDeviation, truth);
      EXPECT_LE(trimmed->MaxDeviation, std::max(2.0 * truth, params.Tolerance));
    }
  }
}
}
