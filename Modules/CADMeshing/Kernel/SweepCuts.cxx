// SPDX-License-Identifier: BSD-3-Clause
#include "SweepCuts.h"

#include "SolidSweeps.h"

#include <algorithm>
#include <tuple>

namespace knotwork
{
namespace
{
/// Pieces behind cuts.
struct CutState
{
  CADPieces Pieces;
  std::vector<CADOperation> Cuts;
  int Solids = 0;
  int NotSwept = 0;   ///< solids
  bool Suits = false; ///< all are swept, such that faces between them suit both
};

/// Composites are one face each.
Result<CADTopology> JoinedTopology(const CADPieces& pieces, std::vector<std::string>& notes)
{
  auto model = pieces.Topology();
  notes = model ? JoinComposites(model.Value) : std::vector<std::string>();
  return model;
}

void CountNotSwept(const CADTopology& model, CutState& state)
{
  const CADQuadsParams params;
  FaceMesher faces(model, params);
  faces.FindShapes();
  state.Solids = static_cast<int>(model.Bodies.size());
  state.NotSwept = 0;
  for (int body = 0; body < state.Solids; ++body)
  {
    state.NotSwept += SweepsOf(model, faces, body) ? 0 : 1;
  }
  state.Suits = state.NotSwept == 0 && ChooseSweeps(model, faces);
}

bool IsBetter(const CutState& a, const CutState& b)
{
  return std::tuple(!a.Suits, a.NotSwept, a.Solids) < std::tuple(!b.Suits, b.NotSwept, b.Solids);
}

/// States behind one more cut.
class CutSearch
{
public:
  explicit CutSearch(const SweepCutsParams& params) : Params(params) {}

  /// @return Aborted.
  Status Deepen(std::vector<CutState>& states)
  {
    std::vector<CutState> deeper;
    double tried = 0.0;
    for (const CutState& state : states)
    {
      const auto cuts = state.Pieces.Cuts();
      const auto number = std::min<std::size_t>(
        cuts ? cuts->size() : 0, static_cast<std::size_t>(this->Params.MaxTried));
      for (std::size_t i = 0; i < number; ++i)
      {
        const auto pieces = state.Pieces.Cut(cuts.Value[i]);
        std::vector<std::string> ignored;
        const auto model =
          pieces ? JoinedTopology(pieces.Value, ignored) : Result<CADTopology>(pieces.Status);
        if (model)
        {
          CutState next{ pieces.Value, state.Cuts };
          next.Cuts.push_back(cuts.Value[i]);
          CountNotSwept(model.Value, next);
          deeper.push_back(std::move(next));
        }
        ++tried;
        if (this->Params.Progress &&
          !this->Params.Progress(tried / (tried + static_cast<double>(states.size()))))
        {
          return { ErrorCode::Aborted, "the search for cuts was stopped" };
        }
      }
    }
    std::stable_sort(deeper.begin(), deeper.end(), IsBetter);
    states = std::move(deeper);
    return {};
  }

private:
  const SweepCutsParams& Params;
};
}

Result<SweepCuts> FindSweepCuts(
  const CADPieces& pieces, const PieceMeshing& meshing, const SweepCutsParams& params)
{
  constexpr std::size_t Kept = 4;
  SweepCuts found;
  auto model = JoinedTopology(pieces, found.Notes);
  if (!model)
  {
    return model.Status;
  }
  found.Model = std::move(model.Value);
  const Status uncut = meshing(found.Model);
  if (uncut || uncut.Code != ErrorCode::InvalidTopology)
  {
    return uncut ? Result<SweepCuts>(std::move(found)) : Result<SweepCuts>(uncut);
  }
  std::vector<CutState> states{ { pieces, {} } };
  CutSearch search(params);
  for (int cut = 0; cut < params.MaxCuts && !states.empty(); ++cut)
  {
    states.resize(std::min(states.size(), Kept));
    if (Status deepened = search.Deepen(states); !deepened)
    {
      return deepened;
    }
    for (const CutState& state : states)
    {
      if (!state.Suits)
      {
        break; // those behind it are worse
      }
      std::vector<std::string> notes;
      model = JoinedTopology(state.Pieces, notes);
      if (!model)
      {
        return model.Status;
      }
      const Status meshed = meshing(model.Value);
      if (meshed)
      {
        found.Model = std::move(model.Value);
        found.Cuts = state.Cuts;
        found.Notes = std::move(notes);
        return found;
      }
      if (meshed.Code != ErrorCode::InvalidTopology)
      {
        return meshed;
      }
    }
  }
  return uncut;
}
}
