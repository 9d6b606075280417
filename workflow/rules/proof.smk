# The diagnosis on worlds with concealed effects. Who diagnoses sees the recordings only; the truth is in an archive elsewhere.
PROOF_TABLES = (
    "worlds effects names intervals pairs aims rough per_effect evidence power strength detection thresholds outcomes effect_outcomes "
    "outside held_out confusion false_alarms wrong_worlds"
).split()
PROOF_FIGURES = "aims power confusion per_effect outcomes outside held_out".split()


wildcard_constraints:
    size="small|full",
    half="fixed|fresh",
    part=r"\d+",
    batch=r"(fixed|fresh)-\d+",


rule proof_seed:
    # a changed diagnosis gets worlds that it has not seen
    output:
        f"{PROOF}/{{size}}/seed.json",
    params:
        fixed="" if CONFIG.proof_seed is None else f"--fixed {CONFIG.proof_seed}",
        code=code("armscope.cli.proof:diagnose"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/seed.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/seed.tsv"
    shell:
        "armscope proof seed {params.fixed} -o {output} > {log} 2>&1"


rule proof_worlds:
    input:
        robots="config/robots",
        seed=lambda wildcards: f"{PROOF}/{wildcards.size}/seed.json" if wildcards.half == "fresh" else [],
    output:
        visible=directory(f"{PROOF}/{{size}}/visible/{{half}}-{{part}}"),
        sealed=f"{PROOF}/{{size}}/sealed/{{half}}-{{part}}.tar.gz",
    params:
        parts=lambda wildcards: OF_PARTS[wildcards.size],
        seed=lambda wildcards, input: f"--seed-file {input.seed}" if input.seed else "",
        code=code("armscope.cli.proof:worlds"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/worlds-{{half}}-{{part}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/worlds-{{half}}-{{part}}.tsv"
    shell:
        "armscope proof worlds {input.robots} --size {wildcards.size} --half {wildcards.half} "
        "--part {wildcards.part}/{params.parts} {params.seed} --visible {output.visible} --sealed {output.sealed} "
        "> {log} 2>&1"


rule proof_diagnose:
    # in a folder of its own, into which only its inputs are linked; `seen` lists what it found there
    input:
        f"{PROOF}/{{size}}/visible/{{batch}}",
    output:
        verdicts=directory(f"{PROOF}/{{size}}/verdicts/{{batch}}"),
        seen=f"{PROOF}/{{size}}/seen/{{batch}}.txt",
    params:
        resamples=CONFIG.proof.resamples,
        cross_validation="--cross-validation" if CONFIG.proof.cross_validation else "--no-cross-validation",
        code=code("armscope.cli.proof:diagnose"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/diagnose-{{batch}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/diagnose-{{batch}}.tsv"
    shadow:
        "minimal"
    shell:
        "(seen=$(mktemp ../seen.XXXXXXXX) && chmod a+r $seen && "
        "find -L . {input} -type f -not -name '*.log' -not -name '.*' -not -path '*/.armscope/*' > $seen && "
        "mv $seen {output.seen} && "
        "armscope proof diagnose {input} --resamples {params.resamples} {params.cross_validation} "
        "-o {output.verdicts}) > {log} 2>&1"


rule proof_score:
    # the only rule that opens the seals
    input:
        visible=of_batches(f"{PROOF}/{{size}}/visible/{{batch}}"),
        sealed=of_batches(f"{PROOF}/{{size}}/sealed/{{batch}}.tar.gz"),
        verdicts=of_batches(f"{PROOF}/{{size}}/verdicts/{{batch}}"),
        seen=of_batches(f"{PROOF}/{{size}}/seen/{{batch}}.txt"),
    output:
        expand(f"{PROOF}/{{{{size}}}}/tables/{{table}}.csv", table=PROOF_TABLES),
    params:
        folder=lambda wildcards: f"{PROOF}/{wildcards.size}",
        code=code("armscope.cli.proof:score"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/score.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/score.tsv"
    shell:
        "armscope proof score {params.folder} -o {params.folder}/tables > {log} 2>&1"


rule proof_figures:
    input:
        expand(f"{PROOF}/{{{{size}}}}/tables/{{table}}.csv", table=PROOF_TABLES),
    output:
        expand(f"{PROOF}/{{{{size}}}}/figures/{{figure}}.{{ending}}", figure=PROOF_FIGURES, ending=("png", "svg")),
    params:
        folder=lambda wildcards: f"{PROOF}/{wildcards.size}",
        code=code("armscope.cli.proof:figures"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/figures.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/figures.tsv"
    shell:
        "armscope proof figures {params.folder}/tables -o {params.folder}/figures > {log} 2>&1"


rule proof_report:
    input:
        tables=rules.proof_figures.input,
        figures=rules.proof_figures.output,
        seed=rules.proof_seed.output,
    output:
        f"{PROOF}/{{size}}/report.html",
    params:
        folder=lambda wildcards: f"{PROOF}/{wildcards.size}",
        code=code("armscope.cli.proof:report"),
    log:
        f"{RESULTS}/logs/proof/{{size}}/report.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/proof/{{size}}/report.tsv"
    shell:
        "armscope proof report {params.folder}/tables {params.folder}/figures {input.seed} --size {wildcards.size} "
        "-o {output} > {log} 2>&1"


rule proof_small:
    input:
        f"{PROOF}/small/report.html",


rule proof:
    input:
        f"{PROOF}/full/report.html",
