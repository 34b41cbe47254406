// SPDX-License-Identifier: BSD-3-Clause
// Cantilevers of every family against the theory of beams, under loads at the end and along edges.
#include "AnalysisCases.h"
#include "BoundaryEdges.h"
#include <knotwork/SplineAnalysis/ProblemDescription.h>
#include <knotwork/SplineAnalysis/ResultFields.h>

#include <gtest/gtest.h>

namespace knotwork::testing
{
namespace
{
constexpr double Modulus = 1000.0;

/// A prism along x, and its cross-section: bent about y in space, about z in the plane.
struct Beam
{
  AnalysisCase Body;
  double Length = 10.0;
  double Top = 0.5; ///< largest distance from the axis in the direction of the load
  double Area = 1.0;
  double Inertia = 1.0 / 12.0;
  double ShearFactor = 5.0 / 6.0;
};

/// The unit square or cube without bends, stretched and moved so that the axis is x.
Beam Stretched(AnalysisCase body, double length = 10.0)
{
  body.Space.Points.col(0) *= length;
  for (int d = 1; d < body.Space.Dimension; ++d)
  {
    body.Space.Points.col(d).array() -= 0.5;
  }
  Beam beam;
  beam.Body = std::move(body);
  beam.Length = length;
  return beam;
}

template <int Dim>
Spline<Dim> StraightBox(int degree, const std::array<int, 3>& elements)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    knots[d] = KnotVector::Uniform(degree, elements[d]);
  }
  Spline<Dim> spline;
  spline.Space = MakeTensorSpace<Dim>(knots).Value;
  spline.ControlPoints = GrevillePoints(*spline.Space);
  return spline;
}

/// Every third element of a box refined, those at its first end.
std::vector<int> AtTheSupport(const SplineSpace<2>& space)
{
  std::vector<int> marked;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (space.Elements[static_cast<std::size_t>(e)].Box.Upper[0] < 0.35)
    {
      marked.push_back(e);
    }
  }
  return marked;
}

/// Two boxes that share a side, the second turned by half a turn of its parameters.
AnalysisCase TwoPatches()
{
  MultiPatch<2> body;
  for (int k = 0; k < 2; ++k)
  {
    body.Patches.push_back(StraightBox<2>(2, { 10, 2, 1 }));
    PointMatrix& points = body.Patches.back().ControlPoints;
    if (k == 1)
    {
      points = (1.0 - points.array()).matrix().eval();
    }
    points.col(0) = 0.5 * (points.col(0).array() + k);
  }
  body.Topology.Interfaces = FindInterfaces(body.Patches);
  AnalysisCase made{ "multi-patch", MakeGalerkinSpace(body).Value, {} };
  made.Boundary = BoundaryFacets(made.Space).Value;
  return made;
}

/// A hexagonal prism whose sections are three rhombi about an extraordinary point.
Beam Hexagon(int degree)
{
  const Spline<3> prism = MappedStar<3>(3, 2, 20, degree,
    [](double* x)
    {
      std::rotate(x, x + 2, x + 3); // right-handed
      x[0] *= 20.0;
    });
  Beam beam;
  beam.Body = CaseOf<3>("unstructured " + std::to_string(degree), prism);
  beam.Length = 20.0;
  beam.Top = std::sqrt(0.75);
  beam.Area = 1.5 * std::sqrt(3.0);
  beam.Inertia = 5.0 / 16.0 * std::sqrt(3.0);
  return beam;
}

/// Where a facet's corners are all at a place along x.
std::vector<CellSide> FacetsAt(const AnalysisCase& body, double at)
{
  std::vector<CellSide> facets;
  for (const CellSide& facet : body.Boundary)
  {
    const auto e = static_cast<std::size_t>(facet.Cell);
    bool all = true;
    for (const auto& corner : SideCorners(body.Space.Shapes[e], body.Space.Degrees[e], facet.Side))
    {
      const double u[] = { static_cast<double>(corner[0] > 0), static_cast<double>(corner[1] > 0),
        static_cast<double>(corner[2] > 0) };
      PointValues values;
      EvaluateFunctions(body.Space, facet.Cell, u, values);
      all = all && std::abs(values.Position[0] - at) < 1e-6;
    }
    if (all)
    {
      facets.push_back(facet);
    }
  }
  return facets;
}

struct BeamResult
{
  double Deflection = 0.0; ///< mean over the end
  double Stress = 0.0;     ///< largest ratio to the theory's near the middle, at the top
};

/// Against the load's direction, the last one. @param projected  stresses of the functions, which
/// count then; without rows the stresses in the elements do.
BeamResult Measure(const Beam& beam, const GalerkinProblem& problem,
  const PointMatrix& coefficients, const std::function<double(double)>& moment,
  const PointMatrix& projected = {})
{
  const GalerkinSpace& space = beam.Body.Space;
  const int last = space.Dimension - 1;
  BeamResult result;
  double area = 0.0;
  PointValues values;
  for (const CellSide& facet : FacetsAt(beam.Body, beam.Length))
  {
    const CellShape shape = space.Shapes[static_cast<std::size_t>(facet.Cell)];
    const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
    const CellRule rule = MakeFacetRule(shape, facet.Side, 4);
    for (std::size_t q = 0; q < rule.Points.size(); ++q)
    {
      EvaluateFunctions(space, facet.Cell, rule.Points[q].data(), values);
      const double weight = rule.Weights[q] * AreaVector(frame, values).norm();
      area += weight;
      for (int a = 0; a < space.NumAlive(facet.Cell); ++a)
      {
        result.Deflection -=
          weight * values.Values[a] * coefficients(space.Alive(facet.Cell)[a], last);
      }
    }
  }
  result.Deflection /= area;
  EXPECT_NEAR(area, space.Dimension == 2 ? 2.0 * beam.Top : beam.Area, 1e-9);
  // the nearest point to the top of the middle, inside an element where stresses are best
  double nearest = 1e300;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const CellRule rule = MakeCellRule(
      space.Shapes[static_cast<std::size_t>(e)], space.Degrees[static_cast<std::size_t>(e)][0]);
    for (const auto& u : rule.Points)
    {
      EvaluateFunctions(space, e, u.data(), values);
      const double distance = std::abs(values.Position[0] - 0.5 * beam.Length) +
        std::abs(values.Position[last] - beam.Top);
      if (distance < nearest)
      {
        nearest = distance;
        double stress = EvaluateSolution(space, problem, coefficients, e, u.data()).Stress(0, 0);
        if (projected.rows() > 0)
        {
          stress = 0.0;
          for (int a = 0; a < space.NumAlive(e); ++a)
          {
            stress += values.Values[a] * projected(space.Alive(e)[a], 0);
          }
        }
        result.Stress =
          stress / (moment(values.Position[0]) * values.Position[last] / beam.Inertia);
      }
    }
  }
  return result;
}

GalerkinProblem HeldAtTheEnd(const Beam& beam)
{
  GalerkinProblem problem;
  problem.Equation =
    beam.Body.Space.Dimension == 2 ? GalerkinEquation::PlaneStress : GalerkinEquation::Solid;
  problem.Materials[0] = { 1.0, Modulus, 0.0 };
  problem.Prescribed.push_back({ FacetsAt(beam.Body, 0.0), -1, {} });
  return problem;
}

/// Deflection and stress over those of theory under a force of 1 at the end. Timoshenko:
/// F l^3 / (3 E I) + F l / (k G A).
/// @param isProjected  whether the stresses are those of the results, not those in elements.
BeamResult MeasureCantilever(
  const Beam& beam, const GalerkinParams& params = {}, bool isProjected = false)
{
  SCOPED_TRACE(beam.Body.Name);
  GalerkinProblem problem = HeldAtTheEnd(beam);
  const int last = beam.Body.Space.Dimension - 1;
  FacetLoad load;
  load.Facets = FacetsAt(beam.Body, beam.Length);
  load.Values = [&](const double*, const double*, double* traction)
  {
    std::fill_n(traction, last + 1, 0.0);
    traction[last] = -1.0 / beam.Area;
  };
  problem.Loads.push_back(load);
  const auto solution = SolveGalerkin(beam.Body.Space, problem, params);
  if (!solution)
  {
    ADD_FAILURE() << solution.Status.Message();
    return {};
  }
  // over the sum of what the support takes, which holds the moment too
  EXPECT_LE((solution->TotalLoad + solution->TotalReaction).norm(),
    1e-10 * solution->Reactions.cwiseAbs().colwise().sum().maxCoeff());
  PointMatrix projected;
  if (isProjected)
  {
    projected = MakeResultFields(
      beam.Body.Space, problem, beam.Body.Boundary, solution->Coefficients, false, params)
                  ->Projected;
  }
  BeamResult result = Measure(
    beam, problem, solution->Coefficients, [&](double x) { return beam.Length - x; }, projected);
  const double theory = std::pow(beam.Length, 3) / (3.0 * Modulus * beam.Inertia) +
    beam.Length / (beam.ShearFactor * 0.5 * Modulus * beam.Area);
  result.Deflection /= theory;
  std::printf("[ beam     ] %-30s %6d functions: deflection %.4f stress %.4f of the theory's\n",
    beam.Body.Name.c_str(), beam.Body.Space.NumFunctions(), result.Deflection, result.Stress);
  return result;
}

void ExpectCantilever(const Beam& beam)
{
  const BeamResult result = MeasureCantilever(beam);
  EXPECT_NEAR(result.Deflection, 1.0, 0.01) << beam.Body.Name;
  EXPECT_NEAR(result.Stress, 1.0, 0.01) << beam.Body.Name;
}

AnalysisCase StraightLagrange(CellShape shape, int order, int n)
{
  return LagrangeCase(shape, order, n, 0.0);
}
}

TEST(Beams, EveryFamilyInThePlane_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    const std::string degree = " " + std::to_string(p);
    const Spline<2> box = StraightBox<2>(p, { 12, 2, 1 });
    const std::vector<int> marked = AtTheSupport(*box.Space);
    ExpectCantilever(Stretched(CaseOf<2>("tensor" + degree, box)));
    ExpectCantilever(
      Stretched(CaseOf<2>("THB" + degree, RefineMarkedElements(box, marked)->Value)));
    ExpectCantilever(Stretched(CaseOf<2>("LR" + degree, RefineMarkedLR(box, marked)->Value)));
    ExpectCantilever(Stretched(StraightLagrange(CellShape::Triangle, p, p == 2 ? 16 : 6)));
    ExpectCantilever(Stretched(StraightLagrange(CellShape::Quadrilateral, p, p == 2 ? 16 : 6)));
  }
  ExpectCantilever(Stretched(TwoPatches()));
  ExpectCantilever(Stretched(StraightLagrange(CellShape::Quadrilateral, 1, 100)));
  ExpectCantilever(Stretched(StraightLagrange(CellShape::Triangle, 1, 80), 5.0));
}

TEST(Beams, EveryFamilyInSpace_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    const std::string degree = " " + std::to_string(p);
    const Spline<3> box = StraightBox<3>(p, { 12, 2, 2 });
    ExpectCantilever(Stretched(CaseOf<3>("tensor" + degree, box)));
    ExpectCantilever(Stretched(CaseOf<3>(
      "THB" + degree, RefineMarkedElements(box, { 0, 1, 12, 13, 24, 25, 36, 37 })->Value)));
    ExpectCantilever(Stretched(StraightLagrange(CellShape::Tetrahedron, p, p == 2 ? 7 : 4)));
    ExpectCantilever(Stretched(StraightLagrange(CellShape::Hexahedron, p, p == 2 ? 8 : 4), 6.0));
  }
  ExpectCantilever(Hexagon(2));
}

// Linear elements are too stiff under bending: they are within 1 % when they are many. Constant
// strain in tetrahedra is the worst; what they miss falls with the square of their size.
TEST(Beams, LinearElementsInSpace_ExactOracle)
{
  ExpectCantilever(Stretched(StraightLagrange(CellShape::Hexahedron, 1, 24), 3.0));
  const Beam coarse = Stretched(StraightLagrange(CellShape::Tetrahedron, 1, 12), 3.0);
  const Beam fine = Stretched(StraightLagrange(CellShape::Tetrahedron, 1, 24), 3.0);
  const double missed = 1.0 - MeasureCantilever(coarse).Deflection;
  EXPECT_LT(missed, 0.15);
  EXPECT_NEAR((1.0 - MeasureCantilever(fine).Deflection) / missed, 0.25, 0.03);
  GalerkinParams iterated; // takes a tenth of a factorization's time here
  iterated.DirectLimit = 0;
  const BeamResult finest = MeasureCantilever(
    Stretched(StraightLagrange(CellShape::Tetrahedron, 1, 42), 3.0), iterated, true);
  EXPECT_NEAR(finest.Deflection, 1.0, 0.01);
  EXPECT_NEAR(finest.Stress, 1.0, 0.01); // in an element it is constant, and 2 % low
}

// Forces along edges: a cantilever of length l under q for each length has the deflection
// q l^4 / (8 E I) + q l^2 / (2 k G A), and the moment q (l - x)^2 / 2.
TEST(Beams, LoadsAlongEdges_ExactOracle)
{
  const auto number = [](const std::string& text) -> Result<ScalarFunction>
  {
    return text == "up" ? ScalarFunction([](const double* x, const double*) { return x[2] - 0.4; })
                        : Result<ScalarFunction>(Status{ ErrorCode::InvalidParameter, text });
  };
  // both edges at the top: no torsion
  const Beam spline = Stretched(CaseOf<3>("tensor", StraightBox<3>(2, { 20, 2, 2 })));
  const Beam refined = Stretched(CaseOf<3>("THB",
    RefineMarkedElements(StraightBox<3>(2, { 20, 2, 2 }), { 60, 61, 62, 63, 64, 65, 66 })->Value));
  for (const Beam* beam : { &spline, &refined })
  {
    SCOPED_TRACE(beam->Body.Name);
    const auto read =
      ReadProblem("{\"conditions\": ["
                  "{\"on\": {\"side\": 0}, \"displacement\": [0, 0, 0]},"
                  "{\"along\": {\"sides\": [5, 2]}, \"force\": [0, 0, -0.05]},"
                  "{\"along\": {\"patch\": 0, \"sides\": [5, 3]}, \"force\": [0, 0, -0.05]}]}",
        GalerkinEquation::Solid, { 1.0, Modulus, 0.0 });
    ASSERT_TRUE(read) << read.Status.Message();
    BoundaryGroups groups;
    groups.Facets = beam->Body.Boundary;
    std::vector<ConditionPlace> places;
    const auto problem = MakeProblem(read.Value, beam->Body.Space, groups, number, &places);
    ASSERT_TRUE(problem) << problem.Status.Message();
    ASSERT_EQ(problem->EdgeLoads.size(), 2U);
    double length = 0.0;
    for (const ElementEdge& edge : places[1].Edges)
    {
      VisitEdge(beam->Body.Space, edge, 1e-10,
        [&](double part, const PointValues& at)
        {
          length += part;
          EXPECT_NEAR(at.Position[1], -0.5, 1e-12);
          EXPECT_NEAR(at.Position[2], 0.5, 1e-12);
        });
    }
    EXPECT_NEAR(length, 10.0, 1e-10);
    const auto solution = SolveGalerkin(beam->Body.Space, problem.Value);
    ASSERT_TRUE(solution) << solution.Status.Message();
    EXPECT_NEAR(solution->TotalLoad[2], -1.0, 1e-10);
    EXPECT_LE((solution->TotalLoad + solution->TotalReaction).norm(), 1e-10);
    const BeamResult result = Measure(*beam, problem.Value, solution->Coefficients,
      [](double x) { return 0.05 * (10.0 - x) * (10.0 - x); });
    const double theory =
      0.1 * 1e4 / (8.0 * Modulus / 12.0) + 0.1 * 100.0 / (2.0 * 5.0 / 6.0 * 0.5 * Modulus);
    std::printf("[ beam     ] %s under loads along edges: deflection %.4f stress %.4f\n",
      beam->Body.Name.c_str(), result.Deflection / theory, result.Stress);
    EXPECT_NEAR(result.Deflection, theory, 0.01 * theory);
    EXPECT_NEAR(result.Stress, 1.0, 0.01);
  }
  // a field of loads: the integral of z - 0.4 = 0.1 along the edges at the top of the end
  const auto read = ReadProblem("{\"conditions\": ["
                                "{\"on\": {\"side\": 0}, \"displacement\": [0, 0, 0]},"
                                "{\"along\": {\"box\": [10, 10, -0.5, 0.5, 0.5, 0.5]},"
                                " \"force\": [0, \"up\", 0]}]}",
    GalerkinEquation::Solid, { 1.0, Modulus, 0.0 });
  BoundaryGroups groups;
  groups.Facets = spline.Body.Boundary;
  const auto problem = MakeProblem(read.Value, spline.Body.Space, groups, number);
  ASSERT_TRUE(problem) << problem.Status.Message();
  EXPECT_EQ(problem->EdgeLoads[0].Edges.size(), 2U); // each once
  const auto solution = SolveGalerkin(spline.Body.Space, problem.Value);
  EXPECT_NEAR(solution->TotalLoad[1], 0.1, 1e-12);
}

// A quarter of a circle: the length of a curved edge.
TEST(Beams, CurvedEdgesAreMeasured_ExactOracle)
{
  ShapeParams tube;
  tube.Kind = ShapeKind::SolidTube;
  tube.InnerRadius = 1.0;
  tube.OuterRadius = 2.0;
  tube.Elements = { 2, 3, 2 };
  tube.Degree = 2;
  const AnalysisCase body = CaseOf<3>("tube", ShapePatches<3>(tube)[0]);
  double length = 0.0;
  for (const FacetEdge& edge : ChooseEdges(body.Space, body.Boundary,
         [&](const CellSide&facet, const FacetEdge&,
           const std::array<std::array<double, 3>, 3>&samples)
         {
           return std::all_of(samples.begin(), samples.end(),
             [&](const std::array<double, 3>& u)
             {
               PointValues values;
               EvaluateFunctions(body.Space, facet.Cell, u.data(), values);
               return std::abs(values.Position.head(2).norm() - 2.0) < 1e-9 &&
                 std::abs(values.Position[2] - body.Space.Points.col(2).maxCoeff()) < 1e-9;
             });
         }))
  {
    VisitEdge(
      body.Space, edge.Place, 1e-14, [&](double part, const PointValues&) { length += part; });
  }
  EXPECT_NEAR(length, 4.0 * std::atan(1.0), 1e-12); // radius 2
}
}
