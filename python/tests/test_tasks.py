"""Simulate, calibrate, compare, stations, report: what the command line says, and files that it reads."""
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
    with pytest.raises(pw.InputError):
        pw.compare(kr270, {"a": small_plan}, poses=3)


def test_a_report_holds_the_plan_and_is_a_page(kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    report = pw.report(kr270, tmp_path / "plan.json", brief=True)
    assert json.loads(report.to_json())["schema"] == "posewright/report/1"
    report.save(tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text().lstrip().lower().startswith("<!doctype html")


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
