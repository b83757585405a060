#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the fenced blocks of README.md and docs/**/*.md. Called as
    check_documents.py LANGUAGE PROJECT BUILD OUTPUT PVBATCH MPIRUN...

Blocks of one document and language are run in a folder of that document's, one after the other:
`python` in one pvbatch of two ranks, `bash` in a shell that stops at the first error, `cpp` through
the compiler with the flags of the tests. There, `build` is the build folder, `../examples` the
examples. LANGUAGE `marks` checks that every block has one of these languages, and that those which
are not run are named in not_run.txt and say so in the document; `links`, that what documents link to
within the project is there, with its heading; `style`, that pages are short and spelled as in America."""

import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

LANGUAGE, PROJECT, BUILD, OUTPUT, PVBATCH = sys.argv[1:6]
MPIRUN = sys.argv[6:]
HERE = os.path.dirname(os.path.abspath(__file__))
LANGUAGES = ("python", "bash", "cpp")
# Of a block that is not run, on the line before it.
MARK = re.compile(r"\*Not run by the tests: (.+)\.\*")
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ +(.+)$", re.MULTILINE)
# Lines that a page may have; 250 where it is not named.
LENGTHS = {"README.md": 120, "docs/performance.md": 100, "docs/limits.md": 80, "docs/architecture.md": 80,
           "docs/lives.md": 150}
BRITISH = re.compile(
    r"colour|neighbour|behaviour|honour|favour|flavour|\bcentre|\bmetre|\bgrey|licence|catalogue|modell|labell|travell"
    r"|(organ|optim|recogn|normal|initial|synchron|real|visual|parallel|serial|minim|maxim|general|final)"
    r"is(e|ing|ation)|analyse\b", re.IGNORECASE)


class Block:
    def __init__(self, document, line, language, text, mark):
        self.document, self.line, self.language = document, line, language
        self.text, self.mark = text, mark

    @property
    def name(self):
        return f"{self.document}:{self.line}"

    @property
    def first(self):
        return self.text.splitlines()[0] if self.text.strip() else ""


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def read_blocks(document):
    with open(os.path.join(PROJECT, document), encoding="utf-8") as text:
        lines = text.read().splitlines()
    blocks, start, before = [], None, ""
    for number, line in enumerate(lines):
        if not line.lstrip().startswith("```"):
            before = line if line.strip() and start is None else before
        elif start is None:
            start, indent = number, len(line) - len(line.lstrip())
            language = line.strip()[3:].strip()
        else:
            text = "".join(inner[indent:] + "\n" for inner in lines[start + 1 : number])
            mark = MARK.search(before)
            blocks.append(Block(document, start + 1, language, text, mark and mark.group(1)))
            start, before = None, ""
    check(start is None, f"{document}: every block ends")
    return blocks


def read_all():
    documents = ["README.md"]
    documents += sorted(glob.glob("docs/**/*.md", root_dir=PROJECT, recursive=True))
    return {document: read_blocks(document) for document in documents}


def read_not_run():
    """(document, first line): reason."""
    allowed = {}
    with open(os.path.join(HERE, "not_run.txt"), encoding="utf-8") as text:
        for line in text:
            if line.strip() and not line.startswith("#"):
                document, first, reason = (part.strip() for part in line.split("|"))
                allowed[document, first] = reason
    return allowed


def check_marks(blocks):
    allowed = read_not_run()
    marked = {}
    for block in blocks:
        check(block.language in LANGUAGES, f"{block.name}: is python, bash or cpp, not '{block.language}'")
        if block.mark:
            marked[block.document, block.first] = block.mark
    check(marked == allowed, f"blocks that are not run are in not_run.txt, and no others: {marked}")
    runnable = sum(block.mark is None for block in blocks)
    check(runnable > 0, f"{runnable} of {len(blocks)} blocks are run")


def read_without_blocks(path):
    with open(path, encoding="utf-8") as text:
        return re.sub(r"^ *```.*?^ *```$", "", text.read(), flags=re.MULTILINE | re.DOTALL)


def get_anchors(text):
    """Of a document's headings, as GitHub makes them."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in HEADING.findall(text)}


def check_links(documents):
    count = 0
    for document in documents:
        path = os.path.join(PROJECT, document)
        for link in LINK.findall(read_without_blocks(path)):
            if re.match(r"[a-z]+:", link):
                continue
            name, _, anchor = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
            check(os.path.exists(target), f"{document}: {link} is there")
            if anchor:
                check(anchor in get_anchors(read_without_blocks(target)), f"{document}: {link} is a heading")
            count += 1
    check(count > 0, f"{count} links lead somewhere")


def check_style(documents):
    for document in documents:
        with open(os.path.join(PROJECT, document), encoding="utf-8") as text:
            lines = text.read().splitlines()
        limit = LENGTHS.get(document, 250)
        check(len(lines) <= limit, f"{document}: {len(lines)} lines, at most {limit}")
        british = [f"{number}: {match.group()}" for number, line in enumerate(lines, 1)
                   for match in BRITISH.finditer(line)]
        check(not british, f"{document}: is spelled as in America {' '.join(british)}")


def make_folder(document):
    """Where the document's blocks run: the same for all languages, so that files are handed on."""
    root = os.path.dirname(OUTPUT)
    for name, target in (("examples", os.path.join(PROJECT, "examples")),):
        link = os.path.join(root, name)
        if not os.path.islink(link):
            os.makedirs(root, exist_ok=True)
            os.symlink(target, link)
    folder = os.path.join(root, "run_" + os.path.splitext(os.path.basename(document))[0])
    if LANGUAGE == "python":
        shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder, exist_ok=True)
    if not os.path.islink(os.path.join(folder, "build")):
        os.symlink(BUILD, os.path.join(folder, "build"))
    return folder


def run(command, folder, what, **more):
    result = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=200, **more
    )
    print(result.stdout, flush=True)
    check(result.returncode == 0, f"{what}: comes to an end")
    return result.stdout


def check_pictures(folder, text, what):
    """Every file name with an ending of pictures that the block writes down is there, with contents."""
    for name in re.findall(r'"([\w/]+\.png)"', text):
        path = os.path.join(folder, name)
        if not os.path.exists(path):  # SaveAnimation numbers
            path = os.path.join(folder, name.replace(".png", ".0000.png"))
        check(os.path.exists(path) and os.path.getsize(path) > 1000, f"{what}: made {name}")


def run_python(document, blocks):
    """One script of all blocks; ParaView's errors must not appear."""
    folder = make_folder(document)
    script = os.path.join(folder, "script.py")
    with open(script, "w", encoding="utf-8") as text:
        for block in blocks:
            # Messages name the document's line.
            text.write(f"exec(compile({block.text!r}, {block.name!r}, 'exec'), globals())\n")
    # Programs of VTK are one process; the package is as the build has it.
    ranks = "1" if any("dsmraytracer" in block.text for block in blocks) else "2"
    packages = glob.glob(os.path.join(BUILD, "lib*", "**", "dsmraytracer"), recursive=True)
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(map(os.path.dirname, packages)))
    out = run([*MPIRUN, "-np", ranks, PVBATCH, script], folder, document, env=environment)
    check("ERR|" not in out and "Error" not in out, f"{document}: without errors")
    for block in blocks:
        check_pictures(folder, block.text, block.name)


def run_bash(document, blocks):
    folder = make_folder(document)
    environment = dict(os.environ)
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_mpi_yield_when_idle",
                 "MCA_rmaps_base_oversubscribe"):
        environment["OMPI_" + name] = "1"
    environment["OMPI_MCA_hwloc_base_binding_policy"] = "none"
    for block in blocks:
        out = run(["bash", "-euo", "pipefail", "-c", block.text], folder, block.name, env=environment)
        check("ERR|" not in out and "Error" not in out, f"{block.name}: without errors")


def run_cpp(document, blocks):
    """What a block uses and does not define is in prelude.h."""
    folder = make_folder(document)
    with open(os.path.join(BUILD, "compile_commands.json"), encoding="utf-8") as text:
        entry = next(entry for entry in json.load(text)
                     if "rendering_TraceImage.dir" in entry["command"])
    words = shlex.split(entry["command"])
    words = words[: words.index("-o")] + words[words.index("-o") + 2 :]
    words = [word for word in words if word not in ("-c", entry["file"])]
    for number, block in enumerate(blocks):
        source = os.path.join(folder, f"block{number}.cxx")
        with open(source, "w", encoding="utf-8") as text:
            text.write(f'#include "{os.path.join(HERE, "prelude.h")}"\n')
            text.write(f"void Block()\n{{\n#line {block.line + 1} \"{block.document}\"\n{block.text}}}\n")
        run([*words, "-fsyntax-only", source], entry["directory"], block.name)


def main():
    documents = read_all()
    if LANGUAGE == "marks":
        check_marks([block for blocks in documents.values() for block in blocks])
        return
    if LANGUAGE == "links":
        check_links([*documents, "CONTRIBUTING.md", "CHANGELOG.md"])
        return
    if LANGUAGE == "style":
        check_style([*documents, "CONTRIBUTING.md", "CHANGELOG.md"])
        return
    for document, blocks in documents.items():
        chosen = [block for block in blocks if block.language == LANGUAGE and not block.mark]
        if chosen:
            {"python": run_python, "bash": run_bash, "cpp": run_cpp}[LANGUAGE](document, chosen)


main()
