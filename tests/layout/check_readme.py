#!/usr/bin/env python3
"""Fails if README.md and the program disagree: check_readme.py ROOT TOOL.

Every `meniscus ...` command in a sh block must name a verb that works and flags that it has; every
verb that works must have an example; the C++ example must be tests/layout/readme_example.cpp; and
the files that the documents link to or run must exist.
"""
import pathlib
import re
import shlex
import subprocess
import sys

LATER = "later version"
EXAMPLE = re.compile(r"<!-- begin: example -->\n```cpp\n(.*?)```\n<!-- end: example -->", re.DOTALL)


def help_of(tool, *verb):
    run = subprocess.run([tool, *verb, "--help"], capture_output=True, text=True, timeout=60, check=False)
    return run.stdout if run.returncode == 0 else None


def working_verbs(tool):
    """The verbs of `meniscus --help`, without those that only say that they come later."""
    listed = help_of(tool).partition("Subcommands:\n")[2].partition("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines() if line.strip() and LATER not in line]


def flags_of(text):
    """The flags in a verb's help, without those that only say that they come later."""
    flags = set()
    for line in text.partition("\nOptions:\n")[2].splitlines():
        names = re.match(r"\s+(-{1,2}[a-zA-Z][\w-]*(?:,-{1,2}[a-zA-Z][\w-]*)*)", line)
        if names and LATER not in line.lower():
            flags.update(names[1].split(","))
    return flags


def sh_lines(text):
    """(line number, line) of each line of the sh blocks, comments taken off."""
    language = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            language = line[3:].strip() if language is None else None
        elif language == "sh" and line.strip():
            yield number, line


def commands(line):
    """The commands of a shell line as lists of words: split at pipes, without redirections."""
    lexer = shlex.shlex(line, posix=True, punctuation_chars="|<>;&")
    lexer.whitespace_split = True
    lexer.commenters = "#"
    words, skip = [], False
    for word in lexer:
        if set(word) <= set("<>"):
            skip = True
        elif set(word) <= set("|;&"):
            yield words
            words = []
        elif skip:
            skip = False
        else:
            words.append(word)
    yield words


def check_command(words, tool, verbs, seen):
    """What is wrong with one `meniscus ...` command."""
    if len(words) < 2 or words[1] not in verbs:
        return [f"\"{' '.join(words)}\": no such verb, or one that does not work yet"]
    seen.add(words[1])
    flags = flags_of(help_of(tool, words[1]))
    used = [re.split("=", word)[0] for word in words[2:] if re.match(r"--?[a-zA-Z]", word)]
    return [f"{words[1]}: no flag {flag}" for flag in used if flag not in flags]


def check_commands(root, tool):
    errors, seen, verbs = [], set(), working_verbs(tool)
    if len(verbs) < 3:
        errors.append(f"meniscus --help names only these verbs: {verbs}")
    for number, line in sh_lines((root / "README.md").read_text()):
        for words in commands(line):
            if words and words[0] == "meniscus":
                errors += [f"README.md:{number}: {error}" for error in check_command(words, tool, verbs, seen)]
            errors += [f"README.md:{number}: {word} does not exist" for word in words
                       if re.match(r"(scripts|data)/", word) and not (root / word).exists()]
    return errors + [f"README.md: no example of {verb}" for verb in verbs if verb not in seen]


def check_example(root):
    source = (root / "tests/layout/readme_example.cpp").read_text()
    quoted = EXAMPLE.search((root / "README.md").read_text())
    if not quoted:
        return ["README.md: no C++ example between its markers"]
    if quoted[1] != source.partition("\n")[2]:  # all but the licence line
        return ["README.md: the C++ example differs from tests/layout/readme_example.cpp; copy it over"]
    return []


def check_links(root):
    errors = []
    for path in [*sorted(root.glob("*.md")), *sorted((root / "docs").glob("*.md"))]:
        for target in re.findall(r"\]\(([^)#\s]+)", path.read_text()):
            if "://" not in target and not (path.parent / target).exists():
                errors.append(f"{path.relative_to(root)}: links to {target}, which does not exist")
    return errors


def main(root, tool):
    errors = check_commands(root, tool) + check_example(root) + check_links(root)
    print("\n".join(errors) or "README.md holds")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2]))
