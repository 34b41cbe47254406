// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

#include <map>
#include <memory>

/// Polynomials on cells as homogeneous forms. A cell's barycentric coordinates are its slots, in
/// groups that sum to 1: (1 - u, u) for each tensor-product direction, (1 - u - v, u, v) for a
/// triangle, and so on. In the scaled Bernstein basis (coefficient times multinomial) a polynomial
/// is a plain form in the slots: products are convolutions, division by a slot is a shift.
namespace knotwork
{
inline constexpr int MaxSlots = 6;

/// Exponents of every slot of one coefficient.
using SlotExponents = std::array<std::uint8_t, MaxSlots>;

struct FormLayout
{
  /// One row of coefficients, contiguous in the first index.
  struct Row
  {
    int J = 0;
    int K = 0;
    int Start = 0;
    int Length = 0;
  };
  /// The coefficients that differ in the exponents of two slots alone, by ascending exponent of the
  /// second: along them the form is univariate, of degree Size - 1.
  struct Line
  {
    int First = 0; ///< into LineIndices
    int Size = 0;
  };
  /// A pair of slots of one group: the direction of an edge of the cell.
  struct Edge
  {
    int From = 0;
    int To = 0;
    std::vector<Line> Lines;
    std::vector<int> LineIndices;
  };

  CellShape Shape = CellShape::Curve;
  CellDegree Degree{}; ///< entries may be 0
  int Size = 0;
  int NumSlots = 0;
  std::vector<Row> Rows;
  std::vector<SlotExponents> Exponents; ///< per coefficient
  std::vector<double> Multinomials; ///< per coefficient, relative error <= 2 MultinomialRoundings u
  int MultinomialRoundings = 0;     ///< 0 when all are exact
  std::vector<int> Corners;         ///< coefficient at each corner of the cell
  std::vector<std::uint8_t> CornerMasks; ///< slots that vanish there
  std::vector<Edge> Edges;
  std::array<std::uint8_t, MaxSlots> GroupMasks{}; ///< per group the set of its slots
  int NumGroups = 0;

  int Index(int i, int j, int k) const
  {
    return CellCoefficient(this->Shape, this->Degree, i, j, k);
  }
};

/// First slot of the group that parameter d belongs to, and the slot whose value is the parameter.
int GroupOfDirection(CellShape shape, int direction);
int SlotOfDirection(CellShape shape, int direction);
/// The degree with that of the direction's group changed by an amount.
CellDegree ChangedDegree(CellShape shape, CellDegree degree, int direction, int change);

/// Layouts made so far; one a thread.
class LayoutCache
{
public:
  const FormLayout& Get(CellShape shape, const CellDegree& degree);

private:
  std::map<std::pair<CellShape, CellDegree>, std::unique_ptr<FormLayout>> Layouts;
};
}
