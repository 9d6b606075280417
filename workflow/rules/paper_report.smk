# Figures 1-11 of the paper and the page of the reproduction.
SPACES = {model.space for model in CONFIG.paper.models}
NEEDS = {"fig06": "cartesian", "fig07": "angular", "fig10": "cartesian", "fig11": "angular"}
# figures of models that are not configured are skipped, and the page says so
FIGURES = [f"fig{number:02}" for number in range(1, 12) if NEEDS.get(f"fig{number:02}") in {None, *SPACES}]


rule figure:
    # all in one job: drawing one takes less than starting
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        fits=f"{PAPER}/fits.json.gz",
        robot=CONFIG.paper.robot.value,
        bands=rules.ensemble_residuals.output.bands,
        settings=settings("figure", tracker=CONFIG.paper.tracker, figures=FIGURES),
    output:
        report(expand(f"{PAPER}/figures/{{figure}}.png", figure=FIGURES), caption="../report/figure.rst", category="Figures"),
        expand(f"{PAPER}/figures/{{figure}}.svg", figure=FIGURES),
        expand(f"{PAPER}/figures/{{figure}}.pdf", figure=FIGURES),
    params:
        folder=subpath(output[0], parent=True),
        code=code("armscope.cli.paper_pages:figures"),
    log:
        f"{RESULTS}/logs/figure.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/figure.tsv"
    shell:
        "armscope paper figures {input.poses} {input.errors} {input.fits} --robot {input.robot} --bands {input.bands} "
        "--settings {input.settings} -o {params.folder} > {log} 2>&1"


if REAL:

    rule figure_real:
        # of all real arms in one job, for the same reason
        input:
            expand(f"{RESULTS}/real/{{set}}/paper/{{file}}", set=REAL, file=("poses.csv", "errors.csv", "fits.json.gz")),
        output:
            png=expand(f"{RESULTS}/real/{{set}}/paper/figures/{{{{figure}}}}.png", set=REAL),
            svg=expand(f"{RESULTS}/real/{{set}}/paper/figures/{{{{figure}}}}.svg", set=REAL),
        wildcard_constraints:
            figure=r"fig\d\d",
        params:
            studies=[f"{RESULTS}/real/{name}/paper" for name in REAL],
            outputs=lambda wildcards, output: " ".join(f"-o {path}" for path in output.png),
            code=code("armscope.cli.paper_pages:figure"),
        log:
            f"{RESULTS}/logs/real/{{figure}}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/real/{{figure}}.tsv"
        shell:
            "armscope paper figure {wildcards.figure} {params.studies} {params.outputs} > {log} 2>&1"


rule convergence_figure:
    input:
        rules.convergence.output,
    output:
        png=report(f"{PAPER}/figures/convergence.png", caption="../report/convergence.rst", category="Method"),
        svg=f"{PAPER}/figures/convergence.svg",
        pdf=f"{PAPER}/figures/convergence.pdf",
    params:
        code=code("armscope.cli.paper_pages:convergence_figure"),
    log:
        f"{RESULTS}/logs/convergence_figure.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/convergence_figure.tsv"
    shell:
        "armscope paper convergence-figure {input} -o {output.png} > {log} 2>&1"


rule figures:
    input:
        expand(f"{PAPER}/figures/{{figure}}.png", figure=[*FIGURES, "convergence", "why"]),


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
            table="table2 claims method method_claims sensitivity why coefficients convergence cross_check audit reading observability "
            "robots enough_poses".split(),
        ),
        proof=f"{PROOF}/small/report.html",
        aims=f"{PROOF}/small/figures/aims.svg",
        real_tables=expand(f"{RESULTS}/real/{{set}}/paper/table2.csv", set=REAL),
        real_figures=expand(f"{RESULTS}/real/{{set}}/paper/figures/fig04.svg", set=REAL),
        settings=settings(
            "paper_report",
            seed=CONFIG.seed,
            paper=CONFIG.paper,
            real=tuple(
                {"title": arm.title, "folder": f"{RESULTS}/real/{name}/paper" if name in REAL else None, "reason": SKIPPED.get(name)}
                for name, arm in CONFIG.real.items()
            ),
        ),
    output:
        page=report(f"{PAPER}/report.html", caption="../report/page.rst", category="Page"),
        table2=report(f"{PAPER}/table2.html", caption="../report/table2.rst", category="Page"),
    params:
        folder=subpath(output.page, parent=True),
        proof=subpath(input.proof, parent=True),
        compensation=subpath(input.cross_table, parent=True),
        code=code("armscope.cli.paper_pages:report"),
    log:
        f"{RESULTS}/logs/paper_report.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/paper_report.tsv"
    shell:
        "armscope paper report {params.folder} {params.proof} --robot {input.robot} --compensation {params.compensation} "
        "--settings {input.settings} -o {output.page} > {log} 2>&1"


rule paper:
    input:
        rules.paper_report.output,
