#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the reference from the headers, without a warning, and looks for a page that says what it is
for each class that applications may use.
    check_reference.py SOURCE BUILD"""

import html
import pathlib
import re
import subprocess
import sys

source, build = (pathlib.Path(path) for path in sys.argv[1:3])
made = subprocess.run(
    ["cmake", "--build", str(build), "--target", "api_documentation"],
    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
)
print(made.stdout)
assert made.returncode == 0, "the reference is made without a warning"

pages = build / "doc" / "html"
assert (pages / "index.html").is_file()
exported = re.compile(r"^class VTKRENDERINGDSM_EXPORT (\w+)", re.MULTILINE)
names = set()
made = (build / "vtk_modules" / "RenderingDSM").glob("vtkDSM*Options.h")
for header in (*(source / "vtk_modules" / "RenderingDSM").rglob("*.h"), *made):
    text = header.read_text()
    for name in exported.findall(text):
        names.add(name)
        brief = re.search(r"@brief\s+(.+)", text).group(1)
        page = html.unescape((pages / f"class{name}.html").read_text())
        assert " ".join(brief.split()) in " ".join(re.sub("<[^>]+>", "", page).split()), f"{name}: {brief}"
assert {"vtkDSMScene", "vtkDSMLightOptions", "vtkDSMMemoryOptions", "vtkDSMVolumeMapper",
        "vtkDSMPolyDataMapper"} <= names, names
print(f"{len(names)} classes have their pages: {' '.join(sorted(names))}")
