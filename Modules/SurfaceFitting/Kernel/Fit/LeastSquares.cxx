// SPDX-License-Identifier: BSD-3-Clause
#include "LeastSquares.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 16;
constexpr std::size_t LeastRows = 16;      // of a group
constexpr std::size_t MostGroups = 64;     // each one needs an entry a function while it is made
constexpr std::size_t ProductChunk = 512;  // a row's product is little work
constexpr double LeastPoints = 1.0 / 30.0; // in the middle of a function, that it counts as more
constexpr double LeastShare = 1.0 / 6.0;   // of what points spread evenly would weigh with it
constexpr double LeastEnergy = 0.01;       // of an element without points, of the mean
constexpr double Pi = 3.14159265358979323846;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

LeastSquaresSystem::LeastSquaresSystem(const ElementFunctions& functions,
  const ElementMoments& moments, const IntArray<2>& degree, int numComponents,
  const FitDivision& division, const LeastSquaresParams& params)
  : Functions(functions), Moments(moments), Division(division), Params(params),
    Components(numComponents), Energy(ThinPlateMatrix(degree)),
    GroupRows(std::max(LeastRows, At(functions.NumFunctions) / MostGroups)),
    Parts(division.Parts(At(functions.NumFunctions), this->GroupRows)),
    FirstRow(this->Parts[division.Own()]), EndRow(this->Parts[division.Own() + 1]),
    Groups((At(functions.NumFunctions) + GroupRows - 1) / GroupRows),
    Diagonal(functions.NumFunctions), Damping(functions.NumFunctions),
    Right(functions.NumFunctions, numComponents)
{
  const int numElements = functions.NumElements();
  if (params.IsDamped)
  {
    // the integral of the square of a uniform B-spline, its mean over the support, and the square
    // of its largest value, about: those of a normal distribution
    this->PointDamping = LeastPoints;
    this->DampingShare = LeastShare;
    for (const int p : degree)
    {
      const double square = std::sqrt(3.0 / (Pi * (p + 1)));
      this->PointDamping *= square;
      this->DampingShare *= square / (p + 1);
      this->SquaredPeak *= 6.0 / (Pi * (p + 1));
    }
  }
  double weight = 0.0;
  this->Weights.resize(At(numElements));
  ParallelFor(At(numElements), ElementChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        this->Weights[e] = moments.Weight(static_cast<int>(e));
      }
    });
  this->ElementStart.assign(At(numElements) + 1, 0);
  for (int e = 0; e < numElements; ++e)
  {
    weight += this->Weights[At(e)];
    this->ElementStart[At(e) + 1] =
      this->ElementStart[At(e)] + At(functions.Alive(e)) * At(functions.Alive(e));
  }
  this->MeanWeight = weight / numElements;
  for (double& value : this->Energy)
  {
    value *= params.Smoothing;
  }
  this->ElementMatrices.resize(this->ElementStart.back());
  this->ElementRight.resize(functions.Functions.size() * At(numComponents));
  ParallelFor(At(numElements), ElementChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        this->MakeElement(static_cast<int>(e));
      }
    });
  ParallelFor(this->EndRow - this->FirstRow, this->GroupRows, params.Threads,
    [&](std::size_t begin, std::size_t end)
    { this->FindColumns(this->FirstRow + begin, this->FirstRow + end); });
  this->ShareRows();
}

void LeastSquaresSystem::ShareRows()
{
  this->Division.ShareParts(this->Diagonal.data(), this->Parts);
  this->Division.ShareParts(this->Damping.data(), this->Parts);
  this->Division.ShareParts(this->Right.data(), this->Parts, At(this->Components));
}

void LeastSquaresSystem::MakeElement(int e)
{
  const auto functions =
    this->Functions.Functions.begin() + static_cast<std::ptrdiff_t>(this->Functions.First(e));
  if (std::none_of(functions, functions + this->Functions.Alive(e),
        [this](int function) { return this->IsOwnRow(function); }))
  {
    return;
  }
  const int n = this->Functions.PerElement;
  double gram[100 * 100];
  double product[100];
  this->Moments.Gram(e, gram);
  // A step between two points bends the small elements between them by any number of tolerances:
  // where points are few, the energy must not outweigh them. Damping holds what it lets go.
  const double least = this->Params.IsDamped ? LeastEnergy : 1.0;
  const double weight =
    std::clamp(this->Weights[At(e)], least * this->MeanWeight, this->MeanWeight);
  for (int i = 0; i < n * n; ++i)
  {
    gram[i] += weight * this->Energy[At(i)];
  }
  const int alive = this->Functions.Alive(e);
  const std::size_t first = this->Functions.First(e);
  double* matrix = this->ElementMatrices.data() + this->ElementStart[At(e)];
  for (int k = 0; k < alive; ++k)
  {
    const double* row = this->Functions.Row(first + At(k));
    std::fill_n(product, n, 0.0);
    for (int a = 0; a < n; ++a)
    {
      if (const double r = row[a]; r != 0.0)
      {
        const double* from = gram + a * n;
        for (int b = 0; b < n; ++b)
        {
          product[b] += r * from[b];
        }
      }
    }
    for (int l = 0; l <= k; ++l)
    {
      const double* other = this->Functions.Row(first + At(l));
      double sum = 0.0;
      for (int b = 0; b < n; ++b)
      {
        sum += product[b] * other[b];
      }
      matrix[k * alive + l] = sum;
      matrix[l * alive + k] = sum;
    }
    for (int c = 0; c < this->Components; ++c)
    {
      const double* right = this->Moments.Right(e, c);
      double sum = 0.0;
      for (int b = 0; b < n; ++b)
      {
        sum += row[b] * right[b];
      }
      this->ElementRight[(first + At(k)) * At(this->Components) + At(c)] = sum;
    }
  }
}

void LeastSquaresSystem::FindColumns(std::size_t begin, std::size_t end)
{
  RowGroup& group = this->Groups[begin / this->GroupRows];
  std::vector<int> places(At(this->Functions.NumFunctions), -1);
  group.Start.push_back(0);
  for (std::size_t i = begin; i < end; ++i)
  {
    const auto first = static_cast<int>(group.Columns.size());
    for (std::size_t use = this->Functions.UseStart[i]; use < this->Functions.UseStart[i + 1];
         ++use)
    {
      const int e = this->Functions.ElementOfEntry[this->Functions.Uses[use]];
      const std::size_t start = this->Functions.First(e);
      for (int l = 0; l < this->Functions.Alive(e); ++l)
      {
        const int column = this->Functions.Functions[start + At(l)];
        if (places[At(column)] < first)
        {
          places[At(column)] = static_cast<int>(group.Columns.size());
          group.Columns.push_back(column);
        }
      }
    }
    group.Start.push_back(group.Columns.size());
    group.Values.resize(group.Columns.size());
    this->FillRow(i, places);
  }
}

/// @param places  of the row's columns among those of its group.
void LeastSquaresSystem::FillRow(std::size_t function, std::vector<int>& places)
{
  RowGroup& group = this->Groups[function / this->GroupRows];
  const std::size_t own = function % this->GroupRows;
  std::fill(group.Values.begin() + static_cast<std::ptrdiff_t>(group.Start[own]),
    group.Values.begin() + static_cast<std::ptrdiff_t>(group.Start[own + 1]), 0.0);
  const auto i = static_cast<Eigen::Index>(function);
  this->Right.row(i).setZero();
  double weight = 0.0;
  double peak = 0.0;
  for (std::size_t use = this->Functions.UseStart[function];
       use < this->Functions.UseStart[function + 1]; ++use)
  {
    const std::size_t entry = this->Functions.Uses[use];
    const int e = this->Functions.ElementOfEntry[entry];
    const std::size_t start = this->Functions.First(e);
    const int alive = this->Functions.Alive(e);
    weight += this->Weights[At(e)];
    const double* row = this->Functions.Row(entry);
    peak = std::max(peak, *std::max_element(row, row + this->Functions.PerElement));
    const double* from =
      this->ElementMatrices.data() + this->ElementStart[At(e)] + (entry - start) * At(alive);
    for (int l = 0; l < alive; ++l)
    {
      group.Values[At(places[At(this->Functions.Functions[start + At(l)])])] += from[l];
    }
    for (int c = 0; c < this->Components; ++c)
    {
      this->Right(i, c) += this->ElementRight[entry * At(this->Components) + At(c)];
    }
  }
  this->Diagonal[i] = group.Values[At(places[function])];
  const double scale = std::min(1.0, peak * peak / this->SquaredPeak); // LR functions have factors
  this->Damping[i] = scale * this->PointDamping +
    std::max(0.0, scale * this->DampingShare * weight - this->Diagonal[i]);
}

void LeastSquaresSystem::Update(const std::vector<int>& elements)
{
  std::vector<int> rows;
  for (const int e : elements)
  {
    const auto first = this->Functions.Functions.begin();
    rows.insert(rows.end(), first + static_cast<std::ptrdiff_t>(this->Functions.Start[At(e)]),
      first + static_cast<std::ptrdiff_t>(this->Functions.Start[At(e) + 1]));
  }
  rows.erase(std::remove_if(rows.begin(), rows.end(),
               [this](int function) { return !this->IsOwnRow(function); }),
    rows.end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  ParallelFor(elements.size(), ElementChunk, this->Params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        this->Weights[At(elements[k])] = this->Moments.Weight(elements[k]);
        this->MakeElement(elements[k]);
      }
    });
  ParallelFor(rows.size(), this->GroupRows, this->Params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<int> places(At(this->Functions.NumFunctions), -1);
      for (std::size_t k = begin; k < end; ++k)
      {
        const std::size_t row = At(rows[k]);
        const RowGroup& group = this->Groups[row / this->GroupRows];
        for (std::size_t j = group.Start[row % this->GroupRows];
             j < group.Start[row % this->GroupRows + 1]; ++j)
        {
          places[At(group.Columns[j])] = static_cast<int>(j);
        }
        this->FillRow(row, places);
      }
    });
  this->ShareRows();
}

void LeastSquaresSystem::Multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const
{
  ParallelFor(this->EndRow - this->FirstRow, ProductChunk, this->Params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      const double* from = x.data();
      for (std::size_t i = this->FirstRow + begin; i < this->FirstRow + end; ++i)
      {
        const RowGroup& group = this->Groups[i / this->GroupRows];
        double sums[2] = {};
        std::size_t k = group.Start[i % this->GroupRows];
        const std::size_t last = group.Start[i % this->GroupRows + 1];
        for (; k + 1 < last; k += 2)
        {
          sums[0] += group.Values[k] * from[group.Columns[k]];
          sums[1] += group.Values[k + 1] * from[group.Columns[k + 1]];
        }
        if (k < last)
        {
          sums[0] += group.Values[k] * from[group.Columns[k]];
        }
        y[static_cast<Eigen::Index>(i)] = sums[0] + sums[1];
      }
    });
  this->Division.ShareParts(y.data(), this->Parts);
}

/// @param scale  of every unknown; 0 where it stays as it is.
void LeastSquaresSystem::SolveColumn(
  const Eigen::VectorXd& right, const Eigen::VectorXd& scale, Eigen::VectorXd& x) const
{
  Eigen::VectorXd product(x.size());
  this->Multiply(x, product);
  Eigen::VectorXd residual = right - product;
  Eigen::VectorXd scaled = residual.cwiseProduct(scale);
  Eigen::VectorXd direction = scaled;
  double rho = residual.dot(scaled);
  for (int k = 0; k < this->Params.MaxIterations; ++k)
  {
    if (scaled.lpNorm<Eigen::Infinity>() <= this->Params.Accuracy)
    {
      return;
    }
    this->Multiply(direction, product);
    product += this->Damping.cwiseProduct(direction);
    const double curvature = direction.dot(product);
    if (!(curvature > 0.0) || !std::isfinite(curvature))
    {
      return;
    }
    const double step = rho / curvature;
    x += step * direction;
    residual -= step * product;
    scaled = residual.cwiseProduct(scale);
    const double next = residual.dot(scaled);
    direction = scaled + next / rho * direction;
    rho = next;
  }
}

void LeastSquaresSystem::Solve(
  PointMatrix& coefficients, const std::vector<std::uint8_t>& fixed) const
{
  Eigen::VectorXd scale = (this->Diagonal + this->Damping)
                            .cwiseMax(1e-300 + 1e-14 * this->Diagonal.maxCoeff())
                            .cwiseInverse();
  for (std::size_t f = 0; f < fixed.size(); ++f)
  {
    scale[static_cast<Eigen::Index>(f)] *= fixed[f] == 0 ? 1.0 : 0.0;
  }
  for (int c = 0; c < this->Components; ++c)
  {
    Eigen::VectorXd x = coefficients.col(c);
    this->SolveColumn(this->Right.col(c), scale, x);
    coefficients.col(c) = x;
  }
}
}
