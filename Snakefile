# The experiments of armscope. `snakemake -j2` runs the whole reproduction; see README.md for the other targets.
configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/paper.smk"


localrules:
    all,


rule all:
    default_target: True
    input:
        rules.paper.input,


onsuccess:
    print(
        f"\nTable 2    {RESULTS}/paper/table2.html\nfigures    {RESULTS}/paper/figures/\nreport     {RESULTS}/paper/report.html"
    )
