// SPDX-License-Identifier: BSD-3-Clause
// The field data of a spline grid: the definition of every patch's space and the caches of its
// coefficients. The module's page describes the arrays.
#pragma once
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include <array>
#include <cstdint>
#include <cstring>

class vtkFieldData;

namespace knotwork
{
/// Names of the arrays of a spline grid.
namespace name
{
constexpr const char* Weights = "RationalWeights";
constexpr const char* WeightsCopy = "BezierWeights";
constexpr const char* Degrees = "HigherOrderDegrees";
constexpr const char* DegreesCopy = "BezierDegrees";
constexpr const char* PatchId = "PatchId";
constexpr const char* ElementId = "ElementId";
constexpr const char* Level = "Level";
constexpr const char* Bounds = "ParametricBounds";
constexpr const char* Basis = "PatchBasis";
}

/// Value of the cell array PatchBasis: 0 for spaces that are not stored, positive for all others.
/// Equal definitions have equal values.
int HashOf(const SpaceDefinition& basis);

/// Checksum over values and shapes; order matters.
class VTKKNOTWORKSPLINEGRID_EXPORT Checksum
{
public:
  void Add(std::uint64_t word)
  {
    const std::uint64_t h = this->H ^ (word * Spread);
    this->H = ((h << 27) | (h >> 37)) * Factor + Offset;
  }
  void Add(double value)
  {
    std::uint64_t word;
    std::memcpy(&word, &value, sizeof word);
    this->Add(word);
  }
  void Add(const PointMatrix& values);
  /// Undoes Add of the same values.
  void Remove(const PointMatrix& values);
  std::uint64_t Value() const { return this->H; }
  static Checksum From(std::uint64_t value)
  {
    Checksum sum;
    sum.H = value;
    return sum;
  }

private:
  void Remove(std::uint64_t word);

  static constexpr std::uint64_t Spread = 0x9e3779b97f4a7c15ULL;
  static constexpr std::uint64_t Factor = 0xc2b2ae3d27d4eb4fULL;
  static constexpr std::uint64_t Offset = 0x165667b19e3779f9ULL;
  std::uint64_t H = 0x6b6e6f74776f726bULL;
};

/// Coefficients as they were encoded. They count while a checksum over what they encode in the grid
/// and over themselves is the stored one.
struct CoefficientCache
{
  std::uint64_t Stored = 0;
  PointMatrix Rows; ///< no rows when lost

  std::uint64_t With(Checksum grid) const
  {
    grid.Add(this->Rows);
    return grid.Value();
  }
  bool Matches(const Checksum& grid) const { return this->With(grid) == this->Stored; }
  /// The value of the only sum of the grid that matches.
  std::uint64_t Matching() const
  {
    Checksum sum = Checksum::From(this->Stored);
    sum.Remove(this->Rows);
    return sum.Value();
  }
};

struct FieldRecord
{
  std::string Name;
  CoefficientCache Cache;
};

struct PatchRecord
{
  int Id = 0;
  SpaceDefinition Basis;
  bool Rational = false;
  int NumElements = 0;
  int NumFunctions = 0;
  CoefficientCache ControlPoints; ///< rows (x, y, z, w)
  std::vector<FieldRecord> Fields;
};

struct SplineSchema
{
  bool Present = false;
  std::vector<PatchRecord> Patches;
  PatchTopology Topology; ///< by PatchId; written alone (TopologyTable.h reads it)
};

/// Of grids with a table of interfaces; others are of version 1.
constexpr int SchemaVersion = 2;

void WriteSchema(const SplineSchema& schema, vtkFieldData* fieldData);
/// @return a schema that is not Present when there is none; InvalidTopology naming the array when
/// it is damaged or of a newer version. Lost caches are not an error.
Result<SplineSchema> ReadSchema(vtkFieldData* fieldData);

/// Of a patch's cells in element order: what x, y, z, w of all the elements' Bezier points, first
/// direction fastest, are added to.
template <int Dim>
Checksum BeginGeometryChecksum(const std::vector<IntArray<Dim>>& degrees);
}
