"""What was measured: how a model predicts it, how noisy it is, how much a row counts."""
