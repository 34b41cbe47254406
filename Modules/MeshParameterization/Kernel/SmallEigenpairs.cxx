// SPDX-License-Identifier: BSD-3-Clause
#include "SmallEigenpairs.h"

#include "SparseCholesky.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int BlockSize = 3;
constexpr int MaxBasis = 120;
constexpr double Tolerance = 1e-9; // residual over the eigenvalue of the inverse

/// Fixed pseudo-random numbers in [-1, 1): results do not depend on the run.
class Noise
{
public:
  double operator()()
  {
    this->State = this->State * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(this->State >> 11) / 4503599627370496.0 - 1.0;
  }

private:
  unsigned long long State = 20150605ULL;
};

/// Makes the columns of a block orthonormal for the masses, and orthogonal to constants and to the
/// first columns of the basis. A column that vanishes is replaced by noise.
void Orthonormalize(const Eigen::MatrixXd& basis, Eigen::Index used, const Eigen::VectorXd& masses,
  Noise& noise, Eigen::MatrixXd& block)
{
  const double total = masses.sum();
  for (Eigen::Index j = 0; j < block.cols(); ++j)
  {
    auto v = block.col(j);
    for (int attempt = 0; attempt < 3; ++attempt)
    {
      const double before = std::sqrt(v.dot(masses.cwiseProduct(v)));
      for (int pass = 0; pass < 2; ++pass)
      {
        v.array() -= masses.dot(v) / total;
        const Eigen::VectorXd weighted = masses.cwiseProduct(v);
        const Eigen::VectorXd share = basis.leftCols(used).transpose() * weighted;
        v.noalias() -= basis.leftCols(used) * share;
        for (Eigen::Index i = 0; i < j; ++i)
        {
          const double part = block.col(i).dot(masses.cwiseProduct(v));
          v -= part * block.col(i);
        }
      }
      const double norm = std::sqrt(v.dot(masses.cwiseProduct(v)));
      if (norm > 1e-10 * before && norm > 0.0)
      {
        v /= norm;
        break;
      }
      for (Eigen::Index i = 0; i < v.size(); ++i)
      {
        v[i] = noise();
      }
    }
  }
}
}

Result<SmallEigenpairs> FindSmallEigenpairs(
  const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses, double shift, int count)
{
  const Eigen::Index n = lower.rows();
  Eigen::SparseMatrix<double> shifted = lower;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    shifted.coeffRef(i, i) += shift * masses[i];
  }
  SparseCholesky cholesky;
  if (Status status = cholesky.Factorize(shifted); !status)
  {
    return status;
  }
  const auto limit = static_cast<Eigen::Index>(std::min<Eigen::Index>(MaxBasis, n - 1));
  const Eigen::Index blockSize = std::min<Eigen::Index>(BlockSize, limit);
  Noise noise;
  Eigen::MatrixXd basis(n, limit);
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(limit, limit);
  Eigen::MatrixXd block(n, blockSize);
  for (Eigen::Index i = 0; i < block.size(); ++i)
  {
    block.data()[i] = noise();
  }
  Orthonormalize(basis, 0, masses, noise, block);
  basis.leftCols(blockSize) = block;
  Eigen::Index used = blockSize;
  Eigen::Index last = 0; // first column of the last block
  while (true)
  {
    Eigen::MatrixXd image = masses.asDiagonal() * block;
    cholesky.Solve(image);
    const Eigen::MatrixXd weighted = masses.asDiagonal() * image;
    const Eigen::MatrixXd share = basis.leftCols(used).transpose() * weighted;
    projected.block(0, last, used, block.cols()) = share;
    projected.block(last, 0, block.cols(), used) = share.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small(projected.topLeftCorner(used, used));
    Eigen::MatrixXd rest = image - basis.leftCols(used) * share;
    rest.rowwise() -= (masses.transpose() * rest) / masses.sum();
    const bool complete = used == n - 1;
    bool converged = complete || used >= count;
    for (Eigen::Index i = 0; i < count && converged && !complete; ++i)
    {
      const Eigen::VectorXd tail =
        rest * small.eigenvectors().col(used - 1 - i).segment(last, block.cols());
      const double residual = std::sqrt(tail.dot(masses.cwiseProduct(tail)));
      converged = residual <= Tolerance * small.eigenvalues()[used - 1 - i];
    }
    if (converged)
    {
      Result<SmallEigenpairs> result;
      const Eigen::Index found = std::min<Eigen::Index>(count, used);
      result.Value.Values.resize(found);
      result.Value.Vectors.resize(n, found);
      for (Eigen::Index i = 0; i < found; ++i)
      {
        result.Value.Values[i] = 1.0 / small.eigenvalues()[used - 1 - i] - shift;
        result.Value.Vectors.col(i) = basis.leftCols(used) * small.eigenvectors().col(used - 1 - i);
      }
      return result;
    }
    const Eigen::Index next = std::min(blockSize, limit - used);
    if (next <= 0)
    {
      return { ErrorCode::NotConverged,
        "eigenvectors after " + std::to_string(used) + " vectors of Lanczos' basis" };
    }
    block = rest.leftCols(next);
    Orthonormalize(basis, used, masses, noise, block);
    last = used;
    basis.middleCols(used, next) = block;
    used += next;
  }
}
}
