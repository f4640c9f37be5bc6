#!/usr/bin/python3
"""Puts tables of results/ between README's markers, so that no figure there is typed by hand. First it makes
results/targets.md, which is drawn from several of them, anew.

A block stands between <!-- results/NAME.md --> and <!-- end -->, each on a line of its own; it gets that file
without its heading. A block whose file has not been made yet stays as it is, and is named.
"""
import os
import pathlib
import re
import subprocess
import sys

START = re.compile(r"^<!-- (results/[\w.-]+\.md) -->\n", re.M)
END = "<!-- end -->\n"


def filled(text, top):
    """The text with every block filled, and the names of the files that are missing."""
    before, *rest = START.split(text)  # text, then name and text in turn
    names, missing = rest[0::2], []
    if not names or len(set(names)) < len(names) or END in before:
        sys.exit("update_readme.py: README.md must hold <!-- results/NAME.md -->, each name once, and "
                 "no end before it")
    parts = [before]
    for name, block in zip(names, rest[1::2]):
        if block.count(END) != 1:
            sys.exit(f"update_readme.py: README.md must hold one {END.strip()} after <!-- {name} -->")
        old, after = block.split(END)
        if (top / name).is_file():
            body = (top / name).read_text(encoding="utf-8").split("\n", 2)[2]  # without its heading
        else:
            body = old
            missing.append(name)
        parts += [f"<!-- {name} -->\n", body, END, after]
    return "".join(parts), missing


def write_whole(path, text):
    temporary = path.with_suffix(".tmp")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def main():
    top = pathlib.Path(__file__).resolve().parent.parent
    targets = subprocess.run([top / "scripts" / "targets_table.py", top / "results"], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    write_whole(top / "results" / "targets.md", targets)
    readme = top / "README.md"
    text, missing = filled(readme.read_text(encoding="utf-8"), top)
    write_whole(readme, text)
    for name in missing:
        print(f"update_readme.py: {name} is not there; its block stays as it is")


main()
