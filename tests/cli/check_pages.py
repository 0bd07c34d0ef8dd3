"""Manual page and completions: check_pages.py PROGRAM. Each says what --help says; tools that are missing are named."""
import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

program = ""


def output(*words):
    return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout


def commands():
    listed = output("--help").split("Commands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines() if line.split()[0] not in ("help", "completion")]


def options(command):
    return re.findall(r"^  (?:-\w \[ )?--([a-z][a-z-]*)", output("help", command), re.M)


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_tool(self, tool, *words):
        if shutil.which(tool) is None:
            self.skipTest(f"{tool} is missing")
        run = subprocess.run([tool, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return run.stdout

    def written(self, name, *words):
        (self.folder / name).write_text(output(*words))
        return name


class Manual(Pages):
    def test_names_every_command_and_option(self):
        page = output("help", "--man").replace("\\-", "-")
        self.assertGreater(len(commands()), 5)
        for command in commands():
            section = page.split(f'.SS "posewright {command} ')[1].split(".SS")[0]
            common = page.split(".SH COMMON OPTIONS")[1]
            self.assertGreater(len(options(command)), 6)
            for option in options(command):
                self.assertIn(f"\\fB--{option}\\fR", section + common, command)

    def test_passes_mandoc(self):
        self.assertEqual(self.run_tool("mandoc", "-T", "lint", self.written("posewright.1", "help", "--man")), "")

    def test_passes_groff(self):
        page = self.run_tool("groff", "-man", "-ww", "-Tutf8", self.written("posewright.1", "help", "--man"))
        self.assertIn("posewright", page)

    def test_is_ascii_of_short_lines(self):
        for line in output("help", "--man").splitlines():
            self.assertTrue(line.isascii(), line)
            self.assertLess(len(line), 100)


class Bash(Pages):
    def complete(self, *words):
        """What bash offers for the last of the words; it splits at `=` as readline does."""
        script = self.written("completion", "completion", "bash")
        listed = " ".join(f"'{word}'" for word in words)
        text = f"source {script}; COMP_WORDS=(posewright {listed}); COMP_CWORD={len(words)}; _posewright; printf '%s\\n' \"${{COMPREPLY[@]}}\""
        return self.run_tool("bash", "-c", text).split()

    def test_script_is_well_formed(self):
        self.run_tool("bash", "-n", self.written("completion", "completion", "bash"))

    def test_script_has_no_warnings(self):
        self.run_tool("shellcheck", "-s", "bash", self.written("completion", "completion", "bash"))

    def test_offers_every_command_and_option(self):
        self.assertEqual([w for w in self.complete("") if w not in ("help", "completion", "--help", "--version")], commands())
        self.assertEqual(self.complete("help", ""), [*commands(), "--man"])
        for command in commands():
            self.assertEqual(sorted(self.complete(command, "--")), sorted("--" + o for o in options(command)))

    def test_offers_names(self):
        self.assertEqual(self.complete("ev"), ["evaluate"])
        self.assertEqual(self.complete("plan", "x.yaml", "--criterion", "test"), ["test_pose", "test_pose_max"])
        self.assertEqual(self.complete("plan", "--criterion", "=", "maxi"), ["maximin"])
        self.assertEqual(self.complete("plan", "--method", "=")[:2], ["auto", "exchange"])
        self.assertEqual(self.complete("select", "--repeats", ""), ["allow", "forbid"])
        self.assertEqual(self.complete("plan", "--candidates", ""), [])
        self.assertIn("kuka-krl", self.complete("export", "plan.json", "--to", ""))
        self.assertNotIn("kuka-krl", self.complete("evaluate", "--from", ""))
        self.assertIn("csv", self.complete("evaluate", "--from", ""))
        self.assertEqual(self.complete("completion", ""), ["bash", "zsh"])

    def test_offers_files_by_kind(self):
        for name in ("a.yaml", "a.json", "a.csv", "a.npy", "a.txt"):
            (self.folder / name).touch()
        (self.folder / "arm").mkdir()
        self.assertEqual(sorted(self.complete("plan", "a")), ["a.yaml", "arm"])
        self.assertEqual(sorted(self.complete("select", "a")), ["a.csv", "a.npy", "arm"])
        self.assertEqual(sorted(self.complete("route", "a")), ["a.json", "arm"])
        self.assertIn("a.txt", self.complete("plan", "-o", "a"))
        self.assertIn("a.txt", self.complete("export", "-o", "a"))
        self.assertEqual(self.complete("plan", "--package", "x", "=", "a"), ["arm"])


class Zsh(Pages):
    def test_script_is_well_formed(self):
        self.run_tool("zsh", "-n", self.written("_posewright", "completion", "zsh"))

    def test_names_every_command_and_option(self):
        script = output("completion", "zsh")
        for command in commands():
            section = script.split(f"\n      {command})\n")[1].split(";;")[0]
            for option in options(command):
                self.assertRegex(section, rf"--{option}[=\[}}]", command)


class Terminal(Pages):
    PROBLEM = pathlib.Path(__file__).resolve().parents[2] / "examples/five_bar/problem.yaml"

    def in_terminal(self, *words, **environment):
        """What the program writes, both streams, to a pseudo-terminal."""
        ours, its = pty.openpty()
        run = subprocess.Popen([program, *map(str, words)], stdout=its, stderr=its, env={**os.environ, "TERM": "xterm", **environment})
        os.close(its)
        text = b""
        try:
            while piece := os.read(ours, 4096):
                text += piece
        except OSError:  # the other end is closed
            pass
        os.close(ours)
        run.wait()
        return text.decode()

    def setUp(self):
        super().setUp()
        os.environ.pop("NO_COLOR", None)

    def test_errors_are_red_there_and_nowhere_else(self):
        self.assertIn("\x1b[1;31mposewright:\x1b[0m unknown command", self.in_terminal("nothing"))
        self.assertNotIn("\x1b[", self.in_terminal("nothing", NO_COLOR="1"))
        self.assertNotIn("\x1b[", self.in_terminal("nothing", TERM="dumb"))
        self.assertNotIn("\x1b[", subprocess.run([program, "nothing"], capture_output=True, text=True).stderr)

    def test_the_first_line_of_a_report_is_bold_there_and_nowhere_else(self):
        words = ["observe", self.PROBLEM, "--candidates", 50, "--variant", "links_and_offsets", "--quiet"]
        bold = self.in_terminal(*words)
        self.assertTrue(bold.startswith("\x1b[1mVariant links_and_offsets"), bold[:200])
        plain = subprocess.run([program, *map(str, words)], capture_output=True, text=True).stdout
        self.assertEqual(re.sub("\x1b\\[[01]m", "", bold).replace("\r\n", "\n"), plain)


if __name__ == "__main__":
    program = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
