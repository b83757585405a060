#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Collects the strings that users read, and checks their English.

usage: check_strings.py ROOT [--print [FOLDER...]]

With --print, writes the strings as one page for proof-reading: file, line, text. Values that the program inserts are
shown as {}. Otherwise, reports strings that contain a phrase of the list below, or a sentence that is too long.
"""
import ast
import html
import pathlib
import re
import sys

FOLDERS = ["vtk_modules", "plugin", "xml", "tools", "examples", "scripts", "cmake"]
FILES = ["demo.sh", "test.sh", "CMakeLists.txt"]
MOST_WORDS = 35
# Strings of fewer words are taken only where a statement reports something.
FEWEST_WORDS = 4
REPORTS = re.compile(r"\b(throw|\w*(?:Error|Warning|Fail|Refuse|Log)\w*)\b")

# Pattern -> what to write.
PHRASES = {
    r"\b\w*(colour|grey|organis|neighbour|metre\b|centre|behaviour|normalis|initialis|recognis|catalogue|licence)\w*":
        "American spelling",
    r"(?:^|[.:;!?] )(Of|What|Whether|That which) (?!\w+ \w+\?)": "subject first: who or what does something?",
    r"(?<!\b[Tt]here )\bis no (?!longer\b)[a-z]+\b": "'is not a ...'",
    r"\bis none\b": "'there is no ...', or the valid values",
    r"\b[Nn]obody\b": "the program or the user",
    r"\bof (ours|theirs|its own kind)\b": "'our' or a name",
    r"\b(goes|go|went) on (?!to\b)": "'continues'",
    r"\b(is|are|was|were) nowhere\b": "what is invalid",
    r"\blacks (its|a|an|the)\b": "'missing ...'",
    r"cannot be used: it tells": "what is invalid",
    r"\bby and by\b": "'gradually', 'in parts'",
    r"\bas a whole\b": "'entire'",
    r"\bare not there\b|\bis not there\b": "'is missing', 'does not exist'",
    r"\b(last|latest) word counts\b": "'The most recent value applies.'",
    r"\bsign of life\b": "'unresponsive'",
    r"\b(tells|told|tell) (of|that|what)\b": "'declares', 'reports'",
    r"\bthe least\b": "'the minimum'",
    r"\bsome(body|one)\b": "the program or the user",
    r"\bis given up\b": "'is treated as failed'",
    r"\bbeyond what\b": "'outside the range of'",
    r"\ban?other \w+ than\b": "'differs from'",
    r"\b(cannot|could not|can't) be had\b": "'is not available'",
    r"\bcame to nothing\b": "'failed'",
    r"\bthat many\b": "the number",
}


def unescape(text):
    text = re.sub(r"\\u([0-9a-fA-F]{4})", lambda match: chr(int(match.group(1), 16)), text)
    escapes = {"n": "\n", "t": "\t", '"': '"', "\\": "\\", "'": "'"}
    return re.sub(r"\\(.)", lambda match: escapes.get(match.group(1), match.group(0)), text, flags=re.DOTALL)


TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | R"(?P<fence>[^(\s"]*)\((?P<raw>.*?)\)(?P=fence)"
      | "(?P<text>(?:[^"\\\n]|\\.)*)"
      | (?P<character>'(?:[^'\\\n]|\\.)+')
      | (?P<include>^[ \t]*\#[ \t]*include[^\n]*)
      | (?P<end>[;{}])""",
    re.VERBOSE | re.DOTALL | re.MULTILINE,
)


def statements(source):
    """Yields, for each statement of C++, its code without strings, and its strings as (offset, text, code before)."""
    code = ""
    strings = []
    place = 0
    gap = ""
    for token in TOKEN.finditer(source):
        between = source[place:token.start()]
        place = token.end()
        code += between
        gap += between
        if token["raw"] is not None or token["text"] is not None:
            text = token["raw"] if token["raw"] is not None else unescape(token["text"])
            strings.append((token.start(), text, gap))
            code += '""'
            gap = ""
        elif token["character"]:
            code += "' '"
            gap += "' '"
        elif token["end"]:
            # A brace within parentheses is a list or a lambda: part of the statement.
            if code.count("(") > code.count(")") and token["end"] != ";":
                code += token["end"]
                gap += token["end"]
                continue
            yield code, strings
            code, gap, strings = "", "", []


JOINED = re.compile(r"^\s*(\+|<<).*(\+|<<)\s*$", re.DOTALL)


def joined(strings):
    """Joins the pieces of one text."""
    whole = []
    for offset, text, gap in strings:
        if whole and not gap.strip():
            whole[-1][1] += text
        elif whole and JOINED.match(gap) and not re.search(r"[?,;]", re.sub(r"\([^()]*\)", "", gap)):
            whole[-1][1] += "{}" + text
        else:
            whole.append([offset, text])
    return whole


def words(text):
    return len(re.findall(r"(?<![\w\-./:%])[A-Za-z][a-z']*(?![\w/:])", text))


def cxx_strings(source):
    for code, strings in statements(source):
        if "static_assert" in code:
            continue
        reports = REPORTS.search(code)
        for offset, text in joined(strings):
            if words(text) >= (2 if reports else FEWEST_WORDS):
                yield source.count("\n", 0, offset) + 1, text


def python_strings(source):
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.JoinedStr):
            text = "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = node.value
        else:
            continue
        if words(text) >= FEWEST_WORDS:
            yield node.lineno, text


def shell_strings(source):
    for number, line in enumerate(source.splitlines(), 1):
        if re.search(r"\b(fail|echo|printf)\b", line) and not line.lstrip().startswith("#"):
            for text in re.findall(r'"((?:[^"\\]|\\.)*)"', line):
                if words(text) >= FEWEST_WORDS:
                    yield number, re.sub(r"\$\{[^}]*\}|\$\w+|\$\([^)]*\)", "{}", text)


def cmake_strings(source):
    source = re.sub(r"^\s*#.*$", "", source, flags=re.MULTILINE)
    for match in re.finditer(r'"((?:[^"\\]|\\.)*)"', source):
        # Code that the build writes is no text.
        if words(match.group(1)) >= FEWEST_WORDS and not re.search(r"\\n|::|<|;", match.group(1)):
            yield source.count("\n", 0, match.start()) + 1, re.sub(r"\$\{[^}]*\}", "{}", match.group(1))


def xml_strings(source):
    source = re.sub(r"<!--.*?-->", lambda match: re.sub(r"[^\n]", " ", match.group()), source, flags=re.DOTALL)
    pattern = r'\b(?:panel_name|\w*label|text|short_help|long_help|file_description)="([^"]*)"' \
              r"|<(?:Documentation|Text)[^>]*>([^<]*)<"
    for match in re.finditer(pattern, source):
        text = html.unescape(match.group(1) or match.group(2) or "")
        if words(text):
            yield source.count("\n", 0, match.start()) + 1, text


READERS = {
    ".h": cxx_strings, ".cxx": cxx_strings, ".txx": cxx_strings, ".py": python_strings, ".sh": shell_strings,
    ".cmake": cmake_strings, ".txt": cmake_strings, ".xml": xml_strings,
}


def collect(root, folders):
    """Yields (name, line, text) of all strings below the folders, and in the files."""
    paths = [path for folder in folders for path in sorted((root / folder).rglob("*"))]
    if folders == FOLDERS:
        paths += [root / name for name in FILES]
    for path in paths:
        suffix = pathlib.Path(path.stem).suffix if path.suffix == ".in" else path.suffix
        if suffix in READERS and path.is_file():
            for line, text in sorted(READERS[suffix](path.read_text())):
                yield path.relative_to(root).as_posix(), line, " ".join(text.split())


def find_faults(text):
    for pattern, advice in PHRASES.items():
        match = re.search(pattern, text)
        if match:
            yield f"'{match.group().strip()}': {advice}"
    for sentence in re.split(r"[.:;!?](?:\s|$)", text):
        if words(sentence) > MOST_WORDS:
            yield f"a sentence of {words(sentence)} words"


def main():
    root = pathlib.Path(sys.argv[1])
    if "--print" in sys.argv:
        folders = sys.argv[sys.argv.index("--print") + 1:] or FOLDERS
        last = None
        for name, line, text in collect(root, folders):
            if name != last:
                print(f"\n{name}")
            last = name
            print(f"  {line}: {text}")
        return 0
    count = 0
    faults = []
    for name, line, text in collect(root, FOLDERS):
        count += 1
        faults += [f"{name}:{line}: {fault}\n    {text}" for fault in find_faults(text)]
    print("\n".join(faults))
    print(f"{count} strings, {len(faults)} faults")
    # The collector itself must not fall silent.
    return 1 if faults or count < 700 else 0


if __name__ == "__main__":
    sys.exit(main())
