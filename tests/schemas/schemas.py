"""The schemas as a program uses them; a missing package ends a test as skipped (77)."""
import copy
import json
import pathlib
import sys

try:
    import jsonschema
    import yaml  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is missing (Debian: python3-jsonschema, python3-yaml)")
    sys.exit(77)

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "schemas"
SCHEMAS = {file.name: json.loads(file.read_text()) for file in sorted(FOLDER.glob("*.schema.json"))}


def parts(schema):
    """All schemas within a schema, itself included."""
    if isinstance(schema, dict):
        yield schema
        for key, inner in schema.items():
            if key not in ("const", "enum", "default"):
                yield from parts(inner)
    elif isinstance(schema, list):
        for inner in schema:
            yield from parts(inner)


def objects(schema):
    """The mappings with named keys; conditions (`if`) are none."""
    for part in parts({key: inner for key, inner in schema.items() if key not in ("if", "then", "else")}):
        if isinstance(part.get("properties"), dict) and part.get("type") in ("object", ["object", "null"]):
            yield part


def closed(schemas):
    """The same schemas without room for keys that they do not name."""
    result = copy.deepcopy(schemas)
    for schema in result.values():
        for part in list(objects(schema)):
            if part is not schema and part is not schema.get("$defs", {}).get("plan"):
                part["additionalProperties"] = False
        schema["unevaluatedProperties"] = False
    return result


def others(name, schemas):
    """How a validator finds the schemas that one refers to: a registry since jsonschema 4.18, a resolver before."""
    try:
        from referencing import Registry, Resource
    except ImportError:
        return {"resolver": jsonschema.RefResolver(name, schemas[name], store=schemas)}
    return {"registry": Registry().with_resources((file, Resource.from_contents(schema)) for file, schema in schemas.items())}


def errors(name, document, schemas=SCHEMAS):
    validator = jsonschema.Draft202012Validator(schemas[name], **others(name, schemas))
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in validator.iter_errors(document)]
