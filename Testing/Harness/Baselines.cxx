// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace knotwork
{

namespace
{

/// An image of width 0 when the file cannot be read.
Image ReadPng(const std::string& path)
{
  Image image;
  vtkNew<vtkPNGReader> reader;
  if (!std::filesystem::exists(path) || !reader->CanReadFile(path.c_str()))
  {
    return image;
  }
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* data = reader->GetOutput();
  const int components = data->GetNumberOfScalarComponents();
  if (data->GetScalarType() != VTK_UNSIGNED_CHAR || components < 3)
  {
    return image;
  }
  image.Width = data->GetDimensions()[0];
  image.Height = data->GetDimensions()[1];
  image.Rgb.reserve(3 * static_cast<size_t>(image.Width) * image.Height);
  const auto* pixel = static_cast<const unsigned char*>(data->GetScalarPointer());
  for (int i = 0; i < image.Width * image.Height; ++i, pixel += components)
  {
    image.Rgb.insert(image.Rgb.end(), pixel, pixel + 3);
  }
  return image;
}

/// Differing pixels black on a pale copy of the picture.
void WriteDifference(const Image& image, const ImageDifference& difference, const std::string& path)
{
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.Width, image.Height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<unsigned char*>(data->GetScalarPointer());
  for (size_t i = 0; i < image.Rgb.size(); ++i)
  {
    out[i] = difference.Differs[i / 3] ? 0 : static_cast<unsigned char>(191 + image.Rgb[i] / 4);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(path.c_str());
  writer->Write();
}

}

std::string CompareWithBaseline(
  const std::string& rendering, const std::string& baseline, const ImageLimits& limits)
{
  const auto stem = std::filesystem::path(rendering).replace_extension();
  const std::string differencePath = stem.string() + ".difference.png";
  const std::string markPath = stem.string() + ".rejected";
  std::error_code ignored; // they need not exist
  std::filesystem::remove(differencePath, ignored);
  std::filesystem::remove(markPath, ignored);

  const Image image = ReadPng(rendering);
  if (image.Width == 0)
  {
    return "no picture at " + rendering;
  }
  std::ostringstream problem;
  const Image reference = ReadPng(baseline);
  if (reference.Width == 0)
  {
    problem << "no baseline at " << baseline;
  }
  else
  {
    const ImageDifference difference = CompareImages(image, reference, limits);
    if (difference.Within(limits))
    {
      return {};
    }
    if (!difference.SameSize)
    {
      problem << rendering << " has " << image.Width << " x " << image.Height << " pixels, "
              << baseline << " has " << reference.Width << " x " << reference.Height;
    }
    else
    {
      WriteDifference(image, difference, differencePath);
      problem << rendering << " differs from " << baseline << " in " << 100 * difference.Share
              << " % of the pixels (limit " << 100 * limits.Share
              << " %), in the worst 16 x 16 block at (" << difference.BlockColumn << ", "
              << difference.BlockRow << ") in " << difference.WorstBlock << " (limit "
              << limits.WorstBlock << "); see " << differencePath;
    }
  }
  std::ofstream(markPath) << baseline << "\n";
  return problem.str();
}

}
