// SPDX-License-Identifier: BSD-3-Clause
#include "UntangledSpline.h"

#include "MeshSpline.h"
#include "UnstructuredData.h"

namespace knotwork
{
namespace
{
constexpr int MostRounds = 6;

template <int Dim>
class UntanglingRounds
{
public:
  UntanglingRounds(const SplineSpacePtr<Dim>& space, const PointMatrixView& vertices,
    int coordinates, const UntangledSplineParams& params)
    : Space(space), Vertices(vertices), Coordinates(coordinates), Params(params)
  {
  }

  Result<UntangledSpline<Dim>> Run()
  {
    if (Status status = this->MakeSpline(0.0); !status)
    {
      return status;
    }
    this->Best = this->Last;
    const bool isAsked = this->Params.Scope != UntanglingScope::None;
    for (int round = 0; isAsked && round < MostRounds && this->IsOpen(); ++round)
    {
      Status status = this->MoveVertices(round);
      status = status ? this->MakeSpline((round + 0.5) / MostRounds) : status;
      if (!status)
      {
        return status;
      }
      if (!this->IsBetter())
      {
        break;
      }
      this->Best = this->Last;
    }
    return std::move(this->Best);
  }

private:
  bool IsOpen() const { return !this->Last.StillFolded.empty() || this->Last.FoldedElements > 0; }
  bool IsBetter() const
  {
    const std::size_t cells = this->Last.StillFolded.size();
    return cells != this->Best.StillFolded.size()
      ? cells < this->Best.StillFolded.size()
      : this->Last.FoldedElements < this->Best.FoldedElements;
  }

  /// The share of the whole that a round has.
  ProgressCallback From(double begin) const
  {
    const ProgressCallback& progress = this->Params.Progress;
    return progress ? ProgressCallback([&progress, begin](double share)
                        { return progress(begin + share * 0.5 / MostRounds); })
                    : ProgressCallback();
  }

  Status MakeSpline(double begin)
  {
    auto made = this->Params.IsCage ? SplineOfCage<Dim>(this->Space, this->Vertices)
                                    : SplineThroughVertices<Dim>(this->Space, this->Vertices,
                                        this->Params.Threads, this->From(begin));
    if (!made)
    {
      return made.Status;
    }
    this->Last.Value = std::move(made.Value);
    this->Last.Vertices = this->Vertices;
    if (this->Params.Scope == UntanglingScope::Elements)
    {
      Spline<Dim> geometry = this->Last.Value;
      geometry.ControlPoints = this->Last.Value.ControlPoints.leftCols(this->Coordinates);
      this->Poor = FoldedElements<Dim>(geometry, this->Params.Threads);
      this->Last.FoldedElements = static_cast<int>(this->Poor.size());
    }
    if (begin == 0.0 && this->Params.Scope != UntanglingScope::None)
    {
      auto folded =
        FoldedCells<Dim>(MeshOf(*this->Space), this->Vertices.leftCols(this->Coordinates));
      this->Last.FoldedCells = std::move(folded.Value);
      this->Last.StillFolded = this->Last.FoldedCells;
      return folded.Status;
    }
    return {};
  }

  Status MoveVertices(int round)
  {
    UntanglingParams params = this->Params.Mesh;
    params.Poor = this->Poor;
    params.Progress = this->From(static_cast<double>(round) / MostRounds);
    const CellMesh<Dim>& mesh = MeshOf(*this->Space);
    auto untangled = UntangleMesh<Dim>(mesh, this->Space->Unstructured->Topology,
      this->Vertices.leftCols(this->Coordinates), params);
    if (!untangled)
    {
      return untangled.Status;
    }
    if (round == 0)
    {
      this->Begin = this->Vertices.leftCols(this->Coordinates);
    }
    this->Vertices.leftCols(this->Coordinates) = untangled->Points;
    this->Last.StillFolded = std::move(untangled->Folded);
    const Eigen::VectorXd moves = (untangled->Points - this->Begin).rowwise().norm();
    this->Last.NumMoved = static_cast<int>((moves.array() > 0.0).count());
    this->Last.LargestMove = moves.maxCoeff();
    return {};
  }

  const SplineSpacePtr<Dim>& Space;
  PointMatrix Vertices;
  PointMatrix Begin;
  const int Coordinates;
  const UntangledSplineParams& Params;
  std::vector<int> Poor;
  UntangledSpline<Dim> Last;
  UntangledSpline<Dim> Best;
};
}

template <int Dim>
Result<UntangledSpline<Dim>> MakeUntangledSpline(const SplineSpacePtr<Dim>& space,
  const PointMatrixView& vertices, int coordinates, const UntangledSplineParams& params)
{
  return UntanglingRounds<Dim>(space, vertices, coordinates, params).Run();
}

template Result<UntangledSpline<2>> MakeUntangledSpline(
  const SplineSpacePtr<2>&, const PointMatrixView&, int, const UntangledSplineParams&);
template Result<UntangledSpline<3>> MakeUntangledSpline(
  const SplineSpacePtr<3>&, const PointMatrixView&, int, const UntangledSplineParams&);
}
