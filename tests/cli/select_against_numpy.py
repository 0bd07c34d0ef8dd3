"""posewright select against numpy and against known results: select_against_numpy.py PROGRAM SHARED_BENCH

Every result's log det is recomputed by numpy's QR from the blocks in the file. On the shared instances, where they are
present, ten restarts must reach what AlgDesign's optFederov reaches in ten, and bounds must equal the approximate optima
of OptimalDesign's od_REX.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy as np

program, bench = sys.argv[1], sys.argv[2]
failures = 0


def check(ok, text):
    global failures
    print(("ok   " if ok else "FAIL ") + text)
    failures += 0 if ok else 1


def select(path, poses, *options):
    run = subprocess.run([program, "select", path, "--poses", str(poses), "--json", "-o", "-", *options],
                         capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(run.stderr)
    return json.loads(run.stdout)


def judge(name, path, poses, *options):
    """Plan of one file; its log det and efficiency against numpy."""
    blocks = np.load(path)
    plan = select(path, poses, *options)
    chosen = [pose["candidate"] for pose in plan["poses"]]
    rows = blocks[chosen].reshape(-1, blocks.shape[2])
    expected = 2 * np.log(np.abs(np.diag(np.linalg.qr(rows, mode="r")))).sum()
    stated, bound = plan["criterion"]["log_det"], plan["certificate"]["candidates"]["log_det_bound"]
    check(abs(stated - expected) <= 1e-9 * max(1, abs(expected)), f"{name}: log det {stated:.9f}, numpy {expected:.9f}")
    check(len(chosen) == poses and stated <= bound, f"{name}: {len(chosen)} poses, bound {bound:.9f}")
    if "allow" not in options:
        check(len(set(chosen)) == poses, f"{name}: no candidate twice")
    return stated, bound


with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "own.npy")
    blocks = np.random.default_rng(1).standard_normal((400, 3, 12)) * np.logspace(-3, 3, 12)
    np.save(path, blocks)
    judge("own blocks, badly scaled", path, 10)
    judge("own blocks, repeats", path, 10, "--repeats", "allow")
    csv = os.path.join(folder, "own.csv")
    np.savetxt(csv, blocks.reshape(-1, 12), delimiter=",", fmt="%.17g")
    a, b = select(path, 10), select(csv, 10, "--rows", "3")
    check([p["candidate"] for p in a["poses"]] == [p["candidate"] for p in b["poses"]], "CSV and .npy give the same plan")

    generator = os.path.join(bench, "make_instances.py")
    if not os.path.exists(generator):
        print("skipped: the shared benchmark instances are absent")
        sys.exit(1 if failures else 0)
    subprocess.run([sys.executable, generator, folder], check=True, stdout=subprocess.DEVNULL)
    instance = lambda name: os.path.join(folder, name + ".npy")
    # Best of ten runs of optFederov, no repeats.
    for name, poses, at_least in [("a_quad5x7", 42, 63.774835), ("b_gauss5k", 60, 135.348695),
                                  ("c_gauss100k", 40, 90.076198), ("d_pus_leg", 40, -55.431302)]:
        stated, _ = judge(name, instance(name), poses)
        check(stated >= at_least - 1e-6, f"{name}: {stated:.6f} is at least AlgDesign's {at_least}")
    # Approximate optima (weights sum to 1): the bound less m ln N where repeats are allowed.
    for name, poses, optimum in [("a_quad5x7", 42, -14.26998258), ("b_gauss5k", 60, 14.19205327),
                                 ("c_gauss100k", 40, 17.32539466), ("d_pus_leg", 40, -77.12970530),
                                 ("e_pus_block", 40, -482.346320219), ("f_gaussblk", 25, 42.193324870)]:
        _, bound = judge(name + ", repeats", instance(name), poses, "--repeats", "allow", "--restarts", "2")
        columns = np.load(instance(name), mmap_mode="r").shape[2]
        check(abs(bound - columns * math.log(poses) - optimum) <= 1e-6,
              f"{name}: approximate optimum {bound - columns * math.log(poses):.9f}, listed {optimum}")
sys.exit(1 if failures else 0)
