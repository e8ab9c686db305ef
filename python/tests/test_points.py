"""Measurements instead of frames."""

from __future__ import annotations

from typing import Tuple

import numpy as np
import pytest
from numpy.typing import NDArray
from veronese import VeroneseError, fit_points

Array = NDArray[np.float64]


def measurements(noise: float = 0.01) -> Tuple[Array, Array]:
    """200 measurements of one motion, 100 of another."""
    random = np.random.default_rng(1)
    positions = random.uniform(-1, 1, (300, 2))
    gradients = random.normal(size=(300, 2))
    flow = np.where(np.arange(300)[:, None] < 200, [0.5, -0.25], positions @ [[0.2, 0.4], [-0.4, 0.2]] + [0, 0.6])
    temporal = -(gradients * flow).sum(axis=1) + noise * random.normal(size=300)
    return positions, np.column_stack([gradients, temporal])


def test_two_motions_are_found() -> None:
    fit = fit_points(*measurements())
    assert fit.count == 2 and fit.stages is None
    assert repr(fit) == "MotionFit(2 motions, 300 measurements)"
    np.testing.assert_allclose(fit.motions[0].matrix, [0, 0, 0.5, 0, 0, -0.25], atol=0.02)
    np.testing.assert_allclose(fit.motions[1].matrix, [0.2, -0.4, 0, 0.4, 0.2, 0.6], atol=0.02)
    assert fit.labels.shape == (300,) and (fit.labels == (np.arange(300) >= 200)).mean() > 0.9
    covariance = fit.motions[0].covariance
    assert covariance is not None and covariance.shape == (6, 6)
    np.testing.assert_allclose(covariance, covariance.T)
    assert fit.motions[0].determined == 6


def test_the_method_of_the_paper_has_its_stages() -> None:
    fit = fit_points(*measurements(noise=1e-6), method="paper")
    assert fit.count == 2 and fit.stages is not None and fit.stages.rank_rule_fired
    assert [tried.motions for tried in fit.stages.ranks] == [1, 2]
    assert len(fit.stages.factorisation) == len(fit.stages.refined) == 2
    assert fit.stages.refinement.termination in ("converged", "stalled")
    assert fit.singular_values.size > 0 and (np.diff(fit.singular_values) <= 0).all()


def test_lists_and_other_numbers_become_arrays() -> None:
    positions, derivatives = measurements()
    once = fit_points(positions, derivatives, motions=2, seed=3)
    again = fit_points(positions.tolist(), derivatives.tolist(), motions=2, seed=3)
    assert (once.motions[0].matrix == again.motions[0].matrix).all()


def test_stages_are_told() -> None:
    told = []
    fit_points(*measurements(), progress=lambda stage, index, of: told.append((index, of)))
    assert told and all(index < of for index, of in told)


def test_what_cannot_be_fitted_has_a_code() -> None:
    positions, derivatives = measurements()
    infinite = derivatives.copy()
    infinite[7, 1] = np.inf
    for code, arguments, options in [
        ("measurement-count-mismatch", (positions[1:], derivatives), {}),
        ("too-few-measurements", (positions[:5], derivatives[:5]), {}),
        ("not-finite", (positions, infinite), {}),
        ("invalid-input", (positions, derivatives[:, :2]), {}),
        ("invalid-input", (positions.ravel(), derivatives), {}),
        ("invalid-input", ("positions", derivatives), {}),
        ("invalid-option", (positions, derivatives), {"method": "better"}),
        ("invalid-option", (positions, derivatives), {"seed": -1}),
        ("invalid-option", (positions, derivatives), {"motions": 11}),
    ]:
        with pytest.raises(VeroneseError) as caught:
            fit_points(*arguments, **options)  # type: ignore[arg-type]
        assert caught.value.code == code
