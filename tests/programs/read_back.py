"""Programs that `export` writes are judged by `evaluate` as the plan they were made from: read_back.py PROGRAM.

A route of an arm, in all languages of programs, and a plan of one with external axes. The route's program has home and points on the way, which are no poses.
"""

import functools
import json
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
JOINTS = [("0 0 0.4", "0 0 1"), ("0.1 0 0.1", "0 1 0"), ("0.5 0 0", "0 1 0"), ("0.1 0 0.05", "1 0 0"), ("0.4 0 0", "0 1 0"), ("0.1 0 0", "1 0 0")]
PROBLEM = """posewright: 1
robot: {urdf: arm.urdf, base: l0, tip: l6}
measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
variants: {all: {parameters: auto}}
workspace: {collision: {self: false, obstacles: [{name: post, box: [0.1, 0.1, 2], at: [0.45, 0.3, 1]}, {name: other, box: [0.1, 0.1, 2], at: [0.4, -0.4, 1]}]}}
design: {criterion: o1, poses: 14, candidates: 60, method: greedy, restarts: 1}
"""
YASKAWA = "sign: [1, -1, 1, -1, 1, 1]\nzero_deg: [0, 5, 0, 0, 0, 0]\npulses_per_degree: [1435.1, 1435.1, 1300.5, 1024, 1024, 568.9]\ncoupling: 0\naxes: [S, L, U, R, B, T]\n"
UNIVERSAL = "axes: [base, shoulder, elbow, wrist1, wrist2, wrist3]\n"
FORMATS = {"kuka-krl": ("ROUTE.src", []), "abb-rapid": ("ROUTE.mod", ["--coupling", "-1"]), "fanuc-tp": ("ROUTE.ls", ["--coupling", "1"]),
           "urscript": ("ROUTE.script", ["--controller", "universal.yaml"]), "yaskawa-inform": ("ROUTE.JBI", ["--controller", "yaskawa.yaml"]), "staubli-val3": ("ROUTE", []), "joint-trajectory": ("ROUTE.yaml", [])}


def run(*words):
    result = subprocess.run([PROGRAM, *words], cwd=FOLDER, capture_output=True, text=True)
    assert result.returncode == 0, (words, result.stderr)
    return result.stdout


@functools.cache
def scores(file, *words):
    return json.loads(run("evaluate", "p.yaml", file, "--candidates", "40", "--json", *words))["scores"]


def difference(a, b):
    """Of the criteria's values, relative; efficiencies are those of a search."""
    assert [x["criterion"] for x in a] == [x["criterion"] for x in b]
    return max(abs(x["value"] - y["value"]) / abs(x["value"]) for x, y in zip(a, b))


def write_robot(joints):
    links = "".join(f'<link name="l{k}"><collision><geometry><sphere radius="0.03"/></geometry></collision></link>' for k in range(len(joints) + 1))
    text = "".join(f'<joint name="j{k + 1}" type="{kind}"><parent link="l{k}"/><child link="l{k + 1}"/><origin xyz="{o}"/><axis xyz="{a}"/>'
                   f'<limit lower="-{reach}" upper="{reach}" velocity="1" effort="1"/></joint>' for k, (o, a, kind, reach) in enumerate(joints))
    (FOLDER / "arm.urdf").write_text(f'<robot name="arm">{links}{text}</robot>')
    (FOLDER / "p.yaml").write_text(PROBLEM.replace("l6", f"l{len(joints)}"))


def read_back(source, language, file, words):
    run("export", source, "--to", language, "-o", file, "--unchecked", *words)
    made = next(p for p in ([FOLDER / file] if "." in file else (FOLDER / file).glob("**/*.dtx")))
    off = difference(scores(source), scores(str(made.relative_to(FOLDER)), "--from", language, *words))
    print(f"{language}: scores differ by {off:.1e}")
    assert off < 1e-4 and (off > 0 or language == "joint-trajectory"), off  # programs have rounded numbers


with tempfile.TemporaryDirectory() as name:
    FOLDER = pathlib.Path(name)
    arm = [(o, a, "revolute", 2.2) for o, a in JOINTS]
    write_robot(arm)
    (FOLDER / "yaskawa.yaml").write_text(YASKAWA)
    (FOLDER / "universal.yaml").write_text(UNIVERSAL)
    run("plan", "p.yaml", "-o", "plan.json", "--poses-csv", "-")
    run("route", "plan.json", "--from-home", "-o", "route.json")
    route = json.loads((FOLDER / "route.json").read_text())
    via = sum(len(motion["points"]) - 2 for motion in route["motions"])
    assert via > 0, "no point on the way"
    for language, (file, words) in FORMATS.items():
        read_back("route.json", language, file, words)
    print(f"{len(route['poses'])} poses, {via} points on the way")

    # On a rail and a turntable, which controllers count as external axes.
    write_robot([("0 0 0", "1 0 0", "prismatic", 0.8), ("0 0 0.1", "0 0 1", "revolute", 1.5), *arm])
    run("plan", "p.yaml", "-o", "rail.json", "--poses-csv", "-", "--force")
    for language, file, axes in (("kuka-krl", "RAIL.src", "E1, E2, A1, A2, A3, A4, A5, A6"), ("fanuc-tp", "RAIL.ls", "E1, GP2.J1, J1, J2, J3, J4, J5, J6"),
                                 ("abb-rapid", "RAIL.mod", "eax_a, eax_b, rax_1, rax_2, rax_3, rax_4, rax_5, rax_6")):
        (FOLDER / "axes.yaml").write_text(f"axes: [{axes}]\ncoupling: 0\n")
        read_back("rail.json", language, file, ["--controller", "axes.yaml"])
