# SPDX-License-Identifier: BSD-3-Clause
"""Checks the form of the subjects of commits. Commits that do not descend from the one that added this file are older
than the rule, and merges have no subject of their own: neither is checked."""
import pathlib
import subprocess

NAME = "tests/style/subjects.py"
WIDTH = 72


def run_git(root, *arguments):
    return subprocess.run(["git", *arguments], cwd=root, check=True, capture_output=True, text=True).stdout.strip()


def list_subjects(root):
    """Returns (hash, subject) of the commits to check, and why there are none, if the sources have no history."""
    try:
        if pathlib.Path(run_git(root, "rev-parse", "--show-toplevel")).resolve() != root.resolve():
            return [], "the sources are not a repository"
        if run_git(root, "rev-parse", "--is-shallow-repository") == "true":
            return [], "the clone is shallow"
        added = run_git(root, "log", "--diff-filter=A", "--format=%H", "--", NAME).splitlines()
        if not added:
            return [], f"{NAME} is not committed"
        log = run_git(root, "log", "--no-merges", "--ancestry-path", "--format=%h %s", f"{added[-1]}..HEAD")
    except (OSError, subprocess.CalledProcessError) as error:
        return [], f"git does not answer: {error}"
    return [line.partition(" ")[::2] for line in log.splitlines()], ""


def find_form_faults(subject):
    if len(subject) > WIDTH:
        yield f"{len(subject)} columns, of at most {WIDTH}"
    if ";" in subject:
        yield "';': split the commit, or name what its changes have in common"
    if not subject[:1].isupper():
        yield "does not begin with a capital letter"
    if subject.endswith("."):
        yield "ends with a period"
