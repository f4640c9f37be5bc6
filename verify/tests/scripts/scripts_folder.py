"""What the tests of the scripts share. Importing it makes the scripts' modules importable."""
import contextlib
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parent.parent.parent.parent / "scripts"
STUDIES = SCRIPTS / "studies"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))


def has_numpy():
    with contextlib.suppress(ImportError):
        import numpy  # noqa: F401

        return True
    return False
