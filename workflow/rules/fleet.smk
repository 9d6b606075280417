# Many arms: `snakemake -j2 fleet` diagnoses those of config/fleet.csv; --config fleet=mine.csv takes others.
rule fleet_diagnose:
    input:
        table=CONFIG.fleet,
        files=files_of_part,
    output:
        directory(f"{FLEET}/verdicts/{{part}}"),
    params:
        parts=lambda wildcards: fleet_parts(),
        code=code("armscope.cli.fleet:diagnose"),
    log:
        f"{RESULTS}/logs/fleet/diagnose-{{part}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/fleet/diagnose-{{part}}.tsv"
    shell:
        "armscope fleet diagnose {input.table} --part {wildcards.part}/{params.parts} -o {output} > {log} 2>&1"


rule fleet_page:
    input:
        table=CONFIG.fleet,
        verdicts=lambda wildcards: expand(f"{FLEET}/verdicts/{{part}}", part=range(fleet_parts())),
    output:
        f"{FLEET}/report.html",
        expand(f"{FLEET}/{{table}}.csv", table=("arms", "causes", "repeated")),
        f"{FLEET}/priors.yaml",
    params:
        folder=subpath(output[0], parent=True),
        verdicts=lambda wildcards, input: " ".join(f"--verdicts {folder}" for folder in input.verdicts),
        code=code("armscope.cli.fleet:page"),
    log:
        f"{RESULTS}/logs/fleet/page.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/fleet/page.tsv"
    shell:
        "armscope fleet page {input.table} {params.verdicts} -o {params.folder} > {log} 2>&1"


rule fleet:
    input:
        rules.fleet_page.output,
