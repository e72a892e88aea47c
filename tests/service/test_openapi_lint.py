"""A lint of api/openapi.yaml: what reads well as YAML and is another document than was meant."""
from pathlib import Path

import pytest
import yaml

DOCUMENT = Path(__file__).resolve().parents[2] / "api/openapi.yaml"
# OpenAPI 3.1's members of each kind of object, and JSON Schema's; those with x- are the document's own.
OPERATION = {"tags", "operationId", "summary", "description", "security", "parameters", "requestBody", "responses"}
PARAMETER = {"name", "in", "required", "description", "schema", "example", "style", "explode"}
SCHEMA = {"type", "description", "title", "enum", "const", "default", "example", "examples", "format", "properties", "required", "items",
          "additionalProperties", "unevaluatedProperties", "propertyNames", "minProperties", "maxProperties", "minItems",
          "maxItems", "minLength", "maxLength", "pattern", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "oneOf",
          "anyOf", "allOf", "not", "$ref", "prefixItems"}
MAPS, LISTS = {"properties"}, {"oneOf", "anyOf", "allOf", "prefixItems"}
SUBSCHEMAS = {"items", "additionalProperties", "unevaluatedProperties", "propertyNames", "not"}


class UniqueKeys(yaml.CSafeLoader):
    """Without this the second of two equal keys silently wins."""

    def construct_mapping(self, node, deep=False):
        keys = [self.construct_object(key, deep=True) for key, _ in node.value]
        twice = {str(key) for key in keys if keys.count(key) > 1}
        if twice:
            raise yaml.constructor.ConstructorError(None, None, f"{twice} twice", node.start_mark)
        return super().construct_mapping(node, deep)


def faults_of_schema(schema, place):
    if isinstance(schema, bool):
        return
    if not isinstance(schema, dict):
        yield f"{place} is {schema!r}, no schema"
        return
    for name in schema:
        if name not in SCHEMA and not str(name).startswith("x-"):
            yield f"{place} has {name!r}, which is no member of a schema"
    if "$ref" in schema and len(schema) > 1:
        yield f"{place} has members beside its $ref"
    if "array" in (schema.get("type") if isinstance(schema.get("type"), list) else [schema.get("type")]) and "items" not in schema:
        yield f"{place} is a list of nobody knows what"
    if schema.get("type") == "object" and not {"properties", "additionalProperties", "allOf", "oneOf", "unevaluatedProperties"} & set(schema):
        yield f"{place} is an object that generated clients take for an empty one"
    if not isinstance(schema.get("description", ""), str):
        yield f"{place} has a description that is no text"
    for name in set(schema.get("required", [])) - set(schema.get("properties", {})):
        if "properties" in schema and "allOf" not in schema:
            yield f"{place} requires {name}, which it does not have"
    for name in MAPS & set(schema):
        for member, inner in schema[name].items():
            yield from faults_of_schema(inner, f"{place}/{name}/{member}")
    for name in LISTS & set(schema):
        for i, inner in enumerate(schema[name]):
            yield from faults_of_schema(inner, f"{place}/{name}/{i}")
    for name in SUBSCHEMAS & set(schema):
        yield from faults_of_schema(schema[name], f"{place}/{name}")


def faults_of_content(content, place):
    for media, body in content.items():
        if set(body) - {"schema", "example"}:
            yield f"{place} {media} has {set(body)}"
        yield from faults_of_schema(body["schema"], f"{place} {media}")


def faults_of_parameter(parameter, place):
    if "$ref" in parameter:
        if len(parameter) > 1:
            yield f"{place} has members beside its $ref"
        return
    if set(parameter) - PARAMETER:
        yield f"{place} has {set(parameter) - PARAMETER}"
    yield from faults_of_schema(parameter["schema"], place)


def faults_of_response(response, place):
    if "$ref" in response:
        if len(response) > 1:
            yield f"{place} has members beside its $ref"
        return
    if set(response) - {"description", "headers", "content"} or not isinstance(response.get("description"), str):
        yield f"{place} has {set(response)}"
    yield from faults_of_content(response.get("content", {}), place)


def faults_of(document):
    for name, schema in document["components"]["schemas"].items():
        yield from faults_of_schema(schema, name)
    for name, parameter in document["components"]["parameters"].items():
        yield from faults_of_parameter(parameter, name)
    for name, response in document["components"]["responses"].items():
        yield from faults_of_response(response, name)
    for path, item in document["paths"].items():
        for parameter in item.get("parameters", []):
            yield from faults_of_parameter(parameter, path)
        for method, operation in item.items():
            if method == "parameters":
                continue
            place = f"{method} {path}"
            if set(operation) - OPERATION:
                yield f"{place} has {set(operation) - OPERATION}"
            for parameter in operation.get("parameters", []):
                yield from faults_of_parameter(parameter, place)
            yield from faults_of_content(operation.get("requestBody", {}).get("content", {}), place)
            for status, response in operation["responses"].items():
                if not isinstance(status, str):
                    yield f"{place} has the status {status!r}, no text"
                yield from faults_of_response(response, f"{place} {status}")


def test_the_document_has_no_faults():
    assert list(faults_of(yaml.load(DOCUMENT.read_text(), UniqueKeys))) == []


@pytest.mark.parametrize("fault, told", [
    ("type: number, description: s of wall clock, when it was submitted", "when it was submitted"),
    ("type: array, minItems: 1", "nobody knows what"),
    ("type: object, description: whatever", "empty one"),
    ("$ref: '#/components/schemas/Label', description: also", "beside its $ref"),
    ("type: object, properties: {a: {typ: string}}", "typ"),
    ("type: object, required: [b], properties: {a: {}}", "requires b"),
])
def test_the_lint_finds(fault, told):
    found = list(faults_of_schema(yaml.safe_load(f"{{{fault}}}"), "here"))
    assert len(found) == 1 and told in found[0]
