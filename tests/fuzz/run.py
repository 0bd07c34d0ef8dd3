"""Fuzzes every reader of files: run.py PROGRAM SOURCE [SECONDS|INPUTSx [TARGET...]].

PROGRAM is the fuzzer of a build with sanitizers. Each target gets SECONDS (2) or, written 1000000x, that many inputs, and begins
with files of the examples, the golden files, and what once went wrong (tests/fuzz/past/TARGET). Exit status 1 if anything goes wrong; the input is left in crash-*."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
LONG = sys.argv[3] if len(sys.argv) > 3 else "2"
COUNTED = LONG.endswith("x")

STL = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e-3 0\nendloop\nendfacet\nendsolid\n"
BINARY = b" " * 80 + (1).to_bytes(4, "little") + bytes(50)
OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 -1//1\n"
NPY = b"\x93NUMPY\x01\x00F\x00{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3, 2), }          \n" + bytes(48)
MEASURED = (b"id,j1 [deg],j2 [mm],P1.x [mm],P1.y [mm],P1.z [mm],P2.x [mm],P2.y [mm],P2.z [mm]\n1,10,20,1,2,3,4,5,6\n"
            b"1,10,20,1,,3,4,5,6\n2,-10,2.5e1,1,2,3,4,5,nan\n")
SAMPLES = (b"parameters: {calibration_type: eye_on_base}\nsamples:\n- robot: {translation: {x: 0, y: 0, z: 1}, rotation: {x: 0, y: 0, z: 0, w: 1}}\n"
           b"  tracking: {translation: {x: .nan, y: 0, z: 1}, rotation: {x: 0, y: 0, z: 0, w: 1}}\n",
           b"- effector_wrt_world: [1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 4, 0, 0, 0, 1]\n  object_wrt_sensor: [1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 4, 0, 0, 0, 1]\n")
SRDF = b'<robot name="r"><disable_collisions link1="a" link2="b" reason="Never"/></robot>'
GROUPS = (b'<robot name="r"><group name="arm"><chain base_link="a" tip_link="b"/></group></robot>',
          b'<robot name="r"><group name="g"><joint name="j"/></group><group name="arm"><group name="g"/></group></robot>')
SCENE = (b"(noname)+\n* table\n1 2.5 0.8\n0 0 0 1\n1\nbox\n2 1 0.1\n0 0 -0.05\n0 0 0 1\n0 0 0 0\n1\ncorner\n1 0 0\n0 0 0 1\n.\n",
         b"s\n* m\n2\nmesh\n3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n0 0 0\n0 0 0 1\n1 0 0 1\nplane\n0 0 1 0.5\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n")
PARAMETERS = b"posewright_parameters: 1\nvariant: all\nvalues:\n  j1.offset: {value: 0.1 deg, nominal: 0, unit: rad}\n"
SETTINGS = (b"sign: [1, -1]\nzero_deg: [0, 90]\nrange_deg: [[-1, 2], [3, 4]]\ncoupling: -1\naxes: [A1, A2]\ndecimals: 4\n"
            b"pulses_per_degree: [1e3, 2]\npivot_mm: [0, 0, 1]\n")


def files(*patterns):
    return [path.read_bytes() for pattern in patterns for path in sorted(SOURCE.glob(pattern)) if path.is_file()]


def lists():
    """A first byte for the format, then the list: of every format each file once would be too many."""
    bytes_of = files("tests/formats/golden/*.yaml", "tests/formats/golden/*.csv", "tests/formats/golden/*.json",
                     "tests/formats/golden/*.txt", "tests/formats/golden/*.npy", "tests/formats/golden/*.srdf")
    return [bytes([k]) + text for k in range(14) for text in bytes_of[k::5]]


def programs():
    """A first byte for the language, then a program of it."""
    folders = [("krl", "kuka-krl/*.src", "kuka-krl/*.dat"), ("rapid", "*.mod"), ("tp", "*.LS"), ("urscript", "*.script"), ("inform", "*.JBI"),
               ("val3", "val3/*/*.dtx", "val3/*/*.pgx"), ("trajectory", "joint_trajectory*.yaml")]
    return [bytes([k]) + text for k, (corpus, *golden) in enumerate(folders)
            for text in files(f"tests/programs/corpus/{corpus}/**/*.[!a]*", *(f"tests/formats/golden/{pattern}" for pattern in golden))]


SEEDS = {
    "problem": lambda: files("examples/**/*.yaml"),
    "urdf": lambda: files("examples/**/*.urdf"),
    "stl": lambda: [STL, BINARY],
    "obj": lambda: [OBJ],
    "npy": lambda: [NPY, *files("tests/formats/golden/*.npy")],
    "blocks": lambda: [NPY, b"a,b\n1,2\n3,4\n5,6\n", b"# c\n1,2\n3e-1,4\n5,6\n"],
    "measured": lambda: [MEASURED],
    "sequence": lambda: files("tests/formats/golden/*.json"),
    "parameters": lambda: [PARAMETERS],
    "samples": lambda: [*SAMPLES, *files("tests/formats/golden/*.samples")],
    "scene": lambda: [*SCENE],
    "srdf": lambda: [SRDF, *GROUPS, *files("tests/formats/golden/*.srdf")],
    "settings": lambda: [SETTINGS, *files("controllers/*.yaml", "tests/formats/golden/yaskawa.yaml")],
    "lists": lists,
    "programs": programs,
}


def fuzz(target, folder):
    """Inputs tried, and whether all went well."""
    corpus = folder / target
    corpus.mkdir()
    for k, seed in enumerate(SEEDS[target]()):
        (corpus / f"seed-{k}").write_bytes(seed)
    for path in (SOURCE / "tests/fuzz/past" / target).glob("*"):
        shutil.copy(path, corpus)
    seed = 0 if COUNTED or float(LONG) > 10 else 1  # a short run is the same each time
    length = f"-runs={int(LONG[:-1])}" if COUNTED else f"-max_total_time={LONG}"
    command = [PROGRAM, length, "-rss_limit_mb=3000", "-timeout=20", "-max_len=20000", f"-seed={seed}",
               "-print_final_stats=1", "-detect_leaks=1", corpus]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, errors="replace", cwd=os.getcwd(),
                          env=os.environ | {"POSEWRIGHT_FUZZ_TARGET": target, "ASAN_OPTIONS": "allocator_may_return_null=1"})
    runs = re.search(r"stat::number_of_executed_units:\s*(\d+)", done.stderr)
    if done.returncode:
        print(done.stderr[-3000:])
    print(f"{target}: {int(runs[1]) if runs else 0} inputs{'' if done.returncode == 0 else '  FAILED'}", flush=True)
    return done.returncode == 0


with tempfile.TemporaryDirectory() as name:
    good = [fuzz(target, pathlib.Path(name)) for target in sys.argv[4:] or SEEDS]
sys.exit(0 if all(good) else 1)
