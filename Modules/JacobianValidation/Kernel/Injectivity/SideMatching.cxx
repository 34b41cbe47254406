// SPDX-License-Identifier: BSD-3-Clause
#include "SideMatching.h"

#include <knotwork/SplineCore/BoxTree.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace knotwork
{
namespace
{
class SideMatcher
{
public:
  explicit SideMatcher(GluingState& state) : State(state) {}

  /// Glues sides whose control points agree bit by bit.
  void GlueEqual()
  {
    std::vector<std::pair<std::uint64_t, int>> hashes;
    for (std::size_t i = 0; i < this->State.Open.size(); ++i)
    {
      hashes.push_back(
        { Hash(this->MakeCanonical(this->State.Open[i]).Values), static_cast<int>(i) });
    }
    std::sort(hashes.begin(), hashes.end());
    std::vector<bool> glued(this->State.Open.size(), false);
    for (std::size_t begin = 0; begin < hashes.size();)
    {
      std::size_t end = begin + 1;
      while (end < hashes.size() && hashes[end].first == hashes[begin].first)
      {
        ++end;
      }
      for (std::size_t i = begin; i + 1 < end; ++i)
      {
        const std::size_t first = static_cast<std::size_t>(hashes[i].second);
        if (glued[first])
        {
          continue;
        }
        const SideOfCell a = this->State.Open[first];
        const Canonical ca = this->MakeCanonical(a);
        for (std::size_t j = i + 1; j < end; ++j)
        {
          const std::size_t second = static_cast<std::size_t>(hashes[j].second);
          const SideOfCell b = this->State.Open[second];
          const Canonical cb = this->MakeCanonical(b);
          if (ca.Values != cb.Values)
          {
            continue;
          }
          if (glued[second] || glued[first] ||
            ca.Frame->Parity * this->State.Sign(a.Cell) ==
              cb.Frame->Parity * this->State.Sign(b.Cell))
          {
            this->State.SetFolded(a, b); // two of the cells lie on one side of it
          }
          glued[first] = true;
          glued[second] = true;
          this->GluePair(a, *ca.Frame, b, *cb.Frame);
        }
      }
      begin = end;
    }
    this->State.KeepUnglued(glued);
  }

  /// Glues what agrees up to rounding.
  void GlueNear()
  {
    const Eigen::Index n = static_cast<Eigen::Index>(this->State.Open.size());
    if (n == 0 || !(this->State.Params.InterfaceTolerance > 0.0))
    {
      return;
    }
    double largest = 0.0;
    PointMatrix lower = PointMatrix::Constant(n, 3, std::numeric_limits<double>::max());
    PointMatrix upper = -lower;
    std::vector<std::vector<std::array<double, 4>>> points;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      points.push_back(this->SidePoints(this->State.Open[static_cast<std::size_t>(i)]));
      for (const auto& x : points.back())
      {
        for (int d = 0; d < 3; ++d)
        {
          lower(i, d) = std::min(lower(i, d), x[static_cast<std::size_t>(d)]);
          upper(i, d) = std::max(upper(i, d), x[static_cast<std::size_t>(d)]);
          largest = std::max(largest, std::abs(x[static_cast<std::size_t>(d)]));
        }
      }
    }
    const double tolerance = this->State.Params.InterfaceTolerance * largest;
    const BoxTree tree(lower, upper);
    std::vector<bool> glued(this->State.Open.size(), false);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const std::size_t first = static_cast<std::size_t>(i);
      double low[3];
      double high[3];
      for (int d = 0; d < 3; ++d)
      {
        low[d] = lower(i, d) - tolerance;
        high[d] = upper(i, d) + tolerance;
      }
      std::vector<int> near;
      tree.ForNear(low, high,
        [&](int j)
        {
          bool same = j > i;
          for (int d = 0; d < 3 && same; ++d)
          {
            same = std::abs(lower(j, d) - lower(i, d)) <= tolerance &&
              std::abs(upper(j, d) - upper(i, d)) <= tolerance;
          }
          if (same)
          {
            near.push_back(j);
          }
        });
      std::sort(near.begin(), near.end());
      for (const int j : near)
      {
        const std::size_t second = static_cast<std::size_t>(j);
        double difference = 0.0;
        const Reframe* frame = this->FindReframe(this->State.Open[first], points[first],
          this->State.Open[second], points[second], tolerance, difference);
        if (!frame)
        {
          continue;
        }
        const SideOfCell a = this->State.Open[first];
        const SideOfCell b = this->State.Open[second];
        const SideFrame& shape = GetSideFrame(this->State.Shape(a.Cell), a.Number);
        const Reframe& identity = this->State.Reframes(
          shape.Shape, SideDegree(this->State.Shape(a.Cell), this->State.Degree(a.Cell), shape))[0];
        if (glued[first] || glued[second] ||
          identity.Parity * this->State.Sign(a.Cell) == frame->Parity * this->State.Sign(b.Cell))
        {
          this->State.SetFolded(a, b);
        }
        glued[first] = true;
        glued[second] = true;
        this->State.Out.InnerRounding = std::max(this->State.Out.InnerRounding, difference);
        this->GluePair(a, identity, b, *frame);
      }
    }
    this->State.KeepUnglued(glued);
  }

private:
  /// Values of a side in a frame, with signed zeros made equal.
  void FrameValues(SideOfCell side, const Reframe& reframe, const std::vector<int>& coefficients,
    std::vector<double>& values) const
  {
    const int n = NumCellCoefficients(this->State.Shape(side.Cell), this->State.Degree(side.Cell));
    const double* block = this->State.Cells.Block(side.Cell);
    values.clear();
    values.push_back(reframe.Degree[0]);
    values.push_back(reframe.Degree[1]);
    values.push_back(static_cast<double>(coefficients.size()));
    for (const int i : reframe.Coefficients)
    {
      for (int plane = 0; plane < this->State.Cells.NumPlanes(); ++plane)
      {
        values.push_back(block[plane * n + coefficients[static_cast<std::size_t>(i)]] + 0.0);
      }
    }
  }

  struct Canonical
  {
    std::vector<double> Values;
    const Reframe* Frame = nullptr;
  };

  Canonical MakeCanonical(SideOfCell side)
  {
    const CellShape shape = this->State.Shape(side.Cell);
    const SideFrame& frame = GetSideFrame(shape, side.Number);
    const auto coefficients = SideCoefficients(shape, this->State.Degree(side.Cell), frame);
    Canonical best;
    std::vector<double> values;
    for (const Reframe& reframe :
      this->State.Reframes(frame.Shape, SideDegree(shape, this->State.Degree(side.Cell), frame)))
    {
      this->FrameValues(side, reframe, coefficients, values);
      if (!best.Frame || values < best.Values)
      {
        best.Values = values;
        best.Frame = &reframe;
      }
    }
    return best;
  }

  static std::uint64_t Hash(const std::vector<double>& values)
  {
    std::uint64_t hash = 1469598103934665603ull;
    for (const double x : values)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ull;
      hash ^= hash >> 29;
    }
    return hash;
  }

  /// Control points of a side, Euclidean, with the weights relative to the first one's.
  std::vector<std::array<double, 4>> SidePoints(SideOfCell side) const
  {
    const CellShape shape = this->State.Shape(side.Cell);
    const int n = NumCellCoefficients(shape, this->State.Degree(side.Cell));
    const double* w = this->State.Cells.Block(side.Cell) + this->State.Cells.NumComponents * n;
    std::vector<std::array<double, 4>> points;
    for (const int i :
      SideCoefficients(shape, this->State.Degree(side.Cell), GetSideFrame(shape, side.Number)))
    {
      const auto x = this->State.Position(side.Cell, i);
      points.push_back({ x[0], x[1], x[2], this->State.Cells.Rational ? w[i] : 1.0 });
    }
    return points;
  }

  /// The way to look at side b in which it agrees with a, if any.
  const Reframe* FindReframe(SideOfCell a, const std::vector<std::array<double, 4>>& pa,
    SideOfCell b, const std::vector<std::array<double, 4>>& pb, double tolerance,
    double& difference)
  {
    const SideFrame& fa = GetSideFrame(this->State.Shape(a.Cell), a.Number);
    const SideFrame& fb = GetSideFrame(this->State.Shape(b.Cell), b.Number);
    if (fa.Shape != fb.Shape || pa.size() != pb.size())
    {
      return nullptr;
    }
    const Reframe& identity = this->State.Reframes(
      fa.Shape, SideDegree(this->State.Shape(a.Cell), this->State.Degree(a.Cell), fa))[0];
    for (const Reframe& reframe : this->State.Reframes(
           fb.Shape, SideDegree(this->State.Shape(b.Cell), this->State.Degree(b.Cell), fb)))
    {
      if (reframe.Degree != identity.Degree)
      {
        continue;
      }
      bool same = true;
      double largest = 0.0;
      const std::size_t firstA = static_cast<std::size_t>(identity.Coefficients[0]);
      const std::size_t firstB = static_cast<std::size_t>(reframe.Coefficients[0]);
      for (std::size_t k = 0; k < pa.size() && same; ++k)
      {
        const auto& x = pa[static_cast<std::size_t>(identity.Coefficients[k])];
        const auto& y = pb[static_cast<std::size_t>(reframe.Coefficients[k])];
        for (std::size_t d = 0; d < 3; ++d)
        {
          largest = std::max(largest, std::abs(x[d] - y[d]));
        }
        const double ratio = (x[3] / pa[firstA][3]) / (y[3] / pb[firstB][3]);
        same = largest <= tolerance &&
          std::abs(ratio - 1.0) <= std::max(this->State.Params.InterfaceTolerance, 0x1p-50);
      }
      if (same)
      {
        difference = largest;
        return &reframe;
      }
    }
    return nullptr;
  }

  void GluePair(SideOfCell a, const Reframe& fa, SideOfCell b, const Reframe& fb)
  {
    const SideFrame& sa = GetSideFrame(this->State.Shape(a.Cell), a.Number);
    const SideFrame& sb = GetSideFrame(this->State.Shape(b.Cell), b.Number);
    std::array<int, 4> ca{};
    std::array<int, 4> cb{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(sa.NumCorners); ++k)
    {
      ca[k] = sa.Corners[static_cast<std::size_t>(fa.Corners[k])];
      cb[k] = sb.Corners[static_cast<std::size_t>(fb.Corners[k])];
      this->State.JoinCorners(a.Cell, ca[k], b.Cell, cb[k]);
    }
    for (int e = 0; e < NumSideEdges(sa.Shape); ++e)
    {
      const auto ends = SideEdge(sa.Shape, e);
      const std::size_t i = static_cast<std::size_t>(ends[0]);
      const std::size_t j = static_cast<std::size_t>(ends[1]);
      this->State.Edges.Unite(
        this->State.EdgeId(a.Cell, ca[i], ca[j]), this->State.EdgeId(b.Cell, cb[i], cb[j]));
    }
    if (this->State.Patch(a.Cell) != this->State.Patch(b.Cell))
    {
      ++this->State.Out.NumInterfaces;
    }
    else if (!this->AreSameIds(a, b))
    {
      ++this->State.Out.NumSeams;
    }
  }

  /// Of sides of one patch with equal points: the same by what is known beside them?
  bool AreSameIds(SideOfCell a, SideOfCell b) const
  {
    if (a.Cell == b.Cell || (this->State.HasBox(a.Cell) && this->State.HasBox(b.Cell)))
    {
      return false;
    }
    if (this->State.Complex.PointIds.empty())
    {
      return true;
    }
    const auto sorted = [this](SideOfCell s)
    {
      std::vector<std::int64_t> ids;
      const CellShape shape = this->State.Shape(s.Cell);
      for (const int i :
        SideCoefficients(shape, this->State.Degree(s.Cell), GetSideFrame(shape, s.Number)))
      {
        ids.push_back(this->State.PointId(s.Cell, i));
      }
      std::sort(ids.begin(), ids.end());
      return ids;
    };
    return sorted(a) == sorted(b);
  }

  GluingState& State;
};
}

void GlueEqual(GluingState& state)
{
  SideMatcher(state).GlueEqual();
}

void GlueNear(GluingState& state)
{
  SideMatcher(state).GlueNear();
}
}
