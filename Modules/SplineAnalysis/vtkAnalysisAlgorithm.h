// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAnalysisAlgorithm
 * @brief   base of the filters that solve Poisson's equation or linear elasticity
 *
 * What is solved, and how: the problem as JSON, whose keys are on the module's page, the material
 * of what it gives none, and limits of the solver.
 */
#ifndef vtkAnalysisAlgorithm_h
#define vtkAnalysisAlgorithm_h
#include "vtkKnotworkSplineAnalysisModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <functional>
#include <memory>
#include <string>

namespace knotwork
{
struct AnalysisOptions;
}

class VTKKNOTWORKSPLINEANALYSIS_EXPORT vtkAnalysisAlgorithm : public vtkSplineAlgorithm
{
public:
  vtkTypeMacro(vtkAnalysisAlgorithm, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Equations
  {
    POISSON = 0,
    ELASTICITY
  };
  enum Planes
  {
    STRESS = 0,
    STRAIN
  };

  ///@{
  /** What is solved, one of Equations: POISSON, -div(k grad u) = f; ELASTICITY, small displacements
   * of elastic bodies. Default POISSON. */
  vtkSetClampMacro(Equation, int, POISSON, ELASTICITY);
  vtkGetMacro(Equation, int);
  ///@}
  ///@{
  /** Elasticity in the plane, one of Planes: STRESS, a thin plate; STRAIN, a long body. Default
   * STRESS. For Equation ELASTICITY. */
  vtkSetClampMacro(Plane, int, STRESS, STRAIN);
  vtkGetMacro(Plane, int);
  ///@}
  ///@{
  /** The problem as JSON: materials, source, conditions. Not beside ProblemFile. Default empty. */
  vtkSetStringMacro(Problem);
  vtkGetStringMacro(Problem);
  ///@}
  ///@{
  /** A file with the problem as JSON. Default empty. */
  vtkSetFilePathMacro(ProblemFile);
  vtkGetFilePathMacro(ProblemFile);
  ///@}
  /**
   * Gives the problem a function, which stands as "@name" where an expression may: its first value,
   * or, where a list belongs, as many as that has. It gets a position and, of loads and `where`,
   * the outward normal (3 coordinates each) and fills up to three values; it is called by the
   * thread that updates the filter alone. An empty one takes the name away. Not a property: no file
   * and no state has it.
   */
  VTK_WRAPEXCLUDE void SetFunction(const std::string& name,
    std::function<void(const double* position, const double* normal, double* values)> function);

  ///@{
  /** Conductivity of what the problem gives no material. Default 1, valid range [1e-100,
   * 1e100]. For Equation POISSON. Group "Material". */
  vtkSetClampMacro(Conductivity, double, 1e-100, 1e100);
  vtkGetMacro(Conductivity, double);
  ///@}
  ///@{
  /** Elastic modulus (Young's) of what the problem gives no material. Default 1, valid range
   * [1e-100, 1e100]. For Equation ELASTICITY. Group "Material". */
  vtkSetClampMacro(YoungsModulus, double, 1e-100, 1e100);
  vtkGetMacro(YoungsModulus, double);
  ///@}
  ///@{
  /** Lateral contraction (Poisson's ratio) of what the problem gives no material. Default 0.3,
   * valid range [-0.99, 0.4999]. For Equation ELASTICITY. Group "Material". */
  vtkSetClampMacro(PoissonsRatio, double, -0.99, 0.4999);
  vtkGetMacro(PoissonsRatio, double);
  ///@}
  ///@{
  /** Unknowns up to which the system is factorized, a tenth of it on one tensor-product volume;
   * above, conjugate gradients solve it. Default 300000, valid range >= 0. Advanced. */
  vtkSetClampMacro(DirectLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(DirectLimit, int);
  ///@}
  ///@{
  /** Residual over right-hand side at which conjugate gradients stop. Default 1e-12, valid range
   * [1e-15, 0.1]. Advanced. */
  vtkSetClampMacro(Tolerance, double, 1e-15, 0.1);
  vtkGetMacro(Tolerance, double);
  ///@}

protected:
  vtkAnalysisAlgorithm();
  ~vtkAnalysisAlgorithm() override;
  /** The properties, for one solution. @return InvalidParameter, FileError of the problem's text.
   */
  knotwork::Result<knotwork::AnalysisOptions> MakeOptions() const;

private:
  vtkAnalysisAlgorithm(const vtkAnalysisAlgorithm&) = delete;
  void operator=(const vtkAnalysisAlgorithm&) = delete;

  struct NamedFunctions;
  std::unique_ptr<NamedFunctions> Functions;
  int Equation = POISSON;
  int Plane = STRESS;
  char* Problem = nullptr;
  char* ProblemFile = nullptr;
  double Conductivity = 1.0;
  double YoungsModulus = 1.0;
  double PoissonsRatio = 0.3;
  int DirectLimit = 300000;
  double Tolerance = 1e-12;
};
#endif
