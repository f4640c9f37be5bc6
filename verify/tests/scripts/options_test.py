#!/usr/bin/python3
"""The options of the scripts that make results (scripts/studies/study.sh)."""
import subprocess
import unittest

from scripts_folder import SCRIPTS, STUDIES


class Options(unittest.TestCase):
    def read(self, own, *words, changes=""):
        """Exit code, what is set, what is complained of, with a tree that has these changes."""
        script = f"""set -euo pipefail
cd "$1"; shift
source scripts/studies/study.sh
git() {{ printf '%s' '{changes}'; }}
scenes=all
read_options /somewhere/some.sh '{own}' "$@"
echo "$out|${{dirty[*]}}|$scenes|${{rest[*]}}"
"""
        done = subprocess.run(["bash", "-c", script, "some.sh", SCRIPTS.parent, *words], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout.strip(), done.stderr

    def test_what_is_given_is_set(self):
        self.assertEqual(self.read(""), (0, "results||all|", ""))
        self.assertEqual(self.read("scenes rest", "--scenes", "a b", "--out", "x y", "--allow-dirty", "--", "-q", "1"),
                         (0, "x y|--allow-dirty|a b|-q 1", ""))

    def test_a_tree_with_changes_is_refused(self):
        code, text, complaint = self.read("", changes=" M README.md")
        self.assertEqual((code, text), (2, ""))
        self.assertIn("some.sh: the tree has uncommitted changes", complaint)
        self.assertEqual(self.read("", "--allow-dirty", changes=" M README.md")[0], 0)

    def test_what_is_not_the_scripts_own_is_refused(self):
        for words in (("--scenes", "a"), ("--rest", "a"), ("--", "a"), ("a",), ("--script", "a")):
            code, text, complaint = self.read("", *words)
            self.assertEqual((code, text), (2, ""))
            self.assertIn(f"some.sh: unknown option {words[0]} (--out DIR, --allow-dirty)", complaint)

    def test_scripts_refuse_unknown_options(self):
        for name in ("contact.sh", "accuracy.sh", "reference.sh", "extremes.sh", "large_balls.sh", "stability.sh"):
            done = subprocess.run([STUDIES / name, "--no-such"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{name}: unknown option --no-such", done.stderr)
            done = subprocess.run([STUDIES / name, "--help"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0)
            self.assertIn(f"scripts/studies/{name} [--out DIR]", done.stdout)
            done = subprocess.run([STUDIES / name, "--out"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{name}: --out needs a value", done.stderr)


if __name__ == "__main__":
    unittest.main()
