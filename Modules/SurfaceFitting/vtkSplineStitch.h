// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineStitch
 * @brief   makes tiles that were fitted apart continuous or smooth across their boundaries
 *
 * Input 0 takes any number of spline grids and collections of them; every surface patch in them is
 * a tile. Tiles count from 0 in the order of the inputs and of their patches.
 *
 * Neighbours are found by the boxes of their parameter domains (height fields: pieces of one
 * plane; an edge may end in the middle of a neighbour's side), by points of their sides in space,
 * or are given as pairs of sides. Both sides of a common edge get each other's knot lines, as long
 * as the functions there reach, and the same coefficients: C0, or C1 with the same derivatives
 * across the edge. Fields are stitched along. Tiles stay what they are a knot span (C0) or two (C1)
 * away from the edges.
 *
 * Output 0 are the tiles as LR splines in one grid; PatchId keeps the ids of the inputs when they
 * differ, else it is the number of the tile. Output 1 is a table with a row an edge: tiles, sides,
 * the part that is common (in each tile's parameter), and bounds, proved, of the jumps before and
 * after in position and in the derivative across. Output 2 is a table of one row with the numbers
 * of all.
 *
 * Cell arrays other than those of spline grids do not pass.
 */
#ifndef vtkSplineStitch_h
#define vtkSplineStitch_h
#include "vtkKnotworkSurfaceFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <array>  // for pairs
#include <vector> // for pairs

class VTKKNOTWORKSURFACEFITTING_EXPORT vtkSplineStitch : public vtkSplineAlgorithm
{
public:
  static vtkSplineStitch* New();
  vtkTypeMacro(vtkSplineStitch, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Matchings
  {
    DOMAIN_BOXES = 0, ///< "Domain" parameter boxes that share an edge or a part of one
    GEOMETRY,         ///< sides that begin, end and have their middle at the same points
    PAIRS             ///< AddPair
  };

  ///@{
  /** 0: tiles meet; 1: their derivatives do, too. Default 1, valid range [0, 1]. */
  vtkSetClampMacro(Continuity, int, 0, 1);
  vtkGetMacro(Continuity, int);
  ///@}
  ///@{
  /** How neighbours are found, one of Matchings: by the boxes of their parameters (height
   * fields), by points of their sides, or as given pairs say. Default DOMAIN_BOXES. */
  vtkSetClampMacro(Matching, int, DOMAIN_BOXES, PAIRS);
  vtkGetMacro(Matching, int);
  ///@}
  ///@{
  /** What counts as the same place, relative to the shortest side of a domain, or with GEOMETRY
   * to the longest edge of the box around all control points. Default 1e-6, valid range [1e-14,
   * 0.1]. Advanced. For Matching not PAIRS. */
  vtkSetClampMacro(Tolerance, double, 1e-14, 0.1);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Pairs of sides for PAIRS: 0 and 1 are the ends of a tile's first parameter, 2 and 3 those of
   * the second; reversed is 1 when the parameters along the sides run against each other. */
  void AddPair(int tileA, int sideA, int tileB, int sideB, int reversed);
  void ClearPairs();
  ///@}

protected:
  vtkSplineStitch();
  ~vtkSplineStitch() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineStitch(const vtkSplineStitch&) = delete;
  void operator=(const vtkSplineStitch&) = delete;

  int Continuity = 1;
  int Matching = DOMAIN_BOXES;
  double Tolerance = 1e-6;
  std::vector<std::array<int, 5>> Pairs;
};
#endif
