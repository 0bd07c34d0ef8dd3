"""Commands whose work several processes share: several_processes.py PROGRAM SOURCE [CASES].

The same files from one process and from several; the same after processes were killed; one line where it cannot be.
CASES of unittest, as python3 -m unittest takes them. Runs on one machine; nothing here knows of a network.
"""

import json
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

    def the_same_in_any_number_of_processes(self, *command, more=lambda: None):
        alone = self.result(0, command), more()
        for processes in (1, 2, 3, 5):
            with self.subTest(command=command[0], processes=processes):
                self.assertEqual((self.result(processes, command, ["--threads", "1"]), more()), alone)

    def test_places_are_shared(self):
        self.needs_processes()
        shutil.copytree(SOURCE / "examples" / "cell", self.folder / "cell")
        self.the_same_in_any_number_of_processes("stations", "cell/problem.yaml", "--poses", "10", "--candidates", "150",
                                                 "--full", "1")

    def test_robots_of_a_fleet_are_shared(self):
        self.needs_processes()
        shutil.copytree(SOURCE / "examples" / "delta", self.folder / "delta")
        self.the_same_in_any_number_of_processes("fleet", "delta/problem.yaml", "kr270/elastostatic.yaml", "--poses", "8",
                                                 "--restarts", "1", "--output-dir", ".", more=self.files_of_fleet)

    def test_variants_of_a_comparison_are_shared(self):
        self.needs_processes()
        self.the_same_in_any_number_of_processes("compare", "kr270/elastostatic.yaml", "--poses", "20", "--candidates",
                                                 "150", "--restarts", "1")

    def test_drawn_robots_of_a_plan_are_shared(self):
        self.needs_processes()
        self.the_same_in_any_number_of_processes("plan", "instruments/camera_on_hand.yaml", "--method", "greedy", "--candidates", "120",
                                                 "--robust", "12", "--robust-measure", "tail 0.25", "-o", "-", "--poses-csv", "-")

    def test_restarts_and_boxes_of_a_plan_are_shared(self):
        self.needs_processes()
        files = ["-o", "-", "--poses-csv", "-"]
        self.the_same_in_any_number_of_processes("plan", "kr270/problem.yaml", "--method", "tabu", "--restarts", "5",
                                                 "--candidates", "200", "--proof-time", "0", *files)
        # Six axes: boxes that take some milliseconds each.
        shutil.copytree(SOURCE / "examples" / "telescope", self.folder / "telescope")
        boxes = ["plan", "telescope/problem.yaml", "--variant", "rigid", "--method", "greedy", "--candidates", "1000",
                 "--poses", "30", "--gap", "50", *files]
        alone = self.result(0, boxes)
        self.assertGreater(alone["certificate"]["workspace"]["boxes"], 100)
        done = run(self.folder, 3, *boxes, "--json", "--verbose", "--threads", "1")
        self.assertEqual(without_times(json.loads(done.stdout)), alone)
        self.assertGreater(int(re.search(r"(\d+) tasks done", done.stderr)[1]), 100)

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
        for moment in range(5):
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
        for moment in range(5):
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
