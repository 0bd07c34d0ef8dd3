"""Displacements of a visit that nobody stated, by restricted maximum likelihood with the dense covariance of all readings."""
import copy

import numpy as np
from arm import si
from scipy import linalg, optimize, stats

from statistics_by_definition import derivative

LEAST = 1e-3  # Of the size at which a displacement counts as much as the noise: less is nothing.


def with_visits(arm, visits):
    """The arm with these displacements beside the stated ones. The noise factor of a fit multiplies all of the covariance."""
    stated = stated_sizes(arm)
    other = copy.copy(arm)
    sizes = np.hypot(stated, np.array([visits["position"], visits["rotation"]]) / visits["noise"])
    other.measurement = arm.measurement | {"repeatability": dict(zip(["position", "rotation"], map(float, sizes)))}
    return other


def stated_sizes(arm):
    """Displacement and rotation, 1σ each axis."""
    stays = arm.measurement.get("repeatability", 0)
    stays = stays if isinstance(stays, dict) else {"position": stays}
    return np.array([si(stays["position"]), si(stays.get("rotation", 0))])


def of_size_one(arm, poses, change, sizes):
    """A Aᵀ of all readings for these sizes of displacement and rotation, with exact joints."""
    other = copy.copy(arm)
    other.problem = arm.problem | {"robot": arm.problem["robot"] | {"encoder_noise": 0}}
    other.measurement = arm.measurement | {"repeatability": dict(zip(["position", "rotation"], map(float, sizes)))}
    A = other.stays(poses, change)
    return linalg.block_diag(*(A @ A.transpose(0, 2, 1)))


class RestrictedLikelihood:
    """Readings z = X x + e, e ~ N(0, f² V + t² A Aᵀ + w² B Bᵀ). Parameters whose tolerance counts are random, the others unknown:
    what is left of z beside those has a likelihood of f, t, w alone (Patterson & Thompson 1971)."""

    def __init__(self, arm, estimate):
        read, change = estimate.read.ravel(), estimate.change(estimate.x)
        square = np.ix_(read, read)
        self.V = linalg.block_diag(*arm.covariances(estimate.poses, change))[square]
        self.parts = [of_size_one(arm, estimate.poses, change, size)[square] for size in np.eye(2)]
        # Where nothing is read there is no residual to derive.
        X = -derivative(lambda x: estimate.residuals(x)[..., estimate.read], estimate.x, estimate.units)
        self.free = X[:, ~estimate.counted]
        self.known = X[:, estimate.counted] @ X[:, estimate.counted].T
        self.z = estimate.residuals()[estimate.read] + X @ estimate.x
        self.units = [np.sqrt(np.trace(self.V) / max(np.trace(part), 1e-300)) for part in self.parts]

    def minus_two_log(self, f, t, w):
        C = f**2 * self.V + t**2 * self.parts[0] + w**2 * self.parts[1] + self.known
        L = np.linalg.cholesky(C)
        z, X = (linalg.solve_triangular(L, a, lower=True) for a in (self.z, self.free))
        Q, R = np.linalg.qr(X)
        return 2 * np.log(np.diag(L)).sum() + 2 * np.log(np.abs(np.diag(R))).sum() + np.sum((z - Q @ (Q.T @ z)) ** 2)

    def least(self, free):
        """By simplices from a grid of starts; `free`: which of noise, displacement, rotation. Noise is at least as stated."""
        low = np.log([1.0, LEAST * self.units[0], LEAST * self.units[1]])[free]

        def value(x):
            sizes = np.array([1.0, 0.0, 0.0])
            sizes[free] = np.exp(np.maximum(x, low))
            return self.minus_two_log(*sizes)
        if not any(free):
            return value(np.zeros(0))
        starts = [low + up for up in ([0.3] * len(low), [np.log(1e3)] * len(low), np.log([2.0, 3e3, 3e3])[free])]
        return min(optimize.minimize(value, start, method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-6, "maxiter": 2000}).fun
                   for start in starts)


def compare_visits(stated_arm, estimate, visits, check):
    """What the program found lies at the least of the likelihood, and its chance is that of the likelihoods' ratio."""
    likelihood = RestrictedLikelihood(stated_arm, estimate)
    unknown = list(stated_sizes(stated_arm) == 0)
    own = likelihood.least([visits["noise"] > 1, *unknown])
    there = likelihood.minus_two_log(visits["noise"], visits["position"], visits["rotation"])
    check.note("visits: −2 ln likelihood", there - own)
    ratio = likelihood.least([True, False, False]) - likelihood.least([True, *unknown])
    check.test("visits: chance", (ratio, stats.chi2.sf(ratio, sum(unknown))), {"statistic": ratio, "probability": visits["probability"]})
    check.note("visits: stated", np.array([visits["position"], visits["rotation"]])[~np.array(unknown)])
