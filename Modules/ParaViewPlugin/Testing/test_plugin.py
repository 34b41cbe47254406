# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads into pvbatch, and every proxy of the modules' XML files can be made and is in the Knotwork menus."""
import glob
import os
import sys
import xml.etree.ElementTree as ElementTree

import knotwork_testing

knotwork_testing.load_plugin()
from paraview import servermanager  # noqa: E402


def proxies():
    found = []
    for path in sys.argv[1:]:
        for group in ElementTree.parse(path).getroot().findall("ProxyGroup"):
            found += [(group.get("name"), proxy.get("name"), proxy.get("class"))
                      for tag in ("SourceProxy", "WriterProxy") for proxy in group.findall(tag)]
    return found


def test_every_proxy_makes_its_class():
    assert proxies()
    manager = servermanager.ProxyManager()
    for group, name, class_name in proxies():
        proxy = manager.NewProxy(group, name)
        assert proxy, f"no proxy {group}/{name}"
        proxy.UpdateVTKObjects()
        made = proxy.GetClientSideObject()
        assert made and made.GetClassName() == class_name, f"{group}/{name} made {made}"
        print(group, name, class_name)


def test_sources_and_filters_have_constructors():
    import paraview.simple as simple

    for group, name, _ in proxies():
        if group in ("sources", "filters"):
            label = servermanager.ProxyManager().GetPrototypeProxy(group, name).GetXMLLabel()
            function = servermanager._make_name_valid(label)
            assert hasattr(simple, function), f"paraview.simple has no {function}"


knotwork_testing.main(globals())
