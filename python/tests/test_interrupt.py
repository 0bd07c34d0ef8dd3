"""Ctrl-C, which only the main thread of a process of its own can show."""
import os
import signal
import subprocess
import sys
import textwrap
import threading

import pytest

import posewright as pw

START = """
import os, signal, sys, warnings
import numpy as np
import posewright as pw
problem = pw.Problem(sys.argv[1])
def interrupt(progress):
    # As from a terminal, while the search is at work.
    if progress.stage == "exchange":
        os.kill(os.getpid(), signal.SIGINT)
long = dict(restarts=1000000, method="exchange", progress=interrupt)
"""


def run(examples, text):
    script = START + textwrap.dedent(text)
    return subprocess.run([sys.executable, "-c", script, str(examples / "kr270" / "problem.yaml")],
                          capture_output=True, text=True, timeout=120)


def test_ctrl_c_keeps_the_best_plan_and_warns(examples):
    done = run(examples, """
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            plan = pw.plan(problem, candidates=100, **long)
        assert plan.interrupted and len(plan) == 18
        assert plan.log_det <= plan.certificate.bound
        assert [w.category for w in told] == [RuntimeWarning], told
        chosen = pw.select(np.random.default_rng(1).standard_normal((300, 2, 6)), poses=9, **long)
        assert chosen.interrupted and len(chosen) == 9
        again = pw.plan(problem, candidates=60, restarts=1, method="exchange")
        assert not again.interrupted
        print("through")
        """)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "through\n"


def test_ctrl_c_before_there_is_a_result_is_a_keyboard_interrupt(examples):
    done = run(examples, """
        def interrupt(progress):
            os.kill(os.getpid(), signal.SIGINT)
        try:
            pw.observe(problem, candidates=1000000, progress=interrupt)
        except KeyboardInterrupt:
            print("raised")
        """)
    assert (done.returncode, done.stdout) == (0, "raised\n"), done.stderr


def test_what_a_signal_handler_raises_comes_out(examples):
    done = run(examples, """
        def stop(number, frame):
            raise TimeoutError("enough")
        signal.signal(signal.SIGINT, stop)
        try:
            pw.plan(problem, candidates=100, **long)
        except TimeoutError as error:
            print(error)
        """)
    assert (done.returncode, done.stdout) == (0, "enough\n"), done.stderr


def test_other_threads_of_python_run_during_a_search(kr270):
    ticks = []
    finished = threading.Event()

    def tick():
        while not finished.wait(0.001):
            ticks.append(1)

    def count(progress):
        seen.append(len(ticks))

    seen = []
    thread = threading.Thread(target=tick)
    thread.start()
    try:
        pw.plan(kr270, candidates=60, restarts=2, method="exchange", progress=count)
    finally:
        finished.set()
        thread.join()
    assert seen[-1] > seen[0]


def test_searches_in_several_threads_do_not_mix(kr270):
    expected = pw.plan(kr270, candidates=60, restarts=1, seed=1, method="exchange").to_dict()["poses"]
    plans = {}

    def search(i):
        plans[i] = pw.plan(kr270, candidates=60, restarts=1, seed=1, method="exchange", threads=1).to_dict()["poses"]

    threads = [threading.Thread(target=search, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [plans[i] for i in range(3)] == [expected] * 3
