// SPDX-License-Identifier: BSD-3-Clause
#include "CarriedCurves.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

namespace knotwork
{
namespace
{
constexpr const char* NumbersName = "CarriedCurveNumbers";
constexpr const char* ValuesName = "CarriedCurveValues";
constexpr const char* FacesName = "CarriedFaces";
constexpr const char* PointsName = "CarriedFacePoints";

/// Columns of NumbersName.
enum Column
{
  Face,
  Loop,
  Curve,
  Edge,
  Begin,
  End,
  Reversed,
  Degree,
  Functions,
  Rational,
  NumColumns
};

Status Damaged(const char* array)
{
  return { ErrorCode::InvalidTopology,
    std::string("the field array '") + array +
      "' of the surfaces is damaged; remove it, or give the trimming curves" };
}

/// An array of the field data with so many components; null when there is none.
template <typename Array>
Array* FieldArray(vtkUnstructuredGrid* grid, const char* arrayName, int components)
{
  auto* array = Array::SafeDownCast(grid->GetFieldData()->GetAbstractArray(arrayName));
  return array && array->GetNumberOfComponents() == components ? array : nullptr;
}

/// Takes numbers one after the other, as long as there are some.
class Values
{
public:
  explicit Values(vtkDoubleArray* array) : Array(array) {}
  bool Has(vtkIdType count) const { return count <= this->Array->GetNumberOfValues() - this->Next; }
  double Take() { return this->Array->GetValue(this->Next++); }
  bool AtEnd() const { return this->Next == this->Array->GetNumberOfValues(); }

private:
  vtkDoubleArray* Array;
  vtkIdType Next = 0;
};

/// Knots, then a row x, y, z, u, v (and the weight) a function.
Status ReadCurve(const int* numbers, Values& values, CarriedCurve& carried)
{
  const int degree = numbers[Degree];
  const int functions = numbers[Functions];
  const int columns = numbers[Rational] != 0 ? 6 : 5;
  if (degree < 1 || degree > 9 || functions < 1 ||
    !values.Has(functions + degree + 1 + static_cast<vtkIdType>(functions) * columns))
  {
    return Damaged(NumbersName);
  }
  std::vector<double> knots(static_cast<std::size_t>(functions + degree + 1));
  for (double& knot : knots)
  {
    knot = values.Take();
  }
  auto made = KnotVector::Create(degree, std::move(knots));
  if (!made)
  {
    return { made.Status.Code, Damaged(ValuesName).Detail + " (" + made.Status.Detail + ")" };
  }
  auto space = MakeTensorSpace<1>({ made.Value });
  if (!space)
  {
    return space.Status;
  }
  TrimmingCurve& use = carried.Use;
  use.Curve.Space = space.Value;
  use.Curve.ControlPoints.resize(functions, 3);
  use.UV.resize(functions, 2);
  use.Curve.Weights.resize(columns == 6 ? functions : 0);
  for (int i = 0; i < functions; ++i)
  {
    for (int c = 0; c < 5; ++c)
    {
      (c < 3 ? use.Curve.ControlPoints(i, c) : use.UV(i, c - 3)) = values.Take();
    }
    if (columns == 6)
    {
      use.Curve.Weights[i] = values.Take();
    }
  }
  carried.Face = numbers[Face];
  carried.Loop = numbers[Loop];
  carried.Curve = numbers[Curve];
  use.Edge = numbers[Edge];
  use.Vertices = { numbers[Begin], numbers[End] };
  use.Reversed = numbers[Reversed] != 0;
  return {};
}
}

void StoreCurves(const TrimmedModel& model, int modelId, vtkUnstructuredGrid* surfaces)
{
  vtkNew<vtkIntArray> numbers;
  numbers->SetName(NumbersName);
  numbers->SetNumberOfComponents(NumColumns);
  vtkNew<vtkDoubleArray> values;
  values->SetName(ValuesName);
  vtkNew<vtkIntArray> faces; // model, face, rows of PointsName
  faces->SetName(FacesName);
  faces->SetNumberOfComponents(3);
  vtkNew<vtkDoubleArray> points;
  points->SetName(PointsName);
  points->SetNumberOfComponents(4); // the fourth is 0: filters that turn vectors leave these alone
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const TrimmedFace& face = model.Faces[f];
    const auto id = static_cast<int>(f);
    for (std::size_t l = 0; l < face.Loops.size(); ++l)
    {
      for (std::size_t c = 0; c < face.Loops[l].Curves.size(); ++c)
      {
        const TrimmingCurve& use = face.Loops[l].Curves[c];
        const KnotVector& knots = use.Curve.Space->Knots[0];
        const int row[NumColumns] = { id, static_cast<int>(l), static_cast<int>(c), use.Edge,
          use.Vertices[0], use.Vertices[1], use.Reversed ? 1 : 0, knots.Degree(),
          knots.NumFunctions(), use.Curve.IsRational() ? 1 : 0 };
        numbers->InsertNextTypedTuple(row);
        for (double knot : knots.Knots())
        {
          values->InsertNextValue(knot);
        }
        for (int i = 0; i < knots.NumFunctions(); ++i)
        {
          for (int d = 0; d < 5; ++d)
          {
            values->InsertNextValue(d < 3 ? use.Curve.ControlPoints(i, d) : use.UV(i, d - 3));
          }
          if (use.Curve.IsRational())
          {
            values->InsertNextValue(use.Curve.Weights[i]);
          }
        }
      }
    }
    const int row[3] = { modelId, id, static_cast<int>(face.Surface.ControlPoints.rows()) };
    faces->InsertNextTypedTuple(row);
    for (Eigen::Index i = 0; i < face.Surface.ControlPoints.rows(); ++i)
    {
      const auto& all = face.Surface.ControlPoints;
      points->InsertNextTuple4(all(i, 0), all(i, 1), all(i, 2), 0.0);
    }
  }
  if (numbers->GetNumberOfTuples() > 0)
  {
    for (vtkAbstractArray* array :
      { static_cast<vtkAbstractArray*>(numbers.Get()), static_cast<vtkAbstractArray*>(values.Get()),
        static_cast<vtkAbstractArray*>(faces.Get()), static_cast<vtkAbstractArray*>(points.Get()) })
    {
      surfaces->GetFieldData()->AddArray(array);
    }
  }
}

Result<CarriedCurves> LoadCurves(vtkUnstructuredGrid* surfaces)
{
  CarriedCurves carried;
  if (!surfaces->GetFieldData()->HasArray(NumbersName))
  {
    return carried;
  }
  auto* numbers = FieldArray<vtkIntArray>(surfaces, NumbersName, NumColumns);
  auto* values = FieldArray<vtkDoubleArray>(surfaces, ValuesName, 1);
  auto* faces = FieldArray<vtkIntArray>(surfaces, FacesName, 3);
  auto* points = FieldArray<vtkDoubleArray>(surfaces, PointsName, 4);
  if (!numbers || !values || !faces || !points)
  {
    return Damaged(!numbers ? NumbersName : !values ? ValuesName : !faces ? FacesName : PointsName);
  }
  vtkIdType first = 0;
  for (vtkIdType f = 0; f < faces->GetNumberOfTuples(); ++f)
  {
    const int rows = faces->GetTypedComponent(f, 2);
    if (rows < 0 || rows > points->GetNumberOfTuples() - first)
    {
      return Damaged(FacesName);
    }
    carried.ModelId = faces->GetTypedComponent(f, 0);
    PointMatrix& face = carried.Surfaces[faces->GetTypedComponent(f, 1)];
    face.resize(rows, 3);
    for (int i = 0; i < rows; ++i, ++first)
    {
      for (int d = 0; d < 3; ++d)
      {
        face(i, d) = points->GetTypedComponent(first, d);
      }
    }
  }
  Values next(values);
  for (vtkIdType k = 0; k < numbers->GetNumberOfTuples(); ++k)
  {
    int row[NumColumns];
    numbers->GetTypedTuple(k, row);
    carried.Curves.emplace_back();
    if (Status status = ReadCurve(row, next, carried.Curves.back()); !status)
    {
      return status;
    }
  }
  if (!next.AtEnd())
  {
    return Damaged(ValuesName);
  }
  return carried;
}
}
