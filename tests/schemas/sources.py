"""What the C++ sources say of the problem file: keys, words, units, and the bad files of its tests."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"')
ESCAPES = {"n": "\n", "t": "\t", '"': '"', "\\": "\\", "'": "'"}


def texts(cpp):
    """The string literals of a piece of C++, unescaped."""
    return [re.sub(r"\\(.)", lambda m: ESCAPES[m[1]], found) for found in LITERAL.findall(cpp)]


def readers():
    """Of the problem file; the parameters file is another one."""
    return {file.name: file.read_text() for file in sorted((ROOT / "src/problem").glob("*.cpp"))
            if not file.name.startswith("calibrated_")}


def allowed_keys():
    """One set of keys for every allow({…}) of the readers and every mapping of the table of the design's keys; a name in
    place of a literal stands for either of its values."""
    below = {}
    for path in re.findall(r'\{"(design\.[a-z_.]+)"', readers()["design_keys.cpp"]):
        mapping, _, key = path.rpartition(".")
        below.setdefault(mapping, set()).add(key)
    found = {frozenset(keys) for keys in below.values()}
    of_instruments = texts(re.search(r"^void allow_instrument\(.*?^}", readers()["read_measurement.cpp"], re.S | re.M)[0])
    for text in readers().values():
        for call, arguments in re.findall(r"(\.allow\(|\ballow_instrument\(section, )\s*\{(.*?)\}\s*\)", text, re.S):
            keys = set(texts(arguments)) | (set(of_instruments) if call.startswith("allow_") else set())
            for name in re.findall(r"(?<![\w\"])([a-z_]+)(?![\w\"])", LITERAL.sub("", arguments)):
                for pair in re.findall(rf"\b{name} = \w+ \? \"(\w+)\" : \"(\w+)\"", text):
                    found.update(frozenset(keys | {one}) for one in pair)
                break
            else:
                found.add(frozenset(keys))
    # Stands in a message only: an arm has no model.
    return {keys for keys in found if not {"urdf", "model"} <= keys}


def asked_keys():
    """Every key that some reader asks for by name."""
    found = set()
    for text in readers().values():
        found.update(re.findall(r"(?:\.at|\.find|\.has)\(\"(\w+)\"\)", text))
    return found


def choices():
    found = set()
    for text in readers().values():
        found.update(frozenset(texts(words)) for words in re.findall(r"choice\(\s*\{(.*?)\}", text, re.S))
    return found


def models():
    return set(re.findall(r'\{"(\w+)", \[\]\(const Section& robot\)', readers()["read_robot.cpp"]))


def units():
    found = {}
    for unit, quantity in re.findall(r'\{"([^"]+)", Quantity::(\w+), ', readers()["units.cpp"]):
        found.setdefault(quantity, set()).add(unit)
    return found


def good_files():
    text = (ROOT / "tests/problem/example_files.hpp").read_text()
    return dict(re.findall(r'inline const std::string (\w+) =\s*R"\((.*?)\)";', text, re.S))


def parameters_file():
    """The good parameters file of the tests and the changes that spoil it, with their messages."""
    source = (ROOT / "tests/problem/calibrated_parameters_test.cpp").read_text()
    good = re.search(r'const std::string good_parameters = R"\((.*?)\)";', source, re.S)[1]
    literal = r'"((?:[^"\\]|\\.)*)"'
    rows = re.findall(rf'\{{{literal},\s*{literal},\s*{literal}\}}', source)
    unescaped = [[re.sub(r"\\(.)", lambda m: ESCAPES[m[1]], text) for text in row] for row in rows]
    return good, [(good.replace(before, after, 1), message) for before, after, message in unescaped]


def bad_files():
    """(name, text, message) of every row of the tests' tables."""
    good = good_files()
    good = {"arm": good["serial"], "platform": good["six_pus"], "cell": good["cell"]}
    source = (ROOT / "tests/problem/bad_files_test.cpp").read_text()
    literal = r'((?:"(?:[^"\\]|\\.)*"\s*)+)'
    row = rf'\{{"(\w+)", (\w+),\s*(?:{literal}|\w+\.c_str\(\)),\s*{literal},\s*(\d+),\s*{literal}\}}'
    for name, base, before, after, _, message in re.findall(row, source):
        before = "".join(texts(before)) if before else good[base]
        if before not in good[base]:
            raise ValueError(f"{name}: the good file has no {before!r}")
        yield name, good[base].replace(before, "".join(texts(after)), 1), "".join(texts(message))
