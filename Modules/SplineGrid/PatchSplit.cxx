// SPDX-License-Identifier: BSD-3-Clause
#include "PatchSplit.h"

#include "PatchFields.h"
#include <knotwork/SplineCore/SplitIntoPatches.h>

#include <algorithm>

namespace knotwork
{
namespace
{
/// Moves the numbers of patches in a topology.
template <typename NumberOf>
void Renumber(PatchTopology& topology, const NumberOf& numberOf)
{
  for (PatchInterface& interface : topology.Interfaces)
  {
    for (PatchSide& side : interface.Sides)
    {
      side.Patch = numberOf(side.Patch);
    }
  }
  for (PatchSide& side : topology.Boundary)
  {
    side.Patch = numberOf(side.Patch);
  }
}

class Splitter
{
public:
  explicit Splitter(SplineModel& model) : Model(model)
  {
    for (const SplinePatch& patch : model.Patches)
    {
      this->NextId = std::max(this->NextId, patch.Id + 1);
    }
  }

  Status Run(int threads)
  {
    std::vector<int> numbers; // of the patches that stay
    for (SplinePatch& patch : this->Model.Patches)
    {
      numbers.push_back(static_cast<int>(this->Patches.size()));
      Status status = std::visit(
        [&](auto& spline)
        {
          if (spline.Space->Kind == SpaceKind::Unstructured)
          {
            return this->Split(spline, patch, threads);
          }
          this->Patches.push_back(patch);
          return Status();
        },
        patch.Geometry);
      if (!status)
      {
        return { status.Code, "patch " + std::to_string(patch.Id) + ": " + status.Detail };
      }
    }
    // an unstructured patch has no sides, so nothing was stated of it
    Renumber(this->Model.Topology, [&](int p) { return numbers[static_cast<std::size_t>(p)]; });
    const auto append = [](auto& to, const auto& from)
    { to.insert(to.end(), from.begin(), from.end()); };
    append(this->Model.Topology.Interfaces, this->Topology.Interfaces);
    append(this->Model.Topology.Boundary, this->Topology.Boundary);
    this->Model.Patches = std::move(this->Patches);
    return {};
  }

private:
  template <int Dim>
  Status Split([[maybe_unused]] const Spline<Dim>& spline,
    [[maybe_unused]] const SplinePatch& patch, int threads)
  {
    if constexpr (Dim > 1)
    {
      auto split = SplitIntoPatches(JoinFields(spline, patch.Fields), threads);
      if (!split)
      {
        return split.Status;
      }
      const int first = static_cast<int>(this->Patches.size());
      for (const Spline<Dim>& part : split->Patches)
      {
        SplinePatch made;
        made.Id = &part == split->Patches.data() ? patch.Id : this->NextId++;
        made.Block = patch.Block;
        made.Fields = patch.Fields;
        SeparateFields(part, made);
        this->Patches.push_back(std::move(made));
      }
      Renumber(split->Topology, [first](int p) { return first + p; });
      this->Topology.Interfaces.insert(this->Topology.Interfaces.end(),
        split->Topology.Interfaces.begin(), split->Topology.Interfaces.end());
      this->Topology.Boundary.insert(this->Topology.Boundary.end(),
        split->Topology.Boundary.begin(), split->Topology.Boundary.end());
      this->Model.Warnings.push_back("patch " + std::to_string(patch.Id) +
        " lies on an unstructured mesh and is written as " + std::to_string(split->Patches.size()) +
        " tensor-product patches");
    }
    return {};
  }

  SplineModel& Model;
  std::vector<SplinePatch> Patches;
  PatchTopology Topology;
  int NextId = 0;
};
}

Status SplitUnstructuredPatches(SplineModel& model, int threads)
{
  const bool any = std::any_of(model.Patches.begin(), model.Patches.end(),
    [](const SplinePatch& patch)
    {
      return std::visit([](const auto& spline)
        { return spline.Space->Kind == SpaceKind::Unstructured; },
        patch.Geometry);
    });
  return any ? Splitter(model).Run(threads) : Status();
}
}
