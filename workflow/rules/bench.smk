# The developers' bench, where it is: simulated arms of an independent engine, diagnosed in batches, scored by its own scorer.
#   snakemake -j2 bench && python -m tools.why_a_name --rates results/bench/figures.json
BENCH = Path(CONFIG.bench_dir)
BENCH_CASES = sorted(case.name for case in BENCH.glob("cases/d*")) if (BENCH / "score.py").is_file() else []
BENCH_BATCHES = {f"{n:02d}": BENCH_CASES[n :: CONFIG.bench_parts] for n in range(CONFIG.bench_parts)} if BENCH_CASES else {}


rule bench_run:
    input:
        lambda wildcards: [f"{BENCH}/cases/{case}" for case in BENCH_BATCHES[wildcards.bench_batch]],
    output:
        directory(f"{RESULTS}/bench/runs/{{bench_batch}}"),
    params:
        bench=BENCH,
        cases=lambda wildcards: BENCH_BATCHES[wildcards.bench_batch],
        code=code("armscope.cli.diagnosis:diagnose", "armscope.cli.diagnosis:predict"),
    log:
        f"{RESULTS}/logs/bench/{{bench_batch}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/bench/{{bench_batch}}.tsv"
    shell:
        "python -m tools.bench run {params.bench} -o {output} {params.cases} > {log} 2>&1"


rule bench:
    # where the bench is missing there is nothing to score, and the rule says so
    input:
        expand(f"{RESULTS}/bench/runs/{{bench_batch}}", bench_batch=BENCH_BATCHES),
    output:
        [f"{RESULTS}/bench/figures.json", f"{RESULTS}/bench/table.md"] if BENCH_CASES else [],
    params:
        bench=BENCH,
        folder=subpath(output[0], parent=True) if BENCH_CASES else "",
    log:
        f"{RESULTS}/logs/bench/score.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/bench/score.tsv"
    shell:
        (
            "python -m tools.bench score {params.bench} -o {params.folder} {input} > {log} 2>&1"
            if BENCH_CASES
            else f"echo 'skipped: the bench, because {BENCH} is not there' | tee {{log}}"
        )
