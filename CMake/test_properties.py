#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests properties.py on a header of its own: what is generated is what the header says (worked by hand), and a header that contradicts
itself in any one way is refused with the name of the property."""
import os
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import properties  # noqa: E402

HEADER = '''
class VTKX_EXPORT vtkThing : public vtkSplineAlgorithm
{
public:
  void PrintSelf(ostream& os, vtkIndent indent) override;
  enum Ways
  {
    SHORT_WAY = 0, ///< "Short" the first
    LONG_WAY,
    LBFGS =
      2, ///< "L-BFGS"
    OTHER ///< "Any other (xyz)"
  };
  ///@{
  /** How, one of Ways: LONG_WAY, or by MaxSteps. Default LONG_WAY. */
  vtkSetClampMacro(Way, int, SHORT_WAY, OTHER);
  vtkGetMacro(Way, int);
  ///@}
  ///@{
  /** Steps at most; 0: none. Default 7, valid range [0, 100]. Advanced. For Way LONG_WAY,
   * LBFGS. For Loud on. Group "Limits". */
  vtkSetClampMacro(MaxSteps, int, 0, 100);
  vtkGetMacro(MaxSteps, int);
  ///@}
  ///@{
  /** Length. Default 0.001, valid range >= 0. For Way not SHORT_WAY. */
  vtkSetClampMacro(Length, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Length, double);
  ///@}
  ///@{
  /** Whether it is loud. Default off. */
  vtkSetMacro(Loud, bool);
  vtkGetMacro(Loud, bool);
  ///@}
  ///@{
  /** The box. Default 0 1.5. Components from, to. */
  vtkSetVector2Macro(Box, double);
  vtkGetVector2Macro(Box, double);
  ///@}
  ///@{
  /** Name of it. Default empty. */
  vtkSetStringMacro(LRName);
  vtkGetStringMacro(LRName);
  ///@}

protected:
  int Way = LONG_WAY;
  int MaxSteps = 7;
  double Length = 1e-3;
  bool Loud = false;
  double Box[2] = { 0.0, 1.5 };
  char* LRName = nullptr;
  std::vector<double> Levels;
};
'''

PROXY = '''<ServerManagerConfiguration><ProxyGroup name="filters"><SourceProxy name="Thing" class="vtkThing">
  <Outputs names="Main Table"/>
  <Input name="Input" types="vtkPolyData vtkTable">The input.</Input>
  <DoubleVectorProperty name="Levels" components="a b" for="Way LONG_WAY"/>
  <Array name="Which" for="Way not LONG_WAY" index="1" arrays="some" none_string="None">An array.</Array>
  <Properties until="Length"/>
  <Array name="LRName" arrays="some" none_string="None"/>
  <Properties/>
</SourceProxy></ProxyGroup></ServerManagerConfiguration>'''

FAULTS = (  # in the header: what stands there, what shall stand there, what the message names
    ("Default 7", "Default 8", "MaxSteps: default is 8"),
    ("MaxSteps = 7", "MaxSteps = 6", "MaxSteps: default is 7"),
    ("[0, 100]", "[0, 10]", "MaxSteps: range"),
    ("0, 100);", "1, 100);", "MaxSteps: range"),
    (", valid range >= 0", "", "Length: range"),
    ("Default LONG_WAY", "Default SHORT_WAY", "Way: default"),
    ("SHORT_WAY, OTHER", "SHORT_WAY, ANOTHER", "Way: SHORT_WAY and ANOTHER"),
    ("Default off", "Default on", "Loud: default"),
    ("Default 0 1.5", "Default 0 1", "Box: default"),
    ("Components from, to", "Components from", "Box: 1 names of 2"),
    ("For Loud on", "For Laud on", "for Laud"),
    ("For Loud on", "For Loud yes", "for Loud yes"),
    ("For Way not SHORT_WAY", "For Way not SHORT", "for Way SHORT"),
    ("Advanced.", "Anyhow.", "MaxSteps: what does"),
    ('Group "Limits"', 'Group "Outputs"', "a group is not called Outputs"),
    ("Default empty.", "", "unnoticed"),
    ("Default off.", "", "Loud: the comment says no default"),
    ("  /** Whether it is loud. Default off. */\n", "", "Loud has no comment"),
    ("  bool Loud = false;\n", "", "Loud: no member"),
    ("(Length,", "(Longth,", "Longth: no member"),
)


JOB = '''const JobRegistration Registration{ "thing", "make a "
  "thing", "--way short", MakeJob<ThingJob> };'''


def put(folder, name, text):
    file = os.path.join(folder, name)
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(text)
    return file


def generated(folder, header_text):
    """All that is made of a header: text by name."""
    header = put(folder, "Modules/X/vtkThing.h", header_text)
    source = put(folder, "in.xml", PROXY)
    page = put(folder, "Modules/X/README.md", "a\n<!-- properties of vtkThing -->\n<!-- end -->\nb\n<!-- jobs -->\n<!-- end -->\n")
    put(folder, "Modules/CommandLine/ThingJob.cxx", JOB)
    readme = put(folder, "README.md", "| `vtkThing` | a thing |\n")
    out = {name: os.path.join(folder, name) for name in ("print.cxx", "options", "out.xml", "table.py")}
    for arguments in (("print-self", out["print.cxx"], header), ("options", out["options"], header),
                      ("proxies", out["out.xml"], source, header), ("python", out["table.py"], header), ("pages", folder)):
        fault = properties.main(*arguments)
        if fault:
            raise ValueError(fault)
    texts = {}
    for name in ("print.cxx", "options.cxx", "options.h", "out.xml", "table.py", "Modules/X/README.md"):
        with open(os.path.join(folder, name), encoding="utf-8") as stream:
            texts[os.path.basename(name)] = stream.read()
    check = ("pages", "--check", folder)
    assert properties.main(*check) == 0
    for file, text, message in ((page, texts["README.md"].replace("Steps at most", "Steps"), "not what headers"),
                                (page, texts["README.md"].replace("make a thing", "make things"), "not what headers"),
                                (page, "nothing", "no page has"), (readme, "| a | b |\n", "has no vtkThing"),
                                (readme, "| `vtkThing`, `vtkNothing` | b |\n", "vtkNothing, which is no class")):
        before = open(file, encoding="utf-8").read()
        put(folder, os.path.relpath(file, folder), text)
        assert message in str(properties.main(*check)), message
        put(folder, os.path.relpath(file, folder), before)
    return texts


def test_outputs(texts):
    printed = texts["print.cxx"]
    for line in ('"MaxSteps: " << this->MaxSteps << "\\n"', '"Box: " << this->Box[0] << " " << this->Box[1] << "\\n"',
                 '(this->LRName ? this->LRName : "(none)")', '"Levels: " << this->Levels.size()'):
        assert line in printed, line
    made = texts["options.cxx"]
    for text in ('"how: long-way, or by --maximum-steps"', '{ "short", "long-way", "lbfgs", "xyz" }',
                 "InRange(filter->GetLengthMinValue(), filter->GetLengthMaxValue())", "SetBox(v[0], v[1])", "v.c_str()"):
        assert text in made, text
    assert texts["options.h"].count("AddProperties(Options& options, vtkThing* filter);") == 1
    table = {}
    exec(texts["table.py"], table)
    table = table["PROPERTIES"]["vtkThing"]
    assert [names for names, _ in table["Way"][4]] == ["short", "long-way", "lbfgs", "xyz"] and table["Way"][4][0][1] == "SHORT_WAY"
    assert table["MaxSteps"] == ("int", 1, 0, 100, []) and table["Length"][2:4] == (0, None) and table["Box"][:2] == ("double", 2)
    row = "| `MaxSteps` | 7 | 0 to 100 | Steps at most; 0: none (with `Way` LONG_WAY, LBFGS; with `Loud` on) |"
    page = texts["README.md"]
    assert row in page and page.startswith("a\n") and page.endswith("<!-- end -->\n"), page
    assert "| `thing` | make a thing | `knotwork thing --way short` |" in page
    check_proxy(ElementTree.fromstring(texts["out.xml"].partition("\n")[2]).find(".//SourceProxy"))


def check_proxy(proxy):
    names = [child.get("name") for child in proxy if child.tag not in ("PropertyGroup", "Hints")]
    assert names == ["Main", "Table", "Input", "Levels", "Which", "Way", "MaxSteps", "LRName", "Length", "Loud", "Box"], names
    found = {child.get("name"): child for child in proxy}
    assert [entry.get("text") for entry in found["Way"].iter("Entry")] == ["Short", "Long Way", "L-BFGS", "Any other (xyz)"]
    assert found["Way"].get("default_values") == "1" and found["Box"].get("default_values") == "0 1.5"
    assert found["Way"].findtext("Documentation") == "How: Long Way, or by Max Steps."
    steps = found["MaxSteps"]
    assert steps.get("panel_visibility") == "advanced" and steps.find("IntRangeDomain").get("max") == "100"
    decorators = [each.attrib for each in steps.iter("PropertyWidgetDecorator") if each.get("property")]
    assert [(each["property"], each.get("values", each.get("value"))) for each in decorators] == [("Way", "1 2"), ("Loud", "1")]
    length = found["Length"]
    assert length.find("DoubleRangeDomain").get("min") == "0" and length.find("DoubleRangeDomain").get("max") is None
    assert length.find(".//PropertyWidgetDecorator").get("inverse") == "1"
    assert [each.get("label") for each in found["Box"].iter("ComponentLabel")] == ["from", "to"]
    assert [value.get("value") for value in found["Input"].iter("DataType")] == ["vtkPolyData", "vtkTable"]
    assert [each.get("label") for each in found["Levels"].iter("ComponentLabel")] == ["a", "b"]
    hidden = [found[name].find(".//PropertyWidgetDecorator").attrib for name in ("Levels", "Which")]
    assert [(each["property"], each["value"], each.get("inverse")) for each in hidden] == [("Way", "1", None), ("Way", "1", "1")]
    assert (found["Which"].get("command"), found["Which"].get("default_values")) == ("SetInputArrayToProcess", "1")
    array = found["LRName"]
    assert (array.get("command"), array.get("default_values"), array.findtext("Documentation")) == ("SetLRName", "None", "Name of it.")
    assert [(each.get("index"), each.get("id")) for each in proxy.iter("OutputPort")] == [("0", "port0"), ("1", "port1")]
    assert [each.get("port") for each in proxy.find("Hints").iter("View")] == ["1"]
    assert proxy.find("PropertyGroup").get("label") == "Limits"


KERNEL = '''constexpr double DefaultLength = 1e-3;
struct ThingParams
{
  ThingWay Way = ThingWay::LongWay;
  int Steps = 7; ///< at most
  double Length = DefaultLength;
};
'''

FILTER = '''ThingParams params;
  params.Way = static_cast<ThingWay>(this->Way);
  params.Steps = this->MaxSteps;
  params.Length = this->Length;
'''


def test_defaults_of_the_kernel():
    with tempfile.TemporaryDirectory() as folder:
        put(folder, "Modules/X/vtkThing.h", HEADER)
        put(folder, "Modules/X/vtkThing.cxx", FILTER)
        for old, new, message in (("", "", "0"), ("Steps = 7", "Steps = 8", "MaxSteps: default is 7, of the kernel's Steps 8"),
                                  ("1e-3", "1e-2", "of the kernel's Length 1e-2"), ("::LongWay", "::ShortWay", "Way: default is LONG_WAY")):
            put(folder, "Modules/X/Kernel/Thing.h", KERNEL.replace(old, new, 1))
            assert message in str(properties.main("defaults", folder)), message
        put(folder, "Modules/X/Kernel/Thing.h", KERNEL.replace("Steps = 7", "Steps = 8"))
        put(folder, "Modules/X/vtkThing.h", HEADER.replace('Group "Limits".', 'Group "Limits". Kernel default 8.'))
        assert properties.main("defaults", folder) == 0


def main():
    test_defaults_of_the_kernel()
    with tempfile.TemporaryDirectory() as folder:
        test_outputs(generated(folder, HEADER))
        for old, new, message in FAULTS:
            assert old in HEADER, old
            try:
                generated(folder, HEADER.replace(old, new, 1))
                fault = "unnoticed"
            except ValueError as error:
                fault = str(error)
            assert message in fault, f"{old} -> {new}: {fault}"
    print(f"{len(FAULTS)} faults planted")


if __name__ == "__main__":
    main()
