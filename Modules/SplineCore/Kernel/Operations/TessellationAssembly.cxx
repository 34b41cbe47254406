// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel.h"
#include "TessellationPlaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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
/// Most batches between two reports of the progress, and vertices that end them.
constexpr std::size_t WaveBatches = 64;
constexpr std::int64_t WaveVertices = 1 << 20;

/// Work that is done together, each part with about as many vertices.
struct Batches
{
  std::vector<std::size_t> First; ///< cut of each, and the end
  std::vector<std::int64_t> Vertices;
  std::size_t Count() const { return this->Vertices.size(); }
};

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
    Status status = this->NumberVertices();
    status = status ? this->MakeBorderPoints() : status;
    if (!status)
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

  /// Border uses of all cuts with their vertices; what the part needs of them.
  Status NumberVertices()
  {
    VertexTable table = this->Cuts.MakeTable();
    std::vector<std::vector<BorderVertex>> borders(1024); // that are found at once
    std::vector<std::int64_t> counts(borders.size());
    for (std::size_t first = 0; first < this->Cuts.Count(); first += borders.size())
    {
      const std::size_t count = std::min(borders.size(), this->Cuts.Count() - first);
      ParallelFor(count, 16, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            counts[i] = this->Cuts.Border(first + i, borders[i]);
          }
        });
      std::size_t found = 0;
      for (std::size_t i = 0; i < count; ++i)
      {
        found += borders[i].size();
      }
      if (this->Uses.size() + found > this->Uses.capacity())
      {
        // as if all that follow had as many: doubling would take up to three times the memory
        const double times =
          static_cast<double>(this->Cuts.Count() - first) / static_cast<double>(count);
        this->Uses.reserve(this->Uses.size() +
          static_cast<std::size_t>(std::ceil(times * static_cast<double>(found))));
      }
      for (std::size_t i = 0; i < count; ++i)
      {
        constexpr std::int64_t most = std::numeric_limits<int>::max();
        const auto uses = static_cast<std::int64_t>(this->Uses.size() + borders[i].size());
        if (counts[i] > most || uses > most)
        {
          return { ErrorCode::TooLarge,
            "the elements have more than " + std::to_string(most) +
              " vertices on their borders, or one of them has within; raise the tolerance" };
        }
        this->NumVertices.push_back(counts[i]);
        for (const BorderVertex& vertex : borders[i])
        {
          this->Uses.push_back({ table.NumberOf(vertex.Position) });
        }
        this->FirstUse.push_back(this->Uses.size());
      }
    }
    this->Cuts.Unite(table);
    const std::size_t numVertices = At(table.Sets.Size());
    this->Wanted.assign(numVertices, this->Params.Parts == 1 || this->Params.Splitting);
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
    return {};
  }

  static Batches BatchesOf(
    std::size_t begin, std::size_t end, const std::vector<std::int64_t>& vertices)
  {
    Batches batches;
    for (std::size_t cut = begin; cut < end; ++cut)
    {
      if (batches.Vertices.empty() || batches.Vertices.back() >= BatchVertices)
      {
        batches.First.push_back(cut);
        batches.Vertices.push_back(0);
      }
      batches.Vertices.back() += vertices[cut];
    }
    batches.First.push_back(end);
    return batches;
  }

  /// Does work(i, first cut, last cut) for the batches of a wave at once, i from 0, and then
  /// take(i, first cut, last cut) one after the other; wave after wave.
  template <typename Work, typename Take>
  Status InWaves(const Batches& batches, double progressFrom, double progressTo, const Work& work,
    const Take& take)
  {
    for (std::size_t wave = 0, count = 0; wave < batches.Count(); wave += count)
    {
      std::int64_t vertices = 0;
      for (count = 0;
           count < WaveBatches && wave + count < batches.Count() && vertices < WaveVertices;
           ++count)
      {
        vertices += batches.Vertices[wave + count];
      }
      std::vector<Status> failed(count);
      ParallelFor(count, 1, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            failed[i] = work(i, batches.First[wave + i], batches.First[wave + i + 1]);
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
        take(i, batches.First[wave + i], batches.First[wave + i + 1]);
      }
      const double done = static_cast<double>(wave + count) / static_cast<double>(batches.Count());
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
    this->CopiesOf.assign(this->Params.Splitting ? this->Wanted.size() : 0, {});
    const auto numWanted =
      static_cast<std::size_t>(std::count(this->Wanted.begin(), this->Wanted.end(), true));
    this->BorderPoints.reserve(numWanted); // copies apart
    this->Values.reserve(numWanted * At(this->Components));
    this->BorderNormals.reserve(this->Normals ? numWanted : 0);
    std::vector<std::int64_t> uses;
    for (std::size_t cut = 0; cut < this->Cuts.Count(); ++cut)
    {
      uses.push_back(static_cast<std::int64_t>(this->FirstUse[cut + 1] - this->FirstUse[cut]));
    }
    std::vector<WantedUses> wanted(WaveBatches);
    const Status status = this->InWaves(
      this->BatchesOf(0, this->Cuts.Count(), uses), 0.2, 0.4,
      [&](std::size_t i, std::size_t begin, std::size_t end)
      { return this->EvaluateBorders(begin, end, wanted[i]); },
      [&](std::size_t i, std::size_t begin, std::size_t end)
      {
        for (std::size_t cut = begin; cut < end; ++cut)
        {
          this->NumberPoints(cut, wanted[i]);
        }
      });
    this->Mesh.NumPointsOfAll = this->NextPoint;
    return status;
  }

  /// Uses of a batch that are wanted, in order.
  struct WantedUses
  {
    std::vector<std::int64_t> Numbers; ///< among the vertices of the cut
    std::size_t Next = 0;
    Places<Dim> Evaluated;
    Eigen::Index NextPlace = 0;
  };

  Status EvaluateBorders(std::size_t begin, std::size_t end, WantedUses& wanted) const
  {
    wanted = WantedUses();
    std::vector<BorderVertex> border;
    for (std::size_t cut = begin; cut < end; ++cut)
    {
      const std::size_t first = this->FirstUse[cut];
      border.clear();
      for (std::size_t use = first; use < this->FirstUse[cut + 1]; ++use)
      {
        if (!this->IsWanted(use))
        {
          continue;
        }
        if (border.empty())
        {
          this->Cuts.Border(cut, border);
        }
        wanted.Numbers.push_back(border[use - first].Number);
        if (this->IsEvaluated(use))
        {
          wanted.Evaluated.Add(this->Cuts.ElementOf(cut), border[use - first].Local);
        }
      }
    }
    return wanted.Evaluated.Evaluate(this->Patches, this->Normals, this->Params.Threads);
  }

  /// Points of the next cut, of which those within are new.
  void NumberPoints(std::size_t cut, WantedUses& wanted)
  {
    this->FirstPoint.push_back(this->NextPoint);
    const int patch = this->Cuts.ElementOf(cut).Patch;
    std::int64_t repeated = 0; // border vertices that are points of cuts before or of this one
    for (std::size_t use = this->FirstUse[cut]; use < this->FirstUse[cut + 1]; ++use)
    {
      bool isNew = this->IsFirst[use];
      if (this->IsWanted(use))
      {
        const std::int64_t number = this->NextPoint + wanted.Numbers[wanted.Next++] - repeated;
        isNew = this->TakePoint(use, patch, number, wanted);
      }
      repeated += isNew ? 0 : 1;
    }
    this->NextPoint += this->NumVertices[cut] - repeated;
  }

  /// The point that a border use is.
  /// @param number  of the point, if it is new.
  /// @return whether it is new.
  bool TakePoint(std::size_t use, int patch, std::int64_t number, WantedUses& wanted)
  {
    BorderUse& own = this->Uses[use];
    const auto vertex = At(own.Vertex);
    const Places<Dim>& places = wanted.Evaluated;
    const Eigen::Index place = this->IsEvaluated(use) ? wanted.NextPlace++ : -1;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (this->Normals)
    {
      normal = places.Normals.row(place).transpose();
    }
    own.Point =
      this->Params.Splitting ? this->FindCopy(vertex, patch, normal) : this->PointOf[vertex];
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
      if (this->Params.Splitting)
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
    this->Mesh.HasNormals = this->Normals;
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
      const bool isMean = !this->Params.Splitting && normal.IsCrease && normal.Sum.norm() > 1e-12;
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
    std::vector<std::int64_t> Corners; ///< rows of points
    std::vector<std::size_t> Count;    ///< cells of every cut
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
    const auto cells = static_cast<std::size_t>(numCells); // about
    this->Mesh.Shapes.reserve(cells);
    this->Mesh.Offsets.reserve(cells + 1);
    this->Mesh.CellPatch.reserve(cells);
    this->Mesh.CellElement.reserve(cells);
    this->Mesh.Offsets.push_back(0);
    std::vector<MadeCells> made(WaveBatches);
    return this->InWaves(
      this->BatchesOf(this->Begin, this->End, this->NumVertices), 0.4, 0.9,
      [&](std::size_t i, std::size_t begin, std::size_t end)
      { return this->MakeBatch(begin, end, made[i]); },
      [&](std::size_t i, std::size_t begin, std::size_t)
      {
        const MadeCells& batch = made[i];
        auto& corners = this->Mesh.Connectivity;
        corners.insert(corners.end(), batch.Corners.begin(), batch.Corners.end());
        auto& shapes = this->Mesh.Shapes;
        shapes.insert(shapes.end(), batch.Shapes.begin(), batch.Shapes.end());
        for (const TessellationShape shape : batch.Shapes)
        {
          this->Mesh.Offsets.push_back(
            this->Mesh.Offsets.back() + static_cast<std::int64_t>(NumCorners(shape)));
        }
        for (std::size_t c = 0; c < batch.Count.size(); ++c)
        {
          const CutElement element = this->Cuts.ElementOf(begin + c);
          const std::size_t count = this->Mesh.CellPatch.size() + batch.Count[c];
          this->Mesh.CellPatch.resize(count, element.Patch);
          this->Mesh.CellElement.resize(count, element.Element);
          this->Mesh.CellSide.resize(element.Side >= 0 ? count : 0, element.Side);
        }
        made[i] = MadeCells();
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
      const std::size_t before = made.Shapes.size();
      this->AddCells(cut, rows, vertices, made);
      made.Count.push_back(made.Shapes.size() - before);
    }
    const Status status = made.Inner.Evaluate(this->Patches, this->Normals, this->Params.Threads);
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
  void AddCells(const knotwork::Cut& cut, const std::vector<std::int64_t>& rows,
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
