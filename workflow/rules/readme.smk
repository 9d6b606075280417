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


# the full proof takes hours, so nothing here runs it: what is there of it is taken, else the README keeps what it says
PROVEN = [path for path in (f"{PROOF}/full/tables/{name}.csv" for name in ("aims", "worlds")) if Path(path).is_file()]


rule readme:
    input:
        claims=f"{PAPER}/claims.csv",
        table2=f"{PAPER}/table2.csv",
        audit=f"{PAPER}/audit.csv",
        arm=f"{RESULTS}/examples/five-effects/figures/arm.svg",
    output:
        touch(f"{RESULTS}/readme.done"),
    params:
        folder=subpath(input.claims, parent=True),
        proof=f"{PROOF}/full/tables",
        proven=[hashlib.sha256(Path(path).read_bytes()).hexdigest() for path in PROVEN],
        code=code("armscope.cli.paper_pages:readme_"),
    log:
        f"{RESULTS}/logs/readme.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/readme.tsv"
    shell:
        "(armscope paper readme README.md {params.folder} {params.proof} && cp {input.arm} docs/figures/five-effects.svg) > {log} 2>&1"
