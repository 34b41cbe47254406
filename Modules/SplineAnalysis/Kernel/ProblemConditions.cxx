// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryEdges.h"
#include "ProblemDescription.h"
#include "StiffnessMatrix.h"
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
using Samples = std::vector<std::array<double, 3>>;

/// A place of the body with the normal there; coordinates that the plane does not have are 0.
struct Place
{
  std::array<double, 3> Point{};
  std::array<double, 3> Normal{};
};

Place PlaceAt(const GalerkinSpace& space, int element, const double* u, const FacetFrame* frame)
{
  PointValues values;
  EvaluateFunctions(space, element, u, values);
  Place place;
  std::copy(values.Position.begin(), values.Position.end(), place.Point.begin());
  if (frame)
  {
    const Eigen::VectorXd normal = AreaVector(*frame, values).normalized();
    std::copy(normal.begin(), normal.end(), place.Normal.begin());
  }
  return place;
}

/// Samples of a facet in its own parameters: corners, middles of edges, middle.
Samples FacetSamples(CellShape shape)
{
  if (NumParameters(shape) == 2)
  {
    return { { 0, 0, 0 }, { 0.5, 0, 0 }, { 1, 0, 0 } };
  }
  if (shape == CellShape::Tetrahedron)
  {
    return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 }, { 0.5, 0.5, 0 }, { 0, 0.5, 0 },
      { 1.0 / 3.0, 1.0 / 3.0, 0 } };
  }
  Samples samples;
  for (const double v : { 0.0, 0.5, 1.0 })
  {
    for (const double u : { 0.0, 0.5, 1.0 })
    {
      samples.push_back({ u, v, 0.0 });
    }
  }
  return samples;
}

/// Of every component; one that is free is 0.
Result<std::vector<ScalarFunction>> CompileValues(
  const ProblemValues& values, const std::string& place, const CompileExpression& compile)
{
  std::vector<ScalarFunction> functions;
  for (const std::optional<ProblemValue>& value : values)
  {
    if (!value || value->Expression.empty())
    {
      const double number = value ? value->Number : 0.0;
      functions.push_back([number](const double*, const double*) { return number; });
      continue;
    }
    auto compiled = compile(value->Expression);
    if (!compiled)
    {
      return { compiled.Status.Code, place + ": " + compiled.Status.Detail };
    }
    functions.push_back(std::move(compiled.Value));
  }
  return functions;
}

/// Unset without values.
Result<PointFunction> MakePointFunction(const ProblemValues& values, const std::string& place,
  int dimension, const CompileExpression& compile)
{
  auto compiled = CompileValues(values, place, compile);
  if (!compiled || values.empty())
  {
    return compiled ? Result<PointFunction>(PointFunction())
                    : Result<PointFunction>(compiled.Status);
  }
  return PointFunction(
    [functions = std::move(compiled.Value), dimension](const double* x, double* into)
    {
      std::array<double, 3> at{};
      std::copy_n(x, dimension, at.begin());
      const std::array<double, 3> none{};
      for (std::size_t k = 0; k < functions.size(); ++k)
      {
        into[k] = functions[k](at.data(), none.data());
      }
    });
}

class ProblemBuilder
{
public:
  ProblemBuilder(const ProblemDescription& description, const GalerkinSpace& space,
    const BoundaryGroups& boundary, const CompileExpression& compile)
    : Description(description), Space(space), Boundary(boundary), Compile(compile),
      Components(NumSolutionComponents(description.Equation))
  {
    this->Lower = space.Points.colwise().minCoeff().transpose();
    this->Upper = space.Points.colwise().maxCoeff().transpose();
    this->Size = (this->Upper - this->Lower).norm();
  }

  Result<GalerkinProblem> Make(std::vector<ConditionPlace>* places)
  {
    this->Problem.Equation = this->Description.Equation;
    this->Problem.Materials = this->Description.Materials;
    auto source =
      MakePointFunction(this->Description.Source, "source", this->Space.Dimension, this->Compile);
    if (!source)
    {
      return source.Status;
    }
    this->Problem.Source = std::move(source.Value);
    for (std::size_t i = 0; i < this->Description.Conditions.size(); ++i)
    {
      this->Name = "condition " + std::to_string(i);
      this->Chosen = {};
      if (const Status status = this->Add(this->Description.Conditions[i]); !status)
      {
        return status;
      }
      if (places)
      {
        places->push_back(this->Chosen);
      }
    }
    return std::move(this->Problem);
  }

private:
  /// Whether samples lie in the region's box and where its expression holds.
  bool Holds(const ProblemRegion& region, const ScalarFunction& where, const Place& place) const
  {
    const double slack = 1e-9 * this->Size;
    for (std::size_t d = 0; region.Box && d < 3; ++d)
    {
      if (place.Point[d] < (*region.Box)[2 * d] - slack ||
        place.Point[d] > (*region.Box)[2 * d + 1] + slack)
      {
        return false;
      }
    }
    return !where || where(place.Point.data(), place.Normal.data()) != 0.0;
  }

  Result<ScalarFunction> Where(const ProblemRegion& region) const
  {
    if (region.Where.empty())
    {
      return ScalarFunction();
    }
    auto compiled = this->Compile(region.Where);
    return compiled ? std::move(compiled)
                    : Result<ScalarFunction>(
                        Status{ compiled.Status.Code, this->Name + ": " + compiled.Status.Detail });
  }

  /// Facets of the boundary by what they are, not by where they lie.
  Result<std::vector<std::size_t>> Candidates(const ProblemRegion& region) const
  {
    std::optional<long long> group = region.Group;
    if (!region.GroupName.empty())
    {
      const auto found = this->Boundary.Names.find(region.GroupName);
      if (found == this->Boundary.Names.end())
      {
        std::string known;
        for (const auto& name : this->Boundary.Names)
        {
          known += (known.empty() ? "" : ", ") + name.first;
        }
        return { ErrorCode::InvalidParameter,
          this->Name + ": there is no group \"" + region.GroupName + "\"" +
            (known.empty() ? "; the input names no groups" : "; there are: " + known) };
      }
      group = found->second;
    }
    if (group && this->Boundary.Groups.empty())
    {
      return { ErrorCode::InvalidParameter,
        this->Name +
          ": the input has no groups of facets, which are cells on its boundary with a cell array "
          "PhysicalGroup; choose by side, box or where" };
    }
    std::vector<std::size_t> candidates;
    std::set<long long> groups;
    std::set<int> patches;
    for (std::size_t i = 0; i < this->Boundary.Facets.size(); ++i)
    {
      const CellSide& facet = this->Boundary.Facets[i];
      const int patch = this->Space.Patches[static_cast<std::size_t>(facet.Cell)];
      patches.insert(patch);
      if (group)
      {
        const auto& own = this->Boundary.Groups[i];
        groups.insert(own.begin(), own.end());
        if (std::find(own.begin(), own.end(), *group) == own.end())
        {
          continue;
        }
      }
      if ((region.Patch < 0 || patch == region.Patch) &&
        (region.Side < 0 || facet.Side == region.Side))
      {
        candidates.push_back(i);
      }
    }
    if (!candidates.empty())
    {
      return candidates;
    }
    std::string what;
    if (group)
    {
      what = ": no facet of the boundary is of group " + std::to_string(*group) + "; there are";
      for (const long long known : groups)
      {
        what += " " + std::to_string(known);
      }
    }
    else
    {
      what = ": no facet of the boundary is on" +
        (region.Side >= 0 ? " side " + std::to_string(region.Side) : std::string()) +
        (region.Patch >= 0 ? " of patch " + std::to_string(region.Patch) : std::string()) +
        "; patches are counted from 0, have sides 0 to " +
        std::to_string(2 * this->Space.Dimension - 1) + ", and there are " +
        std::to_string(patches.size()) + " with sides that no other patch shares";
    }
    return { ErrorCode::InvalidParameter, this->Name + what };
  }

  Status NothingThere(const char* what) const
  {
    return { ErrorCode::InvalidParameter,
      this->Name + " selects no " + what +
        ": none lies there with all of its samples; the body is " + "between " +
        PointText(this->Lower.data(), this->Space.Dimension) + " and " +
        PointText(this->Upper.data(), this->Space.Dimension) };
  }

  Status ChooseFacets(const ProblemRegion& region)
  {
    if (region.Side >= 0 && this->Space.IsNodal)
    {
      return { ErrorCode::InvalidParameter,
        this->Name + ": a mesh has no sides; choose by group, box or where" };
    }
    const auto where = this->Where(region);
    const auto candidates = this->Candidates(region);
    if (!where || !candidates)
    {
      return where ? candidates.Status : where.Status;
    }
    for (const std::size_t i : candidates.Value)
    {
      const CellSide& facet = this->Boundary.Facets[i];
      const CellShape shape = this->Space.Shapes[static_cast<std::size_t>(facet.Cell)];
      const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
      const Samples samples = region.Box || where.Value ? FacetSamples(shape) : Samples();
      if (std::all_of(samples.begin(), samples.end(),
            [&](const std::array<double, 3>& s)
            {
              const auto u = frame.Point({ s[0], s[1] });
              return this->Holds(
                region, where.Value, PlaceAt(this->Space, facet.Cell, u.data(), &frame));
            }))
      {
        this->Chosen.Facets.push_back(facet);
      }
    }
    return this->Chosen.Facets.empty() ? this->NothingThere("facets") : Status();
  }

  /// The group of edges that a region names; none: it names no group, or one of facets.
  std::optional<long long> EdgeGroup(const ProblemRegion& region) const
  {
    const auto named = this->Boundary.EdgeNames.find(region.GroupName);
    const std::optional<long long> group =
      named != this->Boundary.EdgeNames.end() ? named->second : region.Group;
    const bool exists = group &&
      std::any_of(this->Boundary.EdgeGroups.begin(), this->Boundary.EdgeGroups.end(),
        [&](const auto& edge)
        { return std::find(edge.second.begin(), edge.second.end(), *group) != edge.second.end(); });
    return exists ? group : std::nullopt;
  }

  /// Chooses edges with the functions that are not 0 on them.
  Status ChooseEdgesOf(const ProblemRegion& region)
  {
    if (this->Space.Dimension != 3)
    {
      return { ErrorCode::InvalidParameter,
        this->Name + ": \"along\" is for edges of bodies in space; in the plane use \"at\"" };
    }
    const std::optional<long long> group = this->EdgeGroup(region);
    ProblemRegion ofFacets = region;
    if (group)
    {
      ofFacets.Group.reset();
      ofFacets.GroupName.clear();
    }
    const auto where = this->Where(region);
    const auto candidates = this->Candidates(ofFacets);
    if (!where || !candidates)
    {
      return where ? candidates.Status : where.Status;
    }
    std::vector<CellSide> facets;
    for (const std::size_t i : candidates.Value)
    {
      facets.push_back(this->Boundary.Facets[i]);
    }
    const auto edges = ChooseEdges(this->Space, facets,
      [&](const CellSide& facet, const FacetEdge& edge,
        const std::array<std::array<double, 3>, 3>& samples)
      {
        if (group)
        {
          const auto own = this->Boundary.EdgeGroups.find(edge.Ends);
          if (own == this->Boundary.EdgeGroups.end() ||
            std::find(own->second.begin(), own->second.end(), *group) == own->second.end())
          {
            return false;
          }
        }
        const auto e = static_cast<std::size_t>(facet.Cell);
        const FacetFrame frame = MakeFacetFrame(this->Space.Shapes[e], facet.Side);
        const std::size_t across = AcrossSide(std::max(0, region.Other));
        const double end = region.Other % 2;
        if (region.Other >= 0 &&
          (samples[0][across] != end || samples[2][across] != end ||
            (this->Space.InnerSides[e] >> region.Other & 1U) != 0))
        {
          return false;
        }
        return std::all_of(samples.begin(), samples.end(),
          [&](const std::array<double, 3>& u) {
            return this->Holds(
              region, where.Value, PlaceAt(this->Space, facet.Cell, u.data(), &frame));
          });
      });
    std::set<int> functions;
    for (const FacetEdge& edge : edges)
    {
      this->Chosen.Edges.push_back(edge.Place);
      functions.insert(edge.Functions.begin(), edge.Functions.end());
    }
    this->Chosen.Functions.assign(functions.begin(), functions.end());
    return edges.empty() ? this->NothingThere("edges") : Status();
  }

  /// The function that is 1 at a point, where all others are 0.
  Result<int> FunctionAt(const ProblemRegion& region) const
  {
    const int n = this->Space.Dimension;
    const Eigen::Map<const Eigen::RowVectorXd> at(region.At.data(), n);
    Eigen::Index nearest = 0;
    const double distance =
      std::sqrt((this->Space.Points.rowwise() - at).rowwise().squaredNorm().minCoeff(&nearest));
    const int function = static_cast<int>(nearest);
    PointValues values;
    for (int e = 0; e < this->Space.NumElements() && distance <= 1e-6 * this->Size; ++e)
    {
      const int* alive = this->Space.Alive(e);
      const int* found = std::find(alive, alive + this->Space.NumAlive(e), function);
      if (found == alive + this->Space.NumAlive(e))
      {
        continue;
      }
      // nodes of Lagrange elements, and corners, are on the lattice of the degree
      const CellDegree& p = this->Space.Degrees[static_cast<std::size_t>(e)];
      for (int k = 0; k <= p[2]; ++k)
      {
        for (int j = 0; j <= p[1]; ++j)
        {
          for (int i = 0; i <= p[0]; ++i)
          {
            const double u[] = { static_cast<double>(i) / p[0], static_cast<double>(j) / p[1],
              p[2] > 0 ? static_cast<double>(k) / p[2] : 0.0 };
            EvaluateFunctions(this->Space, e, u, values);
            if (std::abs(values.Values[found - alive] - 1.0) < 1e-9)
            {
              return function;
            }
          }
        }
      }
    }
    const Eigen::RowVectorXd place = this->Space.Points.row(nearest);
    return { ErrorCode::InvalidParameter,
      this->Name + ": there is no node at " + PointText(region.At.data(), n) +
        ", nor a corner of a spline; the nearest node or control point is " +
        PointText(place.data(), n) + ". Give the coordinates of one, or hold facets" };
  }

  Status Add(const ProblemCondition& condition)
  {
    auto functions = CompileValues(condition.Values, this->Name, this->Compile);
    if (!functions)
    {
      return functions.Status;
    }
    if (condition.Region.Kind == RegionKind::Facets)
    {
      const Status status = this->ChooseFacets(condition.Region);
      if (status)
      {
        this->AddOnFacets(condition, functions.Value);
      }
      return status;
    }
    if (condition.Region.Kind == RegionKind::Edges)
    {
      const Status status = this->ChooseEdgesOf(condition.Region);
      if (!status || condition.Kind == ConditionKind::Force)
      {
        if (status)
        {
          this->AddAlongEdges(functions.Value);
        }
        return status;
      }
    }
    else
    {
      const auto function = this->FunctionAt(condition.Region);
      if (!function)
      {
        return function.Status;
      }
      this->Chosen.Functions = { function.Value };
    }
    const bool isPoint = condition.Region.Kind == RegionKind::Point;
    for (std::size_t c = 0; c < condition.Values.size(); ++c)
    {
      const auto& value = condition.Values[c];
      if (!value)
      {
        continue;
      }
      if (!isPoint && !value->Expression.empty())
      {
        return { ErrorCode::InvalidParameter,
          this->Name + ": values along edges are numbers; \"" + value->Expression +
            "\" is an expression" };
      }
      const std::array<double, 3> none{};
      const double number = functions.Value[c](condition.Region.At.data(), none.data());
      for (const int function : this->Chosen.Functions)
      {
        const int component = static_cast<int>(c);
        if (condition.Kind == ConditionKind::Force)
        {
          this->Problem.PointLoads.push_back({ function, component, number });
        }
        else
        {
          this->Problem.Supports.push_back({ function, component, number });
        }
      }
    }
    return {};
  }

  void AddAlongEdges(const std::vector<ScalarFunction>& functions)
  {
    this->Problem.EdgeLoads.push_back({ this->Chosen.Edges,
      [functions](const double* x, double* values)
      {
        const std::array<double, 3> none{};
        for (std::size_t k = 0; k < functions.size(); ++k)
        {
          values[k] = functions[k](x, none.data());
        }
      } });
  }

  void AddOnFacets(const ProblemCondition& condition, const std::vector<ScalarFunction>& functions)
  {
    const int n = this->Space.Dimension;
    if (condition.Kind != ConditionKind::Value)
    {
      const bool isPressure = condition.Kind == ConditionKind::Pressure;
      FacetLoad load;
      load.Facets = this->Chosen.Facets;
      load.Values = [functions, isPressure, n](
                      const double* x, const double* normal, double* values)
      {
        Place place;
        std::copy_n(x, n, place.Point.begin());
        std::copy_n(normal, n, place.Normal.begin());
        for (std::size_t k = 0; k < functions.size() && !isPressure; ++k)
        {
          values[k] = functions[k](place.Point.data(), place.Normal.data());
        }
        for (int k = 0; k < n && isPressure; ++k)
        {
          values[k] = -functions[0](place.Point.data(), place.Normal.data()) * normal[k];
        }
      };
      this->Problem.Loads.push_back(std::move(load));
      return;
    }
    for (std::size_t c = 0; c < functions.size(); ++c)
    {
      if (!condition.Values[c])
      {
        continue;
      }
      PrescribedValues prescribed;
      prescribed.Facets = this->Chosen.Facets;
      prescribed.Component = static_cast<int>(c);
      prescribed.Values = [function = functions[c], c, n](const double* x, double* values)
      {
        Place place;
        std::copy_n(x, n, place.Point.begin());
        values[c] = function(place.Point.data(), place.Normal.data());
      };
      this->Problem.Prescribed.push_back(std::move(prescribed));
    }
  }

  const ProblemDescription& Description;
  const GalerkinSpace& Space;
  const BoundaryGroups& Boundary;
  const CompileExpression& Compile;
  int Components;
  Eigen::VectorXd Lower;
  Eigen::VectorXd Upper;
  double Size = 0.0;
  std::string Name; ///< of the condition at work
  ConditionPlace Chosen;
  GalerkinProblem Problem;
};
}

Result<GalerkinProblem> MakeProblem(const ProblemDescription& description,
  const GalerkinSpace& space, const BoundaryGroups& boundary, const CompileExpression& compile,
  std::vector<ConditionPlace>* places)
{
  if (space.NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, "the space has no elements" };
  }
  if (!boundary.Groups.empty() && boundary.Groups.size() != boundary.Facets.size())
  {
    return { ErrorCode::SizeMismatch, "there must be one list of groups a facet, or none" };
  }
  const int components = NumSolutionComponents(description.Equation);
  if (components > 1 && components != space.Dimension)
  {
    return { ErrorCode::DimensionMismatch,
      "plane stress and strain need elements in the plane, solids such in space" };
  }
  return ProblemBuilder(description, space, boundary, compile).Make(places);
}

Result<PointFunction> MakeExact(
  const ProblemDescription& description, int dimension, const CompileExpression& compile)
{
  return MakePointFunction(description.Exact, "exact solution", dimension, compile);
}
}
