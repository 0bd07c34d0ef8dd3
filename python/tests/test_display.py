"""What notebooks show, without a notebook: the HTML is well-formed and holds the values of the JSON."""
import html.parser
import inspect
import json
import math
import xml.etree.ElementTree as xml

import numpy as np
import pytest

import posewright as pw
from posewright import _figures, _markup


@pytest.fixture(scope="module")
def results(kr270, small_plan, examples, tmp_path_factory):
    """{name: result} of everything that the package returns."""
    folder = tmp_path_factory.mktemp("display")
    quick = dict(candidates=60, restarts=1, method="exchange")
    simulation = pw.simulate(kr270, small_plan, draws=4)
    (folder / "measured.csv").write_text(simulation.first_readings)
    calibration = pw.calibrate(kr270, folder / "measured.csv", hold_back=4)
    calibration.save(folder / "parameters.yaml", force=True)
    small_plan.save(folder / "plan.json")
    with pytest.warns(RuntimeWarning):
        calibrated = pw.Problem(kr270.file, parameters=folder / "parameters.yaml")
    blocks = np.random.default_rng(0).standard_normal((50, 3, 8))
    return {
        "plan": small_plan,
        "selected": pw.select(blocks, poses=6, nuisance=2),
        "evaluation": pw.evaluate(kr270, small_plan, drop=2, add=1, **quick),
        "observation": pw.observe(kr270, "geometric", candidates=60)["geometric"],
        "unseen": pw.observe(pw.Problem(examples / "five_bar" / "problem.yaml"), "everything", candidates=60)["everything"],
        "route": pw.route(kr270, small_plan, from_home=True, milestones=20),
        "simulation": simulation,
        "calibration": calibration,
        "compensation": pw.compensate(calibrated, small_plan),
        "next": pw.next_poses(kr270, folder / "measured.csv", poses=2, candidates=60),
        "comparison": pw.compare(kr270, {"planned <1>": small_plan, "first": small_plan.configurations[:14]}, candidates=60),
        "stations": pw.stations(pw.Problem(examples / "cell" / "problem.yaml"), candidates=20, restarts=1, full=0),
        "block evaluation": pw.evaluate_blocks(blocks, nuisance=2),
        "blocks": pw.blocks(kr270, small_plan),
        "exported": pw.export(small_plan, "kuka-krl", kr270),
        "report": pw.report(kr270, folder / "plan.json", brief=True),
    }


@pytest.fixture(scope="module")
def pages(results):
    """{name: parsed HTML}: xml.fromstring fails on what is not well-formed."""
    return {name: xml.fromstring(result._repr_html_()) for name, result in results.items()}


def drawn(page):
    """{title of each figure: [(label, value, width, height)]} as the tooltips and shapes of its bars say."""
    svg = "{http://www.w3.org/2000/svg}"
    figures = {}
    for figure in page.iter(svg + "svg"):
        bars = []
        for rect in figure.iter(svg + "rect"):
            label, value = rect.find(svg + "title").text.rsplit(": ", 1)
            bars.append((label, float(value), float(rect.get("width")), float(rect.get("height"))))
        figures[figure.find(svg + "title").text.split(" (")[0]] = bars
    return figures


def values(page, title):
    return [(label, value) for label, value, _, _ in drawn(page)[title]]


def table(page, first):
    """Rows of the table whose header begins with these words."""
    for found in page.iter("table"):
        rows = [["".join(cell.itertext()) for cell in row] for row in found.iter("tr")]
        if rows[0][: len(first)] == first:
            return rows[1:]
    raise AssertionError(f"no table begins with {first}")


def test_everything_with_a_summary_or_json_is_shown(results):
    shown = {type(result) for result in results.values()}
    named = {value for value in vars(pw).values() if inspect.isclass(value) and ({"summary", "to_dict", "save"} & set(vars(value)))}
    assert named <= shown
    assert all("_repr_html_" in vars(kind) for kind in shown)


def test_every_page_begins_with_a_sentence_and_fetches_nothing(pages):
    for name, page in pages.items():
        assert page.tag == "div" and page.find("p/b").text, name
        addresses = [value for element in page.iter() for key, value in element.items() if key in ("src", "href")]
        assert not addresses and not list(page.iter("script")) and not list(page.iter("link")), name


def test_a_plan_shows_its_sigmas_poses_and_parameters(results, pages):
    plan = results["plan"].to_dict()
    interest = [p for p in plan["parameters"] if p["role"] == "interest"]
    assert values(pages["plan"], "σ in tolerances") == [(p["name"], p["sigma"] / p["tolerance"]) for p in interest]
    assert values(pages["plan"], "share of the information of each pose") == [(str(p["id"]), p["contribution"]) for p in plan["poses"]]
    rows = table(pages["plan"], ["parameter", "nominal"])
    assert [row[0] for row in rows] == [p["name"] for p in plan["parameters"]]
    row = rows[[p["name"] for p in plan["parameters"]].index("px1")]
    assert row[1] == "350 mm" and float(row[3].removesuffix(" mm")) == pytest.approx(1e3 * interest[0]["sigma"], rel=1e-3)
    poses = table(pages["plan"], ["pose", "candidate", "joint_a1"])
    assert len(poses) == 18
    assert float(poses[4][3].removesuffix(" deg")) == pytest.approx(math.degrees(plan["poses"][4]["configuration"][1]), rel=1e-3)


def test_bars_are_as_long_as_their_values(pages):
    for title, scale in (("share of the information of each pose", lambda v: v), ("σ in tolerances", math.log10)):
        bars = drawn(pages["plan"])[title]
        sizes = [height if title.startswith("share") else width for _, _, width, height in bars]
        x = [scale(value) for _, value, _, _ in bars]
        # Two bars give the line that the others must lie on.
        low, high = x.index(min(x)), x.index(max(x))
        slope = (sizes[high] - sizes[low]) / (x[high] - x[low])
        assert slope > 0
        for value, size in zip(x, sizes):
            assert size == pytest.approx(sizes[low] + slope * (value - x[low]), abs=0.02)
    ordinary = drawn(xml.fromstring(_figures.bars("some", [("a", 1.0), ("b", 4.0), ("none", None), ("c", 0.0)])))["some"]
    assert [bar[0] for bar in ordinary] == ["a", "b"] and ordinary[1][2] == 4 * ordinary[0][2]
    assert _figures.bars("none", []) == "" and _figures.columns("none", []) == ""


def test_a_calibration_shows_residuals_and_changes(results, pages):
    json_ = results["calibration"].to_dict()
    histogram = json_["histogram"]
    bins = values(pages["calibration"], "weighted residuals, in σ")
    assert [count for _, count in bins] == histogram["counts"] and float(bins[0][0]) == histogram["from"]
    rows = table(pages["calibration"], ["poses", "axis"])
    assert len(rows) == len(json_["axes"]) and {row[0] for row in rows} == {"fitted", "held back"}
    for row, axis in zip(rows, json_["axes"]):
        factor = {"m": 1e3, "rad": 180 / math.pi}[axis["unit"]]
        assert float(row[2].split()[0]) == pytest.approx(factor * axis["before"]["rms"], rel=1e-3)
        assert float(row[3].split()[0]) == pytest.approx(factor * axis["after"]["rms"], rel=1e-3)
    changes = dict(values(pages["calibration"], "change of each parameter in tolerances"))
    calibration = results["calibration"]
    for p in json_["parameters"]:
        if p["role"] == "interest":
            assert changes[p["name"]] == abs(calibration.values[p["name"]] - p["nominal"]) / p["tolerance"]


def test_the_other_results_show_what_their_json_says(results, pages):
    json_ = {name: result.to_dict() for name, result in results.items() if hasattr(result, "to_dict")}
    assert [value for _, value in values(pages["observation"], "singular values")] == json_["observation"]["singular_values"]
    assert [value for _, value in values(pages["block evaluation"], "singular values")] == results["block evaluation"].singular_values.tolist()
    assert [value for _, value in values(pages["route"], "seconds of each motion")] == [m["seconds"] for m in json_["route"]["motions"]]
    assert len(table(pages["route"], ["from", "to"])) == 18
    curve = [point for point in json_["next"]["curve"] if point["expected"] is not None]
    assert len(curve) > 5
    assert [value for _, value in values(pages["next"], "predicted error at the places over the number of poses, mm")] == [
        1e3 * point["expected"] for point in curve]
    ratios = dict(values(pages["simulation"], "σ observed by σ predicted"))
    for p in json_["simulation"]["parameters"]:
        assert ratios[p["name"]] == p["sigma_observed"] / p["sigma_predicted"]
    assert [value for _, value in values(pages["comparison"], "efficiency")] == [s["efficiency"] for s in json_["comparison"]["scores"]]
    assert [value for _, value in values(pages["compensation"], "position error before, m")] == results["compensation"].before[:, 0].tolist()
    assert [row[0] for row in table(pages["compensation"], ["joint"])] == results["plan"].names
    assert len(table(pages["stations"], ["", "where"])) == len(results["stations"])
    scores = table(pages["evaluation"], ["criterion", "value", "at least of the best"])
    assert [row[0] for row in scores] == list(results["evaluation"].scores)
    assert [row[0] for row in table(pages["exported"], ["file"])] == list(results["exported"].files)
    assert len(table(pages["blocks"], ["parameter", "role"])) == results["blocks"].shape[2]
    for name, lines in (("simulation", results["simulation"].verdict), ("unseen", [d.equation for d in results["unseen"].dependencies])):
        assert lines and [item.text for item in pages[name].iter("li")][: len(lines)] == lines


def test_names_are_text_whatever_they_hold(results, pages):
    rows = table(pages["comparison"], ["plan", "variant"])
    assert rows[0][0] == "planned <1>" and "planned &lt;1&gt;" in results["comparison"]._repr_html_()
    assert xml.fromstring(_markup.table(["<b>&"], [["\"'<i>"]])).find("tbody/tr/td").text == "\"'<i>"


def test_a_report_is_a_page_of_its_own_in_a_frame(results):
    frames = []

    class Reader(html.parser.HTMLParser):  # keeps line ends in attributes, as browsers do; XML does not
        def handle_starttag(self, tag, attributes):
            if tag == "iframe":
                frames.append(dict(attributes))

    Reader().feed(results["report"]._repr_html_())
    [frame] = frames
    assert frame["srcdoc"] == results["report"].to_html() and "<script" in frame["srcdoc"]
    assert "allow-same-origin" not in frame["sandbox"].split()  # it sees nothing of the notebook


def test_the_json_of_a_plan_is_left_as_it_was(results):
    before = results["plan"].to_json()
    results["plan"]._repr_html_()
    assert json.loads(before) == results["plan"].to_dict()
