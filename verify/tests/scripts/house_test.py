#!/usr/bin/python3
"""scripts/check_house.py passes a small tree that keeps the rules, and names each rule that is broken in it."""
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "check_house.py"


class HouseTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        subprocess.run(["git", "init", "-q", self.top], check=True)
        self.write("README.md", "# bounce\n")
        self.write("kernels/CMakeLists.txt", "\n")
        self.write("kernels/stepping/kernel.hpp", '#include "kernels/model/problem.hpp"\n')
        self.write("driver/run/run_loop.cpp", '#include "driver/world/files.hpp"\n#include "verify/watch/ledger.hpp"\n')
        self.write("driver/main.cpp", '#include "driver/run/run_loop.hpp"\n')
        self.write("results/README.md", "tables\n")

    def write(self, name, text):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())

    def check(self):
        subprocess.run(["git", "-C", self.top, "add", "-A"], check=True)
        return subprocess.run([SCRIPT, self.top], capture_output=True, text=True, check=False)

    def broken(self, name, text, said):
        self.write(name, text)
        done = self.check()
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn(said, done.stdout)
        self.assertEqual(done.stdout.count("\n"), 1, done.stdout)

    def test_a_tree_that_keeps_the_rules_passes(self):
        done = self.check()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_includes_upwards(self):
        self.broken("kernels/model/scene.hpp", '#include "kernels/stepping/kernel.hpp"\n',
                    "kernels/model includes upwards")
        self.broken("kernels/model/scene.hpp", '#include "verify/watch/ledger.hpp"\n', "includes upwards")

    def test_includes_that_never_may_be(self):
        self.broken("kernels/csr/csr.cpp", '#include "kernels/rings/ring.hpp"\n',
                    "kernels/csr must not include from kernels/rings")

    def test_files_in_no_room(self):
        self.broken("kernels/ring.cpp", "\n", "kernels/ring.cpp: in no room")

    def test_kernels_that_print_or_name_options(self):
        self.broken("kernels/rings/ring.cpp", '#include <cstdio>\n', "kernels must not print")
        self.broken("kernels/rings/ring.cpp", 'throw Error("--kernel ring");\n', "name options")

    def test_long_files_and_full_folders(self):
        self.broken("driver/run/long.cpp", "\n" * 501, "501 lines; at most 500")
        (self.top / "driver/run/long.cpp").unlink()
        for number in range(24):
            self.write(f"scripts/{number}.sh", "\n")
        self.assertEqual(self.check().returncode, 0)
        for number in range(24, 26):
            self.write(f"scripts/{number}.sh", "\n")
        self.broken("README.md", "# bounce\n", "scripts: 26 files; at most 25")

    def test_readme(self):
        self.broken("README.md", "line\n" * 201, "201 lines")
        self.broken("README.md", "x" * 16001, "16001 bytes")

    def test_results(self):
        self.broken("results/large.png", b"x" * 200_001, "a picture has at most 200000")
        (self.top / "results/large.png").unlink()
        self.write("results/a.csv", b"x" * 3_900_000)
        self.assertEqual(self.check().returncode, 0)
        self.broken("results/b.csv", b"x" * 200_000, "results: 4100007 bytes; at most 4000000")

    def test_another_folder_is_refused(self):
        (self.top / "kernels/CMakeLists.txt").unlink()
        self.assertEqual(self.check().returncode, 2)
        done = subprocess.run([SCRIPT, "--fast"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    unittest.main()
