"""Least squares of readings by definition: whitened residuals, tolerances as rows, the covariance taken at the solution."""
import copy

import numpy as np
from scipy import optimize, stats

from statistics_by_definition import AXES, derivative, displaced, minimum, whitening


class Estimate:
    """Parameters `names` (interest and nuisance) fitted to z, nan where nothing was read.

    `counts`: whose tolerance is one more measurement. `weights`: "wls" by the covariance, "ols" all lengths alike.
    `factor`: by what the noise is larger than stated (ols: the noise itself in m)."""

    def __init__(self, arm, variant, names, poses, z, counts=(), weights="wls", factor=1.0, start=None):
        self.arm, self.variant, self.names, self.poses, self.z, self.weights = arm, variant, list(names), poses, z, weights
        self.read = ~np.isnan(z)
        self.units = np.array([arm.tolerance(name, variant)[0] * getattr(arm, "times", {}).get(name, 1.0) for name in self.names])
        self.counted = np.array([name in counts for name in self.names], bool)
        self.factor = factor
        self.nominal = arm.nominal(variant)
        self.x = np.array([(start or {}).get(name, 0.0) for name in self.names]) / self.units
        # The noise depends on where the robot turns out to stand: solved again with the covariance there, until it stays.
        for _ in range(30):
            before, self.W = self.x, self.whitening_at(self.x)
            self.x, self.J = minimum(self.rows, self.x, self.units)
            if weights == "ols" or np.abs(self.x - before).max() < 1e-8 * (1 + np.abs(self.x).max()):
                break
        self.covariance = np.linalg.inv(self.J.T @ self.J) * np.outer(self.units, self.units)
        self.sigma = np.sqrt(np.diag(self.covariance))

    def change(self, x):
        return self.nominal | {n: self.nominal.get(n, 0.0) + v for n, v in zip(self.names, (x * self.units).T)}

    def whitening_at(self, x):
        if self.weights == "ols":
            return self.read[:, :, None] * np.eye(self.z.shape[1])
        return whitening(self.arm.covariances(self.poses, self.change(x)), self.read)

    def residuals(self, x=None):
        return self.z - self.arm.readings(self.poses, self.change(self.x if x is None else x))

    def whitened(self, x=None):
        return np.einsum("nij,...nj->...ni", self.W, np.where(self.read, self.residuals(x), 0))

    def rows(self, x):
        return np.concatenate([self.whitened(x)[..., self.read] / self.factor, x[..., self.counted]], axis=-1)

    def differences(self):
        """Estimate less nominal, in SI, by name."""
        return dict(zip(self.names, self.x * self.units))

    def chi_square(self):
        return float(np.sum(self.rows(self.x) ** 2))

    def freedom(self):
        return int(self.read.sum() + self.counted.sum() - len(self.names))

    def columns_of_readings(self):
        """Derivatives of the whitened residuals alone, in units of tolerance."""
        return derivative(lambda x: self.whitened(x)[..., self.read], self.x, self.units)

    def refused(self):
        return stats.chi2.sf(self.chi_square(), self.freedom()) < 0.01

    def with_noise(self, factor):
        """The same with another size of the noise, the covariance's shape left as it is."""
        other = copy.copy(self)
        other.factor = factor
        other.x, other.J = minimum(other.rows, self.x, self.units)
        return other

    def told(self):
        """How many of the parameters the readings themselves tell: what their squares fall short of their number."""
        J = self.J[:self.read.sum()]
        return float(np.trace(J @ np.linalg.solve(self.J.T @ self.J, J.T)))

    def noise_shown(self):
        """The size of the noise (of the stated one, ols: in m) for which the readings' residuals are as large as expected."""
        squares = np.sum(self.whitened()[self.read] ** 2)
        return np.sqrt(squares / (self.read.sum() - self.told()))

    def turned(self, frame):
        """How `frame` is turned, and the covariance of a small rotation of it about the axes of its parent."""
        where = [self.names.index(f"{frame}.{a}") for a in AXES[3:]]
        angles = np.array([self.change(self.x)[f"{frame}.{a}"] for a in AXES[3:]])
        R = displaced([0, 0, 0, *angles])[:3, :3]

        def small(change):
            D = displaced([0, 0, 0, *(angles + change).T])[..., :3, :3] @ R.T
            return np.stack([D[..., 2, 1] - D[..., 1, 2], D[..., 0, 2] - D[..., 2, 0], D[..., 1, 0] - D[..., 0, 1]], axis=-1) / 2
        A = derivative(small, np.zeros(3), np.ones(3))
        return R, A @ self.covariance[np.ix_(where, where)] @ A.T


def agreed(more, start):
    """The noise of which residuals show no more and no less, the next one from `start` on; logarithms. Where noise is small
    tolerances count for nothing and residuals show some; where it is large they show what the nominal robot leaves."""
    here = more(start)
    ahead, step = start + here, 0.2 if here > 0 else -0.2
    for _ in range(100):
        there = more(ahead)
        if abs(there) < 1e-9:
            return float(np.exp(ahead))
        if there * here < 0:
            return float(np.exp(optimize.brentq(more, start, ahead, xtol=1e-9)))
        start, here, ahead, step = ahead, there, ahead + step, 1.5 * step
    raise ArithmeticError("no noise agrees with what residuals show")


def calibrated(arm, variant, names, poses, z, counts=(), weights="wls", start=None, begin=None):
    """The estimate with the noise as stated, and the one that counts: with the noise that the residuals show, noise and
    estimate agreeing, if chance refuses the stated one, or if nobody states it (ols). `begin`: a noise to begin with (ols)."""
    first = Estimate(arm, variant, names, poses, z, counts, weights, 1.0, start)
    noise = 1.0
    if weights == "ols":
        # In m a reading weighs nothing beside a tolerance: begin with the noise that plain least squares show.
        noise = begin or np.sqrt(np.sum(first.whitened() ** 2) / max(1, first.read.sum() - (~first.counted).sum()))
    elif not first.refused():
        return first, first

    latest = first

    def more(log_noise):
        """By how much the noise that residuals show is more than the one that they are weighed by."""
        nonlocal latest
        latest = latest.with_noise(float(np.exp(log_noise)))
        return np.log(latest.noise_shown()) - log_noise
    noise = agreed(more, np.log(noise))
    # Residuals that are refused are never smaller than the stated noise would have them.
    noise = noise if weights == "ols" else max(1.0, noise)
    return Estimate(arm, variant, names, poses, z, counts, weights, noise, first.differences()), first


def rms_by_kind(residuals):
    """Root mean squares of single readings, and of the distances of targets that were read whole."""
    single = residuals[~np.isnan(residuals)]
    distance = np.linalg.norm(residuals.reshape(-1, 3), axis=1)
    distance = distance[~np.isnan(distance)]
    return {"m": np.sqrt(np.mean(single**2)), "distance": np.sqrt(np.mean(distance**2)) if len(distance) else np.nan}
