#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds the rows of properties that proxies have to the page of properties, and compares the result with
docs/properties.md. Called as
    make_properties.py PAGE PROJECT OUTPUT DEFINITIONS...
PAGE is the page with {names} in place of rows, DEFINITIONS are the build's definitions of proxies. Fails with the
difference; OUTPUT is then the page to copy to docs/."""

import difflib
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

PAGE, PROJECT, OUTPUT, *DEFINITIONS = (pathlib.Path(path) for path in sys.argv[1:])
SHARED = ("BlendMode", "ScalarOpacityUnitDistance", "InterpolationType", "Shade", "VolumeAnisotropy",
          "UseSeparateOpacityArray", "OpacityArrayName", "OpacityComponent", "IsosurfaceValues", "UseTransfer2D",
          "UseGradientForTransfer2D", "ColorArray2Name", "ColorArray2Component")  # of ParaView's Volume
# The table of a property is the first whose pattern matches its proxy and name. Rows are in the order of definitions.
TABLES = {
    "clipping": r".*:DSM(Clip|Crop|Cap)\w*",
    "slices": r"DSMTracedImage:DSMSlice[XPON]\w*|DSMSliceRepresentation:DSM\w*",
    "isosurfaces": r"DSM(TracedImage|IsosurfaceRepresentation):DSM(?!Slice[YZ])\w*",
    "volumes": r"DSMVolumeRepresentation:(DSM\w*|" + "|".join(SHARED) + ")",
    "meshes": r"DSMGeometryRepresentation:DSM\w*",
    "results": r"DSMFrameReport:DSM(?!Suggested|SlicePoints)\w*",
}
FROM_DATA = {"mid": "center of the data", "data_bounds": "bounds of the data",
             "approximate_cell_length": "size of a cell"}


def read_tables():
    """Returns the properties of each table, by name, with their definitions."""
    tables = {table: {} for table in TABLES}
    for path in DEFINITIONS:
        for proxy in ElementTree.parse(path).iterfind("ProxyGroup/*"):
            for element in proxy.iterfind("*[Documentation]"):
                place = f"{proxy.get('name')}:{element.get('name')}"
                table = next((name for name, pattern in TABLES.items() if re.fullmatch(pattern, place)), None)
                if table:
                    tables[table].setdefault(element.get("name"), element)
    return tables


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
        hasCells = any(domain.get("input_domain_name") == "input_array_values" for domain in element)
        values = "point or cell array" if hasCells else "point array"
        default = "None" if "None" in default else "from the data"
    if default == "none":
        default = "from the data"
    return (default or "empty"), values


def write_rows(properties, isResult):
    rows = []
    for name, element in properties.items():
        label = element.get("label") or re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
        meaning = " ".join(element.find("Documentation").text.split())
        default, values = describe(element)
        if element.get("information_only"):
            default, values = "", "read only"
        cells = [f"`{name}`", meaning] if isResult else [label, f"`{name}`", default, values, meaning]
        rows.append(f"| {' | '.join(cells)} |\n")
    return "".join(rows)


def main():
    page = PAGE.read_text(encoding="utf-8")
    for table, properties in read_tables().items():
        assert properties, f"properties of {table} are defined"
        page = page.replace("{" + table + "}\n", write_rows(properties, table == "results") + "\n")
    OUTPUT.write_text(page, encoding="utf-8")
    kept = PROJECT / "docs" / "properties.md"
    difference = list(difflib.unified_diff(
        kept.read_text(encoding="utf-8").splitlines(), page.splitlines(), str(kept), str(OUTPUT), lineterm=""))
    print("\n".join(difference) or f"ok: {kept} is up to date")
    sys.exit(1 if difference else 0)


main()
