"""Elastoplastic friction: updates of contact points, the program's slider, constants from measured records.

docs/python.md of the project shows each of them at work.
"""
from . import laws
from ._library import message, version as __version__
from ._fit import Fit, fit
from ._namelist import InputError
from ._rates import Rates, SlipRates, rates, slip_rates
from ._rate_state import fit_rate_and_state
from ._rate_state_result import RateStateFit
from ._records import Record, RecordError
from ._run import Run, RunError, run
from ._stability import Stability, stability
from ._update import Result, update

__all__ = ['Fit', 'InputError', 'RateStateFit', 'Rates', 'Record', 'RecordError', 'Result', 'Run', 'RunError', 'SlipRates',
           'Stability', '__version__', 'fit', 'fit_rate_and_state', 'laws', 'message', 'rates', 'run', 'slip_rates', 'stability',
           'update']
