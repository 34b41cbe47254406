// SPDX-License-Identifier: BSD-3-Clause
// Data sets as they are handed to other processes and written as VTK's XML: VTK's own readers and
// writers are the oracles.
#include "DataText.h"
#include "OutputFile.h"
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/DataParts.h>

#include "vtkBitArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLPolyDataReader.h"

#include <algorithm>
#include <fstream>
#include <iterator>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
template <typename Array>
vtkSmartPointer<Array> Values(const char* name, int components, vtkIdType tuples)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, static_cast<double>((i * 7919 + c * 31) % 1000) / 8.0);
    }
  }
  return array;
}

/// A tetrahedron as a polyhedron beside a vertex, with arrays of many types.
vtkSmartPointer<vtkUnstructuredGrid> Mixed()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(0, 1, 0);
  points->InsertNextPoint(0, 0, 1);
  grid->SetPoints(points);
  const vtkIdType corners[] = { 0, 1, 2, 3 };
  const vtkIdType faces[] = { 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2 };
  grid->InsertNextCell(VTK_POLYHEDRON, 4, corners, 4, faces);
  grid->InsertNextCell(VTK_VERTEX, 1, corners + 3);
  const auto normals = Values<vtkFloatArray>("Normals", 3, 4);
  normals->SetComponentName(0, "across");
  normals->SetComponentName(2, "up");
  grid->GetPointData()->SetNormals(normals);
  grid->GetPointData()->SetGlobalIds(Values<vtkIdTypeArray>("Ids", 1, 4));
  grid->GetCellData()->AddArray(Values<vtkUnsignedCharArray>("Kind", 2, 2));
  grid->GetCellData()->SetScalars(Values<vtkDoubleArray>("Size", 1, 2));
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  names->InsertNextValue("<one>");
  names->InsertNextValue("");
  grid->GetFieldData()->AddArray(names);
  grid->GetFieldData()->AddArray(Values<vtkDoubleArray>("Nothing", 3, 0));
  return grid;
}

std::string BytesOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

vtkSmartPointer<vtkPolyData> Large()
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(Values<vtkDoubleArray>("Points", 3, 800'001)); // more than a block of 16 MB
  data->SetPoints(points);
  data->GetPointData()->AddArray(Values<vtkFloatArray>("Values", 1, 800'001));
  return data;
}
}

TEST(VTKData, EveryKindOfArrayIsHandedOver)
{
  const auto plain = Mixed();
  const auto withNote = Mixed(); // which goes as text
  withNote->GetCellData()->GetArray("Size")->GetInformation()->Set(
    vtkDataArray::UNITS_LABEL(), "mm");
  const auto withBits = Mixed();
  withBits->GetCellData()->AddArray(Values<vtkBitArray>("Bits", 1, 2));
  vtkNew<vtkPolyData> empty;
  const auto large = Large();
  for (vtkDataObject* data :
    std::initializer_list<vtkDataObject*>{ plain, withNote, withBits, empty, large })
  {
    std::vector<std::string> parts;
    AppendParts(data, parts);
    AppendParts(empty, parts);
    std::size_t next = 0;
    const auto taken = TakeData(parts, next);
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(TextOf(taken), TextOf(data));
    const auto second = TakeData(parts, next); // begins where the first has ended
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(TextOf(second), TextOf(empty));
    EXPECT_EQ(next, parts.size());
  }
}

TEST(VTKData, PartsThatDoNotBelongTogetherAreNoData)
{
  std::vector<std::string> whole;
  AppendParts(Mixed(), whole);
  for (std::size_t kept = 0; kept < whole.size(); ++kept)
  {
    std::vector<std::string> parts(whole.begin(), whole.begin() + static_cast<long>(kept));
    std::size_t next = 0;
    EXPECT_EQ(TakeData(parts, next), nullptr) << kept;
    EXPECT_LE(next, kept);
  }
  const auto coordinates = std::find_if(whole.begin(), whole.end(),
    [](const std::string& part) { return part.size() == 4 * 3 * sizeof(float); });
  ASSERT_NE(coordinates, whole.end());
  coordinates->pop_back();
  std::size_t next = 0;
  EXPECT_EQ(TakeData(whole, next), nullptr);
}

// Compressed in pieces by several threads, numbers in lines of base64: VTK reads it, and the bytes
// do not depend on the threads.
TEST(VTKData, WrittenFilesAreReadByVTK_CrossOracle)
{
  const auto data = Large();
  for (const char* encoding : { "binary", "appended", "ascii" })
  {
    SCOPED_TRACE(encoding);
    const std::string file = OutputFile("large.vtp");
    std::string first;
    for (const int threads : { 1, 3 })
    {
      DataFileParams params;
      params.Encoding = encoding;
      params.Threads = threads;
      const auto written = WriteDataFile(data, file, params);
      ASSERT_TRUE(written) << written.Status.Message();
      first = first.empty() ? BytesOf(file) : first;
      EXPECT_TRUE(first == BytesOf(file));
    }
    if (std::string(encoding) == "appended")
    {
      continue; // not every libexpat lets VTK read it
    }
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkDataSet* const read = reader->GetOutputAsDataSet();
    ASSERT_EQ(read->GetNumberOfPoints(), data->GetNumberOfPoints());
    vtkDataArray* const values = read->GetPointData()->GetArray("Values");
    for (vtkIdType i = 0; i < read->GetNumberOfPoints(); ++i)
    {
      double there[3];
      double here[3];
      data->GetPoint(i, there);
      read->GetPoint(i, here);
      ASSERT_TRUE(std::equal(there, there + 3, here)) << i;
      ASSERT_EQ(
        values->GetComponent(i, 0), data->GetPointData()->GetArray("Values")->GetComponent(i, 0));
    }
  }
}
