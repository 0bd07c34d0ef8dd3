"""What the program writes is what the schemas say: check_output_schemas.py PROGRAM."""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import sources
from schemas import SCHEMAS, closed, errors

CLOSED = closed(SCHEMAS)
EXAMPLES = sources.ROOT / "examples"
QUICK = ["--method", "exchange", "--restarts", "1"]
program = ""

SMALLEST = """posewright: 1
robot:
  model: five_bar
  encoder_noise: "0.005 deg"
  legs:
    - {base: ["-150 mm", 0], proximal: "250 mm", distal: "350 mm", elbow: left}
    - {base: ["150 mm", 0],  proximal: "250 mm", distal: "350 mm", elbow: right}
  range: {x: ["-200 mm", "200 mm"], y: ["250 mm", "500 mm"]}
measurement: {type: joints, device: {type: isotropic, noise: "0.01 deg"}}
variants:
  all: {parameters: ["leg_?.proximal", "leg_?.distal", "leg_?.offset", "leg_?.sensor_offset"], tolerance: {"*offset": "0.5 deg"}}
  few: {parameters: ["leg_?.proximal", "leg_?.offset"]}
design: {variant: all, poses: auto, candidates: 300, require: {sigma: {"*": "0.2 mm", "*offset": "0.02 deg"}}, test_poses: {random: 5}}
"""


class Outputs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "smallest.yaml").write_text(SMALLEST)

    def run_program(self, *words):
        run = subprocess.run([program, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def check(self, schema, document):
        self.assertEqual(errors(f"{schema}.schema.json", document), [])
        self.assertEqual(errors(f"{schema}.schema.json", document, CLOSED), [], "a key is missing in the schema")
        self.assertNotEqual(errors(f"{schema}.schema.json", {**document, "schema": "other"}), [])

    def test_plans_of_arms_and_platforms(self):
        for words in (["telescope/problem.yaml", "--candidates", 100, *QUICK], ["delta/problem.yaml", "--candidates", 100, "--reserve", *QUICK],
                      ["kr270/compensator.yaml", "--candidates", 60, *QUICK, "--prior", "tolerance"]):
            self.check("plan", self.run_program("plan", EXAMPLES / words[0], *words[1:], "--json"))

    def test_a_list_of_instruments(self):
        problem = EXAMPLES / "instruments/tracker_and_camera.yaml"
        plan = self.run_program("plan", problem, "--candidates", 300, "--restarts", 1, "--json")
        self.check("plan", plan)
        self.assertEqual({pose["instrument"] for pose in plan["poses"]}, {"tracker", "camera"})
        self.assertAlmostEqual(sum(one["share"] for one in plan["instruments"]) + plan["prior_share"], 1, 12)
        (self.folder / "plan.json").write_text(json.dumps(plan))
        self.check("evaluation", self.run_program("evaluate", problem, "plan.json", "--candidates", 300, "--json"))
        # Without tolerances the simulated robot is the nominal one, so many an estimate is worse and refused; not of this seed.
        self.run_program("simulate", problem, "plan.json", "--draws", 2, "--exact", "--data", "data.csv", "--seed", 3, "--json")
        calibration = self.run_program("calibrate", problem, "data.csv", "--json")
        self.check("calibration", calibration)
        self.assertEqual([one["name"] for one in calibration["instruments"]], ["tracker", "camera"])

    def test_plans_against_a_truth(self):
        telescope = [EXAMPLES / "telescope/problem.yaml", "--truth", "matrix", "--poses", 20, "--candidates", 60]
        for criterion in ("discriminate", "bias", "o1"):
            plan = self.run_program("plan", *telescope, "--criterion", criterion, *QUICK, "--json")
            self.assertEqual(plan["discrimination"]["truth"], "matrix")
            self.check("plan", plan)

    def test_plan_with_the_smallest_number_of_poses_and_one_for_several_variants(self):
        plan = self.run_program("plan", "smallest.yaml", "--json")
        self.assertTrue(plan["curve"])
        self.check("plan", plan)
        plan = self.run_program("plan", "smallest.yaml", "--poses", 8, "--criterion", "compound", "--json")
        self.assertTrue(plan["variants"])
        self.check("plan", plan)
        self.check("plan", self.run_program("plan", "smallest.yaml", "--poses", 8, "--criterion", "o3", "--json"))

    def test_plan_at_calibrated_parameters(self):
        (self.folder / "cal.yaml").write_text("posewright_parameters: 1\nvariant: all\nparameters: {leg_1.distal: {value: 0.355}}\n")
        plan = self.run_program("plan", "smallest.yaml", "--poses", 8, "--parameters", "cal.yaml", "--json")
        self.assertEqual(plan["problem"]["parameters"]["variant"], "all")
        self.check("plan", plan)

    def test_selection_of_blocks(self):
        rows = ["%g,%g" % ((7 * i) % 11 - 5, (5 * i) % 13 - 6) for i in range(40)]
        (self.folder / "blocks.csv").write_text("\n".join(rows) + "\n")
        self.check("plan", self.run_program("select", "blocks.csv", "--rows", 2, "--poses", 4, "--json"))

    def test_evaluation(self):
        problem = EXAMPLES / "delta/problem.yaml"
        self.run_program("plan", problem, "--candidates", 200, *QUICK, "--json")
        evaluation = self.run_program("evaluate", problem, "poses.csv", "--candidates", 200, *QUICK, "--drop", 2, "--add", 1, "--json")
        self.assertEqual(len(evaluation["drop"]["poses"]), 2)
        self.assertEqual(len(evaluation["add"]["poses"]), 1)
        self.check("evaluation", evaluation)

    def test_observation(self):
        self.check("observation", self.run_program("observe", EXAMPLES / "telescope/problem.yaml", "--candidates", 300, "--json"))

    def test_comparison(self):
        text = (EXAMPLES / "telescope/problem.yaml").read_text()
        both = "  both: {parameters: [kappa, K_11, K_22, K_33, K_44, K_55, K_66]}\n"
        (self.folder / "both.yaml").write_text(text.replace("  # To see what", both + "  # To see what"))
        words = ["--variant", "rigid,matrix,both", "--candidates", 60, "--method", "exchange"]
        comparison = self.run_program("compare", "both.yaml", *words, "--restarts", 1, "--poses", 16, "--json")
        self.assertEqual(len(comparison["scores"]), 2 * 3)
        self.assertTrue(comparison["variants"][2]["why_not"])
        self.check("comparison", comparison)
        self.run_program("plan", "smallest.yaml", "--poses", 8, "--json")
        self.check("comparison", self.run_program("compare", "smallest.yaml", "plan.json", "poses.csv", "--truth", "all", "--json"))

    def test_calibration(self):
        rows = ["id,q2 [deg],P0.x [mm],P0.y [mm],P0.z [mm],P1.x [mm],P1.y [mm],P1.z [mm],use"]
        for k in range(30):
            q = -140 + 5 * (k // 2)
            noise = [0.1 * ((7 * k + 3 * i) % 11 - 5) / 3 for i in range(6)]
            pins = [-686.4, -123.1, 0, 184.9 * math.sin(math.radians(q)), 184.9 * math.cos(math.radians(q)), 0]
            cells = ["" if k == 4 and i == 5 else f"{p + n:.4f}" for i, (p, n) in enumerate(zip(pins, noise))]
            rows.append(",".join([str(k // 2 + 1), str(q), *cells, "validate" if k > 23 else "fit"]))
        (self.folder / "data.csv").write_text("\n".join(rows) + "\n")
        for weights in ("ols", "wls", "robust"):
            calibration = self.run_program("calibrate", EXAMPLES / "kr270/compensator_geometry.yaml", "data.csv", "--weights", weights, "--json")
            self.assertEqual(calibration["poses_held_back"], 3)
            self.assertAlmostEqual(calibration["parameters"][0]["value"], 0.1849, 3)
            self.check("calibration", calibration)

    def test_compensation(self):
        problem = EXAMPLES / "kr270/problem.yaml"
        values = "{joint_a2.x: {value: 0.3502}, joint_a4.offset: {value: 0.001}}"
        (self.folder / "cal.yaml").write_text(f"posewright_parameters: 1\nvariant: geometric\nparameters: {values}\n")
        self.run_program("plan", problem, "--candidates", 60, *QUICK, "--json")
        words = ["compensate", "cal.yaml", "--problem", problem]
        self.check("compensation", self.run_program(*words, "plan.json", "-o", "commanded.json", "--dh", "distal", "--json"))
        self.check("plan", json.loads((self.folder / "commanded.json").read_text()))
        (self.folder / "poses.csv").write_text("\n".join(["joint_a1,joint_a2,joint_a3,joint_a4,joint_a5,joint_a6", "0,-1,1,0.1,0.5,0", "0,-1,1,6.1086,0.5,0"]))
        run = subprocess.run([program, *map(str, words), "poses.csv", "--json"], cwd=self.folder, capture_output=True, text=True)
        self.assertLessEqual(run.returncode, 1, run.stderr)
        self.check("compensation", json.loads(run.stdout))
        gough = EXAMPLES / "gough/problem.yaml"
        (self.folder / "cal.yaml").write_text("posewright_parameters: 1\nvariant: geometry\nparameters: {leg_1.l: {value: 0.4501}}\n")
        (self.folder / "poses.csv").write_text("x,y,z,rx,ry,rz\n0.01,0.02,0.01,0.05,0,0.1\n")
        result = self.run_program("compensate", "cal.yaml", "poses.csv", "--problem", gough, "--json")
        self.assertIn("leg_1.rho", result["lists"][0]["poses"][0]["actuators"])
        self.check("compensation", result)

    def test_calibrations(self):
        text = (EXAMPLES / "kr270/elastostatic.yaml").read_text().replace("urdf: kr270", f"urdf: {EXAMPLES}/kr270/kr270")
        small = "tolerance: {\"*.compliance*\": 0.03 urad/Nm}"
        few = f"  few: {{parameters: [\"joint_a2.compliance@*\"], {small}}}\n"
        (self.folder / "e.yaml").write_text(text.replace("  all:\n", few + "  all:\n")
                                            .replace("    fixed: [joint_a1", f"    {small}\n    fixed: [joint_a1")
                                            .replace("design: {", "design: {require: {position: {z: 1 mm}, rotation: 0.1 deg}, "))
        self.run_program("plan", "e.yaml", "--candidates", 200, "--method", "exchange", "--restarts", 1, "--json")
        self.run_program("simulate", "e.yaml", "plan.json", "--draws", 2, "--data", "readings.csv", "--json")
        both = ["calibrate", "e.yaml", "readings.csv", "--hold-back", 3, "--in-steps", "--json"]
        calibration = self.run_program(*both, "--variant", "compliances")
        self.check("calibration", calibration)
        self.assertEqual(calibration["compensator"]["freedom"], 2)
        # One target tells nothing of a rotation.
        self.assertEqual([(r["axis"], r["poses"]) for r in calibration["requirements"]], [("z", "fitted"), ("z", "held back")])
        self.assertTrue(any("not checked: rx, ry, rz" in note for note in calibration["notes"]))
        models = self.run_program(*both, "--variant", "compliances,few")
        self.check("calibrations", models)
        self.assertEqual([m["variant"] for m in models["models"]], ["compliances", "few"])
        (self.folder / "k2.csv").write_text("joint_a2 [deg],compliance [urad/Nm],sigma [urad/Nm]\n"
                                            "-0.01,0.297,0.005\n-25.2,0.287,0.006\n-56.9,0.315,0.009\n-99.8,0.302,0.016\n-140,0.251,0.01\n")
        self.check("compensator", self.run_program("calibrate", "e.yaml", "k2.csv", "--json"))

    def test_simulation(self):
        self.run_program("plan", "smallest.yaml", "--poses", 8, "--json")
        words = ["simulate", "smallest.yaml", "plan.json", "--draws", 20, "--json"]
        self.check("simulation", self.run_program(*words, "--data", "readings.csv"))
        self.assertGreater(len((self.folder / "readings.csv").read_text().splitlines()), 8)
        self.check("simulation", self.run_program(*words, "--variant", "few", "--truth", "all", "--weights", "robust", "--missing", 0.1))

    def test_next(self):
        problem = EXAMPLES / "kr270/problem.yaml"
        words = ["next", problem, "--data", "measured.csv", "--candidates", 60, "-k", 2, "--result", "next.json", "--json"]
        first = self.run_program(*words)
        self.assertEqual(first["verdict"], "not_determined")
        self.check("next", first)
        self.run_program("plan", problem, "--candidates", 60, *QUICK, "--json")
        self.run_program("simulate", problem, "plan.json", "--draws", 2, "--data", "measured.csv", "--json")
        second = self.run_program(*words, "--required", "1 mm")
        self.assertEqual((second["verdict"], len(second["history"])), ("reached", 2))
        self.check("next", second)
        self.check("next", json.loads((self.folder / "next.json").read_text()))

    def test_fleet_with_a_robot_that_cannot_be_planned(self):
        few = SMALLEST.replace("candidates: 300", "candidates: 2").replace("poses: auto", "poses: 8")
        (self.folder / "few.yaml").write_text(few)
        run = subprocess.run([program, "fleet", "smallest.yaml", "few.yaml", "--poses", "8", "--restarts", "1", "--json"],
                             cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 1, run.stderr)
        fleet = json.loads(run.stdout)
        self.assertEqual(["why_not" in plan for plan in fleet["plans"]], [False, True])
        self.check("fleet", fleet)
        self.check("plan", json.loads((self.folder / fleet["plans"][0]["plan"]).read_text()))

    def test_plan_route_and_stations_of_a_cell(self):
        cell = self.folder / "cell.yaml"
        text = (EXAMPLES / "cell/problem.yaml").read_text().replace("../kr270/", f"{EXAMPLES}/kr270/")
        cell.write_text(text.replace("reachable: true", "reachable: false").replace("points: [3, 3, 1]", "points: [2, 1, 1]"))
        plan = self.run_program("plan", cell, "--candidates", 60, "--poses", 8, *QUICK, "--json")
        self.assertIn("targets", plan["poses"][0])
        self.check("plan", plan)
        self.check("route", self.run_program("route", "plan.json", "--from-home", "--closed", "--json"))
        self.check("poses", self.run_program("export", "route.json", "--to", "json", "-o", "-"))
        ranking = self.run_program("stations", cell, "--full", 0, "--poses", 8, "--json")
        self.check("stations", ranking)


class ProblemSchema(unittest.TestCase):
    def test_has_the_criteria_and_methods_of_the_program(self):
        design = SCHEMAS["problem.schema.json"]["$defs"]["design"]["properties"]
        for option in ("criterion", "method"):
            run = subprocess.run([program, "plan", EXAMPLES / "delta/problem.yaml", f"--{option}", "nothing"],
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, 2)
            self.assertEqual(run.stderr.strip().split("available: ")[1].split(", "), design[option]["enum"])


if __name__ == "__main__":
    program = sys.argv.pop(1)
    unittest.main()
