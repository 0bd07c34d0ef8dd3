"""Robots like those that public URDF files describe, each made by a function that says what `init` needs.

No file of anybody else is kept. `KINDS` maps names to functions of a folder; each writes its robot there and returns a `Kind`. Those whose `Kind` has a refusal are
broken or leave a choice to the user.
"""

import dataclasses
import pathlib
import re
import struct

KINDS = {}


@dataclasses.dataclass
class Kind:
    """What a user types after `init`, and, where a robot cannot be planned, words of the line that says why."""
    file: str
    words: tuple = ()
    refusal: tuple = ()  # all are in the message; empty: init and plan end well
    note: str = ""  # in what init prints on stderr, if it ends well
    says: str = ""  # in the problem file


def kind(function):
    KINDS[function.__name__] = function
    return function


def origin(xyz=(0, 0, 0), rpy=(0, 0, 0)):
    return f'<origin xyz="{" ".join(map(str, xyz))}" rpy="{" ".join(map(str, rpy))}"/>'


def box(x, y, z, at=(0, 0, 0)):
    return f'{origin(at)}<geometry><box size="{x} {y} {z}"/></geometry>'


def sphere(r, at=(0, 0, 0)):
    return f'{origin(at)}<geometry><sphere radius="{r}"/></geometry>'


def mesh(file, scale="", at=(0, 0, 0)):
    return f'{origin(at)}<geometry><mesh filename="{file}"{f" scale={chr(34)}{scale}{chr(34)}" if scale else ""}/></geometry>'


def along(offset, r):
    """A box over the middle of an offset, r to each side; the joints at its ends stay free of it."""
    size = [max(abs(0.6 * v), 2 * r) for v in offset]
    return box(*size, at=[0.5 * v for v in offset])


class Robot:
    def __init__(self, name="robot"):
        self.name, self.links, self.joints, self.more, self.attributes = name, {}, [], "", ""

    def link(self, name, *shapes, inertial=True):
        self.links[name] = [list(shapes), inertial]
        return self

    def joint(self, name, parent, child, at=(0, 0, 0), axis=(0, 0, 1), of="revolute", lower=-2.8, upper=2.8, velocity=2, rpy=(0, 0, 0), more="", limit=None):
        if limit is None:
            limit = "" if of in ("fixed", "continuous") else f'<limit lower="{lower}" upper="{upper}" effort="100" velocity="{velocity}"/>'
            limit = f'<limit effort="100" velocity="{velocity}"/>' if of == "continuous" else limit
        turning = f'<axis xyz="{" ".join(map(str, axis))}"/>' if axis and of != "fixed" else ""
        self.joints.append(f'<joint name="{name}" type="{of}"><parent link="{parent}"/><child link="{child}"/>{origin(at, rpy)}{turning}{limit}{more}</joint>')
        return self

    def fixed(self, parent, child, at=(0, 0, 0), rpy=(0, 0, 0)):
        return self.joint(f"{parent}-{child}", parent, child, at, of="fixed", rpy=rpy)

    def text(self):
        inertia = '<inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        links = [f'  <link name="{n}">{inertia if i else ""}{"".join(f"<visual>{s}</visual><collision>{s}</collision>" for s in shapes)}</link>' for n, (shapes, i) in self.links.items()]
        return "\n".join([f'<?xml version="1.0"?>\n<robot name="{self.name}"{self.attributes}>', *links, *(f"  {j}" for j in self.joints), self.more, "</robot>\n"])

    def write(self, folder, file="robot.urdf", change=lambda text: text, encoding="utf-8"):
        path = pathlib.Path(folder) / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(change(self.text()).encode(encoding))
        return file


#: Offset from the joint before, axis and half of the range, of an arm like most industrial ones; one after the other for 1 to 8 axes.
AXES = [((0, 0, 0.3), (0, 0, 1), 2.9), ((0.1, 0, 0.25), (0, 1, 0), 1.9), ((0, 0, 0.6), (0, 1, 0), 2.2), ((0.2, 0, 0.1), (1, 0, 0), 3.1),
        ((0.4, 0, 0), (0, 1, 0), 2.0), ((0.15, 0, 0), (1, 0, 0), 3.1), ((0.2, 0, 0), (0, 1, 0), 1.5), ((0.15, 0, 0), (1, 0, 0), 3.0)]


def arm(axes=6, robot=None, prefix="", base=None, tip="tool0", shapes=True, link=along, joint=None, naming=lambda prefix, k: f"{prefix}link_{k}"):
    """An arm of AXES; `link` makes the shape over an offset, `joint` what its joints have besides their place."""
    robot = robot or Robot()
    first = base or naming(prefix, 0) if base else f"{prefix}base_link"
    names = [first] + [naming(prefix, k + 1) for k in range(axes)]
    offsets = [a[0] for a in AXES[:axes]] + [(0.12, 0, 0)]
    for k, name in enumerate(names):
        robot.link(name, *([link(offsets[k], 0.075 - 0.006 * k)] if shapes else []))
    for k in range(axes):
        at, axis, reach = AXES[k]
        words = {"lower": -reach, "upper": reach, "axis": axis, **(joint(k) if joint else {})}
        robot.joint(f"{prefix}joint_{k + 1}", names[k], names[k + 1], at, **words)
    if tip:
        robot.link(prefix + tip, inertial=False).fixed(names[-1], prefix + tip, offsets[-1])
    return robot


def stl(file, size, at=(0, 0, 0), parts=1, text=False):
    """A box, with each side of it in parts² squares."""
    triangles = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            for i in range(parts):
                for j in range(parts):
                    corner = lambda u, v: [at[k] + size[k] * (side if k == axis else (u if k == (axis + 1) % 3 else v) / parts - 0.5) for k in range(3)]
                    a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
                    triangles += [(a, b, c), (a, c, d)] if side > 0 else [(a, c, b), (a, d, c)]
    file = pathlib.Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    if text:
        lines = ["solid box"] + [f"facet normal 0 0 0\nouter loop\n" + "\n".join("vertex " + " ".join(f"{x:g}" for x in p) for p in t) + "\nendloop\nendfacet" for t in triangles]
        file.write_text("\n".join(lines + ["endsolid box\n"]))
    else:
        file.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + b"".join(struct.pack("<12fH", 0, 0, 0, *sum(t, []), 0) for t in triangles))


def arm_of_meshes(folder, unit=1.0, scale="", name="meshes/link.stl", reference="{}", axes=6, **words):
    """An arm whose links are meshes, their numbers in `unit` of a metre."""
    count = 0

    def link(offset, r):
        nonlocal count
        count += 1
        file = name.replace("link", f"link_{count}")
        stl(pathlib.Path(folder) / file, [max(abs(0.6 * v), 2 * r) / unit for v in offset], [0.5 * v / unit for v in offset], **words)
        return mesh(reference.format(file), scale)

    return arm(axes, link=link)


# ---- number of axes

def register_axes(axes):
    def function(folder):
        # All that one axis has is base and reflectors.
        return Kind(arm(axes).write(folder), ("--poses", "8") if axes < 4 else (), refusal=("cannot be identified",) if axes == 1 else ())
    KINDS[f"axes_{axes}"] = function


for number in range(1, 9):
    register_axes(number)


@kind
def axes_12_snake(folder):
    robot = Robot("snake").link("base", box(0.2, 0.2, 0.1))
    before = "base"
    for k in range(12):
        robot.link(f"s{k}", box(0.1, 0.05, 0.05, (0.09, 0, 0)))
        robot.joint(f"s{k}_joint", before, f"s{k}", (0.18, 0, 0) if k else (0, 0, 0.5), (0, 0, 1) if k % 2 else (0, 1, 0), lower=-1.2, upper=1.2)
        before = f"s{k}"
    return Kind(robot.write(folder))


# ---- hands

def finger(robot, name, parent, side, mimic="", at=0.12):
    robot.link(name, box(0.05, 0.01, 0.02, (0.03, 0, 0)))
    return robot.joint(f"{name}_joint", parent, name, (at, 0.03 * side, 0), (0, side, 0), "prismatic", lower=0, upper=0.04, more=mimic)


@kind
def gripper_with_mimic(folder):
    robot = arm()
    robot.link("hand", box(0.08, 0.1, 0.05, (0.05, 0, 0))).fixed("tool0", "hand")
    finger(robot, "left_finger", "hand", 1)
    finger(robot, "right_finger", "hand", -1, '<mimic joint="left_finger_joint"/>')
    return Kind(robot.write(folder))


@kind
def gripper_without_tool_frame(folder):
    robot = arm(tip="")
    robot.link("hand", box(0.08, 0.1, 0.05, (0.05, 0, 0))).fixed("link_6", "hand", (0.12, 0, 0))
    finger(robot, "finger_1", "hand", 1)
    finger(robot, "finger_2", "hand", -1, '<mimic joint="finger_1_joint" multiplier="1"/>')
    return Kind(robot.write(folder))


@kind
def gripper_of_knuckles(folder):
    robot = arm()
    robot.link("gripper_base", box(0.09, 0.1, 0.06, (0.045, 0, 0))).fixed("tool0", "gripper_base")
    first = "left_outer_knuckle_joint"
    for side, s in (("left", 1), ("right", -1)):
        for part, parent, at in (("outer_knuckle", "gripper_base", (0.06, 0.03 * s, 0)), ("inner_knuckle", "gripper_base", (0.07, 0.015 * s, 0)), ("inner_finger", f"{side}_outer_knuckle", (0.05, 0.02 * s, 0))):
            robot.link(f"{side}_{part}", box(0.05, 0.012, 0.02, (0.025, 0, 0)))
            name = f"{side}_{part}_joint"
            robot.joint(name, parent, f"{side}_{part}", at, (0, 0, s), lower=-0.9, upper=0.9, more="" if name == first else f'<mimic joint="{first}" multiplier="{-1 if "finger" in part else 1}"/>')
    return Kind(robot.write(folder))


@kind
def hand_of_free_fingers(folder):
    robot = arm()
    robot.link("palm", box(0.08, 0.12, 0.04, (0.06, 0, 0))).fixed("tool0", "palm")
    for k in range(4):
        robot.link(f"finger_{k}_a", box(0.04, 0.015, 0.015, (0.02, 0, 0))).link(f"finger_{k}_b", box(0.03, 0.014, 0.014, (0.02, 0, 0)))
        robot.joint(f"finger_{k}_1", "palm", f"finger_{k}_a", (0.1, 0.04 - 0.027 * k, 0), (0, 1, 0), lower=0, upper=1.5)
        robot.joint(f"finger_{k}_2", f"finger_{k}_a", f"finger_{k}_b", (0.045, 0, 0), (0, 1, 0), lower=0, upper=1.5)
    return Kind(robot.write(folder))


@kind
def vacuum_gripper_long(folder):
    robot = arm()
    robot.link("gripper", box(0.5, 0.03, 0.03, (0.27, 0, 0))).fixed("tool0", "gripper").link("cup", sphere(0.02)).fixed("gripper", "cup", (0.53, 0, 0))
    return Kind(robot.write(folder))


@kind
def tool_changer_touches_link_5(folder):
    robot = arm()
    robot.link("changer", box(0.3, 0.14, 0.14, (-0.05, 0, 0))).fixed("tool0", "changer")
    return Kind(robot.write(folder))


@kind
def finger_that_follows_an_axis(folder):
    robot = arm()
    robot.link("cover", box(0.05, 0.05, 0.05, (-0.15, 0, 0)))
    robot.joint("cover_joint", "link_2", "cover", (0, 0, 0.6), (0, 1, 0), more='<mimic joint="joint_3" multiplier="0.5"/>')
    return Kind(robot.write(folder), note="link 'cover' is moved by joint 'cover_joint'")


# ---- cameras

@kind
def camera_on_hand(folder):
    robot = arm()
    robot.link("camera_link", box(0.03, 0.09, 0.03)).fixed("tool0", "camera_link", (0.02, 0, 0.07))
    robot.link("camera_optical_frame", inertial=False).fixed("camera_link", "camera_optical_frame", rpy=(-1.5708, 0, -1.5708))
    return Kind(robot.write(folder), ("--camera", "realsense-d435"))


@kind
def camera_and_gripper_on_hand(folder):
    robot = arm()
    robot.link("hand", box(0.08, 0.1, 0.05, (0.05, 0, 0))).fixed("tool0", "hand")
    finger(robot, "left_finger", "hand", 1)
    finger(robot, "right_finger", "hand", -1, '<mimic joint="left_finger_joint"/>')
    robot.link("camera_link", box(0.03, 0.09, 0.03)).fixed("hand", "camera_link", (0.02, 0, 0.06))
    return Kind(robot.write(folder), ("--camera", "realsense-d435"))


@kind
def camera_link_in_the_floor(folder):
    robot = arm()
    robot.link("world_camera", box(0.05, 0.1, 0.05)).fixed("base_link", "world_camera", (0.8, 0, -0.4))
    return Kind(robot.write(folder), says="plane: [0, 0, 1], at: [0, 0, 0]")


@kind
def fixed_camera_seen_by_four_axes(folder):
    return Kind(arm(4).write(folder), ("--camera", "realsense-d435", "--fixed-camera"))


@kind
def fixed_camera_of_scara(folder):
    # Its board faces the floor in every pose.
    return Kind(scara().write(folder), ("--camera", "realsense-d435", "--fixed-camera"), refusal=("no joint angles for a view of the targets", "line_of_sight"))


# ---- other arms

def scara(robot=None):
    robot = robot or Robot("scara")
    robot.link("base_link", box(0.2, 0.2, 0.4, (0, 0, 0.2))).link("link_1", box(0.3, 0.1, 0.06, (0.2, 0, 0))).link("link_2", box(0.26, 0.1, 0.06, (0.16, 0, 0)))
    robot.link("spindle", box(0.02, 0.02, 0.3, (0, 0, -0.05))).link("flange", inertial=False)
    robot.joint("j1", "base_link", "link_1", (0, 0, 0.45), lower=-2.2, upper=2.2).joint("j2", "link_1", "link_2", (0.4, 0, 0.08), lower=-2.5, upper=2.5)
    robot.link("quill").joint("j3", "link_2", "quill", (0.3, 0, 0), of="prismatic", lower=-0.2, upper=0).joint("j4", "quill", "spindle", lower=-6.28, upper=6.28)
    return robot.fixed("spindle", "flange", (0, 0, -0.2))


KINDS["scara"] = lambda folder: Kind(scara().write(folder))


@kind
def palletiser(folder):
    """Four axes; two rods keep the hand level by joints that follow."""
    robot = Robot("palletiser").link("base_link", box(0.4, 0.4, 0.2, (0, 0, 0.1))).link("column", box(0.2, 0.2, 0.15, (0, 0, 0.1)))
    robot.link("upper", box(0.1, 0.1, 0.6, (0, 0, 0.4))).link("fore", box(0.6, 0.1, 0.1, (0.4, 0, 0))).link("wrist", box(0.1, 0.1, 0.06, (0.08, 0, 0))).link("plate", box(0.1, 0.1, 0.02, (0, 0, -0.05)))
    robot.link("rod", box(0.03, 0.03, 0.5, (0, 0.12, 0.4))).link("tool0", inertial=False)
    robot.joint("j1", "base_link", "column", (0, 0, 0.25), lower=-3, upper=3).joint("j2", "column", "upper", (0.1, 0, 0.2), (0, 1, 0), lower=-0.7, upper=1.4)
    robot.joint("j3", "upper", "fore", (0, 0, 0.8), (0, 1, 0), lower=-1.0, upper=1.5)
    robot.joint("j3_level", "fore", "wrist", (0.8, 0, 0), (0, 1, 0), of="revolute", lower=-3, upper=3, more='<mimic joint="j3" multiplier="-1"/>')
    robot.joint("rod_follows", "column", "rod", (0.05, 0, 0.2), (0, 1, 0), lower=-3, upper=3, more='<mimic joint="j2"/>')
    robot.joint("j4", "wrist", "plate", (0.15, 0, -0.05), lower=-6, upper=6).fixed("plate", "tool0", (0, 0, -0.07))
    return Kind(robot.write(folder), note="link 'rod' is moved by joint 'rod_follows'")


@kind
def gantry(folder):
    robot = Robot("gantry").link("base_link", box(3, 0.1, 0.1, (1.5, -1, 2.5)), box(3, 0.1, 0.1, (1.5, 1, 2.5)), box(0.1, 0.1, 2.4, (0, -1, 1.2)), box(0.1, 0.1, 2.4, (0, 1, 1.2)))
    robot.link("bridge", box(0.1, 2.0, 0.1)).link("trolley", box(0.15, 0.15, 0.15)).link("ram", box(0.08, 0.08, 1.2, (0, 0, -0.5))).link("head", box(0.06, 0.06, 0.06)).link("tool0", inertial=False)
    robot.joint("x", "base_link", "bridge", (0, 0, 2.7), (1, 0, 0), "prismatic", lower=0.2, upper=2.8).joint("y", "bridge", "trolley", (0.13, 0, 0), (0, 1, 0), "prismatic", lower=-0.8, upper=0.8)
    robot.joint("z", "trolley", "ram", (0, 0, -0.1), (0, 0, 1), "prismatic", lower=-0.9, upper=0).joint("a", "ram", "head", (0, 0, -1.2), (0, 0, 1), lower=-3, upper=3)
    return Kind(robot.fixed("head", "tool0", (0, 0, -0.06)).write(folder))


@kind
def carriage_touches_its_beam(folder):
    robot = Robot("rail").link("world").link("beam", box(4, 0.2, 0.2, (2, 0, 0.1))).fixed("world", "beam")
    robot.link("carriage", box(0.4, 0.4, 0.1)).joint("rail", "beam", "carriage", (0, 0, 0.25), (1, 0, 0), "prismatic", lower=0.3, upper=3.7, velocity=1)
    arm(6, robot)
    robot.fixed("carriage", "base_link", (0, 0, 0.05))
    # A plate between carriage and beam that hangs on the arm's foot.
    robot.link("skid", box(0.3, 0.3, 0.06)).fixed("base_link", "skid", (0, 0, -0.1))
    return Kind(robot.write(folder))


def on(robot, parent, at=(0, 0, 0), rpy=(0, 0, 0), axes=6, **words):
    return arm(axes, robot, **words).fixed(parent, "base_link", at, rpy)


@kind
def rail(folder):
    robot = Robot("on_rail").link("rail_base", box(4, 0.3, 0.1, (2, 0, 0.05))).link("carriage", box(0.4, 0.4, 0.06))
    robot.joint("rail", "rail_base", "carriage", (0, 0, 0.15), (1, 0, 0), "prismatic", lower=0.3, upper=3.7, velocity=1)
    return Kind(on(robot, "carriage", (0, 0, 0.05)).write(folder))


@kind
def lift_column(folder):
    robot = Robot("lift").link("base_footprint").link("column", box(0.3, 0.3, 0.6, (0, 0, 0.3))).fixed("base_footprint", "column").link("slide", box(0.2, 0.2, 0.05))
    robot.joint("lift", "column", "slide", (0, 0, 0.7), of="prismatic", lower=0, upper=0.4, velocity=0.1)
    return Kind(on(robot, "slide", (0, 0, 0.05)).write(folder))


@kind
def torso_with_two_arms(folder):
    robot = Robot("humanoid").link("pelvis", box(0.3, 0.3, 0.8, (0, 0, 0.4))).link("torso", box(0.25, 0.3, 0.4, (0, 0, 0.25)))
    robot.joint("waist", "pelvis", "torso", (0, 0, 0.85), lower=-1, upper=1)
    for side, s in (("left_", 1), ("right_", -1)):
        arm(6, robot, side).joint(f"{side}shoulder", "torso", f"{side}base_link", (0, 0.35 * s, 0.3), of="fixed", rpy=(-1.2 * s, 0, 0))
    return Kind(robot.write(folder), ("--tip", "left_tool0"))


@kind
def two_arms_without_a_choice(folder):
    robot = Robot("two").link("table", box(1, 2, 0.1, (0, 0, -0.1)))
    for side, s in (("a_", 1), ("b_", -1)):
        arm(6, robot, side, tip="end").fixed("table", f"{side}base_link", (0, 0.7 * s, 0))
    return Kind(robot.write(folder), refusal=("robot.urdf", "several arms or ends", "--tip", "a_end", "b_end"))


@kind
def mobile_base_with_wheels(folder):
    robot = Robot("mobile").link("base_footprint").link("chassis", box(0.8, 0.6, 0.3)).fixed("base_footprint", "chassis", (0, 0, 0.25))
    for k, (x, y) in enumerate([(0.3, 0.35), (0.3, -0.35), (-0.3, 0.35), (-0.3, -0.35)]):
        robot.link(f"wheel_{k}", sphere(0.1)).joint(f"wheel_{k}_joint", "chassis", f"wheel_{k}", (x, y, -0.15), (0, 1, 0), "continuous")
    return Kind(on(robot, "chassis", (0.1, 0, 0.16)).write(folder))


@kind
def mobile_base_that_floats(folder):
    robot = Robot("mobile").link("odom").link("chassis", box(0.8, 0.6, 0.3)).joint("drive", "odom", "chassis", (0, 0, 0.25), None, "planar", limit="")
    return Kind(on(robot, "chassis", (0, 0, 0.16)).write(folder))


@kind
def head_beside_the_arm(folder):
    robot = on(Robot("with_head").link("stand", box(0.3, 0.3, 0.5, (0, 0, 0.25))), "stand", (0, 0, 0.5))
    robot.link("pan", box(0.05, 0.05, 0.05)).link("tilt", box(0.05, 0.1, 0.05)).joint("pan_joint", "stand", "pan", (-0.4, 0, 0.9), lower=-1, upper=1)
    return Kind(robot.joint("tilt_joint", "pan", "tilt", (0, 0, 0.06), (0, 1, 0), lower=-1, upper=1).write(folder))


@kind
def tool_that_turns_for_ever(folder):
    robot = arm()
    robot.link("spindle", box(0.1, 0.03, 0.03, (0.05, 0, 0))).joint("spindle_joint", "tool0", "spindle", axis=(1, 0, 0), of="continuous", velocity=1000)
    return Kind(robot.write(folder))


# ---- links that touch

@kind
def neighbours_of_neighbours_touch(folder):
    return Kind(arm(link=lambda offset, r: box(*[abs(v) + 2.4 * r for v in offset], at=[0.5 * v for v in offset])).write(folder))


@kind
def links_touch_at_zero(folder):
    robot = arm()
    robot.links["link_5"][0].append(box(0.34, 0.04, 0.04, (-0.28, 0, 0.09)))
    robot.links["link_3"][0].append(box(0.2, 0.04, 0.08, (0, 0, 0.24)))
    return Kind(robot.write(folder))


@kind
def cover_over_the_foot(folder):
    robot = arm()
    robot.links["base_link"][0].append(box(0.5, 0.5, 0.1, (0, 0, 0.33)))
    return Kind(robot.write(folder))


@kind
def table_that_the_arm_goes_through(folder):
    return Kind(on(Robot("on_table").link("table", box(1.4, 1.4, 0.9)), "table", (0, 0, 0)).write(folder))


@kind
def cage_around_the_arm(folder):
    robot = Robot("in_a_box").link("cage", box(3, 3, 3, (0, 0, 1.5)))
    return Kind(on(robot, "cage").write(folder))


@kind
def links_in_several_pieces(folder):
    robot = arm()
    for shapes, _ in robot.links.values():
        shapes += 3 * shapes
    return Kind(robot.write(folder))


@kind
def shapes_without_size(folder):
    robot = arm()
    robot.links["link_4"][0].append('<geometry><sphere radius="0"/></geometry>')
    return Kind(robot.write(folder), note="radius")


# ---- where it stands

@kind
def hangs_from_its_foot(folder):
    robot = Robot("ceiling").link("world").link("base_link", box(0.2, 0.2, 0.1, (0, 0, -0.05)))
    robot.fixed("world", "base_link", (0, 0, 2.5))
    arm_down = arm(6, tip="tool0")
    robot.links.update({n: s for n, s in arm_down.links.items() if n != "base_link"})
    robot.joints += [j.replace('xyz="0 0 0.3" rpy="0 0 0"', 'xyz="0 0 -0.3" rpy="3.14159265 0 0"') for j in arm_down.joints]
    return Kind(robot.write(folder), note="floor is a comment", says="# obstacles:")


@kind
def upside_down_in_the_world(folder):
    return Kind(on(Robot("ceiling").link("world"), "world", (0, 0, 2.5), (3.14159265, 0, 0)).write(folder))


@kind
def on_a_wall(folder):
    return Kind(on(Robot("wall").link("world"), "world", (0, 0, 1.5), (0, 1.5708, 0)).write(folder))


@kind
def foot_on_a_pedestal(folder):
    return Kind(on(Robot("high").link("world").link("pedestal", box(0.4, 0.4, 0.8, (0, 0, 0.4))).fixed("world", "pedestal"), "pedestal", (0, 0, 0.8)).write(folder))


@kind
def several_roots(folder):
    robot = arm()
    robot.link("lost_link", box(0.1, 0.1, 0.1))
    return Kind(robot.write(folder), refusal=("robot.urdf", "lost_link"))


@kind
def many_frames_on_the_tip(folder):
    robot = arm(tip="flange")
    before = "flange"
    for name in ("tool_mount", "adapter", "ft_sensor", "tcp_a", "tcp_b"):
        robot.link(name, inertial=False).fixed(before, name, (0.01, 0, 0))
        before = name
    for k in range(5):
        robot.link(f"frame_{k}", inertial=False).fixed("flange", f"frame_{k}", (0, 0.1 * k, 0))
    return Kind(robot.write(folder))


@kind
def frames_without_a_known_name(folder):
    robot = arm(tip="")
    for k in range(3):
        robot.link(f"marker_{k}", inertial=False).fixed("link_6", f"marker_{k}", (0.05, 0.03 * k, 0))
    return Kind(robot.write(folder))


# ---- meshes

@kind
def meshes_in_metres(folder):
    return Kind(arm_of_meshes(folder).write(folder))


@kind
def meshes_in_mm_with_scale(folder):
    return Kind(arm_of_meshes(folder, 0.001, "0.001 0.001 0.001").write(folder))


@kind
def meshes_in_mm_without_scale(folder):
    return Kind(arm_of_meshes(folder, 0.001).write(folder), note='scale="0.001 0.001 0.001"')


@kind
def meshes_scaled_twice(folder):
    return Kind(arm_of_meshes(folder, 1, "0.001 0.001 0.001").write(folder), note="needs no scale")


@kind
def meshes_mirrored(folder):
    return Kind(arm_of_meshes(folder, 1, "1 -1 1").write(folder))


@kind
def meshes_of_many_triangles(folder):
    return Kind(arm_of_meshes(folder, parts=40).write(folder))


@kind
def meshes_as_text(folder):
    return Kind(arm_of_meshes(folder, text=True).write(folder))


@kind
def meshes_in_a_package(folder):
    (pathlib.Path(folder) / "arm_description").mkdir(exist_ok=True)
    (pathlib.Path(folder) / "arm_description/package.xml").write_text("<package><name>arm_description</name></package>")
    robot = arm_of_meshes(pathlib.Path(folder) / "arm_description", reference="package://arm_description/{}")
    return Kind(robot.write(folder, "arm_description/urdf/robot.urdf"))


@kind
def meshes_missing(folder):
    return Kind(arm(link=lambda offset, r: mesh("package://nobody_description/meshes/a.stl")).write(folder), note="nobody_description")


@kind
def meshes_of_a_gone_computer(folder):
    return Kind(arm(link=lambda offset, r: mesh("file:///home/somebody/ws/a.stl")).write(folder), note="a.stl")


@kind
def meshes_of_an_unknown_format(folder):
    (pathlib.Path(folder) / "a.step").write_text("ISO-10303-21;\n")
    robot = arm()
    robot.links["link_4"][0] = [mesh("a.step")]
    return Kind(robot.write(folder), note="a.step")


@kind
def mesh_without_a_triangle(folder):
    robot = arm()
    (pathlib.Path(folder) / "empty.stl").write_bytes(bytes(84))
    robot.links["link_4"][0] = [mesh("empty.stl")]
    return Kind(robot.write(folder), note="empty.stl")


@kind
def no_collision_geometry(folder):
    return Kind(arm().write(folder, change=lambda text: re.sub("<collision>.*?</collision>", "", text)))


@kind
def no_geometry(folder):
    return Kind(arm(shapes=False).write(folder))


@kind
def no_inertia(folder):
    robot = arm()
    for part in robot.links.values():
        part[1] = False
    return Kind(robot.write(folder))


# ---- joints

@kind
def joints_of_two_turns(folder):
    return Kind(arm(joint=lambda k: {"lower": -6.2831, "upper": 6.2831} if k != 1 else {}).write(folder))


@kind
def joints_without_end(folder):
    return Kind(arm(joint=lambda k: {"of": "continuous"} if k in (0, 3, 5) else {}).write(folder))


@kind
def all_joints_without_end(folder):
    return Kind(arm(joint=lambda k: {"of": "continuous"}).write(folder))


@kind
def limits_of_zero(folder):
    return Kind(arm(joint=lambda k: {"lower": 0, "upper": 0, "velocity": 0}).write(folder), refusal=("robot.urdf:", "joint_1", "empty limits"))


@kind
def one_joint_locked(folder):
    return Kind(arm(joint=lambda k: {"lower": 0, "upper": 0} if k == 3 else {}).write(folder), refusal=("robot.urdf:", "joint_4", "empty limits"))


@kind
def limits_missing(folder):
    return Kind(arm(joint=lambda k: {"limit": ""} if k == 2 else {}).write(folder), refusal=("robot.urdf", "joint_3", "has no <limit>"))


@kind
def limits_upside_down(folder):
    return Kind(arm(joint=lambda k: {"lower": 2, "upper": -2} if k == 2 else {}).write(folder), refusal=("robot.urdf:", "joint_3", "lower must be below upper"))


@kind
def limits_in_degrees(folder):
    return Kind(arm(joint=lambda k: {"lower": -170, "upper": 170}).write(folder), note="degrees")


@kind
def limits_narrow(folder):
    return Kind(arm(joint=lambda k: {"lower": -0.12, "upper": 0.12} if k in (3, 5) else {}).write(folder))


@kind
def soft_limits(folder):
    return Kind(arm(joint=lambda k: {"more": '<safety_controller soft_lower_limit="-1.5" soft_upper_limit="1.5" k_position="1" k_velocity="1"/>'}).write(folder))


@kind
def velocities_of_zero(folder):
    return Kind(arm(joint=lambda k: {"velocity": 0}).write(folder), note="velocity of 'joint_1' is not known")


@kind
def velocity_missing(folder):
    return Kind(arm(joint=lambda k: {"limit": '<limit lower="-1.5" upper="1.5" effort="10"/>'} if k == 2 else {}).write(folder), refusal=("robot.urdf", "no velocity"))


@kind
def axes_not_unit(folder):
    return Kind(arm(joint=lambda k: {"axis": [2 * v for v in AXES[k][1]]}).write(folder))


@kind
def axes_nearly_along(folder):
    return Kind(arm(joint=lambda k: {"axis": [v or 3.2051e-9 for v in AXES[k][1]]}).write(folder))


@kind
def axis_missing(folder):
    return Kind(arm(joint=lambda k: {"axis": None} if k == 3 else {}).write(folder))


@kind
def joint_that_floats_in_the_arm(folder):
    return Kind(arm(joint=lambda k: {"of": "floating", "limit": "", "axis": None} if k == 2 else {}).write(folder), refusal=("robot.urdf:", "joint_3", "type"))


# ---- the text

@kind
def names_with_spaces(folder):
    return Kind(arm(naming=lambda prefix, k: f"link {k} part A").write(folder, "my robot.urdf"))


@kind
def names_in_other_alphabets(folder):
    return Kind(arm(naming=lambda prefix, k: f"звено_{k}_关节").write(folder, "арм.urdf"))


@kind
def names_with_slashes(folder):
    return Kind(arm(naming=lambda prefix, k: f"/robot/link-{k}: a&amp;b").write(folder))


@kind
def tags_of_other_programs(folder):
    robot = arm()
    robot.attributes = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
    robot.more = ('<material name="grey"><color rgba="1 1 1 1"/></material><transmission name="t"><type>x</type><joint name="joint_1"><hardwareInterface>p</hardwareInterface></joint></transmission>'
                  '<gazebo reference="link_1"><selfCollide>true</selfCollide></gazebo><ros2_control name="r" type="system"><hardware/></ros2_control>')
    return Kind(robot.write(folder))


@kind
def values_that_xacro_would_fill_in(folder):
    return Kind(arm().write(folder, change=lambda text: text.replace('upper="2.2"', 'upper="${radians(126)}"')), refusal=("robot.urdf:", "joint_3", "${radians(126)}"))


@kind
def macro_left_in_a_urdf(folder):
    robot = arm()
    robot.more = '<xacro:include filename="gripper.xacro"/><xacro:gripper parent="tool0"/>'
    return Kind(robot.write(folder))


@kind
def bytes_before_the_text(folder):
    return Kind(arm().write(folder, change=lambda text: "\ufeff" + text.replace("\n", "\r\n")))


@kind
def text_in_latin_1(folder):
    return Kind(arm(6, Robot("Gelenkarm für Prüfung")).write(folder, change=lambda text: text.replace('version="1.0"', 'version="1.0" encoding="ISO-8859-1"'), encoding="latin-1"))


# ---- sizes

def scaled(factor):
    return arm(link=lambda offset, r: box(*[max(abs(0.6 * v), 2 * r) * factor for v in offset], at=[0.5 * v * factor for v in offset]))


def scale_joints(robot, factor):
    robot.joints = [re.sub(r'xyz="([^"]*)" rpy', lambda m: f'xyz="{" ".join(f"{float(v) * factor:g}" for v in m[1].split())}" rpy', j) for j in robot.joints]
    return robot


@kind
def small_arm(folder):
    return Kind(scale_joints(scaled(0.2), 0.2).write(folder))


@kind
def large_arm(folder):
    return Kind(scale_joints(scaled(4), 4).write(folder))


@kind
def arm_in_millimetres(folder):
    return Kind(scale_joints(scaled(1000), 1000).write(folder), refusal=("robot.urdf", "metres"))
