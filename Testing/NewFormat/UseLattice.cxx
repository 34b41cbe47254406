// SPDX-License-Identifier: BSD-3-Clause
// usage: UseLattice FOLDER. A surface goes to a lattice and comes back, by the ending of the name.
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/FileFormats.h>

#include "vtkDataSet.h"

#include <fstream>
#include <iostream>
#include <sstream>

namespace
{
std::string TextOf(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}
}

int main(int, char** words)
{
  const std::string folder = words[1];
  const std::string text =
    "lattice 3 2\n 0  0  0\n 1  0  0\n 2  0  1\n 0  1  0\n 1  1  0\n 2  1 -1\n";
  std::ofstream(folder + "/given.lat") << text;
  const auto read = knotwork::ReadDataFile(folder + "/given.lat");
  const auto written =
    knotwork::WriteDataFile(read ? read->Data : nullptr, folder + "/written.lat");
  const auto refused = knotwork::ReadDataFile(folder + "/given.latt");
  std::ofstream(folder + "/damaged.lat") << "lattice 3 2\n 0 0 zero\n";
  const auto damaged = knotwork::ReadDataFile(folder + "/damaged.lat");
  std::cerr << read.Status.Detail << written.Status.Detail << damaged.Status.Detail << '\n';
  return read && written && TextOf(folder + "/written.lat") == text && !refused && !damaged &&
      damaged.Status.Code == knotwork::ErrorCode::InvalidFormat &&
      knotwork::SuggestEnding(".latt", knotwork::EndingsThatRead(knotwork::AnyContent)) ==
        " (did you mean '.lat'?)"
    ? 0
    : 1;
}
