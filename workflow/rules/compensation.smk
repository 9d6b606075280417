# What the paper leaves for later, on the virtual SK120: corrected commands, sub-volumes, products of polynomials.
OUTLOOK = f"{RESULTS}/compensation"
# beside the models of the configuration: a sparse choice of products, and blended sub-volumes
EXTENDED = (
    "--products 'SDP(CI)' --products '4th-degree polynomial (AI)' --products 'Fourier 2 (AI)' --products 'Fourier 3 (AI)' "
    "--regions 'FDP(CI)=2' --regions 'FDP(CI)=4'"
)


rule closed_loop:
    # errors at the commands that each model corrects, measured on the anchored robot itself
    input:
        robot=CONFIG.paper.robot.value,
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        robots=rules.measure.output.robots,
        fits=f"{PAPER}/fits.json.gz",
    output:
        table=f"{OUTLOOK}/closed_loop.csv",
        points=f"{OUTLOOK}/closed_loop_points.csv",
        png=f"{OUTLOOK}/closed_loop.png",
        svg=f"{OUTLOOK}/closed_loop.svg",
    params:
        extended=EXTENDED,
        code=code("armscope.cli.outlook:closed_loop"),
    log:
        f"{RESULTS}/logs/closed_loop.log",
    shell:
        "armscope closed-loop {input.robot} --poses {input.poses} --errors {input.errors} --robots {input.robots} "
        "--fits {input.fits} {params.extended} -o {output.table} --points {output.points} --figure {output.png} > {log} 2>&1"


rule regions:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        table=f"{OUTLOOK}/regions.csv",
        png=f"{OUTLOOK}/regions.png",
        svg=f"{OUTLOOK}/regions.svg",
    params:
        seed=CONFIG.seed,
        code=code("armscope.cli.outlook:regions_"),
    log:
        f"{RESULTS}/logs/regions.log",
    shell:
        "armscope regions --poses {input.poses} --errors {input.errors} --seed {params.seed} -o {output.table} "
        "--figure {output.png} > {log} 2>&1"


rule products:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{OUTLOOK}/products.csv",
    params:
        seed=CONFIG.seed,
        code=code("armscope.cli.outlook:products_"),
    log:
        f"{RESULTS}/logs/products.log",
    shell:
        "armscope products --poses {input.poses} --errors {input.errors} --seed {params.seed} -o {output} > {log} 2>&1"


rule full_pose:
    # position and orientation, with the wrist bent: the paper's trajectories run along its pole
    input:
        robot=CONFIG.paper.robot.value,
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        robots=rules.measure.output.robots,
    output:
        f"{OUTLOOK}/full_pose.csv",
    params:
        extended=EXTENDED,
        seed=CONFIG.seed,
        code=code("armscope.cli.outlook:full_pose"),
    log:
        f"{RESULTS}/logs/full_pose.log",
    shell:
        "armscope full-pose {input.robot} --poses {input.poses} --errors {input.errors} --robots {input.robots} "
        "{params.extended} --seed {params.seed} -o {output} > {log} 2>&1"


rule cross_table:
    # real arms: their held-out rows by prediction
    input:
        virtual=rules.closed_loop.output.table,
        real=expand(f"{RESULTS}/real/{{set}}/paper/{{file}}", set=REAL, file=("poses.csv", "errors.csv", "fits.json.gz")),
    output:
        f"{OUTLOOK}/cross_table.csv",
    params:
        folders=" ".join(f"--real {RESULTS}/real/{name}/paper" for name in REAL),
        extended=EXTENDED,
        code=code("armscope.cli.outlook:cross_table_"),
    log:
        f"{RESULTS}/logs/cross_table.log",
    shell:
        "armscope cross-table {input.virtual} {params.folders} {params.extended} -o {output} > {log} 2>&1"


rule compensation:
    input:
        rules.closed_loop.output,
        rules.cross_table.output,
        rules.full_pose.output,
        rules.regions.output,
        rules.products.output,
