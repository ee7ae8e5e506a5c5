"""The JSON of every command against the schema that `slipmap schema` prints of it.

In the folder stand COMMAND.schema.json, and any number of COMMAND.NAME.json of that command."""

import copy
import json
import pathlib
import sys

from jsonschema import Draft202012Validator

folder = pathlib.Path(sys.argv[1])
schemas = sorted(folder.glob("*.schema.json"))
assert schemas, f"no schemas in {folder}"
for path in schemas:
    command = path.name.removesuffix(".schema.json")
    schema = json.loads(path.read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    answers = [p for p in sorted(folder.glob(f"{command}.*.json")) if p != path]
    assert answers, f"no answers of {command}"
    for answer in answers:
        value = json.loads(answer.read_text())
        errors = [f"{answer.name} {e.json_path}: {e.message[:300]}" for e in validator.iter_errors(value)]
        assert not errors, "\n".join(errors)
        assert value["inputs"], f"{answer.name} does not say what was asked"
        # A schema that lets anything pass would let these pass too.
        changes = [(key, None) for key in ("schema_version", "inputs")]
        changes += [(key, {"odd": 1}) for key, old in value.items() if isinstance(old, (bool, int, float, str, list))]
        changes.append(("odd", 1))
        for key, new in changes:
            changed = copy.deepcopy(value)
            changed.pop(key, None)
            if new is not None:
                changed[key] = new
            assert not validator.is_valid(changed), f"{answer.name} is valid with {key} = {new}"
