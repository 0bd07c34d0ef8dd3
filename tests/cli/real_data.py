"""Converts, calibrates and plans the FANUC set and compares with what is known of it: real_data.py SOURCE PROGRAM."""
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2]
EXAMPLE, DATA = SOURCE / "examples/real_data/fanuc_r2000", SOURCE.parent / "shared" / "data" / "fanuc_r2000"
if not DATA.is_dir():
    print(f"skipped: the data are not at {DATA}")
    sys.exit(77)

failures = []


def expect(what, value, good):
    print(f"{what}: {value}")
    if not good:
        failures.append(what)


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words), "--json", "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


with tempfile.TemporaryDirectory() as scratch:
    readings = pathlib.Path(scratch) / "data.csv"
    subprocess.run([sys.executable, "-B", EXAMPLE / "convert.py", DATA, readings], check=True)
    result = run("calibrate", EXAMPLE / "problem.yaml", readings, "--weights", "ols", "--no-prior", "--profile", "none")
    rms = {r["parameters"]: 1e3 * r["rms"] for r in result["residuals"] if (r["poses"], r["kind"]) == ("fitted", "distance")}
    expect("poses", result["poses_fitted"], result["poses_fitted"] == 24)
    parameters = sum(p["estimated"] for p in result["parameters"])
    expect("parameters", parameters, parameters == 33)
    expect("distance RMS of 24 poses, mm", rms["calibrated"], abs(rms["calibrated"] - 0.136) < 0.001)
    expect("base and reflectors alone, mm", rms["placed"], abs(rms["placed"] - 0.615) < 0.001)
    plan = run("plan", EXAMPLE / "problem.yaml", "--candidates-from", readings, "--poses", 12, "--variant", "everything", "--criterion", "o1",
               "-o", "-", "--poses-csv", "-")
    ids = {str(pose["listed"]["id"]) for pose in plan["poses"]}
    expect("poses of the plan", sorted(ids), len(ids) == 12)
    efficiency = plan["certificate"]["candidates"]["efficiency"]
    expect("certificate", efficiency, 0.9 < efficiency <= 1)
    header, *rows = readings.read_text().splitlines()
    marked = [header + ",use"] + [row + (",fit" if row.split(",")[0] in ids else ",validate") for row in rows]
    readings.write_text("\n".join(marked) + "\n")
    result = run("calibrate", EXAMPLE / "problem.yaml", readings, "--weights", "ols", "--no-prior", "--force", "--profile", "none")
    beyond = next(1e3 * r["rms"] for r in result["residuals"] if (r["poses"], r["parameters"], r["kind"]) == ("held back", "calibrated", "distance"))
    expect("distance RMS of the 12 that were held back, mm", beyond, 0.136 < beyond <= 0.25)
sys.exit(f"not as known: {', '.join(failures)}" if failures else 0)
