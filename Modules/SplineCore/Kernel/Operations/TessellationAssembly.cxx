// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel.h"
#include "TessellationParts.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

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

/// Unit normal of row i of a batch; false where the derivatives are parallel or vanish.
bool NormalOf(const EvaluationBatch& batch, Eigen::Index i, const CutElement& cut, int components,
  Eigen::Vector3d& normal)
{
  std::array<Eigen::Vector3d, 2> tangent{ Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() };
  for (std::size_t k = 0; k < 2; ++k)
  {
    for (int c = 0; c < components; ++c)
    {
      tangent[k][c] = batch.First(i, cut.Tangents[k] * components + c);
    }
  }
  normal = tangent[0].cross(tangent[1]);
  const double length = normal.norm();
  if (!(length > 1e-9 * tangent[0].norm() * tangent[1].norm()) || !std::isfinite(length))
  {
    return false;
  }
  normal *= (cut.Flip ? -1.0 : 1.0) / length;
  return true;
}

/// Places in elements, the elements of one patch after those of another, with values there.
template <int Dim>
class Places
{
public:
  void Clear()
  {
    this->Cuts.clear();
    this->Local.clear();
  }
  void Add(const CutElement& cut, const std::array<double, 3>& local)
  {
    this->Cuts.push_back(cut);
    this->Local.push_back(local);
  }
  std::size_t Count() const { return this->Cuts.size(); }

  Status Evaluate(const std::vector<BezierForm<Dim>>& patches, bool withNormals)
  {
    const auto count = static_cast<Eigen::Index>(this->Count());
    this->Values.resize(count, patches.front().NumComponents);
    this->Normals.setZero(withNormals ? count : 0, 3);
    for (std::size_t begin = 0, end = 0; begin < this->Count(); begin = end)
    {
      while (end < this->Count() && this->Cuts[end].Patch == this->Cuts[begin].Patch)
      {
        ++end;
      }
      const Status status =
        this->EvaluatePatch(patches[At(this->Cuts[begin].Patch)], begin, end, withNormals);
      if (!status)
      {
        return status;
      }
    }
    return {};
  }

  PointMatrix Values;
  PointMatrix Normals;

private:
  Status EvaluatePatch(
    const BezierForm<Dim>& form, std::size_t begin, std::size_t end, bool withNormals)
  {
    std::vector<std::size_t> places(end - begin);
    for (std::size_t i = begin; i < end; ++i)
    {
      places[i - begin] = i;
    }
    EvaluationBatch batch;
    Status status = this->EvaluateAt(form, places, 0.0, withNormals ? 1 : 0, batch);
    if (!status)
    {
      return status;
    }
    this->Values.middleRows(static_cast<Eigen::Index>(begin), batch.Values.rows()) = batch.Values;
    if (!withNormals)
    {
      return {};
    }
    std::vector<std::size_t> singular;
    this->TakeNormals(batch, places, form.NumComponents, singular);
    if (singular.empty())
    {
      return {};
    }
    // a collapsed edge or cusp: the limit from inside the element
    status = this->EvaluateAt(form, singular, 1e-4, 1, batch);
    if (status)
    {
      std::vector<std::size_t> without;
      this->TakeNormals(batch, singular, form.NumComponents, without);
    }
    return status;
  }

  void TakeNormals(const EvaluationBatch& batch, const std::vector<std::size_t>& places,
    int components, std::vector<std::size_t>& singular)
  {
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      Eigen::Vector3d normal;
      if (NormalOf(batch, static_cast<Eigen::Index>(i), this->Cuts[places[i]], components, normal))
      {
        this->Normals.row(static_cast<Eigen::Index>(places[i])) = normal.transpose();
      }
      else
      {
        singular.push_back(places[i]);
      }
    }
  }

  /// @param shrink  how far places go towards the middles of their elements.
  Status EvaluateAt(const BezierForm<Dim>& form, const std::vector<std::size_t>& places,
    double shrink, int derivatives, EvaluationBatch& batch) const
  {
    std::vector<int> elements(places.size());
    PointMatrix local(static_cast<Eigen::Index>(places.size()), Dim);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      elements[i] = this->Cuts[places[i]].Element;
      for (int d = 0; d < Dim; ++d)
      {
        const double x = this->Local[places[i]][At(d)];
        local(static_cast<Eigen::Index>(i), d) = x + shrink * (0.5 - x);
      }
    }
    EvaluationParams params;
    params.Derivatives = derivatives;
    params.Threads = 1;
    return EvaluateElements<Dim>(form, elements, local, params, batch);
  }

  std::vector<CutElement> Cuts; ///< of every place
  std::vector<std::array<double, 3>> Local;
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
  int Vertex = 0;
  Eigen::Vector3d Normal = Eigen::Vector3d::Zero(); ///< of its first use
  Eigen::Vector3d Sum = Eigen::Vector3d::Zero();    ///< of the normals of all uses
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
    this->Wanted.assign(At(table.Sets.Size()), this->Params.Parts == 1 || this->Splits() ? 1 : 0);
    this->Owner.assign(At(table.Sets.Size()), -1);
    for (std::size_t use = 0; use < this->Uses.size(); ++use)
    {
      int& vertex = this->Uses[use].Vertex;
      vertex = table.Sets.Find(vertex);
      if (this->Owner[At(vertex)] < 0)
      {
        this->Owner[At(vertex)] = static_cast<std::int64_t>(use);
      }
    }
    for (std::size_t use = this->FirstUse[this->Begin]; use < this->FirstUse[this->End]; ++use)
    {
      this->Wanted[At(this->Uses[use].Vertex)] = 1;
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

  bool IsEvaluated(std::size_t use) const
  {
    const auto vertex = At(this->Uses[use].Vertex);
    return this->Wanted[vertex] != 0 &&
      (this->Normals || this->Owner[vertex] == static_cast<std::int64_t>(use));
  }

  /// Values and normals at border uses, and the points that they are.
  Status MakeBorderPoints()
  {
    this->ValueOf.assign(this->Wanted.size(), -1);
    Eigen::Index numValues = 0;
    for (std::size_t vertex = 0; vertex < this->Wanted.size(); ++vertex)
    {
      if (this->Wanted[vertex] != 0 && this->Owner[vertex] >= 0)
      {
        this->ValueOf[vertex] = numValues++;
      }
    }
    this->Values.resize(numValues, this->Components);
    this->PointsOf.assign(this->Splits() ? this->Wanted.size() : 0, {});
    this->SingleOf.assign(this->Splits() ? 0 : this->Wanted.size(), -1);
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
    std::int64_t sharedBefore =
      0; // border vertices that are points of cuts before, or are repeated
    std::vector<BorderVertex> border;
    this->Cuts.Border(cut, border);
    const CutElement element = this->Cuts.ElementOf(cut);
    for (std::size_t use = this->FirstUse[cut]; use < this->FirstUse[cut + 1]; ++use)
    {
      BorderUse& own = this->Uses[use];
      const auto vertex = At(own.Vertex);
      const bool isOwner = this->Owner[vertex] == static_cast<std::int64_t>(use);
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      if (this->IsEvaluated(use))
      {
        if (isOwner)
        {
          this->Values.row(this->ValueOf[vertex]) = places.Values.row(row);
        }
        if (this->Normals)
        {
          normal = places.Normals.row(row).transpose();
        }
        ++row;
      }
      bool isNew = isOwner;
      if (this->Splits())
      {
        isNew = true;
        for (const auto& [patch, point] : this->PointsOf[vertex])
        {
          if (patch == element.Patch &&
            (!this->Normals || (this->BorderPoints[At(point)].Normal - normal).norm() <= 1e-6))
          {
            own.Point = point;
            isNew = false;
            break;
          }
        }
      }
      const std::int64_t number =
        this->NextPoint + border[use - this->FirstUse[cut]].Number - sharedBefore;
      sharedBefore += isNew ? 0 : 1;
      if (this->Wanted[vertex] == 0)
      {
        continue;
      }
      if (isNew)
      {
        own.Point = static_cast<int>(this->BorderPoints.size());
        BorderPoint made;
        made.Number = number;
        made.Vertex = own.Vertex;
        made.Normal = normal;
        this->BorderPoints.push_back(made);
        if (this->Splits())
        {
          this->PointsOf[vertex].emplace_back(element.Patch, own.Point);
        }
        else
        {
          this->SingleOf[vertex] = own.Point;
        }
      }
      else if (!this->Splits())
      {
        own.Point = this->SingleOf[vertex];
      }
      BorderPoint& point = this->BorderPoints[At(own.Point)];
      point.Sum += normal;
      point.IsCrease = point.IsCrease || (normal - point.Normal).norm() > 1e-6;
    }
    this->NextPoint += this->NumVertices[cut] - sharedBefore;
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

  void SetBorderPoint(std::int64_t row, const BorderPoint& point, const CutElement& element,
    const std::array<double, 3>& local)
  {
    this->SetPoint(row, element, local);
    this->Mesh.Points.row(row) = this->Values.row(this->ValueOf[At(point.Vertex)]);
    if (this->Normals)
    {
      // Where all uses agree the normal is that of the first one, else the mean of all.
      const bool isMean = !this->Splits() && point.IsCrease && point.Sum.norm() > 1e-12;
      this->Mesh.Normals.row(row) = (isMean ? point.Sum.normalized() : point.Normal).transpose();
    }
  }

  /// Points of parts before that the part has, too: as their first uses made them.
  void SetSharedPoints()
  {
    std::vector<BorderVertex> border;
    for (std::size_t i = 0; i < this->SharedUses.size(); ++i)
    {
      const BorderPoint& point = this->BorderPoints[At(this->Uses[this->SharedUses[i]].Point)];
      const auto next =
        std::upper_bound(this->FirstPoint.begin(), this->FirstPoint.end(), point.Number);
      // cuts without a new point begin with the number of the next one
      const auto cut = static_cast<std::size_t>(next - this->FirstPoint.begin()) - 1;
      this->Cuts.Border(cut, border);
      std::size_t use = this->FirstUse[cut];
      while (this->Uses[use].Point != this->Uses[this->SharedUses[i]].Point)
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
      const BorderPoint& point = this->BorderPoints[At(this->Uses[this->FirstUse[c] + k++].Point)];
      if (point.Number == next)
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
  // of vertices:
  std::vector<char> Wanted;        ///< whether the part needs it
  std::vector<std::int64_t> Owner; ///< its first use
  std::vector<Eigen::Index> ValueOf;
  std::vector<int> SingleOf;                              ///< its point, or
  std::vector<std::vector<std::pair<int, int>>> PointsOf; ///< (patch, point)
  PointMatrix Values;
  std::vector<BorderPoint> BorderPoints;
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
