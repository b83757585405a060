#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of gallery.md, by running its code, in docs/images/gallery:

    python3 docs/make_gallery.py [BUILD]

It needs pvbatch, mpirun and xvfb-run. Two ranks run the code in a folder of its own. The pictures get 256 colors."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
LIMIT = 60000  # bytes of a picture


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "build").resolve()
    page = (HERE / "gallery.md").read_text(encoding="utf-8")
    code = "\n".join(re.findall(r"^```python\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL))
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "build").symlink_to(build)
        script = pathlib.Path(folder) / "gallery.py"
        script.write_text(code, encoding="utf-8")
        ranks = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-np", "2"]
        if os.geteuid() == 0:
            ranks.insert(1, "--allow-run-as-root")
        subprocess.run(["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24", *ranks, "pvbatch", str(script)],
                       cwd=folder, check=True)
        for name in sorted(re.findall(r"images/gallery/([\w]+\.png)", page)):
            made = HERE / "images" / "gallery" / name
            subprocess.run(["convert", str(pathlib.Path(folder) / name), "+dither", "-colors", "256", "-strip",
                            f"PNG8:{made}"], check=True)
            size = made.stat().st_size
            print(f"{name}: {size} bytes")
            assert size <= LIMIT, f"{name} is larger than {LIMIT} bytes"


main()
