"""Estimators of a linear model: whitened blocks J (poses × rows × parameters), residuals y (poses × rows), the parameters of
the nominal arm, and the information of the tolerances about them. Each returns the parameters."""
import numpy as np

THRESHOLD = 3e-6  # of the largest singular value: what the poses leave undetermined


def plain(J, y, nominal, known):
    """Least squares; what the poses do not determine stays nominal (pseudo-inverse)."""
    rows = J.reshape(-1, J.shape[2])
    return nominal + np.linalg.pinv(rows, rcond=THRESHOLD) @ (y.reshape(-1) - rows @ nominal)


def ridge(J, y, nominal, known, strengths=10.0 ** np.arange(-4, 4)):
    """Least squares with λ times the tolerances as prior; λ by cross-validation, one pose left out at a time."""
    rows = J.reshape(-1, J.shape[2])
    y = y - J @ nominal
    M, b, one = rows.T @ rows, rows.T @ y.reshape(-1), np.eye(J.shape[1])
    best, found = np.inf, None
    for strength in strengths:
        V = np.linalg.inv(M + strength * known + 1e-9 * np.eye(len(M)))
        theta = V @ b
        kept = one - np.einsum("nrk,nsk->nrs", J @ V, J) + 1e-9 * one
        score = (np.linalg.solve(kept, (y - J @ theta)[..., None]) ** 2).sum()
        if score < best:
            best, found = score, theta
    return nominal + found


def robust(J, y, nominal, known, rounds=20):
    """Huber's weights on whole poses; scale by the median of their residuals."""
    theta = plain(J, y, nominal, known)
    for _ in range(rounds):
        size = np.sqrt(((y - J @ theta) ** 2).mean(1))
        weight = np.sqrt(np.minimum(1, 1.345 * 1.48 * np.median(size) / np.maximum(size, 1e-12)))
        before = theta
        theta = plain(J * weight[:, None, None], y * weight[:, None], nominal, known)
        if np.abs(theta - before).max() < 1e-6:
            break
    return theta


ESTIMATORS = {"plain least squares": plain, "ridge, cross-validated": ridge, "robust": robust}
