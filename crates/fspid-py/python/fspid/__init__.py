"""Design, simulate, prove and tune fuzzy self-tuning PID flight controllers.

>>> import fspid
>>> scenario = fspid.Scenario.preset("pitch-hold")
>>> flight = scenario.simulate()
>>> flight["FSPID"].verdict
'settled'

Every number and every sentence is that of the program ``fspid``: the same code answers both, with the same bits.
"""

from typing import Any

from . import aircraft, lti
from ._core import VERSION as __version__
from ._core import Column
from .answers import (
    Absent,
    Analysis,
    Answer,
    CertificateCheck,
    Certification,
    Columns,
    Contest,
    Design,
    Flight,
    Trace,
    Verification,
)
from .campaign import Campaign, CampaignSummary
from .certificate import Certificate
from .controllers import Controller, Fspid, Pid
from .errors import Error, FileError, InputError, Problem, ScenarioError
from .fuzzy import Audit, Explanation, FuzzySystem, Increments, Supervisor, Surface
from .scenario import Scenario

__all__ = [
    "Absent",
    "Analysis",
    "Answer",
    "Audit",
    "Campaign",
    "CampaignSummary",
    "Certificate",
    "CertificateCheck",
    "Certification",
    "Column",
    "Columns",
    "Contest",
    "Controller",
    "Design",
    "Error",
    "Explanation",
    "FileError",
    "Flight",
    "Fspid",
    "FuzzySystem",
    "Increments",
    "InputError",
    "Pid",
    "Problem",
    "Scenario",
    "ScenarioError",
    "Supervisor",
    "Surface",
    "Trace",
    "Verification",
    "__version__",
    "aircraft",
    "lti",
]


def __getattr__(name: str) -> Any:
    """``fspid.gym`` and ``fspid.widget`` where they are asked for: they need other packages."""
    if name in ("gym", "widget"):
        import importlib

        return importlib.import_module(f"fspid.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
