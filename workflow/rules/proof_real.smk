# Concealment on real recordings: known effects are added to what real arms did, and looked for by who sees the tables only.
PROOF_REAL_TABLES = ("cases", "numbers", "rates", "held_out", "withheld", "skipped")
PROOF_REAL_FIGURES = ("found", "sizes", "held_out")


wildcard_constraints:
    part_real="original|fixed|fresh|withheld",
    half_real="fixed|fresh",


use rule proof_seed as proof_real_seed with:
    output:
        f"{PROOF_REAL}/seed.json",
    log:
        f"{RESULTS}/logs/proof_real/seed.log",


rule proof_real_original:
    # the recordings as they are, and without the columns that say how loaded the arm was
    input:
        recordings=recordings_of,
        robot=robot_of,
        settings=plant_settings,
    output:
        visible=directory(f"{PROOF_REAL}/visible/{{set}}-{{part_real}}"),
        sealed=f"{PROOF_REAL}/sealed/{{set}}-{{part_real}}.tar.gz",
    params:
        code=code("armscope.cli.real:plant"),
    wildcard_constraints:
        part_real="original|withheld",
    log:
        f"{RESULTS}/logs/proof_real/plant-{{set}}-{{part_real}}.log",
    shell:
        "armscope real plant {input.recordings} {input.robot} --settings {input.settings} --part {wildcards.part_real} "
        "--visible {output.visible} --sealed {output.sealed} > {log} 2>&1"


rule proof_real_plant:
    input:
        recordings=recordings_of,
        robot=robot_of,
        verdicts=f"{PROOF_REAL}/verdicts/{{set}}-original",
        seed=lambda wildcards: rules.proof_real_seed.output if wildcards.half_real == "fresh" else [],
        settings=plant_settings,
    output:
        visible=directory(f"{PROOF_REAL}/visible/{{set}}-{{half_real}}"),
        sealed=f"{PROOF_REAL}/sealed/{{set}}-{{half_real}}.tar.gz",
    params:
        seed=lambda wildcards, input: f"--seed-file {input.seed}" if input.seed else "",
        code=code("armscope.cli.real:plant"),
    log:
        f"{RESULTS}/logs/proof_real/plant-{{set}}-{{half_real}}.log",
    shell:
        "armscope real plant {input.recordings} {input.robot} --settings {input.settings} --part {wildcards.half_real} "
        "--verdict {input.verdicts}/original/verdict.json {params.seed} "
        "--visible {output.visible} --sealed {output.sealed} > {log} 2>&1"


use rule proof_diagnose as proof_real_diagnose with:
    # in a folder of its own, into which only its inputs are linked; `seen` lists what it found there
    input:
        f"{PROOF_REAL}/visible/{{set}}-{{part_real}}",
    output:
        verdicts=directory(f"{PROOF_REAL}/verdicts/{{set}}-{{part_real}}"),
        seen=f"{PROOF_REAL}/seen/{{set}}-{{part_real}}.txt",
    log:
        f"{RESULTS}/logs/proof_real/diagnose-{{set}}-{{part_real}}.log",


rule proof_real_score:
    # the only rule that opens the seals
    input:
        visible=proof_real_batches("visible/{batch}"),
        sealed=proof_real_batches("sealed/{batch}.tar.gz"),
        verdicts=proof_real_batches("verdicts/{batch}"),
        seen=proof_real_batches("seen/{batch}.txt"),
    output:
        expand(f"{PROOF_REAL}/tables/{{table}}.csv", table=PROOF_REAL_TABLES),
    params:
        folder=subpath(output[0], ancestor=2),
        code=code("armscope.cli.real:score"),
    log:
        f"{RESULTS}/logs/proof_real/score.log",
    shell:
        "armscope real score {params.folder} -o {params.folder}/tables > {log} 2>&1"


rule proof_real_report:
    input:
        tables=rules.proof_real_score.output,
        seed=rules.proof_real_seed.output,
    output:
        report=f"{PROOF_REAL}/report.html",
        figures=expand(
            f"{PROOF_REAL}/figures/{{figure}}.{{ending}}", figure=PROOF_REAL_FIGURES, ending=("png", "svg")
        ),
    params:
        folder=subpath(output.report, parent=True),
        titles=json.dumps({name: CONFIG.real[name].title.partition(",")[0] for name in CONCEALED_IN}),
        code=code("armscope.cli.real:report"),
    log:
        f"{RESULTS}/logs/proof_real/report.log",
    shell:
        "armscope real report {params.folder}/tables {input.seed} --titles {params.titles:q} -o {params.folder} > {log} 2>&1"


rule proof_real:
    input:
        rules.proof_real_report.output,
