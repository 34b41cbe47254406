// SPDX-License-Identifier: BSD-3-Clause
// Measures and the proof of one-to-one-ness cost at most ten times the proof of regularity and a
// millisecond a cell.
#include "TestCells.h"
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/JacobianValidation/CellMeasures.h>

#include <ctime>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr int NumCells = 60;
/// What slower and busier machines, unoptimized builds and sanitizers may take more; the fault that
/// this guards against was a factor of 100 to 1000.
#ifdef NDEBUG
constexpr double Patience = 10.0;
#else
constexpr double Patience = 50.0;
#endif

double ProcessorSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Case
{
  CellShape Shape;
  int Degree;
  double Noise;
  double Decades;
  bool AreApart;
};

void PrintTo(const Case& c, std::ostream* out)
{
  *out << "shape " << static_cast<int>(c.Shape) << " degree " << c.Degree << " noise " << c.Noise
       << " weights 10^+-" << c.Decades << (c.AreApart ? " apart" : " overlapping");
}

class ValidationEffort : public ::testing::TestWithParam<Case>
{
};
}

TEST_P(ValidationEffort, IsAFewTimesThatOfRegularity_PropertyOracle)
{
  const Case& c = this->GetParam();
  std::mt19937 random(53);
  BernsteinCells cells;
  cells.NumComponents = NumParameters(c.Shape);
  cells.Rational = c.Decades > 0.0;
  for (int i = 0; i < NumCells; ++i)
  {
    AddRandomCell(cells, c.Shape, c.Degree, c.Noise, c.Decades, c.AreApart ? 3.0 * i : 0.0, random);
  }
  JacobianParams jacobianParams;
  jacobianParams.Threads = 1;
  const double start = ProcessorSeconds();
  const auto certificate = ValidateJacobian(cells, jacobianParams);
  const double regularity = ProcessorSeconds() - start;
  ASSERT_TRUE(certificate) << certificate.Status.Message();
  const double limit = Patience * (10.0 * regularity + 1e-3 * NumCells);

  CellMeasuresParams measuresParams;
  measuresParams.Threads = 1;
  measuresParams.BoundBoxes = 0;
  const double beforeMeasures = ProcessorSeconds();
  const auto measures = MeasureCells(cells, measuresParams);
  EXPECT_LT(ProcessorSeconds() - beforeMeasures, limit);
  ASSERT_TRUE(measures);
  EXPECT_LE(measures->Total.Points, NumCells * (measuresParams.MaxPoints + 2 * 32 * 32));

  EXPECT_TRUE(
    measures->Total.Converged || (cells.NumComponents == 3 && c.Degree * c.Decades > 1.0));

  InjectivityParams injectivityParams;
  injectivityParams.Threads = 1;
  const double beforeProof = ProcessorSeconds();
  const auto proof = ProveInjectivity(cells, {}, certificate.Value, injectivityParams);
  EXPECT_LT(ProcessorSeconds() - beforeProof, limit);
  ASSERT_TRUE(proof);
  // a 7500th of the boxes a cell; the last pairs may double it
  EXPECT_LE(proof->Boxes, 2 * NumCells * (injectivityParams.MaxBoxes / 7500));
  if (!c.AreApart)
  {
    EXPECT_EQ(proof->Verdict, InjectivityVerdict::NotInjective);
  }
}

INSTANTIATE_TEST_SUITE_P(, ValidationEffort,
  ::testing::Values(Case{ CellShape::Hexahedron, 1, 0.3, 1.0, false },
    Case{ CellShape::Hexahedron, 1, 0.2, 3.0, true },
    Case{ CellShape::Hexahedron, 2, 0.1, 1.0, false },
    Case{ CellShape::Hexahedron, 2, 0.1, 3.0, true },
    Case{ CellShape::Hexahedron, 2, 0.2, 0.0, false },
    Case{ CellShape::Tetrahedron, 1, 0.1, 1.0, false },
    Case{ CellShape::Tetrahedron, 2, 0.1, 3.0, true },
    Case{ CellShape::Tetrahedron, 3, 0.05, 1.0, false },
    Case{ CellShape::Wedge, 2, 0.1, 1.0, false }, Case{ CellShape::Wedge, 2, 0.1, 3.0, true },
    Case{ CellShape::Quadrilateral, 2, 0.1, 3.0, false },
    Case{ CellShape::Quadrilateral, 4, 0.1, 3.0, true },
    Case{ CellShape::Triangle, 3, 0.1, 1.0, false },
    Case{ CellShape::Triangle, 2, 0.1, 3.0, true }));

// Regular cells by themselves, bent and weighted as far as about a tenth of them is not regular any
// more: what is decided of them, and what it costs.
TEST(RandomRationalCells, AreOneToOneOrNotButRarelyUndecided_PropertyOracle)
{
  const Case cases[] = { { CellShape::Quadrilateral, 1, 0.6, 0.0, true },
    { CellShape::Quadrilateral, 2, 0.2, 0.0, true }, { CellShape::Triangle, 2, 0.2, 0.0, true },
    { CellShape::Triangle, 3, 0.12, 0.0, true }, { CellShape::Hexahedron, 1, 0.4, 0.0, true },
    { CellShape::Hexahedron, 2, 0.12, 0.0, true }, { CellShape::Tetrahedron, 1, 0.4, 0.0, true },
    { CellShape::Tetrahedron, 2, 0.1, 0.0, true }, { CellShape::Tetrahedron, 2, 0.2, 0.0, true },
    { CellShape::Tetrahedron, 3, 0.08, 0.0, true }, { CellShape::Wedge, 1, 0.4, 0.0, true },
    { CellShape::Wedge, 2, 0.14, 0.0, true } };
  const double far = 1e6; // and all cells are of size one
  const std::array<double, 2> sets[] = { { 1.0, 0.0 }, { 3.0, 0.0 }, { 1.0, far }, { 3.0, far } };
  for (const auto& [decades, offset] : sets)
  {
    int regular = 0;
    int undecided = 0;
    double seconds = 0.0;
    double limit = 0.0;
    for (const Case& c : cases)
    {
      std::mt19937 random(59);
      for (int i = 0; i < NumCells; ++i)
      {
        BernsteinCells cells;
        cells.NumComponents = NumParameters(c.Shape);
        cells.Rational = true;
        AddRandomCell(cells, c.Shape, c.Degree, c.Noise, decades, offset, random);
        JacobianParams jacobianParams;
        jacobianParams.Threads = 1;
        const double start = ProcessorSeconds();
        const auto certificate = ValidateJacobian(cells, jacobianParams);
        limit += Patience * (10.0 * (ProcessorSeconds() - start) + 1e-3);
        if (certificate->Verdict != Verdict::Valid)
        {
          continue;
        }
        InjectivityParams injectivityParams;
        injectivityParams.Threads = 1;
        const double before = ProcessorSeconds();
        const auto proof = ProveInjectivity(cells, {}, certificate.Value, injectivityParams);
        seconds += ProcessorSeconds() - before;
        ++regular;
        undecided += proof->Verdict == InjectivityVerdict::Undecided;
      }
    }
    std::printf("weights 10^+-%g at %g: %d regular cells, %d undecided, %.3f ms a cell\n", decades,
      offset, regular, undecided, 1e3 * seconds / regular);
    EXPECT_GT(regular, 600);
    EXPECT_LE(undecided, decades > 1.0 ? regular / 100 : 0);
    EXPECT_LT(seconds, limit);
  }
}
