"""The example of measuring in rounds reaches its target: run_sequential.py PROGRAM SOURCE."""
import re
import subprocess
import sys

program, source = sys.argv[1:]
run = subprocess.run([sys.executable, f"{source}/examples/sequential/sequential.py", "--program", program, "--target", "0.09",
                      "--more", "3"], capture_output=True, text=True)
print(run.stdout, run.stderr)
errors = [float(x) for x in re.findall(r"^ *\d+ +([\d.]+) mm", run.stdout, re.M)]
if run.returncode != 0 or len(errors) < 2:
    sys.exit("the script did not reach its target in rounds")
if errors[-1] > 0.09 or any(after >= before for before, after in zip(errors, errors[1:])):
    sys.exit("more poses did not make the error smaller")
