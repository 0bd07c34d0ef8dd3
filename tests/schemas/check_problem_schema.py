"""The schemas are valid, and the one of the problem file says what the readers in src/problem say."""
import json
import re
import unittest

import plain_yaml
import sources
from schemas import SCHEMAS, errors, jsonschema, objects, parts

PROBLEM = SCHEMAS["problem.schema.json"]
EXAMPLES = sorted((sources.ROOT / "examples").glob("*/*.yaml")) + sorted((sources.ROOT / "examples").glob("*.yaml"))
# Refused for reasons that no schema can state: form of the YAML text, order of numbers, names that must exist.
BEYOND_STRUCTURE = (
    "valid YAML", "second YAML document", "duplicate key", "a key of robot is a list", "control characters",
    "lower < upper", "is an empty range", "empty range", "both ends need the same unit", "already has the name",
    "(nearly) horizontal", "has no sampler", "half turn", "is one place", "from 1 to 6", "is '2e4'",
    "allowed: geometric, everything")
QUANTITIES = {
    "length": {"length"}, "angle": {"angle"}, "joint_value": {"length", "angle"}, "force": {"force"},
    "compliance": {"compliance"}, "stiffness": {"stiffness"}, "time": {"time"}, "velocity": {"turn_rate", "speed"},
    "acceleration": {"turn_acceleration", "acceleration"},
    "parameter_value": {"length", "angle", "force", "compliance", "stiffness"}}


def words(part):
    if "const" in part:
        return {part["const"]}
    return set(part.get("enum", []))


class Schemas(unittest.TestCase):
    def test_are_valid_schemas(self):
        for name, schema in SCHEMAS.items():
            jsonschema.Draft202012Validator.check_schema(schema)
            self.assertEqual(schema["$id"], name)

    def test_every_reference_leads_somewhere(self):
        for name, schema in SCHEMAS.items():
            for part in parts(schema):
                if not isinstance(part.get("$ref"), str):
                    continue
                file, _, pointer = part["$ref"].partition("#/")
                target = SCHEMAS[file or name]
                for step in pointer.split("/") if pointer else []:
                    self.assertIn(step, target, part["$ref"])
                    target = target[step]

    def test_every_definition_is_used(self):
        text = "".join(json.dumps(schema) for schema in SCHEMAS.values())
        for schema in SCHEMAS.values():
            for name in schema.get("$defs", {}):
                self.assertIn(f"#/$defs/{name}\"", text, name)

    def test_every_key_is_explained(self):
        for name, schema in SCHEMAS.items():
            for part in objects(schema):
                for key, inner in part["properties"].items():
                    self.assertIn("description", inner, f"{name}: {key}")


class ProblemSchema(unittest.TestCase):
    def test_has_the_keys_of_the_readers_and_no_others(self):
        here = {frozenset(part["properties"]) for part in objects(PROBLEM)}
        there = sources.allowed_keys()
        self.assertEqual({tuple(sorted(s)) for s in here - there}, set(), "in the schema only")
        self.assertEqual({tuple(sorted(s)) for s in there - here}, set(), "in src/problem only")
        self.assertEqual(sources.asked_keys() - set().union(*here), set(), "asked for, but allowed nowhere")

    def test_refuses_other_keys_everywhere(self):
        for part in objects(PROBLEM):
            self.assertIs(part.get("additionalProperties"), False, sorted(part["properties"]))

    def test_has_the_words_of_the_readers(self):
        here = {frozenset(str(word).lower() if word in (True, False) else word for word in part["enum"])
                for part in parts(PROBLEM) if "enum" in part}
        for part in parts(PROBLEM):  # alternatives that are told apart by their type
            for alternatives in [part.get("anyOf", [])]:
                inner = [PROBLEM["$defs"].get(a.get("$ref", "").split("/")[-1], a) for a in alternatives]
                types = [words(i["properties"]["type"]) for i in inner if "type" in i.get("properties", {})]
                here.add(frozenset().union(*types))
        for part in objects(PROBLEM):
            if "type" in part["properties"]:
                here.add(frozenset(words(part["properties"]["type"])))
        for choice in sources.choices():
            self.assertIn(choice, here)
        models = [part["properties"]["model"]["const"] for part in objects(PROBLEM) if "model" in part["properties"]]
        self.assertEqual(sorted(models), sorted(sources.models()))

    def test_has_the_units_of_the_readers(self):
        units, seen = sources.units(), set()
        for name, part in PROBLEM["$defs"].items():
            match = re.search(r"\(([^()]*)\)\?\[ \\t\]\*\$$", part.get("pattern", ""))
            if not match:
                continue
            quantity = re.sub(r"_(positive|not_negative)$", "", name)
            expected = set().union(*(units[q] for q in QUANTITIES[quantity]))
            self.assertEqual(set(match[1].split("|")), expected, name)
            seen |= QUANTITIES[quantity]
        self.assertEqual(seen, set(units))

    def test_accepts_all_examples_and_the_files_with_every_key(self):
        self.assertGreater(len(EXAMPLES), 10)
        for file in EXAMPLES:
            self.assertEqual(errors("problem.schema.json", plain_yaml.load(file.read_text())), [], file)
        for name, text in sources.good_files().items():
            self.assertEqual(errors("problem.schema.json", plain_yaml.load(text)), [], name)

    def test_examples_name_the_schema(self):
        for file in EXAMPLES:
            match = re.match(r"# yaml-language-server: \$schema=(\S+)\n", file.read_text())
            self.assertTrue(match, f"{file}: the first line does not name the schema")
            self.assertTrue((file.parent / match[1]).samefile(sources.ROOT / "schemas/problem.schema.json"), file)

    def test_refuses_what_the_readers_refuse(self):
        refused = 0
        for name, text, message in sources.bad_files():
            if any(word in message for word in BEYOND_STRUCTURE):
                continue
            with self.subTest(name):
                refused += 1
                self.assertNotEqual(errors("problem.schema.json", plain_yaml.load(text)), [], message)
        self.assertGreater(refused, 90)


class ParametersSchema(unittest.TestCase):
    def test_accepts_and_refuses_what_the_reader_does(self):
        good, bad = sources.parameters_file()
        self.assertEqual(errors("parameters.schema.json", plain_yaml.load(good)), [])
        self.assertGreater(len(bad), 8)
        for text, message in bad:
            if "duplicate key" in message:  # beyond structure
                continue
            with self.subTest(message):
                self.assertNotEqual(errors("parameters.schema.json", plain_yaml.load(text)), [])

    def test_has_the_keys_of_the_reader(self):
        reader = (sources.ROOT / "src/problem/calibrated_parameters.cpp").read_text()
        asked = set(re.findall(r"\.(?:at|find)\(\"(\w+)\"\)", reader))
        known = set().union(*(part["properties"] for part in objects(SCHEMAS["parameters.schema.json"])))
        self.assertEqual(asked - known, set())
        self.assertEqual(asked, {"posewright_parameters", "variant", "convention", "unmodelled", "size", "length", "parameters", "value",
                                 "unit", "nominal"})


if __name__ == "__main__":
    unittest.main()
