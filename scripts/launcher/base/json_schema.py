# SPDX-License-Identifier: Apache-2.0
"""Compares JSON with a schema of docs/schemas, without a package for that. Knows only the words that these schemas use.

A field that the schema does not know is accepted, because a format may get fields without a new version. All numbers must
be finite, and a whole number must fit 64 bits, because other numbers come from a fault.
"""

import math
import re

MOST = 2 ** 63 - 1
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def is_type(value, name):
    """Returns whether `value` has the type of JSON with this name."""
    if name == "integer":
        return type(value) is int and -MOST <= value <= MOST
    if name == "number":
        return is_type(value, "integer") or (type(value) is float and math.isfinite(value))
    return isinstance(value, TYPES[name])


def shown(value):
    """Returns the beginning of a value for a message."""
    return repr(value)[:40]


def fault(value, schema, whole=None, path=""):
    """Returns what is wrong with `value` as words that begin with the path of the field, or None."""
    whole = whole or schema
    if "$ref" in schema:
        return fault(value, whole["definitions"][schema["$ref"].rpartition("/")[2]], whole, path)
    where = path.lstrip(".") or "it"
    if "oneOf" in schema:
        faults = [fault(value, one, whole, path) for one in schema["oneOf"]]
        return None if None in faults else faults[0]
    types = schema.get("type")
    types = [types] if isinstance(types, str) else types
    if types and not any(is_type(value, name) for name in types):
        return f"{where} must be {' or '.join(types)}, got {shown(value)}"
    if "const" in schema and (type(value) is not type(schema["const"]) or value != schema["const"]):
        return f"{where} must be {schema['const']}, got {shown(value)}"
    if "enum" in schema and value not in schema["enum"]:
        return f"{where} must be one of {', '.join(map(str, schema['enum']))}, got {shown(value)}"
    if "minimum" in schema and value is not None and value < schema["minimum"]:
        return f"{where} must be {schema['minimum']} or more, got {shown(value)}"
    if "exclusiveMinimum" in schema and value is not None and value <= schema["exclusiveMinimum"]:
        return f"{where} must be more than {schema['exclusiveMinimum']}, got {shown(value)}"
    if "pattern" in schema and not re.search(schema["pattern"], value):
        return f"{where} must match {schema['pattern']}, got {shown(value)}"
    if isinstance(value, dict):
        return fault_of_object(value, schema, whole, path)
    if isinstance(value, list):
        if len(value) < schema.get("minItems", 0):
            return f"{where} has {len(value)} of at least {schema['minItems']} items"
        return next((found for index, item in enumerate(value) if "items" in schema and
                     (found := fault(item, schema["items"], whole, f"{path}[{index}]"))), None)
    return None


def fault_of_object(value, schema, whole, path):
    for name in schema.get("required", ()):
        if name not in value:
            return f"{(path + '.' + name).lstrip('.')} is missing"
    others = schema.get("additionalProperties")
    for name, inner in value.items():
        known = schema.get("properties", {}).get(name, others if isinstance(others, dict) else None)
        if known is not None and (found := fault(inner, known, whole, f"{path}.{name}")):
            return found
    return None
