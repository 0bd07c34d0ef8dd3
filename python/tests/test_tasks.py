"""Simulate, calibrate, compare, stations, report, export: what the command line says, and files that it reads."""
import json

import numpy as np
import pytest

import posewright as pw


def without_seconds(value):
    if isinstance(value, dict):
        return {k: without_seconds(v) for k, v in value.items() if k != "seconds"}
    return [without_seconds(v) for v in value] if isinstance(value, list) else value


@pytest.fixture(scope="module")
def simulated(kr270, small_plan):
    return pw.simulate(kr270, small_plan, draws=5, exact=True)


@pytest.fixture(scope="module")
def data(simulated, tmp_path_factory):
    file = tmp_path_factory.mktemp("measured") / "measured.csv"
    file.write_text(simulated.first_readings)
    return file


def test_simulate_says_what_the_command_line_says(program, kr270, small_plan, simulated, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    theirs = program("simulate", kr270.file, tmp_path / "plan.json", "--draws", 5, "--exact")
    mine = simulated.to_dict()
    mine["plan"] = theirs["plan"]  # a plan in memory has no file
    assert without_seconds(mine) == without_seconds(theirs)
    assert isinstance(simulated.confirmed, bool) and simulated.verdict and simulated.summary()


def test_calibrate_says_what_the_command_line_says_and_writes_its_parameters_file(program, kr270, data, tmp_path):
    theirs = program("calibrate", kr270.file, data, "-o", tmp_path / "theirs.yaml", "--force")
    mine = pw.calibrate(kr270, data)
    # The command's notes say besides what it wrote.
    assert {k: v for k, v in mine.to_dict().items() if k != "notes"} == {k: v for k, v in theirs.items() if k != "notes"}
    assert set(mine.values) == set(mine.sigma) == set(mine.columns)
    assert np.allclose(np.sqrt(np.diag(mine.covariance)), [mine.sigma[name] for name in mine.columns])
    assert mine.parameters_file() == (tmp_path / "theirs.yaml").read_text()
    mine.save(tmp_path / "mine.yaml", force=True)
    with pytest.raises(FileExistsError):
        mine.save(tmp_path / "mine.yaml", force=True)


def test_a_problem_at_calibrated_parameters_has_their_values(kr270, data, tmp_path):
    found = pw.calibrate(kr270, data)
    found.save(tmp_path / "parameters.yaml", force=True)
    with pytest.warns(RuntimeWarning, match="parameters of another kind"):
        again = pw.Problem(kr270.file, parameters=tmp_path / "parameters.yaml")
    label = {p.name: p for p in pw.Model(again, found.variant, list(found.values)).parameters}
    for name, value in found.values.items():
        assert label[name].nominal == pytest.approx(value, rel=1e-12, abs=1e-15)


def test_compare_says_what_the_command_line_says(program, kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    settings = ["--candidates", 60]
    theirs = program("compare", kr270.file, tmp_path / "plan.json", *settings)
    mine = pw.compare(kr270, {str(tmp_path / "plan.json"): tmp_path / "plan.json"}, candidates=60)
    assert mine.to_dict() == theirs and mine.summary()
    page = mine.to_html()
    data = json.loads(page.split('id="report-data">')[1].split("</script>")[0])
    assert data["schema"] == "posewright/report-of-result/1" and data["result"] == theirs
    with pytest.raises(pw.InputError):
        pw.compare(kr270, {"a": small_plan}, poses=3)


def test_a_report_holds_the_plan_and_is_a_page(kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    report = pw.report(kr270, tmp_path / "plan.json", brief=True)
    assert json.loads(report.to_json())["schema"] == "posewright/report/1"
    report.save(tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text().lstrip().lower().startswith("<!doctype html")


def test_exported_files_are_those_of_the_command_line(program, kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    made = pw.export(small_plan, "abb-rapid", kr270, speed=10, coupling=0)
    assert pw.export(tmp_path / "plan.json", "abb-rapid", kr270, speed=10, coupling=0).files == made.files
    files = made.save(tmp_path)
    assert [file.read_bytes() for file in files] == list(made.files.values()) and made.notes
    theirs = tmp_path / "theirs" / files[0].name
    theirs.parent.mkdir()
    program("export", tmp_path / "plan.json", "--problem", kr270.file, "--to", "abb-rapid", "--speed", 10, "--coupling", 0, "-o", theirs)
    assert theirs.read_bytes() == files[0].read_bytes()
    with pytest.raises(FileExistsError):
        made.save(tmp_path)


def test_an_export_that_moves_a_robot_is_checked_against_it(kr270, small_plan, tmp_path):
    path = tmp_path / "plan.json"
    small_plan.save(path)
    plan = json.loads(path.read_text())
    plan["poses"][0]["configuration"][0] = 9.0
    path.write_text(json.dumps(plan))
    with pytest.raises(pw.InputError, match="joint_a1"):
        pw.export(path, "abb-rapid", kr270, coupling=0)
    assert "are not checked" in " ".join(pw.export(path, "abb-rapid", coupling=0, unchecked=True).notes)
    for wrong in (lambda: pw.export(small_plan, "abb-rapid", coupling=0), lambda: pw.export(small_plan, "no-such-format"),
                  lambda: pw.export(small_plan, "abb-rapid", kr270, speed=200), lambda: pw.export(3, "abb-rapid", kr270),
                  lambda: pw.export(small_plan, "figaroh", speed=10)):
        with pytest.raises(pw.InputError):
            wrong()
    with pytest.raises(TypeError):
        pw.export(small_plan, "abb-rapid", kr270, sped=10)


def test_a_compensation_is_that_of_the_command_line(program, examples, tmp_path):
    file = tmp_path / "cal.yaml"
    file.write_text("posewright_parameters: 1\nvariant: geometric\n"
                    "parameters: {joint_a2.x: {value: 0.3502}, joint_a3.offset: {value: 0.0004}}\n")
    problem = pw.Problem(examples / "kr270" / "problem.yaml", parameters=file)
    poses = np.array([[0.1, -1.2, 1.0, 0.3, 0.5, 0.2], [-0.4, -0.8, 0.9, -0.6, 0.7, 0.1]])
    result = pw.compensate(problem, poses)
    assert result.compensated == [True, True] and not result.failures and result.actuators is None
    assert np.all(np.abs(result.configurations - poses) < 2e-3) and np.any(result.configurations != poses)
    assert np.all(result.before[:, 0] > 1e-4) and np.all(result.after < 1e-9)
    names = ",".join(f"joint_a{i}" for i in range(1, 7))
    (tmp_path / "poses.csv").write_text(names + "\n" + "\n".join(",".join(map(repr, map(float, row))) for row in poses) + "\n")
    theirs = program("compensate", file, tmp_path / "poses.csv", "--problem", examples / "kr270" / "problem.yaml")
    assert np.array_equal([pose["configuration"] for pose in theirs["lists"][0]["poses"]], result.configurations)
    file_ = pw.compensate(problem, tmp_path / "poses.csv", without_tool=True, dh="distal")
    words = ["--problem", examples / "kr270" / "problem.yaml", "--without-tool", "--dh", "distal", "-o", tmp_path / "out.csv"]
    theirs = program("compensate", file, tmp_path / "poses.csv", *words)
    assert file_.text == (tmp_path / "out.csv").read_text()
    assert file_.to_dict() == {key: value for key, value in theirs.items() if key != "written"} and "denavit_hartenberg" in theirs
    assert pw.compensate(problem, poses, most=0.01).failures == pw.compensate(problem, poses, most="0.01 rad").failures
    with pytest.raises(pw.InputError, match="no calibrated parameters"):
        pw.compensate(pw.Problem(examples / "kr270" / "problem.yaml"), poses)
    with pytest.raises(pw.InputError):
        pw.compensate(problem, poses, most=0)


def test_options_of_a_command_do_the_same_as_keywords(program, kr270, small_plan, data, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    words = ["--draws", 6, "--truth-repeatability", "0.05 mm", "--outliers", 0.1, "--outlier-size", 10, "--no-prior"]
    theirs = {**program("simulate", kr270.file, tmp_path / "plan.json", *words), "plan": "plan"}
    named = dict(draws=6, outliers=0.1, outlier_size=10, no_prior=True)
    for length in (5e-5, "0.05 mm"):
        assert pw.simulate(kr270, small_plan, truth_repeatability=length, **named).to_dict() == theirs
    assert pw.simulate(kr270, small_plan, **named).to_dict() != theirs
    calibration = pw.calibrate(kr270, data, dh="proximal")
    assert calibration.to_dict()["denavit_hartenberg"]
    without = pw.calibrate(kr270, data, no_prior=True)
    assert without.sigma != calibration.sigma and not without.to_dict().get("denavit_hartenberg")
    for wrong in (dict(outlier_size=10), dict(truth_nominal=True), dict(truth_repeatability="5 deg"), dict(draws=2.5)):
        with pytest.raises(pw.InputError, match=next(iter(wrong))):
            pw.simulate(kr270, small_plan, **wrong)
    with pytest.raises(TypeError, match="force"):  # an option of the program alone
        pw.simulate(kr270, small_plan, force=True)


def test_poses_for_validation_come_with_the_plan(kr270):
    plan = pw.plan(kr270, poses=12, candidates=80, restarts=1, validation=3)
    assert len(plan) == 12 and sum(not pose.measured for pose in plan.validation.poses) == 3
    assert pw.plan(kr270, poses=12, candidates=80, restarts=1).validation is None


def test_stations_need_a_number_of_places(examples):
    cell = pw.Problem(examples / "cell" / "problem.yaml")
    with pytest.raises(pw.InputError):
        pw.stations(cell, choose=0)


def test_a_plan_among_given_candidates_takes_only_those(kr270, small_plan):
    plan = pw.plan(kr270, poses=9, candidates_from=small_plan, method="exchange", restarts=1)
    assert all(any(np.allclose(q, p) for p in small_plan.configurations) for q in plan.configurations)


def test_wrong_words_and_numbers_are_refused(kr270, small_plan, data):
    for wrong in (lambda: pw.calibrate(kr270, data, weights="best"), lambda: pw.calibrate(kr270, data, hold_back=1),
                  lambda: pw.simulate(kr270, small_plan, draws=1), lambda: pw.simulate(kr270, small_plan, missing=2),
                  lambda: pw.calibrate(kr270, "no.csv"), lambda: pw.report(kr270, "no.json")):
        with pytest.raises(pw.InputError):
            wrong()


def test_next_poses_says_what_the_command_line_says(program, kr270, data, tmp_path):
    theirs = program("next", kr270.file, "--data", data, "-k", 2, "--candidates", 300, "--required", "0.5mm", "--state",
                     tmp_path / "theirs.json")
    asked = {"poses": 2, "candidates": 300, "required": 0.5e-3, "state": tmp_path / "mine.json"}
    mine = pw.next_poses(kr270, data, **asked)
    assert mine.to_dict() == theirs
    assert (tmp_path / "mine.json").read_text() == (tmp_path / "theirs.json").read_text()
    assert mine.verdict == theirs["verdict"] and mine.stop == theirs["stop"] and mine.reason in mine.summary()
    assert mine.error < mine.upper and len(mine.estimates) == theirs["parameters"]["count"]
    assert np.array_equal(mine.configurations, [pose["configuration"] for pose in theirs["poses"]])
    first = pw.next_poses(kr270, candidates=300)
    assert first.verdict == "not_determined" and first.error is None and len(first) == 1
    other = tmp_path / "measured.csv"
    other.write_text(data.read_text().replace("0.1", "0.2"))
    with pytest.raises(pw.InputError, match="differs from the file"):
        pw.next_poses(kr270, other, **asked)
