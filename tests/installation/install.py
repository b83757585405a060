# SPDX-License-Identifier: BSD-3-Clause
"""Installs the build into an empty prefix.

usage: install.py CMAKE BUILD PREFIX
"""
import shutil
import subprocess
import sys


def main():
    cmake, build, prefix = sys.argv[1:]
    shutil.rmtree(prefix, ignore_errors=True)
    subprocess.run([cmake, "--install", build, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)


main()
