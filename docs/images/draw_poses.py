"""draw_poses.py poses.csv OUT.svg: the KR 270's planned poses as stick figures, from the side and from above."""
import csv
import math
import sys


def rotation(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]],
            "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


# The joints of examples/kr270/kr270.urdf: where each one stands in the frame before it, and its axis.
joints = [((0, 0, 0), "z"), ((0.35, 0, 0), "y"), ((1.25, 0, 0), "y"), ((1.1, 0, -0.055), "x"), ((0, 0, 0), "y"), ((0, 0, 0), "x")]


def skeleton(q):
    """Base column, joints and one reflector."""
    R, p, points = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0.0, 0.0, 0.0], [[0, 0, -0.75]]
    for (offset, axis), angle in zip(joints, q):
        p = [p[i] + sum(R[i][k] * offset[k] for k in range(3)) for i in range(3)]
        points.append(p)
        R = times(R, rotation(axis, angle))
    tip = (0.277, -0.047, -0.094)
    points.append([p[i] + sum(R[i][k] * tip[k] for k in range(3)) for i in range(3)])
    return points


def main(source, target):
    with open(source, newline="") as file:
        rows = list(csv.reader(file))[1:]
    scale, out = 95, []
    out.append('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 500" font-family="sans-serif" font-size="15">')
    out.append('<rect width="1000" height="500" fill="#ffffff"/>')
    for title, centre, pick in [("from the side", (250, 290), lambda p: (math.copysign(math.hypot(p[0], p[1]), p[0]), p[2])),
                                ("from above", (750, 260), lambda p: (p[0], p[1]))]:
        out.append(f'<text x="{centre[0]}" y="30" text-anchor="middle" fill="#444">{len(rows)} poses, {title}</text>')
        for index, row in enumerate(rows):
            points = [pick(p) for p in skeleton([float(x) for x in row[1:7]])]
            path = " ".join(f"{centre[0] + scale * x:.1f},{centre[1] - scale * y:.1f}" for x, y in points)
            hue = int(200 + 140 * index / max(1, len(rows) - 1))
            out.append(f'<polyline points="{path}" fill="none" stroke="hsl({hue},55%,45%)" stroke-width="2.5" '
                       'stroke-linejoin="round" stroke-opacity="0.75"/>')
            x, y = points[-1]
            out.append(f'<circle cx="{centre[0] + scale * x:.1f}" cy="{centre[1] - scale * y:.1f}" r="4.5" fill="hsl({hue},55%,40%)"/>')
    out.append("</svg>")
    with open(target, "w") as file:
        file.write("\n".join(out) + "\n")


main(*sys.argv[1:3])
