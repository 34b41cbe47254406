// SPDX-License-Identifier: BSD-3-Clause
#include "GoToolsLR.h"

#include <knotwork/SplineCore/LRSpace.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr long long MaxInt = std::numeric_limits<int>::max();
constexpr const char* KnotTolerance = "1e-08"; // what GoTools writes; values here are exact

/// One record of the text. A polynomial surface stores gamma * coefficient, a rational one the
/// Euclidean point and gamma * weight.
struct Record
{
  std::vector<int> Local; // as LRBasis::LocalKnots
  std::vector<double> Point;
  double Gamma = 1.0;
  double Weight = 1.0;
};

class Reader
{
public:
  explicit Reader(G2Words& words) : W(words) {}

  Spline<2> Read()
  {
    this->Rational = this->W.Integer("rational flag", 0, 1) == 1;
    this->W.Real<double>("knot tolerance");
    for (std::vector<double>& knots : this->Basis.Knots)
    {
      const long long count = this->W.Integer("number of knots", 2, MaxInt);
      for (long long i = 0; i < count && this->W.Outcome; ++i)
      {
        knots.push_back(this->W.Real<double>("knot"));
      }
    }
    for (std::size_t d = 0; d < 2; ++d)
    {
      this->ReadLines(d);
    }
    const long long functions = this->W.Integer("number of functions", 1, MaxInt);
    std::vector<Record> records;
    for (long long i = 0; i < functions && this->W.Outcome; ++i)
    {
      records.push_back(this->ReadRecord());
    }
    return this->W.Outcome ? this->Make(std::move(records)) : Spline<2>();
  }

private:
  void ReadLines(std::size_t d)
  {
    const auto knots = static_cast<long long>(this->Basis.Knots[d].size());
    const auto last = static_cast<long long>(this->Basis.Knots[1 - d].size()) - 1;
    this->W.Integer("number of mesh lines, which is the number of knots", knots, knots);
    for (long long k = 0; k < knots && this->W.Outcome; ++k)
    {
      LRLine line;
      const long long pieces = this->W.Integer("number of pieces of a mesh line", 1, last + 1);
      long long lowest = 0;
      for (long long i = 0; i < pieces && this->W.Outcome; ++i)
      {
        // the first piece starts at knot 0; one that starts at the end has no length
        const long long from =
          this->W.Integer("start of a piece of a mesh line", lowest, i == 0 ? 0 : last);
        const auto multiplicity =
          static_cast<int>(this->W.Integer("multiplicity of a mesh line", 0, MaxDegree + 1));
        if (from < last && (line.empty() || line.back().Multiplicity != multiplicity))
        {
          line.push_back({ static_cast<int>(from), multiplicity });
        }
        lowest = from + 1;
      }
      this->Basis.Lines[d].push_back(std::move(line));
    }
  }

  void ReadLocalKnots(std::size_t d, bool isFirst, std::vector<int>& local)
  {
    int& degree = this->Basis.Degree[d];
    const long long expected = degree + 2;
    const long long count = isFirst
      ? this->W.Integer("number of local knots", 3, MaxDegree + 2, ErrorCode::InvalidDegree)
      : this->W.Integer("number of local knots, which all functions share", expected, expected);
    degree = static_cast<int>(count) - 2;
    const auto last = static_cast<long long>(this->Basis.Knots[d].size()) - 1;
    for (long long i = 0; i < count && this->W.Outcome; ++i)
    {
      local.push_back(static_cast<int>(this->W.Integer("index of a local knot", 0, last)));
    }
  }

  Record ReadRecord()
  {
    Record record;
    const bool isFirst = this->Components == 0;
    const long long lowest = isFirst ? 1 : this->Components;
    this->Components = this->W.Integer("dimension", lowest, isFirst ? MaxG2Components : lowest);
    const int rational = this->Rational ? 1 : 0;
    this->W.Integer("rational flag of a function", rational, rational);
    std::array<long double, MaxG2Components> coefficient{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(this->Components); ++c)
    {
      coefficient[c] = this->W.Real<long double>("coefficient");
    }
    record.Gamma = this->Positive<double>("scaling factor");
    const auto weight = this->Positive<long double>("weight");
    record.Weight = Quotient(weight, record.Gamma);
    for (std::size_t c = 0; c < static_cast<std::size_t>(this->Components); ++c)
    {
      record.Point.push_back(Quotient(coefficient[c], this->Rational ? 1.0 : record.Gamma));
    }
    for (std::size_t d = 0; d < 2; ++d)
    {
      this->ReadLocalKnots(d, isFirst, record.Local);
    }
    return record;
  }

  template <typename Number>
  Number Positive(const char* meaning)
  {
    const Number value = this->W.Real<Number>(meaning);
    if (this->W.Outcome && !(value > 0))
    {
      this->W.Fail(ErrorCode::InvalidWeight, std::string(meaning) + " is not positive");
    }
    return this->W.Outcome ? value : Number(1);
  }

  Spline<2> Make(std::vector<Record> records)
  {
    const auto first = static_cast<std::ptrdiff_t>(this->Basis.Degree[0] + 2);
    std::sort(records.begin(), records.end(),
      [first](const Record& a, const Record& b)
      {
        const auto [x, y] =
          std::mismatch(a.Local.begin() + first, a.Local.end(), b.Local.begin() + first);
        return x != a.Local.end() ? *x < *y : a.Local < b.Local;
      });
    Spline<2> spline;
    const auto rows = static_cast<Eigen::Index>(records.size());
    spline.ControlPoints.resize(rows, this->Components);
    spline.Weights.resize(this->Rational ? rows : 0);
    for (Eigen::Index i = 0; i < rows; ++i)
    {
      const Record& record = records[static_cast<std::size_t>(i)];
      std::copy(record.Point.begin(), record.Point.end(), spline.ControlPoints.row(i).data());
      if (this->Rational)
      {
        spline.Weights[i] = record.Weight;
      }
      this->Basis.Scaling.push_back(record.Gamma);
      this->Basis.LocalKnots.insert(
        this->Basis.LocalKnots.end(), record.Local.begin(), record.Local.end());
    }
    Result<SplineSpacePtr<2>> space = MakeLRSpace(std::move(this->Basis), 1);
    if (!space)
    {
      this->W.Fail(space.Status.Code, "end of an LR surface: " + space.Status.Detail);
    }
    spline.Space = std::move(space.Value);
    return spline;
  }

  G2Words& W;
  LRBasis Basis;
  bool Rational = false;
  long long Components = 0;
};

void AppendWords(std::string& text, const int* begin, const int* end)
{
  text += std::to_string(end - begin);
  for (; begin != end; ++begin)
  {
    text += " " + std::to_string(*begin);
  }
  text += "\n";
}
}

Spline<2> ReadLRSurface(G2Words& words)
{
  return Reader(words).Read();
}

void AppendLRSurface(const Spline<2>& spline, std::string& text)
{
  const LRBasis& basis = spline.Space->LocallyRefined->Basis;
  const bool rational = spline.IsRational();
  text += std::string(rational ? "1 " : "0 ") + KnotTolerance + "\n";
  for (const std::vector<double>& knots : basis.Knots)
  {
    text += std::to_string(knots.size());
    for (const double knot : knots)
    {
      text += " ";
      AppendReal(text, knot);
    }
    text += "\n";
  }
  for (const std::vector<LRLine>& lines : basis.Lines)
  {
    text += std::to_string(lines.size()) + "\n";
    for (const LRLine& line : lines)
    {
      text += std::to_string(line.size());
      for (const LRPiece& piece : line)
      {
        text += "  " + std::to_string(piece.Knot) + " " + std::to_string(piece.Multiplicity);
      }
      text += "\n";
    }
  }
  text += std::to_string(basis.NumFunctions()) + "\n";
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    const double gamma = basis.Scaling[static_cast<std::size_t>(f)];
    text += std::to_string(spline.ControlPoints.cols()) + (rational ? " 1\n" : " 0\n");
    for (Eigen::Index c = 0; c < spline.ControlPoints.cols(); ++c)
    {
      AppendProduct(text, spline.ControlPoints(f, c), rational ? 1.0 : gamma);
      text += " ";
    }
    AppendReal(text, gamma);
    text += " ";
    AppendProduct(text, rational ? spline.Weights[f] : 1.0, rational ? gamma : 1.0);
    text += "\n";
    for (int d = 0; d < 2; ++d)
    {
      const int* local = basis.Local(f, d);
      AppendWords(text, local, local + basis.Degree[static_cast<std::size_t>(d)] + 2);
    }
  }
  text += "\n";
}
}
