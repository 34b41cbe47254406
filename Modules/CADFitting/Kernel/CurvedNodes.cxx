// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedNodes.h"

#include "ElementUntangling.h"
#include "OffsetExtension.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
constexpr int FollowingRings = 2;        ///< of elements around folded ones
constexpr double LeastShare = 0.05;      ///< of the straight element's det J
constexpr double FirstStep = 1.0 / 32.0; ///< of the way back; twice as far each time

std::size_t Index(int i)
{
  return static_cast<std::size_t>(i);
}

PointMatrix Gather(const PointMatrix& points, const int* begin, const int* end)
{
  PointMatrix result(end - begin, 3);
  for (Eigen::Index row = 0; begin != end; ++begin, ++row)
  {
    result.row(row) = points.row(*begin);
  }
  return result;
}

bool LiesInPlane(const PointMatrix& points)
{
  for (Eigen::Index d = 0; d < 3; ++d)
  {
    if (points.rows() > 0 && (points.col(d).array() == points(0, d)).all())
    {
      return true;
    }
  }
  return false;
}
}

CurvedNodes::CurvedNodes(const NodeLattice& lattice, const PointMatrix& corners, bool bezier)
  : Lattice(lattice), Bezier(bezier), InPlane(!lattice.IsVolume() && LiesInPlane(corners)),
    Corners(corners), At(PointMatrix::Zero(lattice.NumNodes(), 3)),
    Offsets(PointMatrix::Zero(lattice.NumNodes(), 3)), Placed(Index(lattice.NumNodes()), 0),
    Held(Index(lattice.NumNodes()), 0), Shares(Index(lattice.NumNodes()), 1.0)
{
  this->Update();
}

Eigen::RowVector3d CurvedNodes::EdgeBase(int edge, int k) const
{
  const auto& ends = this->Lattice.Edges[Index(edge)];
  const double t = static_cast<double>(k) / this->Lattice.Order;
  return (1.0 - t) * this->At.row(ends[0]) + t * this->At.row(ends[1]);
}

PointMatrix CurvedNodes::FaceBase(int face) const
{
  const int* nodes = this->Lattice.FaceNodes.data();
  const auto f = Index(face);
  return this->Lattice.Table(this->Lattice.FaceShape(face)).Blend *
    Gather(this->At, nodes + this->Lattice.FaceBegin[f], nodes + this->Lattice.FaceBegin[f + 1]);
}

std::vector<int> CurvedNodes::InsideFace(int face) const
{
  std::vector<int> nodes = this->Lattice.Table(this->Lattice.FaceShape(face)).Inside;
  for (int& node : nodes)
  {
    node = this->Lattice.FaceNodes[this->Lattice.FaceBegin[Index(face)] + Index(node)];
  }
  return nodes;
}

void CurvedNodes::Place(int node, const Eigen::RowVector3d& base, const Eigen::RowVector3d& at)
{
  this->Offsets.row(node) = at - base;
  this->Placed[Index(node)] = 1;
  this->Held[Index(node)] = 1;
  this->At.row(node) = at;
}

void CurvedNodes::Update()
{
  this->ForBases([this](int node, const Eigen::RowVector3d& base)
    { this->At.row(node) = base + this->Shares[Index(node)] * this->Offsets.row(node); });
}

template <class Visit>
void CurvedNodes::ForBases(Visit&& set)
{
  const NodeLattice& lattice = this->Lattice;
  for (int corner = 0; corner < lattice.NumCorners; ++corner)
  {
    set(corner, this->Corners.row(corner));
  }
  for (int edge = 0; edge < static_cast<int>(lattice.Edges.size()); ++edge)
  {
    for (int k = 1; k < lattice.Order; ++k)
    {
      set(lattice.EdgeNode(edge, k), this->EdgeBase(edge, k));
    }
  }
  for (int face = 0; face < static_cast<int>(lattice.Faces.size()); ++face)
  {
    if (lattice.Table(lattice.FaceShape(face)).Inside.empty())
    {
      continue;
    }
    const PointMatrix base = this->FaceBase(face);
    const std::vector<int> inside = this->InsideFace(face);
    for (std::size_t i = 0; i < inside.size(); ++i)
    {
      set(inside[i], base.row(static_cast<Eigen::Index>(i)));
    }
  }
  for (int e = 0; lattice.IsVolume() && e < lattice.NumElements(); ++e)
  {
    const NodeTable& table = lattice.Table(lattice.Shapes[Index(e)]);
    if (table.Inside.empty())
    {
      continue;
    }
    const int* nodes = lattice.Nodes.data() + lattice.Begin[Index(e)];
    const PointMatrix base =
      table.Blend * Gather(this->At, nodes, lattice.Nodes.data() + lattice.Begin[Index(e) + 1]);
    for (std::size_t i = 0; i < table.Inside.size(); ++i)
    {
      set(nodes[table.Inside[i]], base.row(static_cast<Eigen::Index>(i)));
    }
  }
}

PointMatrix CurvedNodes::ControlPoints(Eigen::VectorXd& errors) const
{
  const NodeLattice& lattice = this->Lattice;
  PointMatrix control = this->At;
  errors = Eigen::VectorXd::Zero(control.rows());
  std::vector<char> isDone(Index(lattice.NumNodes()), lattice.Order == 1 ? 1 : 0);
  std::fill_n(isDone.begin(), lattice.NumCorners, 1);
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    const NodeTable& table = lattice.Table(lattice.Shapes[Index(e)]);
    const int* nodes = lattice.Nodes.data() + lattice.Begin[Index(e)];
    const auto count = static_cast<int>(lattice.Begin[Index(e) + 1] - lattice.Begin[Index(e)]);
    if (std::all_of(nodes, nodes + count, [&](int node) { return isDone[Index(node)] != 0; }))
    {
      continue;
    }
    // polynomials sum to one: what is converted is the offsets from the first point, so that
    // rounding is of the element's size
    const Eigen::RowVector3d origin = this->At.row(nodes[0]);
    const PointMatrix offsets = Gather(this->At, nodes, nodes + count).rowwise() - origin;
    const PointMatrix converted = table.ToBezier * offsets;
    // the matrix' own bound, a rounding of every offset, and one of the last sum
    const PointMatrix bound =
      (table.ErrorBound + 0x1p-51 * table.ToBezier.cwiseAbs()) * offsets.cwiseAbs();
    for (int i = 0; i < count; ++i)
    {
      if (isDone[Index(nodes[i])] == 0)
      {
        isDone[Index(nodes[i])] = 1;
        control.row(nodes[i]) = origin + converted.row(i);
        errors[nodes[i]] = 1.0625 *
          (bound.row(i).maxCoeff() + 0x1p-53 * control.row(nodes[i]).cwiseAbs().maxCoeff());
      }
    }
  }
  return control;
}

PointMatrix CurvedNodes::Output() const
{
  Eigen::VectorXd errors;
  return this->Bezier ? this->ControlPoints(errors) : this->At;
}

BernsteinCells CurvedNodes::MakeCells(const std::vector<int>& which) const
{
  const NodeLattice& lattice = this->Lattice;
  Eigen::VectorXd errors;
  const PointMatrix control = this->ControlPoints(errors);
  const bool hasErrors = !this->Bezier && lattice.Order > 1;
  BernsteinCells cells;
  cells.NumComponents = 3;
  for (const int e : which)
  {
    const CellShape shape = lattice.Shapes[Index(e)];
    const int cell = cells.Add(shape, DegreeOf(shape, lattice.Order));
    double* block = cells.Block(cell);
    const int* nodes = lattice.Nodes.data() + lattice.Begin[Index(e)];
    const auto count =
      static_cast<Eigen::Index>(lattice.Begin[Index(e) + 1] - lattice.Begin[Index(e)]);
    double error = 0.0;
    for (Eigen::Index i = 0; i < count; ++i)
    {
      for (Eigen::Index c = 0; c < 3; ++c)
      {
        block[c * count + i] = control(nodes[i], c);
      }
      error = std::max(error, errors[nodes[i]]);
    }
    if (hasErrors)
    {
      cells.Errors.push_back(error);
    }
  }
  return cells;
}

bool CurvedNodes::MoveBack(int element)
{
  const auto begin = this->Lattice.Begin[Index(element)];
  const auto end = this->Lattice.Begin[Index(element) + 1];
  bool moved = false;
  const auto step = [&](bool corners)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const int node = this->Lattice.Nodes[i];
      double& share = this->Shares[Index(node)];
      if ((node < this->Lattice.NumCorners) == corners && this->Placed[Index(node)] != 0 &&
        share > 0.0)
      {
        share = share == 1.0 ? 1.0 - FirstStep : std::max(0.0, 2.0 * share - 1.0);
        moved = true;
      }
    }
  };
  step(false);
  if (!moved) // the corners are not where they were given: they go back last
  {
    step(true);
  }
  return moved;
}

bool CurvedNodes::IsAccepted(int element, const CellCertificate& certificate) const
{
  if (certificate.Verdict != Verdict::Valid)
  {
    return false;
  }
  if (NumParameters(this->Lattice.Shapes[Index(element)]) == 3)
  {
    // the smallest that was found at a point: what is proved may be far below
    return this->Least.empty() || certificate.MinUpper >= this->Least[Index(element)];
  }
  // a fold in space need not be singular: the normal turns over
  return this->InPlane || certificate.OneSided;
}

Result<JacobianCertificate> CurvedNodes::Certify(const std::vector<int>& which, int threads) const
{
  JacobianParams params;
  params.Threads = threads;
  return ValidateJacobian(this->MakeCells(which), params);
}

std::vector<int> CurvedNodes::FoldedOf(
  const std::vector<int>& which, const JacobianCertificate& certificate) const
{
  std::vector<int> folded;
  for (std::size_t i = 0; i < which.size(); ++i)
  {
    if (!this->IsAccepted(which[i], certificate.Cells[i]))
    {
      folded.push_back(which[i]);
    }
  }
  return folded;
}

std::vector<int> CurvedNodes::MovedSince(const PointMatrix& old) const
{
  std::vector<int> moved;
  for (int e = 0; e < this->Lattice.NumElements(); ++e)
  {
    const int* nodes = this->Lattice.Nodes.data();
    if (std::any_of(nodes + this->Lattice.Begin[Index(e)],
          nodes + this->Lattice.Begin[Index(e) + 1],
          [&](int node) { return old.row(node) != this->At.row(node); }))
    {
      moved.push_back(e);
    }
  }
  return moved;
}

std::vector<char> CurvedNodes::FreeInside(const std::vector<int>& region) const
{
  const NodeLattice& lattice = this->Lattice;
  std::vector<char> isFree(this->Held.size(), 0);
  for (const int e : region)
  {
    for (std::size_t i = lattice.Begin[Index(e)]; i < lattice.Begin[Index(e) + 1]; ++i)
    {
      isFree[Index(lattice.Nodes[i])] = this->Held[Index(lattice.Nodes[i])] != 0 ? 0 : 1;
    }
  }
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    for (std::size_t i = lattice.Begin[Index(e)];
         i < lattice.Begin[Index(e) + 1] && !std::binary_search(region.begin(), region.end(), e);
         ++i)
    {
      isFree[Index(lattice.Nodes[i])] = 0;
    }
  }
  return isFree;
}

Status CurvedNodes::TryPositions(const PointMatrix& wanted, const std::vector<char>& isFree,
  int threads, std::vector<int>& folded, JacobianCertificate& all)
{
  const PointMatrix old = this->At;
  const PointMatrix oldOffsets = this->Offsets;
  const std::vector<char> oldPlaced = this->Placed;
  this->ForBases(
    [&](int node, const Eigen::RowVector3d& base)
    {
      if (isFree[Index(node)] != 0)
      {
        this->Offsets.row(node) = wanted.row(node) - base;
        this->Placed[Index(node)] = 1;
      }
      this->At.row(node) = base + this->Offsets.row(node);
    });
  const std::vector<int> moved = this->MovedSince(old);
  const auto part = this->Certify(moved, threads);
  if (!part)
  {
    return part.Status;
  }
  const std::vector<int> left = this->FoldedOf(moved, part.Value);
  if (left.size() < folded.size())
  {
    folded = left;
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
      all.Cells[Index(moved[i])] = part->Cells[i];
    }
    return {};
  }
  this->Offsets = oldOffsets;
  this->Placed = oldPlaced;
  this->Update();
  return {};
}

Status CurvedNodes::LetInsideFollow(int threads, std::vector<int>& folded, JacobianCertificate& all)
{
  const std::vector<int> region = RingsOf(this->Lattice, folded, FollowingRings);
  const std::vector<char> isFree = this->FreeInside(region);
  const CurvedNodes straight(this->Lattice, this->Corners, this->Bezier);
  PointMatrix ways = this->At - straight.At;
  if (std::count(isFree.begin(), isFree.end(), 1) == 0 ||
    !ExtendWays(this->Lattice, straight.At, region, isFree, ways))
  {
    return {}; // what no step of the lattice joins with the target stays
  }
  return this->TryPositions(straight.At + ways, isFree, threads, folded, all);
}

Status CurvedNodes::Untangle(
  int threads, const ProgressCallback& progress, std::vector<int>& folded, JacobianCertificate& all)
{
  const std::vector<int> region = RingsOf(this->Lattice, folded, FollowingRings);
  const std::vector<char> isFree = this->FreeInside(region);
  if (std::count(isFree.begin(), isFree.end(), 1) == 0)
  {
    return {};
  }
  const CurvedNodes straight(this->Lattice, this->Corners, this->Bezier);
  PointMatrix wanted = this->At;
  if (Status status =
        UntangleInside(this->Lattice, region, straight.At, isFree, threads, progress, wanted);
      !status)
  {
    return status;
  }
  return this->TryPositions(wanted, isFree, threads, folded, all);
}

int CurvedNodes::NumFollowing() const
{
  int count = 0;
  for (std::size_t node = 0; node < this->Placed.size(); ++node)
  {
    count += this->Placed[node] != 0 && this->Held[node] == 0 ? 1 : 0;
  }
  return count;
}

Status CurvedNodes::ComeForward(
  int threads, const ProgressCallback& progress, JacobianCertificate& all)
{
  const NodeLattice& lattice = this->Lattice;
  std::map<int, std::vector<int>> elementsOf; // of points that moved back
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    for (std::size_t i = lattice.Begin[Index(e)]; i < lattice.Begin[Index(e) + 1]; ++i)
    {
      if (this->Shares[Index(lattice.Nodes[i])] < 1.0)
      {
        elementsOf[lattice.Nodes[i]].push_back(e);
      }
    }
  }
  // those of the most elements first: corners, which bases are made of, are such
  std::vector<int> waiting;
  for (const auto& [node, elements] : elementsOf)
  {
    waiting.push_back(node);
  }
  std::stable_sort(waiting.begin(), waiting.end(),
    [&](int a, int b) { return elementsOf[a].size() > elementsOf[b].size(); });
  while (!waiting.empty())
  {
    if (progress && !progress(0.6))
    {
      return { ErrorCode::Aborted, "" };
    }
    std::vector<std::pair<int, double>> chosen; // without common elements, and their shares
    std::vector<int> others;
    std::map<int, int> nodeOf; // by element
    for (const int node : waiting)
    {
      const std::vector<int>& elements = elementsOf[node];
      if (std::any_of(
            elements.begin(), elements.end(), [&](int e) { return nodeOf.count(e) != 0; }))
      {
        others.push_back(node);
        continue;
      }
      for (const int e : elements)
      {
        nodeOf[e] = node;
      }
      chosen.emplace_back(node, this->Shares[Index(node)]);
      this->Shares[Index(node)] = 1.0;
    }
    std::vector<int> which;
    for (const auto& [element, node] : nodeOf)
    {
      which.push_back(element);
    }
    this->Update();
    const auto part = this->Certify(which, threads);
    if (!part)
    {
      return part.Status;
    }
    std::set<int> refused;
    for (const int element : this->FoldedOf(which, part.Value))
    {
      refused.insert(nodeOf[element]);
    }
    for (const auto& [node, share] : chosen)
    {
      if (refused.count(node) != 0)
      {
        this->Shares[Index(node)] = share;
      }
    }
    this->Update();
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      if (refused.count(nodeOf[which[i]]) == 0)
      {
        all.Cells[Index(which[i])] = part->Cells[i];
      }
    }
    waiting = std::move(others);
  }
  return {};
}

Result<JacobianCertificate> CurvedNodes::Relax(const StraightElements& elements, int threads,
  const ProgressCallback& progress, std::vector<char>& relaxed)
{
  const NodeLattice& lattice = this->Lattice;
  std::vector<int> which(lattice.Shapes.size());
  std::iota(which.begin(), which.end(), 0);
  if (lattice.IsVolume())
  {
    const CurvedNodes straight(lattice, this->Corners, this->Bezier);
    for (const int e : which)
    {
      this->Least.push_back(LeastShare * CornerDeterminant(lattice, straight.At, e));
    }
  }
  this->Update();
  auto all = this->Certify(which, threads);
  if (!all)
  {
    return all.Status;
  }
  std::vector<int> folded = this->FoldedOf(which, all.Value);
  if (!folded.empty())
  {
    if (Status status = this->LetInsideFollow(threads, folded, all.Value); !status)
    {
      return status;
    }
  }
  if (!folded.empty() && lattice.IsVolume())
  {
    if (Status status = this->Untangle(threads, progress, folded, all.Value); !status)
    {
      return status;
    }
  }
  while (!folded.empty())
  {
    if (progress && !progress(0.5))
    {
      return { ErrorCode::Aborted, "" };
    }
    for (const int element : folded)
    {
      if (!this->MoveBack(element) && all->Cells[Index(element)].Verdict != Verdict::Valid)
      {
        const Eigen::RowVector3d place = this->At.row(lattice.Nodes[lattice.Begin[Index(element)]]);
        return { ErrorCode::NotConverged,
          elements.ElementName(element) + " at " + PointText(place.data(), 3) +
            " is not valid though it is straight: it is as good as flat there; give it a better "
            "shape" };
      }
    }
    const PointMatrix old = this->At;
    this->Update();
    // that of a surface may be bent when it is straight, and is looked at no more
    which = this->MovedSince(old);
    const auto part = this->Certify(which, threads);
    if (!part)
    {
      return part.Status;
    }
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      all->Cells[Index(which[i])] = part->Cells[i];
    }
    std::vector<int> next = this->FoldedOf(which, part.Value);
    for (const int element : folded)
    {
      if (!std::binary_search(which.begin(), which.end(), element) &&
        all->Cells[Index(element)].Verdict != Verdict::Valid)
      {
        next.push_back(element); // its points moved by less than rounding: they go on
      }
    }
    std::sort(next.begin(), next.end());
    folded = std::move(next);
  }
  if (Status status = this->ComeForward(threads, progress, all.Value); !status)
  {
    return status;
  }
  relaxed.clear();
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    const int* nodes = lattice.Nodes.data() + lattice.Begin[Index(e)];
    relaxed.push_back(std::any_of(nodes, lattice.Nodes.data() + lattice.Begin[Index(e) + 1],
      [this](int node) { return this->Shares[Index(node)] < 1.0; }));
  }
  JacobianCertificate summary;
  summary.Cells = std::move(all->Cells);
  Summarize(summary);
  return summary;
}
}
