"""What a calibration says of itself, by definition: chi-square, lack of fit, correlations, normality, poses that are left out."""
import numpy as np
from scipy import stats

from calibration_estimate import calibrated
from statistics_by_definition import whitening


def both_sides_of_chi_square(square, freedom):
    return 2 * min(stats.chi2.sf(square, freedom), stats.chi2.cdf(square, freedom))


def jarque_bera(values):
    d = values - values.mean()
    skewness, excess = (d**3).mean() / (d**2).mean() ** 1.5, (d**4).mean() / (d**2).mean() ** 2 - 3
    statistic = len(values) / 6 * (skewness**2 + excess**2 / 4)
    return statistic, stats.chi2.sf(statistic, 2)


def serial_correlation(whitened):
    """Of readings with the same ones one pose later, nan where nothing was read; chance: normal, one over the pairs (for fits
    that do not weigh by the covariance)."""
    products = whitened[:-1] * whitened[1:]
    pairs = np.isfinite(products).sum()
    statistic = np.nanmean(products) / np.nanmean(whitened**2)
    return statistic, 2 * stats.norm.sf(abs(statistic) * np.sqrt(pairs))


def instrument_alone(arm, poses, change):
    """Covariance of one line of readings at every pose, whole."""
    single, size = arm.instrument(poses, change), len(arm.columns)
    E = np.zeros((len(poses.Q), size, size))
    for t in range(len(arm.targets)):
        E[:, 3 * t:3 * t + 3, 3 * t:3 * t + 3] = single[:, t]
    return E


def lack_of_fit(estimate, lines, where):
    """F of residuals against the scatter within poses and what is stated to stay at one; lines[i]: readings at where[i],
    fitted or not.

    s²: the scatter whitened with the instrument's covariance, pooled. The residuals then count against s² times the
    instrument's share plus what stays. What the readings tell of the parameters costs them degrees of freedom; s² is known
    as well as its own degrees of freedom say, and only the share of the covariance that rests on it is uncertain."""
    arm, poses, change = estimate.arm, estimate.poses, estimate.change(estimate.x)
    square, freedom = 0.0, 0
    for here, E in zip(lines, instrument_alone(arm, where, change)):
        always = np.flatnonzero(~np.isnan(here).any(axis=0))
        if len(always) == 0 or len(here) < 2:
            continue
        L = np.linalg.cholesky(E[np.ix_(always, always)])
        square += np.sum(np.linalg.solve(L, (here[:, always] - here[:, always].mean(axis=0)).T) ** 2)
        freedom += len(always) * (len(here) - 1)
    fit, share, residuals = 0.0, 0.0, estimate.residuals()
    means = instrument_alone(arm, poses, change) * poses.shares
    for i, (E, A) in enumerate(zip(means * square / freedom, arm.stays(poses, change))):
        there = np.flatnonzero(estimate.read[i])
        V = (E + A @ A.T)[np.ix_(there, there)]
        fit += residuals[i, there] @ np.linalg.solve(V, residuals[i, there])
        share += np.trace(np.linalg.solve(V, E[np.ix_(there, there)]))
    share /= estimate.read.sum()
    left = estimate.read.sum() - estimate.told()
    return fit / left, stats.f.sf(fit / left, left, freedom / share**2)


def correlation(estimate, B):
    """Do readings err together where B is 1? The sum of products of whitened residuals, r'Br, over their mean square,
    against what it is where the whitened readings are independent: residuals are (1 − H) times them, H = J (JᵀJ)⁻¹ Jᵀ, so
    that E r'Br = tr B(1 − H), var r'Br = 2 tr (B(1 − H))²; for a ratio of two quadratic forms of f = tr(1 − H) degrees of
    freedom the variance is 2 (f tr C² − tr² C) / (f + 2), C = B(1 − H)."""
    r = estimate.whitened()[estimate.read] / estimate.factor
    J = estimate.J[:len(r)]
    rest = np.eye(len(r)) - J @ np.linalg.solve(estimate.J.T @ estimate.J, J.T)
    C, f = B @ rest, np.trace(rest)
    expected, off = np.trace(C), r @ B @ r / (r @ r / f)
    variance = 2 * (f * np.sum(C * C.T) - expected**2) / (f + 2)
    return (off - expected) / B.sum(), 2 * stats.norm.sf(abs(off - expected) / np.sqrt(variance))


def within_pose(estimate):
    """Readings of one kind (x of every target) at one pose."""
    pose, reading = np.argwhere(estimate.read).T
    together = (pose[:, None] == pose) & (reading[:, None] % 3 == reading % 3)
    return correlation(estimate, together - np.eye(len(pose)))


def pose_by_pose(estimate):
    """The same reading at two poses, one after the other."""
    pose, reading = np.argwhere(estimate.read).T
    return correlation(estimate, ((np.abs(pose[:, None] - pose) == 1) & (reading[:, None] == reading)).astype(float))


def left_out(estimate, placed, weights):
    """One pose after the other (above 30: one of ten groups) predicted by the estimate from the others, and by base, tool and
    nuisance alone: root mean squares of both, and the mean gain in its own standard errors. Whitened as stated."""
    poses, z, count = estimate.poses, estimate.z, len(estimate.z)
    groups = 10 if count > 30 else count
    squares = {}
    for which in (estimate, placed):
        counts = [n for n, counted in zip(which.names, which.counted) if counted]
        squares[which] = np.zeros(count)
        for g in range(groups):
            out = np.arange(count) % groups == g
            rest, _ = calibrated(which.arm, which.variant, which.names, poses[~out], z[~out], counts, weights, which.differences())
            change = rest.change(rest.x)
            W = whitening(which.arm.covariances(poses[out], change), which.read[out])
            off = np.where(which.read[out], z[out] - which.arm.readings(poses[out], change), 0)
            squares[which][out] = (np.einsum("nij,nj->ni", W, off) ** 2).sum(axis=1) / which.read[out].sum(axis=1)
    gain = squares[placed] - squares[estimate]
    return {"groups": groups, "estimated": np.sqrt(squares[estimate].mean()), "placed": np.sqrt(squares[placed].mean()),
            "gain": gain.mean() / (gain.std(ddof=1) / np.sqrt(count))}
