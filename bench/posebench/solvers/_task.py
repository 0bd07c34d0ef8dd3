"""What solvers share: SOLVER FOLDER N OUT. FOLDER is a part (bench/posebench/cases.py), OUT gets the chosen indices, one a line."""
import json
import pathlib
import sys

NOT_FOR_THIS = 3  # exit code: the solver does not apply to this set, reason on stderr


def arguments():
    folder, poses, out = sys.argv[1:4]
    return pathlib.Path(folder), int(poses), pathlib.Path(out)


def task(folder):
    return json.loads((folder / "task.json").read_text())


def not_for_this(reason):
    print(reason, file=sys.stderr)
    sys.exit(NOT_FOR_THIS)


def needed(folder, name):
    """An array of the folder."""
    import numpy as np
    if not (folder / f"{name}.npy").is_file():
        not_for_this(f"needs {name}")
    return np.load(folder / f"{name}.npy")


def write(out, chosen):
    out.write_text("".join(f"{int(k)}\n" for k in chosen))
