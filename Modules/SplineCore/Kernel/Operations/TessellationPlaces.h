// SPDX-License-Identifier: BSD-3-Clause
// Values and normals where the tessellation has vertices, private to the kernel.
#pragma once
#include "TessellationParts.h"

namespace knotwork
{
/// Places in elements, the elements of one patch after those of another, with values there.
template <int Dim>
class Places
{
public:
  void Clear();
  void Add(const CutElement& cut, const std::array<double, 3>& local);
  std::size_t Count() const { return this->Cuts.size(); }

  /// @param threads  0: all cores.
  Status Evaluate(const std::vector<BezierForm<Dim>>& patches, bool withNormals, int threads);

  PointMatrix Values;  ///< a row a place
  PointMatrix Normals; ///< unit vectors, zero where the element has none

private:
  Status EvaluatePatch(
    const BezierForm<Dim>& form, std::size_t begin, std::size_t end, bool withNormals);
  void TakeNormals(const EvaluationBatch& batch, const std::vector<std::size_t>& places,
    int components, std::vector<std::size_t>& singular);
  /// @param shrink  how far places go towards the middles of their elements.
  Status EvaluateAt(const BezierForm<Dim>& form, const std::vector<std::size_t>& places,
    double shrink, int derivatives, EvaluationBatch& batch) const;

  int Threads = 0;
  std::vector<CutElement> Cuts; ///< of every place
  std::vector<std::array<double, 3>> Local;
};
}
