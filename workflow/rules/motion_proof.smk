# The diagnosis of arms in motion on worlds with concealed causes. Who diagnoses sees robot.yaml and motions only.
MOTION = f"{RESULTS}/motion"
MOTION_TABLES = "proof effects names intervals summary per_effect".split()


wildcard_constraints:
    motion_size="small|full",


rule motion_proof_seed:
    output:
        f"{MOTION}/{{motion_size}}/seed.json",
    params:
        fixed="" if CONFIG.proof_seed is None else f"--fixed {CONFIG.proof_seed}",
        code=code("armscope.cli.motion_proof:diagnose"),
    log:
        f"{RESULTS}/logs/motion/{{motion_size}}/seed.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motion/{{motion_size}}/seed.tsv"
    shell:
        "armscope proof seed {params.fixed} -o {output} > {log} 2>&1"


rule motion_proof_worlds:
    input:
        robots="config/motion",
        seed=rules.motion_proof_seed.output,
    output:
        visible=directory(f"{MOTION}/{{motion_size}}/visible"),
        sealed=f"{MOTION}/{{motion_size}}/sealed.tar.gz",
    params:
        code=code("armscope.cli.motion_proof:worlds"),
    log:
        f"{RESULTS}/logs/motion/{{motion_size}}/worlds.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motion/{{motion_size}}/worlds.tsv"
    shell:
        "armscope proof motion worlds {input.robots} --size {wildcards.motion_size} --seed-file {input.seed} "
        "--visible {output.visible} --sealed {output.sealed} > {log} 2>&1"


rule motion_proof_diagnose:
    # in a folder of its own, into which only its inputs are linked; `seen` lists what it found there
    input:
        rules.motion_proof_worlds.output.visible,
    output:
        verdicts=directory(f"{MOTION}/{{motion_size}}/verdicts"),
        seen=f"{MOTION}/{{motion_size}}/seen.txt",
    params:
        code=code("armscope.cli.motion_proof:diagnose", "armscope.cli.diagnosis:diagnose"),
    log:
        f"{RESULTS}/logs/motion/{{motion_size}}/diagnose.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motion/{{motion_size}}/diagnose.tsv"
    shadow:
        "minimal"
    shell:
        "(seen=$(mktemp ../seen.XXXXXXXX) && chmod a+r $seen && "
        "find -L . {input} -type f -not -name '*.log' -not -name '.*' -not -path '*/.armscope/*' > $seen && "
        "mv $seen {output.seen} && "
        "armscope proof motion diagnose {input} -o {output.verdicts}) > {log} 2>&1"


rule motion_proof_score:
    # the only rule that opens the seals
    input:
        visible=rules.motion_proof_worlds.output.visible,
        sealed=rules.motion_proof_worlds.output.sealed,
        verdicts=rules.motion_proof_diagnose.output.verdicts,
        seen=rules.motion_proof_diagnose.output.seen,
    output:
        expand(f"{MOTION}/{{{{motion_size}}}}/tables/{{table}}.csv", table=MOTION_TABLES),
        f"{MOTION}/{{motion_size}}/tables/summary.md",
    params:
        folder=lambda wildcards: f"{MOTION}/{wildcards.motion_size}",
        code=code("armscope.cli.motion_proof:score"),
    log:
        f"{RESULTS}/logs/motion/{{motion_size}}/score.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motion/{{motion_size}}/score.tsv"
    shell:
        "armscope proof motion score {params.folder} -o {params.folder}/tables > {log} 2>&1"


rule motion_proof:
    input:
        f"{MOTION}/small/tables/summary.csv",


rule motion_proof_full:
    input:
        f"{MOTION}/full/tables/summary.csv",
