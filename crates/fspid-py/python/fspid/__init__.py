"""Design, simulate, prove and tune fuzzy self-tuning PID flight controllers.

>>> import fspid
>>> scenario = fspid.Scenario.preset("pitch-hold")
>>> flight = scenario.simulate()
>>> flight["FSPID"].verdict
'settled'

Every number and every sentence is that of the program ``fspid``: the same code answers both, with the same bits.
"""

from ._core import VERSION as __version__
from ._core import Column
from .answers import Absent, Analysis, Answer, Certification, Contest, Design, Flight, Trace, Verification
from .campaign import Campaign, CampaignSummary
from .errors import Error, FileError, InputError, Problem, ScenarioError
from .scenario import Scenario

__all__ = [
    "Absent",
    "Analysis",
    "Answer",
    "Campaign",
    "CampaignSummary",
    "Certification",
    "Column",
    "Contest",
    "Design",
    "Error",
    "FileError",
    "Flight",
    "InputError",
    "Problem",
    "Scenario",
    "ScenarioError",
    "Trace",
    "Verification",
    "__version__",
]
