// SPDX-License-Identifier: BSD-3-Clause
#include "GoToolsG2.h"

#include "GoToolsLR.h"

namespace knotwork
{
namespace
{
constexpr int ClassIds[] = { 0, 100, 200, 700 };

template <int Dim>
Status AppendSpline(const Spline<Dim>& spline, std::string& text)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  const SplineSpace<Dim>& space = *spline.Space;
  if constexpr (Dim == 2)
  {
    if (space.Kind == SpaceKind::LocallyRefined)
    {
      AppendLRSurface(spline, text);
      return {};
    }
  }
  if (space.Kind != SpaceKind::Tensor &&
    !(space.Kind == SpaceKind::Hierarchical && space.IsIdentityMap()))
  {
    return { ErrorCode::InvalidParameter,
      space.Kind == SpaceKind::Hierarchical
        ? "a hierarchical spline cannot be written as g2; write G+Smo XML"
        : "Bezier elements without knots cannot be written as g2; write .vtu" };
  }
  const Eigen::Index columns = spline.ControlPoints.cols();
  text += std::to_string(ClassIds[Dim]) + " 1 0 0\n";
  text += std::to_string(columns) + (spline.IsRational() ? " 1\n" : " 0\n");
  for (const KnotVector& knots : space.Knots)
  {
    text += std::to_string(knots.NumFunctions()) + " " + std::to_string(knots.Degree() + 1) + "\n";
    for (std::size_t i = 0; i < knots.Knots().size(); ++i)
    {
      text += i > 0 ? " " : "";
      AppendReal(text, knots.Knots()[i]);
    }
    text += "\n";
  }
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      text += c > 0 ? " " : "";
      AppendProduct(
        text, spline.ControlPoints(i, c), spline.IsRational() ? spline.Weights[i] : 1.0);
    }
    if (spline.IsRational())
    {
      text += " ";
      AppendReal(text, spline.Weights[i]);
    }
    text += "\n";
  }
  text += "\n";
  return {};
}
}

Result<std::string> WriteG2(const std::vector<AnySpline>& splines)
{
  if (splines.empty())
  {
    return { ErrorCode::EmptyInput, "there is no spline to write" };
  }
  std::string text;
  for (std::size_t i = 0; i < splines.size(); ++i)
  {
    const Status status =
      std::visit([&](const auto& spline) { return AppendSpline(spline, text); }, splines[i]);
    if (!status)
    {
      return { status.Code, "spline " + std::to_string(i) + ": " + status.Detail };
    }
  }
  return text;
}

Result<std::string> WriteG2Points(const PointFile& file)
{
  const Eigen::Index n = file.Points.rows();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there is no point to write" };
  }
  const std::vector<PointGroup> groups =
    file.Groups.empty() ? std::vector<PointGroup>(1) : file.Groups;
  std::string text;
  for (std::size_t i = 0; i < groups.size(); ++i)
  {
    const Eigen::Index begin = groups[i].Begin;
    const Eigen::Index end = i + 1 < groups.size() ? groups[i + 1].Begin : n;
    if (begin >= end || (i == 0 && begin != 0))
    {
      return { ErrorCode::SizeMismatch, "the groups of points do not follow each other" };
    }
    text += "400 1 0";
    text += groups[i].HasColor ? " 4" : " 0";
    for (std::size_t c = 0; groups[i].HasColor && c < 4; ++c)
    {
      text += " " + std::to_string(groups[i].Color[c]);
    }
    text += "\n" + std::to_string(end - begin) + "\n";
    for (Eigen::Index row = begin; row < end; ++row)
    {
      for (Eigen::Index c = 0; c < 3; ++c)
      {
        text += c > 0 ? " " : "";
        AppendReal(text, file.Points(row, c));
      }
      text += "\n";
    }
    text += "\n";
  }
  return text;
}
}
