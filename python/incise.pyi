"""Plans robotic soft-tissue incisions by simulating them first. Lengths in mm, coordinates in LPS."""

import os
import pathlib
from typing import Literal, Optional, TypedDict

import numpy as np
import numpy.typing as npt

__version__: str

class Error(RuntimeError): ...
class InvalidArgument(Error):
    """An argument of a function is out of its range."""
class CaseError(Error):
    """The case file asks for something that cannot be done: which field, what was found, what was expected."""
class DataError(Error):
    """A file is missing, damaged or unsuitable, or an output cannot be written."""

class Case:
    """A case file as read: see load_case."""

    @property
    def file(self) -> pathlib.Path: ...
    @property
    def folder(self) -> pathlib.Path: ...
    @property
    def title(self) -> str: ...
    @property
    def settings(self) -> dict[str, str]:
        """Every setting, defaults included: dotted key to text."""

class Summary(TypedDict, total=False):
    mean: float
    sd: float
    min: float  # of signed errors only
    max: float

class Evaluation(TypedDict, total=False):
    outcome: str
    closed_loop: Optional[bool]
    negative_margin: Optional[bool]
    contour: Literal["centerline", "inner_edge"]
    target_mm: float
    n_points: int
    abs_error_mm: Optional[Summary]
    signed_error_mm: Optional[Summary]
    paper_abs_error_mm: Optional[float]
    paper_success: Optional[bool]
    hu_score: Optional[float]
    hu_score_ideal: Optional[float]
    centroid_shift_mm: Optional[float]
    coverage: float

class Cut(Evaluation, total=False):
    """The summary of `incise simulate --json` (of the stretch alone, if that found no equilibrium), and arrays."""

    inner_edge: Evaluation
    tets: npt.NDArray[np.int32]  # (m, 4), into vertices_mm
    removed_tets: Optional[npt.NDArray[np.int32]]  # (k,), into tets, in the order in which they went
    vertices_mm: npt.NDArray[np.float64]  # (n, 3), at rest
    stretched_mm: npt.NDArray[np.float64]  # (n, 3), clamped and stretched, before the cut
    centerline_mm: Optional[npt.NDArray[np.float64]]  # (p, 3), mid-line of the kerf, as the tissue lay before the cut
    inner_edge_mm: Optional[npt.NDArray[np.float64]]  # (q, 3), border of the tissue inside the ring, tool out
    kerf_width_mm: float
    removed_volume_mm3: float
    steps: int
    wall_s: float

def load_case(path: str | os.PathLike[str]) -> Case:
    """Reads case.yaml, or the file of that name in a folder. Raises CaseError or DataError."""

def simulate(case: Case, output: str | os.PathLike[str], threads: int = 0) -> Cut:
    """Clamps, stretches, plans and cuts, on the folder `output`; resumes from what it already holds.

    threads: 0 means all; the result is the same bit for bit. A failed incision is a result: see `outcome`.
    Raises CaseError or DataError for a case that cannot be run, KeyboardInterrupt on Ctrl-C (finished stages stay).
    """
