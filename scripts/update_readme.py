#!/usr/bin/python3
"""Puts tables of results/ between README's markers, so that no figure there is typed by hand.

A block stands between <!-- results/NAME.md --> and <!-- end -->, each on a line of its own; it gets that file
without its heading. A block whose file has not been made yet stays as it is, and is named.
"""
import os
import pathlib
import re
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


def main():
    top = pathlib.Path(__file__).resolve().parent.parent
    readme = top / "README.md"
    text, missing = filled(readme.read_text(encoding="utf-8"), top)
    temporary = readme.with_suffix(".tmp")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, readme)
    for name in missing:
        print(f"update_readme.py: {name} is not there; its block stays as it is")


main()
