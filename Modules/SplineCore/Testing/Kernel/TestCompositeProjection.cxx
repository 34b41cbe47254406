// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/CompositeProjection.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <gtest/gtest.h>

#include <limits>

using namespace knotwork;
using namespace meshes;

namespace
{
template <int Dim>
SplineSpacePtr<Dim> MakeSpace(Random& random, const CellMesh<Dim>& mesh, int degree,
  CreasePolicy policy, const std::vector<CellSide>& features = {})
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  params.Features = features;
  if (random.Unit() < 0.5)
  {
    params.Lengths.resize(
      static_cast<std::size_t>(MeshTopology<Dim>::Make(mesh)->FindSheets().Count));
    for (double& length : params.Lengths)
    {
      length = random.Int(1, 3);
    }
  }
  auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return made->Space;
}

PointMatrix RandomPoints(Random& random, Eigen::Index rows, Eigen::Index columns)
{
  PointMatrix points(rows, columns);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.In(-1.0, 1.0);
  }
  return points;
}

/// Another function on every element.
bool AnyFunction(int element, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
{
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    for (Eigen::Index c = 0; c < values.cols(); ++c)
    {
      double sum = element + 0.3 * static_cast<double>(c);
      for (Eigen::Index d = 0; d < local.cols(); ++d)
      {
        sum += (1.7 + static_cast<double>(d)) * local(i, d);
      }
      values(i, c) = std::sin(sum);
    }
  }
  return true;
}

template <int Dim>
double FarFromInverse(const CompositeProjection<Dim>& composite)
{
  const Eigen::SparseMatrix<double, Eigen::RowMajor> product =
    composite.Restriction * composite.Prolongation;
  Eigen::SparseMatrix<double, Eigen::RowMajor> unit(product.rows(), product.cols());
  unit.setIdentity();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rest = product - unit;
  double most = 0.0;
  for (int i = 0; i < rest.outerSize(); ++i)
  {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator at(rest, i); at; ++at)
    {
      most = std::max(most, std::abs(at.value()));
    }
  }
  return most;
}

/// Strips of cells that close without a crease are smooth across the cut of their patch.
template <int Dim>
bool IsCreasedAtCuts(const CompositeProjection<Dim>& composite)
{
  const std::vector<int> continuity = ContinuityOf(*composite.Space);
  return std::all_of(composite.Layout.Cuts.begin(), composite.Layout.Cuts.end(),
    [&](const CellSide& cut)
    { return continuity[static_cast<std::size_t>(2 * Dim * cut.Cell + cut.Side)] == 0; });
}

/// @return whether all patches are creased where they meet.
template <int Dim>
bool ExpectFullIsTheSame(Random& random, const CellMesh<Dim>& mesh, int degree)
{
  const auto space = MakeSpace<Dim>(random, mesh, degree, CreasePolicy::Full);
  const auto composite = MakeCompositeProjection<Dim>(space);
  EXPECT_TRUE(composite) << composite.Status.Message();
  EXPECT_LE(FarFromInverse(composite.Value), 1e-13);
  if (!IsCreasedAtCuts(composite.Value))
  {
    return false;
  }
  EXPECT_TRUE((Eigen::Map<const Eigen::VectorXd>(
                 composite->Prolongation.valuePtr(), composite->Prolongation.nonZeros())
                 .array() == 1.0)
                .all());
  EXPECT_EQ(composite->Prolongation.nonZeros(), composite->Prolongation.rows());
  const int components = random.Int(1, 4);
  ProjectionParams params;
  params.ExtraPoints = random.Int(0, 2);
  params.Threads = 1;
  const auto patches = ProjectByPatches<Dim>(composite.Value, components, AnyFunction, params);
  const auto cells = ProjectOntoSpace<Dim>(space, components, AnyFunction, params);
  EXPECT_TRUE(patches) << patches.Status.Message();
  EXPECT_LE((patches->ControlPoints - cells->ControlPoints).cwiseAbs().maxCoeff(), 1e-10);
  params.Threads = 3;
  const auto again = ProjectByPatches<Dim>(composite.Value, components, AnyFunction, params);
  EXPECT_TRUE(again->ControlPoints == patches->ControlPoints);
  return true;
}

/// Any policy: patches hold the space's splines, which are reproduced.
template <int Dim>
void ExpectProjector(Random& random, const SplineSpacePtr<Dim>& space)
{
  const auto composite = MakeCompositeProjection<Dim>(space);
  ASSERT_TRUE(composite) << composite.Status.Message();
  EXPECT_LE(FarFromInverse(composite.Value), 1e-13);
  Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints = RandomPoints(random, space->NumFunctions, 3);
  const PointMatrix prolonged = composite->Prolongation * spline.ControlPoints;
  const auto split = SplitIntoPatches(spline);
  for (std::size_t k = 0; k < split->Patches.size(); ++k)
  {
    // 1e-10: patches are recovered from Bezier form
    const PointMatrix& points = split->Patches[k].ControlPoints;
    EXPECT_LE(
      (points - prolonged.middleRows(composite->First[k], points.rows())).cwiseAbs().maxCoeff(),
      1e-10);
  }
  const BezierForm<Dim> form = MakeBezierForm(spline, 1);
  const auto value = [&](int e, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
  {
    EvaluationBatch batch;
    const std::vector<int> elements(static_cast<std::size_t>(local.rows()), e);
    EvaluationParams params;
    params.Threads = 1;
    const bool done =
      static_cast<bool>(EvaluateElements<Dim>(form, elements, local, params, batch));
    values = batch.Values;
    return done;
  };
  const auto projected = ProjectByPatches<Dim>(composite.Value, 3, value);
  ASSERT_TRUE(projected) << projected.Status.Message();
  EXPECT_LE((projected->ControlPoints - spline.ControlPoints).cwiseAbs().maxCoeff(), 1e-9);

  const auto plain = MakeCompositeProjection<Dim>(space, RestrictionKind::Plain);
  if (plain)
  {
    EXPECT_LE(FarFromInverse(plain.Value), 1e-9); // solved to 1e-10
  }
  else
  {
    EXPECT_EQ(plain.Status.Code, ErrorCode::NotInSpace);
  }
}

/// A smooth function of a unit square of n by n cells at points of a cell.
double Wave(int n, int cell, double u, double v)
{
  return std::sin(3.0 * (cell % n + u) / n) * std::cos(2.0 * (cell / n + v) / n + 0.3);
}

/// Largest error at a grid of points of every cell of either projection, and their difference.
std::array<double, 3> Errors(int n, int degree, CreasePolicy policy)
{
  const auto mesh = Grid<2>({ n, n });
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  params.Features = { { n * (n / 2) + n / 2, 1 }, { n * (n / 2) + n / 2, 3 } };
  const auto space = MakeUnstructuredSpace<2>(mesh, params)->Space;
  const ElementFunction function =
    [n](int e, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
  {
    for (Eigen::Index i = 0; i < local.rows(); ++i)
    {
      values(i, 0) = Wave(n, e, local(i, 0), local(i, 1));
    }
    return true;
  };
  const auto patches = ProjectByPatches<2>(MakeCompositeProjection<2>(space).Value, 1, function);
  const auto cells = ProjectOntoSpace<2>(space, 1, function);
  std::array<double, 3> errors{};
  const BezierForm<2> a = MakeBezierForm(patches.Value, 1);
  const BezierForm<2> b = MakeBezierForm(cells.Value, 1);
  for (int e = 0; e < mesh.NumCells(); ++e)
  {
    PointMatrix local(16, 2);
    for (int i = 0; i < 16; ++i)
    {
      local.row(i) << (i % 4 + 0.1) / 3.3, (i / 4 + 0.1) / 3.3;
    }
    EvaluationBatch va;
    EvaluationBatch vb;
    const std::vector<int> elements(16, e);
    EXPECT_TRUE(EvaluateElements<2>(a, elements, local, {}, va));
    EXPECT_TRUE(EvaluateElements<2>(b, elements, local, {}, vb));
    for (int i = 0; i < 16; ++i)
    {
      const double exact = Wave(n, e, local(i, 0), local(i, 1));
      errors[0] = std::max(errors[0], std::abs(va.Values(i, 0) - exact));
      errors[1] = std::max(errors[1], std::abs(vb.Values(i, 0) - exact));
      errors[2] = std::max(errors[2], std::abs(va.Values(i, 0) - vb.Values(i, 0)));
    }
  }
  return errors;
}
}

TEST(CompositeProjection, OfFullSpacesIsTheProjectionOfCells_CrossOracle)
{
  int same = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto quads = RandomMesh<2>(random, 80);
    same += ExpectFullIsTheSame<2>(random, quads, random.Int(1, 4)) ? 1 : 0;
    const auto hexes = RandomMesh<3>(random, 40);
    same += ExpectFullIsTheSame<3>(random, hexes, random.Int(1, 3)) ? 1 : 0;
  }
  EXPECT_GE(same, 20);
  Random random(100);
  EXPECT_TRUE(ExpectFullIsTheSame<2>(random, Shuffled<2>(random, Star(5, 7)), 3));
  EXPECT_TRUE(ExpectFullIsTheSame<3>(random, Shuffled<3>(random, Sweep(Star(3, 4), 5)), 2));
}

TEST(CompositeProjection, ReproducesSplinesOfAnyPolicy_ExactOracle)
{
  int smooth = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto quads = RandomMesh<2>(random, 60);
    for (const CreasePolicy policy : { CreasePolicy::Motorcycle, CreasePolicy::Minimal })
    {
      const auto space = MakeSpace<2>(random, quads, random.Int(2, 3), policy);
      smooth += space->IsIdentityMap() ? 0 : 1;
      ExpectProjector<2>(random, space);
    }
    if (seed <= 5)
    {
      const auto hexes = RandomMesh<3>(random, 20);
      ExpectProjector<3>(random, MakeSpace<3>(random, hexes, 2, CreasePolicy::Minimal));
    }
  }
  Random random(100);
  ExpectProjector<2>(random, MakeSpace<2>(random, Star(5, 7), 3, CreasePolicy::Minimal));
  EXPECT_GT(smooth, 5); // not all are C^0 between patches
}

TEST(CompositeProjection, OrderIsThatOfTheProjectionOfCells_PropertyOracle)
{
  for (const CreasePolicy policy : { CreasePolicy::Motorcycle, CreasePolicy::Minimal })
  {
    for (const int degree : { 2, 3 })
    {
      SCOPED_TRACE(degree);
      const auto coarse = Errors(12, degree, policy);
      const auto fine = Errors(24, degree, policy);
      const double rate = std::log2(coarse[0] / fine[0]);
      RecordProperty("rate", std::to_string(rate));
      EXPECT_GT(rate, degree + 1 - 0.4) << coarse[0] << " " << fine[0];
      EXPECT_LT(fine[0], 2.0 * fine[1]);
      EXPECT_LT(fine[2], 2.0 * fine[1]);
    }
  }
}

TEST(CompositeProjection, EveryFailureIsReachable)
{
  Random random(1);
  EXPECT_EQ(MakeCompositeProjection<2>(nullptr).Status.Code, ErrorCode::EmptyInput);
  const auto tensor = MakeTensorSpace<2>({ KnotVector::Uniform(2, 3), KnotVector::Uniform(2, 3) });
  EXPECT_EQ(MakeCompositeProjection<2>(tensor.Value).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(ProjectByPatches<2>({}, 1, AnyFunction).Status.Code, ErrorCode::EmptyInput);
  const auto composite =
    MakeCompositeProjection<2>(MakeSpace<2>(random, Star(5, 4), 3, CreasePolicy::Full)).Value;
  EXPECT_EQ(
    ProjectByPatches<2>(composite, 0, AnyFunction).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ProjectByPatches<2>(composite, 1, nullptr).Status.Code, ErrorCode::InvalidParameter);
  ProjectionParams params;
  params.ExtraPoints = 17;
  EXPECT_EQ(ProjectByPatches<2>(composite, 1, AnyFunction, params).Status.Code,
    ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(ProjectByPatches<2>(composite, 1, AnyFunction, params).Status.Code, ErrorCode::Aborted);

  const auto fail = [&](int kind)
  {
    return ProjectByPatches<2>(composite, 1,
      [kind](int e, const PointMatrix& local, const PointMatrix& at, PointMatrix& values)
      {
        AnyFunction(e, local, at, values);
        if (e == 7 || e == 70)
        {
          values(0, 0) = kind == 1 ? std::numeric_limits<double>::infinity() : 0.0;
          values.conservativeResize(values.rows() - (kind == 2 ? 1 : 0), 1);
          return kind != 0;
        }
        return true;
      })
      .Status;
  };
  const ErrorCode codes[] = { ErrorCode::OutsideDomain, ErrorCode::NonFiniteInput,
    ErrorCode::SizeMismatch };
  for (int kind = 0; kind < 3; ++kind)
  {
    EXPECT_EQ(fail(kind).Code, codes[kind]);
    EXPECT_NE(fail(kind).Message().find("element 7"), std::string::npos);
    EXPECT_EQ(fail(kind).Message().find("element 70"), std::string::npos);
  }

  int without = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    Random own(seed);
    const auto space = MakeSpace<2>(own, RandomMesh<2>(own, 60), 3, CreasePolicy::Minimal);
    const auto plain = MakeCompositeProjection<2>(space, RestrictionKind::Plain);
    if (!plain)
    {
      ++without;
      EXPECT_EQ(plain.Status.Code, ErrorCode::NotInSpace);
      EXPECT_NE(plain.Status.Message().find("function "), std::string::npos);
    }
  }
  EXPECT_GT(without, 0);
}
