# The paper's claims: judged by the method as printed and improved, under other assumptions, and why they depend.
VARIED = CONFIG.paper.sensitivity
SCENARIO_PARTS = 2  # jobs; each starts once and takes every second scenario


rule scenario:
    # every scenario draws, measures, fits and judges robots of its own
    input:
        robot=CONFIG.paper.robot.value,
        others=VARIED.geometry.value,
        settings=settings("scenario", sensitivity=VARIED, models=CONFIG.paper.models, swarm=CONFIG.paper.swarm, **STUDY),
    output:
        f"{PAPER}/sensitivity/{{part}}.csv",
    params:
        parts=SCENARIO_PARTS,
        code=code("armscope.cli.paper_judging:scenario"),
    log:
        f"{RESULTS}/logs/sensitivity/{{part}}.log",
    shell:
        "armscope paper scenario {input.robot} --settings {input.settings} --part {wildcards.part} --parts {params.parts} "
        "-o {output} > {log} 2>&1"


rule sensitivity:
    input:
        expand(f"{PAPER}/sensitivity/{{part}}.csv", part=range(1, SCENARIO_PARTS + 1)),
    output:
        report(f"{PAPER}/sensitivity.csv", caption="../report/sensitivity.rst", category="Claims"),
    params:
        code=code("armscope.cli.paper_judging:join_"),
    log:
        f"{RESULTS}/logs/sensitivity.log",
    shell:
        "armscope paper join {input} -o {output} > {log} 2>&1"


rule method:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        ensemble=rules.measure.output.ensemble,
        settings=settings(
            "method",
            seed=CONFIG.seed,
            models=CONFIG.paper.models,
            swarm=CONFIG.paper.swarm,
            method=CONFIG.paper.method,
        ),
    output:
        table=report(f"{PAPER}/method.csv", caption="../report/method.rst", category="Method"),
        claims=f"{PAPER}/method_claims.csv",
    params:
        code=code("armscope.cli.paper_judging:method_"),
    log:
        f"{RESULTS}/logs/method.log",
    shell:
        "armscope paper method {input.poses} --errors {input.errors} --errors {input.ensemble} --settings {input.settings} "
        "-o {output.table} --claims {output.claims} > {log} 2>&1"


rule sub_volumes:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        ensemble=rules.measure.output.ensemble,
    output:
        f"{PAPER}/sub_volumes.csv",
    params:
        code=code("armscope.cli.paper:sub_volumes_"),
    log:
        f"{RESULTS}/logs/sub_volumes.log",
    shell:
        "armscope paper sub-volumes {input.poses} --errors {input.errors} --errors {input.ensemble} -o {output} > {log} 2>&1"


rule outlook:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        ensemble=rules.measure.output.ensemble,
    output:
        f"{PAPER}/outlook.csv",
    params:
        seed=CONFIG.seed,
        code=code("armscope.cli.paper:outlook_"),
    log:
        f"{RESULTS}/logs/outlook.log",
    shell:
        "armscope paper outlook {input.poses} --errors {input.errors} --errors {input.ensemble} --seed {params.seed} "
        "-o {output} > {log} 2>&1"


rule judge:
    input:
        poses=rules.measure.output.poses,
        errors=[rules.measure.output.errors, rules.measure.output.ensemble],
        fits=[f"{PAPER}/fits.json.gz", rules.fit_ensemble.output[0]],
        as_printed=[f"{PAPER}/fits_as_printed.json.gz", rules.fit_ensemble_as_printed.output[0]],
        sub_volumes=rules.sub_volumes.output,
        outlook=rules.outlook.output,
        enough_poses=rules.measure.output.enough_poses,
    output:
        table=f"{PAPER}/judged.csv",
        per_robot=f"{PAPER}/judged_per_robot.csv",
    params:
        errors=lambda wildcards, input: " ".join(f"--errors {file}" for file in input.errors),
        fits=lambda wildcards, input: " ".join(f"--fits {file}" for file in input.fits),
        as_printed=lambda wildcards, input: " ".join(f"--as-printed {file}" for file in input.as_printed),
        code=code("armscope.cli.paper_judging:judge_"),
    log:
        f"{RESULTS}/logs/judge.log",
    shell:
        "armscope paper judge {input.poses} {params.errors} {params.fits} {params.as_printed} --sub-volumes {input.sub_volumes} "
        "--outlook {input.outlook} --enough-poses {input.enough_poses} --per-robot {output.per_robot} -o {output.table} > {log} 2>&1"


rule claims:
    input:
        judged=rules.judge.output.table,
        sensitivity=rules.sensitivity.output,
    output:
        report(f"{PAPER}/claims.csv", caption="../report/claims.rst", category="Claims"),
    params:
        code=code("armscope.cli.paper_judging:claims_"),
    log:
        f"{RESULTS}/logs/claims.log",
    shell:
        "armscope paper claims {input.judged} --sensitivity {input.sensitivity} -o {output} > {log} 2>&1"


rule why:
    input:
        per_robot=rules.judge.output.per_robot,
        robots=rules.measure.output.in_tolerances,
    output:
        table=f"{PAPER}/why.csv",
        figures=multiext(f"{PAPER}/figures/why", ".png", ".svg", ".pdf"),
    params:
        code=code("armscope.cli.paper_judging:why_"),
    log:
        f"{RESULTS}/logs/why.log",
    shell:
        "armscope paper why {input.per_robot} --robots {input.robots} -o {output.table} --figure {output.figures[0]} > {log} 2>&1"


rule audit:
    input:
        settings=settings("audit", seed=CONFIG.seed, trajectories=CONFIG.paper.trajectories, audit=CONFIG.paper.audit),
    output:
        report(f"{PAPER}/audit.csv", caption="../report/audit.rst", category="Audit"),
    params:
        code=code("armscope.cli.paper_judging:audit_"),
    log:
        f"{RESULTS}/logs/audit.log",
    shell:
        "armscope paper audit --settings {input.settings} -o {output} > {log} 2>&1"
