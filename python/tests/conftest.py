import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import posewright as pw

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def examples():
    return ROOT / "examples"


@pytest.fixture(scope="session")
def kr270(examples):
    return pw.Problem(examples / "kr270" / "problem.yaml")


@pytest.fixture(scope="session")
def small_plan(kr270):
    """Few candidates, one start: what it says must be right, not good."""
    return pw.plan(kr270, candidates=60, restarts=1, method="exchange")


@pytest.fixture(scope="session")
def program():
    """Runs the command line and returns what it prints with --json."""
    path = os.environ.get("POSEWRIGHT_PROGRAM")
    if path is None:
        pytest.skip("POSEWRIGHT_PROGRAM does not name the program")

    def run(*arguments):
        done = subprocess.run([path, *map(str, arguments), "--json"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run


@pytest.fixture
def blocks():
    """Badly scaled blocks 300 × 3 × 8."""
    return np.random.default_rng(1).standard_normal((300, 3, 8)) * np.logspace(-2, 2, 8)


def without_times(plan):
    """A plan as a dictionary without what differs from run to run."""
    plan = json.loads(json.dumps(plan))
    plan["statistics"].pop("seconds")
    for stage in plan["statistics"].get("stages", []):
        stage.pop("seconds")
    return plan
