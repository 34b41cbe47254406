// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"
#include "LocatedSamples.h"

namespace knotwork
{
/// The data terms of a fit, element by element, without their matrix: values tau of the element's
/// local functions at its samples, a row a sample, and the weight matrices
/// W_i = Point I + Normal N_i N_i^T. On an element vectors are Dim planes of Stride() numbers, one
/// a local function, then padding.
/// Memory: prod(p + 1) numbers a sample.
template <int Dim>
class DataTerms
{
public:
  static constexpr int NumLanes = 4;
  static int Stride(int numLocal) { return (numLocal + NumLanes - 1) / NumLanes * NumLanes; }

  DataTerms(const SplineSpace<Dim>& space, const LocatedSamples<Dim>& located,
    const FitSamples<Dim>& samples, const FitWeights& weights, int threads);

  int NumGroups() const { return static_cast<int>(this->Groups.size()); }
  int Element(int group) const { return this->Groups[static_cast<std::size_t>(group)].Element; }
  /// sum += tau^T W tau x on the element of a group.
  void Apply(int group, const double* x, double* sum) const;
  /// sum += tau^T W r: what the group adds to the right-hand side.
  void AddRight(int group, double* sum) const;
  /// The group's samples: number and values of local function j at sample i.
  int NumSamples(int group) const;
  const double* Values(int group, int sample) const;
  /// W of a sample, Dim x Dim.
  Eigen::Matrix<double, Dim, Dim> Weight(int group, int sample) const;
  double PointWeight() const { return this->Point; }
  double NormalWeight() const { return this->Normal; }
  /// N_i times the root of the normal weight.
  Eigen::Matrix<double, Dim, 1> ScaledNormal(int group, int sample) const;

private:
  std::vector<typename LocatedSamples<Dim>::Group> Groups;
  std::size_t Padded;
  double Point;
  double Normal;
  std::vector<double>
    Tau; // sample k of the order of LocatedSamples: Padded numbers from k * Padded
  std::vector<double> Normals; // Dim a sample, times the root of the weight
  std::vector<double> Pulls;   // W r, Dim a sample
};
}
