"""Poses of KRL, RAPID, TP, INFORM, VAL 3 and URScript programs, compensated by the program and checked without it.

cartesian_round_trip.py PROGRAM [POINTS]. Random joints u of an arm; its poses by transforms that are multiplied here, in random
tools and bases, in mm and deg of each language, with the status that these joints have. Then Newton's method here finds the joints that a
nominal controller has at the poses written, near u, and the calibrated robot's transforms say where it stands: at most 1 µm off the pose
that was meant. Every status written is that of these joints. URScript has an arm with three parallel axes and no status: each pose follows
the joints of the motion before it.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import hashlib

import numpy as np

PROGRAM, POINTS = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) > 2 else 300
RNG = np.random.default_rng(4)
# Origin, axis, limit of each joint, as a KUKA counts them: the first and the fourth axis point down and back.
JOINTS = [((0, 0, 0.4), (0, 0, -1), 2.9), ((0.26, 0.01, 0.275), (0, 1, 0), 2.4), ((0.68, 0, 0), (0, 1, 0), 2.6),
          ((0.2, -0.01, -0.035), (-1, 0, 0), 5.0), ((0.47, 0, 0), (0, 1, 0), 2.0), ((0.115, 0, 0), (-1, 0, 0), 6.0)]
PARALLEL = [((0, 0, 0.1273), (0, 0, 1), 6.28), ((0, 0.2209, 0), (0, 1, 0), 6.28), ((-0.612, -0.1719, 0), (0, 1, 0), 6.28),
            ((-0.5723, 0.1149, 0), (0, 1, 0), 6.28), ((0, 0, -0.1157), (0, 0, -1), 6.28), ((0, 0.0922, 0), (0, 1, 0), 6.28)]
# Corrections of the calibrated robot: shift (m) of a joint's frame, offset (rad) of its reading.
SHIFT = {1: (4e-4, 0, -3e-4), 2: (-5e-4, 2e-4, 1e-4)}
OFFSET = {1: 1.1e-3, 2: -9e-4, 3: 7e-4, 4: 1.3e-3, 5: -5e-4}


def turn(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def frame(R=np.eye(3), p=(0, 0, 0)):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R, p
    return X


def flange(q, real=False):
    X = np.eye(4)
    for k, (origin, axis, _) in enumerate(JOINTS):
        shift = np.array(SHIFT.get(k, (0, 0, 0))) * real
        X = X @ frame(p=np.array(origin) + shift) @ frame(turn(axis, q[k] + OFFSET.get(k, 0) * real))
    return X


def joints_at(X, q):
    for _ in range(30):
        e = np.concatenate([X[:3, 3] - flange(q)[:3, 3], vee(X[:3, :3] @ flange(q)[:3, :3].T)])
        if np.abs(e).max() < 1e-13:
            break
        J = np.empty((6, 6))
        for k in range(6):
            h = np.zeros(6)
            h[k] = 1e-6
            A, B = flange(q + h), flange(q - h)
            J[:, k] = np.concatenate([A[:3, 3] - B[:3, 3], vee(A[:3, :3] @ B[:3, :3].T)]) / 2e-6
        q = q + np.linalg.solve(J, e)
    return q


def vee(R):
    return 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def zyx(a, b, c):
    a, b, c = np.radians([a, b, c])
    return turn((0, 0, 1), a) @ turn((0, 1, 0), b) @ turn((1, 0, 0), c)


def angles(R):
    return np.degrees([math.atan2(R[1, 0], R[0, 0]), math.atan2(-R[2, 0], math.hypot(R[0, 0], R[1, 0])), math.atan2(R[2, 1], R[2, 2])])


def quaternion(R):
    w = math.sqrt(max(0, 1 + np.trace(R))) / 2
    if w > 0.1:
        return np.array([w, *(vee(R) / (2 * w))])
    values, vectors = np.linalg.eigh(R + R.T)  # 2 (R + Rᵀ) = … the axis has the largest value
    axis = vectors[:, 2]
    angle = math.atan2(vee(R) @ axis, (np.trace(R) - 1) / 2)
    return np.array([math.cos(angle / 2), *(math.sin(angle / 2) * axis)])


def rotation(w, x, y, z):
    n = math.sqrt(w * w + x * x + y * y + z * z)
    return turn(np.array([x, y, z]) / max(1e-300, math.sqrt(x * x + y * y + z * z)), 2 * math.atan2(math.sqrt(x * x + y * y + z * z) / n, w / n))


def wrist(q):
    """Whether its centre is behind the first axis, and behind the line through the second and third."""
    centre = (flange(q) @ [-0.115, 0, 0, 1])[:3]
    ahead = turn(JOINTS[0][1], q[0]) @ [1, 0, 0]
    # In the arm's plane: the elbow is on the upright side where the forearm is turned forward of the upper arm.
    stretched = -math.atan2(0.035, 0.67)
    return centre @ ahead < 0, math.sin(q[2] - stretched) < 0


class Krl:
    ending, words, beside = "src", [], {}

    def reachable(self, q):
        return True

    def write(self, X, q, tool, base):
        t = frame(zyx(*tool[3:]), np.array(tool[:3]) / 1e3)
        b = frame(zyx(*base[3:]), np.array(base[:3]) / 1e3)
        P = np.linalg.inv(b) @ X @ t
        d = np.degrees(q)
        behind, back = wrist(q)
        s = behind + 2 * (not back) + 4 * (d[4] < 0)
        text = ",".join(f"{n} {v:.9f}" for n, v in zip("XYZABC", [*P[:3, 3] * 1e3, *angles(P[:3, :3])]))
        return f"LIN {{{text},S {s},T {sum(1 << k for k in range(6) if d[k] < 0)},E1 12.5}} C_DIS\n"

    def program(self, lines, tool, base):
        frames = "".join(f"${n}={{" + ",".join(f"{a} {v}" for a, v in zip("XYZABC", f)) + "}\n" for n, f in (("TOOL", tool), ("BASE", base)))
        return "DEF W()\n" + frames + "".join(lines) + "END\n"

    def read(self, text, tool, base):
        for m in re.finditer(r"LIN \{(.*)\}", text):
            v = {a: float(x) for a, x in (item.split() for item in m[1].split(","))}
            assert v["E1"] == 12.5
            t, b = frame(zyx(*tool[3:]), np.array(tool[:3]) / 1e3), frame(zyx(*base[3:]), np.array(base[:3]) / 1e3)
            X = b @ frame(zyx(v["A"], v["B"], v["C"]), np.array([v["X"], v["Y"], v["Z"]]) / 1e3) @ np.linalg.inv(t)
            yield X, (int(v["S"]), int(v["T"]))

    def status(self, q):
        d, (behind, back) = np.degrees(q), wrist(q)
        return behind + 2 * (not back) + 4 * (d[4] < 0), sum(1 << k for k in range(6) if d[k] < 0)


class Rapid(Krl):
    ending, words = "mod", ["--coupling", "0"]

    def write(self, X, q, tool, base):
        t, b = frame(rotation(*tool[3:]), np.array(tool[:3]) / 1e3), frame(rotation(*base[3:]), np.array(base[:3]) / 1e3)
        P = np.linalg.inv(b) @ X @ t
        c = self.status(q)
        numbers = lambda v: "[" + ",".join(f"{x:.10f}" for x in v) + "]"
        return (f"    MoveL [{numbers(P[:3, 3] * 1e3)},{numbers(quaternion(P[:3, :3]))},[{c[0]},{c[1]},{c[2]},{c[3]}],[9E9,9E9,9E9,9E9,9E9,9E9]],"
                "v100,fine,tGun\\WObj:=wPart;\n")

    def program(self, lines, tool, base):
        pose = lambda f: f"[[{f[0]},{f[1]},{f[2]}],[{f[3]},{f[4]},{f[5]},{f[6]}]]"
        return (f"MODULE W\n  PERS tooldata tGun:=[TRUE,{pose(tool)},[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
                f"  PERS wobjdata wPart:=[FALSE,TRUE,\"\",{pose(base)},[[0,0,0],[1,0,0,0]]];\n  PROC main()\n" + "".join(lines) + "  ENDPROC\nENDMODULE\n")

    def read(self, text, tool, base):
        for m in re.finditer(r"MoveL \[\[(.*?)\],\[(.*?)\],\[(.*?)\]", text):
            p, w, c = ([float(x) for x in part.split(",")] for part in m.groups())
            t, b = frame(rotation(*tool[3:]), np.array(tool[:3]) / 1e3), frame(rotation(*base[3:]), np.array(base[:3]) / 1e3)
            yield b @ frame(rotation(*w), np.array(p) / 1e3) @ np.linalg.inv(t), tuple(int(x) for x in c[:3])

    def status(self, q):
        d, (behind, back) = np.degrees(q), wrist(q)
        return tuple(math.floor(d[k] / 90) for k in (0, 3, 5)) + (4 * behind + 2 * back + (d[4] < 0),)


class Tp(Krl):
    ending = "ls"

    def write(self, X, q, tool, base):
        b, t = (frame(zyx(f[5], f[4], f[3]), np.array(f[:3]) / 1e3) for f in (base, tool))
        P = np.linalg.inv(b) @ X @ t
        r, p, w = angles(P[:3, :3])
        c = self.status(q)
        x = P[:3, 3] * 1e3
        return (f"{{\n   GP1:\n\tUF : 1, UT : 2,\tCONFIG : '{c[0]} {c[1]} {c[2]}, {c[3]}, {c[4]}, {c[5]}',\n\tX = {x[0]:.9f}  mm,\tY = {x[1]:.9f}  mm,"
                f"\tZ = {x[2]:.9f}  mm,\n\tW = {w:.9f} deg,\tP = {p:.9f} deg,\tR = {r:.9f} deg\n}};\n")

    def program(self, lines, tool, base):
        self.words = ["--coupling", "0", "--tool=2=" + " ".join(map(str, tool)), "--base=1=" + " ".join(map(str, base))]
        main = "".join(f"{k + 1:4d}:L P[{k + 1}] 100mm/sec FINE    ;\n" for k in range(len(lines)))
        return f"/PROG  W\n/ATTR\nLINE_COUNT\t= {len(lines)};\n/MN\n{main}/POS\n" + "".join(f"P[{k + 1}]{line}" for k, line in enumerate(lines)) + "/END\n"

    def read(self, text, tool, base):
        b, t = (frame(zyx(f[5], f[4], f[3]), np.array(f[:3]) / 1e3) for f in (base, tool))
        for m in re.finditer(r"CONFIG : '(.) (.) (.), (\S+), (\S+), (\S+)',([^}]*)}", text):
            v = {a: float(x) for a, x in re.findall(r"(\w) = (\S+)", m[7])}
            yield b @ frame(zyx(v["R"], v["P"], v["W"]), np.array([v["X"], v["Y"], v["Z"]]) / 1e3) @ np.linalg.inv(t), (*m.groups()[:3], *map(int, m.groups()[3:6]))

    def status(self, q):
        d, (behind, back) = np.degrees(q), wrist(q)
        return ("F" if d[4] > 0 else "N", "D" if back else "U", "B" if behind else "T", *(math.floor((d[k] + 180) / 360) for k in (0, 3, 5)))


class Inform(Krl):
    ending, words = "jbi", []

    def write(self, X, q, tool, base):
        b, t = (frame(zyx(f[5], f[4], f[3]), np.array(f[:3]) / 1e3) for f in (base, tool))
        P = np.linalg.inv(b) @ X @ t
        r, p, w = angles(P[:3, :3])
        numbers = ",".join(f"{v:.9f}" for v in [*P[:3, 3] * 1e3, w, p, r])
        # Neighbours share a heading where they can.
        heading = "///RCONF " + ",".join(map(str, self.status(q))) + ",0,0\n"
        self.last, same = heading, getattr(self, "last", "") == heading
        return ("" if same else heading) + f"C#={numbers}\n"

    def program(self, lines, tool, base):
        self.words = ["--coupling", "0", "--controller", "inform.yaml", "--tool=3=" + " ".join(map(str, tool)), "--base=2=" + " ".join(map(str, base))]
        positions, moves = "", ""
        for k, line in enumerate(lines):
            positions += line.replace("C#", f"C{k:05d}")
            moves += f"MOVL C{k:05d} V=100.0 PL=0\n"
        return (f"/JOB\n//NAME W\n//POS\n///NPOS {len(lines)},0,0,0,0,0\n///USER 2\n///TOOL 3\n///POSTYPE USER\n///RECTAN\n{positions}"
                f"//INST\n///DATE 2026/01/01 00:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n{moves}END\n")

    def read(self, text, tool, base):
        b, t = (frame(zyx(f[5], f[4], f[3]), np.array(f[:3]) / 1e3) for f in (base, tool))
        status = None
        for line in text.splitlines():
            if line.startswith("///RCONF"):
                status = tuple(int(x) for x in line[9:].split(",")[:6])
            elif re.match(r"C\d+=", line):
                x = [float(v) for v in line.split("=")[1].split(",")]
                yield b @ frame(zyx(x[5], x[4], x[3]), np.array(x[:3]) / 1e3) @ np.linalg.inv(t), status

    def status(self, q):
        d, (behind, back) = np.degrees(q), wrist(q)
        over = (d[3] - 90) % 360  # the fourth axis is turned over beyond 90 deg
        beyond = [not -180 < d[k] <= 180 for k in (3, 5, 0)]
        return tuple(int(x) for x in (0 < over <= 180, back, behind, *beyond))


class Val3(Krl):
    ending, words = "dtx", []

    def turns(self, a, b, c):
        a, b, c = np.radians([a, b, c])
        return turn((1, 0, 0), a) @ turn((0, 1, 0), b) @ turn((0, 0, 1), c)

    def frames(self, tool, base):
        # A frame in a frame, a tool on a tool.
        return [frame(self.turns(*f[3:]), np.array(f[:3]) / 1e3) @ frame(self.turns(0, 0, 30), (0, 0.1, 0)) for f in (base, tool)]

    def write(self, X, q, tool, base):
        b, t = self.frames(tool, base)
        P = np.linalg.inv(b) @ X @ t
        R = P[:3, :3]
        a = np.degrees([math.atan2(-R[1, 2], R[2, 2]), math.atan2(R[0, 2], math.hypot(R[1, 2], R[2, 2])), math.atan2(-R[0, 1], R[0, 0])])
        words = (("lefty", "righty"), ("epositive", "enegative"), ("wpositive", "wnegative"))
        s = [w[k] for w, k in zip(words, self.status(q))]
        numbers = " ".join(f'{n}="{v:.9f}"' for n, v in zip(("x", "y", "z", "rx", "ry", "rz"), [*P[:3, 3] * 1e3, *a]))
        return f'      <Value key="#" {numbers} shoulder="{s[0]}" elbow="{s[1]}" wrist="{s[2]}" fatherId="fPart[1]" />\n'

    def program(self, lines, tool, base):
        pose = lambda f: " ".join(f'{n}="{v}"' for n, v in zip(("x", "y", "z", "rx", "ry", "rz"), f))
        data = lambda name, kind, values: f'    <Data name="{name}" access="private" xsi:type="array" type="{kind}" size="{len(values)}">\n' + "".join(values) + "    </Data>\n"
        value = lambda key, f, father: f'      <Value key="{key}" {f} fatherId="{father}" />\n'
        self.beside = {"start.pgx": '<?xml version="1.0"?>\n<Programs>\n<Program name="start">\n<Code><![CDATA[\nbegin\n  for n=0 to size(pW)-1\n'
                                    "    movel(pW[n],tGun[0],mSlow)\n  endFor\n  waitEndMove()\nend\n]]></Code>\n</Program>\n</Programs>\n"}
        return ('<?xml version="1.0" encoding="utf-8"?>\n<Database xmlns="http://www.staubli.com/robotics/VAL3/Data/2">\n  <Datas>\n'
                + data("fCell", "frame", [value(0, pose(base), "world[0]")]) + data("fPart", "frame", [value(0, "", "world[0]"), value(1, 'y="100" rz="30"', "fCell[0]")])
                + data("tHand", "tool", [value(0, pose(tool), "flange[0]")]) + data("tGun", "tool", [value(0, 'y="100" rz="30"', "tHand[0]")])
                + data("pW", "pointRx", [line.replace("#", str(k)) for k, line in enumerate(lines)]) + "  </Datas>\n</Database>\n")

    def read(self, text, tool, base):
        b, t = self.frames(tool, base)
        for m in re.finditer(r'x="(\S+)" y="(\S+)" z="(\S+)" rx="(\S+)" ry="(\S+)" rz="(\S+)" shoulder="(\w+)" elbow="(\w+)" wrist="(\w+)"', text):
            x = [float(v) for v in m.groups()[:6]]
            yield (b @ frame(self.turns(*x[3:]), np.array(x[:3]) / 1e3) @ np.linalg.inv(t),
                   tuple(int(w in ("righty", "enegative", "wnegative")) for w in m.groups()[6:]))

    def status(self, q):
        behind, back = wrist(q)
        return int(behind), int(back), int(q[4] < 0)

    def reachable(self, q):
        return np.abs(q[[3, 5]]).max() < math.pi  # the status leaves turns open


def files(folder):
    (folder / "inform.yaml").write_text("pulses_per_degree: [1000, 1000, 1000, 1000, 1000, 1000]\n")
    links = "".join(f'<link name="l{k}"/>' for k in range(7))
    joints = "".join(f'<joint name="j{k + 1}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/><origin xyz="{o[0]} {o[1]} {o[2]}"/>'
                     f'<axis xyz="{a[0]} {a[1]} {a[2]}"/><limit lower="{-m}" upper="{m}" velocity="1" effort="1"/></joint>'
                     for k, (o, a, m) in enumerate(JOINTS))
    (folder / "arm.urdf").write_text(f'<robot name="arm">{links}{joints}</robot>')
    problem = ("posewright: 1\nrobot: {urdf: arm.urdf, base: l0, tip: l6}\nmeasurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}\n"
               "variants: {all: {parameters: auto}}\ndesign: {poses: 20}\n")
    (folder / "p.yaml").write_text(problem)
    values = [f"j{k + 1}.{a}: {{value: {JOINTS[k][0][i] + s[i]}, unit: m, nominal: {JOINTS[k][0][i]}}}" for k, s in SHIFT.items() for i, a in enumerate("xyz")]
    values += [f"j{k + 1}.offset: {{value: {o}, unit: rad, nominal: 0}}" for k, o in OFFSET.items()]
    digest = hashlib.sha256(problem.encode()).hexdigest()
    (folder / "cal.yaml").write_text(f"posewright_parameters: 1\nvariant: all\nproblem: {{file: p.yaml, sha256: {digest}}}\nparameters: {{{', '.join(values)}}}\n")


def check(language, tool, base, folder):
    joints = [q for q in (np.array([RNG.uniform(-m + 0.05, m - 0.05) for _, _, m in JOINTS]) for _ in range(3 * POINTS))
              if language.reachable(q) and abs(q[4]) > 0.15 and abs(math.sin(q[2] + 0.052)) > 0.15][:POINTS]
    # Zero is where robots are taught: a status may be stated either way there.
    joints[0] = np.array([0, -0.9, 1.4, 0, 0.6, 0.0])
    text = language.program([language.write(flange(q), q, tool, base) for q in joints], tool, base)
    name = f"w.{language.ending}"
    (folder / name).write_text(text)
    for other, content in language.beside.items():
        (folder / other).write_text(content)
    run = subprocess.run([PROGRAM, "compensate", "cal.yaml", name, *language.words, "--most", "45", "--partial", "-o", f"out.{language.ending}", "--json", "--force"],
                         cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    result = json.loads(run.stdout)
    done = [pose["compensated"] for pose in result["lists"][0]["poses"]]
    assert len(done) == len(joints), [l for p in result["programs"] for l in p["lines"] if l["why"]][:5]
    written = list(language.read((folder / f"out.{language.ending}").read_text(), tool, base))
    assert len(written) == len(joints)
    worst, checked = 0, 0
    for q, good, (X, status) in zip(joints, done, written):
        if not good:
            continue
        u = joints_at(X, q)
        assert status == tuple(language.status(u))[:len(status)] or np.abs(np.degrees(u)).min() < 0.01, (status, language.status(u), np.degrees(u))
        tcp = lambda Y: Y[:3, 3]
        worst = max(worst, np.linalg.norm(tcp(flange(u, real=True)) - tcp(flange(q))))
        checked += 1
    print(f"{type(language).__name__}: {checked} of {len(joints)} poses checked, at most {worst * 1e6:.3f} um off")
    assert checked > 0.9 * len(joints) and worst < 1e-6, (checked, worst)


def slerp(A, B, s):
    R = A.T @ B
    angle = math.acos(max(-1, min(1, (np.trace(R) - 1) / 2)))
    return A @ turn(vee(R) / max(1e-300, math.sin(angle)), s * angle) if angle > 1e-9 else A


def check_lines(tool, base, folder):
    """How far the tool leaves lines, by transforms here; the limit is kept or nothing is written."""
    language, T = Krl(), frame(zyx(*tool[3:]), np.array(tool[:3]) / 1e3)
    first = flange(np.array([0.3, -0.9, 1.5, 0.4, 0.7, 0.2]))
    poses = []
    for k in range(6):
        X = frame(zyx(4 * k, -3 * k, 0), (0, 0.08 * k, 0.02 * k * (-1) ** k)) @ first
        poses.append((X, joints_at(X, poses[-1][1] if poses else np.array([0.3, -0.9, 1.5, 0.4, 0.7, 0.2]))))
    (folder / "line.src").write_text(language.program([language.write(X, q, tool, base) for X, q in poses], tool, base))
    words = [PROGRAM, "compensate", "cal.yaml", "line.src", "-o", "line_out.src", "--json", "--force"]
    result = json.loads(subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True).stdout)
    written = [X for X, _ in language.read((folder / "line_out.src").read_text(), tool, base)]
    assert len(result["lines"]) == len(poses) - 1
    worst = 0
    for k, stated in enumerate(result["lines"]):
        A, B, u, largest = written[k] @ T, written[k + 1] @ T, joints_at(written[k], poses[k][1]), 0
        p, q = ((poses[k + i][0] @ T)[:3, 3] for i in (0, 1))
        for s in np.arange(1, 16) / 16:
            u = joints_at(frame(slerp(A[:3, :3], B[:3, :3], s), A[:3, 3] + s * (B - A)[:3, 3]) @ np.linalg.inv(T), u)
            x = (flange(u, real=True) @ T)[:3, 3] - p
            largest = max(largest, np.linalg.norm(x - (q - p) * (x @ (q - p)) / ((q - p) @ (q - p))))
        # The file has digits of 0.1 um.
        assert abs(stated["largest"] - largest) < 3e-7, (stated, largest)
        worst = max(worst, stated["largest"])
    assert worst > 1e-6
    for limit, code in ((worst * 1.1, 0), (worst * 0.9, 1)):
        (folder / "line_out.src").unlink()
        run = subprocess.run([*words, "--line-deviation", str(limit * 1e3)], cwd=folder, capture_output=True, text=True)
        assert run.returncode == code and (folder / "line_out.src").exists() == (code == 0), run.stderr
        (folder / "line_out.src").touch()
    assert "the tool would leave the line by" in run.stderr
    assert "no file is written" in run.stderr and "--partial" not in run.stderr, "it does not help where a line is left"
    print(f"lines: {len(poses) - 1}, the tool leaves them by at most {worst * 1e6:.1f} um, as computed here")


def vector(R):
    q = quaternion(R)
    size = np.linalg.norm(q[1:])
    return 2 * math.atan2(size, q[0]) * q[1:] / max(size, 1e-300)


def check_near(folder, tool_line, q, X, T):
    """A pose behind no known joints is refused with its line; --near says which joints are meant; a second run is refused."""
    P = X @ T
    pose = ",".join(f"{x:.12f}" for x in [*P[:3, 3], *vector(P[:3, :3])])
    (folder / "near.script").write_text(f"{tool_line.strip()}\nmovel(p[{pose}])\n")
    words = [PROGRAM, "compensate", "cal.yaml", "near.script", "-o", "near_out.script", "--most", "45"]
    run = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert run.returncode == 1 and "the joints before it are not known" in run.stdout and not (folder / "near_out.script").exists(), run
    near = ",".join(map(str, np.degrees(q + 0.05)))
    run = subprocess.run([*words, f"--near={near}"], cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run
    x = np.array([float(v) for v in re.search(r"movel\(p\[(.*?)\]", (folder / "near_out.script").read_text())[1].split(",")])
    u = joints_at(frame(turn(x[3:] / np.linalg.norm(x[3:]), np.linalg.norm(x[3:])), x[:3]) @ np.linalg.inv(T), q)
    assert np.linalg.norm((flange(u, real=True) - X)[:3, 3]) < 1e-6
    run = subprocess.run([PROGRAM, "compensate", "cal.yaml", "near_out.script"], cwd=folder, capture_output=True, text=True)
    assert run.returncode == 2 and "compensated already" in run.stderr, run


def check_urscript(folder):
    """Chains of motions: joints, then poses along lines and to the nearest joints, each near the joints before it."""
    global JOINTS
    JOINTS = PARALLEL
    files(folder)
    tool = np.array([0.02, -0.03, 0.21, 0.4, -0.2, 0.9])
    T = frame(turn(tool[3:] / np.linalg.norm(tool[3:]), np.linalg.norm(tool[3:])), tool[:3])
    clear = lambda q: min(abs(math.sin(q[4])), abs(math.sin(q[2])), 2 * (np.linalg.norm((flange(q) @ [0, -0.0922, 0, 1])[:2]) - 0.1639))
    lines, joints, meant = ["def weld():", "  set_tcp(p[" + ",".join(map(str, tool)) + "])"], [], []
    while len(joints) < POINTS:
        q = RNG.uniform(-3, 3, 6)
        lines.append("  movej([" + ",".join(f"{x:.12f}" for x in q) + "], a=1.4, v=1.05)")
        for k in range(5):
            step = q + RNG.uniform(-0.25, 0.25, 6)
            # Far from singularities other joints with the same pose are far, too.
            if min(clear(q), clear(step)) < 0.3:
                break
            q = step
            X = flange(q)
            P = X @ T
            word = ("movel", "movej", "movep")[k % 3]
            lines.append(f"  {word}(p[" + ",".join(f"{x:.12f}" for x in [*P[:3, 3], *vector(P[:3, :3])]) + "], a=1.2, v=0.25)")
            joints.append(q)
            meant.append(X)
    (folder / "w.script").write_text("\n".join([*lines, "end", ""]))
    run = subprocess.run([PROGRAM, "compensate", "cal.yaml", "w.script", "--most", "45", "--partial", "-o", "out.script", "--json", "--force"],
                         cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    done = {line["line"] for p in json.loads(run.stdout)["programs"] for line in p["lines"] if line["treatment"] == "compensated"}
    written = [(n, [float(x) for x in re.search(r"p\[(.*?)\]", line)[1].split(",")]) for n, line in
               enumerate((folder / "out.script").read_text().splitlines()) if re.search(r"move.\(p\[", line)]
    assert len(written) == len(joints)
    worst, checked = 0, 0
    for (n, x), q, X in zip(written, joints, meant):
        if n not in done:  # the remark is a line, so that index n is what was line n
            continue
        P = frame(turn(np.array(x[3:]) / np.linalg.norm(x[3:]), np.linalg.norm(x[3:])), x[:3]) @ np.linalg.inv(T)
        u = joints_at(P, q)
        assert np.abs(u - q).max() < 0.05
        worst = max(worst, np.linalg.norm((flange(u, real=True) - X)[:3, 3]))
        checked += 1
    check_near(folder, lines[1], joints[0], meant[0], T)
    print(f"Urscript: {checked} of {len(joints)} poses checked, at most {worst * 1e6:.3f} um off")
    assert checked > 0.8 * len(joints) and worst < 1e-6, (checked, worst)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    files(folder)
    q = [0.92387953, 0, 0.38268343, 0]
    check(Krl(), (120.5, -30, 210, 30, 45, -60), (900, -200, 350, 5, -3, 12), folder)
    check(Rapid(), (120.5, -30, 210, *q), (900, -200, 350, 0.99, 0.1, 0.05, -0.08), folder)
    check(Tp(), (120.5, -30, 210, 30, 45, -60), (900, -200, 350, 5, -3, 12), folder)
    check(Inform(), (120.5, -30, 210, 30, 45, -60), (900, -200, 350, 5, -3, 12), folder)
    check(Val3(), (120.5, -30, 210, 30, 45, -60), (900, -200, 350, 5, -3, 12), folder)
    check_lines((120.5, -30, 210, 30, 45, -60), (900, -200, 350, 5, -3, 12), folder)
    check_urscript(folder)
