"""Small faults, each such as a tired programmer makes: where in a source they could stand, and what they would make of
its line. Text in quotes and comments is left alone, as are includes, directives of the preprocessor and declarations
that only name things."""

import random
import re
from dataclasses import dataclass

# Operators stand between blanks (clang-format), so that < and > of templates and of includes do not match.
EXCHANGES = {
    "comparison": [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" == ", " != "),
                   (" != ", " == "), (" -eq ", " -ne "), (" -lt ", " -le "), (" in ", " not in ")],
    "sign": [(" + ", " - "), (" - ", " + "), (" += ", " -= "), (" -= ", " += "), (" * ", " / "), (" / ", " * "),
             ("++", "--")],
    "logic": [(" && ", " || "), (" || ", " && "), (" and ", " or "), (" or ", " and "), ("true", "false"),
              ("false", "true"), ("True", "False"), ("False", "True")],
    "index": [(".x", ".y"), (".y", ".x"), (".vx", ".vy"), (".vy", ".vx"), (".first", ".second"), (".second", ".first"),
              ("[0]", "[1]"), ("[1]", "[0]"), ("[i]", "[j]"), ("[j]", "[i]"), (".front()", ".back()"),
              (".back()", ".front()")],
    "extreme": [("std::min(", "std::max("), ("std::max(", "std::min("), ("min_element(", "max_element("),
                ("max_element(", "min_element("), ("std::ceil(", "std::floor("), ("std::floor(", "std::ceil("),
                (" min(", " max("), (" max(", " min(")],
}
NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?)(?![\w.])")
MINUS = re.compile(r"(?<=[(,=] )-(?=[\w(])|(?<=\()-(?=[\w(])|(?<=return )-(?=[\w(])")
NOT = re.compile(r"(?<![\w)!])!(?=[\w(])|\bnot (?!in\b)")
# Not where the order does not matter.
TWO_WORDS = re.compile(r"(?<!min)(?<!max)(?<!hypot)(?<!swap)\((\w+(?:\.\w+)?), (\w+(?:\.\w+)?)\)")
STATEMENT = {  # whole statements of a line, that could be forgotten
    "c++": re.compile(r"^\s+(?!return\b|throw\b|using\b|const\b|auto\b|case\b|break\b|else\b|template\b|friend\b)"
                      r"(?:[\w.>\-\[\]():]+(?:<\w+>)?\(.*\)|[\w.>\-\[\]()]+ [-+*/|]?= [^{]*|\+\+[\w.\-\[\]]+);$"),
    "python": re.compile(r"^\s+(?!return\b|raise\b|import\b|from\b|def\b|yield\b|with\b|for\b|if\b|assert\b)"
                         r"(?:[\w.\[\]]+\(.*\)|[\w.\[\]\"']+ [-+|]?= .*[^\\(\[{,])$"),
    "shell": re.compile(r"^\s+(?!if\b|fi\b|then\b|else\b|do\b|done\b|for\b|while\b|case\b|esac\b|local\b)\w[^#(){}|&\\]*$"),
}
STRINGS = {"c++": re.compile(r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)\'|//.*$'),
           "python": re.compile(r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)*\'|#.*$'),
           "shell": re.compile(r"'[^']*'|(?:^|\s)#.*$")}
LEFT_ALONE = {"c++": re.compile(r"^\s*(?:#|template\b|using\b|namespace\b|static_assert|friend\b|///)|\boverride\b"),
              "python": re.compile(r"^\s*(?:import|from|@|\"\"\"|class\b)"), "shell": re.compile(r"^\s*(?:set -|#)")}


@dataclass(frozen=True)
class Fault:
    """A line of a file, and what it becomes."""
    file: str
    line: int  # from 1
    kind: str
    before: str
    after: str


def language_of(name):
    return {"cpp": "c++", "hpp": "c++", "py": "python", "sh": "shell"}.get(name.rsplit(".", 1)[-1])


def blanked(line, language):
    """The line with its quoted texts and comments as blanks, so that places stay."""
    return STRINGS[language].sub(lambda found: "\0" * len(found.group()), line)


def other_number(text):
    """A number that is a little off: the next whole one, or a tenth more."""
    if re.fullmatch(r"\d+", text):
        return str(int(text) + 1)
    value = 1.1 * float(text)
    return repr(value) if value else "0.1"


def changes(line, language):
    """All faults of one line: kind, and the line they make."""
    code = blanked(line, language)

    def exchanged(start, end, text):
        return line[:start] + text + line[end:]

    for kind, pairs in EXCHANGES.items():
        for old, new in pairs:
            # A word, or the name of a member, is whole.
            pattern = ("" if not old[0].isalnum() else r"\b") + re.escape(old) + ("" if not old[-1].isalnum() else r"\b")
            for found in re.finditer(pattern, code):
                yield kind, exchanged(found.start(), found.end(), new)
    for found in NUMBER.finditer(code):
        yield "constant", exchanged(*found.span(), other_number(found.group()))
    for found in MINUS.finditer(code):
        yield "sign", exchanged(*found.span(), "")
    for found in NOT.finditer(code):
        yield "logic", exchanged(*found.span(), "")
    for found in TWO_WORDS.finditer(code):
        if found[1] != found[2] and not found[1].isdigit():
            yield "order", exchanged(*found.span(), f"({found[2]}, {found[1]})")
    if STATEMENT[language].match(code) and code.count("(") == code.count(")"):
        indent = line[:len(line) - len(line.lstrip())]
        yield "left out", indent + {"c++": ";", "python": "pass", "shell": ":"}[language]


def faults_of(name, text):
    """All faults of a file."""
    language = language_of(name)
    in_docstring = False
    for number, line in enumerate(text.splitlines(), 1):
        quotes = line.count('"""') if language == "python" else 0
        if in_docstring or quotes:
            in_docstring ^= quotes % 2 == 1
            continue
        if LEFT_ALONE[language].search(line):
            continue
        for kind, after in changes(line, language):
            yield Fault(name, number, kind, line, after)


def draw(sources, seed):
    """Faults without end, by turns of chance: a floor (with the weights of FLOORS), a kind, a fault. `sources`: name to
    text. The same for the same sources and seed."""
    chance = random.Random(seed)
    floors = {floor: {} for floor in FLOORS}
    for name in sorted(sources):
        for fault in faults_of(name, sources[name]):
            floors[floor_of(name)].setdefault(fault.kind, []).append(fault)
    floors = {floor: kinds for floor, kinds in floors.items() if kinds}
    seen = set()
    for _ in range(100 * sum(len(of_kind) for kinds in floors.values() for of_kind in kinds.values())):
        floor = chance.choices(list(floors), [FLOORS[each] for each in floors])[0]
        kind = chance.choice(sorted(floors[floor]))
        fault = chance.choice(floors[floor][kind])
        if fault not in seen:
            seen.add(fault)
            yield fault


FLOORS = {"kernels": 3, "verify": 3, "driver": 3, "scripts": 1}


def floor_of(name):
    return name.split("/", 1)[0]


def is_source(name):
    """Whether faults are put into that file: not into tests, their scenes and benchmarks, nor into this."""
    return (floor_of(name) in FLOORS and language_of(name) is not None and not name.startswith("verify/tests/")
            and not name.startswith(("scripts/trials/fault", "verify/oracle/wall_scenes")))


def put_in(text, fault):
    """The text with the fault; None if its line is no more. The line nearest to its number is taken."""
    lines = text.splitlines(keepends=True)
    places = [k for k, line in enumerate(lines) if line.rstrip("\r\n") == fault.before]
    if not places:
        return None
    place = min(places, key=lambda k: abs(k + 1 - fault.line))
    lines[place] = lines[place].replace(fault.before, fault.after, 1)
    return "".join(lines)
