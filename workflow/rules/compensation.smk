# What the paper leaves for later, on the virtual SK120: corrected commands, sub-volumes, products of polynomials.
OUTLOOK = f"{RESULTS}/compensation"


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
        figure=f"{OUTLOOK}/closed_loop.png",
    params:
        code=code("armscope.cli.compensation:closed_loop"),
    log:
        f"{RESULTS}/logs/closed_loop.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope closed-loop {input.robot} --poses {input.poses} --errors {input.errors} --robots {input.robots} "
        "--fits {input.fits} --products 'Fourier 3 (AI)' -o {output.table} --points {output.points} --figure {output.figure} > {log} 2>&1"


rule regions:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        table=f"{OUTLOOK}/regions.csv",
        figure=f"{OUTLOOK}/regions.png",
    params:
        seed=CONFIG.seed,
        code=code("armscope.cli.compensation:regions_"),
    log:
        f"{RESULTS}/logs/regions.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope regions --poses {input.poses} --errors {input.errors} --seed {params.seed} -o {output.table} "
        "--figure {output.figure} > {log} 2>&1"


rule products:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
    output:
        f"{OUTLOOK}/products.csv",
    params:
        seed=CONFIG.seed,
        code=code("armscope.cli.compensation:products_"),
    log:
        f"{RESULTS}/logs/products.log",
    conda:
        "../envs/armscope.yaml"
    shell:
        "armscope products --poses {input.poses} --errors {input.errors} --seed {params.seed} -o {output} > {log} 2>&1"


rule compensation:
    input:
        rules.closed_loop.output,
        rules.regions.output,
        rules.products.output,
