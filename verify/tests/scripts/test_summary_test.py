#!/usr/bin/python3
"""scripts/test_summary.py on a made-up file of ctest."""
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS

CASE = '<testcase name="{}" status="{}">{}<system-out>{}</system-out></testcase>'
SKIPPED = '<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>'


class Summary(unittest.TestCase):
    def run_on(self, *cases):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "ctest.xml"
            path.write_text(f'<testsuite name="x" tests="9">{"".join(cases)}</testsuite>')
            done = subprocess.run([SCRIPTS / "test_summary.py", path], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_skipped_ones_are_none_that_passed(self):
        google = "[ RUN      ] A.B\n../a_test.cpp:7: Skipped\nno device can be made here\n\n[  SKIPPED ] A.B (0 ms)"
        python = "test_a (__main__.Some.test_a)\nWhat it does. ... skipped 'no numpy'\n" \
                 "test_b (__main__.Some.test_b) ... skipped 'no numpy'\ntest_c (__main__.Some.test_c) ... ok\n" \
                 "OK (skipped=2)"
        code, lines = self.run_on(CASE.format("good", "run", "", "fine"), CASE.format("A.B", "notrun", SKIPPED, google),
                                  CASE.format("fortran", "notrun", SKIPPED, "[  SKIPPED ] no FORTRAN compiler"),
                                  CASE.format("scripts_it", "notrun", SKIPPED, python))
        self.assertEqual(code, 0)
        self.assertEqual(lines, ["1 tests passed, 0 failed, 3 skipped",
                                 "  skipped: A.B (no device can be made here)",
                                 "  skipped: fortran (no FORTRAN compiler)",
                                 "  skipped: scripts_it (2 of its tests: no numpy)"])

    def test_what_failed_or_never_ran_is_told(self):
        code, lines = self.run_on(CASE.format("good", "run", "", ""), CASE.format("bad", "fail", "", ""),
                                  CASE.format("lost", "notrun", "", "no such program"))
        self.assertEqual((code, lines), (1, ["1 tests passed, 2 failed, 0 skipped", "  failed: bad", "  failed: lost"]))
        self.assertEqual(self.run_on()[0], 1)
        done = subprocess.run([SCRIPTS / "test_summary.py", "/no/such"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    unittest.main()
