"""A simulated arm of bench/ensemble.py as files for the program: URDF, problem file, list of candidates."""
import csv

import numpy as np

PROBLEM = """posewright: 1
robot: {{urdf: arm.urdf}}
measurement:
  type: points
  targets: {{{targets}}}
  device: {{type: isotropic, noise: "0.06 mm"}}
variants:
  everything: {{parameters: auto}}
design: {{poses: 10}}
"""


def urdf(arm):
    lines, before = ['<robot name="arm"><link name="base"/>'], np.zeros(3)
    for j in range(arm.joints):
        kind = "prismatic" if arm.sliding[j] else "revolute"
        words = {"o": arm.o[j] - before, "w": arm.w[j]}
        o, w = (" ".join(repr(float(v)) for v in words[k]) for k in "ow")
        low, high = map(float, arm.limits[j])
        lines.append(f'<link name="l{j + 1}"/><joint name="j{j + 1}" type="{kind}"><parent link="{f"l{j}" if j else "base"}"/>'
                     f'<child link="l{j + 1}"/><origin xyz="{o}"/><axis xyz="{w}"/>'
                     f'<limit lower="{low!r}" upper="{high!r}" effort="0" velocity="1"/></joint>')
        before = arm.o[j]
    return "\n".join(lines) + "\n</robot>\n"


def write(arm, pool, folder):
    """Problem file and list of candidates."""
    (folder / "arm.urdf").write_text(urdf(arm), encoding="utf-8")
    targets = ", ".join(f"T{k}: [{', '.join(repr(float(v)) for v in p - arm.o[-1])}]" for k, p in enumerate(arm.targets))
    (folder / "problem.yaml").write_text(PROBLEM.format(targets=targets), encoding="utf-8")
    with open(folder / "candidates.csv", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["id"] + [f"j{j + 1} [{'m' if s else 'rad'}]" for j, s in enumerate(arm.sliding)])
        out.writerows([k + 1] + [repr(float(v)) for v in q] for k, q in enumerate(pool.q))
    return folder / "problem.yaml", folder / "candidates.csv"
