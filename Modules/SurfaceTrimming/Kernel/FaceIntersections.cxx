// SPDX-License-Identifier: BSD-3-Clause
#include "FaceIntersections.h"

#include "FacePieces.h"

#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double DefaultShare = 1e-3; ///< of the diagonal
constexpr double SpacingShare = 0.25; ///< of the tolerance, between points on edges
/// Of the tolerance: parts so small that still touch are an open place.
constexpr double LeastShare = 1.0 / 16.0;
constexpr int MostOpenPlaces = 64; ///< of a pair of faces
constexpr int NewtonSteps = 20;
/// Of the model's size: points that agree so coincide.
constexpr double Agreement = 1e-10;
/// Of the model's size: what a face meets itself with is farther away along the face.
constexpr double OwnDistance = 1e-6;
/// Distances from the points on edges are larger than those from edges by less than this factor.
constexpr double EdgeFactor = 1.1;
constexpr std::size_t PairsABatch = 32; ///< between questions for abort
constexpr double ShareOfShapes = 0.2;   ///< of the progress, before pairs are looked at

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

struct SearchParams
{
  double Tolerance = 0.0;
  double Size = 0.0; ///< of the model
  std::int64_t MaxPairs = 0;
};

/// The parts of two faces, or of one with itself.
class PairSearch
{
public:
  PairSearch(const FaceShape& first, const FaceShape& second, const SearchParams& params)
    : Shapes{ &first, &second }, Params(params), IsOwn(&first == &second)
  {
    this->Pieces[0].push_back(first.Root());
    if (!this->IsOwn)
    {
      this->Pieces[1].push_back(second.Root());
    }
  }

  std::int64_t NumPairs() const { return this->Count; }
  /// Nothing unless Verdict says so.
  const FaceMeeting& Meeting() const { return this->Found; }

  IntersectionVerdict Run()
  {
    std::vector<std::array<int, 2>> open{ { 0, 0 } };
    while (!open.empty())
    {
      const auto [a, b] = open.back();
      open.pop_back();
      if (++this->Count > this->Params.MaxPairs)
      {
        this->AddOpen(a, b);
        return IntersectionVerdict::Undecided;
      }
      if (this->AreTold(a, b))
      {
        continue;
      }
      // now and then a look for a point: what meets is mostly found long before the end
      const bool isSmall = std::max(this->Piece(0, a).Size(), this->Piece(1, b).Size()) <=
        LeastShare * this->Params.Tolerance;
      if (!this->IsSelf(a, b) && (isSmall || (this->Count & (this->Count - 1)) == 0) &&
        this->FindPoint(a, b))
      {
        return IntersectionVerdict::Found;
      }
      if (isSmall)
      {
        this->AddOpen(a, b);
        if (this->Found.OpenPlaces >= MostOpenPlaces)
        {
          return IntersectionVerdict::Undecided;
        }
        continue;
      }
      this->Push(a, b, open);
    }
    return this->Found.OpenPlaces > 0 ? IntersectionVerdict::Undecided
                                      : IntersectionVerdict::Absent;
  }

private:
  std::vector<FacePiece>& Tree(int side) { return this->Pieces[At(this->IsOwn ? 0 : side)]; }
  const FacePiece& Piece(int side, int k) { return this->Tree(side)[At(k)]; }
  bool IsSelf(int a, int b) const { return this->IsOwn && a == b; }

  static ParametricBox<2> Around(const FacePiece& a, const FacePiece& b)
  {
    ParametricBox<2> box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      box.Lower[d] = std::min(a.Parameters.Lower[d], b.Parameters.Lower[d]);
      box.Upper[d] = std::max(a.Parameters.Upper[d], b.Parameters.Upper[d]);
    }
    return box;
  }

  static bool DoTouch(const FacePiece& a, const FacePiece& b)
  {
    bool touch = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      touch = touch && a.Parameters.Lower[d] <= b.Parameters.Upper[d] &&
        b.Parameters.Lower[d] <= a.Parameters.Upper[d];
    }
    return touch;
  }

  /// Whether a slab of the one holds nothing of the other.
  bool AreApart(int side, const FacePiece& slab, const FacePiece& other) const
  {
    if (slab.Across.isZero() || other.Control.empty())
    {
      return false;
    }
    const Eigen::RowVectorXd heights =
      slab.Across.transpose() * this->Shapes[At(side)]->ControlPoints(other);
    const double slack = 1e-13 * this->Params.Size;
    return heights.minCoeff() > slab.Most + slack || heights.maxCoeff() < slab.Least - slack;
  }

  /// Whether all of a piece lies within the tolerance of one point on an edge.
  bool IsAtEdge(int side, const FacePiece& piece) const
  {
    const double size = piece.Size();
    return size <= 2.0 * this->Params.Tolerance &&
      this->Shapes[At(side)]->DistanceToEdges(0.5 * (piece.Lower + piece.Upper)) + 0.5 * size <=
      this->Params.Tolerance;
  }

  /// Whether two pieces are known to meet nowhere, or to be at edges.
  bool AreTold(int a, int b)
  {
    const FacePiece& first = this->Piece(0, a);
    const FacePiece& second = this->Piece(1, b);
    if (first.Place == RegionPlace::Outside || second.Place == RegionPlace::Outside)
    {
      return true;
    }
    if (this->IsSelf(a, b))
    {
      return this->Shapes[0]->IsSimple(first.Parameters) || this->IsAtEdge(0, first);
    }
    if ((first.Lower.array() > second.Upper.array()).any() ||
      (second.Lower.array() > first.Upper.array()).any() || this->AreApart(1, first, second) ||
      this->AreApart(0, second, first))
    {
      return true;
    }
    if (this->IsAtEdge(0, first) && this->IsAtEdge(1, second))
    {
      return true;
    }
    return this->IsOwn && DoTouch(first, second) &&
      this->Shapes[0]->IsSimple(Around(first, second));
  }

  void Divide(int side, int k)
  {
    if (this->Piece(side, k).Children < 0)
    {
      this->Shapes[At(side)]->Divide(k, this->Tree(side));
    }
  }

  void Push(int a, int b, std::vector<std::array<int, 2>>& open)
  {
    if (this->IsSelf(a, b))
    {
      this->Divide(0, a);
      const FacePiece& piece = this->Piece(0, a);
      for (int i = 0; i < piece.NumChildren; ++i)
      {
        for (int j = i; j < piece.NumChildren; ++j)
        {
          open.push_back({ piece.Children + i, piece.Children + j });
        }
      }
      return;
    }
    const int side = this->Piece(0, a).Size() >= this->Piece(1, b).Size() ? 0 : 1;
    this->Divide(side, side == 0 ? a : b);
    const FacePiece& piece = this->Piece(side, side == 0 ? a : b);
    for (int i = 0; i < piece.NumChildren; ++i)
    {
      const int child = piece.Children + i;
      open.push_back(side == 0 ? std::array<int, 2>{ child, b } : std::array<int, 2>{ a, child });
    }
  }

  static RealArray<2> Middle(const FacePiece& piece)
  {
    return { 0.5 * (piece.Parameters.Lower[0] + piece.Parameters.Upper[0]),
      0.5 * (piece.Parameters.Lower[1] + piece.Parameters.Upper[1]) };
  }

  void AddOpen(int a, int b)
  {
    if (this->Found.OpenPlaces++ == 0)
    {
      this->Found.Parameters = { Middle(this->Piece(0, a)), Middle(this->Piece(1, b)) };
      const Point3 at = this->Shapes[0]->Evaluate(this->Found.Parameters[0]).col(0);
      this->Found.Position = { at[0], at[1], at[2] };
    }
  }

  /// Newton's method for S(u, v) = T(s, t), of the steps the shortest in shares of the pieces.
  bool FindPoint(int a, int b)
  {
    std::array<RealArray<2>, 2> at{ Middle(this->Piece(0, a)), Middle(this->Piece(1, b)) };
    Eigen::Vector4d scale;
    for (int side = 0; side < 2; ++side)
    {
      const ParametricBox<2>& box = this->Piece(side, side == 0 ? a : b).Parameters;
      scale[2 * side] = box.Upper[0] - box.Lower[0];
      scale[2 * side + 1] = box.Upper[1] - box.Lower[1];
    }
    for (int step = 0; step < NewtonSteps; ++step)
    {
      const Eigen::Matrix3d first = this->Shapes[0]->Evaluate(at[0]);
      const Eigen::Matrix3d second = this->Shapes[1]->Evaluate(at[1]);
      const Point3 gap = first.col(0) - second.col(0);
      if (gap.norm() <= 0.01 * Agreement * this->Params.Size)
      {
        break;
      }
      Eigen::Matrix<double, 3, 4> jacobian;
      jacobian << first.col(1), first.col(2), -second.col(1), -second.col(2);
      jacobian = jacobian * scale.asDiagonal();
      const Eigen::Matrix3d normal = jacobian * jacobian.transpose() +
        1e-14 * jacobian.squaredNorm() * Eigen::Matrix3d::Identity();
      const Eigen::Vector4d move =
        scale.cwiseProduct(jacobian.transpose() * normal.partialPivLu().solve(gap));
      if (!move.allFinite())
      {
        return false;
      }
      for (std::size_t side = 0; side < 2; ++side)
      {
        const ParametricBox<2>& domain = this->Shapes[side]->Domain();
        for (std::size_t d = 0; d < 2; ++d)
        {
          at[side][d] = std::clamp(at[side][d] - move[static_cast<Eigen::Index>(2 * side + d)],
            domain.Lower[d], domain.Upper[d]);
        }
      }
    }
    return this->IsMeeting(at);
  }

  bool IsMeeting(const std::array<RealArray<2>, 2>& at)
  {
    const Point3 first = this->Shapes[0]->Evaluate(at[0]).col(0);
    const Point3 second = this->Shapes[1]->Evaluate(at[1]).col(0);
    const double near = EdgeFactor * this->Params.Tolerance;
    if (!((first - second).norm() <= Agreement * this->Params.Size) ||
      !this->Shapes[0]->Contains(at[0]) || !this->Shapes[1]->Contains(at[1]) ||
      (this->Shapes[0]->DistanceToEdges(first) <= near &&
        this->Shapes[1]->DistanceToEdges(second) <= near))
    {
      return false;
    }
    if (this->IsOwn)
    {
      double farthest = 0.0;
      for (const double share : { 0.25, 0.5, 0.75 })
      {
        const RealArray<2> between{ at[0][0] + share * (at[1][0] - at[0][0]),
          at[0][1] + share * (at[1][1] - at[0][1]) };
        farthest = std::max(farthest, (this->Shapes[0]->Evaluate(between).col(0) - first).norm());
      }
      if (!(farthest > OwnDistance * this->Params.Size))
      {
        return false;
      }
    }
    this->Found.Parameters = at;
    this->Found.Position = { first[0], first[1], first[2] };
    return true;
  }

  std::array<const FaceShape*, 2> Shapes;
  const SearchParams& Params;
  bool IsOwn;
  std::array<std::vector<FacePiece>, 2> Pieces;
  std::int64_t Count = 0;
  FaceMeeting Found;
};

Status CheckInput(const TrimmedModel& model, const FaceIntersectionParams& params)
{
  if (model.Faces.empty())
  {
    return { ErrorCode::EmptyInput, "the model has no faces" };
  }
  if (Status status = model.Check(); !status)
  {
    return status;
  }
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const Spline<2>& surface = model.Faces[f].Surface;
    if (surface.NumComponents() != 3 || surface.Space->Kind != SpaceKind::Tensor)
    {
      return { ErrorCode::DimensionMismatch,
        "face " + std::to_string(f) + ": the surface must be a tensor product in space" };
    }
  }
  if (!(params.Tolerance >= 0.0) || !std::isfinite(params.Tolerance) || params.MaxPairs < 1 ||
    params.Threads < 0)
  {
    return { ErrorCode::InvalidParameter,
      "the tolerance must be finite and not negative, the number of pairs at least 1, that of "
      "threads not negative" };
  }
  return {};
}
}

const char* ToString(IntersectionVerdict verdict)
{
  switch (verdict)
  {
    case IntersectionVerdict::Absent:
      return "absent";
    case IntersectionVerdict::Undecided:
      return "undecided";
    case IntersectionVerdict::Found:
      return "found";
  }
  return "";
}

Result<FaceIntersections> FindFaceIntersections(
  const TrimmedModel& model, const FaceIntersectionParams& params)
{
  if (Status status = CheckInput(model, params); !status)
  {
    return status;
  }
  SearchParams search;
  search.Size = SizeOf(model);
  search.Tolerance = params.Tolerance > 0.0 ? params.Tolerance : DefaultShare * search.Size;
  search.MaxPairs = params.MaxPairs;
  const auto isAborted = [&](double share) { return params.Progress && !params.Progress(share); };
  const Status aborted{ ErrorCode::Aborted, "the search for intersections" };
  std::vector<FaceShape> shapes;
  PointMatrix lower(static_cast<Eigen::Index>(model.Faces.size()), 3);
  PointMatrix upper(lower.rows(), 3);
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    if (isAborted(ShareOfShapes * static_cast<double>(f) / static_cast<double>(model.Faces.size())))
    {
      return aborted;
    }
    auto shape = FaceShape::Create(model.Faces[f], SpacingShare * search.Tolerance, params.Threads);
    if (!shape)
    {
      return { shape.Status.Code, "face " + std::to_string(f) + ": " + shape.Status.Detail };
    }
    const auto row = static_cast<Eigen::Index>(f);
    if (shape->IsEmpty())
    {
      lower.row(row) = upper.row(row) = model.Faces[f].Surface.ControlPoints.row(0);
    }
    else
    {
      lower.row(row) = shape->Lower().transpose();
      upper.row(row) = shape->Upper().transpose();
    }
    shapes.push_back(std::move(shape.Value));
  }
  const BoxTree tree(lower, upper);
  std::vector<std::array<int, 2>> pairs;
  for (int f = 0; f < static_cast<int>(shapes.size()); ++f)
  {
    const std::size_t begin = pairs.size();
    tree.ForNear(lower.row(f).data(), upper.row(f).data(),
      [&](int other)
      {
        const bool meet = (lower.row(f).array() <= upper.row(other).array()).all() &&
          (lower.row(other).array() <= upper.row(f).array()).all();
        if (other >= f && meet && !shapes[At(f)].IsEmpty() && !shapes[At(other)].IsEmpty())
        {
          pairs.push_back({ f, other });
        }
      });
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.end());
  }
  std::vector<FaceMeeting> meetings(pairs.size());
  std::vector<IntersectionVerdict> verdicts(pairs.size(), IntersectionVerdict::Absent);
  std::vector<std::int64_t> counts(pairs.size(), 0);
  for (std::size_t begin = 0; begin < pairs.size(); begin += PairsABatch)
  {
    if (isAborted(ShareOfShapes +
          (1.0 - ShareOfShapes) * static_cast<double>(begin) / static_cast<double>(pairs.size())))
    {
      return aborted;
    }
    ParallelFor(std::min(PairsABatch, pairs.size() - begin), 1, params.Threads,
      [&](std::size_t from, std::size_t to)
      {
        for (std::size_t k = begin + from; k < begin + to; ++k)
        {
          const auto [a, b] = pairs[k];
          PairSearch one(shapes[At(a)], shapes[At(b)], search);
          verdicts[k] = one.Run();
          counts[k] = one.NumPairs();
          meetings[k] = one.Meeting();
          meetings[k].Faces = { a, b };
          meetings[k].Verdict = verdicts[k];
        }
      });
  }
  FaceIntersections result;
  result.Tolerance = search.Tolerance;
  result.PairsOfFaces = static_cast<std::int64_t>(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
  {
    result.Pairs += counts[k];
    if (verdicts[k] != IntersectionVerdict::Absent)
    {
      result.Meetings.push_back(meetings[k]);
      result.Verdict = std::max(result.Verdict, verdicts[k]);
    }
  }
  return result;
}
}
