// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>

#include <gtest/gtest.h>

#include <vtkDoubleArray.h>
#include <vtkDummyCommunicator.h>
#include <vtkDummyController.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace knotwork;

namespace
{
/// One of two processes; what the other one gives is known.
class KnownOther : public vtkDummyCommunicator
{
public:
  static KnownOther* New();
  vtkTypeMacro(KnownOther, vtkDummyCommunicator);
  std::string Given; ///< what this one gave last
  std::string Other;
  void Become(int number) { this->LocalProcessId = number; }

  int AllGatherVoidArray(const void* mine, void* all, vtkIdType, int type) override
  {
    EXPECT_EQ(type, VTK_ID_TYPE_IMPL); // lengths
    auto* lengths = static_cast<vtkIdType*>(all);
    lengths[this->LocalProcessId] = *static_cast<const vtkIdType*>(mine);
    lengths[1 - this->LocalProcessId] = static_cast<vtkIdType>(this->Other.size());
    return 1;
  }
  int AllGatherVVoidArray(
    const void* mine, void* all, vtkIdType length, vtkIdType*, vtkIdType* offsets, int) override
  {
    auto* bytes = static_cast<char*>(all);
    this->Given.assign(static_cast<const char*>(mine), static_cast<std::size_t>(length));
    std::copy(this->Given.begin(), this->Given.end(), bytes + offsets[this->LocalProcessId]);
    std::copy(this->Other.begin(), this->Other.end(), bytes + offsets[1 - this->LocalProcessId]);
    return 1;
  }

protected:
  KnownOther() { this->MaximumNumberOfProcesses = this->NumberOfProcesses = 2; }
};
vtkStandardNewMacro(KnownOther);

struct Row
{
  int Key;
  const char* Text;
  int Count;
  double Least;
  double Largest;
  double Mean;
  double Rms;
};

vtkSmartPointer<vtkTable> TableOf(const std::vector<Row>& rows)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  const auto number = [&](const char* name, auto get)
  { table->AddColumn(ArrayOf<vtkDoubleArray>(name, rows, get)); };
  table->AddColumn(ArrayOf<vtkIntArray>("Key", rows, [](const Row& row) { return row.Key; }));
  table->AddColumn(ArrayOf<vtkStringArray>("Text", rows, [](const Row& row) { return row.Text; }));
  table->AddColumn(ArrayOf<vtkIntArray>("Count", rows, [](const Row& row) { return row.Count; }));
  number("Least", [](const Row& row) { return row.Least; });
  number("Largest", [](const Row& row) { return row.Largest; });
  number("Mean", [](const Row& row) { return row.Mean; });
  number("Rms", [](const Row& row) { return row.Rms; });
  return table;
}

MergedTable HowTo()
{
  return { "Key", "Count",
    { { "Count", Merging::Sum }, { "Least", Merging::Least }, { "Largest", Merging::Largest },
      { "Mean", Merging::Mean }, { "Rms", Merging::QuadraticMean } },
    -1.0 };
}

/// Both processes one after the other. @return their tables.
std::pair<vtkSmartPointer<vtkTable>, vtkSmartPointer<vtkTable>> MergeBoth(
  const std::vector<Row>& first, const std::vector<Row>& second)
{
  vtkNew<KnownOther> communicator;
  vtkNew<vtkDummyController> controller;
  controller->SetCommunicator(communicator);
  vtkMultiProcessController* before = vtkMultiProcessController::GetGlobalController();
  vtkMultiProcessController::SetGlobalController(controller);
  auto tables = std::pair(TableOf(first), TableOf(second));
  if (first.empty())
  {
    tables.first->Initialize(); // an idle process has no columns
  }
  communicator->Become(0);
  const auto probe = TableOf(first);
  if (first.empty())
  {
    probe->Initialize();
  }
  MergeTables(probe, HowTo()); // to know what it gives
  communicator->Other = communicator->Given;
  communicator->Become(1);
  MergeTables(tables.second, HowTo());
  communicator->Other = communicator->Given;
  communicator->Become(0);
  MergeTables(tables.first, HowTo());
  vtkMultiProcessController::SetGlobalController(before);
  return tables;
}
}

TEST(MergeTables, RowsOfOneKeyAreMerged_ExactOracle)
{
  const auto [first, second] =
    MergeBoth({ { 0, "a", 3, -1.0, 4.0, 2.0, 2.0 }, { -1, "all", 3, -1.0, 4.0, 2.0, 2.0 } },
      { { 0, "b", 1, -2.0, 1.0, 6.0, 6.0 }, { 2, "c", 5, 7.0, 8.0, 9.0, 10.0 },
        { -1, "every", 6, -2.0, 8.0, 8.5, 9.5 } });
  EXPECT_EQ(second->GetNumberOfRows(), 0);
  ASSERT_EQ(first->GetNumberOfRows(), 3);
  const auto value = [&table = first](vtkIdType row, const char* name)
  { return table->GetValueByName(row, name).ToDouble(); };
  EXPECT_EQ(value(0, "Key"), 0);
  EXPECT_EQ(value(1, "Key"), 2);
  EXPECT_EQ(value(2, "Key"), -1); // stays the last
  EXPECT_EQ(first->GetValueByName(0, "Text").ToString(), "a");
  EXPECT_EQ(first->GetValueByName(2, "Text").ToString(), "all");
  EXPECT_EQ(value(0, "Count"), 4);
  EXPECT_EQ(value(0, "Least"), -2.0);
  EXPECT_EQ(value(0, "Largest"), 4.0);
  EXPECT_EQ(value(0, "Mean"), 3.0);
  EXPECT_DOUBLE_EQ(value(0, "Rms"), std::sqrt((3 * 4.0 + 36.0) / 4));
  EXPECT_EQ(value(1, "Rms"), 10.0);
  EXPECT_TRUE(vtkIntArray::SafeDownCast(first->GetColumnByName("Count")));
}

TEST(MergeTables, NothingHasNoExtrema)
{
  const auto [first, second] =
    MergeBoth({ { 1, "", 0, 0.0, 0.0, 0.0, 0.0 } }, { { 1, "", 2, 3.0, 4.0, 3.5, 3.6 } });
  ASSERT_EQ(first->GetNumberOfRows(), 1);
  EXPECT_EQ(first->GetValueByName(0, "Least").ToDouble(), 3.0);
  EXPECT_EQ(first->GetValueByName(0, "Mean").ToDouble(), 3.5);
}

TEST(MergeTables, AnIdleProcessTakesTheColumnsOfOthers)
{
  const auto [first, second] = MergeBoth({}, { { 4, "d", 2, 3.0, 4.0, 3.5, 3.6 } });
  EXPECT_EQ(second->GetNumberOfColumns(), 0);
  ASSERT_EQ(first->GetNumberOfRows(), 1);
  EXPECT_STREQ(first->GetColumn(1)->GetName(), "Text");
  EXPECT_EQ(first->GetValueByName(0, "Text").ToString(), "d");
}

TEST(Processes, PartsFollowEachOtherAndDifferByOne_Property)
{
  for (std::size_t n : { 0U, 1U, 5U, 12U, 100U })
  {
    for (int count : { 1, 2, 3, 7 })
    {
      std::size_t end = 0;
      for (int process = 0; process < count; ++process)
      {
        const Processes::Part part = Processes::PartOf(n, process, count);
        EXPECT_EQ(part.Begin, end);
        end = part.End;
        EXPECT_LE(part.End - part.Begin, n / static_cast<std::size_t>(count) + 1);
        EXPECT_GE(part.End - part.Begin, n / static_cast<std::size_t>(count));
      }
      EXPECT_EQ(end, n);
    }
  }
}
