// SPDX-License-Identifier: BSD-3-Clause
#include "FaceCertificate.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TrimmedRegion.h>

#include <cmath>
#include <limits>
#include <optional>

namespace knotwork
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Bounds of |S_u x S_v| that are so much smaller than a value on the region are brought nearer.
constexpr double BoundGap = 0.5;
/// Halving for the sake of the bound ends with so many pieces.
constexpr std::size_t MaxPieces = std::size_t(1) << 20;
/// Boxes of a proof: a piece that is halved when it fails gets few, one that has to be proved as it
/// is the total of all.
constexpr std::int64_t FirstBoxes = 256;
constexpr std::int64_t LastBoxes = 100000;
constexpr std::size_t MaxLast = 64;
constexpr double Inward = 1.0 - 0x1p-50; // covers the three roundings of a scaled bound
constexpr double Outward = 1.0 + 0x1p-50;

/// The part [k / 2^d, (k + 1) / 2^d] of an element in both directions, d = Depth.
struct Piece
{
  int Element = 0;
  int Depth = 0;
  IntArray<2> Index{};
  RegionPlace Place = RegionPlace::Boundary;
  bool Tight = false; ///< the bounds were brought to the gap
  /// Of the least |S_u x S_v| on the piece, by the surface's parameters.
  double Lower = 0.0;
  double Upper = Infinity;
};

class FaceProof
{
public:
  FaceProof(
    const TrimmedFace& face, const TrimmedRegion& region, const FaceCertificateParams& params)
    : Region(region), Params(params),
      Form(MakeBezierForm<2>(Flattened(face.Surface), params.Threads))
  {
    for (double x : this->Form.Data)
    {
      this->Largest = std::max(this->Largest, std::abs(x));
    }
  }

  Result<FaceCertificate> Run()
  {
    std::vector<Piece> pieces(static_cast<std::size_t>(this->Form.Space->NumElements()));
    for (std::size_t e = 0; e < pieces.size(); ++e)
    {
      pieces[e].Element = static_cast<int>(e);
    }
    this->DropOutside(pieces);
    if (const Status status = this->Decide(std::move(pieces)); !status)
    {
      return status;
    }
    if (this->Found.HasWitness)
    {
      return this->Found; // invalid or undecided
    }
    if (const Status status = this->Sharpen(); !status)
    {
      return status;
    }
    if (this->Regular.empty())
    {
      return { ErrorCode::EmptyInput, "the loops enclose no part of the surface" };
    }
    this->Found.Verdict = Verdict::Valid;
    this->Found.MinNormal = Infinity;
    for (const Piece& piece : this->Regular)
    {
      this->Found.MinNormal = std::min(this->Found.MinNormal, piece.Lower);
    }
    return this->Found;
  }

private:
  /// A surface in a plane x, y or z = const as a map into that plane: det J has a sign, so that
  /// folds are proved. Cyclic, so that the sign is that of the normal's component.
  static Spline<2> Flattened(const Spline<2>& surface)
  {
    for (Eigen::Index c = 0; c < 3; ++c)
    {
      if ((surface.ControlPoints.col(c).array() == surface.ControlPoints(0, c)).all())
      {
        Spline<2> flat{ surface.Space, PointMatrix(surface.ControlPoints.rows(), 2),
          surface.Weights };
        flat.ControlPoints.col(0) = surface.ControlPoints.col((c + 1) % 3);
        flat.ControlPoints.col(1) = surface.ControlPoints.col((c + 2) % 3);
        return flat;
      }
    }
    return surface;
  }

  const SplineSpace<2>::Element& Element(const Piece& piece) const
  {
    return this->Form.Space->Elements[static_cast<std::size_t>(piece.Element)];
  }

  /// Parameter of the surface at a local parameter of a piece.
  RealArray<2> Parameter(const Piece& piece, double s, double t) const
  {
    const ParametricBox<2>& box = this->Element(piece).Box;
    const RealArray<2> local{ s, t };
    RealArray<2> u;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double at = std::ldexp(piece.Index[d] + local[d], -piece.Depth);
      u[d] = at == 1.0 ? box.Upper[d] : box.Lower[d] + (box.Upper[d] - box.Lower[d]) * at;
    }
    return u;
  }

  void DropOutside(std::vector<Piece>& pieces) const
  {
    ParallelFor(pieces.size(), 64, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          Piece& piece = pieces[k];
          piece.Place = this->Region.Classify(
            this->Parameter(piece, 0.0, 0.0), this->Parameter(piece, 1.0, 1.0));
        }
      });
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                   [](const Piece& piece) { return piece.Place == RegionPlace::Outside; }),
      pieces.end());
  }

  /// The four quarters of a piece.
  static void AddQuarters(const Piece& piece, std::vector<Piece>& quarters)
  {
    for (int k = 0; k < 4; ++k)
    {
      Piece quarter = piece;
      ++quarter.Depth;
      quarter.Tight = false;
      quarter.Upper = Infinity; // where the least value was may be outside
      quarter.Index = { 2 * piece.Index[0] + (k & 1), 2 * piece.Index[1] + (k >> 1) };
      quarters.push_back(quarter);
    }
  }

  BernsteinCells MakeCells(const std::vector<Piece>& pieces) const
  {
    BernsteinCells cells;
    cells.NumComponents = this->Form.NumComponents;
    cells.Rational = this->Form.Rational;
    for (const Piece& piece : pieces)
    {
      const IntArray<2>& degree = this->Element(piece).Degree;
      cells.Add(CellShape::Quadrilateral, { degree[0], degree[1], 0 });
    }
    cells.Errors.resize(pieces.size());
    ParallelFor(pieces.size(), 256, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          cells.Errors[k] = this->FillCell(pieces[k], cells.Block(static_cast<int>(k)));
        }
      });
    return cells;
  }

  /// @return how far the coefficients may be off.
  double FillCell(const Piece& piece, double* block) const
  {
    const IntArray<2>& degree = this->Element(piece).Degree;
    const int n = NumTensorFunctions<2>(degree);
    const double* from = this->Form.Block(piece.Element);
    const int planes = this->Form.NumPlanes();
    const auto factors = this->Form.Space->Factors(piece.Element);
    const bool exact =
      !factors[0] && !factors[1] && !this->Form.Rational && this->Form.Space->IsIdentityMap();
    if (piece.Depth == 0)
    {
      std::copy(from, from + planes * n, block);
    }
    else
    {
      double matrix[2][(MaxDegree + 1) * (MaxDegree + 1)];
      for (std::size_t d = 0; d < 2; ++d)
      {
        BernsteinRestriction(degree[d], std::ldexp(piece.Index[d], -piece.Depth),
          std::ldexp(piece.Index[d] + 1.0, -piece.Depth), matrix[d]);
      }
      for (int plane = 0; plane < planes; ++plane)
      {
        ApplyFactors<2>(degree, { matrix[0], matrix[1] }, from + plane * n, block + plane * n);
      }
    }
    // Convex combinations with rounded weights, of the control points and then of coefficients:
    // up to 2 p + 2 roundings in a weight and as many in a sum, in both directions.
    const int steps = 4 * (degree[0] + degree[1] + 2);
    const int times = (exact ? 0 : 1) + (piece.Depth > 0 ? 1 : 0);
    return times * steps * 0x1p-52 * this->Largest;
  }

  /// Certificates of pieces, into LastProof; the bounds of those that are valid.
  Status Prove(std::vector<Piece>& pieces, double gap, std::int64_t boxes)
  {
    const BernsteinCells cells = this->MakeCells(pieces);
    JacobianParams params;
    params.RelativeGap = gap;
    params.ComputeMax =
      gap < 1.0 && cells.NumComponents == 2; // of reversed cells it is the minimum
    params.CollapseTolerance = 0.0;
    params.MaxBoxes = boxes;
    params.Threads = this->Params.Threads;
    const double begin = 1.0 - std::ldexp(1.0, -this->Round);
    ++this->Round;
    const double end = 1.0 - std::ldexp(1.0, -this->Round);
    ProgressCallback progress;
    if (this->Params.Progress)
    {
      progress = [&](double share) { return this->Params.Progress(begin + (end - begin) * share); };
    }
    auto proof = ValidateJacobian(cells, params, progress);
    if (!proof)
    {
      return proof.Status;
    }
    this->LastProof = std::move(proof.Value);
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const CellCertificate& cell = this->LastProof.Cells[k];
      if (IsRegular(cell))
      {
        const bool reversed = cell.Verdict == Verdict::Reversed;
        const ParametricBox<2>& box = this->Element(pieces[k]).Box;
        const double area = std::ldexp(
          (box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]), -2 * pieces[k].Depth);
        const double lower = (reversed ? -cell.MaxUpper : cell.MinLower) / area * Inward;
        pieces[k].Lower = std::max(pieces[k].Lower, lower);
        pieces[k].Upper = (reversed ? -cell.MaxLower : cell.MinUpper) / area * Outward;
      }
      pieces[k].Tight = gap < 1.0;
    }
    this->Found.NumPieces += static_cast<int>(pieces.size());
    return {};
  }

  static bool IsRegular(const CellCertificate& cell)
  {
    return cell.Degenerate == 0 &&
      ((cell.Verdict == Verdict::Valid && cell.MinLower > 0.0) ||
        (cell.Verdict == Verdict::Reversed && cell.MaxUpper < 0.0));
  }

  /// Fills Regular, or finds a witness.
  Status Decide(std::vector<Piece> pieces)
  {
    while (!pieces.empty() && this->Found.Verdict != Verdict::Invalid)
    {
      if (const Status status = this->Prove(pieces, 1.0, FirstBoxes); !status)
      {
        return status;
      }
      pieces = this->Sort(pieces);
    }
    if (this->Last.empty() || this->Found.Verdict == Verdict::Invalid)
    {
      return {};
    }
    pieces.swap(this->Last);
    this->IsLast = true;
    if (const Status status = this->Prove(pieces, 1.0, LastBoxes); !status)
    {
      return status;
    }
    this->Sort(pieces);
    return {};
  }

  /// Takes what LastProof says of pieces. @return the quarters of those that may be regular where
  /// the region is; none when the face is found to be invalid.
  std::vector<Piece> Sort(const std::vector<Piece>& pieces)
  {
    std::vector<Piece> quarters;
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const Piece& piece = pieces[k];
      const CellCertificate& cell = this->LastProof.Cells[k];
      if (IsRegular(cell))
      {
        this->Regular.push_back(piece);
        continue;
      }
      if (const auto witness = this->Singularity(piece, cell))
      {
        this->Found.Verdict = Verdict::Invalid;
        this->Found.HasWitness = true;
        this->Found.Witness = *witness;
        return {};
      }
      if (piece.Place == RegionPlace::Boundary && piece.Depth < this->Params.MaxDepth)
      {
        AddQuarters(piece, quarters);
      }
      else if (!this->IsLast && cell.Limit == JacobianLimit::Boxes && this->Last.size() < MaxLast)
      {
        this->Last.push_back(piece);
      }
      else if (!this->Found.HasWitness)
      {
        this->Found.HasWitness = true;
        this->Found.Witness = this->Parameter(piece, 0.5, 0.5);
      }
    }
    this->DropOutside(quarters);
    return quarters;
  }

  /// A place of the region where the proof found the surface not to be regular.
  std::optional<RealArray<2>> Singularity(const Piece& piece, const CellCertificate& cell) const
  {
    // In the plane the witness is one of two places with opposite normals: both must be inside.
    const bool pointwise = this->Form.NumComponents == 3;
    if (cell.Verdict == Verdict::Invalid && (pointwise || piece.Place == RegionPlace::Inside))
    {
      const auto& local =
        this->LastProof.Witnesses[static_cast<std::size_t>(cell.Witness)].Parameters;
      const RealArray<2> u = this->Parameter(piece, local[0], local[1]);
      if (piece.Place == RegionPlace::Inside || this->Region.Contains(u) == RegionPlace::Inside)
      {
        return u;
      }
    }
    if (cell.Degenerate != 0)
    {
      return this->CollapsedCorner(piece);
    }
    return {};
  }

  /// A corner in the region with a tangent that is exactly zero.
  std::optional<RealArray<2>> CollapsedCorner(const Piece& piece) const
  {
    if (piece.Depth > 0 || this->Form.Rational)
    {
      return {};
    }
    const IntArray<2>& degree = this->Element(piece).Degree;
    const int n = NumTensorFunctions<2>(degree);
    const int row = degree[0] + 1;
    const double* block = this->Form.Block(piece.Element);
    for (int corner = 0; corner < 4; ++corner)
    {
      const int right = corner & 1;
      const int top = corner >> 1;
      const int at = right * degree[0] + top * degree[1] * row;
      const RealArray<2> u = this->Parameter(piece, right, top);
      for (const int next : { right ? at - 1 : at + 1, top ? at - row : at + row })
      {
        bool collapsed = true;
        for (int plane = 0; plane < this->Form.NumPlanes(); ++plane)
        {
          collapsed = collapsed && block[plane * n + at] == block[plane * n + next];
        }
        if (collapsed &&
          (piece.Place == RegionPlace::Inside || this->Region.Contains(u) == RegionPlace::Inside))
        {
          return u;
        }
      }
    }
    return {};
  }

  /// Brings bounds of |S_u x S_v| nearer that are far below a value on the region.
  Status Sharpen()
  {
    while (true)
    {
      double upper = Infinity;
      for (const Piece& piece : this->Regular)
      {
        if (piece.Place == RegionPlace::Inside)
        {
          upper = std::min(upper, piece.Upper);
        }
      }
      std::vector<Piece> again;
      std::vector<Piece> kept;
      for (const Piece& piece : this->Regular)
      {
        const bool split = piece.Tight && piece.Place == RegionPlace::Boundary &&
          piece.Depth < this->Params.MaxDepth && this->Regular.size() < MaxPieces;
        if (piece.Lower >= BoundGap * upper || (piece.Tight && !split))
        {
          kept.push_back(piece);
        }
        else if (split)
        {
          AddQuarters(piece, again);
        }
        else
        {
          again.push_back(piece);
        }
      }
      if (again.empty())
      {
        return {};
      }
      this->DropOutside(again);
      if (!again.empty())
      {
        if (const Status status = this->Prove(again, BoundGap, FirstBoxes); !status)
        {
          return status;
        }
      }
      kept.insert(kept.end(), again.begin(), again.end());
      this->Regular = std::move(kept);
    }
  }

  const TrimmedRegion& Region;
  const FaceCertificateParams& Params;
  BezierForm<2> Form;
  double Largest = 0.0;
  std::vector<Piece> Regular; ///< proved, with bounds
  std::vector<Piece> Last;    ///< that more boxes may decide
  bool IsLast = false;        ///< they are being decided
  JacobianCertificate LastProof;
  FaceCertificate Found;
  int Round = 0;
};
}

Result<FaceCertificate> CertifyFace(const TrimmedFace& face, const FaceCertificateParams& params)
{
  if (const Status status = face.Surface.Check(); !status)
  {
    return status;
  }
  if (face.Surface.NumComponents() != 3 || face.Surface.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "the surface must be a tensor product in space" };
  }
  if (params.MaxDepth < 0 || params.MaxDepth > 20)
  {
    return { ErrorCode::InvalidParameter, "the number of halvings must be in [0, 20]" };
  }
  if (params.Threads < 0)
  {
    return { ErrorCode::InvalidParameter, "the number of threads must not be negative" };
  }
  const auto region = TrimmedRegion::Create(face.Loops);
  if (!region)
  {
    return region.Status;
  }
  return FaceProof(face, region.Value, params).Run();
}
}
