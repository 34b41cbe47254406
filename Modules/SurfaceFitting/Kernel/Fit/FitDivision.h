// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitProcesses.h"

#include <cstring>
#include <exception>
#include <numeric>
#include <utility>

namespace knotwork
{
/// Which process of a fit has which elements and points, and what they tell each other. A fit in
/// one process has all of them and tells nobody.
///
/// A process that fails while others wait for what it has to tell says so instead (Fail), and all
/// stop by a FitStop.
class FitDivision
{
public:
  FitDivision() = default;
  FitDivision(const FitProcesses& processes, PointCloud part)
    : Processes(&processes), Given(std::move(part))
  {
  }

  bool IsDivided() const { return this->Processes != nullptr; }
  bool Owns(std::size_t element) const
  {
    return !this->IsDivided() || this->Owners[element] == this->Processes->Own;
  }

  /// Divides the elements of the first space. @param elements  of this process's points.
  void Assign(const std::vector<int>& elements, int numElements);
  /// After a refinement. @param parents  of the new elements.
  void Refine(const std::vector<int>& parents);

  /// What this process has come with, until it is dealt.
  const PointCloud& Part() const { return this->Given; }
  /// The points of all processes in this one's elements, in their order, with tolerances. The own
  /// part is given up.
  /// @param elements  of its points. @param tolerances  one a point of it.
  PointCloud Deal(const std::vector<double>& tolerances, const std::vector<int>& elements);
  /// What was found of the points that were dealt, to where they come from.
  std::vector<double> BringHome(std::vector<double> values) const;

  /// What each element's process has of it, to all.
  /// @param elements  ascending. @param spanOf  numbers and their count, of the k-th of them.
  template <typename SpanOf>
  void Share(const std::vector<int>& elements, const SpanOf& spanOf) const
  {
    for (std::size_t first = 0; this->IsDivided() && first < elements.size(); first += Batch)
    {
      this->ShareSome(elements, first, std::min(first + Batch, elements.size()), spanOf);
    }
  }
  /// The same of all elements.
  template <typename SpanOf>
  void ShareAll(const SpanOf& spanOf) const
  {
    if (this->IsDivided())
    {
      std::vector<int> all(this->Owners.size());
      std::iota(all.begin(), all.end(), 0);
      this->Share(all, spanOf);
    }
  }

  /// The parts of n things, in groups of a size, that all have and one of the processes does:
  /// where each begins, and the end.
  std::vector<std::size_t> Parts(std::size_t n, std::size_t group) const;
  std::size_t Own() const { return this->IsDivided() ? At(this->Processes->Own) : 0; }
  /// What each has made of its part, to all. @param stride  numbers of a thing.
  void ShareParts(
    double* numbers, const std::vector<std::size_t>& parts, std::size_t stride = 1) const;

  double Largest(double own) const;
  std::size_t Sum(std::size_t own) const;
  bool All(bool own) const;
  /// The numbers of all processes, one by one, added in their order.
  void AddUp(std::vector<double>& numbers) const;
  double OfFirst(double own) const; ///< the first process's
  /// Ok, or the failure of the first process that has one.
  Status Agree(const Status& own) const;
  Status Check(const PointCloud& dealt, int numMeasured) const;
  /// Says to the others, who are about to exchange, that this process cannot.
  void Fail(const Status& why) const;

private:
  static constexpr std::size_t Batch = 16384;        ///< elements that are told of at a time
  static constexpr std::size_t PointBatch = 1 << 18; ///< points that are dealt at a time

  static std::size_t At(int i) { return static_cast<std::size_t>(i); }
  std::vector<std::string> Exchange(const std::string& own) const;
  std::vector<double> ExchangeNumbers(double own) const;

  template <typename SpanOf>
  void ShareSome(const std::vector<int>& elements, std::size_t begin, std::size_t end,
    const SpanOf& spanOf) const
  {
    std::string told;
    for (std::size_t k = begin; k < end; ++k)
    {
      if (this->Owns(static_cast<std::size_t>(elements[k])))
      {
        const auto [numbers, count] = spanOf(k);
        told.append(reinterpret_cast<const char*>(numbers), count * sizeof(*numbers));
      }
    }
    const std::vector<std::string> all = this->Exchange(told);
    std::vector<std::size_t> next(all.size(), 0);
    for (std::size_t k = begin; k < end; ++k)
    {
      const auto owner =
        static_cast<std::size_t>(this->Owners[static_cast<std::size_t>(elements[k])]);
      const auto [numbers, count] = spanOf(k);
      std::memcpy(numbers, all[owner].data() + next[owner], count * sizeof(*numbers));
      next[owner] += count * sizeof(*numbers);
    }
  }

  const FitProcesses* Processes = nullptr;
  std::vector<int> Owners;            ///< processes of the elements
  PointCloud Given;                   ///< the own part; empty when it is dealt
  std::vector<std::vector<int>> Sent; ///< points of the own part that each process has
  std::vector<std::size_t> Received;  ///< points that each process has sent
};

/// A process has failed, or was stopped.
struct FitStop : std::exception
{
  explicit FitStop(Status why) : Why(std::move(why)) {}
  const char* what() const noexcept override { return this->Why.Detail.c_str(); }
  Status Why;
};
}
