// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineAlgorithm
 * @brief   base of the filters that take spline grids
 *
 * Input 0 is a vtkUnstructuredGrid of Bezier cells (a spline grid or one of foreign origin) or a
 * vtkPartitionedDataSetCollection of such grids; output 0 has the same type where the filter keeps
 * spline grids. Derived classes implement Compute(); this class turns kernel statuses and
 * exceptions of libraries into one VTK error, sets the error code (vtkErrorCode::UserError + code
 * of the kernel), clears the outputs on failure, and connects progress and abort. In several
 * processes (MPI) filters that need the whole of their inputs fail (InvalidTopology), in one
 * message, when more than one process has data (see DistributedInput.h); the others give empty
 * outputs.
 */
#ifndef vtkSplineAlgorithm_h
#define vtkSplineAlgorithm_h
#include "vtkDataObjectAlgorithm.h"
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>  // for knotwork::Status
#include <knotwork/SplineCore/Types.h>   // for knotwork::ProgressCallback

#include "vtkSmartPointer.h" // for inputs

#include <string> // for warnings
#include <vector> // for warnings

namespace knotwork
{
struct SplineModel;
}

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkSplineAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Threads of the kernel; 0: all cores, one under MPI. Results do not depend on it. Default 0,
   * valid range [0, 1024]. Advanced. */
  vtkSetClampMacro(Threads, int, 0, 1024);
  vtkGetMacro(Threads, int);
  ///@}

  ///@{
  /** Parts of its file that a reader could not take at the last update, one sentence each; a
   * warning says the same. None from filters. */
  int GetNumberOfPartsLeftOut() const { return static_cast<int>(this->LeftOut.size()); }
  std::string GetPartLeftOut(int i) const;
  ///@}

protected:
  vtkSplineAlgorithm();
  ~vtkSplineAlgorithm() override = default;

  /** The three acts of the filter. A Status other than Ok becomes the filter's error. */
  virtual knotwork::Status Compute(
    vtkInformationVector** inputs, vtkInformationVector* outputs) = 0;

  /**
   * Whether the result for a piece of the inputs is that piece of the result for the whole. Those
   * that return true are called with pieces, the others never.
   */
  virtual bool WorksOnPieces() const { return false; }

  /**
   * Whether pieces of several processes make numbers of the whole together: those that return true
   * (and work on pieces) have Gather called before and Merge called after Compute, in all processes
   * at once, those without data too, and may exchange there what they need (Processes.h). What
   * fails in one of them fails in all. A piece that one process is asked for is refused as where
   * the whole is needed.
   */
  virtual bool SumsUpPieces() const { return false; }
  virtual knotwork::Status Gather(vtkInformationVector**) { return {}; }
  virtual knotwork::Status Merge(vtkInformationVector**, vtkInformationVector*) { return {}; }

  /** Of filters that work on pieces: the port of an input that every process needs whole; where one
   * process has it, it is sent to the others. -1: none. */
  virtual int WholeInputPort() const { return -1; }
  /** What stands at that port, for Compute. */
  vtkDataObject* WholeInput(vtkInformationVector** inputs) const;

  /** Reports progress to the pipeline and stops the kernel when the filter is asked to abort. */
  knotwork::ProgressCallback Progress();
  /** The spline grids of an input; shows what DecodeSplineModel found worth knowing. */
  knotwork::Result<knotwork::SplineModel> DecodeInput(vtkDataObject* input);
  /** Shows one VTK warning each. */
  void ReportWarnings(const std::vector<std::string>& warnings);
  /** Shows what a reader left out, one VTK warning each, and keeps it for GetPartLeftOut. */
  void ReportLeftOut(const std::vector<std::string>& parts);
  /** Threads to hand to kernels: the property, or one under MPI when it is 0. */
  int KernelThreads() const;

  /** What an input port takes: data of one of these classes. */
  struct InputType
  {
    std::vector<std::string> Classes;
    bool IsOptional = false;
  };
  static InputType Splines(); ///< spline grids and collections of them
  static InputType Meshes();  ///< polygons, or cells
  static InputType Shapes();  ///< meshes, spline grids, collections of them
  static InputType Optional(InputType type);
  /** For the constructor: one input port a type. Without it there is one, of splines. */
  void SetInputTypes(std::vector<InputType> types);
  /** For the constructor: one output a type, always of that type. */
  void SetOutputTypes(std::vector<std::string> types);
  /** Makes output `port` an empty object of a class, unless it is one. */
  static void MakeOutput(vtkInformationVector* outputs, int port, const char* type);
  /** The same of an input's class; nothing without an input. */
  static void MakeOutputLike(vtkInformationVector* outputs, int port, vtkDataObject* input);
  /** The same for all ports, of the types that FillOutputPortInformation tells. @return 1. */
  int MakeDeclaredOutputs(vtkInformationVector* outputs);

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  /** Outputs of the types that were set, else output 0 of the input's type. */
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int Threads = 0;

private:
  vtkSmartPointer<vtkDataObject> Whole; ///< while RequestData runs
  std::vector<std::string> LeftOut;
  std::vector<InputType> InputTypes;
  std::vector<std::string> OutputTypes;
  vtkSplineAlgorithm(const vtkSplineAlgorithm&) = delete;
  void operator=(const vtkSplineAlgorithm&) = delete;
};
#endif
