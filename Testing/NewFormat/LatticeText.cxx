// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeText.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <sstream>
#include <utility>

namespace knotwork
{
namespace
{
KnotVector LinearKnots(int size)
{
  return KnotVector::Uniform(1, size - 1, 0.0, size - 1.0);
}
}

bool LooksLikeLattice(std::string_view beginning)
{
  return beginning.substr(0, 8) == "lattice ";
}

Result<SplineFile> ReadLattice(std::string_view text)
{
  std::istringstream stream{ std::string(text) };
  std::string word;
  int size[2] = {};
  if (!(stream >> word >> size[0] >> size[1]) || word != "lattice" || size[0] < 2 || size[1] < 2)
  {
    return { ErrorCode::InvalidFormat, "no lattice; write the word and two numbers of points" };
  }
  auto space = MakeTensorSpace<2>({ LinearKnots(size[0]), LinearKnots(size[1]) });
  if (!space)
  {
    return space.Status;
  }
  Spline<2> surface;
  surface.Space = space.Value;
  surface.ControlPoints.resize(size[0] * size[1], 3);
  for (Eigen::Index i = 0; i < surface.ControlPoints.size(); ++i)
  {
    if (!(stream >> surface.ControlPoints(i / 3, i % 3)))
    {
      return { ErrorCode::InvalidFormat, "coordinate " + std::to_string(i) + " is no number" };
    }
  }
  SplineFile file;
  file.Splines.emplace_back(std::move(surface));
  return file;
}

Result<std::string> WriteLattice(const SplineFile& file)
{
  const auto* surface =
    file.Splines.size() == 1 ? std::get_if<Spline<2>>(&file.Splines[0]) : nullptr;
  if (!surface || surface->Space->Knots[0].Degree() != 1 || surface->Space->Knots[1].Degree() != 1)
  {
    return { ErrorCode::InvalidParameter, "a lattice is one surface of degree 1" };
  }
  std::ostringstream stream;
  stream.precision(17);
  stream << "lattice " << surface->Space->Knots[0].NumFunctions() << ' '
         << surface->Space->Knots[1].NumFunctions() << '\n'
         << surface->ControlPoints << '\n';
  return stream.str();
}
}
