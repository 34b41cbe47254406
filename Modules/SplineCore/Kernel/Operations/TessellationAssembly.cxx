// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel.h"
#include "TessellationPlaces.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// Vertices that are evaluated together, about.
constexpr std::int64_t BatchVertices = 4096;
/// Batches between two reports of the progress.
constexpr std::size_t WaveBatches = 64;

/// A vertex of a cut on the border of its element, in the order of cuts.
struct BorderUse
{
  int Vertex = 0;
  int Point = -1; ///< index into the border points
};

/// A point of the mesh on borders: a vertex, or one of its copies.
struct BorderPoint
{
  std::int64_t Number = 0;
  int Source = 0; ///< the first copy, which has the value
};

struct BorderNormal
{
  Eigen::Vector3d First = Eigen::Vector3d::Zero(); ///< of its first use
  Eigen::Vector3d Sum = Eigen::Vector3d::Zero();   ///< of all uses
  bool IsCrease = false;
};

template <int Dim>
class MeshAssembly
{
public:
  MeshAssembly(const std::vector<BezierForm<Dim>>& patches, const TessellationParams& params,
    const TessellationCuts& cuts, TessellationMesh& mesh)
    : Patches(patches), Params(params), Cuts(cuts), Mesh(mesh),
      Components(patches.front().NumComponents),
      Polygons(Dim == 2 || (Dim == 3 && params.Output == TessellationOutput::Surface)),
      Normals(params.Normals && this->Polygons && (Components == 2 || Components == 3))
  {
  }

  Status Assemble()
  {
    this->FindShare();
    this->NumberVertices();
    if (Status status = this->MakeBorderPoints(); !status)
    {
      return status;
    }
    this->SizeMesh();
    return this->MakeCuts();
  }

private:
  /// The cuts of the part.
  void FindShare()
  {
    double all = 0.0;
    for (std::size_t cut = 0; cut < this->Cuts.Count(); ++cut)
    {
      all += this->Cuts.NumCells(cut);
    }
    double before = 0.0;
    this->Begin = this->Cuts.Count();
    for (std::size_t cut = 0; cut < this->Cuts.Count(); ++cut)
    {
      // the part in which the middle of its cells lies
      const double own = this->Cuts.NumCells(cut);
      const int part = static_cast<int>((before + 0.5 * own) / all * this->Params.Parts);
      before += own;
      this->Begin = part >= this->Params.Part ? std::min(this->Begin, cut) : this->Begin;
      this->End = part <= this->Params.Part ? std::max(this->End, cut + 1) : this->End;
    }
  }

  bool IsOwn(std::size_t cut) const { return cut >= this->Begin && cut < this->End; }

  /// Border uses of all cuts with their vertices; what the part needs of them.
  void NumberVertices()
  {
    VertexTable table;
    std::vector<BorderVertex> border;
    for (std::size_t cut = 0; cut < this->Cuts.Count(); ++cut)
    {
      this->NumVertices.push_back(this->Cuts.Border(cut, border));
      for (const BorderVertex& vertex : border)
      {
        this->Uses.push_back({ table.NumberOf(vertex.Position) });
      }
      this->FirstUse.push_back(this->Uses.size());
    }
    this->Cuts.Unite(table);
    const std::size_t numVertices = At(table.Sets.Size());
    this->Wanted.assign(numVertices, this->Params.Parts == 1 || this->Splits());
    this->IsFirst.assign(this->Uses.size(), false);
    std::vector<bool> seen(numVertices, false);
    for (std::size_t use = 0; use < this->Uses.size(); ++use)
    {
      int& vertex = this->Uses[use].Vertex;
      vertex = table.Sets.Find(vertex);
      this->IsFirst[use] = !seen[At(vertex)];
      seen[At(vertex)] = true;
    }
    for (std::size_t use = this->FirstUse[this->Begin]; use < this->FirstUse[this->End]; ++use)
    {
      this->Wanted[At(this->Uses[use].Vertex)] = true;
    }
  }

  /// Whether a vertex may become several points.
  bool Splits() const { return this->Params.Splitting; }

  /// Batches of cuts, each with some thousand vertices.
  std::vector<std::size_t> BatchesOf(
    std::size_t begin, std::size_t end, const std::vector<std::int64_t>& weights) const
  {
    std::vector<std::size_t> first{ begin };
    std::int64_t count = 0;
    for (std::size_t cut = begin; cut < end; ++cut)
    {
      count += weights[cut];
      if (count >= BatchVertices)
      {
        first.push_back(cut + 1);
        count = 0;
      }
    }
    if (first.back() < end)
    {
      first.push_back(end);
    }
    return first;
  }

  /// Does work(batch, first cut, last cut) for batches at once and take(batch) one after the other,
  /// wave after wave.
  template <typename Work, typename Take>
  Status InWaves(const std::vector<std::size_t>& first, double progressFrom, double progressTo,
    const Work& work, const Take& take)
  {
    const std::size_t batches = first.size() - 1;
    for (std::size_t wave = 0; wave < batches; wave += WaveBatches)
    {
      const std::size_t count = std::min(WaveBatches, batches - wave);
      std::vector<Status> failed(count);
      ParallelFor(count, 1, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            failed[i] = work(i, first[wave + i], first[wave + i + 1]);
          }
        });
      for (const Status& status : failed)
      {
        if (!status)
        {
          return status;
        }
      }
      for (std::size_t i = 0; i < count; ++i)
      {
        take(i, first[wave + i], first[wave + i + 1]);
      }
      const double done = static_cast<double>(wave + count) / static_cast<double>(batches);
      if (this->Params.Progress &&
        !this->Params.Progress(progressFrom + (progressTo - progressFrom) * done))
      {
        return { ErrorCode::Aborted, "" };
      }
    }
    return {};
  }

  bool IsWanted(std::size_t use) const { return this->Wanted[At(this->Uses[use].Vertex)]; }

  bool IsEvaluated(std::size_t use) const
  {
    return this->IsWanted(use) && (this->Normals || this->IsFirst[use]);
  }

  /// Values and normals at border uses, and the points that they are.
  Status MakeBorderPoints()
  {
    this->PointOf.assign(this->Wanted.size(), -1);
    this->CopiesOf.assign(this->Splits() ? this->Wanted.size() : 0, {});
    std::vector<std::int64_t> weights;
    for (std::size_t cut = 0; cut < this->Cuts.Count(); ++cut)
    {
      weights.push_back(static_cast<std::int64_t>(this->FirstUse[cut + 1] - this->FirstUse[cut]));
    }
    std::vector<Places<Dim>> places(WaveBatches);
    const Status status = this->InWaves(
      this->BatchesOf(0, this->Cuts.Count(), weights), 0.2, 0.4,
      [&](std::size_t i, std::size_t begin, std::size_t end)
      {
        places[i].Clear();
        std::vector<BorderVertex> border;
        for (std::size_t cut = begin; cut < end; ++cut)
        {
          const std::size_t first = this->FirstUse[cut];
          std::size_t use = first;
          while (use < this->FirstUse[cut + 1] && !this->IsEvaluated(use))
          {
            ++use;
          }
          if (use == this->FirstUse[cut + 1])
          {
            continue;
          }
          this->Cuts.Border(cut, border);
          const CutElement element = this->Cuts.ElementOf(cut);
          for (; use < this->FirstUse[cut + 1]; ++use)
          {
            if (this->IsEvaluated(use))
            {
              places[i].Add(element, border[use - first].Local);
            }
          }
        }
        return places[i].Evaluate(this->Patches, this->Normals);
      },
      [&](std::size_t i, std::size_t begin, std::size_t end)
      {
        Eigen::Index row = 0;
        for (std::size_t cut = begin; cut < end; ++cut)
        {
          this->NumberPoints(cut, places[i], row);
        }
      });
    this->Mesh.NumPointsOfAll = this->NextPoint;
    return status;
  }

  /// Points of the next cut, of which those within are new.
  /// @param row  of the next evaluated border use.
  void NumberPoints(std::size_t cut, const Places<Dim>& places, Eigen::Index& row)
  {
    this->FirstPoint.push_back(this->NextPoint);
    const std::size_t first = this->FirstUse[cut];
    const std::size_t end = this->FirstUse[cut + 1];
    std::vector<BorderVertex> border;
    std::int64_t repeated = 0; // border vertices that are points of cuts before or of this one
    for (std::size_t use = first; use < end; ++use)
    {
      if (!this->IsWanted(use))
      {
        repeated += this->IsFirst[use] ? 0 : 1;
        continue;
      }
      if (border.empty())
      {
        this->Cuts.Border(cut, border);
      }
      const std::int64_t number = this->NextPoint + border[use - first].Number - repeated;
      repeated +=
        this->TakePoint(use, this->Cuts.ElementOf(cut).Patch, number, places, row) ? 0 : 1;
    }
    this->NextPoint += this->NumVertices[cut] - repeated;
  }

  /// The point that a border use is.
  /// @param number  of the point, if it is new.   @param row  of the next evaluated border use.
  /// @return whether it is new.
  bool TakePoint(
    std::size_t use, int patch, std::int64_t number, const Places<Dim>& places, Eigen::Index& row)
  {
    BorderUse& own = this->Uses[use];
    const auto vertex = At(own.Vertex);
    const Eigen::Index place = this->IsEvaluated(use) ? row++ : -1;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (this->Normals)
    {
      normal = places.Normals.row(place).transpose();
    }
    own.Point = this->Splits() ? this->FindCopy(vertex, patch, normal) : this->PointOf[vertex];
    const bool isNew = own.Point < 0;
    if (isNew)
    {
      own.Point = static_cast<int>(this->BorderPoints.size());
      if (this->IsFirst[use])
      {
        this->PointOf[vertex] = own.Point;
      }
      this->BorderPoints.push_back({ number, this->PointOf[vertex] });
      for (int c = 0; c < this->Components; ++c)
      {
        this->Values.push_back(this->IsFirst[use] ? places.Values(place, c) : 0.0);
      }
      if (this->Normals)
      {
        this->BorderNormals.push_back({ normal });
      }
      if (this->Splits())
      {
        this->CopiesOf[vertex].emplace_back(patch, own.Point);
      }
    }
    if (this->Normals)
    {
      BorderNormal& known = this->BorderNormals[At(own.Point)];
      known.Sum += normal;
      known.IsCrease = known.IsCrease || (normal - known.First).norm() > 1e-6;
    }
    return isNew;
  }

  /// The copy of a vertex for a patch and a normal; -1: none yet.
  int FindCopy(std::size_t vertex, int patch, const Eigen::Vector3d& normal) const
  {
    for (const auto& [owner, point] : this->CopiesOf[vertex])
    {
      if (owner == patch &&
        (!this->Normals || (this->BorderNormals[At(point)].First - normal).norm() <= 1e-6))
      {
        return point;
      }
    }
    return -1;
  }

  void SizeMesh()
  {
    this->FirstPoint.push_back(this->NextPoint);
    this->Mesh.FirstPoint = this->FirstPoint[this->Begin];
    this->NumOwn = this->FirstPoint[this->End] - this->Mesh.FirstPoint;
    // border points of parts before
    std::vector<std::pair<std::int64_t, std::size_t>> shared; // number, first use here
    for (std::size_t use = this->FirstUse[this->Begin]; use < this->FirstUse[this->End]; ++use)
    {
      const std::int64_t number = this->BorderPoints[At(this->Uses[use].Point)].Number;
      if (number < this->Mesh.FirstPoint)
      {
        shared.emplace_back(number, use);
      }
    }
    std::sort(shared.begin(), shared.end());
    for (const auto& [number, use] : shared)
    {
      if (this->Mesh.SharedPoints.empty() || this->Mesh.SharedPoints.back() != number)
      {
        this->Mesh.SharedPoints.push_back(number);
        this->SharedUses.push_back(use);
      }
    }
    const std::size_t count = At(this->NumOwn) + this->Mesh.SharedPoints.size();
    this->Mesh.Points.resize(static_cast<Eigen::Index>(count), this->Components);
    this->Mesh.PointLocal.resize(static_cast<Eigen::Index>(count), Dim);
    this->Mesh.Normals.resize(this->Normals ? static_cast<Eigen::Index>(count) : 0, 3);
    this->Mesh.PointPatch.resize(count);
    this->Mesh.PointElement.resize(count);
  }

  std::int64_t RowOf(std::int64_t number) const
  {
    if (number >= this->Mesh.FirstPoint)
    {
      return number - this->Mesh.FirstPoint;
    }
    const auto& shared = this->Mesh.SharedPoints;
    return this->NumOwn + (std::lower_bound(shared.begin(), shared.end(), number) - shared.begin());
  }

  void SetPoint(std::int64_t row, const CutElement& element, const std::array<double, 3>& local)
  {
    this->Mesh.PointPatch[At(row)] = element.Patch;
    this->Mesh.PointElement[At(row)] = element.Element;
    for (int d = 0; d < Dim; ++d)
    {
      this->Mesh.PointLocal(row, d) = local[At(d)];
    }
  }

  void SetBorderPoint(
    std::int64_t row, int point, const CutElement& element, const std::array<double, 3>& local)
  {
    this->SetPoint(row, element, local);
    const std::size_t value = At(this->BorderPoints[At(point)].Source) * At(this->Components);
    for (int c = 0; c < this->Components; ++c)
    {
      this->Mesh.Points(row, c) = this->Values[value + At(c)];
    }
    if (this->Normals)
    {
      // Where all uses agree the normal is that of the first one, else the mean of all.
      const BorderNormal& normal = this->BorderNormals[At(point)];
      const bool isMean = !this->Splits() && normal.IsCrease && normal.Sum.norm() > 1e-12;
      this->Mesh.Normals.row(row) = (isMean ? normal.Sum.normalized() : normal.First).transpose();
    }
  }

  /// Points of parts before that the part has, too: as their first uses made them.
  void SetSharedPoints()
  {
    std::vector<BorderVertex> border;
    std::size_t cut = this->Cuts.Count();
    std::size_t use = 0;
    for (std::size_t i = 0; i < this->SharedUses.size(); ++i) // by number: cut after cut
    {
      const int point = this->Uses[this->SharedUses[i]].Point;
      const auto next = std::upper_bound(
        this->FirstPoint.begin(), this->FirstPoint.end(), this->BorderPoints[At(point)].Number);
      // cuts without a new point begin with the number of the next one
      const auto maker = static_cast<std::size_t>(next - this->FirstPoint.begin()) - 1;
      if (maker != cut)
      {
        cut = maker;
        use = this->FirstUse[cut];
        this->Cuts.Border(cut, border);
      }
      while (this->Uses[use].Point != point)
      {
        ++use;
      }
      this->SetBorderPoint(this->NumOwn + static_cast<std::int64_t>(i), point,
        this->Cuts.ElementOf(cut), border[use - this->FirstUse[cut]].Local);
    }
  }

  /// What a batch of cuts becomes.
  struct MadeCells
  {
    Places<Dim> Inner;
    std::vector<TessellationShape> Shapes;
    std::vector<int> Sizes;
    std::vector<std::int64_t> Corners; ///< rows of points
    std::vector<int> Cuts;             ///< of the cells, from the batch's first
  };

  Status MakeCuts()
  {
    this->SetSharedPoints();
    double numCells = 0.0;
    for (std::size_t cut = this->Begin; cut < this->End; ++cut)
    {
      numCells += this->Cuts.NumCells(cut);
    }
    const int numCorners = !this->Polygons ? Dim == 1 ? 2 : 8 : 4;
    this->Mesh.Connectivity.reserve(static_cast<std::size_t>(numCells * numCorners));
    this->Mesh.Offsets.push_back(0);
    std::vector<MadeCells> made(WaveBatches);
    return this->InWaves(
      this->BatchesOf(this->Begin, this->End, this->NumVertices), 0.4, 0.9,
      [&](std::size_t i, std::size_t begin, std::size_t end)
      { return this->MakeBatch(begin, end, made[i]); },
      [&](std::size_t i, std::size_t begin, std::size_t)
      {
        const MadeCells& cells = made[i];
        auto& corners = this->Mesh.Connectivity;
        corners.insert(corners.end(), cells.Corners.begin(), cells.Corners.end());
        auto& shapes = this->Mesh.Shapes;
        shapes.insert(shapes.end(), cells.Shapes.begin(), cells.Shapes.end());
        for (std::size_t c = 0; c < cells.Shapes.size(); ++c)
        {
          this->Mesh.Offsets.push_back(this->Mesh.Offsets.back() + cells.Sizes[c]);
          const CutElement element = this->Cuts.ElementOf(begin + At(cells.Cuts[c]));
          this->Mesh.CellPatch.push_back(element.Patch);
          this->Mesh.CellElement.push_back(element.Element);
          if (element.Side >= 0)
          {
            this->Mesh.CellSide.push_back(element.Side);
          }
        }
      });
  }

  Status MakeBatch(std::size_t begin, std::size_t end, MadeCells& made)
  {
    made = MadeCells();
    knotwork::Cut cut;
    std::vector<std::int64_t> rows;  // of the vertices
    std::vector<int> vertices;       // that vertices of polygons may share; -1 within
    std::vector<std::int64_t> inner; // rows of the points that are evaluated
    for (std::size_t c = begin; c < end; ++c)
    {
      this->Cuts.Make(c, cut);
      this->PlaceVertices(c, cut, rows, vertices, inner, made.Inner);
      this->AddCells(static_cast<int>(c - begin), cut, rows, vertices, made);
    }
    const Status status = made.Inner.Evaluate(this->Patches, this->Normals);
    for (std::size_t i = 0; status && i < inner.size(); ++i)
    {
      this->Mesh.Points.row(inner[i]) = made.Inner.Values.row(static_cast<Eigen::Index>(i));
      if (this->Normals)
      {
        this->Mesh.Normals.row(inner[i]) = made.Inner.Normals.row(static_cast<Eigen::Index>(i));
      }
    }
    return status;
  }

  /// Rows of a cut's vertices in the mesh; sets the points that are new with it.
  void PlaceVertices(std::size_t c, const knotwork::Cut& cut, std::vector<std::int64_t>& rows,
    std::vector<int>& vertices, std::vector<std::int64_t>& inner, Places<Dim>& places)
  {
    const CutElement element = this->Cuts.ElementOf(c);
    std::vector<BorderVertex> border;
    this->Cuts.Border(c, border);
    rows.assign(cut.Local.size(), -1);
    vertices.assign(cut.Local.size(), -1);
    for (std::size_t k = 0; k < border.size(); ++k)
    {
      const BorderUse& use = this->Uses[this->FirstUse[c] + k];
      const BorderPoint& point = this->BorderPoints[At(use.Point)];
      const std::size_t i = At(border[k].Number);
      rows[i] = this->RowOf(point.Number);
      vertices[i] = use.Vertex;
    }
    std::int64_t next = this->FirstPoint[c];
    std::size_t k = 0;
    for (std::size_t i = 0; i < cut.Local.size(); ++i)
    {
      if (vertices[i] < 0)
      {
        rows[i] = next++ - this->Mesh.FirstPoint;
        this->SetPoint(rows[i], element, cut.Local[i]);
        inner.push_back(rows[i]);
        places.Add(element, cut.Local[i]);
        continue;
      }
      const int point = this->Uses[this->FirstUse[c] + k++].Point;
      if (this->BorderPoints[At(point)].Number == next)
      {
        this->SetBorderPoint(rows[i], point, element, cut.Local[i]);
        ++next;
      }
    }
  }

  /// Corners that became one vertex are dropped, and polygons without area with them.
  void AddCells(int index, const knotwork::Cut& cut, const std::vector<std::int64_t>& rows,
    const std::vector<int>& vertices, MadeCells& made) const
  {
    std::size_t first = 0;
    for (TessellationShape shape : cut.Shapes)
    {
      const std::size_t count = NumCorners(shape);
      std::array<int, 8> corners{};
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k)
      {
        const int corner = cut.Corners[first + k];
        const int vertex = vertices[At(corner)];
        const auto isSame = [&](int other) { return vertices[At(other)] == vertex; };
        if (!this->Polygons || vertex < 0 ||
          std::none_of(corners.begin(), corners.begin() + kept, isSame))
        {
          corners[kept++] = corner;
        }
      }
      first += count;
      if (this->Polygons && kept < 3)
      {
        continue;
      }
      made.Shapes.push_back(this->Polygons && kept == 3 ? TessellationShape::Triangle : shape);
      made.Sizes.push_back(static_cast<int>(kept));
      made.Cuts.push_back(index);
      for (std::size_t k = 0; k < kept; ++k)
      {
        made.Corners.push_back(rows[At(corners[k])]);
      }
    }
  }

  static std::size_t NumCorners(TessellationShape shape)
  {
    switch (shape)
    {
      case TessellationShape::Line:
        return 2;
      case TessellationShape::Triangle:
        return 3;
      case TessellationShape::Quadrilateral:
        return 4;
      case TessellationShape::Hexahedron:
        break;
    }
    return 8;
  }

  const std::vector<BezierForm<Dim>>& Patches;
  const TessellationParams& Params;
  const TessellationCuts& Cuts;
  TessellationMesh& Mesh;
  int Components;
  bool Polygons;
  bool Normals;

  std::size_t Begin = 0; ///< the cuts of the part
  std::size_t End = 0;
  std::vector<std::int64_t> NumVertices; ///< of every cut
  std::vector<std::size_t> FirstUse{ 0 };
  std::vector<BorderUse> Uses;
  std::vector<bool> IsFirst; ///< whether a use is the first one of its vertex
  // of vertices:
  std::vector<bool> Wanted;                               ///< whether the part needs it
  std::vector<int> PointOf;                               ///< the first of its points
  std::vector<std::vector<std::pair<int, int>>> CopiesOf; ///< (patch, point), where they split
  // of border points:
  std::vector<BorderPoint> BorderPoints;
  std::vector<double> Values;
  std::vector<BorderNormal> BorderNormals;
  std::vector<std::int64_t> FirstPoint; ///< of every cut, and the number of all points
  std::int64_t NextPoint = 0;
  std::int64_t NumOwn = 0;
  std::vector<std::size_t> SharedUses; ///< one of each shared point
};
}

template <int Dim>
Status AssembleTessellation(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, const TessellationCuts& cuts, TessellationMesh& mesh)
{
  return MeshAssembly<Dim>(patches, params, cuts, mesh).Assemble();
}

template Status AssembleTessellation<1>(const std::vector<BezierForm<1>>&,
  const TessellationParams&, const TessellationCuts&, TessellationMesh&);
template Status AssembleTessellation<2>(const std::vector<BezierForm<2>>&,
  const TessellationParams&, const TessellationCuts&, TessellationMesh&);
template Status AssembleTessellation<3>(const std::vector<BezierForm<3>>&,
  const TessellationParams&, const TessellationCuts&, TessellationMesh&);
}
