// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>

namespace knotwork
{
/// Reads an OFF mesh (text; comments from # to the end of a line; colours after faces are not
/// looked at). Points in double precision.
/// @return InvalidFormat naming the file and what is wrong: another header, missing or damaged
/// numbers, corners that are no points.
Result<vtkSmartPointer<vtkPolyData>> ReadOffFile(const std::string& file);
}
