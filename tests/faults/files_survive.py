"""Commands that write, killed, interrupted, without room and without descriptors: files_survive.py PROGRAM SOURCE [MOMENTS].

After a kill there are the old files, the new ones, or data without the program (the plan) that reads them; after an
interrupt the best so far; after a failure the old files, and what was found elsewhere.
"""

import hashlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1))
MOMENTS = int(sys.argv.pop(1)) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 3
RANDOM = random.Random(MOMENTS)

ARM = """<robot name="arm"><link name="base"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-2.9" upper="2.9" velocity="2" effort="1"/></joint><link name="l1"/>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.1 0 0.4"/><axis xyz="0 1 0"/>
<limit lower="-1.7" upper="1.7" velocity="2" effort="1"/></joint><link name="l2"/>
<joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
<limit lower="-1.7" upper="1.7" velocity="2" effort="1"/></joint><link name="l3"/>
<joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="0.4 0 0.1"/><axis xyz="1 0 0"/>
<limit lower="-2.9" upper="2.9" velocity="3" effort="1"/></joint><link name="l4"/>
<joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
<limit lower="-2.0" upper="2.0" velocity="3" effort="1"/></joint><link name="l5"/>
<joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.1 0 0"/><axis xyz="1 0 0"/>
<limit lower="-2.9" upper="2.9" velocity="3" effort="1"/></joint><link name="l6"/></robot>
"""
PROBLEM = """posewright: 1
robot: {urdf: arm.urdf, tip: l6}
measurement:
  type: points
  targets: {P1: [0.1, -0.05, -0.09], P2: [0.1, -0.05, 0.09], P3: [0.11, 0.1, 0]}
  device: {type: isotropic, noise: "0.1 mm"}
variants:
  geometric: {parameters: ["j2.x", "j2.offset", "j3.offset", "j4.offset", "j5.offset"], nuisance: ["base.*"]}
design: {poses: 12, candidates: 300, restarts: 3, method: exchange}
"""


# Until the program's first line, while its libraries are loaded, signals do what they always do.
LOADING = 0.5


def run(folder, *arguments, **options):
    return subprocess.run([str(PROGRAM), *arguments], cwd=folder, capture_output=True, text=True, **options)


def content(path):
    """Of a file; a plan's without the seconds that it took."""
    if path.name != "plan.json":
        return digest(path)
    plan = json.loads(path.read_text())
    del plan["statistics"]["seconds"]
    return json.dumps(plan)


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


class Folder:
    """A folder with a problem, a plan and a route of it, made once and copied."""

    made = None

    def __init__(self):
        if Folder.made is None:
            Folder.made = pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
            (Folder.made / "arm.urdf").write_text(ARM)
            (Folder.made / "problem.yaml").write_text(PROBLEM)
            for arguments in (["plan", "problem.yaml"], ["route", "plan.json", "--from-home"],
                              ["simulate", "problem.yaml", "plan.json", "--draws", "2", "--data", "measured.csv"]):
                done = run(Folder.made, *arguments)
                assert done.returncode == 0, done.stderr
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
        for path in Folder.made.iterdir():
            shutil.copy(path, self.path)

    def __enter__(self):
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path)


# Commands that write: arguments, and which files belong together (what the others are for, last).
WRITING = [
    (["plan", "problem.yaml", "--seed", "7"], ["poses.csv", "plan.json"]),
    (["route", "plan.json", "--from-home", "--seed", "7", "--closed"], ["route.json"]),
    (["export", "route.json", "--to", "kuka-krl", "--speed", "5", "-o", "out/"], ["out/CALPOSES.dat", "out/CALPOSES.src"]),
    (["export", "route.json", "--to", "staubli-val3", "--speed", "5", "-o", "out/"],
     ["out/CALPOSES/CALPOSES.dtx", "out/CALPOSES/start.pgx", "out/CALPOSES/CALPOSES.pjx"]),
    (["calibrate", "problem.yaml", "measured.csv", "-o", "parameters.yaml"], ["parameters.yaml"]),
    (["simulate", "problem.yaml", "plan.json", "--draws", "2", "--seed", "9", "--data", "data.csv"], ["data.csv"]),
    (["report", "plan.json", "--brief"], ["report.html"]),
]


def prepare(folder, command):
    """An older version of the same files, by the same command at other options."""
    other = [{"7": "3", "9": "4", "5": "9"}.get(word, word) for word in command]
    done = run(folder, *other)
    assert done.returncode == 0, done.stderr


def versions(folder, files):
    return [content(folder / name) if (folder / name).is_file() else None for name in files]


class Killed(unittest.TestCase):
    """At random moments of the whole run, most of them near its end, where files are written."""

    def moments(self, seconds):
        return [seconds * (RANDOM.random() if i % 3 == 0 else 1 - 0.15 * RANDOM.random() ** 2) for i in range(MOMENTS)]

    def check(self, command, files, kill):
        with Folder() as folder:
            prepare(folder, command)
            extra = ["--force"] if "data.csv" in files else []
            old = versions(folder, files)
            with Folder() as other:
                begin = time.monotonic()
                self.assertEqual(run(other, *command).returncode, 0)
                seconds = time.monotonic() - begin
                new = versions(other, files)
            self.assertNotIn(None, new)
            for moment in self.moments(seconds):
                process = subprocess.Popen([str(PROGRAM), *command, *extra], cwd=folder, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.DEVNULL)
                try:
                    process.wait(moment)
                except subprocess.TimeoutExpired:
                    process.send_signal(kill)
                code = process.wait(20)
                now = versions(folder, files)
                kill_name = signal.Signals(kill).name
                if kill == signal.SIGKILL:
                    old_or_new = now in (old, new) or now[-1] is None
                    self.assertTrue(old_or_new, f"{kill_name} at {moment:.3f} s: {command}")
                else:
                    if code == -kill and moment < LOADING:
                        self.assertIn(now, (old, new))
                        continue
                    self.assertIn(code, (0, 130), f"{kill_name} at {moment:.3f} s: {command}")
                    # A search that is ended early keeps its best so far, which is another plan.
                    whole = now in (old, new) or (code == 130 and None not in now)
                    self.assertTrue(whole, f"{kill_name} at {moment:.3f} s: {command}")
                    if "plan.json" in files:
                        self.consistent(folder)
                if now[-1] is None or now not in (old, new):
                    for name in files:
                        (folder / name).unlink(missing_ok=True)
                    prepare(folder, command)

    def consistent(self, folder):
        plan = json.loads((folder / "plan.json").read_text())
        self.assertEqual({file["path"]: file["sha256"] for file in plan["files"]},
                         {"poses.csv": digest(folder / "poses.csv")})

    def test_at_once_leaves_no_mixture(self):
        for command, files in WRITING:
            with self.subTest(command=command):
                self.check(command, files, signal.SIGKILL)

    def test_politely_leaves_old_or_new_and_the_documented_code(self):
        for command, files in WRITING:
            for kill in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                with self.subTest(command=command, signal=kill):
                    self.check(command, files, kill)


class Interrupted(unittest.TestCase):
    def start(self, folder, *arguments, **options):
        return subprocess.Popen([str(PROGRAM), *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                **options)

    LONG = ["plan", "problem.yaml", "--method", "tabu", "--restarts", "100000", "--candidates", "2000", "--force",
            "-o", "best.json", "--poses-csv", "best.csv"]

    def test_a_search_keeps_its_best_so_far_whatever_asks_it_to_stop(self):
        for kill in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with Folder() as folder:
                process = self.start(folder, *self.LONG)
                time.sleep(3)
                asked = time.monotonic()
                process.send_signal(kill)
                process.communicate()
                self.assertLess(time.monotonic() - asked, 5)
                self.assertEqual(process.returncode, 130)
                self.assertTrue(json.loads((folder / "best.json").read_text())["interrupted"])
                self.assertEqual(len((folder / "best.csv").read_text().splitlines()), 13)

    def test_nohup_stays_nohup(self):
        with Folder() as folder:
            process = self.start(folder, *self.LONG, "--time-limit", "4",
                                 preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
            time.sleep(1)
            process.send_signal(signal.SIGHUP)
            process.communicate()
            self.assertEqual(process.returncode, 0)

    def test_reading_ends_with_the_documented_code(self):
        for arguments in (["plan", "pipe"], ["calibrate", "problem.yaml", "pipe"], ["route", "pipe"],
                          ["export", "pipe", "--to", "csv"]):
            with Folder() as folder:
                os.mkfifo(folder / "pipe")
                process = self.start(folder, *arguments)
                time.sleep(1.5)
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=5)
                self.assertEqual(process.returncode, 130, arguments)


class Room(unittest.TestCase):
    def plan(self, folder, *arguments, limit=None):
        def limited():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        environment = dict(os.environ, TMPDIR=str(folder / "temporary"))
        (folder / "temporary").mkdir(exist_ok=True)
        return run(folder, "plan", "problem.yaml", "--seed", "5", *arguments, env=environment,
                   preexec_fn=limited if limit is not None else None)

    def test_a_full_disk_leaves_the_old_files_and_tells_the_plan(self):
        with Folder() as folder:
            before = {name: digest(folder / name) for name in ("plan.json", "poses.csv")}
            done = self.plan(folder, limit=4000)
            self.assertEqual(done.returncode, 1)
            self.assertIn("cannot be written", done.stderr)
            self.assertIn("12 poses for variant geometric", done.stdout)
            self.assertEqual({name: digest(folder / name) for name in before}, before)
            self.assertEqual([p.name for p in folder.iterdir() if "json." in p.name or "csv." in p.name], [])

    def test_what_has_no_room_here_is_saved_elsewhere(self):
        if os.geteuid() != 0:
            self.skipTest("mounting needs root")
        with Folder() as folder:
            (folder / "small").mkdir()
            if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", folder / "small"],
                              capture_output=True).returncode != 0:
                self.skipTest("nothing can be mounted here")
            try:
                done = self.plan(folder, "-o", "small/plan.json", "--poses-csv", "small/poses.csv")
                self.assertEqual(done.returncode, 1)
                self.assertEqual(list((folder / "small").iterdir()), [])
            finally:
                subprocess.run(["umount", folder / "small"], check=True)
            saved = done.stderr.strip().split("saved as ")[1].split(", ")
            self.assertEqual([pathlib.Path(name).name for name in saved], ["poses.csv", "plan.json"])
            plan = json.loads(pathlib.Path(saved[1]).read_text())
            self.assertEqual(plan["seed"], 5)
            self.assertEqual(plan["files"][0]["sha256"], digest(pathlib.Path(saved[0])))

    def test_a_folder_or_file_that_is_read_only_is_told_before_the_search(self):
        with Folder() as folder:
            (folder / "plan.json").chmod(0o444)
            done = self.plan(folder)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("protected against writing", done.stderr)
            done = self.plan(folder, "-o", "no/such/plan.json")
            self.assertEqual((done.returncode, done.stdout), (1, ""))

    def test_little_memory_gives_one_line(self):
        for megabytes in (60, 90, 120, 160, 250):
            with Folder() as folder:
                def limited(size=megabytes << 20):
                    resource.setrlimit(resource.RLIMIT_AS, (size, size))
                before = contents(folder)
                done = run(folder, "plan", "problem.yaml", "--candidates", "200000", "--threads", "1",
                           preexec_fn=limited)
                if done.returncode == 127 or "shared libraries" in done.stderr:
                    continue  # not even loaded
                self.assertIn(done.returncode, (0, 1), f"{megabytes} MB: {done.stderr[:300]}")
                if done.returncode == 1:
                    self.assertEqual(done.stderr.count("\n"), 1, done.stderr[:300])
                    self.assertEqual(contents(folder), before)


class Descriptors(unittest.TestCase):
    def shell(self, folder, text):
        return subprocess.run(["bash", "-c", text.replace("posewright", str(PROGRAM))], cwd=folder, capture_output=True,
                              text=True)

    def test_messages_that_nobody_hears_cost_no_result(self):
        for redirection in ("2>&-", "2>/dev/full", "2>&1 >/dev/null | true; exit ${PIPESTATUS[0]}"):
            with Folder() as folder:
                old = digest(folder / "plan.json")
                done = self.shell(folder, "posewright plan problem.yaml --seed 6 --verbose " + redirection)
                self.assertEqual(done.returncode, 0, redirection + done.stderr)
                self.assertNotEqual(digest(folder / "plan.json"), old)

    def test_a_table_that_nobody_takes_is_an_error_after_the_files_are_written(self):
        for redirection in (">&-", ">/dev/full", "| true; exit ${PIPESTATUS[0]}", "<&- >&- 2>&-"):
            with Folder() as folder:
                old = digest(folder / "plan.json")
                done = self.shell(folder, "posewright plan problem.yaml --seed 6 --json " + redirection)
                # A reader that is gone may still have taken the first bytes of a pipe.
                self.assertIn(done.returncode, (0, 1) if "true" in redirection else (1,), redirection)
                self.assertNotEqual(digest(folder / "plan.json"), old)
                self.assertTrue(json.loads((folder / "plan.json").read_text())["poses"])

    def test_a_house_without_home_is_fine(self):
        with Folder() as folder:
            self.assertEqual(run(folder, "plan", "problem.yaml", env={}).returncode, 0)


class Places(unittest.TestCase):
    def test_devices_and_pipes_are_written_to_and_stay(self):
        with Folder() as folder:
            done = run(folder, "plan", "problem.yaml", "-o", "/dev/null", "--poses-csv", "/dev/stderr")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
            self.assertTrue(done.stderr.startswith("pose,"), done.stderr[:80])
            os.mkfifo(folder / "pipe")
            reader = subprocess.Popen(["cat", "pipe"], cwd=folder, stdout=subprocess.PIPE, text=True)
            done = run(folder, "plan", "problem.yaml", "-o", "pipe", "--poses-csv", "-")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(reader.communicate()[0])["schema"], "posewright/plan/1")
            self.assertTrue(stat.S_ISFIFO(os.stat(folder / "pipe").st_mode))

    def test_links_are_followed_and_modes_kept(self):
        with Folder() as folder:
            (folder / "elsewhere").mkdir()
            (folder / "link.json").symlink_to("elsewhere/plan.json")
            for mode in (0o640, 0o600):
                done = run(folder, "plan", "problem.yaml", "-o", "link.json", "--poses-csv", "-")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue((folder / "link.json").is_symlink())
                if mode == 0o600:
                    self.assertEqual((folder / "elsewhere" / "plan.json").stat().st_mode & 0o777, 0o640)
                (folder / "elsewhere" / "plan.json").chmod(0o640)

    def test_one_file_by_two_names_is_refused(self):
        with Folder() as folder:
            for first, second in (("x", "./x"), ("new", str(folder / "new")), ("link", "x")):
                (folder / "link").unlink(missing_ok=True)
                (folder / "link").symlink_to("x")
                done = run(folder, "plan", "problem.yaml", "-o", first, "--poses-csv", second)
                self.assertEqual(done.returncode, 2, (first, second))
                self.assertIn("two outputs", done.stderr)

    def test_what_has_no_end_is_no_input(self):
        with Folder() as folder:
            for arguments in (["plan", "/dev/zero"], ["plan", "problem.yaml", "--candidates-from", "/dev/zero"],
                              ["calibrate", "problem.yaml", "/dev/urandom"], ["export", "/dev/zero", "--to", "csv"]):
                done = run(folder, *arguments, timeout=20)
                self.assertEqual(done.returncode, 2, arguments)
                self.assertIn("is a device", done.stderr)


class Owned(unittest.TestCase):
    """Nothing a user gave is replaced silently."""

    def test_the_same_command_twice_needs_no_force(self):
        with Folder() as folder:
            for _ in range(2):
                self.assertEqual(run(folder, "plan", "problem.yaml").returncode, 0)

    def test_readings_in_a_list_of_poses_are_kept(self):
        with Folder() as folder:
            lines = (folder / "poses.csv").read_text().splitlines()
            filled = "\n".join([lines[0] + ",P1.x [m]"] + [line + ",0.1" for line in lines[1:]]) + "\n"
            measured = (folder / "measured.csv").read_text()
            for text in (filled, measured, measured.replace("id,", "pose,", 1), lines[0] + "\n"):
                (folder / "poses.csv").write_text(text)
                done = run(folder, "plan", "problem.yaml")
                self.assertEqual(done.returncode, 1)
                self.assertIn("poses.csv exists and is not known to be written by posewright", done.stderr)
                self.assertEqual((folder / "poses.csv").read_text(), text)
            self.assertEqual(run(folder, "plan", "problem.yaml", "--force").returncode, 0)

    def test_inputs_are_never_replaced_not_even_by_force(self):
        with Folder() as folder:
            before = contents(folder)
            for arguments in (["plan", "problem.yaml", "-o", "arm.urdf"], ["plan", "problem.yaml", "-o", "problem.yaml"],
                              ["plan", "problem.yaml", "--candidates-from", "measured.csv", "--poses-csv", "measured.csv"],
                              ["calibrate", "problem.yaml", "measured.csv", "-o", "measured.csv"],
                              ["route", "plan.json", "-o", "plan.json"], ["report", "plan.json", "-o", "arm.urdf"],
                              ["export", "plan.json", "--to", "csv", "-o", "plan.json"]):
                done = run(folder, *arguments, "--force")
                self.assertEqual(done.returncode, 2, arguments)
                self.assertIn("is an input", done.stderr)
                self.assertEqual(contents(folder), before, arguments)


class Encodings(unittest.TestCase):
    def plan(self, folder, declaration, encoding):
        text = declaration + ARM.replace("j2", "Gel\u00e4nk").replace("<robot", "\n<robot", 1)
        (folder / "arm.urdf").write_bytes(text.encode(encoding))
        (folder / "problem.yaml").write_text(PROBLEM.replace('"j2.x", "j2.offset", ', ""), encoding="utf-8")
        return run(folder, "plan", "problem.yaml", "--json", "--force")

    def test_a_declared_encoding_is_converted(self):
        for name, encoding in (("ISO-8859-1", "latin-1"), ("windows-1252", "cp1252"), ("UTF-8", "utf-8"),
                               ("UTF-16", "utf-16")):
            with Folder() as folder:
                done = self.plan(folder, f'<?xml version="1.0" encoding="{name}"?>', encoding)
                self.assertEqual(done.returncode, 0, name + done.stderr)
                names = json.loads(done.stdout)["poses"][0]["names"]
                self.assertIn("Gel\u00e4nk", names)

    def test_any_other_is_refused_at_the_start_with_its_line(self):
        with Folder() as folder:
            done = self.plan(folder, "", "latin-1")
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, r"arm\.urdf:\d+: byte 0xe4 is not text; a text file in UTF-8 is needed")
            done = self.plan(folder, '<?xml version="1.0" encoding="EBCDIC-XX"?>', "latin-1")
            self.assertEqual(done.returncode, 2)
            self.assertIn("encoding 'EBCDIC-XX' is not known", done.stderr)


if __name__ == "__main__":
    try:
        unittest.main()
    finally:
        if Folder.made is not None:
            shutil.rmtree(Folder.made)
