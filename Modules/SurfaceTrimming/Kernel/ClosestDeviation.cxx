// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestDeviation.h"

#include "DeviationSearch.h"

#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace knotwork
{
namespace
{
constexpr double Infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t MaxPartners = 12; // triangles that a piece is paired with, the nearest ones
constexpr int Steps = 4;                // of Gauss and Newton to a closest point
constexpr double RelativeGap = 0.05;    // of a pair's bound
/// Triangles of plane points that lie on a line are drawn towards their partner's corners by such a
/// share of the bound in space, so that a map onto them has an inverse.
constexpr double ShareOfBound = 0.01;
constexpr double LeastFlatness = 1e-9; // twice the area over the square of the longest side

using Corners = std::array<RealArray<3>, 3>;
using PlaneCorners = std::array<RealArray<2>, 3>;

double Distance(const RealArray<3>& a, const RealArray<3>& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

template <std::size_t Dim>
RealArray<static_cast<int>(Dim)> Combine(
  const std::array<std::array<double, Dim>, 3>& corners, const RealArray<2>& share)
{
  std::array<double, Dim> point{};
  for (std::size_t d = 0; d < Dim; ++d)
  {
    point[d] = (1.0 - share[0] - share[1]) * corners[0][d] + share[0] * corners[1][d] +
      share[1] * corners[2][d];
  }
  return point;
}

double Area(const PlaneCorners& uv)
{
  return (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
    (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
}

bool IsFlat(const PlaneCorners& uv)
{
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const double x = uv[(k + 1) % 3][0] - uv[k][0];
    const double y = uv[(k + 1) % 3][1] - uv[k][1];
    longest = std::max(longest, x * x + y * y);
  }
  return !(std::abs(Area(uv)) > LeastFlatness * longest);
}

/// A part of a triangle, of the mesh or in the plane.
struct Piece
{
  double Bound = 0.0;
  int Triangle = 0; ///< number among those of all charts
  bool OfSurface = false;
  PlaneCorners Shares{ { { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } } }; ///< of corners 1 and 2
  bool Bounded = false;                                                ///< by closest points
};

class Refinement
{
public:
  Refinement(const std::vector<ChartMesh>& charts, const std::vector<TrimmedFace>& faces,
    const ClosestDeviationParams& params, std::vector<ChartDeviation>& deviations)
    : Charts(charts), Faces(faces), Params(params), Deviations(deviations), Surfaces(charts.size())
  {
    for (std::size_t c = 0; c < charts.size(); ++c)
    {
      for (std::size_t t = 0; t < charts[c].Triangles.size(); ++t)
      {
        this->Places.push_back({ static_cast<int>(c), static_cast<int>(t) });
      }
    }
  }

  Status Run()
  {
    std::vector<int> flagged;
    for (std::size_t g = 0; g < this->Places.size(); ++g)
    {
      const ChartDeviation& deviation = this->DeviationOf(static_cast<int>(g));
      const double bound = deviation.TriangleBound[this->Places[g][1]];
      if (bound > this->Params.Enough)
      {
        flagged.push_back(static_cast<int>(g));
      }
      else
      {
        this->Found = std::max(this->Found, deviation.TriangleFound[this->Places[g][1]]);
      }
    }
    if (flagged.empty())
    {
      return {};
    }
    if (Status status = this->MakeTrees(); !status)
    {
      return status;
    }
    this->Settled.assign(this->Places.size(), 0.0);
    this->Met.assign(this->Places.size(), 0.0);
    this->Looked.assign(this->Places.size(), 0);
    for (int g : flagged)
    {
      for (const bool ofSurface : { false, true })
      {
        Piece piece;
        piece.Triangle = g;
        piece.OfSurface = ofSurface;
        piece.Bound =
          this->DeviationOf(g).TriangleBound[this->Places[static_cast<std::size_t>(g)][1]];
        this->Open.push_back(piece);
      }
    }
    if (Status status = this->Refine(); !status)
    {
      return status;
    }
    this->Store(flagged);
    return {};
  }

private:
  struct Surface
  {
    BezierForm<2> Form;
    std::unique_ptr<DeviationSearch> Search;
  };
  /// A triangle near a piece, with what is nearest to the piece's corners.
  struct Partner
  {
    int Triangle = -1;
    double Farthest = 0.0;
    std::array<TriangleFoot, 3> Feet;
  };

  ChartDeviation& DeviationOf(int g)
  {
    return this->Deviations[static_cast<std::size_t>(this->Places[static_cast<std::size_t>(g)][0])];
  }

  ChartTriangle TriangleOf(int g) const
  {
    const auto [c, t] = this->Places[static_cast<std::size_t>(g)];
    return CornersOf(this->Charts[static_cast<std::size_t>(c)], static_cast<std::size_t>(t));
  }

  Surface& SurfaceOf(int g)
  {
    const auto c = static_cast<std::size_t>(this->Places[static_cast<std::size_t>(g)][0]);
    Surface& surface = this->Surfaces[c];
    if (!surface.Search)
    {
      surface.Form = MakeBezierForm<2>(this->Faces[c].Surface, 1);
      surface.Search =
        std::make_unique<DeviationSearch>(surface.Form, RelativeGap, this->Params.Enough);
    }
    return surface;
  }

  /// Trees of all triangles, and of their corners' images on the surfaces.
  Status MakeTrees()
  {
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      EvaluationBatch batch;
      const BezierForm<2> form = MakeBezierForm<2>(this->Faces[c].Surface, this->Params.Threads);
      if (Status status =
            EvaluateParameters<2>(form, this->Charts[c].UV, { 0, this->Params.Threads }, batch);
          !status)
      {
        return status;
      }
      this->Images.push_back(std::move(batch.Values));
    }
    const auto n = static_cast<Eigen::Index>(this->Places.size());
    for (const bool ofSurface : { false, true })
    {
      PointMatrix lower(n, 3);
      PointMatrix upper(n, 3);
      for (Eigen::Index g = 0; g < n; ++g)
      {
        const Corners x = this->CornersOn(static_cast<int>(g), ofSurface);
        for (std::size_t d = 0; d < 3; ++d)
        {
          const auto column = static_cast<Eigen::Index>(d);
          lower(g, column) = std::min({ x[0][d], x[1][d], x[2][d] });
          upper(g, column) = std::max({ x[0][d], x[1][d], x[2][d] });
        }
      }
      this->Trees[ofSurface ? 1 : 0] = BoxTree(lower, upper);
    }
    return {};
  }

  /// Corners of a triangle, or their images on the surface.
  Corners CornersOn(int g, bool ofSurface) const
  {
    const auto [chart, t] = this->Places[static_cast<std::size_t>(g)];
    const auto c = static_cast<std::size_t>(chart);
    const PointMatrix& points = ofSurface ? this->Images[c] : this->Charts[c].Points;
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int row = this->Charts[c].Triangles[static_cast<std::size_t>(t)][k];
      corners[k] = { points(row, 0), points(row, 1), points(row, 2) };
    }
    return corners;
  }

  double Goal() const { return std::max(this->Params.Enough, this->Params.Ratio * this->Found); }

  Status Refine()
  {
    const auto less = [](const Piece& a, const Piece& b) { return a.Bound < b.Bound; };
    int count = 0;
    const auto add = [&](Piece& piece)
    {
      this->Bound(piece);
      ++count;
      this->Open.push_back(piece);
      std::push_heap(this->Open.begin(), this->Open.end(), less);
    };
    std::make_heap(this->Open.begin(), this->Open.end(), less);
    while (!this->Open.empty() && this->Open.front().Bound > this->Goal() &&
      count < this->Params.MaxPieces)
    {
      if (this->Params.Progress && count % 64 == 0 &&
        !this->Params.Progress(static_cast<double>(count) / this->Params.MaxPieces))
      {
        return { ErrorCode::Aborted, "while bounding distances" };
      }
      std::pop_heap(this->Open.begin(), this->Open.end(), less);
      Piece whole = this->Open.back();
      this->Open.pop_back();
      if (!whole.Bounded)
      {
        ++this->Looked[static_cast<std::size_t>(whole.Triangle)];
        add(whole);
        continue;
      }
      for (int part = 0; part < 4; ++part)
      {
        Piece piece = Quarter(whole, part);
        add(piece);
      }
    }
    for (const Piece& piece : this->Open)
    {
      const auto g = static_cast<std::size_t>(piece.Triangle);
      this->Settled[g] = std::max(this->Settled[g], piece.Bound);
    }
    return {};
  }

  static Piece Quarter(const Piece& whole, int part)
  {
    Piece piece = whole;
    const auto middle = [&](std::size_t a, std::size_t b)
    {
      return RealArray<2>{ 0.5 * (whole.Shares[a][0] + whole.Shares[b][0]),
        0.5 * (whole.Shares[a][1] + whole.Shares[b][1]) };
    };
    const PlaneCorners middles{ middle(1, 2), middle(2, 0), middle(0, 1) };
    if (part == 3)
    {
      piece.Shares = middles;
      return piece;
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto corner = static_cast<std::size_t>(part);
      piece.Shares[k] = k == corner ? whole.Shares[k] : middles[3 - k - corner];
    }
    return piece;
  }

  /// Lowers the bound of a piece by what its partners give.
  void Bound(Piece& piece)
  {
    const ChartTriangle whole = this->TriangleOf(piece.Triangle);
    ChartTriangle own;
    for (std::size_t k = 0; k < 3; ++k)
    {
      own.UV[k] = Combine(whole.UV, piece.Shares[k]);
      own.Points[k] = Combine(whole.Points, piece.Shares[k]);
    }
    Surface& surface = this->SurfaceOf(piece.Triangle);
    const Corners onSurface = this->Evaluate(surface.Form, own.UV, 0);
    RealArray<3> nearest; // distances of corners from partners
    double equal = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      nearest[k] = Distance(onSurface[k], own.Points[k]);
      equal = std::max(equal, nearest[k]);
    }
    // corners of parts are rounded, which may turn a needle over: its bound stays
    const bool hasPlace = Area(own.UV) > 0.0 && !IsFlat(own.UV);
    if (hasPlace && equal < piece.Bound)
    {
      piece.Bound = std::min(piece.Bound, surface.Search->Bound(own, equal).Bound);
    }
    const Corners& from = piece.OfSurface ? onSurface : own.Points;
    this->FindPartners(from, piece.OfSurface, piece.Bound);
    this->LookNearCorners(piece, own.Points, nearest);
    for (const Partner& partner : this->Partners)
    {
      ChartTriangle pair = own;
      RealArray<3> distances{};
      if (piece.OfSurface)
      {
        if (partner.Farthest >= piece.Bound)
        {
          break; // so are the others
        }
        const Corners x = this->TriangleOf(partner.Triangle).Points;
        for (std::size_t k = 0; k < 3; ++k)
        {
          pair.Points[k] = Combine(x, { partner.Feet[k].Second, partner.Feet[k].Third });
          distances[k] = Distance(onSurface[k], pair.Points[k]);
        }
      }
      else
      {
        pair.UV = this->Feet(partner, own.Points, distances);
      }
      double farthest = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        nearest[k] = std::min(nearest[k], distances[k]);
        farthest = std::max(farthest, distances[k]);
      }
      if ((hasPlace || !piece.OfSurface) && farthest < piece.Bound && piece.Bound > this->Goal())
      {
        piece.Bound = std::min(piece.Bound, this->BoundPair(piece, partner, pair, farthest));
      }
    }
    piece.Bounded = true;
    const double met = std::max({ nearest[0], nearest[1], nearest[2] });
    this->Found = std::max(this->Found, met);
    auto& metThere = this->Met[static_cast<std::size_t>(piece.Triangle)];
    metThere = std::max(metThere, met);
    this->KeepCorners(piece, nearest);
  }

  /// Lowers distances of corners to those from the partners that are nearest to each of them.
  /// Images of plane triangles are not flat: the surface may be farther than they are.
  void LookNearCorners(const Piece& piece, const Corners& points, RealArray<3>& nearest)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Partner& closest = this->Closest[k];
      if (closest.Triangle < 0)
      {
        continue;
      }
      RealArray<3> distances{};
      if (piece.OfSurface)
      {
        distances[k] = std::sqrt(closest.Feet[k].SquaredDistance);
      }
      else
      {
        this->Feet(closest, points, distances);
      }
      nearest[k] = std::min(nearest[k], distances[k]);
    }
  }

  double BoundPair(const Piece& piece, const Partner& partner, ChartTriangle& pair, double farthest)
  {
    if (!piece.OfSurface)
    {
      if (IsFlat(pair.UV))
      {
        const ChartTriangle other = this->TriangleOf(partner.Triangle);
        double size = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
        {
          size = std::max(size, Distance(other.Points[k], other.Points[(k + 1) % 3]));
        }
        const double share = std::min(0.5, ShareOfBound * piece.Bound / size);
        for (std::size_t k = 0; k < 3; ++k)
        {
          for (std::size_t d = 0; d < 2; ++d)
          {
            pair.UV[k][d] = (1.0 - share) * pair.UV[k][d] + share * other.UV[k][d];
          }
        }
        if (IsFlat(pair.UV))
        {
          return Infinite;
        }
      }
      if (Area(pair.UV) < 0.0)
      {
        std::swap(pair.UV[1], pair.UV[2]);
        std::swap(pair.Points[1], pair.Points[2]);
      }
    }
    const int of = piece.OfSurface ? piece.Triangle : partner.Triangle;
    // `farthest` is no value of a pair that has been drawn aside, but a bound below it is no use
    return this->SurfaceOf(of).Search->Bound(pair, farthest).Bound;
  }

  /// The triangles of the other side near all corners, nearest first, and that nearest to each one.
  void FindPartners(const Corners& from, bool ofSurface, double radius)
  {
    RealArray<3> lower;
    RealArray<3> upper;
    for (std::size_t d = 0; d < 3; ++d)
    {
      lower[d] = std::min({ from[0][d], from[1][d], from[2][d] }) - radius;
      upper[d] = std::max({ from[0][d], from[1][d], from[2][d] }) + radius;
    }
    this->Partners.clear();
    this->Closest = {};
    this->Trees[ofSurface ? 0 : 1].ForNear(lower.data(), upper.data(),
      [&](int g)
      {
        const Corners x = this->CornersOn(g, !ofSurface);
        Partner partner;
        partner.Triangle = g;
        for (std::size_t k = 0; k < 3; ++k)
        {
          partner.Feet[k] =
            ClosestOnTriangle<3>(x[0].data(), x[1].data(), x[2].data(), from[k].data(), g);
          const double distance = std::sqrt(partner.Feet[k].SquaredDistance);
          partner.Farthest = std::max(partner.Farthest, distance);
        }
        for (std::size_t k = 0; k < 3; ++k)
        {
          Partner& closest = this->Closest[k];
          if (closest.Triangle < 0 ||
            partner.Feet[k].SquaredDistance < closest.Feet[k].SquaredDistance)
          {
            closest = partner;
          }
        }
        this->Partners.push_back(partner);
      });
    std::sort(this->Partners.begin(), this->Partners.end(),
      [](const Partner& a, const Partner& b)
      { return a.Farthest != b.Farthest ? a.Farthest < b.Farthest : a.Triangle < b.Triangle; });
    this->Partners.resize(std::min(this->Partners.size(), MaxPartners));
  }

  /// Values, or tangents, of a surface at three points.
  Corners Evaluate(const BezierForm<2>& form, const PlaneCorners& uv, int derivatives)
  {
    this->Parameters.resize(3, 2);
    for (Eigen::Index k = 0; k < 3; ++k)
    {
      for (Eigen::Index d = 0; d < 2; ++d)
      {
        this->Parameters(k, d) = uv[static_cast<std::size_t>(k)][static_cast<std::size_t>(d)];
      }
    }
    EvaluateParameters<2>(form, this->Parameters, { derivatives, 1 }, this->Batch);
    Corners values;
    for (std::size_t k = 0; k < 3; ++k)
    {
      for (std::size_t d = 0; d < 3; ++d)
      {
        values[k][d] =
          this->Batch.Values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d));
      }
    }
    return values;
  }

  /// Parameters in the partner's plane triangle of points of its surface near three points: closest
  /// points of the triangle that is tangent where the last step led.
  PlaneCorners Feet(const Partner& partner, const Corners& points, RealArray<3>& distances)
  {
    const PlaneCorners uv = this->TriangleOf(partner.Triangle).UV;
    const BezierForm<2>& form = this->SurfaceOf(partner.Triangle).Form;
    PlaneCorners shares;
    PlaneCorners best;
    for (std::size_t k = 0; k < 3; ++k)
    {
      shares[k] = { partner.Feet[k].Second, partner.Feet[k].Third };
      distances[k] = Infinite;
    }
    for (int step = 0; step < Steps; ++step)
    {
      PlaneCorners at;
      for (std::size_t k = 0; k < 3; ++k)
      {
        at[k] = Combine(uv, shares[k]);
      }
      const Corners values = this->Evaluate(form, at, 1);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const double distance = Distance(values[k], points[k]);
        if (distance < distances[k])
        {
          distances[k] = distance;
          best[k] = at[k];
        }
        Corners tangent;
        for (std::size_t c = 0; c < 3; ++c)
        {
          for (std::size_t d = 0; d < 3; ++d)
          {
            const auto row = static_cast<Eigen::Index>(k);
            const auto column = static_cast<Eigen::Index>(d);
            tangent[c][d] = values[k][d] + (uv[c][0] - at[k][0]) * this->Batch.First(row, column) +
              (uv[c][1] - at[k][1]) * this->Batch.First(row, 3 + column);
          }
        }
        const TriangleFoot foot = ClosestOnTriangle<3>(
          tangent[0].data(), tangent[1].data(), tangent[2].data(), points[k].data());
        shares[k] = { foot.Second, foot.Third };
      }
    }
    return best;
  }

  /// Points of the mesh are as far as their closest points.
  void KeepCorners(const Piece& piece, const RealArray<3>& nearest)
  {
    if (piece.OfSurface)
    {
      return;
    }
    const auto [c, t] = this->Places[static_cast<std::size_t>(piece.Triangle)];
    const auto& corners =
      this->Charts[static_cast<std::size_t>(c)].Triangles[static_cast<std::size_t>(t)];
    const PlaneCorners ends = Piece().Shares;
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (piece.Shares[k] == ends[k])
      {
        double& distance = this->Deviations[static_cast<std::size_t>(c)].PointDeviation[corners[k]];
        distance = std::min(distance, nearest[k]);
      }
    }
  }

  void Store(const std::vector<int>& flagged)
  {
    for (int g : flagged)
    {
      const auto at = static_cast<std::size_t>(g);
      ChartDeviation& deviation = this->DeviationOf(g);
      double& bound = deviation.TriangleBound[this->Places[at][1]];
      double& found = deviation.TriangleFound[this->Places[at][1]];
      bound = std::min(bound, this->Settled[at]);
      found = std::min(bound, this->Looked[at] == 2 ? this->Met[at] : found);
    }
    for (ChartDeviation& deviation : this->Deviations)
    {
      deviation.MaxBound = deviation.TriangleBound.maxCoeff();
      deviation.MaxFound = deviation.TriangleFound.maxCoeff();
    }
  }

  const std::vector<ChartMesh>& Charts;
  const std::vector<TrimmedFace>& Faces;
  const ClosestDeviationParams& Params;
  std::vector<ChartDeviation>& Deviations;
  std::vector<std::array<int, 2>> Places; ///< chart and triangle
  std::vector<Surface> Surfaces;          ///< of charts, made when asked for
  std::vector<PointMatrix> Images;        ///< of charts' points on their surfaces
  std::array<BoxTree, 2> Trees;           ///< of triangles, and of their images
  std::vector<Piece> Open;                ///< heap, largest bound first
  std::vector<double> Settled;            ///< largest bound of a triangle's pieces
  std::vector<double> Met;                ///< largest distance found on them
  std::vector<char> Looked;               ///< how many of a triangle's two whole pieces
  double Found = 0.0;                     ///< on all triangles
  std::vector<Partner> Partners;          ///< of the piece that is looked at
  std::array<Partner, 3> Closest;         ///< to its corners, if any
  PointMatrix Parameters;
  EvaluationBatch Batch;
};
}

Status RefineDeviations(const std::vector<ChartMesh>& charts, const std::vector<TrimmedFace>& faces,
  const ClosestDeviationParams& params, std::vector<ChartDeviation>& deviations)
{
  return Refinement(charts, faces, params, deviations).Run();
}
}
