"""Which poses to measure before a robot is calibrated, and how good the result will be.

    import posewright as pw
    problem = pw.Problem("problem.yaml")
    plan = pw.plan(problem, poses=18)
    print(plan.summary())

All values are SI: m, rad, N. Wrong input raises InputError (a ValueError), what cannot be done CannotDo (a
RuntimeError). docs/python.md shows every function.
"""

from ._core import (
    BlockEvaluation,
    Blocks,
    Calibration,
    CannotDo,
    Certificate,
    Change,
    Comparison,
    Compensation,
    Coordinate,
    Dependency,
    Evaluation,
    Exported,
    InputError,
    Model,
    Motion,
    NextPoses,
    Observation,
    Parameter,
    Plan,
    Pose,
    Problem,
    Progress,
    Report,
    Route,
    Score,
    Simulation,
    Stations,
    WorkspaceCertificate,
    __version__,
    blocks,
    calibrate,
    compare,
    compensate,
    criteria,
    evaluate,
    evaluate_blocks,
    export,
    init,
    log_det,
    methods,
    next_poses,
    observe,
    plan,
    report,
    route,
    select,
    simulate,
    stations,
)

__all__ = [
    "BlockEvaluation",
    "Blocks",
    "Calibration",
    "CannotDo",
    "Certificate",
    "Change",
    "Comparison",
    "Compensation",
    "Coordinate",
    "Dependency",
    "Evaluation",
    "Exported",
    "InputError",
    "Model",
    "Motion",
    "NextPoses",
    "Observation",
    "Parameter",
    "Plan",
    "Pose",
    "Problem",
    "Progress",
    "Report",
    "Route",
    "Score",
    "Simulation",
    "Stations",
    "WorkspaceCertificate",
    "__version__",
    "blocks",
    "calibrate",
    "compare",
    "compensate",
    "criteria",
    "evaluate",
    "evaluate_blocks",
    "export",
    "init",
    "log_det",
    "methods",
    "next_poses",
    "observe",
    "plan",
    "report",
    "route",
    "select",
    "simulate",
    "stations",
]

from . import _display as _display_of_results

_display_of_results.install()

# Where users find them, and what tracebacks show.
for _public in [value for value in vars().values() if isinstance(value, type)]:
    _public.__module__ = __name__
