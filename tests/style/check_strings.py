#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Collects the strings that users read, the comments of C++ headers, and the subjects of commits, and checks their
English.

usage: check_strings.py ROOT [--print [FOLDER...]]

With --print, writes the strings as one page for proof-reading: file, line, text. Values that the program inserts are
shown as {}. Otherwise, reports texts that contain a phrase of the list below, or a sentence that is too long, and
subjects that subjects.py finds fault with.
"""
import ast
import html
import pathlib
import re
import sys

import subjects

FOLDERS = ["vtk_modules", "plugin", "xml", "tools", "examples", "scripts", "cmake"]
FILES = ["demo.sh", "test.sh", "CMakeLists.txt"]
HEADERS = ["vtk_modules", "plugin"]
MOST_WORDS = 35
# Strings of fewer words are taken only where a statement reports something.
FEWEST_WORDS = 4
REPORTS = re.compile(r"\b(throw|\w*(?:Error|Warning|Fail|Refuse|Log)\w*)\b")

# Pattern -> what to write.
PHRASES = {
    r"\b\w*(colour|grey|organis|neighbour|metre\b|centre|behaviour|normalis|initialis|recognis|catalogue|licence)\w*":
        "American spelling",
    r"(?:^|[.:;!?] )(Of|What|Whether|Th(?:at|ose) (?:of|which)) (?!\w+ \w+\?)":
        "subject first: who or what does something?",
    r"(?<!\b[Tt]here )\bis no (?!longer\b)[a-z]+\b": "'is not a ...'",
    r"\bis none\b(?<![Tt]here is none)": "'there is no ...', or the valid values",
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
    r"\b[Ww]hoever\b|\bthose who\b": "the program, the rank, the caller",
    r"(?:^|[.:;!?] )Tells\b": "'Returns', 'Reports'",
    r"^(So|And|Those)\b|^That (?!\w+ is\b)": "name the thing or the action",
    r"\b(it is|is it) that\b": "name it",
    r"\bfor want of\b": "'because there is no ...'",
    r"\bno more\b(?=[.,:;]|$| (?:and|what)\b)": "'no longer'",
    r"\bare none of\b": "'are not ...'",
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


MARKS = re.compile(r"^\s*(?:///?<?|/\*[*!]?<?|\*(?!/))\s?|\s*\*/$")


def header_comments(source):
    """Yields the comments of C++, a paragraph at a time: lines of // that follow one another are one comment."""
    place, first, lines = 0, 0, ""
    for token in TOKEN.finditer(source + "\n;"):
        if not token["comment"] or not re.fullmatch(r"\n[ \t]*", source[place:token.start()]):
            # A command of Doxygen begins a paragraph.
            for paragraph in re.finditer(r"[^\n]+\n(?:[^\n@][^\n]*\n)*", lines):
                yield first + lines.count("\n", 0, paragraph.start()), re.sub(r"^@\w+[: ]*", "", paragraph.group())
            lines = ""
        if token["comment"]:
            first = first if lines else source.count("\n", 0, token.start()) + 1
            text = "\n".join(MARKS.sub("", line).strip() for line in token["comment"].split("\n"))
            # The column of a table is a sentence.
            lines += re.sub(r"\b {3,}", ": ", re.sub(r"^SPDX-.*", "", text)) + "\n"
        place = token.end()


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


def collect_comments(root):
    """Yields (name, line, text) of all comments of headers."""
    for path in sorted(path for folder in HEADERS for path in (root / folder).rglob("*")):
        if re.search(r"\.(h|txx|h\.in)$", path.name) and path.is_file():
            for line, text in header_comments(path.read_text()):
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
    # The collectors themselves must not fall silent.
    sample = "// SPDX-\n/// Of a.\nint a; ///< Of b,\n       ///< of c.\n/**\n * @brief Of d\n *\n * Of e. */\n" \
             "int b;\n// f\n// g. Of h."
    found = [line for line, text in header_comments(sample) if list(find_faults(text))]
    faults = [] if found == [2, 3, 6, 8, 10] else [f"the sample of comments: faults in lines {found}"]
    if len(list(subjects.find_form_faults("x" * 80 + ";."))) != 4:
        faults.append("the sample of a subject")
    strings, comments = list(collect(root, FOLDERS)), list(collect_comments(root))
    for name, line, text in strings + comments:
        faults += [f"{name}:{line}: {fault}\n    {text}" for fault in find_faults(text)]
    commits, reason = subjects.list_subjects(root)
    for name, text in commits:
        faults += [f"{name}: {fault}\n    {text}" for fault in [*subjects.find_form_faults(text), *find_faults(text)]]
    print("\n".join(faults))
    print(f"{len(strings)} strings, {len(comments)} comments, {len(commits)} subjects of commits, {len(faults)} faults")
    if reason:
        print(f"skipped the subjects of commits: {reason}")
    return 1 if faults or len(strings) < 700 or len(comments) < 3000 else 0


if __name__ == "__main__":
    sys.exit(main())
