"""Converts, calibrates and plans the FANUC set and compares with what is known of it: real_data.py SOURCE PROGRAM."""

import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
SOURCE, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2]
sys.path.insert(0, str(SOURCE / "examples" / "real_data"))
import study  # noqa: E402

DATA = SOURCE.parent / "shared" / "data" / "fanuc_r2000"
if not DATA.is_dir():
    print(f"skipped: the data are not at {DATA}")
    sys.exit(77)

failures = []


def expect(what, value, good):
    print(f"{what}: {value}")
    if not good:
        failures.append(what)


with tempfile.TemporaryDirectory() as scratch:
    fanuc = study.Study(PROGRAM, "fanuc_r2000", DATA, pathlib.Path(scratch))
    expect("poses", len(fanuc.ids), len(fanuc.ids) == 24)
    expect("parameters", fanuc.parameters, fanuc.parameters == 33)
    fitted = 1e3 * fanuc.all["distance"]
    expect("distance RMS of 24 poses, mm", fitted, abs(fitted - 0.136) < 0.001)
    placed = 1e3 * fanuc.all["placed"]
    expect("base and reflectors alone, mm", placed, abs(placed - 0.615) < 0.001)
    ids, efficiency = fanuc.plan(12, study.PLANS[0][1])
    expect("poses of the plan", ids, len(set(ids)) == 12 and set(ids) <= set(fanuc.ids))
    expect("certificate", efficiency, 0.9 < efficiency <= 1)
    beyond = 1e3 * fanuc.judge(ids)["distance"]
    expect("distance RMS of the 12 that were held back, mm", beyond, 0.136 < beyond <= 0.25)
sys.exit(f"not as known: {', '.join(failures)}" if failures else 0)
