# Sweeps over the swarm and the models: one job per variant of the table, drawn together.
from armscope.core.variants import read_variants

try:
    VARIANTS = {variant.id: variant for variant in read_variants(CONFIG.sweep)}
except InputError as error:
    raise WorkflowError(str(error)) from None

SWEEP = f"{RESULTS}/sweep/{Path(CONFIG.sweep).stem}"


rule sweep_variant:
    input:
        poses=rules.measure.output.poses,
        errors=rules.measure.output.errors,
        settings=lambda wildcards: settings(
            f"sweep/{wildcards.variant}",
            seed=CONFIG.seed,
            basis=CONFIG.paper.swarm.basis,
            layout=CONFIG.paper.swarm.layout,
            engine=CONFIG.paper.swarm.engine,
            variant=VARIANTS[wildcards.variant],
        ),
    output:
        f"{SWEEP}/variants/{{variant}}.csv",
    params:
        code=code("armscope.cli.sweep:run"),
    log:
        f"{RESULTS}/logs/sweep/{{variant}}.log",
    shell:
        "armscope sweep run {input.poses} {input.errors} --settings {input.settings} -o {output} > {log} 2>&1"


rule sweep:
    input:
        expand(f"{SWEEP}/variants/{{variant}}.csv", variant=VARIANTS),
    output:
        table=f"{SWEEP}/sweep.csv",
        figures=multiext(f"{SWEEP}/sweep", ".png", ".svg", ".pdf"),
    params:
        code=code("armscope.cli.sweep:draw"),
    log:
        f"{RESULTS}/logs/sweep.log",
    shell:
        "armscope sweep draw {input} -o {output.table} > {log} 2>&1"
