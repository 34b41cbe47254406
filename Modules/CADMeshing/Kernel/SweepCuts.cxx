// SPDX-License-Identifier: BSD-3-Clause
#include "SweepCuts.h"

#include "SolidSweeps.h"

#include <algorithm>
#include <cmath>
#include <string>
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
  state.Suits = static_cast<bool>(ChooseSweeps(model, faces));
  for (int body = 0; !state.Suits && body < state.Solids; ++body)
  {
    state.NotSwept += SweepsOf(model, faces, body) ? 0 : 1;
  }
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
  constexpr std::size_t MostMeshed = 6; ///< behind as many cuts
  SweepCuts found;
  auto model = JoinedTopology(pieces, found.Notes);
  if (!model)
  {
    return model.Status;
  }
  found.Model = std::move(model.Value);
  const auto uncut = meshing(found.Model);
  if (uncut ? uncut.Value == 0.0 : uncut.Status.Code != ErrorCode::InvalidTopology)
  {
    return uncut ? Result<SweepCuts>(std::move(found)) : Result<SweepCuts>(uncut.Status);
  }
  Status failure = uncut.Status;
  double least = uncut ? uncut.Value : HUGE_VAL; // share of cells that are not valid
  std::vector<CutState> states{ { pieces, {} } };
  CutSearch search(params);
  for (int cut = 0; cut < params.MaxCuts && !states.empty(); ++cut)
  {
    states.resize(std::min(states.size(), Kept));
    if (Status deepened = search.Deepen(states); !deepened)
    {
      return deepened;
    }
    for (std::size_t i = 0; i < std::min(states.size(), MostMeshed) && states[i].Suits; ++i)
    {
      SweepCuts next;
      model = JoinedTopology(states[i].Pieces, next.Notes);
      if (!model)
      {
        return model.Status;
      }
      next.Model = std::move(model.Value);
      next.Cuts = states[i].Cuts;
      const auto meshed = meshing(next.Model);
      if (meshed && meshed.Value == 0.0)
      {
        return next;
      }
      if (!meshed && meshed.Status.Code == ErrorCode::TooLarge)
      {
        failure = meshed.Status; // other pieces may need fewer cells
      }
      else if (!meshed && meshed.Status.Code != ErrorCode::InvalidTopology)
      {
        return meshed.Status;
      }
      if (meshed && meshed.Value < least)
      {
        found = std::move(next);
        least = meshed.Value;
      }
    }
  }
  if (least == HUGE_VAL)
  {
    return failure;
  }
  if (least > MostInvalidCells)
  {
    return { ErrorCode::InvalidTopology,
      "of the hexahedra " + std::to_string(std::lround(100.0 * least)) +
        " in a hundred fold over, with the best cuts that were found; lower EdgeLength or "
        "Curvature, or cut the solid (cadmodify, which has --suggest)" };
  }
  const auto again = meshing(found.Model);
  return again ? Result<SweepCuts>(std::move(found)) : Result<SweepCuts>(again.Status);
}
}
