"""mujoco.sysid: the model's parameters by simulation, so that pieces of the motion come out as they were recorded.

As in its own tests and documentation: an MJCF whose motors play back the recorded torque, sensors of the joints'
angles and speeds, `build_residual_fn` and `optimize` (its Gauss-Newton with differences, on one thread). Free are
armature, damping and dry friction of every joint (`joints`), and mass, centre and inertia of every link, too (`all`:
its pseudo-inertia, which is always that of a body), from what robot.yaml states; friction and rotors start at a
hundredth of each joint's largest torque. Played back without a controller an arm falls away from its recording, so that
the motion is cut into pieces of WINDOW_S that each begin as recorded. Angles, speeds and accelerations come low-passed,
as for all; torque as recorded. What it then says of the test path is its own inverse dynamics (mj_inverse). It is
stopped after ITERATIONS; with masses free it has not come to rest by then.

    PYTHON motion_with_sysid.py arm.xml motion.npz said.npz joints    # or all; prints one line of JSON
"""

from __future__ import annotations

import json
import sys
import time

import mujoco
import numpy as np
from mujoco import sysid

WINDOW_S, STEP_S, ITERATIONS = 0.5, 0.01, 30


def free(spec: mujoco.MjSpec, model: mujoco.MjModel, torque: np.ndarray, masses: bool) -> sysid.ParameterDict:
    """Parameters of every joint, and of every link."""
    found = sysid.ParameterDict()
    for number, most in enumerate(torque):
        joint = model.joint(number).name
        for attribute in ("armature", "damping", "frictionloss"):
            change = lambda s, p, j=joint, a=attribute: _set(s.joint(j), a, p.value[0])
            begin = 0.01 * most
            found.add(sysid.Parameter(f"{joint} {attribute}", begin, 0.0, most, modifier=change))
        body = model.body(model.jnt_bodyid[number]).name
        if masses:
            found.add(sysid.body_inertia_param(spec, model, body, sysid.InertiaType.Pseudo, modifier=_heavier(body)))
    return found


def _heavier(name: str):
    """Its own way to write a pseudo-inertia into a body compiles the model each time, and fails on 4.0.0."""

    def change(spec: mujoco.MjSpec, parameter: sysid.Parameter) -> None:
        pi, body = sysid.model_modifier.pi_from_theta(parameter.value), spec.body(name)
        centre = pi[1:4] / pi[0]
        about = pi[4:].reshape(3, 3) + pi[0] * sysid.model_modifier.skew(centre) @ sysid.model_modifier.skew(centre)
        moments, axes = np.linalg.eigh(about)
        axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
        turn = np.empty(4)
        mujoco.mju_mat2Quat(turn, axes.ravel())
        body.mass, body.ipos, body.inertia, body.iquat = pi[0], centre, moments, turn

    return change


def _set(joint: mujoco.MjsJoint, attribute: str, value: float) -> None:
    if attribute == "damping" and np.size(joint.damping) > 1:  # a polynomial of the speed in newer versions
        joint.damping[0] = value
    else:
        setattr(joint, attribute, value)


def pieces(model: mujoco.MjModel, motion: dict, part: str) -> list[sysid.SystemTrajectory]:
    """The motion cut up, each piece with the state that it begins in."""
    rate, names = float(motion["rate"]), [model.sensor(k).name for k in range(model.nsensor)]
    length, made = round(WINDOW_S * rate), []
    for run in np.unique(motion[f"run_{part}"]):
        rows = np.flatnonzero(motion[f"run_{part}"] == run)
        for start in range(0, len(rows) - length, length):
            at = rows[start : start + length + 1]
            times = np.arange(len(at)) / rate
            q, dq = motion[f"q_{part}"][at], motion[f"dq_{part}"][at]
            seen = sysid.TimeSeries.from_names(times, np.hstack([q, dq]), model)
            played = sysid.TimeSeries(times, motion[f"tau_{part}"][at])
            made.append((sysid.create_initial_state(model, q[0], dq[0]), played, seen))
    assert len(names) == 2 * model.nv
    return [sysid.SystemTrajectory(model, control, seen, state, None) for state, control, seen in made]


def said(model: mujoco.MjModel, motion: dict) -> np.ndarray:
    """(N, m) torques of the test path by inverse dynamics."""
    data, found = mujoco.MjData(model), []
    for row in zip(motion["q_test"], motion["dq_test"], motion["ddq_test"], strict=True):
        data.qpos, data.qvel, data.qacc = row
        mujoco.mj_inverse(model, data)
        found.append(data.qfrc_inverse.copy())
    return np.array(found)


def main() -> None:
    """Identify on train, foretell test."""
    motion = dict(np.load(sys.argv[2]))
    spec = mujoco.MjSpec.from_file(sys.argv[1])
    spec.option.timestep = STEP_S
    model = spec.compile()
    started = time.process_time()
    whole = pieces(model, motion, "train")
    state, control, seen = whole[0].initial_state, whole[0].control, whole[0].sensordata
    together = sysid.ModelSequences("arm", spec, "pieces", state, control, seen)
    together.measured_rollout = [whole]  # all pieces of one length at once
    params = free(spec, model, np.abs(motion["tau_train"]).max(axis=0), sys.argv[4] == "all")
    scale = np.concatenate([motion[f"{name}_train"].std(axis=0) for name in ("q", "dq")])

    def difference(parameters, predicted, measured, *_args, state, **_more):
        times = measured.times[1:]  # of states: sensors of a rollout tell of the state before each step
        passed = sysid.TimeSeries(state[:, 0], state[:, 1 : 1 + len(scale)], measured.signal_mapping)
        by_time = passed.resample(times)
        measured = sysid.TimeSeries(times, measured.data[1:], measured.signal_mapping)
        return (by_time.data - measured.data) / scale, by_time, measured

    apart = sysid.build_residual_fn(models_sequences=[together], modify_residual=difference, n_threads=1)

    def residual(x, parameters, **more):
        (left,), *rest = apart(x, parameters, **more)
        if np.ndim(x) == 1:
            return [left], *rest
        by_piece = left.reshape(len(left), x.shape[1], len(whole))  # it lays pieces beside the columns of differences
        return [by_piece.transpose(0, 2, 1).reshape(-1, x.shape[1])], *rest

    found, _ = sysid.optimize(params, residual, "mujoco", max_iters=ITERATIONS, verbose=False)
    seconds = time.process_time() - started
    np.savez(sys.argv[3], said=said(sysid.apply_param_modifiers(found, spec), motion))
    print(json.dumps({"cpu_s": seconds, "parameters": int(params.size), "pieces": len(whole)}))


if __name__ == "__main__":
    main()
