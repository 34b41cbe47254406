// SPDX-License-Identifier: BSD-3-Clause
#include "SideContacts.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
std::vector<SideContact> FindContacts(const std::vector<BoundarySide>& boundary, int a, int b)
{
  const BoundarySide& x = boundary[static_cast<std::size_t>(a)];
  const BoundarySide& y = boundary[static_cast<std::size_t>(b)];
  std::vector<SideContact> contacts;
  for (int i = 0; i < NumSideEdges(x.Frame.Shape); ++i)
  {
    const std::size_t ei = static_cast<std::size_t>(i);
    for (int j = 0; j < NumSideEdges(y.Frame.Shape); ++j)
    {
      const std::size_t ej = static_cast<std::size_t>(j);
      if ((a == b && i == j) || x.CollapsedEdges[ei] || y.CollapsedEdges[ej])
      {
        continue;
      }
      SideContact contact;
      contact.IsEdge = true;
      contact.A = i;
      contact.B = j;
      if (x.Edges[ei] == y.Edges[ej])
      {
        const auto endsX = SideEdge(x.Frame.Shape, i);
        const auto endsY = SideEdge(y.Frame.Shape, j);
        const bool forward = x.Places[static_cast<std::size_t>(endsX[0])] ==
            y.Places[static_cast<std::size_t>(endsY[0])] &&
          x.Places[static_cast<std::size_t>(endsX[1])] ==
            y.Places[static_cast<std::size_t>(endsY[1])];
        if (!forward)
        {
          std::swap(contact.B0, contact.B1);
        }
        contacts.push_back(contact);
      }
      else if (x.Lines[ei] >= 0 && x.Lines[ei] == y.Lines[ej])
      {
        const auto& p = x.LineEnds[ei];
        const auto& q = y.LineEnds[ej];
        const double low = std::max(std::min(p[0], p[1]), std::min(q[0], q[1]));
        const double high = std::min(std::max(p[0], p[1]), std::max(q[0], q[1]));
        if (low < high)
        {
          const auto place = [](const std::array<double, 2>& ends, double t) {
            return std::ldexp(std::round(std::ldexp((t - ends[0]) / (ends[1] - ends[0]), 40)), -40);
          };
          contact.A0 = place(p, low);
          contact.A1 = place(p, high);
          contact.B0 = place(q, low);
          contact.B1 = place(q, high);
          contacts.push_back(contact);
        }
      }
    }
  }
  for (int i = 0; i < x.Frame.NumCorners; ++i)
  {
    for (int j = 0; j < y.Frame.NumCorners; ++j)
    {
      bool isPole = false; // of one collapsed edge: one corner
      for (int e = 0; a == b && e < NumSideEdges(x.Frame.Shape); ++e)
      {
        const auto ends = SideEdge(x.Frame.Shape, e);
        isPole = isPole ||
          (x.CollapsedEdges[static_cast<std::size_t>(e)] &&
            std::min(i, j) == std::min(ends[0], ends[1]) &&
            std::max(i, j) == std::max(ends[0], ends[1]));
      }
      if (!(a == b && i == j) && !isPole &&
        x.Places[static_cast<std::size_t>(i)] == y.Places[static_cast<std::size_t>(j)])
      {
        contacts.push_back({ false, i, j, 0.0, 1.0, 0.0, 1.0 });
      }
    }
  }
  return contacts;
}
}
