// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressiveFit.h"

#include "ElementPatch.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/MeshTraces.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Corner of a cell at a point.
template <int Dim>
int CornerOf(const CellMesh<Dim>& mesh, int cell, int point)
{
  return static_cast<int>(
    std::find(mesh.Cell(cell), mesh.Cell(cell) + (1 << Dim), point) - mesh.Cell(cell));
}

/// Sides of a cell that two corners on a common edge have in common.
template <int Dim>
std::vector<int> SidesOfEdge(int a, int b)
{
  std::vector<int> sides;
  for (int d = 0; d < Dim; ++d)
  {
    if ((a >> d & 1) == (b >> d & 1))
    {
      sides.push_back(2 * d + (a >> d & 1));
    }
  }
  return sides;
}

/// Inner facets at an edge of the surface.
template <int Dim>
void AddFacetsAt(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const SurfaceMesh& surface, int edge, std::vector<CellSide>& facets)
{
  const int cell = surface.Facets[At(surface.QuadsOf[At(edge)][0])].Cell;
  const auto [first, second] = surface.Edges[At(edge)];
  const auto sides = SidesOfEdge<Dim>(CornerOf(mesh, cell, first), CornerOf(mesh, cell, second));
  if constexpr (Dim == 2)
  {
    if (!topology.IsBoundary(cell, sides[0]))
    {
      facets.push_back({ cell, sides[0] });
    }
  }
  else
  {
    topology.Around(cell, MeshTopology<3>::RidgeOf(sides[0], sides[1]),
      [&](int at, int, int out)
      {
        if (!topology.IsBoundary(at, out))
        {
          facets.push_back({ at, out });
        }
      });
  }
}

/// Values of a function of the whole at points of an element of a trace, each of Dim parameters
/// fewer: the function of the whole there.
template <int Dim, int Whole>
PointMatrix Lift(const TraceElement<Dim>& element, const PointMatrix& local)
{
  PointMatrix lifted(local.rows(), Whole);
  lifted.col(element.Facet.Side / 2).setConstant(element.Facet.Side % 2);
  for (std::size_t k = 0; k < Dim; ++k)
  {
    const auto column = static_cast<Eigen::Index>(k);
    lifted.col(element.Direction[k]) = element.Reversed[k]
      ? PointMatrix(1.0 - local.col(column).array())
      : PointMatrix(local.col(column));
  }
  return lifted;
}

/// A function whose values are moved to the target; the part of every element is given.
class OntoTarget
{
public:
  OntoTarget(const FitTarget& target, const std::vector<TargetPart>& parts)
    : Target(target), Parts(parts)
  {
  }
  /// @return false when there is no closest point.
  bool Move(int element, PointMatrix& values) const
  {
    TargetPoints feet;
    Status status = this->Target.Find(this->Parts[At(element)], values, feet);
    if (!status)
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      if (this->FirstElement < 0 || element < this->FirstElement)
      {
        this->FirstElement = element;
        this->First = std::move(status);
      }
      return false;
    }
    values = std::move(feet.Points);
    return true;
  }
  /// What the target said of the first element that failed.
  Status Explain(Status status) const
  {
    return this->FirstElement >= 0 && !status ? this->First : status;
  }

private:
  const FitTarget& Target;
  const std::vector<TargetPart>& Parts;
  mutable std::mutex Mutex;
  mutable int FirstElement = -1;
  mutable Status First;
};

template <int Dim>
class Steps
{
public:
  Steps(const FastPath<Dim>& path, const SurfaceMesh& surface, const MeshClassification& parts,
    const PointMatrix& points, const FitTarget* target, const ProgressiveFitParams& params,
    const Spline<Dim>* from)
    : Path(path), Space(path.Space), Surface(surface), Parts(parts), Target(target), Params(params),
      Map(from ? EvaluateSpline(*from)
               : InterpolateVertices<Dim>(path.Space, points, params.LinearCells))
  {
  }

  Result<ProgressiveFit<Dim>> Run()
  {
    Status status = this->FitWhole();
    for (int pass = 0; status && pass < this->Params.Projections; ++pass)
    {
      if (pass > 0)
      {
        this->Map = EvaluateSpline(this->Fit.Value);
        this->Fit.Warnings.clear();
      }
      status = this->Target ? this->FitToTarget() : Status();
      status = status ? this->Path.Complete(this->Fit.Value) : status;
    }
    return status ? Result<ProgressiveFit<Dim>>(std::move(this->Fit)) : status;
  }

private:
  /// From the surface to corners, each overwriting what is there; or from corners to the volume,
  /// each with the coefficients that are there.
  Status FitToTarget()
  {
    Status status = this->TraceSurface();
    const bool isSurface = this->Params.Surfaces && this->Target->HasSurface();
    if (status && isSurface && !this->Params.Constrain)
    {
      status = this->FitSurface();
    }
    this->Given.clear(); // curves and corners from here on
    if (status && this->Params.Points && this->Params.Constrain)
    {
      this->FitCorners();
    }
    status = status && this->Params.Curves ? this->FitCurves() : status;
    if (status && this->Params.Points && !this->Params.Constrain)
    {
      this->FitCorners();
    }
    this->Fit.OnCurves.clear();
    for (const auto& [function, row] : this->Given)
    {
      this->Fit.OnCurves.push_back(function);
    }
    if (status && this->Params.Constrain)
    {
      status = isSurface ? this->FitSurface() : status;
      status = status && (Dim == 3 || !isSurface || this->IsPart()) ? this->FitAround() : status;
    }
    return status;
  }

  static ElementFunction EvaluateSpline(const Spline<Dim>& spline)
  {
    return [form = MakeBezierForm(spline, 1)](
             int element, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
    {
      EvaluationParams params;
      params.Threads = 1;
      EvaluationBatch batch;
      const std::vector<int> elements(static_cast<std::size_t>(local.rows()), element);
      const Status status = EvaluateElements<Dim>(form, elements, local, params, batch);
      values = batch.Values;
      return static_cast<bool>(status);
    };
  }

  ProjectionParams Projection(double begin, double end) const
  {
    ProjectionParams params;
    params.ExtraPoints = this->Params.ExtraPoints;
    params.Threads = this->Params.Threads;
    if (this->Params.Progress)
    {
      params.Progress = [this, begin, end](double share)
      { return this->Params.Progress(begin + share * (end - begin)); };
    }
    return params;
  }

  /// The map of the mesh; of quadrilaterals at once on the target.
  Status FitWhole()
  {
    auto made = this->Path.ProjectWhole(this->Map, this->Projection(0.0, 0.3));
    this->Fit.Before = std::move(made.Value);
    this->Fit.Value = this->Fit.Before;
    return made.Status;
  }

  std::vector<TargetPart> FaceParts() const
  {
    std::vector<TargetPart> parts;
    for (const int face : this->Parts.FaceOf)
    {
      parts.push_back({ face < 0 ? TargetEntity::Surface : TargetEntity::Face, face });
    }
    return parts;
  }

  /// Whether some of the quadrilaterals are fitted.
  bool IsPart() const
  {
    return Dim == 2 && this->Surface.Facets.size() < At(this->Space->NumElements());
  }

  Status TraceSurface()
  {
    if constexpr (Dim == 3)
    {
      auto trace = TraceOnFacets(*this->Space, this->Surface.Facets);
      this->Trace = std::move(trace.Value);
      return trace.Status;
    }
    else if (this->IsPart())
    {
      this->Trace = PartOnFacets(*this->Space, this->Surface.Facets);
    }
    return {};
  }

  Status FitSurface()
  {
    const std::vector<TargetPart> parts = this->FaceParts();
    const OntoTarget onto(*this->Target, parts);
    const ProjectionParams params = this->Projection(0.3, 0.9);
    Status status;
    if (Dim == 2 && !this->IsPart())
    {
      status = this->FitQuadrilaterals(onto, params);
    }
    else
    {
      const auto made = this->ProjectAround<2>(
        this->Trace.Space, this->Trace.Functions,
        [&](
          int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)
        {
          const TraceElement<2>& at = this->Trace.Elements[At(element)];
          const PointMatrix inside = Dim == 2 ? local : Lift<2, 3>(at, local);
          return this->Map(at.Facet.Cell, inside, parameters, values) && onto.Move(element, values);
        },
        params);
      status = made.Status;
      if (made)
      {
        this->Put(this->Trace.Functions, made->ControlPoints);
      }
    }
    return onto.Explain(status);
  }

  /// All quadrilaterals.
  Status FitQuadrilaterals(const OntoTarget& onto, const ProjectionParams& params)
  {
    if constexpr (Dim == 2)
    {
      const auto map = [&](int element, const PointMatrix& local, const PointMatrix& parameters,
                         PointMatrix& values)
      { return this->Map(element, local, parameters, values) && onto.Move(element, values); };
      auto made = this->Params.Constrain
        ? this->ProjectAround<2>(this->Space, this->OwnFunctions(), map, params)
        : this->Path.Project(map, params);
      if (made)
      {
        this->Fit.Value = std::move(made.Value);
      }
      return made.Status;
    }
    return {};
  }

  /// The whole anew with the coefficients that its surface, or its curves, have.
  Status FitAround()
  {
    auto made = this->ProjectAround<Dim>(
      this->Space, this->OwnFunctions(), this->Map, this->Projection(0.9, 1.0));
    if (made)
    {
      this->Fit.Value = std::move(made.Value);
    }
    return made.Status;
  }

  std::vector<int> OwnFunctions() const
  {
    std::vector<int> functions(At(this->Space->NumFunctions));
    std::iota(functions.begin(), functions.end(), 0);
    return functions;
  }

  /// With the coefficients that are given where these constrain.
  /// @param functions  of the whole, of every function of the space.
  template <int D>
  Result<Spline<D>> ProjectAround(const SplineSpacePtr<D>& space, const std::vector<int>& functions,
    const ElementFunction& map, const ProjectionParams& params) const
  {
    std::vector<int> own;
    PointMatrix rows(static_cast<Eigen::Index>(this->Params.Constrain ? functions.size() : 0), 3);
    for (std::size_t i = 0; this->Params.Constrain && i < functions.size(); ++i)
    {
      if (const auto given = this->Given.find(functions[i]); given != this->Given.end())
      {
        rows.row(static_cast<Eigen::Index>(own.size())) = given->second;
        own.push_back(static_cast<int>(i));
      }
    }
    return ProjectWithCoefficients<D>(
      space, map, own, rows.topRows(static_cast<Eigen::Index>(own.size())), params);
  }

  /// Coefficients of functions of the whole.
  void Put(const std::vector<int>& functions, const PointMatrix& rows)
  {
    for (std::size_t i = 0; i < functions.size(); ++i)
    {
      const Eigen::RowVector3d row = rows.row(static_cast<Eigen::Index>(i));
      this->Fit.Value.ControlPoints.row(functions[i]) = row;
      this->Given[functions[i]] = row;
    }
  }

  /// The edge as a side of an element of the surface's space.
  CellSide FacetOfEdge(int edge) const
  {
    const int quad = this->Surface.QuadsOf[At(edge)][0];
    const CellSide facet = this->Surface.Facets[At(quad)];
    const CellMesh<Dim>& mesh = MeshOf(*this->Space);
    const int a = CornerOf(mesh, facet.Cell, this->Surface.Edges[At(edge)][0]);
    const int b = CornerOf(mesh, facet.Cell, this->Surface.Edges[At(edge)][1]);
    if constexpr (Dim == 2)
    {
      return { facet.Cell, SidesOfEdge<2>(a, b)[0] };
    }
    else
    {
      const TraceElement<2>& element = this->Trace.Elements[At(quad)];
      const auto onTrace = [&](int corner)
      {
        int own = 0;
        for (std::size_t k = 0; k < 2; ++k)
        {
          own |= ((corner >> element.Direction[k] & 1) ^ (element.Reversed[k] ? 1 : 0)) << k;
        }
        return own;
      };
      return { quad, SidesOfEdge<2>(onTrace(a), onTrace(b))[0] };
    }
  }

  Status FitCurves()
  {
    std::map<std::pair<int, int>, std::vector<int>> edgesOf; // curve, or -1 and the face of a rim
    for (std::size_t e = 0; e < this->Surface.Edges.size(); ++e)
    {
      const bool isFreeRim = this->Surface.QuadsOf[e][1] == Rim && this->Target->HasSurface();
      const int curve = this->Parts.CurveOf[e];
      if (curve >= 0)
      {
        edgesOf[{ curve, -1 }].push_back(static_cast<int>(e));
      }
      else if (isFreeRim)
      {
        const int face = this->Parts.FaceOf[At(this->Surface.QuadsOf[e][0])];
        edgesOf[{ -1, face }].push_back(static_cast<int>(e));
      }
    }
    for (const auto& [key, edges] : edgesOf)
    {
      TargetPart part{ TargetEntity::Curve, key.first };
      if (key.first < 0)
      {
        part = { key.second < 0 ? TargetEntity::Surface : TargetEntity::Face, key.second };
      }
      Status status = this->FitCurve(part, edges);
      if (status.Code == ErrorCode::InvalidParameter || status.Code == ErrorCode::NotInSpace)
      {
        this->Fit.Warnings.push_back(
          "curve " + std::to_string(key.first) + " is not fitted by itself: " + status.Detail);
      }
      else if (!status)
      {
        return status;
      }
    }
    return {};
  }

  Status FitCurve(const TargetPart& part, const std::vector<int>& edges)
  {
    std::vector<CellSide> facets;
    for (const int edge : edges)
    {
      facets.push_back(this->FacetOfEdge(edge));
    }
    knotwork::Result<std::vector<MeshTrace<1>>> traces;
    if constexpr (Dim == 2)
    {
      traces = TraceOnFacets(*this->Space, facets);
    }
    else
    {
      traces = TraceOnFacets(*this->Trace.Space, facets);
    }
    if (!traces)
    {
      return traces.Status;
    }
    for (const MeshTrace<1>& trace : traces.Value)
    {
      const std::vector<TargetPart> parts(trace.Elements.size(), part);
      const OntoTarget onto(*this->Target, parts);
      std::vector<int> functions = trace.Functions;
      if constexpr (Dim == 3)
      {
        for (int& function : functions)
        {
          function = this->Trace.Functions[At(function)];
        }
      }
      const auto made = this->ProjectAround<1>(
        trace.Space, functions,
        [&](
          int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)
        {
          const TraceElement<1>& at = trace.Elements[At(element)];
          const PointMatrix onSurface = Lift<1, 2>(at, local);
          if constexpr (Dim == 2)
          {
            return this->Map(at.Facet.Cell, onSurface, parameters, values) &&
              onto.Move(element, values);
          }
          else
          {
            const TraceElement<2>& face = this->Trace.Elements[At(at.Facet.Cell)];
            return this->Map(face.Facet.Cell, Lift<2, 3>(face, onSurface), parameters, values) &&
              onto.Move(element, values);
          }
        },
        this->Projection(0.9, 1.0));
      if (!made)
      {
        return onto.Explain(made.Status);
      }
      this->Put(functions, made->ControlPoints);
    }
    return {};
  }

  /// Control points that are values of the spline at corners.
  void FitCorners()
  {
    const CellMesh<Dim>& mesh = MeshOf(*this->Space);
    std::set<int> smooth;
    std::set<int> done;
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        const int point = mesh.Cell(c)[corner];
        const TargetPart& part = this->Parts.PointParts[At(point)];
        if (part.Entity != TargetEntity::Vertex || done.count(point) != 0)
        {
          continue;
        }
        const int function = this->FunctionOfCorner(c, corner);
        if (function >= 0)
        {
          this->Put({ function }, this->Target->Vertices().row(part.Id));
          done.insert(point);
        }
        smooth.insert(point);
      }
    }
    for (const int point : smooth)
    {
      if (done.count(point) == 0)
      {
        this->Fit.Warnings.push_back("the spline is smooth at point " + std::to_string(point) +
          ", which is a corner of the target");
      }
    }
  }

  /// Function whose control point is the spline's value there, -1: none.
  int FunctionOfCorner(int cell, int corner) const
  {
    const SplineSpace<Dim>& space = *this->Space;
    const int degree = space.Elements[At(cell)].Degree[0];
    int local = 0;
    for (int d = Dim - 1; d >= 0; --d)
    {
      const int end = (corner >> d & 1) * degree;
      const double* factor = space.Factor(cell, d);
      if (factor && factor[end * (degree + 1) + end] != 1.0)
      {
        return -1;
      }
      local = local * (degree + 1) + end;
    }
    const int row = space.LocalFunctions(cell)[local];
    if (space.IsIdentityMap())
    {
      return row;
    }
    const std::size_t begin = space.RowStart[At(row)];
    const bool isUnit =
      space.RowStart[At(row) + 1] == begin + 1 && space.RowCoefficient[begin] == 1.0;
    return isUnit ? space.RowFunction[begin] : -1;
  }

  const FastPath<Dim>& Path;
  const SplineSpacePtr<Dim>& Space;
  const SurfaceMesh& Surface;
  const MeshClassification& Parts;
  const FitTarget* Target; ///< null: none
  const ProgressiveFitParams& Params;
  ElementFunction Map;                     ///< of the whole: through the points, or the fit before
  MeshTrace<2> Trace;                      ///< of volumes and of parts
  std::map<int, Eigen::RowVector3d> Given; ///< coefficients that were fitted to the target
  ProgressiveFit<Dim> Fit;
};
}

template <int Dim>
std::vector<CellSide> FeatureFacets(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const SurfaceMesh& surface, const MeshClassification& parts)
{
  std::vector<CellSide> facets;
  const auto isSharp = [&](int edge)
  { return parts.CurveOf[At(edge)] >= 0 || surface.QuadsOf[At(edge)][1] < 0; };
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    if (parts.CurveOf[e] >= 0)
    {
      AddFacetsAt(mesh, topology, surface, static_cast<int>(e), facets);
    }
  }
  for (const int point : surface.Points)
  {
    if (parts.PointParts[At(point)].Entity != TargetEntity::Vertex)
    {
      continue;
    }
    surface.ForEdges(point,
      [&](int edge)
      {
        // the only edge between two sharp ones: the surface may go straight on beside it
        bool isBetween = !isSharp(edge);
        for (const int quad : surface.QuadsOf[At(edge)])
        {
          for (std::size_t k = 0; isBetween && k < 4; ++k)
          {
            const int other = surface.EdgesOf[At(quad)][k];
            const auto& ends = surface.Edges[At(other)];
            const bool isAtPoint = other != edge && (ends[0] == point || ends[1] == point);
            isBetween = !isAtPoint || isSharp(other);
          }
        }
        if (isBetween)
        {
          AddFacetsAt(mesh, topology, surface, edge, facets);
        }
      });
  }
  return facets;
}

template <int Dim>
std::vector<CellSide> Prolong(
  const MeshTopology<Dim>& topology, const std::vector<CellSide>& facets)
{
  std::vector<char> isIn(At(topology.NumCells()) * 2 * Dim, 0);
  std::vector<CellSide> all;
  const auto add = [&](const CellSide& facet)
  {
    char& own = isIn[At(facet.Cell) * 2 * Dim + At(facet.Side)];
    if (own == 0)
    {
      const int other = topology.Neighbour(facet.Cell, facet.Side);
      const int side = topology.Crossing(facet.Cell, facet.Side).Side;
      own = 1;
      isIn[At(other) * 2 * Dim + At(side)] = 1;
      all.push_back(facet);
    }
  };
  std::for_each(facets.begin(), facets.end(), add);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const CellSide facet = all[i];
    for (int across = 0; across < 2 * Dim; ++across)
    {
      if (across / 2 != facet.Side / 2 &&
        topology.IsRegularInside(facet.Cell, MeshTopology<Dim>::RidgeOf(facet.Side, across)))
      {
        add(topology.Opposite(facet.Cell, facet.Side, across));
      }
    }
  }
  return all;
}

template <int Dim>
Result<ProgressiveFit<Dim>> FitProgressively(const FastPath<Dim>& path, const SurfaceMesh& surface,
  const MeshClassification& parts, const PointMatrix& points, const FitTarget* target,
  const ProgressiveFitParams& params, const Spline<Dim>* from)
{
  return Steps<Dim>(path, surface, parts, points, target, params, from).Run();
}

template std::vector<CellSide> FeatureFacets(
  const CellMesh<2>&, const MeshTopology<2>&, const SurfaceMesh&, const MeshClassification&);
template std::vector<CellSide> FeatureFacets(
  const CellMesh<3>&, const MeshTopology<3>&, const SurfaceMesh&, const MeshClassification&);
template std::vector<CellSide> Prolong(const MeshTopology<2>&, const std::vector<CellSide>&);
template std::vector<CellSide> Prolong(const MeshTopology<3>&, const std::vector<CellSide>&);
template Result<ProgressiveFit<2>> FitProgressively(const FastPath<2>&, const SurfaceMesh&,
  const MeshClassification&, const PointMatrix&, const FitTarget*, const ProgressiveFitParams&,
  const Spline<2>*);
template Result<ProgressiveFit<3>> FitProgressively(const FastPath<3>&, const SurfaceMesh&,
  const MeshClassification&, const PointMatrix&, const FitTarget*, const ProgressiveFitParams&,
  const Spline<3>*);
}
