// SPDX-License-Identifier: BSD-3-Clause
// usage: CompareImages RENDERING.png BASELINE.png      exit status 0 agree, 1 differ, 2 wrong usage
#include "Baselines.h"

#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 3)
  {
    std::cerr << "usage: CompareImages RENDERING.png BASELINE.png\n";
    return 2;
  }
  const std::string problem = knotwork::CompareWithBaseline(argv[1], argv[2]);
  if (!problem.empty())
  {
    std::cerr << "CompareImages: " << problem << "\n";
    return 1;
  }
  return 0;
}
