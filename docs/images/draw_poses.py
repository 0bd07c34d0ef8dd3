"""draw_poses.py poses.csv OUT.svg: a KR 270 in one of its planned poses, the tracker that measures it, and the reflectors in all poses.

Parallel projection; lengths in metres, frame of the robot's base. The floor is 0.75 m below the base link's frame.
"""
import csv
import math
import sys

import numpy as np

# The joints of examples/kr270/kr270.urdf: where each one stands in the frame before it, and its axis.
JOINTS = [((0, 0, 0), "z"), ((0.35, 0, 0), "y"), ((1.25, 0, 0), "y"), ((1.1, 0, -0.055), "x"), ((0, 0, 0), "y"), ((0, 0, 0), "x")]
# The three reflectors of examples/kr270/problem.yaml in the frame of the flange.
REFLECTORS = np.array([[0.27723, -0.04653, -0.09387], [0.27649, -0.04825, 0.09405], [0.27844, 0.10373, -0.00217]])
FLOOR = -0.75
TRACKER = np.array([2.6, -1.6, 0.3])
ORANGE, DARK, BLUE, RED, GREY = "#e8833a", "#8a4513", "#1f5fae", "#d03030", "#5b6470"
SCALE, CENTRE = 100, (450, 310)
AZIMUTH, ELEVATION = math.radians(-62), math.radians(22)


def rotation(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]],
                     "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])


def chain(q):
    """Origins of the joints and the reflectors, each an array of points."""
    R, p, origins = np.eye(3), np.zeros(3), []
    for (offset, axis), angle in zip(JOINTS, q):
        p = p + R @ offset
        origins.append(p)
        R = R @ rotation(axis, angle)
    return np.array(origins), p + REFLECTORS @ R.T, p + R @ [0.21, 0, 0]


def seen(p):
    """Place on the sheet of a point."""
    x = -math.sin(AZIMUTH) * p[0] + math.cos(AZIMUTH) * p[1]
    into = math.cos(AZIMUTH) * p[0] + math.sin(AZIMUTH) * p[1]
    y = math.cos(ELEVATION) * p[2] - math.sin(ELEVATION) * into
    return CENTRE[0] + SCALE * x, CENTRE[1] - SCALE * y


def line(points, colour, width, **more):
    path = " ".join("%.1f,%.1f" % seen(p) for p in points)
    extra = "".join(f' {key.replace("_", "-")}="{value}"' for key, value in more.items())
    return (f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linecap="round" '
            f'stroke-linejoin="round"{extra}/>')


def limb(points, radius, colour=ORANGE, edge=DARK):
    """A body about these points: its edge, the body, and the light on it."""
    width = 2 * SCALE * radius
    return [line(points, edge, f"{width + 2:.1f}"), line(points, colour, f"{width:.1f}"),
            line(points, "#ffffff", f"{width / 3:.1f}", stroke_opacity="0.22")]


def text(place, words, anchor="start", colour="#222", size=16):
    return f'<text x="{place[0]:.0f}" y="{place[1]:.0f}" text-anchor="{anchor}" fill="{colour}" font-size="{size}">{words}</text>'


def dot(p, radius, colour, edge="#ffffff"):
    x, y = seen(p)
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}" stroke="{edge}" stroke-width="0.8"/>'


def floor():
    out = []
    for k in range(-3, 4):
        out.append(line([(k, -2, FLOOR), (k, 3, FLOOR)], "#d5dbe3", 1))
    for k in range(-2, 4):
        out.append(line([(-3, k, FLOOR), (3, k, FLOOR)], "#d5dbe3", 1))
    return out


def tracker(aimed):
    top = TRACKER
    feet = [TRACKER[:2] + 0.32 * np.array([math.cos(a), math.sin(a)]) for a in (1.2, 3.3, 5.4)]
    out = [line([top - [0, 0, 0.25], (*foot, FLOOR)], GREY, 4) for foot in feet]
    out += limb([top - [0, 0, 0.25], top - [0, 0, 0.02]], 0.09, "#aab4c0", GREY)
    out += limb([top + [0, 0, 0.08]], 0.12, "#dfe5ec", GREY)
    return out + [line([top + [0, 0, 0.08], aimed], RED, 1.6)]


def robot(origins, flange):
    foot = np.array([0, 0, FLOOR])
    x, y = seen(foot)
    out = [f'<ellipse cx="{x:.1f}" cy="{y + dy:.1f}" rx="{SCALE * 0.42:.1f}" ry="{SCALE * 0.42 * math.sin(ELEVATION):.1f}" '
           f'fill="{colour}" stroke="#2c3238"/>' for dy, colour in ((0, "#3a414a"), (-SCALE * 0.12, "#4a525c"))]
    out += limb([(0, 0, -0.45), (0, 0, -0.15)], 0.28)
    out += limb([(0, 0, -0.15), origins[1]], 0.24)
    out += limb([origins[1], origins[2]], 0.15)
    out += limb([origins[2], origins[3]], 0.12)
    return out + limb([origins[4], flange], 0.08, "#4a525c", "#2c3238")


def main(source, target):
    with open(source, newline="") as file:
        poses = [chain([float(x) for x in row[1:7]]) for row in list(csv.reader(file))[1:]]
    # The robot is shown where it points most towards the tracker.
    shown = max(poses, key=lambda pose: pose[1][0] @ (TRACKER / np.linalg.norm(TRACKER)) + 0.5 * pose[1][0][2])
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="70 20 830 510" font-family="sans-serif">',
           '<rect x="70" y="20" width="830" height="510" fill="#ffffff"/>', *floor()]
    for origins, reflectors, _ in poses:
        out.append(line([origins[1], origins[2], origins[3], reflectors.mean(axis=0)], "#8fa9cc", 1.3, stroke_opacity="0.6"))
    out += robot(shown[0], shown[2])
    for pose in poses:
        out += [dot(p, 4.2, BLUE) for p in pose[1]]
    out += tracker(shown[1][0]) + [dot(p, 5.2, RED) for p in shown[1]]
    place = seen(TRACKER)
    out.append(text((place[0] + 24, place[1] + 4), "laser tracker"))
    place = seen(shown[1][0])
    out.append(text((place[0] + 12, place[1] - 12), "three reflectors on the flange", colour=RED))
    out.append(text((100, 60), f"{len(poses)} planned poses: {3 * len(poses)} places of reflectors", colour=BLUE))
    a, b = np.array([-1.0, -2.0, FLOOR]), np.array([0.0, -2.0, FLOOR])
    out.append(line([a, b], "#222", 3))
    out.append(text(((seen(a)[0] + seen(b)[0]) / 2, seen(b)[1] + 24), "1 m", "middle"))
    out.append("</svg>")
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


main(*sys.argv[1:3])
