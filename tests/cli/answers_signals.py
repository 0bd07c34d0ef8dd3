"""Commands that take long, ended at a stage that their progress names: answers_signals.py PROGRAM SOURCE.

Each answers soon (the bound is wide: a loaded machine is slow), with the documented code and with what it has.
bench/interrupts.py measures how soon.
"""

import json
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
SOON = 15.0  # s; on a quiet machine it is below one
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="signals-"))


def setUpModule():
    text = (SOURCE / "examples/cell/problem.yaml").read_text()
    text = re.sub(r"^design:.*$", "design: {poses: 12, candidates: 600, restarts: 1, method: exchange}", text, flags=re.M)
    text = text.replace("../", f"{SOURCE / 'examples'}/")
    (FOLDER / "problem.yaml").write_text(text)
    two = text.replace("variants:\n", 'variants:\n  fewer: {parameters: auto, nuisance: ["base.*", "target.*"], fixed: ["joint_a3.*"]}\n')
    (FOLDER / "two.yaml").write_text(two.replace("reachable: true", "reachable: false"))
    done = subprocess.run([PROGRAM, "plan", "problem.yaml", "--quiet", "--poses-csv", "-"], cwd=FOLDER,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def tearDownModule():
    shutil.rmtree(FOLDER)


class Answers(unittest.TestCase):
    def ended(self, words, stage, how):
        """Output of a command that gets a signal when its progress says `stage`, a regular expression."""
        process = subprocess.Popen([PROGRAM, *words, "--verbose"], cwd=FOLDER, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        begin, told = time.monotonic(), []
        for line in process.stderr:
            if not told:
                self.assertLess(time.monotonic() - begin, SOON, "nothing was told")
            told.append(line)
            if re.match(stage, line):
                break
        else:
            self.fail(f"{words}: no stage {stage} in {told}; exit {process.wait()}")
        asked = time.monotonic()
        process.send_signal(how)
        out, err = process.communicate()
        self.assertLess(time.monotonic() - asked, SOON, words)
        self.assertEqual(process.returncode, 130, err)
        return out, err

    def test_stations_rank_what_was_looked_at(self):
        out, _ = self.ended(["stations", "problem.yaml", "--json"], "places [1-9]", signal.SIGTERM)
        result = json.loads(out)
        self.assertTrue(result["interrupted"])
        planned = [rank for rank in result["ranking"] if "why_not" not in rank]
        self.assertEqual([rank["looked_at"] for rank in planned], [True] * len(planned))
        self.assertTrue(any(not rank["looked_at"] for rank in result["ranking"]))
        self.assertGreaterEqual(len(planned), 1)
        self.assertFalse(any(rank["in_full"] for rank in planned))
        phi = [rank["phi"] for rank in planned if rank["parameters"] == planned[0]["parameters"]]
        self.assertEqual(phi, sorted(phi, reverse=True))
        whole = subprocess.run([PROGRAM, "stations", "problem.yaml", "--json", "--full", "0", "--quiet"], cwd=FOLDER,
                               capture_output=True, text=True)
        whole = json.loads(whole.stdout)
        self.assertFalse(whole["interrupted"])
        self.assertEqual(len(result["ranking"]), len(whole["ranking"]))
        # What was looked at is what it is in a whole run.
        by_name = {tuple(rank["stations"]): rank for rank in whole["ranking"]}
        for rank in planned:
            self.assertEqual(rank["phi"], by_name[tuple(rank["stations"])]["phi"])

    def test_stations_keep_quick_plans_where_no_full_one_is_done(self):
        out, _ = self.ended(["stations", "problem.yaml"], "full plans", signal.SIGINT)
        self.assertRegex(out, r"Ended early: (\d+) of \1 scored, [0-2] planned in full\.")

    def test_a_route_keeps_its_order_and_motions(self):
        out, err = self.ended(["route", "plan.json", "--closed", "-o", "early.json"], "clearance", signal.SIGHUP)
        self.assertIn("Written: early.json", out)
        self.assertIn("left out", err)
        early = json.loads((FOLDER / "early.json").read_text())
        whole = subprocess.run([PROGRAM, "route", "plan.json", "--closed", "-o", "-", "--json", "--quiet"], cwd=FOLDER,
                               capture_output=True, text=True)
        whole = json.loads(whole.stdout)
        self.assertEqual(early["order"], whole["order"])
        self.assertEqual([m["points"] for m in early["motions"]], [m["points"] for m in whole["motions"]])

    def test_a_report_says_what_is_left_out(self):
        self.ended(["report", "plan.json", "-o", "early.html"], "other numbers of poses", signal.SIGTERM)
        page = (FOLDER / "early.html").read_text()
        self.assertIn("Stopped early: some numbers of poses are left out", page)

    def test_an_evaluation_has_the_score_and_a_true_bound(self):
        words = ["evaluate", "problem.yaml", "plan.json", "--drop", "2", "--json"]
        out, err = self.ended(words, "certificate", signal.SIGINT)
        early = json.loads(out)
        self.assertIn("ended early", err)
        whole = json.loads(subprocess.run([PROGRAM, *words, "--quiet"], cwd=FOLDER, capture_output=True, text=True).stdout)
        scores = {score["criterion"]: score for score in whole["scores"]}
        self.assertGreaterEqual(len(early["scores"]), 1)
        for score in early["scores"]:
            self.assertEqual(score["value"], scores[score["criterion"]]["value"])
            if score["efficiency"] is not None:
                self.assertLessEqual(score["efficiency"], scores[score["criterion"]]["efficiency"] + 1e-9)

    def test_a_time_limit_that_starts_use_up_is_followed_by_no_more_work(self):
        draw = random.Random(1)
        (FOLDER / "blocks.csv").write_text("\n".join(",".join(str(draw.gauss(0, 1)) for _ in range(8)) for _ in range(300)) + "\n")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([PROGRAM, "select", "blocks.csv", "--rows", "1", "--poses", "12", "--time-limit", "1", "--threads", "2", "-o", "-", "--quiet"],
                              cwd=FOLDER, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        # Of the processor, which other programs do not lengthen: two threads for the limit, and what comes before and after it.
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, 2 + 2)

    def test_a_comparison_has_the_variants_that_are_done(self):
        words = ["compare", "two.yaml", "--variant", "geometric,fewer", "--json"]
        out, _ = self.ended(words, "fewer: workspace bound", signal.SIGTERM)
        early = json.loads(out)
        self.assertTrue(early["interrupted"])
        self.assertEqual(early["not_planned"], ["fewer"])
        self.assertEqual([plan["searched_for"] for plan in early["plans"]], ["geometric"])
        self.assertEqual((early["aliases"], early["worth"]), ([], []))
        whole = json.loads(subprocess.run([PROGRAM, *words, "--quiet"], cwd=FOLDER, capture_output=True, text=True).stdout)
        self.assertFalse(whole["interrupted"])
        figures = ["plan", "variant", "log_det", "mean_sigma_per_tolerance"]
        self.assertEqual([[score[key] for key in figures] for score in early["scores"]],
                         [[score[key] for key in figures] for score in whole["scores"][:2]])

    def test_a_comparison_that_has_no_plan_says_nothing(self):
        out, _ = self.ended(["compare", "two.yaml", "--variant", "geometric"], "geometric: workspace bound", signal.SIGINT)
        self.assertEqual(out, "")

    def test_a_time_limit_that_is_too_short_says_so(self):
        for words in (["route", "plan.json", "-o", "no.json"], ["report", "plan.json", "-o", "no.html"],
                      ["stations", "problem.yaml"]):
            done = subprocess.run([PROGRAM, *words, "--time-limit", "0.01"], cwd=FOLDER, capture_output=True, text=True)
            self.assertEqual(done.returncode, 1, words)
            self.assertIn("stopped before", done.stderr)
        self.assertEqual([p.name for p in FOLDER.glob("no.*")], [])


if __name__ == "__main__":
    unittest.main()
