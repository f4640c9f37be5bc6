#!/usr/bin/python3
"""test_summary.py FILE: what a run of ctest came to, from the file of its --output-junit: how many tests passed,
failed and were skipped, and which of those, with the reason. A skipped test proves nothing, so it counts as none that
passed. Exit code 1 if a test failed or none ran."""
import re
import sys
import xml.etree.ElementTree as ET

# What googletest prints, this project's own stand-ins, unittest.
REASONS = (r"Skipped\n(.+)", r"\[  SKIPPED \] (.+)", r"\.\.\. skipped '(.*)'")


def reason_of(text):
    """Why tests were skipped, as their output says."""
    for pattern in REASONS:
        found = re.findall(pattern, text)
        if found:
            several = f"{len(found)} of its tests: " if pattern is REASONS[-1] else ""
            return several + "; ".join(dict.fromkeys(found))
    return "no reason given"


def summary(path):
    """Lines to print, and whether all is well."""
    passed, failed, skipped = 0, [], []
    for case in ET.parse(path).getroot().iter("testcase"):
        output = case.findtext("system-out") or ""
        if case.get("status") == "run":
            passed += 1
        elif case.find("skipped") is not None and case.get("status") == "notrun":
            skipped.append(f"{case.get('name')} ({reason_of(output)})")
        else:
            failed.append(case.get("name"))
    lines = [f"{passed} tests passed, {len(failed)} failed, {len(skipped)} skipped"]
    lines += [f"  failed: {name}" for name in failed]
    lines += [f"  skipped: {name}" for name in skipped]
    return lines, not failed and passed > 0


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    try:
        lines, well = summary(sys.argv[1])
    except (OSError, ET.ParseError) as error:
        print(f"test_summary.py: {sys.argv[1]} cannot be read: {error}", file=sys.stderr)
        return 1
    print("\n".join(lines))
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
