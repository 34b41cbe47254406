// SPDX-License-Identifier: BSD-3-Clause
#include "RandomModels.h"

#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace knotwork
{
namespace
{
using Random = std::mt19937;

double Uniform(Random& random, double begin, double end)
{
  return begin + (end - begin) * (random() / 4294967296.0); // the same on every platform
}

int Pick(Random& random, int begin, int end)
{
  return begin + static_cast<int>(random() % static_cast<unsigned>(end - begin + 1));
}

KnotVector RandomKnots(Random& random, int elements, bool hierarchical)
{
  const int p = Pick(random, 1, 3);
  double u = Uniform(random, -1.0, 1.0);
  std::vector<double> knots;
  const bool clamped = Pick(random, 0, 2) > 0;
  const auto step = [&] { u += Uniform(random, 0.5, 1.5); };
  for (int i = 0; i <= p; ++i)
  {
    knots.push_back(u);
    if (!clamped && i < p)
    {
      step();
    }
  }
  for (int e = 1; e < elements; ++e)
  {
    step();
    const int multiplicity =
      Pick(random, 0, 3) == 0 ? Pick(random, 1, hierarchical ? p : p + 1) : 1;
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), u);
  }
  step();
  for (int i = 0; i <= p; ++i)
  {
    knots.push_back(u);
    if (!clamped)
    {
      step();
    }
  }
  Result<KnotVector> made = KnotVector::Create(p, knots);
  EXPECT_TRUE(made) << made.Status.Message();
  return made.Value;
}

template <int Dim>
SplineSpacePtr<Dim> RandomSpace(Random& random, SpaceKind kind)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& direction : knots)
  {
    direction = RandomKnots(random, Pick(random, 2, Dim == 3 ? 3 : 5), kind != SpaceKind::Tensor);
  }
  if (kind == SpaceKind::Tensor)
  {
    auto space = MakeTensorSpace<Dim>(knots);
    EXPECT_TRUE(space) << space.Status.Message();
    return space.Value;
  }
  std::vector<HierarchyBox<Dim>> boxes;
  for (int level = 1; level <= 3; ++level)
  {
    HierarchyBox<Dim> box;
    box.Level = level;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int parents = knots[d].NumElements() << (level - 1);
      const int first = Pick(random, 0, parents - 1);
      const int last = std::min(parents, first + Pick(random, 1, knots[d].Degree() + 1));
      box.Lower[d] = 2 * first;
      box.Upper[d] = 2 * last;
    }
    boxes.push_back(box);
  }
  auto space = MakeHierarchicalSpace<Dim>(knots, boxes);
  EXPECT_TRUE(space) << space.Status.Message();
  return space.Value;
}

PointMatrix RandomRows(Random& random, int rows, int columns)
{
  PointMatrix values(rows, columns);
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    values.data()[i] = Uniform(random, -1.0, 1.0);
  }
  return values;
}

template <int Dim>
SplinePatch RandomPatch(Random& random, const ModelCase& model, int number)
{
  SplinePatch patch;
  patch.Id = 3 + 2 * number;
  Spline<Dim> spline;
  spline.Space = RandomSpace<Dim>(random, model.Kind);
  const int n = spline.Space->NumFunctions;
  spline.ControlPoints = RandomRows(random, n, 3);
  const auto functions = DescribeFunctions(*spline.Space);
  for (int i = 0; i < n; ++i)
  {
    for (int d = 0; d < Dim; ++d)
    {
      spline.ControlPoints(i, d) =
        functions[static_cast<std::size_t>(i)].Greville[static_cast<std::size_t>(d)] +
        0.1 * spline.ControlPoints(i, d) + 10.0 * number;
    }
  }
  if (model.Rational && number != 1)
  {
    spline.Weights.resize(n);
    for (int i = 0; i < n; ++i)
    {
      spline.Weights[i] = Uniform(random, 0.5, 2.0);
    }
  }
  patch.Fields.push_back({ "Temperature", RandomRows(random, n, 1) });
  patch.Fields.push_back({ "Velocity", RandomRows(random, n, 3) });
  if (number == 0)
  {
    patch.Fields.push_back({ "Stress", RandomRows(random, n, 6) });
  }
  patch.Geometry = std::move(spline);
  return patch;
}

template <int Dim>
bool SameSpace(const SplineSpace<Dim>& a, const SplineSpace<Dim>& b)
{
  bool same = a.Kind == b.Kind && a.NumFunctions == b.NumFunctions && a.Knots == b.Knots &&
    a.LocalFunctionIds == b.LocalFunctionIds && a.Elements.size() == b.Elements.size() &&
    a.RowFunction == b.RowFunction && a.RowCoefficient == b.RowCoefficient;
  for (std::size_t e = 0; same && e < a.Elements.size(); ++e)
  {
    same = a.Elements[e].Degree == b.Elements[e].Degree &&
      a.Elements[e].Level == b.Elements[e].Level &&
      a.Elements[e].Box.Lower == b.Elements[e].Box.Lower &&
      a.Elements[e].Box.Upper == b.Elements[e].Box.Upper;
  }
  return same;
}

bool SameMatrix(const PointMatrix& a, const PointMatrix& b)
{
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}
}

std::ostream& operator<<(std::ostream& os, const ModelCase& model)
{
  return os << (model.Kind == SpaceKind::Tensor ? "Tensor" : "Hierarchical") << model.Dimension
            << "D" << (model.Rational ? "Rational" : "Polynomial") << model.NumPatches
            << (model.NumPatches > 1 ? "Patches" : "Patch") << "Seed" << model.Seed;
}

std::vector<ModelCase> AllModelCases()
{
  std::vector<ModelCase> all;
  for (SpaceKind kind : { SpaceKind::Tensor, SpaceKind::Hierarchical })
  {
    for (int dimension = 1; dimension <= 3; ++dimension)
    {
      for (bool rational : { false, true })
      {
        for (int patches : { 1, 3 })
        {
          for (unsigned seed : { 1U, 2U })
          {
            all.push_back({ dimension, kind, rational, patches, seed });
          }
        }
      }
    }
  }
  return all;
}

std::string NameOf(const ::testing::TestParamInfo<ModelCase>& info)
{
  std::ostringstream text;
  text << info.param;
  return text.str();
}

SplineModel RandomModel(const ModelCase& model)
{
  Random random(model.Seed * 7919U + static_cast<unsigned>(model.Dimension));
  SplineModel made;
  for (int number = 0; number < model.NumPatches; ++number)
  {
    made.Patches.push_back(model.Dimension == 1 ? RandomPatch<1>(random, model, number)
        : model.Dimension == 2                  ? RandomPatch<2>(random, model, number)
                                                : RandomPatch<3>(random, model, number));
  }
  return made;
}

vtkSmartPointer<vtkUnstructuredGrid> Encode(const SplineModel& model)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const Status status = EncodeSplineGrid(model, grid);
  EXPECT_TRUE(status) << status.Message();
  return grid;
}

SplineModel Decode(vtkDataObject* data)
{
  Result<SplineModel> model = DecodeSplineModel(data, 0);
  EXPECT_TRUE(model) << model.Status.Message();
  return model.Value;
}

const PointMatrix& ControlPoints(const SplinePatch& patch)
{
  return std::visit(
    [](const auto& spline) -> const PointMatrix& { return spline.ControlPoints; }, patch.Geometry);
}

Eigen::VectorXd Weights(const SplinePatch& patch)
{
  return std::visit(
    [](const auto& spline) -> Eigen::VectorXd
    {
      return spline.IsRational() ? spline.Weights
                                 : Eigen::VectorXd::Ones(spline.ControlPoints.rows());
    },
    patch.Geometry);
}

bool IsRational(const SplinePatch& patch)
{
  return std::visit([](const auto& spline) { return spline.IsRational(); }, patch.Geometry);
}

SpaceKind KindOf(const SplinePatch& patch)
{
  return std::visit([](const auto& spline) { return spline.Space->Kind; }, patch.Geometry);
}

int NumElements(const SplinePatch& patch)
{
  return std::visit([](const auto& spline) { return spline.Space->NumElements(); }, patch.Geometry);
}

int NumFunctions(const SplinePatch& patch)
{
  return std::visit([](const auto& spline) { return spline.Space->NumFunctions; }, patch.Geometry);
}

const SplinePatch& PatchOf(const SplineModel& model, int id)
{
  for (const SplinePatch& patch : model.Patches)
  {
    if (patch.Id == id)
    {
      return patch;
    }
  }
  throw std::out_of_range("no patch " + std::to_string(id)); // fails the test
}

::testing::AssertionResult Identical(const SplineModel& a, const SplineModel& b)
{
  if (a.Patches.size() != b.Patches.size())
  {
    return ::testing::AssertionFailure()
      << a.Patches.size() << " and " << b.Patches.size() << " patches";
  }
  for (const SplinePatch& patch : a.Patches)
  {
    const auto at = std::find_if(b.Patches.begin(), b.Patches.end(),
      [&](const SplinePatch& other) { return other.Id == patch.Id && other.Block == patch.Block; });
    const auto fail = [&](const std::string& what)
    { return ::testing::AssertionFailure() << "patch " << patch.Id << ": " << what; };
    if (at == b.Patches.end() || at->Geometry.index() != patch.Geometry.index())
    {
      return fail("missing or of another dimension");
    }
    const bool sameSpace = std::visit(
      [&](const auto& spline)
      {
        using Type = std::decay_t<decltype(spline)>;
        return SameSpace(*spline.Space, *std::get<Type>(at->Geometry).Space);
      },
      patch.Geometry);
    if (!sameSpace)
    {
      return fail("the spaces differ");
    }
    if (!SameMatrix(ControlPoints(patch), ControlPoints(*at)))
    {
      return fail("the control points differ");
    }
    if (IsRational(patch) != IsRational(*at) || Weights(patch) != Weights(*at))
    {
      return fail("the weights differ");
    }
    if (patch.Fields.size() != at->Fields.size())
    {
      return fail(std::to_string(patch.Fields.size()) + " and " +
        std::to_string(at->Fields.size()) + " fields");
    }
    for (std::size_t f = 0; f < patch.Fields.size(); ++f)
    {
      if (patch.Fields[f].Name != at->Fields[f].Name ||
        !SameMatrix(patch.Fields[f].Coefficients, at->Fields[f].Coefficients))
      {
        return fail("field " + patch.Fields[f].Name + " differs");
      }
    }
  }
  return ::testing::AssertionSuccess();
}

::testing::AssertionResult Near(const SplinePatch& a, const PointMatrix& controlPoints,
  const Eigen::VectorXd& weights, double tolerance, double weightTolerance)
{
  const double distance = (ControlPoints(a) - controlPoints).rowwise().norm().maxCoeff();
  const double weightDistance =
    ((Weights(a) - weights).cwiseAbs().cwiseQuotient(weights)).maxCoeff();
  if (distance <= tolerance && weightDistance <= weightTolerance)
  {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure()
    << "patch " << a.Id << ": control points differ by " << distance << " (allowed " << tolerance
    << "), weights by " << weightDistance << " (allowed " << weightTolerance << "), amplification "
    << a.Amplification;
}

double SizeOf(const PointMatrix& points)
{
  return points.cwiseAbs().maxCoeff();
}
}
