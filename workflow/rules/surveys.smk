# Surveys, each corrected in shares of its images and joined.
SURVEYS = config.get("surveys") or {}


def correct_of(wildcards):
    survey = SURVEYS[wildcards.survey]
    return f"{config['aphotic']} correct {survey['images']} --rig {survey['rig']} {survey.get('arguments', '')}"


def shares_of(wildcards):
    shares = SURVEYS[wildcards.survey].get("shares", 1)
    return [f"results/shares/{wildcards.survey}/{share}-of-{shares}.done" for share in range(1, shares + 1)]


wildcard_constraints:
    survey="|".join(map(re.escape, SURVEYS)) or "none",


# Images that are skipped are an answer (status 1) that the joining command gives for all.
rule share:
    input:
        rig=lambda wildcards: SURVEYS[wildcards.survey]["rig"],
    output:
        touch("results/shares/{survey}/{share}-of-{shares}.done"),
    log:
        "logs/surveys/{survey}/{share}-of-{shares}.log",
    params:
        correct=correct_of,
    threads: config.get("threads", 1)
    retries: 2
    shell:
        "{params.correct} --jobs {threads} -o results/surveys/{wildcards.survey}"
        " --share {wildcards.share}/{wildcards.shares} > {log:q} 2>&1 || [ $? -eq 1 ]"


rule join:
    input:
        shares_of,
    output:
        "results/surveys/{survey}/correction.json",
    log:
        "logs/surveys/{survey}/join.log",
    params:
        correct=correct_of,
    threads: config.get("threads", 1)
    shell:
        "{params.correct} --jobs {threads} -o results/surveys/{wildcards.survey} > {log:q} 2>&1"
