"""The example of measuring in rounds reaches its target: run_sequential.py PROGRAM SOURCE."""
import pathlib
import re
import subprocess
import sys
import tempfile

program, source = sys.argv[1:]
example = pathlib.Path(source).resolve() / "examples/sequential"
with tempfile.TemporaryDirectory() as folder:
    # The example's problem with fewer candidates, which is where its time goes.
    text = (example / "problem.yaml").read_text()
    problem = pathlib.Path(folder) / "problem.yaml"
    problem.write_text(text.replace("candidates: 600", "candidates: 120").replace("../kr270/", f"{example.parent}/kr270/"))
    assert "candidates: 120" in problem.read_text()
    run = subprocess.run([sys.executable, example / "sequential.py", "--program", program, "--problem", problem, "--target", "0.09",
                          "--more", "4"], capture_output=True, text=True)
print(run.stdout, run.stderr)
errors = [float(x) for x in re.findall(r"^ *\d+ +([\d.]+) mm", run.stdout, re.M)]
if run.returncode != 0 or len(errors) < 2:
    sys.exit("the script did not reach its target in rounds")
if errors[-1] > 0.09 or any(after >= before for before, after in zip(errors, errors[1:])):
    sys.exit("more poses did not make the error smaller")
