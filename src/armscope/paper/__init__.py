"""The 2006 paper: its printed numbers, robots anchored to them, Table 2, claims, audit, and the same on real arms.

The way of a study, each step a pure function of the ones before:

    errors = geometric_errors(arm, link_m, link_rad, base_m, base_rad)        # armscope.world.tolerances
    paths = PlannedPaths(...).by_name()                                       # name -> (N, 3) mm
    trajectories = trajectory_poses(arm, paths)                               # pose table
    identification, choice = identification_poses(errors, trajectories, ...)  # pose table, observability index
    study = measure_virtual(errors, concat([identification, trajectories]), tracker, ensemble, seed)
    study.robots.to_table()                                                   # anchored geometric errors
    study.measurements.to_tables()                                            # poses, errors; and from_tables
    fits = fit_swarms(study.measurements.fit_problems(specs, robots), seeds)  # armscope.errormodels
    residuals = residual_table(study.measurements, fits)                      # one row per robot, model, cell, seed
    table2(residuals)                                                         # beside the printed one
    sub_volumes(study.measurements)                                           # one, two, four regions
    claims(residuals, fits, sub_volumes(...), fits_as_printed)                # verdicts
    reading(study.measurements.identification.nominal_mm)                     # Eqs. (15)-(17) as physics
    cross_check(residuals, fits)                                              # printed numbers anchoring did not use
    audit()                                                                   # printed against printed

    rows = recordings.of_runs([run], first_id)                                # a real arm's
    real_measurements(arm, rows, seed).measurements                           # for the same fits and tables

Everything here is in mm and rad, as the paper's equations.
"""
