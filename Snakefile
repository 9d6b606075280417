# The experiments of armscope. `snakemake -j2` runs the whole reproduction; see README.md for the other targets.
configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/real.smk"
include: "workflow/rules/sweep.smk"


localrules:
    all,


rule all:
    default_target: True
    input:
        rules.paper.input,


onsuccess:
    for name, reason in SKIPPED.items():
        print(f"skipped    real arm {name}: {reason}")
    print(f"Table 2    {PAPER}/table2.html ({PAPER}/table2.csv)")
    print(f"figures    {PAPER}/figures/")
    print(f"report     {PAPER}/report.html")
