// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianField.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace knotwork
{
namespace
{
int Padded(int n)
{
  return (n + RowLanes - 1) / RowLanes * RowLanes;
}

/// out = sum_b factors[b] * rows[b], rows stride apart, n a multiple of RowLanes.
template <int Count>
void Combine(const double* rows, std::ptrdiff_t stride, const double* factors, int n, double* out)
{
  WithWidestVectors(
    [=](auto)
    {
      for (int i = 0; i < n; i += RowLanes)
      {
        RowVector sum = factors[0] * At(rows + i);
        for (int b = 1; b < Count; ++b)
        {
          sum += factors[b] * At(rows + b * stride + i);
        }
        At(out + i) = sum;
      }
    });
}

/// rows[b] += factors[b] * in.
template <int Count>
void Spread(const double* in, const double* factors, int n, double* rows, std::ptrdiff_t stride)
{
  WithWidestVectors(
    [=](auto)
    {
      for (int i = 0; i < n; i += RowLanes)
      {
        const RowVector v = At(in + i);
        for (int b = 0; b < Count; ++b)
        {
          double* to = rows + b * stride + i;
          At(to) = At(to) + factors[b] * v;
        }
      }
    });
}

using CombineFunction = void (*)(const double*, std::ptrdiff_t, const double*, int, double*);
using SpreadFunction = void (*)(const double*, const double*, int, double*, std::ptrdiff_t);
constexpr CombineFunction Combines[MaxDegree + 2] = { nullptr, Combine<1>, Combine<2>, Combine<3>,
  Combine<4>, Combine<5>, Combine<6>, Combine<7>, Combine<8>, Combine<9>, Combine<10> };
constexpr SpreadFunction Spreads[MaxDegree + 2] = { nullptr, Spread<1>, Spread<2>, Spread<3>,
  Spread<4>, Spread<5>, Spread<6>, Spread<7>, Spread<8>, Spread<9>, Spread<10> };

/// Functions of one direction at its points: rows of degree + 1 numbers a point.
struct LineBasis
{
  int NumPoints = 0;
  int Degree = 0;
  int NumFunctions = 0;
  std::vector<int> First; ///< first alive function of each point
  std::vector<double> Values;
  std::vector<double> Derivatives;
  std::vector<double> Weights;

  LineBasis(const KnotVector& knots, const LinePoints& points)
    : NumPoints(static_cast<int>(points.Elements.size())), Degree(knots.Degree()),
      NumFunctions(knots.NumFunctions()), Weights(points.Weights)
  {
    const std::size_t n = static_cast<std::size_t>(this->Degree) + 1;
    std::vector<double> both(2 * n);
    for (std::size_t i = 0; i < points.Elements.size(); ++i)
    {
      const int e = points.Elements[i];
      const double begin = knots.Breaks()[static_cast<std::size_t>(e)];
      const double end = knots.Breaks()[static_cast<std::size_t>(e) + 1];
      knots.EvaluateFunctions(e, begin + points.Local[i] * (end - begin), 1, both.data());
      this->First.push_back(knots.Span(e) - this->Degree);
      this->Values.insert(this->Values.end(), both.begin(), both.begin() + this->Degree + 1);
      this->Derivatives.insert(
        this->Derivatives.end(), both.begin() + this->Degree + 1, both.end());
    }
  }
  const double* Value(int i) const { return this->Values.data() + i * (this->Degree + 1); }
  const double* Derivative(int i) const
  {
    return this->Derivatives.data() + i * (this->Degree + 1);
  }
};

/// The innermost direction: four points at a time with the functions alive at any of them.
struct GroupedLine
{
  struct Group
  {
    int First = 0;
    int Count = 0;
    std::size_t Offset = 0; ///< into Values, Derivatives: Count x RowLanes each
  };
  int NumPoints = 0; ///< padded
  int NumFunctions = 0;
  std::vector<Group> Groups;
  std::vector<double> Values;
  std::vector<double> Derivatives;
  std::vector<double> Weights;
  std::vector<double> Padding;

  explicit GroupedLine(const LineBasis& line)
    : NumPoints(Padded(line.NumPoints)), NumFunctions(line.NumFunctions)
  {
    this->Weights.assign(static_cast<std::size_t>(this->NumPoints), 0.0);
    this->Padding.assign(static_cast<std::size_t>(this->NumPoints), 1.0);
    std::copy(line.Weights.begin(), line.Weights.end(), this->Weights.begin());
    std::fill_n(this->Padding.begin(), line.NumPoints, 0.0);
    for (int i = 0; i < line.NumPoints; i += RowLanes)
    {
      const int last = std::min(i + RowLanes, line.NumPoints) - 1;
      Group group;
      group.First = line.First[static_cast<std::size_t>(i)];
      group.Count = line.First[static_cast<std::size_t>(last)] + line.Degree + 1 - group.First;
      group.Offset = this->Values.size();
      this->Values.resize(group.Offset + static_cast<std::size_t>(group.Count * RowLanes), 0.0);
      this->Derivatives.resize(this->Values.size(), 0.0);
      for (int k = i; k <= last; ++k)
      {
        const int shift = line.First[static_cast<std::size_t>(k)] - group.First;
        for (int a = 0; a <= line.Degree; ++a)
        {
          const std::size_t at =
            group.Offset + static_cast<std::size_t>((shift + a) * RowLanes + k - i);
          this->Values[at] = line.Value(k)[a];
          this->Derivatives[at] = line.Derivative(k)[a];
        }
      }
      this->Groups.push_back(group);
    }
  }

  void Forward(const double* coefficients, double* values, double* derivatives) const
  {
    WithWidestVectors([=](auto) { this->ForwardLoop(coefficients, values, derivatives); });
  }
  void ForwardLoop(const double* coefficients, double* values, double* derivatives) const
  {
    for (const Group& group : this->Groups)
    {
      const double* c = coefficients + group.First;
      const double* b = this->Values.data() + group.Offset;
      const double* db = this->Derivatives.data() + group.Offset;
      RowVector value = c[0] * At(b);
      RowVector derivative = c[0] * At(db);
      for (int a = 1; a < group.Count; ++a)
      {
        value += c[a] * At(b + a * RowLanes);
        derivative += c[a] * At(db + a * RowLanes);
      }
      At(values) = value;
      At(derivatives) = derivative;
      values += RowLanes;
      derivatives += RowLanes;
    }
  }

  void Backward(const double* values, const double* derivatives, double* gradient) const
  {
    WithWidestVectors([=](auto) { this->BackwardLoop(values, derivatives, gradient); });
  }
  void BackwardLoop(const double* values, const double* derivatives, double* gradient) const
  {
    for (const Group& group : this->Groups)
    {
      double* g = gradient + group.First;
      const double* b = this->Values.data() + group.Offset;
      const double* db = this->Derivatives.data() + group.Offset;
      const RowVector value = At(values);
      const RowVector derivative = At(derivatives);
      for (int a = 0; a < group.Count; ++a)
      {
        const RowVector sum = value * At(b + a * RowLanes) + derivative * At(db + a * RowLanes);
        g[a] += (sum[0] + sum[2]) + (sum[1] + sum[3]);
      }
      values += RowLanes;
      derivatives += RowLanes;
    }
  }
};

template <int Dim>
class TensorField final : public JacobianField<Dim>
{
public:
  TensorField(const std::array<KnotVector, Dim>& knots, const std::array<LinePoints, Dim>& lines)
    : Inner(LineBasis(knots[0], lines[0]))
  {
    this->NumRows = 1;
    this->Points = static_cast<int>(lines[0].Elements.size());
    for (std::size_t d = 1; d < Dim; ++d)
    {
      this->Outer.emplace_back(knots[d], lines[d]);
      this->NumRows *= this->Outer.back().NumFunctions;
      this->Points *= this->Outer.back().NumPoints;
    }
  }

  int NumPoints() const override { return this->Points; }

  void Visit(const double* coefficients, double* gradient, int numPlanes, bool values,
    RowBody& body) override
  {
    const int n = this->Inner.NumPoints;
    const int width = numPlanes * n; // one kind of number for all planes
    const int m = this->Inner.NumFunctions;
    const std::size_t size = static_cast<std::size_t>(2 * width * this->NumRows);
    this->Lines.resize(size);
    if (gradient)
    {
      this->LineGradients.assign(size, 0.0);
    }
    for (int row = 0; row < this->NumRows; ++row)
    {
      double* to = this->Lines.data() + 2 * width * row;
      for (int c = 0; c < numPlanes; ++c)
      {
        this->Inner.Forward(
          coefficients + (c * this->NumRows + row) * m, to + c * n, to + width + c * n);
      }
    }
    this->Fields.resize(static_cast<std::size_t>((Dim + 1) * width));
    this->FieldGradients.assign(this->Fields.size(), 0.0);
    if constexpr (Dim == 2)
    {
      this->VisitRows(this->Lines.data(), gradient ? this->LineGradients.data() : nullptr,
        this->Outer[0], 1.0, width, values, body);
    }
    else
    {
      this->VisitPlanes(gradient != nullptr, width, values, body);
    }
    if (gradient)
    {
      std::fill_n(gradient, numPlanes * this->NumRows * m, 0.0);
      for (int row = 0; row < this->NumRows; ++row)
      {
        const double* from = this->LineGradients.data() + 2 * width * row;
        for (int c = 0; c < numPlanes; ++c)
        {
          this->Inner.Backward(
            from + c * n, from + width + c * n, gradient + (c * this->NumRows + row) * m);
        }
      }
    }
  }

private:
  /// The last direction: rows hold, width numbers each, the value and the Dim - 1 derivatives of
  /// the directions before.
  void VisitRows(const double* rows, double* rowGradients, const LineBasis& line, double factor,
    int width, bool values, RowBody& body)
  {
    constexpr int NumKinds = Dim;
    const int count = line.Degree + 1;
    const CombineFunction combine = Combines[count];
    const SpreadFunction spread = Spreads[count];
    const std::ptrdiff_t stride = NumKinds * width;
    const int skip = values ? 0 : width; // values come first
    double* fields = this->Fields.data();
    double* gradients = rowGradients ? this->FieldGradients.data() : nullptr;
    for (int i = 0; i < line.NumPoints; ++i)
    {
      const std::ptrdiff_t first = line.First[static_cast<std::size_t>(i)] * stride;
      combine(rows + first + skip, stride, line.Value(i), NumKinds * width - skip, fields + skip);
      combine(rows + first, stride, line.Derivative(i), width, fields + NumKinds * width);
      body.Row(this->Inner.NumPoints, fields, gradients, this->Inner.Weights.data(),
        factor * line.Weights[static_cast<std::size_t>(i)], this->Inner.Padding.data());
      if (gradients)
      {
        spread(gradients + skip, line.Value(i), NumKinds * width - skip,
          rowGradients + first + skip, stride);
        spread(
          gradients + NumKinds * width, line.Derivative(i), width, rowGradients + first, stride);
      }
    }
  }

  /// In 3D, for each point of the second direction, the lines are combined to rows of all functions
  /// of the third: values, first and second derivatives.
  void VisitPlanes(bool gradients, int width, bool values, RowBody& body)
  {
    const LineBasis& second = this->Outer[0];
    const LineBasis& third = this->Outer[1];
    const int count = second.Degree + 1;
    const CombineFunction combine = Combines[count];
    const SpreadFunction spread = Spreads[count];
    const std::ptrdiff_t stride = 2 * width;
    this->Rows.resize(static_cast<std::size_t>(3 * width * third.NumFunctions));
    for (int i = 0; i < second.NumPoints; ++i)
    {
      const auto line = [&](int k)
      { return (k * second.NumFunctions + second.First[static_cast<std::size_t>(i)]) * stride; };
      for (int k = 0; k < third.NumFunctions; ++k)
      {
        double* row = this->Rows.data() + 3 * width * k;
        combine(this->Lines.data() + line(k), stride, second.Value(i), 2 * width, row);
        combine(this->Lines.data() + line(k), stride, second.Derivative(i), width, row + 2 * width);
      }
      if (gradients)
      {
        this->RowGradients.assign(this->Rows.size(), 0.0);
      }
      this->VisitRows(this->Rows.data(), gradients ? this->RowGradients.data() : nullptr, third,
        second.Weights[static_cast<std::size_t>(i)], width, values, body);
      for (int k = 0; gradients && k < third.NumFunctions; ++k)
      {
        const double* row = this->RowGradients.data() + 3 * width * k;
        spread(row, second.Value(i), 2 * width, this->LineGradients.data() + line(k), stride);
        spread(row + 2 * width, second.Derivative(i), width, this->LineGradients.data() + line(k),
          stride);
      }
    }
  }

  GroupedLine Inner;
  std::vector<LineBasis> Outer;
  int NumRows = 1; ///< lines of coefficients along the first direction
  int Points = 0;
  std::vector<double> Lines, LineGradients; ///< per line of coefficients: values, derivatives
  std::vector<double> Rows, RowGradients;
  std::vector<double> Fields, FieldGradients;
};

/// Any space: dense matrices of the functions alive on an element.
template <int Dim>
class ElementField final : public JacobianField<Dim>
{
public:
  ElementField(const SplineSpace<Dim>& space, const std::vector<int>& numPoints)
    : NumFunctions(space.NumFunctions)
  {
    FunctionValues basis;
    std::map<int, ElementQuadrature<Dim>> rules;
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const int perDirection = numPoints[static_cast<std::size_t>(e)];
      auto found = rules.find(perDirection);
      if (found == rules.end())
      {
        IntArray<Dim> counts;
        counts.fill(perDirection);
        found = rules.emplace(perDirection, MakeElementQuadrature<Dim>(counts)).first;
      }
      const ElementQuadrature<Dim>& rule = found->second;
      const auto& box = space.Elements[static_cast<std::size_t>(e)].Box;
      double volume = 1.0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        volume *= box.Upper[d] - box.Lower[d];
      }
      Block block;
      block.Points = static_cast<int>(rule.Local.rows());
      block.Padded = Padded(block.Points);
      block.Basis = this->Basis.size();
      block.Weight = this->Weights.size();
      this->Total += block.Points;
      for (int i = 0; i < block.Points; ++i)
      {
        EvaluateFunctions<Dim>(space, e, rule.Local.row(i).data(), 1, nullptr, basis);
        if (i == 0)
        {
          block.Functions = basis.Functions;
          this->Basis.resize(block.Basis +
              (Dim + 1) * basis.Functions.size() * static_cast<std::size_t>(block.Padded),
            0.0);
        }
        for (std::size_t f = 0; f < basis.Functions.size(); ++f)
        {
          for (std::size_t t = 0; t <= Dim; ++t)
          {
            this->Basis[block.Basis +
              (t * basis.Functions.size() + f) * static_cast<std::size_t>(block.Padded) +
              static_cast<std::size_t>(i)] =
              basis.Values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(t));
          }
        }
        this->Weights.push_back(volume * rule.Weights[i]);
        this->Padding.push_back(0.0);
      }
      this->Weights.resize(block.Weight + static_cast<std::size_t>(block.Padded), 0.0);
      this->Padding.resize(this->Weights.size(), 1.0);
      this->Blocks.push_back(std::move(block));
    }
  }

  int NumPoints() const override { return this->Total; }

  void Visit(const double* coefficients, double* gradient, int numPlanes, bool values,
    RowBody& body) override
  {
    if (gradient)
    {
      std::fill_n(gradient, numPlanes * this->NumFunctions, 0.0);
    }
    for (const Block& block : this->Blocks)
    {
      const int n = block.Padded;
      this->Fields.resize(static_cast<std::size_t>((Dim + 1) * numPlanes * n));
      this->FieldGradients.resize(this->Fields.size());
      const std::size_t numFunctions = block.Functions.size();
      const auto row = [&](int t, std::size_t f)
      {
        return this->Basis.data() + block.Basis +
          (static_cast<std::size_t>(t) * numFunctions + f) * static_cast<std::size_t>(n);
      };
      for (int t = values ? 0 : 1; t <= Dim; ++t)
      {
        for (int c = 0; c < numPlanes; ++c)
        {
          double* field = this->Fields.data() + (t * numPlanes + c) * n;
          std::fill_n(field, n, 0.0);
          for (std::size_t f = 0; f < numFunctions; ++f)
          {
            const double factor = coefficients[c * this->NumFunctions + block.Functions[f]];
            Spread<1>(row(t, f), &factor, n, field, 0);
          }
        }
      }
      body.Row(n, this->Fields.data(), gradient ? this->FieldGradients.data() : nullptr,
        this->Weights.data() + block.Weight, 1.0, this->Padding.data() + block.Weight);
      for (int t = values ? 0 : 1; gradient && t <= Dim; ++t)
      {
        for (int c = 0; c < numPlanes; ++c)
        {
          const double* field = this->FieldGradients.data() + (t * numPlanes + c) * n;
          for (std::size_t f = 0; f < numFunctions; ++f)
          {
            RowVector sum{};
            for (int i = 0; i < n; i += RowLanes)
            {
              sum += At(field + i) * At(row(t, f) + i);
            }
            gradient[c * this->NumFunctions + block.Functions[f]] +=
              (sum[0] + sum[2]) + (sum[1] + sum[3]);
          }
        }
      }
    }
  }

private:
  struct Block
  {
    std::vector<int> Functions;
    int Points = 0;
    int Padded = 0;
    std::size_t Basis = 0;
    std::size_t Weight = 0;
  };
  int NumFunctions = 0;
  int Total = 0;
  std::vector<Block> Blocks;
  std::vector<double> Basis; ///< per element (Dim + 1) x functions x points
  std::vector<double> Weights, Padding;
  std::vector<double> Fields, FieldGradients;
};

/// Gathers for every field and adds its gradients.
template <int Dim>
class GluedField final : public JacobianField<Dim>
{
public:
  GluedField(std::vector<std::unique_ptr<JacobianField<Dim>>> fields,
    std::vector<std::vector<int>> numbers, int numFunctions)
    : Fields(std::move(fields)), Numbers(std::move(numbers)), NumFunctions(numFunctions)
  {
  }

  int NumPoints() const override
  {
    int total = 0;
    for (const auto& field : this->Fields)
    {
      total += field->NumPoints();
    }
    return total;
  }

  void Visit(const double* coefficients, double* gradient, int numPlanes, bool values,
    RowBody& body) override
  {
    if (gradient)
    {
      std::fill_n(gradient, numPlanes * this->NumFunctions, 0.0);
    }
    for (std::size_t p = 0; p < this->Fields.size(); ++p)
    {
      const std::vector<int>& numbers = this->Numbers[p];
      const std::size_t n = numbers.size();
      this->Own.resize(n * static_cast<std::size_t>(numPlanes));
      this->OwnGradient.resize(gradient ? this->Own.size() : 0);
      for (int c = 0; c < numPlanes; ++c)
      {
        const double* from = coefficients + c * this->NumFunctions;
        double* to = this->Own.data() + static_cast<std::size_t>(c) * n;
        for (std::size_t i = 0; i < n; ++i)
        {
          to[i] = from[numbers[i]];
        }
      }
      this->Fields[p]->Visit(
        this->Own.data(), gradient ? this->OwnGradient.data() : nullptr, numPlanes, values, body);
      for (int c = 0; gradient && c < numPlanes; ++c)
      {
        const double* from = this->OwnGradient.data() + static_cast<std::size_t>(c) * n;
        double* to = gradient + c * this->NumFunctions;
        for (std::size_t i = 0; i < n; ++i)
        {
          to[numbers[i]] += from[i];
        }
      }
    }
  }

private:
  std::vector<std::unique_ptr<JacobianField<Dim>>> Fields;
  std::vector<std::vector<int>> Numbers;
  int NumFunctions = 0;
  std::vector<double> Own, OwnGradient;
};
}

LinePoints GaussLine(const KnotVector& knots, const std::vector<int>& numPoints)
{
  LinePoints line;
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    const std::size_t at = static_cast<std::size_t>(e);
    const QuadratureRule rule = GaussLegendre(numPoints[at]);
    const double length = knots.Breaks()[at + 1] - knots.Breaks()[at];
    for (std::size_t i = 0; i < rule.Nodes.size(); ++i)
    {
      line.Elements.push_back(e);
      line.Local.push_back(rule.Nodes[i]);
      line.Weights.push_back(length * rule.Weights[i]);
    }
  }
  return line;
}

LinePoints UniformLine(const KnotVector& knots, int n)
{
  LinePoints line;
  for (int i = 0; i < n; ++i)
  {
    const double u = knots.Begin() + (knots.End() - knots.Begin()) * i / (n - 1);
    const int e = knots.FindElement(u);
    const double begin = knots.Breaks()[static_cast<std::size_t>(e)];
    const double end = knots.Breaks()[static_cast<std::size_t>(e) + 1];
    line.Elements.push_back(e);
    line.Local.push_back((u - begin) / (end - begin));
    line.Weights.push_back(1.0 / n);
  }
  return line;
}

template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeTensorField(
  const std::array<KnotVector, Dim>& knots, const std::array<LinePoints, Dim>& lines)
{
  return std::make_unique<TensorField<Dim>>(knots, lines);
}

template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeElementField(
  const SplineSpace<Dim>& space, const std::vector<int>& numPoints)
{
  return std::make_unique<ElementField<Dim>>(space, numPoints);
}

template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeGluedField(
  std::vector<std::unique_ptr<JacobianField<Dim>>> fields, std::vector<std::vector<int>> numbers,
  int numFunctions)
{
  return std::make_unique<GluedField<Dim>>(std::move(fields), std::move(numbers), numFunctions);
}

template std::unique_ptr<JacobianField<2>> MakeTensorField<2>(
  const std::array<KnotVector, 2>&, const std::array<LinePoints, 2>&);
template std::unique_ptr<JacobianField<3>> MakeTensorField<3>(
  const std::array<KnotVector, 3>&, const std::array<LinePoints, 3>&);
template std::unique_ptr<JacobianField<2>> MakeElementField<2>(
  const SplineSpace<2>&, const std::vector<int>&);
template std::unique_ptr<JacobianField<3>> MakeElementField<3>(
  const SplineSpace<3>&, const std::vector<int>&);
template std::unique_ptr<JacobianField<2>> MakeGluedField<2>(
  std::vector<std::unique_ptr<JacobianField<2>>>, std::vector<std::vector<int>>, int);
template std::unique_ptr<JacobianField<3>> MakeGluedField<3>(
  std::vector<std::unique_ptr<JacobianField<3>>>, std::vector<std::vector<int>>, int);
}
