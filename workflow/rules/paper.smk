# The 2006 paper on the virtual SK120: measure, fit, tabulate.
PAPER = f"{RESULTS}/paper"

# what a virtual study assumes, whatever is done with it
STUDY = dict(
    seed=CONFIG.seed,
    tolerances=CONFIG.paper.tolerances,
    ensemble_robots=CONFIG.paper.ensemble.robots,
    identification=CONFIG.paper.identification,
    trajectories=CONFIG.paper.trajectories,
    tracker=CONFIG.paper.tracker,
)


# a geometry, path or corner that can't be reached is told before anything runs
require_reach(
    CONFIG.paper.robot.value,
    CONFIG.paper.sensitivity.geometry.value,
    settings("reach", sensitivity=CONFIG.paper.sensitivity, **STUDY),
)


rule measure:
    input:
        robot=CONFIG.paper.robot.value,
        settings=settings("measure", **STUDY),
    output:
        poses=f"{PAPER}/poses.csv",
        errors=f"{PAPER}/errors.csv",
        ensemble=f"{PAPER}/ensemble_errors.csv.gz",
        robots=f"{PAPER}/robots.csv",
        in_tolerances=f"{PAPER}/robots_in_tolerances.csv",
        observability=f"{PAPER}/observability.csv",
        enough_poses=f"{PAPER}/enough_poses.csv",
    params:
        folder=subpath(output.poses, parent=True),
        code=code("armscope.cli.paper:measure"),
    log:
        f"{RESULTS}/logs/measure.log",
    shell:
        "armscope paper measure {input.robot} --settings {input.settings} -o {params.folder} > {log} 2>&1"


rule fit:
    # of any study: the virtual SK120's, or a real arm's
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
        settings=fit_settings("fit"),
    output:
        f"{RESULTS}/{{study}}/fits.json.gz",
    params:
        as_printed="",
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/{{study}}/fit.log",
    shell:
        "armscope paper fit {input.poses} {input.errors} --settings {input.settings} {params.as_printed} -o {output} > {log} 2>&1"


use rule fit as fit_ensemble with:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.ensemble,
        settings=fit_settings("fit_ensemble", seeds=CONFIG.paper.ensemble.seeds),
    output:
        f"{PAPER}/ensemble_fits.json.gz",
    log:
        f"{RESULTS}/logs/fit_ensemble.log",


use rule fit as fit_as_printed with:
    # the paper's own coordinates, one swarm for all axes, and the velocity update exactly as section 5 prints it; one run, as
    # there and as in the scenarios that it is compared with
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
        settings=fit_settings("fit_as_printed", seeds=CONFIG.paper.sensitivity.seeds),
    output:
        f"{RESULTS}/{{study}}/fits_as_printed.json.gz",
    params:
        as_printed="--as-printed",
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/{{study}}/fit_as_printed.log",


use rule fit_ensemble as fit_ensemble_as_printed with:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.ensemble,
        settings=fit_settings("fit_as_printed", seeds=CONFIG.paper.sensitivity.seeds),
    output:
        f"{PAPER}/ensemble_fits_as_printed.json.gz",
    params:
        as_printed="--as-printed",
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/fit_ensemble_as_printed.log",


rule residuals:
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
        fits=f"{RESULTS}/{{study}}/fits.json.gz",
    output:
        table=f"{RESULTS}/{{study}}/residuals.csv.gz",
    params:
        code=code("armscope.cli.paper:residuals"),
    log:
        f"{RESULTS}/logs/{{study}}/residuals.log",
    shell:
        "armscope paper residuals {input.poses} {input.errors} {input.fits} -o {output.table} > {log} 2>&1"


rule ensemble_residuals:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.ensemble,
        fits=rules.fit_ensemble.output,
    output:
        table=f"{PAPER}/ensemble_residuals.csv.gz",
        bands=f"{PAPER}/ensemble_bands.csv.gz",
    params:
        code=code("armscope.cli.paper:residuals"),
    log:
        f"{RESULTS}/logs/ensemble_residuals.log",
    shell:
        "armscope paper residuals {input.poses} {input.errors} {input.fits} --bands {output.bands} -o {output.table} > {log} 2>&1"


rule table2:
    input:
        residuals=f"{RESULTS}/{{study}}/residuals.csv.gz",
        ensemble=lambda wildcards: rules.ensemble_residuals.output.table if wildcards.study == "paper" else [],
    output:
        f"{RESULTS}/{{study}}/table2.csv",
    params:
        beside=lambda wildcards: "--beside-printed" if wildcards.study == "paper" else "--no-beside-printed",
        code=code("armscope.cli.paper:table2_"),
    log:
        f"{RESULTS}/logs/{{study}}/table2.log",
    shell:
        "armscope paper table2 {input.residuals} {input.ensemble} {params.beside} -o {output} > {log} 2>&1"


rule coefficients:
    input:
        f"{PAPER}/fits.json.gz",
    output:
        f"{PAPER}/coefficients.csv",
    params:
        code=code("armscope.cli.paper:coefficients"),
    log:
        f"{RESULTS}/logs/coefficients.log",
    shell:
        "armscope paper coefficients {input} -o {output} > {log} 2>&1"


rule cross_check:
    input:
        residuals=f"{PAPER}/residuals.csv.gz",
        ensemble_residuals=rules.ensemble_residuals.output.table,
        fits=f"{PAPER}/fits.json.gz",
        ensemble_fits=rules.fit_ensemble.output,
    output:
        f"{PAPER}/cross_check.csv",
    params:
        code=code("armscope.cli.paper:cross_check_"),
    log:
        f"{RESULTS}/logs/cross_check.log",
    shell:
        "armscope paper cross-check {input.residuals} {input.ensemble_residuals} --fits {input.fits} --fits {input.ensemble_fits} "
        "-o {output} > {log} 2>&1"


rule reading:
    input:
        rules.measure.output.poses,
    output:
        f"{PAPER}/reading.csv",
    params:
        code=code("armscope.cli.paper:reading_"),
    log:
        f"{RESULTS}/logs/reading.log",
    shell:
        "armscope paper reading {input} -o {output} > {log} 2>&1"


rule convergence:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        settings=fit_settings("fit"),
    output:
        f"{PAPER}/convergence.csv",
    params:
        code=code("armscope.cli.paper:convergence"),
    log:
        f"{RESULTS}/logs/convergence.log",
    shell:
        "armscope paper convergence {input.poses} {input.errors} --settings {input.settings} -o {output} > {log} 2>&1"
