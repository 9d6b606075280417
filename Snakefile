# The experiments of armscope. `snakemake -j2` runs the whole reproduction; see README.md for the other targets.
from snakemake.utils import min_version

min_version("9.0")


configfile: "config/config.yaml"


report: "workflow/report/description.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/paper_claims.smk"
include: "workflow/rules/paper_report.smk"
include: "workflow/rules/real.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/sweep.smk"
include: "workflow/rules/proof.smk"
include: "workflow/rules/proof_real.smk"
include: "workflow/rules/motion_proof.smk"
include: "workflow/rules/motion.smk"
include: "workflow/rules/bench.smk"
include: "workflow/rules/compensation.smk"
include: "workflow/rules/poses.smk"
include: "workflow/rules/readme.smk"
include: "workflow/rules/fleet.smk"


# what takes less time than its own submission to a cluster, or needs the network or the checkout itself
localrules:
    all,
    audit,
    bench,
    choose_poses,
    claims,
    fetch_raw,
    fleet_page,
    paper_report,
    proof_real_seed,
    proof_seed,
    readme,
    real_arms,
    real_concealed,
    sensitivity,


rule all:
    default_target: True
    input:
        rules.paper.input,
        rules.proof_small.input,


onsuccess:
    for what, path in {
        "Table 2": f"{PAPER}/table2.html",
        "figures": f"{PAPER}/figures",
        "report": f"{PAPER}/report.html",
        "proof": f"{PROOF}/small/report.html",
    }.items():
        if Path(path).exists():  # other targets make other things
            print(f"{what:10} {path}")
