// SPDX-License-Identifier: BSD-3-Clause
#include "HexahedronData.h"

#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace knotwork
{
void EncodeHexahedra(const CellMesh<3>& mesh, const PointMatrix& points,
  const HexahedronQuality& quality, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPoints> ofOutput;
  ofOutput->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    ofOutput->InsertNextPoint(points.row(i).data());
  }
  output->SetPoints(ofOutput);
  output->AllocateExact(mesh.NumCells(), 8);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* at = mesh.Cell(c);
    const vtkIdType ids[8] = { at[0], at[1], at[3], at[2], at[4], at[5], at[7], at[6] };
    output->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  output->GetCellData()->AddArray(ArrayOf<vtkDoubleArray>(
    "ScaledJacobian", quality.ScaledJacobians, [](double value) { return value; }));
  output->GetCellData()->AddArray(ArrayOf<vtkIntArray>("Verdict", quality.Certificate.Cells,
    [](const CellCertificate& cell) { return static_cast<int>(cell.Verdict); }));
  output->GetCellData()->SetActiveScalars("ScaledJacobian"); // drawn first
}

void AddHexahedronColumns(const HexahedronQuality& quality, vtkTable* table)
{
  const JacobianCertificate& certificate = quality.Certificate;
  AddColumn(table, "Verdict", ToString(certificate.Verdict));
  AddColumn(table, "ValidCells", certificate.NumValid);
  AddColumn(table, "ReversedCells", certificate.NumReversed);
  AddColumn(table, "InvalidCells", certificate.NumInvalid);
  AddColumn(table, "UndecidedCells", certificate.NumUndecided);
  AddColumn(table, "MinJacobianLower", certificate.MinLower);
  AddColumn(table, "LeastScaledJacobian", quality.LeastScaledJacobian);
  AddColumn(table, "Volume", quality.Volume);
}

std::vector<std::string> HexahedronWarnings(
  const HexahedronQuality& quality, const std::string& remedy)
{
  const JacobianCertificate& certificate = quality.Certificate;
  const auto& cells = certificate.Cells;
  const std::string all = " of " + std::to_string(cells.size()) + " hexahedra ";
  const auto first = [&](const auto& is)
  { return std::to_string(std::find_if(cells.begin(), cells.end(), is) - cells.begin()); };
  std::vector<std::string> warnings;
  if (const auto folded = certificate.NumInvalid + certificate.NumReversed; folded > 0)
  {
    const auto isFolded = [](const CellCertificate& cell)
    { return cell.Verdict == Verdict::Invalid || cell.Verdict == Verdict::Reversed; };
    warnings.push_back(std::to_string(folded) + all + "are folded, the first is cell " +
      first(isFolded) + " (Verdict -1 or 2); " + remedy);
  }
  if (certificate.NumUndecided > 0)
  {
    const auto isOpen = [](const CellCertificate& cell)
    { return cell.Verdict == Verdict::Undecided; };
    warnings.push_back(std::to_string(certificate.NumUndecided) + all +
      "are neither proved valid nor folded, the first is cell " + first(isOpen) + " (Verdict 0); " +
      remedy);
  }
  return warnings;
}
}
