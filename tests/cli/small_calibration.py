"""A calibration as `incise calibrate` would leave it, without having calibrated: for tests of what plans by one."""

import copy
import json
import math
import pathlib

STEP_S, SPEED_MM_S, SECTORS = 0.02, 13.0, 36


def ring(radius_mm, modulus_kpa):
    """Covariates like those of small_case's ring."""
    return {"radius_mm": radius_mm, "outline": 1.0, "along": 0.5, "aside_mm": 0.0, "youngs_modulus_kpa": modulus_kpa, "lateral_margin_mm": 5.0,
            "depth_mm": 5.0, "speed_mm_s": 7.0, "start_deg": -90.0, "pull_deg": -90.0}


def fitted(name, mean_mm):
    """A photograph that errs by `mean_mm` with a wave of its own, and a fit that is 0.05 mm off."""
    wave = [0.1 * math.cos(4.0 * math.pi * i / SECTORS) for i in range(SECTORS)]
    return {"name": name, "observed_mm": [mean_mm + w for w in wave], "fitted_mm": [mean_mm - 0.05] * SECTORS}


SPECIMENS = [
    {"name": "s1", "youngs_modulus_kpa": 62.0, "stretch_force_n": 24.0, "simulated_force_n": 27.0, "stretch_mm": 20.0,
     "photographed_mean_signed_mm": -3.5, "registration": {"rmse_mm": 0.30, "scale": 1.000}, "ring": ring(4.9, 62.0)},
    {"name": "s2", "youngs_modulus_kpa": 78.0, "stretch_force_n": 30.0, "simulated_force_n": 27.0, "stretch_mm": 20.0,
     "photographed_mean_signed_mm": -3.9, "registration": {"rmse_mm": 0.36, "scale": 1.004}, "ring": ring(5.1, 78.0)},
]
RESIDUAL = {"sd_mm": 0.3, "correlation_deg": 60.0, "reading_mm": 0.1, "specimen_spread_mm": 0.2, "placement_mm": 0.2, "n_effective": 4.0}


def samples(drag_mm=(1.2, 1.4), ln_stiffness=(-0.1, 0.1), bias_mm=(0.1, 0.3)):
    """Eight of equal weight."""
    return [{"weight": 0.125, "drag_length_mm": drag, "stiffness_factor": math.exp(stiff), "bias_mm": bias}
            for drag in drag_mm for stiff in ln_stiffness for bias in bias_mm]


def calibration():
    return {
        "schema": "incise.calibration/1", "method": "fit", "virtual": True, "reference_step_s": STEP_S, "baseline_mm": 1.9,
        "chosen": {"speed_mm_s": SPEED_MM_S, "dullness": 5.0, "stiffness_of_case": 1.0},
        "specimens": copy.deepcopy(SPECIMENS), "posterior": {"samples": samples()}, "residual": dict(RESIDUAL),
        "fitted": [fitted("s1", -3.5), fitted("s2", -3.9)],
    }


def write(path, changed=None):
    """`changed` is called with the calibration and may alter it."""
    found = calibration()
    if changed:
        changed(found)
    pathlib.Path(path).write_text(json.dumps(found))
    return pathlib.Path(path)
