// SPDX-License-Identifier: BSD-3-Clause
#include "Messages.h"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <cctype>
#include <regex>

namespace knotwork
{
namespace
{
/// "ERROR: In file.cxx, line 1\nvtkClass (0x1): text\n\n" becomes "text" on one line.
std::string PlainText(const std::string& message)
{
  static const std::regex place(R"(^[A-Za-z ]*: In [^\n]*, line \d+\s*)");
  static const std::regex object(R"(\bvtk\w+ ?\((0x[0-9a-fA-F]+|nil|\(nil\))\):? ?)");
  static const std::regex pointer(R"( ?\(?0x[0-9a-fA-F]{6,}\)?)");
  // expressions are for the beginning: a message is short, what it shows of a file may not be
  constexpr std::size_t most = 4000;
  std::string source = std::regex_replace(message.substr(0, most), place, "");
  source = std::regex_replace(source, object, "");
  source = std::regex_replace(source, pointer, "");
  std::string text;
  for (char c : source)
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
  while (!text.empty() && (text.back() == ' ' || text.back() == '.'))
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
  void DisplayWarningText(const char* text) override { this->Warnings.push_back(PlainText(text)); }
  void DisplayGenericWarningText(const char* text) override { this->DisplayWarningText(text); }

  std::string Error;
  std::vector<std::string> Warnings;
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

std::vector<std::string> MessageCapture::Warnings() const
{
  return Current()->Warnings;
}
}
