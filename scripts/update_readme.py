#!/usr/bin/python3
"""Puts what stands in results/throughput.md between README's markers, so that no figure there is typed
by hand."""
import os
import pathlib
import sys

START = "<!-- results/throughput.md -->\n"
END = "<!-- end -->\n"

top = pathlib.Path(__file__).resolve().parent.parent
readme = top / "README.md"
table = (top / "results" / "throughput.md").read_text(encoding="utf-8")
text = readme.read_text(encoding="utf-8")
if text.count(START) != 1 or text.count(END) != 1:
    sys.exit(f"update_readme.py: README.md must hold {START.strip()} and {END.strip()} once each")
before, rest = text.split(START)
_, after = rest.split(END)
body = table.split("\n", 2)[2]  # without its heading
temporary = readme.with_suffix(".tmp")
temporary.write_text(before + START + body + END + after, encoding="utf-8")
os.replace(temporary, readme)
