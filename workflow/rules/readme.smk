# The README's numbers and figure. They are files under version control, so this is no part of the default run.


rule example:
    input:
        recordings="examples/{example}/recordings.csv",
        robot="examples/{example}/robot.yaml",
    output:
        verdict=f"{RESULTS}/examples/{{example}}/verdict.json",
        report=f"{RESULTS}/examples/{{example}}/report.html",
        arm=f"{RESULTS}/examples/{{example}}/figures/arm.svg",
    params:
        folder=subpath(output.verdict, parent=True),
        code=code("armscope.cli.diagnosis:diagnose"),
    log:
        f"{RESULTS}/logs/examples/{{example}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/examples/{{example}}.tsv"
    shell:
        "armscope diagnose {input.recordings} --robot {input.robot} -o {params.folder} --force > {log} 2>&1"


rule readme:
    input:
        claims=f"{PAPER}/claims.csv",
        table2=f"{PAPER}/table2.csv",
        aims=f"{PROOF}/full/tables/aims.csv",
        worlds=f"{PROOF}/full/tables/worlds.csv",
        arm=f"{RESULTS}/examples/five-effects/figures/arm.svg",
    output:
        touch(f"{RESULTS}/readme.done"),
    params:
        folder=subpath(input.claims, parent=True),
        proof=subpath(input.aims, parent=True),
        code=code("armscope.cli.paper_pages:readme_"),
    log:
        f"{RESULTS}/logs/readme.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/readme.tsv"
    shell:
        "(armscope paper readme README.md {params.folder} {params.proof} && cp {input.arm} docs/figures/five-effects.svg) > {log} 2>&1"
