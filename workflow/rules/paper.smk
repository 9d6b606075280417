# The 2006 paper on the virtual SK120: measure, fit, tabulate, draw, report.
PAPER = f"{RESULTS}/paper"
FIGURES = [f"fig{number:02}" for number in range(3, 12)]


rule measure:
    input:
        robot=CONFIG.paper.robot.value,
    output:
        poses=f"{PAPER}/poses.csv",
        errors=f"{PAPER}/errors.csv",
        ensemble=f"{PAPER}/ensemble_errors.csv.gz",
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
    benchmark:
        f"{RESULTS}/logs/benchmarks/measure.tsv"
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper measure {input.robot} --settings {params.settings:q} -o {params.folder} > {log} 2>&1"


rule fit:
    # of any study: the virtual SK120's, or a real arm's
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
    output:
        f"{RESULTS}/{{study}}/fits.json.gz",
    params:
        settings=fit_settings(),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/{{study}}/fit.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/{{study}}/fit.tsv"
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper fit {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


use rule fit as fit_ensemble with:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.ensemble,
    output:
        f"{PAPER}/ensemble_fits.json.gz",
    params:
        settings=fit_settings(seeds=CONFIG.paper.ensemble.seeds),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/fit_ensemble.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/fit_ensemble.tsv"


use rule fit as fit_as_printed with:
    # the velocity update without inertia or constriction, exactly as section 5 prints it
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{PAPER}/fits_as_printed.json.gz",
    params:
        settings=fit_settings(update="original", velocity_clamp=None),
        code=code("armscope.cli.paper:fit"),
    log:
        f"{RESULTS}/logs/fit_as_printed.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/fit_as_printed.tsv"


rule residuals:
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
        fits=f"{RESULTS}/{{study}}/fits.json.gz",
    output:
        f"{RESULTS}/{{study}}/residuals.csv.gz",
    params:
        code=code("armscope.cli.paper:residuals"),
    log:
        f"{RESULTS}/logs/{{study}}/residuals.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper residuals {input.poses} {input.errors} {input.fits} -o {output} > {log} 2>&1"


use rule residuals as ensemble_residuals with:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.ensemble,
        fits=rules.fit_ensemble.output,
    output:
        f"{PAPER}/ensemble_residuals.csv.gz",
    log:
        f"{RESULTS}/logs/ensemble_residuals.log",


rule table2:
    input:
        residuals=f"{RESULTS}/{{study}}/residuals.csv.gz",
        ensemble=lambda wildcards: rules.ensemble_residuals.output if wildcards.study == "paper" else [],
    output:
        f"{RESULTS}/{{study}}/table2.csv",
    params:
        beside=lambda wildcards: "--beside-printed" if wildcards.study == "paper" else "--no-beside-printed",
        code=code("armscope.cli.paper:table2_"),
    log:
        f"{RESULTS}/logs/{{study}}/table2.log",
    conda:
        "../envs/armscope.yaml"
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
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper coefficients {input} -o {output} > {log} 2>&1"


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
    conda:
        "../envs/armscope.yaml"
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
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper outlook {input.poses} --errors {input.errors} --errors {input.ensemble} --seed {params.seed} "
        "-o {output} > {log} 2>&1"


rule claims:
    input:
        residuals=f"{PAPER}/residuals.csv.gz",
        ensemble_residuals=rules.ensemble_residuals.output,
        fits=f"{PAPER}/fits.json.gz",
        ensemble_fits=rules.fit_ensemble.output,
        as_printed=rules.fit_as_printed.output,
        sub_volumes=rules.sub_volumes.output,
        outlook=rules.outlook.output,
    output:
        f"{PAPER}/claims.csv",
    params:
        code=code("armscope.cli.paper:claims_"),
    log:
        f"{RESULTS}/logs/claims.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper claims {input.residuals} {input.ensemble_residuals} --fits {input.fits} --fits {input.ensemble_fits} "
        "--as-printed {input.as_printed} --sub-volumes {input.sub_volumes} --outlook {input.outlook} -o {output} > {log} 2>&1"


rule cross_check:
    input:
        residuals=f"{PAPER}/residuals.csv.gz",
        ensemble_residuals=rules.ensemble_residuals.output,
        fits=f"{PAPER}/fits.json.gz",
        ensemble_fits=rules.fit_ensemble.output,
    output:
        f"{PAPER}/cross_check.csv",
    params:
        code=code("armscope.cli.paper:cross_check_"),
    log:
        f"{RESULTS}/logs/cross_check.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper cross-check {input.residuals} {input.ensemble_residuals} --fits {input.fits} --fits {input.ensemble_fits} "
        "-o {output} > {log} 2>&1"


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
        settings=fit_settings(),
        code=code("armscope.cli.paper:convergence"),
    log:
        f"{RESULTS}/logs/convergence.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/convergence.tsv"
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper convergence {input.poses} {input.errors} --settings {params.settings:q} -o {output} > {log} 2>&1"


rule figure:
    input:
        poses=f"{RESULTS}/{{study}}/poses.csv",
        errors=f"{RESULTS}/{{study}}/errors.csv",
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
        robot=CONFIG.paper.robot.value,
        outlook=expand(
            f"{RESULTS}/compensation/{{file}}",
            file="closed_loop_points.csv products.csv full_pose.csv closed_loop.svg regions.svg".split(),
        ),
        cross_table=f"{RESULTS}/compensation/cross_table.csv",
        figures=rules.figures.input,
        tables=expand(
            f"{PAPER}/{{table}}.csv",
            table="table2 claims coefficients convergence cross_check audit reading observability robots".split(),
        ),
        proof=f"{PROOF}/small/report.html",
        aims=f"{PROOF}/small/figures/aims.svg",
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
        proof=subpath(input.proof, parent=True),
        compensation=subpath(input.cross_table, parent=True),
        code=code("armscope.cli.paper:report"),
    log:
        f"{RESULTS}/logs/paper_report.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope paper report {params.folder} {params.proof} --robot {input.robot} --compensation {params.compensation} --settings {params.settings:q} -o {output.page} > {log} 2>&1"


rule paper:
    input:
        rules.paper_report.output,
