// SPDX-License-Identifier: BSD-3-Clause
#include "GismoXml.h"
#include "TextWords.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/PatchDirections.h>

#include <algorithm>
#include <set>

namespace knotwork
{
namespace
{
void AppendRows(std::string& text, const double* values, Eigen::Index rows, Eigen::Index columns)
{
  for (Eigen::Index i = 0; i < rows; ++i)
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      text += c > 0 ? " " : "";
      AppendReal(text, *values++);
    }
    text += "\n";
  }
}

void AppendKnots(std::string& text, const KnotVector& knots, const std::string& index)
{
  text += "<Basis type=\"BSplineBasis\"" + index + "><KnotVector degree=\"" +
    std::to_string(knots.Degree()) + "\">";
  for (std::size_t i = 0; i < knots.Knots().size(); ++i)
  {
    text += i > 0 ? " " : "";
    AppendReal(text, knots.Knots()[i]);
  }
  text += "</KnotVector></Basis>\n";
}

/// The names of types in G+Smo: curves have shorter ones.
template <int Dim>
std::string Numbered(const char* name)
{
  return name + std::to_string(Dim);
}

template <int Dim>
void AppendTensorBasis(std::string& text, const std::array<KnotVector, Dim>& knots)
{
  if (Dim == 1)
  {
    AppendKnots(text, knots[0], "");
    return;
  }
  text += "<Basis type=\"" + Numbered<Dim>("TensorBSplineBasis") + "\">\n";
  for (std::size_t d = 0; d < Dim; ++d)
  {
    AppendKnots(text, knots[d], " index=\"" + std::to_string(d) + "\"");
  }
  text += "</Basis>\n";
}

template <int Dim>
void AppendSpline(std::string& text, const Spline<Dim>& spline, int id)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const bool hierarchical = space.Kind == SpaceKind::Hierarchical;
  const bool rational = spline.IsRational();
  std::string type = Dim == 1 ? (rational ? "Nurbs" : "BSpline")
                              : Numbered<Dim>(rational ? "TensorNurbs" : "TensorBSpline");
  std::string rationalBasis = Dim == 1 ? "NurbsBasis" : Numbered<Dim>("TensorNurbsBasis");
  if (hierarchical)
  {
    type = Numbered<Dim>(rational ? "RationalTHBSpline" : "THBSpline");
    rationalBasis = Numbered<Dim>("RationalTHBSplineBasis");
  }
  text += "<Geometry type=\"" + type + "\" id=\"" + std::to_string(id) + "\">\n";
  text += rational ? "<Basis type=\"" + rationalBasis + "\">\n" : "";
  if (hierarchical)
  {
    text +=
      "<Basis type=\"" + (Dim == 1 ? "THBSplineBasis" : Numbered<Dim>("THBSplineBasis")) + "\">\n";
  }
  AppendTensorBasis<Dim>(text, space.Knots);
  if (hierarchical)
  {
    for (const HierarchyBox<Dim>& box : HierarchyBoxes(space))
    {
      text += "<box level=\"" + std::to_string(box.Level) + "\">";
      for (std::size_t d = 0; d < 2 * Dim; ++d)
      {
        text += (d > 0 ? " " : "") + std::to_string(d < Dim ? box.Lower[d] : box.Upper[d - Dim]);
      }
      text += "</box>\n";
    }
    text += "</Basis>\n";
  }
  if (rational)
  {
    text += "<weights>\n";
    AppendRows(text, spline.Weights.data(), spline.Weights.size(), 1);
    text += "</weights>\n</Basis>\n";
  }
  text += "<coefs geoDim=\"" + std::to_string(spline.ControlPoints.cols()) + "\">\n";
  AppendRows(
    text, spline.ControlPoints.data(), spline.ControlPoints.rows(), spline.ControlPoints.cols());
  text += "</coefs>\n</Geometry>\n";
}

/// What the patches of a multi-patch refer to must be there.
Status CheckMultiPatch(const SplineFile& file, const StatedPatches& patches)
{
  const std::set<int> members(patches.Splines.begin(), patches.Splines.end());
  const int count = static_cast<int>(file.Splines.size());
  bool fits =
    patches.Dimension >= 1 && patches.Dimension <= 3 && members.size() == patches.Splines.size();
  for (int i : patches.Splines)
  {
    fits = fits && i >= 0 && i < count &&
      static_cast<int>(file.Splines[static_cast<std::size_t>(i)].index()) + 1 == patches.Dimension;
  }
  const auto isMember = [&](const PatchSide& side) { return members.count(side.Patch) > 0; };
  const PatchTopology& topology = patches.Topology;
  for (const PatchInterface& interface : topology.Interfaces)
  {
    fits = fits && isMember(interface.Sides[0]) && isMember(interface.Sides[1]);
  }
  fits = fits && std::all_of(topology.Boundary.begin(), topology.Boundary.end(), isMember);
  if (!fits)
  {
    return { ErrorCode::InvalidTopology, "a multi-patch refers to a spline that is not there" };
  }
  return CheckTopology(topology, count, patches.Dimension);
}

void AppendMultiPatch(
  std::string& text, const StatedPatches& patches, const std::vector<int>& ids, int id)
{
  const auto idOf = [&](int spline)
  { return std::to_string(ids[static_cast<std::size_t>(spline)]); };
  const auto sideOf = [&](const PatchSide& side)
  { return idOf(side.Patch) + " " + std::to_string(side.Side + 1); };
  text += "<MultiPatch parDim=\"" + std::to_string(patches.Dimension) + "\" id=\"" +
    std::to_string(id) + "\">\n<patches type=\"id_index\">";
  for (std::size_t i = 0; i < patches.Splines.size(); ++i)
  {
    text += (i > 0 ? " " : "") + idOf(patches.Splines[i]);
  }
  text += "</patches>\n";
  if (!patches.Topology.Interfaces.empty())
  {
    text += "<interfaces>\n";
    for (const PatchInterface& interface : patches.Topology.Interfaces)
    {
      text += sideOf(interface.Sides[0]) + " " + sideOf(interface.Sides[1]);
      const PatchDirections directions = DirectionsOf(interface, patches.Dimension);
      for (const auto* row : { &directions.Direction, &directions.Sense })
      {
        for (int d = 0; d < patches.Dimension; ++d)
        {
          text += " " + std::to_string((*row)[static_cast<std::size_t>(d)]);
        }
      }
      text += "\n";
    }
    text += "</interfaces>\n";
  }
  if (!patches.Topology.Boundary.empty())
  {
    text += "<boundary>\n";
    for (const PatchSide& side : patches.Topology.Boundary)
    {
      text += sideOf(side) + "\n";
    }
    text += "</boundary>\n";
  }
  text += "</MultiPatch>\n";
}
}

Result<std::string> WriteGismoXml(const SplineFile& file)
{
  if (file.Splines.empty())
  {
    return { ErrorCode::EmptyInput, "there is no spline to write" };
  }
  std::vector<int> ids = file.Ids;
  for (int i = 0; ids.size() < file.Splines.size() && file.Ids.empty(); ++i)
  {
    ids.push_back(i);
  }
  const std::set<int> distinct(ids.begin(), ids.end());
  if (ids.size() != file.Splines.size() || distinct.size() != ids.size() || *distinct.begin() < 0)
  {
    return { ErrorCode::InvalidTopology, "splines have one id each, distinct and not negative" };
  }
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<xml>\n";
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    const Status status = std::visit(
      [&](const auto& spline) -> Status
      {
        if (Status check = spline.Check(); !check)
        {
          return check;
        }
        if (spline.Space->Kind == SpaceKind::Bezier)
        {
          return { ErrorCode::InvalidParameter,
            "Bezier elements without knots cannot be written as G+Smo XML; write .vtu" };
        }
        if (spline.Space->Kind == SpaceKind::LocallyRefined)
        {
          return { ErrorCode::InvalidParameter,
            "a locally refined spline cannot be written as G+Smo XML; write g2 (GoTools)" };
        }
        AppendSpline(text, spline, ids[i]);
        return {};
      },
      file.Splines[i]);
    if (!status)
    {
      return { status.Code, "spline " + std::to_string(i) + ": " + status.Detail };
    }
  }
  // after all geometries, as the numbers go on where theirs end
  long long next = static_cast<long long>(*distinct.rbegin()) + 1;
  for (const StatedPatches& patches : file.MultiPatches)
  {
    if (Status status = CheckMultiPatch(file, patches); !status)
    {
      return status;
    }
    AppendMultiPatch(text, patches, ids, static_cast<int>(next++));
  }
  return text + "</xml>\n";
}
}
