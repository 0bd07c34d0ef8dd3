"""Chances that `calibrate` states, against how often things happen: calibration_chances.py PROGRAM SOURCE [COUNT [SEED]].

COUNT calibrations (default 120) of random arms whose readings are drawn just as the problem states, true parameters by those
tolerances that count. Then a stated chance p is below p as often as that, and intervals hold the truth 95 times of 100. A test
of uniformity (Kolmogorov, Smirnov) and of coverage for each way of fitting; exit status 1 where chance does so once in 10,000."""
import json
import pathlib
import secrets
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy import stats

    import calibration_problems as drawn
    from statistics_by_definition import Arm
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml, python3-scipy)")
    sys.exit(77)

WAYS = {"as stated": [], "no prior": ["--no-prior"], "ols": ["--weights", "ols"], "ols, no prior": ["--weights", "ols", "--no-prior"],
        "robust": ["--weights", "robust"], "robust, no prior": ["--weights", "robust", "--no-prior"]}
TESTS = ["chi_square", "lack_of_fit", "within_pose_correlation", "serial_correlation"]
SELDOM = 1e-4


def calibrate(program, folder, options):
    done = subprocess.run([program, "calibrate", str(folder / "problem.yaml"), str(folder / "data.csv"), "--json", "--quiet", *options],
                          capture_output=True, text=True)
    return json.loads(done.stdout) if done.stdout else None


def write_data(arm, truth, poses, lines, random, folder):
    everything = drawn.drawn_readings(arm, poses, truth, [lines] * len(poses.Q), random)
    drawn.written(folder / "data.csv", arm, poses, everything, random)


def alike(robot, measurement):
    """Noise of one size for all readings, as ols takes it to be."""
    measurement["device"] = {"type": "isotropic", "noise": "0.08 mm"}
    measurement.pop("repeatability", None)
    robot.pop("encoder_noise", None)


def one(program, folder, random, way, chances, covered):
    drawn.random_problem(folder, random, joints=int(random.integers(2, 4)), edit=alike if way.startswith("ols") else None)
    arm = Arm(folder / "problem.yaml")
    lines = int(random.integers(2, 5))
    poses = drawn.drawn_poses(arm, random, int(random.integers(8, 14)))
    # Which parameters these poses determine; they alone differ from nominal in the robot that is measured.
    write_data(arm, {}, poses, lines, random, folder)
    first = calibrate(program, folder, WAYS[way])
    if first is None:
        return
    truth = {p["name"]: p["tolerance"] * random.normal() for p in first["parameters"] if p["estimated"]}
    write_data(arm, truth, poses, lines, random, folder)
    result = calibrate(program, folder, WAYS[way])
    # Chances and intervals are those of a problem that is linear within its uncertainty.
    if result is None or result["curvature"] is None or result["curvature"] > 0.02:
        return
    for test in TESTS:
        if result["tests"][test] is not None:
            chances.setdefault((way, test), []).append(result["tests"][test]["probability"])
    held = [p["interval"][0] <= p["nominal"] + truth[p["name"]] <= p["interval"][1]
            for p in result["parameters"] if p["estimated"] and p["interval"] and p["name"] in truth]
    # None has an interval where all hang on something that these poses cannot tell.
    if held:
        covered.setdefault(way, []).append(np.mean(held))


def main(program, source, count="120", seed="1"):
    seed = secrets.randbelow(10**9) if seed == "fresh" else int(seed)
    print(f"seed {seed}")
    chances, covered, good = {}, {}, True
    with tempfile.TemporaryDirectory() as name:
        for k in range(int(count)):
            one(str(pathlib.Path(program).resolve()), pathlib.Path(name), np.random.default_rng([seed, k]), list(WAYS)[k % len(WAYS)],
                chances, covered)
    for (way, test), p in sorted(chances.items()):
        chance = stats.kstest(p, "uniform").pvalue
        good = good and chance > SELDOM
        below = ", ".join(f"{np.mean(np.array(p) < level):.3f} below {level}" for level in (0.01, 0.05, 0.5, 0.95))
        print(f"{way}, {test}: {len(p)} chances, {below}; uniform: p = {chance:.2g}{'' if chance > SELDOM else '  FAILED'}")
    for way, shares in covered.items():
        mean, error = np.mean(shares), np.std(shares, ddof=1) / np.sqrt(len(shares))
        chance = 2 * stats.t.sf(abs(mean - 0.95) / max(error, 1e-9), len(shares) - 1)
        good = good and chance > SELDOM
        print(f"{way}: intervals hold the truth {100 * mean:.2f} ± {100 * error:.2f} times of 100{'' if chance > SELDOM else '  FAILED'}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
