"""What the tests of the scripts share. Importing it makes the scripts' modules importable."""
import contextlib
import io
import runpy
import subprocess
import sys
from pathlib import Path
from unittest import mock

SCRIPTS = Path(__file__).resolve().parent.parent.parent.parent / "scripts"
STUDIES = SCRIPTS / "studies"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))


def has_numpy():
    with contextlib.suppress(ImportError):
        import numpy  # noqa: F401

        return True
    return False


def run_here(script, *words):
    """A script as a user runs it, but within this process: what takes long to import is imported once."""
    out, err, code = io.StringIO(), io.StringIO(), 0
    words = [str(script), *map(str, words)]
    with mock.patch.object(sys, "argv", words), mock.patch.object(sys, "path", [str(script.parent), *sys.path]), \
            contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            runpy.run_path(str(script), run_name="__main__")
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
    return subprocess.CompletedProcess(words, code, out.getvalue(), err.getvalue())
