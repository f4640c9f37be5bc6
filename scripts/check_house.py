#!/usr/bin/python3
"""Checks the rules of the house: who may include whom, and how large files, folders, README and results may be.

    scripts/check_house.py [FOLDER]      FOLDER: a tree to check instead of this one

Exit code 1 if a rule is broken, each break on a line of its own; 2 for a folder that is no such tree.
"""
import pathlib
import re
import subprocess
import sys

# A room includes from itself and from the rooms before it, but for what NEVER says.
ROOMS = [
    "kernels/model", "kernels/stepping", "kernels/rings", "kernels/csr", "kernels/contact", "kernels/plan",
    "verify/vibrations", "verify/watch", "verify/figures", "verify/oracle", "verify/stability", "verify/accuracy",
    "driver/world", "driver/scene", "driver/output", "driver/run", "driver/stability", "driver/accuracy", "driver/extremes",
    "driver", "bench", "verify/tests",
]
NEVER = {
    "kernels/csr": ["kernels/rings"],
    "kernels/contact": ["kernels/rings", "kernels/csr"],
    "verify/vibrations": ["verify"],
    "verify/oracle": ["verify/vibrations"],
    "driver/stability": ["driver/run"],
    "bench": ["driver/run", "driver/stability", "driver/accuracy", "driver/extremes"],
}
# What kernels must not do: print, read files, exit, name an option of the command line.
FORBIDDEN_IN_KERNELS = re.compile(r'#include <(?:iostream|fstream|cstdio|filesystem)>|\bprintf\(|\bexit\(|"--\w')

MOST_LINES, MOST_FILES = 500, 25
README_LINES, README_BYTES = 200, 16_000
RESULTS_BYTES, PNG_BYTES = 4_000_000, 200_000
INCLUDE = re.compile(r'^#include "((?:kernels|verify|driver|bench)/[^"]+)"', re.M)


def tracked(top):
    """The files of the tree as git knows them, less those that are gone."""
    done = subprocess.run(["git", "-C", top, "ls-files", "-z"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"check_house.py: {top}: no git tree", file=sys.stderr)
        sys.exit(2)
    return [name for name in done.stdout.split("\0") if name and (top / name).is_file()]


def room_of(name):
    """The longest room whose folder holds the file; None for one that is in no room."""
    inside = [room for room in ROOMS if name.startswith(room + "/")]
    return max(inside, key=len) if inside else None


def arrows(top, names):
    for name in names:
        if not name.endswith((".cpp", ".hpp")):
            continue
        text = (top / name).read_text(encoding="utf-8")
        room = room_of(name)
        if room is None:
            yield f"{name}: in no room; the rooms are {', '.join(ROOMS)}"
            continue
        for other in INCLUDE.findall(text):
            to = room_of(other)
            if to is None:
                yield f"{name}: includes {other}, which is in no room"
            elif ROOMS.index(to) > ROOMS.index(room):
                yield f"{name}: {room} includes upwards, {other}"
            elif to != room and any((to + "/").startswith(never + "/") for never in NEVER.get(room, ())):
                yield f"{name}: {room} must not include from {to} ({other})"
        if room.startswith("kernels/"):
            for found in FORBIDDEN_IN_KERNELS.findall(text):
                yield f"{name}: kernels must not print, read files, exit or name options ({found})"


def sizes(top, names):
    folders = {}
    for name in names:
        path = top / name
        folder = str(pathlib.PurePosixPath(name).parent)
        folders[folder] = folders.get(folder, 0) + 1
        if name.endswith((".cpp", ".hpp", ".py", ".sh", ".cmake")):
            lines = path.read_text(encoding="utf-8").count("\n")
            if lines > MOST_LINES:
                yield f"{name}: {lines} lines; at most {MOST_LINES}"
        if name.startswith("results/") and name.endswith(".png") and path.stat().st_size > PNG_BYTES:
            yield f"{name}: {path.stat().st_size} bytes; a picture has at most {PNG_BYTES}"
    for folder, files in sorted(folders.items()):
        if files > MOST_FILES and not folder.startswith("driver/scenes"):
            yield f"{folder}: {files} files; at most {MOST_FILES}"
    results = sum((top / name).stat().st_size for name in names if name.startswith("results/"))
    if results > RESULTS_BYTES:
        yield f"results: {results} bytes; at most {RESULTS_BYTES}"


def readme(top):
    text = (top / "README.md").read_bytes()
    if text.count(b"\n") > README_LINES or len(text) > README_BYTES:
        yield (f"README.md: {text.count(chr(10).encode())} lines and {len(text)} bytes; at most {README_LINES} "
               f"and {README_BYTES}")


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    top = pathlib.Path(sys.argv[1] if len(sys.argv) == 2 else pathlib.Path(__file__).resolve().parent.parent)
    names = tracked(top)
    if "README.md" not in names or "kernels/CMakeLists.txt" not in names:
        print(f"check_house.py: {top}: not a tree of bounce", file=sys.stderr)
        sys.exit(2)
    broken = [*arrows(top, names), *sizes(top, names), *readme(top)]
    for line in broken:
        print(f"check_house.py: {line}")
    if broken:
        sys.exit(1)
    print("check_house.py: who includes whom, file sizes, README and results are as the rules say")


if __name__ == "__main__":
    main()
