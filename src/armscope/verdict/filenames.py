"""What the files of a diagnosis are called: known before anything is imported that writes them."""

VERDICT, CURVES = "verdict.json", "curves.csv"
FILES = (
    VERDICT, "model.yaml", "predicted.csv", "suspects.csv", "next_poses.csv", CURVES, "atlas.csv",
)  # fmt: skip
"""All that `armscope.verdict.files.write_verdict` may write."""
