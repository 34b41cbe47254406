// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>

namespace knotwork
{
/// n x c, one point (or coefficient, or parameter) a row, contiguous by rows as VTK stores points.
/// The alignment of Eigen's owning types is pinned by the kernel targets' public compile definition
/// EIGEN_MAX_ALIGN_BYTES=16, so they may cross installed interfaces whatever the architecture
/// flags.
using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using PointMatrixView = Eigen::Ref<const PointMatrix>;

/// One integer or one real number per parametric direction.
template <int Dim>
using IntArray = std::array<int, Dim>;
template <int Dim>
using RealArray = std::array<double, Dim>;

/// Axis-aligned box in the parameter domain.
template <int Dim>
struct ParametricBox
{
  RealArray<Dim> Lower{};
  RealArray<Dim> Upper{};
};

/// Called from the calling thread only with the done share in [0, 1]; returns false to abort.
using ProgressCallback = std::function<bool(double)>;

/// Product of (p + 1) over the directions: functions of a tensor-product element.
template <int Dim>
int NumTensorFunctions(const IntArray<Dim>& degree)
{
  int n = 1;
  for (int p : degree)
  {
    n *= p + 1;
  }
  return n;
}

inline constexpr int MaxDegree = 9;
}
