import pathlib

import numpy as np
import pytest

import posewright as pw
from conftest import without_times

yaml = pytest.importorskip("yaml", reason="python3-yaml is absent")


def as_dictionary(file):
    return yaml.safe_load(file.read_text())


@pytest.mark.parametrize("name", ["kr270", "five_bar", "telescope"])
def test_a_dictionary_gives_the_plan_of_the_file_bit_for_bit(examples, name):
    file = examples / name / "problem.yaml"
    settings = dict(candidates=60, restarts=1, method="exchange")
    by_file = without_times(pw.plan(pw.Problem(file), **settings).to_dict())
    by_dictionary = without_times(pw.plan(pw.Problem(as_dictionary(file), base=file.parent), **settings).to_dict())
    by_file.pop("problem"), by_dictionary.pop("problem")
    assert by_file == by_dictionary


def test_text_gives_the_problem_of_the_file(examples):
    file = examples / "kr270" / "problem.yaml"
    problem = pw.Problem.from_text(file.read_text(), file.parent, name="mine.yaml")
    assert isinstance(problem, pw.Problem)
    assert problem.sha256 == pw.Problem(file).sha256
    assert problem.variants == ["geometric", "automatic", "denavit_hartenberg"]
    assert pathlib.Path(problem.file).name == "mine.yaml"


def test_numbers_of_numpy_paths_and_tuples_are_values(examples):
    given = as_dictionary(examples / "kr270" / "problem.yaml")
    given["robot"]["urdf"] = examples / "kr270" / "kr270.urdf"
    given["measurement"]["targets"]["P1"] = np.array([0.27723, -0.04653, -0.09387])
    given["measurement"]["targets"]["P2"] = (np.float64(0.27649), np.float32(-0.04825), 0.09405)
    given["measurement"]["repeats"] = np.int64(3)
    assert pw.Problem(given).variants == list(given["variants"])


def test_words_for_yes_and_no_are_true_and_false(examples):
    given = as_dictionary(examples / "kr270" / "problem.yaml")
    for reserve in (True, False):
        given["design"]["reserve"] = reserve
        plan = pw.plan(pw.Problem(given, base=examples / "kr270"), candidates=60, restarts=1, method="greedy")
        assert plan.reserve is reserve


def test_a_plan_for_the_tolerances_tells_every_drawn_robots_efficiency(examples):
    problem = pw.Problem(examples / "kr270" / "problem.yaml")
    plan = pw.plan(problem, candidates=200, restarts=1, method="greedy", robust=5, robust_measure="tail 0.4")
    written = plan.to_dict()["robust"]
    assert list(plan.robust_efficiency) == written["efficiency"] and len(written["efficiency"]) == 5
    lowest = sorted(written["efficiency"])[:2]
    assert written["value"] == pytest.approx(float(np.exp(np.mean(np.log(lowest)))))
    assert len(pw.plan(problem, candidates=60, restarts=1, method="greedy").robust_efficiency) == 0
    with pytest.raises(pw.InputError, match="is no measure"):
        pw.plan(problem, robust=5, robust_measure="median")


@pytest.mark.parametrize(
    "path, value, said",
    [
        (["design", "poses"], -3, "design.poses"),
        (["design", "colour"], "red", "design.colour: unknown key 'colour'; allowed: "),
        (["measurement", "device", "noise"], "5 deg", "measurement.device.noise"),
        (["measurement", "targets", "P2"], [1, 2], "measurement.targets.P2"),
        (["variants", "geometric", "parameters"], ["px1", "nothing"], "variants.geometric.parameters[1]"),
        (["design", "candidates"], float("nan"), "design.candidates"),
        (["robot", "urdf"], None, "robot.urdf"),
    ],
)
def test_what_is_wrong_in_a_dictionary_is_named_by_its_keys(examples, path, value, said):
    given = as_dictionary(examples / "kr270" / "problem.yaml")
    place = given
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    with pytest.raises(pw.InputError) as error:
        pw.plan(pw.Problem(given, base=examples / "kr270"), candidates=60)
    assert said in str(error.value)
    assert "problem:" in str(error.value)


def test_what_is_no_value_is_a_type_error_that_names_the_key():
    with pytest.raises(TypeError, match=r"robot\.urdf is a set"):
        pw.Problem({"posewright": 1, "robot": {"urdf": {1}}})
    with pytest.raises(TypeError, match="a mapping, not list"):
        pw.Problem([1, 2])
    with pytest.raises(TypeError, match="the key None"):
        pw.Problem({None: 1})


def test_what_is_wrong_in_a_file_is_named_by_file_and_line(tmp_path):
    file = tmp_path / "bad.yaml"
    file.write_text("posewright: 1\nrobots: 2\n")
    with pytest.raises(ValueError) as error:
        pw.Problem(str(file))
    assert isinstance(error.value, pw.InputError)
    assert (error.value.file, error.value.line) == (str(file), 2)
    assert str(error.value).startswith(f"{file}:2: unknown key 'robots'")
    with pytest.raises(pw.InputError) as error:
        pw.Problem(tmp_path / "absent.yaml")
    assert error.value.line is None


def test_base_and_packages_are_checked(examples):
    with pytest.raises(TypeError, match="base"):
        pw.Problem(examples / "kr270" / "problem.yaml", base=".")
    with pytest.raises(pw.InputError, match="is not a folder"):
        pw.Problem(examples / "kr270" / "problem.yaml", packages={"arm": examples / "absent"})


def test_init_writes_the_text_that_the_command_writes(examples, tmp_path):
    text = pw.init(examples / "kr270" / "kr270.urdf", tracker=True, at=(3, 0, 0.5), poses=12, folder=examples)
    problem = pw.Problem.from_text(text, examples)
    assert problem.variants[0] == "geometric" and "poses: 12" in text and "[3, 0, \"500 mm\"]" in text
    with pytest.raises(pw.InputError, match="no instrument is named"):
        pw.init(examples / "kr270" / "kr270.urdf")
    with pytest.raises(pw.InputError, match="board does not go with tracker"):
        pw.init(examples / "kr270" / "kr270.urdf", tracker=True, board="6x9x25mm")


def test_init_makes_a_problem_of_samples(examples):
    samples = examples / "hand_eye" / "hand_eye.samples"
    problem = pw.Problem.from_text(pw.init(samples=samples))
    camera = pw.calibrate(problem, samples, weights="robust").frames["tool"]
    assert np.abs(camera[:3, 3] - [0.062, -0.018, 0.085]).max() < 2e-3
    with pytest.raises(TypeError, match="a robot or samples"):
        pw.init()
