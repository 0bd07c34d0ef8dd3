#!/usr/bin/env python3
"""Growth of the CPU seconds with the size of a task.

    bench/growth.py PROGRAM [--rows candidates,data]

Each row runs a command on sizes that grow, up to ten times what people have. Prints CPU seconds and MiB of each size,
and the exponent between the last two sizes: seconds of the program's start and of reading its files included.
"""

import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

import pairs


def joints_arm(folder, joints):
    """An arm of so many joints, axes in turn about z, y and x."""
    axes, urdf = ["0 0 1", "0 1 0", "1 0 0"], '<robot name="arm"><link name="l0"/>\n'
    for j in range(1, joints + 1):
        urdf += (f'<link name="l{j}"/><joint name="j{j}" type="revolute"><parent link="l{j - 1}"/><child link="l{j}"/>'
                 f'<origin xyz="0.05 0 {2.4 / joints - 0.02 * j / joints:.4f}"/><axis xyz="{axes[j % 3]}"/>'
                 '<limit lower="-2.4" upper="2.4" effort="1" velocity="1"/></joint>\n')
    (folder / f"arm{joints}.urdf").write_text(urdf + "</robot>\n")
    text = (folder / pairs.eight_joints(folder)).read_text()
    (folder / f"arm{joints}.yaml").write_text(text.replace("eight.urdf, tip: l8", f"arm{joints}.urdf, tip: l{joints}"))
    return f"arm{joints}.yaml"


WAVES = """
import numpy as np
side = round(np.sqrt({triangles} / 2))
x, y = np.meshgrid(np.linspace(-0.45, 0.45, side + 1), np.linspace(-0.7, 0.7, side + 1), indexing="ij")
p = np.stack([x, y, 0.02 * np.sin(40 * x) * np.cos(40 * y)], axis=-1).astype("<f4")
a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
corners = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 9)
rows = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("c", "<f4", 9), ("s", "<u2")])
rows["c"] = corners
open("{name}", "wb").write(b" " * 80 + np.uint32(len(rows)).tobytes() + rows.tobytes())
"""


def triangles_cell(folder, triangles):
    """The cell with a sheet of waves of so many triangles on its fixture."""
    # In a process of its own: the peak memory of a child is at least that of its parent.
    subprocess.run([sys.executable, "-c", WAVES.format(triangles=triangles, name=f"waves{triangles}.stl")], cwd=folder / "examples/cell", check=True)
    return with_obstacles(folder, f"triangles{triangles}", f"{{name: waves, mesh: waves{triangles}.stl, at: [1.9, 0.2, 0.0]}}")


def bodies_cell(folder, bodies):
    """The cell with so many small boxes more, on the floor about the arm."""
    places = [(2 * math.pi * k / bodies, 1.4 + 0.6 * (k * 0.618 % 1)) for k in range(bodies)]
    return with_obstacles(folder, f"bodies{bodies}", *(
        f"{{name: box_{k}, box: [0.05, 0.05, 0.2], at: [{r * math.cos(a):.4f}, {r * math.sin(a):.4f}, -0.65]}}" for k, (a, r) in enumerate(places)))


def with_obstacles(folder, name, *obstacles):
    text = (folder / "examples/cell/problem.yaml").read_text()
    before = "      - {name: wall,"
    (folder / f"examples/cell/{name}.yaml").write_text(text.replace(before, "".join(f"      - {o}\n" for o in obstacles) + before, 1))
    return f"examples/cell/{name}.yaml"


def fleet(folder, robots):
    """Problem files of so many robots."""
    text = (folder / "examples/five_bar/problem.yaml").read_text()
    for k in range(robots):
        (folder / f"examples/five_bar/robot_{k}.yaml").write_text(text)
    return [f"examples/five_bar/robot_{k}.yaml" for k in range(robots)]


def rows(program, folder):
    """@return name → sizes, and the words of a size"""
    def select(n, m, poses, *words):
        return ["select", pairs.gaussian(folder, n, m, 1), "--poses", str(poses), *words, *pairs.SELECT]

    def calibrate(variant, poses):
        return ["calibrate", "examples/kr270/unmodelled.yaml", pairs.measured(program, folder, poses),
                "--variant", variant, "--json", "-o", "-"]

    def plan(problem, *words):
        return ["plan", problem, "--proof-time", "0", *words, *pairs.PLAN]

    kr270 = "examples/kr270/problem.yaml"
    return {
        "candidates, select of n × 20, 40 poses": ((10_000, 100_000, 1_000_000), lambda n: select(n, 20, 40)),
        "parameters, select of 5,000 × m, 2 m poses": ((30, 100, 300), lambda m: select(5000, m, 2 * m, "--restarts", "1")),
        "parameters alone, select of 5,000 × m, 600 poses": ((30, 100, 300), lambda m: select(5000, m, 600, "--restarts", "1")),
        "poses, select of 5,000 × 10": ((100, 300, 1000), lambda poses: select(5000, 10, poses)),
        "poses, report of the KR 270": ((30, 100, 300, 1000), lambda poses: [
            "report", pairs.planned(program, folder, kr270, poses, restarts=10) + ".json", "-o", "out.html", "--force", "--quiet"]),
        "measured poses, calibrate": ((300, 1000, 5000), lambda poses: calibrate("geometric", poses)),
        "measured poses, calibrate with an unmodelled effect": ((300, 1000, 5000), lambda poses: calibrate("lacking", poses)),
        "joints, plan": ((4, 7, 14), lambda joints: plan(joints_arm(folder, joints))),
        "bodies, observe of the cell": ((10, 30, 100, 300), lambda bodies: ["observe", bodies_cell(folder, bodies), "--quiet"]),
        "triangles of an obstacle, observe of the cell": ((10_000, 100_000, 1_000_000), lambda triangles: [
            "observe", triangles_cell(folder, triangles), "--quiet"]),
        "robots of a fleet, plans of the five-bar": ((10, 30, 100), lambda robots: [
            "fleet", *fleet(folder, robots), "--output-dir", "fleet", "--force", "--quiet"]),
        "robots of the tolerances, plan of the KR 270": ((10, 30, 100), lambda robots: plan(kr270, "--robust", str(robots))),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--rows", default="", help="beginnings of names, with commas; all")
    arguments = parser.parse_args()
    wanted = tuple(arguments.rows.split(",")) if arguments.rows else ("",)
    print("| what grows | sizes | CPU s | MiB | exponent |\n| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        folder, program = pathlib.Path(name), arguments.program.resolve()
        pairs.prepare(folder, None)
        for title, (sizes, words) in rows(program, folder).items():
            if not title.startswith(wanted):
                continue
            results = [pairs.run(program, words(size), folder) for size in sizes]
            seconds = [cpu for cpu, _, _ in results]
            exponent = math.log(seconds[-1] / seconds[-2]) / math.log(sizes[-1] / sizes[-2])
            print(f"| {title} | {', '.join(f'{s:,}' for s in sizes)} | {', '.join(f'{s:.3g}' for s in seconds)} | "
                  f"{', '.join(f'{m:.0f}' for _, m, _ in results)} | {exponent:.2f} |", flush=True)


if __name__ == "__main__":
    main()
