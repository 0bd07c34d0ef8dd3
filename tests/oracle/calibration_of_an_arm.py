"""What `calibrate` states, computed again from definitions: calibration_of_an_arm.py PROGRAM SOURCE [COUNT [SEED]].

COUNT random arms (default 20) beside the KUKA KR 270 of the examples; SEED "fresh" draws one. For each, readings of a robot that
we draw, in several ways: noise as stated or not, cells that are empty, repeats as lines, poses that are held back. The same least
squares by scipy, and every statistic from its definition. Exit status 1 where anything disagrees."""
import pathlib
import secrets
import shutil
import sys
import tempfile

try:
    import numpy as np

    import calibration_problems as drawn
    from calibration_comparison import ALLOWED, compare
    from calibration_runs import Run, describe, random_way
    from statistics_by_definition import Arm
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml, python3-scipy)")
    sys.exit(77)


def one_station(robot, measurement):
    """Few poses from many stations would determine neither."""
    measurement["device"].pop("stations", None)


def count_of_poses(random, small):
    """Few, to leave out one after the other by brute force, or so many that they are left out in groups."""
    if not small:
        return int(random.integers(14, 24))
    return int(random.integers(6, 10) if random.random() < 0.7 else random.integers(31, 36))


def main(program, source, count="20", seed="1"):
    seed = secrets.randbelow(10**9) if seed == "fresh" else int(seed)
    print(f"seed {seed}")
    program, good = pathlib.Path(program).resolve(), True
    runs = refusals = silent = visits = 0
    with tempfile.TemporaryDirectory() as name:
        here = pathlib.Path(name)
        for k in range(-1, int(count)):
            random = np.random.default_rng([seed, k + 1])
            small = k % 4 == 0
            if k < 0:
                for file in ("problem.yaml", "kr270.urdf"):
                    shutil.copy(pathlib.Path(source).resolve() / "examples/kr270" / file, here / file)
            else:
                drawn.random_problem(here, random, *((2, one_station) if small else ()))
            arm = Arm(here / "problem.yaml")
            variant = next(iter(arm.problem["variants"]))
            for _ in range(2):
                way = random_way(random, arm, variant, small)
                run = Run(program, here, arm, variant, way, random, count_of_poses(random, small))
                told = f"{'KR 270' if k < 0 else f'arm {k}'} {describe(way)}: "
                check = compare(run, brute_force=small) if run.result else None
                if check is None:
                    print(f"{told}not judged, exit status {run.status}: {run.said[:150]}")
                    silent += 1
                    continue
                runs, refusals = runs + 1, refusals + (run.result["verdict"] != "use it")
                visits += run.result["visit_errors"] is not None
                wrong = check.wrong()
                good = good and not wrong
                told += ", ".join(f"{what} {off:.0e}" for what, off in check.worst.items() if off > 0.1 * ALLOWED[what])
                print(told + (f"  FAILED: {'; '.join(wrong)}" if wrong else ""), flush=True)
    print(f"{runs} calibrations, {refusals} of them refused, {visits} with displacements of a visit that are not stated; {silent} not judged")
    sys.exit(0 if good and silent < runs else 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
