// SPDX-License-Identifier: BSD-3-Clause
// The solids of a CAD file that are cut into simpler ones, in memory.
#pragma once
#include "CADModify.h"
#include "CADTopology.h"

namespace knotwork
{
/// The bodies of a file, before and behind cuts. Not for several threads at once.
class CADPieces
{
public:
  /// @param file  STEP, IGES or BREP. @param unit  of lengths from here on.
  /// @return as CADTopology::Read.
  static Result<CADPieces> Read(const std::string& file, LengthUnit unit = LengthUnit::Millimetre);

  /// @return as CADTopology::Read.
  Result<CADTopology> Topology() const;

  /// Cuts that may leave simpler solids: along the surfaces of faces at concave edges, those at the
  /// longest edges first, then along planes through axes of cylinders, cones, balls and tori that
  /// are square to a plane face, to another axis or to an axis of the file. None stands there
  /// twice.
  /// @return InvalidFormat: OpenCASCADE fails.
  Result<std::vector<CADOperation>> Cuts() const;

  /// The pieces behind a cut, which goes through all solids; what they share is there once.
  /// @return failures of ModifyCAD.
  Result<CADPieces> Cut(const CADOperation& operation) const;

private:
  std::shared_ptr<const ModelBodies> Bodies;
  std::string Place; ///< in messages
};
}
