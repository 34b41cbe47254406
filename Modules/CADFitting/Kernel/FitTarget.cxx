// SPDX-License-Identifier: BSD-3-Clause
#include "FitTarget.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
FitTarget::~FitTarget() = default;

const TriangleIndex<3>* FitTarget::Triangles() const
{
  return nullptr;
}

PolylineFoot::PolylineFoot(PointMatrix points, bool closed)
  : Points(std::move(points)), Lengths{ 0.0 }, Closed(closed)
{
  if (closed)
  {
    this->Points.conservativeResize(this->Points.rows() + 1, 3);
    this->Points.bottomRows<1>() = this->Points.topRows<1>().eval();
  }
  for (Eigen::Index i = 1; i < this->Points.rows(); ++i)
  {
    this->Lengths.push_back(
      this->Lengths.back() + (this->Points.row(i) - this->Points.row(i - 1)).norm());
  }
}

PolylineFoot::Foot PolylineFoot::Nearest(const Eigen::RowVector3d& query) const
{
  Foot best{ this->Points.row(0), 0.0, (this->Points.row(0) - query).norm() };
  for (Eigen::Index i = 1; i < this->Points.rows(); ++i)
  {
    const Eigen::RowVector3d begin = this->Points.row(i - 1);
    const Eigen::RowVector3d along = this->Points.row(i) - begin;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp((query - begin).dot(along) / square, 0.0, 1.0) : 0.0;
    const Eigen::RowVector3d point = begin + t * along;
    const double distance = (point - query).norm();
    if (distance < best.Distance)
    {
      const double before = this->Lengths[static_cast<std::size_t>(i - 1)];
      best = { point, before + t * std::sqrt(square), distance };
    }
  }
  return best;
}

Eigen::RowVector3d PolylineFoot::At(double length) const
{
  if (this->Closed && this->Length() > 0.0)
  {
    length -= std::floor(length / this->Length()) * this->Length();
  }
  const auto next = std::upper_bound(this->Lengths.begin(), this->Lengths.end(), length);
  if (next == this->Lengths.begin())
  {
    return this->Points.row(0);
  }
  if (next == this->Lengths.end())
  {
    return this->Points.bottomRows<1>();
  }
  const auto i = static_cast<Eigen::Index>(next - this->Lengths.begin());
  const double before = *(next - 1);
  const double t = (length - before) / (*next - before);
  return (1.0 - t) * this->Points.row(i - 1) + t * this->Points.row(i);
}

PolylineFoot LineOf(const TargetCurve& curve)
{
  return curve.IsLoop() ? PolylineFoot(curve.Points.topRows(curve.Points.rows() - 1), true)
                        : PolylineFoot(curve.Points, curve.IsClosed());
}
}
