# The 2006 paper on the virtual SK120: measure, fit, tabulate, draw, report.
PAPER = f"{RESULTS}/paper"
FIGURES = [f"fig{number:02}" for number in range(3, 12)]


rule measure:
    input:
        robot=CONFIG.paper.robot.value,
    output:
        poses=f"{PAPER}/poses.csv",
        errors=f"{PAPER}/errors.csv.gz",
        robots=f"{PAPER}/robots.csv",
        observability=f"{PAPER}/observability.csv",
    params:
        folder=subpath(output.poses, parent=True),
        settings=settings(
            seed=CONFIG.seed,
            tolerances=CONFIG.paper.tolerances,
            ensemble_robots=CONFIG.paper.ensemble.robots,
            identification=CONFIG.paper.identification,
            trajectories=CONFIG.paper.trajectories,
            tracker=CONFIG.paper.tracker,
        ),
        code=code("armscope.cli.paper:measure"),
    log:
        f"{RESULTS}/logs/measure.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper measure {input.robot} --settings {params.settings:q} -o {params.folder} > {log} 2>&1"


rule fit:
    # of any study: the virtual SK120's, or a real arm's
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv.gz",
    output:
        f"{RESULTS}/{{study}}/fits.json.gz",
    params:
        settings=settings(
            seed=CONFIG.seed,
            models=CONFIG.paper.models,
            swarm=CONFIG.paper.swarm,
            ensemble_seeds=CONFIG.paper.ensemble.seeds,
        ),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/{{study}}/fit.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper fit {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


rule fit_as_printed:
    # the velocity update without inertia or constriction, exactly as section 5 prints it, on the anchored robot only
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{PAPER}/fits_as_printed.json.gz",
    params:
        settings=settings(
            seed=CONFIG.seed,
            models=CONFIG.paper.models,
            swarm=CONFIG.paper.swarm.model_copy(update={"update": "original", "velocity_clamp": None}),
            ensemble_seeds=CONFIG.paper.ensemble.seeds,
        ),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/fit_as_printed.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper fit {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


rule residuals:
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv.gz",
        fits=f"{RESULTS}/{{study}}/fits.json.gz",
    output:
        residuals=f"{RESULTS}/{{study}}/residuals.csv.gz",
        table2=f"{RESULTS}/{{study}}/table2.csv",
        coefficients=f"{RESULTS}/{{study}}/coefficients.csv",
    params:
        folder=subpath(output.table2, parent=True),
        beside=lambda wildcards: "--beside-printed" if wildcards.study == "paper" else "--no-beside-printed",
        code=code("armscope.cli.paper:residuals"),
    log:
        f"{RESULTS}/logs/{{study}}/residuals.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper residuals {input.poses} {input.errors} {input.fits} {params.beside} -o {params.folder} > {log} 2>&1"


rule claims:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        fits=f"{PAPER}/fits.json.gz",
        as_printed=rules.fit_as_printed.output,
        residuals=f"{PAPER}/residuals.csv.gz",
    output:
        claims=f"{PAPER}/claims.csv",
        sub_volumes=f"{PAPER}/sub_volumes.csv",
    params:
        folder=subpath(output.claims, parent=True),
        code=code("armscope.cli.paper:claims_"),
    log:
        f"{RESULTS}/logs/claims.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper claims {input.poses} {input.errors} {input.fits} {input.as_printed} {input.residuals} -o {params.folder} > {log} 2>&1"


rule cross_check:
    input:
        residuals=f"{PAPER}/residuals.csv.gz",
        fits=f"{PAPER}/fits.json.gz",
    output:
        f"{PAPER}/cross_check.csv",
    params:
        code=code("armscope.cli.paper:cross_check_"),
    log:
        f"{RESULTS}/logs/cross_check.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper cross-check {input.residuals} {input.fits} -o {output} > {log} 2>&1"


rule audit:
    output:
        f"{PAPER}/audit.csv",
    params:
        settings=settings(seed=CONFIG.seed, trajectories=CONFIG.paper.trajectories, audit=CONFIG.paper.audit),
        code=code("armscope.cli.paper:audit_"),
    log:
        f"{RESULTS}/logs/audit.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper audit --settings {params.settings:q} -o {output} > {log} 2>&1"


rule reading:
    input:
        rules.measure.output.poses,
    output:
        f"{PAPER}/reading.csv",
    params:
        code=code("armscope.cli.paper:reading_"),
    log:
        f"{RESULTS}/logs/reading.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper reading {input} -o {output} > {log} 2>&1"


rule convergence:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{PAPER}/convergence.csv",
    params:
        settings=settings(seed=CONFIG.seed, models=CONFIG.paper.models, swarm=CONFIG.paper.swarm),
        code=code("armscope.cli.paper:convergence"),
    log:
        f"{RESULTS}/logs/convergence.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper convergence {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


rule figure:
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv.gz",
        fits=f"{RESULTS}/{{study}}/fits.json.gz",
    output:
        multiext(f"{RESULTS}/{{study}}/figures/{{figure}}", png=".png", svg=".svg", pdf=".pdf"),
    wildcard_constraints:
        figure=r"fig\d\d",
    params:
        code=code("armscope.cli.paper:figure"),
    log:
        f"{RESULTS}/logs/{{study}}/{{figure}}.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper figure {wildcards.figure} {input.poses} {input.errors} {input.fits} -o {output.png} > {log} 2>&1"


rule convergence_figure:
    input:
        rules.convergence.output,
    output:
        multiext(f"{PAPER}/figures/convergence", png=".png", svg=".svg", pdf=".pdf"),
    params:
        code=code("armscope.cli.paper:convergence_figure"),
    log:
        f"{RESULTS}/logs/convergence_figure.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper convergence-figure {input} -o {output.png} > {log} 2>&1"


rule figures:
    input:
        expand(f"{PAPER}/figures/{{figure}}.png", figure=[*FIGURES, "convergence"]),


rule paper_report:
    input:
        figures=rules.figures.input,
        tables=expand(
            f"{PAPER}/{{table}}.csv",
            table="table2 claims coefficients convergence cross_check audit reading observability robots".split(),
        ),
        real_tables=expand(f"{RESULTS}/real/{{set}}/paper/table2.csv", set=REAL),
        real_figures=expand(f"{RESULTS}/real/{{set}}/paper/figures/fig04.svg", set=REAL),
    output:
        page=f"{PAPER}/report.html",
        table2=f"{PAPER}/table2.html",
    params:
        folder=subpath(output.page, parent=True),
        settings=settings(
            seed=CONFIG.seed,
            paper=CONFIG.paper,
            real=tuple(
                {"title": arm.title, "folder": f"{RESULTS}/real/{name}/paper" if name in REAL else None, "reason": SKIPPED.get(name)}
                for name, arm in CONFIG.real.items()
            ),
        ),
        code=code("armscope.cli.paper:report"),
    log:
        f"{RESULTS}/logs/paper_report.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper report {params.folder} --settings {params.settings:q} -o {output.page} > {log} 2>&1"


rule paper:
    input:
        rules.paper_report.output,


rule readme:
    # a file under version control, so this is no part of the default run
    input:
        claims=f"{PAPER}/claims.csv",
        table2=f"{PAPER}/table2.csv",
    output:
        touch(f"{PAPER}/readme.done"),
    params:
        folder=subpath(input.claims, parent=True),
        code=code("armscope.cli.paper:readme_"),
    log:
        f"{RESULTS}/logs/readme.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper readme README.md {params.folder} > {log} 2>&1"
