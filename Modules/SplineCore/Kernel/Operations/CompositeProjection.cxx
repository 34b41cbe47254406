// SPDX-License-Identifier: BSD-3-Clause
#include "CompositeProjection.h"

#include "DualFunctionals.h"
#include "PatchSpaces.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Numbers this close to 0 and 1 are: quotients of the same knots in two orders.
constexpr double Rounding = 1e-13;

PointMatrix Snapped(PointMatrix matrix)
{
  for (Eigen::Index i = 0; i < matrix.size(); ++i)
  {
    double& value = matrix.data()[i];
    value = std::abs(value - std::round(value)) < Rounding ? std::round(value) : value;
  }
  return matrix;
}

/// A cell in its patch: its own local functions in those of the patch, and the other way round.
template <int Dim>
struct CellInPatch
{
  CellInPatch(const CompositeProjection<Dim>& composite, int patch, int index)
    : Cell(composite.Layout.Patches[At(patch)].Cells[At(index)]), Space(*composite.Space),
      Degree(Space.Unstructured->Degree),
      Turned(TurnedEntries<Dim>(Degree + 1, composite.Layout.AheadOf[At(this->Cell)])),
      PatchFunctions(composite.Patches[At(patch)]->LocalFunctions(index)),
      FirstOfPatch(composite.First[At(patch)])
  {
    const SplineSpace<Dim>& patchSpace = *composite.Patches[At(patch)];
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int ahead = composite.Layout.AheadOf[At(this->Cell)][d];
      const PointMatrix own = FactorOf(this->Space, this->Cell, ahead / 2, ahead % 2 == 0);
      const PointMatrix theirs = FactorOf(patchSpace, index, static_cast<int>(d), false);
      this->ToPatch[d] = Snapped(Solve(theirs, own));
      this->FromPatch[d] = Snapped(Solve(own, theirs));
      this->Integrals[d] = own.rowwise().sum() / (this->Degree + 1);
    }
  }

  int Size() const { return static_cast<int>(this->Turned.size()); }
  /// Row of T of a local function in the patch's directions.
  int RowOf(int local) const
  {
    return this->Space.LocalFunctions(this->Cell)[this->Turned[At(local)]];
  }
  int PatchFunction(int local) const { return this->FirstOfPatch + this->PatchFunctions[local]; }
  IntArray<Dim> Index(int local) const
  {
    IntArray<Dim> degree;
    degree.fill(this->Degree);
    return TensorIndex<Dim>(degree, local);
  }
  /// Integral of a local function over the cell as the unit cube.
  double Integral(int local) const
  {
    double integral = 1.0;
    const IntArray<Dim> index = this->Index(local);
    for (std::size_t d = 0; d < Dim; ++d)
    {
      integral *= this->Integrals[d][index[d]];
    }
    return integral;
  }
  /// Calls entry(function, share) for every function in the row of T of a local function.
  template <typename Entry>
  void VisitRow(int local, const Entry& entry) const
  {
    const int row = this->RowOf(local);
    if (this->Space.IsIdentityMap())
    {
      entry(row, 1.0);
      return;
    }
    for (std::size_t k = this->Space.RowStart[At(row)]; k < this->Space.RowStart[At(row) + 1]; ++k)
    {
      entry(this->Space.RowFunction[k], this->Space.RowCoefficient[k]);
    }
  }
  /// Entry of a tensor product of one matrix a direction.
  double Product(const std::array<PointMatrix, Dim>& matrices, const IntArray<Dim>& i,
    const IntArray<Dim>& j) const
  {
    double product = 1.0;
    for (std::size_t d = 0; d < Dim && product != 0.0; ++d)
    {
      product *= matrices[d](i[d], j[d]);
    }
    return product;
  }

  int Cell;
  const SplineSpace<Dim>& Space;
  int Degree;
  std::vector<int> Turned;
  const int* PatchFunctions;
  int FirstOfPatch;
  std::array<PointMatrix, Dim> ToPatch;   ///< (patch function, own function)
  std::array<PointMatrix, Dim> FromPatch; ///< (own function, patch function)
  std::array<Eigen::VectorXd, Dim> Integrals;

private:
  static PointMatrix FactorOf(const SplineSpace<Dim>& space, int e, int direction, bool reversed)
  {
    const int n = space.Elements[At(e)].Degree[At(direction)] + 1;
    const double* factor = space.Factor(e, direction);
    PointMatrix matrix = PointMatrix::Identity(n, n);
    if (factor)
    {
      matrix = Eigen::Map<const PointMatrix>(factor, n, n);
    }
    return reversed ? PointMatrix(matrix.reverse()) : matrix;
  }
  /// Coefficients in functions `in` of the functions `of` (rows in Bernstein form): a column each.
  static PointMatrix Solve(const PointMatrix& in, const PointMatrix& of)
  {
    if (in == of)
    {
      return PointMatrix::Identity(in.rows(), in.cols());
    }
    return Eigen::MatrixXd(in.transpose()).partialPivLu().solve(Eigen::MatrixXd(of.transpose()));
  }
};

/// Rows of the Prolongation of the patch functions whose support has its middle in the cell.
template <int Dim>
void AddProlongation(const CompositeProjection<Dim>& composite, int patch,
  const CellInPatch<Dim>& cell, Triplets& triplets)
{
  const SplineSpace<Dim>& patchSpace = *composite.Patches[At(patch)];
  const IntArray<Dim>& place = composite.Layout.IndexOf[At(cell.Cell)];
  for (int m = 0; m < cell.Size(); ++m)
  {
    const IntArray<Dim> to = cell.Index(m);
    bool isMiddle = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = patchSpace.Knots[d];
      const auto support = knots.Support(knots.Span(place[d]) - cell.Degree + to[d]);
      isMiddle = isMiddle && place[d] == (support[0] + support[1]) / 2;
    }
    for (int i = 0; isMiddle && i < cell.Size(); ++i)
    {
      const double share = cell.Product(cell.ToPatch, to, cell.Index(i));
      if (share != 0.0)
      {
        cell.VisitRow(i,
          [&](int function, double value)
          { triplets.emplace_back(cell.PatchFunction(m), function, share * value); });
      }
    }
  }
}

/// Integrals of the B-splines of a direction, elements as unit intervals.
Eigen::VectorXd LineIntegrals(const KnotVector& knots)
{
  const int alive = knots.Degree() + 1;
  Eigen::VectorXd integrals = Eigen::VectorXd::Zero(knots.NumFunctions());
  PointMatrix factor(alive, alive);
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    knots.Extraction(e, factor.data());
    integrals.segment(knots.Span(e) - knots.Degree(), alive) += factor.rowwise().sum() / alive;
  }
  return integrals;
}

/// Both matrices where every function of a patch is one of the space, by the functions alone.
/// @return whether it is so.
template <int Dim>
bool MakeUnitMatrices(CompositeProjection<Dim>& composite)
{
  const int rows = composite.First.back();
  std::vector<int> functionOf;
  Eigen::VectorXd shares(rows);
  for (int k = 0; k < static_cast<int>(composite.Patches.size()); ++k)
  {
    const SplineSpace<Dim>& patch = *composite.Patches[At(k)];
    const auto own = FunctionsOfPatch(*composite.Space, composite.Layout, k, patch);
    if (!own)
    {
      return false;
    }
    functionOf.insert(functionOf.end(), own->begin(), own->end());
    Eigen::VectorXd integrals = LineIntegrals(patch.Knots[0]);
    for (std::size_t d = 1; d < Dim; ++d)
    {
      const Eigen::MatrixXd product = integrals * LineIntegrals(patch.Knots[d]).transpose();
      integrals = Eigen::Map<const Eigen::VectorXd>(product.data(), product.size());
    }
    shares.segment(composite.First[At(k)], patch.NumFunctions) = integrals;
  }
  Eigen::VectorXd totals = Eigen::VectorXd::Zero(composite.Space->NumFunctions);
  for (int row = 0; row < rows; ++row)
  {
    totals[functionOf[At(row)]] += shares[row];
  }
  Triplets ones;
  Triplets means;
  for (int row = 0; row < rows; ++row)
  {
    const int function = functionOf[At(row)];
    ones.emplace_back(row, function, 1.0);
    means.emplace_back(function, row, shares[row] / totals[function]);
  }
  composite.Prolongation.resize(rows, composite.Space->NumFunctions);
  composite.Prolongation.setFromTriplets(ones.begin(), ones.end());
  composite.Restriction.resize(composite.Space->NumFunctions, rows);
  composite.Restriction.setFromTriplets(means.begin(), means.end());
  return true;
}

/// Rows of the Restriction by the inverses on the cells of the patches.
template <int Dim>
class WeightedRestriction
{
public:
  explicit WeightedRestriction(const CompositeProjection<Dim>& composite)
    : Composite(composite), Total(At(composite.Space->NumFunctions), 0.0),
      Slot(At(composite.Space->NumFunctions), -1)
  {
  }

  Triplets Run()
  {
    const int numPatches = static_cast<int>(this->Composite.Patches.size());
    for (int k = 0; k < numPatches; ++k)
    {
      this->Sum(k);
      for (const Share& share : this->Shares)
      {
        this->Total[At(share.Function)] += share.Integral;
      }
    }
    for (int k = 0; k < numPatches; ++k)
    {
      this->Sum(k);
      this->AddRows(k);
    }
    return std::move(this->Rows);
  }

private:
  struct Share
  {
    int Function;
    double Integral = 0.0;
    int UnitRows = 0;  ///< cells on which the function's coefficient is a local one
    int MixedRows = 0; ///< cells on which it follows from others
  };

  /// The functions alive on a patch.
  void Sum(int patch)
  {
    for (const Share& share : this->Shares)
    {
      this->Slot[At(share.Function)] = -1;
    }
    this->Shares.clear();
    this->VisitCells(patch,
      [&](const CellInPatch<Dim>& cell)
      {
        std::vector<int> alive;
        for (int i = 0; i < cell.Size(); ++i)
        {
          const double integral = cell.Integral(i);
          cell.VisitRow(i,
            [&](int function, double value)
            {
              int& slot = this->Slot[At(function)];
              if (slot < 0)
              {
                slot = static_cast<int>(this->Shares.size());
                this->Shares.push_back({ function });
              }
              this->Shares[At(slot)].Integral += value * integral;
              alive.push_back(slot);
            });
          const int own = OwnFunction(*this->Composite.Space, cell.RowOf(i));
          if (own >= 0)
          {
            ++this->Shares[At(this->Slot[At(own)])].UnitRows;
          }
        }
        std::sort(alive.begin(), alive.end());
        alive.erase(std::unique(alive.begin(), alive.end()), alive.end());
        for (const int slot : alive)
        {
          ++this->Shares[At(slot)].MixedRows;
        }
      });
  }

  void AddRows(int patch)
  {
    this->VisitCells(patch,
      [&](const CellInPatch<Dim>& cell)
      {
        std::vector<int> mixed; // functions that no cell of the patch has alone
        for (int i = 0; i < cell.Size(); ++i)
        {
          const int own = OwnFunction(*this->Composite.Space, cell.RowOf(i));
          if (own >= 0)
          {
            this->Add(cell, own, Eigen::VectorXd::Unit(cell.Size(), i),
              this->Shares[At(this->Slot[At(own)])].UnitRows);
          }
          cell.VisitRow(i,
            [&](int function, double)
            {
              if (this->Shares[At(this->Slot[At(function)])].UnitRows == 0)
              {
                mixed.push_back(function);
              }
            });
        }
        this->AddMixed(cell, std::move(mixed));
      });
  }

  void AddMixed(const CellInPatch<Dim>& cell, std::vector<int> mixed)
  {
    if (mixed.empty())
    {
      return;
    }
    std::sort(mixed.begin(), mixed.end());
    mixed.erase(std::unique(mixed.begin(), mixed.end()), mixed.end());
    const std::vector<int> alive = this->Composite.Space->AliveFunctions(cell.Cell);
    const auto column = [&](int function)
    { return std::lower_bound(alive.begin(), alive.end(), function) - alive.begin(); };
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(cell.Size(), cell.Size());
    for (int i = 0; i < cell.Size(); ++i)
    {
      cell.VisitRow(i, [&](int function, double value) { map(i, column(function)) = value; });
    }
    const auto factored = map.transpose().partialPivLu();
    for (const int function : mixed)
    {
      this->Add(cell, function,
        factored.solve(Eigen::VectorXd::Unit(cell.Size(), column(function))),
        this->Shares[At(this->Slot[At(function)])].MixedRows);
    }
  }

  /// @param row  the coefficient of the function in those of the local functions.
  void Add(const CellInPatch<Dim>& cell, int function, const Eigen::VectorXd& row, int cells)
  {
    const double weight =
      this->Shares[At(this->Slot[At(function)])].Integral / this->Total[At(function)] / cells;
    for (int i = 0; i < cell.Size(); ++i)
    {
      for (int m = 0; row[i] != 0.0 && m < cell.Size(); ++m)
      {
        const double share = cell.Product(cell.FromPatch, cell.Index(i), cell.Index(m));
        if (share != 0.0)
        {
          this->Rows.emplace_back(function, cell.PatchFunction(m), weight * row[i] * share);
        }
      }
    }
  }

  template <typename Visit>
  void VisitCells(int patch, const Visit& visit)
  {
    const int cells = static_cast<int>(this->Composite.Layout.Patches[At(patch)].Cells.size());
    for (int index = 0; index < cells; ++index)
    {
      visit(CellInPatch<Dim>(this->Composite, patch, index));
    }
  }

  const CompositeProjection<Dim>& Composite;
  std::vector<double> Total;
  std::vector<int> Slot; ///< of a function in Shares
  std::vector<Share> Shares;
  Triplets Rows;
};

/// The shortest row on the nonzeros of each column of the Prolongation.
Result<Triplets> PlainRestriction(const Eigen::SparseMatrix<double, Eigen::RowMajor>& prolongation)
{
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const Eigen::SparseMatrix<double> columns = prolongation;
  Result<Triplets> result;
  for (int function = 0; function < columns.cols(); ++function)
  {
    std::vector<int> rows;
    std::vector<int> others{ function };
    for (Eigen::SparseMatrix<double>::InnerIterator at(columns, function); at; ++at)
    {
      rows.push_back(static_cast<int>(at.row()));
      for (Rows::InnerIterator in(prolongation, at.row()); in; ++in)
      {
        others.push_back(static_cast<int>(in.col()));
      }
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    const auto column = [&](Eigen::Index f) {
      return std::lower_bound(others.begin(), others.end(), static_cast<int>(f)) - others.begin();
    };
    const auto numRows = static_cast<Eigen::Index>(rows.size());
    const auto numOthers = static_cast<Eigen::Index>(others.size());
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(numOthers, numRows);
    for (Eigen::Index i = 0; i < numRows; ++i)
    {
      for (Rows::InnerIterator in(prolongation, rows[static_cast<std::size_t>(i)]); in; ++in)
      {
        block(column(in.col()), i) = in.value();
      }
    }
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(numOthers, column(function));
    const Eigen::VectorXd row = numOthers == 1
      ? Eigen::VectorXd(block.transpose() / block.squaredNorm())
      : Eigen::VectorXd(block.completeOrthogonalDecomposition().solve(unit));
    if (!((block * row - unit).cwiseAbs().maxCoeff() <= 1e-10))
    {
      return { ErrorCode::NotInSpace,
        "function " + std::to_string(function) + " has no plain restriction" };
    }
    for (Eigen::Index i = 0; i < numRows; ++i)
    {
      result->emplace_back(function, rows[static_cast<std::size_t>(i)], row[i]);
    }
  }
  return result;
}
}

template <int Dim>
Result<CompositeProjection<Dim>> MakeCompositeProjection(
  const SplineSpacePtr<Dim>& space, RestrictionKind restriction)
{
  if (!space || space->NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, "no space to project onto" };
  }
  if (space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the space is none on an unstructured mesh" };
  }
  Result<CompositeProjection<Dim>> result;
  CompositeProjection<Dim>& composite = result.Value;
  composite.Space = space;
  composite.Layout = FindSpacePatches(*space);
  composite.First.assign(1, 0);
  for (const MeshPatch<Dim>& patch : composite.Layout.Patches)
  {
    auto made = MakePatchSpace(*space->Unstructured, composite.Layout, patch);
    if (!made)
    {
      return made.Status;
    }
    composite.First.push_back(composite.First.back() + made.Value->NumFunctions);
    composite.Patches.push_back(std::move(made.Value));
  }
  if (restriction == RestrictionKind::Weighted && MakeUnitMatrices(composite))
  {
    return result;
  }
  Triplets triplets;
  for (int k = 0; k < static_cast<int>(composite.Patches.size()); ++k)
  {
    const int cells = static_cast<int>(composite.Layout.Patches[At(k)].Cells.size());
    for (int index = 0; index < cells; ++index)
    {
      AddProlongation(composite, k, CellInPatch<Dim>(composite, k, index), triplets);
    }
  }
  composite.Prolongation.resize(composite.First.back(), space->NumFunctions);
  composite.Prolongation.setFromTriplets(triplets.begin(), triplets.end());
  composite.Prolongation.prune(1.0, Rounding);
  if (restriction == RestrictionKind::Weighted)
  {
    triplets = WeightedRestriction<Dim>(composite).Run();
  }
  else
  {
    auto plain = PlainRestriction(composite.Prolongation);
    if (!plain)
    {
      return plain.Status;
    }
    triplets = std::move(plain.Value);
  }
  composite.Restriction.resize(space->NumFunctions, composite.First.back());
  composite.Restriction.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

template Result<CompositeProjection<2>> MakeCompositeProjection(
  const SplineSpacePtr<2>&, RestrictionKind);
template Result<CompositeProjection<3>> MakeCompositeProjection(
  const SplineSpacePtr<3>&, RestrictionKind);
}
