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
        folder=PAPER,
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
    shell:
        "armscope paper measure {input.robot} --settings {params.settings:q} -o {params.folder} > {log} 2>&1"


rule fit:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{PAPER}/fits.json.gz",
    params:
        settings=settings(
            seed=CONFIG.seed,
            models=CONFIG.paper.models,
            swarm=CONFIG.paper.swarm,
            ensemble_seeds=CONFIG.paper.ensemble.seeds,
        ),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/fit.log",
    shell:
        "armscope paper fit {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


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
    shell:
        "armscope paper convergence {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


rule figure:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        fits=rules.fit.output,
    output:
        multiext(f"{PAPER}/figures/{{figure}}", ".png", ".svg", ".pdf"),
    wildcard_constraints:
        figure=r"fig\d\d",
    params:
        code=code("armscope.cli.paper:figure"),
    log:
        f"{RESULTS}/logs/{{figure}}.log",
    shell:
        "armscope paper figure {wildcards.figure} {input.poses} {input.errors} {input.fits} -o {output[0]} > {log} 2>&1"


rule convergence_figure:
    input:
        rules.convergence.output,
    output:
        multiext(f"{PAPER}/figures/convergence", ".png", ".svg", ".pdf"),
    params:
        code=code("armscope.cli.paper:convergence_figure"),
    log:
        f"{RESULTS}/logs/convergence_figure.log",
    shell:
        "armscope paper convergence-figure {input} -o {output[0]} > {log} 2>&1"


rule figures:
    input:
        expand(f"{PAPER}/figures/{{figure}}.png", figure=[*FIGURES, "convergence"]),


rule paper:
    input:
        rules.figures.input,
