// SPDX-License-Identifier: BSD-3-Clause
#include "Messages.h"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <cctype>

namespace knotwork
{
namespace
{
/// "ERROR: In file.cxx, line 1\nvtkClass (0x1): text\n\n" becomes "text" on one line.
std::string PlainText(const std::string& message)
{
  std::size_t begin = message.find("): ");
  begin = begin == std::string::npos ? 0 : begin + 3;
  std::string text;
  for (char c : message.substr(begin))
  {
    if (std::isspace(static_cast<unsigned char>(c)))
    {
      if (!text.empty() && text.back() != ' ')
      {
        text += ' ';
      }
      continue;
    }
    text += c;
  }
  while (!text.empty() && text.back() == ' ')
  {
    text.pop_back();
  }
  return text;
}

class CaptureWindow : public vtkOutputWindow
{
public:
  static CaptureWindow* New();
  vtkTypeMacro(CaptureWindow, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override
  {
    // the pipeline repeats that an algorithm failed; the first message says why
    if (this->Error.empty())
    {
      this->Error = PlainText(text);
    }
  }
  void DisplayWarningText(const char* text) override { this->Warning += PlainText(text) + "\n"; }
  void DisplayGenericWarningText(const char* text) override { this->DisplayWarningText(text); }

  std::string Error;
  std::string Warning;
};
vtkStandardNewMacro(CaptureWindow);

CaptureWindow* Current()
{
  return CaptureWindow::SafeDownCast(vtkOutputWindow::GetInstance());
}
}

MessageCapture::MessageCapture()
{
  vtkSmartPointer<CaptureWindow> window = vtkSmartPointer<CaptureWindow>::New();
  vtkOutputWindow::SetInstance(window);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF); // it repeats what the window is told
}

MessageCapture::~MessageCapture()
{
  vtkOutputWindow::SetInstance(nullptr);
}

bool MessageCapture::HasError() const
{
  return !Current()->Error.empty();
}

std::string MessageCapture::FirstError() const
{
  return Current()->Error;
}

std::string MessageCapture::Warnings() const
{
  return Current()->Warning;
}
}
