import json

import numpy as np
import pytest

import posewright as pw
from conftest import without_times


@pytest.fixture(scope="module")
def cell(examples):
    return pw.Problem(examples / "cell" / "problem.yaml")


@pytest.fixture(scope="module")
def reached(cell):
    """Ten feasible configurations of the cell."""
    return pw.Model(cell, candidates=60).candidates(10)


@pytest.fixture
def pose_list(cell, reached, tmp_path):
    """The same as a file."""
    names = [f"joint_a{i}" for i in range(1, 7)]
    lines = [",".join(f"{name} [rad]" for name in names), *(",".join(map(repr, q)) for q in reached[:, : len(names)].tolist())]
    file = tmp_path / "poses.csv"
    file.write_text("\n".join(lines) + "\n")
    return file


def test_observe_says_what_the_command_line_says(program, kr270):
    theirs = program("observe", kr270.file, "--candidates", 60)
    mine = pw.observe(kr270, candidates=60)
    assert list(mine) == kr270.variants
    assert [o.to_dict() for o in mine.values()] == theirs["variants"]
    one = pw.observe(kr270, "automatic", candidates=60)
    assert list(one) == ["automatic"] and one["automatic"].to_dict() == mine["automatic"].to_dict()


def test_an_observation_is_consistent(kr270):
    o = pw.observe(kr270, "automatic", candidates=60)["automatic"]
    assert o.rank == len(o.kept) == len(o.singular_values) - len(o.dependencies)
    assert len(o.parameters) == o.rank + len(o.dependencies)
    assert o.configurations == 60 and o.smallest_poses > 1
    assert (np.diff(o.singular_values) <= 0).all()
    for d in o.dependencies:
        assert d.dropped not in o.kept and set(d.terms) <= set(o.kept) and d.dropped in d.equation
    assert set(o.recommended) <= set(o.kept) and o.sigma.shape == (o.rank,)
    assert o.summary().startswith("Variant automatic: 18 of 42 parameters can be identified")
    assert "automatic" in repr(o) and all("Dependency" in repr(d) for d in o.dependencies + o.near_dependencies)


def test_evaluate_says_what_the_command_line_says(program, kr270, small_plan, tmp_path):
    small_plan.save(tmp_path / "plan.json")
    settings = ["--candidates", 60, "--restarts", 1, "--method", "exchange"]
    theirs = program("evaluate", kr270.file, tmp_path / "plan.json", "--drop", 2, "--add", 1, *settings)
    for poses in (small_plan, small_plan.configurations, tmp_path / "plan.json"):
        mine = pw.evaluate(kr270, poses, drop=2, add=1, candidates=60, restarts=1, method="exchange")
        assert without_times(mine.to_dict()) == without_times(theirs)
    assert json.loads(mine.to_json())["schema"] == "posewright/evaluation/1"
    assert mine.plan.log_det == pytest.approx(small_plan.log_det, rel=1e-12)
    assert mine.scores["o1"].value == mine.plan.criterion_value
    assert len(mine.drop.poses) == 2 and 0 < mine.drop.efficiency < 1
    assert mine.add.configurations.shape == (1, 6) and mine.add.efficiency > 1
    assert "Drop first" in mine.summary() and mine._repr_html_()
    for shown in (mine, mine.add, mine.drop, mine.scores["o1"]):
        assert repr(shown).startswith("<" + type(shown).__name__)
    plain = pw.evaluate(kr270, small_plan, candidates=60)
    assert plain.drop is None and plain.add is None


def test_poses_that_are_not_feasible_are_named(cell, reached):
    inside = reached.copy()
    inside[4, :6] = [1.8, -0.4, 0.6, 0, 0, 0]  # into the wall
    with pytest.raises(pw.InputError, match="configurations: pose 5 is not feasible"):
        pw.evaluate(cell, inside, candidates=60)


def test_a_choice_is_a_number_in_arrays_and_a_label_in_plans(examples):
    problem = pw.Problem(examples / "instruments" / "tracker_two_stations.yaml")
    plan = pw.plan(problem, candidates=60, restarts=1, method="exchange")
    assert len(set(plan.stations)) == 2
    model = pw.Model(problem, plan)
    configurations = model.configurations(plan)
    station = [c.name for c in model.coordinates].index("station")
    labels = model.coordinates[station].labels
    assert [labels[int(q)] for q in configurations[:, station]] == plan.stations
    assert pw.log_det(model.blocks(configurations)) == pytest.approx(plan.log_det, rel=1e-12)
    configurations[0, station] = 0.5
    with pytest.raises(pw.InputError, match="configurations: pose 1: 'station' is 0.5"):
        model.blocks(configurations)
    with pytest.raises(pw.InputError, match="pose 1: has 6 values; one for each of"):
        model.blocks(plan.configurations)


def test_a_route_is_that_of_the_command_line(program, cell, reached, pose_list, tmp_path):
    theirs = program("route", pose_list, "--problem", cell.file, "--from-home", "--closed", "-o", "-")
    route = pw.route(cell, pose_list, from_home=True, closed=True)
    assert without_seconds(route.to_dict()) == without_seconds(theirs)
    from_memory = pw.route(cell, reached, from_home=True, closed=True)
    assert from_memory.order == route.order
    assert (from_memory.configurations == route.configurations).all()
    by_id = dict(enumerate(reached[:, : len(route.names)].tolist(), 1))
    assert sorted(route.order + list(route.unreachable)) == sorted(by_id)
    turns = (route.configurations - np.array([by_id[i] for i in route.order])) / (2 * np.pi)
    assert np.abs(turns - np.round(turns)).max() < 1e-12  # the turn nearest to home
    stops = dict(zip(route.order, route.configurations.tolist()))
    assert [m.start for m in route.motions] == [0, *route.order]
    assert [m.end for m in route.motions] == [*route.order, 0]
    for motion in route.motions:
        assert motion.points[0].tolist() == (stops[motion.start] if motion.start else route.home.tolist())
        assert motion.points.shape[1] == len(route.names) == len(route.units)
    assert route.travel_seconds == pytest.approx(sum(m.seconds for m in route.motions))
    route.save(tmp_path / "route.json")
    assert json.loads((tmp_path / "route.json").read_text()) == route.to_dict()
    assert route.to_csv().startswith("pose,") and route.summary()
    assert "Route" in repr(route) and "Motion" in repr(route.motions[0])


def without_seconds(route):
    return {key: value for key, value in route.items() if key not in ("computing_seconds", "statistics")}


def test_a_route_knows_whether_the_plan_was_made_for_this_problem(kr270, small_plan, examples):
    assert not pw.route(kr270, small_plan).problem_changed
    text = (examples / "kr270" / "problem.yaml").read_text() + "\n# changed\n"
    assert pw.route(pw.Problem.from_text(text, examples / "kr270"), small_plan).problem_changed


def test_bad_arguments_of_a_route(kr270, small_plan):
    with pytest.raises(pw.InputError, match="start and from-home cannot be combined"):
        pw.route(kr270, small_plan, from_home=True, start=1)
    with pytest.raises(pw.InputError, match="start= 99 is not a pose of"):
        pw.route(kr270, small_plan, start=99)
    with pytest.raises(pw.InputError, match="milestones 0"):
        pw.route(kr270, small_plan, milestones=0)


def test_lists_that_other_programs_wrote_are_read_by_their_format(kr270, small_plan, tmp_path):
    file = tmp_path / "poses.npy"
    np.save(file, small_plan.configurations)
    settings = dict(candidates=60, restarts=1, method="exchange")
    by_file = pw.evaluate(kr270, file, from_="pybotics-npy", **settings)
    assert without_times(by_file.to_dict()) == without_times(pw.evaluate(kr270, small_plan, **settings).to_dict())
    with pytest.raises(pw.InputError, match="it belongs to the name of a pose list"):
        pw.evaluate(kr270, small_plan, from_="pybotics-npy")
    with pytest.raises(pw.InputError, match="format"):
        pw.route(kr270, file, from_="nothing")
