"""Design of experiments on plain arrays: how much some poses tell about some parameters, and which tell most."""
