#!/usr/bin/python3
"""scripts/trials/faults.py: which faults are drawn, how they are put in, and the page; nothing is built."""
import itertools
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, run_here

from trials import fault_kinds, faults

CODE = """// a < b + 1
#include <vector>
template <class T, int n = 3>
int f(int a, int b) {  // a == b
  int sum = 0;
  const std::string text = "1 + 2 == 3";
  for (int i = 0; i < a; ++i) sum += b[i];
  state.clear();
  return std::min(a, -b) - g(a, b);
}
"""


class Kinds(unittest.TestCase):
    def lines(self, text, name="kernels/a.cpp"):
        return [(fault.kind, fault.line, fault.after.strip()) for fault in fault_kinds.faults_of(name, text)]

    def test_each_kind_is_found_in_code_alone(self):
        found = self.lines(CODE)
        self.assertEqual({line for _, line, _ in found}, {5, 7, 8, 9})
        for fault in (("comparison", 7, "for (int i = 0; i <= a; ++i) sum += b[i];"),
                      ("sign", 7, "for (int i = 0; i < a; ++i) sum -= b[i];"),
                      ("constant", 5, "int sum = 1;"), ("left out", 8, ";"),
                      ("index", 7, "for (int i = 0; i < a; ++i) sum += b[j];"),
                      ("extreme", 9, "return std::max(a, -b) - g(a, b);"),
                      ("sign", 9, "return std::min(a, b) - g(a, b);"),
                      ("order", 9, "return std::min(a, -b) - g(b, a);")):
            self.assertIn(fault, found)
        self.assertNotIn("int sum = 0;", [after for _, _, after in found])

    def test_strings_and_words_are_left_alone(self):
        for text in (' x("a < b");', "#if a < b", "using a = b<3>;", "  call<3>(x);  // 1 < 2", " auto v = a.xy;"):
            self.assertNotIn("comparison", [kind for kind, _, _ in self.lines(text)], text)
        self.assertEqual([after for kind, _, after in self.lines(" z = a.x + b.xy;") if kind == "index"],
                         ["z = a.y + b.xy;"])
        self.assertEqual(self.lines('    """A text < of 3."""\n    # 1 < 2', "scripts/a.py"), [])

    def test_python_and_shell(self):
        python = self.lines("def f(x):\n    x.append(3)\n    return x if 1 < 2 and not x else x[0]", "scripts/a.py")
        for fault in (("left out", 2, "pass"), ("constant", 2, "x.append(4)"),
                      ("logic", 3, "return x if 1 < 2 or not x else x[0]"),
                      ("logic", 3, "return x if 1 < 2 and x else x[0]")):
            self.assertIn(fault, python)
        self.assertIn(("logic", 1, "[[ -e a ]] && make"), self.lines("[[ -e a ]] || make", "scripts/a.sh"))

    def test_numbers_go_off_a_little(self):
        self.assertEqual([fault_kinds.other_number(text) for text in ("0", "7", "0.5", "0.0", "1e-6")],
                         ["1", "8", "0.55", "0.1", "1.1e-06"])

    def test_the_draw_is_that_of_its_seed(self):
        sources = {f"{floor}/a.cpp": CODE for floor in ("kernels", "verify", "driver")}
        one, same, other = (list(itertools.islice(fault_kinds.draw(sources, seed), 20)) for seed in (1, 1, 2))
        self.assertEqual(one, same)
        self.assertNotEqual(one, other)
        self.assertEqual(len(set(one)), 20)
        self.assertEqual({fault_kinds.floor_of(fault.file) for fault in one}, {"kernels", "verify", "driver"})

    def test_sources(self):
        self.assertTrue(fault_kinds.is_source("kernels/model/ball.cpp"))
        self.assertTrue(fault_kinds.is_source("scripts/test.sh"))
        for name in ("verify/tests/a.cpp", "bench/a.cpp", "scripts/trials/faults.py", "driver/README.md"):
            self.assertFalse(fault_kinds.is_source(name), name)

    def test_a_fault_goes_where_its_line_is_now(self):
        fault = fault_kinds.Fault("a", 4, "constant", "b = 1", "b = 2")
        self.assertEqual(fault_kinds.put_in("b = 1\na\nx\ny\nb = 1\n", fault), "b = 1\na\nx\ny\nb = 2\n")
        self.assertIsNone(fault_kinds.put_in("b = 11\n", fault))


class Page(unittest.TestCase):
    def row(self, number, seen_by, before="a < b", file="kernels/a.cpp"):
        return dict(zip(faults.COLUMNS, ("1", str(number), file, "7", "comparison", f"  {before}", "  a <= b | c",
                                         seen_by, "3", "c0ffee")))

    def test_rows_are_counted_and_explained(self):
        rows = [self.row(1, "a_test: A.B"), self.row(2, faults.NOT_SEEN), self.row(3, faults.NOT_SEEN, "c < d"),
                self.row(4, "b_test", file="driver/b.cpp")]
        text = faults.markdown(rows, {("kernels/a.cpp", "c < d", "a <= b | c"): "they never meet"})
        self.assertIn("| kernels | 3 | 1 | 1 | 1 | 33 % |", text)
        self.assertIn("| driver | 1 | 1 | 0 | 0 | 100 % |", text)
        self.assertIn("| all | 4 | 2 | 1 | 1 | 50 % |", text)
        self.assertIn("| kernels/a.cpp:7 | comparison | `a < b` | `a <= b \\| c` | **no test sees it** |", text)
        self.assertIn("| they never meet |", text)
        self.assertIn("| `a <= b \\| c` | a_test: A.B |", text)

    def test_rows_are_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "faults.csv"
            self.assertEqual(faults.read_rows(path), [])
            rows = [self.row(1, 'a "test", b'), self.row(2, faults.NOT_SEEN)]
            faults.write_rows(path, rows)
            self.assertEqual(faults.read_rows(path), rows)
            self.assertEqual([each.name for each in Path(folder).iterdir()], ["faults.csv"])
            done = run_here(SCRIPTS / "trials" / "faults.py", "--table", "--out", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("| all | 2 | 1 | 0 | 1 | 50 % |", (Path(folder) / "faults.md").read_text())
            path.write_text("seed,number\n1,2\n")
            self.assertRaises(faults.InputError, faults.read_rows, path)

    def test_bad_input(self):
        for words, complaint in ((("--faults", "0"), "allowed is 1 or more"), (("--jobs", "0"), "allowed is 1 or more")):
            done = run_here(SCRIPTS / "trials" / "faults.py", *words)
            self.assertEqual(done.returncode, 2)
            self.assertIn(complaint, done.stderr)

    def test_what_failed_is_named(self):
        self.assertEqual(faults.failure_of("x\n[  FAILED  ] A/B.C/0, where x (3 ms)\n"), "A/B.C/0")
        self.assertEqual(faults.failure_of("FAIL: test_it (x.Y.test_it)\n"), "test_it")
        self.assertEqual(faults.failure_of("no"), "")

    def test_explanations_are_read(self):
        self.assertIsInstance(faults.read_explained(), dict)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "e.toml"
            path.write_text('[[fault]]\nfile = "a"\nbefore = " b"\nafter = "c "\nwhy = "d"\n')
            self.assertEqual(faults.read_explained(path), {("a", "b", "c"): "d"})
            path.write_text('[[fault]]\nfile = "a"\n')
            self.assertRaises(faults.InputError, faults.read_explained, path)


if __name__ == "__main__":
    unittest.main()
