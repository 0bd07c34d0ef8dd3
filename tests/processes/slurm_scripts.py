"""The scripts of docs/examples for Slurm: slurm_scripts.py SOURCE PROGRAM. Their syntax alone: no Slurm runs them here.

A shell reads them, every #SBATCH option stands before the first command and is one that sbatch has, and the options of
posewright are those of its help.
"""
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, PROGRAM = pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1))
# Long options of sbatch(1), Slurm 22.05 (https://slurm.schedmd.com/archive/slurm-22.05.8/sbatch.html), and how their values
# look. What a script uses and the list lacks is looked up there first.
TIME = r"(\d+-)?\d+(:\d+){0,2}"
SBATCH = {"array": r"\d+(-\d+)?(:\d+)?(,\d+(-\d+)?)*(%\d+)?", "chdir": r"\S+", "constraint": r"\S+", "cpus-per-task": r"\d+",
          "dependency": r"\S+", "error": r"\S+", "exclusive": "", "job-name": r"\S+", "mem": r"\d+[KMGT]?", "mem-per-cpu": r"\d+[KMGT]?",
          "nodes": r"\d+(-\d+)?", "ntasks": r"\d+", "ntasks-per-node": r"\d+", "open-mode": "append|truncate", "output": r"\S+",
          "parsable": "", "partition": r"\S+", "requeue": "", "no-requeue": "", "signal": r"\S+", "time": TIME}


def wrong_options(text):
    """What is wrong with the #SBATCH lines."""
    wrong, begun = [], False
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("#"):
            begun = begun or bool(line.strip())
        elif line.startswith("#SBATCH"):
            for word in line.split()[1:]:
                option = re.fullmatch(r"--([a-z-]+)(?:=(\S+))?", word)
                known = option and option[1] in SBATCH and re.fullmatch(SBATCH[option[1]], option[2] or "")
                if begun or not known:
                    wrong.append(f"{number}: {word}")
    return wrong


class SlurmScripts(unittest.TestCase):
    def scripts(self):
        found = sorted((SOURCE / "docs" / "examples").glob("*.sh"))
        self.assertGreaterEqual(len(found), 3)
        return found

    def test_a_shell_reads_them(self):
        for script in self.scripts():
            with self.subTest(script=script.name):
                for shell in ("bash", "sh"):
                    self.assertEqual(subprocess.run([shell, "-n", script], capture_output=True, text=True).stderr, "")

    def test_sbatch_has_their_options(self):
        for script in self.scripts():
            text = script.read_text(encoding="utf-8")
            with self.subTest(script=script.name):
                self.assertGreaterEqual(text.count("\n#SBATCH "), 3)
                self.assertEqual(wrong_options(text), [])

    def test_what_is_wrong_would_be_found(self):
        for line in ("#SBATCH --ntask=8", "#SBATCH --time=soon", "#SBATCH --array=", "#SBATCH -n 8 cpus", "echo\n#SBATCH --ntasks=8"):
            self.assertNotEqual(wrong_options("#!/bin/sh\n" + line), [], line)

    def test_posewright_has_their_options(self):
        for script in self.scripts():
            text = script.read_text(encoding="utf-8").replace("\\\n", " ")
            for command, rest in re.findall(r"\bposewright ([a-z]+) ([^\n]*)", text):
                known = subprocess.run([PROGRAM, "help", command], capture_output=True, text=True, check=True).stdout
                for option in re.findall(r"(?<= )--[a-z-]+", rest):
                    with self.subTest(script=script.name, option=option):
                        self.assertRegex(known, rf"{option}\b")


if __name__ == "__main__":
    unittest.main()
