// SPDX-License-Identifier: BSD-3-Clause
#include "SparseCholesky.h"

#ifdef KNOTWORK_HAS_CHOLMOD
#include <Eigen/CholmodSupport>
#include <dlfcn.h>
#else
#include <Eigen/SparseCholesky>
#endif

namespace knotwork
{
#ifdef KNOTWORK_HAS_CHOLMOD
namespace
{
/// While it lives, CHOLMOD's loops run in the calling thread alone. They ask OpenMP for four
/// threads whatever the caller's number is, for work that is too little to share: waiting took a
/// quarter of the processor's time. OpenMP is there when CHOLMOD brought it.
class OneThread
{
public:
  OneThread()
  {
    if (this->Levels && this->SetLevels)
    {
      this->Before = this->Levels();
      this->SetLevels(0);
    }
  }
  ~OneThread()
  {
    if (this->Levels && this->SetLevels)
    {
      this->SetLevels(this->Before);
    }
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

private:
  template <typename Function>
  static Function* Find(const char* name)
  {
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
  }

  int (*Levels)() = Find<int()>("omp_get_max_active_levels");
  void (*SetLevels)(int) = Find<void(int)>("omp_set_max_active_levels");
  int Before = 0;
};
}
#endif

struct SparseCholesky::Solver
{
#ifdef KNOTWORK_HAS_CHOLMOD
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> Method;
#else
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> Method;
#endif
  Eigen::Index Rows = -1;
  Eigen::Index NonZeros = -1;
};

SparseCholesky::SparseCholesky() : Factor(std::make_unique<Solver>())
{
#ifdef KNOTWORK_HAS_CHOLMOD
  this->Factor->Method.cholmod().print = 0; // messages are the caller's
#endif
}

SparseCholesky::~SparseCholesky() = default;

Status SparseCholesky::Factorize(const Eigen::SparseMatrix<double>& lower)
{
#ifdef KNOTWORK_HAS_CHOLMOD
  const OneThread oneThread;
#endif
  if (lower.rows() != this->Factor->Rows || lower.nonZeros() != this->Factor->NonZeros)
  {
    this->Factor->Method.analyzePattern(lower);
    this->Factor->Rows = lower.rows();
    this->Factor->NonZeros = lower.nonZeros();
  }
  this->Factor->Method.factorize(lower);
  bool positive = this->Factor->Method.info() == Eigen::Success;
#ifndef KNOTWORK_HAS_CHOLMOD
  positive = positive && this->Factor->Method.vectorD().minCoeff() > 0.0;
#endif
  if (!positive)
  {
    return { ErrorCode::SingularSystem, "a matrix of the mesh is not positive definite" };
  }
  return {};
}

void SparseCholesky::Solve(Eigen::MatrixXd& sides) const
{
#ifdef KNOTWORK_HAS_CHOLMOD
  const OneThread oneThread;
#endif
  sides = this->Factor->Method.solve(sides).eval();
}

Status SolvePositive(const std::vector<Eigen::Triplet<double>>& lower, Eigen::MatrixXd& sides)
{
  Eigen::SparseMatrix<double> matrix(sides.rows(), sides.rows());
  matrix.setFromTriplets(lower.begin(), lower.end());
  SparseCholesky cholesky;
  const Status status = cholesky.Factorize(matrix);
  if (status)
  {
    cholesky.Solve(sides);
  }
  return status;
}
}
