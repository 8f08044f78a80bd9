# One command over rigs and values of their keys.
import itertools
import re
import shlex

RIGS = config.get("rigs") or {}
AXES = config.get("set") or {}


def point_name(values):
    text = "_".join(f"{key}={value}" for key, value in zip(AXES, values))
    return re.sub(r"[^A-Za-z0-9_.=+-]", "-", text) or "as-it-is"


# Each combination of values, by its name.
POINTS = {point_name(values): dict(zip(AXES, values)) for values in itertools.product(*AXES.values())} if RIGS else {}


def settings(wildcards):
    return " ".join("--set " + shlex.quote(f"{key}={value}") for key, value in POINTS[wildcards.point].items())


wildcard_constraints:
    rig="|".join(map(re.escape, RIGS)) or "none",
    point="|".join(map(re.escape, POINTS)) or "none",


# The folder keeps what a run that was stopped had done, and the command goes on there: so the folder
# itself is no output, which Snakemake would remove.
rule rig:
    input:
        rig=lambda wildcards: RIGS[wildcards.rig],
        tables=config.get("tables") or [],
    output:
        image="results/rigs/{rig}/{point}/image.exr",
        answer="results/rigs/{rig}/{point}/answer.json",
        preview=report(
            "results/rigs/{rig}/{point}/preview.png",
            category="{rig}",
            labels=lambda wildcards: {key: str(value) for key, value in POINTS[wildcards.point].items()},
        ),
    log:
        "logs/rigs/{rig}/{point}.log",
    params:
        settings=settings,
        command=config.get("command", "render"),
        arguments=config.get("arguments", ""),
        folder=lambda wildcards, output: os.path.dirname(output.image),
    threads: config.get("threads", 1)
    retries: 2
    shell:
        "{config[aphotic]} {params.command} {input.rig:q} {params.settings} {params.arguments}"
        " --jobs {threads} --json -o {params.folder:q} > {output.answer:q} 2> {log:q}"


# A line for each rig and point: the keys, and the numbers that the command tells.
rule table:
    input:
        expand("results/rigs/{rig}/{point}/answer.json", rig=RIGS, point=POINTS),
    output:
        report("results/rigs.csv", category="all"),
    params:
        points=POINTS,
    script:
        "../scripts/table.py"
