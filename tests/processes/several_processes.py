"""Commands whose work several processes share: several_processes.py PROGRAM SOURCE [CASES].

The same files from one process and from several; the same after processes were killed; one line where it cannot be.
CASES of unittest, as python3 -m unittest takes them. Runs on one machine; nothing here knows of a network.
"""

import itertools
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

PROGRAM, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
MODULE = PROGRAM.parent.parent / "lib" / "posewright" / "modules" / "posewright_mpi.so"
MPIRUN = shutil.which("mpirun")
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_btl_base_warn_component_unused": "0"}
# Seconds that a run took, and what of a file depends on them.
TIMES = {"seconds", "time", "stages", "created"}


def started(processes, *arguments):
    begin = [MPIRUN, "--oversubscribe", "-n", str(processes)] if processes > 0 else []
    return [*begin, str(PROGRAM), *map(str, arguments)]


def run(folder, processes, *arguments):
    return subprocess.run(started(processes, *arguments), cwd=folder, env=ENVIRONMENT, capture_output=True, text=True)


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in TIMES}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def blocks_csv(folder, candidates=160, columns=6):
    draw = random.Random(5)
    with open(folder / "blocks.csv", "w", encoding="ascii") as file:
        for _ in range(candidates):
            file.write(",".join(f"{draw.gauss(0, 1):.6f}" for _ in range(columns)) + "\n")


def blocks_npy(file, candidates, rows=2, columns=5):
    """Every fourth block is one of before with its rows' signs turned: ties, on several processes."""
    draw = numpy.random.default_rng(7)
    blocks = draw.normal(size=(candidates, rows, columns)) * draw.uniform(0.3, 1, size=(candidates, 1, 1))
    blocks[3::4] = -blocks[numpy.arange(3, candidates, 4) // 2]
    numpy.save(file, blocks)
    return blocks


def log_det(blocks, members):
    rows = numpy.concatenate([blocks[i] for i in members])
    return numpy.linalg.slogdet(rows.T @ rows)[1]


class SeveralProcesses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.home.name)
        shutil.copytree(SOURCE / "examples" / "kr270", cls.folder / "kr270")
        shutil.copytree(SOURCE / "examples" / "instruments", cls.folder / "instruments")
        blocks_csv(cls.folder)
        plan = run(cls.folder, 0, "plan", "kr270/problem.yaml", "--method", "greedy", "--candidates", "200",
                   "--proof-time", "0", "-o", "kr270.json", "--poses-csv", "kr270.csv")
        assert plan.returncode == 0, plan.stderr

    @classmethod
    def tearDownClass(cls):
        cls.home.cleanup()

    def result(self, processes, command, extra=()):
        """What the command says or writes, as JSON, without times."""
        done = run(self.folder, processes, *command, *extra, "--json", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return without_times(json.loads(done.stdout))

    def commands(self):
        select = ["select", "blocks.csv", "--rows", "1", "--poses", "9", "-o", "-"]
        return {
            "draws": ["simulate", "kr270/problem.yaml", "kr270.json", "--draws", "40"],
            "restarts": [*select, "--restarts", "7"],
            "nodes": [*select, "--method", "branch_and_bound"],
        }

    def needs_processes(self):
        if MPIRUN is None or not MODULE.exists():
            self.skipTest("Open MPI is not here, or posewright was built without it")

    def test_any_number_of_processes_gives_the_same(self):
        self.needs_processes()
        for name, command in self.commands().items():
            alone = self.result(0, command)
            for processes in (1, 2, 3, 5):
                with self.subTest(tasks=name, processes=processes):
                    done = run(self.folder, processes, *command, "--threads", "1", "--json", "--verbose")
                    self.assertEqual(without_times(json.loads(done.stdout)), alone)
                    # Not each process for itself: tasks went between them.
                    told = re.search(r"(\d+) tasks done, 0 known before; (\d+) processes, (\d+) messages", done.stderr)
                    self.assertGreater(int(told[1]), 4)
                    self.assertEqual(int(told[2]), processes)
                    self.assertGreater(int(told[3]), 2 * (processes - 1) - 1)

    def the_same_in_three_processes(self, *command, more=lambda: None):
        """Draws, restarts and nodes have every number of processes; what else is shared goes the same way."""
        alone = self.result(0, command), more()
        self.assertEqual((self.result(3, command, ["--threads", "1"]), more()), alone)

    def spread(self, processes, file, *extra):
        done = run(self.folder, processes, "select", file, "--spread", "-o", "-", "--json", "--verbose", *extra)
        self.assertEqual(done.returncode, 0, done.stderr)
        return without_times(json.loads(done.stdout)), done.stderr

    def test_spread_blocks_give_the_same_on_any_number_of_processes_with_few_messages(self):
        self.needs_processes()
        blocks_npy(self.folder / "spread.npy", 700)
        for extra in (["--poses", "9"], ["--poses", "12", "--repeats", "3"]):
            alone, _ = self.spread(0, "spread.npy", *extra, "--threads", "1")
            self.assertEqual(self.spread(0, "spread.npy", *extra, "--threads", "3")[0], alone)
            for processes in (1, 2, 3, 5, 8) if "--repeats" not in extra else (3,):
                with self.subTest(processes=processes, extra=extra):
                    result, told = self.spread(processes, "spread.npy", *extra, "--threads", "1")
                    self.assertEqual(result, alone)
                    looks, look_bytes, blocks, block_bytes, per_look, bytes_of_look, per_block, bytes_of_block = map(float, re.search(
                        r"(\d+) looks for an exchange, an all-reduce of (\d+) bytes each; (\d+) blocks of (\d+) bytes sent to "
                        r"all; the busiest process had ([\d.]+) messages of (\d+) bytes in all for a look, ([\d.]+) of (\d+) for",
                        told).groups())
                    steps = math.ceil(math.log2(processes))
                    self.assertGreater(looks, blocks)
                    self.assertGreater(blocks, 15)
                    self.assertLessEqual(look_bytes, 24)
                    self.assertEqual(block_bytes, 2 * 8 * 8)
                    # Up and down a tree; the root of a broadcast changes.
                    self.assertEqual(per_look, 2 * steps)
                    self.assertLessEqual(per_block, steps)
                    self.assertGreaterEqual(per_block, 1 if processes > 1 else 0)
                    self.assertLessEqual(bytes_of_look, 2 * steps * (look_bytes + 8))
                    self.assertLessEqual(bytes_of_block, steps * block_bytes)

    def test_a_plan_of_spread_blocks_is_as_good_as_of_blocks_in_one_memory(self):
        blocks = blocks_npy(self.folder / "whole.npy", 500)
        spread, _ = self.spread(0, "whole.npy", "--poses", "9")
        plain = self.result(0, ["select", "whole.npy", "--poses", "9", "-o", "-"])
        members = [pose["candidate"] for pose in spread["poses"]]
        self.assertAlmostEqual(spread["criterion"]["log_det"], log_det(blocks, members), delta=1e-9)
        self.assertGreater(spread["criterion"]["log_det"], plain["criterion"]["log_det"] - 0.1)
        # The same bound, from the same problem by two programs; no plan is above it.
        self.assertAlmostEqual(spread["certificate"]["candidates"]["bound"], plain["certificate"]["candidates"]["bound"], delta=1e-6)
        self.assertGreaterEqual(spread["certificate"]["candidates"]["bound"], plain["criterion"]["log_det"] - 1e-9)
        # No exchange gains: all are tried.
        gains = [log_det(blocks, members[:k] + [j] + members[k + 1:]) - spread["criterion"]["log_det"]
                 for k in range(9) for j in range(500) if j not in members]
        self.assertLess(max(gains), 1e-8)

    def test_no_set_of_spread_blocks_is_above_the_bound_and_the_best_is_found(self):
        blocks = blocks_npy(self.folder / "few.npy", 18, rows=2, columns=4)
        spread, _ = self.spread(0, "few.npy", "--poses", "4")
        best = max(log_det(blocks, members) for members in itertools.combinations(range(18), 4))
        self.assertGreaterEqual(spread["certificate"]["candidates"]["bound"], best)
        self.assertAlmostEqual(spread["criterion"]["log_det"], best, delta=1e-9)
        self.assertLessEqual(spread["certificate"]["candidates"]["efficiency"], math.exp((spread["criterion"]["log_det"] - best) / 4) + 1e-12)

    def test_what_cannot_be_spread_says_so_in_one_line(self):
        self.needs_processes()
        blocks = blocks_npy(self.folder / "bad.npy", 300)
        blocks[290, 1, 3] = numpy.nan
        numpy.save(self.folder / "bad.npy", blocks)
        blocks_npy(self.folder / "good.npy", 300)
        cases = [("bad.npy", [], 2, "block 290, row 1, column 3 is not finite"), ("blocks.csv", ["--rows", "1"], 2, "numpy.save")]
        for option, value in (("criterion", ["a"]), ("method", ["tabu"]), ("nuisance", ["1"]), ("fixed", ["3"]), ("augment", ["3"]),
                              ("reserve", []), ("restarts", ["3"]), ("resume", ["a.log"])):
            cases.append(("good.npy", [f"--{option}", *value], 2, f"--{option}"))
        cases.append(("good.npy", ["--poses", "300"], 1, "leave no choice"))
        for file, extra, code, expected in cases:
            with self.subTest(file=file, extra=extra):
                poses = [] if "--poses" in extra else ["--poses", "9"]
                done = run(self.folder, 3 if file == "bad.npy" else 0, "select", file, "--spread", *poses, "-o", "-", *extra)
                self.assertEqual(done.returncode, code, done.stderr)
                lines = [line for line in done.stderr.splitlines() if line.startswith("posewright: ")]
                self.assertEqual(len(lines), 1, done.stderr)
                self.assertIn(expected, lines[0])

    def test_places_are_shared(self):
        self.needs_processes()
        shutil.copytree(SOURCE / "examples" / "cell", self.folder / "cell")
        problem = self.folder / "cell" / "problem.yaml"
        text = problem.read_text(encoding="utf-8")
        four_places = text.replace("points: [3, 3, 1]", "points: [2, 2, 1]")
        self.assertNotEqual(four_places, text)
        problem.write_text(four_places, encoding="utf-8")
        self.the_same_in_three_processes("stations", "cell/problem.yaml", "--poses", "8", "--candidates", "60",
                                                 "--restarts", "1", "--full", "1")

    def test_robots_of_a_fleet_are_shared(self):
        self.needs_processes()
        shutil.copytree(SOURCE / "examples" / "delta", self.folder / "delta")
        self.the_same_in_three_processes("fleet", "delta/problem.yaml", "kr270/elastostatic.yaml", "--poses", "8",
                                                 "--restarts", "1", "--output-dir", ".", more=self.files_of_fleet)

    def test_variants_of_a_comparison_are_shared(self):
        self.needs_processes()
        self.the_same_in_three_processes("compare", "kr270/elastostatic.yaml", "--poses", "20", "--candidates",
                                                 "150", "--restarts", "1")

    def test_drawn_robots_of_a_plan_are_shared(self):
        self.needs_processes()
        self.the_same_in_three_processes("plan", "instruments/camera_on_hand.yaml", "--method", "greedy", "--candidates", "60",
                                                 "--robust", "8", "--robust-measure", "tail 0.25", "-o", "-", "--poses-csv", "-")

    def test_restarts_and_boxes_of_a_plan_are_shared(self):
        self.needs_processes()
        files = ["-o", "-", "--poses-csv", "-"]
        self.the_same_in_three_processes("plan", "kr270/problem.yaml", "--method", "tabu", "--restarts", "5", "--candidates", "60",
                                         "--proof-time", "0", *files)
        # Six axes: boxes that take half a millisecond each, eight a task, in three rounds.
        shutil.copytree(SOURCE / "examples" / "telescope", self.folder / "telescope")
        boxes = ["plan", "telescope/problem.yaml", "--variant", "rigid", "--method", "greedy", "--candidates", "1000",
                 "--poses", "30", "--gap", "95", *files]
        alone = self.result(0, boxes)
        boxes_alone = alone["certificate"]["workspace"]["boxes"]
        self.assertGreater(boxes_alone, 64)
        done = run(self.folder, 3, *boxes, "--json", "--verbose", "--threads", "1")
        self.assertEqual(without_times(json.loads(done.stdout)), alone)
        self.assertGreaterEqual(int(re.search(r"(\d+) tasks done", done.stderr)[1]), boxes_alone // 8)

    def files_of_fleet(self):
        return [without_times(json.loads((self.folder / f"{name}.plan.json").read_text(encoding="utf-8")))
                for name in ("delta", "elastostatic")]

    def killed_run(self, processes, command, log, after):
        """Starts it in a group of its own, kills all of it after so many seconds; whether it was killed in time."""
        with subprocess.Popen(started(processes, *command, "--resume", log, "--threads", "1"), cwd=self.folder,
                              env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              start_new_session=True) as process:
            try:
                process.wait(after)
                return False
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return True

    def test_a_killed_run_goes_on_from_its_log_and_gives_the_same(self):
        command = [*self.commands()["draws"][:3], "--draws", "400"]
        alone = self.result(0, command)
        draw = random.Random(11)
        killed = 0
        for moment in range(3):
            log = f"killed{moment}.log"
            killed += self.killed_run(0, command, log, 0.3 + draw.random())
            with self.subTest(moment=moment):
                self.assertEqual(self.result(0, command, ["--resume", log]), alone)
        self.assertGreater(killed, 0)

    def test_a_killed_process_ends_all_and_nothing_finished_is_lost(self):
        self.needs_processes()
        command = [*self.commands()["draws"][:3], "--draws", "500"]
        alone = self.result(0, command)
        draw = random.Random(12)
        for moment in range(3):
            log, finished, victim = self.folder / f"rank{moment}.log", draw.randrange(50, 350), draw.randrange(2)
            with self.subTest(moment=moment, finished=finished, victim=victim):
                with subprocess.Popen(started(2, *command, "--resume", log, "--threads", "1"), cwd=self.folder,
                                      env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                    while process.poll() is None and (not log.exists() or log.read_bytes().count(b"\nresult ") < finished):
                        time.sleep(0.01)
                    children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True)
                    os.kill(int(children.stdout.split()[victim]), signal.SIGKILL)
                    self.assertNotEqual(process.wait(20), 0)
                self.assertGreaterEqual(log.read_bytes().count(b"\nresult "), finished - 1)
                again = run(self.folder, 0, *command, "--resume", log, "--json", "--verbose")
                self.assertEqual(without_times(json.loads(again.stdout)), alone)
                self.assertGreaterEqual(int(re.search(r"(\d+) known before", again.stderr)[1]), finished - 1)

    def test_shares_of_a_job_array_are_merged(self):
        command = self.commands()["draws"]
        alone = self.result(0, command)
        parts = []
        for part in (1, 2, 3):
            parts.append(f"part{part}.log")
            done = run(self.folder, 0, *command, "--shard", f"{part}/3", "--resume", parts[-1])
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("of 40 draws are in the log", done.stdout)
        missing = run(self.folder, 0, "merge", *parts[:2], "-o", "whole.log")
        self.assertEqual(missing.returncode, 1)
        self.assertRegex(missing.stderr, r"no part has these draws: 2, 5, 8, .* \(13 in all\)")
        self.assertEqual(run(self.folder, 0, "merge", *parts, "-o", "whole.log").returncode, 0)
        self.assertEqual(self.result(0, command, ["--resume", "whole.log"]), alone)
        other = run(self.folder, 0, *command, "--exact", "--resume", "whole.log")
        self.assertEqual(other.returncode, 2)
        self.assertIn("whole.log: is of another computation", other.stderr)

    def test_what_cannot_be_shared_says_so_in_one_line(self):
        self.needs_processes()
        observe = run(self.folder, 2, "observe", "kr270/problem.yaml")
        self.assertNotEqual(observe.returncode, 0)
        self.assertEqual(observe.stderr.count("posewright: "), 1, observe.stderr)
        self.assertIn("observe runs in one process", observe.stderr)

    def test_without_mpi_one_line_says_so(self):
        alone = self.folder / "bin" / "posewright"
        alone.parent.mkdir(exist_ok=True)
        shutil.copy(PROGRAM, alone)
        done = subprocess.run([alone, *self.commands()["draws"]], cwd=self.folder, capture_output=True, text=True,
                              env={**ENVIRONMENT, "OMPI_COMM_WORLD_SIZE": "2"})
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("started as one of 2 processes", done.stderr)


if __name__ == "__main__":
    unittest.main()
