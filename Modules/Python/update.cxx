// SPDX-License-Identifier: BSD-3-Clause
// knotwork._update: brings an algorithm up to date without Python's lock, so that other Python
// threads go on meanwhile. VTK 9.1 keeps the lock for the whole of Update(). Observers in Python,
// and the functions that a problem has, take it themselves while they run.
#include "vtkPython.h" // before all others

#include <knotwork/SplineAnalysis/vtkAnalysisAlgorithm.h>

#include "vtkAlgorithm.h"
#include "vtkPythonUtil.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace
{
/// Python's lock, while it lives.
class Lock
{
public:
  Lock() : State(PyGILState_Ensure()) {}
  ~Lock() { PyGILState_Release(this->State); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

private:
  PyGILState_STATE State;
};

void Release(PyObject* object)
{
  if (Py_IsInitialized())
  {
    const Lock lock;
    Py_DECREF(object);
  }
}

/// Calls function(x, y, z, nx, ny, nz) for three numbers; it must not raise.
void CallFunction(PyObject* function, const double* position, const double* normal, double* values)
{
  const Lock lock;
  PyObject* const returned = PyObject_CallFunction(
    function, "dddddd", position[0], position[1], position[2], normal[0], normal[1], normal[2]);
  if (!returned || !PyArg_ParseTuple(returned, "ddd", &values[0], &values[1], &values[2]))
  {
    PyErr_WriteUnraisable(function);
    std::fill(values, values + 3, std::numeric_limits<double>::quiet_NaN());
  }
  Py_XDECREF(returned);
}

PyObject* SetFunction(PyObject*, PyObject* arguments)
{
  PyObject* object = nullptr;
  const char* name = nullptr;
  PyObject* function = nullptr;
  if (!PyArg_ParseTuple(arguments, "OsO", &object, &name, &function))
  {
    return nullptr;
  }
  auto* algorithm = vtkAnalysisAlgorithm::SafeDownCast(
    vtkPythonUtil::GetPointerFromObject(object, "vtkAnalysisAlgorithm"));
  if (!algorithm)
  {
    return nullptr; // the exception is set
  }
  Py_INCREF(function);
  const std::shared_ptr<PyObject> held(function, Release);
  algorithm->SetFunction(name,
    [held](const double* position, const double* normal, double* values)
    { CallFunction(held.get(), position, normal, values); });
  Py_RETURN_NONE;
}

PyObject* Update(PyObject*, PyObject* argument)
{
  auto* algorithm =
    vtkAlgorithm::SafeDownCast(vtkPythonUtil::GetPointerFromObject(argument, "vtkAlgorithm"));
  if (!algorithm)
  {
    return nullptr; // the exception is set
  }
  Py_BEGIN_ALLOW_THREADS algorithm->Update();
  Py_END_ALLOW_THREADS Py_RETURN_NONE;
}

PyMethodDef Methods[] = { { "update", Update, METH_O,
                            "update(algorithm): algorithm.Update() without Python's lock." },
  { "set_function", SetFunction, METH_VARARGS,
    "set_function(algorithm, name, function): what a problem names as @name." },
  { nullptr, nullptr, 0, nullptr } };

PyModuleDef Definition = { PyModuleDef_HEAD_INIT, "_update", nullptr, -1, Methods, nullptr, nullptr,
  nullptr, nullptr };
}

// the name that Python looks for
// NOLINTNEXTLINE(readability-identifier-naming,bugprone-reserved-identifier)
PyMODINIT_FUNC PyInit__update()
{
  return PyModule_Create(&Definition);
}
