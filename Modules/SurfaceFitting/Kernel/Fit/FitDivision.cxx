// SPDX-License-Identifier: BSD-3-Clause
#include "FitDivision.h"

#include <algorithm>
#include <cstdint>

namespace knotwork
{
namespace
{
constexpr char Goes = 'g';
constexpr char Fails = 'f';

template <typename T>
std::string AsBytes(const T* values, std::size_t count)
{
  return { reinterpret_cast<const char*>(values), sizeof(T) * count };
}

template <typename T>
std::vector<T> FromBytes(const std::string& bytes)
{
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::string AsBytes(const Status& status)
{
  return status ? std::string()
                : std::to_string(static_cast<int>(status.Code)) + " " + status.Detail;
}

Status StatusFromBytes(const std::string& bytes)
{
  return bytes.empty()
    ? Status()
    : Status(static_cast<ErrorCode>(std::stoi(bytes)), bytes.substr(bytes.find(' ') + 1));
}
}

std::vector<std::string> FitDivision::Exchange(const std::string& own) const
{
  std::vector<std::string> all = this->Processes->Exchange(Goes + own);
  for (const std::string& one : all)
  {
    if (one[0] == Fails)
    {
      throw FitStop(StatusFromBytes(one.substr(1)));
    }
  }
  for (std::string& one : all)
  {
    one.erase(0, 1);
  }
  return all;
}

void FitDivision::Fail(const Status& why) const
{
  this->Processes->Exchange(Fails + AsBytes(why));
}

std::vector<double> FitDivision::ExchangeNumbers(double own) const
{
  std::vector<double> numbers;
  for (const std::string& one : this->Exchange(AsBytes(&own, 1)))
  {
    numbers.push_back(FromBytes<double>(one)[0]);
  }
  return numbers;
}

std::vector<std::size_t> FitDivision::Parts(std::size_t n, std::size_t group) const
{
  const std::size_t count = this->IsDivided() ? At(this->Processes->Count) : 1;
  const std::size_t groups = (n + group - 1) / group;
  std::vector<std::size_t> begins;
  for (std::size_t p = 0; p <= count; ++p)
  {
    begins.push_back(std::min(groups * p / count * group, n));
  }
  return begins;
}

void FitDivision::ShareParts(
  double* numbers, const std::vector<std::size_t>& parts, std::size_t stride) const
{
  if (!this->IsDivided())
  {
    return;
  }
  const std::size_t own = this->Own();
  const std::vector<std::string> all =
    this->Exchange(AsBytes(numbers + parts[own] * stride, (parts[own + 1] - parts[own]) * stride));
  for (std::size_t p = 0; p < all.size(); ++p)
  {
    std::memcpy(numbers + parts[p] * stride, all[p].data(), all[p].size());
  }
}

double FitDivision::Largest(double own) const
{
  if (!this->IsDivided())
  {
    return own;
  }
  const std::vector<double> all = this->ExchangeNumbers(own);
  return *std::max_element(all.begin(), all.end());
}

std::size_t FitDivision::Sum(std::size_t own) const
{
  if (!this->IsDivided())
  {
    return own;
  }
  std::size_t sum = 0;
  for (const std::string& one : this->Exchange(AsBytes(&own, 1)))
  {
    sum += FromBytes<std::size_t>(one)[0];
  }
  return sum;
}

bool FitDivision::All(bool own) const
{
  return this->Largest(own ? 0.0 : 1.0) == 0.0;
}

void FitDivision::AddUp(std::vector<double>& numbers) const
{
  if (!this->IsDivided())
  {
    return;
  }
  const std::vector<std::string> all = this->Exchange(AsBytes(numbers.data(), numbers.size()));
  std::fill(numbers.begin(), numbers.end(), 0.0);
  for (const std::string& bytes : all)
  {
    const std::vector<double> one = FromBytes<double>(bytes);
    std::transform(one.begin(), one.end(), numbers.begin(), numbers.begin(), std::plus<>());
  }
}

double FitDivision::OfFirst(double own) const
{
  return this->IsDivided() ? this->ExchangeNumbers(own)[0] : own;
}

Status FitDivision::Agree(const Status& own) const
{
  if (!this->IsDivided())
  {
    return own;
  }
  const std::vector<std::string> all = this->Exchange(AsBytes(own));
  const auto failed =
    std::find_if(all.begin(), all.end(), [](const std::string& one) { return !one.empty(); });
  if (failed == all.end())
  {
    return {};
  }
  Status status = StatusFromBytes(*failed);
  if (failed != all.begin()) // whose points it numbers
  {
    status.Detail += " (process " + std::to_string(failed - all.begin()) + " of " +
      std::to_string(all.size()) + ", counted from 0)";
  }
  return status;
}

Status FitDivision::Check(const PointCloud& dealt, int numMeasured) const
{
  return this->Agree(this->Processes->Check && dealt.Values.rows() > 0
      ? this->Processes->Check(dealt.Parameters, dealt.Values.leftCols(numMeasured))
      : Status());
}

void FitDivision::Assign(const std::vector<int>& elements, int numElements)
{
  std::vector<double> points(static_cast<std::size_t>(numElements), 0.0);
  for (const int e : elements)
  {
    ++points[static_cast<std::size_t>(e)];
  }
  this->AddUp(points);
  const double total = std::accumulate(points.begin(), points.end(), 0.0);
  // an element goes to the process in whose share the middle of its points lies
  this->Owners.clear();
  double before = 0.0;
  for (const double own : points)
  {
    const double share = (before + 0.5 * own) / std::max(total, 1.0);
    this->Owners.push_back(
      std::min(static_cast<int>(share * this->Processes->Count), this->Processes->Count - 1));
    before += own;
  }
}

void FitDivision::Refine(const std::vector<int>& parents)
{
  if (!this->IsDivided())
  {
    return;
  }
  std::vector<int> owners;
  owners.reserve(parents.size());
  for (const int parent : parents)
  {
    owners.push_back(this->Owners[static_cast<std::size_t>(parent)]);
  }
  this->Owners = std::move(owners);
}

PointCloud FitDivision::Deal(
  const std::vector<double>& tolerances, const std::vector<int>& elements)
{
  const std::size_t count = At(this->Processes->Count);
  this->Sent.assign(count, {});
  for (std::size_t i = 0; i < elements.size(); ++i)
  {
    this->Sent[At(this->Owners[At(elements[i])])].push_back(static_cast<int>(i));
  }
  std::vector<std::string> hands;
  for (const std::vector<int>& points : this->Sent)
  {
    const std::size_t size = points.size();
    hands.push_back(AsBytes(&size, 1));
  }
  this->Received.clear();
  std::vector<Eigen::Index> next; // row for a point of each process
  Eigen::Index rows = 0;
  for (const std::string& one : this->Processes->Deal(std::move(hands)))
  {
    this->Received.push_back(FromBytes<std::size_t>(one)[0]);
    next.push_back(rows);
    rows += static_cast<Eigen::Index>(this->Received.back());
  }
  // a point is its parameters, values, tolerance, and whether it is significant
  const PointCloud& cloud = this->Given;
  const auto columns = static_cast<Eigen::Index>(
    this->Largest(cloud.Values.rows() > 0 ? static_cast<double>(cloud.Values.cols()) : 0.0));
  std::vector<double> row(static_cast<std::size_t>(columns) + 4);
  PointCloud dealt;
  dealt.Parameters.resize(rows, 2);
  dealt.Values.resize(rows, columns);
  dealt.Tolerances.resize(rows);
  dealt.Significant.resize(static_cast<std::size_t>(rows));
  // so many at a time that what is under way is small
  const auto most = static_cast<std::size_t>(this->Largest(static_cast<double>(elements.size())));
  for (std::size_t first = 0; first < most; first += PointBatch)
  {
    hands.assign(count, {});
    for (std::size_t i = first; i < std::min(first + PointBatch, elements.size()); ++i)
    {
      std::copy_n(cloud.Parameters.data() + 2 * i, 2, row.begin());
      std::copy_n(
        cloud.Values.data() + static_cast<std::size_t>(columns) * i, columns, row.begin() + 2);
      row[row.size() - 2] = tolerances[i];
      row.back() = cloud.Significant.empty() ? 0.0 : cloud.Significant[i];
      hands[At(this->Owners[At(elements[i])])] += AsBytes(row.data(), row.size());
    }
    this->All(true); // one that has run out of memory says so here
    const std::vector<std::string> all = this->Processes->Deal(std::move(hands));
    for (std::size_t p = 0; p < count; ++p)
    {
      for (std::size_t at = 0; at < all[p].size(); at += sizeof(double) * row.size())
      {
        const Eigen::Index to = next[p]++;
        std::memcpy(row.data(), all[p].data() + at, sizeof(double) * row.size());
        std::copy_n(row.begin(), 2, dealt.Parameters.data() + 2 * to);
        std::copy_n(row.begin() + 2, columns, dealt.Values.data() + columns * to);
        dealt.Tolerances[to] = row[row.size() - 2];
        dealt.Significant[static_cast<std::size_t>(to)] = row.back() != 0.0 ? 1 : 0;
      }
    }
  }
  this->Given = PointCloud();
  return dealt;
}

std::vector<double> FitDivision::BringHome(std::vector<double> values) const
{
  if (!this->IsDivided())
  {
    return values;
  }
  std::size_t count = 0;
  for (const std::vector<int>& points : this->Sent)
  {
    count += points.size();
  }
  std::vector<double> home(count);
  const std::size_t longest =
    *std::max_element(this->Received.begin(), this->Received.end()); // of what one has sent
  const auto most = static_cast<std::size_t>(this->Largest(static_cast<double>(longest)));
  for (std::size_t first = 0; first < most; first += PointBatch) // of each process
  {
    std::vector<std::string> hands;
    std::size_t begin = 0;
    for (const std::size_t received : this->Received)
    {
      const std::size_t from = std::min(first, received);
      hands.push_back(
        AsBytes(values.data() + begin + from, std::min(first + PointBatch, received) - from));
      begin += received;
    }
    this->All(true); // as in Deal
    const std::vector<std::string> all = this->Processes->Deal(std::move(hands));
    for (std::size_t p = 0; p < all.size(); ++p)
    {
      const std::vector<double> back = FromBytes<double>(all[p]);
      for (std::size_t k = 0; k < back.size(); ++k)
      {
        home[static_cast<std::size_t>(this->Sent[p][first + k])] = back[k];
      }
    }
  }
  return home;
}
}
