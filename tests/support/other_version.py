# SPDX-License-Identifier: BSD-3-Clause
"""Copies the plugin, as the server's, with another version in it:
    other_version.py PLUGIN VERSION COPY"""

import pathlib
import sys

plugin, version, copy = sys.argv[1:]
other = "".join("9" if letter.isdigit() else letter for letter in version)
content = pathlib.Path(plugin).read_bytes()
old, new = (b"\0" + text.encode() + b"\0" for text in (version, other))
assert old in content and len(old) == len(new), f"{plugin} holds its version, {version}"
pathlib.Path(copy).parent.mkdir(parents=True, exist_ok=True)
pathlib.Path(copy).write_bytes(content.replace(old, new))
