# The 2006 paper on the virtual SK120: measure, fit, tabulate, draw, report.
PAPER = f"{RESULTS}/paper"


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


rule paper:
    input:
        rules.fit.output,
