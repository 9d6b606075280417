# Arms in motion: public recordings, fetched, checked, imported and diagnosed, and the small proof on sealed worlds.
#   snakemake -j2 fetch_motions
FETCHED_MOTIONS = f"{RESULTS}/motions"
# a set whose arm is nowhere described can be fetched and imported, and not diagnosed
MOVING = sorted(path.parent.name for path in Path("config/motions").glob("*/mapping.yaml"))
WITH_ARM = [name for name in MOVING if urdf_of(name)]


rule fetch_motion:
    # as fetch_raw does for points
    input:
        source="config/motions/{moving_set}/source.yaml",
    output:
        f"{FETCHED_MOTIONS}/{{moving_set}}/fetched.txt",
    params:
        folder=subpath(output[0], parent=True),
        stand_in=lambda wildcards: f"--recordings-dir {MOTIONS}" if (MOTIONS / wildcards.moving_set / "raw").is_dir() else "",
        code=code("armscope.cli.recordings:fetch"),
    log:
        f"{RESULTS}/logs/motions/{{moving_set}}/fetch.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motions/{{moving_set}}/fetch.tsv"
    shell:
        "armscope fetch {input.source} -o {params.folder}/raw {params.stand_in} > {output} 2> {log}"


rule import_motion:
    input:
        fetched=f"{FETCHED_MOTIONS}/{{moving_set}}/fetched.txt",
        mapping="config/motions/{moving_set}/mapping.yaml",
    output:
        f"{FETCHED_MOTIONS}/{{moving_set}}/motions.csv.gz",
    params:
        raw=raw_motions,
        code=code("armscope.cli.recordings:import_"),
    log:
        f"{RESULTS}/logs/motions/{{moving_set}}/import.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motions/{{moving_set}}/import.tsv"
    shell:
        "armscope import {params.raw:q} --mapping {input.mapping} -o {output} > {log} 2>&1"


rule fetch_motions:
    input:
        expand(f"{FETCHED_MOTIONS}/{{moving_set}}/motions.csv.gz", moving_set=MOVING),


rule motion_real:
    # robot.yaml names a URDF beside it: both go where the verdict goes
    input:
        motions=rules.import_motion.output,
        urdf=lambda wildcards: urdf_of(wildcards.moving_set),
        robot="config/motions/{moving_set}/robot.yaml",
    output:
        verdict=f"{MOTION}/real/{{moving_set}}/verdict.json",
        report=f"{MOTION}/real/{{moving_set}}/report.html",
    params:
        folder=subpath(output.verdict, parent=True),
        code=code("armscope.cli.diagnosis:diagnose"),
    log:
        f"{RESULTS}/logs/motion/real/{{moving_set}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/motion/real/{{moving_set}}.tsv"
    shell:
        "(cp {input.urdf} {params.folder}/robot.urdf && cp {input.robot} {params.folder}/robot.yaml && "
        "armscope diagnose {input.motions} --robot {params.folder}/robot.yaml -o {params.folder} --force) > {log} 2>&1"


rule motion:
    input:
        rules.motion_proof.input,
        expand(f"{MOTION}/real/{{moving_set}}/report.html", moving_set=WITH_ARM),
