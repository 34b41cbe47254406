# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads into pvbatch: its proxies can be made, replace none of ParaView's own, are enabled by every type of
input that they take, and show their main output alone after Apply."""
import sys
import xml.etree.ElementTree as ElementTree

import knotwork_testing
import paraview.simple as simple
from paraview import servermanager
from vtkmodules.vtkCommonDataModel import vtkDataObject


def definitions():
    """Class and label of every proxy that ParaView knows, by group and name."""
    iterator = servermanager.ProxyManager().GetProxyDefinitionManager().NewIterator()
    found = {}
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        element = iterator.GetProxyDefinition()
        key = (iterator.GetGroupName(), iterator.GetProxyName())
        found[key] = (element.GetAttribute("class"), element.GetAttribute("label"))
        iterator.GoToNextItem()
    return found


BEFORE = definitions()
FUNCTIONS = set(dir(simple))
knotwork_testing.load_plugin()


def proxies():
    """Group and XML element of each proxy of ours."""
    return [(group.get("name"), proxy) for path in sys.argv[1:]
            for group in ElementTree.parse(path).getroot().findall("ProxyGroup") for proxy in group]


def new_proxy(group, element):
    proxy = servermanager.ProxyManager().NewProxy(group, element.get("name"))
    assert proxy, f"no proxy {group}/{element.get('name')}"
    proxy.UpdateVTKObjects()
    return proxy


def test_every_proxy_makes_its_class():
    assert proxies()
    for group, element in proxies():
        made = new_proxy(group, element).GetClientSideObject()
        assert made and made.GetClassName() == element.get("class"), f"{group}/{element.get('name')} made {made}"


def function_name(label):
    return servermanager._make_name_valid(label)


def test_sources_and_filters_have_constructors():
    for group, element in proxies():
        if group in ("sources", "filters"):
            assert hasattr(simple, function_name(element.get("label"))), element.get("label")


def test_no_proxy_of_paraview_is_replaced():
    ours = {(group, element.get("name")) for group, element in proxies()}
    assert not ours & set(BEFORE), ours & set(BEFORE)
    after = definitions()
    assert set(after) == set(BEFORE) | ours, (set(after) ^ set(BEFORE)) - ours
    assert all(after[key] == value for key, value in BEFORE.items())
    assert len(BEFORE) > 500, len(BEFORE)
    functions = {function_name(element.get("label")) for group, element in proxies() if group in ("sources", "filters")}
    assert not functions & FUNCTIONS, functions & FUNCTIONS


def sources():
    """A source and port of every type that an input of ours can ask for."""
    square = simple.KnotworkSplineSource()
    group = simple.GroupDatasets(Input=[square])  # a partitioned dataset collection
    points = {"vtkPolyData": [simple.Line(), simple.Sphere()], "vtkUnstructuredGrid": [square],
              "vtkPartitionedDataSetCollection": [group], "vtkSelection": [simple.IDSelectionSource()],
              "vtkTable": [simple.ProgrammableSource(OutputDataSetType="vtkTable")], "vtkImageData": [simple.Wavelet()]}
    points["vtkPointSet"] = points["vtkPolyData"] + points["vtkUnstructuredGrid"]
    points["vtkDataSet"] = points["vtkPointSet"] + points["vtkImageData"]
    for proxy in {id(proxy): proxy for several in points.values() for proxy in several}.values():
        proxy.UpdatePipeline()
    return points


def test_every_type_of_input_enables_its_filter():
    # as ParaView's menu decides: by the property named Input, else by the first one by the alphabet
    of_type = sources()
    checked = 0
    for group, element in proxies():
        inputs = element.findall("InputProperty")
        if not inputs:
            continue
        name = element.get("name")
        assert inputs[0].get("name") == "Input" and inputs[0].get("port_index", "0") == "0", name
        for declared in inputs:
            for kind in [entry.get("value") for entry in declared.iter("DataType")]:
                for source in of_type[kind]:
                    proxy = new_proxy(group, element)
                    asked = proxy.GetProperty(declared.get("name"))
                    asked.RemoveAllUncheckedProxies()
                    asked.AddUncheckedInputConnection(source.SMProxy, 0)
                    assert asked.IsInDomains(), (name, declared.get("name"), kind)
                    checked += 1
        refused = new_proxy(group, element).GetProperty("Input")
        refused.AddUncheckedInputConnection(of_type["vtkSelection"][0].SMProxy, 0)
        assert not refused.IsInDomains(), name
    assert checked > 40, checked


def test_one_output_is_shown_and_it_is_no_table():
    controller = servermanager.vtkSMParaViewPipelineControllerWithRendering()
    several = 0
    for group, element in proxies():
        proxy = new_proxy(group, element)
        if not proxy.IsA("vtkSMSourceProxy") or element.tag == "WriterProxy":
            continue
        algorithm = proxy.GetClientSideObject()
        ports = range(algorithm.GetNumberOfOutputPorts())
        # ParaView shows every output that it is not told to leave out, and a table takes the view
        shown = [port for port in ports if controller.GetPreferredViewType(proxy, port) != "None"]
        assert len(shown) == 1, (element.get("name"), shown)
        kind = algorithm.GetOutputPortInformation(shown[0]).Get(vtkDataObject.DATA_TYPE_NAME())
        assert kind != "vtkTable", element.get("name")
        several += len(ports) > 1
    assert several >= 12, several


knotwork_testing.main(globals())
