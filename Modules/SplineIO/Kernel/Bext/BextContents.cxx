// SPDX-License-Identifier: BSD-3-Clause
#include "BextContents.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>

namespace knotwork
{
namespace
{
template <int Dim>
Result<SplineFile> MakeFile(const BextContents& contents, int first)
{
  ExtractionTable<Dim> table;
  for (const IntArray<3>& degree : contents.Table.Degrees)
  {
    table.Degrees.emplace_back();
    std::copy_n(degree.begin(), Dim, table.Degrees.back().begin());
  }
  table.FirstFunction = contents.Table.FirstFunction;
  table.Functions = contents.Table.Functions;
  table.Vectors = contents.Table.Vectors;
  table.FirstCoefficient = contents.Table.FirstCoefficient;
  table.Coefficients = contents.Table.Coefficients;
  auto space = MakeExplicitSpace<Dim>(table, static_cast<int>(contents.Nodes.rows()), first);
  if (!space)
  {
    return space.Status;
  }
  for (Eigen::Index i = 0; i < contents.Nodes.rows(); ++i)
  {
    const std::string name = "control point " + std::to_string(i + first);
    if (!AllWithinLimit(contents.Nodes.row(i).head(3)))
    {
      return { ErrorCode::TooLarge, name + ": " + BeyondLimit() };
    }
    if (contents.Rational && !(contents.Nodes(i, 3) > 0.0))
    {
      return { ErrorCode::InvalidWeight,
        name + " has the weight " + Digits(contents.Nodes(i, 3)) + "; weights are positive" };
    }
  }
  SplineFile file;
  Spline<Dim> spline;
  spline.Space = std::move(space.Value);
  spline.ControlPoints = contents.Nodes.leftCols(3);
  if (contents.Rational)
  {
    spline.Weights = contents.Nodes.col(3);
  }
  else if ((contents.Nodes.col(3).array() != 1.0).any())
  {
    file.Warnings.emplace_back(
      "weights other than 1 are not taken: the file says that it is not rational");
  }
  file.Splines.emplace_back(std::move(spline));
  file.Ids.push_back(contents.PatchId);
  return file;
}

template <int Dim>
void AddSpline(const Spline<Dim>& spline, BextContents& contents)
{
  const ExtractionTable<Dim> table = ExtractionOf(*spline.Space);
  ExtractionTable<3>& all = contents.Table;
  const Eigen::Index firstNode = contents.Nodes.rows();
  const std::size_t firstEntry = all.Functions.size();
  const auto firstVector = static_cast<int>(all.NumVectors());
  const std::size_t firstCoefficient = all.Coefficients.size();
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    all.Degrees.emplace_back();
    std::copy(table.Degrees[e].begin(), table.Degrees[e].end(), all.Degrees.back().begin());
    all.FirstFunction.push_back(firstEntry + table.FirstFunction[e + 1]);
  }
  for (std::size_t k = 0; k < table.Functions.size(); ++k)
  {
    all.Functions.push_back(static_cast<int>(firstNode) + table.Functions[k]);
    all.Vectors.push_back(firstVector + table.Vectors[k]);
  }
  for (std::size_t v = 1; v < table.FirstCoefficient.size(); ++v)
  {
    all.FirstCoefficient.push_back(firstCoefficient + table.FirstCoefficient[v]);
  }
  all.Coefficients.insert(
    all.Coefficients.end(), table.Coefficients.begin(), table.Coefficients.end());
  const Eigen::Index count = spline.ControlPoints.rows();
  contents.Nodes.conservativeResize(firstNode + count, 4);
  auto rows = contents.Nodes.bottomRows(count);
  rows.setZero();
  rows.leftCols(spline.ControlPoints.cols()) = spline.ControlPoints;
  rows.col(3).setOnes();
  if (spline.IsRational())
  {
    rows.col(3) = spline.Weights;
    contents.Rational = true;
  }
}
}

std::vector<BextBlock> BlocksOf(const ExtractionTable<3>& table)
{
  std::vector<BextBlock> blocks;
  const auto functions = [&table](std::size_t e)
  { return table.FirstFunction[e + 1] - table.FirstFunction[e]; };
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    if (e == 0 || table.Degrees[e] != table.Degrees[e - 1] || functions(e) != functions(e - 1))
    {
      blocks.push_back({ e, e });
    }
    blocks.back().End = e + 1;
  }
  return blocks;
}

Result<SplineFile> FileOfContents(const BextContents& contents, int first)
{
  return contents.Dimension == 1 ? MakeFile<1>(contents, first)
    : contents.Dimension == 2    ? MakeFile<2>(contents, first)
                                 : MakeFile<3>(contents, first);
}

Result<BextContents> ContentsOfFile(const SplineFile& file)
{
  BextContents contents;
  if (file.Splines.empty())
  {
    return { ErrorCode::EmptyInput, "there is no spline to write" };
  }
  contents.PatchId = file.Ids.empty() ? 0 : file.Ids.front();
  contents.Dimension = static_cast<int>(file.Splines.front().index()) + 1;
  contents.Nodes.resize(0, 4);
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    const int id = file.Ids.empty() ? static_cast<int>(i) : file.Ids[i];
    const std::string name = "patch " + std::to_string(id);
    const Status status = std::visit(
      [&](const auto& spline) -> Status
      {
        if (Status checked = spline.Check(); !checked)
        {
          return { checked.Code, name + ": " + checked.Detail };
        }
        if (spline.NumComponents() > 3)
        {
          return { ErrorCode::DimensionMismatch,
            name + " has " + std::to_string(spline.NumComponents()) +
              " coordinates; BEXT has three" };
        }
        if (static_cast<int>(file.Splines[i].index()) + 1 != contents.Dimension)
        {
          return { ErrorCode::DimensionMismatch,
            name + " has " + std::to_string(file.Splines[i].index() + 1) +
              " parameters, the first patch " + std::to_string(contents.Dimension) +
              "; curves, surfaces and volumes are written to BEXT files of their own" };
        }
        AddSpline(spline, contents);
        return {};
      },
      file.Splines[i]);
    if (!status)
    {
      return status;
    }
  }
  if (file.Splines.size() > 1)
  {
    contents.Table = WithVectorsOnce<3>(contents.Table);
  }
  return contents;
}
}
