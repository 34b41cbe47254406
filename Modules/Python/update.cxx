// SPDX-License-Identifier: BSD-3-Clause
// knotwork._update: brings an algorithm up to date without Python's lock, so that other Python
// threads go on meanwhile. VTK 9.1 keeps the lock for the whole of Update(). Observers in Python
// take it themselves while they run.
#include "vtkPython.h" // before all others

#include "vtkAlgorithm.h"
#include "vtkPythonUtil.h"

namespace
{
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
