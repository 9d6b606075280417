# Identification poses by observability, and what they are worth beside random ones and a grid.
POSES = f"{RESULTS}/poses"


rule choose_poses:
    input:
        lambda wildcards: CONFIG.poses.robots[wildcards.arm],
    output:
        poses=f"{POSES}/{{arm}}.csv",
        indices=f"{POSES}/{{arm}}.json",
        compared=f"{POSES}/{{arm}}_compared.csv",
        figure=multiext(f"{POSES}/{{arm}}", ".png", ".svg"),
    params:
        options=(
            f"-n {CONFIG.poses.poses.value} --candidates {CONFIG.poses.candidates.value} --seeds {CONFIG.poses.seeds} "
            f"--tracker={','.join(map(str, CONFIG.poses.tracker_mm.value))} --floor-mm {CONFIG.poses.floor_mm.value} "
            f"--seed {CONFIG.seed}"
        ),
        code=code("armscope.cli.poses:poses"),
    log:
        f"{RESULTS}/logs/poses/{{arm}}.log",
    shell:
        "armscope poses --robot {input} {params.options} --all-criteria -o {output.poses} > {log} 2>&1"


rule poses:
    input:
        expand(f"{POSES}/{{arm}}.csv", arm=CONFIG.poses.robots),
