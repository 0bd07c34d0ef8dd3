#!/usr/bin/env python3
"""kept_candidates.py PROGRAM SOURCES: observe, plan, evaluate, route and report of a cell print and write the same with
and without kept candidates, with a damaged or unwritable folder, and two at a time. No file comes beside the problem."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

program, sources = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:3])
cell = pathlib.Path(sources) / "examples" / "cell" / "problem.yaml"
names = {"POSEWRIGHT_CACHE", "XDG_CACHE_HOME"}


def without_seconds(value):
    """Copy without times and the names of the files beside a plan."""
    if isinstance(value, dict):
        return {key: without_seconds(part) for key, part in value.items() if "seconds" not in key and key != "files"}
    return [without_seconds(part) for part in value] if isinstance(value, list) else value


class KeptCandidates(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="posewright-kept-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.cache = self.folder / "cache"
        (self.folder / "cell").mkdir()
        (self.folder / "kr270").mkdir()
        shutil.copy(cell, self.folder / "cell")
        shutil.copy(cell.parent.parent / "kr270" / "kr270.urdf", self.folder / "kr270")
        self.problem = self.folder / "cell" / "problem.yaml"

    def start(self, *words, **variables):
        environment = {key: value for key, value in os.environ.items() if key not in names}
        environment.update({"POSEWRIGHT_CACHE": str(self.cache)} if not variables else variables)
        return subprocess.Popen([program, *map(str, words)], cwd=self.folder, env=environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run_program(self, *words, **variables):
        process = self.start(*words, **variables)
        out, err = process.communicate()
        self.assertEqual(process.returncode, 0, err)
        return out

    def plan(self, *more, name="plan", **variables):
        file = self.folder / f"{name}.json"
        self.run_program("plan", self.problem, "--poses", 14, "--candidates", 400, "--restarts", 1, "--method", "exchange",
                         "--criterion", "o1", "--force", "-o", file, *more, **variables)
        return without_seconds(json.loads(file.read_text()))

    def kept(self):
        return sorted(self.cache.glob("*.result")) if self.cache.exists() else []

    def test_each_command_prints_and_writes_the_same(self):
        anew = self.plan("--no-cache")
        self.assertEqual(self.kept(), [])
        self.assertEqual(self.plan(), anew)
        self.assertEqual(len(self.kept()), 1)
        before = self.kept()[0].stat().st_mtime_ns
        self.assertEqual(self.plan(), anew)
        self.assertEqual(len(self.kept()), 1)
        self.assertGreater(self.kept()[0].stat().st_mtime_ns, before)  # it was used
        design = ["--set", "design.candidates=400", "--set", "design.criterion=o1"]
        for words in (["observe", self.problem, "--candidates", 400, "--json"],
                      ["evaluate", self.problem, "plan.json", "--candidates", 400, "--criterion", "o1", "--json"],
                      ["report", "plan.json", "--json"]):
            with self.subTest(words[0]):
                found = [without_seconds(json.loads(self.run_program(*words, *more)))
                         for more in (["--no-cache"], [], [])]
                self.assertEqual(found[1], found[0])
                self.assertEqual(found[2], found[0])
        self.assertEqual(sorted(file.name for file in self.problem.parent.iterdir()), ["problem.yaml"])

    def test_a_damaged_or_foreign_file_does_no_harm(self):
        anew = self.plan()
        (file,) = self.kept()
        whole = file.read_bytes()
        for damaged in (b"", whole[:1000], whole[:-1] + bytes([whole[-1] ^ 1])):
            file.write_bytes(damaged)
            self.assertEqual(self.plan(), anew)
            self.assertEqual(file.read_bytes(), whole)
        file.write_bytes(b"somebody's letter")
        self.assertEqual(self.plan(), anew)
        self.assertEqual(file.read_bytes(), b"somebody's letter")

    def test_a_folder_that_cannot_be_written_is_no_error(self):
        anew = self.plan("--no-cache")
        self.cache.mkdir()
        self.cache.chmod(0o500)
        self.assertEqual(self.plan(), anew)
        self.cache.chmod(0o700)
        for place in ("/proc/self/here", str(self.problem), "relative", ""):
            self.assertEqual(self.plan(POSEWRIGHT_CACHE=place), anew)
        self.assertFalse((self.folder / "relative").exists())

    def test_the_folder_is_the_users_cache(self):
        anew = self.plan("--no-cache")
        self.assertEqual(self.plan(XDG_CACHE_HOME=str(self.folder / "xdg")), anew)
        self.assertEqual(len(list((self.folder / "xdg" / "posewright").glob("*.result"))), 1)
        self.assertEqual(self.plan(HOME=str(self.folder / "home")), anew)
        self.assertEqual(len(list((self.folder / "home" / ".cache" / "posewright").glob("*.result"))), 1)

    def test_two_at_a_time_and_one_that_is_killed(self):
        anew = self.plan("--no-cache")
        words = ["plan", self.problem, "--poses", 14, "--candidates", 400, "--restarts", 1, "--method", "exchange",
                 "--criterion", "o1", "-o"]
        both = [self.start(*words, self.folder / f"{k}.json") for k in "ab"]
        killed = self.start(*words, self.folder / "c.json")
        killed.kill()
        for process in (*both, killed):
            process.communicate()
        self.assertEqual([process.returncode for process in both], [0, 0])
        for k in "ab":
            self.assertEqual(without_seconds(json.loads((self.folder / f"{k}.json").read_text())), anew)
        self.assertEqual(len(self.kept()), 1)
        self.assertEqual(self.plan(), anew)

    def test_a_changed_clearance_draws_anew(self):
        self.plan()
        text = self.problem.read_text()
        self.problem.write_text(text.replace('clearance: "30 mm"', 'clearance: "31 mm"'))
        anew = self.plan("--no-cache")
        self.assertEqual(self.plan(), anew)
        self.assertEqual(len(self.kept()), 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
