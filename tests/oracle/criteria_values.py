"""Every criterion by its definition, for many sets of poses at once: sums of JᵀJ, inverses, determinants, singular values."""
import numpy as np

from statistics_by_definition import STEP, Poses, derivative, whitening

LOG_DETERMINANTS, TRACES, INDICES = ("o1", "ds"), ("a", "test_pose", "test_pose_max"), ("o2", "o3", "o4", "o5")


def columns(arm, variant, poses, names):
    """Whitened derivatives by the named parameters at the variant's nominal values: pose × reading × parameter."""
    nominal = arm.nominal(variant)
    W = whitening(arm.covariances(poses, nominal), np.ones((len(poses.Q), len(arm.columns)), bool))

    def rows(values):
        change = nominal | {n: nominal.get(n, 0.0) + v for n, v in zip(names, values.T)}
        rows = np.einsum("nij,...nj->...ni", W, arm.readings(poses, change))
        return rows.reshape(len(values), -1)
    J = derivative(rows, np.zeros(len(names)), np.ones(len(names)))
    return J.reshape(len(poses.Q), -1, len(names))


def log_determinant(M):
    """nan where nothing is determined."""
    good = np.isfinite(M[..., 0, 0])
    values = np.full(M.shape[:-2], np.nan)
    values[good] = np.linalg.slogdet(M[good])[1]
    return values


class Fitted:
    """One variant and what its criteria need at a list of poses. Columns count in units of their tolerance throughout."""

    def __init__(self, arm, variant, parameters, poses, prior):
        self.arm, self.variant = arm, variant
        self.names = [p["name"] for p in parameters]
        self.interest = np.array([p["role"] == "interest" for p in parameters])
        self.units = np.array([arm.tolerance(name, variant)[0] for name in self.names])
        self.J = columns(arm, variant, poses, self.names) * self.units
        self.grams = np.einsum("nri,nrj->nij", self.J, self.J)
        self.prior = np.eye(len(self.names)) if prior else 0.0
        self.size = int(self.interest.sum())
        self.known = {}

    def information(self, sets):
        """sets: rows of indices of poses. Those that determine nothing become nan, so that nothing is hidden."""
        M = self.grams[sets].sum(axis=-3) + self.prior
        # Whatever units the columns have.
        size = np.sqrt(np.diagonal(M, axis1=-2, axis2=-1)) + 1e-300
        values = np.linalg.eigvalsh(M / (size[..., :, None] * size[..., None, :]))
        return np.where((values[..., 0] > 1e-9 * values[..., -1])[..., None, None], M, np.nan)

    def inverse(self, sets):
        """Kept for the last few lists of sets, because every criterion asks for it."""
        key = (np.shape(sets), np.asarray(sets).tobytes())
        if key not in self.known:
            self.known = dict(list(self.known.items())[-4:]) | {key: self.inverted(self.information(sets))}
        return self.known[key]

    @staticmethod
    def inverted(M):
        good = np.isfinite(M[..., 0, 0])
        V = np.full_like(M, np.nan)
        V[good] = np.linalg.inv(M[good])
        return V

    def schur(self, sets):
        """Information of the parameters of interest, the others eliminated."""
        return self.inverted(self.inverse(sets)[..., self.interest, :][..., self.interest])

    def log_det(self, sets):
        """In SI."""
        return log_determinant(self.schur(sets)) - 2 * np.log(self.units[self.interest]).sum()

    def log_det_full(self, sets):
        return log_determinant(self.information(sets)) - 2 * np.log(self.units).sum()

    def sigma(self, sets):
        return np.sqrt(np.diagonal(self.inverse(sets), axis1=-2, axis2=-1)) * self.units

    def column_units(self, scaling, among):
        """What a column of interest counts in: its tolerance, SI, or the inverse of its mean effect on a pose's readings
        (root of the mean over `among` of the squared norm of its block)."""
        if scaling == "tolerance":
            return self.units[self.interest]
        if scaling == "none":
            return np.ones(self.size)
        squares = np.diagonal(self.grams, axis1=1, axis2=2)[among].mean(axis=0) / self.units**2
        return 1 / np.sqrt(squares[self.interest])

    def indices(self, sets, units):
        sets = np.atleast_2d(sets)
        S = self.schur(sets) * np.outer(units, units) / np.outer(self.units[self.interest], self.units[self.interest])
        good = np.isfinite(S[..., 0, 0])
        s = np.full(S.shape[:-1], np.nan)
        s[good] = np.sqrt(np.maximum(np.linalg.eigvalsh(S[good])[..., ::-1], 0))
        least, most = s[..., -1], s[..., 0]
        return {"o1": np.exp(np.log(s).mean(axis=-1)) / np.sqrt(sets.shape[-1]), "o2": least / most, "o3": least,
                "o4": least**2 / most, "o5": 1 / (1 / s).sum(axis=-1)}

    def position_jacobians(self, test, point, names):
        """How the tip's point moves at the test poses by parameters in SI: test pose × 3 × parameter."""
        nominal, p = self.arm.nominal(self.variant), np.append(point, 1)

        def where(values):
            change = nominal | {n: nominal.get(n, 0.0) + v for n, v in zip(names, values.T)}
            return (self.arm.tips(test, change) @ p)[..., :3].reshape(len(values), -1)
        return derivative(where, np.zeros(len(names)), np.ones(len(names))).reshape(len(test), 3, len(names))

    def test_variances(self, sets, test, point):
        """tr(A_t V A_tᵀ) at every test pose; nuisance columns are zero there."""
        A = self.position_jacobians(test, point, self.names) * self.units * self.interest
        return np.einsum("tij,...jk,tik->...t", A, self.inverse(sets), A)


class Effects:
    """What is the case and not fitted: one column for all differences of nominal values, one for every tolerance of what
    the truth estimates and the fitted variant does not (nominal values equal)."""

    def __init__(self, fitted, truth, truth_names, poses):
        arm, here, there = fitted.arm, fitted.arm.nominal(fitted.variant), fitted.arm.nominal(truth)
        differing = sorted(n for n in set(here) | set(there) if here.get(n, 0.0) != there.get(n, 0.0))
        self.delta = {n: there.get(n, 0.0) - here.get(n, 0.0) for n in differing}
        self.extra = [n for n in truth_names if n not in fitted.names and n not in differing]
        self.names = differing + self.extra
        self.step = np.zeros((len(self.names), bool(differing) + len(self.extra)))
        self.step[:len(differing), :1] = np.array(list(self.delta.values())).reshape(-1, 1) if differing else 0
        for k, name in enumerate(self.extra):
            self.step[len(differing) + k, bool(differing) + k] = arm.tolerance(name, truth)[0]
        self.fitted, self.by_nominal = fitted, bool(differing)
        E = columns(arm, fitted.variant, poses, self.names) @ self.step
        self.cross = np.einsum("nri,nrk->nik", fitted.J, E)
        self.squares = np.einsum("nri,nrk->nik", E, E)

    def left(self, sets):
        """By column, ‖(I − P) e‖²: what fitting leaves of it. With a prior its rows read no effect."""
        C = self.cross[sets].sum(axis=-3)
        fitted = np.einsum("...ik,...ij,...jk->...k", C, self.fitted.inverse(sets), C)
        return np.diagonal(self.squares[sets].sum(axis=-3), axis1=-2, axis2=-1) - fitted

    def size(self, sets):
        """What there is before anything is fitted."""
        return np.trace(self.squares[sets].sum(axis=-3), axis1=-2, axis2=-1)

    def estimates(self, sets):
        """By how much the estimates are off, in units of tolerance: parameter × effect."""
        off = self.fitted.inverse(sets) @ self.cross[sets].sum(axis=-3)
        for k, name in enumerate(self.fitted.names):
            if self.by_nominal and name in self.delta:
                off[..., k, 0] -= self.delta[name] / self.fitted.units[k]
        return off

    def squared_errors(self, sets, test, point):
        """Sum over effects of the squared error at every test pose: what the estimates say less what is there."""
        f = self.fitted
        A = f.position_jacobians(test, point, f.names) * f.units * f.interest
        unseen = [k for k, n in enumerate(self.names) if n not in f.names]
        b = f.position_jacobians(test, point, self.names)[:, :, unseen] @ self.step[unseen]
        error = np.einsum("tij,...jk->...tik", A, self.estimates(sets)) - b
        return (error**2).sum(axis=(-2, -1))


class Design:
    """All that a problem asks for, over the poses of a list."""

    def __init__(self, arm, fits, effects, design):
        self.arm, self.fits, self.effects, self.design = arm, fits, effects, design
        test = design.get("test_poses", {})
        self.test = np.array(test["at"]) if test else None
        self.point = np.array(test.get("point", [0, 0, 0]), float)
        weights = np.array(test.get("weights", np.ones(len(test.get("at", [1])))), float)
        self.weights = weights / weights.sum()
        self.fit = fits[0]

    def value(self, name, sets, among, bounds=None, shares=None):
        """The criterion in its own terms; `among`: the poses whose mean effect `scaling: norm` means."""
        fit, scaling = self.fit, self.design.get("scaling", "tolerance")
        units = fit.column_units(scaling, among)
        if name == "ds":
            return fit.log_det(sets)
        if name in INDICES or name == "o1":
            return fit.indices(sets, units)[name].reshape(np.shape(sets)[:-1])
        if name == "a":
            return -((fit.sigma(sets)[..., fit.interest] / units) ** 2).sum(axis=-1)
        if name == "test_pose":
            return -fit.test_variances(sets, self.test, self.point) @ self.weights
        if name == "test_pose_max":
            return -fit.test_variances(sets, self.test, self.point).max(axis=-1)
        if name in ("compound", "maximin"):
            e = np.array([(f.log_det(sets) - bound) / f.size for f, bound in zip(self.fits, bounds)])
            return np.exp(e.min(axis=0)) if name == "maximin" else np.tensordot(shares, e, 1)
        if name == "discriminate":
            return self.effects.left(sets).sum(axis=-1)
        if name == "bias":
            if self.test is not None:
                return self.value("test_pose", sets, among) - self.effects.squared_errors(sets, self.test, self.point) @ self.weights
            off = self.effects.estimates(sets)[..., fit.interest, :] * (fit.units[fit.interest] / units)[:, None]
            return self.value("a", sets, among) - (off**2).sum(axis=(-2, -1))
        raise ValueError(name)

    def degree(self, name):
        # Singular values are roots of what grows with the information.
        return self.fit.size if name in LOG_DETERMINANTS else 0.5 if name in INDICES else 1

    def potential(self, name, value, sets=None):
        """Φ, which the certificate bounds, from a criterion's value."""
        if name in LOG_DETERMINANTS:
            return self.fit.log_det(sets)
        if name in TRACES:
            return -np.log(-value)
        with np.errstate(invalid="ignore", divide="ignore"):
            return value if name == "compound" else np.log(value)
