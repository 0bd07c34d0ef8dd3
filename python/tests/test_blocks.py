import numpy as np
import pytest

import posewright as pw
from conftest import without_times


def log_det(rows, nuisance=0):
    """By numpy alone: slogdet of the information, and of its nuisance block."""
    information = rows.T @ rows
    whole = np.linalg.slogdet(information)[1]
    return whole - np.linalg.slogdet(information[:nuisance, :nuisance])[1] if nuisance else whole


@pytest.mark.parametrize("nuisance", [0, 3])
def test_select_gives_the_plan_of_the_command_line_and_numpys_log_det(program, blocks, tmp_path, nuisance):
    np.save(tmp_path / "blocks.npy", blocks)
    theirs = program("select", tmp_path / "blocks.npy", "--poses", 6, "--nuisance", nuisance, "-o", "-")
    plan = pw.select(blocks, poses=6, nuisance=nuisance)
    mine = without_times(plan.to_dict())
    theirs = without_times(theirs)
    mine.pop("problem"), theirs.pop("problem")
    assert mine == theirs
    rows = blocks[plan.candidates].reshape(-1, 8)
    assert abs(plan.log_det - log_det(rows, nuisance)) < 1e-9
    assert abs(pw.log_det(blocks, plan.candidates, nuisance=nuisance) - plan.log_det) < 1e-12
    assert plan.log_det <= plan.certificate.bound


def test_any_layout_and_type_of_the_same_numbers_gives_the_same_plan(blocks):
    blocks = blocks.astype(np.float32)  # so that every type below holds the same numbers
    expected = pw.select(blocks.astype(float), poses=6, restarts=2).to_dict()["poses"]
    spread = np.zeros((600, 6, 24))
    spread[::2, ::2, ::3] = blocks
    read_only = blocks.astype(float)
    read_only.flags.writeable = False
    for same in (blocks, np.asfortranarray(blocks), spread[::2, ::2, ::3], blocks.astype(">f8"), read_only,
                 np.ascontiguousarray(blocks[:, :, ::-1].astype(float))[:, :, ::-1]):
        assert pw.select(same, poses=6, restarts=2).to_dict()["poses"] == expected
    assert pw.select(blocks.reshape(-1, 8), poses=6, rows=3, restarts=2).to_dict()["poses"] == expected
    assert pw.select(blocks.tolist(), poses=6, restarts=2).to_dict()["poses"] == expected


def test_select_leaves_the_blocks_as_they_are(blocks):
    before = blocks.copy()
    pw.select(blocks, poses=6, restarts=1)
    assert (blocks == before).all()


def test_names_repeats_and_whole_numbers():
    blocks = np.eye(3, dtype=int)[:, None, :]  # three blocks of one row
    names = ["a", "b", "c"]
    plan = pw.select(blocks, poses=6, repeats=2, names=names)
    assert sorted(plan.candidates) == [0, 0, 1, 1, 2, 2]
    assert [p.name for p in plan.parameters] == names
    assert plan.log_det == pytest.approx(3 * np.log(2), abs=1e-12)
    assert pw.select(blocks, poses=6, repeats="allow").log_det == pytest.approx(3 * np.log(2), abs=1e-12)
    assert plan.configurations.shape == (6, 0)
    with pytest.raises(pw.InputError):
        plan.save("poses.csv")


@pytest.mark.parametrize(
    "change, said",
    [
        (lambda b: b[0], "blocks is 3 × 8; n × r × m"),
        (lambda b: b[None], "blocks is 1 × 300 × 3 × 8"),
        (lambda b: b[:0], "n, r and m must be at least 1"),
        (lambda b: np.where(b == b[7, 1, 2], np.nan, b), "block 7, row 1, column 2 is not finite"),
        (lambda b: np.where(b == b[7, 1, 2], -np.inf, b), "block 7, row 1, column 2 is not finite"),
    ],
)
def test_bad_arrays_are_input_errors(blocks, change, said):
    with pytest.raises(pw.InputError) as error:
        pw.select(change(blocks), poses=6)
    assert said in str(error.value)


@pytest.mark.parametrize("kind", [complex, bool, str, object])
def test_arrays_of_anything_but_real_numbers_are_type_errors(blocks, kind):
    with pytest.raises(TypeError, match="real numbers"):
        pw.select(blocks.astype(kind), poses=6)


@pytest.mark.parametrize(
    "arguments, error, said",
    [
        (dict(poses=2), pw.CannotDo, "at least 3"),
        (dict(poses=400), pw.CannotDo, "400 poses cannot be chosen from 300"),
        (dict(poses=6, nuisance=8), pw.InputError, "nuisance is 8; 0 to 7"),
        (dict(poses=6, criterion="test_pose"), pw.InputError, "needs a robot"),
        (dict(poses=6, criterion="x"), pw.InputError, "unknown criterion"),
        (dict(poses=6, names=["a"]), pw.InputError, "there are 1 names"),
        (dict(poses=6, rows=3), pw.InputError, "blocks is 300 × 3 × 8"),
        (dict(poses=6, gap=1), pw.InputError, "it is for branch_and_bound"),
        (dict(poses=6, gap=100), pw.InputError, "above 0 and below 100"),
    ],
)
def test_arguments_that_do_not_fit_the_blocks(blocks, arguments, error, said):
    with pytest.raises(error) as raised:
        pw.select(blocks, **arguments)
    assert said in str(raised.value)


@pytest.mark.parametrize("name", ["kr270", "five_bar", "telescope", "delta"])
def test_blocks_at_the_planned_poses_give_the_plans_figures(examples, name):
    problem = pw.Problem(examples / name / "problem.yaml")
    plan = pw.plan(problem, candidates=60, restarts=1, method="exchange")
    blocks = pw.blocks(problem, plan)
    rows = blocks.values.reshape(-1, blocks.shape[2])
    # Columns in units of their tolerance, so that numpy's determinant is as good as ours.
    tolerance = np.array([p.tolerance for p in blocks.parameters])
    scale = 2 * np.log(tolerance[blocks.nuisance:]).sum()
    assert log_det(rows * tolerance, blocks.nuisance) - scale == pytest.approx(plan.log_det, rel=1e-9)
    judged = pw.evaluate_blocks(blocks)
    assert judged.log_det == pytest.approx(plan.log_det, rel=1e-12)
    assert judged.log_det_full == pytest.approx(plan.log_det_full, rel=1e-12)
    assert judged.indices == pytest.approx(plan.indices, rel=1e-9)
    assert judged.value(plan.criterion) == pytest.approx(plan.criterion_value, rel=1e-9)
    sigma = dict(zip(blocks.names, judged.sigma))
    assert {p.name: p.sigma for p in plan.parameters if p.sigma is not None} == pytest.approx(sigma, rel=1e-9)
    np.testing.assert_allclose(np.sqrt(np.diag(judged.covariance)), judged.sigma, rtol=1e-9)


def test_blocks_are_labelled_and_share_their_memory(kr270, small_plan):
    blocks = pw.blocks(kr270, small_plan.configurations)
    assert blocks.shape == blocks.values.shape == (18, 9, 33)
    assert len(blocks) == 18 and len(blocks.names) == len(blocks.units) == 33
    assert [p.role for p in blocks.parameters] == ["nuisance"] * blocks.nuisance + ["interest"] * 18
    assert np.shares_memory(blocks.values, blocks.values)
    assert np.asarray(blocks).shape == (18, 9, 33)
    assert pw.log_det(blocks) == pytest.approx(small_plan.log_det, rel=1e-12)
    values = blocks.values
    del blocks
    assert np.isfinite(values).all()
    assert "18 × 9 × 33" in repr(pw.blocks(kr270, small_plan))


def test_whitened_blocks_are_the_jacobians_weighted_by_their_covariance(kr270, small_plan):
    model = pw.Model(kr270)
    G, covariance = model.jacobians(small_plan)
    blocks = model.blocks(small_plan).values
    for g, c, j in zip(G, covariance, blocks):
        information = g.T @ np.linalg.solve(c, g)
        np.testing.assert_allclose(j.T @ j, information, rtol=1e-9, atol=1e-12 * abs(information).max())


def test_candidates_blocks_and_select_make_the_plan_of_a_variant(kr270):
    model = pw.Model(kr270, seed=5)
    candidates = model.candidates(60, seed=5)
    assert candidates.shape == (60, 6)
    chosen = pw.select(model.blocks(candidates), poses=18, restarts=2, seed=5)
    plan = pw.plan(kr270, candidates=60, restarts=2, method="exchange", seed=5)
    assert (candidates[chosen.candidates] == plan.configurations).all()
    assert chosen.log_det == pytest.approx(plan.log_det, rel=1e-12)


def test_a_model_of_a_plan_has_the_plans_columns(kr270):
    plan = pw.plan(kr270, variant="automatic", candidates=60, restarts=1, method="greedy")
    model = pw.Model(kr270, plan)
    assert sorted(p.name for p in model.parameters) == sorted(p.name for p in plan.parameters if p.sigma is not None)
    same = pw.Model(kr270, "automatic", candidates=60)
    assert [p.name for p in same.parameters] == [p.name for p in model.parameters]
    few = pw.Model(kr270, "geometric", ["px1", "base.x"])
    assert [p.name for p in few.parameters] == ["base.x", "px1"] and few.nuisance == 1


def test_models_say_what_a_configuration_is(kr270):
    model = pw.Model(kr270)
    assert [c.name for c in model.coordinates][:2] == ["joint_a1", "joint_a2"]
    assert all(c.lower < c.upper and c.unit == "rad" and not c.labels for c in model.coordinates)
    assert "joint_a1" in repr(model.coordinates[0]) and "variant geometric" in repr(model)
    with pytest.raises(pw.InputError, match="has no parameter 'nothing'"):
        pw.Model(kr270, "geometric", ["nothing"])
    with pytest.raises(pw.InputError, match="named twice"):
        pw.Model(kr270, "geometric", ["px1", "px1"])
    with pytest.raises(pw.InputError, match="variants: geometric"):
        pw.Model(kr270, "nothing")


@pytest.mark.parametrize(
    "make, said",
    [
        (lambda q: q[0], "configurations is 6; N poses × n coordinates"),
        (lambda q: q[:, :5], "pose 1: has 5 values; one for each of joint_a1"),
        (lambda q: q[:0], "has no poses"),
        (lambda q: np.where(q == q[3, 2], np.nan, q), "pose 4: 'joint_a3' is not finite"),
        (lambda q: q + 10, "pose 1: 'joint_a1' is"),
    ],
)
def test_bad_configurations_are_input_errors(kr270, small_plan, make, said):
    with pytest.raises(pw.InputError) as error:
        pw.blocks(kr270, make(small_plan.configurations))
    assert said in str(error.value)


def test_log_det_of_chosen_blocks_counts_repeats(blocks):
    assert pw.log_det(blocks, [1, 1, 5, 9]) == pytest.approx(log_det(blocks[[1, 1, 5, 9]].reshape(-1, 8)), abs=1e-9)
    judged = pw.evaluate_blocks(blocks, np.array([1, 1, 5, 9]), tolerance=np.full(8, 2.0))
    assert judged.contributions.sum() == pytest.approx(1)
    for name in ("o1", "o2", "o3", "o4", "o5", "a", "ds"):
        assert np.isfinite(judged.value(name))
    with_prior = pw.evaluate_blocks(blocks, [1], tolerance=np.full(8, 2.0), prior=True)
    rows = np.vstack([blocks[1], np.eye(8) / 2])
    assert with_prior.log_det == pytest.approx(log_det(rows), abs=1e-9)
    with pytest.raises(pw.CannotDo):
        pw.log_det(blocks, [1])
    for chosen in ([300], [-1], [], [[1]]):
        with pytest.raises(pw.InputError):
            pw.log_det(blocks, chosen)
    with pytest.raises(TypeError):
        pw.log_det(blocks, [1.5])
    for tolerance in ([1.0], np.zeros(8), np.full(8, np.nan)):
        with pytest.raises(pw.InputError):
            pw.evaluate_blocks(blocks, tolerance=tolerance)


def test_criteria_and_methods_are_named():
    assert {"o1", "o2", "o3", "o4", "o5", "a", "ds", "test_pose"} <= set(pw.criteria())
    assert {"auto", "exchange", "greedy"} <= set(pw.methods())
    assert all(pw.criteria().values()) and all(pw.methods().values())
