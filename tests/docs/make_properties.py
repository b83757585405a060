#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds the rows of properties that xml/ defines to the page of properties, and compares the result with
docs/properties.md. Called as
    make_properties.py PAGE PROJECT OUTPUT
PAGE is the page with {names} in place of rows. Fails with the difference; OUTPUT is then the page to copy to docs/."""

import difflib
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

PAGE, PROJECT, OUTPUT = (pathlib.Path(path) for path in sys.argv[1:])
SHARED = ("ScalarOpacityUnitDistance", "Shade", "VolumeAnisotropy", "UseSeparateOpacityArray", "OpacityArrayName",
          "OpacityComponent", "IsosurfaceValues")  # of ParaView's Volume
# Rows in the order of the definitions.
TABLES = {
    "isosurfaces": r"DSMShow|DSM(IsoArray|IsoComponent|IgnoreValues|ValidRange|IsoValue|ValueRange)\w*",
    "volumes": r"BlendMode|DSMScattering|" + "|".join(SHARED),
    "slices": r"DSMSlice(X|XIndex|XIndices|Plane|Origin|Normal|OpacityFromMap|Interpolate|Lighting)",
    "clipping": r"DSM(Clip|Crop|Cap)\w*",
    "meshes": r"DSMShowEdges|DSMLineRadius|DSMPointRadius|DSMRadiusArray",
    "results": r"DSM(FrameTime|Statistics|StatisticsSummary|Samples)",
}
FROM_DATA = {"mid": "center of the data", "data_bounds": "bounds of the data",
             "approximate_cell_length": "size of a cell"}


def read_properties():
    properties = {}
    for name in ("dsm_image_properties.xml.in", "dsm_slice_properties.xml.in", "dsm_representations.xml.in",
                 "dsm_common_properties.xml.in", "dsm_geometry.xml.in"):
        text = (PROJECT / "xml" / name).read_text(encoding="utf-8")
        text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
        for element in ElementTree.fromstring(f"<all>{text}</all>").iter():
            documentation = element.find("Documentation")
            if element.tag.endswith("Property") and "name" in element.attrib and documentation is not None:
                properties.setdefault(element.attrib["name"], element)
    return properties


def describe(element):
    """The default and the valid values, in words."""
    default = element.get("default_values", "empty list")
    values = {"String": "text", "Int": "whole number", "Double": "number"}[element.tag.split("Vector")[0]]
    count = element.get("number_of_elements", "1")
    if element.get("repeat_command"):
        values = f"list of {values}s"
    elif values != "text" and int(count) > 1:
        values = f"{count} numbers"
    for domain in element:
        kind = domain.tag
        entries = {entry.get("value"): entry.get("text") for entry in domain.findall("Entry")}
        if kind == "BooleanDomain":
            values = "0, 1"
        elif entries:
            values = ", ".join(f'`"{text}"`' for text in entries.values())
            default = f'`"{entries[default]}"`' if default in entries else default
        elif kind.endswith("RangeDomain") and domain.get("min"):
            values = f"{domain.get('min')} to {domain.get('max')}"
        elif "ArrayDomain" in kind or kind == "ArrayListDomain":
            values = "point array"
        elif kind == "DSMSliceIndexDomain":
            default = default.replace("-1", "middle")
        if kind == "BoundsDomain":
            default = FROM_DATA[domain.get("default_mode") or domain.get("mode")]
    if element.get("element_types", "").startswith("0 0 0 0"):
        values, default = "point array", "None" if "None" in default else "from the data"
    if default == "none":
        default = "from the data"
    return (default or "empty"), values


def write_rows(properties, pattern, isResult):
    rows = []
    for name, element in properties.items():
        if re.fullmatch(pattern, name):
            label = element.get("label") or re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
            meaning = " ".join(element.find("Documentation").text.split())
            default, values = describe(element)
            if element.get("information_only"):
                default, values = "", "read only"
            cells = [f"`{name}`", meaning] if isResult else [label, f"`{name}`", default, values, meaning]
            rows.append(f"| {' | '.join(cells)} |\n")
    assert rows, f"properties of {pattern} are defined"
    return "".join(rows)


def main():
    properties = read_properties()
    page = PAGE.read_text(encoding="utf-8")
    for table, pattern in TABLES.items():
        page = page.replace("{" + table + "}\n", write_rows(properties, pattern, table == "results") + "\n")
    OUTPUT.write_text(page, encoding="utf-8")
    kept = PROJECT / "docs" / "properties.md"
    difference = list(difflib.unified_diff(
        kept.read_text(encoding="utf-8").splitlines(), page.splitlines(), str(kept), str(OUTPUT), lineterm=""))
    print("\n".join(difference) or f"ok: {kept} is up to date")
    unlisted = [name for name in properties
                if name.startswith("DSM") and f"`{name}`" not in page
                and not re.search(r"Slice[YZ]|SlicePoints|Suggested", name)]
    print("".join(f"{name} is in no table\n" for name in unlisted), end="")
    sys.exit(1 if difference or unlisted else 0)


main()
