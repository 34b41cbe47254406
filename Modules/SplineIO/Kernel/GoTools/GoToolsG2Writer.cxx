// SPDX-License-Identifier: BSD-3-Clause
#include "GoToolsG2.h"

#include "GoToolsLR.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr int ClassIds[] = { 0, 100, 200, 700 };

/// What follows the header of a spline of tensor-product kind.
template <int Dim>
void AppendBody(const Spline<Dim>& spline, std::string& text)
{
  const Eigen::Index columns = spline.ControlPoints.cols();
  text += std::to_string(columns) + (spline.IsRational() ? " 1\n" : " 0\n");
  for (const KnotVector& knots : spline.Space->Knots)
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
}

template <int Dim>
Status CheckSpline(const Spline<Dim>& spline)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  const SplineSpace<Dim>& space = *spline.Space;
  if (space.Kind == SpaceKind::Tensor || (Dim == 2 && space.Kind == SpaceKind::LocallyRefined) ||
    (space.Kind == SpaceKind::Hierarchical && space.IsIdentityMap()))
  {
    return {};
  }
  return { ErrorCode::InvalidParameter,
    space.Kind == SpaceKind::Hierarchical
      ? "a hierarchical spline cannot be written as g2; write G+Smo XML"
      : "Bezier elements without knots cannot be written as g2; write .vtu" };
}

/// The class of a spline and what separates it from the body.
template <int Dim>
void AppendSpline(const Spline<Dim>& spline, const char* version, std::string& text)
{
  if constexpr (Dim == 2)
  {
    if (spline.Space->Kind == SpaceKind::LocallyRefined)
    {
      text += std::string("293") + version + "\n";
      AppendLRSurface(spline, text);
      return;
    }
  }
  text += std::to_string(ClassIds[Dim]) + version + "\n";
  AppendBody(spline, text);
  text += version[0] != '\0' ? "\n" : "";
}

Status AppendBoundary(const LoopCurve& curve, std::string& text)
{
  for (const Spline<1>* side : { &curve.Parameter, &curve.Space })
  {
    const Status status = side->Space ? CheckSpline(*side) : Status();
    if (!status)
    {
      return status;
    }
  }
  if (!curve.Parameter.Space && !curve.Space.Space)
  {
    return { ErrorCode::EmptyInput, "a boundary curve that is nowhere" };
  }
  text += curve.PreferParameter ? "1 " : "0 ";
  text += curve.Parameter.Space ? "100 " : "0 ";
  text += curve.Space.Space ? "100\n" : "0\n";
  for (const Spline<1>* side : { &curve.Parameter, &curve.Space })
  {
    if (side->Space)
    {
      AppendBody(*side, text);
    }
  }
  return {};
}

Status AppendLoops(const BoundedSurface& bounded, std::string& text)
{
  text += std::to_string(bounded.Loops.size()) + "\n";
  for (const SurfaceLoop& loop : bounded.Loops)
  {
    text += std::to_string(loop.Curves.size()) + " ";
    AppendReal(text, loop.Tolerance);
    text += "\n";
    for (const LoopCurve& curve : loop.Curves)
    {
      if (Status status = AppendBoundary(curve, text); !status)
      {
        return status;
      }
    }
  }
  text += "\n";
  return {};
}

const BoundedSurface* FindBounded(const SplineFile& file, std::size_t spline)
{
  const auto found = std::find_if(file.Bounded.begin(), file.Bounded.end(),
    [&](const BoundedSurface& bounded) { return bounded.Spline == static_cast<int>(spline); });
  return found == file.Bounded.end() ? nullptr : &*found;
}
}

Result<std::string> WriteG2File(const SplineFile& file)
{
  if (file.Splines.empty())
  {
    return { ErrorCode::EmptyInput, "there is no spline to write" };
  }
  std::string text;
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    const BoundedSurface* bounded = FindBounded(file, i);
    text += bounded ? "210 1 0 0\n" : "";
    Status status = std::visit(
      [&](const auto& spline)
      {
        const Status checked = CheckSpline(spline);
        if (checked)
        {
          AppendSpline(spline, bounded ? "" : " 1 0 0", text);
        }
        return checked;
      },
      file.Splines[i]);
    if (bounded && file.Splines[i].index() != 1)
    {
      status = { ErrorCode::DimensionMismatch, "only a surface has a boundary of curves" };
    }
    status = status && bounded ? AppendLoops(*bounded, text) : status;
    if (!status)
    {
      return { status.Code, "spline " + std::to_string(i) + ": " + status.Detail };
    }
  }
  return text;
}

Result<std::string> WriteG2(const std::vector<AnySpline>& splines)
{
  SplineFile file;
  file.Splines = splines;
  return WriteG2File(file);
}

Result<std::string> WriteG2Points(const PointFile& file)
{
  const Eigen::Index n = file.Points.rows();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there is no point to write" };
  }
  if (Status status = CheckCoordinates(file.Points); !status)
  {
    return status;
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
