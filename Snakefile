# The experiments of armscope. `snakemake -j2` runs the whole reproduction; see README.md for the other targets.
configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/real.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/sweep.smk"
include: "workflow/rules/proof.smk"
include: "workflow/rules/proof_real.smk"
include: "workflow/rules/compensation.smk"
include: "workflow/rules/poses.smk"
include: "workflow/rules/readme.smk"


localrules:
    all,


rule all:
    default_target: True
    input:
        rules.paper.input,
        rules.proof_small.input,
        rules.poses.input,


onsuccess:
    print(f"Table 2    {PAPER}/table2.html ({PAPER}/table2.csv)")
    print(f"figures    {PAPER}/figures/")
    print(f"report     {PAPER}/report.html")
    print(f"proof      {PROOF}/small/report.html")
