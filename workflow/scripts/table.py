# A line for each point of each rig: its keys, and every number in the command's answer.
import csv
import json
from pathlib import Path


def numbers(value, name=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numbers(inner, f"{name}.{key}" if name else key)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield name, value


rows = []
for file in map(Path, snakemake.input):
    point = snakemake.params.points[file.parent.name]
    rows.append({"rig": file.parent.parent.name, **point, **dict(numbers(json.loads(file.read_text())))})
names = list(dict.fromkeys(name for row in rows for name in row))
with open(snakemake.output[0], "w", newline="") as table:
    writer = csv.DictWriter(table, names)
    writer.writeheader()
    writer.writerows(rows)
