# Arms in motion: public recordings where they lie beside the checkout, and the small proof on sealed worlds.
MOTIONS = Path(RECORDINGS).parent / "motions"
MOVING = [
    path.stem for path in sorted(Path("config/motions").glob("*.yaml")) if (MOTIONS / path.stem / "motions.csv.gz").is_file()
]


rule motion_real:
    # robot.yaml names a URDF beside it: both go where the verdict goes
    input:
        motions=f"{MOTIONS}/{{moving_set}}/motions.csv.gz",
        urdf=f"{MOTIONS}/{{moving_set}}/robot.urdf",
        robot="config/motions/{moving_set}.yaml",
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
        expand(f"{MOTION}/real/{{moving_set}}/report.html", moving_set=MOVING),
