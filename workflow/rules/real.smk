# The paper's models on real arms: identification rows chosen in the same way, the rest held out.


rule measure_real:
    input:
        recordings=recordings_of,
        robot=robot_of,
        settings=lambda wildcards: settings(
            f"measure_real/{wildcards.set}",
            seed=CONFIG.seed,
            poses=CONFIG.paper.identification.poses.value,
            run=CONFIG.real[wildcards.set].run,
            first_id=CONFIG.real[wildcards.set].first_id,
        ),
    output:
        poses=f"{RESULTS}/real/{{set}}/paper/poses.csv",
        errors=f"{RESULTS}/real/{{set}}/paper/errors.csv",
        observability=f"{RESULTS}/real/{{set}}/paper/observability.csv",
    params:
        folder=subpath(output.poses, parent=True),
        code=code("armscope.cli.paper:measure_real"),
    log:
        f"{RESULTS}/logs/real/{{set}}/measure.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real/{{set}}/measure.tsv"
    shell:
        "armscope paper measure-real {input.recordings} {input.robot} --settings {input.settings} -o {params.folder} > {log} 2>&1"


rule diagnose_real:
    # what is wrong with a real arm: report page, verdict, fitted model
    input:
        recordings=recordings_of,
        robot=robot_of,
    output:
        verdict=f"{RESULTS}/real/{{set}}/verdict.json",
        report=f"{RESULTS}/real/{{set}}/report.html",
    params:
        folder=subpath(output.verdict, parent=True),
        run=lambda wildcards: f"--run {CONFIG.real[wildcards.set].run}" if CONFIG.real[wildcards.set].run else "",
        first=lambda wildcards: (
            f"--first-id {CONFIG.real[wildcards.set].first_id}" if CONFIG.real[wildcards.set].first_id else ""
        ),
        code=code("armscope.cli.diagnosis:diagnose"),
    log:
        f"{RESULTS}/logs/real/{{set}}/diagnose.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real/{{set}}/diagnose.tsv"
    shell:
        "armscope diagnose {input.recordings} --robot {input.robot} {params.run} {params.first} -o {params.folder} --force > {log} 2>&1"


rule protocol_real:
    # the reference protocol: same splits, 3D distance on rows that took no part, beside the figures of others
    input:
        recordings=recordings_of,
        robot=robot_of,
        reference=lambda wildcards: CONFIG.real[wildcards.set].reference,
    output:
        expand(f"{RESULTS}/real/{{{{set}}}}/{{table}}.csv", table=("protocol", "splits", "names", "transfer", "curves_by_run")),
        f"{RESULTS}/real/{{set}}/protocol.png",
    params:
        folder=subpath(output[0], parent=True),
        splits=lambda wildcards: " ".join(
            f"--{kind}-splits {count}"
            for kind in ("diagnosed", "oriented")
            if (count := getattr(CONFIG.real[wildcards.set], f"{kind}_splits"))
        ),
        code=code("armscope.cli.real:protocol"),
    log:
        f"{RESULTS}/logs/real/{{set}}/protocol.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real/{{set}}/protocol.tsv"
    shell:
        "armscope real protocol {input.recordings} {input.robot} {input.reference} {params.splits} -o {params.folder} "
        "> {log} 2>&1"


rule regions_real:
    # regions that took no part: the last rows, the farthest, the highest, those on one side
    input:
        recordings=recordings_of,
        robot=robot_of,
        reference=lambda wildcards: CONFIG.real[wildcards.set].reference,
    output:
        f"{RESULTS}/real/{{set}}/regions.csv",
    params:
        code=code("armscope.cli.real:regions"),
    log:
        f"{RESULTS}/logs/real/{{set}}/regions.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real/{{set}}/regions.tsv"
    shell:
        "armscope real regions {input.recordings} {input.robot} {input.reference} -o {output} > {log} 2>&1"


rule compliances_real:
    # do the runs of an arm whose torques were recorded say the same of what gives way?
    input:
        recordings=recordings_of,
        robot=robot_of,
        reference=lambda wildcards: CONFIG.real[wildcards.set].reference,
    output:
        expand(f"{RESULTS}/real/{{{{set}}}}/compliances{{table}}.csv", table=("", "_agree", "_simulated")),
    params:
        folder=subpath(output[0], parent=True),
        seed=CONFIG.seed,
        code=code("armscope.cli.real:compliances"),
    log:
        f"{RESULTS}/logs/real/{{set}}/compliances.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real/{{set}}/compliances.tsv"
    shell:
        "armscope real compliances {input.recordings} {input.robot} {input.reference} --seed {params.seed} "
        "-o {params.folder} > {log} 2>&1"


# docs/real-arms.md and docs/real-concealed.md, which are under version control and therefore no part of `real`
PAGED = [name for name in REAL if CONFIG.real[name].reference]
COMPARED = [name for name in PAGED if CONFIG.real[name].loads_recorded]


rule real_arms:
    input:
        expand(f"{RESULTS}/real/{{set}}/verdict.json", set=PAGED),
        expand(f"{RESULTS}/real/{{set}}/{{table}}.csv", set=PAGED, table=("protocol", "regions")),
        expand(f"{RESULTS}/real/{{set}}/compliances.csv", set=COMPARED),
        settings=settings(
            "real_arms",
            arms=[
                {
                    "name": name,
                    "title": CONFIG.real[name].title,
                    "folder": f"{RESULTS}/real/{name}",
                    "reference": CONFIG.real[name].reference,
                    "run": CONFIG.real[name].run,
                    "first_id": CONFIG.real[name].first_id,
                }
                for name in PAGED
            ],
        ),
    output:
        touch(f"{RESULTS}/real_arms.done"),
    params:
        code=code("armscope.cli.real:page"),
    log:
        f"{RESULTS}/logs/real_arms.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real_arms.tsv"
    shell:
        "armscope real page docs/real-arms.md --settings {input.settings} --of \"commit $(git rev-parse --short HEAD)\" "
        "--force > {log} 2>&1"


rule real_concealed:
    input:
        f"{RESULTS}/proof_real/tables/rates.csv",
        settings=settings(
            "real_concealed",
            proof=f"{RESULTS}/proof_real/tables",
            titles={name: CONFIG.real[name].title.partition(",")[0] for name in PAGED},
        ),
    output:
        touch(f"{RESULTS}/real_concealed.done"),
    params:
        code=code("armscope.cli.real:concealed"),
    log:
        f"{RESULTS}/logs/real_concealed.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/real_concealed.tsv"
    shell:
        "armscope real concealed docs/real-concealed.md --settings {input.settings} --of \"commit $(git rev-parse --short HEAD)\" "
        "--force > {log} 2>&1"


rule real:
    input:
        expand(f"{RESULTS}/real/{{set}}/report.html", set=REAL),
        expand(f"{RESULTS}/real/{{set}}/{{table}}.csv", set=PAGED, table=("protocol", "regions")),
        expand(f"{RESULTS}/real/{{set}}/compliances.csv", set=COMPARED),
