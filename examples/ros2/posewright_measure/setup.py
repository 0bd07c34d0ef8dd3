from setuptools import setup

NAME = "posewright_measure"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/measure.launch.py"]),
    ],
    install_requires=["setuptools"],
    license="BSD-3-Clause",
    entry_points={"console_scripts": [f"measure = {NAME}.measure:main"]},
)
