// SPDX-License-Identifier: BSD-3-Clause
#include "CoefficientFilter.h"
#include "ExactForm.h"
#include "FilterCells.h"
#include "JacobianCorpus.h"

#include <knotwork/SplineCore/WideVectors.h>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace knotwork
{
namespace
{
using Pack = Doubles<2>;
constexpr int PackSize = LanesOf<Pack>;

struct Shape
{
  CellShape Kind;
  CellDegree Degree;
  bool Rational;
};

const Shape Shapes[] = { { CellShape::Quadrilateral, { 1, 1, 0 }, false },
  { CellShape::Quadrilateral, { 2, 2, 0 }, false },
  { CellShape::Quadrilateral, { 3, 3, 0 }, false },
  { CellShape::Quadrilateral, { 4, 4, 0 }, false },
  { CellShape::Quadrilateral, { 5, 2, 0 }, false }, { CellShape::Quadrilateral, { 1, 1, 0 }, true },
  { CellShape::Quadrilateral, { 2, 2, 0 }, true }, { CellShape::Quadrilateral, { 3, 3, 0 }, true },
  { CellShape::Quadrilateral, { 4, 4, 0 }, true }, { CellShape::Hexahedron, { 1, 1, 1 }, false },
  { CellShape::Hexahedron, { 2, 2, 2 }, false }, { CellShape::Hexahedron, { 3, 3, 3 }, false },
  { CellShape::Hexahedron, { 1, 2, 1 }, false }, { CellShape::Hexahedron, { 2, 2, 2 }, true },
  { CellShape::Triangle, { 3, 3, 0 }, true }, { CellShape::Tetrahedron, { 2, 2, 2 }, false },
  { CellShape::Wedge, { 2, 2, 1 }, false } };

std::vector<double> RandomBlock(oracle::Random& random, const Shape& shape, double offset)
{
  const int n = NumCellCoefficients(shape.Kind, shape.Degree);
  const int d = NumParameters(shape.Kind);
  std::vector<double> block(static_cast<std::size_t>(n * (d + shape.Rational)));
  for (int i = 0; i < n; ++i)
  {
    const double w = shape.Rational ? random.In(0.5, 2.0) : 1.0;
    for (int c = 0; c < d; ++c)
    {
      block[static_cast<std::size_t>(c * n + i)] = w * (random.In(-1.0, 1.0) + offset);
    }
    if (shape.Rational)
    {
      block[static_cast<std::size_t>(d * n + i)] = w;
    }
  }
  return block;
}

/// Every lane's smallest and largest coefficient are those of the exact numerator to within the
/// error bound, for compiled degrees and others.
TEST(CoefficientFilter, BoundsAreThoseOfTheExactForm_CrossOracle)
{
  oracle::Random random(21);
  CoefficientFilter<Pack> filter;
  LayoutCache cache;
  for (const Shape& shape : Shapes)
  {
    for (const double offset : { 0.0, 1000.0 })
    {
      std::vector<std::vector<double>> data;
      std::array<const double*, PackSize> blocks;
      for (std::size_t l = 0; l < PackSize; ++l)
      {
        data.push_back(RandomBlock(random, shape, offset));
      }
      for (std::size_t l = 0; l < PackSize; ++l)
      {
        blocks[l] = data[l].data();
      }
      CoefficientBounds<Pack> bounds;
      filter.Determinant(shape.Kind, shape.Degree, shape.Rational, blocks, Pack{}, bounds);
      for (int l = 0; l < PackSize; ++l)
      {
        const int d = NumParameters(shape.Kind);
        const FormLayout& layout = cache.Get(shape.Kind, shape.Degree);
        const ExactCell cell = MakeExactCell(
          layout, d, shape.Rational, data[static_cast<std::size_t>(l)].data(), nullptr, 0.0);
        std::array<const ExactInteger*, 4> planes{};
        for (std::size_t c = 0; c < 4; ++c)
        {
          planes[c] = cell.Planes[c].data();
        }
        JacobianForms<ExactInteger> forms(cache);
        forms.Set(shape.Kind, shape.Degree, d, shape.Rational, planes, {});
        const Form<ExactInteger>& numerator = forms.Determinant();
        ExactForm exact;
        exact.Layout = numerator.Layout;
        exact.C = numerator.C;
        exact.Exponent = cell.Exponent * (d + shape.Rational);
        double smallest = std::numeric_limits<double>::infinity();
        double largest = -smallest;
        for (const double v : exact.CoefficientsAt(0))
        {
          smallest = std::min(smallest, v);
          largest = std::max(largest, v);
        }
        const double ulps = 8.0 * UnitRoundoff * std::max(std::fabs(smallest), std::fabs(largest));
        EXPECT_NEAR(bounds.Smallest[l], smallest, bounds.Error[l] + ulps);
        EXPECT_NEAR(bounds.Largest[l], largest, bounds.Error[l] + ulps);
        EXPECT_LT(bounds.Error[l], (offset > 0.0 ? 1e-7 : 1e-10) * (largest - smallest));
        EXPECT_EQ(bounds.NotFinite[l], 0.0);
        double smallestCorner = std::numeric_limits<double>::infinity();
        for (int c = 0; c < NumCorners(shape.Kind); ++c)
        {
          double v = exact.ValueAt(CornerParameters(shape.Kind, c));
          double w = 1.0;
          if (shape.Rational)
          {
            w = data[static_cast<std::size_t>(l)][static_cast<std::size_t>(
              d * layout.Size + layout.Corners[static_cast<std::size_t>(c)])];
          }
          smallestCorner = std::min(smallestCorner, v / std::pow(w, shape.Rational ? d + 1 : 0));
        }
        EXPECT_NEAR(bounds.SmallestCorner[l], smallestCorner,
          bounds.Error[l] * (shape.Rational ? 16.0 : 1.0) + 16.0 * ulps);
      }
    }
  }
}

/// The bound of the compiled degrees is that of the general analysis, up to how tightly terms are
/// counted. (A given error of 1e-300 changes no number and leads past the compiled degrees.)
TEST(CoefficientFilter, CompiledDegreesHaveTheGeneralErrorBound_CrossOracle)
{
  oracle::Random random(23);
  CoefficientFilter<Pack> filter;
  for (const Shape& shape : Shapes)
  {
    const std::vector<double> block = RandomBlock(random, shape, 3.0);
    std::array<const double*, PackSize> blocks;
    blocks.fill(block.data());
    CoefficientBounds<Pack> compiled;
    CoefficientBounds<Pack> general;
    filter.Determinant(shape.Kind, shape.Degree, shape.Rational, blocks, Pack{}, compiled);
    filter.Determinant(shape.Kind, shape.Degree, shape.Rational, blocks, Pack{} + 1e-300, general);
    EXPECT_GT(compiled.Error[0], 0.3 * general.Error[0]);
    EXPECT_LT(compiled.Error[0], 4.0 * general.Error[0]);
    EXPECT_NEAR(compiled.Smallest[0], general.Smallest[0], general.Error[0]);
    EXPECT_NEAR(compiled.LargestCorner[0], general.LargestCorner[0], 64.0 * general.Error[0]);
  }
}

TEST(CoefficientFilter, NotFiniteInputIsSeen_PropertyOracle)
{
  oracle::Random random(22);
  CoefficientFilter<Pack> filter;
  for (const Shape& shape : Shapes)
  {
    for (const double bad :
      { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
    {
      std::vector<double> good = RandomBlock(random, shape, 0.0);
      std::vector<double> damaged = good;
      damaged[static_cast<std::size_t>(random.Int(0, static_cast<int>(good.size()) - 1))] = bad;
      std::array<const double*, PackSize> blocks;
      blocks.fill(good.data());
      blocks[1] = damaged.data();
      CoefficientBounds<Pack> bounds;
      filter.Determinant(shape.Kind, shape.Degree, shape.Rational, blocks, Pack{}, bounds);
      EXPECT_EQ(bounds.NotFinite[0], 0.0);
      EXPECT_TRUE(std::isnan(bounds.NotFinite[1]));
    }
  }
}

/// Proofs on processors with wider vectors are those of others: nothing is fused or reordered.
TEST(CoefficientFilter, WiderPacksHaveTheSameBits_ExactOracle)
{
  if (!HasWideVectors())
  {
    GTEST_SKIP() << "no wider vectors on this processor";
  }
  oracle::Random random(24);
  LayoutCache layouts;
  int decided = 0;
  for (const Shape& shape : Shapes)
  {
    BernsteinCells cells;
    cells.NumComponents = NumParameters(shape.Kind);
    cells.Rational = shape.Rational;
    const FormLayout& layout = layouts.Get(shape.Kind, shape.Degree);
    for (int c = 0; c < 23; ++c)
    {
      // near the identity, so that signs of coefficients decide some
      const int cell = cells.Add(shape.Kind, shape.Degree);
      std::vector<double> block = RandomBlock(random, shape, 0.0);
      for (const FormLayout::Row& row : layout.Rows)
      {
        for (int i = 0; i < row.Length; ++i)
        {
          const int place[3] = { i, row.J, row.K };
          for (int d = 0; d < cells.NumComponents; ++d)
          {
            double& x = block[static_cast<std::size_t>(d * layout.Size + row.Start + i)];
            const double w = shape.Rational
              ? block[static_cast<std::size_t>(cells.NumComponents * layout.Size + row.Start + i)]
              : 1.0;
            x = 0.1 * x + w * place[d] / shape.Degree[static_cast<std::size_t>(d)];
          }
        }
      }
      std::copy(block.begin(), block.end(), cells.Block(cell));
    }
    const auto count = static_cast<std::size_t>(cells.NumCells());
    for (const bool uncertain : { false, true })
    {
      cells.Errors.assign(uncertain ? count : 0, 1e-15);
      JacobianParams params;
      params.RelativeGap = 1.0;
      std::vector<CellCertificate> narrow(count);
      std::vector<CellCertificate> wide(count);
      EXPECT_TRUE(FilterCells<2>(cells, params, 0, count, narrow.data()));
      EXPECT_TRUE(FilterCells<4>(cells, params, 0, count, wide.data()));
      for (std::size_t c = 0; c < count; ++c)
      {
        EXPECT_EQ(narrow[c].Verdict, wide[c].Verdict);
        EXPECT_EQ(std::memcmp(&narrow[c].MinLower, &wide[c].MinLower, 4 * sizeof(double)), 0);
        decided += narrow[c].Verdict != Verdict::Undecided ? 1 : 0;
      }
    }
  }
  EXPECT_GT(decided, 200);
}
}
}
