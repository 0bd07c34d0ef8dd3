import json
import math

import numpy as np
import pytest

import posewright as pw
from conftest import without_times


@pytest.mark.parametrize("name, method", [("kr270", "exchange"), ("five_bar", "auto")])
def test_the_command_line_gives_the_same_plan(program, examples, tmp_path, name, method):
    file = examples / name / "problem.yaml"
    options = ["--candidates", 60, "--restarts", 2, "--seed", 3, "--poses", 20, "--method", method]
    theirs = program("plan", file, *options, "-o", "-", "--poses-csv", tmp_path / "poses.csv")
    plan = pw.plan(pw.Problem(file), poses=20, candidates=60, restarts=2, seed=3, method=method)
    assert without_times(plan.to_dict()) == without_times(theirs)
    assert plan.to_csv() == (tmp_path / "poses.csv").read_text()


def test_candidates_of_a_cell_are_kept_where_the_environment_says(examples, tmp_path, monkeypatch):
    file = examples / "cell" / "problem.yaml"
    options = {"poses": 14, "candidates": 150, "restarts": 1, "method": "exchange", "criterion": "o1", "seed": 5}

    def plan():
        return without_times(pw.plan(pw.Problem(file), **options).to_dict())

    monkeypatch.setenv("POSEWRIGHT_CACHE", "off")
    anew = plan()
    monkeypatch.setenv("POSEWRIGHT_CACHE", str(tmp_path / "kept"))
    assert plan() == anew
    (result,) = (tmp_path / "kept").glob("*.result")
    before = result.stat().st_mtime_ns
    assert plan() == anew
    assert result.stat().st_mtime_ns > before  # it was used


def test_attributes_say_what_the_file_says(small_plan):
    written = small_plan.to_dict()
    assert json.loads(small_plan.to_json()) == written
    poses = written["poses"]
    assert small_plan.configurations.shape == (18, 6)
    assert small_plan.configurations.tolist() == [pose["configuration"] for pose in poses]
    assert (small_plan.names, small_plan.units) == (poses[0]["names"], poses[0]["units"])
    assert len(small_plan) == len(small_plan.poses) == 18
    for mine, pose in zip(small_plan.poses, poses):
        assert (mine.id, mine.candidate, mine.contribution) == (pose["id"], pose["candidate"], pose["contribution"])
        assert mine.efficiency_without == pose["efficiency_without"]
        assert mine.configuration.tolist() == pose["configuration"]
        assert mine.tool_pose[:3, 3].tolist() == pose["tool_pose"]["position"]
        np.testing.assert_allclose(mine.tool_pose[:3, :3] @ mine.tool_pose[:3, :3].T, np.eye(3), atol=1e-12)
    assert small_plan.candidates == [pose["candidate"] for pose in poses]
    for mine, parameter in zip(small_plan.parameters, written["parameters"]):
        for key in ("name", "unit", "role", "nominal", "tolerance", "sigma", "worth_identifying"):
            assert getattr(mine, key) == parameter[key]
    assert small_plan.sigma.tolist() == [p.sigma for p in small_plan.parameters]
    criterion, certificate = written["criterion"], written["certificate"]["candidates"]
    assert (small_plan.log_det, small_plan.criterion_value) == (criterion["log_det"], criterion["value"])
    assert small_plan.indices == criterion["indices"]
    assert small_plan.certificate.efficiency == certificate["efficiency"]
    assert small_plan.certificate.bound == certificate["log_det_bound"]
    assert math.isclose(small_plan.contributions.sum(), 1)
    assert not small_plan.interrupted


def test_dropped_parameters_have_an_equation_and_no_sigma(kr270):
    plan = pw.plan(kr270, variant="automatic", candidates=60, restarts=1, method="greedy")
    dropped = [p for p in plan.parameters if p.dropped_because]
    assert dropped and all(p.sigma is None and p.worth_identifying is None for p in dropped)
    assert np.isnan(plan.sigma).sum() == len(dropped)


@pytest.mark.parametrize("name, method", [("kr270", "exchange"), ("five_bar", "auto")])
def test_threads_do_not_change_the_plan(examples, name, method):
    problem = pw.Problem(examples / name / "problem.yaml")
    settings = dict(candidates=60, restarts=3, method=method)
    one, two = (without_times(pw.plan(problem, threads=n, **settings).to_dict()) for n in (1, 2))
    assert one == two


def test_criteria_without_a_bound_have_no_certificate(kr270):
    assert pw.plan(kr270, criterion="o2", candidates=60, restarts=1, method="greedy").certificate is None


def test_poses_measured_already_come_from_plans_files_and_arrays(kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "measured.csv")
    settings = dict(poses=4, candidates=60, restarts=1, method="exchange")
    plans = [
        without_times(pw.plan(kr270, measured=measured, **settings).to_dict())
        for measured in (small_plan, tmp_path / "measured.csv", small_plan.configurations)
    ]
    assert plans[0] == plans[2]
    # CSV says degrees, so that its last digits differ.
    assert math.isclose(plans[0]["criterion"]["log_det"], plans[1]["criterion"]["log_det"], rel_tol=1e-9)
    assert [p.get("measured", False) for p in plans[0]["poses"]] == [True] * 18 + [False] * 4


def test_fixed_poses_are_among_the_plans_own(kr270, small_plan):
    plan = pw.plan(kr270, 18, fixed=small_plan.configurations[:2], candidates=200, restarts=1, method="exchange")
    assert [p.fixed for p in plan.poses] == [True] * 2 + [False] * 16
    assert not any(p.measured for p in plan.poses)
    assert np.array_equal(plan.configurations[:2], small_plan.configurations[:2])


def test_progress_is_told_and_what_it_raises_comes_out(kr270):
    seen = []
    pw.plan(kr270, candidates=60, restarts=2, method="exchange", progress=seen.append)
    assert {"candidates"} < {p.stage for p in seen}
    assert all(p.total == 0 or 0 <= p.done <= p.total for p in seen)
    assert "Progress" in repr(seen[0])

    def fail(progress):
        raise KeyError(progress.stage)

    with pytest.raises(KeyError, match="candidates"):
        pw.plan(kr270, candidates=60, progress=fail)


def test_a_time_limit_ends_the_search_with_the_best_plan(kr270):
    plan = pw.plan(kr270, candidates=1000, restarts=100000, method="exchange", time_limit=0.5)
    assert plan.interrupted and len(plan) == 18


@pytest.mark.parametrize(
    "arguments, said",
    [
        (dict(poses=0), "poses is '0'; a whole number from 1 to 1000000"),
        (dict(poses="many"), "poses is 'many'; a whole number from 1"),
        (dict(criterion="o9"), "unknown criterion 'o9'; available: o1"),
        (dict(method="magic"), "unknown method 'magic'"),
        (dict(variant="none"), "variant"),
        (dict(candidates=-1), "candidates is '-1'"),
        (dict(poses=18.5), "poses is '18.5'; a whole number"),
        (dict(poses=True), "a whole number"),
        (dict(repeats="some"), "allowed: allow, forbid"),
        (dict(scaling="no"), "allowed: tolerance, norm, none"),
        (dict(prior=True), "allowed: none, tolerance"),
        (dict(seed=-1), "seed is -1"),
        (dict(threads=-1), "threads is -1"),
        (dict(time_limit=-1), "time_limit"),
        (dict(time_limit=float("nan")), "time_limit"),
        (dict(measured="absent.csv"), "absent.csv"),
    ],
)
def test_bad_arguments_are_input_errors(kr270, arguments, said):
    with pytest.raises(pw.InputError) as error:
        pw.plan(kr270, **arguments)
    assert said in str(error.value)


@pytest.mark.parametrize("arguments", [dict(seed=1.5), dict(progress=3), dict(pose=3)])
def test_arguments_of_another_type_are_type_errors(kr270, arguments):
    with pytest.raises(TypeError):
        pw.plan(kr270, **arguments)


def test_what_cannot_be_done_is_a_runtime_error(kr270):
    with pytest.raises(RuntimeError) as error:
        pw.plan(kr270, poses=2, candidates=60)
    assert isinstance(error.value, pw.CannotDo)
    assert "at least" in str(error.value)
    assert not isinstance(error.value, ValueError)


def test_options_in_messages_are_those_of_python(examples, kr270):
    text = (examples / "kr270" / "problem.yaml").read_text().replace("  poses: 18\n", "")
    with pytest.raises(pw.InputError, match="set design: poses or poses="):
        pw.plan(pw.Problem.from_text(text, examples / "kr270"))


def test_files_are_written_whole_and_never_over_others(small_plan, tmp_path):
    for name, text in [("plan.json", small_plan.to_json()), ("poses.csv", small_plan.to_csv())]:
        small_plan.save(tmp_path / name)
        assert (tmp_path / name).read_text() == text
        with pytest.raises(FileExistsError, match="overwrite=True"):
            small_plan.save(tmp_path / name)
        small_plan.save(str(tmp_path / name), overwrite=True)
    with pytest.raises(pw.CannotDo):
        small_plan.save(tmp_path / "absent" / "plan.json")


def test_a_plan_shows_itself(small_plan):
    assert repr(small_plan).startswith("<Plan: 18 poses for ")
    assert "px1" in small_plan.summary() and "px1" in small_plan._repr_html_()
    for shown in (small_plan.poses[0], small_plan.parameters[0], small_plan.certificate):
        assert repr(shown).startswith("<" + type(shown).__name__)
