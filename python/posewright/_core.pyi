import os
from collections.abc import Mapping
from typing import Any, Callable, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

_Floats = NDArray[np.float64]
_Path = Union[str, os.PathLike[str]]
_Report = Optional[Callable[[Progress], object]]

__version__: str

class InputError(ValueError):
    file: Optional[str]
    line: Optional[int]

class CannotDo(RuntimeError): ...

class Progress:
    @property
    def stage(self) -> str: ...
    @property
    def done(self) -> float: ...
    @property
    def total(self) -> float: ...
    @property
    def best(self) -> Optional[float]: ...
    @property
    def bound(self) -> Optional[float]: ...
    @property
    def efficiency(self) -> Optional[float]: ...

class Parameter:
    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def role(self) -> str: ...
    @property
    def nominal(self) -> float: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def sigma(self) -> Optional[float]: ...
    @property
    def variant(self) -> Optional[str]: ...
    @property
    def dropped_because(self) -> Optional[str]: ...
    @property
    def worth_identifying(self) -> Optional[bool]: ...

class Pose:
    @property
    def id(self) -> int: ...
    @property
    def candidate(self) -> Optional[int]: ...
    @property
    def measured(self) -> bool: ...
    @property
    def fixed(self) -> bool: ...
    @property
    def configuration(self) -> _Floats: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def actuators(self) -> dict[str, float]: ...
    @property
    def load_case(self) -> Optional[str]: ...
    @property
    def station(self) -> Optional[str]: ...
    @property
    def tool_pose(self) -> Optional[_Floats]: ...
    @property
    def contribution(self) -> float: ...
    @property
    def efficiency_without(self) -> Optional[float]: ...

class WorkspaceCertificate:
    @property
    def efficiency(self) -> float: ...
    @property
    def bound(self) -> float: ...
    @property
    def max_sensitivity_ratio(self) -> float: ...
    @property
    def method(self) -> str: ...
    @property
    def settled(self) -> bool: ...
    @property
    def at_most(self) -> float: ...

class Certificate:
    @property
    def efficiency(self) -> float: ...
    @property
    def bound(self) -> float: ...
    @property
    def max_sensitivity_ratio(self) -> float: ...
    @property
    def count(self) -> int: ...
    @property
    def found(self) -> int: ...
    @property
    def repeats(self) -> str: ...
    @property
    def workspace(self) -> Optional[WorkspaceCertificate]: ...

class Plan:
    @property
    def poses(self) -> list[Pose]: ...
    @property
    def configurations(self) -> _Floats: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def candidates(self) -> list[Optional[int]]: ...
    @property
    def stations(self) -> list[Optional[str]]: ...
    @property
    def load_cases(self) -> list[Optional[str]]: ...
    @property
    def contributions(self) -> _Floats: ...
    @property
    def parameters(self) -> list[Parameter]: ...
    @property
    def sigma(self) -> _Floats: ...
    @property
    def log_det(self) -> float: ...
    @property
    def log_det_full(self) -> float: ...
    @property
    def criterion(self) -> str: ...
    @property
    def criterion_value(self) -> float: ...
    @property
    def indices(self) -> dict[str, float]: ...
    @property
    def condition(self) -> float: ...
    @property
    def certificate(self) -> Optional[Certificate]: ...
    @property
    def proved_optimal(self) -> bool: ...
    @property
    def rho0(self) -> Optional[float]: ...
    @property
    def test_errors(self) -> _Floats: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def variant(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def scaling(self) -> str: ...
    @property
    def prior(self) -> bool: ...
    @property
    def reserve(self) -> bool: ...
    @property
    def robust_efficiency(self) -> NDArray[np.float64]: ...
    @property
    def seed(self) -> int: ...
    @property
    def problem_file(self) -> str: ...
    @property
    def problem_sha256(self) -> str: ...
    @property
    def validation(self) -> Optional[Plan]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_csv(self) -> str: ...
    def save(self, path: _Path, *, overwrite: bool = False) -> None: ...
    def __len__(self) -> int: ...
    def _repr_html_(self) -> str: ...

_Poses = Union[Plan, _Path, ArrayLike]

class Problem:
    def __init__(
        self,
        source: Union[_Path, Mapping[str, Any]],
        base: Optional[_Path] = None,
        *,
        packages: dict[str, Any] = ...,
        parameters: Optional[_Path] = None,
    ) -> None: ...
    @staticmethod
    def from_text(
        text: str, base: Optional[_Path] = None, *, name: str = "problem", packages: dict[str, Any] = ...
    ) -> Problem: ...
    @property
    def file(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def variants(self) -> list[str]: ...

class Coordinate:
    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def periodic(self) -> bool: ...
    @property
    def values(self) -> list[float]: ...
    @property
    def labels(self) -> list[str]: ...

class Blocks:
    @property
    def values(self) -> _Floats: ...
    @property
    def parameters(self) -> list[Parameter]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def nuisance(self) -> int: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    def __array__(self, dtype: DTypeLike = None) -> NDArray[Any]: ...
    def __len__(self) -> int: ...
    def _repr_html_(self) -> str: ...

class Model:
    @overload
    def __init__(
        self,
        problem: Problem,
        variant: str = "",
        parameters: list[str] = ...,
        *,
        candidates: Optional[int] = None,
        seed: int = 0,
        threads: int = 0,
        progress: _Report = None,
    ) -> None: ...
    @overload
    def __init__(self, problem: Problem, plan: Plan, variant: str = "", *, threads: int = 0) -> None: ...
    @property
    def variant(self) -> str: ...
    @property
    def coordinates(self) -> list[Coordinate]: ...
    @property
    def parameters(self) -> list[Parameter]: ...
    @property
    def nuisance(self) -> int: ...
    def configurations(self, poses: _Poses) -> _Floats: ...
    def blocks(self, configurations: _Poses, *, threads: int = 0) -> Blocks: ...
    def jacobians(self, configurations: _Poses) -> tuple[_Floats, _Floats]: ...
    def candidates(
        self, count: int = 10000, *, seed: int = 0, threads: int = 0, progress: _Report = None
    ) -> _Floats: ...

class Score:
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def efficiency(self) -> Optional[float]: ...

class Change:
    @property
    def poses(self) -> list[int]: ...
    @property
    def added(self) -> list[Pose]: ...
    @property
    def configurations(self) -> _Floats: ...
    @property
    def efficiency(self) -> float: ...
    @property
    def log_det(self) -> float: ...
    @property
    def rho0(self) -> Optional[float]: ...

class Evaluation:
    @property
    def plan(self) -> Plan: ...
    @property
    def scores(self) -> dict[str, Score]: ...
    @property
    def drop(self) -> Optional[Change]: ...
    @property
    def add(self) -> Optional[Change]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

class Dependency:
    @property
    def dropped(self) -> str: ...
    @property
    def terms(self) -> dict[str, float]: ...
    @property
    def remainder(self) -> float: ...
    @property
    def equation(self) -> str: ...

class Observation:
    @property
    def variant(self) -> str: ...
    @property
    def configurations(self) -> int: ...
    @property
    def rows(self) -> int: ...
    @property
    def rank(self) -> int: ...
    @property
    def exact_rank(self) -> int: ...
    @property
    def singular_values(self) -> _Floats: ...
    @property
    def parameters(self) -> list[Parameter]: ...
    @property
    def kept(self) -> list[str]: ...
    @property
    def dependencies(self) -> list[Dependency]: ...
    @property
    def near_dependencies(self) -> list[Dependency]: ...
    @property
    def indices(self) -> dict[str, float]: ...
    @property
    def smallest_poses(self) -> Optional[int]: ...
    @property
    def recommended(self) -> Optional[list[str]]: ...
    @property
    def sigma(self) -> Optional[_Floats]: ...
    def summary(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

class Motion:
    @property
    def start(self) -> int: ...
    @property
    def end(self) -> int: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def seconds(self) -> float: ...
    @property
    def change_seconds(self) -> float: ...
    @property
    def found_by(self) -> str: ...

class Route:
    @property
    def order(self) -> list[int]: ...
    @property
    def poses(self) -> list[Pose]: ...
    @property
    def configurations(self) -> _Floats: ...
    @property
    def motions(self) -> list[Motion]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def home(self) -> _Floats: ...
    @property
    def unreachable(self) -> dict[int, str]: ...
    @property
    def travel_seconds(self) -> float: ...
    @property
    def change_seconds(self) -> float: ...
    @property
    def planned_seconds(self) -> float: ...
    @property
    def optimal(self) -> bool: ...
    @property
    def problem_changed(self) -> bool: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_csv(self) -> str: ...
    def save(self, path: _Path, *, overwrite: bool = False) -> None: ...
    def _repr_html_(self) -> str: ...

class BlockEvaluation:
    @property
    def log_det(self) -> float: ...
    @property
    def log_det_full(self) -> float: ...
    @property
    def sigma(self) -> _Floats: ...
    @property
    def covariance(self) -> _Floats: ...
    @property
    def singular_values(self) -> _Floats: ...
    @property
    def indices(self) -> dict[str, float]: ...
    @property
    def condition(self) -> float: ...
    @property
    def contributions(self) -> _Floats: ...
    def value(self, criterion: str) -> float: ...
    def _repr_html_(self) -> str: ...

def blocks(
    problem: Problem, configurations: _Poses, variant: str = "", *, threads: int = 0
) -> Blocks: ...
def _shown(value: float, unit: str) -> str: ...
def criteria() -> dict[str, str]: ...
def methods() -> dict[str, str]: ...
def plan(
    problem: Problem,
    poses: Union[int, str, None] = None,
    *,
    # options
    validation: Optional[int] = None,
    gap: Optional[float] = None,
    proof_time: Optional[float] = None,
    # keys of design
    variant: Union[float, str, None] = None,
    truth: Union[float, str, None] = None,
    variants: Union[dict[str, Any], list[Any], None] = None,
    criterion: Optional[str] = None,
    method: Optional[str] = None,
    require: Optional[dict[str, Any]] = None,
    require_accuracy: Optional[str] = None,
    require_position: Union[dict[str, Any], str, None] = None,
    require_rotation: Union[dict[str, Any], str, None] = None,
    require_sigma: Optional[dict[str, Any]] = None,
    candidates: Optional[int] = None,
    candidates_from: Optional[_Poses] = None,
    restarts: Optional[int] = None,
    repeats: Union[int, str, None] = None,
    minimum_distance: Union[dict[str, Any], str, None] = None,
    minimum_distance_angle: Union[float, str, None] = None,
    minimum_distance_length: Union[float, str, None] = None,
    scaling: Optional[str] = None,
    prior: Optional[str] = None,
    reserve: Optional[bool] = None,
    robust: Union[dict[str, Any], int, None] = None,
    robust_draws: Optional[int] = None,
    robust_measure: Optional[str] = None,
    measured: Optional[_Poses] = None,
    augment: Optional[_Poses] = None,
    fixed: Optional[_Poses] = None,
    test_poses: Union[dict[str, Any], str, None] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Plan: ...
def evaluate(
    problem: Problem,
    poses: _Poses,
    *,
    # options
    drop: Optional[int] = None,
    add: Optional[int] = None,
    from_: Optional[str] = None,
    controller: Optional[str] = None,
    coupling: Optional[float] = None,
    # keys of design
    variant: Union[float, str, None] = None,
    truth: Union[float, str, None] = None,
    variants: Union[dict[str, Any], list[Any], None] = None,
    criterion: Optional[str] = None,
    method: Optional[str] = None,
    require: Optional[dict[str, Any]] = None,
    require_accuracy: Optional[str] = None,
    require_position: Union[dict[str, Any], str, None] = None,
    require_rotation: Union[dict[str, Any], str, None] = None,
    require_sigma: Optional[dict[str, Any]] = None,
    candidates: Optional[int] = None,
    candidates_from: Optional[_Poses] = None,
    restarts: Optional[int] = None,
    repeats: Union[int, str, None] = None,
    minimum_distance: Union[dict[str, Any], str, None] = None,
    minimum_distance_angle: Union[float, str, None] = None,
    minimum_distance_length: Union[float, str, None] = None,
    scaling: Optional[str] = None,
    prior: Optional[str] = None,
    reserve: Optional[bool] = None,
    robust: Union[dict[str, Any], int, None] = None,
    robust_draws: Optional[int] = None,
    robust_measure: Optional[str] = None,
    measured: Optional[_Poses] = None,
    augment: Optional[_Poses] = None,
    fixed: Optional[_Poses] = None,
    test_poses: Union[dict[str, Any], str, None] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Evaluation: ...
def init(
    robot: Optional[_Path] = None,
    *,
    # options
    tracker: bool = False,
    camera: Optional[str] = None,
    board: Optional[str] = None,
    fixed_camera: bool = False,
    arm: bool = False,
    samples: Optional[_Path] = None,
    at: Union[str, ArrayLike, None] = None,
    poses: Optional[int] = None,
    accuracy: Union[float, str, None] = None,
    base: Optional[str] = None,
    tip: Optional[str] = None,
    floor: Union[float, str, None] = None,
    xacro: Union[str, Sequence[str], None] = None,
    # own
    packages: Mapping[str, _Path] = {},
    folder: Optional[_Path] = None,
    progress: _Report = None,
) -> str: ...
def observe(
    problem: Problem,
    variant: Optional[str] = None,
    *,
    # options
    candidates: Optional[int] = None,
    poses: Optional[int] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    progress: _Report = None,
) -> dict[str, Observation]: ...
def route(
    problem: Problem,
    poses: _Poses,
    *,
    # options
    from_home: bool = False,
    closed: bool = False,
    start: Optional[int] = None,
    replace: bool = False,
    milestones: Optional[int] = None,
    settle: Optional[float] = None,
    reading: Optional[float] = None,
    from_: Optional[str] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Route: ...
def select(
    blocks: Union[Blocks, ArrayLike],
    poses: int,
    *,
    names: Optional[list[str]] = None,
    # options
    rows: Optional[int] = None,
    nuisance: Optional[int] = None,
    criterion: Optional[str] = None,
    method: Optional[str] = None,
    restarts: Optional[int] = None,
    fixed: Union[str, ArrayLike, None] = None,
    augment: Union[str, ArrayLike, None] = None,
    repeats: Union[float, str, None] = None,
    gap: Optional[float] = None,
    reserve: bool = False,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Plan: ...
def evaluate_blocks(
    blocks: Union[Blocks, ArrayLike],
    chosen: Optional[ArrayLike] = None,
    *,
    nuisance: Optional[int] = None,
    rows: Optional[int] = None,
    tolerance: Optional[ArrayLike] = None,
    prior: bool = False,
) -> BlockEvaluation: ...
def log_det(
    blocks: Union[Blocks, ArrayLike],
    chosen: Optional[ArrayLike] = None,
    *,
    nuisance: Optional[int] = None,
    rows: Optional[int] = None,
) -> float: ...

class Calibration:
    @property
    def variant(self) -> str: ...
    @property
    def converged(self) -> bool: ...
    @property
    def useful(self) -> bool: ...
    @property
    def values(self) -> dict[str, float]: ...
    @property
    def sigma(self) -> dict[str, float]: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def covariance(self) -> _Floats: ...
    @property
    def frames(self) -> dict[str, _Floats]: ...
    @property
    def noise_factor(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_html(self) -> str: ...
    def parameters_file(self) -> str: ...
    def save(self, path: _Path, *, overwrite: bool = False, force: bool = False) -> None: ...
    def _repr_html_(self) -> str: ...

class Simulation:
    @property
    def confirmed(self) -> bool: ...
    @property
    def verdict(self) -> list[str]: ...
    @property
    def first_readings(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...
    def to_html(self) -> str: ...

class Comparison:
    @property
    def notes(self) -> list[str]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...
    def to_html(self) -> str: ...

class Compensation:
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    @property
    def configurations(self) -> _Floats: ...
    @property
    def actuators(self) -> Optional[_Floats]: ...
    @property
    def compensated(self) -> list[bool]: ...
    @property
    def before(self) -> _Floats: ...
    @property
    def after(self) -> _Floats: ...
    @property
    def failures(self) -> list[str]: ...
    @property
    def text(self) -> Optional[str]: ...
    @property
    def notes(self) -> list[str]: ...
    def _repr_html_(self) -> str: ...

class NextPoses:
    def _repr_html_(self) -> str: ...
    @property
    def configurations(self) -> _Floats: ...
    @property
    def poses(self) -> list[Pose]: ...
    @property
    def stop(self) -> bool: ...
    @property
    def verdict(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def error(self) -> Optional[float]: ...
    @property
    def upper(self) -> Optional[float]: ...
    @property
    def estimates(self) -> dict[str, float]: ...
    @property
    def notes(self) -> list[str]: ...
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def __len__(self) -> int: ...

class Stations:
    def summary(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_html(self) -> str: ...
    def __len__(self) -> int: ...
    def _repr_html_(self) -> str: ...

class Exported:
    @property
    def files(self) -> dict[str, bytes]: ...
    @property
    def notes(self) -> list[str]: ...
    def save(self, folder: _Path = ".", *, overwrite: bool = False) -> list[os.PathLike[str]]: ...
    def _repr_html_(self) -> str: ...

class Report:
    @property
    def notes(self) -> list[str]: ...
    def to_html(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def save(self, path: _Path, *, overwrite: bool = False) -> None: ...
    def _repr_html_(self) -> str: ...

def calibrate(
    problem: Problem,
    data: Union[_Path, Sequence[_Path]],
    variant: Optional[str] = None,
    *,
    # options
    weights: Optional[str] = None,
    no_prior: bool = False,
    validate: Optional[_Path] = None,
    moved: Optional[str] = None,
    hold_back: Optional[int] = None,
    in_steps: bool = False,
    profile: Union[str, Sequence[str], None] = None,
    interpolate: bool = False,
    dh: Optional[str] = None,
    # own
    threads: int = 0,
    progress: _Report = None,
) -> Calibration: ...
def simulate(
    problem: Problem,
    poses: _Poses,
    variant: Optional[str] = None,
    *,
    # options
    draws: Optional[int] = None,
    truth: Optional[str] = None,
    truth_nominal: bool = False,
    truth_repeatability: Union[float, str, None] = None,
    truth_independent: Union[float, str, None] = None,
    truth_joints: Union[float, str, None] = None,
    no_prior: bool = False,
    exact: bool = False,
    profile: bool = False,
    weights: Optional[str] = None,
    missing: Optional[float] = None,
    outliers: Optional[float] = None,
    outlier_size: Optional[float] = None,
    validation: Optional[int] = None,
    candidates: Optional[int] = None,
    from_: Optional[str] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Simulation: ...
def compensate(
    problem: Problem,
    poses: _Poses,
    *,
    # options
    partial: bool = False,
    from_: Optional[str] = None,
    controller: Optional[_Path] = None,
    coupling: Optional[float] = None,
    tool: Union[str, Sequence[str], None] = None,
    base: Union[str, Sequence[str], None] = None,
    world: Union[str, Sequence[str], None] = None,
    flange: Union[str, Sequence[str], None] = None,
    near: Union[str, Sequence[str], None] = None,
    line_deviation: Union[float, str, None] = None,
    with_base: bool = False,
    without_tool: bool = False,
    position_only: bool = False,
    elastic_target: bool = False,
    most: Union[float, str, None] = None,
    dh: Optional[str] = None,
    # own
    threads: int = 0,
    progress: _Report = None,
) -> Compensation: ...
def compare(
    problem: Problem,
    plans: Mapping[str, _Poses] = ...,
    *,
    # options
    variant: Union[str, Sequence[str], None] = None,
    truth: Optional[str] = None,
    from_: Optional[str] = None,
    # keys of design
    criterion: Optional[str] = None,
    method: Optional[str] = None,
    poses: Union[int, str, None] = None,
    require: Optional[dict[str, Any]] = None,
    require_accuracy: Optional[str] = None,
    require_position: Union[dict[str, Any], str, None] = None,
    require_rotation: Union[dict[str, Any], str, None] = None,
    require_sigma: Optional[dict[str, Any]] = None,
    candidates: Optional[int] = None,
    candidates_from: Optional[_Poses] = None,
    restarts: Optional[int] = None,
    repeats: Union[int, str, None] = None,
    minimum_distance: Union[dict[str, Any], str, None] = None,
    minimum_distance_angle: Union[float, str, None] = None,
    minimum_distance_length: Union[float, str, None] = None,
    scaling: Optional[str] = None,
    prior: Optional[str] = None,
    reserve: Optional[bool] = None,
    robust: Union[dict[str, Any], int, None] = None,
    robust_draws: Optional[int] = None,
    robust_measure: Optional[str] = None,
    measured: Optional[_Poses] = None,
    augment: Optional[_Poses] = None,
    fixed: Optional[_Poses] = None,
    test_poses: Union[dict[str, Any], str, None] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    progress: _Report = None,
) -> Comparison: ...
def next_poses(
    problem: Problem,
    data: Optional[_Path] = None,
    poses: int = 1,
    *,
    # options
    required: Union[float, str, None] = None,
    variant: Optional[str] = None,
    criterion: Optional[str] = None,
    no_prior: bool = False,
    candidates: Optional[int] = None,
    candidates_from: Optional[_Poses] = None,
    state: Optional[_Path] = None,
    restart: bool = False,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> NextPoses: ...
def stations(
    problem: Problem,
    *,
    # options
    choose: Optional[int] = None,
    pairs: bool = False,
    full: Optional[int] = None,
    # keys of design
    variant: Union[float, str, None] = None,
    truth: Union[float, str, None] = None,
    variants: Union[dict[str, Any], list[Any], None] = None,
    criterion: Optional[str] = None,
    method: Optional[str] = None,
    poses: Union[int, str, None] = None,
    require: Optional[dict[str, Any]] = None,
    require_accuracy: Optional[str] = None,
    require_position: Union[dict[str, Any], str, None] = None,
    require_rotation: Union[dict[str, Any], str, None] = None,
    require_sigma: Optional[dict[str, Any]] = None,
    candidates: Optional[int] = None,
    candidates_from: Optional[_Poses] = None,
    restarts: Optional[int] = None,
    repeats: Union[int, str, None] = None,
    minimum_distance: Union[dict[str, Any], str, None] = None,
    minimum_distance_angle: Union[float, str, None] = None,
    minimum_distance_length: Union[float, str, None] = None,
    scaling: Optional[str] = None,
    prior: Optional[str] = None,
    reserve: Optional[bool] = None,
    robust: Union[dict[str, Any], int, None] = None,
    robust_draws: Optional[int] = None,
    robust_measure: Optional[str] = None,
    measured: Optional[_Poses] = None,
    augment: Optional[_Poses] = None,
    fixed: Optional[_Poses] = None,
    test_poses: Union[dict[str, Any], str, None] = None,
    # own
    seed: int = 0,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Stations: ...
def export(
    plan: Union[Plan, Route, _Path],
    to: str,
    problem: Optional[Problem] = None,
    *,
    # options
    name: Optional[str] = None,
    speed: Optional[int] = None,
    settle: Optional[float] = None,
    wait: Optional[float] = None,
    digital_output: Union[float, str, None] = None,
    digital_input: Union[float, str, None] = None,
    tool: Union[float, str, None] = None,
    payload: Union[float, str, None] = None,
    base: Optional[int] = None,
    coupling: Optional[float] = None,
    controller: Optional[_Path] = None,
    station: Optional[str] = None,
    group: Optional[str] = None,
    unchecked: bool = False,
    # own
) -> Exported: ...
def report(
    problem: Problem,
    plan: _Path,
    *,
    # options
    route: Optional[_Path] = None,
    brief: bool = False,
    # own
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: _Report = None,
) -> Report: ...
