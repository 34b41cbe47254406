// SPDX-License-Identifier: BSD-3-Clause
#include "MeshTraces.h"

#include "TensorSpace.h"
#include "UnstructuredData.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace knotwork
{
namespace
{
constexpr double Tolerance = 1e-10; ///< of factors and rows, which are of the order of 1

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::string NameOf(const CellSide& facet)
{
  return "side " + std::to_string(facet.Side) + " of cell " + std::to_string(facet.Cell);
}

template <int Dim>
Status CheckFacets(const SplineSpace<Dim>& space, const std::vector<CellSide>& facets)
{
  if (space.Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the space is none on a mesh" };
  }
  if (facets.empty())
  {
    return { ErrorCode::EmptyInput, "no facets" };
  }
  const UnstructuredData<Dim>& data = *space.Unstructured;
  for (const CellSide& facet : facets)
  {
    if (facet.Cell < 0 || facet.Cell >= data.Topology.NumCells() || facet.Side < 0 ||
      facet.Side >= 2 * Dim)
    {
      return { ErrorCode::InvalidParameter, "there is no " + NameOf(facet) };
    }
    if (data.ContinuityOf(facet.Cell, facet.Side) > 0)
    {
      return { ErrorCode::InvalidParameter,
        "the spline crosses " + NameOf(facet) + " smoothly: mark it as a feature" };
    }
  }
  return {};
}

/// The side of a cell, or its neighbour's there, whichever is the lower.
template <int Dim>
int FacetNumber(const MeshTopology<Dim>& topology, const CellSide& facet)
{
  const int own = facet.Cell * 2 * Dim + facet.Side;
  const int other = topology.IsBoundary(facet.Cell, facet.Side)
    ? own
    : topology.Neighbour(facet.Cell, facet.Side) * 2 * Dim +
      topology.Crossing(facet.Cell, facet.Side).Side;
  return std::min(own, other);
}

/// The facet in which a trace goes on.
struct NextFacet
{
  int Number = -1; ///< FacetNumber; -1 where it ends
  int Continuity = -1;
};

/// Traces go on over a ridge as smoothly as the spline where there are just two cells between two
/// facets, on either side; else C^0 where just two facets meet.
/// @param isIn  by FacetNumber. @param facet  of the cell, at the ridge.
template <int Dim>
NextFacet GoOver(
  const UnstructuredData<Dim>& data, const std::set<int>& isIn, const CellSide& facet, int ridge)
{
  std::vector<int> numbers; // of the facets around the ridge
  std::vector<int> continuity;
  const auto add = [&](int cell, int side)
  {
    numbers.push_back(FacetNumber(data.Topology, { cell, side }));
    continuity.push_back(data.ContinuityOf(cell, side));
  };
  const bool closed = data.Topology.Around(facet.Cell, ridge,
    [&](int cell, int in, int out)
    {
      if (numbers.empty())
      {
        add(cell, in);
      }
      add(cell, out);
    });
  if (closed)
  {
    numbers.pop_back(); // is the first
  }
  const int count = static_cast<int>(numbers.size());
  const auto has = [&](int i) { return isIn.count(numbers[At(i)]) != 0; };
  const auto smoothest = [&](int from)
  {
    NextFacet next;
    for (const int step : { 1, -1 })
    {
      const bool isInside = closed || (from + 2 * step >= 0 && from + 2 * step < count);
      const int between = (from + step + count) % count;
      const int to = (from + 2 * step + 2 * count) % count;
      if (isInside && to != from && !has(between) && has(to) &&
        continuity[At(between)] > std::max(0, next.Continuity))
      {
        next = { to, continuity[At(between)] };
      }
    }
    return next;
  };
  const auto place = std::find(numbers.begin(), numbers.end(), FacetNumber(data.Topology, facet));
  const int own = static_cast<int>(place - numbers.begin());
  NextFacet next = smoothest(own);
  if (next.Number >= 0)
  {
    return smoothest(next.Number).Number == own
      ? NextFacet{ numbers[At(next.Number)], next.Continuity }
      : NextFacet();
  }
  std::vector<int> others;
  for (int i = 0; i < count; ++i)
  {
    if (i != own && has(i))
    {
      others.push_back(numbers[At(i)]);
    }
  }
  return others.size() == 1 ? NextFacet{ others[0], 0 } : NextFacet();
}

/// Where elements of a trace may be read: the facet's side of the cell, and its neighbour's.
template <int Dim>
std::vector<TraceElement<Dim - 1>> PlacesOf(
  const MeshTopology<Dim>& topology, const TraceElement<Dim - 1>& element)
{
  std::vector<TraceElement<Dim - 1>> places{ element };
  const auto [cell, side] = element.Facet;
  if (!topology.IsBoundary(cell, side))
  {
    const FacetCrossing<Dim>& crossing = topology.Crossing(cell, side);
    TraceElement<Dim - 1> other;
    other.Facet = { topology.Neighbour(cell, side), crossing.Side };
    for (std::size_t k = 0; k + 1 < Dim; ++k)
    {
      const int image = crossing.Image[At(2 * element.Direction[k])];
      other.Direction[k] = image / 2;
      other.Reversed[k] = element.Reversed[k] != (image % 2 == 1);
    }
    places.push_back(other);
  }
  return places;
}

/// Whether the elements have the same local functions there.
template <int Dim>
bool HasSameFactors(const SplineSpace<Dim>& whole, const SplineSpace<Dim - 1>& trace, int element,
  const TraceElement<Dim - 1>& place)
{
  const int p = whole.Elements[At(place.Facet.Cell)].Degree[0];
  const auto own = trace.Factors(element);
  const auto of = whole.Factors(place.Facet.Cell);
  const auto entry = [p](const double* factor, int i, int j) {
    return factor ? factor[i * (p + 1) + j] : i == j ? 1.0 : 0.0;
  };
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    const bool turned = place.Reversed[k];
    for (int i = 0; i <= p; ++i)
    {
      for (int j = 0; j <= p; ++j)
      {
        const double expected =
          entry(of[At(place.Direction[k])], turned ? p - i : i, turned ? p - j : j);
        if (!(std::abs(entry(own[k], i, j) - expected) <= Tolerance))
        {
          return false;
        }
      }
    }
  }
  return true;
}

/// Number of the cell's local function that a local function of the trace's element is.
template <int Dim>
int LocalIn(const SplineSpace<Dim>& whole, const TraceElement<Dim - 1>& place, int index)
{
  const int p = whole.Elements[At(place.Facet.Cell)].Degree[0];
  IntArray<Dim> at{};
  at[At(place.Facet.Side / 2)] = place.Facet.Side % 2 * p;
  for (std::size_t k = 0; k + 1 < Dim; ++k, index /= p + 1)
  {
    const int i = index % (p + 1);
    at[At(place.Direction[k])] = place.Reversed[k] ? p - i : i;
  }
  int local = 0;
  for (std::size_t d = Dim; d-- > 0;)
  {
    local = local * (p + 1) + at[d];
  }
  return local;
}

/// Row of T by function.
template <int Dim>
std::map<int, double> RowOf(const SplineSpace<Dim>& space, int local)
{
  if (space.IsIdentityMap())
  {
    return { { local, 1.0 } };
  }
  std::map<int, double> row;
  for (std::size_t i = space.RowStart[At(local)]; i < space.RowStart[At(local) + 1]; ++i)
  {
    row[space.RowFunction[i]] += space.RowCoefficient[i];
  }
  return row;
}

/// Finds the function of the whole that each function of the trace is; every element's local
/// functions must be the same combinations of these, and no other function be alive there.
template <int Dim>
Status MatchFunctions(const SplineSpace<Dim>& whole, MeshTrace<Dim - 1>& trace)
{
  const auto refuse = [](const CellSide& facet)
  {
    return Status(ErrorCode::NotInSpace,
      "the functions on " + NameOf(facet) +
        " are not independent there: facets end where the spline goes on smoothly, or on one that "
        "it crosses smoothly; leave them out, add those beyond, or mark those as features");
  };
  const SplineSpace<Dim - 1>& space = *trace.Space;
  trace.Functions.assign(At(space.NumFunctions), -1);
  struct Rows
  {
    std::map<int, double> Own, Of;
    CellSide Facet;
  };
  std::vector<Rows> rows;
  for (std::size_t e = 0; e < trace.Elements.size(); ++e)
  {
    const int element = static_cast<int>(e);
    const auto places = PlacesOf<Dim>(whole.Unstructured->Topology, trace.Elements[e]);
    const auto place = std::find_if(places.begin(), places.end(),
      [&](const auto& at) { return HasSameFactors<Dim>(whole, space, element, at); });
    if (place == places.end())
    {
      return refuse(trace.Elements[e].Facet);
    }
    const int* own = space.LocalFunctions(element);
    const int* of = whole.LocalFunctions(place->Facet.Cell);
    const int count = NumTensorFunctions<Dim - 1>(space.Elements[e].Degree);
    for (int i = 0; i < count; ++i)
    {
      rows.push_back({ RowOf<Dim - 1>(space, own[i]),
        RowOf<Dim>(whole, of[LocalIn<Dim>(whole, *place, i)]), place->Facet });
      const Rows& row = rows.back();
      if (row.Own.size() == 1 && row.Of.size() == 1)
      {
        trace.Functions[At(row.Own.begin()->first)] = row.Of.begin()->first;
      }
    }
  }
  for (const Rows& row : rows)
  {
    std::map<int, double> mapped = row.Of;
    for (const auto& [function, coefficient] : row.Own)
    {
      mapped[trace.Functions[At(function)]] -= coefficient;
    }
    if (std::any_of(mapped.begin(), mapped.end(),
          [](const auto& entry)
          { return entry.first < 0 || !(std::abs(entry.second) <= Tolerance); }))
    {
      return refuse(row.Facet);
    }
  }
  return {};
}

/// Curves of edges that follow each other.
class CurveFinder
{
public:
  CurveFinder(const SplineSpace<2>& space, const std::vector<CellSide>& facets)
    : Space(space), Data(*space.Unstructured), Facets(facets)
  {
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      const int number = FacetNumber(this->Data.Topology, facets[i]);
      this->IsIn.insert(number);
      this->PlaceOf[number] = static_cast<int>(i);
    }
    this->IsTaken.assign(facets.size(), 0);
  }

  Result<std::vector<MeshTrace<1>>> Find()
  {
    std::vector<MeshTrace<1>> curves;
    for (std::size_t i = 0; i < this->Facets.size(); ++i)
    {
      if (this->IsTaken[i] != 0)
      {
        continue;
      }
      auto curve = this->Follow(static_cast<int>(i));
      if (!curve)
      {
        return curve.Status;
      }
      curves.push_back(std::move(curve.Value));
    }
    return curves;
  }

private:
  struct Step
  {
    int Facet;
    bool Reversed; ///< against the direction of the cell
  };

  int PointOf(int facet, int end) const
  {
    const auto [cell, side] = this->Facets[static_cast<std::size_t>(facet)];
    return this->Data.Mesh.Cell(cell)[side % 2 << side / 2 | end << (1 - side / 2)];
  }
  double Length(const Step& step) const
  {
    const auto [cell, side] = this->Facets[static_cast<std::size_t>(step.Facet)];
    return this->Data.Length(cell, 1 - side / 2);
  }
  /// Over the end of a step.
  NextFacet Over(const Step& step) const
  {
    const CellSide& facet = this->Facets[static_cast<std::size_t>(step.Facet)];
    const int across = 2 * (1 - facet.Side / 2) + (step.Reversed ? 0 : 1);
    return GoOver<2>(this->Data, this->IsIn, facet, MeshTopology<2>::RidgeOf(facet.Side, across));
  }
  Step Next(const Step& step, const NextFacet& over) const
  {
    const int next = this->PlaceOf.at(over.Number);
    return { next, this->PointOf(next, 0) != this->PointOf(step.Facet, step.Reversed ? 0 : 1) };
  }

  Result<MeshTrace<1>> Follow(int first)
  {
    // back to where it begins, unless it closes, and from there on
    Step start{ first, false };
    bool closed = false;
    Step back{ first, true };
    for (NextFacet over; (over = this->Over(back)).Number >= 0;)
    {
      back = this->Next(back, over);
      start = { back.Facet, !back.Reversed };
      if (back.Facet == first)
      {
        closed = true;
        break;
      }
    }
    std::vector<Step> steps;
    std::vector<int> continuity; // at the ends of the steps
    for (Step at = start;;)
    {
      const NextFacet over = this->Over(at);
      steps.push_back(at);
      continuity.push_back(over.Continuity);
      this->IsTaken[static_cast<std::size_t>(at.Facet)] = 1;
      if (over.Number < 0)
      {
        break;
      }
      at = this->Next(at, over);
      if (at.Facet == start.Facet)
      {
        break;
      }
    }
    const auto crease = std::find(continuity.begin(), continuity.end(), 0);
    if (closed && crease != continuity.end()) // begins there
    {
      const auto shift = crease - continuity.begin() + 1;
      std::rotate(steps.begin(), steps.begin() + shift, steps.end());
      std::rotate(continuity.begin(), continuity.begin() + shift, continuity.end());
      closed = false;
    }
    return this->MakeCurve(steps, continuity, closed);
  }

  /// @param smooth  whether it closes without an end.
  Result<MeshTrace<1>> MakeCurve(
    const std::vector<Step>& steps, const std::vector<int>& continuity, bool smooth) const
  {
    const int p = this->Data.Degree;
    std::vector<double> knots;
    double at = 0.0;
    if (!smooth)
    {
      knots.assign(static_cast<std::size_t>(p) + 1, at);
    }
    else // p knots before the one at the beginning
    {
      std::vector<double> before;
      double from = 0.0;
      for (std::size_t i = steps.size(); before.size() < static_cast<std::size_t>(p) + 1;)
      {
        before.insert(before.end(), static_cast<std::size_t>(p - continuity[i - 1]), from);
        from -= this->Length(steps[i - 1]);
        i = i == 1 ? steps.size() : i - 1;
      }
      before.resize(static_cast<std::size_t>(p) + 1);
      knots.assign(before.rbegin(), before.rend());
    }
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
      at += this->Length(steps[i]);
      const bool last = i + 1 == steps.size();
      if (!last)
      {
        knots.insert(knots.end(), static_cast<std::size_t>(p - continuity[i]), at);
      }
    }
    if (!smooth)
    {
      knots.insert(knots.end(), static_cast<std::size_t>(p) + 1, at);
    }
    else
    {
      const std::size_t size = knots.size() + static_cast<std::size_t>(p) + 1;
      for (std::size_t i = steps.size(); knots.size() < size;)
      {
        knots.insert(knots.end(), static_cast<std::size_t>(p - continuity[i - 1]), at);
        i = i == steps.size() ? 1 : i + 1;
        at += this->Length(steps[i - 1]);
      }
      knots.resize(size);
    }
    auto created = KnotVector::Create(p, knots);
    if (!created)
    {
      return created.Status;
    }
    auto space = MakeTensorSpace<1>({ created.Value });
    if (!space)
    {
      return space.Status;
    }
    MeshTrace<1> trace;
    trace.Space = space.Value;
    for (const Step& step : steps)
    {
      TraceElement<1> element;
      element.Facet = this->Facets[static_cast<std::size_t>(step.Facet)];
      element.Direction = { 1 - element.Facet.Side / 2 };
      element.Reversed = { step.Reversed };
      trace.Elements.push_back(element);
    }
    if (Status status = MatchFunctions<2>(this->Space, trace); !status)
    {
      return status;
    }
    return trace;
  }

  const SplineSpace<2>& Space;
  const UnstructuredData<2>& Data;
  const std::vector<CellSide>& Facets;
  std::set<int> IsIn;         ///< by FacetNumber
  std::map<int, int> PlaceOf; ///< of facets by their numbers
  std::vector<char> IsTaken;
};
}

template <int Dim>
std::vector<CellSide> BoundaryFacets(const MeshTopology<Dim>& topology)
{
  std::vector<CellSide> facets;
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      if (topology.IsBoundary(c, side))
      {
        facets.push_back({ c, side });
      }
    }
  }
  return facets;
}

Result<MeshTrace<2>> TraceOnFacets(const SplineSpace<3>& space, const std::vector<CellSide>& facets)
{
  if (const Status status = CheckFacets<3>(space, facets); !status)
  {
    return status;
  }
  const UnstructuredData<3>& data = *space.Unstructured;
  MeshTrace<2> trace;
  CellMesh<2> mesh;
  std::map<int, int> pointOf;
  std::set<int> isIn;
  for (const CellSide& facet : facets)
  {
    isIn.insert(FacetNumber(data.Topology, facet));
    const int first = facet.Side / 2 == 0 ? 1 : 0;
    const int second = facet.Side / 2 == 2 ? 1 : 2;
    TraceElement<2> element;
    element.Facet = facet;
    // the surface's normal points out of the cell
    const bool swap = (facet.Side % 2 == 1) == (facet.Side / 2 == 1);
    element.Direction = { swap ? second : first, swap ? first : second };
    trace.Elements.push_back(element);
    for (int corner = 0; corner < 4; ++corner)
    {
      const int at = facet.Side % 2 << facet.Side / 2 | (corner & 1) << element.Direction[0] |
        (corner >> 1) << element.Direction[1];
      const int point = data.Mesh.Cell(facet.Cell)[at];
      mesh.Corners.push_back(
        pointOf.try_emplace(point, static_cast<int>(pointOf.size())).first->second);
    }
  }
  mesh.NumPoints = static_cast<int>(pointOf.size());
  const auto topology = MeshTopology<2>::Make(mesh);
  if (!topology)
  {
    return { topology.Status.Code,
      "the facets, numbered as cells, are no surface: " + topology.Status.Detail };
  }
  std::vector<int> continuity;
  std::vector<double> lengths;
  const auto sheets = topology->FindSheets();
  lengths.resize(data.Lengths.empty() ? 0 : At(sheets.Count));
  for (std::size_t e = 0; e < facets.size(); ++e)
  {
    const TraceElement<2>& element = trace.Elements[e];
    const int side = element.Facet.Side;
    for (int k = 0; k < 4; ++k)
    {
      const int across = 2 * element.Direction[At(k / 2)] + k % 2;
      const int ridge = MeshTopology<3>::RidgeOf(side, across);
      continuity.push_back(topology->IsBoundary(static_cast<int>(e), k)
          ? -1
          : std::max(0, GoOver<3>(data, isIn, element.Facet, ridge).Continuity));
    }
    for (std::size_t k = 0; k < 2 && !lengths.empty(); ++k)
    {
      lengths[At(sheets.Of[2 * e + k])] = data.Length(element.Facet.Cell, element.Direction[k]);
    }
  }
  auto made = MakeUnstructuredSpace<2>(mesh, data.Degree, continuity, lengths);
  if (!made)
  {
    return { made.Status.Code, "on the facets, numbered as cells: " + made.Status.Detail };
  }
  trace.Space = std::move(made.Value);
  if (Status status = MatchFunctions<3>(space, trace); !status)
  {
    return status;
  }
  return trace;
}

Result<std::vector<MeshTrace<1>>> TraceOnFacets(
  const SplineSpace<2>& space, const std::vector<CellSide>& facets)
{
  if (const Status status = CheckFacets<2>(space, facets); !status)
  {
    return status;
  }
  return CurveFinder(space, facets).Find();
}

template <int Dim>
Spline<Dim> TraceOf(const Spline<Dim + 1>& spline, const MeshTrace<Dim>& trace)
{
  Spline<Dim> result;
  result.Space = trace.Space;
  const auto count = static_cast<Eigen::Index>(trace.Functions.size());
  result.ControlPoints.resize(count, spline.ControlPoints.cols());
  result.Weights.resize(spline.IsRational() ? count : 0);
  for (Eigen::Index f = 0; f < count; ++f)
  {
    const int function = trace.Functions[static_cast<std::size_t>(f)];
    result.ControlPoints.row(f) = spline.ControlPoints.row(function);
    if (spline.IsRational())
    {
      result.Weights[f] = spline.Weights[function];
    }
  }
  return result;
}

template std::vector<CellSide> BoundaryFacets<2>(const MeshTopology<2>&);
template std::vector<CellSide> BoundaryFacets<3>(const MeshTopology<3>&);
template Spline<1> TraceOf<1>(const Spline<2>&, const MeshTrace<1>&);
template Spline<2> TraceOf<2>(const Spline<3>&, const MeshTrace<2>&);
}
