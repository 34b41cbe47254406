// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro

#include <optional>
#include <string>
#include <vector>

class vtkTable;

namespace knotwork
{
/// What becomes of the numbers that the pieces of a dataset have in a column of one row.
enum class Merging
{
  Sum,
  Least,
  Largest,
  Mean,         ///< by the weights
  QuadraticMean ///< by the weights
};

struct MergedColumn
{
  std::string Name;
  Merging How;
};

struct MergedTable
{
  std::string Key; ///< column of numbers by which rows are the same; empty: there is one row
  std::string
    Weight; ///< column of the means' weights; rows of weight 0 have no part in extrema either
  /// Columns that are not named have the value of the first piece that has the row.
  std::vector<MergedColumn> Columns;
  std::optional<double> LastKey; ///< of a row that stays the last; others ascend
};

/// Makes the tables of the pieces that processes have one table of all, in the first process; the
/// others' become empty. Sums are made in the order of the processes.
/// @pre called by all processes (see Processes.h); tables have the same columns, of one component,
/// or none.
VTKKNOTWORKSPLINEGRID_EXPORT void MergeTables(vtkTable* table, const MergedTable& how);
}
