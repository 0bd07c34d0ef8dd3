"""The KR 270's plan with its proof that docs/benchmarks.md and docs/examples.md quote is made again: check_benchmarks.py SOURCE PROGRAM.
Skipped where the program has the system's mathematical functions: its plans depend on the processor."""
import json
import math
import pathlib
import subprocess
import sys
import tempfile


def planned(source, program):
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "plan", source / "examples/kr270/problem.yaml", "-o", "-", "--poses-csv", pathlib.Path(folder) / "poses.csv",
                   "--json", "--quiet"]
        return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def percent(share, decimals=2):
    """As the program states a share: never more than it is."""
    return f"{math.floor(100 * share * 10 ** decimals) / 10 ** decimals:.{decimals}f} %"


def proved(plan):
    """Texts about the plan with its proof: page and text."""
    candidates, proof = (plan["certificate"][kind] for kind in ("candidates", "workspace"))
    assert proof["proved"], "the plan is not proved any more"
    yield "benchmarks.md", f"| KR 270, 6 joints | {len(plan['poses'])} | {plan['criterion']['log_det']:.4f} |"
    yield "benchmarks.md", f"| {100 * proof['efficiency']:.2f} % | {proof['max_sensitivity_ratio']:.4f} | {proof['boxes']:,} |"
    yield "examples.md", f"| ≥ {percent(candidates['efficiency'], 1)} ({percent(proof['efficiency'])} over the workspace) |"


def main(source, program):
    source = pathlib.Path(source)
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    if "Mathematical functions: musl" not in said:
        print(f"Skipped: the figures are those of musl's functions (scripts/setup installs musl-dev). {said}")
        sys.exit(77)
    texts = proved(planned(source, program))
    missing = [f"docs/{page} lacks: {text}" for page, text in texts if text not in (source / "docs" / page).read_text(encoding="utf-8")]
    print("\n".join(missing))
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
