"""What can be missing from a simulation: one small file per family of effects, and the model made of them."""
