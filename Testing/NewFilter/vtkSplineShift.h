// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineShift
 * @brief   shifted spline grids, a filter that new_filter.py adds to a copy of the tree
 */
#ifndef vtkSplineShift_h
#define vtkSplineShift_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineShift : public vtkSplineAlgorithm
{
public:
  static vtkSplineShift* New();
  vtkTypeMacro(vtkSplineShift, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Ways
  {
    ALONG_X = 0,
    ALONG_Z
  };
  ///@{
  /** Where the points go, one of Ways. Default ALONG_Z. */
  vtkSetClampMacro(Way, int, ALONG_X, ALONG_Z);
  vtkGetMacro(Way, int);
  ///@}
  ///@{
  /** How far the points go, in units of the points. Default 1, valid range [0, 1000]. Advanced. */
  vtkSetClampMacro(Distance, double, 0.0, 1000.0);
  vtkGetMacro(Distance, double);
  ///@}

protected:
  vtkSplineShift();
  ~vtkSplineShift() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineShift(const vtkSplineShift&) = delete;
  void operator=(const vtkSplineShift&) = delete;

  int Way = ALONG_Z;
  double Distance = 1.0;
};
#endif
