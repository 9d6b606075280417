# Public recordings of real arms, fetched from their source, checked, and converted:
#   snakemake -j2 fetch_recordings
#   snakemake -j2 --config recordings_dir=results/recordings
IMPORTABLE = [path.parent.name for path in sorted(Path("config/recordings").glob("*/mapping.yaml"))]
FETCHED = f"{RESULTS}/recordings"


rule fetch_raw:
    # the files themselves are no output: Snakemake would remove what is whole, or kept aside, when one of them fails
    input:
        source="config/recordings/{public_set}/source.yaml",
    output:
        f"{FETCHED}/{{public_set}}/fetched.txt",
    params:
        folder=subpath(output[0], parent=True),
        # a folder of the raw files stands in for the network where there is one
        stand_in=lambda wildcards: (
            f"--recordings-dir {RECORDINGS}" if Path(RECORDINGS, wildcards.public_set, "raw").is_dir() else ""
        ),
        code=code("armscope.cli.recordings:fetch"),
    log:
        f"{RESULTS}/logs/recordings/{{public_set}}/fetch.log",
    shell:
        "armscope fetch {input.source} -o {params.folder}/raw {params.stand_in} > {output} 2> {log}"


rule import_raw:
    input:
        fetched=f"{FETCHED}/{{public_set}}/fetched.txt",
        mapping="config/recordings/{public_set}/mapping.yaml",
        robot="config/recordings/{public_set}/robot.yaml",
    output:
        recordings=f"{FETCHED}/{{public_set}}/recordings.csv.gz",
        robot=f"{FETCHED}/{{public_set}}/robot.yaml",
    params:
        raw=raw_files,
        code=code("armscope.cli.recordings:import_"),
    log:
        f"{RESULTS}/logs/recordings/{{public_set}}/import.log",
    shell:
        "(armscope import {params.raw:q} --mapping {input.mapping} -o {output.recordings} && cp {input.robot} {output.robot}) "
        "> {log} 2>&1"


rule fetch_recordings:
    input:
        expand(f"{FETCHED}/{{public_set}}/recordings.csv.gz", public_set=IMPORTABLE),
