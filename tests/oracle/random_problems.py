"""Problem files at random, the same ones for the same seed and number: a robot, an instrument that can see it, noise, loads, variants."""
import yaml

from random_arms import Arm, DenavitHartenberg, Springs
from random_instruments import INSTRUMENTS, chance, pick
from random_parallel import Compensator, Delta, FiveBar, Gough, SixPus
from random_robots import rounded

# In this order they come in turn, so that a few problems have all of them.
ROBOTS = [Arm, Springs, SixPus, DenavitHartenberg, Delta, Gough, FiveBar, Compensator]


def stays(random, measurement):
    """What stays at a pose, and how often it is read."""
    if chance(random, 0.5):
        measurement["repeats"] = int(random.integers(2, 6))
    if chance(random, 0.6):
        position = f"{random.uniform(0.01, 0.1):.4f} mm"
        turned = {"position": position, "rotation": f"{random.uniform(0, 0.1):.4f} mrad"}
        measurement["repeatability"] = turned if chance(random, 0.6) else position


def line_of_sight(random, problem):
    """Targets that face away are hidden; from a pose where enough are seen, those count."""
    several = len(problem["measurement"].get("targets", [])) > 1
    if several and problem["measurement"]["device"].get("stations") and "components" not in problem["measurement"] and chance(random, 0.5):
        faces = {name: rounded(random, 1) for name in problem["measurement"]["targets"]}
        seen = {"visible": 1, "acceptance": "75 deg", "normals": faces}
        problem["workspace"] = problem.get("workspace", {}) | {"line_of_sight": seen}


def instrument_nominal(random, measurement):
    """Where targets and stations are, if not where the measurement says."""
    if not chance(random, 0.15):
        return {}
    found = {f"target.{name}.x": "12 mm" for name in measurement.get("targets", []) if name.startswith("T")}
    return found | {f"station.{name}.r?": 0.04 for name in measurement["device"].get("stations", [])}


def variant(random, robot, measurement):
    """Parameters of interest, nuisance ones, fixed ones, some tolerances and nominal values."""
    kind, parameters = measurement["type"], robot.parameters(random, measurement)
    chosen, nuisance = {"parameters": parameters, "nominal": robot.nominal(random) | instrument_nominal(random, measurement)}, []
    if isinstance(parameters, list) and "auto" not in parameters:
        # Everything named must be told apart: with base and targets free much of it would not, nor with a part of the readings.
        measurement.pop("components", None)
        return {key: value for key, value in chosen.items() if value}
    if kind != "joints":
        if chance(random, 0.7):
            nuisance.append("base.*")
        else:
            chosen["fixed"] = ["base.*"]
    if kind in ("points", "position", "distance") and robot.kind != "compensator" and chance(random, 0.7):
        nuisance.append("target.*")
    if kind == "pose" and chance(random, 0.7):
        nuisance.append("tool.*")
    if kind == "camera":
        nuisance += ["board.*", "camera.*" if chance(random, 0.6) else "camera.f?"]
    if "B" in measurement["device"].get("stations", {}) and chance(random, 0.6):
        nuisance.append("station.B.*")
    if "anchors" in measurement and chance(random, 0.4):
        nuisance.append("anchor.*" if chance(random, 0.5) else "anchor.*.length")
    if chance(random, 0.4):
        chosen["tolerance"] = {pick(random, robot.lengths): f"{random.uniform(0.1, 2):.4f} mm"}
    chosen["nuisance"] = nuisance
    return {key: value for key, value in chosen.items() if value}


def design(random, robot, measurement):
    chosen = {"poses": robot.poses(measurement), "scaling": pick(random, ["tolerance", "norm", "none"]),
              "criterion": pick(random, ["o1", "ds", "a", "o3", "o5"])}
    if chance(random, 0.25):
        chosen["prior"] = "tolerance"
    if chance(random, 0.5) and measurement["type"] != "joints" and robot.kind != "compensator" and "between" not in measurement:
        at = [robot.somewhere(random) for _ in range(3)]
        chosen["test_poses"] = {"at": at, "weights": [1, 2.5, 0.5]} if chance(random, 0.5) else {"at": at}
        if chance(random, 0.5):
            chosen["test_poses"]["point"] = rounded(random, 0.3 * robot.size)
        loads = list(robot.spec.get("elastostatic", {}).get("loads", {}))
        if len(loads) > 1 and chance(random, 0.4):
            chosen["test_poses"]["load_case"] = pick(random, loads)
        chosen["criterion"] = pick(random, ["o1", "test_pose", "test_pose_max", "a"])
    return chosen


def random_problem(folder, random, number, robots=ROBOTS):
    """Writes the file; its path and what it is."""
    robot = robots[number % len(robots)](random, folder)
    measurement = INSTRUMENTS[pick(random, robot.instruments)](random, robot)
    if measurement["type"] != "joints" and robot.kind != "compensator":
        stays(random, measurement)
    if robot.kind == "springs" and chance(random, 0.35):
        measurement["load"] = "loaded_minus_unloaded"
    problem = {"posewright": 1, "robot": robot.spec, "measurement": measurement,
               "variants": {"all": variant(random, robot, measurement)}, "design": design(random, robot, measurement)}
    if robot.workspace:
        problem["workspace"] = robot.workspace
    if measurement["type"] == "points" and robot.kind != "compensator":
        line_of_sight(random, problem)
    file = folder / "problem.yaml"
    file.write_text(yaml.safe_dump(problem, sort_keys=False))
    notes = [measurement["device"]["type"]] if measurement["type"] in ("points", "position", "pose") else []
    notes += ["pairs"] * ("between" in measurement) + ["loaded minus unloaded"] * ("load" in measurement)
    notes += ["line of sight"] * ("line_of_sight" in problem.get("workspace", {}))
    return file, f"{robot.title()} × {measurement['type']}" + (f" ({', '.join(notes)})" if notes else "")
